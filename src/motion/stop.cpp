#include <algorithm>

#include "motion/motion.h"
#include "numeric/told_time.h"
#include "setup/eliminate.h"
#include "setup/outputs/output_tape.h"
#include "structure/branch.h"
#include "structure/redundancy.h"

namespace anholon {

static std::string joined(const std::vector<std::string>& list) {
  std::string all;
  for (const std::string& x : list) all += (all.empty() ? "" : ", ") + x;
  return all;
}

// Names a root or logarithm in the equations whose argument has come to zero; empty if there is none.
template <Number N>
static std::string vanishing_root(const Motion<N>& motion) {
  const Tape& tape = motion.program().tape;
  for (std::uint32_t k = 0; k < tape.main_end; ++k) {
    const Instruction& in = tape.code[k];
    const bool root = in.op == Op::power && !tape.rationals[in.index].is_integer();
    const bool logarithm = in.op == Op::function && in.index == static_cast<std::uint32_t>(Function::log);
    if ((root || logarithm) && std::abs(to_double(motion.stepper().point(true).machine().series(in.a)[0])) < 1e-9)
      return root ? "the root of a quantity that reaches zero" : "the logarithm of a quantity that reaches zero";
  }
  return {};
}

// Names a position, velocity or higher derivative of the state that has grown far beyond its earlier size.
template <Number N>
static std::string unbounded(const Scenario& s, const Motion<N>& motion) {
  constexpr double kUnbounded = 1e5;
  const auto& point = motion.stepper().point();
  for (int k = 0; k < largest_order(s, motion.program().d); ++k) {
    const std::size_t level = static_cast<std::size_t>(k);
    double start = 1;
    for (double v : level == 0 ? s.state.q : level == 1 ? s.state.qd : s.state.higher[level - 2].value)
      start = std::max(start, std::abs(v));
    for (std::size_t a = 0; a < s.system.coordinates; ++a)
      if (k < motion.program().d[a] && std::abs(to_double(point.derivative(a, k))) > kUnbounded * start)
        return derivative_name(s.system.variable_names[a], static_cast<unsigned>(k), Format::text);
  }
  return {};
}

// Names the constraint whose row in Phi has vanished, or depends on the others, compared with the start; empty if there
// is none.
template <Number N>
static std::string lost_hold(Workspace& s, const Motion<N>& motion) {
  using W = Wider<N>;
  constexpr double kLost = 1e-2;
  const Mechanics& m = *s.mechanics;
  const std::vector<std::size_t>& taken = motion.program().system->constraints;
  const std::size_t n = s.system.coordinates, rows = taken.size();
  if (rows == 0) return {};
  Column es;
  std::vector<int> order;
  for (std::size_t r : taken) {
    order.push_back(m.order[r]);
    for (Expr e : m.Phi[r]) es.push_back(put_masses(*s.model, e));
  }
  OutputTape<W> phi_tape(s, es, motion.parameters());
  phi_tape.evaluate(motion.stepper().point());
  Matrix<double> phi(rows, n), at_start(rows, n);
  PointValues start = values_near(*s.model, parameter_values<double>(*s.model), s.state);
  for (std::size_t i = 0; i < phi.data.size(); ++i)
    phi.data[i] = to_double(phi_tape[i]), at_start.data[i] = start(es[i]);
  const auto size = [&](const Matrix<double>& of, std::size_t i) {
    double largest = 0;
    for (std::size_t a = 0; a < n; ++a) largest = std::max(largest, std::abs(of(i, a)));
    return largest;
  };
  for (std::size_t i = 0; i < rows; ++i)
    if (size(phi, i) < kLost * size(at_start, i))
      return "the partial derivatives of the constraint '" + s.model->constraints[taken[i]].name + "' vanish";
  const IndependentConstraints choice = choose_independent(phi, order);
  if (choice.weakest > kLost * choose_independent(at_start, order).weakest && choice.redundant.empty()) return {};
  const std::size_t which = choice.redundant.empty() ? choice.weakest_row : choice.redundant[0];
  return "the constraint '" + s.model->constraints[taken[which]].name + "' becomes dependent on the others";
}

// True if a mode switches a constraint; a switched-off constraint may contain no unknown.
static bool switched(const Scenario& s) {
  return std::any_of(s.independent.begin(), s.independent.end(), [&](std::size_t r) {
    const Expr phi = s.model->constraints[r].phi;
    const std::vector<NodeId> all = symbols({&phi, 1});
    return std::any_of(all.begin(), all.end(), [&](NodeId id) {
      const Node& n = phi.graph->node(id);
      return n.kind == Kind::parameter && s.model->parameters[n.index].mode;
    });
  });
}

// The hint for a constraint that becomes dependent on the others. A component that was left out at the start, because
// it followed from the others there, may be independent elsewhere.
static std::string hint_of_dependence(const Scenario& s) {
  std::vector<std::string> left_out;
  for (std::size_t r : s.redundant) left_out.push_back("'" + s.model->constraints[r].name + "'");
  if (left_out.empty())
    return "end the motion before; coordinates or constraints written otherwise may be regular there";
  return joined(left_out) +
         (left_out.size() == 1 ? " was left out at the start and may count here: name the directions in which the "
                               : " were left out at the start and may count here: name the directions in which the ") +
         "constraints stay independent, along = […]";
}

// Returns the coordinates of the motion, as " (x = 1, y = 2)", unless they are too many to be read. The last step may
// have begun elsewhere.
template <Number N>
static std::string where(const Scenario& s, const Motion<N>& motion) {
  constexpr std::size_t kMost = 6;
  if (s.system.coordinates == 0 || s.system.coordinates > kMost) return "";
  const Stepper<N>& stepper = motion.stepper();
  Expansion<Wider<N>> end(motion.program(), motion.parameters(), 1);
  const bool reached = stepper.at(stepper.time(), end, false).ok();
  const Expansion<Wider<N>>& point = reached ? end : stepper.point();
  std::vector<std::string> list;
  for (std::size_t a = 0; a < s.system.coordinates; ++a)
    list.push_back(s.system.variable_names[a] + " = " + number_text(to_double(point.derivative(a, 0)), 6));
  return " (" + joined(list) + ")";
}

template <Number N>
void explain_stop(Workspace& s, const Motion<N>& motion, Outcome& outcome) {
  using W = Wider<N>;
  constexpr double kVanished = 1e-9, kUnbounded = 1e9, kFallen = 1e-3, kFaint = 1e-3;
  constexpr int kRecentSteps = 8;
  const Stepper<N>& stepper = motion.stepper();
  const System& system = *motion.program().system;
  const Expansion<W>& point = stepper.point();
  std::string& message = outcome.message;
  const std::string when = at_time(to_double(stepper.time()));
  if (const std::string name = unbounded(s, motion); !name.empty() && outcome.kind != OutcomeKind::interrupted) {
    outcome.kind = OutcomeKind::blow_up;
    message += "; " + name + " grows without bound";
    outcome.hint = "look at the last good state: end the motion before";
    return;
  }
  if (const auto i = stepper.shortened_by();
      i && *i < s.model->events.size() && outcome.kind == OutcomeKind::step_collapse) {
    message +=
        "; the formula of the event '" + s.model->events[*i].name + "' has no value there, or grows without bound";
    outcome.hint = kEventWithoutValue;
    return;
  }
  const double first = to_double(stepper.first_sigma()), least = to_double(stepper.least_regular().sigma);
  const std::string lost = lost_hold(s, motion);
  // A singular configuration that the motion has passed long before does not count.
  const Wider<N> steps = abs(W(stepper.time() - stepper.before())) * W(kRecentSteps);
  const bool here = abs(W(stepper.least_regular().t - stepper.time())) <= steps;
  const bool fallen = outcome.kind == OutcomeKind::singular || (here && least < kFallen * first) || !lost.empty();
  for (std::size_t k = 0; k < system.constraints.size() && lost.empty(); ++k) {
    const std::size_t r = system.constraints[k];
    if (!may_branch(*s.mechanics, s.system, r)) continue;
    const double now = to_double(point.derivative(s.system.coordinates + k, 0)),
                 start = s.state.multipliers[0].value[r];
    const bool vanishes = s.mechanics->order[r] > 2 && std::abs(now) < kFaint * std::abs(start);
    if (!vanishes && !fallen) continue;
    outcome.kind = OutcomeKind::singular;
    message = "singular configuration: " +
              (vanishes ? "the multiplier of the constraint '" + s.model->constraints[r].name + "' goes to 0"
                        : "two solutions for the constraint '" + s.model->constraints[r].name + "' meet") +
              when + ", and the equations no longer determine the motion there";
    outcome.hint = "end the motion before; the other branch, [initial] branch = {…}, may go on";
    return;
  }
  if (fallen) {
    const std::size_t j = stepper.least_regular().unknown;
    outcome.kind = OutcomeKind::singular;
    message = "singular configuration" + when + where(s, motion) + ": " +
              (!lost.empty() ? lost
                             : std::string("the equations no longer determine the ") +
                                   (j < system.coordinates    ? "acceleration of "
                                    : j < system.mechanical() ? "multiplier "
                                                              : "rate of the state ") +
                                   system.variable_names[j]);
    if (outcome.hint.empty() || !lost.empty() || !s.redundant.empty())
      outcome.hint = switched(s)
                         ? "a mode switches a constraint off, and nothing is left to determine its multiplier: write "
                           "what opens as a [[contact]], or as a constraint with one_sided = true"
                         : hint_of_dependence(s);
  }
  if (const std::string root = vanishing_root(motion); !root.empty() && outcome.kind != OutcomeKind::not_a_number)
    message += "; " + root + " is at the edge of where it has a value";
  for (std::size_t i = 0; i < s.model->masses.size(); ++i)
    if (std::abs(to_double(stepper.quadrature(1 + i, W(0)))) < kVanished)
      message += "; the mass of '" + s.model->masses[i].name + "' vanishes there";
  std::vector<std::string> unbounded;
  for (std::size_t k = 0; k < system.constraints.size(); ++k)
    if (std::abs(to_double(point.derivative(s.system.coordinates + k, 0))) > kUnbounded)
      unbounded.push_back("'" + system.equation_names[s.system.coordinates + k] + "'");
  if (unbounded.size() == 1)
    message += "; the multiplier of " + unbounded[0] + " grows without bound: the constraint loses its hold there";
  if (unbounded.size() > 1)
    message +=
        "; the multipliers of " + joined(unbounded) + " grow without bound: the constraints lose their hold there";
}

template void explain_stop(Workspace&, const Motion<double>&, Outcome&);
template void explain_stop(Workspace&, const Motion<long double>&, Outcome&);
template void explain_stop(Workspace&, const Motion<Quad>&, Outcome&);
template void explain_stop(Workspace&, const Motion<Multi>&, Outcome&);

}  // namespace anholon
