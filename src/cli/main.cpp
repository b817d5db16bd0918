// The program anholon: parses the command line, nothing else.
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>

#include <CLI/CLI.hpp>

#include "base/assert.h"
#include "base/diagnostic.h"
#include "cli/input.h"
#include "cli/say.h"
#include "motion/code_for_long_runs.h"

using namespace anholon;
using namespace anholon::cli;

namespace {

// --q x=1 y=2 MODEL: a word without '=' in a list of assignments is the model.
void rescue_model(Options& o) {
  for (std::vector<std::string>* list : {&o.q, &o.qdot, &o.qddot, &o.qdddot, &o.lambda, &o.lambdadot, &o.set})
    for (auto it = list->begin(); it != list->end();) {
      if (o.model.empty() && it->find('=') == std::string::npos)
        o.model = *it, it = list->erase(it);
      else
        ++it;
    }
}

constexpr const char* kCommands[] = {"check",     "derive",  "evaluate", "simulate", "sweep",  "linearize", "forms",
                                     "models",    "prove",   "compare",  "papers",   "verify", "new",       "fmt",
                                     "reference", "convert", "plot",     "report",   "render"};

// Gives a word that is not a command its own message.
void check_command(const char* word) {
  if (word[0] == '-') return;
  std::vector<std::string> known;
  for (const char* c : kCommands) {
    if (std::string(c) == word) return;
    known.emplace_back(c);
  }
  const std::string near = did_you_mean(word, known);
  throw UsageError{"error: there is no command '" + std::string(word) + "'" +
                   (near.empty() ? "" : "; did you mean '" + near + "'?") + "\nhint: anholon --help\n"};
}

// The words in a form that can be typed again.
std::string command_line(int argc, char** argv) {
  std::string line = "anholon";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool plain =
        !word.empty() &&
        word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-") ==
            std::string::npos;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += " " + (plain ? word : quoted + "'");
  }
  return line;
}

// Returns an error if the printed output did not reach its reader: a full disk or a closed pipe is not success.
int finish(int code) {
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (written || code != kOk) return code;  // the earlier error was already printed
  say(stderr, "error: cannot write the output: %s\n", std::strerror(errno));
  return kBadInput;
}

int run(int argc, char** argv) {
  if (argc > 1) check_command(argv[1]);
  CLI::App app{"Anholon: the equations of nonholonomic mechanics, their motion, with a residual report."};
  app.name("anholon");
  app.set_version_flag("--version", "anholon " ANHOLON_VERSION);
  app.require_subcommand(1);
  app.footer(
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
  Options o;
  o.command_line = command_line(argc, argv);
  std::function<int(const Options&)> command;

  const auto model_command = [&](const char* name, const char* what, int (*f)(const Options&), const char* footer) {
    CLI::App* c = app.add_subcommand(name, what);
    c->footer(footer);
    c->add_option("MODEL", o.model, "a model file, or the name of a shipped model");
    c->add_flag("--json", o.json, "JSON on the standard output");
    c->add_flag("--quiet", o.quiet, "no progress, no report on stderr");
    c->callback([&command, f] { command = f; });
    return c;
  };
  const auto parameters = [&](CLI::App* c) {
    c->add_option("--set", o.set, "NAME=VALUE: another value of a parameter, or of an integer of [index]")
        ->type_name("NAME=VALUE");
    c->add_option("--case", o.cases, "a scenario of the file, [case.NAME]; several are applied one after the other")
        ->type_name("NAME")
        ->allow_extra_args(false);
  };
  const auto state = [&](CLI::App* c) {
    c->add_option("--t", o.t, "initial time")->type_name("T");
    c->add_option("--q", o.q, "initial positions x=0.2,y=1 (exact decimals); others from the file")
        ->type_name("NAME=VALUE");
    c->add_option("--qdot", o.qdot, "initial velocities x=0.2,y=1")->type_name("NAME=VALUE");
    c->add_option("--qddot", o.qddot, "initial accelerations, where constraints of order 3 and more leave them free")
        ->type_name("NAME=VALUE");
    c->add_option("--qdddot", o.qdddot, "initial third derivatives, likewise (order 4 and more)")
        ->type_name("NAME=VALUE");
    c->add_option("--lambda", o.lambda, "initial multipliers blade=0.4, likewise (order 3 and more)")
        ->type_name("NAME=VALUE");
    c->add_option("--lambdadot", o.lambdadot, "initial rates of multipliers (order 4 and more)")
        ->type_name("NAME=VALUE");
  };
  const auto form_option = [&](CLI::App* c) {
    c->add_option("--form", o.form, "form of the equations (see `anholon forms`; derive: also all; motions: also auto)")
        ->type_name("NAME")
        ->each([&o](const std::string&) { o.form_given = true; });
    c->add_option("--eliminate", o.eliminate,
                  "dependent coordinates of the forms without multipliers: y,z (default: chosen)")
        ->type_name("NAME,…")
        ->allow_extra_args(false);
    c->add_option("--show", o.show, "print one stage instead: mechanics, system, structure, program; check: also cost")
        ->type_name("STAGE");
  };

  const auto order_m = [&](CLI::App* c) {
    c->add_option("--m", o.m,
                  "the order m of the forms that have one, 1 to " + std::to_string(kHighestM) +
                      ": constraints of lower order are\nlifted to it (default: the highest order of the constraints, "
                      "1 at least)")
        ->type_name("M")
        ->check(CLI::Range(1, static_cast<int>(kHighestM)));
  };

  CLI::App* check_command = model_command("check", "classify the constraints, show structure and initial data",
                                          cli::check, "Example: anholon check models/zoo/disc.toml");
  parameters(check_command), state(check_command), form_option(check_command);

  CLI::App* derive_command =
      model_command("derive", "print the equations of motion", cli::derive,
                    "Examples: anholon derive disc --format latex\n"
                    "          anholon derive luo-zhao-example-2 --reactions\n"
                    "          anholon derive chaplygin-sleigh --form nielsen-reduced --m 3 --steps");
  parameters(derive_command), form_option(derive_command);
  derive_command
      ->add_option("--format", o.format,
                   "text, latex, mathml or json; c (C99) or python (NumPy): a program that computes the motion's right "
                   "side\n(default: by the end of FILE, else text)")
      ->type_name("FORMAT")
      ->each([&o](const std::string&) { o.format_given = true; });
  derive_command
      ->add_option("-o,--output", o.output,
                   "FILE.txt, FILE.tex, FILE.html, FILE.json, FILE.c or FILE.py (default: the standard output)")
      ->type_name("FILE");
  derive_command
      ->add_option("--expand", o.expand,
                   "auto or paper (grouped), none, full (written out), parts (named, for many coordinates)")
      ->type_name("HOW");

  derive_command->add_flag("--steps", o.steps,
                           "show the forces, constraints, the elimination and the quantities of the form on the way");
  derive_command->add_flag("--reactions", o.reactions,
                           "show multipliers, generalized reactions and the reactions on each body as formulas, too");
  order_m(derive_command);

  CLI::App* evaluate_command =
      model_command("evaluate", "all forces, accelerations, multipliers, reactions at one state", cli::evaluate,
                    "Example: anholon evaluate disc --q theta=1 --qdot theta=0.1 --json");
  parameters(evaluate_command), state(evaluate_command), form_option(evaluate_command);
  evaluate_command->add_option("--digits", o.digits, "more than 16: multiprecision, or quad if asked for")
      ->type_name("N")
      ->check(CLI::Range(1, 2000));
  evaluate_command->add_option("--numbers", o.numbers, "long-double (default) or quad (33 digits)")
      ->check(CLI::IsMember({"long-double", "quad"}));

  const auto accuracy = [&](CLI::App* c) {
    c->add_option("--tolerance", o.tolerance, "of each step, relative (default 1e-12)")->type_name("TOL");
    c->add_option("--digits", o.digits, "more than 16: multiprecision, or quad if asked for")
        ->type_name("N")
        ->check(CLI::Range(1, 2000));
    c->add_option("--numbers", o.numbers,
                  "double, long-double or quad (33 digits, tolerance 1e-32 unless given; faster than --digits)")
        ->check(CLI::IsMember({"double", "long-double", "quad"}));
    c->add_option("--rigorous", o.rigorous,
                  "bound the residuals of the dense output by ball arithmetic: at so many times, or all")
        ->type_name("N");
    c->add_option("--order", o.order, "order of the Taylor polynomials (default: from the tolerance)")
        ->check(CLI::Range(4, 500));
    c->add_option("--method", o.method,
                  "taylor; rk: Runge-Kutta of order 8, for loose tolerances and kinks; bdf, for stiff motions; auto "
                  "(default): Taylor\nunless another one is found to be much cheaper on the way")
        ->type_name("NAME");
    c->add_option("--integrator", o.integrator,
                  "taylor, or a second opinion by SUNDIALS: cvode, ida; with its difference")
        ->type_name("NAME");
  };
  const auto motion = [&](CLI::App* c) {
    c->add_option("--to", o.to, "end time (absolute)")->type_name("T");
    c->add_option("--at", o.at, "rows at exactly these times: 0.25,0.5")->type_name("T,…");
    c->add_option("--every", o.every, "rows at this interval")->type_name("DT");
    accuracy(c);
  };
  CLI::App* simulate_command = model_command(
      "simulate", "integrate the motion", cli::simulate,
      "FILE.h5 holds the model, the rows and the report, and can be read while the run goes on and after a kill.\n"
      "Examples: anholon simulate disc --to 10 --every 0.01 -o disc.csv\n"
      "          anholon simulate disc --to 10 -o disc.h5 && anholon plot disc.h5\n"
      "          anholon simulate disc --to 1000 --tolerance 1e-6 --method rk");
  parameters(simulate_command), state(simulate_command), form_option(simulate_command);
  motion(simulate_command);
  simulate_command
      ->add_option("--save", o.save, "FILE that holds the run's state at the end, after Ctrl-C, and every few seconds")
      ->type_name("FILE");
  simulate_command
      ->add_option("--continue", o.resume,
                   "FILE that --save wrote: the run goes on with the same bits, rows after its last")
      ->type_name("FILE");
  simulate_command
      ->add_option(
          "--error-estimate", o.error_estimate,
          "digits to trust, by a second, sharper run: always, never, or of runs up to 5000 steps (short, the default)")
      ->type_name("WHEN")
      ->check(CLI::IsMember({"always", "never", "short"}));
  simulate_command
      ->add_option("-o,--output", o.output, "FILE.h5, FILE.csv or FILE.json (default: CSV on the standard output)")
      ->type_name("FILE");

  simulate_command
      ->add_option("--report", o.report,
                   "FILE.html: the motion as a page with equations, plots and animation (see anholon report)")
      ->type_name("FILE");

  CLI::App* report_command = model_command(
      "report", "a page that shows a motion: equations, proof, plots, animation", cli::report,
      "One self-contained file for any browser. MODEL is a model, whose motion is computed, or a run in HDF5.\n"
      "Examples: anholon report disc -o disc.html\n"
      "          anholon simulate disc --to 10 -o disc.h5 && anholon report disc.h5\n"
      "          anholon report luo-zhao-example-2 --to 5 --forms routh,appell\n"
      "          anholon report pendulum.toml --case moon --case mars       scenarios side by side\n"
      "          anholon report disc --rows disc.csv                        rows from a file");
  parameters(report_command), state(report_command), form_option(report_command), motion(report_command);
  report_command->add_option("-o,--output", o.output, "FILE.html (default: named as the model, in this folder)")
      ->type_name("FILE");
  report_command
      ->add_option("--forms", o.forms,
                   "forms whose equations are shown: routh,maggi (default: Routh's, those of the motion, Maggi's)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
  report_command->add_option("--rows", o.rows, "a run of this model whose rows are shown, in HDF5, CSV or JSON")
      ->type_name("FILE");
  report_command->add_flag("--no-proof", o.no_proof, "leave out the proof that the forms agree");

  CLI::App* render_command = model_command(
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
  parameters(render_command), state(render_command), form_option(render_command), accuracy(render_command);
  render_command
      ->add_option("-o,--output", o.output,
                   "FILE.mp4, FILE.gif, FILE.png or FOLDER/ (default: named as the model, .mp4, with --at .png)")
      ->type_name("FILE");
  render_command
      ->add_option("--size", o.size, "of the picture in pixels, 64x64 to 7680x7680 (default 1280x720; gif: 640x360)")
      ->type_name("WxH");
  render_command->add_option("--fps", o.fps, "pictures per second, 1 to 120 (default 30; gif: 25)")->type_name("N");
  render_command
      ->add_option("--seconds", o.seconds,
                   "how long the film lasts (default: as the motion where that is 2 to 20 s, else 10)")
      ->type_name("S");
  render_command
      ->add_option("--at", o.picture_at,
                   "with FILE.png: the time of the picture, or 60%: so far through the motion (default: its start)")
      ->type_name("T");
  render_command->add_option("--from", o.from, "recorded from this time on")->type_name("T");
  render_command->add_option("--to", o.to, "recorded up to this time, where the motion of a MODEL ends, too")
      ->type_name("T");
  render_command
      ->add_option("--every", o.every, "rows of the motion at this interval (default: as many as a page shows)")
      ->type_name("DT");
  render_command
      ->add_option("--frame", o.frame,
                   "where the model's observer moves: what it sees, observer (default), or an inertial one")
      ->type_name("WHO")
      ->check(CLI::IsMember({"observer", "inertial"}));
  render_command->add_flag("--dark", o.dark, "on a dark ground");
  render_command->add_option("--rows", o.rows, "a run of this model, in HDF5, CSV or JSON")->type_name("FILE");

  CLI::App* sweep_command = model_command(
      "sweep", "many motions with other parameters and initial values, on all cores", cli::sweep,
      "NAME is a parameter, a coordinate x or a velocity x'. A grid is 0:10:101 (from, to, how many), a list 1,2,5; "
      "several grids make all\n"
      "combinations. Random values are NAME~normal(MEAN,DEVIATION) or NAME~uniform(FROM,TO), drawn for each of -n "
      "cases; where there are\n"
      "grids too, the cases go round them. One line per case: what is varied, outcome, t, final state, outputs.\n"
      "Exit status: 0 all motions finished, 1 some stopped early (their lines say why), 2 bad input.\n"
      "Examples: anholon sweep rattleback --vary \"psi'=-10:10:200\" --to 5 -o cases.csv\n"
      "          anholon sweep disc --vary m=1,2,5 --vary \"theta~normal(0.3,0.01)\" -n 3000 --seed 7");
  parameters(sweep_command), state(sweep_command), form_option(sweep_command);
  sweep_command
      ->add_option("--vary", o.varied,
                   "NAME=FROM:TO:COUNT, NAME=A,B,…, NAME~normal(MEAN,DEVIATION) or NAME~uniform(FROM,TO)")
      ->type_name("WHAT")
      ->allow_extra_args(false);
  sweep_command->add_option("-n,--cases", o.case_count, "how many, where values are random")->type_name("N");
  sweep_command->add_option("--seed", o.seed, "other random values (default 0)")->type_name("N");
  sweep_command
      ->add_option("--threads", o.threads, "default: as many as the machine has; the numbers are the same for any")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  sweep_command->add_option("--to", o.to, "end time (absolute)")->type_name("T");
  sweep_command->add_option("--tolerance", o.tolerance, "of each step, relative (default 1e-12)")->type_name("TOL");
  sweep_command->add_option("--order", o.order, "order of the Taylor polynomials (default: from the tolerance)")
      ->check(CLI::Range(4, 500));
  sweep_command
      ->add_option("--method", o.method,
                   "taylor; rk or bdf, as for simulate: one case after the other on each core; auto (default): Taylor, "
                   "in the lanes of the processor")
      ->type_name("NAME");
  sweep_command
      ->add_option("--error-estimate", o.error_estimate,
                   "digits to trust, by a second, sharper run of a few cases: always, never, or of cases up to 5000 "
                   "steps (short, the default)")
      ->type_name("WHEN")
      ->check(CLI::IsMember({"always", "never", "short"}));
  sweep_command->add_option("-o,--output", o.output, "FILE.csv or FILE.json (default: CSV on the standard output)")
      ->type_name("FILE");

  CLI::App* linearize_command =
      model_command("linearize", "the linear model of a motion, its eigenvalues and modes, over a range of a parameter",
                    cli::linearize,
                    "About the initial state, which may be an equilibrium or a steady motion: [initial] conditions = "
                    "[\"theta'' = 0\", …] finds one.\n"
                    "Exit status: 0 ok, 1 no linear model at some value, 2 bad input.\n"
                    "Example: anholon linearize whipple --vary v=0..10:1");
  parameters(linearize_command), state(linearize_command), form_option(linearize_command);
  linearize_command
      ->add_option("--about", o.about,
                   "state (default), or equilibrium: the one nearest to the initial positions, those of --q included")
      ->type_name("WHAT")
      ->check(CLI::IsMember({"state", "equilibrium"}));
  linearize_command
      ->add_option(
          "--vary", o.vary,
          "a parameter over a range, v=0..10:1 or v=0,1,2; where eigenvalues cross the imaginary axis is found")
      ->type_name("NAME=VALUES");
  linearize_command
      ->add_option("--digits", o.digits, "of the numbers printed (default 16); the computation has at least 36")
      ->type_name("N")
      ->check(CLI::Range(1, 2000));
  linearize_command->add_flag("--csv", o.csv, "one line of eigenvalues per parameter value");

  CLI::App* forms_command = model_command("forms", "the catalogue of forms, and which apply to a model", cli::forms,
                                          "Example: anholon forms disc");
  parameters(forms_command);
  CLI::App* prove_command =
      model_command("prove", "prove that the forms of the equations agree, and show which do not", cli::prove,
                    "Exit status: 0 every pair is decided, 1 one stays unknown, 2 bad input.\n"
                    "Example: anholon prove luo-zhao-example-2 -o proof.json && anholon verify proof.json");
  prove_command->add_option("--forms", o.forms, "only these forms: routh,chaplygin (default: all that apply)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
  prove_command
      ->add_option("--eliminate", o.eliminate,
                   "dependent coordinates of the forms without multipliers (default: chosen)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
  order_m(prove_command);
  prove_command
      ->add_option("--digits", o.proof_digits,
                   "of the enclosures that tell a difference from zero, at most (default 308)")
      ->type_name("N")
      ->check(CLI::Range(20, 20000));
  prove_command->add_option("-o,--output", o.output, "write a certificate")->type_name("FILE");
  CLI::App* compare_command = model_command(
      "compare", "published equations against the derived ones: proved, refuted, or unknown", cli::compare,
      "EQUATIONS holds one equation per line, LABEL: left = right, in the names of the model, multipliers "
      "(lambda.NAME), energies and forces\n"
      "(T_r, Q.x, Gamma.x, N.x), partial and frozen derivatives, equations of forms (maggi.x): doc/equations.md.\n"
      "Where changes of up to four places make a false equation true, they are named.\n"
      "Exit status: 0 all are true, 1 one is false or stays unknown, 2 bad input.\n"
      "Example: anholon compare luo-zhao-example-1-symbolic luo-zhao-example-1.as-read");
  compare_command->add_option("EQUATIONS", o.equations, "a file of equations, or the name of a shipped one");
  parameters(compare_command);
  compare_command
      ->add_option("--eliminate", o.eliminate, "coordinates for which the constraints are solved (default: chosen)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
  CLI::App* papers_command =
      app.add_subcommand("papers", "the papers behind the program: every numbered equation, decided");
  papers_command->footer(
      "Without a tag: all papers with their equations and verdicts. A tag in any spelling: L3.13, \"[L 3.13]\", 3.18', "
      "Q13, N3.16.\n"
      "What is true is proved and a mutant of it refuted; what is false is refuted, and its corrected version proved.\n"
      "Exit status: 0 all is as the tables say, 1 something is not, 2 bad input.\n"
      "Examples: anholon papers L3.13\n"
      "          anholon papers --check");
  papers_command->add_option("TAG", o.model, "one equation");
  papers_command->add_flag("--check", o.check_only, "decide all, and count");
  papers_command->add_flag("--json", o.json, "JSON on the standard output");
  papers_command->add_flag("--markdown", o.markdown, "the tables in Markdown");
  papers_command->add_flag("--quiet", o.quiet, "no progress");
  papers_command->callback([&command] { command = cli::papers; });
  CLI::App* verify_command = app.add_subcommand("verify", "check a certificate, independently of what wrote it");
  verify_command->footer(
      "Exit status: 0 all claims confirmed, 1 one is contradicted or could not be checked, 2 not a certificate.\n"
      "Example: anholon verify disc.json");
  verify_command->add_option("CERTIFICATE", o.model, "a certificate file")->required();
  verify_command->add_flag("--json", o.json, "JSON on the standard output");
  verify_command->add_flag("--quiet", o.quiet, "the exit status only");
  verify_command->add_option("--points", o.points, "random points modulo each of two primes (default 6)")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  verify_command->add_option("--digits", o.proof_digits, "of the enclosures at witnesses, at most (default 308)")
      ->type_name("N")
      ->check(CLI::Range(20, 20000));
  verify_command->add_option("--seed", o.seed, "another choice of points (default 0)")->type_name("N");
  verify_command->callback([&command] { command = cli::verify; });
  CLI::App* new_command = app.add_subcommand("new", "a model to start from; without a name, the list of templates");
  new_command->footer("Example: anholon new pendulum -o mine.toml");
  new_command->add_option("TEMPLATE", o.model, "its name");
  new_command
      ->add_option("-o,--output", o.output, "the file to write, which must not be there (default: the standard output)")
      ->type_name("FILE");
  new_command->callback([&command] { command = cli::new_model; });
  CLI::App* format_command =
      app.add_subcommand("fmt", "set the layout of model files; what they say, their order and comments stay");
  format_command->footer(
      "Prints the names of the files it changed. Exit status: 0 ok, 1 with --check: a file would change, 2 bad input.\n"
      "Example: anholon fmt mine.toml");
  format_command->add_option("FILE", o.files, "model files")->required();
  format_command->add_flag("--check", o.check_only, "change nothing, say which files would be");
  format_command->add_flag("--stdout", o.to_stdout, "print the text instead of changing the file");
  format_command->callback([&command] { command = cli::format; });
  CLI::App* plot_command =
      app.add_subcommand("plot", "columns of a run, drawn in the terminal or as a figure for a paper");
  plot_command->footer("Columns are named as in the run; * and ? stand for any letters (in quotes, for the shell). "
                       "Without names: the coordinates.\n"
                       "Examples: anholon plot run.h5\n"
                       "          anholon plot run.h5 theta \"theta'\" --each --from 2 --to 5\n"
                       "          anholon plot run.h5 y --x x --title \"path of the contact\"\n"
                       "          anholon plot run.h5 'lambda.*' -o forces.pdf --size 8cmx5cm");
  plot_command->add_option("RUN", o.model, "a run: FILE.h5, FILE.csv, FILE.json, or - for what comes through a pipe")
      ->required();
  plot_command->add_option("COLUMN", o.columns, "names of columns, or patterns");
  plot_command->add_option("--x", o.abscissa, "the column along the horizontal axis (default: t)")->type_name("COLUMN");
  plot_command->add_option("--from", o.from, "no rows before this time")->type_name("T");
  plot_command->add_option("--to", o.to, "no rows after this time")->type_name("T");
  plot_command->add_flag("--log", o.log_axis, "logarithmic vertical axis; what is not positive is left out");
  plot_command->add_flag("--equal", o.equal,
                         "one unit is as long along both axes, for paths: plot run.h5 y --x x --equal");
  plot_command->add_flag("--together", o.together, "all columns in one panel (the default)");
  plot_command->add_flag("--each", o.each, "a panel for each column");
  plot_command
      ->add_option("--labels", o.labels,
                   "unicode (θ̇), latex ($\\dot{\\theta}$, for programs that set it) or plain (theta')")
      ->type_name("STYLE")
      ->check(CLI::IsMember({"unicode", "latex", "plain"}));
  plot_command->add_option("--title", o.title, "above the figure")->type_name("TEXT");
  plot_command
      ->add_option("--size", o.size,
                   "of a figure: 8cmx5cm (cm, mm, in, pt; default 16cmx9cm); in the terminal: 100x30, columns and rows")
      ->type_name("WxH");
  plot_command->add_flag("--json", o.json, "JSON on the standard output: what is drawn, and between which numbers");
  plot_command->add_option("-o,--output", o.output, "FILE.svg, FILE.pdf, FILE.png or FILE.tex (pgfplots)")
      ->type_name("FILE");
  plot_command->callback([&command] { command = cli::plot; });
  CLI::App* convert_command = app.add_subcommand("convert", "a run in another format: HDF5, CSV or JSON");
  convert_command->footer("No digit is lost on the way. HDF5 holds the model, the rows and the report, JSON the rows "
                          "and the report, CSV the rows.\n"
                          "Example: anholon convert run.h5 run.csv");
  convert_command->add_option("IN", o.model, "the run, in any of the formats; -: through a pipe")->required();
  convert_command->add_option("OUT", o.output, "FILE.h5, FILE.csv or FILE.json (default: CSV on the standard output)");
  convert_command->add_flag("--json", o.json, "JSON on the standard output");
  convert_command->callback([&command] { command = cli::convert; });
  CLI::App* reference_command = app.add_subcommand("reference", "the language of model files, in Markdown");
  reference_command->footer("Example: anholon reference event");
  reference_command->add_option("SECTION", o.model, "one section: body, event, …, or formulas (default: all)");
  reference_command->add_flag("--schema", o.schema,
                              "a JSON Schema of the language, for editors with a TOML language server");
  reference_command->callback([&command] { command = cli::reference; });
  model_command("models", "the shipped models; with a name, the text of one", cli::models,
                "Example: anholon models disc");

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    const bool known = argc > 1 && argv[1][0] != '-';
    say(stderr, "error: %s\nhint: anholon %s%s--help\n", e.what(), known ? argv[1] : "", known ? " " : "");
    return kBadInput;
  }
  rescue_model(o);
  const bool needs_model =
      !(forms_command->parsed() || app.got_subcommand("models") || papers_command->parsed() ||
        verify_command->parsed() || new_command->parsed() || format_command->parsed() || reference_command->parsed());
  if (needs_model && o.model.empty()) {
    say_lines(stderr,
              "error: no model is named\nhint: a path to a .toml file, or a name that `anholon models` lists\n");
    return kBadInput;
  }
  return command(o);
}

}  // namespace

int main(int argc, char** argv) {
  set_fault_handler([](const char* file, int line, const char* condition) {
    say(stderr, "%s:%d: internal fault: %s\nplease report this with the model\n", file, line, condition);
    std::_Exit(kFault);
  });
  // A limit on the size of files is an error with a message, like a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const int status = finish(run(argc, argv));
    if (!compiling_for_nobody()) return status;
    std::fflush(nullptr);
    std::_Exit(status);
  } catch (const UsageError& e) {
    std::fflush(stdout);
    say_lines(stderr, e.text);
    return kBadInput;
  } catch (const Failure& e) {
    // The failure does not concern one element of the file, but the equations made of all elements.
    std::fflush(stdout);
    say(stderr, "error: %s\n", e.what());
    if (!e.diagnostic.hint.empty()) say(stderr, "hint: %s\n", e.diagnostic.hint.c_str());
    return kBadInput;
  } catch (const std::bad_alloc&) {
    say_lines(stderr, "stopped (too_large): out of memory\nhint: the model is too large for this machine\n");
    return kStopped;
  } catch (const std::exception& e) {
    say(stderr, "internal fault: %s\nplease report this with the model\n", e.what());
    return kFault;
  }
}
