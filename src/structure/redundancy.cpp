#include "structure/redundancy.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "expr/generic_point.h"
#include "expr/normal.h"
#include "structure/stage.h"
#include "tape/bind.h"

namespace anholon {

namespace {

// A row whose sine is below the first number is taken only if its order has no better row, and one below the second
// only if no order has a better row.
constexpr double kFarFromDependent = 0.5, kNearlyDependent = 0.05;

// Returns a value for a symbol that the state does not hold: in (0.5, 1.5), different for each symbol, so that rows of
// different constraints are not parallel by accident.
double generic(const Node& symbol) { return 0.5 + generic_value(symbol, 0); }

// Squares of the entries may be beyond double.
double length(const std::vector<double>& v) {
  double largest = 0, sum = 0;
  for (const double x : v) largest = std::max(largest, std::abs(x));
  if (!(largest > 0)) return 0;
  for (const double x : v) sum += (x / largest) * (x / largest);
  return largest * std::sqrt(sum);
}

// An orthonormal basis that grows.
class OrthonormalRows {
 public:
  // Returns the component of v orthogonal to the basis, orthogonalized twice.
  std::vector<double> beyond(std::vector<double> v) const {
    for (int pass = 0; pass < 2; ++pass)
      for (const std::vector<double>& e : basis_) {
        double dot = 0;
        for (std::size_t a = 0; a < v.size(); ++a) dot += e[a] * v[a];
        for (std::size_t a = 0; a < v.size(); ++a) v[a] -= dot * e[a];
      }
    return v;
  }
  // Returns the components of v along the basis.
  std::vector<double> components(const std::vector<double>& v) const {
    std::vector<double> list;
    for (const std::vector<double>& e : basis_) list.push_back(std::inner_product(e.begin(), e.end(), v.begin(), 0.0));
    return list;
  }
  void add(std::vector<double> v) {
    const double l = length(v);
    for (double& x : v) x /= l;
    basis_.push_back(std::move(v));
  }

 private:
  std::vector<std::vector<double>> basis_;
};

}  // namespace

IndependentConstraints choose_independent(const Matrix<double>& phi, const std::vector<int>& order,
                                          const std::function<bool(std::size_t)>& vanishes) {
  IndependentConstraints choice;
  std::vector<std::size_t> open;
  std::vector<std::vector<double>> rows(phi.rows);
  for (std::size_t i = 0; i < phi.rows; ++i) {
    rows[i].assign(&phi.data[i * phi.cols], &phi.data[i * phi.cols] + phi.cols);
    const double l = length(rows[i]);
    if (!(l > 0)) {
      (vanishes && vanishes(i) ? choice.vanishing : choice.independent).push_back(i);
      continue;
    }
    for (double& x : rows[i]) x /= l;
    open.push_back(i);
  }
  OrthonormalRows span;
  const auto take = [&](int of_order, double threshold) {
    std::vector<std::size_t> left;
    for (std::size_t i : open) {
      std::vector<double> rest = order[i] == of_order ? span.beyond(rows[i]) : std::vector<double>();
      const double sine = length(rest);
      if (!(sine > threshold)) {
        left.push_back(i);
        continue;
      }
      span.add(std::move(rest));
      if (sine < choice.weakest) choice.weakest = sine, choice.weakest_row = i;
      choice.independent.push_back(i);
    }
    open = std::move(left);
  };
  std::vector<int> orders;
  for (std::size_t i : open) orders.push_back(order[i]);
  std::sort(orders.begin(), orders.end());
  orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
  for (int k : orders) take(k, kFarFromDependent), take(k, kNearlyDependent);
  for (int k : orders) take(k, kDependent);
  choice.redundant = std::move(open);
  choice.redundant.insert(choice.redundant.end(), choice.vanishing.begin(), choice.vanishing.end());
  std::sort(choice.independent.begin(), choice.independent.end());
  std::sort(choice.redundant.begin(), choice.redundant.end());
  return choice;
}

namespace {

// The independent rows that are not zero, at length 1, as combinations of an orthonormal basis: rows = T * basis.
struct Triangle {
  std::vector<std::size_t> rows;  // their indices
  OrthonormalRows basis;
  std::vector<std::vector<double>> inverse;  // the columns of T^-1
};

Triangle triangle(const std::vector<std::vector<double>>& unit_rows, const std::vector<std::size_t>& independent) {
  Triangle of;
  std::vector<std::vector<double>> t;
  for (const std::size_t i : independent) {
    if (!(length(unit_rows[i]) > 0)) continue;
    of.rows.push_back(i);
    of.basis.add(of.basis.beyond(unit_rows[i]));
    t.push_back(of.basis.components(unit_rows[i]));
  }
  const std::size_t r = of.rows.size();
  for (std::size_t j = 0; j < r; ++j) {
    std::vector<double> column(r, 0);
    for (std::size_t i = j; i < r; ++i) {
      double sum = i == j ? 1 : 0;
      for (std::size_t k = j; k < i; ++k) sum -= t[i][k] * column[k];
      column[i] = sum / t[i][i];
    }
    of.inverse.push_back(std::move(column));
  }
  return of;
}

}  // namespace

std::vector<Dependency> dependencies(const Matrix<double>& phi, const IndependentConstraints& choice) {
  std::vector<Dependency> list;
  if (choice.redundant.empty()) return list;
  std::vector<std::vector<double>> unit(phi.rows);
  std::vector<double> lengths(phi.rows);
  for (std::size_t i = 0; i < phi.rows; ++i) {
    unit[i].assign(&phi.data[i * phi.cols], &phi.data[i * phi.cols] + phi.cols);
    lengths[i] = length(unit[i]);
    if (lengths[i] > 0)
      for (double& x : unit[i]) x /= lengths[i];
  }
  const Triangle of = triangle(unit, choice.independent);
  for (const std::size_t r : choice.redundant) {
    Dependency& d = list.emplace_back();
    if (!(lengths[r] > 0) || length(of.basis.beyond(unit[r])) > kDependent) continue;
    d.assign(phi.rows, 0.0);
    d[r] = 1 / lengths[r];
    const std::vector<double> along = of.basis.components(unit[r]);
    for (std::size_t j = 0; j < of.rows.size(); ++j) {
      // A row takes part if the redundant row is not, up to kDependent, in the span of the other independent rows.
      const double multiple = std::inner_product(along.begin(), along.end(), of.inverse[j].begin(), 0.0);
      if (std::abs(multiple) > kDependent * length(of.inverse[j])) d[of.rows[j]] = -multiple / lengths[of.rows[j]];
    }
  }
  return list;
}

bool vanishes_identically(const Mechanics& m, const std::vector<double>& parameters, std::size_t r) {
  const std::unique_ptr<Graph> own = m.graph().clone();  // the graph may be frozen
  const Model& model = *m.model;
  // Formulas of the file are exact; other numbers have been set since.
  Column formulas;
  for (const Parameter& p : model.parameters) formulas.push_back(p.value);
  const std::vector<double> of_file = evaluate_parameters<double>(m.graph(), formulas);
  Expr e = own->own(m.phi[r]);
  for (std::size_t depth = 0; depth <= formulas.size(); ++depth)
    e = substitute({&e, 1}, [&](NodeId id) {
      const Node& n = own->node(id);
      if (n.kind != Kind::parameter) return Expr{};
      return parameters[n.index] == of_file[n.index] ? own->own(formulas[n.index])
                                                     : own->number(Rational(parameters[n.index]));
    })[0];
  return proved_zero(e);
}

Matrix<double> constraint_rows(const Mechanics& m, const std::vector<double>& parameters,
                               const InitialState<double>& state) {
  const std::size_t s = m.phi.size(), n = m.q.size();
  Column es;
  for (const Column& row : m.Phi)
    for (Expr e : row) es.push_back(put_masses(*m.model, e));
  const Tape tape = compile(es);
  Machine<double> machine(tape, 0, parameters);
  bind(machine, m.graph(), [&](const Node& node, NodeId) {
    const double* known = state.value(node);
    return node.kind == Kind::time ? state.t : known ? *known : generic(node);
  });
  machine.evaluate();
  Matrix<double> phi(s, n);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t a = 0; a < n; ++a) phi(i, a) = machine.value(i * n + a);
  return phi;
}

IndependentConstraints independent_constraints(const Mechanics& m, const std::vector<double>& parameters,
                                               const InitialState<double>& state) {
  if (m.phi.empty()) return {};
  return choose_independent(constraint_rows(m, parameters, state), m.order,
                            [&](std::size_t r) { return vanishes_identically(m, parameters, r); });
}

template <Number N>
std::vector<N> least_multipliers(const Matrix<N>& phi, const std::vector<std::size_t>& independent,
                                 const std::vector<N>& multipliers) {
  const std::size_t s = phi.rows, n = phi.cols, r = independent.size();
  Matrix<N> gram(r, r), square(r, r), c(s, r);
  const auto dot = [&](std::size_t i, std::size_t j) {
    N sum(0);
    for (std::size_t a = 0; a < n; ++a) addmul(sum, phi(i, a), phi(j, a));
    return sum;
  };
  for (std::size_t i = 0; i < r; ++i)
    for (std::size_t j = 0; j < r; ++j) gram(i, j) = dot(independent[i], independent[j]);
  std::vector<N> lambda(s, N(0)), row(r, N(0)), w;
  Lu<N> lu;
  if (r == 0 || !lu.factor(gram)) return lambda;
  for (std::size_t i = 0; i < s; ++i) {
    for (std::size_t j = 0; j < r; ++j) row[j] = dot(i, independent[j]);
    lu.solve(row, w);
    for (std::size_t j = 0; j < r; ++j) c(i, j) = w[j];
  }
  for (std::size_t j = 0; j < r; ++j)
    for (std::size_t k = 0; k < r; ++k)
      for (std::size_t i = 0; i < s; ++i) addmul(square(j, k), c(i, j), c(i, k));
  if (!lu.factor(square)) return lambda;
  lu.solve(multipliers, w);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < r; ++j) addmul(lambda[i], c(i, j), w[j]);
  return lambda;
}

template std::vector<double> least_multipliers(const Matrix<double>&, const std::vector<std::size_t>&,
                                               const std::vector<double>&);
template std::vector<long double> least_multipliers(const Matrix<long double>&, const std::vector<std::size_t>&,
                                                    const std::vector<long double>&);
template std::vector<Quad> least_multipliers(const Matrix<Quad>&, const std::vector<std::size_t>&,
                                             const std::vector<Quad>&);
template std::vector<Multi> least_multipliers(const Matrix<Multi>&, const std::vector<std::size_t>&,
                                              const std::vector<Multi>&);

}  // namespace anholon
