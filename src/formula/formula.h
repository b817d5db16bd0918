// Typed formulas: text -> syntax tree -> number, vector or rotation.
//
// The grammar (doc/language.md, Formulas): + - * / ^ with the usual strength (^ binds to the right and before a leading
// minus), postfix ' for the total derivative, calls f(a, b), members P.x, arrays [a, b, c], one or more `=` in an
// equation. A number may carry a unit, `30 deg`, `9.81 m/s^2`, after a blank and without blanks in it. Names are
// letters, digits and _; a Greek letter is the same name as its spelling; superscript 2 3, ·, ×, − and other dashes are
// accepted. `#` starts a comment.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "expr/diff.h"
#include "expr/handles.h"

namespace anholon {

struct Indices;  // formula/indices.h

// Maps an offset (in characters) of a formula to its position in the file, because the text of a TOML string may start
// anywhere, contain escapes or span several lines.
class FormulaText {
 public:
  FormulaText() = default;
  // A text that starts at `start` and runs without escapes.
  FormulaText(std::string text, Span start);
  // A text with the place of each of its characters.
  FormulaText(std::string text, std::vector<Span> places);
  const std::string& text() const { return text_; }
  Span span(std::size_t offset, std::size_t length) const;  // in characters
  Span whole() const;
  // The meanings of the letters of [index] in the formula; null if there are none.
  const std::shared_ptr<const Indices>& indices() const { return indices_; }
  void set_file(std::uint32_t file);
  void set_indices(std::shared_ptr<const Indices> indices) { indices_ = std::move(indices); }

 private:
  std::string text_;
  std::shared_ptr<const Indices> indices_;
  Span start_;
  std::vector<Span> places_;  // per character; empty: start_ plus offset
};

struct Syntax {
  enum class Op : std::uint8_t {
    number,
    quantity,  // a number with a unit: args[0] the number, text the unit as written
    name,
    call,
    member,
    array,
    negate,
    power,
    prime,
    index,
    apply,  // P[i-1], T[i](a, b) (args[0] is T[i]) and f.c0(x); a parsed formula holds names and calls instead
    add,    // args joined by operators add, subtract
    subtract,
    multiply,  // args joined by operators multiply, divide, dot, cross
    divide,
    compare,  // one of > < >= <= (in text) between two operands: a condition of piecewise
    dot,
    cross,  // the signs · and ×: these products for two vectors, the ordinary product for numbers
  };
  struct Operator {
    Op op;
    Span span;
  };
  Op op;
  std::string text;                 // name, number or member
  std::vector<Syntax> args;         // operands; of a call or index the arguments (callee in text)
  Span span;                        // place of the operator or name itself
  std::size_t offset = 0, end = 0;  // the whole subformula, in characters
  std::vector<Operator> operators;  // for add and multiply: the operators before args[1], args[2], …
};

// Parses one formula; parse_equation parses the sides of an equation. Throws Failure.
Syntax parse_formula(const FormulaText& text);
std::vector<Syntax> parse_equation(const FormulaText& text);  // one side or two
std::vector<Syntax> parse_plain(const FormulaText& text);     // the same without substituting indices

// Returns the formula as text, with brackets if they are needed.
std::string print(const Syntax& s);

// Returns the spelling under which a name is known: Greek letters become their names.
std::string normal_name(std::string_view name);
bool is_identifier(std::string_view name);  // after normal_name

// ---- values --------------------------------------------------------------------------------

struct Vector {
  Expr x, y, z;  // components along the observer's axes
  Expr& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  const Expr& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
};

// A rotation with its angular velocity relative to the observer, by components along the observer's axes and along its
// own axes. Both are built up turn by turn, so they stay short.
struct Rotation {
  Vector columns[3];     // the new axes in the observer's axes
  Vector rate;           // angular velocity, components along the observer's axes
  Vector own_rate;       // the same vector, components along the new axes
  bool by_turns = true;  // orthonormal identically (a quaternion is orthonormal only on its unit sphere)
  const Vector& operator[](int k) const { return columns[k]; }
};

inline void for_each_expression(Vector& v, const ExprVisitor& f) {
  auto& [x, y, z] = v;
  for_each_expression_of(f, x, y, z);
}
inline void for_each_expression(Rotation& r, const ExprVisitor& f) {
  auto& [columns, rate, own_rate, by_turns] = r;
  for_each_expression_of(f, columns, rate, own_rate, by_turns);
}

Vector operator+(const Vector& a, const Vector& b);
Vector operator-(const Vector& a, const Vector& b);
Vector operator*(Expr k, const Vector& a);
Expr dot(const Vector& a, const Vector& b);
Vector cross(const Vector& a, const Vector& b);
Vector zero_vector(Graph& g);
bool is_zero(const Vector& a);
Vector total_derivative(const Vector& a);
Vector operator*(const Rotation& r, const Vector& a);
Vector transpose_times(const Rotation& r, const Vector& a);
Rotation operator*(const Rotation& a, const Rotation& b);
Rotation identity_rotation(Graph& g);
Rotation turn(int axis, Expr angle);  // rotx, roty, rotz: axis 0, 1, 2
Rotation turn(const Vector& unit_axis, Expr angle);
// Returns the rotation with the given axes; its rate is 1/2 sum_k u_k x u_k' (theory: weighted-points).
Rotation rotation_from_axes(const Vector& x, const Vector& y, const Vector& z);

// A body named in a formula. A particle can be used as a point, and a body with an orientation as a frame
// (Names::point, Names::frame). Every body has `B.center`, `B.x`, vel(B, P), ….
struct BodyName {
  std::size_t index;
};
struct InertialName {};
// A name without a value of its own: that of a table without an argument, lambda without a constraint. `is` says in
// messages what it is.
struct IncompleteName {
  const char* is;
};
inline constexpr IncompleteName kMultipliers{"a list of multipliers (one is lambda.NAME)"},
    kMultipliersOfVector{"a list of multipliers (one is lambda.NAME.x)"};

using Value = std::variant<Expr, Vector, Rotation, BodyName, InertialName, IncompleteName>;
const char* type_name(const Value& v);
inline bool is_body(const Value& v) { return std::holds_alternative<BodyName>(v); }
inline bool is_inertial(const Value& v) { return std::holds_alternative<InertialName>(v); }
inline bool is_incomplete(const Value& v) { return std::holds_alternative<IncompleteName>(v); }
inline bool is_scalar(const Value& v) { return std::holds_alternative<Expr>(v); }

// The meaning of names. Lookups throw Failure for unknown names (`span` gives the position).
struct Names {
  virtual ~Names() = default;
  virtual Graph& graph() = 0;
  virtual Value name(const std::string& name, Span span) = 0;
  // Evaluates functions beyond the built-in ones (velocity of a point, given functions); returns nullopt for an unknown
  // one.
  virtual std::optional<Value> call(const std::string& function, const std::vector<Value>& arguments,
                                    const Syntax& syntax) = 0;
  virtual Value member(const Value& object, const Syntax& syntax) = 0;
  virtual std::vector<std::string> functions() const = 0;  // for "did you mean"
  // These return the point, or the frame, that a body represents; nullopt if the body has none.
  virtual std::optional<Vector> point(const BodyName& /*body*/, Span /*use*/) { return std::nullopt; }
  virtual std::optional<Rotation> frame(const BodyName& /*body*/, Span /*use*/) { return std::nullopt; }
  virtual std::string body_name(const BodyName& /*body*/) const { return "B"; }
  // True if the model declares this name.
  virtual bool declares(const std::string& /*name*/) const { return false; }
  // Returns the expression as a function of time, before a formula is differentiated by time.
  virtual Expr in_time(Expr e) { return e; }
  // Is called for each quat(…), because it is a rotation only if its norm is 1.
  virtual void quaternion(const std::array<Expr, 4>& /*components*/, const Syntax& /*call*/) {}
};

// Replaces a body by its point (or frame), if it has one; other values are unchanged.
Value as_point(Value v, Names& names, Span use);
Value as_frame(Value v, Names& names, Span use);
// Returns the hint for a body that is neither point nor frame: "write shell.center for its point".
std::string body_hint(const Value& v, const Names& names);

// Throws the Failure of a call of a function that neither the formulas nor the names have.
[[noreturn]] void refuse_unknown_function(const Syntax& call, Names& names);

Value evaluate(const Syntax& s, Names& names);
Expr evaluate_number(const Syntax& s, Names& names);
Vector evaluate_vector(const Syntax& s, Names& names);  // 0 is also the zero vector
Rotation evaluate_rotation(const Syntax& s, Names& names);

}  // namespace anholon
