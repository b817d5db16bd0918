#include "emit/rate_formulas.h"

namespace anholon {

std::vector<Column> RateFormulas::matrix() const {
  std::vector<Column> rows;
  for (Expr e : equations) rows.push_back(gradient(e, lead.symbols));
  return rows;
}

Column RateFormulas::right() const {
  if (!linear) return -equations;
  Graph& g = *model->graph;
  return -substitute(equations, [&](NodeId id) {
    for (Expr s : lead.symbols)
      if (s.id == id) return g.zero();
    return Expr{};
  });
}

}  // namespace anholon
