#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <sys/ioctl.h>
#include <unistd.h>

#include "api/pictures/sweep_cases.h"
#include "api/pictures/sweep_picture.h"
#include "base/json.h"
#include "cli/motions/result_file.h"
#include "cli/motions/run_formulas.h"
#include "cli/pictures/sweep_page.h"
#include "cli/say.h"
#include "plot/drawing.h"
#include "plot/terminal.h"
#include "result/file.h"
#include "setup/choice.h"

namespace anholon::cli {

namespace {

// Returns the height of a figure in cm: room for all panels, one below the other.
double height_of(std::size_t panels) {
  constexpr double kPlain = 9, kComfortable = 3.5, kPage = 26, kLeast = 1.9;
  const auto n = static_cast<double>(panels);
  return std::max({kPlain, std::min(kPage, kComfortable * n), kLeast * n});
}

using namespace anholon::plot;

enum class Target { terminal, svg, pdf, png, tex, html };

Target target(const std::string& path) {
  if (path.empty()) return Target::terminal;
  const std::size_t dot = path.rfind('.');
  const std::string end = dot == std::string::npos ? "" : path.substr(dot + 1);
  for (const auto& [name, t] : {std::pair{"svg", Target::svg},
                                {"pdf", Target::pdf},
                                {"png", Target::png},
                                {"tex", Target::tex},
                                {"html", Target::html}})
    if (end == name) return t;
  throw UsageError{"error: a figure '" + path +
                   "' cannot be drawn\nhint: a name that ends in .svg, .pdf, .png or .tex\n"};
}

struct Length {
  double value = 0;
  bool paper = false;  // in cm
};

// Reads "8cm", "80"; nullopt if the text is not a length.
std::optional<Length> length(const std::string& text) {
  Length l;
  const auto r = std::from_chars(text.data(), text.data() + text.size(), l.value);
  if (r.ec != std::errc() || !(l.value > 0)) return std::nullopt;
  const std::string unit(r.ptr, text.data() + text.size());
  if (unit.empty()) return l;
  l.paper = true;
  for (const auto& [name, cm] : {std::pair{"cm", 1.0}, {"mm", 0.1}, {"in", 2.54}, {"pt", 2.54 / 72}})
    if (unit == name) {
      l.value *= cm;
      return l;
    }
  return std::nullopt;
}

// Reads WIDTHxHEIGHT, lengths on paper for a figure or characters for the terminal, into the options of the target.
void take_size(const std::string& text, Target t, FigureOptions& figure, TerminalSize& terminal) {
  if (text.empty()) return;
  const std::size_t x = text.find('x');
  const auto wrong = [&](const std::string& what) {
    throw UsageError{"error: --size " + text + ": " + what +
                     "\nhint: --size 8cmx5cm for a figure, --size 100x30 (columns, rows) in the terminal\n"};
  };
  if (x == std::string::npos) wrong("not of the form WIDTHxHEIGHT");
  const auto w = length(text.substr(0, x)), h = length(text.substr(x + 1));
  if (!w || !h || w->paper != h->paper) wrong("not two lengths");
  if (t == Target::terminal) {
    if (w->paper) wrong("a terminal has columns and rows");
    if (w->value < 20 || w->value > 1000 || h->value < 2 || h->value > 1000) wrong("from 20x2 to 1000x1000");
    terminal.columns = static_cast<int>(w->value);
    terminal.rows = static_cast<int>(h->value);
  } else {
    if (!w->paper) wrong("a figure has lengths");
    if (w->value < 2 || w->value > 200 || h->value < 1.5 || h->value > 200) wrong("from 2cmx1.5cm to 200cmx200cm");
    figure.width = w->value;
    figure.height = h->value;
  }
}

double time(const std::string& text, const char* option) {
  return time_value(constant(text, option), std::string(option) + ": ").get_d();
}

bool colours() {
  const char* no = std::getenv("NO_COLOR");
  const char* kind = std::getenv("TERM");
  return isatty(1) && !(no && *no) && !(kind && std::strcmp(kind, "dumb") == 0);
}

// Returns the size of the terminal, or COLUMNS x LINES; `rows` is the height of one of `panels` boxes.
TerminalSize terminal_size(std::size_t panels) {
  TerminalSize size;
  int lines = 26;
  winsize w{};
  if (isatty(1) && ioctl(1, TIOCGWINSZ, &w) == 0 && w.ws_col > 0) {
    size.columns = w.ws_col;
    if (w.ws_row > 0) lines = w.ws_row;
  } else if (const char* columns = std::getenv("COLUMNS")) {
    if (const int n = std::atoi(columns); n > 0) size.columns = n;
  }
  size.columns = std::clamp(size.columns, 30, 500);
  // kBeside: rows for the legend, the axis, its labels, its name and the prompt.
  constexpr int kBeside = 6, kLeast = 6, kMost = 30;
  size.rows = panels > 1 ? std::clamp((lines - kBeside) / static_cast<int>(panels) - 2, kLeast, kMost)
                         : std::clamp(lines - kBeside, 2 * kLeast, kMost);
  size.colours = colours();
  return size;
}

std::string ranges(const Figure& f) {
  JsonWriter j;
  const auto range = [&](double from, double to) {
    j.open_array().number(number_text(from)).number(number_text(to)).close();
  };
  const auto least_and_greatest = [&](const std::vector<double>& v) {
    double least = INFINITY, greatest = -INFINITY;
    for (const double x : v)
      if (std::isfinite(x)) least = std::min(least, x), greatest = std::max(greatest, x);
    range(least, greatest);
  };
  j.open_object().key("x").open_object().key("name").string(f.x_name).key("axis");
  range(f.x_axis.from, f.x_axis.to);
  j.key("range");
  std::vector<double> all_x = f.x;
  for (const Panel& p : f.panels)
    for (const Series& s : p.series) all_x.insert(all_x.end(), s.x.begin(), s.x.end());
  least_and_greatest(all_x);
  j.close().key("rows").integer(static_cast<long long>(f.rows)).key("panels").open_array();
  for (const Panel& p : f.panels) {
    j.open_object().key("axis");
    range(p.y.from, p.y.to);
    j.key("series").open_array();
    for (const Series& s : p.series) {
      j.open_object().key("name").string(s.name);
      if (!s.of.empty()) j.key("of").string(s.of);
      j.key("label").string(series_text(s, f.labels)).key("range");
      least_and_greatest(s.y);
      j.close();
    }
    j.close().close();
  }
  j.close().close();
  return j.text() + "\n";
}

std::string write_drawing(const Drawing& d, const std::string& title, Target t, const std::string& path) {
  if (t == Target::svg) return write_whole(path, draw_svg(d, title));
  return write_whole_by_name(path, [&](const std::string& beside) {
    const std::string why = draw_cairo(d, title, t == Target::pdf ? CairoFormat::pdf : CairoFormat::png, beside);
    return why.empty() ? why : "cannot write " + path + ": " + why;
  });
}

std::string write_figure(const Figure& f, Target t, const std::string& path) {
  if (t == Target::tex) return write_whole(path, draw_tex(f));
  return t == Target::terminal ? std::string() : write_drawing(lay_out(f), f.title, t, path);
}

// Draws a sweep as a map or a histogram. If it is drawn as curves, returns them as runs and sets the options.
std::vector<NamedRun> drawn_sweep(const PlotCommand& o, Target t, FigureOptions& options) {
  const auto must_be_written = [](const std::string& why) {
    if (!why.empty()) throw UsageError{"error: " + why + "\n"};
  };
  v1::SweepPicture picture = v1::picture_of_sweep(
      v1::SweepCases(o.run), {split(o.columns), o.abscissa, o.ordinate, o.histogram, o.title, "--"});
  if (!picture.note.empty())
    say(stderr, "note: %s holds %s; what is missing is left empty\n", o.run.c_str(), picture.note.c_str());
  const auto draw = [&](auto& drawn) {
    drawn.labels = options.labels;
    if (!o.size.empty()) drawn.width = options.width, drawn.height = options.height;
    must_be_written(write_drawing(lay_out(drawn), drawn.title, t, o.output));
  };
  if (!(o.from.empty() && o.to.empty()) && (picture.map || picture.histogram || picture.options.x != "t"))
    throw UsageError{
        "error: --from and --to belong to curves over t\nhint: leave them out; --at of the sweep chooses its "
        "times\n"};
  if (picture.map || picture.histogram) {
    if (t == Target::terminal || t == Target::tex)
      throw UsageError{
          "error: a map or a histogram of a sweep is drawn as .svg, .pdf, .png or .html\nhint: -o falls.svg\n"};
    if (o.log)
      throw UsageError{"error: --log belongs to curves: a map and a histogram have no logarithmic scale\n"
                       "hint: leave out --log\n"};
    picture.map ? draw(*picture.map) : draw(*picture.histogram);
    return {};
  }
  options.x = picture.options.x;
  options.names = picture.options.names;
  options.title = picture.options.title;
  options.smooth = false;
  return std::move(picture.curves);
}

// Reads the run o.run and the runs named in `columns`; removes their names from `columns`. A word names a run if it is
// a file name and no column of the run o.run.
std::vector<NamedRun> read_runs(const PlotCommand& o, std::vector<std::string>& columns) {
  std::vector<NamedRun> runs{{read_result(o.run), ""}};
  const RunTable first = runs[0].run.table;  // `runs` grows
  std::erase_if(columns, [&](const std::string& word) {
    std::error_code none;
    const bool file = std::filesystem::is_regular_file(word, none) ||
                      (format_of(word) && word.find_last_of('.') != std::string::npos);
    if (!file || first.find(word) < first.columns.size()) return false;
    if (v1::SweepCases::are_in(word))
      throw UsageError{"error: " + word +
                       " holds a sweep, and a figure of several files shows runs\nhint: anholon plot " + word +
                       " NAME -o sweep.svg\n"};
    runs.push_back({read_result(word), word});
    return true;
  });
  if (runs.size() > 1) runs[0].name = o.run;
  std::vector<std::string> names = columns;
  if (!o.abscissa.empty()) names.push_back(o.abscissa);
  for (NamedRun& each : runs) add_formulas(each.run, names);
  return runs;
}

}  // namespace

int plot(const PlotCommand& o) {
  const Target t = target(o.output);
  if ((t == Target::pdf || t == Target::png) && !no_cairo().empty())
    throw UsageError{"error: " + no_cairo() + "\nhint: -o figure.svg or -o figure.tex, or " + kCairoRemedy + "\n"};
  if (o.each && o.together) throw UsageError{"error: --together and --each exclude each other\n"};
  FigureOptions options;
  for (const std::string& name : split(o.columns)) options.names.push_back(name);
  options.x = o.abscissa;
  if (!o.from.empty()) options.from = time(o.from, "--from");
  if (!o.to.empty()) options.to = time(o.to, "--to");
  options.log = o.log;
  options.each = o.each;
  options.equal = o.equal;
  if (o.equal && o.log) throw UsageError{"error: --equal and --log exclude each other\n"};
  options.smooth = true;
  options.title = o.title;
  options.labels = o.labels == "latex"   ? LabelStyle::latex
                   : o.labels == "plain" ? LabelStyle::plain
                                         : LabelStyle::unicode;
  TerminalSize given;
  given.rows = 0;
  take_size(o.size, t, options, given);

  const bool of_sweep = v1::SweepCases::are_in(o.run);
  if (!of_sweep && !o.ordinate.empty())
    throw UsageError{"error: --y belongs to a sweep\nhint: anholon plot run.h5 NAME\n"};
  if (!of_sweep && !o.histogram.empty())
    throw UsageError{
        "error: --histogram belongs to a sweep\nhint: anholon plot falls/ --histogram theta -o theta.svg\n"};
  if (!of_sweep && t == Target::html)
    throw UsageError{
        "error: a page shows a sweep, or the motion of a model\nhint: anholon report MODEL -o page.html\n"};
  if (o.motions > 0 && t != Target::html)
    throw UsageError{
        "error: --motions belongs to a page of a sweep\nhint: anholon plot falls/ -o falls.html --motions 24\n"};
  if (t == Target::html && o.log)
    throw UsageError{
        "error: --log belongs to curves: a page of a sweep has no logarithmic scale\nhint: leave out --log\n"};
  if (t == Target::html && !(o.from.empty() && o.to.empty()))
    throw UsageError{
        "error: --from and --to belong to curves over t, and a page shows a sweep\nhint: leave them out\n"};
  if (t == Target::html) return write_page_of_sweep(o);
  std::vector<NamedRun> runs;
  if (of_sweep) {
    runs = drawn_sweep(o, t, options);
    if (runs.empty()) return kOk;
  } else {
    runs = read_runs(o, options.names);
  }
  Figure figure;
  try {
    figure = make_figure(runs, options);
  } catch (const Failure& e) {
    throw UsageError{"error: " + e.diagnostic.message +
                     (e.diagnostic.hint.empty() ? "" : "\nhint: " + e.diagnostic.hint) + "\n"};
  }
  if (t != Target::terminal) {
    if (o.size.empty() && figure.panels.size() > 1) figure.height = height_of(figure.panels.size());
    if (const std::string why = write_figure(figure, t, o.output); !why.empty())
      throw UsageError{"error: " + why + "\n"};
  } else if (!o.json) {
    TerminalSize size = terminal_size(figure.panels.size());
    if (given.rows > 0) size.columns = given.columns, size.rows = given.rows;
    draw(draw_terminal(figure, size));
  }
  if (o.json) hand_out(ranges(figure));
  return kOk;
}

}  // namespace anholon::cli
