// Finds the kinks on the way of a step, where a function goes on as another one that its Taylor series do not
// represent: abs and sign where their argument passes zero, a choice where its condition changes, a table at its knots,
// a square root (a norm) where its argument touches zero, an angle atan2(y, x) at its jump beside the negative x axis.
#pragma once
#include "tape/tape.h"

namespace anholon {

template <Number N>
struct Kink {
  bool at_start = false, ahead = false;
  N where{0};  // the first kink ahead, from the point of the series
  // The slot whose value decides there, and the value that it passes; nullopt for a root that touches zero. `enters`:
  // at that value itself the function beyond the kink holds.
  std::optional<std::uint32_t> slot;
  std::uint32_t argument = 0;  // the argument of the function that turns there
  N passes{0};
  const StepFunction* table = nullptr;  // the table of which that value is a knot
  bool enters = false;
  std::vector<std::uint32_t> slots_at_start;  // those that decide at the start
};

// The slots whose values decide which functions hold below `end`.
std::vector<std::uint32_t> kink_arguments(const Tape& tape, std::uint32_t end);

// Tells for each slot below `end` whether it decides for slots that are not among `needed`, and for none of `needed`.
std::vector<bool> deciding_for_others(const Tape& tape, std::uint32_t end, const std::vector<std::uint32_t>& needed);

// Returns the first kink in (0, h], h of either sign, by the series of orders 0..degree of the slots below `end`.
// `expanded`: the machine itself has made the series; otherwise it holds the series of the deciding slots alone.
// `passed_over`: deciding slots whose kinks are ignored; may be empty.
template <Number N>
Kink<N> first_kink(const Machine<N>& machine, std::uint32_t end, int degree, const N& h, bool expanded,
                   const std::vector<bool>& passed_over = {});

// stays_positive(): true if a polynomial that is positive at 0 surely stays positive over [0, h], so that its root has
// no kink. keeps_sign(): true if a polynomial of either sign surely keeps it. Both use the sizes of the coefficients.
template <Number N>
bool stays_positive(const N* c, int degree, const N& h);
template <Number N>
bool keeps_sign(const N* c, int degree, const N& h);

// True if the series of a slot that decides is round-off over [0, h]. `values`: see kinks_log_reach().
template <Number N>
bool is_round_off(std::uint32_t slot, const Machine<N>& machine, const Machine<N>& values, int degree, const N& h);

// The logarithm of the distance over which the series of these slots are known, which decide where kinks are
// (kink_arguments). `values`: a machine with the values, at the point, of everything that they are made of.
template <Number N>
double kinks_log_reach(const std::vector<std::uint32_t>& arguments, const Machine<N>& machine, const Machine<N>& values,
                       int degree, double log_tolerance);

}  // namespace anholon
