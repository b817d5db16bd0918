#include "setup/eliminate.h"

#include <algorithm>
#include <cmath>

#include "expr/generic_point.h"

namespace anholon {

Matrix<double> constraint_matrix(const Mechanics& m, const std::vector<std::size_t>& constraints, PointValues& at) {
  Matrix<double> phi(constraints.size(), m.q.size());
  for (std::size_t i = 0; i < constraints.size(); ++i)
    for (std::size_t a = 0; a < m.q.size(); ++a) phi(i, a) = at(put_masses(*m.model, m.Phi[constraints[i]][a]));
  return phi;
}

namespace {

// Below this part of its size a pivot counts as zero.
constexpr double kSingular = 1e-9;

// Returns a value in (0.6, 1.4) for a symbol whose value is not known.
double generic(const Node& n) { return 0.6 + 0.8 * generic_value(n, 0); }

std::string list_of(const Model& model, const std::vector<std::size_t>& which) {
  std::string list;
  for (std::size_t a : which) list += (list.empty() ? "" : ", ") + model.coordinates[a].name;
  return list;
}

// Returns the weight of a pivot: a pivot that is a number can never vanish, so its weight is larger.
double weight(const Mechanics& m, const std::vector<std::size_t>& constraints, std::size_t a) {
  constexpr double kConstant = 4;
  for (std::size_t r : constraints)
    if (!is_number(m.Phi[r][a])) return 1;
  return kConstant;
}

// Chooses pivots by full pivoting on Phi M^(-1/2), with the diagonal of the mass matrix.
std::vector<std::size_t> best_pivots(const Mechanics& m, const std::vector<std::size_t>& constraints, PointValues& at) {
  Matrix<double> phi = constraint_matrix(m, constraints, at);
  const Column p = gradient(m.T, m.qd);
  double largest = 0;
  std::vector<double> mass;
  for (std::size_t a = 0; a < phi.cols; ++a) {
    mass.push_back(std::abs(at(put_masses(*m.model, partial(p[a], m.qd[a])))));
    largest = std::max(largest, mass.back());
  }
  for (std::size_t a = 0; a < phi.cols; ++a) {
    // A coordinate without inertia counts as very light.
    const double scale = largest > 0 ? std::sqrt(std::max(mass[a] / largest, 1e-6)) : 1;
    for (std::size_t i = 0; i < phi.rows; ++i) phi(i, a) *= weight(m, constraints, a) / scale;
  }
  return choose_rows(phi, kSingular).pivot_columns;
}

std::vector<std::size_t> dependent_coordinates(const Mechanics& m, const std::vector<std::size_t>& constraints,
                                               const std::vector<std::size_t>& wanted, PointValues& at) {
  const Model& model = *m.model;
  if (constraints.empty()) return {};
  const Matrix<double> phi = constraint_matrix(m, constraints, at);
  const std::vector<std::size_t>& asked = wanted.empty() ? model.dependent : wanted;
  if (asked.empty()) {
    std::vector<std::size_t> pivots = best_pivots(m, constraints, at);
    // At a singular state any choice that is regular elsewhere serves for the equations themselves.
    if (pivots.size() < constraints.size()) {
      PointValues elsewhere(generic);
      pivots = best_pivots(m, constraints, elsewhere);
    }
    if (pivots.size() < constraints.size())
      throw Failure({}, "the constraints do not determine as many coordinates as there are constraints",
                    "look for constraints that say the same");
    return pivots;
  }
  if (asked.size() != constraints.size())
    throw Failure({},
                  "to eliminate: " + std::to_string(asked.size()) + " coordinates (" + list_of(model, asked) +
                      "), but there are " + std::to_string(constraints.size()) + " independent constraints",
                  "as many dependent coordinates as constraints");
  Matrix<double> phi_D(constraints.size(), asked.size());
  for (std::size_t i = 0; i < phi_D.rows; ++i)
    for (std::size_t b = 0; b < asked.size(); ++b) phi_D(i, b) = phi(i, asked[b]);
  if (choose_rows(phi_D, kSingular).independent.size() < asked.size())
    throw Failure({}, "the constraints do not determine " + list_of(model, asked) + " at this state",
                  "others that they determine: " + list_of(model, best_pivots(m, constraints, at)));
  return asked;
}

std::vector<QuasiVelocity> quasi_velocities(const Mechanics& m, const std::vector<std::size_t>& constraints,
                                            const std::vector<std::size_t>& dependent, PointValues& at) {
  const Model& model = *m.model;
  const std::size_t n = m.q.size(), s = constraints.size();
  std::vector<QuasiVelocity> list = model.quasi;
  if (list.size() > n - s)
    throw Failure(list[n - s].span,
                  std::to_string(list.size()) + " quasi-velocities; the constraints leave room for " +
                      std::to_string(n - s),
                  "leave out " + std::to_string(list.size() - (n - s)));
  // At a singular state the rows that are regular elsewhere serve for the equations themselves.
  PointValues elsewhere(generic);
  Matrix<double> rows = constraint_matrix(m, constraints, at);
  const bool singular = choose_rows(rows, kSingular).independent.size() < s;
  if (singular) rows = constraint_matrix(m, constraints, elsewhere);
  const auto with = [&](const std::vector<double>& row) {
    Matrix<double> more(rows.rows + 1, n);
    std::copy(rows.data.begin(), rows.data.end(), more.data.begin());
    std::copy(row.begin(), row.end(), more.data.end() - static_cast<std::ptrdiff_t>(n));
    return more;
  };
  const auto independent = [](const Matrix<double>& a) { return choose_rows(a, 1e-6).independent.size() == a.rows; };
  for (const QuasiVelocity& u : list) {
    std::vector<double> row;
    for (Expr e : gradient(u.value, jets(model, static_cast<unsigned>(u.order))))
      row.push_back((singular ? elsewhere : at)(e));
    const Matrix<double> more = with(row);
    if (!independent(more))
      throw Failure(u.span,
                    "the quasi-velocity '" + u.name + "' depends on the constraints and the quasi-velocities before it",
                    "n - s quasi-velocities are independent of each other and of the constraints");
    rows = more;
  }
  std::vector<std::size_t> order;  // independent coordinates first
  for (std::size_t a = 0; a < n; ++a)
    if (std::find(dependent.begin(), dependent.end(), a) == dependent.end()) order.push_back(a);
  order.insert(order.end(), dependent.begin(), dependent.end());
  for (std::size_t a : order) {
    if (list.size() == n - s) break;
    std::vector<double> row(n, 0.0);
    row[a] = 1;
    const Matrix<double> more = with(row);
    if (!independent(more)) continue;
    rows = more;
    list.push_back({automatic_name(model, "u_" + model.coordinates[a].name), m.qd[a], 1, {}});
  }
  return list;
}

}  // namespace

std::function<double(const Node&)> symbol_near(const Model& model, const std::vector<double>& parameters,
                                               const InitialState<double>& state) {
  // Varying masses need some positive value for the choice of pivots.
  const bool known = state.q.size() == model.coordinates.size();
  std::vector<std::optional<double>> inputs;
  for (const Control& u : model.controls)
    inputs.push_back(u.value && is_number(*u.value) ? std::optional(from_rational<double>(number_value(*u.value)))
                                                    : std::nullopt);
  return [parameters, state, known, inputs](const Node& n) {
    if (n.kind == Kind::control && n.index < inputs.size() && inputs[n.index])
      return n.order == 0 ? *inputs[n.index] : 0.0;
    if (n.kind == Kind::parameter && n.index < parameters.size()) return parameters[n.index];
    if (known && n.kind == Kind::time) return state.t;
    if (const double* value = n.kind == Kind::jet || n.kind == Kind::state ? state.value(n) : nullptr) return *value;
    return generic(n);
  };
}

PointValues values_near(const Model& model, const std::vector<double>& parameters, const InitialState<double>& state) {
  return PointValues(symbol_near(model, parameters, state));
}

EliminationChoice choose_elimination(const Mechanics& m, const std::vector<std::size_t>& constraints, Unknowns unknowns,
                                     const std::vector<std::size_t>& wanted, PointValues& at) {
  EliminationChoice choice{
      constraints, dependent_coordinates(m, constraints, wanted, at), unknowns == Unknowns::quasi_velocities, {}};
  if (choice.by_quasi) choice.quasi = quasi_velocities(m, constraints, choice.dependent, at);
  return choice;
}

std::vector<std::size_t> independent_rows(const Mechanics& m, const std::vector<std::size_t>& all, PointValues& at) {
  std::vector<std::size_t> rows = choose_rows(constraint_matrix(m, all, at), kSingular).independent;
  if (rows.size() < all.size()) {
    // Decides whether there are fewer independent rows at a singular state only.
    PointValues elsewhere(generic);
    rows = choose_rows(constraint_matrix(m, all, elsewhere), kSingular).independent;
  }
  std::vector<std::size_t> chosen;
  for (std::size_t i : rows) chosen.push_back(all[i]);
  return chosen;
}

}  // namespace anholon
