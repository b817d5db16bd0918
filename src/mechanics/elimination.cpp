#include "mechanics/elimination.h"

#include <algorithm>
#include <cmath>

#include "base/assert.h"
#include "expr/normal.h"
#include "print/arrange.h"

namespace anholon {

namespace {

// In large matrices, which are not for readers, only shorter expressions are rewritten.
constexpr std::size_t kShortInLarge = 40, kLarge = 5;
// The limit of the work for simplifying intermediate expressions, in products of terms.
constexpr long kShortWork = 20'000;
// A pivot is at least this fraction of the largest candidate.
constexpr double kPivot = 1e-3;

std::size_t nodes(Expr e) { return reachable({&e, 1}).size(); }

// A short form of e: common factors of fractions are cancelled, also those hidden by sin^2 + cos^2 = 1.
Expr shortest(Expr e) {
  const std::size_t size = nodes(e);
  if (size <= 3 || size > kShortEnough) return e;
  const Expr short_one = arranged(e, {});
  return nodes(short_one) < size ? short_one : e;
}

// Replaces the symbols `from` by `to`.
Column put(const Column& X, const Column& from, const Column& to) {
  if (X.empty()) return X;
  std::unordered_map<NodeId, Expr> image;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!(from[i] == to[i])) image.emplace(from[i].id, to[i]);
  if (image.empty()) return X;
  return substitute(X, [&](NodeId id) {
    const auto it = image.find(id);
    return it == image.end() ? Expr{} : it->second;
  });
}

bool depends(std::span<const Expr> es, const Column& on) {
  for (NodeId id : symbols(es))
    for (Expr s : on)
      if (s.id == id) return true;
  return false;
}

}  // namespace

Expr shorter(Expr e, std::size_t longest) {
  const std::size_t size = nodes(e);
  if (size <= 3 || size > longest) return e;
  const std::optional<Expr> full = expanded(e, kShortWork);
  return full && nodes(*full) < size ? *full : e;
}

Column operator*(const Column& X, const Rows& Y) {
  ANHOLON_ASSERT(X.size() == Y.size());
  if (Y.empty() || Y[0].empty()) return {};
  Graph& g = *Y[0][0].graph;
  Column out;
  for (std::size_t a = 0; a < Y[0].size(); ++a) {
    std::vector<Expr> terms;
    for (std::size_t b = 0; b < X.size(); ++b)
      if (!is_zero(X[b]) && !is_zero(Y[b][a])) terms.push_back(X[b] * Y[b][a]);
    out.push_back(terms.empty() ? g.zero() : sum(terms));
  }
  return out;
}

Rows operator-(const Rows& a, const Rows& b) {
  Rows r;
  for (std::size_t i = 0; i < a.size(); ++i) r.push_back(a[i] - b[i]);
  return r;
}

Rows operator+(const Rows& a, const Rows& b) {
  Rows r;
  for (std::size_t i = 0; i < a.size(); ++i) r.push_back(a[i] + b[i]);
  return r;
}

Rows operator*(const Rational& c, const Rows& a) {
  Rows r;
  for (const Column& row : a) r.push_back(c * row);
  return r;
}

Rows inverse(const Rows& A, PointValues& at, Column& pivots, bool readable) {
  const std::size_t n = A.size();
  if (n == 0) return {};
  Graph& g = *A[0][0].graph;
  const std::size_t longest = n < kLarge ? kShortEnough : kShortInLarge;
  Rows left = A, right(n, Column(n, g.zero()));
  for (std::size_t i = 0; i < n; ++i) right[i][i] = g.one();
  std::vector<std::size_t> row_of(n);
  std::vector<bool> used(n, false), column_used(n, false);
  for (std::size_t step = 0; step < n; ++step) {
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        if (!used[i] && !column_used[j] && !is_zero(left[i][j])) largest = std::max(largest, std::abs(at(left[i][j])));
    std::size_t row = n, column = n, best = SIZE_MAX;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        if (used[i] || column_used[j] || is_zero(left[i][j])) continue;
        if (!(std::abs(at(left[i][j])) >= kPivot * largest)) continue;
        const std::size_t cost = is_number(left[i][j]) ? 0 : nodes(left[i][j]);
        if (cost < best) best = cost, row = i, column = j;
      }
    if (row == n)
      throw Failure({}, "the constraints do not determine the dependent coordinates", "choose others with --eliminate");
    used[row] = column_used[column] = true;
    row_of[column] = row;
    const Expr pivot = left[row][column];
    if (!is_number(pivot)) pivots.push_back(pivot);
    for (std::size_t j = 0; j < n; ++j) {
      if (!is_zero(left[row][j])) left[row][j] = shorter(left[row][j] / pivot, longest);
      if (!is_zero(right[row][j])) right[row][j] = shorter(right[row][j] / pivot, longest);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Expr factor = left[i][column];
      if (i == row || is_zero(factor)) continue;
      for (std::size_t j = 0; j < n; ++j) {
        if (!is_zero(left[row][j]))
          left[i][j] = j == column ? g.zero() : shorter(left[i][j] - factor * left[row][j], longest);
        if (!is_zero(right[row][j])) right[i][j] = shorter(right[i][j] - factor * right[row][j], longest);
      }
    }
  }
  Rows out;
  for (std::size_t j = 0; j < n; ++j) out.push_back(right[row_of[j]]);
  if (readable && n < kLarge)
    for (Column& row : out)
      for (Expr& e : row) e = shortest(e);
  return out;
}

Column Elimination::pick(const Column& X, const std::vector<std::size_t>& which) {
  Column out;
  for (std::size_t a : which) out.push_back(X[a]);
  return out;
}

Elimination::Elimination(const Mechanics& M, const EliminationChoice& choice, std::shared_ptr<PointValues> at)
    : constraints(choice.constraints), dependent(choice.dependent), mechanics_(&M), at_(std::move(at)) {
  const Model& model = *M.model;
  for (std::size_t r : constraints) m = std::max(m, static_cast<unsigned>(M.order[r]));
  for (const QuasiVelocity& q : choice.quasi) m = std::max(m, static_cast<unsigned>(q.order));
  ANHOLON_ASSERT(choice.m == 0 || choice.m >= m);  // constraints are lifted, never lowered
  if (choice.m) m = asked = choice.m;
  top_ = jets(model, m);
  next_ = jets(model, m + 1);
  std::sort(dependent.begin(), dependent.end());
  for (std::size_t a = 0; a < M.q.size(); ++a)
    if (std::find(dependent.begin(), dependent.end(), a) == dependent.end()) independent.push_back(a);
  for (std::size_t r : constraints) {
    phi.push_back(total_derivative(put_masses(model, M.phi[r]), m - static_cast<unsigned>(M.order[r])));
    Phi_D.push_back(D(put_masses(model, M.Phi[r])));
  }
  Phi_D_inverse = inverse(Phi_D, *at_, pivots_, true);
  if (choice.by_quasi)
    by_quasi_velocities(choice.quasi, choice.solve);
  else
    by_coordinates(choice.solve);
  finish();
}

Elimination Elimination::of_order(unsigned asked) {
  Elimination e;
  if (asked) e.m = e.asked = asked;
  return e;
}

void Elimination::by_coordinates(bool solve) {
  Graph& gr = mechanics_->graph();
  const std::size_t n = top_.size(), s = dependent.size();
  u = u_value_ = I(top_);
  u_rate_ = u_rate_value_ = I(next_);
  for (std::size_t a : independent) names.push_back(mechanics_->model->coordinates[a].name);
  orders.assign(names.size(), m);
  g = top_;
  // If phi is linear in q_D^(m), the coefficients do not contain q_D^(m).
  solved = solve;
  const Column top_D = D(top_);
  for (const Column& row : Phi_D)
    for (Expr e : row)
      if (depends({&e, 1}, top_D)) solved = false;
  if (solved) {
    const Column rest = put(phi, top_D, Column(s, gr.zero()));
    for (std::size_t b = 0; b < s; ++b) {
      std::vector<Expr> terms;
      for (std::size_t r = 0; r < s; ++r)
        if (!is_zero(Phi_D_inverse[b][r])) terms.push_back(-(Phi_D_inverse[b][r] * rest[r]));
      g[dependent[b]] = shortest(sum(terms));
    }
    return;
  }
  W_inverse_.assign(n, Column(n, gr.zero()));
  for (std::size_t a = 0; a < independent.size(); ++a) W_inverse_[independent[a]][a] = gr.one();
  for (std::size_t b = 0; b < s; ++b)
    for (std::size_t r = 0; r < s; ++r) {
      W_inverse_[dependent[b]][independent.size() + r] = Phi_D_inverse[b][r];
      const Column row = gradient(phi[r], u);
      for (std::size_t a = 0; a < independent.size(); ++a)
        W_inverse_[dependent[b]][a] += -(Phi_D_inverse[b][r] * row[a]);
    }
}

void Elimination::by_quasi_velocities(const std::vector<QuasiVelocity>& list, bool solve) {
  Graph& gr = mechanics_->graph();
  quasi = true;
  Column symbols, symbol_rates;
  for (std::size_t a = 0; a < list.size(); ++a) {
    const unsigned lift = m - static_cast<unsigned>(list[a].order);
    const auto index = static_cast<std::uint32_t>(a);
    symbols.push_back(gr.quasi(index, lift));
    symbol_rates.push_back(gr.quasi(index, lift + 1));
    u_value_.push_back(total_derivative(list[a].value, lift));
    names.push_back(list[a].name);
    orders.push_back(lift);
  }
  u_rate_value_ = total_derivative(u_value_);
  w = u_value_;
  w.insert(w.end(), phi.begin(), phi.end());
  Rows W;
  for (Expr e : w) W.push_back(gradient(e, top_));
  chi_by_u = inverse(W, *at_, pivots_, true);
  solved = solve;
  for (const Column& row : W)
    if (depends(row, top_)) solved = false;
  if (solved) {
    // W q^(m) = (u, 0) - w at q^(m) = 0.
    const Column rest = put(w, top_, Column(top_.size(), gr.zero()));
    u = symbols;
    u_rate_ = symbol_rates;
    for (const Column& row : chi_by_u) {
      std::vector<Expr> terms;
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (i < u.size()) terms.push_back(row[i] * u[i]);
        terms.push_back(-(row[i] * rest[i]));
      }
      g.push_back(shortest(sum(terms)));
    }
  } else {
    u = u_value_;
    u_rate_ = symbol_rates;
    g = top_;
    W_inverse_ = chi_by_u;
  }
}

void Elimination::finish() {
  Graph& gr = mechanics_->graph();
  const std::size_t n = top_.size(), free = u.size();
  if (solved) {
    g_rate_ = put(total_derivative(g), top_, g);
    for (Expr e : g) B_.push_back(gradient(e, u));
    for (Expr e : g_rate_) g_rate_by_u_.push_back(gradient(e, u));
    return;
  }
  for (const Column& row : W_inverse_)
    B_.push_back(Column(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(free)));
  // W q^(m+1) + (the remaining terms of dw/dt) = (u', 0).
  Column all = u_value_;
  all.insert(all.end(), phi.begin(), phi.end());
  const Column rest = put(total_derivative(all), next_, Column(n, gr.zero()));
  for (const Column& row : W_inverse_) {
    std::vector<Expr> terms;
    for (std::size_t i = 0; i < n; ++i) {
      if (i < free) terms.push_back(row[i] * u_rate_[i]);
      if (quasi || i >= free) terms.push_back(-(row[i] * rest[i]));
    }
    g_rate_.push_back(sum(terms));
  }
  for (Expr e : g_rate_) g_rate_by_u_.push_back(put(gradient(e, top_) * B_, u_rate_, u_rate_value_));
}

Expr Elimination::on(Expr X) const { return on(Column{X})[0]; }

Column Elimination::on(const Column& X) const {
  if (!solved) return X;
  Column from = top_, to = g;
  from.insert(from.end(), next_.begin(), next_.end());
  to.insert(to.end(), g_rate_.begin(), g_rate_.end());
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
  if (solved) return gradient(on(X), u);
  const Column a = gradient(X, top_) * B_;
  return a.empty() ? a : a + gradient(X, next_) * g_rate_by_u_;
}

Column Elimination::by_u_rate(Expr X) const { return solved ? gradient(on(X), u_rate_) : gradient(X, next_) * B_; }

Column Elimination::by(unsigned k, Expr X) const {
  const Column lower = jets(*mechanics_->model, k);
  if (solved) return gradient(on(X), lower);
  return gradient(X, lower) + gradient(X, top_) * g_by(k);
}

const Rows& Elimination::g_by(unsigned k) const {
  ANHOLON_ASSERT(k < m);
  if (g_by_.size() <= k) g_by_.resize(k + 1);
  Rows& rows = g_by_[k];
  if (!rows.empty()) return rows;
  const Column lower = jets(*mechanics_->model, k);
  if (solved) {
    for (Expr e : g) rows.push_back(gradient(e, lower));
    return rows;
  }
  Column all = u_value_;
  all.insert(all.end(), phi.begin(), phi.end());
  Rows by_lower;
  for (Expr e : all) by_lower.push_back(gradient(e, lower));
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

Rows Elimination::f_by_u() const { return part(B_, dependent, nullptr); }
Rows Elimination::f_by(unsigned k) const { return part(g_by(k), dependent, &independent); }
Rows Elimination::f_rate_by_u() const { return part(g_rate_by_u_, dependent, nullptr); }

Column Elimination::contract(const Column& X) const { return on(X) * B_; }

Column Elimination::in_coordinates(const Column& X) const {
  if (!quasi) return X;
  Column from = solved ? u : u_rate_, to = solved ? u_value_ : u_rate_value_;
  if (solved) {
    from.insert(from.end(), u_rate_.begin(), u_rate_.end());
    to.insert(to.end(), u_rate_value_.begin(), u_rate_value_.end());
  }
  return put(X, from, to);
}

Elimination Elimination::of(const Mechanics& copy) const {
  Elimination e = *this;
  if (mechanics_) e.mechanics_ = &copy;
  if (at_) e.at_ = std::make_shared<PointValues>(*at_);
  return e;
}

void for_each_expression(Elimination& e, const ExprVisitor& f) {
  auto& [m, asked, constraints, dependent, independent, phi, Phi_D, Phi_D_inverse, names, orders, solved, quasi, u, g,
         w, chi_by_u, mechanics, at, top, next, u_rate, g_rate, u_value, u_rate_value, W_inverse, B, g_rate_by_u, g_by,
         pivots] = e;
  static_cast<void>(mechanics), static_cast<void>(at);
  for_each_expression_of(f, m, asked, constraints, dependent, independent, phi, Phi_D, Phi_D_inverse, names, orders,
                         solved, quasi, u, g, w, chi_by_u, top, next, u_rate, g_rate, u_value, u_rate_value, W_inverse,
                         B, g_rate_by_u, g_by, pivots);
}

}  // namespace anholon
