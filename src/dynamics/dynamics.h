// The equations of a motion as a function f(t, x, u, p) -> x' in doubles, for other people's solvers: in independent
// velocities where the equations have them, else in the state of the motion: the derivatives of coordinates and
// multipliers below those that the equations are solved for.
//
// It is evaluated by a kernel, many states side by side, with machine code if there is a compiler. Where the leading
// derivatives enter nonlinearly, the equations may have several solutions: f is then the one that joins the solution at
// the start, followed along the straight line from the start to (t, x, u, p) (theory: dae-view). A state's rates have the
// same bits alone, in any lane and on any number of threads.
#pragma once
#include <functional>
#include <memory>

#include "dynamics/idle.h"
#include "kernel/kernel.h"
#include "setup/scenario.h"

namespace anholon {

struct Representation;

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
  // Null if these equations are no function of x, or have no solution at the start; `why` then says the reason. Else `why`
  // says why the velocities are not independent ones, a clause in words of the model; empty if they are.
  static std::unique_ptr<Dynamics> make(Workspace& scenario, const StateChoice& choice, const Choice& wanted,
                                        std::string& why);

  // The state x: coordinates, velocities (q', or independent ones), higher derivatives, then the model's states.
  struct State {
    std::string name;     // "x", "x'", "x''", "u1", "z"
    std::string meaning;  // of an independent velocity: its formula in q and q'; else empty
  };
  const std::vector<State>& states() const { return states_; }
  bool minimal() const { return map_ != nullptr; }
  // Whether accelerations and multipliers follow from linear equations.
  bool linear() const { return !program_->several_solutions; }
  // Whether they do, and rates of the model's states follow from them by formulas that are not linear.
  bool rates_follow() const { return program_->nonlinear && linear(); }
  const std::vector<double>& start() const { return start_; }
  double start_time() const { return start_time_; }
  // Indices of the parameters that do not follow from others, which p holds; how many inputs follow all parameters.
  const std::vector<std::size_t>& free_parameters() const { return free_; }
  std::size_t inputs() const { return inputs_; }

  // The rates of `count` states at time t; x and rates: state i of motion k at i * count + k. May be called by many
  // threads; large batches are computed by several. NaN where the equations have no solution.
  void rates(double t, const double* x, std::size_t count, double* rates, InputsAndParameters given = {}) const;

  // What leads each of `count` states, state by state and then unknown by unknown: accelerations, multipliers, rates of
  // the model's states. REQUIRES: not minimal.
  std::vector<double> leading(double t, const double* x, std::size_t count, InputsAndParameters given = {}) const;
  const std::vector<long double>& parameters() const { return parameters_; }
  // All parameters of the model for the state k of `count`, with u and p in their places.
  std::vector<long double> parameters(InputsAndParameters given, std::size_t count, std::size_t k) const;

  // Converts one state from coordinates, velocities q' with all higher derivatives of the state, and the model's states,
  // and back. p: as in InputsAndParameters, of one state.
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
  // An unknown of the program: which states hold it and its derivatives below the one that is solved for.
  struct Unknown {
    std::vector<std::size_t> places;
    int order() const { return static_cast<int>(places.size()); }
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
    InputsAndParameters given;
    bool of_start() const { return given.u.empty() && given.p.empty(); }
    bool common(std::size_t inputs, std::size_t parameters) const;
  };
  // Solves for what leads the states from..to of the call: put(k, solved) with solved(j) of unknown j.
  template <class Put>
  void compute(Kernel& kernel, const Call& call, std::size_t from, std::size_t to, const Put& put) const;
  template <class Put>
  void compute_by_reference(const Call& call, std::size_t from, std::size_t to, const Put& put) const;
  // compute() of all states, by as many lanes and threads as pay.
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
  // Calls f with a kernel of that many lanes that nobody else uses meanwhile, with the parameters of the call where all
  // states have the same.
  template <class F>
  void with_kernel(int lanes, const Call& call, const F& f) const;

  std::size_t coordinates_ = 0, model_states_ = 0, inputs_ = 0;
  std::size_t values_ = 0;  // how many states are coordinates or multipliers themselves
  std::shared_ptr<const Program> program_;
  std::shared_ptr<const StateMap> map_;
  std::shared_ptr<const KernelPlan> plan_;  // null where the reference computes
  std::vector<long double> parameters_;
  std::vector<std::size_t> free_;
  Tape all_parameters_;       // by the free ones
  bool some_follow_ = false;  // whether parameters follow from others
  std::vector<State> states_;
  std::vector<Unknown> unknowns_;
  std::vector<double> start_, motion_start_;  // x; the state of the motion, unknown by unknown
  std::vector<long double> start_leading_;    // the solution there
  double start_time_ = 0;
  mutable Idle<Worker> alone_, in_lanes_;
};

}  // namespace anholon
