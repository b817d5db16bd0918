#include "integrate/series/events.h"

#include <algorithm>

#include "integrate/series/sign_change.h"

namespace anholon {

namespace {

// Values below kNoise round-offs of the terms that they are made of are zero; events nearer than kOneMoment round-offs
// are at one moment.
constexpr int kNoise = 64, kOneMoment = 64;
// A value that a restart leaves at zero was not much farther from zero before.
constexpr int kMargin = 16;
// If a series changes its sign more often than this in one step, further changes are not found.
constexpr int kMostCrossings = 1000;

// Returns the sign that a series takes right after 0, in the direction of h.
template <Number N>
int side_after(const N* c, int degree, const N& h, const N& floor) {
  if (abs(c[0]) > floor) return c[0] > N(0) ? 1 : -1;
  N power(1);
  for (int k = 1; k <= degree; ++k) {
    power = power * h;
    const N term = c[k] * power;
    if (abs(term) > floor) return term > N(0) ? 1 : -1;
  }
  return 0;
}

// Returns the coefficients of p(x + shift), by Horner's scheme.
template <Number N>
std::vector<N> shifted(const N* c, int degree, const N& shift) {
  std::vector<N> a(c, c + degree + 1);
  for (int k = 0; k < degree; ++k)
    for (int j = degree - 1; j >= k; --j) a[static_cast<std::size_t>(j)] += shift * a[static_cast<std::size_t>(j) + 1];
  return a;
}

}  // namespace

// Moves x nearer to the zero of the formula, as long as the formula's values fall and are above `floor`.
template <Number N>
static N improved(const N* c, int degree, N x, const N& h, const N& floor,
                  const std::function<std::optional<N>(const N&)>& value) {
  constexpr int kSteps = 4;
  // A series this far from its formula does not represent it.
  const N range = h * N(1e-2);
  std::optional<N> v = value(x);
  for (int k = 0; k < kSteps && v && (*v > floor || *v < -floor); ++k) {
    N slope(0);
    for (int j = degree; j >= 1; --j) slope = slope * x + c[j] * N(j);
    if (!(abs(slope) > N(0))) break;
    const N change = *v / slope, next = x - change;
    if (!(abs(change) < abs(range)) || (next > N(0)) != (h > N(0)) || abs(next) > abs(h)) break;
    const std::optional<N> there = value(next);
    if (!there || !(abs(*there) < abs(*v))) break;
    x = next;
    v = there;
  }
  return x;
}

template <Number N>
void EventWatch<N>::restart() {
  for (std::size_t i = 0; i < sides_.size(); ++i)
    sides_[i] = i < at_zero_.size() && at_zero_[i] ? (sides_[i] > 0 ? 2 : sides_[i] < 0 ? -2 : 0) : 0;
}

// Returns all crossings within (0, h], up to the first one that ends the step.
template <Number N>
std::vector<typename EventWatch<N>::Crossing>
EventWatch<N>::crossings(const N* c, int degree, const N& h, const N& floor, const WatchedSeries& s, int side) {
  const int forward = h > N(0) ? 1 : -1;
  std::vector<Crossing> list;
  N from(0), noise = floor;
  std::vector<N> p(c, c + degree + 1);
  for (int k = 0; side != 0 && k < kMostCrossings; ++k) {
    std::vector<N> turned = p;
    if (side < 0)
      for (N& x : turned) x = -x;
    const auto x = first_below<N>(turned.data(), degree, N(h - from), noise);
    if (!x) break;
    side = -side;
    list.push_back({N(from + *x), side});
    if (s.ends_step && s.fires(side * forward)) break;
    if (*x == N(0) && k > 0) break;
    from = list.back().where;
    p = shifted(c, degree, from);
    // Far from the expansion, the terms that cancel at a crossing are larger.
    N terms(0), power(1);
    for (int j = 0; j <= degree; ++j, power *= from) terms += abs(c[j] * power);
    const N there = unit_roundoff<N>() * N(kNoise) * terms;
    noise = floor < there ? there : floor;
  }
  return list;
}

template <Number N>
double EventWatch<N>::log_reach(std::size_t i, double log_tolerance) const {
  const N floor = unit_roundoff<N>() * N(kNoise) * known_[i].terms;
  return anholon::log_reach<N>(known_[i].c.data(), degree_, floor, log_tolerance);
}

template <Number N>
double EventWatch<N>::log_reach(double log_tolerance) const {
  double reach = 300;
  for (std::size_t i = 0; i < known_.size(); ++i) reach = std::min(reach, log_reach(i, log_tolerance));
  return reach;
}

template <Number N>
std::size_t EventWatch<N>::least_known(double log_tolerance) const {
  std::size_t least = 0;
  for (std::size_t i = 1; i < known_.size(); ++i)
    if (log_reach(i, log_tolerance) < log_reach(least, log_tolerance)) least = i;
  return least;
}

template <Number N>
bool EventWatch<N>::has_series(const Known& known) {
  return std::all_of(known.c.begin(), known.c.end(), [](const N& x) { return is_finite(x); });
}

template <Number N>
bool EventWatch<N>::have_series() const {
  return std::all_of(known_.begin(), known_.end(), has_series);
}

template <Number N>
bool EventWatch<N>::without_series() const {
  for (std::size_t i = 0; i < series_.size(); ++i)
    if (series_[i].of_state && !has_series(known_[i])) return true;
  return false;
}

template <Number N>
bool EventWatch<N>::as_foretold(const N& where, double log_tolerance, const ValueThere& value,
                                const MadeOf& made_of) const {
  // The measure is that of the steps of the motion (end_check.cpp). If the formula has no value, the motion ends.
  constexpr double kTolerances = 100, kRoundoffs = 4096;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const WatchedSeries& s = series_[i];
    const N* c = known_[i].c.data();
    if (!s.of_state || !has_series(known_[i])) continue;
    std::optional<N> is = value(s.quadrature);
    if (!is) continue;
    if (known_[i].begins) *is -= *known_[i].begins;
    if (!is_finite(*is)) return false;
    N terms = known_[i].terms, power(1);
    for (int k = 0; k <= degree_; ++k, power *= where) terms = std::max(terms, N(abs(N(c[k] * power))));
    if (const N size = abs(*is); size > terms) terms = size;
    const N most = std::max(N(N(exp(N(log_tolerance))) * N(kTolerances)), N(unit_roundoff<N>() * N(kRoundoffs)));
    const N miss = abs(N(*is - value_at(c, degree_, where)));
    if (!(miss <= most * terms) && !(miss <= unit_roundoff<N>() * N(kRoundoffs) * made_of(s.quadrature))) return false;
  }
  return true;
}

// The round-off of a value from its terms, and from the rounding of the time at which it is taken.
template <Number N>
N EventWatch<N>::noise(std::size_t i, const N& t) const {
  return unit_roundoff<N>() * N(kNoise) * (known_[i].terms + abs(known_[i].c[1]) * abs(t));
}

template <Number N>
bool EventWatch<N>::may_pass_near(const N& t, const N& where, const N& within) const {
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const N* c = known_[i].c.data();
    if (!has_series(known_[i])) return true;
    N slope(0);
    for (int k = degree_; k >= 1; --k) slope = slope * where + c[k] * N(k);
    const N way = N(2) * abs(slope) * within + N(kMargin) * noise(i, t);
    if (!(abs(value_at(c, degree_, where)) > way)) return true;
  }
  return false;
}

// Returns all crossings that values at the ends of parts of (0, h] show, up to the first one that ends the step.
template <Number N>
std::vector<typename EventWatch<N>::Crossing> EventWatch<N>::crossings_of_values(const WatchedSeries& s, int& side,
                                                                                 const N& h, const Values& values) {
  constexpr int kParts = 32, kHalvings = 120;
  const int forward = h > N(0) ? 1 : -1;
  std::vector<Crossing> list;
  const auto sign_at = [&](const N& x) {
    const std::optional<N> v = values(s.quadrature, x);
    return !v ? 0 : *v > N(0) ? 1 : *v < N(0) ? -1 : 0;
  };
  int now = side;
  N from(0);
  for (int i = 1; i <= kParts; ++i) {
    const N to = h * N(i) / N(kParts);
    const int there = sign_at(to);
    if (there == 0) continue;
    if (now == 0) {
      now = side = there;
    } else if (there != now) {
      N low = from, high = to;
      for (int k = 0; k < kHalvings; ++k) {
        const N middle = (low + high) / N(2);
        if (middle == low || middle == high) break;
        (sign_at(middle) == there ? high : low) = middle;
      }
      now = there;
      list.push_back({high, there});
      if (s.ends_step && s.fires(there * forward)) break;
    }
    from = to;
  }
  return list;
}

template <Number N>
std::vector<Fired<N>> EventWatch<N>::look(const N& t, N& h, const std::optional<N>& kink, const Values& values) {
  sides_before_ = sides_;
  at_zero_before_ = at_zero_;
  const N eps = unit_roundoff<N>();
  const int forward = h > N(0) ? 1 : -1;
  std::vector<std::vector<Crossing>> each;
  std::vector<N> floors;
  bool ended = false;
  N end = h;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const WatchedSeries& s = series_[i];
    const N* c = known_[i].c.data();
    const N floor = noise(i, t);
    floors.push_back(floor);
    if (s.of_state && !has_series(known_[i])) {
      if (is_finite(c[0]) && abs(c[0]) > N(0) && sides_[i] == 0) sides_[i] = c[0] > N(0) ? 1 : -1;
      if (abs(sides_[i]) > 1) sides_[i] /= 2;
      each.push_back(crossings_of_values(s, sides_[i], h, values));
      if (each[i].empty() || !s.ends_step || !s.fires(each[i].back().towards * forward)) continue;
      if (!ended || abs(each[i].back().where) < abs(end)) end = each[i].back().where, ended = true;
      continue;
    }
    if (sides_[i] == 0)
      sides_[i] = side_after(c, degree_, h, floor);
    else if (abs(sides_[i]) > 1)
      sides_[i] = abs(c[0]) > floor ? (c[0] > N(0) ? 1 : -1) : sides_[i] / 2;
    each.push_back(crossings(c, degree_, h, floor, s, sides_[i]));
    // Beyond a kink the series do not follow the formula, which may touch zero there and turn.
    if (s.of_state && kink && !each[i].empty() && !(abs(each[i].back().where) < abs(*kink))) {
      const std::optional<N> there = values(s.quadrature, h);
      if (there && !(each[i].back().towards > 0 ? *there > N(0) : *there < N(0))) each[i].pop_back();
    }
    if (s.of_state)
      for (Crossing& x : each[i])
        x.where = improved<N>(c, degree_, x.where, h, known_[i].begins ? floor : N(0), [&](const N& where) {
          const std::optional<N> v = values(s.quadrature, where);
          return v && known_[i].begins ? std::optional<N>(N(*v - *known_[i].begins)) : v;
        });
    if (each[i].empty() || !s.ends_step || !s.fires(each[i].back().towards * forward)) continue;
    if (!ended || abs(each[i].back().where) < abs(end)) end = each[i].back().where, ended = true;
  }
  // An event a few round-offs behind the end belongs to the step.
  const N slack = ended ? N(eps * N(kOneMoment) * (abs(t) > abs(end) ? N(abs(t)) : N(abs(end)))) : N(0);
  std::vector<Fired<N>> fired;
  for (std::size_t i = 0; i < each.size(); ++i)
    for (const Crossing& x : each[i]) {
      if (abs(x.where) > abs(end) + slack) break;
      sides_[i] = x.towards;
      if (series_[i].fires(x.towards * forward))
        fired.push_back({i, ended && !(abs(x.where) < abs(end) - slack) ? end : x.where});
    }
  std::stable_sort(fired.begin(), fired.end(),
                   [](const Fired<N>& a, const Fired<N>& b) { return abs(a.where) < abs(b.where); });
  if (ended) h = end;
  at_zero_.clear();
  for (std::size_t i = 0; i < series_.size(); ++i)
    at_zero_.push_back(!(abs(value_at(known_[i].c.data(), degree_, h)) > floors[i] * N(kMargin)));
  for (const Fired<N>& f : fired)
    if (!(abs(f.where) < abs(h))) at_zero_[f.series] = false;
  return fired;
}

template class EventWatch<double>;
template class EventWatch<long double>;
template class EventWatch<Quad>;
template class EventWatch<Multi>;

}  // namespace anholon
