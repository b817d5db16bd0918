#include "cli/pictures/sweep_page.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>

#include "base/escape.h"
#include "base/json.h"
#include "cli/pictures/sweep_cases.h"
#include "cli/pictures/sweep_page_script.h"

namespace anholon::cli {

namespace {

constexpr std::size_t kMostNumbers = 4'000'000;  // of a page: some 40 MB

// Doubles as base64 of their bytes, the least significant first.
std::string base64(const std::vector<double>& values) {
  static_assert(std::endian::native == std::endian::little);
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes(values.size() * sizeof(double), '\0'), text;
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  const auto byte = [&](std::size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U; };
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    const unsigned three = byte(k) << 16 | byte(k + 1) << 8 | byte(k + 2);
    for (unsigned n = 0; n < 4; ++n) text += k + n <= bytes.size() ? kLetters[three >> (18 - 6 * n) & 63U] : '=';
  }
  return text;
}

// The last row of each case; of many cases one in each of 256 x 256 cells.
std::vector<std::size_t> rows_to_show(const std::vector<double>& numbers, const std::vector<plot::NamedColumn>& axes,
                                      std::size_t columns) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < numbers.size(); ++row)
    if (row + 1 == numbers.size() || numbers[row + 1] != numbers[row]) rows.push_back(row);
  if (rows.size() * columns <= kMostNumbers) return rows;
  std::set<std::vector<int>> seen;
  std::vector<std::pair<double, double>> ranges;
  for (const plot::NamedColumn& a : axes) {
    const auto [least, greatest] = std::minmax_element(a.values.begin(), a.values.end());
    ranges.emplace_back(*least, std::max(*greatest - *least, 1e-300));
  }
  std::erase_if(rows, [&](std::size_t row) {
    std::vector<int> cell;
    for (std::size_t k = 0; k < axes.size(); ++k)
      cell.push_back(static_cast<int>(256 * (axes[k].values[row] - ranges[k].first) / ranges[k].second));
    return !seen.insert(cell).second;
  });
  return rows;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::size_t>& rows) {
  std::vector<T> list;
  for (const std::size_t row : rows) list.push_back(all[row]);
  return list;
}

std::string label(const plot::NamedColumn& c) {
  return plot::plain_text(plot::axis_label(c, "", plot::LabelStyle::unicode));
}

}  // namespace

std::string page_of_sweep(const PlotCommand& o) {
  const SweepCases cases(o.run);
  std::vector<std::string> names = cases.names(), words, axis_names;
  for (const std::string& given : {o.abscissa, o.ordinate})
    if (!given.empty()) axis_names.push_back(given);
  for (const std::string& name : cases.varied())
    if (axis_names.size() < 2 && std::find(axis_names.begin(), axis_names.end(), name) == axis_names.end())
      axis_names.push_back(name);
  if (axis_names.empty())
    throw Failure({}, "the columns of the sweep do not tell what varies", "--x and --y name columns of the sweep");
  const std::vector<std::string> asked = split(o.columns);
  if (asked.size() > 1) throw Failure({}, "a page of a sweep begins with one column", "its menu has all columns");
  const std::string shown = asked.empty() ? "outcome" : asked[0];
  std::vector<plot::NamedColumn> axes = cases.read(axis_names, words);
  if (!words.empty()) throw Failure({}, "an axis shows numbers, and a column of words was named", "--x theta --y phi");
  cases.read({shown}, words), words.clear();
  std::vector<std::string> none;
  const std::vector<double> numbers = cases.read({"case"}, none)[0].values;
  if (numbers.empty()) throw Failure({}, "no part is in " + o.run, "the command of the sweep computes them");
  const std::vector<std::size_t> rows = rows_to_show(numbers, axes, names.size());

  std::vector<unsigned> generations = cases.generations();
  if (!generations.empty()) generations = chosen(generations, rows);
  for (plot::NamedColumn& a : axes) a.values = chosen(a.values, rows);
  JsonWriter j;
  const std::string title = o.title.empty() ? cases.store() ? cases.store()->asked("title") : o.run : o.title;
  j.open_object().key("title").string(title).key("shown").string(shown).key("command").string(cases.command());
  j.key("model").string(cases.store() ? cases.store()->asked("model") : "");
  j.key("varied").open_array();
  for (const std::string& name : cases.varied()) j.string(name);
  j.close().key("axes").open_array();
  for (const plot::NamedColumn& a : axes)
    j.open_object().key("name").string(a.name).key("label").string(label(a)).close();
  j.close().key("columns").open_array();
  for (const std::string& name : names) {
    std::vector<std::string> of_column;
    const plot::NamedColumn c = cases.read({name}, of_column)[0];
    j.open_object().key("name").string(name).key("label").string(label(c)).key("data").string(
        base64(chosen(c.values, rows)));
    j.key("words").open_array();
    for (const std::string& word : of_column) j.string(word);
    j.close().close();
  }
  j.close();
  if (axes.size() == 2) {
    std::vector<double> corners;
    for (const plot::HeatMap::Finer& cell : plot::cells_of_cases(axes[0], axes[1], generations))
      for (const double v : {cell.from.x, cell.to.x, cell.from.y, cell.to.y}) corners.push_back(v);
    j.key("cells").string(base64(corners));
  }
  std::string data = j.key("all").integer(static_cast<long long>(numbers.size())).close().text();
  // The text of a model may hold the end of a script.
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos; at += 6) data.replace(at, 1, "\\u003c");
  std::string page = std::string(kSweepPageHead) + markup_escape(title) + kSweepPageBody + data + kSweepPageScript;
  return page;
}

}  // namespace anholon::cli
