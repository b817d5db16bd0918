#include "mechanics/pfaff.h"

#include "expr/generic_point.h"
#include "expr/normal.h"
#include "tape/tape.h"

namespace anholon {

bool is_function_of_time(const Node& n) {
  return n.kind == Kind::given || n.kind == Kind::state || n.kind == Kind::control;
}

const StateVariable* state_moved_by_motion(const Model& model, const Column& es) {
  const Graph& g = *model.graph;
  Column all;  // the formulas, then the rates of the states in them and in these rates
  for (Expr e : es) all.push_back(put_masses(model, e));
  std::vector<bool> seen(model.states.size(), false);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (NodeId id : symbols({&all[i], 1})) {
      const Node n = g.node(id);
      if (n.kind != Kind::state || seen[n.index]) continue;
      seen[n.index] = true;
      const StateVariable& s = model.states[n.index];
      const Expr rate = put_masses(model, s.rate);
      for (NodeId of_rate : symbols({&rate, 1}))
        if (const Node& r = g.node(of_rate);
            r.kind != Kind::time && r.kind != Kind::parameter && !is_function_of_time(r))
          return &s;
      all.push_back(rate);
    }
  return nullptr;
}

Column FormSpace::differential(Expr f) const {
  Column df = gradient(f, z);
  if (!time) return df;
  Graph& g = *f.graph;
  for (NodeId id : symbols({&f, 1})) {
    const Node n = g.node(id);
    if (!is_function_of_time(n)) continue;
    const Expr slope = partial(f, {&g, id});
    df.back() += slope * (n.kind == Kind::given     ? g.given(n.index, n.order + 1U)
                          : n.kind == Kind::control ? g.control(n.index, n.order + 1U)
                                                    : put_state_rates(*model, g.state(n.index, n.order + 1U), 1));
  }
  return df;
}

Expr applied(const Column& w, const Column& X) {
  std::vector<Expr> terms;
  for (std::size_t a = 0; a < w.size(); ++a)
    if (!is_zero(w[a]) && !is_zero(X[a])) terms.push_back(w[a] * X[a]);
  return terms.empty() ? w[0].graph->zero() : sum(terms);
}

VectorField::VectorField(const FormSpace& space, Column components) : X(std::move(components)) {
  for (Expr e : X) differentials.push_back(is_number(e) ? Column(X.size(), e.graph->zero()) : space.differential(e));
}

Expr simplified(Expr e) {
  constexpr long kMostWork = 100'000;  // products of terms: a formula that takes more work is not simplified
  const std::size_t size = reachable({&e, 1}).size();
  if (size <= 3 || size > kShortEnough) return e;
  const std::optional<NormalForm> form = normal_form(e, {}, kMostWork);
  if (!form) return e;
  const Expr top = expression(form->numerator, form->generators);
  const Expr whole = is_zero(top) ? top : top / expression(form->denominator, form->generators);
  return reachable({&whole, 1}).size() < size ? whole : e;
}

Column bracket(const VectorField& X, const VectorField& Y) {
  Column b;
  for (std::size_t c = 0; c < X.X.size(); ++c) {
    const Expr forth = applied(Y.differentials[c], X.X), back = applied(X.differentials[c], Y.X);
    b.push_back(simplified(forth - back));
  }
  return b;
}

// Returns the holonomic constraints that are independent at the state. The others follow from them nearby, but for
// singular configurations.
static Column independent_holonomic(const Mechanics& m, PointValues& near) {
  constexpr double kDependent = 1e-9;
  Column phi;
  for (std::size_t r = 0; r < m.phi.size(); ++r)
    if (m.order[r] == 0) phi.push_back(m.phi[r]);
  Matrix<double> a(phi.size(), m.q.size());
  for (std::size_t i = 0; i < a.rows; ++i) {
    const Column row = gradient(phi[i], m.q);
    for (std::size_t j = 0; j < a.cols; ++j) a(i, j) = near(row[j]);
  }
  Column independent;
  for (const std::size_t i : choose_rows(a, kDependent).independent) independent.push_back(phi[i]);
  return independent;
}

FormPoint::FormPoint(const Mechanics& m, PointValues& near, std::uint64_t seed, bool other_parameters) {
  Graph& g = m.graph();
  Column es;
  for (const Parameter& p : m.model->parameters) es.push_back(p.value);
  const std::vector<Multi> parameters = evaluate_parameters<Multi>(g, es);
  const auto begin = [&](double distance) {
    symbol_ = [&g, &near, seed, distance, other_parameters, parameters](const Node& n) {
      const double u = generic_value(n, seed);
      if (n.kind == Kind::parameter && !other_parameters && n.index < parameters.size()) return parameters[n.index];
      if (n.kind != Kind::time && n.kind != Kind::jet) return Multi(0.6 + 0.8 * u);
      const double base = near(n.kind == Kind::time ? g.time() : g.jet(n.index, n.order));
      return Multi(base) + Multi(distance * (1 + std::abs(base)) * (0.05 + 0.3 * u));
    };
    values_ = std::make_unique<ValuesAt<Multi>>(symbol_);
  };
  const Column phi = independent_holonomic(m, near);
  for (const double distance : {1.0, 0.25, 0.0625}) {
    begin(distance);
    if (phi.empty() || satisfy(m.q, phi)) return;
  }
  begin(1);
}

// Moves the positions to near ones that satisfy the constraints. Returns false if Newton's method does not find them.
bool FormPoint::satisfy(const Column& q, const Column& phi) {
  constexpr int kMostSteps = 40;
  constexpr double kSatisfied = 1e-45;
  Rows rows;
  for (const Expr f : phi) rows.push_back(gradient(f, q));
  Matrix<Multi> unit(q.size(), q.size()), a(phi.size(), q.size());
  for (std::size_t j = 0; j < q.size(); ++j) unit(j, j) = Multi(1);
  std::vector<Multi> missed(phi.size()), step;
  for (int k = 0; k < kMostSteps; ++k) {
    bool good = true;
    for (std::size_t i = 0; i < phi.size(); ++i) {
      missed[i] = -(*values_)(phi[i]);
      if (!missed[i].finite()) return false;
      good = good && abs(missed[i]) < Multi(kSatisfied);
      for (std::size_t j = 0; j < q.size(); ++j) a(i, j) = (*values_)(rows[i][j]);
    }
    if (good) return true;
    if (!least_change(unit, a, missed, step)) return false;
    std::vector<Multi> moved;
    for (std::size_t j = 0; j < q.size(); ++j) moved.push_back((*values_)(q[j]) + step[j]);
    symbol_ = [symbol = symbol_, moved = std::move(moved)](const Node& n) {
      return n.kind == Kind::jet && n.order == 0 ? moved[n.index] : symbol(n);
    };
    values_ = std::make_unique<ValuesAt<Multi>>(symbol_);
  }
  return false;
}

PointValues FormPoint::rough() const {
  return PointValues([symbol = symbol_](const Node& n) { return symbol(n).to_double(); });
}

Matrix<Multi> values_at(const Rows& rows, FormPoint& at) {
  Matrix<Multi> a(rows.size(), rows.empty() ? 0 : rows[0].size());
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < a.cols; ++j) {
      const Multi v = at(rows[i][j]);
      if (!v.finite()) throw NoValue{};
      if (abs(v) > Multi(kFormZero)) a(i, j) = v;
    }
  return a;
}

std::size_t rank(const Matrix<Multi>& a) { return choose_rows(a, Multi(kIndependent)).independent.size(); }

bool Echelon::add(std::vector<Multi> v) {
  const auto largest = [&] {
    std::size_t at = 0;
    for (std::size_t a = 1; a < v.size(); ++a)
      if (abs(v[a]) > abs(v[at])) at = a;
    return at;
  };
  if (v.empty() || !(abs(v[largest()]) > Multi(kFormZero))) return false;
  const Multi scale = v[largest()];
  for (Multi& x : v) x /= scale;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Multi factor = -v[pivots_[i]];
    for (std::size_t a = 0; a < v.size(); ++a) addmul(v[a], factor, rows_[i][a]);
  }
  const std::size_t pivot = largest();
  if (!(abs(v[pivot]) > Multi(kIndependent))) return false;
  const Multi size = v[pivot];
  for (Multi& x : v) x /= size;
  rows_.push_back(std::move(v));
  pivots_.push_back(pivot);
  return true;
}

Expr parameters_put(const Model& model, Expr e) {
  // Values of parameters may contain other parameters.
  for (std::size_t k = 0; k <= model.parameters.size(); ++k) {
    const Expr next = substitute({&e, 1}, [&](NodeId id) {
      const Node& n = e.graph->node(id);
      return n.kind == Kind::parameter ? model.parameters[n.index].value : Expr{};
    })[0];
    if (next == e) break;
    e = next;
  }
  return e;
}

}  // namespace anholon
