#include "cli/motions/report.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include <unistd.h>

#include "cli/motions/result_file.h"
#include "cli/motions/run_formulas.h"
#include "cli/motions/run_info.h"
#include "cli/outputs.h"
#include "cli/say.h"
#include "observe/rows/quantity_units.h"
#include "report/page/page_of.h"
#include "report/rows/page_rows.h"
#include "result/choose_columns.h"
#include "result/file.h"

namespace anholon::cli {

namespace {

void make_ready(const SystemCommand& o, Told& x) {
  Scenario prepared;
  const Outcome outcome = ready(x.in, form(o, *x.in.model), state_choice(o, *x.in.model), prepared);
  if (!outcome.ok()) {
    print_outcome(outcome);
    throw UsageError{"error: the start of the run cannot be found again\n"};
  }
  x.scenario = std::make_unique<Workspace>(prepared);
  const bool reset =
      std::any_of(x.in.model->events.begin(), x.in.model->events.end(), [](const Event& e) { return !e.set.empty(); });
  if (!reset && contacts(*x.in.names).empty()) x.conserved = conserved(*x.scenario->mechanics);
}

// Returns the columns to plot on the page. Throws UsageError.
std::vector<std::string> columns_of_page(const PageFile& page, const RunTable& table) {
  try {
    std::vector<std::string> names;
    for (const std::size_t k : chosen_columns(table.columns, split(page.columns), 0)) names.push_back(table.columns[k]);
    return names;
  } catch (const Failure& e) {
    throw usage_error(e, {});
  }
}

}  // namespace

void take_up(const SystemCommand& o, const std::string& rows, Told& x) {
  x.run = read_result(rows.empty() ? o.model : rows);
  if (x.run.table.rows() == 0) throw UsageError{"error: the run has no rows\n"};
  if (!rows.empty()) {
    x.in = read(o);
    const ResultFormat* format = format_of(rows);
    const bool lines = format && format->name == std::string("CSV");
    if (const std::string why = obstacle_to_showing(*x.in.model, x.run.table, lines); !why.empty())
      throw UsageError{"error: '" + rows + "' cannot be shown: " + why +
                       "\nhint: the columns of anholon simulate, with times that ascend or descend\n"};
    if (x.run.units.empty()) x.run.units = quantity_units(*x.in.model, contacts(*x.in.names));
    make_ready(with_form(o, x.in), x);
    return;
  }
  if (x.run.model.empty())
    throw UsageError{"error: '" + o.model + "' holds rows, but not their model\nhint: anholon report MODEL --rows " +
                     o.model + ", or a run in HDF5: anholon simulate MODEL -o run.h5\n"};
  const SystemCommand was = options_of(x.run, o);
  x.in = model_of(x.run, was);
  make_ready(was, x);
}

bool is_a_run(const std::string& path) { return format_of(path) && std::filesystem::exists(path); }

void check_page(const PageFile& page) {
  if (const std::string why = obstacle_to_writing(page.path); !why.empty()) throw UsageError{"error: " + why + "\n"};
}

void write_page(const SystemCommand& o, const PageFile& page, std::deque<Told>& cases) {
  Told& first = cases[0];
  // Equations and proof use the eliminations at the state of the run.
  const SystemCommand was = first.run.settings.empty() ? o : options_of(first.run, o);
  PageRequest request;
  request.choice = state_choice(was, *first.in.model);
  for (const std::string& name : split(page.forms)) {
    SystemCommand one = o;
    one.motion.form = name;
    request.forms.push_back(&form(one, *first.in.model, &*first.scenario->mechanics));
  }
  if (page.no_proof) request.no_proof = "The proof was left out (--no-proof).";
  request.version = "anholon " ANHOLON_VERSION;
  request.command = o.command_line;
  request.source = first.in.source;
  if (!page.columns.empty()) request.columns = columns_of_page(page, first.run.table);
  if (!o.quiet) request.note = [](const std::string& text) { say(stderr, "note: %s\n", text.c_str()); };
  const bool terminal = isatty(STDERR_FILENO) != 0 && !o.quiet;
  if (terminal)
    request.progress = [](std::size_t done, std::size_t all, const std::string& name) {
      say(stderr, "\r\033[Kproof: %zu of %zu, %s", done, all, name.c_str());
    };
  std::vector<PagedRun> runs;
  for (Told& x : cases) runs.push_back({x.name, x.scenario.get(), x.conserved, x.run});
  std::string text;
  try {
    text = page_of(std::move(runs), first.in.model, request);
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, first.in.source)};
  }
  if (terminal) say(stderr, "\r\033[K");
  if (const std::string why = write_whole(page.path, text); !why.empty()) throw UsageError{"error: " + why + "\n"};
  if (!o.quiet) say(stderr, "page: %s, %.0f kB\n", page.path.c_str(), static_cast<double>(text.size()) / 1000);
}

int report(const ReportCommand& o) {
  PageFile page = o.page;
  if (page.path.empty()) page.path = std::filesystem::path(o.model).stem().string() + ".html";
  check_page(page);
  std::deque<Told> cases;
  if (!o.rows.empty() || is_a_run(o.model)) {
    take_up(o, o.rows, cases.emplace_back());
    must_spare_inputs(o, cases[0].in, {o.rows.empty() ? o.model : o.rows}, {{"the page", page.path}});
    write_page(o, page, cases);
    return kOk;
  }
  // Cases are shown side by side; `all` includes the file without a case.
  std::vector<std::string> names = o.cases;
  if (names == std::vector<std::string>{"all"}) {
    ModelCommand plain = o;
    plain.cases.clear();
    names = read(plain).model->cases;
    names.insert(names.begin(), "");
  }
  if (names.empty()) names = {""};
  int code = kOk;
  for (const std::string& name : names) {
    SimulateCommand one{o, {}, {}, {}, page};
    one.cases = name.empty() ? std::vector<std::string>{} : std::vector<std::string>{name};
    Told& x = cases.emplace_back();
    x.name = name;
    code = std::max(code, simulate_motion(one, nullptr, &x));
    if (x.run.table.rows() == 0) cases.pop_back();
  }
  if (!cases.empty()) write_page(o, page, cases);
  return code;
}

}  // namespace anholon::cli
