#include "cli/command_line.h"

#include <algorithm>
#include <limits>
#include <map>

#include "base/diagnostic.h"
#include "base/utf8.h"
#include "cli/command_words.h"
#include "cli/completion.h"
#include "cli/input.h"
#include "cli/say.h"
#include "modelfile/language/reference.h"
#include "result/format.h"
#include "setup/choice.h"

namespace anholon::cli {

// Returns the commands and options that a shell completes, read from `app` itself; options without a group are hidden
// and left out.
static CommandWords words_of(const CLI::App& app, const std::string& words) {
  CommandWords c{words, app.get_description(), {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    CommandWords::Flag flag;
    for (const std::string& name : option->get_snames()) flag.names.push_back("-" + name);
    for (const std::string& name : option->get_lnames()) flag.names.push_back("--" + name);
    if (flag.names.empty()) continue;  // a word without a dash
    flag.takes_value = option->get_type_size_max() > 0;
    for (const char ch : option->get_description()) flag.about += ch == '\n' ? ' ' : ch;
    c.flags.push_back(std::move(flag));
  }
  for (const CLI::App* inner : app.get_subcommands([](const CLI::App*) { return true; }))
    c.inner.push_back(words_of(*inner, words.empty() ? inner->get_name() : words + " " + inner->get_name()));
  return c;
}

// What a mode is: a part of the hint for commands without --mode.
static constexpr const char* kAboutModes = "a mode says which contacts are open, slip or stick, and which constraints "
                                           "with 'active' hold; a motion finds its modes "
                                           "itself";

// Returns the option that a user means by a word that is none: the one that the word abbreviates, the file of the output
// for --output and the like, or the one that is spelt alike; empty if there is none.
static std::string near_option(const std::string& word, const std::vector<std::string>& known) {
  constexpr std::size_t kShortest = 5;  // "--tol"
  const auto begins = [&](const std::string& name) { return name.starts_with(word); };
  if (word.size() >= kShortest && std::count_if(known.begin(), known.end(), begins) == 1)
    return *std::find_if(known.begin(), known.end(), begins);
  // Words of other programs.
  static const std::map<std::string, std::string> other = {
      {"--tend", "--to"},       {"--t-end", "--to"},   {"--tmax", "--to"},        {"--t-max", "--to"},
      {"--tf", "--to"},         {"--tfinal", "--to"},  {"--t-final", "--to"},     {"--tstop", "--to"},
      {"--until", "--to"},      {"--end", "--to"},     {"--duration", "--to"},    {"--time", "--to"},
      {"--dt", "--every"},      {"--step", "--every"}, {"--rtol", "--tolerance"}, {"--reltol", "--tolerance"},
      {"--atol", "--tolerance"}};
  if (const auto it = other.find(word);
      it != other.end() && std::find(known.begin(), known.end(), it->second) != known.end())
    return it->second;
  if (word.starts_with("--out") && std::find(known.begin(), known.end(), "-o") != known.end()) return "-o";
  return did_you_mean(word, known);
}

// Throws if a word is no option of the command, and says which commands have it.
void CommandLine::check_options(int argc, char** argv) const {
  const CLI::App *command = &app_, *outer = &app_;
  std::string name;  // of the command: "sweep status"
  while (!command->get_subcommands().empty()) {
    outer = command;
    command = command->get_subcommands()[0];
    name += (name.empty() ? "" : " ") + command->get_name();
  }
  const CommandWords own = words_of(*command, "");
  std::vector<std::string> known;
  for (const CommandWords::Flag& flag : own.flags) known.insert(known.end(), flag.names.begin(), flag.names.end());
  for (int i = 2; i < argc; ++i) {
    const std::string word = std::string(argv[i]).substr(0, std::string(argv[i]).find('='));
    if (word == "--") return;
    if (!word.starts_with("--") || std::find(known.begin(), known.end(), word) != known.end()) continue;
    std::string others;
    const auto add_those_of = [&](const CLI::App& of, const std::string& before) {
      for (const CLI::App* other : of.get_subcommands([](const CLI::App*) { return true; }))
        if (other->get_option_no_throw(word)) others += (others.empty() ? "" : ", ") + before + other->get_name();
    };
    add_those_of(app_, "");
    if (outer != &app_) add_those_of(*outer, outer->get_name() + " ");
    const std::string near = others.empty() ? near_option(word, known) : "";
    const std::string help = "anholon " + name + " --help";
    throw UsageError{"error: '" + name + "' has no option " + word +
                     (near.empty() ? "" : "; did you mean " + near + "?") +
                     "\nhint: " + (others.empty() ? help : word + " is an option of " + others) +
                     (word == "--mode" ? std::string("; ") + kAboutModes : "") + "\n"};
  }
}

// Prints the help of an option. The library counts bytes where it pads names to the column of the descriptions, but an
// ellipsis has three bytes.
class HelpLines : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    std::string line = CLI::Formatter::make_option(option, is_positional);
    const std::string name = "  " + make_option_name(option, is_positional) + make_option_opts(option);
    if (name.size() < get_column_width()) line.insert(name.size(), name.size() - utf8_length(name), ' ');
    return line;
  }

  // Removes one of the two empty lines with which the library ends the options if their last group is hidden.
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
    if (const std::size_t at = text.find("\n\n\n"); at != std::string::npos) text.erase(at, 1);
    return text;
  }
};

CommandLine::CommandLine() {
  app_.name("anholon");
  app_.formatter(std::make_shared<HelpLines>());
  app_.set_version_flag("--version", "anholon " ANHOLON_VERSION);
  app_.require_subcommand(1);
  app_.footer(
      "Examples:\n"
      "  anholon models                                      the shipped models\n"
      "  anholon check disc                                  what kind of system it is\n"
      "  anholon derive luo-zhao-example-2 --format latex    its equations\n"
      "  anholon simulate disc --to 10 -o disc.csv           its motion\n"
      "  anholon report disc -o disc.html                    its equations, motion and animation on one page\n"
      "  anholon render disc -o disc.mp4                     its animation as a film; -o disc.png --at 3 for a "
      "picture\n"
      "  anholon plot disc.csv theta phi                     drawn in the terminal; -o fig.pdf for a paper\n"
      "  anholon sweep disc --vary m=1:3:200 -o cases.csv    many motions, on all cores\n"
      "  anholon linearize whipple --vary v=0..10:1          eigenvalues over a range, weave and capsize speeds\n"
      "  anholon prove disc -o proof.json                    a proof that all forms of the equations agree\n"
      "  anholon papers L3.13                                an equation of the papers, decided\n"
      "  anholon help contacts                               a topic of model files: contacts, events, forces, …\n"
      "Exit status: 0 ok, 1 the motion stopped early (what was computed is kept), 2 bad input, 3 internal fault.");
  for (const auto add : {add_check, add_derive,    add_evaluate, add_simulate, add_report,    add_render, add_studio,
                         add_sweep, add_linearize, add_forms,    add_prove,    add_compare,   add_papers, add_verify,
                         add_new,   add_format,    add_plot,     add_convert,  add_reference, add_models})
    add(*this);
  add_completion();
}

int CommandLine::run(int argc, char** argv) {
  std::vector<std::string> known;
  for (const CLI::App* command : app_.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(command->get_name());
  // `anholon help simulate` is `anholon simulate --help`, `anholon help contacts` is `anholon reference contact`.
  if (argc > 1 && std::string_view(argv[1]) == "help") {
    if (argc > 2 && is_topic(argv[2], known)) {
      hand_out(reference_section(argv[2]));
      return kOk;
    }
    static char help[] = "--help";
    std::vector<char*> asked = {argv[0]};
    if (argc > 2) asked.push_back(argv[2]);
    asked.push_back(help);
    return run(static_cast<int>(asked.size()), asked.data());
  }
  if (argc > 1) check_command(argv[1], known);
  typed_ = command_line(std::vector<std::string>(argv + std::min(argc, 1), argv + argc));
  try {
    app_.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app_.exit(e);
    if (dynamic_cast<const CLI::ExtrasError*>(&e)) check_options(argc, argv);
    const bool named = argc > 1 && argv[1][0] != '-';
    say(stderr, "error: %s\nhint: anholon %s%s--help\n", e.what(), named ? argv[1] : "", named ? " " : "");
    return kBadInput;
  }
  return command_();
}

int say_no_model() {
  say_lines(stderr, "error: no model is named\nhint: a path to a .toml file, or a name that `anholon models` lists\n");
  return kBadInput;
}

void CommandLine::add_completion() {
  CLI::App* c = app_.add_subcommand("completion", "a script with which a shell completes commands, options and models");
  c->footer("Examples: source <(anholon completion bash)\n"
            "          anholon completion zsh > ~/.zfunc/_anholon\n"
            "          anholon completion fish > ~/.config/fish/completions/anholon.fish");
  const auto shell = std::make_shared<std::string>();
  c->add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember(shells_with_completion()));
  c->callback([this, shell] {
    command_ = [this, shell] {
      hand_out(completion_script(words_of(app_, ""), *shell));
      return kOk;
    };
  });
}

// ---- options that commands share -------------------------------------------------------------------

std::string plain_output() { return std::string(" (default: ") + plain_format().name + " on the standard output)"; }

void model_options(CLI::App* c, SystemCommand& o, ModelOption::Of of) {
  for (const ModelOption& m : model_options())
    if (m.of == of)
      c->add_option("--" + std::string(m.name), o.*m.words, m.help)->type_name(m.value)->allow_extra_args(m.assigns);
}

void parameters(CLI::App* c, SystemCommand& o) { model_options(c, o, ModelOption::Of::parameters); }

void state(CLI::App* c, SystemCommand& o) {
  c->add_option("--t", o.t, "initial time")->type_name("T");
  model_options(c, o, ModelOption::Of::state);
}

void motion_option(CLI::App* c, SystemCommand& o, const char* name, const char* help) {
  const MotionOption& row = anholon::motion_option(name);
  const std::string flag = "--" + std::string(name);
  const auto take = [&o, &row, flag](const std::vector<std::string>& words) {
    set(o.motion, row, words, flag, [&](const std::string& text) {
      return row.part == MotionOption::Part::times ? time_value(constant(text, flag), flag + ": ")
                                                   : pure_value(constant(text, flag), flag + ": ");
    });
  };
  CLI::Option* option =
      std::holds_alternative<std::vector<WrittenTime> MotionSettings::*>(row.member)
          ? c->add_option_function<std::vector<std::string>>(
                flag, [take](const std::vector<std::string>& words) { take(split(words)); }, help ? help : row.help)
          : c->add_option_function<std::string>(
                flag, [take](const std::string& word) { take({word}); }, help ? help : row.help);
  option->type_name(row.value);
}

void motion_options(CLI::App* c, SystemCommand& o, MotionOption::Part part) {
  for (const MotionOption& row : anholon::motion_options())
    if (row.part == part) motion_option(c, o, row.name);
}

void form_option(CLI::App* c, SystemCommand& o) {
  motion_options(c, o, MotionOption::Part::form);
  model_options(c, o, ModelOption::Of::form);
  c->add_option("--show", o.show, "print one stage instead: mechanics, system, structure, program; check: also cost")
      ->type_name("STAGE");
}

void mode_of_contacts(CLI::App* c, SystemCommand& o) {
  c->add_option("--mode", o.mode,
                "the mode of the contacts: floor=sticks,wall=slips (open, slips or sticks; open without its name); of "
                "constraints with 'active': the number of a mode, caught=1")
      ->type_name("NAME=MODE")
      ->allow_extra_args(false);
}

void accuracy(CLI::App* c, SystemCommand& o) { motion_options(c, o, MotionOption::Part::accuracy); }

void motion(CLI::App* c, SystemCommand& o) {
  motion_options(c, o, MotionOption::Part::times);
  accuracy(c, o);
}

// Removes zeros before a seed and returns what is wrong with it. The library reads negative and too large numbers as if
// they were others, and a number after a zero as one of base 8.
static std::string settle_seed(std::string& text) {
  const std::string largest = std::to_string(std::numeric_limits<std::uint64_t>::max());
  const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
  std::string number = digits ? text.substr(std::min(text.find_first_not_of('0'), text.size() - 1)) : "";
  if (!digits || number.size() > largest.size() || (number.size() == largest.size() && number > largest))
    return "a seed is a whole number from 0 to " + largest + ", not '" + text + "'";
  text = std::move(number);
  return {};
}

void seed_option(CLI::App* c, unsigned long long& seed, const char* help) {
  c->add_option("--seed", seed, help)->type_name("N")->transform(CLI::Validator(settle_seed, ""));
}

void order_m(CLI::App* c, int& m) {
  c->add_option("--m", m,
                "the order m of the forms that have one, 1 to " + std::to_string(kHighestM) +
                    ": constraints of lower order are\nlifted to it (default: the highest order of the constraints, "
                    "1 at least)")
      ->type_name("M")
      ->check(CLI::Range(1, static_cast<int>(kHighestM)));
}

int run_command_line(int argc, char** argv) { return CommandLine().run(argc, argv); }

}  // namespace anholon::cli
