// The meaning of names in a model file, looked up when needed, in any order of declaration.
//
// Values (coordinates, parameters, functions, defines, frames, points) share one namespace, bodies have their own, so
// that a point P and a body P may live together.
#pragma once
#include <functional>
#include <map>
#include <set>

#include "expr/table.h"
#include "model/model.h"
#include "modelfile/names/forces_in_formulas.h"
#include "modelfile/names/identity.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/toml.h"

namespace anholon {

class Scope final : public Names {
 public:
  explicit Scope(Model& model) : model_(model) {}

  // A declaration. Its formula is parsed and evaluated at its first use.
  enum class Role : std::uint8_t { coordinate, parameter, function, define, frame, point, state, control, table };
  struct Declaration {
    Role role = Role::define;
    std::size_t index = 0;  // index of a coordinate, parameter or unknown function
    FormulaText formula;
    const Item* item = nullptr;          // an array value
    std::vector<std::string> arguments;  // of a function with arguments
    Span span;
    bool symbolic = false;  // a symbol of its own: coordinate, unknown function
    std::string unit;       // unit of a parameter {value, unit}
    std::string override;   // "--set m=3", if the value comes from the command line
    enum class State : std::uint8_t { fresh, open, done, failed } state = State::fresh;
    std::size_t place = 0;  // among all declarations
    Value value = InertialName{};
    Syntax body{};  // of a function with arguments
    bool parsed = false;
  };
  void reserve(const std::set<std::string>& letters) { letters_ = letters; }  // letters of [index]
  // Throws Failure if the name is reserved, already taken, or not an identifier (P[2], with whole numbers in a bracket,
  // is allowed).
  void declare(const std::string& name, Declaration d);
  void declare_body(const std::string& name, Span span);
  // Notes that the declaration of the name failed, and that this was reported: its uses fail silently.
  void note_failed(const std::string& name) { failed_.insert(name); }
  // Throws the Failure of a name that nothing declares.
  [[noreturn]] void refuse_unknown(const std::string& name, Span span) const;
  void set_gravity(const Item& field);
  std::size_t add_table(Table table);
  bool has_tables() const { return !tables_.empty(); }

  // The parts of bodies, evaluated on demand (a centre may refer to another body's centre).
  struct BodyParts {
    const Item* center = nullptr;
    const Item* orientation = nullptr;
    const Item* angle = nullptr;
    bool particle = false;
    bool center_open = false, orientation_open = false;
    bool center_failed = false, orientation_failed = false;  // true if the part failed, and the failure was reported
    bool body_failed = false;                                // true if its section has an error, which was reported
    std::optional<Vector> center_value;
    std::optional<Rotation> orientation_value;
  };
  BodyParts& parts(std::size_t body) { return parts_[body]; }
  Vector center(std::size_t body, Span use);
  bool is_particle(std::size_t body) const { return parts_[body].particle; }
  // For messages: "the particle 'bob'", and the hint if it has no orientation.
  std::string what_is(std::size_t body) const;
  std::string orientation_hint(std::size_t body) const;
  bool has_orientation(std::size_t body) const { return parts_[body].orientation || parts_[body].angle; }
  const Rotation& orientation(std::size_t body, Span use);
  std::size_t body(const std::string& name, Span span) const;  // throws if there is none
  const std::size_t* find_body(const std::string& name) const;
  const std::vector<std::string>& body_names() const { return body_names_; }

  // Evaluates an item: a string or number is a formula, an array a vector.
  Expr number(const Item& item);
  Vector vector(const Item& item);
  Rotation rotation(const Item& item);
  std::vector<Syntax> equation(const Item& item);
  Value evaluate_value(const Item& item);
  void resolve_all();  // evaluates unused declarations, so that their errors are reported
  const std::map<std::string, Declaration>& declarations() const { return declarations_; }

  // In potentials the name of a varying mass denotes its frozen symbol.
  bool freeze_masses = false;
  ForcesInFormulas forces;
  Vector gravity_at(const Vector& place, Span use);
  // Returns the derivatives of the field of gravity by the three coordinates of the place; empty if the field is
  // uniform.
  bool gravity_gradient = false;  // set by [gravity] gradient
  std::vector<Vector> gravity_gradient_at(const Vector& place, Span use);
  std::vector<Diagnostic> failures;  // failures of declarations evaluated on demand

  // Names
  Graph& graph() override { return *model_.graph; }
  Value name(const std::string& name, Span span) override;
  std::optional<Value> call(const std::string& function, const std::vector<Value>& arguments,
                            const Syntax& syntax) override;
  Value member(const Value& object, const Syntax& syntax) override;
  std::vector<std::string> functions() const override;
  std::optional<Vector> point(const BodyName& body, Span use) override;
  std::optional<Rotation> frame(const BodyName& body, Span use) override;
  std::string body_name(const BodyName& body) const override { return body_names_[body.index]; }
  bool declares(const std::string& name) const override { return declarations_.count(name) > 0 || find_body(name); }
  void quaternion(const std::array<Expr, 4>& components, const Syntax& call) override {
    quaternions_.push_back({components, call.span});
  }

  // The quaternions met so far, in the order of their evaluation.
  struct Quaternion {
    std::array<Expr, 4> components;
    Span span;
  };
  const std::vector<Quaternion>& quaternions() const { return quaternions_; }

  std::vector<Identity> identities;  // what holds for the numbers of the file, and has to hold for other numbers

 private:
  // A definition that leads through too many others to be evaluated in one go: it is evaluated after the definitions
  // that it needs.
  struct TooDeep {
    std::string name;
    Declaration* declaration;  // null for a part of a body
    Span use;
    std::function<void()> ask;
  };
  class Call;
  void from_the_ground(const std::function<void()>& ask);
  void settle(const std::string& name, Declaration& d, Span use);
  void settle_center(std::size_t body, Span use);
  void settle_orientation(std::size_t body, Span use);
  void check_name(const std::string& name, Span span) const;
  const Value& resolve(const std::string& name, Declaration& d, Span use);
  Value in_its_unit(Value v, const Declaration& d);
  Value evaluate_declaration(const std::string& name, Declaration& d);
  Vector material_velocity(std::size_t body, const Vector& place, Span use);
  Vector inertial_rate(const Vector& v);
  bool speaks_of_multipliers();
  bool holds_multiplier(const std::string& name);
  Value multiplier(const std::string& path, Span use);
  Vector reaction_on(std::size_t body, const Syntax& call);
  Expr look_up(std::size_t table, Expr x, Span use);

  Model& model_;
  std::map<std::string, Declaration> declarations_;
  std::set<std::string> letters_, failed_;
  std::map<std::string, std::size_t> bodies_;
  std::vector<std::string> body_names_;
  std::vector<Span> body_spans_;
  std::vector<BodyParts> parts_;
  struct TableEntry {
    Table table;
    TableFunction function;
  };
  std::vector<TableEntry> tables_;
  const Item* gravity_ = nullptr;
  std::optional<Vector> here_;
  std::vector<Quaternion> quaternions_;
  std::vector<std::string> open_;                        // path of names being evaluated
  std::size_t depth_ = 0;                                // depth of nested definitions and parts of bodies
  std::vector<std::map<std::string, Value>> arguments_;  // arguments of functions being called
  std::size_t calls_ = 0;                                // calls of given functions, over the whole file
};

// Multipliers from this one on are forces of contacts; models have far fewer constraints.
inline constexpr std::uint32_t kContactForces = 1U << 20U;

// The places in which multipliers and reactions are allowed.
inline constexpr const char* kWhereMultipliers =
    "such a formula stands in conditions, monitors, outputs, rates and events, or in a [define] that these use";
bool is_reaction(const std::string& function);
// Returns "rolling.x" for lambda.rolling.x; empty for other members.
std::string multiplier_path(const Syntax& member);

// True if a number with a unit occurs in the formula.
bool has_unit(const Syntax& s);

}  // namespace anholon
