// The Taylor expansion of a motion in one lane of a kernel: in doubles, where nothing has to be looked at closely.
//
// While the lane holds a motion, its state is in the lane alone and steps are made there; what the track says of it is
// out of date. It can be read at any time, and is taken back where the reference has to go on.
#pragma once
#include <memory>
#include <optional>

#include "integrate/motion_state.h"
#include "kernel/kernel.h"
#include "program/expansion.h"

namespace anholon {

// Velocities by the unknowns of a kernel against those that its series foretell: the largest difference, the largest
// velocity, and the size of the kernel's state, at least 1. Infinite or no number where the unknowns give none.
struct VelocityJump {
  double most = 0, speed = 0, size = 1;
};

class KernelExpansion {
 public:
  using W = Wider<double>;
  KernelExpansion(std::shared_ptr<Kernel> kernel, int lane, const Program& motion, int order, double log_tolerance);

  // Whether the kernel has no other lanes.
  bool alone() const { return kernel_->lanes() == 1; }
  // Whether the kernel has unknowns of its own.
  bool mapped() const { return kernel_->plan().map() != nullptr; }

  // Whether no constraint of the motion is one of positions: none is differentiated twice.
  bool without_positions() const;

  // Puts the motion into the lane, if it is not there, where the next expansion is to be made.
  void load(MotionTrack<double>& track, const std::vector<W>& guess);
  void expand() { kernel_->begin(); }
  // Looks at what the kernel has made. False if the reference has to make the expansion: the pivots have become small,
  // or small enough for another measure of J, or coefficients are no numbers. `follows`: the expansion before was
  // made here, too.
  bool serves(StepRecord<double>& record, bool measure, bool follows);
  // Whether the lane holds the motion, and nothing in it decides which function holds.
  bool may_be_ordinary() const { return holds_ && deciding_.empty(); }
  // As serves(), where nothing asks for a closer look; else false, and nothing is changed.
  bool serves_at_once(StepRecord<double>& record, bool measure);
  // An expansion with these pivots has served at once.
  void follow_pivots(const Pivots& last) {
    suspected_ = false;
    pivots_ = last;
  }
  const Pivots& last_pivots() const { return pivots_; }
  // Pivots of smaller health are not trusted.
  double least_health() const { return least_health_; }
  // Whether no function hides in a step over h what its series do not show.
  bool hides_nothing_over(double h) const;
  // How far the state of the present expansion was from the constraints before it was projected, relative to its size.
  double drift() const { return kernel_->drift(lane_); }
  // Whether J may have been singular since the last expansion, by the pivots.
  bool suspected() const { return suspected_; }
  void forget_suspicion() { suspected_ = false; }
  double reach() const { return kernel_->reach(lane_); }
  // Copies the series that decide which functions hold into `series`, where kinks are looked for.
  void show_deciding(Expansion<double>& series) const;
  // Finds out whether one of them may pass its point within the horizon.
  void look_for_turns(double horizon);
  bool may_turn() const { return may_turn_; }

  // Puts into `m` where the lane's motion is; `expanded`: the expansion is made, and no step since. Nothing changes
  // if the motion is not in the lane.
  void read(MotionState<double>& m, bool expanded) const;
  void read_begun(MotionTrack<double>& track) const;
  // Reads all of it; the motion is then not in the lane any more.
  void take_back(MotionTrack<double>& track, bool expanded);
  void drop() { holds_ = false; }
  // The lane's motion is rounded as by take_back() and load().
  void round_state() {
    if (holds_) kernel_->round_state(lane_);
  }
  // The kernel's expansion is not to be: the motion is where it was begun.
  void take_back_as_begun(MotionTrack<double>& track);

  // Series of the present expansion. A kernel with unknowns of its own has no multipliers: 0.
  double coefficient(std::size_t j, int k) const;
  double quadrature(std::size_t i, int k) const { return kernel_->quadrature(i, k, lane_); }
  bool constant_quadrature(std::size_t i) const { return kernel_->constant_quadrature(i); }
  // Over the step to where the kernel was sent last.
  double integral(std::size_t i) const { return kernel_->integral(i, lane_); }
  std::vector<W> leading() const;
  std::vector<W> base(const W& begun) const;  // the state where it was made
  void state_at(const W& begun, const W& h, std::vector<W>& state, std::vector<W>& leading) const;
  // The same in the kernel's own unknowns; `leading`: of the motion.
  void own_state_at(const W& h, std::vector<W>& own, std::vector<W>& leading) const;
  // Points within the step where a function may do what its series do not show.
  std::vector<double> hidden_points(double h) const;

  // The kernel is to go h beyond the expansion, to the time t.
  void send(double h, double t);
  // There: what Newton's first step changes of the leading derivatives foretold, as a rate.
  double defect() const { return kernel_->defect(lane_); }
  // … and how the velocities differ, of a kernel with unknowns of its own; `t`: the time there.
  VelocityJump velocity_jump(double t) const;
  void show_advanced(bool advanced) { kernel_->show_advanced(advanced); }
  // Goes where it was sent, and begins the next expansion there. The kernel has no other lanes.
  void advance() {
    kernel_->advance();
    kernel_->start_next();
  }
  // Whether the state is one that grows without bound, or none, where the kernel was sent.
  bool blows_up() const { return !(kernel_->largest(lane_) < kBlowUp); }
  // The kernel has gone on by h; the motion goes with it. False if it grows beyond kBlowUp: then it is where the
  // expansion was made.
  bool follow(MotionTrack<double>& track, const W& h);

 private:
  std::optional<std::size_t> own_unknown(std::size_t j) const;
  std::vector<double> coefficients(const Place& place) const;
  void advanced(const W& h, const std::vector<W>& base, std::vector<W>& state, std::vector<W>& leading) const;

  std::shared_ptr<Kernel> kernel_;
  int lane_;
  const Program* program_;  // of the motion
  int order_;
  double least_health_;  // below it the reference makes the expansion
  std::vector<Plan::Deciding> deciding_;
  Pivots pivots_;       // at the last expansion
  bool holds_ = false;  // the motion is in the lane
  bool suspected_ = false, may_turn_ = false;
};

}  // namespace anholon
