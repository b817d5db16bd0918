// A figure laid out on paper: lines and words with their positions, in points of 1/72 inch, y downwards. The drawing
// functions do not know axes.
#pragma once
#include <array>
#include <cstdint>

#include "plot/figure.h"

namespace anholon::plot {

enum class Role : std::uint8_t { grid, axis, series };
enum class Anchor : std::uint8_t { start, middle, end };

struct Stroke {
  std::vector<Point> points;
  Role role = Role::axis;
  std::size_t series = 0;  // index of the colour
};

struct Word {
  Point at;  // on the base line
  RichText text;
  double size = 9;
  Anchor anchor = Anchor::start;
  bool upwards = false;
};

// A filled rectangle, below the lines.
struct Patch {
  Point from, to;         // opposite corners
  std::uint32_t rgb = 0;  // 0xrrggbb
};

struct Drawing {
  double width = 0, height = 0;
  std::vector<Patch> patches;
  std::vector<Stroke> strokes;
  std::vector<Word> words;
};

Drawing lay_out(const Figure& figure);

// Colours that colour-blind readers can distinguish (Okabe and Ito); they repeat with other dashes.
inline constexpr std::size_t kColours = 8;
extern const char* const kColour[kColours];
struct Dash {
  const char *css, *pgf;         // a class of the SVG, a style of pgfplots; empty for a solid line
  std::array<double, 4> on_off;  // lengths in points; 0 ends them
  std::size_t lengths() const { return on_off[0] == 0 ? 0 : on_off[2] == 0 ? 2 : 4; }
};
// Returns the dash of the curve with this number.
const Dash& dash_of(std::size_t series);
inline constexpr std::size_t kDashes = 4;
extern const Dash kDash[kDashes];

// A complete SVG whose colours a page can set: classes s0 … s7, axis, grid, words; variables --s0 …, --ink, --grid,
// --paper.
std::string draw_svg(const Figure& figure);
std::string draw_svg(const Drawing& drawing, const std::string& title);
// Returns an axis of pgfplots, to be \input.
std::string draw_tex(const Figure& figure);

enum class CairoFormat { pdf, png };
// no_cairo(): the reason why this program cannot draw these formats here; empty if it can. kCairoRemedy: what to do
// then.
const std::string& no_cairo();
extern const char* const kCairoRemedy;
// Returns an empty string, or the reason why the file could not be written.
std::string draw_cairo(const Figure& figure, CairoFormat format, const std::string& path);
std::string draw_cairo(const Drawing& drawing, const std::string& title, CairoFormat format, const std::string& path);

}  // namespace anholon::plot
