// The functions of formulas as a table: call, meaning, an example. Functions of one argument with an explicit
// derivative come from elementary.def.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace anholon {

// The rule by which the dimension of a call follows from those of its arguments.
enum class DimensionRule : std::uint8_t {
  pure,                  // pure numbers to a pure number
  same,                  // that of the argument
  number,                // a pure number for an argument of any dimension
  root,                  // the square root of that of the argument
  square,                // the square of that of a vector
  length,                // that of a vector, as a number
  direction,             // a vector of pure numbers
  alike,                 // that of arguments of one dimension
  angle,                 // a pure number from arguments of one dimension
  choice,                // the values after the first argument have one dimension
  cases,                 // conditions with their values, which have one dimension
  dot,                   // the product, as a number
  cross,                 // the product, as a vector
  derivative,            // the argument by a power of time
  rotation,              // a rotation by pure numbers
  turns,                 // a rotation by pure numbers after the first argument, which names axes
  turn_about,            // a rotation about a vector by a pure number
  matrix,                // a rotation by rows of pure numbers
  force,                 // a vector in newtons of any argument
  torque,                // the same in newton metres
  velocity,              // a point by time, or a velocity
  acceleration,          // a point by time squared, or an acceleration
  angular_velocity,      // 1/s
  angular_acceleration,  // 1/s^2
  gravity,               // an acceleration at a point
  open,                  // not checked
};

struct FunctionRow {
  std::string name;
  std::string call;     // "atan2(y, x)"
  std::string meaning;  // in Markdown, without full stop
  std::string example;  // in a model with the coordinates x, y, theta, the frame B, the point P, the body plate
  DimensionRule dimension = DimensionRule::pure;
};

// The functions of pure mathematics, which need no model.
const std::vector<FunctionRow>& function_table();
std::vector<std::string> function_names();

}  // namespace anholon
