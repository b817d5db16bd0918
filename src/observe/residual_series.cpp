#include "observe/residual_series.h"

#include <algorithm>

#include "print/print.h"
#include "setup/outputs/output_tape.h"
#include "tape/bind.h"
#include "tape/operands.h"

namespace anholon {

Ball rising(std::size_t order, std::size_t k) {
  Ball f(1);
  for (std::size_t i = 1; i <= k; ++i) f *= Ball(static_cast<int>(order + i));
  return f;
}

ResidualSeries::ResidualSeries(Workspace& s, slong bits) : s_(s), bits_(bits), coordinates_(s.mechanics->q.size()) {
  const BallScope precision(bits_);
  const Model& model = *s.model;
  const Mechanics& m = *s.mechanics;
  const Column inertia = newton_left_side(m), reaction = put_masses(model, m.N);
  const Column force = put_masses(model, forces(m));
  Column es;
  for (std::size_t a = 0; a < inertia.size(); ++a) es.push_back(inertia[a] - force[a] - reaction[a]);
  std::vector<int> leads(es.size(), 0);
  for (std::size_t r = 0; r < m.phi.size(); ++r) {
    // Constraints that take part hide as many derivatives as the structure tells; redundant ones follow from them.
    const auto row = std::find(s.system.constraints.begin(), s.system.constraints.end(), r);
    const std::size_t equation = s.system.coordinates + static_cast<std::size_t>(row - s.system.constraints.begin());
    hidden_.push_back(row == s.system.constraints.end() ? std::max(0, 2 - m.order[r]) : s.structure.c[equation]);
    es.push_back(put_masses(model, m.phi[r]));
    leads.push_back(hidden_.back());
  }
  phi_ = es.size();
  for (const std::size_t r : s.system.constraints)
    for (Expr e : m.Phi[r]) es.push_back(put_masses(model, e)), leads.push_back(0);
  // The numbers to which the residuals are relative; their values suffice.
  scale_ = es.size();
  for (const Column* part : {&inertia, &force, &reaction}) es.insert(es.end(), part->begin(), part->end());
  tape_ = compile(OutputTape<double>::put(s, es), leads);
  parameters_ = parameter_values<Ball>(model);
}

void ResidualSeries::reserve(int orders) {
  if (machine_ && orders <= orders_) return;
  machine_ = std::make_unique<Machine<Ball>>(tape_, static_cast<std::size_t>(orders) + 1, parameters_);
  orders_ = orders;
}

void ResidualSeries::evaluate(const BallSeries& x, const Ball& t, int orders) {
  reserve(orders);
  bind_series(*machine_, *s_.model->graph, [&](const Node& n, NodeId symbol, Ball* w, int lead) {
    const std::size_t top = static_cast<std::size_t>(orders + lead);
    const auto j = s_.system.variable(symbol);
    for (std::size_t p = 0; p <= top; ++p) {
      const std::size_t k = p + n.order;
      if (n.kind == Kind::time)
        w[p] = p == 0 ? t : Ball(p == 1 ? 1 : 0);
      else
        w[p] = j && k < x[*j].size() ? x[*j][k] * rising(p, n.order) : Ball(0);
    }
  });
  for (int stage = -tape_.largest_lead; stage <= orders; ++stage) machine_->sweep(stage, 0, tape_.main_end);
}

Ball ResidualSeries::newton_scale() {
  machine_->sweep(0, tape_.main_end, static_cast<std::uint32_t>(tape_.code.size()));
  Ball scale(1);
  for (std::size_t i = scale_; i < tape_.roots.size(); ++i)
    if (machine_->value(i).is_finite()) scale = max(scale, lower_end(abs(machine_->value(i))));
  return scale;
}

std::string ResidualSeries::turning() const {
  const auto zero_at = [&](std::uint32_t slot) { return machine_->series(slot)[0].contains_zero(); };
  for (std::uint32_t s = 0; s < tape_.main_end; ++s) {
    const Instruction& in = tape_.code[s];
    bool turns = false;
    if (turns_at_zero(in))
      turns = zero_at(in.a);
    else if (in.op == Op::select)
      turns = zero_at(in.first);
    else if (in.op == Op::power && !tape_.rationals[in.index].is_integer())
      turns = zero_at(in.a);
    else if (in.op == Op::lookup)
      for (const Rational& knot : tape_.step_functions[in.index].knots)
        turns = turns || machine_->series(in.a)[0].contains(knot);
    if (turns && tape_.nodes[s] != Tape::kNoNode)
      return print(Expr{s_.model->graph.get(), tape_.nodes[s]}, s_.model->names, Format::text);
  }
  return {};
}

const Ball* ResidualSeries::phi(std::size_t constraint, std::size_t coordinate) const {
  return machine_->series(tape_.roots[phi_ + constraint * coordinates_ + coordinate]);
}

BallSeries ResidualSeries::correction(std::size_t orders) const {
  const PrecisionScope precision(static_cast<int>(static_cast<double>(bits_) * 0.30103) + 1);
  const std::size_t n = coordinates_, count = s_.system.constraints.size();
  Matrix<Multi> normal(count, count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t a = 0; a < n; ++a)
        addmul(normal(i, j), phi(i, a)[0].midpoint_multi(), phi(j, a)[0].midpoint_multi());
  Lu<Multi> lu;
  if (count == 0 || !lu.factor(normal)) return {};
  std::vector<std::vector<Multi>> delta(count);
  for (std::size_t k = 0; k < orders; ++k) {
    std::vector<Multi> right(count), solution;
    for (std::size_t a = 0; a < n; ++a) {
      Multi left = residual(a)[k].midpoint_multi();
      for (std::size_t j = 0; j < count; ++j)
        for (std::size_t i = 1; i <= k; ++i) addmul(left, Multi(-delta[j][k - i]), phi(j, a)[i].midpoint_multi());
      for (std::size_t j = 0; j < count; ++j) addmul(right[j], phi(j, a)[0].midpoint_multi(), left);
    }
    lu.solve(right, solution);
    for (std::size_t j = 0; j < count; ++j) {
      if (!solution[j].finite()) return {};
      delta[j].push_back(solution[j]);
    }
  }
  BallSeries balls(count);
  for (std::size_t j = 0; j < count; ++j)
    for (const Multi& x : delta[j]) balls[j].emplace_back(x);
  return balls;
}

Ball ResidualSeries::corrected(std::size_t a, std::size_t order, const BallSeries& delta) const {
  Ball left = residual(a)[order];
  for (std::size_t j = 0; j < delta.size(); ++j)
    for (std::size_t k = 0; k <= order && k < delta[j].size(); ++k) addmul(left, -delta[j][k], phi(j, a)[order - k]);
  return left;
}

}  // namespace anholon
