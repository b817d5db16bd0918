#include <charconv>
#include <cmath>

#include "base/escape.h"
#include "plot/drawing.h"

namespace anholon::plot {

namespace {

std::string number(double x) {
  char buffer[64];
  const auto r = std::to_chars(buffer, buffer + sizeof buffer, x, std::chars_format::general, 8);
  return std::string(buffer, r.ptr);
}

// TeX computes with few digits, so rows are written unchanged, after a decimation that is invisible in print.
void series(std::string& out, const Figure& f, const Panel& p, const Series& s, std::size_t number_of) {
  constexpr double kDots = 1200;
  const auto back = [](const Axis& a, double place) {
    return a.log ? a.from * std::pow(a.to / a.from, place) : a.from + (a.to - a.from) * place;
  };
  bool first = true;
  for (const auto& piece : curve(f, p, s, kDots, kDots)) {
    out += "\\addplot[color=anholon" + std::to_string(s.number % kColours) + (*dash_of(s.number).pgf ? ", " : "") +
           dash_of(s.number).pgf + (first ? "" : ", forget plot") + "] coordinates {\n";
    std::string line;
    for (const Point& q : piece) {
      const std::string pair = "(" + number(back(f.x_axis, q.x / kDots)) + "," + number(back(p.y, q.y / kDots)) + ")";
      if (line.size() + pair.size() > 110) out += line + "\n", line.clear();
      line += pair;
    }
    out += line + "\n};\n";
    first = false;
  }
  if (number_of > 1) out += "\\addlegendentry{" + series_latex(s) + "}\n";
}

}  // namespace

std::string draw_tex(const Figure& f) {
  std::string out = "% In the preamble: \\usepackage{pgfplots} \\pgfplotsset{compat=1.16} "
                    "\\usepgfplotslibrary{groupplots}; then \\input{THIS FILE}\n";
  for (std::size_t k = 0; k < kColours; ++k) {
    std::string hex = kColour[k] + 1;
    for (char& c : hex) c = static_cast<char>(c >= 'a' && c <= 'f' ? c - 'a' + 'A' : c);
    out += "\\definecolor{anholon" + std::to_string(k) + "}{HTML}{" + hex + "}\n";
  }
  const std::size_t n = f.panels.size();
  out +=
      "\\begin{tikzpicture}\n\\begin{groupplot}[\n  group style={group size=1 by " + std::to_string(n) +
      ", x descriptions at=edge bottom, vertical sep=6pt},\n  width=" + number(f.width) +
      "cm, height=" + number(f.height / static_cast<double>(n)) + "cm, " + (f.equal ? "axis equal, " : "") +
      "grid=major, grid style={gray!20}, no markers,\n  every axis plot/.append style={line width=0.6pt},\n  xlabel={" +
      latex_label(f.x_name, f.x_unit) + "}, xmin=" + number(f.x_axis.from) + ", xmax=" + number(f.x_axis.to) +
      ",\n  legend style={draw=none, fill=none, at={(0.5,1.02)}, anchor=south, legend columns=-1, /tikz/every even "
      "column/.append style={column sep=6pt}},\n]\n";
  for (std::size_t i = 0; i < n; ++i) {
    const Panel& p = f.panels[i];
    std::string options;
    const auto add = [&](const std::string& o) { options += (options.empty() ? "" : ", ") + o; };
    if (i == 0 && !f.title.empty()) add("title={" + latex_escape(f.title) + "}");
    if (p.series.size() == 1) add("ylabel={" + series_latex(p.series[0]) + "}");
    if (p.y.log) add("ymode=log");
    out += "\\nextgroupplot" + (options.empty() ? "" : "[" + options + "]") + "\n";
    for (const Series& s : p.series) series(out, f, p, s, p.series.size());
  }
  return out + "\\end{groupplot}\n\\end{tikzpicture}\n";
}

}  // namespace anholon::plot
