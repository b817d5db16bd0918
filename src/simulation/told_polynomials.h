// The Taylor polynomials of a step, for those who follow a motion without rows.
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "motion/motion.h"
#include "observe/options.h"
#include "simulation/followed_value.h"

namespace anholon {

template <Number N>
class ToldPolynomials {
 public:
  using W = Wider<N>;

  // `stages`: orders beyond the leading derivatives that values need; `first`: the first of the followed formulas among
  // the quadratures.
  ToldPolynomials(const Workspace& s, int stages, std::size_t first)
      : coordinates_(s.system.coordinates), mechanical_(s.system.mechanical()), stages_(stages), first_(first) {}

  // Returns the polynomials of the last step as far as `end`; they hold until the motion makes another step.
  StepPolynomials of_last_step(const Motion<N>& motion, const W& end) {
    const Stepper<N>& stepper = motion.stepper();
    // Values need an expansion; most steps need no values.
    point_.reset();
    const auto expansion = [this, &motion]() -> Expansion<W>& {
      if (!point_) point_.emplace(motion.program(), motion.parameters(), std::max(1, stages_));
      return *point_;
    };
    hiding_.belong_to(motion.eliminations());
    const auto coefficient = [this, &stepper](std::size_t j, int k) {
      const std::size_t unknown = j < coordinates_ ? j : mechanical_ + j - coordinates_;
      return k > stepper.degree(unknown) ? 0 : to_double(stepper.coefficient(unknown, k));
    };
    const auto quadrature = [this, &stepper](std::size_t i, int k) {
      return to_double(stepper.quadrature_coefficient(first_ + i, k));
    };
    const auto value = [this, &stepper, expansion](std::size_t i, double x) -> std::pair<double, double> {
      return value_of_quadrature(stepper, W(stepper.before() + W(x)), first_ + i, expansion());
    };
    const auto hiding = [this, &motion, &stepper, expansion](std::size_t i, double x) -> std::vector<HidingArgument> {
      const std::vector<HidingSlot>& slots = hiding_.of(motion.program(), first_ + i);
      if (slots.empty()) return {};
      return hiding_arguments(stepper, W(stepper.before() + W(x)), slots, expansion());
    };
    return {to_double(stepper.before()), to_double(end), stepper.order(), coefficient,    quadrature,
            stepper.one_sided(),         value,          hiding,          stepper.kinks()};
  }

 private:
  std::size_t coordinates_, mechanical_;
  int stages_;
  std::size_t first_;
  HidingSlots hiding_;  // of the followed formulas
  std::optional<Expansion<W>> point_;
};

}  // namespace anholon
