// Uses every part of the installed library and prints the results.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <anholon/anholon.h>

namespace {

int failures = 0;

void expect(bool holds, const char* what) {
  if (holds) return;
  std::printf("NOT: %s\n", what);
  ++failures;
}

constexpr const char* kPendulum = R"toml(
title = "pendulum"
coordinates = ["theta"]
parameters = {m = 1, l = "9.81/4"}
[[particle]]
name = "bob"
mass = "m"
position = ["l*sin(theta)", "-l*cos(theta)", 0]
[gravity]
field = [0, "-9.81", 0]
[initial]
theta = 0.1
"theta'" = 0
[simulate]
to = 2
)toml";

void mistakes() {
  const auto none = anholon::read_text("title = 3", {}, "bad.toml");
  expect(!none && !none.error().diagnostics.empty(), "a mistake is a diagnostic");
  expect(!none && none.error().diagnostics[0].file == "bad.toml", "it names its file");
  expect(none.text().find("bad.toml:1") != std::string::npos, "its text has the place");
  const auto model = anholon::read_text(kPendulum);
  anholon::PrepareOptions wrong;
  wrong.initial.emplace("thetta", 1.0);
  const auto system = anholon::prepare(*model, wrong);
  expect(!system && system.text().find("did you mean 'theta'") != std::string::npos, "a slip has a suggestion");
}

void motion(const anholon::System& system) {
  anholon::MotionOptions options;
  options.every = 0.25;
  const auto run = anholon::simulate(system, options);
  expect(bool(run), "the motion is computed");
  if (!run) return;
  expect(run->outcome().ok(), "it finishes");
  expect(run->rows() == 9 && run->t().back() == 2, "its rows are those that were asked for");
  expect(std::abs(run->column("theta").back() - 0.1 * std::cos(4.0)) < 1e-3, "theta = 0.1 cos 2t, nearly");
  expect(run->column("no such").empty(), "an unknown column is empty");
  expect(run->block().size() == run->columns().size() * run->rows() &&
             run->block().data() + run->rows() == run->column("theta").data(),
         "the columns lie side by side");
  expect(run->columns()[2].latex == "\\dot{\\theta}" && anholon::symbol("theta'").latex == "\\dot{\\theta}",
         "a column has a symbol");
  const auto picture = anholon::picture_data(*run);
  expect(picture && picture->find("\"scene\": {") != std::string::npos, "the viewer gets a scene");
  const auto drawn = anholon::figure(*run, {{"theta"}});
  expect(drawn && drawn->find("<svg") == 0, "a figure is an SVG");
  expect(!anholon::figure(*run, {{"tehta"}}), "an unknown column is not drawn");
  expect(run->report().newton < 1e-12, "Newton's law holds");
  expect(!run->report().trust.empty() && run->report().trust[0].digits > 8, "digits can be trusted");
  std::size_t asked = 0;
  options.cancelled = [&asked] { return ++asked > 3; };
  const auto stopped = anholon::simulate(system, options);
  expect(stopped && stopped->outcome().kind == anholon::OutcomeKind::interrupted && stopped->rows() > 0,
         "a cancelled motion keeps its rows");

  // Options that have no member are set by their names.
  anholon::MotionOptions wide;
  wide.at = {1};
  wide.others = {{"numbers", "quad"}};
  const auto quad = anholon::simulate(system, wide);
  expect(quad && quad->text(0, "theta").size() > 25, "quad gives more digits");
  wide.others = {{"numbres", "quad"}};
  const auto unknown = anholon::simulate(system, wide);
  expect(!unknown && unknown.error().text.find("did you mean 'numbers'") != std::string::npos, "a wrong name is told");

  anholon::MotionOptions beyond;
  beyond.to = 2;
  beyond.at = {0.5, 3};
  const auto refused = anholon::simulate(system, beyond);
  expect(!refused && refused.error().text.find("the time 3 lies beyond the end, t = 2") != std::string::npos,
         "rows beyond the end are refused");
  beyond.at.clear();
  expect(bool(anholon::simulate(system, beyond)), "an end alone is not");

  // Two threads that use one system get the bits of one thread.
  std::vector<double> first, second;
  const auto go = [&system](std::vector<double>& to) {
    const auto r = anholon::simulate(system);
    to.assign(r->column("theta").begin(), r->column("theta").end());
  };
  std::thread one([&] { go(first); }), two([&] { go(second); });
  one.join(), two.join();
  expect(!first.empty() && first == second, "two threads get the same bits");
}

void sweep(const anholon::System& system) {
  anholon::SweepOptions options;
  options.vary = {{"m", {1, 2}}, {"theta'", anholon::linspace(0, 1, 5)}};
  const auto all = anholon::sweep(system, options);
  expect(bool(all), "the sweep is computed");
  if (!all) return;
  expect(all->cases() == 10 && all->finished() == 10, "all cases finish");
  expect(all->varied("theta'").size() == 10 && all->varied("m")[5] == 2, "the last one varies fastest");
  expect(all->varied("theta'")[4] == 1 && all->column("theta'")[4] != 1,
         "a velocity at the end is not that at the start");
  expect(all->column("theta")[0] == all->column("theta")[5], "the mass of a pendulum has no influence");

  options.at = {0.5, 1};
  options.reduce = {"max(theta)"};
  options.columns = {"theta", "max*"};
  const auto rows = anholon::sweep(system, options);
  expect(rows && rows->times().size() == 2 && rows->columns().size() == 2, "columns and times are chosen");
  if (!rows) return;
  expect(rows->rows("theta").size() == 20 && rows->rows("theta")[1] == rows->column("theta")[0],
         "the last row is the end");
  expect(rows->column("max(theta)")[3] >= rows->rows("theta")[6] && rows->rows("max(theta)").empty(),
         "an extreme is one number for each case");
  expect(!rows->write("sweep.txt"), "a sweep is written in the formats that hold sweeps");
  const auto map = anholon::figure(*all), other_map = anholon::figure(*all, {.columns = {"theta"}});
  expect(map && other_map && map->starts_with("<svg") && *map != *other_map, "maps over the two numbers that vary");
  expect(!anholon::figure(*all, {.columns = {"thet"}}), "a figure names its columns");

  options.at = {}, options.reduce = {}, options.columns = {};
  options.vary = {{"m", {}, "uniform(1,2)"}};
  const auto endless = anholon::sweep(system, options);
  expect(!endless && endless.error().text.find("how many cases") != std::string::npos, "random values want a number");
  options.cases = 5;
  const auto drawn = anholon::sweep(system, options), again = anholon::sweep(system, options);
  expect(drawn && again && drawn->cases() == 5, "random cases are computed");
  if (!drawn || !again) return;
  for (std::size_t k = 0; k < 5; ++k)
    expect(drawn->varied("m")[k] > 1 && drawn->varied("m")[k] < 2 && drawn->varied("m")[k] == again->varied("m")[k],
           "a draw follows from seed and number");
  options.seed = 1;
  const auto other = anholon::sweep(system, options);
  expect(other && other->varied("m")[0] != drawn->varied("m")[0], "another seed draws other values");
}

// A sweep over scenarios of a model has the numbers of each scenario alone, in memory and in a folder.
void sweep_over_scenarios() {
  const std::string text = std::string(kPendulum) + "[case.long]\nparameters.l = 4\n[case.late]\nsimulate.to = 3\n";
  const auto model = anholon::read_text(text);
  if (!model) return expect(false, "a model with scenarios is read");
  anholon::SweepOptions options;
  options.vary = {{"theta", {0.1, 0.2}}, {"case", {"long", "late"}}};
  const auto all = anholon::sweep(*model, options);
  expect(all && all->cases() == 4 && all->finished() == 4, "each scenario has all cases of the others");
  if (!all) return (void)std::printf("%s", all.text().c_str());
  expect(all->scenarios() == std::vector<std::string>{"long", "late"} && all->scenario(1) == "long" &&
             all->scenario(2) == "late" && all->varied("case").empty(),
         "scenarios vary slowest, and have names");
  expect(all->varied("theta")[3] == 0.2 && all->t()[1] == 2 && all->t()[2] == 3, "a scenario has an end of its own");
  const auto late = anholon::prepare(*anholon::read_text(text, {.cases = {"late"}}));
  const auto alone = anholon::sweep(*late, {.vary = {{"theta", {0.1, 0.2}}}});
  expect(alone && alone->column("theta")[0] == all->column("theta")[2] &&
             alone->column("theta")[1] == all->column("theta")[3],
         "the numbers are those of the scenario alone");

  char name[] = "/tmp/anholon-outside-XXXXXX";
  if (!mkdtemp(name)) return expect(false, "a folder is made");
  const std::string path = std::string(name) + "/falls";
  const auto folder = anholon::sweep_into(*model, options, path, 3);
  expect(folder && folder->cases() == 4 && folder->parts() == 2 && folder->columns()[1] == "case_name",
         "a folder holds the scenarios");
  if (!folder) return (void)std::printf("%s", folder.text().c_str());
  const auto done = folder->fill({.threads = 1});
  expect(done && done->complete && done->cases == 4, "a part may hold cases of two scenarios");
  const auto read = folder->read({"case_name", "theta"});
  const auto* words = read ? std::get_if<anholon::FolderColumn::Words>(&(*read)[0].values) : nullptr;
  const auto* theta = read ? std::get_if<std::vector<double>>(&(*read)[1].values) : nullptr;
  expect(words && words->different == all->scenarios() && words->rows == std::vector<std::uint32_t>{0, 0, 1, 1},
         "the folder names the scenarios");
  expect(theta && std::equal(theta->begin(), theta->end(), all->column("theta").begin(), all->column("theta").end()),
         "the folder has the numbers of the sweep in memory");
  const auto drawn = anholon::figure(*folder, {.columns = {"theta"}});
  expect(drawn && drawn->starts_with("<svg") && !anholon::figure(*folder, {.columns = {"thet"}}), "a folder is drawn");
  expect(folder->points().at("theta(0)") == std::vector<double>{0.1, 0.2}, "a folder tells the points of its grid");
  const auto numbers = folder->numbers(2);
  expect(numbers && numbers->size() == 2 && (*numbers)[0].second == "late" && (*numbers)[1].second == "1/10",
         "a case tells its scenario");
  const auto refined = folder->refine();
  expect(!refined && refined.text().find("no grid") != std::string::npos, "several scenarios are no grid");
  const std::string file = std::string(name) + "/falls.csv";
  const auto written = all->write(file);
  expect(written && *written == file && std::filesystem::file_size(file) > 100, "a sweep in memory is written");
  std::filesystem::remove_all(name);

  const auto error_of = [&](std::vector<anholon::Vary> vary) {
    options.vary = std::move(vary);
    return anholon::sweep(*model, options).text();
  };
  expect(error_of({{"case", {"lng"}}}).find("did you mean 'long'") != std::string::npos, "a slip has a suggestion");
  expect(error_of({{"case", {"long", "long"}}}).find("twice") != std::string::npos, "a scenario is named once");
  options.vary = {{"case", {"long"}}};
  expect(anholon::sweep(*late, options).text().find("sweep(model, …)") != std::string::npos,
         "a system has one scenario");
}

void analysis(const anholon::Model& model, const anholon::System& system) {
  const auto compared = anholon::compare(model, "a: l*theta'' = -9.81*sin(theta)\nb: l*theta'' = 9.81*sin(theta)\n");
  expect(compared && compared->size() == 2 && (*compared)[0].verdict == anholon::Verdict::proved,
         "a published equation is proved");
  expect(compared && (*compared)[1].verdict == anholon::Verdict::refuted && !(*compared)[1].suggestions.empty(),
         "a misprint is found");
  const auto wrong = anholon::compare(model, "a: k = 0");
  expect(!wrong && wrong.error().diagnostics.at(0).line == 1, "a mistake in an equation has its line");
  const auto state = anholon::evaluate(system, 30);
  expect(state && state->derivatives.at(0).name == "theta''" && state->derivatives[0].text.size() > 30,
         "a state is evaluated with 30 digits");
  const auto rest = anholon::linearize(model, {.equilibrium = true, .digits = 30});
  expect(rest && rest->motion == anholon::Steadiness::equilibrium && rest->A.texts.size() == 4,
         "the equilibrium is found, and linearized with 30 digits");
  const auto stable = anholon::stability(model, "l", {1, 2, 3}, {.initial = {{"theta", 0}, {"theta'", 0}}});
  expect(stable && stable->curves.size() == 2 && stable->curves[0].size() == 3 && stable->crossings.empty() &&
             std::abs(stable->curves[0][0].imag()) > 3,
         "eigenvalues over a parameter");
  if (!stable) std::printf("%s", stable.text().c_str());
}

}  // namespace

int main() {
  std::printf("anholon %s, %zu shipped models\n", anholon::version(), anholon::shipped_models().size());
  mistakes();
  const auto model = anholon::read_text(kPendulum);
  expect(bool(model), "the model is read");
  if (!model) return std::printf("%s", model.text().c_str()), 1;
  expect(model->parameters()[1].value == 9.81 / 4, "a parameter has its value");
  const auto equations = anholon::derive(*model, {.form = "lagrange-type"});
  expect(equations && equations->text.find("theta''") != std::string::npos, "equations are derived");
  if (!equations) std::printf("%s", equations.text().c_str());
  const auto proof = anholon::prove(*model);
  expect(proof && proof->all_proved(), "all forms are proved equal");
  for (const std::size_t after : {std::size_t{0}, std::size_t{200}}) {
    std::size_t looks = 0;
    const anholon::StopRequest request([&] { return looks++ >= after; });
    const auto stopped = anholon::prove(*model);
    // A request that comes before the proof begins leaves no proof at all.
    expect(stopped ? stopped->stopped && !stopped->all_proved() && stopped->certificate.empty()
                   : stopped.error().outcome && stopped.error().outcome->kind == anholon::OutcomeKind::interrupted,
           "a stopped proof says so");
    const auto derived = anholon::derive(*model);
    expect(!derived && derived.error().outcome && derived.error().outcome->kind == anholon::OutcomeKind::interrupted,
           "a stopped derivation is an outcome");
  }
  expect(bool(anholon::derive(*model)), "the request ends with its block");
  const auto verified = anholon::verify(proof->certificate);
  expect(verified && verified->all_confirmed() && verified->claims > 0, "the certificate is confirmed");
  const auto system = anholon::prepare(*model);
  expect(bool(system), "the system is prepared");
  if (!system) return std::printf("%s", system.text().c_str()), 1;
  expect(system->degrees_of_freedom() == 1, "it has one degree of freedom");
  motion(*system);
  sweep(*system);
  sweep_over_scenarios();
  const auto source = anholon::program_text(*system, anholon::Language::c);
  expect(source && source->find("#include <math.h>") != std::string::npos, "the motion is written as a program");
  const auto disc = anholon::read_file("disc");
  expect(bool(disc), "a shipped model is found");
  const auto f = anholon::dynamics(*system), rolling = anholon::dynamics(*anholon::prepare(*disc));
  expect(f && !f->minimal() && f->obstacle().find("no constraints") != std::string::npos && rolling &&
             rolling->minimal() && rolling->obstacle().empty(),
         "a function tells why its velocities are not independent ones");
  const auto rest = anholon::prepare(*anholon::read_text(kPendulum), {.initial = {{"theta", 0}}});
  const auto linear = anholon::linearize(*rest);
  expect(linear && linear->eigenvalues.size() == 2 && std::abs(std::abs(linear->eigenvalues[0].imag()) - 2) < 1e-12,
         "the pendulum at rest has the frequency 2");
  analysis(*model, *system);
  std::printf("%d failures\n", failures);
  return failures == 0 ? 0 : 1;
}
