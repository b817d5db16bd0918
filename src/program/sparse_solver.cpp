// The results of a sparse elimination: lists of operations that solve, the inverse, columns left to their own rows.
#include <algorithm>
#include <optional>

#include "program/sparse_lu.h"

namespace anholon {

SparseLu solver(const SparseElimination& e, std::uint32_t sides, const std::vector<bool>& needed) {
  SparseLu out = e.lu;
  const std::size_t rows = needed.size();
  // Marks the rows whose right side may be nonzero.
  std::vector<bool> side(rows, false);
  std::fill(side.begin(), side.begin() + sides, true);
  std::vector<SparseLu::Forward> forward;
  for (const SparseLu::Forward& f : out.forward) {
    if (!side[f.from]) continue;
    side[f.to] = true;
    forward.push_back(f);
  }
  out.forward_all = std::move(out.forward);
  out.forward = std::move(forward);

  std::vector<bool> wanted = needed;
  std::vector<bool> kept(rows, false);
  // A column is needed by the rows of the pivots before its own.
  for (std::size_t k = 0; k < out.pivots.size(); ++k) {
    kept[k] = wanted[out.pivots[k].column];
    if (kept[k])
      for (const auto& [column, entry] : e.upper[k]) wanted[column] = true;
  }
  for (std::size_t k = out.pivots.size(); k-- > 0;) {
    const SparseLu::Pivot& p = out.pivots[k];
    if (!kept[k]) continue;
    SparseLu::Backward b{
        p.column, p.row, static_cast<std::uint32_t>(k), static_cast<std::uint32_t>(out.terms.size()), 0, !side[p.row]};
    for (const auto& [column, entry] : e.upper[k]) out.terms.push_back({entry, column});
    b.count = static_cast<std::uint32_t>(out.terms.size()) - b.first;
    out.backward.push_back(b);
  }
  return out;
}

namespace {

// A number that is the same at every expansion, if known.
using Known = std::optional<double>;

Known product(const Known& a, const Known& b) {
  if (a && b) return *a * *b;
  return a == 0.0 || b == 0.0 ? Known(0) : std::nullopt;
}

Known difference(const Known& a, const Known& b) { return a && b ? Known(*a - *b) : std::nullopt; }

Known reciprocal(const SparseLu::Pivot& p) { return p.one ? Known(1) : p.minus_one ? Known(-1) : std::nullopt; }

// Returns the factors that are known whole numbers, from exact entries and pivots of 1 and -1.
std::vector<Known> known_factors(const SparseLu& e, std::span<const SampledEntry> entries) {
  std::vector<Known> lu(e.entries, 0.0);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    Known& sum = lu[e.place[i]];
    sum = entries[i].exact && sum ? Known(*sum + entries[i].value[0]) : std::nullopt;
  }
  for (const SparseLu::Pivot& p : e.pivots) {
    for (std::uint32_t i = p.first_scaled; i < p.first_scaled + p.scaled; ++i)
      lu[e.scaled_entries[i]] = product(lu[e.scaled_entries[i]], reciprocal(p));
    for (std::uint32_t i = p.first_update; i < p.first_update + p.updates; ++i) {
      const SparseLu::Update& u = e.update_list[i];
      lu[u.to] = difference(lu[u.to], product(lu[u.l], lu[u.u]));
    }
  }
  return lu;
}

// Returns the solution for a unit side.
std::vector<Known> known_solution(const SparseLu& e, const std::vector<Known>& lu, std::uint32_t side,
                                  std::size_t rows) {
  std::vector<Known> rhs(rows, 0.0), y(rows, 0.0);
  rhs[side] = 1.0;
  for (const SparseLu::Forward& f : e.forward) rhs[f.to] = difference(rhs[f.to], product(lu[f.entry], rhs[f.from]));
  for (const SparseLu::Backward& b : e.backward) {
    Known s = rhs[b.row];
    for (std::uint32_t i = b.first; i < b.first + b.count; ++i)
      s = difference(s, product(lu[e.terms[i].entry], y[e.terms[i].column]));
    y[b.column] = product(s, reciprocal(e.pivots[b.pivot]));
  }
  return y;
}

}  // namespace

bool invert(SparseLu& e, std::span<const SampledEntry> entries, const std::vector<std::uint32_t>& sides,
            const std::vector<bool>& needed, std::size_t most) {
  std::vector<std::vector<std::uint32_t>> met(needed.size());
  std::size_t count = 0;
  for (const std::uint32_t side : sides) {
    std::vector<bool> rhs(needed.size(), false), solution(needed.size(), false);
    rhs[side] = true;
    for (const SparseLu::Forward& f : e.forward)
      if (rhs[f.from]) rhs[f.to] = true;
    for (const SparseLu::Backward& b : e.backward) {
      bool some = !b.zero_side && rhs[b.row];
      for (std::uint32_t i = b.first; i < b.first + b.count; ++i)
        if (solution[e.terms[i].column]) some = true;
      if (!some) continue;
      solution[b.column] = true;
      if (needed[b.column]) met[b.column].push_back(side), ++count;
    }
  }
  if (count > most) return false;
  const std::vector<Known> lu = known_factors(e, entries);
  for (const std::uint32_t side : sides) {
    const std::vector<Known> y = known_solution(e, lu, side, needed.size());
    for (std::uint32_t column = 0; column < met.size(); ++column)
      if (std::find(met[column].begin(), met[column].end(), side) != met[column].end())
        e.influences.push_back({column, side,
                                met[column].size() > 1 ? 0
                                : y[column] == 1.0     ? 1
                                : y[column] == -1.0    ? -1
                                                       : 0});
  }
  return true;
}

void leave_to_own_rows(SparseLu& e, std::uint32_t first, std::span<const SampledEntry> entries,
                       const std::vector<bool>& needed) {
  std::vector<std::vector<SparseLu::Term>> rows(needed.size());
  for (std::uint32_t i = 0; i < entries.size(); ++i)
    if (entries[i].row >= first && entries[i].column != entries[i].row)
      rows[entries[i].row].push_back({i, entries[i].column});
  std::vector<bool> wanted = needed;
  for (std::uint32_t column = static_cast<std::uint32_t>(needed.size()); column-- > first;)
    if (wanted[column])
      for (const SparseLu::Term& t : rows[column]) wanted[t.column] = true;
  for (std::uint32_t column = first; column < needed.size(); ++column) {
    if (!wanted[column]) continue;
    e.own.push_back(
        {column, static_cast<std::uint32_t>(e.own_terms.size()), static_cast<std::uint32_t>(rows[column].size())});
    e.own_terms.insert(e.own_terms.end(), rows[column].begin(), rows[column].end());
  }
}

}  // namespace anholon
