// The equations of a motion as a function f(t, x, u, p) -> x' in doubles, for other people's solvers: in independent
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

// u and p of a call: one set of numbers for all states, or one for each (number i of state k at i * count + k). Empty: the
// values at the start.
struct InputsAndParameters {
  std::span<const double> u, p;
};

class Dynamics {
 public:
  struct Choice {
    bool minimal = true;     // in independent velocities if the equations have them
    std::size_t inputs = 0;  // the last parameters of the model, as many, are the inputs (setup/inputs.h)
  };
  // Null if there is no kernel for these equations; `why` then says the reason.
  static std::unique_ptr<Dynamics> make(Workspace& scenario, const StateChoice& choice, const Choice& wanted,
                                        std::string& why);

  // The state x: coordinates, velocities (q', or independent ones), then the model's states.
  struct State {
    std::string name;     // "x", "x'", "u1", "z"
    std::string meaning;  // of an independent velocity: its formula in q and q'; else empty
  };
  const std::vector<State>& states() const { return states_; }
  bool minimal() const { return map_ != nullptr; }
  const std::vector<double>& start() const { return start_; }
  double start_time() const { return start_time_; }
  // Indices of the parameters that do not follow from others, which p holds; how many inputs follow all parameters.
  const std::vector<std::size_t>& free_parameters() const { return free_; }
  std::size_t inputs() const { return inputs_; }

  // The rates of `count` states at time t; x and rates: state i of motion k at i * count + k. May be called by many
  // threads; large batches are computed by several. NaN where the equations have no solution.
  void rates(double t, const double* x, std::size_t count, double* rates, InputsAndParameters given = {}) const;

  // What leads one state, unknown by unknown: accelerations, multipliers, rates of the model's states. REQUIRES: not
  // minimal.
  std::vector<double> leading(double t, const std::vector<double>& x, InputsAndParameters given = {}) const;
  const std::vector<long double>& parameters() const { return parameters_; }
  // All parameters of the model for the state k of `count`, with u and p in their places.
  std::vector<long double> parameters(InputsAndParameters given, std::size_t count, std::size_t k) const;

  // Converts one state from coordinates, velocities q' and the model's states, and back.
  std::vector<double> from_motion(double t, const std::vector<double>& q, const std::vector<double>& qd,
                                  const std::vector<double>& z) const;
  struct Full {
    std::vector<double> q, qd, z;
  };
  Full to_motion(double t, const std::vector<double>& x) const;

  // The value of a symbol at the start, by which independent velocities are chosen.
  double at_start(const Node& symbol) const;

 private:
  Dynamics() = default;
  // An unknown of the plan: which states hold it and its first derivative, and how many of them.
  struct Unknown {
    std::size_t value, rate;
    int order;
  };
  // A kernel and whose parameters its lanes have.
  struct Worker {
    std::unique_ptr<Kernel> kernel;
    bool as_given = false;  // other than those at the start
  };
  struct Call {
    double t;
    const double* x;
    std::size_t count;
    double* rates;
    InputsAndParameters given;
    bool of_start() const { return given.u.empty() && given.p.empty(); }
    bool common(std::size_t inputs, std::size_t parameters) const;
  };
  void compute(Kernel& kernel, const Call& call, std::size_t from, std::size_t to) const;
  std::vector<double> by_reference(double t, const std::function<double(std::size_t)>& state,
                                   const std::vector<long double>& parameters) const;
  void find_free_parameters(const Model& model, std::size_t inputs);
  // Calls f with a kernel of that many lanes that nobody else uses meanwhile, with the parameters of the call where all
  // states have the same.
  template <class F>
  void with_kernel(int lanes, const Call& call, const F& f) const;

  std::size_t coordinates_ = 0, model_states_ = 0, inputs_ = 0;
  std::shared_ptr<const StateMap> map_;
  std::shared_ptr<const KernelPlan> plan_, derived_;
  std::vector<long double> parameters_;
  std::vector<std::size_t> free_;
  Tape all_parameters_;       // by the free ones
  bool some_follow_ = false;  // whether parameters follow from others
  std::vector<State> states_;
  std::vector<Unknown> unknowns_;             // of the plan that are states
  std::vector<double> start_, motion_start_;  // x; q_a and q_a' one after the other, then z
  double start_time_ = 0;
  mutable std::mutex idle_;
  mutable std::vector<Worker> alone_, in_lanes_;  // kernels that nobody uses now
};

}  // namespace anholon
