// The command line words of the commands that describe a model.
#include "cli/command_words.h"
#include "result/format.h"

namespace anholon::cli {

void add_check(CommandLine& line) {
  const auto [c, o] = line.model_command("check", "classify the constraints, show structure and initial data",
                                         cli::check, "Example: anholon check models/zoo/disc.toml");
  parameters(c, o), state(c, o), form_option(c, o);
}

void add_evaluate(CommandLine& line) {
  const auto [c, o] =
      line.model_command("evaluate", "all forces, accelerations, multipliers, reactions at one state", cli::evaluate,
                         "Example: anholon evaluate disc --q theta=1 --qdot theta=0.1 --json");
  parameters(c, o), state(c, o), form_option(c, o);
  motion_option(c, o, "digits");
  motion_option(c, o, "numbers", "long-double (default) or quad (33 digits)");
}

void add_linearize(CommandLine& line) {
  const auto [c, o] = line.model_command(
      "linearize", "the linear model of a motion, its eigenvalues and modes, over a range of a parameter",
      cli::linearize,
      "About the initial state, which may be an equilibrium or a steady motion: [initial] conditions = "
      "[\"theta'' = 0\", …] finds one.\n"
      "An input with a formula is a feedback, which A contains; B belongs to what is added to it.\n"
      "Exit status: 0 ok, 1 no linear model at some value, 2 bad input.\n"
      "Example: anholon linearize whipple --vary v=0..10:1");
  parameters(c, o), state(c, o), form_option(c, o), mode_of_contacts(c, o);
  c->add_option(
       "--about", o.about,
       "state (default), or equilibrium: the one to which unbalanced forces fall steadily from the initial\n"
       "positions, those of --q included; where they do not fall to zero, one that is found near. States of [state]\n"
       "that influence the motion rest, too")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"state", "equilibrium"}));
  c->add_option(
       "--vary", o.vary,
       "a parameter over a range, v=0..10:1 (step), v=0:10:11 (how many) or v=0,1,2; where eigenvalues cross the "
       "imaginary axis is found")
      ->type_name("NAME=VALUES");
  motion_option(c, o, "digits",
                "of the numbers printed (default 16, in matrices and modes fewer); the computation has at least 36");
  c->add_flag("--csv", o.csv, "one line of eigenvalues per parameter value");
}

void add_forms(CommandLine& line) {
  const auto [c, o] = line.model_command("forms", "the catalogue of forms, and which apply to a model", cli::forms,
                                         "Example: anholon forms disc", CommandLine::Model::optional);
  parameters(c, o);
}

void add_new(CommandLine& line) {
  const auto [c, o] = line.command("new", "a model to start from; without a name, the list of templates",
                                   cli::new_model, "Example: anholon new pendulum -o mine.toml");
  c->add_option("TEMPLATE", o.name, "its name");
  c->add_option("-o,--output", o.output, "the file to write, which must not be there (default: the standard output)")
      ->type_name("FILE");
}

void add_format(CommandLine& line) {
  const auto [c, o] = line.command(
      "fmt", "set the layout of model files; what they say, their order and comments stay", cli::format,
      "Prints the names of the files it changed. Exit status: 0 ok, 1 with --check: a file would change, 2 "
      "bad input.\n"
      "Example: anholon fmt mine.toml");
  c->add_option("FILE", o.files, "model files")->required();
  c->add_flag("--check", o.check, "change nothing, say which files would be");
  c->add_flag("--stdout", o.to_stdout, "print the text instead of changing the file");
}

void add_reference(CommandLine& line) {
  const auto [c, o] = line.command("reference", "the language of model files, in Markdown", cli::reference,
                                   "Example: anholon reference event");
  c->add_option("SECTION", o.section, "one section: body, event, …, or formulas (default: all)");
  c->add_flag("--schema", o.schema, "a JSON Schema of the language, for editors with a TOML language server");
}

void add_models(CommandLine& line) {
  line.model_command("models", "the shipped models; with a name, the text of one", cli::models,
                     "Example: anholon models disc", CommandLine::Model::optional);
}

}  // namespace anholon::cli
