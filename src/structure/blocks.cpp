#include "structure/blocks.h"

#include <algorithm>

namespace anholon {

namespace {

// Returns the strongly connected components by Tarjan's algorithm, without recursion; each comes after the components
// it needs.
std::vector<std::vector<std::size_t>> components(const std::vector<std::vector<std::size_t>>& needs) {
  constexpr std::size_t kUnseen = SIZE_MAX;
  const std::size_t n = needs.size();
  std::vector<std::size_t> index(n, kUnseen), low(n, 0), next(n, 0), open, path;
  std::vector<bool> is_open(n, false);
  std::vector<std::vector<std::size_t>> out;
  std::size_t count = 0;
  for (std::size_t root = 0; root < n; ++root) {
    if (index[root] != kUnseen) continue;
    path.push_back(root);
    while (!path.empty()) {
      const std::size_t i = path.back();
      if (index[i] == kUnseen) index[i] = low[i] = count++, open.push_back(i), is_open[i] = true;
      bool descends = false;
      while (next[i] < needs[i].size() && !descends) {
        const std::size_t k = needs[i][next[i]];
        if (index[k] == kUnseen)
          path.push_back(k), descends = true;
        else {
          if (is_open[k]) low[i] = std::min(low[i], low[k]);
          ++next[i];
        }
      }
      if (descends) continue;
      path.pop_back();
      if (low[i] != index[i]) continue;
      out.emplace_back();
      std::size_t k = 0;
      do {
        k = open.back();
        open.pop_back();
        is_open[k] = false;
        out.back().push_back(k);
      } while (k != i);
      std::sort(out.back().begin(), out.back().end());
    }
  }
  return out;
}

}  // namespace

std::vector<Block> blocks(const Structure& t) {
  const std::size_t n = t.c.size();
  std::vector<std::size_t> owner(n, 0);  // for an unknown: the equation that the transversal assigns to it
  for (std::size_t i = 0; i < n; ++i) owner[static_cast<std::size_t>(t.transversal[i])] = i;
  std::vector<std::vector<std::size_t>> needs(n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j)
      if (t.sigma[i][j] != kAbsent && t.sigma[i][j] == t.d[j] - t.c[i] && owner[j] != i) needs[i].push_back(owner[j]);
  std::vector<Block> out;
  for (const std::vector<std::size_t>& equations : components(needs)) {
    Block b{equations, {}};
    for (std::size_t i : equations) b.unknowns.push_back(static_cast<std::size_t>(t.transversal[i]));
    std::sort(b.unknowns.begin(), b.unknowns.end());
    out.push_back(b);
  }
  return out;
}

std::vector<HiddenConstraint> hidden_constraints(const System& s, const Structure& t) {
  std::vector<HiddenConstraint> out;
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (t.c[i] == 0) continue;
    int highest = kAbsent;
    for (std::size_t j = 0; j < s.coordinates; ++j) highest = std::max(highest, t.sigma[i][j]);
    HiddenConstraint h{i, {}};
    for (int k = 0; k < t.c[i]; ++k) h.orders.push_back(highest == kAbsent ? kAbsent : highest + k);
    out.push_back(h);
  }
  return out;
}

std::string print(const System& s, const Structure& t, const std::vector<Block>& list) {
  std::string out = "block-triangular form: " + std::to_string(list.size()) + " blocks, solved one after the other\n";
  std::size_t number = 0;
  for (const Block& b : list) {
    std::string names, unknowns;
    for (std::size_t i : b.equations) names += (names.empty() ? "" : ", ") + s.equation_names[i];
    for (std::size_t j : b.unknowns)
      unknowns += (unknowns.empty() ? "" : ", ") +
                  derivative_name(s.variable_names[j], static_cast<unsigned>(t.d[j]), Format::text);
    out += "  " + std::to_string(++number) + "  " + names + "  for  " + unknowns + "\n";
  }
  return out;
}

}  // namespace anholon
