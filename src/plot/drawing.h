// A figure laid out on paper: lines and words with their places, in points of 1/72 inch, y downwards. What draws it
// needs to know nothing of axes.
#pragma once
#include "plot/figure.h"

namespace anholon::plot {

enum class Role : std::uint8_t { grid, axis, series };
enum class Anchor : std::uint8_t { start, middle, end };

struct Stroke {
  std::vector<Point> points;
  Role role = Role::axis;
  std::size_t series = 0;  // which colour
};

struct Word {
  Point at;  // on the base line
  RichText text;
  double size = 9;
  Anchor anchor = Anchor::start;
  bool upwards = false;
};

struct Drawing {
  double width = 0, height = 0;
  std::vector<Stroke> strokes;
  std::vector<Word> words;
};

Drawing lay_out(const Figure& figure);

// Colours that also colour-blind readers tell apart (Okabe and Ito); they repeat, then dashed.
inline constexpr std::size_t kColours = 8;
extern const char* const kColour[kColours];

// An SVG of its own, on which a page can set colours: classes s0 … s7, axis, grid, words; variables --s0 …, --ink,
// --grid, --paper.
std::string draw_svg(const Figure& figure);
// An axis of pgfplots, to be \input.
std::string draw_tex(const Figure& figure);

enum class CairoFormat { pdf, png };
bool has_cairo();
extern const char* const kNoCairo;
// Empty, or why the file could not be written.
std::string draw_cairo(const Figure& figure, CairoFormat format, const std::string& path);

}  // namespace anholon::plot
