// The command line words of the commands that compute motions.
#include "cli/command_words.h"
#include "result/format.h"

namespace anholon::cli {

void add_simulate(CommandLine& line) {
  const auto [c, o] = line.model_command(
      "simulate", "integrate the motion", cli::simulate,
      "FILE.h5 holds the model, the rows and the report, and can be read while the run goes on and after a kill.\n"
      "Examples: anholon simulate disc --to 10 --every 0.01 -o disc.csv\n"
      "          anholon simulate disc --to 10 -o disc.h5 && anholon plot disc.h5\n"
      "          anholon simulate disc --to 1000 --tolerance 1e-6 --method rk");
  parameters(c, o), state(c, o), form_option(c, o);
  motion(c, o);
  c->add_option("--save", o.save, "FILE that holds the run's state at the end, after Ctrl-C, and every few seconds")
      ->type_name("FILE");
  c->add_option("--continue", o.resume,
                "FILE that --save wrote: the run goes on with the same bits, rows after its last")
      ->type_name("FILE");
  motion_options(c, o, MotionOption::Part::judgement);
  c->add_option("-o,--output", o.output, known_files("FILE") + plain_output())->type_name("FILE");

  c->add_option("--report", o.page.path,
                "FILE.html: the motion as a page with equations, plots and animation (see anholon report)")
      ->type_name("FILE");
}

void add_report(CommandLine& line) {
  const auto [c, o] = line.model_command(
      "report", "a page that shows a motion: equations, proof, plots, animation", cli::report,
      "One self-contained file for any browser. MODEL is a model, whose motion is computed, or a run in HDF5.\n"
      "Examples: anholon report disc -o disc.html\n"
      "          anholon simulate disc --to 10 -o disc.h5 && anholon report disc.h5\n"
      "          anholon report luo-zhao-example-2 --to 5 --forms routh,appell\n"
      "          anholon report pendulum.toml --case moon --case mars       scenarios side by side\n"
      "          anholon report disc --rows disc.csv                        rows from a file");
  parameters(c, o), state(c, o), form_option(c, o), motion(c, o);
  c->add_option("-o,--output", o.page.path, "FILE.html (default: named as the model, in this folder)")
      ->type_name("FILE");
  c->add_option("--forms", o.page.forms,
                "forms whose equations are shown: routh,maggi (default: Routh's, those of the motion, Maggi's)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
  c->add_option("--columns", o.page.columns,
                "columns of the run in the charts, by names and patterns: 'x_*,theta' (default: as many as fit)")
      ->type_name("NAME,…")
      ->allow_extra_args(false);
  c->add_option("--rows", o.rows, "a run of this model whose rows are shown, in " + known_formats())->type_name("FILE");
  c->add_flag("--no-proof", o.page.no_proof, "leave out the proof that the forms agree");
}

// Adds the commands of `sweep` on a folder.
static void add_sweep_folder(CommandLine& line, CLI::App* sweep) {
  const auto part = [&](const char* name, const char* what, int (*run)(const SweepFolderCommand&), const char* footer) {
    const Words<SweepFolderCommand> w = line.command(name, what, run, footer, sweep);
    w.app->add_option("FOLDER", w.o.folder, "the folder of a sweep")->required();
    w.app->add_flag("--json", w.o.json, "JSON on the standard output");
    return w;
  };
  const auto status = part("status", "how far a sweep in a folder is", sweep_status,
                           "Exit status: 0 complete, 1 parts are missing, 2 bad input.\n"
                           "Example: anholon sweep status falls/ --watch");
  status.app->add_flag("--watch", status.o.watch, "a line every two seconds until all parts are there");
  const auto [c, o] = part("collect", "one file of a sweep in a folder", sweep_collect,
                           "Exit status: 0 ok, 2 bad input, or parts are missing.\n"
                           "Example: anholon sweep collect falls/ -o falls.csv");
  c->add_option("-o,--output", o.output, known_files("FILE", sweep_formats()) + plain_output())->type_name("FILE");
  c->add_flag("--partial", o.partial, "those parts that are there");
  c->add_flag("--quiet", o.quiet, "no report on stderr");
}

void add_sweep(CommandLine& line) {
  const auto [c, o] = line.model_command(
      "sweep", "many motions with other parameters and initial values, on all cores", cli::sweep,
      "NAME is a parameter, a coordinate x or a velocity x'. A grid is 0:10:101 (from, to, how many) or 0..10:0.1 "
      "(from, to, step),\n"
      "a list 1,2,5; several grids make all combinations. Random values are NAME~normal(MEAN,DEVIATION) or "
      "NAME~uniform(FROM,TO),\n"
      "drawn for each of -n cases; where there are grids too, the cases go round them. case=a,b runs through the "
      "sections [case.a]\n"
      "and [case.b] of the file.\n"
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
  parameters(c, o), state(c, o), form_option(c, o), mode_of_contacts(c, o);
  c->add_option(
       "--vary", o.varied,
       "NAME=FROM:TO:COUNT, NAME=FROM..TO:STEP, NAME=A,B,…, NAME~normal(MEAN,DEVIATION) or NAME~uniform(FROM,TO)")
      ->type_name("WHAT")
      ->allow_extra_args(false);
  c->add_option("-n", o.case_count, "how many cases, where values are drawn")->type_name("N");
  c->add_option("--cases", o.case_table,
                "a table of cases, CSV or Parquet: columns with the names of what varies, a row for each case")
      ->type_name("FILE");
  c->add_option("--draw", o.draw,
                "random (default), or sobol: points of a Sobol sequence, which lie more evenly; -n a power of 2")
      ->type_name("HOW")
      ->check(CLI::IsMember({"random", "sobol"}));
  seed_option(c, o.seed, "other draws (default 0)");
  c->add_option("--reduce", o.reduce,
                "over each motion: max(FORMULA), min(FORMULA) or mean(FORMULA), by its Taylor polynomials; "
                "last(FORMULA), at its end; "
                "count(EVENT), first(EVENT): how often an event fired, and its first time")
      ->type_name("WHAT,…");
  c->add_option("--columns", o.columns,
                "which columns beside the case, what varies and the reductions, also by patterns with * and ?: "
                "theta,*',outcome; beside the usual ones there are event and steps")
      ->type_name("NAME,…");
  c->add_option("--threads", o.threads, "default: as many as the machine has; the numbers are the same for any")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  for (const MotionOption& row : anholon::motion_options())
    if (row.in_sweep) motion_option(c, o, row.name, row.in_sweep);
  c->add_option("-o,--output", o.output,
                known_files("FILE", sweep_formats()) + ", or FOLDER/, which the same command completes after any stop" +
                    plain_output())
      ->type_name("FILE");
  c->add_option("--shard", o.shard, "with -o FOLDER/: the I-th of N shares, for N processes on any machines")
      ->type_name("I/N");
  c->add_option("--chunk", o.chunk,
                "with a new FOLDER/: cases in each of its files (default: as many as take some seconds)")
      ->type_name("N");
  c->add_option("--refine", o.refine,
                "with -o FOLDER/: so many further generations of cases, which halve the grid where neighbours ended in "
                "different ways")
      ->type_name("N");
  c->add_option("--refine-by", o.refine_by,
                "halve the grid, too, where the numbers of neighbours in this column differ by more than the bound")
      ->type_name("COLUMN:BOUND");
  add_sweep_folder(line, c);
}

void add_convert(CommandLine& line) {
  const auto [c, o] =
      line.command("convert", "a run in another format: " + known_formats(), cli::convert,
                   "No digit is lost on the way. " + held_by_formats() + "\nExample: anholon convert run.h5 run.csv");
  c->add_option("IN", o.run, "the run, in any of the formats; -: through a pipe")->required();
  c->add_option("OUT", o.output, known_files("FILE") + plain_output());
  c->add_flag("--json", o.json, "JSON on the standard output");
}

}  // namespace anholon::cli
