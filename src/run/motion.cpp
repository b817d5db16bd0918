#include "run/motion.h"

namespace anholon {

template <Number N>
Motion<N>::Leg::Leg(const Motion& m, System of, Structure structured)
    : system(std::move(of)), structure(std::move(structured)), program(anholon::program(system, structure, m.quadratures_)),
      stepper(program, parameter_values<N>(*m.s_.model), m.parameters_, m.settings_), point(program, m.parameters_, std::max(1, m.stages_)) {}

template <Number N>
Motion<N>::Motion(const Scenario& s, const StepSettings& settings, std::vector<Expr> quadratures, int stages)
    : s_(s), settings_(settings), quadratures_(std::move(quadratures)), stages_(stages), parameters_(parameter_values<W>(*s.model)),
      leg_(std::make_unique<Leg>(*this, s.system, s.structure)) {
  watch_pivots(s.elimination);
}

template <Number N>
Outcome Motion<N>::start(const StateChoice& choice) {
  Start<W> start;
  if (Outcome o = initial_state(s_, choice, start); !o.ok()) return o;
  return leg_->stepper.start(start.t, start.state, start.leading);
}

static bool can_go_on(OutcomeKind kind) {
  return kind == OutcomeKind::singular || kind == OutcomeKind::step_collapse || kind == OutcomeKind::not_a_number;
}

template <Number N>
Outcome Motion<N>::step(const W& end) {
  if (stepped_ && pivot_is_small()) eliminate_again();
  Outcome o = leg_->stepper.step(end);
  // Near a zero of a pivot the form of the equations fails, not the motion: another elimination goes on.
  if (!o.ok() && pivots_ && can_go_on(o.kind) && eliminate_again()) o = leg_->stepper.step(end);
  stepped_ = true;
  return o;
}

template <Number N>
Outcome Motion<N>::at(const W& t) {
  if (Outcome o = leg_->stepper.at(t, leg_->point); !o.ok()) {
    o.message += " at t = " + number_text(to_double(t), 12);
    return o;
  }
  return stages_ > 0 ? leg_->point.extend() : Outcome{};
}

// Keeps an eye on what the elimination divides by.
template <Number N>
void Motion<N>::watch_pivots(const Elimination& e) {
  elimination_ = e;
  pivots_.reset();
  chosen_.clear();
  if (!e.pivots().empty()) pivots_ = std::make_unique<OutputTape<W>>(s_, put_masses(*s_.model, e.in_coordinates(e.on(e.pivots()))), parameters_);
}

template <Number N>
bool Motion<N>::pivot_is_small() {
  constexpr double kSmall = 0.4;
  if (!pivots_) return false;
  pivots_->evaluate(leg_->stepper.point());
  bool small = false;
  const bool first = chosen_.empty();
  for (std::size_t i = 0; i < elimination_.pivots().size(); ++i) {
    const double v = std::abs(to_double((*pivots_)[i]));
    if (first) chosen_.push_back(v);
    small = small || v < kSmall * chosen_[i];
  }
  return small;
}

// Another choice of dependent coordinates at the point where the last step began; false if it is the same and its pivots too.
template <Number N>
bool Motion<N>::eliminate_again() {
  InitialState<double> here;
  const Expansion<W>& point = leg_->stepper.point();
  here.t = to_double(point.time());
  const auto level = [&](int k) {
    std::vector<double> values;
    for (std::size_t a = 0; a < s_.system.coordinates; ++a) values.push_back(k <= leg_->program.d[a] ? to_double(point.derivative(a, k)) : 0.0);
    return values;
  };
  here.q = level(0);
  here.qd = level(1);
  for (int k = 2; s_.routh && k <= largest_order(s_, leg_->program.d); ++k) here.higher.push_back({level(k), {}});
  const Model& model = *s_.model;
  try {
    const auto at = std::make_shared<PointValues>(values_near(model, parameter_values<double>(model), here));
    const Elimination e(*s_.mechanics, choose_elimination(*s_.mechanics, s_.independent, s_.system.form->unknowns, {}, *at), at);
    System system = implicit_system(s_.model, *s_.mechanics, *s_.system.form, s_.independent, e);
    Structure structure;
    ProbeHints hints;
    hints.t = here.t;
    hints.derivatives = {here.q, here.qd};
    for (const Level<double>& k : here.higher) hints.derivatives.push_back(k.value);
    if (!analyse(system, parameter_values<double>(model), hints, structure).ok() || structure.d != leg_->structure.d) return false;
    drop_absent(system, structure);
    const bool same = e.dependent == elimination_.dependent && e.pivots() == elimination_.pivots();
    watch_pivots(e);
    if (same) return false;
    auto next = std::make_unique<Leg>(*this, std::move(system), std::move(structure));
    if (!next->stepper.take_over(leg_->stepper).ok()) return false;
    leg_ = std::move(next);
    ++eliminations_;
    return true;
  } catch (const Failure&) {
    return false;  // the present elimination goes on as far as it can
  }
}

template class Motion<double>;
template class Motion<long double>;
template class Motion<Quad>;
template class Motion<Multi>;

}  // namespace anholon
