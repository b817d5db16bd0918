#include "report/rows/page_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "numeric/number.h"
#include "print/print_names.h"
#include "report/rows/contact_bands.h"

namespace anholon {

namespace {

constexpr unsigned kMostDerivatives = 5;

// The columns of a coordinate and of its derivatives, as far as there are any.
using Derivatives = std::array<std::optional<std::size_t>, kMostDerivatives>;

// Inserts rows with the sides of jumps between those of a run.
class SidesOfJumps {
 public:
  SidesOfJumps(const Model& model, const RunTable& table, const std::vector<EventReport>& events)
      : from_(table), values_(table.columns.size()) {
    for (const Coordinate& q : model.coordinates) {
      Derivatives d;
      for (unsigned k = 0; k < kMostDerivatives; ++k)
        if (const std::size_t at = table.find(derivative_name(q.name, k, Format::text)); at < table.columns.size())
          d[k] = at;
      of_.push_back(d);
    }
    const bool contacts = has_contacts(table);
    for (const EventReport& e : events)
      if (!e.changes.empty() || (contacts && e.name.find('.') != std::string::npos)) events_.push_back(&e);
  }

  RunTable make() {
    if (events_.empty()) return from_;
    to_.set_columns(from_.columns);
    const std::size_t n = from_.rows();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < values_.size(); ++k) values_[k] = from_.values[k][i];
      write();
      if (i + 1 < n) between(i);
    }
    return std::move(to_);
  }

 private:
  double time(std::size_t row) const { return from_.values[0][row]; }
  void write() { to_.add_row({values_}); }

  // Inserts the sides of the jumps from row i on, before the next row.
  void between(std::size_t i) {
    const bool has_its_side = i == 0 || time(i - 1) == time(i) || time(i + 1) == time(i);
    const auto passed = [&](const EventReport* e) {
      return has_its_side ? !(e->t.value > time(i)) : e->t.value < time(i);
    };
    while (next_ < events_.size() && passed(events_[next_])) ++next_;
    const std::size_t first = next_;
    while (next_ < events_.size() && events_[next_]->t.value < time(i + 1)) ++next_;
    if (first == next_) return;
    const double begin = events_[first]->t.value, end = events_[next_ - 1]->t.value;
    std::vector<double> before = continued(i, begin), after = continued(i + 1, end);
    if (begin == end) join(i, begin, first, before, after);
    if (begin > time(i)) put(before);
    if (begin < end) put(unknown(before)), put(unknown(after));
    put(after);
  }

  void put(const std::vector<double>& row) {
    values_ = row;
    write();
  }

  // Returns row i, continued to a time by its derivatives.
  std::vector<double> continued(std::size_t i, double t) const {
    std::vector<double> row;
    for (std::size_t k = 0; k < from_.columns.size(); ++k) row.push_back(from_.values[k][i]);
    const double h = t - time(i);
    row[0] = t;
    if (h == 0) return row;
    for (const Derivatives& d : of_)
      for (unsigned k = 0; k < kMostDerivatives; ++k) {
        if (!d[k]) continue;
        double sum = 0, factor = 1;
        for (unsigned j = k; j < kMostDerivatives && d[j] && std::isfinite(from_.values[*d[j]][i]); ++j)
          sum += factor * from_.values[*d[j]][i], factor *= h / (j - k + 1);
        row[*d[k]] = sum;
      }
    return row;
  }

  // Positions that no event sets are the same on both sides.
  void join(std::size_t i, double t, std::size_t first, std::vector<double>& before, std::vector<double>& after) const {
    for (const Derivatives& d : of_) {
      if (!d[0]) continue;
      const auto sets = [&](const EventReport* e) {
        return std::any_of(e->changes.begin(), e->changes.end(),
                           [&](const EventReport::Change& c) { return c.name == from_.columns[*d[0]]; });
      };
      if (std::any_of(events_.begin() + static_cast<std::ptrdiff_t>(first),
                      events_.begin() + static_cast<std::ptrdiff_t>(next_), sets))
        continue;
      const double x = t == time(i) ? before[*d[0]] : (before[*d[0]] + after[*d[0]]) / 2;
      before[*d[0]] = after[*d[0]] = x;
    }
  }

  // Returns the other side of a row, of which only the positions are known.
  std::vector<double> unknown(const std::vector<double>& side) const {
    std::vector<double> row(side.size(), std::numeric_limits<double>::quiet_NaN());
    row[0] = side[0];
    for (const Derivatives& d : of_)
      if (d[0]) row[*d[0]] = side[*d[0]];
    return row;
  }

  const RunTable& from_;
  std::vector<Derivatives> of_;  // for each coordinate
  std::vector<const EventReport*> events_;
  std::size_t next_ = 0;
  std::vector<double> values_;  // of one row
  RunTable to_;
};

RunTable reversed(const RunTable& table) {
  RunTable to;
  to.set_columns(table.columns);
  std::vector<double> row(table.columns.size());
  for (std::size_t i = table.rows(); i-- > 0;) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = table.values[k][i];
    to.add_row({row});
  }
  return to;
}

}  // namespace

void PageSink::row(const Row& row) {
  const double t = row.values[0];
  const bool side = run_.table.rows() > 0 && t == last_;
  last_ = t;
  if (side) keep_skipped();
  if (run_.table.rows() > 0 && !side && ++since_ < every_) {
    skipped_ = {{row.values.begin(), row.values.end()}, {row.texts.begin(), row.texts.end()}};
    return;
  }
  skipped_.reset();
  since_ = 0;
  run_.table.add_row(row);
  if (run_.table.rows() * run_.table.columns.size() > most_) halve();
}

void PageSink::keep_skipped() {
  if (!skipped_) return;
  run_.table.add_row({skipped_->values, skipped_->texts});
  skipped_.reset();
}

void PageSink::halve() {
  const RunTable all = std::move(run_.table);
  run_.table = {};
  run_.table.set_columns(all.columns);
  const std::span<const double> t = all.values[0];
  std::vector<double> values(all.columns.size());
  std::vector<std::string> texts(all.columns.size());
  const std::size_t n = all.rows();
  for (std::size_t i = 0; i < n; ++i) {
    const bool side = (i > 0 && t[i - 1] == t[i]) || (i + 1 < n && t[i + 1] == t[i]);
    if (i % 2 == 1 && !side && i + 1 < n) continue;
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] = all.values[k][i];
      texts[k] = i < all.texts[k].size() ? all.texts[k][i] : std::string();
    }
    run_.table.add_row({values, texts});
  }
  every_ *= 2;
}

RunTable rows_for_page(const Model& model, const RunTable& table, const std::vector<EventReport>& events) {
  const std::size_t n = table.rows();
  if (n > 1 && table.values[0][n - 1] < table.values[0][0]) return reversed(table);
  return SidesOfJumps(model, table, events).make();
}

std::string obstacle_to_showing(const Model& model, const RunTable& table, bool lines) {
  if (table.columns.empty() || table.columns[0] != "t") return "the first column of the rows is not the time, t";
  std::string missing;
  for (const Coordinate& q : model.coordinates)
    if (table.find(q.name) == table.columns.size()) missing += (missing.empty() ? "" : ", ") + q.name;
  if (!missing.empty()) return "the rows have no column for coordinates of the model: " + missing;
  const std::span<const double> t = table.values[0];
  const auto where = [&](std::size_t row) {
    return lines ? "line " + std::to_string(row + 2) : "row " + std::to_string(row + 1);
  };
  double direction = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (!std::isfinite(t[i])) return "the time in " + where(i) + " is no number";
    const double step = i == 0 ? 0 : t[i] - t[i - 1];
    if (step * direction < 0)
      return "the time turns round in " + where(i) + ": " + number_text(t[i]) + " after " + number_text(t[i - 1]);
    if (step != 0) direction = step;
  }
  return "";
}

}  // namespace anholon
