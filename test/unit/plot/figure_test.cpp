#include <gtest/gtest.h>

#include "plot/figure.h"
#include "result/choose_columns.h"
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include <unistd.h>

#include "base/diagnostic.h"
#include "plot/drawing.h"
#include "plot/terminal.h"

namespace anholon::plot::figure_test {
namespace {

RunFile run(const std::vector<std::string>& columns, const std::vector<std::vector<double>>& values) {
  RunFile r;
  r.table.set_columns(columns);
  r.table.values = values;
  return r;
}

std::vector<std::string> names(const Figure& f) {
  std::vector<std::string> list;
  for (const Panel& p : f.panels)
    for (const Series& s : p.series) list.push_back(s.name);
  return list;
}

const RunFile& disc() {
  static const RunFile r =
      run({"t", "x", "theta", "x'", "theta'", "x''", "lambda.a", "lambda.b"},
          {{0, 1, 2}, {1, 2, 3}, {3, 2, 5}, {0, 0, 0}, {1, 1, 2}, {0, 1, 2}, {7, 8, 9}, {-1, 0, 1}});
  return r;
}

FigureOptions of(const std::vector<std::string>& list) {
  FigureOptions o;
  o.names = list;
  return o;
}

std::string trouble(const RunFile& r, const FigureOptions& o) {
  try {
    make_figure(r, o);
    return "none";
  } catch (const Failure& f) {
    return f.diagnostic.message;
  }
}

TEST(SeveralRuns, LieOverEachOtherWithTheirOwnTimes) {
  const std::vector<NamedRun> runs{{run({"t", "x", "y"}, {{0, 1, 2}, {1, 2, 3}, {5, 5, 6}}), "a.csv"},
                                   {run({"t", "y", "x"}, {{0, 4}, {7, 8}, {-1, 9}}), "b.csv"}};
  const Figure together = make_figure(runs, of({"x"}));
  ASSERT_EQ(together.panels.size(), 1U);
  const std::vector<Series>& s = together.panels[0].series;
  ASSERT_EQ(s.size(), 2U);
  EXPECT_EQ(s[0].x, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(s[1].x, (std::vector<double>{0, 4}));
  EXPECT_EQ(s[1].y, (std::vector<double>{-1, 9}));
  EXPECT_EQ(series_text(s[1], LabelStyle::plain), "x, b.csv");
  EXPECT_EQ(series_latex(s[1]), "$x$, b.csv");
  EXPECT_NE(s[0].number, s[1].number);
  EXPECT_EQ(together.rows, 5U);
  EXPECT_EQ(together.x_axis.to, 4);
  EXPECT_LT(together.panels[0].y.from, -1);
  EXPECT_GT(together.panels[0].y.to, 9);
  // The second curve covers the whole width, the first covers half of it.
  const auto first = curve(together, together.panels[0], s[0], 100, 100),
             second = curve(together, together.panels[0], s[1], 100, 100);
  EXPECT_NEAR(first.back().back().x, 50, 1);
  EXPECT_NEAR(second.back().back().x, 100, 1);
  FigureOptions each = of({"x", "y"});
  each.each = true;
  const Figure apart = make_figure(runs, each);
  ASSERT_EQ(apart.panels.size(), 2U);
  EXPECT_EQ(apart.panels[1].series[0].name, "y");
  EXPECT_EQ(apart.panels[1].series[1].name, "y");
}

TEST(SeveralRuns, TellWhichOneLacksAColumn) {
  const std::vector<NamedRun> runs{{run({"t", "x"}, {{0, 1}, {1, 2}}), "a.csv"},
                                   {run({"t", "y"}, {{0, 1}, {1, 2}}), "b.csv"}};
  try {
    make_figure(runs, of({"x"}));
    FAIL();
  } catch (const Failure& f) {
    EXPECT_EQ(f.diagnostic.message, "b.csv: there is no column 'x'");
  }
}

TEST(Ticks, AreRound) {
  const Ticks t = ticks({0, 10, false}, 6);
  EXPECT_EQ(t.labels, (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(ticks({-0.31, 0.2, false}, 4).labels, (std::vector<std::string>{"-0.2", "0.0", "0.2"}));
  EXPECT_EQ(ticks({1e-7, 4e-7, false}, 4).labels, (std::vector<std::string>{"1", "2", "3", "4"}));
  EXPECT_EQ(ticks({1e-7, 4e-7, false}, 4).note, "×10⁻⁷");
  EXPECT_EQ(ticks({0, 2e6, false}, 3).note, "×10⁶");
}

// Values that differ in late digits are labelled relative to a round number; base and label together give the value.
TEST(Ticks, LateDigits) {
  const Ticks t = ticks({11.5983245949, 11.5983245953, false}, 5);
  ASSERT_GE(t.at.size(), 3u);
  ASSERT_EQ(t.note.substr(0, 7), "×10⁻");
  const std::size_t plus = t.note.find("+ ");
  ASSERT_NE(plus, std::string::npos);
  const double base = std::stod(t.note.substr(plus + 2)),
               factor = t.note.find("⁻¹⁰") != std::string::npos ? 1e-10 : 1e-9;
  for (std::size_t k = 0; k < t.at.size(); ++k) EXPECT_NEAR(base + factor * std::stod(t.labels[k]), t.at[k], 1e-14);
}

TEST(Ticks, OfPowersAndOfNothing) {
  EXPECT_EQ(ticks({1e-12, 1, true}, 4).labels, (std::vector<std::string>{"10⁻¹²", "10⁻⁹", "10⁻⁶", "10⁻³", "10⁰"}));
  EXPECT_EQ(ticks({1, 30, true}, 6).labels, (std::vector<std::string>{"1", "2", "5", "10", "20"}));
  EXPECT_TRUE(ticks({1, 1, false}, 5).at.empty());
  EXPECT_TRUE(ticks({0, INFINITY, false}, 5).at.empty());
  for (const double size : {1e-300, 1e-8, 3.7, 1e8, 1e300})
    for (int most = 2; most < 12; ++most) {
      const Ticks t = ticks({-0.3 * size, size, false}, most);
      EXPECT_GE(t.at.size(), 2u) << size << " " << most;
      EXPECT_LE(t.at.size(), static_cast<std::size_t>(most + 2)) << size << " " << most;
    }
}

TEST(Axis, HasALengthAlways) {
  for (const double x : {0.0, 1.0, -3e-9, 11.598}) {
    const Axis a = axis_for(x, x, false, false);
    EXPECT_LT(a.from, x);
    EXPECT_GT(a.to, x);
  }
  EXPECT_EQ(axis_for(0, 10, false, true).to, 10);
  EXPECT_LT(axis_for(0, 10, false, false).from, 0);
  EXPECT_NEAR((Axis{1, 100, true}).place(10), 0.5, 1e-15);
}

TEST(Select, NamesPatternsAndTheCoordinates) {
  EXPECT_EQ(names(make_figure(disc(), {})), (std::vector<std::string>{"x", "theta"}));
  EXPECT_EQ(names(make_figure(disc(), of({"lambda.*", "x"}))), (std::vector<std::string>{"lambda.a", "lambda.b", "x"}));
  EXPECT_EQ(names(make_figure(disc(), of({"*'"}))), (std::vector<std::string>{"x'", "theta'", "x''"}));
  EXPECT_EQ(names(make_figure(disc(), of({"?'"}))), (std::vector<std::string>{"x'"}));
  EXPECT_EQ(names(make_figure(disc(), of({"x", "x", "?"}))), (std::vector<std::string>{"x"}));  // and never t over t
  FigureOptions path = of({"theta"});
  path.x = "x";
  EXPECT_EQ(make_figure(disc(), path).x, (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(matches("a*b*c", "aXbYbZc"));
  EXPECT_FALSE(matches("a*b*c", "aXbYbZ"));
  EXPECT_TRUE(matches("*", ""));
}

TEST(Select, SaysWhatThereIs) {
  EXPECT_EQ(trouble(disc(), of({"thata"})), "there is no column 'thata'; did you mean 'theta'?");
  EXPECT_EQ(trouble(disc(), of({"q.*"})), "no column fits 'q.*'");
  FigureOptions o;
  o.from = 5;
  EXPECT_EQ(trouble(disc(), o), "no row lies between these times");
  o = of({"x''"});
  o.to = 0.5;
  o.log = true;
  EXPECT_EQ(trouble(disc(), o), "the column 'x''' has no positive number to be shown");
  EXPECT_EQ(trouble(run({"t", "x"}, {{}, {}}), {}), "the run has no rows yet");
}

TEST(Figure, TimesAndPanels) {
  FigureOptions o = of({"x", "theta"});
  o.from = 1;
  o.each = true;
  const Figure f = make_figure(disc(), o);
  EXPECT_EQ(f.x, (std::vector<double>{1, 2}));
  ASSERT_EQ(f.panels.size(), 2u);
  EXPECT_EQ(f.panels[1].series[0].y, (std::vector<double>{2, 5}));
}

// One of a million rows is an outlier: the curve keeps it, and few other points.
TEST(Curve, KeepsExtremesOfManyRows) {
  const std::size_t n = 1'000'000;
  std::vector<double> t(n), y(n);
  for (std::size_t i = 0; i < n; ++i) t[i] = static_cast<double>(i), y[i] = std::sin(static_cast<double>(i));
  y[777'777] = 50;
  y[123'456] = -40;
  const Figure f = make_figure(run({"t", "y"}, {t, y}), {});
  const auto pieces = curve(f, f.panels[0], f.panels[0].series[0], 200, 1);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_LE(pieces[0].size(), 4u * 201u);
  double least = 1, greatest = 0, before = -1;
  for (const Point& p : pieces[0]) {
    least = std::min(least, p.y), greatest = std::max(greatest, p.y);
    EXPECT_GE(p.x, before);
    before = p.x;
  }
  EXPECT_EQ(greatest, f.panels[0].y.place(50));
  EXPECT_EQ(least, f.panels[0].y.place(-40));
  // Ends of the curve, and both sides of the outlier.
  EXPECT_EQ(pieces[0].front().x, 0);
  EXPECT_EQ(pieces[0].back().x, 200);
}

TEST(Curve, AFewRowsStayAsTheyAre) {
  const Figure f = make_figure(disc(), of({"theta"}));
  const auto pieces = curve(f, f.panels[0], f.panels[0].series[0], 100, 100);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].size(), 3u);
}

// Sparse rows of a sine with its derivative: the curve between them is the sine, not the polygon. At a jump the curve
// stays between the values.
TEST(Curve, IsSmoothBetweenTheRows) {
  std::vector<double> t, y, dy, ddy;
  for (int i = 0; i <= 20; ++i)
    t.push_back(0.5 * i), y.push_back(std::sin(t.back())), dy.push_back(std::cos(t.back())),
        ddy.push_back(i < 10 ? 1 : 5);
  FigureOptions o = of({"y", "y'", "y''"});
  o.smooth = true;
  const Figure f = make_figure(run({"t", "y", "y'", "y''"}, {t, y, dy, ddy}), o);
  EXPECT_EQ(f.rows, 21u);
  ASSERT_GT(f.x.size(), 300u);
  for (std::size_t i = 0; i < f.x.size(); ++i) {
    EXPECT_NEAR(f.panels[0].series[0].y[i], std::sin(f.x[i]), 2e-4);
    EXPECT_GE(f.panels[0].series[2].y[i], 1 - 1e-14);
    EXPECT_LE(f.panels[0].series[2].y[i], 5 + 1e-14);
  }
  for (std::size_t i = 0; i < t.size(); ++i) EXPECT_NE(std::find(f.x.begin(), f.x.end(), t[i]), f.x.end());
  // A velocity is reversed between two rows, with the same acceleration before and after.
  const Figure jump = make_figure(
      run({"t", "v", "v'"}, {{0, 1, 2, 3}, {0, -10, 10, 0}, {-10, -10, -10, -10}}), o = [] {
        FigureOptions p = of({"v"});
        p.smooth = true;
        return p;
      }());
  const std::vector<double>& v = jump.panels[0].series[0].y;
  EXPECT_EQ(*std::max_element(v.begin(), v.end()), 10);
  EXPECT_EQ(*std::min_element(v.begin(), v.end()), -10);
  // Over another abscissa the rows are joined by straight lines.
  o.names = {"y"}, o.x = "y'";
  EXPECT_EQ(make_figure(run({"t", "y", "y'"}, {t, y, dy}), o).x.size(), 21u);
}

TEST(Curve, GapsAndPaths) {
  const double nan = std::nan("");
  const Figure gap = make_figure(run({"t", "y"}, {{0, 1, 2, 3, 4}, {0, 1, nan, 1, 0}}), {});
  const auto pieces = curve(gap, gap.panels[0], gap.panels[0].series[0], 10, 10);
  ASSERT_EQ(pieces.size(), 2u);
  EXPECT_EQ(pieces[0].size(), 2u);
  EXPECT_EQ(pieces[1].size(), 2u);
  // A circle goes back and forth in x; its last point is kept.
  std::vector<double> t, x, y;
  for (int i = 0; i <= 10'000; ++i) t.push_back(i), x.push_back(std::cos(i * 1e-3)), y.push_back(std::sin(i * 1e-3));
  FigureOptions o = of({"y"});
  o.x = "x";
  const Figure f = make_figure(run({"t", "x", "y"}, {t, x, y}), o);
  const auto circle = curve(f, f.panels[0], f.panels[0].series[0], 100, 100);
  ASSERT_EQ(circle.size(), 1u);
  EXPECT_LT(circle[0].size(), 200u);
  // Points that are left out lie so near the curve that the distance is invisible.
  for (std::size_t i = 0; i < t.size(); i += 7) {
    const Point p{100 * f.x_axis.place(x[i]), 100 * f.panels[0].y.place(y[i])};
    double nearest = 1e9;
    for (std::size_t k = 1; k < circle[0].size(); ++k) {
      const Point a = circle[0][k - 1], b = circle[0][k];
      const double dx = b.x - a.x, dy = b.y - a.y,
                   u = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
      nearest = std::min(nearest, std::hypot(p.x - a.x - u * dx, p.y - a.y - u * dy));
    }
    ASSERT_LT(nearest, 0.7) << i;
  }
  EXPECT_EQ(circle[0].back().x, 100 * f.x_axis.place(x.back()));
  // A path that returns along itself turns at its end.
  const Figure back = make_figure(run({"t", "x", "y"}, {{0, 1, 2, 3}, {0, 5, 10, 3}, {0, 5, 10, 3}}), o);
  const auto turned = curve(back, back.panels[0], back.panels[0].series[0], 100, 100);
  ASSERT_EQ(turned[0].size(), 3u);
  EXPECT_EQ(turned[0][1].x, 100 * back.x_axis.place(10));
}

TEST(Terminal, DrawsEveryDotOfALine) {
  FigureOptions o = of({"y"});
  const std::string text = draw_terminal(make_figure(run({"t", "y"}, {{0, 1}, {0, 1}}), o), {24, 4, false});
  EXPECT_EQ(text, "     y\n"
                  "1.0 ┤               ⣀⡠⠔\n"
                  "0.5 ┤         ⢀⣀⠤⠔⠊⠉\n"
                  "    │    ⢀⡠⠤⠒⠊⠁\n"
                  "0.0 ┤⠤⠔⠒⠉⠁\n"
                  "    └┬────────┬───────┬\n"
                  "    0.0      0.5     1.0\n"
                  "             t\n");
}

TEST(Terminal, ColoursOnlyWhereAskedFor) {
  const Figure f = make_figure(disc(), of({"x", "theta"}));
  const std::string plain = draw_terminal(f, {60, 10, false}), coloured = draw_terminal(f, {60, 10, true});
  EXPECT_EQ(plain.find('\033'), std::string::npos);
  EXPECT_NE(plain.find("a x  b θ"), std::string::npos);
  EXPECT_NE(coloured.find("\033[36m──\033[0m x"), std::string::npos);
  EXPECT_NE(coloured.find("\033[33m──\033[0m θ"), std::string::npos);
}

TEST(Terminal, NoLineIsWiderThanTheTerminal) {
  const RunFile& r = disc();
  for (const int width : {30, 47, 80, 133}) {
    for (const bool each : {false, true}) {
      FigureOptions o = of({"*"});
      o.each = each;
      const std::string text = draw_terminal(make_figure(r, o), {width, 7, false});
      for (std::size_t from = 0; from < text.size();) {
        const std::size_t end = text.find('\n', from);
        EXPECT_LE(shown_width(text.substr(from, end - from)), static_cast<std::size_t>(width)) << text;
        from = end + 1;
      }
    }
  }
}

TEST(Svg, EscapesAndNamesItsClasses) {
  FigureOptions o = of({"x", "theta'"});
  o.title = "a < b & \"c\"";
  const std::string svg = draw_svg(make_figure(disc(), o));
  EXPECT_NE(svg.find("<title>a &lt; b &amp; &quot;c&quot;</title>"), std::string::npos);
  EXPECT_EQ(svg.find("a < b"), std::string::npos);
  for (const char* part :
       {"class=\"s s0\"", "class=\"s s1\"", "class=\"axis\"", "class=\"grid\"", "var(--s0,", "viewBox=\"0 0 "})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

TEST(Figure, EqualAxesAreAsLongAsWhatTheyShow) {
  FigureOptions o = of({"theta"});
  o.x = "x";
  o.equal = true;
  Figure f = make_figure(disc(), o);
  const Figure before = f;
  make_equal(f, 300, 100);
  const double x = f.x_axis.to - f.x_axis.from, y = f.panels[0].y.to - f.panels[0].y.from;
  EXPECT_NEAR(x / 300, y / 100, 1e-15);
  EXPECT_LE(f.x_axis.from, before.x_axis.from);
  EXPECT_GE(f.x_axis.to, before.x_axis.to);
  EXPECT_LE(f.panels[0].y.from, before.panels[0].y.from);
  EXPECT_GE(f.panels[0].y.to, before.panels[0].y.to);
}

// A circle is as wide as it is high, on paper and in the dots of a terminal.
TEST(Figure, ACircleIsRound) {
  std::vector<double> t, x, y;
  for (int k = 0; k <= 200; ++k)
    t.push_back(k), x.push_back(3 * std::cos(k * 0.0314159265)), y.push_back(3 * std::sin(k * 0.0314159265));
  const RunFile circle = run({"t", "x", "y"}, {t, x, y});
  FigureOptions o = of({"y"});
  o.x = "x";
  for (const bool equal : {true, false}) {
    o.equal = equal;
    double least_x = 1e9, most_x = -1e9, least_y = 1e9, most_y = -1e9;
    for (const Stroke& s : lay_out(make_figure(circle, o)).strokes) {
      if (s.role != Role::series) continue;
      for (const Point& p : s.points)
        least_x = std::min(least_x, p.x), most_x = std::max(most_x, p.x), least_y = std::min(least_y, p.y),
        most_y = std::max(most_y, p.y);
    }
    const double ratio = (most_x - least_x) / (most_y - least_y);
    if (equal)
      EXPECT_NEAR(ratio, 1, 0.01);
    else
      EXPECT_GT(ratio, 1.3);
  }
}

TEST(Tex, NamesAreLatex) {
  FigureOptions o = of({"x", "theta'"});
  o.title = "50%";
  const std::string tex = draw_tex(make_figure(disc(), o));
  for (const char* part : {"\\addlegendentry{$\\dot{\\theta}$}", "xlabel={$t$}", "title={50\\%}", "\\begin{groupplot}",
                           "\\addplot[color=anholon1] coordinates {\n(0,1)(1,1)(2,2)\n};"})
    EXPECT_NE(tex.find(part), std::string::npos) << part << "\n" << tex;
}

TEST(Cairo, SaysWhereItCannotWrite) {
  const std::string why = no_cairo().empty() ? "No such file or directory" : no_cairo();
  const Figure f = make_figure(disc(), {});
  EXPECT_EQ(draw_cairo(f, CairoFormat::pdf, "/no/such/folder/a.pdf"), why);
  EXPECT_EQ(draw_cairo(f, CairoFormat::png, "/no/such/folder/a.png"), why);
}

TEST(Cairo, DrawsTheSameBytes) {
#ifdef __SANITIZE_ADDRESS__
  const __lsan::ScopedDisabler kept;  // fontconfig keeps its data of fonts until the end
#endif
  FigureOptions o = of({"theta'", "lambda.*"});
  o.title = "Scheibe";
  const Figure f = make_figure(disc(), o);
  const auto drawn = [&](CairoFormat format) {
    const std::string path = ::testing::TempDir() + "anholon-figure-" + std::to_string(getpid());
    EXPECT_EQ(draw_cairo(f, format, path), no_cairo());
    std::string bytes;
    if (std::FILE* file = std::fopen(path.c_str(), "rb")) {
      for (int c; (c = std::fgetc(file)) != EOF;) bytes += static_cast<char>(c);
      std::fclose(file);
    }
    std::remove(path.c_str());
    return bytes;
  };
  const std::string pdf = drawn(CairoFormat::pdf), png = drawn(CairoFormat::png);
  if (!no_cairo().empty()) {
    EXPECT_EQ(pdf + png, "");
    return;
  }
  EXPECT_EQ(pdf.substr(0, 5), "%PDF-");
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_GT(png.size(), 2000u);
  EXPECT_EQ(drawn(CairoFormat::pdf), pdf);
  EXPECT_EQ(drawn(CairoFormat::png), png);
}

// Few rows of exp(-10 t): on a logarithmic axis the curve between them is the line through the rows.
TEST(Smooth, FollowsLogarithmsOnALogarithmicAxis) {
  std::vector<double> t, y, rate;
  for (int k = 0; k <= 10; ++k) t.push_back(0.5 * k), y.push_back(std::exp(-5.0 * k)), rate.push_back(-10 * y.back());
  FigureOptions o = of({"y"});
  o.smooth = o.log = true;
  for (const RunFile& r : {run({"t", "y", "y'"}, {t, y, rate}), run({"t", "y"}, {t, y})}) {
    const Figure f = make_figure(r, o);
    ASSERT_GT(f.x.size(), 100U);
    double worst = 0;
    for (std::size_t i = 0; i < f.x.size(); ++i)
      worst = std::max(worst, std::abs(std::log(f.panels[0].series[0].y[i]) + 10 * f.x[i]));
    EXPECT_LT(worst, 1e-9);
  }
}

TEST(Smooth, KeepsAModeUpToTheNextRow) {
  FigureOptions o = of({"floor.mode"});
  o.smooth = true;
  const Figure f = make_figure(run({"t", "floor.mode"}, {{0, 1, 2, 3, 4}, {1, 1, 2, 2, 2}}), o);
  for (std::size_t i = 0; i < f.x.size(); ++i) EXPECT_EQ(f.panels[0].series[0].y[i], f.x[i] < 2 ? 1 : 2) << f.x[i];
}

TEST(Axes, NumbersThatAreTooFarApartAreRefused) {
  EXPECT_EQ(trouble(run({"t", "x"}, {{0, 1}, {-1.7e308, 1.7e308}}), of({"x"})),
            "the numbers of 'x' are too far apart for an axis");
  EXPECT_EQ(trouble(run({"t", "x"}, {{0, 1}, {-1e306, 1e306}}), of({"x"})), "none");
}

TEST(Layout, LongTitlesTakeLinesAndSmallFiguresAreRefused) {
  FigureOptions o = of({"theta"});
  o.title = "The lean of a disc that rolls on a plane, with a title that is longer than its figure is wide, by far";
  const Figure f = make_figure(disc(), o);
  std::size_t lines = 0;
  for (const Word& w : lay_out(f).words) lines += w.anchor == Anchor::middle && w.at.y < 40;
  EXPECT_GT(lines, 1U);
  o.width = 3, o.height = 2;
  EXPECT_THROW(lay_out(make_figure(disc(), o)), Failure);
}

TEST(Layout, ThirtyTwoCurvesDifferInColourOrDash) {
  std::set<std::pair<std::size_t, std::string>> styles;
  for (std::size_t k = 0; k < kColours * kDashes; ++k) styles.insert({k % kColours, dash_of(k).css});
  EXPECT_EQ(styles.size(), kColours * kDashes);
}

}  // namespace
}  // namespace anholon::plot::figure_test
