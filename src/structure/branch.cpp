#include "structure/branch.h"

#include <algorithm>
#include <cstdint>

namespace anholon {

bool may_branch(const Mechanics& m, const System& s, std::size_t r) {
  const Graph& g = m.graph();
  if (m.order[r] < 2) return false;
  for (NodeId id : symbols(m.Phi[r])) {
    const Node& n = g.node(id);
    if (n.kind == Kind::jet && static_cast<int>(n.order) == m.order[r])
      return std::find(s.constraints.begin(), s.constraints.end(), r) != s.constraints.end();
  }
  return false;
}

Column nonlinear_in_forces(const Mechanics& m, const std::vector<int>& d) {
  Column list;
  Graph& g = m.graph();
  const int least = *std::min_element(d.begin(), d.begin() + static_cast<std::ptrdiff_t>(m.q.size()));
  const auto leads = [&](NodeId id) {
    const Node& n = g.node(id);
    return n.kind == Kind::jet && static_cast<int>(n.order) == d[n.index];
  };
  const auto holds_leading = [&](Expr e) {
    const std::vector<NodeId> met = symbols({&e, 1});
    return std::any_of(met.begin(), met.end(), leads);
  };
  for (const Column* forces : {&m.Q, &m.QR, &m.QD})
    for (Expr force : *forces) {
      if (jet_order(force) < least) continue;
      for (NodeId id : symbols({&force, 1})) {
        const Expr x{&g, id};
        if (leads(id) && holds_leading(partial(force, x)) &&
            std::none_of(list.begin(), list.end(), [&](Expr other) { return other.id == id; }))
          list.push_back(x);
      }
    }
  return list;
}

static bool constraints_may_branch(const Mechanics& m, const System& s) {
  return std::any_of(s.constraints.begin(), s.constraints.end(), [&](std::size_t r) { return may_branch(m, s, r); });
}

bool may_branch(const Mechanics& m, const System& s, const Structure& t) {
  return constraints_may_branch(m, s) || !nonlinear_in_forces(m, t.d).empty();
}

StageEquation law(const System& s, std::size_t i, unsigned k) {
  const Expr e = put_state_rates(*s.model, total_derivative(s.equations[i], k), 2);
  const std::string& name = s.equation_names[i];
  if (i < s.coordinates) return {e, "the equation of motion of '" + name + "'", {}};
  if (i >= s.mechanical()) return {e, "the rate of '" + name + "'", s.model->states[i - s.mechanical()].span};
  return {e, "constraint '" + name + "'", s.model->constraints[s.constraints[i - s.coordinates]].span};
}

bool leads_beyond_rate(const System& s, const Structure& t, std::size_t j) { return j >= s.mechanical() && t.d[j] > 1; }

std::vector<StageEquation> leading_equations(const System& s, const Structure& t) {
  Graph& g = *s.model->graph;
  const auto rate_is_known = [&](NodeId id) {
    const Node n = g.node(id);
    return n.kind == Kind::state && n.order == 1 && leads_beyond_rate(s, t, s.mechanical() + n.index)
               ? put_masses(*s.model, s.model->states[n.index].rate)
               : Expr{};
  };
  std::vector<StageEquation> list;
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (leads_beyond_rate(s, t, i)) continue;
    StageEquation e = law(s, i, static_cast<unsigned>(t.c[i]));
    e.residual = substitute({&e.residual, 1}, rate_is_known)[0];
    list.push_back(std::move(e));
  }
  return list;
}

Column leading_unknowns(const System& s, const Structure& t) {
  Column list;
  for (std::size_t j = 0; j < s.size(); ++j)
    if (!leads_beyond_rate(s, t, j)) list.push_back(s.symbol(j, static_cast<unsigned>(t.d[j])));
  return list;
}

namespace {

constexpr int kMostNewton = 60, kNearStarts = 8;
// The search from random starts ends after this number of starts in a row without a new solution; the second number
// holds as long as none of the solutions is wanted.
constexpr int kInVain = 24, kInVainWithoutWanted = 160, kMostRandomStarts = 600;
constexpr std::size_t kFlipsUpTo = 8;  // coordinates whose signs are flipped one by one
constexpr double kSame = 1e-6;         // solutions at a smaller distance count as one
constexpr double kSingular = 1e-9;     // smallest scaled singular value
// The same threshold for random starts of Newton's method, which come close to points at which the equations do not
// determine the motion.
constexpr double kClearlyRegular = 1e-4;

// Returns the next random number, from -1000 to 1000, the same on every machine.
int thousandths(std::uint64_t& random) {
  random = random * 6364136223846793005U + 1442695040888963407U;
  return static_cast<int>((random >> 33U) % 2001U) - 1000;
}

unsigned orders(const System& s, const Structure& t) {
  unsigned bits = 0;
  for (std::size_t j = 0; j < s.coordinates; ++j) bits |= 1U << t.d[j];
  return bits;
}

template <class T>
std::vector<T> part(const std::vector<T>& all, std::size_t from, std::size_t to) {
  return {all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(to)};
}

template <Number N>
class Search {
 public:
  Search(const Mechanics& m, const System& s, const Structure& t, const std::vector<N>& parameters,
         InitialState<N> state, const MayBeTaken<N>& wanted)
      : m_(m), s_(s), parameters_(parameters), wanted_(wanted), n_(s.coordinates), equations_(leading_equations(s, t)),
        unknowns_(leading_unknowns(s, t)), all_(m, equations_, unknowns_, 0, parameters), metric_(orders(s, t)),
        constraints_(m, part(equations_, n_, s.mechanical()), part(unknowns_, 0, n_), metric_, parameters),
        motion_(m, part(equations_, 0, n_), part(unknowns_, n_, s.mechanical()), 0, parameters),
        state_(std::move(state)) {
    if (constraints_may_branch(m, s)) return;
    for (const Expr& x : nonlinear_in_forces(m, t.d)) nonlinear_.push_back(m.graph().node(x.id).index);
  }

  LeadingSolutions<N> run() {
    without_nonlinear_constraints();
    guess_ = jets();
    try_from(guess_);
    const N size = length();
    if (!out_.found.empty()) {
      const std::vector<N> first = part(out_.found[0], 0, n_);
      std::vector<N> mirrored = first, opposite = first;
      for (std::size_t a = 0; a < n_; ++a) mirrored[a] = N(2) * guess_[a] - first[a], opposite[a] = -first[a];
      try_from(mirrored);
      try_from(opposite);
      for (std::size_t a = 0; a < n_ && n_ <= kFlipsUpTo; ++a) {
        std::vector<N> flipped = first;
        flipped[a] = -flipped[a];
        try_from(flipped);
      }
    }
    along_the_reaction(size);
    for (int k = 0; k < kNearStarts; ++k) {
      std::vector<N> x = guess_;
      for (std::size_t a = 0; a < n_; ++a)
        x[a] += size *
                N(static_cast<int>((static_cast<unsigned>(k + 1) * 2654435761U + static_cast<unsigned>(a) * 40503U) %
                                   2001U) -
                  1000) /
                N(700);
      try_from(x);
    }
    // If all starts have led to points at which the equations do not determine the motion, further starts would as
    // well.
    if (!out_.singular || !out_.found.empty()) start_at_random(size);
    sort();
    return out_;
  }

 private:
  // Starts farther away, until starts find nothing new.
  void start_at_random(const N& size) {
    least_singular_value_ = kClearlyRegular;
    std::uint64_t random = 1;
    const auto enough = [&] {
      return std::any_of(out_.found.begin(), out_.found.end(), wanted_) ? kInVain : kInVainWithoutWanted;
    };
    for (int k = 0, in_vain = 0; k < kMostRandomStarts && in_vain < enough(); ++k) {
      std::vector<N> x = guess_;
      for (N& v : x) {
        v += size * N(1 + k / 2 % 6) * N(thousandths(random)) / N(1000);
      }
      const std::size_t before = out_.found.size();
      if (k % 2 == 0)
        try_from(x);
      else
        try_freely(x, random);
      in_vain = out_.found.size() > before ? 0 : in_vain + 1;
    }
  }

  std::vector<N> jets() {
    std::vector<N> x;
    for (std::size_t a = 0; a < n_; ++a) x.push_back(constraints_.x(state_, a));
    return x;
  }
  bool guessed() {
    for (std::size_t a = 0; a < n_; ++a)
      if (*state_.origin(constraints_.unknown(a)) == Origin::guessed) return true;
    return false;
  }
  N length() {
    N size(1);
    for (const std::vector<N>& x : out_.found)
      for (std::size_t a = 0; a < n_; ++a)
        if (abs(x[a]) > size) size = abs(x[a]);
    return size;
  }

  // Computes accelerations with zero multipliers of the nonlinear constraints; Gauss' principle measures changes from
  // them.
  void without_nonlinear_constraints() {
    if (metric_ != 1U << 2 || guessed() || !constraints_may_branch(m_, s_)) return;
    std::vector<StageEquation> rows = part(equations_, 0, n_);
    Column unknowns = part(unknowns_, 0, n_);
    for (std::size_t i = n_; i < equations_.size(); ++i)
      if (i >= s_.mechanical() || !may_branch(m_, s_, s_.constraints[i - n_]))
        rows.push_back(equations_[i]), unknowns.push_back(unknowns_[i]);
    Stage<N> free(m_, rows, unknowns, metric_, parameters_);
    const InitialState<N> before = state_;
    std::vector<std::size_t> every;
    for (std::size_t j = 0; j < unknowns.size(); ++j) every.push_back(j);
    if (!find_by_least_change(free, state_, every)) state_ = before;
  }

  // Projects the start onto the constraints by least change, finds the best multipliers there, and continues with
  // Newton's method.
  void try_from(const std::vector<N>& start) {
    const InitialState<N> before = state_;
    std::vector<std::size_t> every;
    for (std::size_t a = 0; a < n_; ++a) constraints_.x(state_, a) = start[a], every.push_back(a);
    for (std::size_t j = 0; j < motion_.unknowns(); ++j) motion_.x(state_, j) = N(0);
    if (find_by_least_change(constraints_, state_, every) && multipliers()) newton();
    state_ = before;
  }

  // Applies Newton's method from accelerations that miss the constraints, with random multipliers.
  void try_freely(const std::vector<N>& start, std::uint64_t random) {
    const InitialState<N> before = state_;
    for (std::size_t a = 0; a < n_; ++a) constraints_.x(state_, a) = start[a];
    const bool possible = motion_.evaluate(state_) && multipliers();
    for (std::size_t j = 0; possible && j < motion_.unknowns(); ++j) {
      motion_.x(state_, j) = motion_.x(state_, j) * N(thousandths(random)) / N(250);
    }
    if (possible) newton();
    state_ = before;
  }

  bool multipliers() {
    if (!motion_.evaluate(state_)) return false;
    const std::size_t s = motion_.unknowns();
    Matrix<N> normal(s, s);
    std::vector<N> rhs(s, N(0)), y;
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < s; ++j) {
        for (std::size_t k = 0; k < s; ++k) addmul(normal(j, k), motion_.jacobian(i, j), motion_.jacobian(i, k));
        addmul(rhs[j], N(-motion_.jacobian(i, j)), motion_.residual[i]);
      }
    Lu<N> lu;
    if (!lu.factor(normal)) return true;  // Newton's method may still converge
    lu.solve(rhs, y);
    for (std::size_t j = 0; j < s; ++j) motion_.x(state_, j) += y[j];
    return true;
  }

  void newton() {
    const std::size_t n = all_.unknowns();
    if (!all_.evaluate(state_)) return;
    Lu<N> lu;
    std::vector<N> y, direction;
    for (int k = 0; k < kMostNewton; ++k) {
      const std::vector<N> scale = all_.scale;
      const auto merit = [&] { return all_.worst(scale); };
      const N now = merit();
      const bool solved = !(now > stage_rounding<N>());
      if (!lu.factor(all_.jacobian) || lu.smallest_singular_value(direction) < N(least_singular_value_)) {
        if (to_double(now) < kSame) out_.singular = true;
        return;
      }
      if (solved) return keep();
      std::vector<N> rhs, old;
      for (std::size_t i = 0; i < n; ++i) rhs.push_back(-all_.residual[i]), old.push_back(all_.x(state_, i));
      lu.solve(rhs, y);
      N fraction(1);
      bool better = false;
      for (int halvings = 0; halvings < 10 && !better; ++halvings, fraction = fraction * N(0.5)) {
        for (std::size_t i = 0; i < n; ++i) all_.x(state_, i) = old[i] + fraction * y[i];
        better = all_.evaluate(state_) && merit() <= now * (N(1) - fraction * N(0.1));
      }
      if (!better) return;
    }
  }

  void keep() {
    std::vector<N> x;
    N size(1);
    for (std::size_t j = 0; j < all_.unknowns(); ++j) {
      x.push_back(all_.x(state_, j));
      if (abs(x[j]) > size) size = abs(x[j]);
    }
    // Sets to zero what the start has left in numbers that are zero.
    for (N& v : x)
      if (abs(v) < size * unit_roundoff<N>() * N(0.001)) v = N(0);
    for (const std::vector<N>& other : out_.found) {
      bool same = true;
      for (std::size_t j = 0; j < x.size(); ++j) {
        const N scale = abs(x[j]) > N(1) ? abs(x[j]) : N(1);
        same = same && abs(N(x[j] - other[j])) < N(kSame) * scale;
      }
      if (same) return;
    }
    out_.found.push_back(x);
  }

  // Tries q^(m) along and against the reaction E - G (theory: initial-data).
  void along_the_reaction(const N& size) {
    const InitialState<N> before = state_;
    for (std::size_t j = 0; j < motion_.unknowns(); ++j) motion_.x(state_, j) = N(0);
    if (!motion_.evaluate(state_) || !constraints_.evaluate(state_)) return;
    const std::vector<N> reaction = motion_.residual;
    state_ = before;
    N largest(0);
    for (const N& v : reaction)
      if (abs(v) > largest) largest = abs(v);
    if (!(largest > N(0))) return;
    for (int sign : {1, -1}) {
      std::vector<N> x = guess_;
      for (std::size_t a = 0; a < n_; ++a) x[a] += N(sign) * size * reaction[a] / largest;
      try_from(x);
    }
  }

  void sort() {
    for (std::size_t a = 0; a < n_; ++a) constraints_.x(state_, a) = guess_[a];
    if (!constraints_.evaluate(state_)) return;
    // Where forces alone are nonlinear, the others of the leading derivatives follow from those in them, which may have no
    // inertia.
    const auto distance = [&](const std::vector<N>& x) {
      N sum(0);
      for (const std::size_t a : nonlinear_) sum += (x[a] - guess_[a]) * (x[a] - guess_[a]);
      if (!nonlinear_.empty()) return to_double(sum);
      for (std::size_t a = 0; a < n_; ++a)
        for (std::size_t b = 0; b < n_; ++b) sum += (x[a] - guess_[a]) * constraints_.metric(a, b) * (x[b] - guess_[b]);
      return to_double(sum);
    };
    const auto pushes = [&](const std::vector<N>& x) {
      double sum = 0;
      for (std::size_t j = n_; j < x.size(); ++j) sum += to_double(x[j]);
      return sum;
    };
    std::stable_sort(out_.found.begin(), out_.found.end(),
                     [&](const std::vector<N>& x, const std::vector<N>& y) { return distance(x) < distance(y); });
    // Of equally near solutions, takes the one with the larger multipliers.
    std::size_t best = 0;
    for (std::size_t k = 1; k < out_.found.size() && distance(out_.found[k]) <= distance(out_.found[0]) * (1 + kSame);
         ++k)
      if (pushes(out_.found[k]) > pushes(out_.found[best])) best = k;
    if (best > 0)
      std::rotate(out_.found.begin(), out_.found.begin() + static_cast<std::ptrdiff_t>(best),
                  out_.found.begin() + static_cast<std::ptrdiff_t>(best) + 1);
  }

  const Mechanics& m_;
  const System& s_;
  const std::vector<N>& parameters_;
  const MayBeTaken<N>& wanted_;
  std::size_t n_;
  std::vector<StageEquation> equations_;
  Column unknowns_;
  Stage<N> all_;
  unsigned metric_;
  Stage<N> constraints_, motion_;
  InitialState<N> state_;
  std::vector<N> guess_;
  std::vector<std::size_t> nonlinear_;  // the coordinates in which forces are nonlinear, without nonlinear constraints
  double least_singular_value_ = kSingular;
  LeadingSolutions<N> out_;
};

}  // namespace

template <Number N>
LeadingSolutions<N> leading_solutions(const Mechanics& m, const System& s, const Structure& t,
                                      const std::vector<N>& parameters, InitialState<N> state,
                                      const MayBeTaken<N>& wanted) {
  return Search<N>(m, s, t, parameters, std::move(state), wanted).run();
}

template LeadingSolutions<double> leading_solutions<double>(const Mechanics&, const System&, const Structure&,
                                                            const std::vector<double>&, InitialState<double>,
                                                            const MayBeTaken<double>&);
template LeadingSolutions<long double> leading_solutions<long double>(const Mechanics&, const System&, const Structure&,
                                                                      const std::vector<long double>&,
                                                                      InitialState<long double>,
                                                                      const MayBeTaken<long double>&);
template LeadingSolutions<Quad> leading_solutions<Quad>(const Mechanics&, const System&, const Structure&,
                                                        const std::vector<Quad>&, InitialState<Quad>,
                                                        const MayBeTaken<Quad>&);
template LeadingSolutions<Multi> leading_solutions<Multi>(const Mechanics&, const System&, const Structure&,
                                                          const std::vector<Multi>&, InitialState<Multi>,
                                                          const MayBeTaken<Multi>&);

}  // namespace anholon
