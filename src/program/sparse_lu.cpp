#include "program/sparse_lu.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace anholon {

namespace {

// A pivot is at least this fraction of the largest entry of its row.
constexpr double kThreshold = 0.05;
constexpr double kVanishes = 1e-12;
constexpr int kScalings = 3;

// A rule for ties: many pivots cost the same, and the choice decides about later fill.
struct Order {
  int candidates;  // the maximal number of shortest rows and columns that are searched for the next pivot
  enum class Tie { largest, first_row, last_column } tie;
};
constexpr Order kUsual{6, Order::Tie::largest};
// If the elimination fills in more per row than this, other orders are tried, for matrices that are not large; no rule
// is known that predicts the best order.
constexpr std::size_t kMuchFill = 5, kLarge = 1000;
constexpr int kAll = 2 * static_cast<int>(kLarge);
constexpr Order kOthers[] = {{kAll, Order::Tie::first_row}, {kAll, Order::Tie::last_column}};
// Larger matrices are numbered along the mechanism first (numbers_along), and pivots are taken from one end of it: in
// the usual order the fill of a long chain grows faster than the chain, as pivots are chosen all over it. If more is
// filled in per row than this, the usual order is tried as well.
constexpr Order kAlong{3, Order::Tie::first_row};
constexpr std::size_t kMuchFillAlong = 30;

// The new numbers of rows and columns.
struct Numbers {
  std::vector<std::uint32_t> row, column;
};

// Numbers rows and columns by the distance from one end (reverse Cuthill-McKee on the graph of rows and columns), so
// that entries are near the diagonal.
Numbers numbers_along(std::uint32_t n, std::span<const SampledEntry> entries) {
  std::vector<std::vector<std::uint32_t>> near(2 * std::size_t{n});  // rows, then columns
  for (const SampledEntry& e : entries) near[e.row].push_back(n + e.column), near[n + e.column].push_back(e.row);
  for (auto& list : near)
    std::sort(list.begin(), list.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::pair(near[a].size(), a) < std::pair(near[b].size(), b);
    });
  // Adds all nodes that are connected with a node to `order`; returns the farthest one.
  std::vector<bool> seen(near.size(), false);
  const auto spread = [&](std::uint32_t start, std::vector<std::uint32_t>& order) {
    std::size_t next = order.size();
    order.push_back(start);
    seen[start] = true;
    for (; next < order.size(); ++next)
      for (const std::uint32_t other : near[order[next]])
        if (!seen[other]) seen[other] = true, order.push_back(other);
    return order.back();
  };
  std::vector<std::uint32_t> order;
  for (std::uint32_t node = 0; node < near.size(); ++node) {
    if (seen[node]) continue;
    constexpr int kRounds = 4;
    std::uint32_t end = node;
    for (int round = 0; round < kRounds; ++round) {
      std::vector<std::uint32_t> connected;
      end = spread(end, connected);
      for (const std::uint32_t other : connected) seen[other] = false;
    }
    spread(end, order);
  }
  Numbers out{std::vector<std::uint32_t>(n), std::vector<std::uint32_t>(n)};
  std::uint32_t row = 0, column = 0;
  for (auto node = order.rbegin(); node != order.rend(); ++node)
    if (*node < n)
      out.row[*node] = row++;
    else
      out.column[*node - n] = column++;
  return out;
}

using Values = std::array<double, kSamples>;

class Eliminated {
 public:
  Eliminated(std::uint32_t n, std::size_t samples, const Order& order, SparseLu& out)
      : n_(n), samples_(samples), order_(order), out_(out), rows_(n), columns_(n), largest_(n), version_(n, 1) {}

  void add(const SampledEntry& e) {
    const auto [at, fresh] = entry(rows_[e.row], e.column, entries_.size());
    if (fresh) {
      entries_.push_back({.value = e.value, .exact = e.exact});
      for (std::size_t k = 0; k < samples_; ++k) entries_.back().terms[k] = std::abs(e.value[k]);
      insert(columns_[e.column], e.row);
    } else {
      for (std::size_t k = 0; k < samples_; ++k)
        entries_[at].terms[k] = std::max(entries_[at].terms[k], std::abs(e.value[k]));
      for (std::size_t k = 0; k < samples_; ++k) entries_[at].value[k] += e.value[k];
      entries_[at].exact = false;
    }
    out_.place.push_back(at);
  }

  // Scales by powers of 2, so that large entries are significant ones.
  void scale() {
    row_scale_.assign(n_, {});
    column_scale_.assign(n_, {});
    for (std::size_t k = 0; k < samples_; ++k) {
      for (std::uint32_t i = 0; i < n_; ++i) row_scale_[i][k] = column_scale_[i][k] = 1;
      for (int round = 0; round < kScalings; ++round) {
        std::vector<double> most(n_, 0);
        for (std::uint32_t i = 0; i < n_; ++i)
          for (const auto& [j, e] : rows_[i])
            most[i] = std::max(most[i], std::abs(entries_[e].value[k]) * row_scale_[i][k] * column_scale_[j][k]);
        for (std::uint32_t i = 0; i < n_; ++i)
          if (most[i] > 0) row_scale_[i][k] *= std::exp2(-std::round(std::log2(most[i])));
        most.assign(n_, 0);
        for (std::uint32_t i = 0; i < n_; ++i)
          for (const auto& [j, e] : rows_[i])
            most[j] = std::max(most[j], std::abs(entries_[e].value[k]) * row_scale_[i][k] * column_scale_[j][k]);
        for (std::uint32_t j = 0; j < n_; ++j)
          if (most[j] > 0) column_scale_[j][k] *= std::exp2(-std::round(std::log2(most[j])));
      }
    }
  }

  bool run() {
    for (std::uint32_t i = 0; i < n_; ++i)
      short_rows_.insert({rows_[i].size(), i}), short_columns_.insert({columns_[i].size(), i});
    for (std::int64_t k = 0; k < n_; ++k) {
      best_ = {};
      int looked = 0;
      auto row = short_rows_.begin(), column = short_columns_.begin();
      while (looked < order_.candidates && (row != short_rows_.end() || column != short_columns_.end())) {
        if (best_.found && best_.cost == 0 && best_.exact) break;
        // An entry that was not considered is in a row and in a column that are no shorter than these.
        if (best_.found && (row == short_rows_.end() || column == short_columns_.end() ||
                            least_cost(row->first, column->first) > best_.cost))
          break;
        if (column == short_columns_.end() || (row != short_rows_.end() && row->first <= column->first)) {
          const std::uint32_t i = (row++)->second;
          for (const auto& [j, e] : rows_[i]) consider(i, j, e);
        } else {
          const std::uint32_t j = (column++)->second;
          for (std::uint32_t i : columns_[j]) consider(i, j, find(rows_[i], j)->second);
        }
        if (best_.found) ++looked;
      }
      if (!best_.found && one_sign_) {
        // The next attempt takes any pivot that is not small, even if it passes through zero somewhere.
        one_sign_ = false;
        --k;
        continue;
      }
      if (!best_.found && !small_) {
        // The last attempt takes any pivot that is not round-off of its terms: coefficients of very different sizes
        // have no common scale.
        small_ = true;
        for (std::uint32_t& version : version_) ++version;
        --k;
        continue;
      }
      if (!best_.found) return false;
      one_sign_ = true;
      eliminate();
    }
    out_.entries = static_cast<std::uint32_t>(entries_.size());
    return true;
  }

  // Returns the remaining rows of the pivots.
  std::vector<std::map<std::uint32_t, std::uint32_t>> upper() const {
    std::vector<std::map<std::uint32_t, std::uint32_t>> out;
    for (const Row& row : upper_) out.emplace_back(row.begin(), row.end());
    return out;
  }

 private:
  struct Entry {
    Values value;
    Values terms{};  // the sizes of the numbers that were added to the value, and of those in them
    bool exact = false;
    // The result of size_of_pivot, and the version of its row for which it holds.
    double size = 0;
    std::uint32_t version = 0;
  };
  // Columns with their entries, in order; rows of a column, in order. They are short.
  using Row = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  using Column = std::vector<std::uint32_t>;
  static Row::iterator find(Row& row, std::uint32_t j) {
    return std::lower_bound(row.begin(), row.end(), std::pair(j, 0U));
  }
  // Returns the entry of a column, which is added with this number if there is none, and whether it was added.
  static std::pair<std::uint32_t, bool> entry(Row& row, std::uint32_t j, std::size_t number) {
    const auto at = find(row, j);
    if (at != row.end() && at->first == j) return {at->second, false};
    row.insert(at, {j, static_cast<std::uint32_t>(number)});
    return {static_cast<std::uint32_t>(number), true};
  }
  static void insert(Column& column, std::uint32_t i) {
    column.insert(std::lower_bound(column.begin(), column.end(), i), i);
  }
  static void erase(Column& column, std::uint32_t i) {
    column.erase(std::lower_bound(column.begin(), column.end(), i));
  }
  struct Best {
    bool found = false, exact = false;
    std::size_t cost = 0;
    double size = 0;
    std::uint32_t row = 0, column = 0, entry = 0;
  };

  double scaled(std::uint32_t i, std::uint32_t j, std::uint32_t e, std::size_t k) const {
    return std::abs(entries_[e].value[k]) * row_scale_[i][k] * column_scale_[j][k];
  }

  static std::size_t least_cost(std::size_t row, std::size_t column) {
    return (std::max<std::size_t>(row, 1) - 1) * (std::max<std::size_t>(column, 1) - 1);
  }

  void consider(std::uint32_t i, std::uint32_t j, std::uint32_t e) {
    const std::size_t cost = (rows_[i].size() - 1) * (columns_[j].size() - 1);
    const bool exact = entries_[e].exact && std::abs(entries_[e].value[0]) == 1;
    if (best_.found && (cost > best_.cost || (cost == best_.cost && best_.exact && !exact))) return;
    const bool ties = best_.found && cost == best_.cost && exact == best_.exact;
    if (ties && order_.tie != Order::Tie::largest && !wins(i, j, 0)) return;
    Entry& entry = entries_[e];
    if (entry.version != version_[i]) entry.size = size_of_pivot(i, j, e), entry.version = version_[i];
    const double size = one_sign_ && !of_one_sign(entry) ? 0 : entry.size;
    if (size == 0 || (ties && !wins(i, j, size))) return;
    best_ = {true, exact, cost, size, i, j, e};
  }

  // Returns the least fraction of the largest entry of its row over the samples; 0 if it is too small for a pivot.
  double size_of_pivot(std::uint32_t i, std::uint32_t j, std::uint32_t e) {
    double size = 1;
    const Values& largest = largest_in_row(i);
    for (std::size_t k = 0; k < samples_; ++k) {
      const double most = largest[k], here = scaled(i, j, e, k);
      const Entry& entry = entries_[e];
      const bool zero = !(here > kVanishes) && !(small_ && std::abs(entry.value[k]) > kVanishes * entry.terms[k]);
      if (zero || here < kThreshold * most) return 0;
      size = std::min(size, here / most);
    }
    return size;
  }

  bool of_one_sign(const Entry& entry) const {
    return std::none_of(entry.value.begin(), entry.value.begin() + static_cast<std::ptrdiff_t>(samples_),
                        [&](double v) { return v * entry.value[0] < 0; });
  }

  const Values& largest_in_row(std::uint32_t i) {
    std::optional<Values>& largest = largest_[i];
    if (!largest) {
      largest.emplace();
      for (const auto& [j, e] : rows_[i])
        for (std::size_t k = 0; k < samples_; ++k) (*largest)[k] = std::max((*largest)[k], scaled(i, j, e, k));
    }
    return *largest;
  }

  bool wins(std::uint32_t i, std::uint32_t j, double size) const {
    switch (order_.tie) {
    case Order::Tie::largest:
      return size > best_.size;
    case Order::Tie::first_row:
      return i < best_.row;
    case Order::Tie::last_column:
      return j > best_.column;
    }
    return false;
  }

  void resize_row(std::uint32_t i, std::size_t from) {
    short_rows_.erase({from, i});
    short_rows_.insert({rows_[i].size(), i});
  }
  void resize_column(std::uint32_t j, std::size_t from) {
    short_columns_.erase({from, j});
    short_columns_.insert({columns_[j].size(), j});
  }

  void eliminate() {
    const std::uint32_t i = best_.row, j = best_.column;
    SparseLu::Pivot p;
    p.row = i;
    p.column = j;
    p.entry = best_.entry;
    p.one = best_.exact && entries_[p.entry].value[0] == 1;
    p.minus_one = best_.exact && entries_[p.entry].value[0] == -1;
    p.value = entries_[p.entry].value;
    p.first_scaled = static_cast<std::uint32_t>(out_.scaled_entries.size());
    p.first_update = static_cast<std::uint32_t>(out_.update_list.size());
    short_rows_.erase({rows_[i].size(), i});
    short_columns_.erase({columns_[j].size(), j});
    Row top = std::move(rows_[i]);
    top.erase(find(top, j));
    for (const auto& [other, e] : top) {
      const std::size_t from = columns_[other].size();
      erase(columns_[other], i);
      resize_column(other, from);
    }
    erase(columns_[j], i);
    for (std::uint32_t r : columns_[j]) {
      const std::size_t from = rows_[r].size();
      const auto place = find(rows_[r], j);
      const std::uint32_t l = place->second;
      rows_[r].erase(place);
      largest_[r].reset();
      ++version_[r];
      out_.scaled_entries.push_back(l);
      const Values &pivot_terms = entries_[p.entry].terms, column_terms = entries_[l].terms;
      for (std::size_t k = 0; k < samples_; ++k) {
        entries_[l].value[k] /= p.value[k];
        const double of_pivot = std::abs(entries_[l].value[k]) * pivot_terms[k];
        entries_[l].terms[k] = std::max(column_terms[k], of_pivot) / std::abs(p.value[k]);
      }
      for (const auto& [other, u] : top) {
        const auto [at, fresh] = entry(rows_[r], other, entries_.size());
        if (fresh) {
          entries_.push_back({});
          const std::size_t column_from = columns_[other].size();
          insert(columns_[other], r);
          resize_column(other, column_from);
        }
        for (std::size_t k = 0; k < samples_; ++k) {
          const Entry &left = entries_[l], &up = entries_[u];
          Entry& here = entries_[at];
          here.value[k] -= left.value[k] * up.value[k];
          here.terms[k] =
              std::max({here.terms[k], left.terms[k] * std::abs(up.value[k]), std::abs(left.value[k]) * up.terms[k]});
        }
        entries_[at].exact = false;
        out_.update_list.push_back({at, l, u});
      }
      out_.forward.push_back({r, l, i});
      resize_row(r, from);
    }
    columns_[j].clear();
    p.scaled = static_cast<std::uint32_t>(out_.scaled_entries.size()) - p.first_scaled;
    p.updates = static_cast<std::uint32_t>(out_.update_list.size()) - p.first_update;
    out_.pivots.push_back(p);
    upper_.push_back(std::move(top));
  }

  std::uint32_t n_;
  std::size_t samples_;
  const Order order_;
  SparseLu& out_;
  std::vector<Entry> entries_;
  std::vector<Row> rows_, upper_;
  std::vector<Column> columns_;
  std::vector<Values> row_scale_, column_scale_;
  std::vector<std::optional<Values>> largest_;  // the largest entry of a row in its present state, scaled
  std::vector<std::uint32_t> version_;          // version of a row, which counts its changes
  std::set<std::pair<std::size_t, std::uint32_t>> short_rows_, short_columns_;
  Best best_;
  bool one_sign_ = true;  // only pivots of the same sign at all samples
  bool small_ = false;    // also pivots that are small in relation to the scales
};

std::size_t operations(const SparseElimination& e) { return e.lu.update_list.size() + e.lu.scaled_entries.size(); }

SparseElimination eliminate_in(const Order& order, std::uint32_t rows, std::span<const SampledEntry> entries,
                               std::size_t samples) {
  SparseElimination e;
  Eliminated m(rows, samples, order, e.lu);
  for (const SampledEntry& entry : entries) m.add(entry);
  m.scale();
  if (!m.run()) return {};
  e.upper = m.upper();
  return e;
}

}  // namespace

// Eliminates in the order along the mechanism.
static SparseElimination eliminate_along(std::uint32_t rows, std::span<const SampledEntry> entries,
                                         std::size_t samples) {
  const Numbers numbers = numbers_along(rows, entries);
  std::vector<SampledEntry> numbered(entries.begin(), entries.end());
  for (SampledEntry& e : numbered) e.row = numbers.row[e.row], e.column = numbers.column[e.column];
  SparseElimination out = eliminate_in(kAlong, rows, numbered, samples);
  std::vector<std::uint32_t> row(rows), column(rows);
  for (std::uint32_t i = 0; i < rows; ++i) row[numbers.row[i]] = i, column[numbers.column[i]] = i;
  for (SparseLu::Pivot& p : out.lu.pivots) p.row = row[p.row], p.column = column[p.column];
  for (SparseLu::Forward& f : out.lu.forward) f.to = row[f.to], f.from = row[f.from];
  for (auto& upper : out.upper) {
    std::map<std::uint32_t, std::uint32_t> renamed;
    for (const auto& [j, entry] : upper) renamed[column[j]] = entry;
    upper = std::move(renamed);
  }
  return out;
}

SparseElimination eliminate_sparse(std::uint32_t rows, std::span<const SampledEntry> entries, std::size_t samples) {
  if (rows > kLarge) {
    SparseElimination along = eliminate_along(rows, entries, samples);
    if (!along.lu.pivots.empty() && operations(along) <= kMuchFillAlong * rows) return along;
    SparseElimination usual = eliminate_in(kUsual, rows, entries, samples);
    return along.lu.pivots.empty() || (!usual.lu.pivots.empty() && operations(usual) < operations(along)) ? usual
                                                                                                          : along;
  }
  SparseElimination best = eliminate_in(kUsual, rows, entries, samples);
  if (operations(best) > kMuchFill * rows)
    for (const Order& order : kOthers)
      if (SparseElimination e = eliminate_in(order, rows, entries, samples);
          !e.lu.pivots.empty() && operations(e) < operations(best))
        best = std::move(e);
  return best;
}

}  // namespace anholon
