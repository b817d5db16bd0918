// [[contact]]: unilateral contacts with Coulomb friction and restitution (theory: contact).
//
// A contact is no part of the equations of a model: the reader returns the model in which all contacts are open.
// Motions make a model for each mode of the contacts (contact/mode/mode_model.h).
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "modelfile/names/names.h"

namespace anholon {

enum class ImpactLaw : std::uint8_t { newton, poisson };

// The forces of contacts in formulas of the model, lambda.NAME and so on: symbols whose values depend on the mode.
struct ContactForces {
  struct Force {
    std::size_t contact = 0;
    std::optional<std::size_t> friction;  // this component of the friction, or of the moment of resistance; nullopt: N
  };
  struct Formula {
    // rate: of a state, linear in the forces.
    enum class Of : std::uint8_t { monitor, output, event, rate } of = Of::monitor;
    std::size_t index = 0;      // index among its kind; the element of the model holds the value with all contacts open
    Expr value;                 // multiplier kContactForces + k is force k
    std::size_t component = 0;  // of an output that is a vector
  };
  std::vector<Force> forces;
  std::vector<Formula> formulas;
};

// The data of a [[constraint]] with active = "…", which has no laws of a contact: it holds in both directions while a
// formula of modes is positive.
struct Switch {
  Expr active;
  int order = 0;         // order of the constraint, 0 or 1
  std::string equation;  // as written
  // Its place among the constraints of the model if it holds at the start; the model then has it.
  std::optional<std::size_t> at_start;
};

// The SI units of a contact in a file with units; empty if they do not follow.
struct ContactUnits {
  std::string gap, normal, slip, friction;  // for resistance, slip is an angular velocity and friction a moment
};

struct Contact {
  std::string name;
  std::string element;     // its name in the file; for a corner of a box, that of the box
  std::string shape;       // shape of the body: point, ball, disc, torus or box; empty if the gap is a formula
  Expr gap;                // g(q, t) >= 0
  std::vector<Expr> slip;  // components of the relative tangential velocity, at most two, linear in q'
  Expr friction;           // coefficient of slip, mu >= 0
  Expr static_friction;    // coefficient of sticking
  Expr restitution;        // 0 … 1
  ImpactLaw law = ImpactLaw::newton;
  Span span;
  // For resistance to rolling or drilling: the index of its contact, which precedes it in the list and whose gap it
  // has. Its `slip` is an angular velocity, and its coefficients of friction are the lengths that, times N, are the
  // largest moment.
  std::optional<std::size_t> under;
  // A coefficient as written, for errors.
  struct Coefficient {
    std::string key;
    Expr value;
    Span span;
  };
  std::vector<Coefficient> given;
  std::vector<Expr> sizes;     // sizes of the shapes in contact, as far as they are given; they are positive
  std::optional<Switch> held;  // a constraint that holds in some modes; `gap` is its left side minus its right side
  std::shared_ptr<const ContactForces> forces;  // the forces of all contacts of the model; null if no formula holds any
  ContactUnits units;
  // The borders of surfaces of all contacts, if motions look at them (contact/surface/borders.h); else null.
  std::shared_ptr<const std::vector<Expr>> borders;
  bool rough() const;  // true if there is friction
};

// Returns the SI units of the columns of contacts: {"floor.gap": "m", "floor.normal": "N"}, as far as they are known.
std::map<std::string, std::string> column_units(const std::vector<Contact>& contacts);

// Returns a hint how a coefficient of a contact is varied, if a word such as "floor.friction" names one; else empty.
std::string hint_for_coefficient(const std::string& name);

// True if a [[constraint]] has one_sided = true. Throws Failure if the value is neither true nor false.
bool is_one_sided(const Item& constraint);

// True if a [[constraint]] holds in some modes only: it has the key 'active'.
bool is_switched(const Item& constraint);

// Reads the contacts of a file whose names are declared: its [[contact]]s, each followed by its resistance to rolling
// (NAME.rolling) and drilling (NAME.drilling), then its one-sided constraints, whose gaps are left - right. Contacts
// with friction or restitution must have the same law of impacts. Errors go to the diagnostics.
std::vector<Contact> read_contacts(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
