#include "structure/structure.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "model/formula_of_slot.h"
#include "tape/bind.h"

namespace anholon {

int Structure::largest_c() const { return c.empty() ? 0 : *std::max_element(c.begin(), c.end()); }

namespace {

constexpr int kProbes = 3;
// A partial derivative below this fraction of its terms is round-off, not a dependence.
constexpr double kNoDependence = 1e-11;

// Forward tangents of all equations with respect to all inputs at one point: |dE_i / d input_k|.
class Probe {
 public:
  Probe(const System& s, const Tape& equations, const std::vector<double>& parameters)
      : tape_(equations), machine_(tape_, 0, parameters), system_(s), variable_of_(tape_.inputs.size(), 0),
        order_of_(tape_.inputs.size(), kAbsent) {
    for (std::uint32_t k = 0; k < tape_.inputs.size(); ++k) {
      const NodeId symbol = tape_.inputs[k].symbol;
      const auto j = s.variable(symbol);
      if (!j) continue;
      variable_of_[k] = *j;
      order_of_[k] = static_cast<int>(s.model->graph->node(symbol).order);
      columns_.push_back(k);
    }
    std::stable_sort(columns_.begin(), columns_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return order_of_[a] > order_of_[b]; });
  }

  // Raises sigma[i][j] to the highest derivative of unknown j that occurs in equation i at a point. False if a formula has
  // no value at the point; `sigma` is then of no use.
  bool measure(const ProbeHints& hints, std::mt19937_64& random, std::vector<std::vector<int>>& sigma) {
    constexpr double kLeast = 0.05, kMost = 0.35;
    // Distributions of the standard library have different bits in different implementations.
    const auto spread = [&] { return static_cast<double>(random()) * 0x1p-64 * (kMost - kLeast) + kLeast; };
    bind(machine_, *system_.model->graph, [&](const Node& n, NodeId) {
      const double base = hints.at(n).value_or(0.4);
      return base + (1 + std::abs(base)) * spread();
    });
    machine_.evaluate();
    partials_.clear();
    for (std::uint32_t s = 0; s < tape_.code.size(); ++s) partials_.push_back(machine_.partials(s));
    // The columns are computed a few at a time: all columns would take slots times inputs of memory, and these stay in
    // the caches. The highest derivatives come first, because lower ones tell nothing if these occur.
    constexpr std::size_t kColumns = 8;
    std::vector<std::uint32_t> next;
    for (auto column = columns_.begin(); column != columns_.end();) {
      next.clear();
      for (; column != columns_.end() && next.size() < kColumns &&
             (next.empty() || order_of_[*column] == order_of_[next.front()]);
           ++column)
        if (tells(*column, sigma)) next.push_back(*column);
      if (!next.empty() && !measure(next, sigma)) return false;
    }
    return true;
  }

  // True if the derivative with respect to any input can still raise an entry of `sigma`.
  bool any_tells(const std::vector<std::vector<int>>& sigma) const {
    return std::any_of(columns_.begin(), columns_.end(), [&](std::uint32_t k) { return tells(k, sigma); });
  }

 private:
  bool tells(std::uint32_t input, const std::vector<std::vector<int>>& sigma) const {
    return std::any_of(sigma.begin(), sigma.end(),
                       [&](const std::vector<int>& row) { return row[variable_of_[input]] < order_of_[input]; });
  }

  // Measures the derivatives with respect to some inputs.
  bool measure(const std::vector<std::uint32_t>& inputs, std::vector<std::vector<int>>& sigma) {
    const std::size_t cols = inputs.size(), size = tape_.code.size() * cols;
    tangent_.assign(size, 0.0), terms_.assign(size, 0.0), zero_.assign(tape_.code.size(), 1);
    std::uint32_t next_input = 0;
    for (std::uint32_t s = 0; s < tape_.code.size(); ++s) {
      const Instruction& in = tape_.code[s];
      double *row = &tangent_[s * cols], *row_terms = &terms_[s * cols];
      const auto add = [&](std::uint32_t operand, double factor) {
        if (zero_[operand] && std::isfinite(factor)) return;
        zero_[s] = 0;
        const double *below = &tangent_[operand * cols], *below_terms = &terms_[operand * cols];
        for (std::size_t k = 0; k < cols; ++k) {
          row[k] += factor * below[k];
          row_terms[k] += std::abs(factor) * below_terms[k];
        }
      };
      const auto& partials = partials_[s];
      switch (in.op) {
      case Op::constant:
      case Op::pi:
      case Op::parameter:
      case Op::lookup:
        break;
      // A derivative occurs in a choice if it occurs in one of its branches.
      case Op::select:
        for (const std::uint32_t operand : {in.a, in.b}) {
          const double* below = &tangent_[operand * cols];
          if (std::all_of(below, below + cols, [](double v) { return std::isfinite(v); })) add(operand, 1);
        }
        break;
      case Op::input:
        if (const auto at = std::find(inputs.begin(), inputs.end(), next_input); at != inputs.end()) {
          row[at - inputs.begin()] = row_terms[at - inputs.begin()] = 1;
          zero_[s] = 0;
        }
        ++next_input;
        break;
      case Op::linear:
        for (std::uint32_t k = in.first; k < in.first + in.count; ++k)
          add(tape_.linear_terms[k].slot, machine_.rational(tape_.linear_terms[k].coefficient));
        break;
      case Op::multiply:
      case Op::scale:
      case Op::divide:
      case Op::arctan2:
        add(in.a, partials.a);
        add(in.b, partials.b);
        break;
      case Op::square:
      case Op::power:
      case Op::function:
        add(in.a, partials.a);
        break;
      case Op::rate:
        break;  // systems are analysed with their derivatives expanded
      }
    }
    for (std::size_t i = 0; i < tape_.roots.size(); ++i)
      for (std::size_t k = 0; k < cols; ++k) {
        const double v = std::abs(tangent_[tape_.roots[i] * cols + k]), all = terms_[tape_.roots[i] * cols + k];
        if (!std::isfinite(v)) return false;
        int& highest = sigma[i][variable_of_[inputs[k]]];
        if (v > kNoDependence * all) highest = std::max(highest, order_of_[inputs[k]]);
      }
    return true;
  }

  const Tape& tape_;
  Machine<double> machine_;
  std::vector<Machine<double>::Partials> partials_;
  std::vector<double> tangent_, terms_;  // numbers of each slot, for the present columns
  std::vector<unsigned char> zero_;      // true if a slot has no entry there
  const System& system_;
  std::vector<std::size_t> variable_of_;  // the unknown of each input that is an unknown or a derivative of one
  std::vector<int> order_of_;
  std::vector<std::uint32_t> columns_;  // these inputs, the highest derivatives first
};

// Describes an unknown that cannot be matched, for the message.
std::string undetermined(const System& s, const std::vector<std::vector<int>>& sigma) {
  for (std::size_t j = 0; j < s.size(); ++j) {
    bool occurs = false;
    for (std::size_t i = 0; i < s.size(); ++i) occurs = occurs || sigma[i][j] != kAbsent;
    if (!occurs) return s.variable_names[j];
  }
  return {};
}

// Lists the coordinates whose acceleration occurs in no equation of motion.
std::string without_inertia(const System& s, const std::vector<std::vector<int>>& sigma) {
  std::string list;
  for (std::size_t j = 0; j < s.coordinates; ++j) {
    int highest = kAbsent;
    for (std::size_t i = 0; i < s.coordinates; ++i) highest = std::max(highest, sigma[i][j]);
    if (highest < 2) list += (list.empty() ? "" : ", ") + s.variable_names[j];
  }
  return list;
}

// Returns the outcome for a constraint whose highest derivatives all have coefficients that are 0, so that its reaction
// acts on nothing; nullopt if there is none.
std::optional<Outcome> order_falls(const System& s, const std::vector<std::vector<int>>& sigma) {
  for (std::size_t j = s.coordinates; j < s.mechanical(); ++j) {
    bool occurs = false;
    for (std::size_t i = 0; i < s.size(); ++i) occurs = occurs || sigma[i][j] != kAbsent;
    const Constraint& c = s.model->constraints[s.constraints[j - s.coordinates]];
    if (occurs || c.by) continue;
    const std::string what = c.order == 0   ? "the coordinates"
                             : c.order == 1 ? "the velocities"
                             : c.order == 2 ? "the accelerations"
                                            : "the derivatives of order " + std::to_string(c.order);
    return Outcome{OutcomeKind::singular,
                   "with these values of the parameters the coefficients of " + what + " in the constraint '" + c.name +
                       "' are 0, so that its reaction acts on nothing",
                   c.order == 0 ? "give the parameters other values, or leave the constraint out"
                                : "give the parameters other values, or write the constraint without " + what,
                   c.span};
  }
  return std::nullopt;
}

// Returns the equations that are too many for the unknowns in them: those that alternating paths reach from an equation
// that no matching gives an unknown of its own.
std::vector<std::size_t> too_many(const std::vector<std::vector<int>>& sigma) {
  const std::size_t n = sigma.size();
  std::vector<std::size_t> row_of(n, n);  // the row of each column
  for (std::size_t free = 0; free < n; ++free) {
    std::vector<std::size_t> reached{free}, from(n, n);  // from[j]: the row by which column j is reached
    std::size_t end = n;
    for (std::size_t k = 0; k < reached.size() && end == n; ++k)
      for (std::size_t j = 0; j < n && end == n; ++j) {
        if (sigma[reached[k]][j] == kAbsent || from[j] != n) continue;
        from[j] = reached[k];
        if (row_of[j] == n)
          end = j;
        else
          reached.push_back(row_of[j]);
      }
    if (end == n) return reached;
    std::vector<std::size_t> column_of(n, n);
    for (std::size_t j = 0; j < n; ++j)
      if (row_of[j] != n) column_of[row_of[j]] = j;
    for (std::size_t j = end; j != n;) {
      const std::size_t row = from[j], next = column_of[row];
      row_of[j] = row;
      j = next;
    }
  }
  return {};
}

// Returns the outcome for a servo constraint whose input does not act on the quantity that it should keep; nullopt if
// there is none.
std::optional<Outcome> idle_input(const System& s, const std::vector<std::vector<int>>& sigma) {
  for (const std::size_t row : too_many(sigma)) {
    if (row < s.coordinates || row >= s.mechanical()) continue;
    const Constraint& c = s.model->constraints[s.constraints[row - s.coordinates]];
    if (!c.by) continue;
    const std::string& input = s.model->controls[*c.by].name;
    return Outcome{OutcomeKind::singular,
                   "the input '" + input + "' does not act on what the constraint '" + c.name + "' asks for",
                   "let '" + input + "' stand in a force or torque that moves what stands in the constraint"};
  }
  return std::nullopt;
}

}  // namespace

// The Hungarian method with potentials. Of columns that are equally near, one without a row is taken: if all entries
// are equal, the assignment of earlier rows is then not searched.
std::vector<int> highest_transversal(const std::vector<std::vector<int>>& sigma) {
  const std::size_t n = sigma.size();
  const double inf = std::numeric_limits<double>::infinity(), forbidden = 1e9;
  std::vector<double> u(n + 1, 0), v(n + 1, 0);
  std::vector<std::size_t> row_of(n + 1, 0), way(n + 1, 0);
  const auto cost = [&](std::size_t i, std::size_t j) {
    return sigma[i - 1][j - 1] == kAbsent ? forbidden : -static_cast<double>(sigma[i - 1][j - 1]);
  };
  for (std::size_t i = 1; i <= n; ++i) {
    row_of[0] = i;
    std::size_t j0 = 0;
    std::vector<double> least(n + 1, inf);
    std::vector<unsigned char> used(n + 1, 0);
    do {
      used[j0] = 1;
      const std::size_t i0 = row_of[j0];
      std::size_t j1 = 0;
      double delta = inf;
      for (std::size_t j = 1; j <= n; ++j) {
        if (used[j]) continue;
        const double reduced = cost(i0, j) - u[i0] - v[j];
        if (reduced < least[j]) least[j] = reduced, way[j] = j0;
        if (least[j] < delta || (least[j] == delta && row_of[j] == 0 && row_of[j1] != 0)) delta = least[j], j1 = j;
      }
      for (std::size_t j = 0; j <= n; ++j) {
        if (used[j])
          u[row_of[j]] += delta, v[j] -= delta;
        else
          least[j] -= delta;
      }
      j0 = j1;
    } while (row_of[j0] != 0);
    do {
      const std::size_t j1 = way[j0];
      row_of[j0] = row_of[j1];
      j0 = j1;
    } while (j0 != 0);
  }
  std::vector<int> transversal(n, -1);
  for (std::size_t j = 1; j <= n; ++j) {
    if (sigma[row_of[j] - 1][j - 1] == kAbsent) return {};
    transversal[row_of[j] - 1] = static_cast<int>(j) - 1;
  }
  return transversal;
}

std::optional<std::vector<std::vector<int>>> signature(const System& s, const Tape& equations,
                                                       const std::vector<double>& parameters, const ProbeHints& hints) {
  const std::size_t n = s.size();
  Probe probe(s, equations, parameters);
  std::vector<std::vector<int>> sigma(n, std::vector<int>(n, kAbsent));
  std::mt19937_64 random(20261121);
  int measured = 0;
  for (int attempt = 0; attempt < 20 && measured < kProbes; ++attempt) {
    if (measured > 0 && !probe.any_tells(sigma)) break;
    auto trial = sigma;
    if (probe.measure(hints, random, trial)) sigma = std::move(trial), ++measured;
  }
  if (measured == 0) return std::nullopt;
  return sigma;
}

// Names the first formula without a value at the hints themselves; if all have one, some formula has none near the
// hints.
static Outcome no_value(const System& s, const Tape& equations, const std::vector<double>& parameters,
                        const ProbeHints& hints) {
  Machine<double> machine(equations, 0, parameters);
  bind(machine, *s.model->graph, [&](const Node& n, NodeId) { return hints.at(n).value_or(0); });
  machine.evaluate();
  const auto value = [&](std::uint32_t slot) { return machine.series(slot)[0]; };
  for (std::uint32_t slot = 0; slot < equations.code.size(); ++slot)
    if (!std::isfinite(value(slot))) {
      Outcome o = without_value(equations, *s.model, slot, value);
      o.message += " (at the start)";
      return o;
    }
  return {OutcomeKind::not_a_number, "the equations have no value near the initial data",
          "look for roots or logarithms of negative numbers and divisions by zero at the start"};
}

Outcome analyse(const System& s, const std::vector<double>& parameters, const ProbeHints& hints, Structure& out) {
  const std::size_t n = s.size();
  const Tape equations = compile(s.equations);
  const auto sigma = signature(s, equations, parameters, hints);
  if (!sigma) return no_value(s, equations, parameters, hints);
  out.sigma = *sigma;
  out.transversal = highest_transversal(out.sigma);
  if (out.transversal.empty()) {
    if (const std::string list = without_inertia(s, out.sigma); !list.empty())
      return {OutcomeKind::singular, "no inertia acts on " + list,
              "a mass or a moment of inertia is zero, or no body moves with that coordinate"};
    if (const auto falls = order_falls(s, out.sigma)) return *falls;
    const std::string name = undetermined(s, out.sigma);
    if (const auto idle = idle_input(s, out.sigma); name.empty() && idle) return *idle;
    return {OutcomeKind::singular,
            name.empty()
                ? "the equations do not determine the motion: there are more constraints than they leave room for"
                : "no equation determines '" + name + "'",
            name.empty() ? "look for constraints that say the same, or leave one out"
                         : "a coordinate needs a mass, an inertia or a constraint that it moves"};
  }
  // Smallest offsets: d_j = max (sigma_ij + c_i), c_i = d_j - sigma_ij on the transversal.
  out.c.assign(n, 0);
  out.d.assign(n, 0);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t j = 0; j < n; ++j) {
      out.d[j] = 0;
      for (std::size_t i = 0; i < n; ++i)
        if (out.sigma[i][j] != kAbsent) out.d[j] = std::max(out.d[j], out.sigma[i][j] + out.c[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = static_cast<std::size_t>(out.transversal[i]);
      const int c = out.d[j] - out.sigma[i][j];
      if (c != out.c[i]) out.c[i] = c, again = true;
    }
  }
  out.state_dimension = 0;
  for (int d : out.d) out.state_dimension += d;
  for (int c : out.c) out.state_dimension -= c;
  int holonomic = 0;
  for (std::size_t r : s.constraints) holonomic += s.model->constraints[r].order == 0;
  out.degrees_of_freedom = static_cast<int>(s.coordinates) - static_cast<int>(s.constraints.size());
  out.configuration_dimension = static_cast<int>(s.coordinates) - holonomic;
  return {};
}

void drop_absent(System& s, const Structure& t) {
  Graph& g = *s.model->graph;
  // Returns early for most systems, which have no such derivative.
  const int most = t.largest_c();
  const std::vector<NodeId> all = symbols(s.equations);
  if (std::none_of(all.begin(), all.end(), [&](NodeId id) {
        const auto j = s.variable(id);
        return j && static_cast<int>(g.node(id).order) + most > t.d[*j];
      }))
    return;
  for (std::size_t i = 0; i < s.size(); ++i)
    s.equations[i] = substitute({&s.equations[i], 1}, [&](NodeId id) {
      const auto j = s.variable(id);
      return j && static_cast<int>(g.node(id).order) + t.c[i] > t.d[*j] ? g.zero() : Expr{};
    })[0];
}

namespace {

// The limits for printing a matrix: a wider one has numbers instead of names of its columns; one with more unknowns is
// printed row by row.
constexpr std::size_t kWidest = 100, kMostColumns = 30;

std::string entry(const Structure& t, std::size_t i, std::size_t j) {
  return std::to_string(t.sigma[i][j]) + (t.transversal[i] == static_cast<int>(j) ? "*" : "");
}

// Prints only nonzero entries: "rod1 (c 2): x1 0*, y1 0".
std::string row_by_row(const System& s, const Structure& t) {
  std::string out =
      "signature matrix (equation (c): unknowns with the highest derivative that occurs; * on the transversal)\n";
  for (std::size_t i = 0; i < s.size(); ++i) {
    out += "  " + s.equation_names[i] + " (c " + std::to_string(t.c[i]) + "):";
    bool first = true;
    for (std::size_t j = 0; j < s.size(); ++j)
      if (t.sigma[i][j] != kAbsent)
        out += (first ? " " : ", ") + s.variable_names[j] + " " + entry(t, i, j), first = false;
    out += "\n";
  }
  out += "  d:";
  for (std::size_t j = 0; j < s.size(); ++j)
    out += (j ? ", " : " ") + s.variable_names[j] + " " + std::to_string(t.d[j]);
  return out + "\n";
}

// Prints "1 x, 2 y, …" in lines of limited length.
std::string numbered_columns(const System& s) {
  std::string out = "  columns:", line;
  for (std::size_t j = 0; j < s.size(); ++j) {
    const std::string item = " " + std::to_string(j + 1) + " " + s.variable_names[j] + (j + 1 < s.size() ? "," : "");
    if (line.size() + item.size() > kWidest - 10) out += line + "\n          ", line.clear();
    line += item;
  }
  return out + line + "\n";
}

}  // namespace

std::string print(const System& s, const Structure& t) {
  const std::size_t n = s.size();
  if (n > kMostColumns) return row_by_row(s, t);
  std::size_t all_names = 0;
  for (const std::string& name : s.variable_names) all_names += std::max<std::size_t>(name.size(), 2) + 2;
  const bool numbered = all_names > kWidest;
  std::vector<std::vector<std::string>> cells(n + 2, std::vector<std::string>(n + 2));
  for (std::size_t j = 0; j < n; ++j) {
    cells[0][j + 1] = numbered ? std::to_string(j + 1) + " " : s.variable_names[j];
    cells[n + 1][j + 1] = std::to_string(t.d[j]) + (numbered ? " " : "");
  }
  cells[0][n + 1] = "c";
  cells[n + 1][0] = "d";
  for (std::size_t i = 0; i < n; ++i) {
    cells[i + 1][0] = s.equation_names[i];
    cells[i + 1][n + 1] = std::to_string(t.c[i]);
    for (std::size_t j = 0; j < n; ++j)
      cells[i + 1][j + 1] =
          t.sigma[i][j] == kAbsent ? "- " : entry(t, i, j) + (t.transversal[i] == static_cast<int>(j) ? "" : " ");
  }
  std::string out = "signature matrix (rows: equations, columns: unknowns; * on the transversal)\n";
  if (numbered) out += numbered_columns(s);
  std::vector<std::size_t> width(n + 2, 1);
  for (const auto& row : cells)
    for (std::size_t j = 0; j < row.size(); ++j) width[j] = std::max(width[j], row[j].size());
  for (const auto& row : cells) {
    for (std::size_t j = 0; j < row.size(); ++j)
      out += (j ? "  " : "") + std::string(width[j] - row[j].size(), ' ') + row[j];
    while (out.back() == ' ') out.pop_back();
    out += "\n";
  }
  return out;
}

}  // namespace anholon
