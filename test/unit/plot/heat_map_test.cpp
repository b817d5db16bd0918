#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <set>

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/diagnostic.h"
#include "plot/heat_map.h"
#include "plot/histogram.h"

namespace anholon::plot::heat_map_test {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

TEST(HeatMap, HasACellForEachPairOfValues) {
  // (x, y): value, in any order; there is no case at (2, 20).
  const HeatMap m = make_heat_map({"x", "m", {2, 1, 1}}, {"y", "", {10, 10, 20}}, {"v", "", {5, 3, 7}}, {});
  EXPECT_EQ(m.x.values, (std::vector<double>{1, 2}));
  EXPECT_EQ(m.y.values, (std::vector<double>{10, 20}));
  EXPECT_EQ(m.values[0], 3);
  EXPECT_EQ(m.values[1], 5);
  EXPECT_EQ(m.values[2], 7);
  EXPECT_TRUE(std::isnan(m.values[3]));
}

TEST(HeatMap, TakesMeansAndTheMostFrequentWord) {
  const NamedColumn x{"x", "", {1, 1, 1, 1}}, y{"y", "", {1, 1, 1, 1}};
  EXPECT_EQ(make_heat_map(x, y, {"v", "", {1, 2, 6, kNone}}, {}).values[0], 3);
  EXPECT_EQ(make_heat_map(x, y, {"v", "", {1, 0, 1, 0}}, {"finished", "fell"}).values[0], 0);
  EXPECT_EQ(make_heat_map(x, y, {"v", "", {1, 0, 1, 1}}, {"finished", "fell"}).values[0], 1);
}

TEST(HeatMap, CutsManyValuesIntoCells) {
  NamedColumn x{"x", "", {}}, y{"y", "", {}}, v{"v", "", {}};
  for (int k = 0; k <= 1000; ++k) x.values.push_back(k), y.values.push_back(0), v.values.push_back(k);
  const HeatMap m = make_heat_map(x, y, v, {});
  ASSERT_EQ(m.x.values.size(), kMostCells);
  for (std::size_t k = 0; k < kMostCells; ++k) EXPECT_NEAR(m.values[k], m.x.values[k], 1000.0 / kMostCells);
}

TEST(HeatMap, HasTheCellsOfPointsWhereCasesAreMissing) {
  const NamedColumn x{"x", "", {2, 2}, "", {2, 4, 6}}, y{"y", "", {1, 0}, "", {0, 1}};
  const HeatMap m = make_heat_map(x, y, {"v", "", {5, 3}}, {});
  EXPECT_EQ(m.x.values, (std::vector<double>{2, 4, 6}));
  EXPECT_EQ(m.values[0], 3);
  EXPECT_EQ(m.values[3], 5);
  for (const std::size_t empty : {1U, 2U, 4U, 5U}) EXPECT_TRUE(std::isnan(m.values[empty]));
  // A cell reaches to the middle between two points; if only the points of cases counted, the cases would fill the
  // width.
  const std::vector<HeatMap::Finer> cells = cells_of_cases(x, y, {});
  EXPECT_EQ(cells[0].from.x, 1);
  EXPECT_EQ(cells[0].to.x, 3);
}

TEST(HeatMap, DrawsFurtherGenerationsAtTheirSizes) {
  const NamedColumn x{"x", "", {0, 2, 6, 1, 0.5, 4}}, y{"y", "", {0, 1, 0, 0, 0, 0.5}};
  const HeatMap m = make_heat_map(x, y, {"v", "", {1, 2, 3, 4, 5, 6}}, {}, {0, 0, 0, 1, 2, 1});
  EXPECT_EQ(m.x.values, (std::vector<double>{0, 2, 6}));
  ASSERT_EQ(m.finer.size(), 3U);
  // The cells of generation 1 have half of the interval from 0 to 2, and half of that from 2 to 6.
  EXPECT_EQ(m.finer[0].from.x, 0.5);
  EXPECT_EQ(m.finer[0].to.x, 1.5);
  EXPECT_EQ(m.finer[0].from.y, -0.25);
  EXPECT_EQ(m.finer[0].to.y, 0.25);
  EXPECT_EQ(m.finer[1].from.x, 3);
  EXPECT_EQ(m.finer[1].to.x, 5);
  EXPECT_EQ(m.finer[1].value, 6);
  EXPECT_EQ(m.finer[2].from.x, 0.25);
  EXPECT_EQ(m.finer[2].to.x, 0.75);
  const Drawing d = lay_out(m);
  const Patch& last = d.patches.back();
  EXPECT_NEAR(last.to.x - last.from.x,
              (d.patches[d.patches.size() - 3].to.x - d.patches[d.patches.size() - 3].from.x) / 2, 1e-9);
}

// Beyond the first and the last value there are no cells.
TEST(HeatMap, OfFurtherGenerationsEndsAtTheOutermostValues) {
  HeatMap m = make_heat_map({"x", "", {0, 4, 0, 4, 0, 1}}, {"y", "", {0, 0, 2, 2, 1, 0}}, {"v", "", {1, 2, 3, 4, 5, 6}},
                            {}, {0, 0, 0, 0, 1, 2});
  ASSERT_EQ(m.finer.size(), 2U);
  EXPECT_LT(m.finer[0].from.x, 0);
  const Drawing d = lay_out(m);
  double left = 1e9, right = -1e9;
  for (const auto& s : d.strokes)
    if (s.points.size() == 5) left = std::min(left, s.points[0].x), right = std::max(right, s.points[0].x);
  // The scale at the right has a frame as well.
  for (const auto& p : d.patches) {
    EXPECT_GE(p.from.x, left);
    EXPECT_LE(p.from.x, p.to.x);
    EXPECT_LE(p.from.y, p.to.y);
  }
  std::size_t at_left = 0;
  for (const auto& p : d.patches) at_left += p.from.x == left;
  EXPECT_EQ(at_left, 3U) << "two coarse cells and a finer one";
}

TEST(Histogram, CountsNumbersAndWords) {
  NamedColumn of{"v", "m", {kNone}};
  for (int k = 0; k < 1000; ++k) of.values.push_back(k < 900 ? 0.001 * k : 2);
  const Histogram h = make_histogram(of, {});
  EXPECT_EQ(h.counts.size(), 20U);
  EXPECT_EQ(h.left_out, 1U);
  std::size_t all = 0;
  for (const std::size_t count : h.counts) all += count;
  EXPECT_EQ(all, 1000U);
  EXPECT_EQ(h.counts.back(), 100U);
  EXPECT_EQ(h.counts[10], 0U);
  EXPECT_NEAR(static_cast<double>(h.counts[3]), 100, 1);
  const Histogram words = make_histogram({"outcome", "", {0, 1, 0}}, {"finished", "fell"});
  EXPECT_EQ(words.counts, (std::vector<std::size_t>{2, 1}));
  const Drawing d = lay_out(words);
  ASSERT_EQ(d.patches.size(), 2U);
  EXPECT_NEAR(d.patches[0].to.y - d.patches[0].from.y, 2 * (d.patches[1].to.y - d.patches[1].from.y), 1e-9);
  EXPECT_EQ(make_histogram({"v", "", {7, 7}}, {}).from, 3.5);
  EXPECT_THROW(make_histogram({"v", "", {kNone}}, {}), Failure);
}

TEST(HeatMap, RefusesColumnsWithoutNumbers) {
  EXPECT_THROW(make_heat_map({"x", "", {kNone}}, {"y", "", {1}}, {"v", "", {1}}, {}), Failure);
}

TEST(HeatMap, PaintsEachCellInItsPlace) {
  const HeatMap m =
      make_heat_map({"x", "", {0, 1, 0, 1}}, {"y", "", {0, 0, 1, 1}}, {"v", "", {0, 1, 1, 0}}, {"a", "b"});
  const Drawing d = lay_out(m);
  // Two patches belong to the legend; the cells follow, the lower row first.
  ASSERT_EQ(d.patches.size(), 6U);
  const Patch &low = d.patches[2], &high = d.patches[5];
  EXPECT_EQ(low.rgb, d.patches[0].rgb);
  EXPECT_EQ(high.rgb, d.patches[0].rgb);
  EXPECT_EQ(d.patches[3].rgb, d.patches[1].rgb);
  EXPECT_LT(low.from.x, high.from.x);
  EXPECT_GT(low.from.y, high.from.y);
  EXPECT_NEAR(low.to.x, high.from.x, 1e-9);
  EXPECT_NE(draw_svg(d, "falls").find("<rect"), std::string::npos);
}

// The map of columns x rows cells of different values, and the place of its cells in points.
struct Map {
  Drawing drawing;
  Point from{1e9, 1e9}, to{0, 0};
};
Map map_of(int columns, int rows, double width, double height) {
  NamedColumn x{"x", "", {}}, y{"y", "", {}}, v{"v", "", {}};
  for (int k = 0; k < rows; ++k)
    for (int i = 0; i < columns; ++i)
      x.values.push_back(i + 1), y.values.push_back(k + 1), v.values.push_back(i + 2 * k);
  HeatMap m = make_heat_map(x, y, v, {});
  m.width = width, m.height = height;
  Map map{lay_out(m), {1e9, 1e9}, {0, 0}};
  constexpr std::size_t kScale = 64;  // the patches of the scale of colours, which come first
  for (std::size_t k = kScale; k < map.drawing.patches.size(); ++k) {
    const Patch& p = map.drawing.patches[k];
    map.from = {std::min(map.from.x, p.from.x), std::min(map.from.y, p.from.y)};
    map.to = {std::max(map.to.x, p.to.x), std::max(map.to.y, p.to.y)};
  }
  return map;
}

// Returns the number of white pixels inside the map; -1 if cairo cannot read pictures here.
int white_pixels(const Map& map, void* cairo) {
  const auto find = [&](auto*& function, const char* name) {
    function = reinterpret_cast<std::decay_t<decltype(function)>>(dlsym(cairo, name));
    return function != nullptr;
  };
  void* (*read)(const char*) = nullptr;
  const unsigned char* (*data_of)(void*) = nullptr;
  int (*stride_of)(void*) = nullptr;
  void (*destroy)(void*) = nullptr;
  if (!find(read, "cairo_image_surface_create_from_png") || !find(data_of, "cairo_image_surface_get_data") ||
      !find(stride_of, "cairo_image_surface_get_stride") || !find(destroy, "cairo_surface_destroy"))
    return -1;
  const std::string path = ::testing::TempDir() + "anholon-map-" + std::to_string(getpid()) + ".png";
  EXPECT_EQ(draw_cairo(map.drawing, "", CairoFormat::png, path), "");
  void* picture = read(path.c_str());
  std::remove(path.c_str());
  const unsigned char* data = data_of(picture);
  if (!data) return -1;
  constexpr double kPixels = 200.0 / 72;
  constexpr int kFrame = 3;  // pixels of the frame
  int white = 0;
  for (int y = static_cast<int>(map.from.y * kPixels) + kFrame; y < static_cast<int>(map.to.y * kPixels) - kFrame; ++y)
    for (int x = static_cast<int>(map.from.x * kPixels) + kFrame; x < static_cast<int>(map.to.x * kPixels) - kFrame;
         ++x) {
      const unsigned char* pixel = data + y * stride_of(picture) + 4 * x;
      white += pixel[0] == 255 && pixel[1] == 255 && pixel[2] == 255;
    }
  destroy(picture);
  return white;
}

TEST(HeatMap, ShowsNoPaperBetweenCells) {
  void* cairo = no_cairo().empty() ? dlopen("libcairo.so.2", RTLD_NOW | RTLD_LOCAL) : nullptr;
  if (!cairo) GTEST_SKIP() << "cairo is not here";
  for (const auto& [width, height] : {std::pair{14.0, 9.0}, {16.0, 11.0}, {9.3, 7.1}})
    for (int n = 1; n < 40; n += 2)
      EXPECT_EQ(white_pixels(map_of(n, n + 2, width, height), cairo), 0)
          << n << " columns, " << width << " cm x " << height << " cm";
  dlclose(cairo);
}

// In an SVG, too, the cells above and beside a cell begin where it ends, to the last decimal.
TEST(HeatMap, HasCellsThatMeetInAnSvg) {
  for (int n = 2; n < 20; ++n) {
    const std::string svg = draw_svg(map_of(n, n + 2, 14, 9).drawing, "");
    std::set<long> starts, ends;
    for (std::size_t at = svg.find("<rect"); at != std::string::npos; at = svg.find("<rect", at + 1)) {
      double x = 0, y = 0, width = 0, height = 0;
      ASSERT_EQ(std::sscanf(svg.c_str() + at, "<rect x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &x, &y, &width,
                            &height),
                4);
      starts.insert(std::lround(100 * x));
      ends.insert(std::lround(100 * (x + width)));
    }
    // All columns but the first one begin where another one ends; so does none of the scale of colours.
    std::vector<long> alone;
    std::set_difference(starts.begin(), starts.end(), ends.begin(), ends.end(), std::back_inserter(alone));
    EXPECT_EQ(alone.size(), 2U) << n;
  }
}

}  // namespace anholon::plot::heat_map_test
