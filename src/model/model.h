// The checked model: the contents of the model file, with every name resolved and the place of every element in the
// source. Immutable once built; the model owns the graph that holds its expressions.
//
// All vectors are components along the observer's axes (theory: weighted-points). Masses and weights that vary are
// frozen symbols mu_i; `masses` has the formula of each.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "expr/handles.h"
#include "formula/formula.h"
#include "model/motion_settings.h"
#include "model/view.h"
#include "print/print.h"

namespace anholon {

struct Coordinate {
  std::string name;
  Span span;
};

struct Parameter {
  std::string name;
  Expr value;  // exact, in terms of numbers and other parameters
  std::string doc;
  Span span;
  bool mode = false;  // [mode]: constant between events; `value` is its value at the start
  // The value is a vector, which formulas contain in place of the name; `value` is then zero, and no formula contains
  // this parameter.
  bool vector = false;
  // The unit that the file declares for the number, in which bare numbers given from outside count; empty: SI units.
  std::string unit = {};
};

// The observer's frame: moving components of its angular velocity and of the inertial acceleration
// of its origin, functions of time only.
struct Observer {
  Vector spin;                            // omega
  Vector origin_acceleration;             // a0
  std::optional<Vector> origin_velocity;  // moving components of the inertial velocity of the origin
  bool inertial = true;                   // neither turns nor accelerates
};

// A mass or axis weight that varies with t, q, q': its frozen symbol is graph.mass(index).
struct VaryingMass {
  std::string name;
  bool weight = false;  // true for the weight of an axis, which may be negative (products of inertia)
  Expr value;
  Span span;
};

// A second-moment axis vector u with weight e (theory: weighted-points). It contributes like a mass point but feels no
// uniform field. `frame_axis` k >= 0: u is axis k of the body's orientation.
struct Axis {
  Expr weight;  // frozen form
  Vector vector;
  std::vector<Expr> own;  // components along the body's own axes, if these are orthonormal identically
};

struct Body {
  std::string name;
  Span span;
  bool particle = false;
  Expr mass;  // frozen form; 0 for a massless rotor or a carrier
  Vector center;
  std::optional<Rotation> orientation;
  std::vector<Axis> axes;
  std::optional<Vector> expelled_velocity;  // u: leaving or joining matter minus exit point
  Vector exit_point;                        // position of that material point
  Vector gravity;                           // field at the centre
  std::vector<Vector> gravity_gradient;     // its derivatives by x, y, z; empty if it has no torque on the body
  std::optional<Shape> shape;
};

struct Force {
  enum class Kind : std::uint8_t { vector, torque, tension, generalized };
  struct Place {
    std::size_t body = 0;
    Vector point;  // position of the material point
    bool at_center = true;
  };
  std::string name;
  Span span;
  Kind kind = Kind::vector;
  Place on;
  std::optional<Place> from;  // place of the opposite force
  Vector vector;              // force or torque
  Expr tension;
  std::vector<std::pair<std::size_t, Expr>> generalized;  // coordinate, component
};

struct Potential {
  std::string name;
  Expr value;
  Span span;
};

// A function R of the velocities whose force is -dR/dq'.
struct Dissipation {
  std::string name;
  Expr value;
  std::string formula;  // as written
  Span span;
};

struct Constraint {
  std::string name;      // "blade", or "rolling.x" for a component of a vector equation
  Expr phi;              // left side - right side
  int order = 0;         // highest derivative that truly occurs
  std::string equation;  // as written
  Span span;
  std::optional<std::size_t> by =
      std::nullopt;  // kept by this input, which takes the place of lambda (servo constraint)
};

// An unknown function z of the user with z' = rate: propellant, controller, actuator.
struct StateVariable {
  std::string name;
  Expr rate, initial;
  Span span;
  Expr open_rate = {};  // see put_inputs
};

// A control: a formula of anything, represented by a symbol of its own while equations are derived. The control of a
// servo constraint is its multiplier.
struct Control {
  std::string name;
  std::optional<Expr> value;
  std::optional<std::size_t> constraint = std::nullopt;  // the constraint that it keeps
  Span span;
  Expr open = {};  // see put_inputs
  // An element in which the formula replaces the symbol, such as "the potential 'V'"; empty if there is none.
  std::string put_into = {};
};

// A number or vector that runs record.
struct OutputQuantity {
  std::string name, unit, doc;
  std::vector<Expr> values;  // one, or the three components
  bool conserved = false;
  Span span;
};

// The assignment of an event to a mode (parameter), a state, a coordinate or one of its derivatives.
struct Assignment {
  Expr symbol, value;  // the value, in which earlier assignments hold
  Span span;
  Expr open = {};  // see put_inputs
};

// A strict change of sign of a formula along the motion, and its effect.
struct Event {
  std::string name;
  Expr when;
  int direction = 0;  // 1: up, -1: down
  std::vector<Assignment> set;
  bool stop = false;
  Span span;
  Expr open_when = {};  // see put_inputs
  bool ends_step() const { return stop || !set.empty(); }
};

// A quasi-velocity u(q, q', …, t); its order is the highest derivative in it.
struct QuasiVelocity {
  std::string name;
  Expr value;
  int order = 1;
  Span span;
};

// A number that runs watch along the motion.
struct Monitor {
  std::string name;
  Expr value;
  Span span;
  Expr open = {};  // see put_inputs
};

// A formula that must stay positive: the distance of the argument of a table from an end of its knots, if nothing tells
// how the table continues.
struct Bound {
  Expr inside;
  std::string fault;
  Span span;
};

struct GivenValue {
  Expr symbol;  // q_a^(k) or lambda_r^(k)
  Expr value;   // exact
  Span span;
};

struct Condition {
  Expr residual;
  std::string text;
  Span span;
};

// The choice of one solution, if a constraint that is nonlinear in its highest derivatives has several.
struct BranchChoice {
  std::size_t constraint = 0;
  bool positive = true;  // lambda > 0
  Span span;
};

struct InitialData {
  Expr t;
  std::vector<GivenValue> given, guess;
  std::vector<Condition> conditions;
  std::vector<BranchChoice> branches;
};

// A note on what the reader did unasked, such as dropping components, or on the modes in which the equations hold.
struct ModelNote {
  enum class About : std::uint8_t { reading, open_contacts, modes_of_start };
  ModelNote(std::string what, About of = About::reading)
      : text(std::move(what)), about(of) {}  // NOLINT: a text is a note
  std::string text;
  About about;
  // True if the equations hold in other modes as well, as other equations.
  bool of_modes() const { return about != About::reading; }
};

struct Model {
  std::shared_ptr<Graph> graph;
  SourceText source_text;
  std::string title, source;
  std::vector<Coordinate> coordinates;
  std::vector<Parameter> parameters;
  std::vector<std::string> unknown_functions;  // [functions] f = {}
  std::vector<std::string> table_files;        // paths of the files that tables come from
  Observer observer;
  std::vector<VaryingMass> masses;
  std::vector<Body> bodies;  // particles among them, in the order of the file
  std::vector<Force> forces;
  std::vector<Potential> potentials;
  std::vector<Dissipation> dissipation;
  std::vector<Constraint> constraints;
  std::vector<QuasiVelocity> quasi;
  std::vector<std::size_t> dependent;  // coordinates that the user wants eliminated
  InitialData initial;
  std::vector<StateVariable> states;
  std::vector<Control> controls;  // [input]
  std::vector<OutputQuantity> outputs;
  std::vector<Event> events;
  std::vector<Bound> bounds;
  std::vector<Monitor> monitors;  // [monitor], then the numbers of the outputs
  MotionSettings simulate;
  View view;
  SymbolNames names;
  std::vector<std::string> cases;  // scenarios of the file, [case.NAME]
  // If the file has units: those of coordinates and parameters; an empty text if the unit is unknown.
  std::vector<std::string> coordinate_units, parameter_units;
  // The dimensions of the coordinates, then of the states, as numbers: entries with the same number have the same
  // dimension, as far as the formulas tell. Empty if all have number 0.
  std::vector<std::uint32_t> scales;
  std::vector<ModelNote> notes;
};

// The handles of the model (expr/handles.h).
void for_each_expression(Model& model, const ExprVisitor& f);
void for_each_expression(QuasiVelocity& u, const ExprVisitor& f);
// Returns the same model with a clone of its graph, in which the owner may build expressions. `nodes`: clones only the
// first so many nodes.
std::shared_ptr<Model> clone(const Model& model);
std::shared_ptr<Model> clone(const Model& model, std::size_t nodes);

// Substitutes the masses, mu -> m(t, q, q'), after which derivatives are no longer frozen; substitutes inputs as well.
Column put_masses(const Model& model, std::span<const Expr> es);
Expr put_masses(const Model& model, Expr e);

// These substitute masses alone, and inputs alone.
Column put_varying_masses(const Model& model, std::span<const Expr> es);
Column put_controls(const Model& model, std::span<const Expr> es);

// Returns the open form of a formula. Monitors, rates of states, events and inputs hold the formulas of the inputs.
// Beside such a formula stands its open form, in which inputs are symbols; the open form has no graph if the formula
// contains no input that has a formula.
Expr open_form(const Model& model, Expr as_read);
// Substitutes the inputs into monitors, rates and events anew, after the formulas of inputs were changed. Inputs
// without a formula stay symbols.
void put_inputs(Model& model);
// Expresses the inputs that are not in `given` by the formulas of the other inputs anew.
void put_inputs_into_inputs(Model& model, const std::set<std::size_t>& given);
// Substitutes z^(k) -> D^(k-from) of the rate, k >= from >= 1, so that no derivative of a state beyond `from` - 1 is
// left.
Expr put_state_rates(const Model& model, Expr e, unsigned from);

// Returns the name of the unknown that keeps constraint r: "lambda.rolling", or the name of the input that keeps the
// constraint.
std::string multiplier_name(const Model& model, std::size_t r);

// Returns a name for a quantity that the equations introduce, such as "m_p" or "u_x"; a number is appended if the model
// has the name already.
std::string automatic_name(const Model& model, const std::string& wanted);
// Returns the automatic name of mass i, "m_p".
std::string mass_name(const Model& model, std::size_t i);

// Returns the coordinates q, q', q'', … as columns of symbols.
Column jets(const Model& model, unsigned order);

}  // namespace anholon
