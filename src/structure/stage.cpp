#include "structure/stage.h"

#include <algorithm>

namespace anholon {

namespace {
constexpr int kMostIterations = 60;
}  // namespace

template <Number N>
Stage<N>::Stage(const Mechanics& m, std::vector<StageEquation> equations, Column unknowns, unsigned measured, const std::vector<N>& parameters)
    : m_(m), equations_(std::move(equations)), unknowns_(std::move(unknowns)), measured_(measured), tape_(build()),
      machine_(tape_, 0, parameters) {}

template <Number N>
Tape Stage<N>::build() {
  Column es;
  for (const StageEquation& e : equations_) es.push_back(e.residual);
  for (const StageEquation& e : equations_) {
    const Column d = gradient(e.residual, unknowns_);
    es.insert(es.end(), d.begin(), d.end());
  }
  for (const Column& row : mass_matrix(m_)) es.insert(es.end(), row.begin(), row.end());
  return compile(es);
}

template <Number N>
bool Stage<N>::evaluate(const InitialState<N>& s) {
  const Graph& g = m_.graph();
  for (const Input& in : tape_.inputs) {
    const Node& n = g.node(in.symbol);
    const N* known = s.value(n);
    machine_.series(in.slot)[0] = n.kind == Kind::time ? s.t : known ? *known : N(0);
  }
  machine_.evaluate();
  const std::size_t n = unknowns(), q = m_.q.size();
  residual.assign(size(), N(0));
  scale.assign(size(), N(0));
  jacobian = Matrix<N>(size(), n);
  metric = Matrix<N>(n, n);
  N largest_unknown(1);  // a residual below its round-off is none
  for (std::size_t j = 0; j < n; ++j)
    if (N v = abs(*s.value(unknown(j))); v > largest_unknown) largest_unknown = v;
  for (std::size_t i = 0; i < size(); ++i) {
    residual[i] = machine_.value(i);
    if (!is_finite(residual[i])) return false;
    scale[i] = machine_.terms(i, 0);
    for (std::size_t j = 0; j < n; ++j) {
      jacobian(i, j) = machine_.value(size() + i * n + j);
      if (!is_finite(jacobian(i, j))) return false;
      for (N part : {abs(N(jacobian(i, j) * *s.value(unknown(j)))), N(abs(jacobian(i, j)) * largest_unknown * unit_roundoff<N>())})
        if (part > scale[i]) scale[i] = part;
    }
    if (!(scale[i] > N(0))) scale[i] = N(1);
  }
  const std::size_t first = size() * (n + 1);
  const auto mass = [&](std::size_t a, std::size_t b) -> const N& { return machine_.value(first + a * q + b); };
  N largest(0);
  for (std::size_t a = 0; a < q; ++a)
    for (std::size_t b = 0; b < q; ++b) {
      if (!is_finite(mass(a, b))) return false;
      if (a == b && abs(mass(a, b)) > largest) largest = abs(mass(a, b));
    }
  // A coordinate without inertia still has a least change.
  if (!(largest > N(0))) largest = N(1);
  const auto measured = [&](const Node& u) { return u.kind == Kind::jet && (measured_ >> u.order & 1U) != 0; };
  for (std::size_t i = 0; i < n; ++i) {
    const Node &a = unknown(i);
    if (measured(a))
      for (std::size_t j = 0; j < n; ++j)
        if (const Node& b = unknown(j); measured(b) && a.order == b.order) metric(i, j) = mass(a.index, b.index);
    metric(i, i) += largest * N(1e-12);
  }
  return true;
}

// The sum of the absolute values of the terms of an equation.
template <Number N>
N Stage<N>::worst(std::size_t* which) const {
  N most(0);
  for (std::size_t i = 0; i < size(); ++i)
    if (N v = abs(residual[i]) / scale[i]; v > most) {
      most = v;
      if (which) *which = i;
    }
  return most;
}

template <Number N>
bool find_by_least_change(Stage<N>& s, InitialState<N>& state, const std::vector<std::size_t>& free) {
  std::vector<N*> x;
  std::vector<N> guess;
  for (std::size_t j : free) x.push_back(&s.x(state, j)), guess.push_back(*x.back());
  const N rounding = stage_rounding<N>();
  if (!s.evaluate(state)) return false;
  N last_step(-1);
  bool nudged = false;
  for (int k = 0; k < kMostIterations && !free.empty(); ++k) {
    Matrix<N> a(s.size(), free.size());
    for (std::size_t i = 0; i < s.size(); ++i)
      for (std::size_t j = 0; j < free.size(); ++j) a(i, j) = s.jacobian(i, free[j]);
    const RowChoice<N> rows = choose_rows(a, N(kDependent));
    if (rows.dependent.size() && !nudged && s.worst() > rounding && k == 0) {
      // The guess may be a place where a constraint is flat (the centre of a circle): leave it.
      nudged = true;
      bool flat = false;
      for (std::size_t i : rows.dependent)
        if (abs(s.residual[i]) > rounding * s.scale[i]) flat = true;
      if (flat) {
        for (std::size_t j = 0; j < free.size(); ++j) *x[j] += N(0.1) + N(0.037) * N(static_cast<int>(j % 7));
        if (!s.evaluate(state)) return false;
        continue;
      }
    }
    const std::size_t r = rows.independent.size();
    if (r == 0) break;
    Matrix<N> ar(r, free.size()), metric(free.size(), free.size());
    std::vector<N> b(r, N(0)), y;
    for (std::size_t i = 0; i < r; ++i) {
      b[i] = -s.residual[rows.independent[i]];
      for (std::size_t j = 0; j < free.size(); ++j) {
        ar(i, j) = a(rows.independent[i], j);
        b[i] += ar(i, j) * (*x[j] - guess[j]);
      }
    }
    for (std::size_t i = 0; i < free.size(); ++i)
      for (std::size_t j = 0; j < free.size(); ++j) metric(i, j) = s.metric(free[i], free[j]);
    if (!least_change(metric, ar, b, y)) return true;
    // Progress is measured against the scales where the step begins: those at its end grow with it.
    const std::vector<N> scale = s.scale;
    const auto merit = [&] {
      N worst(0);
      for (std::size_t i = 0; i < s.size(); ++i)
        if (N v = abs(s.residual[i]) / scale[i]; v > worst) worst = v;
      return worst;
    };
    const N now = merit();
    std::vector<N> old;
    for (const N* v : x) old.push_back(*v);
    N fraction(1), step(0), size(0);
    bool better = false;
    for (int halvings = 0; halvings < 12; ++halvings, fraction = fraction * N(0.5)) {
      for (std::size_t j = 0; j < free.size(); ++j) *x[j] = old[j] + fraction * (guess[j] + y[j] - old[j]);
      if (!s.evaluate(state)) continue;
      if (merit() <= now * N(0.9) + rounding * N(4) || halvings == 11) {
        better = true;
        break;
      }
    }
    if (!better && !s.evaluate(state)) return false;
    for (std::size_t j = 0; j < free.size(); ++j) {
      if (N v = abs(N(*x[j] - old[j])); v > step) step = v;
      if (N v = abs(*x[j]); v > size) size = v;
    }
    const N floor = unit_roundoff<N>() * N(8) * (size > N(1) ? size : N(1));
    const bool settled = !(step > floor) || (last_step >= N(0) && !(step < last_step) && step < floor * N(100));
    last_step = step;
    if (settled) break;
  }
  return true;
}

template class Stage<double>;
template class Stage<long double>;
template class Stage<Quad>;
template class Stage<Multi>;
template bool find_by_least_change<double>(Stage<double>&, InitialState<double>&, const std::vector<std::size_t>&);
template bool find_by_least_change<long double>(Stage<long double>&, InitialState<long double>&, const std::vector<std::size_t>&);
template bool find_by_least_change<Quad>(Stage<Quad>&, InitialState<Quad>&, const std::vector<std::size_t>&);
template bool find_by_least_change<Multi>(Stage<Multi>&, InitialState<Multi>&, const std::vector<std::size_t>&);

}  // namespace anholon
