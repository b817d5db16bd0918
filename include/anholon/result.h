// What every function of the library returns: a value, or why there is none.
//
// Nothing of this library throws for what a user wrote or for what numbers do. Mistakes in a model come back as
// diagnostics with their places; a motion that cannot go on comes back as an outcome with its remedy.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

// Marks what the shared library offers; everything else in it is hidden.
#define ANHOLON_API __attribute__((visibility("default")))

namespace anholon::v1 {

enum class Severity : std::uint8_t { error, warning, note };

// One remark on a text of the user.
struct Diagnostic {
  Severity severity = Severity::error;
  std::string message;
  std::string hint;  // what to write instead; may be empty
  std::string file;
  unsigned line = 0;    // from 1; 0: the text as a whole
  unsigned column = 0;  // from 1, in characters
  unsigned length = 0;  // in characters
};

enum class OutcomeKind : std::uint8_t {
  finished,        // the end that was asked for is reached
  singular,        // the system Jacobian lost rank: a singular configuration
  step_collapse,   // the step fell below what the time can resolve
  blow_up,         // a state grew without bound
  negative_mass,   // a given mass fell below zero
  not_a_number,    // a formula left its domain: a root or a logarithm of a negative number, 0/0
  no_convergence,  // Newton's iteration for the leading derivatives failed
  inconsistent,    // no initial data satisfy the constraints with the values given
  interrupted,     // `cancelled` returned true, or the greatest number of steps is reached
  too_large,       // the work or the memory would be beyond all proportion
};
// "finished", "singular", …
ANHOLON_API const char* name(OutcomeKind kind);

// How a computation ended.
struct Outcome {
  OutcomeKind kind = OutcomeKind::finished;
  std::string message;  // what happened, and where
  std::string hint;     // what to do
  bool ok() const { return kind == OutcomeKind::finished; }
};

// Why there is no value.
struct Error {
  std::vector<Diagnostic> diagnostics;  // mistakes in a text or in an argument
  std::optional<Outcome> outcome;       // numerical trouble
  std::string text;  // all of it as the program prints it: file:line:column, the line, a caret, a hint
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(Error error) : error_(std::move(error)) {}

  explicit operator bool() const { return value_.has_value(); }
  // The value. REQUIRES: there is one.
  T& operator*() { return value_.value(); }
  const T& operator*() const { return value_.value(); }
  T* operator->() { return &value_.value(); }
  const T* operator->() const { return &value_.value(); }
  // Why there is no value; empty if there is one.
  const Error& error() const { return error_; }
  const std::string& text() const { return error_.text; }

 private:
  std::optional<T> value_;
  Error error_;
};

// A number as a model file writes it. A double stands for the shortest decimal that reads back to it, so 0.1 is 1/10.
class ANHOLON_API Number {
 public:
  Number(double value);
  Number(int value);
  Number(std::string text) : text_(std::move(text)) {}  // "1/3", "pi/2", "30 deg", "8 cm"
  Number(const char* text) : text_(text) {}
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace anholon::v1

// Programs write anholon::Model. The library itself, where other types have these names, does not.
#ifndef ANHOLON_LIBRARY
namespace anholon {
using namespace v1;
}
#endif
