#include "api/sweep_request.h"

#include <algorithm>

#include "ensemble/request.h"
#include "ensemble/with_contacts.h"
#include "result/choose_columns.h"

namespace anholon::v1 {

namespace {

[[noreturn]] void refuse(const inner::MistakeInWord& m, const char* option) {
  throw inner::Failure({}, std::string(option) + " " + m.word + ": " + m.diagnostic.message, m.diagnostic.hint);
}

inner::Variation::Draws draws_of(const std::string& name) {
  if (name == "random") return inner::Variation::Draws::random;
  if (name == "sobol") return inner::Variation::Draws::sobol;
  const std::string near = inner::did_you_mean(name, {"random", "sobol"});
  throw inner::Failure({}, "draw cannot be '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                       "random or sobol");
}

// What varies, from the options. Throws Failure.
inner::Variation variation_of(const SweepOptions& asked, const inner::Model& model) {
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
  } catch (const inner::MistakeInWord& m) {
    refuse(m, "vary");
  }
  v.finish(asked.cases, "SweepOptions::cases");
  return v;
}

// The model with the formulas of the reductions. Throws Failure.
inner::Outcome scenario_with(const System::Data& of, const std::vector<std::string>& words,
                             inner::Reductions& reductions, inner::Scenario& scenario) {
  inner::Diagnostics diagnostics;
  const auto open = of.model->open_again(diagnostics);
  if (!open) throw inner::Failure(diagnostics.list().front());
  try {
    for (const std::string& word : words) reductions.add(word, *open);
  } catch (const inner::MistakeInWord& m) {
    refuse(m, "reduce");
  }
  inner::Outcome start = make_system(open->model, of.scenario.system.form->name, of.choice, scenario);
  if (start.ok()) reductions.move_to(scenario);
  return start;
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

PreparedSweep::PreparedSweep(const System::Data& of, const SweepOptions& asked) {
  if (!asked.reduce.empty()) start = scenario_with(of, asked.reduce, options.reductions, with_formulas);
  if (!start.ok()) return;
  scenario = asked.reduce.empty() ? &of.scenario : &with_formulas;
  options.state = of.choice;
  variation.emplace(variation_of(asked, *scenario->model));
  must_not_be_given(variation->varied(), options.state);
  options.varied = variation->varied();
  options.cases = variation->cases();
  options.numbers = [this](std::size_t number) { return inner::EnsembleCase{(*variation)(number), {}}; };
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
  move_with(of.model->contacts, options);
}

}  // namespace anholon::v1
