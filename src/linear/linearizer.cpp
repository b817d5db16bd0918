#include "linear/linearizer.h"

#include "linear/steadiness.h"
#include "linear/steady_elimination.h"
#include "model/formula_of_slot.h"
#include "numeric/more_digits.h"

namespace anholon {

Linearizer::Linearizer(Workspace& scenario, const StateChoice& choice, Signals signals)
    : choice_(choice), equations_(scenario, std::move(signals)), mass_(mass_matrix(*scenario.mechanics)) {}

static std::string text_of(const Branch& b, const SymbolNames& names) {
  const std::string condition = print(b.condition, names, Format::text);
  return b.table.empty() ? "where " + condition + " passes 0"
                         : "where " + condition + " passes a knot of the table '" + b.table + "'";
}

Outcome Linearizer::look_for_kinks(const LinearPoint& point, const std::vector<Multi>& parameters,
                                   std::vector<std::string>& rough) const {
  const Multi part = round_off(kZeroPart), near = part * (Multi(1) + largest(point.x));
  const std::size_t rows = equations_.rows.size() + equations_.signals.y.size();
  for (const auto& side : equations_.sides.sides(parameters, near, [&](Machine<Multi>& m) { point.set(m); })) {
    const std::string where = text_of(equations_.sides.branches()[side.branch], equations_.scenario.model->names);
    for (std::size_t k = 0; k < side.below.size(); ++k) {
      const Multi &a = side.below[k], &b = side.above[k];
      if (!a.finite() && !b.finite()) continue;
      if (a.finite() && b.finite() && !(abs(Multi(a - b)) > part * (Multi(1) + abs(a) + abs(b)))) continue;
      const std::size_t row = k < rows ? k : equations_.sides.partials()[k - rows].row;
      if (row >= equations_.rows.size()) {
        rough[row - equations_.rows.size()] = "a kink or a jump at this state, " + where;
        continue;
      }
      return {OutcomeKind::not_a_number,
              "the equations have no derivative at this state: the equation of " +
                  equations_.scenario.system.equation_names[equations_.rows[row].first] + " has a kink or a jump " +
                  where,
              "linearize at a state on one side of it, --about state with other initial values, or replace min, max, "
              "abs, sign, piecewise or the table there by a smooth formula"};
    }
  }
  return {};
}

// Names the formula for which the equations have no derivative at the point.
Outcome Linearizer::without_derivative(const LinearPoint& point) const {
  const auto fault = point.fault(0, equations_.rows.size());
  if (!fault) return {OutcomeKind::not_a_number, "the equations have no value at this state", "choose another state"};
  const std::string equation = equations_.scenario.system.equation_names[equations_.rows[fault->row].first];
  return {OutcomeKind::not_a_number,
          "the equation of " + equation + " has " + lacking(*fault) + " at this state: " + formula_of(point, *fault),
          "linearize at another state, --about state with other initial values, or make the formula smooth there"};
}

// Marks outputs that have no value or no derivative at the point.
void Linearizer::look_for_lacking_outputs(const LinearPoint& point, std::vector<std::string>& rough) const {
  for (std::size_t o = 0; o < rough.size(); ++o) {
    const std::size_t row = equations_.rows.size() + o;
    if (const auto fault = point.fault(row, row + 1); fault && rough[o].empty())
      rough[o] = lacking(*fault) + " at this state: " + formula_of(point, *fault);
  }
}

std::string Linearizer::lacking(const LinearPoint::Fault& fault) const {
  if (!fault.column) return "no value";
  const std::size_t e = *fault.column, entries = equations_.entries.size();
  return "no derivative by " + (e < entries ? equations_.entry_name(e) : equations_.signals.inputs[e - entries]);
}

std::string Linearizer::formula_of(const LinearPoint& point, const LinearPoint::Fault& fault) const {
  const Model& model = *equations_.scenario.model;
  const auto value = [&](std::uint32_t s) { return point.value(s); };
  return fault.row < equations_.rows.size() ? without_value(equations_.tape, model, fault.slot, value).message
                                            : message_without_value(equations_.tape, model, fault.slot, value);
}

// Removes outputs without a derivative at the point.
static void leave_out(const std::vector<std::string>& rough, LinearModel& m) {
  for (std::size_t o = rough.size(); o-- > 0;) {
    if (rough[o].empty()) continue;
    m.notes.push_back("the output '" + m.outputs[o] + "' has " + rough[o] + "; it is left out");
    m.outputs.erase(m.outputs.begin() + static_cast<std::ptrdiff_t>(o));
    for (Matrix<Multi>* of : {&m.C, &m.D}) {
      Matrix<Multi> fewer(of->rows - 1, of->cols);
      for (std::size_t r = 0; r < fewer.rows; ++r)
        for (std::size_t c = 0; c < fewer.cols; ++c) fewer(r, c) = (*of)(r < o ? r : r + 1, c);
      *of = std::move(fewer);
    }
  }
}

Outcome Linearizer::at(const std::vector<Multi>& parameters, const InitialState<double>& near, bool check,
                       LinearModel& out) const {
  const InitialProblem<Multi> problem{
      equations_.scenario.mechanics.get(), parameters, choice_.overrides, choice_.t, &mass_, nullptr, &near};
  InitialState<Multi> state;
  if (Outcome o = consistent_state(problem, state); !o.ok()) return o;
  if (equations_.scenario.routh)
    if (Outcome o = complete_state(problem, *equations_.scenario.routh, equations_.scenario.routh_structure, state);
        !o.ok())
      return o;
  const Outcome singular{OutcomeKind::singular,
                         "the equations do not determine the motion at this state: it has no linear model",
                         "choose another state"};
  LinearPoint point(equations_, choice_.eliminate.empty() ? equations_.scenario.model->dependent : choice_.eliminate,
                    parameters);
  point.load(state);
  std::vector<std::string> rough(equations_.signals.y.size());
  if (!point.evaluate()) {
    if (Outcome o = look_for_kinks(point, parameters, rough); !o.ok()) return o;
    return without_derivative(point);
  }
  if (!point.choose() || !point.settle()) return singular;
  if (Outcome o = look_for_kinks(point, parameters, rough); !o.ok()) return o;
  look_for_lacking_outputs(point, rough);
  point.linear(out);
  out.replaced = state.replaced.note;
  if (!out.replaced.empty()) out.notes.push_back(out.replaced);
  leave_out(rough, out);

  look_for_steadiness(point, check, out);
  out.eliminate.clear();
  if (out.motion == LinearModel::Motion::unsteady)
    for (const std::size_t a : steady_elimination(equations_, parameters, point))
      out.eliminate.push_back(equations_.scenario.model->coordinates[a].name);
  Matrix<Multi> core(out.core.size(), out.core.size());
  for (std::size_t i = 0; i < core.rows; ++i)
    for (std::size_t k = 0; k < core.cols; ++k) core(i, k) = out.A(out.core[i], out.core[k]);
  if (!eigenvalues(core, out.spectrum))
    return {OutcomeKind::no_convergence, "the eigenvalues of A were not found",
            "ask for more digits: --digits " + std::to_string(more_digits<Multi>())};
  return {};
}

}  // namespace anholon
