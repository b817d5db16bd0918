#include "kernel/plan/layout.h"

#include <algorithm>

namespace anholon {

PlanLayout::PlanLayout(const Program& p, const Slots& slots, int stages, Plan& plan)
    : p_(p), slots_(slots), plan_(plan) {
  plan_.stages = stages;
  plan_.c = p_.c;
  plan_.d = p_.d;
  plan_.largest_lead = p_.tape.largest_lead;
  plan_.largest_d = *std::max_element(p_.d.begin(), p_.d.end());
  // An odd stride keeps series off the same cache sets.
  int beyond = std::max(plan_.largest_lead, plan_.largest_d);
  for (const ProgramInput& in : p_.inputs) beyond = std::max(beyond, in.order);
  plan_.stride = static_cast<std::uint32_t>(stages + beyond + 2) | 1U;
  make_coefficients();
  // A vector of coefficients may begin before the first series.
  plan_.arena = std::max(static_cast<std::uint32_t>(plan_.coefficients.size()), std::uint32_t{kBlock});
  for (std::size_t j = 0; j < p_.unknowns(); ++j) plan_.x.push_back(take(plan_.stride));
  plan_.time = take(plan_.stride);
  const std::uint32_t zero = take(plan_.stride);
  place_.resize(slots_.code.size());
  for (std::uint32_t s = 0; s < slots_.code.size(); ++s) {
    if (!slots_.live[s]) continue;
    if (slots_.code[s].constant)
      place_[s] = {coefficient({Rational(1), {s}}), false};
    else
      place_[s] = place_of_series(s, zero);
  }
  for (std::uint32_t s = 0; s < slots_.code.size(); ++s)
    if (slots_.varies(s) && !slots_.series[s]) place_[s] = take_number();
}

// Coefficients come first in the arena, because all of them are made before the first series is placed.
void PlanLayout::make_coefficients() {
  coefficient({Rational(1), {}});
  coefficient({Rational(-1), {}});
  for (std::uint32_t s = 0; s < slots_.code.size(); ++s) {
    if (!slots_.live[s]) continue;
    if (slots_.code[s].constant) coefficient({Rational(1), {s}});
    for (const Slots::Summand& t : slots_.sums[s]) coefficient(t.c);
  }
}

// Inputs are series of the unknowns, of time, or zero.
Place PlanLayout::place_of_series(std::uint32_t s, std::uint32_t zero) {
  if (const ProgramInput* const in = slots_.code[s].op == Op::input ? slots_.inputs[s] : nullptr) {
    if (in->kind == ProgramInput::Kind::time) return {plan_.time, true};
    if (in->kind == ProgramInput::Kind::other) return {zero, true};
    if (in->order == 0) {
      coordinate_at_[plan_.x[in->variable]] = s;
      return {plan_.x[in->variable], true};
    }
  }
  return slots_.series[s] ? take_series() : Place{};
}

std::uint32_t PlanLayout::coefficient(const Coefficient& c) {
  std::uint64_t hash = c.rational.hash();
  for (std::uint32_t s : c.slots) hash = mixed(hash, s);
  const std::uint32_t known = coefficient_.find(hash, [&](std::uint32_t k) {
    return plan_.coefficients[k].rational == c.rational && plan_.coefficients[k].slots == c.slots;
  });
  if (known != HashIndex::kNone) return known;
  const auto index = static_cast<std::uint32_t>(plan_.coefficients.size());
  coefficient_.insert(hash, index);
  plan_.coefficients.push_back(c);
  return index;
}

}  // namespace anholon
