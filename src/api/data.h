// The data behind the types of the public headers, and the conversion of the layers' errors into public ones.
#pragma once
#include "anholon/motion.h"
#include "base/stop.h"
#include "modelfile/contacts.h"
#include "modelfile/names/constant.h"
#include "modelfile/read.h"
#include "setup/scenario.h"

namespace anholon::v1 {

namespace inner = ::anholon;

struct Model::Data {
  inner::SourceText source;
  inner::Overrides overrides;
  std::vector<std::string> cases, mode;
  std::shared_ptr<const inner::Model> model;
  std::vector<Diagnostic> remarks;
  // The contacts that move, none if a mode is chosen; and all of the file. Their expressions belong to the graph of the
  // model.
  std::vector<inner::Contact> contacts, contacts_of_file;
  std::vector<inner::Identity> identities;  // of the parameters

  // Throws Failure if `what` needs a mode of the contacts and none is chosen.
  void without_contacts(const std::string& what) const;
  // Tells in the hint of an inconsistent start that a state of the chosen mode is needed, if one is chosen.
  void hint_at_state(inner::Outcome& start, const inner::StateChoice& choice) const;
  // Reads the text again, in the chosen mode. Returns nullopt if the diagnostics have errors. Throws Failure.
  std::optional<inner::OpenModel> open_again(inner::Diagnostics& diagnostics) const;
  // Returns a copy with an expression graph of its own, in which the owner of the copy may build expressions.
  std::shared_ptr<const inner::Model> own_copy() const { return inner::clone(*model); }
};

struct System::Data {
  std::shared_ptr<const Model::Data> model;
  inner::StateChoice choice;
  inner::Scenario scenario;
};

// The options of a motion that members of MotionOptions set, each with its words on the command line.
using OptionWords = std::vector<std::pair<std::string, std::vector<std::string>>>;
OptionWords words_of_members(const MotionOptions& asked);
// Returns the model with one of its scenarios applied. The errors are those of read_file.
Result<Model> with_scenario(const Model& model, const std::string& scenario);
// Returns the system that `prepare` makes of a model; `start` tells whether the system has a consistent start. Throws
// Failure.
std::shared_ptr<const System::Data> system_of(const Model& model, const PrepareOptions& options, inner::Outcome& start);

Severity to_public(inner::Severity severity);
Diagnostic to_public(const inner::Diagnostic& d, const inner::SourceText& source);
OutcomeKind to_public(inner::OutcomeKind kind);
Outcome to_public(const inner::Outcome& outcome);

Error error_of(const inner::Diagnostics& diagnostics, const inner::SourceText& source);
Error error_of(const inner::Failure& failure, const inner::SourceText& source);
Error error_of(const inner::Outcome& outcome);
// Returns the error of a mistake in an argument of a call.
Error mistake(const std::string& message, const std::string& hint = {});

// Calls f, which returns a Result. A Failure or a stop request that f throws becomes the error of the Result.
template <class F>
auto guarded(const inner::SourceText& source, F f) -> decltype(f()) {
  try {
    return f();
  } catch (const inner::Failure& failure) {
    return error_of(failure, source);
  } catch (const inner::StopRequested&) {
    return error_of(inner::Outcome{inner::OutcomeKind::interrupted, "the computation was stopped", ""});
  } catch (const std::bad_alloc&) {
    return error_of(
        inner::Outcome{inner::OutcomeKind::too_large, "out of memory", "the model is too large for this machine"});
  }
}

// Reads the model from a text; base files are read from memory if the text brings them.
Result<Model> opened(inner::SourceText source, const ReadOptions& options);

// Returns the number of an option of motions, exact and in SI units. Throws Failure that names the option, also if the
// unit of the number is that of another quantity than the option's, which is a time or a pure number.
inner::Rational option_value(const Number& number, const inner::MotionOption& option);
// Returns the number as an exact rational in SI units, with the dimension of its unit. Throws Failure that names the
// argument.
inner::Constant constant(const Number& number, const std::string& argument);

// Returns the form of that name. Throws Failure if no form has the name, or if `mechanics` is given and the form does
// not apply to it.
const inner::Formulation& find_form(const std::string& name, const inner::Mechanics* mechanics = nullptr);

// Returns the initial values and eliminations that the options ask for. Throws Failure.
inner::StateChoice state_choice(const PrepareOptions& options, const inner::Model& model);

// Prepares the system. Throws Failure.
inner::Outcome make_system(std::shared_ptr<const inner::Model> model, const std::string& form,
                           const inner::StateChoice& choice, inner::Scenario& scenario);

}  // namespace anholon::v1
