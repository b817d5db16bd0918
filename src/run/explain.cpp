#include <algorithm>

#include "run/motion.h"
#include "structure/branch.h"

namespace anholon {

// A root or logarithm in the equations whose argument has come to zero.
template <Number N>
static std::string vanishing_root(const Motion<N>& motion) {
  const Tape& tape = motion.program().tape;
  for (std::uint32_t k = 0; k < tape.main_end; ++k) {
    const Instruction& in = tape.code[k];
    const bool root = in.op == Op::power && tape.rationals[in.index].get_den() != 1;
    const bool logarithm = in.op == Op::function && in.index == static_cast<std::uint32_t>(Function::log);
    if ((root || logarithm) && std::abs(to_double(motion.stepper().point().machine().series(in.a)[0])) < 1e-9)
      return root ? "the root of a quantity that reaches zero" : "the logarithm of a quantity that reaches zero";
  }
  return {};
}

template <Number N>
void explain(const Scenario& s, const Motion<N>& motion, Outcome& outcome) {
  using W = Wider<N>;
  constexpr double kVanished = 1e-9, kUnbounded = 1e9, kMeet = 1e-6, kFaint = 1e-3;
  const Stepper<N>& stepper = motion.stepper();
  const Expansion<W>& point = stepper.point();
  std::string& message = outcome.message;
  for (std::size_t a = 0; a < s.system.coordinates; ++a)
    for (int k = 0; k < 2; ++k)
      if (std::abs(to_double(point.derivative(a, k))) > kUnbounded * kUnbounded) {
        outcome.kind = OutcomeKind::blow_up;
        message += "; " + derivative_name(s.system.variable_names[a], static_cast<unsigned>(k), Format::text) + " grows without bound";
        outcome.hint = "look at the last good state: end the motion before";
        return;
      }
  for (std::size_t k = 0; k < s.system.constraints.size(); ++k) {
    const std::size_t r = s.system.constraints[k];
    if (!may_branch(*s.mechanics, s.system, r)) continue;
    const double now = to_double(point.derivative(s.system.coordinates + k, 0)), start = s.state.multipliers[0].value[r];
    const bool vanishes = s.mechanics->order[r] > 2 && std::abs(now) < kFaint * std::abs(start);
    if (vanishes || to_double(stepper.smallest_sigma()) < kMeet) {
      outcome.kind = OutcomeKind::singular;
      message = "singular configuration: " + (vanishes ? "the multiplier of the constraint '" + s.model->constraints[r].name + "' goes to 0"
                                                       : "two solutions for the constraint '" + s.model->constraints[r].name + "' meet") +
                " at t = " + number_text(to_double(stepper.time()), 12) + ", and the equations no longer determine the motion there";
      outcome.hint = "end the motion before; the other branch, [initial] branch = {…}, may go on";
      return;
    }
  }
  if (const std::string root = vanishing_root(motion); !root.empty()) message += "; " + root + " is at the edge of where it has a value";
  for (std::size_t i = 0; i < s.model->masses.size(); ++i)
    if (std::abs(to_double(stepper.quadrature(1 + i, W(0)))) < kVanished)
      message += "; the mass of '" + s.model->masses[i].name + "' vanishes there";
  for (std::size_t k = 0; k < s.system.constraints.size(); ++k)
    if (std::abs(to_double(point.derivative(s.system.coordinates + k, 0))) > kUnbounded)
      message += "; the multiplier of '" + s.system.equation_names[s.system.coordinates + k] +
                 "' grows without bound: the constraint loses its hold there";
}

template void explain(const Scenario&, const Motion<double>&, Outcome&);
template void explain(const Scenario&, const Motion<long double>&, Outcome&);
template void explain(const Scenario&, const Motion<Multi>&, Outcome&);

}  // namespace anholon
