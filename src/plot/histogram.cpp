#include "plot/histogram.h"

#include <algorithm>
#include <cmath>

#include "base/diagnostic.h"

namespace anholon::plot {

namespace {

constexpr double kBarLabel = 9, kBarMark = 8, kBarGap = 4, kBarTick = 3, kBarLetter = 0.62;

}  // namespace

Histogram make_histogram(NamedColumn of, std::vector<std::string> words) {
  Histogram h;
  std::vector<double> values;
  for (const double v : of.values)
    if (std::isfinite(v)) values.push_back(v);
  h.left_out = of.values.size() - values.size();
  h.of = {of.name, of.unit, {}, of.meaning};
  if (values.empty()) throw Failure({}, "no case has a value of '" + h.of.name + "'");
  if (!words.empty()) {
    h.counts.assign(words.size(), 0);
    for (const double v : values) ++h.counts[static_cast<std::size_t>(v)];
    h.words = std::move(words);
    h.to = static_cast<double>(h.counts.size());
    return h;
  }
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  h.from = *least, h.to = *greatest;
  // A single value gets a bar around it.
  if (!(h.from < h.to)) {
    const double half = h.from == 0 ? 0.5 : std::abs(h.from) / 2;
    h.from -= half, h.to += half;
  }
  const auto bars =
      static_cast<std::size_t>(std::clamp(std::round(2 * std::cbrt(static_cast<double>(values.size()))), 5.0, 100.0));
  h.counts.assign(bars, 0);
  for (const double v : values) {
    const double place = (v / 2 - h.from / 2) / (h.to / 2 - h.from / 2) * static_cast<double>(bars);
    ++h.counts[std::min(static_cast<std::size_t>(std::max(place, 0.0)), bars - 1)];
  }
  return h;
}

Drawing lay_out(const Histogram& h) {
  Drawing d;
  d.width = h.width * kPointsInCm, d.height = h.height * kPointsInCm;
  double top = kBarGap;
  const auto word = [&](Point at, RichText text, double size, Anchor anchor, bool upwards = false) {
    d.words.push_back({at, std::move(text), size, anchor, upwards});
  };
  if (!h.title.empty()) {
    word({d.width / 2, top + kBarLabel}, {{h.title}}, kBarLabel + 1, Anchor::middle);
    top += kBarLabel + 1 + 2 * kBarGap;
  }
  const double bottom = d.height - kBarGap - 2 * kBarLabel - kBarMark;
  const Axis high{0, 1.05 * static_cast<double>(*std::max_element(h.counts.begin(), h.counts.end())) + 1e-300};
  const Ticks marks = ticks(high, static_cast<int>((bottom - top) / 28));
  double widest = 0;
  for (const std::string& l : marks.labels)
    widest = std::max(widest, kBarLetter * kBarMark * static_cast<double>(shown_width(l)));
  const double left = 2 * kBarGap + 1.3 * kBarLabel + widest + kBarTick, right = d.width - 2.5 * kBarGap;
  const auto y_at = [&](double count) { return bottom - (bottom - top) * high.place(count); };
  const double bar = (right - left) / static_cast<double>(h.counts.size());
  for (std::size_t k = 0; k < h.counts.size(); ++k) {
    const double inset = h.words.empty() ? 0 : bar / 8, from = left + bar * static_cast<double>(k);
    if (h.counts[k] > 0)
      d.patches.push_back({{from + inset, y_at(static_cast<double>(h.counts[k]))},
                           {from + bar - inset, bottom},
                           colour_of_word(h.words.empty() ? 0 : k)});
    if (!h.words.empty())
      word({from + bar / 2, bottom + kBarTick + kBarMark}, {{h.words[k].empty() ? "none" : h.words[k]}}, kBarMark,
           Anchor::middle);
  }
  d.strokes.push_back({{{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}, Role::axis, 0});
  for (std::size_t k = 0; k < marks.at.size(); ++k) {
    const double y = y_at(marks.at[k]);
    d.strokes.push_back({{{left - kBarTick, y}, {left, y}}, Role::axis, 0});
    word({left - kBarTick - 2, y + 0.36 * kBarMark}, {{marks.labels[k]}}, kBarMark, Anchor::end);
  }
  std::string note;
  if (h.words.empty()) {
    const Axis along{h.from, h.to};
    const Ticks x = ticks(along, static_cast<int>((right - left) / 55));
    note = x.note;
    for (std::size_t k = 0; k < x.at.size(); ++k) {
      const double at = left + (right - left) * along.place(x.at[k]);
      d.strokes.push_back({{{at, bottom}, {at, bottom + kBarTick}}, Role::axis, 0});
      word({at, bottom + kBarTick + kBarMark}, {{x.labels[k]}}, kBarMark, Anchor::middle);
    }
  }
  if (h.left_out > 0)
    note += (note.empty() ? "" : " ") + ("without " + std::to_string(h.left_out) + " rows that have none");
  word({(left + right) / 2, d.height - 1.5 * kBarGap}, axis_label(h.of, note, h.labels), kBarLabel, Anchor::middle);
  word({kBarGap + kBarLabel, (top + bottom) / 2}, {{"cases" + (marks.note.empty() ? "" : " " + marks.note)}}, kBarLabel,
       Anchor::middle, true);
  return d;
}

}  // namespace anholon::plot
