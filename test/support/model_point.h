// Points at which expressions of a model are evaluated: parameters as given, all other symbols pseudo-random.
#pragma once
#include "model/model.h"
#include "support/value.h"
#include "tape/tape.h"

namespace anholon::test {

inline Point random_point(const Model& model, std::uint64_t seed) {
  Column es;
  for (const Parameter& p : model.parameters) es.push_back(p.value);
  return Point(seed).set_parameters(evaluate_parameters<Multi>(*model.graph, es));
}

// The point at a time tau later on a smooth path through `start`. Every jet is the derivative of the one below it, as
// in a motion whose derivatives from order `highest` + 1 on are zero.
inline Point moved(const Model& model, const Point& start, const Multi& tau, unsigned highest) {
  Graph& g = *model.graph;
  Point p = start;
  p.set(g.time(), start(g, g.time().id) + tau);
  for (std::uint32_t a = 0; a < model.coordinates.size(); ++a)
    for (unsigned k = 0; k <= highest; ++k) {
      Multi x(0), factor(1);
      for (unsigned i = k; i <= highest; ++i) {
        x += start(g, g.jet(a, i).id) * factor;
        factor = factor * tau / Multi(static_cast<int>(i - k + 1));
      }
      p.set(g.jet(a, k), x);
    }
  return p;
}

}  // namespace anholon::test
