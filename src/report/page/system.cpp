#include <algorithm>

#include "modelfile/names/declared_unit.h"
#include "motion/start.h"
#include "numeric/number.h"
#include "print/print_names.h"
#include "report/markup.h"
#include "report/math_lines.h"
#include "report/page/sections.h"
#include "report/words.h"

namespace anholon {

namespace {

// Bodies, constraints, parameters and initial data in tables.
class SystemSection {
 public:
  explicit SystemSection(const Page& page) : p_(page), model_(*page.cases[0].scenario->model) {}

  std::string write() const {
    const Scenario& s = *p_.cases[0].scenario;
    std::string out = "<p>" + std::to_string(s.structure.degrees_of_freedom) +
                      (s.structure.degrees_of_freedom == 1 ? " degree" : " degrees") +
                      " of freedom, configurations of " + std::to_string(s.structure.configuration_dimension) +
                      (s.structure.configuration_dimension == 1 ? " dimension, " : " dimensions, ") + "a state of " +
                      std::to_string(s.structure.state_dimension) + ".";
    for (const std::string& e : effects(model_)) out += " " + user(sentence(e));
    out += "</p>\n" + bodies() + constraints() + parameters();
    for (const PageCase& c : p_.cases) out += initial_data(c);
    return out;
  }

 private:
  std::string name_math(const std::string& name, unsigned order = 0) const {
    const auto chosen = model_.names.notation.find(name);
    return math(derivative_name(chosen == model_.names.notation.end() ? mathml_name(name) : chosen->second.mathml,
                                order, Format::mathml));
  }

  std::string bodies() const {
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMost = 40;
    for (std::size_t k = 0; k < std::min(model_.bodies.size(), kMost); ++k) {
      const Body& b = model_.bodies[k];
      rows.push_back({user(b.name),
                      b.particle ? "particle"
                      : b.shape  ? markup_escape(b.shape->kind)
                                 : "body",
                      wrapping_math(print(put_masses(model_, b.mass), model_.names, Format::mathml)),
                      b.expelled_velocity ? "expels or collects matter" : ""});
    }
    return table("Bodies", {"", "kind", "mass", ""}, rows);
  }

  std::string constraints() const {
    const Scenario& s = *p_.cases[0].scenario;
    constexpr std::size_t kLongestPower = 80, kMost = 60;
    std::vector<std::vector<std::string>> rows;
    for (std::size_t r = 0; r < std::min(model_.constraints.size(), kMost); ++r) {
      const Constraint& c = model_.constraints[r];
      std::string kind = description(s.classes[r], c.order);
      if (s.classes[r].redundant) kind += "; redundant here";
      const std::string reaction = c.by ? "kept by the input " + model_.controls[*c.by].name
                                        : std::string(in_words(p_.cases[0].facts[r].hypothesis));
      rows.push_back({user(c.name), "<code>" + user(c.equation) + "</code>", markup_escape(kind),
                      markup_escape(work(s, p_.cases[0].facts[r], r, kLongestPower)), markup_escape(reaction)});
    }
    return table("Constraints", {"", "as written", "kind", "its reaction", "hypothesis"}, rows);
  }

  std::string parameters() const {
    const std::vector<double> values = parameters_as_given(model_);
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMost = 80;
    for (std::size_t k = 0; k < std::min(values.size(), kMost); ++k) {
      const std::string unit = unit_of_parameter(model_, k);
      rows.push_back({math(print(model_.graph->parameter(static_cast<std::uint32_t>(k)), model_.names, Format::mathml)),
                      markup_escape(number_text(values[k])), user(unit), user(model_.parameters[k].doc)});
    }
    return table("Parameters", {"", "value", "unit", ""}, rows);
  }

  std::string initial_data(const PageCase& c) const {
    const InitialState<double> x = start_as_in_rows(*c.scenario);
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMost = 60;
    for (std::size_t a = 0; a < std::min(x.q.size(), kMost); ++a)
      rows.push_back({name_math(model_.coordinates[a].name), markup_escape(number_text(x.q[a])), name(x.q_origin[a]),
                      name_math(model_.coordinates[a].name, 1), markup_escape(number_text(x.qd[a])),
                      name(x.qd_origin[a])});
    for (const StateEntry& e : higher_state(*c.scenario))
      rows.push_back({user(e.name), markup_escape(number_text(e.value)), name(e.origin), "", "", ""});
    return table("Initial data at t = " + number_text(x.t) + (c.name.empty() ? "" : ", " + c.name),
                 {"", "position", "", "", "velocity", ""}, rows);
  }

  const Page& p_;
  const Model& model_;
};

}  // namespace

std::string system_section(const Page& page) { return SystemSection(page).write(); }

}  // namespace anholon
