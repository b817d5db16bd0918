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

// Returns the error with `before` in front of its message, its place in the source if it has one, and its hint if it
// has one.
UsageError usage_error(const Failure& f, const SourceText& source, const std::string& before = "");

// Throws UsageError, whose text shows the place of the mistake in the word of the option, or in the file that holds the
// word.
[[noreturn]] void refuse(const MistakeInWord& m, const char* option);

struct Reader {
  std::shared_ptr<const Model> model;
  std::shared_ptr<Names> names;
  SourceText source;
};
// Reads the model named by the options (a path, or the name of a shipped model) with --set applied.
Reader read(const ModelCommand& o);
// Reads the model from a text that is already in memory, with --set applied.
Reader read(const ModelCommand& o, SourceText source);
// Returns the form that --form names, else that of [simulate] form, else Routh's. Throws if it does not apply.
const Formulation& form(const SystemCommand& o, const Model& model, const Mechanics* mechanics = nullptr);
// Replaces the form "auto", of the command line or of the file, by the selected form in the options; prints its name
// unless quiet.
void settle_form(SystemCommand& o, const Reader& in);
// Returns the options with the form settled.
template <class Command>
Command with_form(Command o, const Reader& in) {
  settle_form(o, in);
  return o;
}
StateChoice state_choice(const SystemCommand& o, const Model& model);
Rational exact(const std::string& text, const std::string& option);
// Reads a number with the dimension of its unit.
Constant constant(const std::string& text, const std::string& option);
// Returns the asker of the command line: it names options with "--" and prints notes on stderr. saving: the option that
// saves or continues a run, if one is given.
Asker asker(const char* saving = "");
// Splits words of the form "a,b,c" and joins the parts of all words in one list.
std::vector<std::string> split(const std::vector<std::string>& words);

// Throws if the form does not apply to the model, or no motion is computed in it.
void must_have_motions(const Reader& in, const Formulation& form);
// Makes the scenario of the model in the form asked for; throws UsageError for mistakes of the user.
Outcome ready(const Reader& in, const Formulation& form, const StateChoice& choice, Scenario& scenario);

// Computes only the elimination, for printing equations; lifted to the order of --m if it is given.
Elimination elimination(const Reader& in, const Mechanics& m, const Formulation& form, const StateChoice& choice,
                        unsigned order = 0);
// Throws if the form is not available with the order m.
void must_have_order(const Formulation& form, const Mechanics& mechanics, unsigned m);

// Returns the eliminations with which forms are compared: with solved constraints, if they can be solved, and with
// unsolved ones.
std::vector<Eliminations> eliminations_of(const Reader& in, const Mechanics& m, const StateChoice& choice,
                                          unsigned order = 0);

void print_diagnostic(const Diagnostic& d, const SourceText& source);
// source: the text to which the place of the outcome, if any, refers.
void print_outcome(const Outcome& o, const SourceText& source = {});

std::vector<ShippedFile> shipped(Shipped kind);

}  // namespace anholon::cli
