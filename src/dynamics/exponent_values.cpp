#include "dynamics/exponent_values.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "model/exponents.h"

namespace anholon {

// Exponents in double are whole numbers up to this, the round-off of a few operations.
static constexpr double kRoundOff = 1e-12;

ExponentValues::ExponentValues(const Model& given) {
  const std::shared_ptr<Model> model = clone(given);
  std::vector<std::size_t> all(model->parameters.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Column exponents = exponents_of(*model, all);
  for (Expr e : exponents) {
    std::set<std::size_t> met, found;
    std::vector<Expr> open{e};
    while (!open.empty()) {
      const std::vector<NodeId> in = symbols({&open.back(), 1});
      open.pop_back();
      for (const NodeId id : in) {
        const std::size_t i = model->graph->node(id).index;
        if (!met.insert(i).second) continue;
        open.push_back(model->parameters[i].value);
        if (symbols({&open.back(), 1}).empty()) found.insert(i);
      }
    }
    follows_from_.emplace_back(found.begin(), found.end());
  }
  if (!exponents.empty()) tape_ = compile(exponents);
}

ExponentValues::Values ExponentValues::whole(const std::vector<double>& parameters) const {
  Values out;
  if (!any()) return out;
  Machine<double> machine(tape_, 0, parameters);
  machine.evaluate();
  for (std::size_t i = 0; i < follows_from_.size(); ++i)
    if (const double e = machine.value(i); std::abs(e - std::round(e)) <= kRoundOff * std::max(1.0, std::abs(e)))
      for (const std::size_t k : follows_from_[i]) out[k] = parameters[k];
  return out;
}

std::vector<std::size_t> ExponentValues::others(const Values& values) const {
  std::set<std::size_t> out;
  for (const std::vector<std::size_t>& list : follows_from_) out.insert(list.begin(), list.end());
  for (const auto& [parameter, value] : values) out.erase(parameter);
  return {out.begin(), out.end()};
}

std::shared_ptr<const Model> with_values(const Model& model, const ExponentValues::Values& values) {
  const std::shared_ptr<Model> own = clone(model);
  for (const auto& [parameter, value] : values) own->parameters[parameter].value = own->graph->number(Rational(value));
  return own;
}

}  // namespace anholon
