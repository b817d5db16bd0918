#include "mechanics/elimination.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon {

namespace {

bool depends(std::span<const Expr> es, const Column& on) {
  for (NodeId id : symbols(es))
    for (Expr s : on)
      if (s.id == id) return true;
  return false;
}

}  // namespace

std::optional<std::size_t> FreeQuantities::index_of(const std::string& name) const {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return std::nullopt;
  return static_cast<std::size_t>(at - names.begin());
}

Column Elimination::pick(const Column& X, const std::vector<std::size_t>& which) {
  Column out;
  for (std::size_t a : which) out.push_back(X[a]);
  return out;
}

Elimination::Elimination(const Mechanics& M, const EliminationChoice& choice, std::shared_ptr<PointValues> at)
    : constraints(choice.constraints), dependent(choice.dependent), left_out(choice.left_out),
      full_rank(choice.full_rank), mechanics_(&M), pivots_(std::move(at)) {
  const Model& model = *M.model;
  for (std::size_t r : constraints) m = std::max(m, static_cast<unsigned>(M.order[r]));
  for (const QuasiVelocity& q : choice.quasi) m = std::max(m, static_cast<unsigned>(q.order));
  ANHOLON_ASSERT(choice.m == 0 || choice.m >= m);  // constraints are lifted, never lowered
  if (choice.m) m = asked = choice.m;
  top_.symbols = jets(model, m);
  next_.symbols = jets(model, m + 1);
  std::sort(dependent.begin(), dependent.end());
  for (std::size_t a = 0; a < M.q.size(); ++a)
    if (std::find(dependent.begin(), dependent.end(), a) == dependent.end()) independent.push_back(a);
  Rows Phi_D;
  for (std::size_t r : constraints) {
    phi.push_back(total_derivative(put_masses(model, M.phi[r]), m - static_cast<unsigned>(M.order[r])));
    Phi_D.push_back(D(put_masses(model, M.Phi[r])));
  }
  Phi_D_inverse = pivots_.inverse(Phi_D, Wanted::readable);
  if (choice.by_quasi)
    by_quasi_velocities(choice.quasi, choice.solve);
  else
    by_coordinates(Phi_D, choice.solve);
  if (solved)
    differentiate();
  else
    differentiate_implicitly();
}

Elimination Elimination::of_order(unsigned asked) {
  Elimination e;
  if (asked) e.m = e.asked = asked;
  return e;
}

void Elimination::by_coordinates(const Rows& Phi_D, bool solve) {
  Graph& gr = mechanics_->graph();
  const std::size_t n = top_.symbols.size(), s = dependent.size();
  free.u = free.value = I(top_.symbols);
  free.rate = free.rate_value = I(next_.symbols);
  for (std::size_t a : independent) free.names.push_back(mechanics_->model->coordinates[a].name);
  free.orders.assign(free.names.size(), m);
  top_.values = top_.symbols;
  // If phi is linear in q_D^(m), the coefficients do not contain q_D^(m).
  solved = solve;
  const Column top_D = D(top_.symbols);
  for (const Column& row : Phi_D)
    for (Expr e : row)
      if (depends({&e, 1}, top_D)) solved = false;
  if (solved) {
    const Column rest = put(phi, top_D, Column(s, gr.zero()));
    for (std::size_t b = 0; b < s; ++b) {
      std::vector<Expr> terms;
      for (std::size_t r = 0; r < s; ++r)
        if (!is_zero(Phi_D_inverse[b][r])) terms.push_back(-(Phi_D_inverse[b][r] * rest[r]));
      top_.values[dependent[b]] = shortest(sum(terms));
    }
    return;
  }
  W_inverse_.assign(n, Column(n, gr.zero()));
  for (std::size_t a = 0; a < independent.size(); ++a) W_inverse_[independent[a]][a] = gr.one();
  for (std::size_t b = 0; b < s; ++b)
    for (std::size_t r = 0; r < s; ++r) {
      W_inverse_[dependent[b]][independent.size() + r] = Phi_D_inverse[b][r];
      const Column row = gradient(phi[r], free.u);
      for (std::size_t a = 0; a < independent.size(); ++a)
        W_inverse_[dependent[b]][a] += -(Phi_D_inverse[b][r] * row[a]);
    }
}

void Elimination::by_quasi_velocities(const std::vector<QuasiVelocity>& list, bool solve) {
  Graph& gr = mechanics_->graph();
  Column symbols;
  for (std::size_t a = 0; a < list.size(); ++a) {
    const unsigned lift = m - static_cast<unsigned>(list[a].order);
    const auto index = static_cast<std::uint32_t>(a);
    symbols.push_back(gr.quasi(index, lift));
    free.rate.push_back(gr.quasi(index, lift + 1));
    free.value.push_back(total_derivative(list[a].value, lift));
    free.names.push_back(list[a].name);
    free.orders.push_back(lift);
    free.named.push_back(list[a].value);
  }
  free.rate_value = total_derivative(free.value);
  quasi = QuasiBasis{all_values(), {}};
  Rows W;
  for (Expr e : quasi->w) W.push_back(gradient(e, top_.symbols));
  quasi->chi_by_u = pivots_.inverse(W, Wanted::readable);
  solved = solve;
  for (const Column& row : W)
    if (depends(row, top_.symbols)) solved = false;
  if (solved) {
    // W q^(m) = (u, 0) - w at q^(m) = 0.
    const Column rest = put(quasi->w, top_.symbols, Column(top_.symbols.size(), gr.zero()));
    free.u = symbols;
    for (const Column& row : quasi->chi_by_u) {
      std::vector<Expr> terms;
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (i < symbols.size()) terms.push_back(row[i] * symbols[i]);
        terms.push_back(-(row[i] * rest[i]));
      }
      top_.values.push_back(shortest(sum(terms)));
    }
  } else {
    free.u = free.value;
    top_.values = top_.symbols;
    W_inverse_ = quasi->chi_by_u;
  }
}

void Elimination::differentiate() {
  next_.values = put(total_derivative(top_.values), top_.symbols, top_.values);
  for (OnManifold* level : {&top_, &next_})
    for (Expr e : level->values) level->by_u.push_back(gradient(e, free.u));
}

void Elimination::differentiate_implicitly() {
  Graph& gr = mechanics_->graph();
  const std::size_t n = top_.symbols.size(), count = free.u.size();
  for (const Column& row : W_inverse_)
    top_.by_u.push_back(Column(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(count)));
  // W q^(m+1) + (the remaining terms of dw/dt) = (u', 0).
  const Column rest = put(total_derivative(all_values()), next_.symbols, Column(n, gr.zero()));
  for (const Column& row : W_inverse_) {
    std::vector<Expr> terms;
    for (std::size_t i = 0; i < n; ++i) {
      if (i < count) terms.push_back(row[i] * free.rate[i]);
      if (quasi || i >= count) terms.push_back(-(row[i] * rest[i]));
    }
    next_.values.push_back(sum(terms));
  }
  for (Expr e : next_.values)
    next_.by_u.push_back(put(gradient(e, top_.symbols) * top_.by_u, free.rate, free.rate_value));
}

Column Elimination::all_values() const {
  Column all = free.value;
  all.insert(all.end(), phi.begin(), phi.end());
  return all;
}

Expr Elimination::on(Expr X) const { return on(Column{X})[0]; }

Column Elimination::on(const Column& X) const {
  if (!solved) return X;
  Column from = top_.symbols, to = top_.values;
  from.insert(from.end(), next_.symbols.begin(), next_.symbols.end());
  to.insert(to.end(), next_.values.begin(), next_.values.end());
  return put(X, from, to);
}

Rows Elimination::on(const Rows& X) const {
  Rows out;
  for (const Column& row : X) out.push_back(on(row));
  return out;
}

Rows Elimination::rate(const Rows& X) const {
  Rows out;
  for (const Column& row : X) out.push_back(rate(row));
  return out;
}

Column Elimination::by_u(Expr X) const {
  if (solved) return gradient(on(X), free.u);
  const Column a = gradient(X, top_.symbols) * top_.by_u;
  return a.empty() ? a : a + gradient(X, next_.symbols) * next_.by_u;
}

Column Elimination::by_u_rate(Expr X) const {
  return solved ? gradient(on(X), free.rate) : gradient(X, next_.symbols) * top_.by_u;
}

Column Elimination::by(unsigned k, Expr X) const {
  const Column lower = jets(*mechanics_->model, k);
  if (solved) return gradient(on(X), lower);
  return gradient(X, lower) + gradient(X, top_.symbols) * g_by(k);
}

const Rows& Elimination::g_by(unsigned k) const {
  ANHOLON_ASSERT(k < m);
  if (g_by_.size() <= k) g_by_.resize(k + 1);
  Rows& rows = g_by_[k];
  if (!rows.empty()) return rows;
  const Column lower = jets(*mechanics_->model, k);
  if (solved) {
    for (Expr e : top_.values) rows.push_back(gradient(e, lower));
    return rows;
  }
  Rows by_lower;
  for (Expr e : all_values()) by_lower.push_back(gradient(e, lower));
  for (const Column& row : W_inverse_) rows.push_back(-(row * by_lower));
  return rows;
}

static Rows part(const Rows& X, const std::vector<std::size_t>& rows, const std::vector<std::size_t>* columns) {
  Rows out;
  for (std::size_t r : rows) {
    out.emplace_back();
    if (!columns)
      out.back() = X[r];
    else
      for (std::size_t c : *columns) out.back().push_back(X[r][c]);
  }
  return out;
}

Rows Elimination::C() const {
  Rows out;
  Rows Phi_I;
  for (std::size_t r : constraints) Phi_I.push_back(I(put_masses(*mechanics_->model, mechanics_->Phi[r])));
  for (const Column& row : Phi_D_inverse) out.push_back(on(-(row * Phi_I)));
  return out;
}

Rows Elimination::f_by_u() const { return part(top_.by_u, dependent, nullptr); }
Rows Elimination::f_by(unsigned k) const { return part(g_by(k), dependent, &independent); }
Rows Elimination::f_rate_by_u() const { return part(next_.by_u, dependent, nullptr); }

Column Elimination::contract(const Column& X) const { return on(X) * top_.by_u; }

Column Elimination::in_coordinates(const Column& X) const {
  if (!quasi) return X;
  const Graph& g = mechanics_->graph();
  Column from, to;
  for (NodeId id : symbols(X)) {
    const Node& n = g.node(id);
    if (n.kind != Kind::quasi || n.index >= free.named.size()) continue;
    from.push_back({&mechanics_->graph(), id});
    to.push_back(total_derivative(free.named[n.index], n.order));
  }
  return put(X, from, to);
}

Elimination Elimination::of(const Mechanics& copy) const {
  Elimination e = *this;
  if (mechanics_) e.mechanics_ = &copy;
  e.pivots_ = pivots_.copy();
  return e;
}

static void for_each_expression(FreeQuantities& free, const ExprVisitor& f) {
  auto& [names, orders, u, rate, value, rate_value, named] = free;
  for_each_expression_of(f, names, orders, u, rate, value, rate_value, named);
}

static void for_each_expression(QuasiBasis& basis, const ExprVisitor& f) {
  auto& [w, chi_by_u] = basis;
  for_each_expression_of(f, w, chi_by_u);
}

static void for_each_expression(OnManifold& level, const ExprVisitor& f) {
  auto& [symbols, values, by_u] = level;
  for_each_expression_of(f, symbols, values, by_u);
}

void for_each_expression(Elimination& e, const ExprVisitor& f) {
  auto& [m, asked, constraints, dependent, independent, left_out, full_rank, phi, Phi_D_inverse, solved, free, quasi,
         mechanics, top, next, W_inverse, g_by, pivots] = e;
  static_cast<void>(mechanics), static_cast<void>(left_out), static_cast<void>(full_rank);
  for_each_expression_of(f, m, asked, constraints, dependent, independent, phi, Phi_D_inverse, solved, free, quasi, top,
                         next, W_inverse, g_by, pivots);
}

}  // namespace anholon
