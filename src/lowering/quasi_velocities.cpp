#include "lowering/quasi_velocities.h"

#include <algorithm>

#include "lowering/admissible_velocities.h"
#include "lowering/copied_mechanics.h"
#include "lowering/short_energy.h"

namespace anholon {

namespace {

// With more velocities, the energy is not short in any choice of them.
constexpr std::size_t kMostVelocities = 4;

class Writer {
 public:
  Writer(const System& derived, const Mechanics& m, std::span<const Expr> others,
         const std::function<double(const Node&)>& symbol, std::string& why)
      : derived_(derived), why_(why), c_(copied_mechanics(m, derived, others)), g_(*c_.model->graph),
        at_([this, symbol](const Node& n) { return stands_for(n) ? value_of_[n.index - n_] : symbol(n); }),
        q_(jets(*c_.model, 0)), qd_(jets(*c_.model, 1)), n_(q_.size()), zero_(g_.zero()), v_(qd_, at_, tidy_) {}

  std::optional<QuasiVelocities> run() {
    if (!v_.solve(put_masses(*c_.model, c_.constraints)))
      return none("the constraint '" + name_of(v_.refused) + "' " + v_.why);
    if (v_.free.empty()) return none("the constraints leave no velocity free");
    if (v_.free.size() > kMostVelocities)
      return none("the constraints leave " + std::to_string(v_.free.size()) +
                  " velocities free, and independent ones are found for at most " + std::to_string(kMostVelocities));
    if (!use_names()) return none("a constraint has a part without velocities");
    for (Expr v : qd_) velocity_.push_back(tidy_(v_.solved(v)));
    read_points();
    if (!energy_.diagonalize(mass_matrix(), v_.free, at_, tidy_, [this](Expr e) { return one_series(e); }))
      return none("the formulas of independent velocities grow long");
    return equations();
  }

 private:
  std::nullopt_t none(std::string why) const {
    why_ = std::move(why);
    return std::nullopt;
  }
  // Returns the name of a constraint of the derived system.
  const std::string& name_of(std::size_t k) const { return derived_.model->constraints[derived_.constraints[k]].name; }

  Expr p(std::size_t i) { return g_.state(static_cast<std::uint32_t>(c_.state_rates.size() + i), 0); }

  // Gives an expression that is used more than once a series of its own: otherwise products would be split, and
  // computed anew each time.
  Expr one_series(Expr e) {
    const Node& n = g_.node(e.id);
    const bool simple = n.kind != Kind::product && n.kind != Kind::sum;
    if (simple || is_constant(e)) return e;
    const auto [at, fresh] = series_.try_emplace(e.id, rates_.size());
    if (fresh) value_of_.push_back(at_(e)), rates_.push_back(e);
    return g_.jet(static_cast<std::uint32_t>(n_ + at->second), 0);
  }
  bool stands_for(const Node& n) const { return n.kind == Kind::jet && n.index >= n_; }
  bool holds_accelerations(const Column& es) const {
    const std::vector<NodeId> all = symbols(es);
    return std::any_of(all.begin(), all.end(), [&](NodeId id) {
      const Node& n = g_.node(id);
      return n.kind == Kind::jet && n.order > 1 && !stands_for(n);
    });
  }

  // Expresses named velocities in the free ones. Returns false if a velocity is not homogeneous in them.
  bool use_names() {
    const std::size_t l = v_.free.size();
    for (std::size_t i = 0; i < l; ++i) used_by_free_.push_back(Column(l, zero_)), used_by_free_[i][i] = g_.one();
    used_ = v_.free;
    for (std::size_t s = 0; s < v_.named.size(); ++s) {
      const auto [by, rest] = linear(v_.definitions[s], used_, tidy_);
      if (!is_zero(rest)) return false;
      Column row = by * used_by_free_;
      for (Expr& x : row) x = one_series(x);
      used_by_free_.push_back(std::move(row));
      used_.push_back(v_.named[s]);
    }
    return true;
  }

  // Reads the velocities of the weighted points, component by component, in used_.
  void read_points() {
    for (const CopiedMechanics::Point& point : c_.points) {
      if (is_zero(point.weight)) continue;
      for (int i = 0; i < 3; ++i) {
        const Expr v = total_derivative(point.place[i]);
        if (!is_zero(v)) points_.push_back({point.weight, linear(v_.solved(v), used_, tidy_)});
      }
      bounds_.push_back(points_.size());
    }
  }

  Rows mass_matrix() {
    const std::size_t l = v_.free.size(), n = used_.size();
    Rows M(l, Column(l, zero_)), local(n, Column(n, zero_));
    // Squares of sines and cosines sum to one within one point.
    std::size_t first = 0;
    for (const std::size_t end : bounds_) {
      for (std::size_t s = 0; s < n; ++s)
        for (std::size_t t = s; t < n; ++t) {
          std::vector<Expr> terms;
          for (std::size_t c = first; c < end; ++c)
            if (const auto& [weight, e] = points_[c]; !is_zero(e.by[s]) && !is_zero(e.by[t]))
              terms.push_back(weight * e.by[s] * e.by[t]);
          if (!terms.empty()) local[s][t] = local[s][t] + tidy_(sum(terms));
        }
      first = end;
    }
    for (std::size_t s = 0; s < n; ++s)
      for (std::size_t t = s; t < n; ++t) local[t][s] = local[s][t] = tidy_(local[s][t]);
    for (std::size_t i = 0; i < l; ++i)
      for (std::size_t j = i; j < l; ++j) {
        std::vector<Expr> terms{zero_};
        for (std::size_t s = 0; s < n; ++s)
          for (std::size_t t = 0; t < n; ++t)
            if (!is_zero(local[s][t]) && !is_zero(used_by_free_[s][i]) && !is_zero(used_by_free_[t][j]))
              terms.push_back(local[s][t] * used_by_free_[s][i] * used_by_free_[t][j]);
        M[i][j] = M[j][i] = v_.named.empty() ? tidy_(sum(terms)) : sum(terms);
      }
    return M;
  }

  std::optional<QuasiVelocities> equations() {
    const std::size_t l = v_.free.size(), states = c_.state_rates.size();
    const Column given_forces = put_masses(*c_.model, c_.forces), given_rates = put_masses(*c_.model, c_.state_rates);
    if (holds_accelerations(given_forces)) return none("a force holds accelerations");
    if (holds_accelerations(given_rates)) return none("the rate of a state holds accelerations");
    QuasiVelocities r;
    r.count = l;
    r.inertia = energy_.inertia;
    r.clears_poles = v_.clears_poles;
    Column ps;
    for (std::size_t i = 0; i < l; ++i)
      ps.push_back(p(i)), c_.model->names.states.push_back("p" + std::to_string(i + 1));
    r.of_state = v_.in_velocities(energy_.p_by_v);
    // If all formulas are short, splitting them costs less than series.
    const bool apart = rates_.empty();
    const Column free = energy_.v_in(ps, [&](Expr e) { return apart ? e : one_series(e); });
    Column values = free;
    for (std::size_t s = l; s < used_.size(); ++s) values.push_back(one_series(dot(used_by_free_[s], free)));
    r.velocities = put(velocity_, used_, values);
    on_velocities_ = {qd_, r.velocities};
    Column rates;
    for (std::size_t i = 0; i < states; ++i) rates.push_back(put(given_rates[i], qd_, r.velocities));
    for (std::size_t i = 0; i < states; ++i)
      on_velocities_.first.push_back(g_.state(static_cast<std::uint32_t>(i), 1)),
          on_velocities_.second.push_back(rates[i]);
    const Rows A = gyroscopic(r.velocities);
    // Forces on the used velocities come first, because there sines and cosines combine.
    Column forces = pullback(velocity_, put(given_forces, qd_, r.velocities), used_);
    for (Expr& f : forces) f = tidy_(f);
    const Column Q = forces * used_by_free_ * energy_.v_by_p;
    ps.push_back(g_.one());
    for (std::size_t i = 0; i < l; ++i) rates.push_back((Q[i] - dot(A[i], ps)) / energy_.inertia[i]);
    const Column second = jets(*c_.model, 2), accelerations = total_derivative(r.velocities);
    for (Expr e : c_.others) {
      r.others.push_back(on_velocities(put(e, second, accelerations)));
      for (NodeId id : symbols({&r.others.back(), 1}))
        if (const Node& n = g_.node(id);
            n.kind == Kind::multiplier || (n.kind == Kind::jet && n.order > 0 && !stands_for(n)))
          return none("a formula holds multipliers or accelerations");
    }
    r.determinant = determinant();
    r.system = first_order_system(r.velocities, rates);
    return r;
  }

  // Makes the system q' = velocities with the rates of the states.
  System first_order_system(const Column& velocities, const Column& rates) const {
    System s = derived_;
    s.model = c_.model;
    s.constraints.clear();
    s.of_motion = n_;
    s.equations = qd_ - velocities;
    s.equation_names.resize(n_);
    s.variable_names.resize(n_);
    for (std::size_t i = 0; i < rates.size(); ++i) {
      s.equations.push_back(g_.state(static_cast<std::uint32_t>(i), 1) - rates[i]);
      for (auto* names : {&s.equation_names, &s.variable_names}) names->push_back(c_.model->names.states[i]);
    }
    s.rates = rates_;
    s.scales = scales();
    return s;
  }

  // Quasi-velocities have the scales of the velocities that they represent, apart from coordinates.
  std::vector<std::uint32_t> scales() const {
    const std::size_t states = c_.state_rates.size(), all = derived_.scales.size();
    std::vector<std::uint32_t> list(derived_.scales.begin(),
                                    derived_.scales.begin() + static_cast<std::ptrdiff_t>(all ? n_ : 0));
    list.resize(n_);
    for (std::size_t i = 0; i < states; ++i) list.push_back(all ? derived_.scales[all - states + i] : 0);
    const std::uint32_t velocities = *std::max_element(list.begin(), list.end()) + 1;
    for (std::size_t i = 0; i < v_.free.size(); ++i) {
      const std::uint32_t coordinate = g_.node(v_.free[energy_.pivot(i)].id).index;
      list.push_back(velocities + (coordinate < n_ ? list[coordinate] : 0));
    }
    return list;
  }

  Expr determinant() {
    std::vector<std::pair<Expr, Rational>> factors;
    for (Expr d : energy_.pivots)
      if (!is_constant(d)) factors.push_back({d, Rational(1)});
    for (Expr a : v_.pivots)
      if (!is_constant(a)) factors.push_back({a, Rational(2)});
    const Expr d = tidy_(g_.product(factors));
    return is_constant(d) ? g_.one() : d;
  }

  Expr on_velocities(Expr e) const { return put(e, on_velocities_.first, on_velocities_.second); }

  // Returns in row i: A_ij, then sum_c m_c e_ci . e_c0'.
  Rows gyroscopic(const Column& velocities) {
    const std::size_t l = v_.free.size();
    Rows used_by_p;
    for (const Column& row : used_by_free_) used_by_p.push_back(row * energy_.v_by_p);
    std::vector<std::pair<Expr, Column>> points;
    for (const auto& [weight, e] : points_) {
      Column by = e.by * used_by_p;
      by.push_back(e.rest);
      for (Expr& x : by) x = tidy_(x);
      points.push_back({weight, std::move(by)});
    }
    const auto moved = [&](std::size_t i, std::size_t j) {  // sum_c m_c e_ci . e_cj'
      Column by_velocity(n_, zero_);
      std::vector<Expr> terms{zero_};
      for (const auto& [weight, e] : points) {
        if (is_zero(e[i]) || is_zero(e[j])) continue;
        const Expr of = written_out(e[j], n_, rates_);
        const Column gradient = anholon::gradient(of, q_);
        for (std::size_t a = 0; a < n_; ++a)
          if (!is_zero(gradient[a])) by_velocity[a] = by_velocity[a] + weight * e[i] * gradient[a];
        if (const Expr rest = on_velocities(put(total_derivative(of), qd_, Column(n_, zero_))); !is_zero(rest))
          terms.push_back(weight * e[i] * rest);
      }
      for (std::size_t a = 0; a < n_; ++a)
        if (!is_zero(by_velocity[a])) terms.push_back(tidy_(by_velocity[a]) * velocities[a]);
      return sum(terms);
    };
    Rows A(l, Column(l + 1, zero_));
    for (std::size_t i = 0; i < l; ++i) {
      for (std::size_t j = i + 1; j < l; ++j) {
        // The simpler expression is differentiated.
        const auto length = [&](std::size_t k) {
          std::size_t all = 0;
          for (const auto& [weight, e] : points)
            if (!is_zero(e[i]) && !is_zero(e[j])) all += node_count(written_out(e[k], n_, rates_));
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
  std::string& why_;
  CopiedMechanics c_;
  Graph& g_;
  PointValues at_;
  Tidy tidy_;
  Column q_, qd_;
  std::size_t n_;
  Expr zero_;
  AdmissibleVelocities v_;
  ShortEnergy energy_;
  Column velocity_, used_;  // q' in terms of used_: the free velocities, and names
  Rows used_by_free_;
  std::vector<std::pair<Expr, Linear>> points_;
  std::vector<std::size_t> bounds_;          // the end of each weighted point among points_
  std::pair<Column, Column> on_velocities_;  // q' and z', and their expressions
  Column rates_;                             // jets of coordinates n + k represent these expressions
  std::vector<double> value_of_;
  std::unordered_map<NodeId, std::size_t> series_;
};

}  // namespace

std::optional<QuasiVelocities> quasi_velocities(const System& derived, const Mechanics& m, std::span<const Expr> others,
                                                const std::function<double(const Node&)>& symbol, std::string& why) {
  const std::vector<Constraint>& constraints = m.model->constraints;
  if (!m.model->masses.empty()) why = "a mass varies";
  for (const std::size_t r : derived.constraints)
    if (constraints[r].by)
      why = "an input keeps the constraint '" + constraints[r].name + "'";
    else if (m.order[r] != 1)
      why = "the constraint '" + constraints[r].name + "' is of order " + std::to_string(m.order[r]);
  if (!why.empty()) return std::nullopt;
  return Writer(derived, m, others, symbol, why).run();
}

}  // namespace anholon
