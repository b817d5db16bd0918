#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

#include "cli/contacts.h"
#include "cli/input.h"
#include "cli/model_options.h"
#include "cli/models/show.h"
#include "cli/outputs.h"
#include "cli/say.h"
#include "cli/typed_words.h"
#include "contact/mode/switched_model.h"
#include "dynamics/rate_formulas_of.h"
#include "report/equations.h"
#include "result/file.h"
#include "setup/eliminate.h"
#include "setup/program.h"

namespace anholon::cli {

namespace {

// Returns the format that --format names, else that of the file's extension.
std::string format_of_equations(const DeriveCommand& o) {
  const std::string end = std::filesystem::path(o.output).extension().string();
  if (!o.format_given && !o.output.empty())
    for (const auto& [ending, format] :
         {std::pair{".tex", "latex"}, {".html", "mathml"}, {".json", "json"}, {".c", "c"}, {".py", "python"}})
      if (end == ending) return format;
  return o.format;
}

// Writes to the file, or to the standard output.
void deliver(const DeriveCommand& o, const std::string& text) {
  if (o.output.empty() || o.output == "-") return hand_out(text);
  if (const std::string why = write_whole(o.output, text); !why.empty()) throw UsageError{"error: " + why + "\n"};
}

Elimination pivots_of(const Reader& in, const Mechanics& m, const StateChoice& choice) {
  try {
    return elimination_of_reactions(m, choice.overrides, choice.eliminate);
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, in.source)};
  }
}

// Returns the command that writes the program, without the file to which it goes.
std::string made_by(const DeriveCommand& o) {
  std::vector<std::string> words = {"derive", o.model, "--format", o.format};
  if (o.motion.form) words.insert(words.end(), {"--form", *o.motion.form});
  const auto add = [&](const char* name, const std::vector<std::string>& list) {
    for (const std::string& word : list) words.insert(words.end(), {"--" + std::string(name), word});
  };
  if (!o.t.empty()) add("t", {o.t});
  for (const ModelOption& option : model_options()) add(option.name, o.*option.words);
  add("mode", o.mode);
  return command_line(words);
}

// Writes the motion as a program in C or Python.
int write_program(const DeriveCommand& o, const Reader& in, const Formulation& f) {
  if (o.json)
    throw UsageError{"error: --format " + o.format + " is not JSON\nhint: leave one of --json and --format out\n"};
  if (const auto d = not_integrated(*in.model)) {
    print_diagnostic(*d, in.source);
    return kBadInput;
  }
  Scenario s;
  const StateChoice choice = state_choice(o, *in.model);
  Outcome outcome = ready(in, f, choice, s);
  if (!outcome.ok()) {
    hint_at_state_of_mode(outcome, o, *in.model, choice);
    print_outcome(outcome);
    return kStopped;
  }
  try {
    const bool python = o.format == "python";
    const std::vector<std::size_t> switching = switching_parameters(*in.model, contacts(*in.names));
    const auto rates = python ? independent_rates(s, choice, switching) : std::nullopt;
    deliver(o, program_text(s, choice, python ? ProgramLanguage::python : ProgramLanguage::c,
                            std::filesystem::path(o.model).stem().string(), made_by(o),
                            {rates ? &*rates : nullptr, switching}));
  } catch (const Failure& failure) {
    print_diagnostic(failure.diagnostic, in.source);
    return kBadInput;
  }
  return kOk;
}

}  // namespace

int derive(const DeriveCommand& asked) {
  DeriveCommand o = asked;
  o.format = format_of_equations(asked);
  const Reader in = in_mode(read(o), o, "derive");
  must_spare_inputs(o, in, {}, {{"-o", o.output}});
  const Model& model = *in.model;
  if (o.format != "text" && o.format != "latex" && o.format != "mathml" && o.format != "c" && o.format != "python" &&
      o.format != "json")
    throw UsageError{"error: there is no format '" + o.format +
                     "'\nhint: --format text, latex, mathml or json; c or python for a program\n"};
  if (o.expand != "auto" && o.expand != "none" && o.expand != "paper" && o.expand != "full" && o.expand != "parts")
    throw UsageError{"error: --expand: '" + o.expand + "'\nhint: auto, none, paper, full or parts\n"};
  const Mechanics m = mechanics(model);
  const bool all = o.motion.form == "all";
  const bool program = o.format == "c" || o.format == "python";
  if (all && (program || !o.show.empty()))
    throw UsageError{"error: --form all goes with text, latex, mathml and json\nhint: name one form\n"};
  if ((o.m || o.reactions) && (program || !o.show.empty()))
    throw UsageError{
        std::string("error: ") + (o.m ? "--m" : "--reactions") +
        " goes with text, latex, mathml and json\nhint: a program and the stages of the way are those of a motion\n"};
  const auto order = static_cast<unsigned>(o.m);
  std::vector<const Formulation*> wanted;
  for (const Formulation* f : formulations())
    if (all && obstacle(*f, m).empty() && (!order || order_obstacle(*f, m, order).empty())) wanted.push_back(f);
  if (!all) wanted.push_back(&form(o, model, &m));
  if (!all && order) must_have_order(*wanted[0], m, order);
  if (!all && o.reactions && wanted[0]->unknowns == Unknowns::variational)
    throw UsageError{"error: --reactions: the multipliers of the form '" + std::string(wanted[0]->name) +
                     "' are not those of ideal reactions\nhint: name another form, or none for Routh's equations\n"};
  if (!o.show.empty()) {
    Scenario s;
    const StateChoice choice = state_choice(o, model);
    Outcome outcome = ready(in, *wanted[0], choice, s);
    hint_at_state_of_mode(outcome, o, model, choice);
    return show(o, s, outcome);
  }
  if (!o.output.empty() && o.output != "-")
    if (const std::string why = obstacle_to_writing(o.output); !why.empty()) throw UsageError{"error: " + why + "\n"};
  if (program) return write_program(o, in, *wanted[0]);

  std::vector<Derivation> list;
  Arranger arranger(o.expand);
  std::map<Unknowns, Elimination> eliminations;
  std::optional<Elimination> pivots;  // of the reactions in forms with multipliers
  const StateChoice choice = state_choice(o, model);
  for (const Formulation* f : wanted) {
    if (!eliminations.count(f->unknowns)) eliminations.emplace(f->unknowns, elimination(in, m, *f, choice, order));
    const Elimination& e = eliminations.at(f->unknowns);
    const Elimination* of_reactions = nullptr;
    if (o.reactions && f->eliminates()) of_reactions = &e;
    if (o.reactions && f->unknowns == Unknowns::multipliers) {
      if (!pivots) pivots = pivots_of(in, m, choice);
      of_reactions = &*pivots;
    }
    list.push_back(derivation(m, *f, e, arranger, o.steps, of_reactions));
  }
  // The text has the notes itself.
  const bool is_text = !o.json && o.format == "text";
  std::set<std::string> told;
  for (const Derivation& d : list)
    for (const std::string& n : d.notes)
      if (!is_text && !o.quiet && told.insert(n).second) say(stderr, "note: %s\n", n.c_str());
  const std::string text = o.json || o.format == "json" ? as_json(list, all)
                           : o.format == "latex"        ? as_latex(list)
                           : o.format == "mathml"       ? as_mathml(list)
                                                        : as_text(list);
  deliver(o, text);
  return kOk;
}

}  // namespace anholon::cli
