// The equations of a motion as a function x' = f(t, x, u, p), for integrators and optimizers of others.
#pragma once
#include <optional>
#include <span>

#include "anholon/system.h"

namespace anholon::v1 {

struct DynamicsOptions {
  // In independent velocities, which satisfy the constraints whatever their values are (theory: quasi-velocities), if
  // the equations have them; else in the state of the motion: all coordinates and velocities, and higher derivatives
  // where constraints of order 2 and more ask for them.
  bool minimal = true;
  // Whether inputs of the model are arguments u: all that can be set, or those named, in this order. Else their formulas
  // stand in f.
  bool inputs = false;
  std::vector<std::string> input_names = {};
  // Instead of all monitors and outputs of the model: some by their names, or formulas in the names of the model, also of
  // multipliers (lambda.NAME) and reactions (reaction(BODY), a vector). An empty formula: the name is the formula.
  struct Output {
    std::string name, formula = {};
  };
  std::optional<std::vector<Output>> outputs = {};
};

struct StateName {
  std::string name;     // "x", "x'", "x''", an independent velocity "u1", a state of the model
  std::string meaning;  // of an independent velocity: its formula in coordinates and velocities; else empty
};

// A function  x' = f(t, x, u, p)  with outputs  y = h(t, x, u, p).  p: the parameters of the model that do not follow from
// others, without those whose values decide the order of the equations, such as a mass that is 0, or which constraints
// with `active` hold. A power with an exponent of parameters has a value at every state if p makes the exponent a whole
// number, and for positive bases otherwise. Immutable, cheap to copy, and safe to use from many threads. Numbers are in SI
// units; an output that has a unit in the file is in that unit.
class ANHOLON_API Dynamics {
 public:
  // What x holds: coordinates, velocities, higher derivatives, then the model's states.
  const std::vector<StateName>& states() const;
  std::vector<std::string> inputs() const;      // what u holds
  std::vector<std::string> parameters() const;  // what p holds
  std::vector<std::string> outputs() const;     // what y holds: monitors and outputs of the model
  bool minimal() const;
  // The reason why the velocities are not independent ones, a clause such as "the constraint 'rod' is of order 0"; empty if
  // minimal.
  const std::string& obstacle() const;
  // Whether the equations are linear in what they are solved for. Where they are not, they may have several solutions: the
  // rates are those of the solution that joins the one at the start, followed along the straight line from there, and NaN
  // where it ends.
  bool linear() const;
  double start_time() const;
  const std::vector<double>& start() const;      // x at the initial state
  std::vector<double> start_inputs() const;      // u there
  std::vector<double> parameter_values() const;  // p as the model has it

  // u and p of a call: empty (the inputs by their formulas, the parameters of the model), one set of numbers for all
  // states, or one for each, in the order of x.
  struct Given {
    std::span<const double> u = {}, p = {};
    bool nan_if_stopped = true;
  };

  // Under a StopRequest the functions of many states end early if it asks for it. Their numbers are then NaN;
  // without nan_if_stopped they are anything, as large arrays take long to fill.

  // The rates of `count` states at time t. Number i of state k is at [i * count + k] of both arrays, of the size
  // states() * count. NaN where the equations have no solution. A state has the same bits alone and among others.
  // REQUIRES: the sizes fit.
  void rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates, const Given& given) const;
  void rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates) const {
    this->rates(t, x, count, rates, Given{});
  }

  // The outputs of `count` states, in their order: output i of state k at [i * count + k]. REQUIRES: the sizes fit.
  std::vector<double> outputs(double t, std::span<const double> x, std::size_t count, const Given& given) const;
  // The inputs of one state by the formulas of the model. REQUIRES: the sizes fit.
  std::vector<double> inputs(double t, const std::vector<double>& x, std::span<const double> p) const;
  // The given ones, and the others by their formulas, in which the given ones act.
  std::vector<double> inputs(double t, const std::vector<double>& x, std::span<const double> p,
                             std::span<const std::optional<double>> given) const;

  // The exact derivatives of the rates, then of the outputs, of `count` states by x, u or p: number (i, j) of state k at
  // [(i * columns + j) * count + k]. NaN where the equations have no solution. REQUIRES: the sizes fit.
  enum class By : std::uint8_t { state, input, parameter };
  struct Jacobian {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values;
  };
  Jacobian jacobian(double t, std::span<const double> x, std::size_t count, const Given& given,
                    By by = By::state) const;

  // The linear equations that are solved at `count` states for accelerations, multipliers and rates of the model's
  // states: matrix unknowns = right, the matrix row by row, with the numbers of all states one after the other as in a
  // Jacobian. REQUIRES: not minimal; linear; the sizes fit.
  struct Equations {
    std::vector<std::string> unknowns;
    std::vector<double> matrix, right;
  };
  Equations equations(double t, std::span<const double> x, std::size_t count, const Given& given) const;

  // What the equations of one state are solved for, unknown by unknown. Empty if minimal. REQUIRES: the sizes fit.
  std::vector<double> leading(double t, const std::vector<double>& x, const Given& given) const;

  // The function as source text: a C file with name_rhs and, in CasADi's external interface, name and jac_name; a Python
  // module whose functions take the library for arrays as an argument.
  // REQUIRES: linear, for C. Throws std::domain_error if a power with a parameter in its exponent has no value at the
  // start, where the formulas need one.
  enum class Source : std::uint8_t { casadi, formulas };
  std::string source(Source kind, const std::string& name = "motion") const;

  // One state from coordinates q, velocities qdot (followed by the higher derivatives of states()) and the model's states
  // z, and back. p: the parameters, on which independent velocities may depend; empty: those of the model.
  // REQUIRES: the sizes fit.
  std::vector<double> from_motion(double t, const std::vector<double>& q, const std::vector<double>& qdot,
                                  const std::vector<double>& z = {}, std::span<const double> p = {}) const;
  struct Motion {
    std::vector<double> q, qdot, z;
  };
  Motion to_motion(double t, const std::vector<double>& x, std::span<const double> p = {}) const;

  struct Data;
  explicit Dynamics(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

 private:
  std::shared_ptr<const Data> data_;
};

// Redundant constraints take no part. Errors: equations without a solution at the start, a form that eliminates
// coordinates, an input that cannot be set, an output that is not known.
ANHOLON_API Result<Dynamics> dynamics(const System& system, const DynamicsOptions& options = {});

}  // namespace anholon::v1
