// The equations of a motion as a function f(t, x) -> x' in doubles, for other people's solvers: in independent
// velocities where the equations have them, else in all coordinates and velocities.
//
// It is evaluated by a kernel, many states side by side, with machine code if there is a compiler. A state's rates have
// the same bits alone, in any lane and on any number of threads.
#pragma once
#include <functional>
#include <memory>
#include <mutex>

#include "kernel/kernel.h"
#include "setup/scenario.h"

namespace anholon {

class Dynamics {
 public:
  // Null if there is no kernel for these equations; `why` then says the reason. `minimal`: in independent velocities if
  // the equations have them.
  static std::unique_ptr<Dynamics> make(Workspace& scenario, const StateChoice& choice, bool minimal, std::string& why);

  // The state x: coordinates, velocities (q', or independent ones), then the model's states.
  struct State {
    std::string name;     // "x", "x'", "u1", "z"
    std::string meaning;  // of an independent velocity: its formula in q and q'; else empty
  };
  const std::vector<State>& states() const { return states_; }
  bool minimal() const { return map_ != nullptr; }
  const std::vector<double>& start() const { return start_; }
  double start_time() const { return start_time_; }

  // The rates of `count` states at time t; x and rates: state i of motion k at i * count + k. May be called by many
  // threads; large batches are computed by several. NaN where the equations have no solution.
  void rates(double t, const double* x, std::size_t count, double* rates) const;

  // What leads one state, unknown by unknown: accelerations, multipliers, rates of the model's states. REQUIRES: not
  // minimal.
  std::vector<double> leading(double t, const std::vector<double>& x) const;
  const std::vector<long double>& parameters() const { return parameters_; }

  // Converts one state from coordinates, velocities q' and the model's states, and back.
  std::vector<double> from_motion(double t, const std::vector<double>& q, const std::vector<double>& qd,
                                  const std::vector<double>& z) const;
  struct Full {
    std::vector<double> q, qd, z;
  };
  Full to_motion(double t, const std::vector<double>& x) const;

 private:
  Dynamics() = default;
  // An unknown of the plan: which states hold it and its first derivative, and how many of them.
  struct Unknown {
    std::size_t value, rate;
    int order;
  };
  void compute(Kernel& kernel, double t, const double* x, std::size_t count, std::size_t from, std::size_t to,
               double* rates) const;
  std::vector<double> by_reference(double t, const std::function<double(std::size_t)>& state) const;
  // Calls f with a kernel of that many lanes that nobody else uses meanwhile.
  template <class F>
  void with_kernel(int lanes, const F& f) const;

  std::size_t coordinates_ = 0, model_states_ = 0;
  std::shared_ptr<const StateMap> map_;
  std::shared_ptr<const KernelPlan> plan_;
  std::vector<long double> parameters_;
  std::vector<State> states_;
  std::vector<Unknown> unknowns_;  // of the plan that are states
  std::vector<double> start_;
  double start_time_ = 0;
  mutable std::mutex idle_;
  mutable std::vector<std::unique_ptr<Kernel>> alone_, in_lanes_;  // kernels that nobody uses now
};

}  // namespace anholon
