// Turns names and numbers that are given beside a model into a form and a choice of state. The command line and the
// library share these functions. All of them throw Failure without a place.
#pragma once
#include "modelfile/names/constant.h"
#include "modelfile/names/declared_unit.h"
#include "setup/scenario.h"

namespace anholon {

const Formulation& named_form(const std::string& name);
// Throws if the form does not apply to the model.
void must_apply(const Formulation& form, const Mechanics& mechanics);
// Throws if no motion is computed in the form.
void must_have_motions(const Formulation& form, const Mechanics& mechanics);
// Returns the forms that apply, "routh, maggi, …"; `with_motions` leaves out those for which no motion is computed.
std::string forms_that_apply(const Mechanics& mechanics, bool with_motions);

// Returns the index of a coordinate; `called` begins the message: "--eliminate: ".
std::size_t coordinate_of(const Model& model, const std::string& name, const std::string& called = {});

// The quantity to which an initial value belongs: x'' is of order 2; lambda.blade is a multiplier.
struct InitialName {
  std::string name;  // without primes and "lambda."
  unsigned order = 0;
  bool multiplier = false;
};
InitialName initial_name(const std::string& written);
// Adds a value to the choice. Throws if no quantity has the name, if the value follows from the state or is given
// already, or if it has the unit of another quantity.
void give(StateChoice& choice, const Model& model, const InitialName& of, const Constant& value,
          const std::string& called = {});

// The physical quantity of values that are given beside a model: that of a parameter, or of a derivative of a
// coordinate. In a file without units the quantity follows from the formulas; the text of the file is then read again,
// once.
class GivenQuantity {
 public:
  // REQUIRES: the model outlives the object.
  static GivenQuantity of_parameter(const Model& model, std::size_t index);
  static GivenQuantity of_coordinate(const Model& model, std::size_t index, unsigned order);

  struct Misfit {
    std::string message;            // "a length (m) is expected here, this is a mass (kg)"
    std::string unit;               // the expected SI unit; "1" for a pure number; empty if there is none
    std::string bare = "SI units";  // what bare numbers count in
    // Returns "a number in m, or a bare number in SI units"; `before` is "a number " or empty.
    std::string hint(const std::string& before) const;
  };
  // Returns nullopt if the value has no unit or a unit of this quantity.
  std::optional<Misfit> misfit(const Constant& value);
  // Returns the number of the value as users see it: that of a parameter is in the unit that the file declares for it,
  // and a bare number is given in this unit.
  Rational number(const Constant& value) const { return value.dimension ? bare_.number(value.value) : value.value; }

 private:
  GivenQuantity(const Model& model, std::string name, std::string unit, unsigned order);

  const Model* model_;
  std::string name_, unit_;  // unit_: the SI unit, empty if it is unknown
  std::string declared_;     // the unit of bare numbers as the file writes it; empty if the file declares none
  DeclaredUnit bare_;        // the same
  unsigned order_;
  bool looked_ = false;
};
// Return the value of a time in s, and of a pure number. Both throw if the value has another unit; `called` begins the
// message: "--to: ".
Rational time_value(const Constant& value, const std::string& called);
Rational pure_value(const Constant& value, const std::string& called);

// Returns the least order whose derivatives follow from the state.
unsigned first_determined_order(const Model& model);

}  // namespace anholon
