#include "motion/motion.h"

#include <algorithm>
#include <cmath>

#include "expr/copy.h"
#include "kernel/kernel.h"
#include "numeric/told_time.h"
#include "structure/redundancy.h"

namespace anholon {

// Kernels, which only doubles have, need the slots of the tape as it is derived; other programs share common parts of
// products.
template <Number N>
Motion<N>::Leg::Leg(const Motion& m, std::shared_ptr<Workspace> of_leg, Elimination by, System of, Structure structured)
    : own(std::move(of_leg)), elimination(std::move(by)), system(std::move(of)), structure(std::move(structured)),
      quadratures(m.s_.redundant.empty() ? m.with_watched(m.workspace(*this))
                                         : taking_part(system, m.with_watched(m.workspace(*this)))),
      program(anholon::program(system, structure, quadratures, !std::same_as<N, double>)),
      stepper(program, m.narrow_parameters_, m.parameters_, m.settings_),
      point(program, m.parameters_, std::max(1, m.stages_)), present(program, m.parameters_, 1) {
  stepper.watch(watched_series(m.s_, m.quadratures_.size()));
  m.watch_pivots(*this);
}

// True if other independent constraints may be chosen during the motion. They may not if multipliers belong to the
// state, or if their series are needed.
static bool chooses_rows(const Scenario& s, const StepSettings& settings) {
  return !s.redundant.empty() && !settings.multipliers && multiplier_orders(s) == 0;
}

template <Number N>
Motion<N>::Motion(Workspace& s, const StepSettings& settings, std::vector<Expr> quadratures, int stages)
    : s_(s), base_(s.elimination.pivots().empty() && !chooses_rows(s, settings) ? nullptr
                                                                                : std::make_unique<const Workspace>(s)),
      settings_(settings), quadratures_(std::move(quadratures)), stages_(stages),
      start_parameters_(parameter_values<W>(*s.model)), parameters_(start_parameters_),
      narrow_parameters_(parameter_values<N>(*s.model)),
      leg_(std::make_unique<Leg>(*this, nullptr, s.elimination, s.system, s.structure)) {
  begun_parameters_ = parameters_;
}

// Changes each number by a different multiple of a round-off: the constraints might take back changes that are alike.
template <Number W>
static void change_last_digits(std::vector<W>& state, const std::vector<bool>& kept, const W& roundoff) {
  constexpr int kMost = 5, kPeriod = 2 * kMost + 1, kStride = 7, kFirst = 3;
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (kept[i]) continue;
    const int by = (static_cast<int>(i % kPeriod) * kStride + kFirst) % kPeriod - kMost;
    state[i] += state[i] * roundoff * W(by == 0 ? kMost : by);
  }
}

// Tells for each number of the state whether it stands in the formula of an event that is zero at the start: with
// another last digit, the start would lie before or behind the event.
static std::vector<bool> on_events(const Scenario& s, std::size_t size) {
  constexpr double kOnIt = 1e-9;
  std::vector<bool> held(size, false);
  if (s.model->events.empty()) return held;
  double largest = 1;
  for (const std::vector<double>* level : {&s.state.q, &s.state.qd})
    for (double x : *level) largest = std::max(largest, std::abs(x));
  PointValues at = values_near(*s.model, parameter_values<double>(*s.model), s.state);
  for (const Event& e : s.model->events) {
    if (std::abs(at(e.when)) > kOnIt * largest) continue;
    std::size_t i = 0;
    const std::vector<NodeId> symbols_of_event = symbols({&e.when, 1});
    for (std::size_t j = 0; j < s.system.size(); ++j)
      for (int k = 0; k < s.structure.d[j] && i < size; ++k, ++i)
        for (NodeId id : symbols_of_event)
          if (s.system.variable(id) == j && s.model->graph->node(id).order == k) held[i] = true;
  }
  return held;
}

template <Number N>
Outcome Motion<N>::start(const StateChoice& choice) {
  if (Outcome o = initial_state(s_, choice, start_); !o.ok()) return o;
  // A motion in doubles may depend on a round-off of each number, though its state is wider; the change here is a fifth
  // of one.
  constexpr double kOfKernel = 0.2;
  if (other_digits_)
    change_last_digits(start_.state, on_events(s_, start_.state.size()),
                       settings_.other_rounding ? W(convert<W>(unit_roundoff<N>()) * W(kOfKernel))
                                                : unit_roundoff<W>());
  if (leg_->pivots && start_.state.size() == leg_->present.state_size()) {
    leg_->present.load(start_.t, start_.state, start_.leading);
    choices_.pivots = leg_->pivots->at(leg_->present);
  }
  accelerate(*leg_);
  Outcome o = leg_->stepper.start(start_.t, start_.state, start_.leading);
  if (o.kind == OutcomeKind::not_a_number) tell_time(o, to_double(start_.t));
  return o;
}

template <Number N>
void Motion<N>::take(const MotionPlans& plans, Leg& leg) {
  if constexpr (std::same_as<N, double>) leg.stepper.accelerate(plans.plan);
  leg.plan = plans.plan, leg.unmapped_plan = plans.unmapped_plan, leg.writing = plans.writing;
}

// Pivots are chosen at the start of the whole motion, with the modes there, so that a resumed run has the same ones.
template <Number N>
void Motion<N>::accelerate(Leg& leg) const {
  if constexpr (std::same_as<N, double>) {
    if (!settings_.kernel || !no_plan(leg.program).empty() || start_.state.size() != leg.point.state_size()) return;
    if (given_) return take(*given_, leg);
    const auto derived =
        KernelPlan::make(std::make_shared<const Program>(leg.program), leg.stepper.order() - 1, start_parameters_,
                         to_double(start_.t), {start_.state.begin(), start_.state.end()});
    leg.stepper.accelerate(derived);
    if (!leg.stepper.accelerated()) return;
    // A segment between events is usually short: its equations are rewritten only if it has lasted.
    const bool as_derived = watches() && effort_ == WritingEffort::at_once;
    const std::vector<Representation> list = as_derived ? std::vector{Representation{Writing::derived, derived, {}}}
                                                        : representations(to_represent(leg, derived), effort_);
    const Representation& taken = best(list);
    if (taken.plan != derived) leg.stepper.accelerate(taken.plan);
    leg.plan = taken.plan;
    leg.unmapped_plan = cheapest_unmapped(list).plan;
    leg.writing = taken.writing;
    if (effort_ == WritingEffort::at_once && !as_derived) leg.at_once = list;
  } else {
    (void)leg;
  }
}

template <Number N>
ToRepresent Motion<N>::to_represent(const Leg& leg, std::shared_ptr<const KernelPlan> derived) const {
  std::vector<double> state;
  for (const W& x : start_.state) state.push_back(to_double(x));
  ToRepresent e{std::move(derived),
                leg.structure,
                leg.quadratures,
                {},
                to_double(start_.t),
                std::move(state),
                workspace(leg).mechanics.get()};
  if constexpr (std::same_as<N, double>) e.parameters = start_parameters_;
  return e;
}

// The effort depends only on the number of steps, so that a resumed run makes the same one. If coordinates are
// eliminated anew during the motion, no writing lasts long enough.
template <Number N>
void Motion<N>::write_anew() {
  const WritingEffort effort = effort_after(leg_->stepper.steps());
  if (effort <= effort_ || leg_->pivots || !leg_->stepper.accelerated()) return;
  effort_ = effort;
  given_.reset();
  // The representations that were found without effort are kept.
  if (std::vector<Representation> list = leg_->at_once; !list.empty()) {
    add_representations(to_represent(*leg_, list.front().plan), effort, list);
    if (best(list).writing == leg_->writing) return;
  }
  auto next = same_leg();
  accelerate(*next);
  if (next->writing == leg_->writing || !next->stepper.take_over(leg_->stepper).ok()) return;
  leg_ = std::move(next);
  choices_.begun = choices_.now();
  begun_parameters_ = parameters_;
}

static bool can_go_on(OutcomeKind kind) {
  return kind == OutcomeKind::singular || kind == OutcomeKind::step_collapse || kind == OutcomeKind::not_a_number ||
         kind == OutcomeKind::no_convergence;
}

// If an event may stop the motion, the motion is expected to last as long again as it has lasted.
static double expected_end(const Model& m, double begin, double now, double end) {
  const bool may_stop = std::any_of(m.events.begin(), m.events.end(), [](const Event& e) { return e.stop; });
  const double lasted = std::abs(now - begin);
  if (!may_stop || std::abs(end - now) <= lasted) return end;
  return end > now ? now + lasted : now - lasted;
}

// The pivots of an elimination are checked after every step; the equations are rewritten after fixed numbers of steps.
template <Number N>
Outcome Motion<N>::steps(const W& end, Stretch<W>& stretch) {
  if (stepped_ && leg_->pivots && pivot_is_small(present())) choose_again();
  if (stepped_) write_anew();
  stretch.limit(leg_->pivots ? 1 : steps_with_effort(leg_->stepper.steps()));
  const double now = to_double(leg_->stepper.time());
  code_.step(leg_->plan, now, expected_end(*s_.model, to_double(start_.t), now, to_double(end)));
  const typename Choices::Mark before = choices_.now();
  const std::size_t expansions = leg_->stepper.expansions(), steps = leg_->stepper.steps();
  Outcome o = leg_->stepper.steps(end, stretch);
  code_.count(leg_->stepper.steps() - steps);
  if (leg_->stepper.expansions() != expansions) choices_.begun = before, begun_parameters_ = parameters_;
  // Near a zero of a pivot the form of the equations fails, not the motion, which goes on with another choice.
  if (!o.ok() && leg_->pivots && can_go_on(o.kind) && choose_again()) o = leg_->stepper.step(end);
  // The next step begins with the state as one sum in the wider type; a lane may hold it as another sum of two doubles.
  if (o.ok()) leg_->stepper.round_state();
  stepped_ = true;
  return o;
}

template <Number N>
Outcome Motion<N>::at(const W& t) {
  beside_.shown = false;
  if (leg_->pivots) {
    Start<W> place;
    place.t = t;
    leg_->stepper.foretell(t, place.state, place.leading);
    choose_beside(place);
    if (beside_.shown) return anholon::settle_at(beside_.leg->point, place, stages_ > 0);
  }
  if (Outcome o = leg_->stepper.at(t, leg_->point); !o.ok()) {
    tell_time(o, to_double(t));
    return o;
  }
  return stages_ > 0 ? leg_->point.extend() : Outcome{};
}

// Watches the pivots on which the choices of a leg depend.
template <Number N>
void Motion<N>::watch_pivots(Leg& leg) const {
  const bool rows = base_ && chooses_rows(s_, settings_) && !leg.system.constraints.empty();
  if (!rows && leg.elimination.pivots().empty()) return;
  const std::vector<std::size_t> all;
  leg.pivots = std::make_unique<ChoiceWatch<W>>(workspace(leg), leg.elimination, rows ? leg.system.constraints : all,
                                                parameters_);
}

// Makes the present leg again, with the present parameters.
template <Number N>
std::unique_ptr<typename Motion<N>::Leg> Motion<N>::same_leg() const {
  return std::make_unique<Leg>(*this, leg_->own, leg_->elimination, leg_->system, leg_->structure);
}

// Chooses another leg for a place at which a pivot is bad: a step that begins with good pivots may be so long that one
// of them vanishes within it.
template <Number N>
void Motion<N>::choose_beside(const Start<W>& place) {
  beside_.shown = false;
  if (!leg_->pivots || choices_.pivots.empty()) return;
  leg_->present.load(place.t, place.state, place.leading);
  if (!pivot_is_below(kBadPivot, leg_->present)) return;
  if (auto other = derived_at(here(leg_->present))) beside_.leg = std::move(other), beside_.shown = true;
}

template <Number N>
bool Motion<N>::pivot_is_below(double share, const Expansion<W>& at) {
  if (!leg_->pivots) return false;
  const std::vector<double> now = leg_->pivots->at(at);
  if (choices_.pivots.empty()) choices_.pivots = now;
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i] < share * choices_.pivots[i]) return true;
  return false;
}

// The state of the motion; its leading derivatives are a guess.
template <Number N>
const Expansion<typename Motion<N>::W>& Motion<N>::present() {
  leg_->stepper.leave_kernel();
  leg_->present.load(leg_->stepper.time(), leg_->stepper.state(), leg_->stepper.leading());
  return leg_->present;
}

template <Number N>
InitialState<double> Motion<N>::here(const Expansion<W>& point) const {
  InitialState<double> here;
  here.t = to_double(point.time());
  const auto level = [&](std::size_t k) {
    std::vector<double> values;
    for (std::size_t a = 0; a < s_.system.coordinates; ++a)
      values.push_back(static_cast<int>(k) <= leg_->program.d[a] ? to_double(point.derivative(a, static_cast<int>(k)))
                                                                 : 0.0);
    return values;
  };
  here.q = level(0);
  here.qd = level(1);
  for (std::size_t k = 2; k < levels(); ++k) here.higher.push_back({level(k), {}});
  for (std::size_t j = s_.system.mechanical(); j < s_.system.size(); ++j) {
    here.states.push_back(to_double(point.derivative(j, 0)));
    here.state_rates.push_back(to_double(point.derivative(j, 1)));
  }
  return here;
}

// True if two eliminations, of two workspaces, have the same dependent coordinates and the same pivots.
static bool same(const Elimination& a, const Elimination& b) {
  if (a.dependent != b.dependent) return false;
  Graph common;
  return copied(a.pivots(), common) == copied(b.pivots(), common);
}

// Returns the leg with the dependent coordinates and independent constraints that are best at a point; nullptr if its
// equations cannot be made, or if another number of constraints is independent there.
template <Number N>
std::unique_ptr<typename Motion<N>::Leg> Motion<N>::derived_at(const InitialState<double>& here) const {
  try {
    auto own = std::make_shared<Workspace>(*base_);
    const Mechanics& m = *own->mechanics;
    std::vector<double> now;
    for (const W& p : parameters_) now.push_back(to_double(p));
    if (chooses_rows(*own, settings_)) {
      IndependentConstraints rows = independent_constraints(m, now, here);
      if (rows.independent.size() != own->independent.size()) return nullptr;
      own->independent = std::move(rows.independent), own->redundant = std::move(rows.redundant);
    }
    Elimination e;
    if (own->system.form->eliminates()) {
      const auto at = std::make_shared<PointValues>(values_near(*own->model, now, here));
      e = Elimination(m, choose_elimination(m, own->independent, own->system.form->unknowns, {}, *at), at);
    }
    System system = implicit_system(own->model, m, *own->system.form, own->independent, e);
    Structure structure;
    ProbeHints hints;
    hints.t = here.t;
    hints.derivatives = {here.q, here.qd};
    for (const Level<double>& k : here.higher) hints.derivatives.push_back(k.value);
    hints.states = here.states;
    if (!analyse(system, now, hints, structure).ok() || structure.d != leg_->structure.d) return nullptr;
    drop_absent(system, structure);
    return std::make_unique<Leg>(*this, std::move(own), std::move(e), std::move(system), std::move(structure));
  } catch (const Failure&) {
    return nullptr;  // the present elimination goes on as far as it can
  }
}

// Chooses anew where the motion is; returns false if there is no better choice.
template <Number N>
bool Motion<N>::choose_again() {
  choices_.list.push_back({here(present()), false});
  auto next = derived_at(choices_.list.back().here);
  if (next && next->system.constraints == leg_->system.constraints && same(next->elimination, leg_->elimination))
    next = nullptr;
  if (next) accelerate(*next);
  // The pivots are taken before the expansion, which a kernel continues.
  const Expansion<W>& point = present();
  std::vector<double> as_it_is = leg_->pivots->at(point), as_chosen;
  if (next && next->pivots) as_chosen = next->pivots->at(point);
  const bool taken = next && next->stepper.take_over(leg_->stepper).ok();
  if (taken) {
    leg_ = std::move(next);
    choices_.list.back().taken = true;
    ++choices_.taken;
  }
  choices_.pivots = taken ? std::move(as_chosen) : std::move(as_it_is);
  if (taken) choices_.begun = choices_.now();
  return taken;
}

template <Number N>
void Motion<N>::save(SavedRun& to) const {
  // Structured bindings name all members, so a member that is added and forgotten here does not compile.
  const StepperState<N> begun = leg_->stepper.begun();
  const auto& [motion, direction, sides] = begun;
  const auto& [t, state, carry, leading, own, own_leading, integrals, integral_carry, record] = motion;
  const auto& [branch_step, steps, worst_constraint, worst_equation, first_sigma, least_regular, sigma_before,
               last_step, least_health, careful] = record;
  to.set_numbers<W>("t", {t});
  to.set_numbers("state", state);
  to.set_numbers("carry", carry);
  to.set_numbers("leading", leading);
  to.set_numbers("own", own);
  to.set_numbers("own_leading", own_leading);
  to.set_numbers("integrals", integrals);
  to.set_numbers("integral_carry", integral_carry);
  to.set_numbers<W>("stepper", {branch_step, worst_constraint, worst_equation, least_regular.t, last_step});
  to.set_numbers<N>("sigma", {first_sigma, least_regular.sigma, sigma_before, least_health});
  to.set_numbers("direction", direction);
  to.set("counts", {std::to_string(steps), std::to_string(least_regular.unknown), careful ? "1" : "0"});
  std::vector<double> choices;
  for (std::size_t i = 0; i < choices_.begun.choices; ++i) {
    const typename Choices::Choice& c = choices_.list[i];
    choices.push_back(c.taken ? 1 : 0);
    choices.push_back(c.here.t);
    choices.insert(choices.end(), c.here.q.begin(), c.here.q.end());
    choices.insert(choices.end(), c.here.qd.begin(), c.here.qd.end());
    for (const Level<double>& k : c.here.higher) choices.insert(choices.end(), k.value.begin(), k.value.end());
    choices.insert(choices.end(), c.here.states.begin(), c.here.states.end());
    choices.insert(choices.end(), c.here.state_rates.begin(), c.here.state_rates.end());
  }
  to.set_numbers("eliminations", choices);
  to.set_numbers("pivots", choices_.begun.pivots);
  to.set_numbers("sides", std::vector<W>(sides.begin(), sides.end()));
  to.set_numbers("modes", begun_parameters_);
}

template <Number N>
Outcome Motion<N>::resume(const StateChoice& choice, const SavedRun& from) {
  // The pivots of kernels are chosen at the initial state.
  if (Outcome o = initial_state(s_, choice, start_); !o.ok()) return o;
  if (const std::vector<W> modes = from.numbers<W>("modes", parameters_.size()); modes != parameters_) {
    set_modes(modes);
    leg_ = same_leg();
  }
  const std::size_t n = s_.system.coordinates, states = s_.model->states.size(), length = 2 + n * levels() + 2 * states;
  const std::vector<double> choices = from.numbers<double>("eliminations");
  if (choices.size() % length != 0) SavedRun::unfit("eliminations");
  for (auto at = choices.begin(); at != choices.end();) {
    typename Choices::Choice c;
    c.taken = *at++ != 0;
    c.here.t = *at++;
    const auto level = [&] {
      std::vector<double> values(at, at + static_cast<std::ptrdiff_t>(n));
      at += static_cast<std::ptrdiff_t>(n);
      return values;
    };
    c.here.q = level();
    c.here.qd = level();
    for (std::size_t k = 2; k < levels(); ++k) c.here.higher.push_back({level(), {}});
    for (std::size_t i = 0; i < states; ++i) c.here.states.push_back(*at++);
    for (std::size_t i = 0; i < states; ++i) c.here.state_rates.push_back(*at++);
    choices_.list.push_back(std::move(c));
  }
  choices_.taken = static_cast<std::size_t>(
      std::count_if(choices_.list.begin(), choices_.list.end(), [](const auto& c) { return c.taken; }));
  const auto last = std::find_if(choices_.list.rbegin(), choices_.list.rend(), [](const auto& c) { return c.taken; });
  if (last != choices_.list.rend()) {
    auto next = base_ ? derived_at(last->here) : nullptr;
    if (!next) SavedRun::unfit("eliminations");
    leg_ = std::move(next);
  }
  const std::vector<double> pivots = from.numbers<double>("pivots");
  if (!pivots.empty() && pivots.size() != (leg_->pivots ? leg_->pivots->count() : 0)) SavedRun::unfit("pivots");
  choices_.pivots = pivots;
  choices_.begun = choices_.now();

  const Program& p = leg_->program;
  const std::size_t size = leg_->point.state_size();
  const std::vector<W> more = from.numbers<W>("stepper", 5);
  const std::vector<N> sigma = from.numbers<N>("sigma", 4);
  const std::vector<long double> counts = from.numbers<long double>("counts", 3);
  StepperState<N> b;
  auto& [motion, direction, sides] = b;
  auto& [t, state, carry, leading, own, own_leading, integrals, integral_carry, record] = motion;
  auto& [branch_step, steps, worst_constraint, worst_equation, first_sigma, least_regular, sigma_before, last_step,
         least_health, careful] = record;
  t = from.number<W>("t");
  state = from.numbers<W>("state", size);
  carry = from.numbers<W>("carry", size);
  leading = from.numbers<W>("leading");
  if (!leading.empty() && leading.size() != p.unknowns()) SavedRun::unfit("leading");
  own = from.numbers<W>("own");
  own_leading = from.numbers<W>("own_leading");
  integrals = from.numbers<W>("integrals", p.quadratures);
  integral_carry = from.numbers<W>("integral_carry", p.quadratures);
  branch_step = more[0];
  worst_constraint = more[1];
  worst_equation = more[2];
  least_regular.t = more[3];
  last_step = more[4];
  first_sigma = sigma[0];
  least_regular.sigma = sigma[1];
  sigma_before = sigma[2];
  least_health = sigma[3];
  steps = static_cast<std::size_t>(counts[0]);
  least_regular.unknown = static_cast<std::size_t>(counts[1]);
  careful = counts[2] != 0;
  direction = from.numbers<N>("direction");
  for (const W& side : from.numbers<W>("sides", watched_formulas(*s_.model).size()))
    sides.push_back(static_cast<int>(to_double(side)));
  if (least_regular.unknown >= p.unknowns() || (!direction.empty() && direction.size() != p.unknowns()))
    SavedRun::unfit("direction");
  if (!leg_->pivots) effort_ = effort_after(steps);
  accelerate(*leg_);
  return leg_->stepper.resume(b);
}

template class Motion<double>;
template class Motion<long double>;
template class Motion<Quad>;
template class Motion<Multi>;

}  // namespace anholon
