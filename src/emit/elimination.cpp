#include "emit/elimination.h"

#include <algorithm>
#include <cmath>

#include "emit/text.h"
#include "tape/bind.h"

namespace anholon::emit {

namespace {

constexpr std::size_t kMostUnknowns = 200;  // the most unknowns of an elimination that is written out
constexpr int kSamples = 6;
constexpr double kAround = 0.3;     // radius of the samples, in coordinates and velocities
constexpr double kThreshold = 0.1;  // the least ratio of a pivot to the largest entry of its column
// Lost digits of a number of size 1: a tenth of the 1e-12 to which programs agree with the motion.
constexpr double kLost = 1e-13;

using Table = std::vector<std::vector<double>>;

// Returns the matrix at states near the start at which it has finite entries.
std::vector<Table> samples_of(const System& s, const Motion& m, const EmitOptions::Start& start) {
  const std::size_t n = m.jacobian.size();
  const Tape tape = compile(entries(m.jacobian));
  Column values;
  for (const Parameter& p : s.model->parameters) values.push_back(p.value);
  const std::vector<double> parameters = evaluate_parameters<double>(*s.model->graph, values);
  const std::vector<double> state = start_state(m, start);
  std::vector<Table> list;
  for (int k = 0; k < kSamples; ++k) {
    Machine<double> machine(tape, 0, parameters);
    bind(machine, *s.model->graph, [&](const Node& node, NodeId id) {
      if (node.kind == Kind::time) return start.t;
      const auto j = s.variable(id);
      if (!j || static_cast<int>(node.order) >= m.orders[*j]) return 0.0;
      const std::size_t place = m.place(*j, node.order);
      return state[place] + (k == 0 ? 0 : kAround * std::sin(static_cast<double>(64 * k) + static_cast<double>(place)));
    });
    machine.evaluate();
    Table a(n, std::vector<double>(n));
    bool finite = true;
    for (std::size_t i = 0; i < n * n; ++i) finite = std::isfinite(a[i / n][i % n] = machine.value(i)) && finite;
    if (finite) list.push_back(std::move(a));
  }
  return list;
}

// The elimination of the samples, step by step, with the pattern of all of them.
class Search {
 public:
  Search(const Motion& m, std::vector<Table> samples) : n_(m.jacobian.size()), samples_(std::move(samples)) {
    for (const Column& row : m.jacobian) {
      occurs_.emplace_back();
      for (Expr e : row) occurs_.back().push_back(!is_zero(e));
    }
    row_done_.resize(n_), column_done_.resize(n_);
  }

  std::optional<Pivots> run() {
    Pivots pivots;
    for (std::size_t k = 0; k < n_; ++k) {
      const auto next = best();
      if (!next) return std::nullopt;
      eliminate(next->first, next->second);
      pivots.push_back(*next);
    }
    return pivots;
  }

 private:
  std::optional<std::pair<std::size_t, std::size_t>> best() const {
    std::vector<std::size_t> in_row(n_), in_column(n_);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j)
        if (open(i, j)) ++in_row[i], ++in_column[j];
    std::optional<std::pair<std::size_t, std::size_t>> found;
    std::size_t least = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      if (column_done_[j]) continue;
      std::vector<double> largest;
      for (const Table& a : samples_) {
        double most = 0;
        for (std::size_t i = 0; i < n_; ++i)
          if (open(i, j)) most = std::max(most, std::abs(a[i][j]));
        largest.push_back(most);
      }
      for (std::size_t i = 0; i < n_; ++i) {
        if (!open(i, j)) continue;
        bool suits = true;
        for (std::size_t k = 0; k < samples_.size(); ++k)
          suits = suits && samples_[k][i][j] != 0 && std::abs(samples_[k][i][j]) >= kThreshold * largest[k];
        const std::size_t cost = (in_row[i] - 1) * (in_column[j] - 1);
        if (suits && (!found || cost < least)) found = {i, j}, least = cost;
      }
    }
    return found;
  }

  void eliminate(std::size_t row, std::size_t column) {
    row_done_[row] = column_done_[column] = true;
    for (std::size_t i = 0; i < n_; ++i) {
      if (row_done_[i] || !occurs_[i][column]) continue;
      for (Table& a : samples_) {
        const double l = a[i][column] / a[row][column];
        for (std::size_t j = 0; j < n_; ++j) a[i][j] -= l * a[row][j];
      }
      for (std::size_t j = 0; j < n_; ++j) occurs_[i][j] = occurs_[i][j] || occurs_[row][j];
    }
  }

  bool open(std::size_t i, std::size_t j) const { return !row_done_[i] && !column_done_[j] && occurs_[i][j]; }

  std::size_t n_;
  std::vector<Table> samples_;
  std::vector<std::vector<bool>> occurs_;
  std::vector<bool> row_done_, column_done_;
};

// Solves a x = b by the elimination, in double.
std::vector<double> solved(Table a, std::vector<double> b, const Pivots& pivots) {
  const std::size_t n = b.size();
  std::vector<bool> done(n);
  for (const auto& [row, column] : pivots) {
    done[row] = true;
    for (std::size_t i = 0; i < n; ++i) {
      if (done[i] || a[i][column] == 0) continue;
      const double l = a[i][column] / a[row][column];
      for (std::size_t j = 0; j < n; ++j) a[i][j] = j == column ? 0 : a[i][j] - l * a[row][j];
      b[i] -= l * b[row];
    }
  }
  std::vector<double> x(n);
  for (std::size_t k = n; k-- > 0;) {
    const auto [row, column] = pivots[k];
    double sum = b[row];
    for (std::size_t j = 0; j < n; ++j)
      if (j != column) sum -= a[row][j] * x[j];
    x[column] = sum / a[row][column];
  }
  return x;
}

// True if one correction of a solution with numbers of size 1 exceeds kLost in a sample.
bool loses_digits(const std::vector<Table>& samples, const Pivots& pivots) {
  const std::size_t n = pivots.size();
  const auto missing = [&](const Table& a, const std::vector<double>& b, const std::vector<double>& x) {
    std::vector<double> rest = b;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) rest[i] -= a[i][j] * x[j];
    return rest;
  };
  return std::any_of(samples.begin(), samples.end(), [&](const Table& a) {
    std::vector<double> b = missing(a, std::vector<double>(n), std::vector<double>(n, -1.0));
    const std::vector<double> x = solved(a, b, pivots), more = solved(a, missing(a, b, x), pivots);
    return std::any_of(more.begin(), more.end(), [](double d) { return !(std::abs(d) <= kLost); });
  });
}

}  // namespace

std::optional<PivotOrder> elimination_at_start(const System& s, const Motion& m, const EmitOptions::Start& start) {
  if (!m.linear || m.jacobian.size() > kMostUnknowns) return std::nullopt;
  const std::vector<Table> samples = samples_of(s, m, start);
  if (samples.empty()) return std::nullopt;
  const std::optional<Pivots> pivots = Search(m, samples).run();
  return pivots ? std::optional(PivotOrder{*pivots, loses_digits(samples, *pivots)}) : std::nullopt;
}

namespace {

// Writes the statements of an elimination.
class PythonElimination {
 public:
  PythonElimination(const PivotOrder& e, const EliminationNames& names)
      : e_(e), names_(names), n_(e.pivots.size()), a_(names.matrix), inverse_(n_), multipliers_(n_) {}

  std::string run() {
    eliminate();
    std::vector<std::string> x = substituted(reduced(names_.right, "g"), "x");
    if (e_.refined) {
      std::string lead;
      for (const std::string& number : x) lead += (lead.empty() ? "" : ", ") + number;
      put("lead", "[" + lead + "]");
      out_ += names_.residual;
      const std::vector<std::string> more = substituted(reduced(names_.left, "s"), "y");
      for (std::size_t j = 0; j < n_; ++j) x[j] += " - " + more[j];
    }
    std::string list;
    for (const std::string& number : x) list += (list.empty() ? "" : ", ") + number;
    return out_ + "    return [" + list + "], " + (suits_.empty() ? "True" : suits_) + "\n";
  }

 private:
  std::string fresh(const char* kind, std::size_t i) const { return names_.prefix + kind + std::to_string(i); }
  void put(const std::string& name, const std::string& value) { out_ += "    " + name + " = " + value + "\n"; }
  std::string entry(std::size_t row, std::size_t column) const { return a_[row * n_ + column]; }

  void eliminate() {
    std::vector<bool> done(n_);
    std::size_t count = 0;
    for (const auto& [row, column] : e_.pivots) {
      done[row] = true;
      for (std::size_t i = 0; i < n_; ++i) {
        if (done[i] || entry(i, column).empty()) continue;
        if (inverse_[row].empty()) put(inverse_[row] = fresh("d", row), "1.0/" + entry(row, column));
        const std::string l = fresh("l", count++);
        put(l, entry(i, column) + "*" + inverse_[row]);
        suits_ += (suits_.empty() ? "(abs(" : " & (abs(") + l + ") < 1e3)";
        multipliers_[row].push_back({i, l});
        for (std::size_t j = 0; j < n_; ++j) {
          if (j == column || entry(row, j).empty()) continue;
          const std::string changed = fresh("f", i * n_ + j), less = l + "*" + entry(row, j);
          put(changed, entry(i, j).empty() ? "-" + less : entry(i, j) + " - " + less);
          a_[i * n_ + j] = changed;
        }
        a_[i * n_ + column].clear();
      }
    }
  }

  // Returns a right side after the elimination; empty entries vanish.
  std::vector<std::string> reduced(std::vector<std::string> b, const char* kind) {
    for (const auto& [row, column] : e_.pivots)
      for (const auto& [i, l] : multipliers_[row]) {
        if (b[row].empty()) continue;
        put(fresh(kind, i), (b[i].empty() ? "-" : b[i] + " - ") + l + "*" + b[row]);
        b[i] = fresh(kind, i);
      }
    return b;
  }

  // Returns the solution, by its unknowns.
  std::vector<std::string> substituted(const std::vector<std::string>& b, const char* kind) {
    std::vector<std::string> x(n_);
    for (std::size_t k = n_; k-- > 0;) {
      const auto [row, column] = e_.pivots[k];
      std::string sum = b[row];
      for (std::size_t j = 0; j < n_; ++j)
        if (j != column && !entry(row, j).empty()) sum += (sum.empty() ? "-" : " - ") + entry(row, j) + "*" + x[j];
      x[column] = fresh(kind, column);
      put(x[column], sum.empty()
                         ? "0.0*" + entry(row, column)
                         : "(" + sum + ")" + (inverse_[row].empty() ? "/" + entry(row, column) : "*" + inverse_[row]));
    }
    return x;
  }

  const PivotOrder& e_;
  const EliminationNames& names_;
  std::size_t n_;
  std::vector<std::string> a_;
  std::vector<std::string> inverse_;  // reciprocals of pivots that divide more than once, by row
  std::vector<std::vector<std::pair<std::size_t, std::string>>> multipliers_;  // by row of the pivot: row, name
  std::string out_, suits_;
};

}  // namespace

std::string python_elimination(const PivotOrder& elimination, const EliminationNames& names) {
  return PythonElimination(elimination, names).run();
}

}  // namespace anholon::emit
