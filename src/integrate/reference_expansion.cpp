#include "integrate/reference_expansion.h"

#include <cmath>

namespace anholon {

template <Number N>
ReferenceExpansion<N>::ReferenceExpansion(const Program& program, const std::vector<N>& parameters, int order)
    : program_(&program), order_(order), expansion_(program, parameters, order - 1) {
  for (std::size_t j = 0; j < program.unknowns(); ++j)
    unknowns_.push_back({&expansion_.coefficient(j, 0), program.d[j]});
  for (int k = 1; k <= order; ++k) reciprocal_.push_back(W(1) / W(k));
}

template <Number N>
typename ReferenceExpansion<N>::W ReferenceExpansion<N>::integral(std::size_t i, const W& h) const {
  W s(0);
  for (int k = order_ - 1; k >= 0; --k)
    s = (s + convert<W>(expansion_.quadrature(i)[k]) * reciprocal_[static_cast<std::size_t>(k)]) * h;
  return s;
}

template <Number N>
Outcome ReferenceExpansion<N>::prepare(const MotionState<N>& m, const std::vector<W>& guess) {
  convert_all(m.state, narrow_state_);
  convert_all(guess, narrow_leading_);
  expansion_.load(convert<N>(m.t), narrow_state_, narrow_leading_);
  return expansion_.prepare();
}

template <Number N>
Outcome ReferenceExpansion<N>::solve(MotionState<N>& m, const std::vector<W>& guess, Expansion<W>& point) {
  point.load(m.t, m.state, guess);
  if constexpr (std::same_as<N, W>) {
    if (Outcome o = expansion_.project(); !o.ok()) return o;
    missed_ = {expansion_.drift(), expansion_.most_missed()};
    if (Outcome o = expansion_.solve(); !o.ok()) return o;
    const std::vector<W> unprojected = m.state;
    expansion_.state(m.state);
    for (std::size_t i = 0; i < m.state.size(); ++i)
      if (m.state[i] != unprojected[i]) m.carry[i] = W(0);
    expansion_.leading(m.leading);
    point.load(m.t, m.state, m.leading);
    m.record.worst_constraint = std::max(m.record.worst_constraint, expansion_.drift());
    m.record.worst_equation = std::max(m.record.worst_equation, expansion_.equation_residual());
    return {};
  } else {
    return solve_wide(m, point);
  }
}

template <Number N>
Outcome ReferenceExpansion<N>::solve_wide(MotionState<N>& m, Expansion<W>& point) {
  const auto solver = [this](const std::vector<W>& r, std::vector<W>& y) {
    convert_all(r, narrow_r_);
    expansion_.system_jacobian().solve_once(narrow_r_, narrow_y_);
    convert_all(narrow_y_, y);
  };
  point.evaluate();
  point.adopt_jacobian(expansion_.system_jacobian());
  if (Outcome o = point.project(solver); !o.ok()) return o;
  missed_ = {convert<N>(point.drift()), point.most_missed()};
  if (Outcome o = point.solve(solver); !o.ok()) {
    // The Jacobian depends on the leading derivatives, so they are solved for in N first.
    if (o = expansion_.solve(); !o.ok()) return o;
    expansion_.leading(narrow_leading_);
    convert_all(narrow_leading_, m.leading);
    point.load(m.t, m.state, m.leading);
    point.evaluate();
    if (o = point.project(solver); !o.ok()) return o;
    if (o = point.solve(solver); !o.ok()) return o;
  }
  point.state(m.state);
  point.leading(m.leading);
  expansion_.adopt_values(point);
  m.record.worst_constraint = std::max(m.record.worst_constraint, point.drift());
  m.record.worst_equation = std::max(m.record.worst_equation, point.equation_residual());
  return {};
}

template <Number N>
void ReferenceExpansion<N>::cut_to(const MotionState<N>& m, const std::vector<W>& leading, Expansion<W>& point) {
  std::vector<N> narrow;
  convert_all(leading, narrow);
  expansion_.cut_to(narrow);
  point.load(m.t, m.state, leading);
}

template <Number N>
void ReferenceExpansion<N>::polynomial(const W& h, const Expansion<W>& point, std::vector<W>& increments,
                                       std::vector<W>& leading) const {
  const Program& p = *program_;
  increments.assign(expansion_.state_size(), W(0));
  leading.assign(p.unknowns(), W(0));
  for (std::size_t j = 0; j < p.unknowns(); ++j) {
    const int d = p.d[j], top = order_ - 1 + d;
    // Coefficients up to that of the leading derivative come from the wider point.
    const auto coefficient = [&](int k) {
      return k <= d ? point.coefficient(j, k) : convert<W>(expansion_.coefficient(j, k));
    };
    for (int k = 0; k <= d; ++k) {
      // The sum is sum_i x_(k+i) (k+i)!/i! h^i without the term of order 0, which is the state itself.
      W s(0);
      for (int i = top - k; i >= 1; --i) {
        W factor(1);
        for (int f = 1; f <= k; ++f) factor = factor * W(i + f);
        s = (s + coefficient(k + i) * factor) * h;
      }
      if (k < d)
        increments[expansion_.offset(j) + static_cast<std::size_t>(k)] = s;
      else
        leading[j] = point.derivative(j, k) + s;
    }
  }
}

template <Number N>
bool ReferenceExpansion<N>::advance(MotionState<N>& m, const W& h, const Expansion<W>& point) {
  polynomial(h, point, change_, m.leading);
  next_ = m.state;
  for (std::size_t i = 0; i < next_.size(); ++i) {
    add_compensated(next_[i], m.carry[i], change_[i]);
    if (!is_finite(next_[i]) || std::abs(to_double(next_[i])) > kBlowUp) return false;
  }
  std::swap(m.state, next_);
  return true;
}

template class ReferenceExpansion<double>;
template class ReferenceExpansion<long double>;
template class ReferenceExpansion<Quad>;
template class ReferenceExpansion<Multi>;

}  // namespace anholon
