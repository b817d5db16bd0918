#include "contact/law/round_off.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/law/consistent_modes.h"
#include "contact/law/rows.h"

namespace anholon {

void RoundOff::segment_has_ended(long double length) {
  length_ = length;
  reached_.assign(contacts_.size(), false);
}

bool RoundOff::closed(std::size_t c) const { return reached_[c] || dynamics_.place(c).gap <= uncertainty(c); }

// The error with which an event is located, relative to a unit or to the size of the model.
static constexpr long double kMissed = 1e-8L;

bool RoundOff::negligible(std::size_t c) const { return dynamics_.place(c).gap > 0 || missed(c); }

bool RoundOff::missed(std::size_t c) const {
  constexpr long double kFactor = 1000;
  return std::abs(dynamics_.place(c).gap) < std::max(kMissed, kFactor * uncertainty(c));
}

bool RoundOff::gap_is_round_off(std::size_t c) const {
  return terms(c).largest > std::abs(dynamics_.place(c).gap_rate * at_.t.get_d());
}

RoundOff::Terms RoundOff::terms(std::size_t c) const {
  const std::vector<long double>& normal = dynamics_.accelerations().contacts[c].normal;
  Terms found;
  const auto add = [&](long double term) {
    found.largest = std::max(found.largest, std::abs(term));
    found.sum += std::abs(term);
  };
  long double rest = dynamics_.place(c).gap;
  for (std::size_t a = 0; a < normal.size(); ++a) {
    const long double term = normal[a] * at_.q[a];
    rest -= term;
    add(term);
  }
  add(rest);
  return found;
}

long double RoundOff::depth(std::size_t c) const {
  constexpr long double kDepth = 2e-14L;
  return kDepth * std::max(place_size(c), terms(c).sum);
}

bool RoundOff::negligible_at_start(std::size_t c) const {
  const long double largest = terms(c).largest;
  return negligible(c) && dynamics_.place(c).gap >= -std::max(kMissed * largest, uncertainty(c));
}

long double RoundOff::uncertainty(std::size_t c) const {
  constexpr long double kClosed = 1e-12L, kMoved = 16 * std::numeric_limits<double>::epsilon();
  long double fastest = 0;
  for (std::size_t a = 0; a < at_.q.size(); ++a)
    fastest = std::max(fastest, std::abs(dynamics_.accelerations().contacts[c].normal[a] * dynamics_.most(a)));
  return kClosed * place_size(c) +
         kMoved * (length_ * fastest + std::abs(at_.t.get_d()) * std::abs(dynamics_.place(c).gap_rate));
}

long double RoundOff::late() const {
  constexpr long double kTime = 16 * std::numeric_limits<double>::epsilon();
  return length_ > 0 ? 1 + kTime * std::abs(at_.t.get_d()) / (length_ * kSame) : 1;
}

long double RoundOff::place_size(std::size_t c) const {
  long double size = 1e-300L;
  for (std::size_t a = 0; a < at_.q.size(); ++a) {
    const long double term = std::abs(dynamics_.accelerations().contacts[c].normal[a]) * (1 + std::abs(at_.q[a]));
    if (std::isfinite(term)) size = std::max(size, term);
  }
  return size;
}

long double RoundOff::gap_rate(std::size_t c) const {
  constexpr long double kZero = 1e-12L;
  const long double v = dynamics_.place(c).gap_rate;
  long double size = 0;
  for (std::size_t a = 0; a < at_.q.size(); ++a)
    size = std::max(size, std::abs(dynamics_.accelerations().contacts[c].normal[a] * dynamics_.most(a)));
  return std::abs(v) <= kZero * size ? 0 : v;
}

// The acceleration with which a gap would close without contacts.
long double RoundOff::pressed(std::size_t c) const {
  const ContactProblem& p = dynamics_.accelerations();
  const auto free = of_modes(p, ContactModes(contacts_.size()));
  if (!free) return 0;
  long double a = p.contacts[c].normal_rate;
  for (std::size_t i = 0; i < free->x.size(); ++i) a += p.contacts[c].normal[i] * free->x[i];
  return std::max(-a, 0.0L);
}

// True if the deceleration a ends a velocity within the round-off of the place.
bool RoundOff::hardly_moves(std::size_t c, long double v, long double a) const {
  return a > 0 && v * v <= 2 * a * kPlace * place_size(c);
}

bool RoundOff::hardly_rises(std::size_t c) const {
  return hardly_moves(c, gap_rate(c), pressed(c)) || hardly_moves(c, gap_rate(c), pressed_by_others(c));
}

// The acceleration with which a gap would close while other contacts touch that are at rest or hardly rise: a disc that
// spins on a floor is driven against a wall by friction alone.
long double RoundOff::pressed_by_others(std::size_t c) const {
  ContactProblem p = dynamics_.accelerations();
  const ContactRows own = p.contacts[c];
  bool any = false;
  for (std::size_t o = 0; o < p.contacts.size(); ++o) {
    ContactRows& rows = p.contacts[o];
    if (rows.under) continue;
    rows.may_touch = o != c && closed(o) && (gap_rate(o) == 0 || hardly_moves(o, gap_rate(o), pressed(o)));
    any = any || rows.may_touch;
    if (!rows.may_touch) rows.normal.assign(p.b.size(), 0), rows.normal_rate = 0;
  }
  if (!any) return 0;
  const std::vector<ContactSolution> list = consistent_modes(p);
  if (list.size() != 1) return 0;
  long double a = own.normal_rate;
  for (std::size_t i = 0; i < list[0].x.size(); ++i) a += own.normal[i] * list[0].x[i];
  return std::max(-a, 0.0L);
}

bool RoundOff::hardly_slips(std::size_t c) const {
  const auto& slip = dynamics_.place(c).slip;
  return contacts_[c].rough() &&
         hardly_moves(c, std::hypot(slip[0], slip[1]), dynamics_.accelerations().contacts[c].friction * pressed(c));
}

}  // namespace anholon
