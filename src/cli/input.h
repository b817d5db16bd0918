// Turns the words of a command line into a model, a state and exact numbers.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>

#include "base/read_file.h"
#include "cli/commands.h"
#include "modelfile/names/constant.h"
#include "modelfile/text/shipped.h"
#include "proof/prove.h"
#include "setup/scenario.h"
#include "setup/words/mistake_in_word.h"
#include "simulation/request.h"

namespace anholon::cli {

// Thrown for mistakes of the user; the text is complete, the exit code is 2.
struct UsageError {
  std::string text;
};

// Shows the place of the mistake in the word that the option has, or in the file from which it is. Throws UsageError.
[[noreturn]] void refuse(const MistakeInWord& m, const char* option);

struct Reader {
  std::shared_ptr<const Model> model;
  std::shared_ptr<Names> names;
  SourceText source;
};
// Reads the model named by the options (a path, or the name of a shipped model) with --set applied.
Reader read(const ModelCommand& o);
// As above, from a text that is already in memory.
Reader read(const ModelCommand& o, SourceText source);
// The form asked for: --form, else [simulate] form, else Routh's; throws if it does not apply.
const Formulation& form(const SystemCommand& o, const Model& model, const Mechanics* mechanics = nullptr);
// Puts the selected form in the place of --form auto, or of that of the file; prints it unless quiet.
void settle_form(SystemCommand& o, const Reader& in);
// The options with the form settled.
template <class Command>
Command with_form(Command o, const Reader& in) {
  settle_form(o, in);
  return o;
}
StateChoice state_choice(const SystemCommand& o, const Model& model);
Rational exact(const std::string& text, const std::string& option);
// The same with the dimension of its unit.
Constant constant(const std::string& text, const std::string& option);
// How the command line calls its options, and notes on stderr. saving: the option that saves or continues a run, if one
// is given.
Asker asker(const char* saving = "");
// Splits "a,b,c" and repeated words alike.
std::vector<std::string> split(const std::vector<std::string>& words);

// Throws if the form does not apply to the model, or no motion is computed in it.
void must_have_motions(const Reader& in, const Formulation& form);
// Makes the scenario of the model in the form asked for; throws UsageError for mistakes of the user.
Outcome ready(const Reader& in, const Formulation& form, const StateChoice& choice, Scenario& scenario);

// Makes only the elimination, for printing equations; lifted to --m if it is given.
Elimination elimination(const Reader& in, const Mechanics& m, const Formulation& form, const StateChoice& choice,
                        unsigned order = 0);
// Throws if the form is not available with the order m.
void must_have_order(const Formulation& form, const Mechanics& mechanics, unsigned m);

// The eliminations with which forms are compared: with the constraints solved, if they can be, and unsolved.
std::vector<Eliminations> eliminations_of(const Reader& in, const Mechanics& m, const StateChoice& choice,
                                          unsigned order = 0);

void print_diagnostic(const Diagnostic& d, const SourceText& source);
// source: the text in which the outcome may have a place.
void print_outcome(const Outcome& o, const SourceText& source = {});

std::vector<ShippedFile> shipped(Shipped kind);

}  // namespace anholon::cli
