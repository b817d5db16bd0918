#include "linear/steadiness.h"

#include <optional>

namespace anholon {

namespace {

bool no_influence(const LinearModel& m, std::size_t column, const std::vector<bool>& kept, const Multi& zero) {
  for (std::size_t r = 0; r < m.states.size(); ++r)
    if (kept[r] && abs(m.A(r, column)) > zero) return false;
  return true;
}

// Removes coordinates and states of the model without influence on the remaining ones, until none is left.
std::vector<bool> without_cyclic(const LinearModel& m, const LinearPoint& p, std::vector<bool> may, const Multi& zero) {
  std::vector<bool> kept(m.states.size(), true);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i] && may[i] && p.position(i) && no_influence(m, i, kept, zero)) kept[i] = false, again = true;
  }
  return kept;
}

// A smaller rate, in relation to the state, may come from numbers that were copied with sixteen digits.
constexpr double kCopied = 1e-13;

// How the motion is examined. `moving`: the other point lies along the motion; else the coordinates without influence
// have other values there even if they rest. A number that is smaller than `nothing`, in relation to its neighbours, is
// zero.
struct Look {
  bool check, moving;
  Multi nothing;
};

void tell(LinearModel& m, LinearModel::Motion motion, std::string why) {
  m.motion = motion;
  m.why = std::move(why);
}

// Finds the coordinates that have no influence, here and at another point, and whether all others rest.
void look_for_steadiness(const LinearPoint& point, const Look& look, LinearModel& out) {
  const auto& [check, moving, nothing] = look;
  const std::size_t n = out.states.size();
  // These numbers are irrational, because the periods of excitations and roads are often simple fractions, and half of
  // a period looks like rest.
  const Multi later = sqrt(Multi(2)) / Multi(4), away = sqrt(Multi(3)) / Multi(25);
  const Multi zero = nothing * (Multi(1) + largest(out.A.data)), still = nothing * (Multi(1) + largest(point.x));
  std::vector<bool> kept(n, true), may(n, true);
  LinearModel other;
  bool moved = false;
  for (bool again = true; again;) {
    again = false;
    kept = without_cyclic(out, point, may, zero);
    if (!check) break;
    LinearPoint there = point;
    there.t += later;
    for (std::size_t i = 0, k = 0; i < n; ++i)
      if (!kept[i] && (!moving || abs(out.rates[i]) > still))
        there.x[point.independent(i)] += away * Multi(static_cast<int>(++k) + 4) + later * out.rates[i];
    moved = there.evaluate() && there.settle();
    if (!moved) break;
    there.linear(other);
    for (std::size_t i = 0; i < n; ++i)
      if (!kept[i] && !no_influence(other, i, kept, zero)) may[i] = false, again = true;
  }
  out.cyclic.clear(), out.core.clear();
  for (std::size_t i = 0; i < n; ++i) (kept[i] ? out.core : out.cyclic).push_back(i);

  if (!check) return tell(out, LinearModel::Motion::unchecked, "");
  tell(out, LinearModel::Motion::equilibrium, "");
  if (largest(out.rates) > still) out.motion = LinearModel::Motion::steady;
  if (!moved) tell(out, LinearModel::Motion::unchecked, "no other point of the motion was found");
  for (std::size_t i : out.core) {
    // The rate of a coordinate is a velocity, which is a state itself or follows from states.
    if (abs(out.rates[i]) > still) {
      tell(out, LinearModel::Motion::unsteady,
           "the rate of " + out.states[i] + " is " + number_text(to_double(out.rates[i]), 6));
      break;
    }
    if (!moved) continue;
    if (abs(other.rates[i]) > still) {
      tell(out, LinearModel::Motion::unsteady, "the rate of " + out.states[i] + " does not stay 0");
      break;
    }
    bool same = true;
    for (std::size_t k : out.core) same = same && !(abs(Multi(other.A(i, k) - out.A(i, k))) > zero);
    if (!same) {
      tell(out, LinearModel::Motion::unsteady,
           "the coefficients in the equation of " + out.states[i] + " vary along the motion");
      break;
    }
  }
}

// Examines the motion at a point beside it, then along it. A heading that rests may have other values in the same
// motion only if no state is a velocity along fixed axes.
void look_for_steadiness(const LinearPoint& point, bool check, const Multi& nothing, LinearModel& out) {
  look_for_steadiness(point, {check, false, nothing}, out);
  if (out.motion != LinearModel::Motion::unsteady) return;
  LinearModel along = out;
  look_for_steadiness(point, {check, true, nothing}, along);
  if (along.motion != LinearModel::Motion::unsteady) out = std::move(along);
}

// Returns the state that moves most of those that should rest, if a rounded number explains its motion.
std::optional<std::size_t> creeping(const LinearModel& m, const LinearPoint& point) {
  std::optional<std::size_t> most;
  for (const std::size_t i : m.core)
    if (abs(m.rates[i]) > Multi(0) && (!most || abs(m.rates[i]) > abs(m.rates[*most]))) most = i;
  const bool rounded = most && abs(m.rates[*most]) < Multi(kCopied) * (Multi(1) + largest(point.x));
  return rounded ? most : std::nullopt;
}

}  // namespace

void look_for_steadiness(const LinearPoint& point, bool check, LinearModel& out) {
  look_for_steadiness(point, check, round_off(kZeroPart), out);
  if (out.motion != LinearModel::Motion::unsteady) return;
  LinearModel rounded = out;
  look_for_steadiness(point, check, Multi(kCopied), rounded);
  const auto creeps = creeping(rounded, point);
  if (rounded.motion == LinearModel::Motion::unsteady || !creeps) return;
  rounded.notes.push_back("the rate of " + rounded.states[*creeps] + " is " +
                          number_text(to_double(rounded.rates[*creeps]), 6) +
                          ", as of a number rounded to sixteen digits, and counts as 0");
  out = std::move(rounded);
}

}  // namespace anholon
