#include "integrate/events.h"

#include <algorithm>

#include "integrate/crossing.h"

namespace anholon {

namespace {

// Values below so many round-offs of what they are made of are zero; events nearer than so many round-offs are at one moment.
constexpr int kNoise = 64, kOneMoment = 64;
// More changes of sign than this in one step are not told apart.
constexpr int kMostCrossings = 1000;

// The sign that a series takes right after 0, in the direction of h.
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

// p(x + shift), by Horner's scheme.
template <Number N>
std::vector<N> shifted(const N* c, int degree, const N& shift) {
  std::vector<N> a(c, c + degree + 1);
  for (int k = 0; k < degree; ++k)
    for (int j = degree - 1; j >= k; --j) a[static_cast<std::size_t>(j)] += shift * a[static_cast<std::size_t>(j) + 1];
  return a;
}

}  // namespace

// All within (0, h], up to the first that ends the step.
template <Number N>
std::vector<typename EventWatch<N>::Crossing> EventWatch<N>::crossings(const N* c, int degree, const N& h, const N& floor, const WatchedSeries& s, int side) {
  std::vector<Crossing> list;
  N from(0);
  std::vector<N> p(c, c + degree + 1);
  for (int k = 0; side != 0 && k < kMostCrossings; ++k) {
    std::vector<N> turned = p;
    if (side < 0)
      for (N& x : turned) x = -x;
    const auto x = first_below<N>(turned.data(), degree, N(h - from), floor);
    if (!x) break;
    side = -side;
    list.push_back({N(from + *x), side});
    if (s.ends_step && s.fires(side)) break;
    if (*x == N(0) && k > 0) break;
    from = list.back().where;
    p = shifted(c, degree, from);
  }
  return list;
}

template <Number N>
double EventWatch<N>::log_reach(const Expansion<N>& e, int degree, double log_tolerance) const {
  double reach = 300;
  for (const WatchedSeries& s : series_) {
    const N floor = unit_roundoff<N>() * N(kNoise) * e.quadrature_terms(s.quadrature);
    reach = std::min(reach, anholon::log_reach<N>(e.quadrature(s.quadrature), degree, floor, log_tolerance));
  }
  return reach;
}

template <Number N>
std::vector<Fired<N>> EventWatch<N>::look(const Expansion<N>& e, int degree, const N& t, N& h) {
  const N eps = unit_roundoff<N>();
  std::vector<std::vector<Crossing>> each;
  bool ended = false;
  N end = h;
  for (std::size_t i = 0; i < series_.size(); ++i) {
    const WatchedSeries& s = series_[i];
    const N* c = e.quadrature(s.quadrature);
    // What a value is made of, and the rounding of the time at which it is taken.
    const N floor = eps * N(kNoise) * (e.quadrature_terms(s.quadrature) + abs(c[1]) * abs(t));
    if (sides_[i] == 0) sides_[i] = side_after(c, degree, h, floor);
    each.push_back(crossings(c, degree, h, floor, s, sides_[i]));
    if (each[i].empty() || !s.ends_step || !s.fires(each[i].back().towards)) continue;
    if (!ended || abs(each[i].back().where) < abs(end)) end = each[i].back().where, ended = true;
  }
  // What lies a few round-offs behind the end belongs to it.
  const N slack = ended ? N(eps * N(kOneMoment) * (abs(t) > abs(end) ? N(abs(t)) : N(abs(end)))) : N(0);
  std::vector<Fired<N>> fired;
  for (std::size_t i = 0; i < each.size(); ++i)
    for (const Crossing& x : each[i]) {
      if (abs(x.where) > abs(end) + slack) break;
      sides_[i] = x.towards;
      if (series_[i].fires(x.towards)) fired.push_back({i, ended && !(abs(x.where) < abs(end) - slack) ? end : x.where});
    }
  std::stable_sort(fired.begin(), fired.end(), [](const Fired<N>& a, const Fired<N>& b) { return abs(a.where) < abs(b.where); });
  if (ended) h = end;
  return fired;
}

template class EventWatch<double>;
template class EventWatch<long double>;
template class EventWatch<Quad>;
template class EventWatch<Multi>;

}  // namespace anholon
