// The Taylor expansion of a motion in one lane of a kernel, in doubles, for steps that need no closer look.
//
// While the lane holds a motion, its state is in the lane alone and steps are made there; the track's state is out of
// date. The state can be read at any time, and is taken back when the reference has to go on.
#pragma once
#include <memory>
#include <optional>

#include "integrate/motion_state.h"
#include "kernel/kernel.h"
#include "program/expansion.h"

namespace anholon {

// The difference between the velocities given by the unknowns of a kernel and those that its series foretell: the
// largest difference, the largest velocity, and the size of the kernel's state, at least 1. The difference is infinite
// or not a number if the unknowns give no velocities.
struct VelocityJump {
  double most = 0, speed = 0, size = 1;
};

class KernelExpansion {
 public:
  using W = Wider<double>;
  KernelExpansion(std::shared_ptr<Kernel> kernel, int lane, const Program& motion, int order, double log_tolerance);

  // True if the kernel has no other lanes.
  bool alone() const { return kernel_->lanes() == 1; }
  // True if the kernel has unknowns of its own.
  bool mapped() const { return kernel_->plan().map() != nullptr; }

  // True if no constraint of the motion restricts positions, which means that none is differentiated twice.
  bool without_positions() const;

  // Puts the motion into the lane, if the lane does not hold it, at the point of the next expansion.
  void load(MotionTrack<double>& track, const std::vector<W>& guess);
  void expand() { kernel_->begin(); }
  // Judges the expansion that the kernel has made. Returns false if the reference has to make it: the pivots have
  // become small, or small enough that J has to be measured again, or coefficients are not finite. `follows`: the
  // expansion before was made by the kernel, too.
  bool serves(StepRecord<double>& record, bool measure, bool follows);
  // True if the lane holds the motion, and no series decides which functions hold.
  bool may_be_ordinary() const { return holds_ && deciding_.empty(); }
  // Like serves() if nothing needs a closer look; otherwise it returns false and changes nothing.
  bool serves_at_once(StepRecord<double>& record, bool measure);
  // Notes that an expansion with these pivots has served at once.
  void follow_pivots(const Pivots& last) {
    suspected_ = false;
    pivots_ = last;
  }
  const Pivots& last_pivots() const { return pivots_; }
  // The least health of pivots that are trusted.
  double least_health() const { return least_health_; }
  // True if no function does anything in a step over h that its series do not show.
  bool hides_nothing_over(double h) const;
  // The distance of the present expansion's state from the constraints before the projection, relative to the size of
  // the state.
  double drift() const { return kernel_->drift(lane_); }
  // True if the pivots show that J may have been singular since the last expansion.
  bool suspected() const { return suspected_; }
  void forget_suspicion() { suspected_ = false; }
  double reach() const { return kernel_->reach(lane_); }
  // Copies the series that decide which functions hold into `series`, where kinks are looked for.
  void show_deciding(Expansion<double>& series) const;
  // Finds out whether one of these series may pass its point within the horizon.
  void look_for_turns(double horizon);
  bool may_turn() const { return may_turn_; }

  // Reads the lane's motion into `m`; does nothing if the motion is not in the lane. `expanded`: the expansion is made,
  // and no step has been made since.
  void read(MotionState<double>& m, bool expanded) const;
  void read_begun(MotionTrack<double>& track) const;
  // Reads the whole motion and takes it out of the lane.
  void take_back(MotionTrack<double>& track, bool expanded);
  void drop() { holds_ = false; }
  // Rounds the lane's motion as take_back() and load() would.
  void round_state() {
    if (holds_) kernel_->round_state(lane_);
  }
  // Drops the kernel's expansion: the motion is again where the expansion was begun.
  void take_back_as_begun(MotionTrack<double>& track);

  // The series of the present expansion. The coefficient of a multiplier is 0 if the kernel has unknowns of its own.
  double coefficient(std::size_t j, int k) const;
  double quadrature(std::size_t i, int k) const { return kernel_->quadrature(i, k, lane_); }
  bool constant_quadrature(std::size_t i) const { return kernel_->constant_quadrature(i); }
  // The integral over the step to where the kernel was sent last.
  double integral(std::size_t i) const { return kernel_->integral(i, lane_); }
  std::vector<W> leading() const;
  std::vector<W> base(const W& begun) const;  // the state at the point of the expansion
  void state_at(const W& begun, const W& h, std::vector<W>& state, std::vector<W>& leading) const;
  // Like state_at(), but in the kernel's own unknowns. `leading`: the leading derivatives in the unknowns of the
  // motion.
  void own_state_at(const W& h, std::vector<W>& own, std::vector<W>& leading) const;
  // Adds the points within the step where a function of a slot below `end` may do something that its series do not show.
  // Returns false if the series of its argument do not reach over the step.
  bool add_hidden_points(std::uint32_t end, double h, std::vector<double>& points) const;

  // Sends the kernel to h beyond the expansion, which is at time t.
  void send(double h, double t);
  // The change that Newton's first step would make to the leading derivatives foretold there, as a rate.
  double defect() const { return kernel_->defect(lane_); }
  // The difference of the velocities at the time t, where the kernel was sent, for a kernel with unknowns of its own.
  VelocityJump velocity_jump(double t) const;
  void show_advanced(bool advanced) { kernel_->show_advanced(advanced); }
  // Goes where the kernel was sent, and begins the next expansion there. REQUIRES: the kernel has no other lanes.
  void advance() {
    kernel_->advance();
    kernel_->start_next();
  }
  // True if, where the kernel was sent, the state grows without bound or is not finite.
  bool blows_up() const { return !(kernel_->largest(lane_) < kBlowUp); }
  // Takes the motion along after the kernel has gone on by h. Returns false if the motion grows beyond kBlowUp; then it
  // is at the point of the expansion.
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
