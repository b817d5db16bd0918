// A system that is ready to move: a model in one form of its equations, with a consistent initial state.
#pragma once
#include "anholon/model.h"

namespace anholon::v1 {

struct PrepareOptions {
  std::string form = "routh";                  // "auto": the form whose motion takes the fewest operations
  std::map<std::string, Number> initial = {};  // "x", "x'", "theta''", "lambda.rod": instead of the values of the file
  std::vector<std::string> eliminate = {};     // coordinates that forms without multipliers eliminate; empty: chosen
};

// Where a value of the initial state comes from.
enum class Origin : std::uint8_t {
  given,      // by the file or the options
  derived,    // from the constraints
  chosen,     // free, and set to 0
  guessed,    // the solution next to a guess
  corrected,  // given, and moved onto the constraints
};

struct InitialValue {
  std::string name;  // "x", "x'", …
  double value = 0;  // SI
  Origin origin = Origin::given;
};

struct ConstraintClass {
  std::string name;
  std::string kind;          // holonomic, linear, affine or nonlinear in its highest derivatives
  bool homogeneous = false;  // in them; a homogeneous constraint of order 1 does no work
  bool rheonomic = false;    // holds t explicitly
  bool redundant = false;    // follows from the others at the initial state
};

// Immutable, cheap to copy, and safe to use from many threads.
class ANHOLON_API System {
 public:
  std::string form() const;
  double start() const;  // the initial time
  std::vector<InitialValue> initial() const;
  std::vector<ConstraintClass> constraints() const;
  // Velocities that the constraints leave free; coordinates without constraints.
  int degrees_of_freedom() const;
  const std::vector<std::string>& notes() const;  // choices that were made for the initial state
  Model model() const;

  struct Data;
  explicit System(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

// Errors: an unknown form or name (diagnostics); inconsistent data or a singular start (an outcome).
ANHOLON_API Result<System> prepare(const Model& model, const PrepareOptions& options = {});

enum class Language : std::uint8_t { c, python };
// The motion as a program that stands by itself: right side, equations, hidden constraints, outputs, events and what they
// set. Errors: formulas that have no text in the language.
ANHOLON_API Result<std::string> program_text(const System& system, Language language);

}  // namespace anholon::v1
