// The equations of a motion as a function f(t, x, u, p) -> x' in doubles, for the solvers of other programs: in
// independent velocities if the equations have them, otherwise in the state of the motion (the derivatives of
// coordinates and multipliers below those that the equations are solved for).
//
// A kernel evaluates the function, many states side by side, with machine code if there is a compiler. If the leading
// derivatives enter nonlinearly, the equations may have several solutions: f is then the one connected with the
// solution at the start, followed along the straight line from the start to (t, x, u, p) (theory: dae-view). The bits
// of a state's rates do not depend on the other states, the lane or the number of threads.
#pragma once
#include <functional>
#include <memory>

#include "dynamics/idle.h"
#include "kernel/kernel.h"
#include "setup/scenario.h"

namespace anholon {

struct Representation;

// u and p of a call: one set of numbers for all states, or one for each state (number i of state k at i * count + k).
// Empty: the values at the start.
struct InputsAndParameters {
  std::span<const double> u, p;
};

class Dynamics {
 public:
  struct Choice {
    bool minimal = true;     // in independent velocities if the equations have them
    std::size_t inputs = 0;  // the number of inputs, which are the last parameters of the model (setup/inputs.h)
    std::vector<std::size_t> fixed =
        {};  // parameters that keep their values, because they decide which constraints hold
  };
  // Puts the ends of tables into the workspace (setup/ends_of_tables.h).
  // Returns nullptr if these equations are no function of x, or have no solution at the start; `why` is then the
  // reason. Otherwise `why` tells why the velocities are not independent ones, a clause in words of the model; it is
  // empty if they are.
  static std::unique_ptr<Dynamics> make(Workspace& scenario, const StateChoice& choice, const Choice& wanted,
                                        std::string& why);

  // The state x: coordinates, velocities (q', or independent ones), higher derivatives, then the model's states.
  struct State {
    std::string name;     // "x", "x'", "x''", "u1" ("u1_2" if the model has a u1), "z"
    std::string meaning;  // of an independent velocity: its formula in q and q'; otherwise empty
  };
  const std::vector<State>& states() const { return states_; }
  bool minimal() const { return map_ != nullptr; }
  // True if accelerations and multipliers follow from linear equations.
  bool linear() const { return !program_->several_solutions; }
  // True if they do, and rates of the model's states follow from them by nonlinear formulas.
  bool rates_follow() const { return program_->nonlinear && linear(); }
  const std::vector<double>& start() const { return start_; }
  double start_time() const { return start_time_; }
  // free_parameters(): the indices of the parameters that do not follow from others, in the order of p. inputs(): the
  // number of inputs, which are the last parameters.
  const std::vector<std::size_t>& free_parameters() const { return free_; }
  std::size_t inputs() const { return inputs_; }

  // Computes the rates of `count` states at time t; x and rates: state i of motion k is at i * count + k. Many threads
  // may call it; large batches are computed by several threads. Rates are NaN if the equations have no solution.
  void rates(double t, const double* x, std::size_t count, double* rates, InputsAndParameters given = {}) const;

  // Returns the leading derivatives of each of `count` states, state by state and then unknown by unknown:
  // accelerations, multipliers, rates of the model's states. REQUIRES: not minimal.
  std::vector<double> leading(double t, const double* x, std::size_t count, InputsAndParameters given = {}) const;
  const std::vector<long double>& parameters() const { return parameters_; }
  // All parameters of the model for state k of `count`, with u and p in their places.
  std::vector<long double> parameters(InputsAndParameters given, std::size_t count, std::size_t k) const;

  // Convert one state: from coordinates, velocities q' with all higher derivatives of the state, and the model's
  // states; and back. p: as in InputsAndParameters, for one state.
  std::vector<double> from_motion(double t, const std::vector<double>& q, const std::vector<double>& qd,
                                  const std::vector<double>& z, std::span<const double> p = {}) const;
  struct Full {
    std::vector<double> q, qd, z;
  };
  Full to_motion(double t, const std::vector<double>& x, std::span<const double> p = {}) const;

  // The value of a symbol at the start, by which independent velocities are chosen.
  double at_start(const Node& symbol) const;

 private:
  Dynamics() = default;
  // An unknown of the program: the places of its derivatives below the leading one in x.
  struct Unknown {
    std::vector<std::size_t> places;
    int order() const { return static_cast<int>(places.size()); }
  };
  // A kernel, and the parameters of its lanes.
  struct Worker {
    std::unique_ptr<Kernel> kernel;
    bool as_given = false;  // the lanes have other parameters than at the start
  };
  struct Call {
    double t;
    const double* x;
    std::size_t count;
    InputsAndParameters given;
    bool of_start() const { return given.u.empty() && given.p.empty(); }
    bool common(std::size_t inputs, std::size_t parameters) const;
  };
  // Solves for the leading derivatives of the states from..to of the call, and calls put(k, solved) with solved(j) for
  // unknown j.
  template <class Put>
  void compute(Kernel& kernel, const Call& call, std::size_t from, std::size_t to, const Put& put) const;
  template <class Put>
  void compute_by_reference(const Call& call, std::size_t from, std::size_t to, const Put& put) const;
  // compute() for all states, in as many lanes and threads as pay.
  template <class Put>
  void solve(const Call& call, const Put& put) const;
  std::vector<long double> entries(const std::function<double(std::size_t)>& state) const;
  std::vector<double> by_reference(double t, const std::function<double(std::size_t)>& state,
                                   const std::vector<long double>& parameters) const;
  std::vector<double> along_branch(double t, const std::function<double(std::size_t)>& state,
                                   const std::vector<long double>& parameters) const;
  void put_independent_velocities(const System& system, const Representation& mapped);
  void put_state_of_motion(const System& system, const std::vector<int>& d);
  void find_free_parameters(const Model& model, std::size_t inputs);
  // Calls f with a kernel of that many lanes that is used by nobody else meanwhile. It has the parameters of the call
  // if all states have the same.
  template <class F>
  void with_kernel(int lanes, const Call& call, const F& f) const;

  std::size_t coordinates_ = 0, model_states_ = 0, inputs_ = 0;
  std::size_t state_entries_ = 0;  // of the model's states: with their rates, where a constraint needs them
  std::size_t values_ = 0;         // the number of states that are coordinates or multipliers themselves
  std::shared_ptr<const Program> program_;
  std::shared_ptr<const StateMap> map_;
  std::shared_ptr<const KernelPlan> plan_;  // nullptr if the reference computes
  std::vector<long double> parameters_;
  std::vector<std::size_t> free_;
  Tape all_parameters_;       // as functions of the free ones
  bool some_follow_ = false;  // parameters follow from others
  std::vector<State> states_;
  std::vector<Unknown> unknowns_;
  std::vector<double> start_, motion_start_;  // x; the state of the motion, unknown by unknown
  std::vector<long double> start_leading_;    // the solution there
  double start_time_ = 0;
  mutable Idle<Worker> alone_, in_lanes_;
};

}  // namespace anholon
