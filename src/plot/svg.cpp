#include <charconv>
#include <cmath>
#include <cstdio>

#include "base/escape.h"
#include "plot/drawing.h"

namespace anholon::plot {

namespace {

// Writes a number with two decimals at most.
std::string number(double x) {
  char buffer[64];
  const auto r = std::to_chars(buffer, buffer + sizeof buffer, x, std::chars_format::fixed, 2);
  std::string s(buffer, r.ptr);
  while (s.back() == '0') s.pop_back();
  if (s.back() == '.') s.pop_back();
  return s == "-0" ? "0" : s;
}

std::string path(const std::vector<Point>& points) {
  std::string d;
  for (std::size_t i = 0; i < points.size(); ++i)
    d += (i == 0 ? "M" : i == 1 ? "L" : " ") + number(points[i].x) + " " + number(points[i].y);
  return d;
}

std::string class_of(const Stroke& s) {
  switch (s.role) {
  case Role::grid:
    return "grid";
  case Role::axis:
    return "axis";
  case Role::series:
    break;
  }
  const std::string dash = dash_of(s.series).css;
  return "s s" + std::to_string(s.series % kColours) + (dash.empty() ? "" : " ") + dash;
}

}  // namespace

std::string draw_svg(const Figure& figure) { return draw_svg(lay_out(figure), figure.title); }

std::string draw_svg(const Drawing& d, const std::string& title) {
  const std::string w = number(d.width), h = number(d.height);
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "pt\" height=\"" + h +
                    "pt\" viewBox=\"0 0 " + w + " " + h + "\" class=\"anholon-plot\">\n";
  if (!title.empty()) out += "<title>" + markup_escape(title) + "</title>\n";
  out += "<style>\n.anholon-plot{background:var(--paper,#fff)}\n.anholon-plot "
         "path{fill:none;stroke-linejoin:round}\n.anholon-plot .grid{stroke:var(--grid,#e4e4e4);stroke-width:.5}\n"
         ".anholon-plot .axis{stroke:var(--ink,#222);stroke-width:.6}\n.anholon-plot "
         ".s{stroke-width:1.1}\n";
  // Few figures have so many curves that they need more than the first dash.
  std::size_t dashes = 2;
  for (const Stroke& stroke : d.strokes)
    if (stroke.role == Role::series && stroke.series >= 2 * kColours) dashes = kDashes;
  for (std::size_t k = 1; k < dashes; ++k) {
    out += std::string(".anholon-plot .") + kDash[k].css + "{stroke-dasharray:";
    for (std::size_t i = 0; i < kDash[k].lengths(); ++i) out += (i == 0 ? "" : " ") + number(kDash[k].on_off[i]);
    out += "}\n";
  }
  out += ".anholon-plot text{fill:var(--ink,#222);font-family:var(--font,\"STIX Two Text\",\"Liberation "
         "Serif\",\"Times New Roman\",serif)}\n";
  for (std::size_t k = 0; k < kColours; ++k)
    out += ".anholon-plot .s" + std::to_string(k) + "{stroke:var(--s" + std::to_string(k) + "," + kColour[k] + ")}\n";
  out += "</style>\n";
  // The size of a patch is the difference of its rounded edges, so that patches that share an edge share it in the
  // picture, too.
  const auto rounded = [](double x) { return std::round(x * 100) / 100; };
  for (const Patch& p : d.patches) {
    char colour[8];
    std::snprintf(colour, sizeof colour, "#%06x", static_cast<unsigned>(p.rgb & 0xffffffU));
    const Point from = {rounded(p.from.x), rounded(p.from.y)}, to = {rounded(p.to.x), rounded(p.to.y)};
    out += "<rect x=\"" + number(from.x) + "\" y=\"" + number(from.y) + "\" width=\"" + number(to.x - from.x) +
           "\" height=\"" + number(to.y - from.y) + "\" fill=\"" + colour + "\" shape-rendering=\"crispEdges\"/>\n";
  }
  for (const Stroke& s : d.strokes) out += "<path class=\"" + class_of(s) + "\" d=\"" + path(s.points) + "\"/>\n";
  for (const Word& word : d.words) {
    const std::string at = number(word.at.x) + (word.upwards ? " " : "\" y=\"") + number(word.at.y);
    out += "<text " + (word.upwards ? "transform=\"translate(" + at + ") rotate(-90)\"" : "x=\"" + at + "\"") +
           " font-size=\"" + number(word.size) + "\"";
    if (word.anchor != Anchor::start)
      out += std::string(" text-anchor=\"") + (word.anchor == Anchor::middle ? "middle" : "end") + "\"";
    out += ">";
    bool low = false;
    for (const TextPiece& p : word.text) {
      const std::string text = markup_escape(plain_text({{p.text, false, false, p.dots}}));
      std::string style = p.italic ? " font-style=\"italic\"" : "";
      if (p.sub) style += " font-size=\"" + number(0.7 * word.size) + "\"";
      if (p.sub != low) style += " dy=\"" + number((p.sub ? 0.25 : -0.25) * word.size) + "\"";
      low = p.sub;
      out += style.empty() ? text : "<tspan" + style + ">" + text + "</tspan>";
    }
    out += "</text>\n";
  }
  return out + "</svg>\n";
}

}  // namespace anholon::plot
