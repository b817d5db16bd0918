#include "setup/notes_on_multipliers.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "expr/generic_point.h"
#include "modelfile/names/multiplier_names.h"
#include "setup/eliminate.h"

namespace anholon {

namespace {

bool is_multiplier(const Node& n) { return n.kind == Kind::multiplier; }

// Tells by numbers whether a formula changes with the multipliers.
class Change {
 public:
  Change(const Model& model, const InitialState<double>& state, Expr formula)
      : formula_(formula), near_(symbol_near(model, evaluate_parameters<double>(*model.graph, values(model)), state)) {}

  // True if the value changes with the multipliers along a dependency.
  bool along(const Dependency& d) const {
    constexpr double kSame = 1e-9;  // far above round-off
    bool any = false;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const double before = value(d, 0, seed), after = value(d, 1, seed);
      if (!std::isfinite(before) || !std::isfinite(after)) continue;
      any = true;
      if (std::abs(after - before) > kSame * (std::abs(after) + std::abs(before))) return true;
    }
    return !any;  // a formula without values at these places is not known to be determined
  }

 private:
  static Column values(const Model& model) {
    Column es;
    for (const Parameter& p : model.parameters) es.push_back(p.value);
    return es;
  }
  double value(const Dependency& d, double factor, std::uint64_t seed) const {
    // Even places have multipliers of both signs.
    PointValues at([&](const Node& n) {
      if (!is_multiplier(n) || n.index >= d.size()) return near_(n);
      const double lambda = generic_value(n, seed) - (seed % 2 == 0 ? 0.5 : 0.0);
      return lambda + factor * d[n.index] / largest(d);
    });
    return at(formula_);
  }
  static double largest(const Dependency& d) {
    double most = 0;
    for (const double x : d) most = std::max(most, std::abs(x));
    return most;
  }

  Expr formula_;
  std::function<double(const Node&)> near_;
};

std::string quoted(const Model& m, const std::vector<std::size_t>& constraints) {
  std::vector<std::string> names;
  for (const std::size_t r : constraints) names.push_back("'" + m.constraints[r].name + "'");
  return joined_names(names);
}

// The redundant constraints of a group, and whether they follow from the same ones everywhere.
std::pair<std::vector<std::size_t>, bool> left_out(const UndeterminedMultipliers& shared,
                                                   const std::vector<std::size_t>& group) {
  std::pair<std::vector<std::size_t>, bool> found{{}, true};
  for (std::size_t k = 0; k < shared.redundant.size(); ++k) {
    if (std::find(group.begin(), group.end(), shared.redundant[k]) == group.end()) continue;
    found.first.push_back(shared.redundant[k]);
    found.second = found.second && shared.lasts[k];
  }
  return found;
}

std::string share(const std::vector<std::size_t>& group) {
  return group.size() > 2 ? "share their forces" : "share one force";
}

std::string remedy(const Model& m, const UndeterminedMultipliers& shared, const std::vector<std::size_t>& group) {
  const auto [constraints, everywhere] = left_out(shared, group);
  return without_constraints(m, constraints, everywhere);
}

}  // namespace

std::vector<NamedFormula> formulas_with_multipliers(const Model& m) {
  std::vector<NamedFormula> list;
  const auto add = [&](const std::string& kind, const std::string& name, Expr e) {
    if (e.graph && holds_multiplier(e)) list.push_back({kind + " '" + name + "'", e});
  };
  for (const Monitor& of : m.monitors) {
    const bool output = std::any_of(m.outputs.begin(), m.outputs.end(), [&](const OutputQuantity& q) {
      return of.name == q.name || of.name.rfind(q.name + ".", 0) == 0;
    });
    add(output ? "output" : "monitor", of.name, of.value);
  }
  for (const Event& e : m.events) {
    add("event", e.name, e.when);
    for (const Assignment& set : e.set) add("what is set by event", e.name, set.value);
  }
  for (const StateVariable& z : m.states) add("the rate of", z.name, z.rate);
  for (const Condition& c : m.initial.conditions) add("condition", c.text, c.residual);
  return list;
}

std::string note_of_undetermined(const Model& m, const UndeterminedMultipliers& shared,
                                 const std::vector<std::size_t>& group, bool least) {
  return multiplier_names(m, group) + " are not determined one by one, because these constraints " + share(group) +
         ": the columns have " +
         (least ? "the smallest ones with these forces (least norm), which depend on how the equations are scaled"
                : "0 for those that are left out") +
         "; the sums that make up a force, N, reaction(B) and the motion are determined; with " +
         remedy(m, shared, group) + " the equations determine each multiplier";
}

std::string note_of_formula(const Model& m, const UndeterminedMultipliers& shared, const InitialState<double>& state,
                            const NamedFormula& f) {
  if (!shared.any() || !holds_multiplier(f.formula)) return {};
  const Change change(m, state, f.formula);
  std::set<std::size_t> held;
  for (const NodeId id : symbols({&f.formula, 1}))
    if (const Node& n = f.formula.graph->node(id); is_multiplier(n)) held.insert(n.index);
  std::vector<std::size_t> found;
  for (const Dependency& d : shared.dependencies) {
    if (d.empty() || std::none_of(held.begin(), held.end(), [&](std::size_t r) { return takes_part(d, r); })) continue;
    if (!change.along(d)) continue;
    for (const std::size_t r : held)
      if (takes_part(d, r) && std::find(found.begin(), found.end(), r) == found.end()) found.push_back(r);
  }
  if (found.empty()) return {};
  std::sort(found.begin(), found.end());
  const std::vector<std::size_t> group = shared.group_of(found[0]);
  const bool one = m.bodies.size() == 1;
  return f.what + " contains " + multiplier_names(m, found) + ", which the equations do not determine, as " +
         quoted(m, group) + " " + share(group) + ": take reaction(" + (one ? m.bodies[0].name : "B") +
         (one ? "" : ") of a body B") + (one ? ") in its place" : " in its place") + ", or write the model with " +
         remedy(m, shared, group);
}

std::string joined_names(const std::vector<std::string>& names) {
  constexpr std::size_t kNamed = 8;
  std::string list;
  for (std::size_t k = 0; k < names.size() && k < kNamed; ++k)
    list += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  return names.size() > kNamed ? list + ", …" : list;
}

std::string multiplier_names(const Model& m, const std::vector<std::size_t>& constraints) {
  std::vector<std::string> names;
  for (const std::size_t r : constraints) names.push_back(multiplier_name(m, r));
  return joined_names(names);
}

std::string without_constraints(const Model& m, const std::vector<std::size_t>& constraints, bool example) {
  std::map<std::string, std::string> axes;  // of vector equations: the components to leave out
  std::vector<std::string> whole, steps;
  for (const std::size_t r : constraints) {
    const std::string& name = m.constraints[r].name;
    const std::size_t dot = name.rfind('.');
    if (dot != std::string::npos && dot + 2 == name.size() && name.back() >= 'x' && name.back() <= 'z')
      axes[name.substr(0, dot)] += name.back();
    else
      whole.push_back("'" + name + "'");
  }
  for (const auto& [name, out] : axes) {
    std::string kept;
    for (const char axis : {'x', 'y', 'z'})
      if (out.find(axis) == std::string::npos) kept += std::string(kept.empty() ? "" : ", ") + "\"e" + axis + "\"";
    steps.push_back(example && !kept.empty() ? "along = [" + kept + "] in '" + name + "'"
                                             : "'along' in '" + name + "' with the directions that count");
  }
  if (!whole.empty()) steps.insert(steps.begin(), joined_names(whole) + " left out");
  return joined_names(steps);
}

}  // namespace anholon
