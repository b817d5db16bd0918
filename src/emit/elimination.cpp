#include "emit/elimination.h"

#include <cmath>

#include "emit/text.h"
#include "tape/bind.h"

namespace anholon::emit {

namespace {

constexpr std::size_t kMostUnknowns = 200;  // of an elimination that is written out
constexpr int kSamples = 6;
constexpr double kAround = 0.3;     // of the samples, in coordinates and velocities
constexpr double kThreshold = 0.1;  // of a pivot against its column

using Table = std::vector<std::vector<double>>;

// The matrix at states around the start at which it has finite entries.
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

}  // namespace

std::optional<Pivots> pivots_at_start(const System& s, const Motion& m, const EmitOptions::Start& start) {
  if (!m.linear || m.jacobian.size() > kMostUnknowns) return std::nullopt;
  std::vector<Table> samples = samples_of(s, m, start);
  if (samples.empty()) return std::nullopt;
  return Search(m, std::move(samples)).run();
}

std::string python_elimination(const Pivots& pivots, const EliminationNames& names) {
  const std::size_t n = pivots.size();
  std::vector<std::string> a = names.matrix, b = names.right;
  std::vector<bool> done(n);
  std::vector<std::string> inverse(n);  // of pivots that are divided by more than once, by row
  std::string out, suits;
  std::size_t multipliers = 0;
  const auto fresh = [&](const char* kind, std::size_t i) { return names.prefix + kind + std::to_string(i); };
  for (const auto& [row, column] : pivots) {
    done[row] = true;
    for (std::size_t i = 0; i < n; ++i) {
      if (done[i] || a[i * n + column].empty()) continue;
      if (inverse[row].empty()) {
        inverse[row] = fresh("d", row);
        out += "    " + inverse[row] + " = 1.0/" + a[row * n + column] + "\n";
      }
      const std::string l = fresh("l", multipliers++);
      out += "    " + l + " = " + a[i * n + column] + "*" + inverse[row] + "\n";
      suits += (suits.empty() ? "(abs(" : " & (abs(") + l + ") < 1e3)";
      for (std::size_t j = 0; j < n; ++j) {
        if (j == column || a[row * n + j].empty()) continue;
        std::string& entry = a[i * n + j];
        if (entry.empty()) {
          entry = fresh("f", i * n + j);
          out += "    " + entry + " = -" + l + "*" + a[row * n + j] + "\n";
        } else {
          const std::string changed = fresh("f", i * n + j);
          out += "    " + changed + " = " + entry + " - " + l + "*" + a[row * n + j] + "\n";
          entry = changed;
        }
      }
      if (!b[row].empty()) {
        const std::string changed = fresh("g", i);
        out += "    " + changed + " = " + (b[i].empty() ? "-" : b[i] + " - ") + l + "*" + b[row] + "\n";
        b[i] = changed;
      }
      a[i * n + column].clear();
    }
  }
  std::vector<std::string> lead(n);
  for (std::size_t k = n; k-- > 0;) {
    const auto [row, column] = pivots[k];
    std::string sum = b[row];
    for (std::size_t j = 0; j < n; ++j)
      if (j != column && !a[row * n + j].empty()) sum += (sum.empty() ? "-" : " - ") + a[row * n + j] + "*" + lead[j];
    lead[column] = fresh("x", column);
    out += "    " + lead[column] + " = " +
           (sum.empty() ? "0.0*" + a[row * n + column]
                        : "(" + sum + ")" + (inverse[row].empty() ? "/" + a[row * n + column] : "*" + inverse[row])) +
           "\n";
  }
  out += "    return [";
  for (std::size_t i = 0; i < n; ++i) out += (i ? ", " : "") + lead[i];
  return out + "], " + (suits.empty() ? "True" : suits) + "\n";
}

}  // namespace anholon::emit
