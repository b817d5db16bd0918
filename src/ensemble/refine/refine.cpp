#include "ensemble/refine/refine.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/json.h"
#include "ensemble/refine/borders.h"
#include "result/table.h"

namespace anholon {

namespace {

constexpr const char* kHint = "--refine-by theta:0.1: neighbours whose theta differs by more than 0.1 are a border";
constexpr std::size_t kMostAxes = 6;  // 3^6 points around a cell

// The kinds of ends of motions, numbered in the order in which they come.
class Kinds {
 public:
  std::uint32_t of(const std::string& words) {
    const auto at = std::find(list_.begin(), list_.end(), words) - list_.begin();
    if (at == std::ssize(list_)) list_.push_back(words);
    return static_cast<std::uint32_t>(at);
  }

 private:
  std::vector<std::string> list_;
};

const ParquetColumn* column_of(const ParquetTable& table, std::string_view name) {
  for (const ParquetColumn& c : table.columns)
    if (c.name == name) return &c;
  return nullptr;
}

double number_at(const ParquetColumn& c, std::size_t row) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&c.values)) return (*numbers)[row];
  if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&c.values)) return static_cast<double>((*whole)[row]);
  return std::get<Words>(c.values).rows[row];
}

// Appends what the rows of a part tell about its cases; the last row of a case counts.
void look_at(const ParquetTable& table, const std::string& path, const std::string& column, Kinds& kinds,
             std::vector<Sight>& sights) {
  const ParquetColumn* number = column_of(table, "case");
  const ParquetColumn* shown = column.empty() ? nullptr : column_of(table, column);
  std::vector<const Words*> ends;
  for (const char* name : {"outcome", "event"})
    if (const ParquetColumn* c = column_of(table, name); c && std::holds_alternative<Words>(c->values))
      ends.push_back(&std::get<Words>(c->values));
  if (!number || (!column.empty() && !shown)) throw Failure({}, path + " has other columns than the sweep");
  for (std::size_t row = 0; row < table.rows(); ++row) {
    if (row + 1 < table.rows() && number_at(*number, row) == number_at(*number, row + 1)) continue;
    std::string words;
    for (const Words* w : ends) words += w->different.at(w->rows[row]) + '\n';
    sights.push_back({kinds.of(words), shown ? number_at(*shown, row) : 0});
  }
}

Borders::Differ differ_by(const RefineRule& rule) {
  return [bound = rule.bound](const Sight& a, const Sight& b) {
    return a.kind != b.kind || std::isnan(a.value) != std::isnan(b.value) || std::abs(a.value - b.value) > bound;
  };
}

}  // namespace

std::string RefineRule::text() const { return column.empty() ? std::string() : column + ":" + number_text(bound); }

RefineRule refine_rule(const std::string& word) {
  RefineRule rule;
  if (word.empty()) return rule;
  const std::size_t colon = word.rfind(':');
  if (colon == std::string::npos || colon == 0)
    mistake_in(word, 0, word.size(), "this is not of the form COLUMN:BOUND", kHint);
  rule.column = word.substr(0, colon);
  const char* end = word.data() + word.size();
  const auto [stop, why] = std::from_chars(word.data() + colon + 1, end, rule.bound);
  if (why != std::errc() || stop != end || !(rule.bound >= 0) || std::isinf(rule.bound))
    mistake_in(word, colon + 1, std::max<std::size_t>(1, word.size() - colon - 1),
               "a bound is a number that is not negative", kHint);
  return rule;
}

void must_be_refinable(const Variation& variation, const std::vector<std::string>& columns, const RefineRule& rule) {
  variation.must_be_a_grid();
  const auto has = [&](const std::string& name) {
    return std::find(columns.begin(), columns.end(), name) != columns.end();
  };
  if (!rule.column.empty() && !has(rule.column)) {
    const std::string near = did_you_mean(rule.column, columns);
    throw Failure({},
                  "the sweep keeps no column '" + rule.column + "' to refine by" +
                      (near.empty() ? "" : "; did you mean '" + near + "'?"),
                  kHint);
  }
  if (is_column_of_words(rule.column))
    throw Failure({}, "the column '" + rule.column + "' holds words, and a bound is one of numbers",
                  "borders between outcomes and events are refined in any case; leave out the rule, or give a column "
                  "of numbers");
  if (rule.column.empty() && !has("outcome"))
    throw Failure({}, "without the column 'outcome' nothing tells where a border is",
                  "add outcome to the columns, or give a column to refine by");
  const std::vector<std::size_t>& axes = variation.axes();
  const auto wide = std::count_if(axes.begin(), axes.end(), [](std::size_t points) { return points > 1; });
  if (wide == 0) throw Failure({}, "one case has no neighbours, and no border to refine", "several values");
  if (wide > static_cast<std::ptrdiff_t>(kMostAxes))
    throw Failure({}, "borders are refined over at most " + std::to_string(kMostAxes) + " variations", "fewer grids");
}

void must_go_on(const SweepStore& store, const RefineRule& rule) {
  for (std::size_t g = 1; g < store.generations().size(); ++g)
    if (const std::string& before = store.generations()[g].rule; before != rule.text())
      throw Failure({},
                    store.folder() + " was refined by " +
                        (before.empty() ? "outcomes and events" : "'" + before + "'") + ", not by " +
                        (rule.column.empty() ? "these alone" : "'" + rule.text() + "'"),
                    "the same rule goes on; another one needs another folder");
}

std::size_t add_generation(SweepStore& store, const Variation& variation, const RefineRule& rule) {
  must_go_on(store, rule);
  const Borders::Differ differ = differ_by(rule);
  Borders borders(variation.axes());
  Kinds kinds;
  std::vector<std::int64_t> next;
  const std::vector<Generation> before = store.generations();
  for (std::size_t g = 0; g < before.size(); ++g) {
    if (g > 0 && store.points_of(g) != next)
      throw Failure({},
                    "generation " + std::to_string(g) + " of " + store.folder() + " has other points than its borders",
                    "a part before it was changed, or another version of the program planned it");
    std::vector<Sight> sights;
    sights.reserve(before[g].cases);
    for (std::size_t part = before[g].first_part; part < before[g].first_part + before[g].parts; ++part)
      look_at(store.read(part), store.path_of(part), rule.column, kinds, sights);
    if (sights.size() != before[g].cases)
      throw Failure({}, store.folder() + " holds other cases than it should",
                    "remove its parts; the same command computes them again");
    borders.see(sights);
    next = borders.next(differ);
  }
  const std::size_t axes = variation.axes().size();
  if (!next.empty()) store.add_generation(next, axes, rule.text());
  return next.size() / axes;
}

std::function<EnsembleCase(std::size_t)> numbers_of(const SweepStore& store, const Variation& variation) {
  const std::vector<Generation> generations = store.generations();
  auto points = std::make_shared<std::vector<std::vector<std::int64_t>>>();
  for (std::size_t g = 0; g < generations.size(); ++g)
    points->push_back(g == 0 ? std::vector<std::int64_t>() : store.points_of(g));
  return [generations, points, &variation](std::size_t number) -> EnsembleCase {
    const std::size_t g = generation_of(generations, number);
    if (g == 0) return {variation(number), {}};
    const std::size_t axes = variation.axes().size(), at = (number - generations[g].first_case) * axes;
    return {variation.between(std::span((*points)[g]).subspan(at, axes), static_cast<unsigned>(g)), {}};
  };
}

}  // namespace anholon
