// The words of the command line: each command with its options and help.
#include "cli/command_line.h"

#include <functional>

#include <CLI/CLI.hpp>

#include "base/diagnostic.h"
#include "cli/completion.h"
#include "cli/input.h"
#include "cli/model_options.h"
#include "cli/say.h"
#include "cli/words.h"
#include "result/format.h"

namespace anholon::cli {

namespace {

std::string plain_output() { return std::string(" (default: ") + plain_format().name + " on the standard output)"; }

class CommandLine {
 public:
  CommandLine() {
    app_.name("anholon");
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
        "Exit status: 0 ok, 1 the motion stopped early (what was computed is kept), 2 bad input, 3 internal fault.");
    add_check();
    add_derive();
    add_evaluate();
    add_simulate();
    add_report();
    add_render();
    add_studio();
    add_sweep();
    add_linearize();
    add_forms();
    add_prove();
    add_compare();
    add_papers();
    add_verify();
    add_new();
    add_format();
    add_plot();
    add_convert();
    add_reference();
    add_models();
    add_completion();
  }

  // Runs the command that the words name; returns the exit status.
  int run(int argc, char** argv) {
    o_.command_line = command_line(argc, argv);
    try {
      app_.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
      if (e.get_exit_code() == 0) return app_.exit(e);
      const bool known = argc > 1 && argv[1][0] != '-';
      say(stderr, "error: %s\nhint: anholon %s%s--help\n", e.what(), known ? argv[1] : "", known ? " " : "");
      return kBadInput;
    }
    if (!shell_.empty()) {
      hand_out(completion_script(words_of(app_, ""), shell_));
      return kOk;
    }
    rescue_model(o_);
    if (needs_model_ && o_.model.empty()) {
      say_lines(stderr,
                "error: no model is named\nhint: a path to a .toml file, or a name that `anholon models` lists\n");
      return kBadInput;
    }
    return command_(o_);
  }

 private:
  using Function = int (*)(const Options&);

  // A command of its own kind.
  CLI::App* command(const char* name, const std::string& what, Function f, const std::string& footer,
                    bool needs_model = false) {
    CLI::App* c = app_.add_subcommand(name, what);
    c->footer(footer);
    c->callback([this, f, needs_model] { command_ = f, needs_model_ = needs_model; });
    return c;
  }
  // A command on a model.
  CLI::App* model_command(const char* name, const char* what, Function f, const char* footer, bool needs_model = true) {
    CLI::App* c = command(name, what, f, footer, needs_model);
    c->add_option("MODEL", o_.model, "a model file, or the name of a shipped model");
    c->add_flag("--json", o_.json, "JSON on the standard output");
    c->add_flag("--quiet", o_.quiet, "no progress, no report on stderr");
    return c;
  }

  // What a shell completes, from the commands and options themselves. Options without a group are not shown.
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

  // ---- options that commands share ---------------------------------------------------------------

  void model_options(CLI::App* c, ModelOption::Of of) {
    for (const ModelOption& m : cli::model_options())
      if (m.of == of)
        c->add_option("--" + std::string(m.name), o_.*m.words, m.help)->type_name(m.value)->allow_extra_args(m.assigns);
  }
  void parameters(CLI::App* c) { model_options(c, ModelOption::Of::parameters); }
  void state(CLI::App* c) {
    c->add_option("--t", o_.t, "initial time")->type_name("T");
    model_options(c, ModelOption::Of::state);
  }

  // An option of motions; `help` where a command means it in its own way.
  void motion_option(CLI::App* c, const char* name, const char* help = nullptr) {
    const MotionOption& row = anholon::motion_option(name);
    const std::string flag = "--" + std::string(name);
    const auto take = [this, &row, flag](const std::vector<std::string>& words) {
      set(o_.motion, row, words, flag, [&](const std::string& text) { return exact(text, flag); });
    };
    CLI::Option* option =
        std::holds_alternative<std::vector<WrittenTime> MotionSettings::*>(row.member)
            ? c->add_option_function<std::vector<std::string>>(
                  flag, [take](const std::vector<std::string>& words) { take(split(words)); }, help ? help : row.help)
            : c->add_option_function<std::string>(
                  flag, [take](const std::string& word) { take({word}); }, help ? help : row.help);
    option->type_name(row.value);
  }

  void form_option(CLI::App* c) {
    motion_options(c, MotionOption::Part::form);
    model_options(c, ModelOption::Of::form);
    c->add_option("--show", o_.show, "print one stage instead: mechanics, system, structure, program; check: also cost")
        ->type_name("STAGE");
  }

  void order_m(CLI::App* c) {
    c->add_option("--m", o_.m,
                  "the order m of the forms that have one, 1 to " + std::to_string(kHighestM) +
                      ": constraints of lower order are\nlifted to it (default: the highest order of the constraints, "
                      "1 at least)")
        ->type_name("M")
        ->check(CLI::Range(1, static_cast<int>(kHighestM)));
  }

  void motion_options(CLI::App* c, MotionOption::Part part) {
    for (const MotionOption& row : anholon::motion_options())
      if (row.part == part) motion_option(c, row.name);
  }
  void accuracy(CLI::App* c) { motion_options(c, MotionOption::Part::accuracy); }
  void motion(CLI::App* c) {
    motion_options(c, MotionOption::Part::times);
    accuracy(c);
  }

  // ---- the commands, in the order of the help ----------------------------------------------------

  void add_check() {
    CLI::App* c = model_command("check", "classify the constraints, show structure and initial data", cli::check,
                                "Example: anholon check models/zoo/disc.toml");
    parameters(c), state(c), form_option(c);
  }

  void add_derive() {
    CLI::App* c = model_command("derive", "print the equations of motion", cli::derive,
                                "Examples: anholon derive disc --format latex\n"
                                "          anholon derive luo-zhao-example-2 --reactions\n"
                                "          anholon derive chaplygin-sleigh --form nielsen-reduced --m 3 --steps");
    parameters(c), form_option(c);
    c->add_option("--format", o_.format,
                  "text, latex, mathml or json; c (C99) or python (NumPy): a program that computes the motion's right "
                  "side\n(default: by the end of FILE, else text)")
        ->type_name("FORMAT")
        ->each([this](const std::string&) { o_.format_given = true; });
    c->add_option("-o,--output", o_.output,
                  "FILE.txt, FILE.tex, FILE.html, FILE.json, FILE.c or FILE.py (default: the standard output)")
        ->type_name("FILE");
    c->add_option("--expand", o_.expand,
                  "auto or paper (grouped), none, full (written out), parts (named, for many coordinates)")
        ->type_name("HOW");

    c->add_flag("--steps", o_.steps,
                "show the forces, constraints, the elimination and the quantities of the form on the way");
    c->add_flag("--reactions", o_.reactions,
                "show multipliers, generalized reactions and the reactions on each body as formulas, too");
    order_m(c);
  }

  void add_evaluate() {
    CLI::App* c = model_command("evaluate", "all forces, accelerations, multipliers, reactions at one state",
                                cli::evaluate, "Example: anholon evaluate disc --q theta=1 --qdot theta=0.1 --json");
    parameters(c), state(c), form_option(c);
    motion_option(c, "digits");
    motion_option(c, "numbers", "long-double (default) or quad (33 digits)");
  }

  void add_simulate() {
    CLI::App* c = model_command(
        "simulate", "integrate the motion", cli::simulate,
        "FILE.h5 holds the model, the rows and the report, and can be read while the run goes on and after a kill.\n"
        "Examples: anholon simulate disc --to 10 --every 0.01 -o disc.csv\n"
        "          anholon simulate disc --to 10 -o disc.h5 && anholon plot disc.h5\n"
        "          anholon simulate disc --to 1000 --tolerance 1e-6 --method rk");
    parameters(c), state(c), form_option(c);
    motion(c);
    c->add_option("--save", o_.save, "FILE that holds the run's state at the end, after Ctrl-C, and every few seconds")
        ->type_name("FILE");
    c->add_option("--continue", o_.resume,
                  "FILE that --save wrote: the run goes on with the same bits, rows after its last")
        ->type_name("FILE");
    motion_options(c, MotionOption::Part::judgement);
    c->add_option("-o,--output", o_.output, known_files("FILE") + plain_output())->type_name("FILE");

    c->add_option("--report", o_.report,
                  "FILE.html: the motion as a page with equations, plots and animation (see anholon report)")
        ->type_name("FILE");
  }

  void add_report() {
    CLI::App* c = model_command(
        "report", "a page that shows a motion: equations, proof, plots, animation", cli::report,
        "One self-contained file for any browser. MODEL is a model, whose motion is computed, or a run in HDF5.\n"
        "Examples: anholon report disc -o disc.html\n"
        "          anholon simulate disc --to 10 -o disc.h5 && anholon report disc.h5\n"
        "          anholon report luo-zhao-example-2 --to 5 --forms routh,appell\n"
        "          anholon report pendulum.toml --case moon --case mars       scenarios side by side\n"
        "          anholon report disc --rows disc.csv                        rows from a file");
    parameters(c), state(c), form_option(c), motion(c);
    c->add_option("-o,--output", o_.output, "FILE.html (default: named as the model, in this folder)")
        ->type_name("FILE");
    c->add_option("--forms", o_.forms,
                  "forms whose equations are shown: routh,maggi (default: Routh's, those of the motion, Maggi's)")
        ->type_name("NAME,…")
        ->allow_extra_args(false);
    c->add_option("--rows", o_.rows, "a run of this model whose rows are shown, in " + known_formats())
        ->type_name("FILE");
    c->add_flag("--no-proof", o_.no_proof, "leave out the proof that the forms agree");
  }

  void add_render() {
    CLI::App* c = model_command(
        "render", "the animation of a motion as a film or pictures (needs Chromium; films: ffmpeg)", cli::render,
        "MODEL is a model, whose motion is computed, or a run in HDF5. -o FILE.mp4 or FILE.gif is a film, FILE.png one "
        "picture,\n"
        "FOLDER/ a picture for each moment: frame-0001.png, … Chromium is looked for as chromium, chromium-browser, "
        "google-chrome;\n"
        "ANHOLON_CHROMIUM names another.\n"
        "Exit status: 0 ok, 1 the motion stopped early (what there is was recorded) or Ctrl-C, 2 bad input, or nothing "
        "to record with.\n"
        "Examples: anholon render disc -o disc.mp4\n"
        "          anholon simulate disc --to 10 -o disc.h5 && anholon render disc.h5 -o disc.gif --seconds 4\n"
        "          anholon render disc -o disc.png --at 3 --size 1920x1080 --dark\n"
        "          anholon render luo-zhao-example-2 -o seen/ --frame inertial --from 1 --to 2 --fps 50");
    parameters(c), state(c), form_option(c), accuracy(c);
    c->add_option("-o,--output", o_.output,
                  "FILE.mp4, FILE.gif, FILE.png or FOLDER/ (default: named as the model, .mp4, with --at .png)")
        ->type_name("FILE");
    c->add_option("--size", o_.size, "of the picture in pixels, 64x64 to 7680x7680 (default 1280x720; gif: 640x360)")
        ->type_name("WxH");
    c->add_option("--fps", o_.fps, "pictures per second, 1 to 120 (default 30; gif: 25)")->type_name("N");
    c->add_option("--seconds", o_.seconds,
                  "how long the film lasts (default: as the motion where that is 2 to 20 s, else 10)")
        ->type_name("S");
    c->add_option("--at", o_.picture_at,
                  "with FILE.png: the time of the picture, or 60%: so far through the motion (default: its start)")
        ->type_name("T");
    c->add_option("--from", o_.from, "recorded from this time on")->type_name("T");
    motion_option(c, "to", "recorded up to this time, where the motion of a MODEL ends, too");
    motion_option(c, "every", "rows of the motion at this interval (default: as many as a page shows)");
    c->add_option("--frame", o_.frame,
                  "where the model's observer moves: what it sees, observer (default), or an inertial one")
        ->type_name("WHO")
        ->check(CLI::IsMember({"observer", "inertial"}));
    c->add_flag("--dark", o_.dark, "on a dark ground");
    c->add_option("--rows", o_.rows, "a run of this model, in " + known_formats())->type_name("FILE");
  }

  void add_studio() {
    CLI::App* c =
        command("studio", "edit a model in the browser: equations, proof, plots and animation as you type", cli::studio,
                "Serves a page on the loopback address alone, whose address has a secret; Ctrl-C ends it. "
                "'Save' writes the file that was opened.\n"
                "A shipped model is shown and not written to: anholon new rolling -o mine.toml makes a file.\n"
                "Examples: anholon studio mine.toml\n"
                "          anholon studio disc --port 8080 --no-browser");
    c->add_option("MODEL", o_.model, "a model file, or the name of a shipped model (default: disc)");
    c->add_option("--port", o_.port, "the port of the page (default: a free one)")
        ->type_name("N")
        ->check(CLI::Range(0, 65535));
    c->add_flag("--no-browser", o_.no_browser, "print the address and open no browser");
    c->add_flag("--quiet", o_.quiet, "print the address alone");
    c->add_flag("--worker", o_.studio_worker)->group("");
  }

  void add_completion() {
    CLI::App* c = command("completion", "a script with which a shell completes commands, options and models", nullptr,
                          "Examples: source <(anholon completion bash)\n"
                          "          anholon completion zsh > ~/.zfunc/_anholon\n"
                          "          anholon completion fish > ~/.config/fish/completions/anholon.fish");
    c->add_option("SHELL", shell_, "bash, zsh or fish")->required()->check(CLI::IsMember(shells_with_completion()));
  }

  void add_sweep() {
    CLI::App* c = model_command(
        "sweep", "many motions with other parameters and initial values, on all cores", cli::sweep,
        "NAME is a parameter, a coordinate x or a velocity x'. A grid is 0:10:101 (from, to, how many), a list 1,2,5; "
        "several grids make all\n"
        "combinations. Random values are NAME~normal(MEAN,DEVIATION) or NAME~uniform(FROM,TO), drawn for each of -n "
        "cases; where there are\n"
        "grids too, the cases go round them. case=a,b runs through the sections [case.a] and [case.b] of the file.\n"
        "One line per case: what is varied, outcome, the event that ended the motion, t, final state, outputs, "
        "reductions; with --at one line\n"
        "per case and time.\n"
        "Exit status: 0 all motions finished, 1 some stopped early (their lines say why), 2 bad input.\n"
        "Examples: anholon sweep rattleback --vary \"psi'=-10:10:200\" --to 5 -o cases.csv\n"
        "          anholon sweep disc --vary m=1,2,5 --vary \"theta~normal(0.3,0.01)\" -n 3000 --seed 7\n"
        "          anholon sweep disc --vary \"phi'=5:7:100\" --to 10 --reduce \"min(theta),max(theta')\" --columns "
        "\"phi'(0),min*,max*\"\n"
        "          anholon sweep disc --cases cases.csv --at 1,2,5 -o rows.h5\n"
        "          anholon sweep disc --vary \"phi'=1:7:1000000\" --to 3 -o falls/        goes on after a kill\n"
        "          anholon sweep disc --vary \"phi'=1:7:1000000\" --to 3 -o falls/ --shard 3/8\n"
        "          anholon sweep disc --vary \"phi'=1:7:61\" --vary theta=0.2:1.4:49 --to 3 -o falls/ --refine 4");
    parameters(c), state(c), form_option(c);
    c->add_option("--vary", o_.varied,
                  "NAME=FROM:TO:COUNT, NAME=A,B,…, NAME~normal(MEAN,DEVIATION) or NAME~uniform(FROM,TO)")
        ->type_name("WHAT")
        ->allow_extra_args(false);
    c->add_option("-n", o_.case_count, "how many cases, where values are drawn")->type_name("N");
    c->add_option("--cases", o_.case_table,
                  "a table of cases in CSV: a first line of names, a line of numbers for each case")
        ->type_name("FILE");
    c->add_option("--draw", o_.draw,
                  "random (default), or sobol: points of a Sobol sequence, which lie more evenly; -n a power of 2")
        ->type_name("HOW")
        ->check(CLI::IsMember({"random", "sobol"}));
    c->add_option("--seed", o_.seed, "other draws (default 0)")->type_name("N");
    c->add_option(
         "--reduce", o_.reduce,
         "max(FORMULA), min(FORMULA), mean(FORMULA) or last(FORMULA) over each motion, by its Taylor polynomials")
        ->type_name("WHAT,…");
    c->add_option(
         "--columns", o_.columns,
         "which columns, or patterns with * and ?: theta,*',outcome; beside the usual ones there are event and "
         "steps")
        ->type_name("NAME,…");
    c->add_option("--threads", o_.threads, "default: as many as the machine has; the numbers are the same for any")
        ->type_name("N")
        ->check(CLI::Range(1, 1024));
    for (const MotionOption& row : anholon::motion_options())
      if (row.in_sweep) motion_option(c, row.name, row.in_sweep);
    c->add_option("-o,--output", o_.output,
                  known_files("FILE", sweep_formats()) +
                      ", or FOLDER/, which the same command completes after any stop" + plain_output())
        ->type_name("FILE");
    c->add_option("--shard", o_.shard, "with -o FOLDER/: the I-th of N shares, for N processes on any machines")
        ->type_name("I/N");
    c->add_option("--chunk", o_.chunk,
                  "with a new FOLDER/: cases in each of its files (default: as many as take some seconds)")
        ->type_name("N");
    c->add_option(
         "--refine", o_.refine,
         "with -o FOLDER/: so many further generations of cases, which halve the grid where neighbours ended in "
         "different ways")
        ->type_name("N");
    c->add_option("--refine-by", o_.refine_by,
                  "halve the grid, too, where the numbers of neighbours in this column differ by more than the bound")
        ->type_name("COLUMN:BOUND");
    add_sweep_folder(c);
  }

  // Commands of `sweep` on a folder.
  void add_sweep_folder(CLI::App* sweep) {
    const auto part = [&](const char* name, const char* what, Function f, const char* footer) {
      CLI::App* c = sweep->add_subcommand(name, what);
      c->footer(footer);
      c->callback([this, f] { command_ = f, needs_model_ = false; });
      c->add_option("FOLDER", o_.folder, "the folder of a sweep")->required();
      c->add_flag("--json", o_.json, "JSON on the standard output");
      return c;
    };
    CLI::App* status = part("status", "how far a sweep in a folder is", sweep_status,
                            "Exit status: 0 complete, 1 parts are missing, 2 bad input.\n"
                            "Example: anholon sweep status falls/ --watch");
    status->add_flag("--watch", o_.watch, "a line every two seconds until all parts are there");
    CLI::App* c = part("collect", "one file of a sweep in a folder", sweep_collect,
                       "Exit status: 0 ok, 2 bad input, or parts are missing.\n"
                       "Example: anholon sweep collect falls/ -o falls.csv");
    c->add_option("-o,--output", o_.output, known_files("FILE", sweep_formats()) + plain_output())->type_name("FILE");
    c->add_flag("--partial", o_.partial, "those parts that are there");
    c->add_flag("--quiet", o_.quiet, "no report on stderr");
    // A command on a folder is not the sweep of a model.
    sweep->callback([this, sweep] {
      if (sweep->get_subcommands().empty()) command_ = cli::sweep, needs_model_ = true;
    });
  }

  void add_linearize() {
    CLI::App* c = model_command(
        "linearize", "the linear model of a motion, its eigenvalues and modes, over a range of a parameter",
        cli::linearize,
        "About the initial state, which may be an equilibrium or a steady motion: [initial] conditions = "
        "[\"theta'' = 0\", …] finds one.\n"
        "Exit status: 0 ok, 1 no linear model at some value, 2 bad input.\n"
        "Example: anholon linearize whipple --vary v=0..10:1");
    parameters(c), state(c), form_option(c);
    c->add_option("--about", o_.about,
                  "state (default), or equilibrium: the one nearest to the initial positions, those of --q included")
        ->type_name("WHAT")
        ->check(CLI::IsMember({"state", "equilibrium"}));
    c->add_option("--vary", o_.vary,
                  "a parameter over a range, v=0..10:1 or v=0,1,2; where eigenvalues cross the imaginary axis is found")
        ->type_name("NAME=VALUES");
    motion_option(c, "digits", "of the numbers printed (default 16); the computation has at least 36");
    c->add_flag("--csv", o_.csv, "one line of eigenvalues per parameter value");
  }

  void add_forms() {
    CLI::App* c = model_command("forms", "the catalogue of forms, and which apply to a model", cli::forms,
                                "Example: anholon forms disc", false);
    parameters(c);
  }

  void add_prove() {
    CLI::App* c =
        model_command("prove", "prove that the forms of the equations agree, and show which do not", cli::prove,
                      "Exit status: 0 every pair is decided, 1 one stays unknown, 2 bad input.\n"
                      "Example: anholon prove luo-zhao-example-2 -o proof.json && anholon verify proof.json");
    c->add_option("--forms", o_.forms, "only these forms: routh,chaplygin (default: all that apply)")
        ->type_name("NAME,…")
        ->allow_extra_args(false);
    c->add_option("--eliminate", o_.eliminate,
                  "dependent coordinates of the forms without multipliers (default: chosen)")
        ->type_name("NAME,…")
        ->allow_extra_args(false);
    order_m(c);
    c->add_option("--digits", o_.proof_digits,
                  "of the enclosures that tell a difference from zero, at most (default 308)")
        ->type_name("N")
        ->check(CLI::Range(20, 20000));
    c->add_option("-o,--output", o_.output, "write a certificate")->type_name("FILE");
  }

  void add_compare() {
    CLI::App* c = model_command(
        "compare", "published equations against the derived ones: proved, refuted, or unknown", cli::compare,
        "EQUATIONS holds one equation per line, LABEL: left = right, in the names of the model, multipliers "
        "(lambda.NAME), energies and forces\n"
        "(T_r, Q.x, Gamma.x, N.x), partial and frozen derivatives, equations of forms (maggi.x): doc/equations.md.\n"
        "Where changes of up to four places make a false equation true, they are named.\n"
        "Exit status: 0 all are true, 1 one is false or stays unknown, 2 bad input.\n"
        "Example: anholon compare luo-zhao-example-1-symbolic luo-zhao-example-1.as-read");
    c->add_option("EQUATIONS", o_.equations, "a file of equations, or the name of a shipped one");
    parameters(c);
    c->add_option("--eliminate", o_.eliminate, "coordinates for which the constraints are solved (default: chosen)")
        ->type_name("NAME,…")
        ->allow_extra_args(false);
  }

  void add_papers() {
    CLI::App* c = command("papers", "the papers behind the program: every numbered equation, decided", cli::papers,
                          "Without a tag: all papers with their equations and verdicts. A tag in any spelling: L3.13, "
                          "\"[L 3.13]\", 3.18', "
                          "Q13, N3.16.\n"
                          "What is true is proved and a mutant of it refuted; what is false is refuted, and its "
                          "corrected version proved.\n"
                          "Exit status: 0 all is as the tables say, 1 something is not, 2 bad input.\n"
                          "Examples: anholon papers L3.13\n"
                          "          anholon papers --check");
    c->add_option("TAG", o_.model, "one equation");
    c->add_flag("--check", o_.check_only, "decide all, and count");
    c->add_flag("--json", o_.json, "JSON on the standard output");
    c->add_flag("--markdown", o_.markdown, "the tables in Markdown");
    c->add_flag("--quiet", o_.quiet, "no progress");
  }

  void add_verify() {
    CLI::App* c = command(
        "verify", "check a certificate, independently of what wrote it", cli::verify,
        "Exit status: 0 all claims confirmed, 1 one is contradicted or could not be checked, 2 not a certificate.\n"
        "Example: anholon verify disc.json");
    c->add_option("CERTIFICATE", o_.model, "a certificate file")->required();
    c->add_flag("--json", o_.json, "JSON on the standard output");
    c->add_flag("--quiet", o_.quiet, "the exit status only");
    c->add_option("--points", o_.points, "random points modulo each of two primes (default 6)")
        ->type_name("N")
        ->check(CLI::Range(1, 1000));
    c->add_option("--digits", o_.proof_digits, "of the enclosures at witnesses, at most (default 308)")
        ->type_name("N")
        ->check(CLI::Range(20, 20000));
    c->add_option("--seed", o_.seed, "another choice of points (default 0)")->type_name("N");
  }

  void add_new() {
    CLI::App* c = command("new", "a model to start from; without a name, the list of templates", cli::new_model,
                          "Example: anholon new pendulum -o mine.toml");
    c->add_option("TEMPLATE", o_.model, "its name");
    c->add_option("-o,--output", o_.output, "the file to write, which must not be there (default: the standard output)")
        ->type_name("FILE");
  }

  void add_format() {
    CLI::App* c =
        command("fmt", "set the layout of model files; what they say, their order and comments stay", cli::format,
                "Prints the names of the files it changed. Exit status: 0 ok, 1 with --check: a file would change, 2 "
                "bad input.\n"
                "Example: anholon fmt mine.toml");
    c->add_option("FILE", o_.files, "model files")->required();
    c->add_flag("--check", o_.check_only, "change nothing, say which files would be");
    c->add_flag("--stdout", o_.to_stdout, "print the text instead of changing the file");
  }

  void add_plot() {
    CLI::App* c = command("plot", "columns of a run, drawn in the terminal or as a figure for a paper", cli::plot,
                          "Columns are named as in the run; * and ? stand for any letters (in quotes, for the shell). "
                          "Without names: the coordinates.\n"
                          "Examples: anholon plot run.h5\n"
                          "          anholon plot run.h5 theta \"theta'\" --each --from 2 --to 5\n"
                          "          anholon plot run.h5 y --x x --title \"path of the contact\"\n"
                          "          anholon plot run.h5 'lambda.*' -o forces.pdf --size 8cmx5cm\n"
                          "          anholon plot falls/ outcome -o falls.svg       cells over the two that vary\n"
                          "          anholon plot cases.csv --histogram theta -o theta.svg",
                          true);
    c->add_option("RUN", o_.model,
                  "a run: " + known_files("FILE") +
                      ", or - for what comes through a pipe; or a sweep: a folder, a .csv or .parquet file")
        ->required();
    c->add_option("COLUMN", o_.columns, "names of columns, or patterns");
    c->add_option("--x", o_.abscissa, "the column along the horizontal axis (default: t)")->type_name("COLUMN");
    c->add_option("--y", o_.ordinate,
                  "of a sweep: the column along the vertical axis (default: the second that varies)")
        ->type_name("COLUMN");
    c->add_option("--histogram", o_.histogram, "of a sweep: how often the numbers or words of this column occur")
        ->type_name("COLUMN");
    c->add_option("--from", o_.from, "no rows before this time")->type_name("T");
    c->add_option("--to", o_.until, "no rows after this time")->type_name("T");
    c->add_flag("--log", o_.log_axis, "logarithmic vertical axis; what is not positive is left out");
    c->add_flag("--equal", o_.equal, "one unit is as long along both axes, for paths: plot run.h5 y --x x --equal");
    c->add_flag("--together", o_.together, "all columns in one panel (the default)");
    c->add_flag("--each", o_.each, "a panel for each column");
    c->add_option("--labels", o_.labels,
                  "unicode (θ̇), latex ($\\dot{\\theta}$, for programs that set it) or plain (theta')")
        ->type_name("STYLE")
        ->check(CLI::IsMember({"unicode", "latex", "plain"}));
    c->add_option("--title", o_.title, "above the figure")->type_name("TEXT");
    c->add_option("--size", o_.size,
                  "of a figure: 8cmx5cm (cm, mm, in, pt; default 16cmx9cm); in the terminal: 100x30, columns and rows")
        ->type_name("WxH");
    c->add_flag("--json", o_.json, "JSON on the standard output: what is drawn, and between which numbers");
    c->add_option(
         "-o,--output", o_.output,
         "FILE.svg, FILE.pdf, FILE.png or FILE.tex (pgfplots); of a sweep FILE.html, too, whose cells tell their "
         "cases")
        ->type_name("FILE");
  }

  void add_convert() {
    CLI::App* c = command(
        "convert", "a run in another format: " + known_formats(), cli::convert,
        "No digit is lost on the way. " + held_by_formats() + "\nExample: anholon convert run.h5 run.csv", true);
    c->add_option("IN", o_.model, "the run, in any of the formats; -: through a pipe")->required();
    c->add_option("OUT", o_.output, known_files("FILE") + plain_output());
    c->add_flag("--json", o_.json, "JSON on the standard output");
  }

  void add_reference() {
    CLI::App* c = command("reference", "the language of model files, in Markdown", cli::reference,
                          "Example: anholon reference event");
    c->add_option("SECTION", o_.model, "one section: body, event, …, or formulas (default: all)");
    c->add_flag("--schema", o_.schema, "a JSON Schema of the language, for editors with a TOML language server");
  }

  void add_models() {
    model_command("models", "the shipped models; with a name, the text of one", cli::models,
                  "Example: anholon models disc", false);
  }

  CLI::App app_{"Anholon: the equations of nonholonomic mechanics, their motion, with a residual report."};
  Options o_;
  std::string shell_;  // of `completion`; empty for other commands
  std::function<int(const Options&)> command_;
  bool needs_model_ = false;
};

}  // namespace

int run_command_line(int argc, char** argv) {
  if (argc > 1) check_command(argv[1]);
  return CommandLine().run(argc, argv);
}

}  // namespace anholon::cli
