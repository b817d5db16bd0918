// The dimension of a formula, by its syntax tree.
#pragma once
#include <functional>
#include <tuple>

#include "formula/functions.h"
#include "modelfile/check/unify.h"
#include "modelfile/names/names.h"

namespace anholon {

// The kind of a formula as far as dimensions matter. The components of a vector have one dimension; entries of a
// rotation are numbers.
struct Measured {
  enum class Type : std::uint8_t { number, vector, rotation, body, other } type = Type::other;
  DimensionForm dimension;
};

class FormulaDimensions {
 public:
  // Tells whether the units of values from outside (--set) are read; if ignored, such a value has any dimension.
  enum class Overrides : std::uint8_t { read, ignored };

  FormulaDimensions(const Scope& scope, const Model& model, Overrides overrides);

  // Declares all names; a clash inside a declaration is reported once, at its place.
  void declarations(Diagnostics& found);

  void look_for_units(const Syntax& s);
  Measured of(const Syntax& s);
  Measured of(const Item& item);  // a formula, or an array of three
  // Returns the dimension of a side of an equation or of a term of a sum: a single axis is 1 of any unit along it, as
  // in vel(P) = T.x.
  Measured term(const Syntax& s);
  Measured term(const Item& item) { return item.is_formula() ? term(parse_formula(item.formula)) : of(item); }
  Measured named(const std::string& name);
  DimensionForm unit(const char* text) const;
  // Throws Failure if m cannot have the wanted dimension.
  void expect(const Measured& m, const DimensionForm& wanted, Span place);
  void expect(const Item& item, const DimensionForm& wanted);  // a formula or an array; other items are skipped
  // Requires that the sizes of a shape, as in "disc(R)", are lengths. Throws Failure if one cannot be a length.
  void expect_lengths(const Item& shape);
  void alike(const Measured& a, const Measured& b, Span place, const char* between, const char* behind = "");
  std::optional<Dimension> known(const std::string& name);
  std::optional<Dimension> known(const DimensionForm& form) const { return dimensions_.known(form); }

  // Returns the dimensions of x and y of a table.
  std::pair<DimensionForm, DimensionForm> table(const std::string& name);
  // Returns the dimension of a unit that is given beside a value.
  DimensionForm given_unit(const std::string& text);

  // A number without a unit, other than 0, as a term of a sum whose terms have a unit: the 2 of "2 + r" with a length r.
  struct BareTerm {
    Span span;
    std::string text;  // text of the number
    Dimension dimension;
  };
  // Returns the bare terms of all formulas that were checked, in the order of the file.
  std::vector<BareTerm> bare_terms() const;

  // Returns the dimension of lambda.NAME; nullopt if it is not known.
  std::function<std::optional<DimensionForm>(const std::string&)> of_multiplier;
  bool units_seen = false;  // in the file, not in --set
  bool in_field = false;    // in [gravity], where 'here' denotes a place

 private:
  Measured declared(const std::string& name, const Scope::Declaration& d);
  Measured measured(const Syntax& s);
  Measured call(const Syntax& s);
  Measured by_rule(const Syntax& s, DimensionRule rule);
  Measured argument(const Syntax& s, std::size_t i);
  // Requires that all arguments have one dimension, which is returned.
  Measured one_dimension(const Syntax& s, const std::string& behind);
  Measured components(const Syntax& s);
  Measured one_of_values(const Syntax& s, DimensionRule rule);
  Measured rate_of_point(const Syntax& s, int times);
  Measured user_call(const Syntax& s, const Scope::Declaration& d);
  Measured sum(const Syntax& s);
  Measured product(const Syntax& s);
  Measured raised(const Syntax& s);
  Measured number(DimensionForm d = {}) const { return {Measured::Type::number, std::move(d)}; }
  Measured vector(DimensionForm d = {}) const { return {Measured::Type::vector, std::move(d)}; }
  Measured anything() { return {Measured::Type::other, dimensions_.unknown()}; }
  void seen(const DimensionForm& unit);
  void pure(const Syntax& argument);
  bool is_body(const std::string& name) const;

  // A number that is a term of a sum.
  struct BareNumber {
    Span span;
    std::string text;
    DimensionForm dimension;
  };

  const Scope& scope_;
  Dimensions dimensions_;
  std::map<std::string, Measured> names_;
  std::map<std::string, std::pair<DimensionForm, DimensionForm>> tables_;
  std::map<std::string, Syntax> functions_;
  std::vector<std::map<std::string, Measured>> arguments_;
  Diagnostics* found_ = nullptr;
  std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, BareNumber> bare_;  // by file, line and column
  std::vector<std::string> open_;
  std::size_t calls_ = 0;
  int depth_ = 0;
  bool in_override_ = false;
  Overrides overrides_;
};

}  // namespace anholon
