#include "cli/pictures/sweep_motions.h"

#include <cmath>

#include "api/run_data.h"
#include "api/sweep_case.h"
#include "base/json.h"
#include "cli/motions/progress.h"
#include "cli/say.h"
#include "cli/stop.h"
#include "report/page/data.h"

namespace anholon::cli {

namespace {

constexpr int kRows = 300;  // of a motion, besides those of its events

// Returns the numbers of at most `most` cases, spread over the map; cases without a place in the map are left out.
std::vector<std::size_t> chosen_cases(const std::vector<MappedCase>& cases, std::size_t most) {
  std::vector<plot::SpreadCase> places;
  std::vector<std::size_t> numbers, chosen;
  for (const MappedCase& c : cases) {
    if (!std::isfinite(c.place.at.x) || !std::isfinite(c.place.at.y)) continue;
    places.push_back(c.place);
    numbers.push_back(c.number);
  }
  for (const std::size_t k : plot::spread(places, most)) chosen.push_back(numbers[k]);
  return chosen;
}

std::string in_words(const v1::Outcome& outcome) {
  if (outcome.kind == v1::OutcomeKind::finished) return {};
  const std::string text = outcome.message.empty() ? v1::name(outcome.kind) : outcome.message;
  return outcome.hint.empty() ? text : text + " " + outcome.hint;
}

// Returns the reason why there is no motion.
std::string in_words(const v1::Error& error) {
  if (!error.diagnostics.empty()) return error.diagnostics.front().message;
  return error.outcome ? error.outcome->message : error.text;
}

v1::Result<v1::Run> motion(const SweepStore& store, std::size_t number) {
  const v1::Result<v1::System> system = v1::system_of_case(store, number);
  if (!system) return system.error();
  v1::MotionOptions options = v1::with_intervals(*system, v1::options_of_case(store, {}), kRows - 1);
  options.cancelled = stop_requested;
  options.error_estimate = false;
  return v1::simulate(*system, options);
}

std::string brief_data(const v1::Run& run) {
  Workspace workspace(run.data().system.data().scenario);
  Page page;
  page.cases.push_back({"", &workspace, {}, {}, run.data().run});
  page.source = workspace.model->source_text;
  return brief_page_data(page);
}

}  // namespace

HeldMotions held_motions(const PlotCommand& o, const std::vector<MappedCase>& mapped) {
  if (!SweepStore::is_there(o.run))
    throw UsageError{
        "error: --motions: " + o.run +
        " does not tell the model of the sweep\nhint: a sweep in a folder does: anholon sweep MODEL --vary … "
        "-o falls/\n"};
  const SweepStore store = v1::opened_to_read(o.run);
  const std::vector<std::size_t> cases = chosen_cases(mapped, static_cast<std::size_t>(o.motions));
  catch_stop(o.output);
  HeldMotions held;
  std::string why;
  Progress progress(false, "case", "cases");
  for (std::size_t k = 0; k < cases.size(); ++k) {
    progress(static_cast<double>(k) / static_cast<double>(cases.size()), static_cast<double>(cases[k]), k);
    const v1::Result<v1::Run> run = motion(store, cases[k]);
    if (stop_requested()) {
      held.stopped = true;
      return held;
    }
    if (!run || run->rows() == 0) {
      why = run ? "it has no rows" : in_words(run.error());
      say(stderr, "note: case %zu has no motion in the page: %s\n", cases[k], why.c_str());
      continue;
    }
    JsonWriter json;
    json.open_object().key("number").integer(static_cast<long long>(cases[k]));
    json.key("outcome").string(in_words(run->outcome())).close();
    std::string one = json.text();
    one.resize(one.rfind('}'));
    held.data += (held.count == 0 ? "[" : ",\n") + one + ", \"data\": " + brief_data(*run) + "}";
    ++held.count;
  }
  if (held.count == 0) throw UsageError{"error: --motions: no case has a motion: " + why + "\n"};
  held.data += "]";
  return held;
}

}  // namespace anholon::cli
