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
// A matrix of longer entries is not eliminated.
constexpr std::size_t kLongest = 100;

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

// sum_i a_i b_i
Expr dot(const Column& a, const Column& b) {
  std::vector<Expr> terms{a[0].graph->zero()};
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!is_zero(a[i]) && !is_zero(b[i])) terms.push_back(a[i] * b[i]);
  return sum(terms);
}

bool is_constant(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (const Kind k = e.graph->node(id).kind; k != Kind::pi && k != Kind::parameter) return false;
  return true;
}

// 0: constant.
std::size_t varying_nodes(Expr e) {
  const std::vector<NodeId> all = reachable({&e, 1});
  return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](NodeId id) { return !is_constant({e.graph, id}); }));
}

bool contains(Expr e, const Column& v) {
  for (NodeId id : symbols({&e, 1}))
    if (std::any_of(v.begin(), v.end(), [&](Expr x) { return x.id == id; })) return true;
  return false;
}

// As short as a person would write it, if that is soon found.
class Tidy {
 public:
  Expr operator()(Expr e) {
    const std::size_t size = nodes(e);
    if (size < kShort || size > kLong) return e;
    const auto [known, fresh] = known_.try_emplace(e.id, e);
    if (!fresh) return known->second;
    const std::optional<NormalForm> plain = normal_form(e, {}, kWork);
    return plain ? known->second = arranged(e, {}, plain) : e;
  }

 private:
  static constexpr std::size_t kShort = 6, kLong = 64;
  static constexpr long kWork = 400;
  std::unordered_map<NodeId, Expr> known_;
};

// sum_j by[j] v_j + rest
struct Linear {
  Column by;
  Expr rest;
};

// Of what is linear in v; what many of them have in common stays so.
Linear linear(Expr e, const Column& v, Tidy& tidy) {
  Column values(v.size(), e.graph->zero());
  Linear l{{}, put(e, v, values)};
  for (Expr& one : values) {
    one = e.graph->one();
    l.by.push_back(tidy(put(e, v, values) - l.rest));
    one = e.graph->zero();
  }
  return l;
}

// The constraints, linear in the velocities, solved one after the other.
class Admissible {
 public:
  Admissible(const Column& qd, PointValues& at, Tidy& t) : free(qd), free_by_velocity_(qd), g_(*qd[0].graph), at_(at), tidy(t), qd_(qd) {}

  Column free;  // the velocities left: of coordinates, or names for others
  // Names for velocities that are used as they are, in the order in which they are defined: in `free` and those before.
  Column named, definitions;

  // False where they are not what this can solve.
  bool solve(const Column& constraints) {
    for (Expr phi : constraints)
      if (!solve(phi)) return false;
    if (free.empty() || free.size() > kMostVelocities) return false;
    for (Expr& d : definitions) d = solved(d);
    return true;
  }
  // In `free` and `named`.
  Expr solved(Expr e) const {
    e = by_points(e);
    for (std::size_t i = 0; i < gone_.size(); ++i) e = put(e, {gone_[i]}, {values_[i]});
    return e;
  }
  // What is given in `free`, in q'.
  Column in_velocities(const Column& es) const { return put(es, free, free_by_velocity_); }
  // What was divided by.
  Column pivots;

 private:
  bool solve(Expr constraint) {
    const Expr by_names = tidy(solved(constraint)), phi = written_out(by_names);
    const Column by = gradient(phi, free);
    if (std::any_of(by.begin(), by.end(), [&](Expr e) { return contains(e, free); })) return false;
    const auto [a, rest] = linear(phi, free, tidy);
    double largest = 0;
    std::vector<std::size_t> in;
    for (std::size_t i = 0; i < free.size(); ++i)
      if (!is_zero(a[i])) in.push_back(i), largest = std::max(largest, std::abs(at_(a[i])));
    if (!(largest > 0)) return false;
    std::size_t best = free.size(), cost = SIZE_MAX;
    for (const std::size_t i : in)
      if (std::abs(at_(a[i])) >= kPivot * largest)
        if (const std::size_t c = varying_nodes(a[i]); c < cost) best = i, cost = c;
    if (cost == 0)
      // A speed that others go on with keeps its name, if it has one.
      if (const auto parts = of_a_point(constraint); parts && partial(by_names, free[best]) == a[best]) {
        pivots.push_back(a[best]);
        define(best, tidy(-put(by_names, {free[best]}, {g_.zero()}) / a[best]));
        keep(*parts);
        return true;
      }
    if (cost > 0 && in.size() == 2 && is_zero(rest)) {
      // a v + b w = 0 without division: v = -b u, w = a u.
      const std::size_t v = in[0], w = in[1];
      const Expr u = name(), by_velocity = (a[v] * free_by_velocity_[w] - a[w] * free_by_velocity_[v]) / (pow(a[v], 2) + pow(a[w], 2));
      remove(w, a[v] * u);
      remove(v, -a[w] * u);
      free.push_back(u);
      free_by_velocity_.push_back(by_velocity);
    } else {
      std::vector<Expr> terms{rest};
      for (const std::size_t i : in)
        if (i != best) terms.push_back(a[i] * free[i]);
      pivots.push_back(a[best]);
      remove(best, tidy(-sum(terms) / a[best]));
    }
    return true;
  }

  // Sums that go on from the velocity of a point.
  Expr by_points(Expr e) const {
    if (points_.empty()) return e;
    std::unordered_map<NodeId, Expr> image;
    for (NodeId id : reachable({&e, 1}))
      if (g_.node(id).kind == Kind::sum)
        for (auto point = points_.rbegin(); point != points_.rend() && !image.count(id); ++point)
          if (const std::optional<Expr> rest = without(id, point->first.id)) image.emplace(id, *rest + point->second);
    return replace_nodes({&e, 1}, image)[0];
  }

  // The sum less another one that it contains, term by term.
  std::optional<Expr> without(NodeId whole, NodeId part) const {
    const std::span<const Term> terms = g_.terms(whole), taken = g_.terms(part);
    std::vector<std::pair<Rational, Expr>> rest;
    std::size_t found = 0;
    for (const Term& t : terms)
      if (found < taken.size() && t.node == taken[found].node && t.weight == taken[found].weight) ++found;
      else rest.push_back({g_.rational(t.weight), Expr{&g_, t.node}});
    return found == taken.size() ? std::optional<Expr>(g_.sum(rest)) : std::nullopt;
  }

  // Without names.
  Expr written_out(Expr e) const {
    for (std::size_t i = named.size(); i-- > 0;) e = put(e, {named[i]}, {solved(definitions[i])});
    return e;
  }

  Expr name() { return g_.quasi(static_cast<std::uint32_t>(names_++), 0); }

  void erase(std::size_t i) {
    free.erase(free.begin() + static_cast<std::ptrdiff_t>(i));
    free_by_velocity_.erase(free_by_velocity_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  void remove(std::size_t i, Expr value) {
    gone_.push_back(free[i]);
    values_.push_back(value);
    erase(i);
  }
  void define(std::size_t i, Expr value) {
    named.push_back(free[i]);
    definitions.push_back(value);
    erase(i);
  }

  // a X + b Y = 0 where the velocity (X, Y) of a point stands as it is: that has the direction (-b, a).
  std::optional<std::pair<Linear, Linear>> of_a_point(Expr phi) {
    if (g_.node(phi.id).kind != Kind::sum || g_.terms(phi.id).size() != 2) return std::nullopt;
    std::vector<Linear> parts;
    const std::vector<Term> terms(g_.terms(phi.id).begin(), g_.terms(phi.id).end());
    for (const Term& t : terms) {
      if (g_.node(t.node).kind != Kind::product) return std::nullopt;
      std::vector<std::pair<Expr, Rational>> factors;
      std::optional<Expr> velocity;
      for (const Term& f : g_.terms(t.node))
        if (const Expr e{&g_, f.node}; !contains(e, qd_)) factors.push_back({e, g_.rational(f.weight)});
        else if (velocity || g_.node(f.node).kind != Kind::sum || g_.rational(f.weight) != 1) return std::nullopt;
        else velocity = e;
      if (!velocity) return std::nullopt;
      const Rational weight = g_.rational(t.weight);
      parts.push_back({{weight * g_.product(factors)}, *velocity});
    }
    return std::pair(parts[0], parts[1]);
  }

  // Its speed has a name from now on.
  void keep(const std::pair<Linear, Linear>& parts) {
    const Expr a = parts.first.by[0], b = parts.second.by[0], X = parts.first.rest, Y = parts.second.rest, u = name();
    const Expr speed = tidy(solved(a * Y - b * X) / (pow(a, 2) + pow(b, 2)));
    named.push_back(u);
    definitions.push_back(speed);
    points_.push_back({X, -b * u});
    points_.push_back({Y, a * u});
  }

  Column free_by_velocity_;
  Graph& g_;
  PointValues& at_;
  Tidy& tidy;
  const Column& qd_;
  std::size_t names_ = 0;
  Column gone_, values_;
  std::vector<std::pair<Expr, Expr>> points_;  // components of velocities, and what they are
};

// T = 1/2 sum inertia_i p_i^2 + what is of lower degree in p, inertia constant.
class ShortEnergy {
 public:
  Rows free_by_p;
  Column p_by_free, inertia, determinant;

  // The free velocities in p, by their names where one is made of others.
  Column free_velocities(const Column& p, const std::function<Expr(Expr)>& named) const {
    Column v(p.size(), p[0].graph->zero());
    for (std::size_t i = p.size(); i-- > 0;) v[order_[i]] = named(free_by_p[order_[i]][i] * p[i] - dot(above_[i], v));
    return v;
  }

  // M: of the free velocities. False where it does not stay short. `named`: what a root is called.
  bool diagonalize(Rows M, const Column& free, PointValues& at, Tidy& tidy, const std::function<Expr(Expr)>& named) {
    Graph& g = *free[0].graph;
    const std::size_t l = free.size();
    const Expr zero = g.zero();
    // M = L D L^T, D_k = C_k r_k^2 with C_k constant, p_k = r_k (v_k + sum_j L_jk v_j).
    std::vector<std::size_t> left(l);
    for (std::size_t i = 0; i < l; ++i) left[i] = i;
    Column roots;
    std::vector<bool> whole;
    while (!left.empty()) {
      std::size_t best = left.size();
      std::pair<int, std::size_t> cost{3, SIZE_MAX};
      Root root{zero, zero, false};
      for (std::size_t x = 0; x < left.size(); ++x) {
        const Expr d = M[left[x]][left[x]];
        if (!(at(d) > 0)) return false;
        const Root r = root_of(d);
        const std::pair<int, std::size_t> c{is_constant(d) ? 0 : r.whole ? 1 : 2, nodes(d)};
        if (c < cost) best = x, cost = c, root = r;
      }
      const std::size_t k = left[best];
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
      determinant.push_back(M[k][k]);
      Column factors(l, zero);
      for (const std::size_t j : left)
        if (!is_zero(M[j][k])) {
          if (nodes(M[j][k]) + nodes(M[k][k]) > kLongest) return false;
          factors[j] = tidy(M[j][k] / M[k][k]);
        }
      for (const std::size_t i : left)
        for (const std::size_t j : left)
          if (j >= i && !is_zero(factors[i]) && !is_zero(factors[j])) M[i][j] = M[j][i] = tidy(M[i][j] - factors[i] * M[j][k]);
      order_.push_back(k);
      roots.push_back(root.varying);
      whole.push_back(root.whole);
      inertia.push_back(root.constant);
      above_.push_back(std::move(factors));
    }
    // Backwards: the last one first.
    free_by_p.assign(l, Column(l, zero));
    for (std::size_t i = l; i-- > 0;) {
      const std::size_t k = order_[i];
      p_by_free.insert(p_by_free.begin(), roots[i] * (free[k] + dot(above_[i], free)));
      free_by_p[k][i] = pow(roots[i], -1);
      if (!whole[i]) free_by_p[k][i] = named(free_by_p[k][i]);
      for (std::size_t x = i + 1; x < l; ++x) {
        Column of_x;
        for (std::size_t j = 0; j < l; ++j) of_x.push_back(free_by_p[j][x]);
        free_by_p[k][x] = tidy(-dot(above_[i], of_x));
      }
    }
    return true;
  }

 private:
  // e = constant varying^2; `whole`: without a root.
  struct Root {
    Expr constant, varying;
    bool whole;
  };
  static Root root_of(Expr e) {
    Graph& g = *e.graph;
    if (g.node(e.id).kind == Kind::sum && g.terms(e.id).size() == 1) {
      const Term t = g.terms(e.id)[0];
      const Root r = root_of(Expr{&g, t.node});
      return {g.rational(t.weight) * r.constant, r.varying, r.whole};
    }
    std::vector<std::pair<Expr, Rational>> factors{{e, Rational(1)}}, constant, out, rest;
    if (g.node(e.id).kind == Kind::product) {
      factors.clear();
      for (const Term& t : g.terms(e.id)) factors.push_back({Expr{&g, t.node}, g.rational(t.weight)});
    }
    for (const auto& [base, exponent] : factors)
      if (is_constant(base)) constant.push_back({base, exponent});
      else if (const Rational half = exponent / 2; half.get_den() == 1) out.push_back({base, half});
      else rest.push_back({base, exponent});
    return {g.product(constant), g.product(out) * sqrt(g.product(rest)), rest.empty()};
  }

  std::vector<std::size_t> order_;
  Rows above_;  // L_jk
};

class Writer {
 public:
  Writer(const System& derived, const Mechanics& m, std::span<const Expr> others, const std::function<double(const Node&)>& symbol)
      : derived_(derived), c_(copied_mechanics(m, derived, others)), g_(*c_.model->graph), at_([this, symbol](const Node& n) { return stands_for(n) ? value_of_[n.index - n_] : symbol(n); }),
        q_(jets(*c_.model, 0)), qd_(jets(*c_.model, 1)), n_(q_.size()), zero_(g_.zero()), v_(qd_, at_, tidy) {}

  std::optional<QuasiVelocities> run() {
    if (!v_.solve(put_masses(*c_.model, c_.constraints)) || !use_names()) return std::nullopt;
    for (Expr v : qd_) velocity_.push_back(tidy(v_.solved(v)));
    read_points();
    if (!energy_.diagonalize(mass_matrix(), v_.free, at_, tidy, [this](Expr e) { return one_series(e); })) return std::nullopt;
    return equations();
  }

 private:
  Expr p(std::size_t i) { return g_.state(static_cast<std::uint32_t>(c_.state_rates.size() + i), 0); }

  // What is used more than once gets a series of its own: otherwise products would be taken apart, and made anew each time.
  Expr one_series(Expr e) {
    const Node& n = g_.node(e.id);
    const bool simple = n.kind != Kind::product && n.kind != Kind::sum;
    if (simple || is_constant(e)) return e;
    const auto [at, fresh] = series_.try_emplace(e.id, rates_.size());
    if (fresh) value_of_.push_back(at_(e)), rates_.push_back(e);
    return g_.jet(static_cast<std::uint32_t>(n_ + at->second), 0);
  }
  bool stands_for(const Node& n) const { return n.kind == Kind::jet && n.index >= n_; }
  // … written out again.
  Expr whole(Expr e) {
    for (;;) {
      const Expr out = substitute({&e, 1}, [&](NodeId id) { return stands_for(g_.node(id)) ? rates_[g_.node(id).index - n_] : Expr{}; })[0];
      if (out == e) return e;
      e = out;
    }
  }

  // Velocities with a name, in those that are free. False where they are not homogeneous.
  bool use_names() {
    const std::size_t l = v_.free.size();
    for (std::size_t i = 0; i < l; ++i) used_by_free_.push_back(Column(l, zero_)), used_by_free_[i][i] = g_.one();
    used_ = v_.free;
    for (std::size_t s = 0; s < v_.named.size(); ++s) {
      const auto [by, rest] = linear(v_.definitions[s], used_, tidy);
      if (!is_zero(rest)) return false;
      Column row = by * used_by_free_;
      for (Expr& x : row) x = one_series(x);
      used_by_free_.push_back(std::move(row));
      used_.push_back(v_.named[s]);
    }
    return true;
  }

  // Velocities of the weighted points, component by component, in used_.
  void read_points() {
    for (const CopiedMechanics::Point& point : c_.points) {
      if (is_zero(point.weight)) continue;
      for (int i = 0; i < 3; ++i) {
        const Expr v = total_derivative(point.place[i]);
        if (!is_zero(v)) points_.push_back({point.weight, linear(tidy(v_.solved(v)), used_, tidy)});
      }
      bounds_.push_back(points_.size());
    }
  }

  Rows mass_matrix() {
    const std::size_t l = v_.free.size(), n = used_.size();
    Rows M(l, Column(l, zero_)), local(n, Column(n, zero_));
    // What squares of sines and cosines make one is within one point.
    std::size_t first = 0;
    for (const std::size_t end : bounds_) {
      for (std::size_t s = 0; s < n; ++s)
        for (std::size_t t = s; t < n; ++t) {
          std::vector<Expr> terms;
          for (std::size_t c = first; c < end; ++c)
            if (const auto& [weight, e] = points_[c]; !is_zero(e.by[s]) && !is_zero(e.by[t])) terms.push_back(weight * e.by[s] * e.by[t]);
          if (!terms.empty()) local[s][t] = local[s][t] + tidy(sum(terms));
        }
      first = end;
    }
    for (std::size_t s = 0; s < n; ++s)
      for (std::size_t t = s; t < n; ++t) local[t][s] = local[s][t] = tidy(local[s][t]);
    for (std::size_t i = 0; i < l; ++i)
      for (std::size_t j = i; j < l; ++j) {
        std::vector<Expr> terms{zero_};
        for (std::size_t s = 0; s < n; ++s)
          for (std::size_t t = 0; t < n; ++t)
            if (!is_zero(local[s][t]) && !is_zero(used_by_free_[s][i]) && !is_zero(used_by_free_[t][j])) terms.push_back(local[s][t] * used_by_free_[s][i] * used_by_free_[t][j]);
        M[i][j] = M[j][i] = v_.named.empty() ? tidy(sum(terms)) : sum(terms);
      }
    return M;
  }

  std::optional<QuasiVelocities> equations() {
    const std::size_t l = v_.free.size(), states = c_.state_rates.size();
    QuasiVelocities r;
    r.count = l;
    Column ps, rates_of_states;
    for (std::size_t i = 0; i < l; ++i) ps.push_back(p(i));
    // Short formulas alone are better taken apart.
    const bool apart = rates_.empty();
    const Column free = energy_.free_velocities(ps, [&](Expr e) { return apart ? e : one_series(e); });
    Column values = free;
    for (std::size_t s = l; s < used_.size(); ++s) values.push_back(one_series(dot(used_by_free_[s], free)));
    r.velocities = put(velocity_, used_, values);
    Column first = qd_, on_first = r.velocities;
    for (Expr rate : put_masses(*c_.model, c_.state_rates)) rates_of_states.push_back(put(rate, qd_, r.velocities));
    for (std::size_t i = 0; i < states; ++i) first.push_back(g_.state(static_cast<std::uint32_t>(i), 1)), on_first.push_back(rates_of_states[i]);
    const Rows A = gyroscopic(r.velocities, first, on_first);
    // Forces on what is used first, where sines and cosines meet.
    Column forces = pullback(velocity_, put(put_masses(*c_.model, c_.forces), qd_, r.velocities), used_);
    for (Expr& f : forces) f = tidy(f);
    const Column Q = forces * used_by_free_ * energy_.free_by_p;
    r.of_state = v_.in_velocities(energy_.p_by_free);
    System& s = r.system;
    s = derived_;
    s.model = c_.model;
    s.constraints.clear();
    s.of_motion = n_;
    s.equations.clear();
    s.equation_names.resize(n_);
    s.variable_names.resize(n_);
    for (std::size_t a = 0; a < n_; ++a) s.equations.push_back(qd_[a] - r.velocities[a]);
    const auto add = [&](std::size_t state, Expr rate, std::string name) {
      s.equations.push_back(g_.state(static_cast<std::uint32_t>(state), 1) - rate);
      s.equation_names.push_back(name);
      s.variable_names.push_back(std::move(name));
    };
    for (std::size_t i = 0; i < states; ++i) add(i, rates_of_states[i], derived_.equation_names[derived_.mechanical() + i]);
    ps.push_back(g_.one());
    for (std::size_t i = 0; i < l; ++i) add(states + i, (Q[i] - dot(A[i], ps)) / energy_.inertia[i], "p" + std::to_string(i + 1));
    const Column second = jets(*c_.model, 2), accelerations = total_derivative(r.velocities);
    for (Expr e : c_.others) {
      r.others.push_back(put(put(e, second, accelerations), first, on_first));
      for (NodeId id : symbols({&r.others.back(), 1}))
        if (const Node& symbol = g_.node(id); symbol.kind == Kind::multiplier || (symbol.kind == Kind::jet && symbol.order > 0 && !stands_for(symbol))) return std::nullopt;
    }
    r.determinant = g_.one();
    for (Expr d : energy_.determinant)
      if (!is_constant(d)) r.determinant = r.determinant * d;
    for (Expr a : v_.pivots)
      if (!is_constant(a)) r.determinant = r.determinant * pow(a, 2);
    if (is_constant(r.determinant = tidy(r.determinant))) r.determinant = g_.one();
    s.rates = rates_;
    return r;
  }

  // Row i: A_ij, then sum_c m_c e_ci . e_c0'.
  Rows gyroscopic(const Column& velocities, const Column& first, const Column& on_first) {
    const std::size_t l = v_.free.size();
    Rows used_by_p;
    for (const Column& row : used_by_free_) used_by_p.push_back(row * energy_.free_by_p);
    std::vector<std::pair<Expr, Column>> points;
    for (const auto& [weight, e] : points_) {
      Column by = e.by * used_by_p;
      by.push_back(e.rest);
      for (Expr& x : by) x = tidy(x);
      points.push_back({weight, std::move(by)});
    }
    const auto moved = [&](std::size_t i, std::size_t j) {  // sum_c m_c e_ci . e_cj'
      Column by_velocity(n_, zero_);
      std::vector<Expr> terms{zero_};
      for (const auto& [weight, e] : points) {
        if (is_zero(e[i]) || is_zero(e[j])) continue;
        const Expr of = whole(e[j]);
        const Column gradient = anholon::gradient(of, q_);
        for (std::size_t a = 0; a < n_; ++a)
          if (!is_zero(gradient[a])) by_velocity[a] = by_velocity[a] + weight * e[i] * gradient[a];
        if (const Expr rest = put(put(total_derivative(of), qd_, Column(n_, zero_)), first, on_first); !is_zero(rest)) terms.push_back(weight * e[i] * rest);
      }
      for (std::size_t a = 0; a < n_; ++a)
        if (!is_zero(by_velocity[a])) terms.push_back(tidy(by_velocity[a]) * velocities[a]);
      return sum(terms);
    };
    Rows A(l, Column(l + 1, zero_));
    for (std::size_t i = 0; i < l; ++i) {
      for (std::size_t j = i + 1; j < l; ++j) {
        // What is simpler is differentiated.
        const auto length = [&](std::size_t k) {
          std::size_t all = 0;
          for (const auto& [weight, e] : points)
            if (!is_zero(e[i]) && !is_zero(e[j])) all += nodes(whole(e[k]));
          return all;
        };
        const bool forward = length(j) <= length(i);
        A[i][j] = forward ? moved(i, j) : -moved(j, i);
        A[j][i] = -A[i][j];
      }
      A[i][l] = moved(i, l);
    }
    return A;
  }

  const System& derived_;
  CopiedMechanics c_;
  Graph& g_;
  PointValues at_;
  Tidy tidy;
  Column q_, qd_;
  std::size_t n_;
  Expr zero_;
  Admissible v_;
  ShortEnergy energy_;
  Column velocity_, used_;  // q' in used_: what is free, and names
  Rows used_by_free_;
  std::vector<std::pair<Expr, Linear>> points_;
  std::vector<std::size_t> bounds_;  // of each weighted point's among them
  Column rates_;                     // jets of coordinates n + k stand for these
  std::vector<double> value_of_;
  std::unordered_map<NodeId, std::size_t> series_;
};

}  // namespace

std::optional<QuasiVelocities> quasi_velocities(const System& derived, const Mechanics& m, std::span<const Expr> others, const std::function<double(const Node&)>& symbol) {
  const auto of_first_order = [&](std::size_t r) { return m.order[r] == 1 && !m.model->constraints[r].by; };
  if (!m.model->masses.empty() || !std::all_of(derived.constraints.begin(), derived.constraints.end(), of_first_order)) return std::nullopt;
  return Writer(derived, m, others, symbol).run();
}

}  // namespace anholon
