// The command line words of the commands that draw.
#include "cli/command_words.h"
#include "result/format.h"

namespace anholon::cli {

void add_render(CommandLine& line) {
  const auto [c, o] = line.model_command(
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
  parameters(c, o), state(c, o), form_option(c, o), accuracy(c, o);
  c->add_option("-o,--output", o.output,
                "FILE.mp4, FILE.gif, FILE.png or FOLDER/ (default: named as the model, .mp4, with --at .png)")
      ->type_name("FILE");
  c->add_option("--size", o.size, "of the picture in pixels, 64x64 to 7680x7680 (default 1280x720; gif: 640x360)")
      ->type_name("WxH");
  c->add_option("--fps", o.fps, "pictures per second, 1 to 120 (default 30; gif: 25)")->type_name("N");
  c->add_option("--seconds", o.seconds,
                "how long the film lasts (default: as the motion where that is 2 to 20 s, else 10)")
      ->type_name("S");
  c->add_option("--at", o.at,
                "with FILE.png: the time of the picture, or 60%: so far through the motion (default: its start)")
      ->type_name("T");
  c->add_option("--from", o.from, "recorded from this time on")->type_name("T");
  motion_option(c, o, "to", "recorded up to this time, where the motion of a MODEL ends, too");
  motion_option(c, o, "every", "rows of the motion at this interval (default: as many as a page shows)");
  c->add_option("--frame", o.frame,
                "where the model's observer moves: what it sees, observer (default), or an inertial one")
      ->type_name("WHO")
      ->check(CLI::IsMember({"observer", "inertial"}));
  c->add_flag("--dark", o.dark, "on a dark ground");
  c->add_option("--rows", o.rows, "a run of this model, in " + known_formats())->type_name("FILE");
}

void add_studio(CommandLine& line) {
  const auto [c, o] = line.command(
      "studio",
      "edit a model in the browser: equations, proof, plots and animation as you type; or see a sweep and its motions",
      cli::studio,
      "Serves a page on the loopback address alone, whose address has a secret; Ctrl-C ends it. "
      "'Save' writes the file that was opened.\n"
      "A shipped model is shown and not written to: anholon new rolling -o mine.toml makes a file.\n"
      "Of a folder of a sweep the page shows the map of its cases; a click on one computes its motion and shows it.\n"
      "Examples: anholon studio mine.toml\n"
      "          anholon studio disc --port 8080 --no-browser\n"
      "          anholon studio falls/");
  c->add_option("MODEL", o.model, "a model file, the name of a shipped model (default: disc), or a folder of a sweep");
  c->add_option("--port", o.port, "the port of the page (default: a free one)")
      ->type_name("N")
      ->check(CLI::Range(0, 65535));
  c->add_flag("--no-browser", o.no_browser, "print the address and open no browser");
  c->add_flag("--quiet", o.quiet, "print the address alone");
  c->add_flag("--worker", o.worker)->group("");
}

void add_plot(CommandLine& line) {
  const auto [c, o] =
      line.command("plot", "columns of a run, drawn in the terminal or as a figure for a paper", cli::plot,
                   "Columns are named as in the run; * and ? stand for any letters (in quotes, for the shell). "
                   "Without names: the coordinates.\n"
                   "Examples: anholon plot run.h5\n"
                   "          anholon plot run.h5 theta \"theta'\" --each --from 2 --to 5\n"
                   "          anholon plot run.h5 y --x x --title \"path of the contact\"\n"
                   "          anholon plot run.h5 other.h5 theta             theta of both, one over the other\n"
                   "          anholon plot run.h5 'lambda.*' -o forces.pdf --size 8cmx5cm\n"
                   "          anholon plot falls/ outcome -o falls.svg       cells over the two that vary\n"
                   "          anholon plot falls/ -o falls.html --motions 24  a page with the motions of 24 cases\n"
                   "          anholon plot cases.csv --histogram theta -o theta.svg");
  c->add_option("RUN", o.run,
                "a run: " + known_files("FILE") +
                    ", or - for what comes through a pipe; or a sweep: a folder, a .csv or .parquet file")
      ->required();
  c->add_option("COLUMN", o.columns,
                "names of columns, or patterns; the names of further runs, whose curves lie over those of the first");
  c->add_option("--x", o.abscissa,
                "the column along the horizontal axis (default: t; of a sweep the first that varies, or t if cases "
                "have several rows)")
      ->type_name("COLUMN");
  c->add_option(
       "--y", o.ordinate,
       "of a sweep: the column along the vertical axis (default: the second that varies); none: curves over --x")
      ->type_name("COLUMN");
  c->add_option("--histogram", o.histogram, "of a sweep: how often the numbers or words of this column occur")
      ->type_name("COLUMN");
  c->add_option(
       "--motions", o.motions,
       "of a sweep in a folder, with -o FILE.html: the page holds the motions of so many cases, spread over the "
       "map")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  c->add_option("--from", o.from, "no rows before this time")->type_name("T");
  c->add_option("--to", o.to, "no rows after this time")->type_name("T");
  c->add_flag("--log", o.log, "logarithmic vertical axis; what is not positive is left out");
  c->add_flag("--equal", o.equal, "one unit is as long along both axes, for paths: plot run.h5 y --x x --equal");
  c->add_flag("--together", o.together, "all columns in one panel (the default)");
  c->add_flag("--each", o.each, "a panel for each column");
  c->add_option("--labels", o.labels,
                "unicode (θ̇), latex ($\\dot{\\theta}$, for programs that set it) or plain (theta')")
      ->type_name("STYLE")
      ->check(CLI::IsMember({"unicode", "latex", "plain"}));
  c->add_option("--title", o.title, "above the figure")->type_name("TEXT");
  c->add_option("--size", o.size,
                "of a figure: 8cmx5cm (cm, mm, in, pt; default 16cmx9cm); in the terminal: 100x30, columns and rows")
      ->type_name("WxH");
  c->add_flag("--json", o.json, "JSON on the standard output: what is drawn, and between which numbers");
  c->add_option(
       "-o,--output", o.output,
       "FILE.svg, FILE.pdf, FILE.png or FILE.tex (pgfplots); of a sweep FILE.html, too, whose cells tell their "
       "cases")
      ->type_name("FILE");
}

}  // namespace anholon::cli
