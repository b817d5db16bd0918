#include "plot/heat_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "base/diagnostic.h"

namespace anholon::plot {

namespace {

constexpr double kLabelSize = 9, kMarkSize = 8, kMapGap = 4, kMapTick = 3, kLetterWidth = 0.62;

// Points of the colour map viridis, from its least number to its greatest.
constexpr std::uint32_t kScale[] = {0x440154, 0x482878, 0x3e4989, 0x31688e, 0x26828e,
                                    0x1f9e89, 0x35b779, 0x6ece58, 0xb5de2b, 0xfde725};

std::uint32_t scale_colour(double place) {
  constexpr std::size_t kSteps = std::size(kScale) - 1;
  const double at = std::clamp(place, 0.0, 1.0) * static_cast<double>(kSteps);
  const std::size_t k = std::min(static_cast<std::size_t>(at), kSteps - 1);
  std::uint32_t rgb = 0;
  for (const unsigned shift : {16U, 8U, 0U}) {
    const double a = kScale[k] >> shift & 255U, b = kScale[k + 1] >> shift & 255U;
    rgb |= static_cast<std::uint32_t>(std::lround(a + (b - a) * (at - static_cast<double>(k)))) << shift;
  }
  return rgb;
}

// Returns the cell of each row along one axis, and leaves the middles of the cells in the column.
std::vector<std::size_t> cells_along(NamedColumn& c) {
  std::vector<double> different = c.points;
  for (const double v : c.values)
    if (std::isfinite(v)) different.push_back(v);
  std::sort(different.begin(), different.end());
  different.erase(std::unique(different.begin(), different.end()), different.end());
  if (different.empty()) throw Failure({}, "no case has a value of '" + c.name + "'");
  std::vector<std::size_t> cells;
  if (different.size() > kMostCells) {
    const double from = different.front(), width = (different.back() - from) / static_cast<double>(kMostCells);
    for (const double v : c.values)
      cells.push_back(std::isfinite(v) ? std::min(static_cast<std::size_t>((v - from) / width), kMostCells - 1)
                                       : kMostCells);
    different.resize(kMostCells);
    for (std::size_t k = 0; k < kMostCells; ++k) different[k] = from + (static_cast<double>(k) + 0.5) * width;
  } else {
    for (const double v : c.values)
      cells.push_back(
          std::isfinite(v)
              ? static_cast<std::size_t>(std::lower_bound(different.begin(), different.end(), v) - different.begin())
              : different.size());
  }
  c.values = std::move(different);
  return cells;
}

// Returns the borders of cells with these middles.
std::vector<double> borders(const std::vector<double>& middles) {
  if (middles.size() == 1) return {middles[0] - 0.5, middles[0] + 0.5};
  std::vector<double> list{middles[0] - (middles[1] - middles[0]) / 2};
  for (std::size_t k = 1; k < middles.size(); ++k) list.push_back((middles[k - 1] + middles[k]) / 2);
  list.push_back(middles.back() + (middles.back() - middles[middles.size() - 2]) / 2);
  return list;
}

class MapLayout {
 public:
  explicit MapLayout(const HeatMap& m) : m_(m) {
    d_.width = m.width * kPointsInCm, d_.height = m.height * kPointsInCm;
    const auto see = [&](double v) {
      if (std::isfinite(v)) least_ = std::min(least_, v), greatest_ = std::max(greatest_, v);
    };
    for (const double v : m.values) see(v);
    for (const HeatMap::Finer& f : m.finer) see(f.value);
    if (!(least_ < greatest_)) greatest_ = least_ + 1;
  }

  Drawing make() {
    top_ = kMapGap;
    if (!m_.title.empty()) {
      word({d_.width / 2, top_ + kLabelSize}, {{m_.title}}, kLabelSize + 1, Anchor::middle);
      top_ += kLabelSize + 1 + 2 * kMapGap;
    }
    bottom_ = d_.height - kMapGap - 2 * kLabelSize - kMarkSize;
    const std::vector<double> xs = borders(m_.x.values), ys = borders(m_.y.values);
    x_ = range(m_.x.values, xs), y_ = range(m_.y.values, ys);
    const Ticks y_ticks = ticks(y_, static_cast<int>((bottom_ - top_) / 28));
    left_ = 2 * kMapGap + 1.3 * kLabelSize + widest(y_ticks.labels) + kMapTick;
    right_ = d_.width - 2.5 * kMapGap;
    m_.words.empty() ? bar() : legend();
    cells(xs, ys);
    axes(y_ticks);
    return std::move(d_);
  }

 private:
  // Returns the range of an axis. The cells of further generations lie between the first and the last value, and so
  // does the map.
  Axis range(const std::vector<double>& values, const std::vector<double>& ends) const {
    return m_.finer.empty() || values.size() < 2 ? Axis{ends.front(), ends.back()}
                                                 : Axis{values.front(), values.back()};
  }
  static double widest(const std::vector<std::string>& labels) {
    double width = 0;
    for (const std::string& l : labels)
      width = std::max(width, kLetterWidth * kMarkSize * static_cast<double>(shown_width(l)));
    return width;
  }
  void word(Point at, RichText text, double size, Anchor anchor, bool upwards = false) {
    d_.words.push_back({at, std::move(text), size, anchor, upwards});
  }
  void box(Point a, Point b) { d_.strokes.push_back({{a, {b.x, a.y}, b, {a.x, b.y}, a}, Role::axis, 0}); }
  double x_at(double x) const { return left_ + (right_ - left_) * x_.place(x); }
  double y_at(double y) const { return bottom_ - (bottom_ - top_) * y_.place(y); }

  // Draws the words and their colours, in lines above the cells.
  void legend() {
    double x = left_, y = top_ + kMarkSize;
    for (std::size_t k = 0; k < m_.words.size(); ++k) {
      const std::string text = m_.words[k].empty() ? "none" : m_.words[k];
      const double width = kMarkSize + 3 * kMapGap + kLetterWidth * kMarkSize * static_cast<double>(shown_width(text));
      if (x > left_ && x + width > right_) x = left_, y += kMarkSize + kMapGap;
      d_.patches.push_back({{x, y - 0.8 * kMarkSize}, {x + kMarkSize, y + 0.2 * kMarkSize}, colour_of_word(k)});
      word({x + kMarkSize + kMapGap, y}, {{text}}, kMarkSize, Anchor::start);
      x += width;
    }
    top_ = y + 2 * kMapGap;
  }

  // Draws the scale of the numbers, at the right of the cells.
  void bar() {
    const Axis axis{least_, greatest_};
    const Ticks marks = ticks(axis, static_cast<int>((bottom_ - top_) / 28));
    const double width = 10, end = d_.width - 2 * kMapGap - 1.3 * kLabelSize - widest(marks.labels) - kMapTick,
                 from = end - width;
    constexpr int kPatches = 64;
    const double high = (bottom_ - top_) / kPatches;
    for (int k = 0; k < kPatches; ++k)
      d_.patches.push_back(
          {{from, bottom_ - (k + 1) * high}, {end, bottom_ - k * high}, scale_colour((k + 0.5) / kPatches)});
    box({from, top_}, {end, bottom_});
    for (std::size_t k = 0; k < marks.at.size(); ++k) {
      const double y = bottom_ - (bottom_ - top_) * axis.place(marks.at[k]);
      d_.strokes.push_back({{{end, y}, {end + kMapTick, y}}, Role::axis, 0});
      word({end + kMapTick + 2, y + 0.36 * kMarkSize}, {{marks.labels[k]}}, kMarkSize, Anchor::start);
    }
    RichText label = rich_label(m_.name, m_.unit, m_.labels);
    if (!marks.note.empty()) label.push_back({" " + marks.note});
    word({d_.width - kMapGap, (top_ + bottom_) / 2}, std::move(label), kLabelSize, Anchor::middle, true);
    right_ = from - 3 * kMapGap;
  }

  void cells(const std::vector<double>& xs, const std::vector<double>& ys) {
    const std::size_t columns = m_.x.values.size();
    for (std::size_t k = 0; k < m_.y.values.size(); ++k) {
      // Neighbours of one colour in a row become one patch.
      bool open = false;
      for (std::size_t i = 0; i < columns; ++i) {
        const double v = m_.values[k * columns + i];
        if (!std::isfinite(v)) {
          open = false;
          continue;
        }
        const std::uint32_t rgb = colour(v);
        if (open && d_.patches.back().rgb == rgb)
          d_.patches.back().to.x = std::min(x_at(xs[i + 1]), right_);
        else
          patch({xs[i], ys[k]}, {xs[i + 1], ys[k + 1]}, rgb);
        open = true;
      }
    }
    for (const HeatMap::Finer& f : m_.finer) patch(f.from, f.to, colour(f.value));
  }
  // Draws the part of a cell with these corners that lies within the map.
  void patch(Point from, Point to, std::uint32_t rgb) {
    d_.patches.push_back({{std::max(x_at(from.x), left_), std::max(y_at(to.y), top_)},
                          {std::min(x_at(to.x), right_), std::min(y_at(from.y), bottom_)},
                          rgb});
  }
  std::uint32_t colour(double v) const {
    return m_.words.empty() ? scale_colour((v - least_) / (greatest_ - least_))
                            : colour_of_word(static_cast<std::size_t>(v));
  }

  void axes(const Ticks& y_ticks) {
    box({left_, top_}, {right_, bottom_});
    const Ticks x_ticks = ticks(x_, static_cast<int>((right_ - left_) / 55));
    for (std::size_t k = 0; k < x_ticks.at.size(); ++k) {
      const double x = x_at(x_ticks.at[k]);
      d_.strokes.push_back({{{x, bottom_}, {x, bottom_ + kMapTick}}, Role::axis, 0});
      word({x, bottom_ + kMapTick + kMarkSize}, {{x_ticks.labels[k]}}, kMarkSize, Anchor::middle);
    }
    for (std::size_t k = 0; k < y_ticks.at.size(); ++k) {
      const double y = y_at(y_ticks.at[k]);
      d_.strokes.push_back({{{left_ - kMapTick, y}, {left_, y}}, Role::axis, 0});
      word({left_ - kMapTick - 2, y + 0.36 * kMarkSize}, {{y_ticks.labels[k]}}, kMarkSize, Anchor::end);
    }
    word({(left_ + right_) / 2, d_.height - 1.5 * kMapGap}, axis_label(m_.x, x_ticks.note, m_.labels), kLabelSize,
         Anchor::middle);
    word({kMapGap + kLabelSize, (top_ + bottom_) / 2}, axis_label(m_.y, y_ticks.note, m_.labels), kLabelSize,
         Anchor::middle, true);
  }

  const HeatMap& m_;
  Drawing d_;
  Axis x_, y_;
  double least_ = std::numeric_limits<double>::infinity(), greatest_ = -std::numeric_limits<double>::infinity();
  double left_ = 0, right_ = 0, top_ = 0, bottom_ = 0;
};

}  // namespace

std::uint32_t colour_of_word(std::size_t word) {
  return static_cast<std::uint32_t>(std::strtoul(kColour[word % kColours] + 1, nullptr, 16));
}

RichText axis_label(const NamedColumn& c, const std::string& note, LabelStyle style) {
  RichText label = rich_label(c.name, c.unit, style);
  if (!c.meaning.empty()) label.push_back({", " + c.meaning});
  if (!note.empty()) label.push_back({" " + note});
  return label;
}

namespace {

// The mean of the numbers, or the most frequent word, of the cases at one place.
class Summary {
 public:
  void add(double v, bool word) {
    ++count_, sum_ += v;
    if (word) ++words_[static_cast<std::size_t>(v)];
  }
  double value() const {
    if (words_.empty()) return sum_ / static_cast<double>(count_);
    std::size_t best = words_.begin()->first, most = 0;
    for (const auto& [word, cases] : words_)
      if (cases > most) most = cases, best = word;
    return static_cast<double>(best);
  }

 private:
  std::size_t count_ = 0;
  double sum_ = 0;
  std::map<std::size_t, std::size_t> words_;
};

// Returns half of the width, at each side of its middle, of a cell that is 2^g times as small as the first ones.
std::pair<double, double> around(const std::vector<double>& first, double at, unsigned g) {
  const auto next = std::upper_bound(first.begin(), first.end(), at);
  const auto width = [&](std::vector<double>::const_iterator upper) {
    return std::ldexp(*upper - *(upper - 1), -static_cast<int>(g) - 1);
  };
  if (first.size() < 2) return {at - 0.5, at + 0.5};
  // A value of the first generation has neighbours at distances that may differ.
  const bool on = next != first.begin() && *(next - 1) == at;
  const auto right = next == first.end() ? next - 1 : next == first.begin() ? next + 1 : next;
  const auto left = on && next - 1 != first.begin() ? next - 1 : right;
  return {at - width(left), at + width(right)};
}

// Adds the cells of the further generations, the coarse ones first.
void add_finer(HeatMap& m, const NamedColumn& x, const NamedColumn& y, const NamedColumn& of,
               const std::vector<unsigned>& generations) {
  std::map<std::tuple<unsigned, double, double>, Summary> places;
  for (std::size_t row = 0; row < generations.size(); ++row)
    if (generations[row] > 0 && std::isfinite(of.values[row]) && std::isfinite(x.values[row]) &&
        std::isfinite(y.values[row]))
      places[{generations[row], x.values[row], y.values[row]}].add(of.values[row], !m.words.empty());
  for (const auto& [place, summary] : places) {
    const auto& [g, at_x, at_y] = place;
    const auto [left, right] = around(m.x.values, at_x, g);
    const auto [low, high] = around(m.y.values, at_y, g);
    m.finer.push_back({{left, low}, {right, high}, summary.value()});
  }
}

NamedColumn first_generation(const NamedColumn& c, const std::vector<unsigned>& generations) {
  NamedColumn first{c.name, c.unit, {}, c.meaning, c.points};
  for (std::size_t row = 0; row < c.values.size(); ++row)
    if (generations.empty() || generations[row] == 0) first.values.push_back(c.values[row]);
  return first;
}

}  // namespace

HeatMap make_heat_map(NamedColumn x, NamedColumn y, const NamedColumn& of, std::vector<std::string> words,
                      const std::vector<unsigned>& generations) {
  HeatMap m;
  NamedColumn first_x = first_generation(x, generations), first_y = first_generation(y, generations);
  const NamedColumn first_of = first_generation(of, generations);
  const std::vector<std::size_t> i = cells_along(first_x), k = cells_along(first_y);
  const std::size_t columns = first_x.values.size(), cells = columns * first_y.values.size();
  std::map<std::size_t, Summary> places;
  for (std::size_t row = 0; row < first_of.values.size(); ++row)
    if (i[row] < columns && k[row] < first_y.values.size() && std::isfinite(first_of.values[row]))
      places[k[row] * columns + i[row]].add(first_of.values[row], !words.empty());
  m.values.assign(cells, std::numeric_limits<double>::quiet_NaN());
  for (const auto& [cell, summary] : places) m.values[cell] = summary.value();
  m.x = std::move(first_x), m.y = std::move(first_y), m.words = std::move(words);
  m.name = of.name, m.unit = of.unit;
  add_finer(m, x, y, of, generations);
  return m;
}

std::vector<HeatMap::Finer> cells_of_cases(const NamedColumn& x, const NamedColumn& y,
                                           const std::vector<unsigned>& generations) {
  NamedColumn first_x = first_generation(x, generations), first_y = first_generation(y, generations);
  cells_along(first_x), cells_along(first_y);
  std::vector<HeatMap::Finer> cells;
  for (std::size_t row = 0; row < x.values.size(); ++row) {
    const unsigned g = generations.empty() ? 0 : generations[row];
    const auto [left, right] = around(first_x.values, x.values[row], g);
    const auto [low, high] = around(first_y.values, y.values[row], g);
    cells.push_back({{left, low}, {right, high}, 0});
  }
  return cells;
}

Drawing lay_out(const HeatMap& map) { return MapLayout(map).make(); }

}  // namespace anholon::plot
