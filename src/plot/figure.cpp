#include "plot/figure.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>

#include "base/diagnostic.h"
#include "base/escape.h"
#include "result/choose_columns.h"

namespace anholon::plot {

namespace {

// Returns the columns that have a derivative beside them; all columns if none has.
std::vector<std::size_t> coordinates(const RunTable& table, std::size_t x) {
  constexpr std::size_t kMost = 8;
  std::vector<std::size_t> list;
  for (const bool all : {false, true}) {
    for (std::size_t j = 0; j < table.columns.size() && list.size() < kMost; ++j)
      if (j != x && table.columns[j] != "t" && table.columns[j].back() != '\'' &&
          (all || table.find(table.columns[j] + "'") < table.columns.size()))
        list.push_back(j);
    if (!list.empty()) break;
  }
  return list;
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), greatest = -std::numeric_limits<double>::infinity();
  void see(double x) { least = std::min(least, x), greatest = std::max(greatest, x); }
  bool empty() const { return least > greatest; }
};

// Returns the slopes of a column at its rows: the derivative if it is a column, otherwise those of a curve that stays
// between the rows (Fritsch and Carlson).
std::vector<double> slopes(const std::vector<double>& x, const std::vector<double>& y) {
  std::vector<double> s(y.size(), 0);
  for (std::size_t i = 1; i + 1 < y.size(); ++i) {
    const double before = (y[i] - y[i - 1]) / (x[i] - x[i - 1]), after = (y[i + 1] - y[i]) / (x[i + 1] - x[i]);
    if (before * after > 0) s[i] = 2 * before * after / (before + after);
  }
  const std::size_t n = y.size();
  s[0] = (y[1] - y[0]) / (x[1] - x[0]);
  s[n - 1] = (y[n - 1] - y[n - 2]) / (x[n - 1] - x[n - 2]);
  return s;
}

// True if a column without a derivative is a mode: whole numbers that mostly stay the same.
bool is_mode(const std::vector<double>& y) {
  std::size_t same = 0;
  for (std::size_t i = 1; i < y.size(); ++i) same += y[i] == y[i - 1];
  return 2 * same + 1 >= y.size() &&
         std::all_of(y.begin(), y.end(), [](double v) { return std::isfinite(v) && v == std::round(v); });
}

// The cubic with both slopes between two rows, over u in [0, 1] of an interval of length h. If the slopes do not fit
// the rows, there is a jump in between, and the line stays straight.
class Between {
 public:
  Between(double y0, double y1, double d0, double d1, double h) : y0_(y0), y1_(y1), d0_(h * d0), d1_(h * d1) {
    constexpr double kFits = 0.25;
    const double rise = y1 - y0, mean = (d0_ + d1_) / 2;
    curved_ = std::abs(rise - mean) <= kFits * (std::abs(rise) + (std::abs(d0_) + std::abs(d1_)) / 2);
  }
  double operator()(double u) const {
    const double v = 1 - u;
    return curved_ ? y0_ * v * v * (1 + 2 * u) + y1_ * u * u * (1 + 2 * v) + u * v * (d0_ * v - d1_ * u)
                   : y0_ + u * (y1_ - y0_);
  }

 private:
  double y0_, y1_, d0_, d1_;
  bool curved_ = false;
};

// Puts points of a curve between rows, which are far apart if they are at the ends of steps. On a logarithmic axis the
// curve of positive numbers is that of their logarithms. A mode keeps its value up to the next row.
void smooth(Figure& f, const std::vector<std::vector<double>>& derivatives, bool log) {
  constexpr std::size_t kPoints = 1000, kMost = 20;
  const std::size_t n = f.x.size(), parts = n < 2 ? 1 : std::min(kMost, kPoints / n);
  const bool in_order = std::is_sorted(f.x.begin(), f.x.end(), std::less_equal<>()) ||
                        std::is_sorted(f.x.rbegin(), f.x.rend(), std::less_equal<>());
  if (parts < 2 || !in_order) return;
  const std::vector<double> x = std::move(f.x);
  f.x.clear();
  for (std::size_t i = 0; i + 1 < n; ++i)
    for (std::size_t k = 0; k < parts; ++k)
      f.x.push_back(x[i] + (x[i + 1] - x[i]) * static_cast<double>(k) / static_cast<double>(parts));
  f.x.push_back(x.back());
  std::size_t number = 0;
  for (Panel& p : f.panels)
    for (Series& s : p.series) {
      const std::vector<double>& given = derivatives[number++];
      const bool mode = given.empty() && is_mode(s.y);
      const bool of_logarithms = log && std::all_of(s.y.begin(), s.y.end(), [](double v) { return v > 0; });
      std::vector<double> y = std::move(s.y), d = given;
      if (of_logarithms) {
        for (std::size_t i = 0; i < d.size(); ++i) d[i] /= y[i];
        for (double& v : y) v = std::log(v);
      }
      if (d.empty()) d = slopes(x, y);
      s.y.clear();
      for (std::size_t i = 0; i + 1 < n; ++i) {
        const Between between(y[i], y[i + 1], d[i], d[i + 1], x[i + 1] - x[i]);
        for (std::size_t k = 0; k < parts; ++k)
          s.y.push_back(mode || k == 0 ? y[i] : between(static_cast<double>(k) / static_cast<double>(parts)));
      }
      s.y.push_back(y.back());
      if (of_logarithms)
        for (double& v : s.y) v = std::exp(v);
    }
}

// Returns an axis over the numbers of a column.
Axis axis_of(const Range& range, const std::string& column, bool log, bool tight) {
  constexpr double kLongest = 1e307;  // so that a double can represent the positions of the ticks
  if (!log && !(range.greatest - range.least < kLongest))
    throw Failure(Span{}, "the numbers of '" + column + "' are too far apart for an axis",
                  "--log, or --from and --to for a part of the motion");
  return axis_for(range.least, range.greatest, log, tight);
}

// Chooses the vertical axes so that all series fit.
void fit_panels(Figure& f, bool log) {
  for (Panel& p : f.panels) {
    Range ys;
    for (const Series& s : p.series)
      for (const double v : s.y)
        if (std::isfinite(v) && (!log || v > 0)) ys.see(v);
    if (ys.empty())
      throw Failure(Span{},
                    "the column '" + p.series[0].name + "' has no " + (log ? "positive " : "") + "number to be shown",
                    log ? "without --log" : "another column, or other times");
    p.y = axis_of(ys, p.series[0].name, log, false);
  }
}

void see_finite(Range& range, const std::vector<double>& values) {
  for (const double v : values)
    if (std::isfinite(v)) range.see(v);
}

// Adds the series of a figure to the panels of the same columns.
void add_series(Figure& to, Figure from, const std::string& of, bool each) {
  for (Panel& panel : from.panels) {
    const std::string& name = panel.series.front().name;
    const auto same = std::find_if(to.panels.begin(), to.panels.end(),
                                   [&](const Panel& p) { return !each || p.series.front().name == name; });
    Panel& place = same == to.panels.end() ? to.panels.emplace_back() : *same;
    for (Series& s : panel.series) {
      s.of = of, s.x = from.x, s.number = place.series.size();
      place.series.push_back(std::move(s));
    }
  }
}

}  // namespace

RichText series_label(const Series& s, LabelStyle style) {
  RichText label = rich_label(s.name, s.unit, style);
  if (!s.of.empty()) label.push_back({", " + shown(s.of)});
  return label;
}

std::string series_text(const Series& s, LabelStyle style) {
  return text_label(s.name, s.unit, style) + (s.of.empty() ? "" : ", " + shown(s.of));
}

std::string series_latex(const Series& s) {
  return latex_label(s.name, s.unit) + (s.of.empty() ? "" : ", " + latex_escape(s.of));
}

std::vector<std::size_t> select_columns(const RunTable& table, const std::vector<std::string>& names, std::size_t x) {
  return names.empty() ? coordinates(table, x) : chosen_columns(table.columns, names, x);
}

void make_equal(Figure& f, double width, double height) {
  const auto longer = [](Axis& a, double length) {
    const double middle = (a.from + a.to) / 2;
    a.from = middle - length / 2, a.to = middle + length / 2;
  };
  double unit = (f.x_axis.to - f.x_axis.from) / width;
  for (const Panel& p : f.panels) unit = std::max(unit, (p.y.to - p.y.from) / height);
  longer(f.x_axis, unit * width);
  for (Panel& p : f.panels) longer(p.y, unit * height);
}

Figure make_figure(const RunFile& run, const FigureOptions& o) {
  const RunTable& table = run.table;
  const auto unit = [&](const std::string& column) {
    const auto it = run.units.find(column);
    return it == run.units.end() ? std::string() : it->second;
  };
  if (table.rows() == 0) throw Failure(Span{}, "the run has no rows yet", "wait for them, or simulate anew");
  const std::size_t time = table.find("t");
  std::size_t x = o.x.empty() ? (time < table.columns.size() ? time : 0) : table.find(o.x);
  if (x == table.columns.size()) unknown_column(table.columns, o.x);

  Figure f;
  std::tie(f.title, f.labels, f.width, f.height, f.equal) = std::tie(o.title, o.labels, o.width, o.height, o.equal);
  f.x_name = table.columns[x];
  f.x_unit = unit(f.x_name);
  const std::span<const double> t = table.values[time < table.columns.size() ? time : x];
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < table.rows(); ++i)
    if (!(o.from && !(t[i] >= *o.from)) && !(o.to && !(t[i] <= *o.to))) rows.push_back(i);
  if (rows.empty())
    throw Failure(Span{}, "no row lies between these times",
                  "the rows go from t = " + table.text(0, time < table.columns.size() ? time : x) + " to " +
                      table.text(table.rows() - 1, time < table.columns.size() ? time : x));
  const auto taken = [&](std::size_t column) {
    std::vector<double> v;
    v.reserve(rows.size());
    for (const std::size_t i : rows) v.push_back(table.values[column][i]);
    return v;
  };
  f.rows = rows.size();
  f.x = taken(x);
  Range xs;
  see_finite(xs, f.x);
  if (xs.empty()) throw Failure(Span{}, "the column '" + f.x_name + "' has no number to be shown", "another --x");
  f.x_axis = axis_of(xs, f.x_name, false, f.x_name == "t");

  const std::vector<std::size_t> columns = select_columns(table, o.names, x);
  if (columns.empty())
    throw Failure(Span{}, "there is nothing to draw over '" + f.x_name + "'",
                  "the columns are " + list_of_columns(table.columns));
  constexpr std::size_t kMostPanels = 40;
  if (o.each && columns.size() > kMostPanels)
    throw Failure(Span{}, std::to_string(columns.size()) + " panels are too many for one figure",
                  "fewer columns, or without --each");
  std::vector<std::vector<double>> derivatives;
  for (const std::size_t j : columns) {
    if (o.each || f.panels.empty()) f.panels.emplace_back();
    std::vector<Series>& series = f.panels.back().series;
    series.push_back({table.columns[j], unit(table.columns[j]), taken(j), o.each ? 0 : series.size()});
    if (!o.smooth) continue;
    const std::size_t derivative = table.find(table.columns[j] + "'");
    derivatives.push_back(derivative < table.columns.size() ? taken(derivative) : std::vector<double>());
  }
  if (o.smooth && x == time) smooth(f, derivatives, o.log);
  fit_panels(f, o.log);
  return f;
}

Figure make_figure(const std::vector<NamedRun>& runs, const FigureOptions& o) {
  if (runs.size() == 1 && runs[0].name.empty()) return make_figure(runs[0].run, o);
  Figure all;
  Range xs;
  for (const NamedRun& each : runs) {
    Figure one;
    try {
      one = make_figure(each.run, o);
    } catch (Failure& f) {
      f.diagnostic.message = each.name + ": " + f.diagnostic.message;
      throw;
    }
    see_finite(xs, one.x);
    if (all.x_name.empty()) {
      all = one;
      all.rows = 0, all.x.clear(), all.panels.clear();
    }
    all.rows += one.rows;
    add_series(all, std::move(one), each.name, o.each);
  }
  all.x_axis = axis_of(xs, all.x_name, false, all.x_name == "t");
  fit_panels(all, o.log);
  return all;
}

namespace {

// Keeps the visible part of points that come in order of columns.
class ByColumns {
 public:
  explicit ByColumns(std::vector<Point>& out) : out_(out) {}
  void add(const Point& p) {
    const double column = std::floor(p.x);
    if (count_ > 0 && column != column_) flush();
    if (count_ == 0) column_ = column, first_ = least_ = greatest_ = p, least_at_ = greatest_at_ = 0;
    if (p.y < least_.y) least_ = p, least_at_ = count_;
    if (p.y > greatest_.y) greatest_ = p, greatest_at_ = count_;
    last_ = p;
    ++count_;
  }
  void flush() {
    if (count_ == 0) return;
    out_.push_back(first_);
    const bool rising = least_at_ <= greatest_at_;
    const std::size_t a = rising ? least_at_ : greatest_at_, b = rising ? greatest_at_ : least_at_;
    if (a > 0 && a + 1 < count_) out_.push_back(rising ? least_ : greatest_);
    if (b > a && b > 0 && b + 1 < count_) out_.push_back(rising ? greatest_ : least_);
    if (count_ > 1) out_.push_back(last_);
    count_ = 0;
  }

 private:
  std::vector<Point>& out_;
  std::size_t count_ = 0, least_at_ = 0, greatest_at_ = 0;
  double column_ = 0;
  Point first_{}, last_{}, least_{}, greatest_{};
};

// Omits points of a path that are, within visible accuracy, on a straight line between others: all points since the
// last kept one are in a narrow cone.
class AlongAPath {
 public:
  explicit AlongAPath(std::vector<Point>& out) : out_(out) {}
  void add(const Point& p) {
    if (out_.empty()) {
      out_.push_back(p);
      return;
    }
    if (!narrow(p) && holds_) {
      out_.push_back(last_);
      distance_ = 0;
      open_ = holds_ = false;
      narrow(p);
    }
    last_ = p;
    holds_ = true;
  }
  void flush() {
    if (holds_) out_.push_back(last_);
    holds_ = false;
  }

 private:
  static constexpr double kSeen = 0.3;  // in points of the output

  // Narrows the cone by p; returns false if p is outside or turns back.
  bool narrow(const Point& p) {
    const double dx = p.x - out_.back().x, dy = p.y - out_.back().y, d = std::hypot(dx, dy);
    if (d <= kSeen) return !open_;
    const double angle = std::atan2(dy, dx), half = std::asin(kSeen / d);
    if (!open_) {
      open_ = true;
      direction_ = angle;
      low_ = -half, high_ = half;
    } else {
      const double turned = std::remainder(angle - direction_, 2 * M_PI);
      if (turned < low_ || turned > high_ || d < distance_) return false;
      low_ = std::max(low_, turned - half), high_ = std::min(high_, turned + half);
    }
    distance_ = d;
    return true;
  }

  std::vector<Point>& out_;
  Point last_{};
  bool holds_ = false, open_ = false;
  double direction_ = 0, low_ = 0, high_ = 0, distance_ = 0;
};

const std::vector<double>& abscissa(const Figure& f, const Series& s) { return s.x.empty() ? f.x : s.x; }

template <class Keeper>
std::vector<std::vector<Point>> kept(const Figure& f, const Panel& panel, const Series& s, double width,
                                     double height) {
  std::vector<std::vector<Point>> pieces;
  std::optional<Keeper> keeper;
  const std::vector<double>& x = abscissa(f, s);
  for (std::size_t i = 0; i < std::min(x.size(), s.y.size()); ++i) {
    const bool there = std::isfinite(x[i]) && std::isfinite(s.y[i]) && (!panel.y.log || s.y[i] > 0);
    if (!there) {
      if (keeper) keeper->flush();
      keeper.reset();
      continue;
    }
    if (!keeper) keeper.emplace(pieces.emplace_back());
    keeper->add({width * f.x_axis.place(x[i]), height * panel.y.place(s.y[i])});
  }
  if (keeper) keeper->flush();
  return pieces;
}

}  // namespace

std::vector<std::vector<Point>> curve(const Figure& f, const Panel& panel, const Series& s, double width,
                                      double height) {
  const std::vector<double>& x = abscissa(f, s);
  const bool in_order = std::is_sorted(x.begin(), x.end()) || std::is_sorted(x.rbegin(), x.rend());
  return in_order ? kept<ByColumns>(f, panel, s, width, height) : kept<AlongAPath>(f, panel, s, width, height);
}

}  // namespace anholon::plot
