#include "setup/start/large_angles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "expr/generic_point.h"
#include "modelfile/names/with_unit.h"
#include "tape/point.h"

namespace anholon {

namespace {

constexpr double kFourTurns = 8 * std::numbers::pi;

bool usual_in_degrees(double angle) {
  for (const double degrees : {30, 45, 60, 90, 180, 270, 360})
    if (std::abs(angle) == degrees) return true;
  return false;
}

bool is_circular(const Node& n) {
  return n.kind == Kind::function &&
         (n.index == static_cast<std::uint32_t>(Function::sin) ||
          n.index == static_cast<std::uint32_t>(Function::cos) || n.index == static_cast<std::uint32_t>(Function::tan));
}

// Returns for each coordinate whether it is a term in the argument of a circular function.
std::vector<bool> terms_of_angles(const Graph& g, std::size_t nodes, std::size_t coordinates) {
  std::vector<bool> found(coordinates, false);
  const auto see = [&](NodeId id) {
    if (const Node& n = g.node(id); n.kind == Kind::jet && n.order == 0) found[n.index] = true;
  };
  for (NodeId id = 0; id < nodes; ++id) {
    if (!is_circular(g.node(id))) continue;
    const NodeId argument = g.terms(id)[0].node;
    see(argument);
    if (g.node(argument).kind == Kind::sum)
      for (const Term& term : g.terms(argument)) see(term.node);
  }
  return found;
}

// Removes the coordinates that occur in the position of a body outside circular functions.
void remove_lengths(const Model& model, std::vector<bool>& angles) {
  const Graph& g = *model.graph;
  std::vector<bool> seen(g.size(), false);
  std::vector<NodeId> open;
  for (const Body& b : model.bodies)
    for (int i = 0; i < 3; ++i) open.push_back(b.center[i].id);
  while (!open.empty()) {
    const NodeId id = open.back();
    open.pop_back();
    if (seen[id]) continue;
    seen[id] = true;
    const Node& n = g.node(id);
    if (n.kind == Kind::jet && n.order == 0) angles[n.index] = false;
    if (is_circular(n)) continue;
    for (const Term& term : g.summands(id)) open.push_back(term.node);
  }
}

// True if the equations at a generic point change with the coordinate. In the equations of a rolling wheel, its angle
// may occur in terms that cancel.
bool changes(const System& system, std::size_t coordinate) {
  constexpr double kChange = 1e-6;  // far above round-off
  const auto values = [&](double moved) {
    return PointValues([&, moved](const Node& n) {
      const bool here = n.kind == Kind::jet && n.order == 0 && n.index == coordinate;
      return generic_value(n, 1) + (here ? moved : 0);
    });
  };
  PointValues before = values(0), after = values(1);
  return std::any_of(system.equations.begin(), system.equations.end(), [&](Expr e) {
    const double a = before(e), b = after(e);
    return !(std::abs(a - b) <= kChange * (std::abs(a) + std::abs(b)));
  });
}

// True if the initial value of the coordinate is written with a unit, in the file or beside it.
bool is_with_unit(const Model& model, const std::vector<StateOverride>& overrides, std::size_t coordinate) {
  for (const StateOverride& o : overrides)
    if (!o.multiplier && o.order == 0 && o.coordinate == coordinate) return o.with_unit;
  const Expr symbol = model.graph->jet(static_cast<std::uint32_t>(coordinate), 0);
  return std::any_of(model.initial.given.begin(), model.initial.given.end(), [&](const GivenValue& v) {
    return v.symbol == symbol && is_with_unit(model.source_text, v.span);
  });
}

}  // namespace

std::string note_of_large_angles(const System& system, const InitialState<double>& state, std::size_t nodes,
                                 const std::vector<StateOverride>& overrides) {
  constexpr std::size_t kNamed = 8;
  const Model& model = *system.model;
  const std::size_t n = state.q.size();
  const auto given = [&](std::size_t a) {
    return state.q_origin[a] == Origin::given || state.q_origin[a] == Origin::corrected;
  };
  std::vector<std::size_t> large;
  for (std::size_t a = 0; a < n; ++a)
    if (given(a) && (usual_in_degrees(state.q[a]) || std::abs(state.q[a]) > kFourTurns)) large.push_back(a);
  if (large.empty()) return {};
  std::vector<bool> angles = terms_of_angles(*model.graph, nodes, n);
  remove_lengths(model, angles);
  std::erase_if(large, [&](std::size_t a) {
    return !angles[a] || !(usual_in_degrees(state.q[a]) || changes(system, a)) || is_with_unit(model, overrides, a);
  });
  if (large.empty()) return {};
  const auto text = [&](std::size_t a, const std::string& value) { return model.coordinates[a].name + " = " + value; };
  std::string list;
  for (std::size_t k = 0; k < large.size() && k < kNamed; ++k)
    list += (k ? ", " : "") + text(large[k], number_text(state.q[large[k]]));
  const std::size_t first = large[0];
  return list + (large.size() > kNamed ? ", …" : "") + " at the start: angles are in radians; in degrees write " +
         text(first, "\"" + number_text(state.q[first]) + " deg\"");
}

}  // namespace anholon
