#include "system/quasi_velocities.h"

#include <algorithm>
#include <cmath>

#include "expr/arrange.h"
#include "system/copied_mechanics.h"
#include "tape/point.h"

namespace anholon {

namespace {

// With more, the energy is not short in any velocities.
constexpr std::size_t kMostVelocities = 4;
// Pivots are at least this part of the largest candidate.
constexpr double kPivot = 1e-2;

std::size_t nodes(Expr e) { return reachable({&e, 1}).size(); }

// Symbols replaced.
Column put(const Column& es, const Column& from, const Column& to) {
  std::unordered_map<NodeId, Expr> image;
  for (std::size_t i = 0; i < from.size(); ++i) image.emplace(from[i].id, to[i]);
  return substitute(es, [&](NodeId id) {
    const auto it = image.find(id);
    return it == image.end() ? Expr{} : it->second;
  });
}
Expr put(Expr e, const Column& from, const Column& to) { return put(Column{e}, from, to)[0]; }

Expr dot(const Column& a, const Column& b) {
  std::vector<Expr> terms{a[0].graph->zero()};
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!is_zero(a[i])) terms.push_back(a[i] * b[i]);
  return sum(terms);
}

bool is_constant(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (const Kind k = e.graph->node(id).kind; k != Kind::pi && k != Kind::parameter) return false;
  return true;
}

// e as sum_j by[j] v_j + rest.
struct Linear {
  Column by;
  Expr rest;
};

class Writer {
 public:
  Writer(const System& derived, const Mechanics& m, std::span<const Expr> others, const std::function<double(const Node&)>& symbol)
      : derived_(derived), c_(copied_mechanics(m, derived, others)), g_(*c_.model->graph), at_(symbol), q_(jets(*c_.model, 0)), qd_(jets(*c_.model, 1)), zero_(g_.zero()) {}

  std::optional<QuasiVelocities> run() {
    return admissible_velocities() && short_energy() ? equations() : std::nullopt;
  }

 private:
  Expr p(std::size_t i, unsigned order = 0) { return g_.state(static_cast<std::uint32_t>(c_.state_rates.size() + i), order); }

  static bool contains(Expr e, const Column& v) {
    for (NodeId id : symbols({&e, 1}))
      if (std::any_of(v.begin(), v.end(), [&](Expr x) { return x.id == id; })) return true;
    return false;
  }

  // Of what is linear in v; what many of them have in common stays so.
  Linear linear(Expr e, const Column& v) {
    Column values(v.size(), zero_);
    Linear l{{}, put(e, v, values)};
    for (Expr& one : values) {
      one = g_.one();
      l.by.push_back(shorter(put(e, v, values) - l.rest));
      one = zero_;
    }
    return l;
  }

  // Solves the constraints for velocities, one after the other: velocity_ in terms of free_, and back.
  bool admissible_velocities() {
    free_ = free_by_velocity_ = qd_;
    Column solved, values;
    const auto solve = [&](std::size_t i, Expr value) {
      solved.insert(solved.begin(), free_[i]);
      values.insert(values.begin(), value);
      free_.erase(free_.begin() + static_cast<std::ptrdiff_t>(i));
      free_by_velocity_.erase(free_by_velocity_.begin() + static_cast<std::ptrdiff_t>(i));
    };
    const auto solution = [&](Expr e) {
      for (std::size_t i = solved.size(); i-- > 0;) e = put(e, {solved[i]}, {values[i]});
      return e;
    };
    for (const Expr constraint : put_masses(*c_.model, c_.constraints)) {
      const Expr phi = shorter(solution(constraint));
      const Column by = gradient(phi, free_);
      if (std::any_of(by.begin(), by.end(), [&](Expr e) { return contains(e, free_); })) return false;
      const Linear l = linear(phi, free_);
      double largest = 0;
      std::vector<std::size_t> in;
      for (std::size_t i = 0; i < free_.size(); ++i)
        if (!is_zero(l.by[i])) in.push_back(i), largest = std::max(largest, std::abs(at_(l.by[i])));
      if (!(largest > 0)) return false;
      std::size_t best = free_.size(), cost = SIZE_MAX;
      for (const std::size_t i : in)
        if (const double size = std::abs(at_(l.by[i])); size >= kPivot * largest)
          if (const std::size_t c = is_constant(l.by[i]) ? 0 : nodes(l.by[i]); c < cost) best = i, cost = c;
      if (cost > 0 && in.size() == 2 && is_zero(l.rest)) {
        // a v + b w = 0 without division: v = -b u, w = a u.
        const Expr a = l.by[in[0]], b = l.by[in[1]], u = g_.quasi(static_cast<std::uint32_t>(fresh_++), 0);
        const Expr u_by_velocity = (a * free_by_velocity_[in[1]] - b * free_by_velocity_[in[0]]) / (pow(a, 2) + pow(b, 2));
        solve(in[1], a * u);
        solve(in[0], -b * u);
        free_.push_back(u);
        free_by_velocity_.push_back(u_by_velocity);
        continue;
      }
      std::vector<Expr> terms{l.rest};
      for (const std::size_t i : in)
        if (i != best) terms.push_back(l.by[i] * free_[i]);
      determinant_.push_back({l.by[best], 2});
      solve(best, shorter(-sum(terms) / l.by[best]));
    }
    if (free_.empty() || free_.size() > kMostVelocities) return false;
    for (Expr v : qd_) velocity_.push_back(shorter(solution(v)));
    return true;
  }

  // The velocities of the weighted points in free_, and from them p: T = 1/2 sum p_i^2 + what is of lower degree.
  bool short_energy() {
    const std::size_t l = free_.size();
    for (const CopiedMechanics::Point& point : c_.points) {
      if (is_zero(point.weight)) continue;
      for (int i = 0; i < 3; ++i) {
        const Expr v = total_derivative(point.place[i]);
        if (!is_zero(v)) points_.push_back({point.weight, linear(shorter(put(v, qd_, velocity_)), free_)});
      }
    }
    Rows M(l, Column(l, zero_));
    for (std::size_t i = 0; i < l; ++i)
      for (std::size_t j = i; j < l; ++j) M[i][j] = M[j][i] = inner(i, j);
    // M = L D L^T, D_k = C_k r_k^2 with C_k constant, p_k = r_k (v_k + sum_j L_jk v_j).
    std::vector<std::size_t> left(l), order;
    for (std::size_t i = 0; i < l; ++i) left[i] = i;
    Column roots;
    Rows above;  // L_jk
    while (!left.empty()) {
      std::size_t best = left.size();
      std::pair<int, std::size_t> cost{3, SIZE_MAX};
      Root root{zero_, zero_, false};
      for (std::size_t x = 0; x < left.size(); ++x) {
        const Expr d = M[left[x]][left[x]];
        if (!(at_(d) > 0)) return false;
        const Root r = root_of(d);
        const std::pair<int, std::size_t> c{is_constant(d) ? 0 : r.whole ? 1 : 2, nodes(d)};
        if (c < cost) best = x, cost = c, root = r;
      }
      const std::size_t k = left[best];
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
      determinant_.push_back({M[k][k], 1});
      Column factors(l, zero_);
      for (const std::size_t j : left)
        if (!is_zero(M[j][k])) factors[j] = tidy(M[j][k] / M[k][k]);
      for (const std::size_t i : left)
        for (const std::size_t j : left)
          if (j >= i && !is_zero(factors[i]) && !is_zero(factors[j])) M[i][j] = M[j][i] = tidy(M[i][j] - factors[i] * M[j][k]);
      order.push_back(k);
      roots.push_back(root.varying);
      inertia_.push_back(root.constant);
      above.push_back(std::move(factors));
    }
    // Backwards: the last one first.
    free_by_p_.assign(l, Column(l, zero_));
    for (std::size_t i = l; i-- > 0;) {
      const std::size_t k = order[i];
      Expr forward = free_[k];
      for (std::size_t j = 0; j < l; ++j) forward += above[i][j] * free_[j];
      p_by_free_.insert(p_by_free_.begin(), roots[i] * forward);
      free_by_p_[k][i] = pow(roots[i], -1);
      for (std::size_t x = i + 1; x < l; ++x) {
        std::vector<Expr> terms;
        for (std::size_t j = 0; j < l; ++j)
          if (!is_zero(above[i][j]) && !is_zero(free_by_p_[j][x])) terms.push_back(-(above[i][j] * free_by_p_[j][x]));
        if (!terms.empty()) free_by_p_[k][x] = tidy(sum(terms));
      }
    }
    return true;
  }

  Expr inner(std::size_t i, std::size_t j) {
    std::vector<Expr> terms;
    for (const auto& [weight, e] : points_)
      if (!is_zero(e.by[i]) && !is_zero(e.by[j])) terms.push_back(weight * e.by[i] * e.by[j]);
    return terms.empty() ? zero_ : tidy(sum(terms));
  }

  // As short as a person would write it.
  Expr tidy(Expr e) {
    const std::size_t size = nodes(e);
    return size <= 3 || size > kShortEnough ? e : arranged(e, {});
  }

  // e = constant varying^2, where `whole`: without a root.
  struct Root {
    Expr constant, varying;
    bool whole;
  };
  Root root_of(Expr e) {
    if (g_.node(e.id).kind == Kind::sum && g_.terms(e.id).size() == 1) {
      const Term t = g_.terms(e.id)[0];
      const Root r = root_of(Expr{&g_, t.node});
      return {g_.rational(t.weight) * r.constant, r.varying, r.whole};
    }
    std::vector<std::pair<Expr, Rational>> factors{{e, Rational(1)}}, constant, out, rest;
    if (g_.node(e.id).kind == Kind::product) {
      factors.clear();
      for (const Term& t : g_.terms(e.id)) factors.push_back({Expr{&g_, t.node}, g_.rational(t.weight)});
    }
    for (const auto& [base, exponent] : factors)
      if (is_constant(base)) constant.push_back({base, exponent});
      else if (const Rational half = exponent / 2; half.get_den() == 1) out.push_back({base, half});
      else rest.push_back({base, exponent});
    return {g_.product(constant), g_.product(out) * sqrt(g_.product(rest)), rest.empty()};
  }

  std::optional<QuasiVelocities> equations() {
    const std::size_t n = q_.size(), l = free_.size(), states = c_.state_rates.size();
    QuasiVelocities r;
    r.count = l;
    Column ps, free, rates_of_states;
    for (std::size_t i = 0; i < l; ++i) ps.push_back(p(i));
    for (const Column& row : free_by_p_) free.push_back(dot(row, ps));
    r.velocities = put(velocity_, free_, free);
    Column first = qd_, on_first = r.velocities;
    for (Expr rate : put_masses(*c_.model, c_.state_rates)) rates_of_states.push_back(put(rate, qd_, r.velocities));
    for (std::size_t i = 0; i < states; ++i) first.push_back(g_.state(static_cast<std::uint32_t>(i), 1)), on_first.push_back(rates_of_states[i]);
    // sum_c m_c e_ci . e_cj', j = l for e_c0.
    std::vector<std::pair<Expr, Column>> points;
    for (const auto& [weight, e] : points_) {
      Column by = e.by * free_by_p_;
      by.push_back(e.rest);
      for (Expr& x : by) x = tidy(x);
      points.push_back({weight, std::move(by)});
    }
    const auto moved = [&](std::size_t i, std::size_t j) {
      Column by_velocity(n, zero_);
      std::vector<Expr> terms;
      for (const auto& [weight, e] : points) {
        if (is_zero(e[i]) || is_zero(e[j])) continue;
        const Column gradient = anholon::gradient(e[j], q_);
        for (std::size_t a = 0; a < n; ++a)
          if (!is_zero(gradient[a])) by_velocity[a] += weight * e[i] * gradient[a];
        if (const Expr rest = put(put(total_derivative(e[j]), qd_, Column(n, zero_)), first, on_first); !is_zero(rest)) terms.push_back(weight * e[i] * rest);
      }
      for (std::size_t a = 0; a < n; ++a)
        if (!is_zero(by_velocity[a])) terms.push_back(tidy(by_velocity[a]) * r.velocities[a]);
      return terms.empty() ? zero_ : sum(terms);
    };
    Rows A(l, Column(l, zero_));
    for (std::size_t i = 0; i < l; ++i)
      for (std::size_t j = i + 1; j < l; ++j) {
        const Expr one = moved(i, j), other = moved(j, i);
        A[i][j] = nodes(one) <= nodes(other) ? one : -other;
        A[j][i] = -A[i][j];
      }
    const Column Q = pullback(r.velocities, put(put_masses(*c_.model, c_.forces), qd_, r.velocities), ps);
    r.of_state = put(p_by_free_, free_, free_by_velocity_);
    System& s = r.system;
    s = derived_;
    s.model = c_.model;
    s.constraints.clear();
    s.of_motion = n;
    s.equations.clear();
    s.equation_names.resize(n);
    s.variable_names.resize(n);
    for (std::size_t a = 0; a < n; ++a) s.equations.push_back(qd_[a] - r.velocities[a]);
    const auto add = [&](std::size_t state, Expr rate, std::string name) {
      s.equations.push_back(g_.state(static_cast<std::uint32_t>(state), 1) - rate);
      s.equation_names.push_back(name);
      s.variable_names.push_back(std::move(name));
    };
    for (std::size_t i = 0; i < states; ++i) add(i, rates_of_states[i], derived_.equation_names[derived_.mechanical() + i]);
    for (std::size_t i = 0; i < l; ++i) {
      add(states + i, (Q[i] - moved(i, l) - dot(A[i], ps)) / inertia_[i], "p" + std::to_string(i + 1));
    }
    const Column second = jets(*c_.model, 2), accelerations = total_derivative(r.velocities);
    for (Expr e : c_.others) {
      r.others.push_back(put(put(e, second, accelerations), first, on_first));
      for (NodeId id : symbols({&r.others.back(), 1}))
        if (const Node& symbol = g_.node(id); symbol.kind == Kind::multiplier || (symbol.kind == Kind::jet && symbol.order > 0)) return std::nullopt;
    }
    r.determinant = g_.one();
    for (const auto& [factor, exponent] : determinant_)
      if (!is_constant(factor)) r.determinant = r.determinant * pow(factor, exponent);
    r.determinant = tidy(r.determinant);
    if (is_constant(r.determinant)) r.determinant = g_.one();
    return r;
  }

  const System& derived_;
  CopiedMechanics c_;
  Graph& g_;
  PointValues at_;
  Column q_, qd_;
  Expr zero_;
  std::size_t fresh_ = 0;
  Column free_, free_by_velocity_, velocity_;
  std::vector<std::pair<Expr, Linear>> points_;
  Rows free_by_p_;
  Column p_by_free_, inertia_;  // T = 1/2 sum inertia_i p_i^2 + …
  std::vector<std::pair<Expr, Rational>> determinant_;
};

}  // namespace

std::optional<QuasiVelocities> quasi_velocities(const System& derived, const Mechanics& m, std::span<const Expr> others, const std::function<double(const Node&)>& symbol) {
  const auto of_first_order = [&](std::size_t r) { return m.order[r] == 1 && !m.model->constraints[r].by; };
  if (!m.model->masses.empty() || !std::all_of(derived.constraints.begin(), derived.constraints.end(), of_first_order)) return std::nullopt;
  return Writer(derived, m, others, symbol).run();
}

}  // namespace anholon
