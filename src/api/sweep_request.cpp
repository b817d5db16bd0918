#include "api/sweep_request.h"

#include <algorithm>

#include "ensemble/case_scenario.h"
#include "ensemble/parts/scenarios.h"
#include "ensemble/request.h"
#include "ensemble/with_contacts.h"
#include "model/exponents.h"
#include "result/choose_columns.h"

namespace anholon::v1 {

namespace {

constexpr const char* kScenarios = "case";  // the name of a Vary that runs through scenarios

[[noreturn]] void refuse(const inner::MistakeInWord& m, const char* option) {
  // A mistake in a table has the line of the table.
  if (!m.file.empty())
    throw inner::Failure({}, m.file + ", line " + std::to_string(m.diagnostic.span.line) + ": " + m.diagnostic.message,
                         m.diagnostic.hint);
  throw inner::Failure({}, std::string(option) + " " + m.word + ": " + m.diagnostic.message, m.diagnostic.hint);
}

inner::Variation::Draws draws_of(const std::string& name) {
  if (name == "random") return inner::Variation::Draws::random;
  if (name == "sobol") return inner::Variation::Draws::sobol;
  const std::string near = inner::did_you_mean(name, {"random", "sobol"});
  throw inner::Failure({}, "draw cannot be '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                       "random or sobol");
}

// Returns the variation that the options ask for; if scenarios vary (`of_scenario`), nothing else has to. Throws
// Failure.
inner::Variation variation_of(const SweepOptions& asked, const inner::Model& model, bool of_scenario) {
  inner::Variation v(asked.seed, draws_of(asked.draw));
  if (asked.together) v.together();
  try {
    for (const Vary& each : asked.vary) {
      if (!each.law.empty()) {
        v.add(text_of(each), model);
        continue;
      }
      std::vector<inner::Constant> values;
      for (const Number& n : each.values) values.push_back(constant(n, each.name));
      v.add(each.name, values, model);
    }
    if (!asked.table.empty()) v.add(std::make_shared<const inner::CaseTable>(asked.table, asked.table_name), model);
  } catch (const inner::MistakeInWord& m) {
    refuse(m, "vary");
  }
  if (of_scenario && v.varied().empty() && !asked.cases)
    v.finish_with_one();
  else
    v.finish(asked.cases, "cases");
  return v;
}

// Removes the scenarios that vary from the options and returns their names.
std::vector<std::string> take_scenarios(SweepOptions& asked) {
  std::vector<std::string> names;
  const auto removed = std::erase_if(asked.vary, [&](const Vary& v) {
    if (v.name != kScenarios) return false;
    if (!v.law.empty())
      throw inner::Failure({}, "vary case: scenarios have names, and '" + v.law + "' is a law of numbers",
                           "a list of the names of sections [case.NAME]");
    for (const Number& name : v.values) names.push_back(name.text());
    return true;
  });
  if (removed > 0) inner::must_name_each_once(names, "vary");
  if (removed > 0 && asked.together)
    throw inner::Failure({}, "scenarios do not go together with values: each has all cases of a table",
                         "leave out 'together', or make a sweep of each case");
  return names;
}

// Throws Failure if scenarios of a file are to vary in a system, which is already read with its scenario.
void must_not_vary_scenarios(const SweepOptions& asked, const inner::Model& model) {
  const auto named = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& each) { return each.name == kScenarios; });
  };
  if (named(asked.vary) && !named(model.parameters) && !named(model.coordinates))
    throw inner::Failure({}, "vary case: a system is that of one scenario",
                         "sweep(model, …) runs through the scenarios of a model");
}

}  // namespace

std::string text_of(const Vary& v) {
  const bool grid = v.law.find(':') != std::string::npos;
  if (!v.law.empty()) return v.name + (grid ? "=" : "~") + v.law;
  std::string text = v.name + "=";
  for (std::size_t k = 0; k < v.values.size(); ++k) text += (k == 0 ? "" : ",") + v.values[k].text();
  return text;
}

std::vector<std::size_t> chosen_places(const std::vector<std::string>& asked, const std::vector<std::string>& all) {
  std::vector<std::size_t> places;
  if (asked.empty()) {
    for (std::size_t k = 0; k < all.size(); ++k) places.push_back(k);
    return places;
  }
  places = inner::chosen_columns(all, asked);
  std::sort(places.begin(), places.end());
  return places;
}

PreparedPiece::PreparedPiece(System of, const inner::Outcome& of_system, std::string scenario_name,
                             const SweepOptions& asked)
    : system(std::move(of)), word(std::move(scenario_name)) {
  options.state = system.data().choice;
  variation.emplace(variation_of(asked, *system.data().model->model, !word.empty()));
  std::vector<std::string> chosen;
  for (const std::string& mode : system.data().model->mode)
    chosen.push_back(inner::normal_name(mode.substr(0, mode.find('='))));
  must_not_be_given(variation->varied(), options.state, chosen);
  options.varied = variation->varied();
  options.state.open_parameters = inner::varied_parameters(options);
  scenario = scenario_for(asked.reduce, of_system);
  options.cases = variation->cases();
  options.numbers = [this](std::size_t number) { return inner::EnsembleCase{(*variation)(number), {}}; };
  const Model::Data& model = *system.data().model;
  switch_with(open_ ? contacts(*open_->names) : model.contacts_of_file, open_ ? *open_->model : *model.model, options);
  if (!own_start_.ok()) scenario_of_cases(options, own_);
  const auto set = [&](const char* name, const std::vector<std::string>& words) {
    const inner::MotionOption& option = inner::motion_option(name);
    inner::set(settings, option, words, name,
               [&](const std::string& text) { return option_value(Number(text), option); });
  };
  if (asked.to) set("to", {asked.to->text()});
  if (asked.tolerance) set("tolerance", {asked.tolerance->text()});
  std::vector<std::string> times;
  for (const Number& t : asked.at) times.push_back(t.text());
  if (!times.empty()) set("at", times);
  settings.error_estimate = "never";
  inner::ask(settings, *scenario, {"", "", [](const std::string&) {}}, options);
  options.threads = asked.threads;
  options.identities = model.identities;
  move_with(moving(), *scenario, options);
}

// Returns the contacts of the model in whose graph the formulas are; empty if a mode is chosen.
const std::vector<inner::Contact>& PreparedPiece::moving() const {
  const std::vector<inner::Contact>& of_model = system.data().model->contacts;
  return open_ && !of_model.empty() ? contacts(*open_->names) : of_model;
}

// Returns the scenario of the system, or one of this piece that has the formulas of the reductions or another start.
const inner::Scenario* PreparedPiece::scenario_for(const std::vector<std::string>& reductions,
                                                   const inner::Outcome& of_system) {
  const System::Data& of = system.data();
  const bool exponents_vary =
      !inner::exponents_of(*inner::clone(*of.model->model), *options.state.open_parameters).empty();
  if (reductions.empty() && of_system.ok() && !exponents_vary) return &of.scenario;
  inner::Diagnostics diagnostics;
  open_ = of.model->open_again(diagnostics);
  if (!open_) throw inner::Failure(diagnostics.list().front());
  try {
    for (const std::string& reduction : reductions) options.reductions.add(reduction, *open_, moving());
  } catch (const inner::MistakeInWord& m) {
    refuse(m, "reduce");
  }
  own_start_ = make_system(open_->model, of.scenario.system.form->name, options.state, own_);
  return &own_;
}

Result<std::shared_ptr<const PreparedSweep>> prepared_sweep(const System& system, const SweepOptions& asked) {
  const System::Data& of = system.data();
  using Prepared = Result<std::shared_ptr<const PreparedSweep>>;
  return guarded(of.model->source, [&]() -> Prepared {
    must_not_vary_scenarios(asked, *of.scenario.model);
    auto sweep = std::make_shared<PreparedSweep>();
    sweep->model = of.model, sweep->asked = asked;
    const PreparedPiece& piece = sweep->pieces.emplace_back(system, inner::Outcome{}, std::string(), asked);
    sweep->cases = piece.options.cases;
    return Prepared(std::move(sweep));
  });
}

Result<std::shared_ptr<const PreparedSweep>> prepared_sweep(const Model& model, const PrepareOptions& prepare,
                                                            const SweepOptions& asked) {
  using Prepared = Result<std::shared_ptr<const PreparedSweep>>;
  return guarded(model.data().source, [&]() -> Prepared {
    auto sweep = std::make_shared<PreparedSweep>();
    sweep->model = std::make_shared<const Model::Data>(model.data());
    sweep->asked = asked;
    sweep->scenarios = take_scenarios(sweep->asked);
    for (std::size_t k = 0; k < std::max<std::size_t>(sweep->scenarios.size(), 1); ++k) {
      const std::string scenario = sweep->scenarios.empty() ? std::string() : sweep->scenarios[k];
      const Result<Model> read = scenario.empty() ? model : with_scenario(model, scenario);
      if (!read) return read.error();
      inner::Outcome start;
      System system(system_of(*read, prepare, start));
      const PreparedPiece& piece = sweep->pieces.emplace_back(std::move(system), start, scenario, sweep->asked);
      sweep->cases += piece.options.cases;
    }
    return Prepared(std::move(sweep));
  });
}

TabledPieces::TabledPieces(const PreparedSweep& sweep) {
  for (const PreparedPiece& piece : sweep.pieces) {
    inner::SweepTable& table = tables.emplace_back(*piece.scenario->model, piece.options);
    if (!sweep.asked.columns.empty()) {
      std::vector<std::string> all;
      for (const inner::SweepColumn& c : table.available()) all.push_back(c.name);
      table.choose(inner::chosen_columns(all, sweep.asked.columns));
    }
    if (!piece.word.empty()) table.add_word("case_name");
    table.must_tell_columns_apart();
    must_have_columns_of(tables.front(), sweep.pieces.front().word, table, piece.word, "choose columns that both have");
    pieces.push_back({piece.scenario, &options.emplace_back(piece.options), &table, piece.word});
  }
}

}  // namespace anholon::v1
