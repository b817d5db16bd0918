#include "plot/drawing.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "base/diagnostic.h"
#include "base/escape.h"

namespace anholon::plot {

const char* const kColour[kColours] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                       "#e69f00", "#56b4e9", "#000000", "#8c564b"};

const Dash kDash[kDashes] = {{"", "", {}},
                             {"dashed", "dashed", {4, 2}},
                             {"dotted", "dotted", {1.2, 1.8}},
                             {"mixed", "dash dot", {6, 2, 1.2, 2}}};
const Dash& dash_of(std::size_t series) { return kDash[series / kColours % kDashes]; }

namespace {

constexpr double kPointsPerCm = 72 / 2.54;
constexpr double kSize = 9, kSmall = 8;  // the sizes of words
constexpr double kLetter = 0.62;         // mean width of a letter, relative to its size
constexpr double kTick = 3, kGap = 4,
                 kEntry = 18;  // marks at ticks; gaps; the line of an entry of the legend

double width_of(const std::string& text, double size) {
  return kLetter * size * static_cast<double>(shown_width(text));
}

double width_of(const RichText& text, double size) {
  double width = 0;
  for (const TextPiece& p : text) width += (p.sub ? 0.7 : 1) * width_of(p.text, size);
  return width;
}

RichText minus_signs(std::string label) {
  if (!label.empty() && label[0] == '-') label.replace(0, 1, "−");
  return {{label}};
}

// Breaks a text into lines that are not longer than `width`, except single words.
std::vector<std::string> lines_of(const std::string& text, double size, double width) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::string& line = lines.back();
    const std::string longer = line.empty() ? word : line + " " + word;
    if (line.empty() || width_of(longer, size) <= width)
      line = longer;
    else
      lines.push_back(word);
  }
  return lines;
}

// Returns the outline of a dot of visible size.
std::vector<Point> dot(Point at) {
  constexpr double kRadius = 1;
  return {{at.x - kRadius, at.y}, {at.x, at.y - kRadius}, {at.x + kRadius, at.y},
          {at.x, at.y + kRadius}, {at.x - kRadius, at.y}, {at.x + kRadius, at.y}};
}

class Layout {
 public:
  explicit Layout(const Figure& f) : own_(f.equal ? std::optional<Figure>(f) : std::nullopt), f_(own_ ? *own_ : f) {
    d_.width = f.width * kPointsPerCm;
    d_.height = f.height * kPointsPerCm;
  }

  Drawing make() {
    double top = kGap, bottom = d_.height - kGap;
    if (!f_.title.empty()) {
      for (const std::string& line : lines_of(shown(f_.title), kSize + 1, d_.width - 2 * kGap)) {
        d_.words.push_back({{d_.width / 2, top + kSize}, {{line}}, kSize + 1, Anchor::middle});
        top += kSize + 1 + 0.5 * kGap;
      }
      top += kGap;
    }
    bottom -= 0.35 * kSize;
    d_.words.push_back({{0, bottom}, rich_label(f_.x_name, f_.x_unit, f_.labels), kSize, Anchor::middle});
    const std::size_t x_word = d_.words.size() - 1;
    bottom -= kSize + 0.5 * kGap;
    tick_line_ = bottom;
    bottom -= kSmall + kTick + 0.5;

    // All panels start at the same left edge, below one another.
    const double each = (bottom - top) / static_cast<double>(f_.panels.size());
    std::vector<Ticks> y_ticks = scales(each);
    // The box is as wide as the labels of its ticks allow; the first round finds their width.
    for (int round = 0; own_ && round < 2; ++round) {
      make_equal(*own_, right_ - left_, box_ = box_height(each));
      const double left = left_;
      y_ticks = scales(each);
      if (round == 1) left_ = left;
    }
    x_ticks_ = ticks(f_.x_axis, static_cast<int>(d_.width / 55));
    d_.words[x_word].at.x = (left_ + right_) / 2;
    if (!x_ticks_.note.empty())
      d_.words.push_back({{right_, d_.words[x_word].at.y}, {{x_ticks_.note}}, kSmall, Anchor::end});
    for (std::size_t i = 0; i < f_.panels.size(); ++i) {
      const double from = top + each * static_cast<double>(i);
      panel(f_.panels[i], y_ticks[i], from, from + each - (i + 1 < f_.panels.size() ? 1.5 * kGap : 0),
            i + 1 == f_.panels.size());
    }
    return std::move(d_);
  }

 private:
  // Returns a height of a panel that is certainly left under its legend.
  double box_height(double each) const {
    std::size_t most = 1;
    for (const Panel& p : f_.panels) most = std::max(most, p.series.size());
    constexpr std::size_t kEntriesOfALine = 3;
    const double lines = most > 1 ? static_cast<double>((most + kEntriesOfALine - 1) / kEntriesOfALine) : 0;
    return std::max(10.0, each - (lines + 1) * (kSmall + kGap) - 3.5 * kGap);
  }

  // Computes the ticks of all panels, and the left and right ends of their boxes.
  std::vector<Ticks> scales(double each) {
    std::vector<Ticks> y_ticks;
    double labels = 0;
    bool any_word = false;
    for (const Panel& p : f_.panels) {
      y_ticks.push_back(ticks(p.y, std::max(2, static_cast<int>(each / 28))));
      for (const std::string& l : y_ticks.back().labels) labels = std::max(labels, width_of(l, kSmall));
      any_word = any_word || p.series.size() == 1;
    }
    left_ = kGap + (any_word ? kSize * 1.3 + kGap : 0) + labels + kTick + 2;
    right_ = d_.width - 2.5 * kGap;
    return y_ticks;
  }

  void line(Point a, Point b, Role role) { d_.strokes.push_back({{a, b}, role, 0}); }

  // Draws one line of entries, or more for long ones; returns the top of the box.
  double legend(const Panel& p, double top) {
    double x = left_, y = top + kSmall;
    for (const Series& s : p.series) {
      const RichText text = series_label(s, f_.labels);
      const double width = kEntry + kGap + width_of(text, kSmall) + 2.5 * kGap;
      if (x > left_ && x + width > right_ + 2.5 * kGap) x = left_, y += kSmall + kGap;
      d_.strokes.push_back({{{x, y - 0.32 * kSmall}, {x + kEntry, y - 0.32 * kSmall}}, Role::series, s.number});
      d_.words.push_back({{x + kEntry + kGap, y}, text, kSmall});
      x += width;
    }
    return y + 1.5 * kGap;
  }

  void panel(const Panel& p, const Ticks& y_ticks, double top, double bottom, bool last) {
    if (!y_ticks.note.empty()) {
      d_.words.push_back({{left_, top + kSmall}, minus_signs(y_ticks.note), kSmall});
      top += kSmall + kGap;
    }
    if (p.series.size() > 1) {
      top = legend(p, top);
    } else {
      d_.words.push_back(
          {{kGap + kSize, (top + bottom) / 2}, series_label(p.series[0], f_.labels), kSize, Anchor::middle, true});
      top += kGap;
    }
    constexpr double kLeast = 20;  // the least length of both sides of a box
    const double height = own_ ? box_ : bottom - top, width = right_ - left_;
    if (height < kLeast || width < kLeast)
      throw Failure(Span{},
                    "a figure of this size has no room for its " +
                        std::string(f_.panels.size() > 1 ? "panels" : "curves") + " beside their labels",
                    "a larger --size, fewer columns, or without --title");
    if (own_)
      top = bottom - height;
    else
      bottom = top + height;
    for (std::size_t i = 0; i < x_ticks_.at.size(); ++i) {
      const double x = left_ + width * f_.x_axis.place(x_ticks_.at[i]);
      line({x, top}, {x, bottom}, Role::grid);
      line({x, bottom}, {x, bottom + kTick}, Role::axis);
      if (last) d_.words.push_back({{x, tick_line_}, minus_signs(x_ticks_.labels[i]), kSmall, Anchor::middle});
    }
    for (std::size_t i = 0; i < y_ticks.at.size(); ++i) {
      const double y = bottom - height * p.y.place(y_ticks.at[i]);
      line({left_, y}, {right_, y}, Role::grid);
      line({left_ - kTick, y}, {left_, y}, Role::axis);
      d_.words.push_back({{left_ - kTick - 2, y + 0.36 * kSmall}, minus_signs(y_ticks.labels[i]), kSmall, Anchor::end});
    }
    d_.strokes.push_back(
        {{{left_, top}, {right_, top}, {right_, bottom}, {left_, bottom}, {left_, top}}, Role::axis, 0});
    // The decimation uses more points than there are points of paper: finer than print.
    constexpr double kFiner = 4;
    for (const Series& s : p.series)
      for (auto& piece : curve(f_, p, s, kFiner * width, kFiner * height)) {
        for (Point& q : piece) q = {left_ + q.x / kFiner, bottom - q.y / kFiner};
        // A single point is drawn as a dot.
        if (piece.size() == 1) piece = dot(piece[0]);
        d_.strokes.push_back({std::move(piece), Role::series, s.number});
      }
  }

  std::optional<Figure> own_;  // a copy with equal axes
  const Figure& f_;
  Drawing d_;
  Ticks x_ticks_;
  double left_ = 0, right_ = 0, tick_line_ = 0, box_ = 0;
};

}  // namespace

Drawing lay_out(const Figure& figure) { return Layout(figure).make(); }

}  // namespace anholon::plot
