// The arena of a plan: constants first, then series, then single numbers.
#pragma once
#include <map>

#include "base/hash_index.h"
#include "kernel/plan/slots.h"

namespace anholon {

class PlanLayout {
 public:
  // Places all slots and the series of the unknowns.
  PlanLayout(const Program& program, const Slots& slots, int stages, Plan& plan);

  std::uint32_t take(std::uint32_t size) {
    const std::uint32_t at = plan_.arena;
    plan_.arena += size;
    return at;
  }
  Place take_number() { return {take(1), false}; }
  Place take_series() { return {take(plan_.stride), true}; }
  // The place of a constant, which is made if it is new. REQUIRES: the tape contains the constant.
  std::uint32_t coefficient(const Coefficient& c);
  // The place of a slot, or of the slot that it repeats.
  Place place(std::uint32_t slot) const { return place_[slots_.same_as(slot)]; }
  // The slot of a coordinate by its place.
  const std::map<std::uint32_t, std::uint32_t>& coordinates() const { return coordinate_at_; }

 private:
  void make_coefficients();
  Place place_of_series(std::uint32_t s, std::uint32_t zero);

  const Program& p_;
  const Slots& slots_;
  Plan& plan_;
  std::vector<Place> place_;
  HashIndex coefficient_;
  std::map<std::uint32_t, std::uint32_t> coordinate_at_;
};

}  // namespace anholon
