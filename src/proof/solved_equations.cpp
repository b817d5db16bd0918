#include "proof/solved_equations.h"

#include <algorithm>

#include "base/diagnostic.h"
#include "expr/normal.h"

namespace anholon {

namespace {

// The solution of psi = 0 for the symbol s in which it is affine or quadratic. `sign`: the sign of a root.
struct Solved {
  Expr value;
  bool by_root = false;  // the value contains `sign`
};

std::optional<Solved> solved_for(Expr psi, Expr s, Expr sign) {
  const auto holds_s = [&](Expr e) {
    const std::vector<NodeId> ids = symbols({&e, 1});
    return std::binary_search(ids.begin(), ids.end(), s.id);
  };
  const auto at_zero = [&](Expr e) { return put(e, {s}, {psi.graph->zero()}); };
  try {
    const Expr slope = partial(psi, s);
    Expr curve = partial(slope, s);
    if (const auto full = expanded(curve)) curve = *full;
    if (holds_s(curve)) return std::nullopt;
    const Expr c = at_zero(psi), b = at_zero(slope);
    if (proved_zero(curve)) return proved_zero(b) ? std::nullopt : std::optional(Solved{-(c / b)});
    const Expr a = Rational(1, 2) * curve;
    if (proved_zero(b)) return Solved{sign * sqrt(-(c / a)), true};
    return Solved{(sign * sqrt(b * b - 4 * (a * c)) - b) / (2 * a), true};
  } catch (const Failure&) {
    return std::nullopt;  // a denominator vanishes with s
  }
}

}  // namespace

bool SolvedEquations::add(Expr psi, Column& open) {
  constexpr std::uint32_t kFirstSign = 100'000;  // beyond all quasi-velocities
  constexpr std::size_t kMostSigns = 4;
  psi = put(psi, symbols_, values_);
  // Affine equations come before quadratic ones: a root makes all later expressions longer.
  std::size_t best = open.size();
  std::optional<Solved> found;
  const Expr sign = psi.graph->quasi(kFirstSign + static_cast<std::uint32_t>(signs_.size()), 0);
  for (std::size_t j = 0; j < open.size(); ++j) {
    const auto v = solved_for(psi, open[j], sign);
    if (!v || (found && reachable({&found->value, 1}).size() <= reachable({&v->value, 1}).size())) continue;
    best = j;
    found = v;
  }
  if (!found || (found->by_root && signs_.size() == kMostSigns)) return false;
  values_ = put(values_, {open[best]}, {found->value});
  symbols_.push_back(open[best]);
  values_.push_back(found->value);
  if (found->by_root) signs_.push_back(sign);
  open.erase(open.begin() + static_cast<std::ptrdiff_t>(best));
  return true;
}

Column SolvedEquations::branches(Expr e) const {
  try {
    Column list;
    const Expr on = put(e, symbols_, values_);
    for (unsigned branch = 0; branch < 1U << signs_.size(); ++branch) {
      Column signs;
      for (std::size_t k = 0; k < signs_.size(); ++k) signs.push_back(e.graph->number(branch >> k & 1 ? -1 : 1));
      list.push_back(put(on, signs_, signs));
    }
    return list;
  } catch (const Failure&) {
    return {};
  }
}

}  // namespace anholon
