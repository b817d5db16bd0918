#include "linear/states_at_rest.h"

#include <algorithm>

#include "formulation/formulation.h"
#include "numeric/linear.h"
#include "structure/initial_problem.h"
#include "tape/bind.h"

namespace anholon {

namespace {

// The laws of rest, as expressions that vanish, and their unknowns: positions, multipliers and states.
struct LawsOfRest {
  Column laws, unknowns;
};

Column without_motion(const Column& es) {
  Graph& g = *es.front().graph;
  return substitute(es, [&](NodeId id) {
    const Node& n = g.node(id);
    return n.kind == Kind::jet && n.order > 0 ? g.zero() : Expr{};
  });
}

// Calls `see` for each state of a column.
template <class See>
void for_each_state(const Column& es, const See& see) {
  for (const NodeId id : symbols(es))
    if (const Node& n = es.front().graph->node(id); n.kind == Kind::state) see(n.index);
}

// Returns nullopt if no state influences the motion. Throws Failure if a formula has no value at rest.
std::optional<LawsOfRest> laws_of_rest(const Model& model) {
  const Mechanics m = mechanics(model);
  Graph& g = m.graph();
  const Equations e = find_formulation("routh")->equations(m, {});
  Column laws = m.phi;
  for (std::size_t i = 0; i < e.left.size(); ++i) laws.push_back(e.left[i] - e.right[i]);
  for (Expr& law : laws) law = put_state_rates(model, put_masses(model, law), 1);
  laws = without_motion(laws);
  Column rates;
  for (const StateVariable& z : model.states) rates.push_back(put_state_rates(model, put_masses(model, z.rate), 1));
  rates = without_motion(rates);
  // A state has influence if it occurs in these laws, or in the rate of a state with influence.
  std::vector<bool> has_influence(rates.size());
  std::vector<std::uint32_t> found;
  const auto see = [&](std::uint32_t state) {
    if (!has_influence[state]) has_influence[state] = true, found.push_back(state);
  };
  for_each_state(laws, see);
  for (std::size_t k = 0; k < found.size(); ++k) for_each_state({rates[found[k]]}, see);
  if (found.empty()) return std::nullopt;
  for (const std::uint32_t state : found) laws.push_back(rates[state]);
  LawsOfRest all{std::move(laws), {}};
  for (const NodeId id : symbols(all.laws))
    if (const Kind kind = g.node(id).kind; kind == Kind::jet || kind == Kind::multiplier || kind == Kind::state)
      all.unknowns.push_back({&g, id});
  return all;
}

// Newton's method for the laws, with the least change in each step.
class SearchForRest {
 public:
  SearchForRest(const Model& model, LawsOfRest of)
      : of_(std::move(of)), tape_(compile(with_derivatives(of_))), parameters_(parameters_of(model)),
        machine_(tape_, 0, parameters_) {
    begin(model);
  }

  const Column& unknowns() const { return of_.unknowns; }
  // Returns the values of the unknowns, for which the laws hold up to `tolerance`; nullopt if there are none nearby.
  std::optional<std::vector<Multi>> solve(const Multi& tolerance) {
    constexpr int kMostTries = 60;
    if (!evaluate()) return std::nullopt;
    for (int step = 0; step < kMostTries; ++step) {
      if (worst(scales_) <= tolerance) return x_;
      if (!go()) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  static Column with_derivatives(const LawsOfRest& of) {
    Column all = of.laws;
    for (const Expr& law : of.laws)
      for (const Expr& x : of.unknowns) all.push_back(partial(law, x));
    return all;
  }
  static std::vector<Multi> parameters_of(const Model& model) {
    Column values;
    for (const Parameter& p : model.parameters) values.push_back(p.value);
    return evaluate_parameters<Multi>(*model.graph, values);
  }

  // Sets the time and the unknowns to the values of the file; multipliers, and positions without a value, to 0.
  void begin(const Model& model) {
    const Tape tape = initial_values(model);
    Machine<Multi> values(tape, 0, parameters_);
    values.evaluate();
    t_ = values.value(0);
    const std::size_t states = model.states.size();
    for (const Expr& x : of_.unknowns) {
      const Node& n = x.graph->node(x.id);
      Multi value(0);
      if (n.kind == Kind::state) value = values.value(1 + n.index);
      for (std::size_t k = 0; k < model.initial.guess.size(); ++k)
        if (model.initial.guess[k].symbol == x) value = values.value(1 + states + k);
      x_.push_back(value);
    }
  }

  // Computes laws, derivatives and scales; returns false if a number is not finite.
  bool evaluate() {
    const Graph& g = *of_.laws.front().graph;
    bind(machine_, g, [&](const Node& n, NodeId id) {
      if (n.kind == Kind::time) return t_;
      for (std::size_t j = 0; j < x_.size(); ++j)
        if (of_.unknowns[j].id == id) return x_[j];
      return Multi(0);
    });
    machine_.evaluate();
    const std::size_t rows = of_.laws.size(), columns = x_.size();
    residual_.assign(rows, Multi(0)), scales_.assign(rows, Multi(0)), jacobian_ = Matrix<Multi>(rows, columns);
    for (std::size_t i = 0; i < rows; ++i) {
      residual_[i] = machine_.value(i);
      if (!residual_[i].finite()) return false;
      for (std::size_t j = 0; j < columns; ++j) {
        const Multi d = jacobian_(i, j) = machine_.value(rows + i * columns + j);
        if (!d.finite()) return false;
        scales_[i] = std::max(scales_[i], abs(d) * std::max(Multi(1), abs(x_[j])));
      }
    }
    return true;
  }

  // The largest residual in relation to these scales.
  Multi worst(const std::vector<Multi>& scales) const {
    Multi most(0);
    for (std::size_t i = 0; i < residual_.size(); ++i)
      if (residual_[i] != Multi(0)) most = std::max(most, abs(residual_[i]) / scales[i]);
    return most;
  }

  // Makes the step, or a part of it, after which the residuals are smaller. Returns false if there is none.
  bool go() {
    const RowChoice<Multi> rows = choose_rows(jacobian_, Multi(kDependent));
    Matrix<Multi> a(rows.independent.size(), x_.size()), metric(x_.size(), x_.size());
    std::vector<Multi> missing, change;
    for (std::size_t j = 0; j < x_.size(); ++j) metric(j, j) = Multi(1);
    for (std::size_t k = 0; k < a.rows; ++k) {
      for (std::size_t j = 0; j < a.cols; ++j) a(k, j) = jacobian_(rows.independent[k], j);
      missing.push_back(-residual_[rows.independent[k]]);
    }
    if (a.rows == 0 || !least_change(metric, a, missing, change)) return false;
    const std::vector<Multi> from = x_, scales = scales_;
    const Multi before = worst(scales);
    constexpr int kMostCuts = 12;
    for (int k = 0; k < kMostCuts; ++k) {
      for (std::size_t j = 0; j < x_.size(); ++j) x_[j] = from[j] + change[j];
      if (evaluate() && worst(scales) < before) return true;
      for (Multi& d : change) d /= Multi(2);
    }
    return false;
  }

  const LawsOfRest of_;
  const Tape tape_;
  const std::vector<Multi> parameters_;
  Machine<Multi> machine_;
  Multi t_{0};
  std::vector<Multi> x_, residual_, scales_;
  Matrix<Multi> jacobian_;
};

}  // namespace

std::shared_ptr<const Model> with_states_at_rest(const Model& at_rest, int digits) {
  if (at_rest.states.empty() || !at_rest.unknown_functions.empty()) return nullptr;
  constexpr int kGuard = 12;
  const PrecisionScope precision(digits + kGuard);
  try {
    const std::shared_ptr<Model> own = clone(at_rest);
    std::optional<LawsOfRest> laws = laws_of_rest(*own);
    if (!laws) return nullptr;
    SearchForRest search(*own, std::move(*laws));
    const auto found = search.solve(from_rational<Multi>(*parse_rational("1e-" + std::to_string(digits))));
    if (!found) return nullptr;
    auto model = std::make_shared<Model>(at_rest);
    Graph& g = *model->graph;
    for (std::size_t j = 0; j < found->size(); ++j) {
      const Node& n = own->graph->node(search.unknowns()[j].id);
      const Expr value = g.number(*parse_rational(number_text((*found)[j], digits + kGuard)));
      if (n.kind == Kind::state) model->states[n.index].initial = value;
      if (n.kind != Kind::jet) continue;
      const Expr q = g.jet(n.index, 0);
      std::erase_if(model->initial.guess, [&](const GivenValue& v) { return v.symbol == q; });
      model->initial.guess.push_back({q, value, {}});
    }
    return model;
  } catch (const Failure&) {
    return nullptr;  // a formula has no value at rest
  }
}

}  // namespace anholon
