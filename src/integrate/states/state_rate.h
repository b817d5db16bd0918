// The motion as an ordinary differential equation x' = f(t, x) of its state, for methods that need f alone.
//
//   x = (x_j^(k), k < d_j);  f solves the equations for the leading derivatives and shifts: x_j^(k)' = x_j^(k+1)  (theory: methods)
//
// On the hidden constraints f is the motion's own field, near them a smooth extension of it; a state is projected on
// them on request. A kernel evaluates f without stages beyond the leading derivatives; the reference evaluates it if
// there is no kernel or the kernel's pivots have become small.
#pragma once
#include <memory>
#include <optional>

#include "integrate/step_control.h"
#include "kernel/kernel.h"
#include "program/expansion.h"

namespace anholon {

// A quadrature of the program that must not become negative: a mass, or the distance by which the argument of a table
// is inside of it.
struct Guard {
  std::size_t quadrature = 0;
  Outcome fault;
};

class StateRate {
 public:
  // `plan`: the plan of a program for the same unknowns and quadratures, or nullptr.
  StateRate(const Program& program, const std::vector<double>& parameters,
            const std::vector<long double>& wide_parameters, std::shared_ptr<const KernelPlan> plan,
            std::vector<Guard> guards = {});

  // Evaluates f at the state, or, with `projected`, at the nearest state on the hidden constraints.
  Outcome evaluate(double t, const std::vector<double>& state, bool projected = false);
  // The results at that point: the state, f, the leading derivatives, the quadratures.
  const std::vector<double>& state() const { return state_; }
  const std::vector<double>& rate() const { return rate_; }
  const std::vector<double>& leading() const { return leading_; }
  const std::vector<double>& integrands() const { return integrands_; }
  // After a projection: the distance of the state from the constraints, relative to the size of the state; whether the
  // state was moved.
  double drift() const { return drift_; }
  bool moved() const { return moved_; }
  // The pivots of the kernel, also if they were so small that the reference made the evaluation; nullopt without a
  // kernel.
  const std::optional<Pivots>& pivots() const { return pivots_; }
  // The side of each possible kink of f (abs, sign, piecewise, table): the number of a piece, or of an interval between
  // knots. Empty if the reference made the evaluation.
  const std::vector<int>& sides() const { return sides_; }
  // The arguments that decide about the kinks; and how far an argument is beyond the end of its side, in the direction
  // of another side.
  const std::vector<double>& arguments() const { return arguments_; }
  double beyond(std::size_t kink, double argument, int side, int other) const;
  // True if the last evaluation failed at a guard.
  bool guarded() const { return guarded_; }
  // The first guess of the leading derivatives of the next evaluation.
  void set_leading(const std::vector<double>& leading) { leading_ = leading; }

  const Program& program() const { return *program_; }
  const std::vector<double>& parameters() const { return point_.parameters(); }
  std::size_t size() const { return scale_.size(); }
  // The scale of each entry x_j^(k) of the state: entries with the same k and the same scale of the program share one.
  const std::vector<std::size_t>& scale() const { return scale_; }
  std::size_t scales() const { return scales_; }
  bool constrained() const { return constrained_; }
  const KernelPlan* plan() const { return kernel_ ? &kernel_->plan() : nullptr; }
  std::size_t evaluations() const { return evaluations_; }
  std::size_t by_reference() const { return by_reference_; }

 private:
  struct Kink {
    Place argument;
    const std::vector<double>* knots = nullptr;  // of a table; for other kinks zero separates the sides
  };
  void find_kinks();
  bool by_kernel(double t, const std::vector<double>& state, bool projected);
  Outcome by_reference(double t, const std::vector<double>& state, bool projected);

  const Program* program_;
  std::unique_ptr<Kernel> kernel_;
  Expansion<double> point_;
  std::vector<Guard> guards_;
  std::vector<Kink> kinks_;
  std::vector<std::size_t> scale_;
  std::vector<int> sides_;
  std::size_t scales_ = 1;
  bool constrained_ = false, moved_ = false, guarded_ = false;
  std::vector<double> state_, rate_, leading_, integrands_, arguments_;
  double drift_ = 0;
  std::optional<Pivots> pivots_;
  std::size_t evaluations_ = 0, by_reference_ = 0;
};

// A consistent state on a motion, its leading derivatives, and the integrals up to there.
struct MotionPoint {
  long double t = 0;
  std::vector<long double> state;
  std::vector<double> leading;
  std::vector<long double> integrals;
};

// Steps of a motion in doubles by a method other than Taylor's. Each step ends on all hidden constraints.
class StateStepper {
 public:
  virtual ~StateStepper() = default;
  virtual const char* title() const = 0;
  // Starts at a state that satisfies the constraints to round-off.
  virtual Outcome start(const MotionPoint& from, long double end) = 0;
  virtual Outcome step(long double end) = 0;
  // Computes a point anywhere in the last step, to the accuracy of the steps; its state is close to the constraints.
  virtual Outcome at(long double t, MotionPoint& point) = 0;
  virtual std::size_t refused() const = 0;  // refused steps
  virtual StateRate& rate() = 0;
  virtual double more_work() const { return 0; }  // operations beside the evaluations of f

  const MotionPoint& before() const { return before_; }
  const MotionPoint& now() const { return now_; }
  std::size_t steps() const { return steps_; }
  double worst_constraint() const { return worst_constraint_; }

 protected:
  MotionPoint before_, now_;
  std::size_t steps_ = 0;
  double worst_constraint_ = 0;
};

// Computes the size of the entries of each scale, at least 1; tolerances are relative to these sizes.
void scale_sizes(const StateRate& rate, const std::vector<double>& state, std::vector<double>& sizes);

}  // namespace anholon
