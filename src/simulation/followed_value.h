// The value of a formula at a time within the last step, by the equations there; and the arguments of the functions in
// it that may hide their variation.
#pragma once
#include <limits>
#include <map>
#include <utility>

#include "integrate/series/hidden_points.h"
#include "integrate/stepper.h"

namespace anholon {

// Returns the value, NaN if the quadrature of the program has none, and the magnitude of everything that the value is
// made of, -1 if the motion has no solution at t. The point is an expansion of the caller.
template <Number N>
std::pair<double, double> value_of_quadrature(const Stepper<N>& stepper, const Wider<N>& t, std::size_t quadrature,
                                              Expansion<Wider<N>>& point) {
  if (!stepper.at(t, point).ok()) return {std::numeric_limits<double>::quiet_NaN(), -1};
  point.evaluate_quadratures();
  std::vector<Wider<N>> sizes;
  point.machine().made_of(sizes);
  const Program& program = point.program();
  return {to_double(point.quadrature(quadrature)[0]),
          to_double(sizes[program.tape.roots[program.unknowns() + quadrature]])};
}

// The functions and quotients in each quadrature of a program that may hide their variation.
class HidingSlots {
 public:
  const std::vector<HidingSlot>& of(const Program& program, std::size_t quadrature) {
    const auto [at, is_new] = known_.try_emplace(quadrature);
    if (!is_new) return at->second;
    for (const std::uint32_t slot : precedents(program.tape, {program.tape.roots[program.unknowns() + quadrature]}))
      if (const auto hides = may_hide(program.tape, slot)) at->second.push_back(*hides);
    return at->second;
  }
  // Forgets the slots of the program before so many eliminations.
  void belong_to(std::size_t eliminations) {
    if (std::exchange(eliminations_, eliminations) != eliminations) known_.clear();
  }

 private:
  std::size_t eliminations_ = 0;
  std::map<std::size_t, std::vector<HidingSlot>> known_;
};

// Returns the arguments of these functions; none if the motion has no solution at t. The point is an expansion of the
// caller.
template <Number N>
std::vector<HidingArgument> hiding_arguments(const Stepper<N>& stepper, const Wider<N>& t,
                                             const std::vector<HidingSlot>& slots, Expansion<Wider<N>>& point) {
  std::vector<HidingArgument> list;
  if (!stepper.at(t, point).ok()) return list;
  point.evaluate_quadratures();
  for (const HidingSlot& s : slots) list.push_back({s.function, to_double(point.machine().series(s.argument)[0])});
  return list;
}

}  // namespace anholon
