#include "cli/motions/report.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>

#include <unistd.h>

#include "base/hash.h"
#include "cli/motions/result_file.h"
#include "cli/motions/run_formulas.h"
#include "cli/motions/run_info.h"
#include "cli/say.h"
#include "observe/rows/row_values.h"
#include "proof/checker/verify.h"
#include "report/page/page.h"
#include "result/file.h"

namespace anholon::cli {

namespace {

// Limits: a proof of all forms takes long, and equations of more coordinates are too long to read.
constexpr std::size_t kMostProved = 12, kMostNodesProved = 600, kMostRead = 24;

void make_ready(const Options& o, Told& x) {
  Scenario prepared;
  const Outcome outcome = ready(x.in, form(o, *x.in.model), state_choice(o, *x.in.model), prepared);
  if (!outcome.ok()) {
    print_outcome(outcome);
    throw UsageError{"error: the start of the run cannot be found again\n"};
  }
  x.scenario = std::make_unique<Workspace>(prepared);
  const bool reset =
      std::any_of(x.in.model->events.begin(), x.in.model->events.end(), [](const Event& e) { return !e.set.empty(); });
  if (!reset) x.conserved = conserved(*x.scenario->mechanics);
}

// Routh's equations, those of the motion, and Maggi's if there are constraints to eliminate.
std::vector<const Formulation*> shown_forms(const Options& o, const Told& x) {
  const Mechanics& m = *x.scenario->mechanics;
  std::vector<const Formulation*> list;
  const auto add = [&](const Formulation* f) {
    if (f && obstacle(*f, m).empty() && std::find(list.begin(), list.end(), f) == list.end()) list.push_back(f);
  };
  for (const std::string& name : split(o.forms)) {
    Options one = o;
    one.motion.form = name;
    add(&form(one, *x.in.model, &m));
  }
  if (!list.empty()) return list;
  add(find_formulation("routh"));
  add(x.scenario->system.form);
  if (!m.phi.empty() && m.q.size() <= kMostRead) add(find_formulation("maggi"));
  return list;
}

// Equations longer than kLong are not printed on the page; the steps of the derivation are shown if the result is
// shorter than kShort.
constexpr std::size_t kLong = 40000, kShort = 6000, kMostArranged = 320;

std::size_t length(const Derivation& d) {
  std::size_t n = 0;
  for (const Line& l : d.equations) {
    if (l.left) n += print(*l.left, d.names, Format::text).size();
    n += print(l.right, d.names, Format::text).size();
  }
  return n;
}

// The number of nodes to arrange and to prove.
std::size_t nodes(const Mechanics& m, const Formulation& f, const Elimination& e) {
  const Equations raw = f.equations(m, e);
  Column all = raw.left;
  all.insert(all.end(), raw.right.begin(), raw.right.end());
  return reachable(all).size();
}

Derivation derived(const Mechanics& m, const Formulation& f, const Elimination& e, Arranger& arranger) {
  const auto in_parts = [&] {
    Arranger parts("parts");
    return derivation(m, f, e, parts, false);
  };
  if (nodes(m, f, e) > kMostArranged) return in_parts();
  Derivation d = derivation(m, f, e, arranger, false);
  const std::size_t n = length(d);
  if (n > kLong) return in_parts();
  return f.eliminates() && n < kShort ? derivation(m, f, e, arranger, true) : d;
}

std::string eliminated(const Elimination& e, const Model& model) {
  std::string list;
  for (std::size_t k : e.dependent) list += (list.empty() ? "" : ", ") + model.coordinates[k].name;
  return list.empty() ? "" : "The constraints are solved for derivatives of " + list + ".";
}

}  // namespace

void take_up(const Options& o, Told& x) {
  x.run = read_result(o.rows.empty() ? o.model : o.rows);
  if (x.run.table.rows() == 0) throw UsageError{"error: the run has no rows\n"};
  if (!o.rows.empty()) {
    x.in = read(o);
    if (x.run.units.empty()) x.run.units = column_units(*x.in.model);
    make_ready(with_form(o, x.in), x);
    return;
  }
  if (x.run.model.empty())
    throw UsageError{"error: '" + o.model + "' holds rows, but not their model\nhint: anholon report MODEL --rows " +
                     o.model + ", or a run in HDF5: anholon simulate MODEL -o run.h5\n"};
  const Options was = options_of(x.run, o);
  x.in = model_of(x.run, was);
  make_ready(was, x);
}

bool is_a_run(const std::string& path) { return format_of(path) && std::filesystem::exists(path); }

void check_page(const Options& o) {
  if (const std::string why = obstacle_to_writing(o.report); !why.empty()) throw UsageError{"error: " + why + "\n"};
}

void write_page(const Options& o, std::deque<Told>& cases) {
  Page page;
  Told& first = cases[0];
  const Model& model = *first.in.model;
  const Mechanics& m = *first.scenario->mechanics;
  std::deque<Explanation> explanations;
  for (Told& x : cases) {
    explanations.push_back(explain(*x.scenario));
    page.cases.push_back({x.name, x.scenario.get(), &explanations.back(), x.conserved, x.run});
  }
  // Equations and proof use the eliminations at the state of the run.
  const Options was = first.run.settings.empty() ? o : options_of(first.run, o);
  const StateChoice choice = state_choice(was, model);
  Arranger arranger("auto");
  std::map<Unknowns, Elimination> eliminations;
  std::size_t first_size = 0;
  for (const Formulation* f : shown_forms(o, first)) {
    if (!eliminations.count(f->unknowns)) eliminations.emplace(f->unknowns, elimination(first.in, m, *f, choice));
    const Elimination& e = eliminations.at(f->unknowns);
    const std::size_t size = nodes(m, *f, e);
    if (page.equations.empty())
      first_size = size;
    else if (size > kMostArranged && o.forms.empty())
      continue;  // it was not asked for, and is too long to read
    page.equations.push_back(derived(m, *f, e, arranger));
    page.eliminations.push_back(f->eliminates() ? eliminated(e, model) : "");
  }
  page.version = "anholon " ANHOLON_VERSION;
  page.model_hash = sha256_text(all_text(first.in.source));
  page.source = first.in.source;
  page.command = o.command_line;
  Proof proof;
  std::shared_ptr<const Model> fresh;  // the model of the proof
  if (o.no_proof || m.q.size() > kMostProved || first_size > kMostNodesProved) {
    page.no_proof = o.no_proof
                        ? "The proof was left out (--no-proof)."
                        : "For equations of this length a proof takes its time: anholon prove " + first.in.source.name;
  } else {
    std::vector<const Formulation*> forms;
    for (const Formulation* f : formulations())
      if (obstacle(*f, m).empty()) forms.push_back(f);
    // On a graph of its own: that of the motion and the printed equations has grown.
    fresh = clone(*first.in.model);
    const Mechanics own = mechanics(*fresh);
    const std::vector<Eliminations> offered = eliminations_of(first.in, own, choice);
    ProofOptions options;
    const bool terminal = isatty(STDERR_FILENO) != 0 && !o.quiet;
    std::size_t done = 0;
    if (terminal)
      options.progress = [&](const Formulation& f) {
        say(stderr, "\r\033[Kproof: %zu of %zu, %s", ++done, forms.size(), f.name);
      };
    proof = anholon::prove(own, forms, offered, options);
    if (terminal) say(stderr, "\r\033[K");
    const Certificate c = certificate(own, proof, offered.front(), page.version, page.model_hash);
    page.proof = &proof;
    page.hypotheses = c.hypotheses;
    page.meaning = c.meaning;
    // Checks the certificate like a recipient: from its text.
    page.certificate = to_json(c);
    const Verification checked = verify(read_certificate(page.certificate));
    page.claims = checked.claims.size();
    page.confirmed =
        static_cast<std::size_t>(std::count_if(checked.claims.begin(), checked.claims.end(),
                                               [](const ClaimFinding& f) { return f.finding == Finding::confirmed; }));
  }
  const std::string text = html(page);
  if (const std::string why = write_whole(o.report, text); !why.empty()) throw UsageError{"error: " + why + "\n"};
  if (!o.quiet) say(stderr, "page: %s, %.0f kB\n", o.report.c_str(), static_cast<double>(text.size()) / 1000);
}

int report(const Options& asked) {
  Options o = asked;
  o.report = o.output;
  o.output.clear();
  if (o.report.empty()) o.report = std::filesystem::path(o.model).stem().string() + ".html";
  check_page(o);
  std::deque<Told> cases;
  if (!o.rows.empty() || is_a_run(o.model)) {
    take_up(o, cases.emplace_back());
    write_page(o, cases);
    return kOk;
  }
  // Cases are shown side by side; `all` includes the file without a case.
  std::vector<std::string> names = o.cases;
  if (names == std::vector<std::string>{"all"}) {
    Options plain = o;
    plain.cases.clear();
    names = read(plain).model->cases;
    names.insert(names.begin(), "");
  }
  if (names.empty()) names = {""};
  int code = kOk;
  for (const std::string& name : names) {
    Options one = o;
    one.cases = name.empty() ? std::vector<std::string>{} : std::vector<std::string>{name};
    Told& x = cases.emplace_back();
    x.name = name;
    code = std::max(code, simulate_motion(one, nullptr, &x));
    if (x.run.table.rows() == 0) cases.pop_back();
  }
  if (!cases.empty()) write_page(o, cases);
  return code;
}

}  // namespace anholon::cli
