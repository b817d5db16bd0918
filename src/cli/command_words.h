// The words of the command line: each command's options and help, given to the library that parses them.
#pragma once
#include <concepts>
#include <functional>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "cli/commands.h"
#include "cli/model_options.h"
#include "cli/typed_words.h"
#include "model/motion_settings.h"

namespace anholon::cli {

// A command of the command line, and the object in which its options are stored.
template <class Command>
struct Words {
  CLI::App* app;
  Command& o;
};

class CommandLine {
 public:
  CommandLine();

  // Runs the command that the words name, and returns the exit status. Throws UsageError for words that make no
  // command.
  int run(int argc, char** argv);

  // Adds a command below `parent` (nullptr: below the program) that is run with its parsed options.
  template <class Command>
  Words<Command> command(const char* name, const std::string& what, int (*function)(const Command&),
                         const std::string& footer, CLI::App* parent = nullptr) {
    return command(name, what, function, footer, parent, Model::optional);
  }

  enum class Model { needed, optional };
  // Adds a command on a model, with the options that all such commands have.
  template <class Command>
  Words<Command> model_command(const char* name, const char* what, int (*function)(const Command&), const char* footer,
                               Model model = Model::needed);

 private:
  template <class Command>
  Words<Command> command(const char* name, const std::string& what, int (*function)(const Command&),
                         const std::string& footer, CLI::App* parent, Model model);
  // Runs a command whose options are parsed.
  template <class Command>
  int run_parsed(Command& o, int (*function)(const Command&), Model model) const;
  void add_completion();
  void check_options(int argc, char** argv) const;

  CLI::App app_{"Anholon: the equations of nonholonomic mechanics, their motion, with a residual report."};
  std::string typed_;  // the words, in a form that can be typed again
  std::function<int()> command_;
};

// ---- options that commands share -------------------------------------------------------------------

// Adds the options of one kind from the table in cli/model_options.h.
void model_options(CLI::App* c, SystemCommand& o, ModelOption::Of of);
void parameters(CLI::App* c, SystemCommand& o);
void state(CLI::App* c, SystemCommand& o);
void form_option(CLI::App* c, SystemCommand& o);
// Adds --mode to a command on the equations of one mode of the contacts.
void mode_of_contacts(CLI::App* c, SystemCommand& o);
// Adds an option of motions; `help` replaces the text of the table if the option means something else in this command.
void motion_option(CLI::App* c, SystemCommand& o, const char* name, const char* help = nullptr);
void motion_options(CLI::App* c, SystemCommand& o, MotionOption::Part part);
void accuracy(CLI::App* c, SystemCommand& o);
void motion(CLI::App* c, SystemCommand& o);
// Adds --m, the order of the forms that have one.
void seed_option(CLI::App* c, unsigned long long& seed, const char* help);
void order_m(CLI::App* c, int& m);
// The words of the help that name the default output.
std::string plain_output();

// ---- the commands ----------------------------------------------------------------------------------

void add_check(CommandLine& line);
void add_compare(CommandLine& line);
void add_convert(CommandLine& line);
void add_derive(CommandLine& line);
void add_evaluate(CommandLine& line);
void add_format(CommandLine& line);
void add_forms(CommandLine& line);
void add_linearize(CommandLine& line);
void add_models(CommandLine& line);
void add_new(CommandLine& line);
void add_papers(CommandLine& line);
void add_plot(CommandLine& line);
void add_prove(CommandLine& line);
void add_reference(CommandLine& line);
void add_render(CommandLine& line);
void add_report(CommandLine& line);
void add_simulate(CommandLine& line);
void add_studio(CommandLine& line);
void add_sweep(CommandLine& line);
void add_verify(CommandLine& line);

// ---- definitions of the templates ------------------------------------------------------------------

// Says that a command needs a model, and returns the exit status.
int say_no_model();

template <class Command>
int CommandLine::run_parsed(Command& o, int (*function)(const Command&), [[maybe_unused]] Model model) const {
  if constexpr (requires { o.command_line; }) o.command_line = typed_;
  if constexpr (std::derived_from<Command, SystemCommand>) rescue_model(o);
  if constexpr (std::derived_from<Command, ModelCommand>)
    if (model == Model::needed && o.model.empty()) return say_no_model();
  return function(o);
}

template <class Command>
Words<Command> CommandLine::command(const char* name, const std::string& what, int (*function)(const Command&),
                                    const std::string& footer, CLI::App* parent, Model model) {
  CLI::App* c = (parent ? parent : &app_)->add_subcommand(name, what);
  c->footer(footer);
  const auto o = std::make_shared<Command>();
  c->callback([this, c, o, function, model] {
    if (!c->get_subcommands().empty()) return;  // the words name one of these
    command_ = [this, o, function, model] { return run_parsed(*o, function, model); };
  });
  return {c, *o};
}

template <class Command>
Words<Command> CommandLine::model_command(const char* name, const char* what, int (*function)(const Command&),
                                          const char* footer, Model model) {
  const Words<Command> w = command(name, what, function, footer, nullptr, model);
  w.app->add_option("MODEL", w.o.model, "a model file, or the name of a shipped model");
  w.app->add_flag("--json", w.o.json, "JSON on the standard output");
  w.app->add_flag("--quiet", w.o.quiet, "no progress, no report on stderr");
  return w;
}

}  // namespace anholon::cli
