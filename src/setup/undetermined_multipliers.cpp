#include "setup/undetermined_multipliers.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "expr/generic_point.h"

namespace anholon {

namespace {

// True if the same rows take part in two dependencies.
bool alike(const Dependency& a, const Dependency& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t r = 0; r < a.size(); ++r)
    if ((a[r] != 0) != (b[r] != 0)) return false;
  return true;
}

// Changes a value by up to a half of its size, or of 1, by a number that differs from symbol to symbol.
double moved(double value, const Node& symbol, std::uint64_t seed) {
  return value + (generic_value(symbol, seed) - 0.5) * std::max(1.0, std::abs(value));
}

// Another place near the state, which need not satisfy the constraints.
InitialState<double> elsewhere(const Mechanics& m, InitialState<double> state, std::uint64_t seed) {
  Graph& g = m.graph();
  for (std::size_t a = 0; a < state.q.size(); ++a) {
    state.q[a] = moved(state.q[a], g.node(m.q[a].id), seed);
    state.qd[a] = moved(state.qd[a], g.node(m.qd[a].id), seed);
  }
  state.t += 0.3 * static_cast<double>(seed);
  return state;
}

}  // namespace

std::vector<std::vector<std::size_t>> UndeterminedMultipliers::groups() const {
  std::vector<std::set<std::size_t>> joined;
  for (const Dependency& d : dependencies) {
    std::set<std::size_t> rows;
    for (std::size_t r = 0; r < d.size(); ++r)
      if (d[r] != 0) rows.insert(r);
    std::erase_if(joined, [&](const std::set<std::size_t>& other) {
      const bool common = std::any_of(other.begin(), other.end(), [&](std::size_t r) { return rows.count(r) > 0; });
      if (common) rows.insert(other.begin(), other.end());
      return common;
    });
    if (!rows.empty()) joined.push_back(std::move(rows));
  }
  std::sort(joined.begin(), joined.end());
  std::vector<std::vector<std::size_t>> list;
  for (const std::set<std::size_t>& rows : joined) list.emplace_back(rows.begin(), rows.end());
  return list;
}

std::vector<std::size_t> UndeterminedMultipliers::group_of(std::size_t r) const {
  for (const std::vector<std::size_t>& group : groups())
    if (std::find(group.begin(), group.end(), r) != group.end()) return group;
  return {};
}

bool UndeterminedMultipliers::determined_everywhere(std::size_t r) const {
  return std::all_of(lasts.begin(), lasts.end(), [](bool x) { return x; }) &&
         std::none_of(dependencies.begin(), dependencies.end(), [&](const Dependency& d) { return takes_part(d, r); });
}

UndeterminedMultipliers undetermined_multipliers(const Mechanics& m, const std::vector<double>& parameters,
                                                 const InitialState<double>& state,
                                                 const IndependentConstraints& choice) {
  if (choice.redundant.empty()) return {};
  UndeterminedMultipliers shared;
  shared.redundant = choice.redundant;
  shared.dependencies = dependencies(constraint_rows(m, parameters, state), choice);
  shared.lasts.assign(choice.redundant.size(), true);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const std::vector<Dependency> there =
        dependencies(constraint_rows(m, parameters, elsewhere(m, state, seed)), choice);
    for (std::size_t k = 0; k < there.size(); ++k)
      shared.lasts[k] = shared.lasts[k] && alike(there[k], shared.dependencies[k]);
  }
  return shared;
}

}  // namespace anholon
