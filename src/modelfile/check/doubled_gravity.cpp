#include "modelfile/check/doubled_gravity.h"

#include <cmath>
#include <set>

#include "expr/generic_point.h"
#include "tape/point.h"

namespace anholon {

namespace {

// Values of expressions at one of several points that differ in the coordinates.
class Point {
 public:
  // `zero`: a parameter that is zero at this point.
  Point(const Model& model, std::uint64_t number, std::optional<std::uint32_t> zero)
      : model_(model), number_(number), zero_(zero), parameters_(model.parameters.size()) {}

  double operator()(Expr e) { return values_(e); }

 private:
  double symbol(const Node& n) {
    if (n.kind == Kind::jet) return generic_value(n, number_);
    if (n.kind != Kind::parameter) return generic_value(n, 0);
    std::optional<double>& known = parameters_[n.index];
    const Expr e = model_.parameters[n.index].value;
    if (!known) known = zero_ == n.index ? 0 : is_number(e) ? generic_value(n, 0) : values_of_parameters_(e);
    return *known;
  }

  const Model& model_;
  std::uint64_t number_;
  std::optional<std::uint32_t> zero_;
  std::vector<std::optional<double>> parameters_;
  PointValues values_{[this](const Node& n) { return symbol(n); }};
  PointValues values_of_parameters_{[this](const Node& n) { return symbol(n); }};
};

constexpr std::uint64_t kPoints = 3;

// The values of a function at all points.
using Values = std::array<double, kPoints>;

struct Energies {
  std::vector<Values> potentials;
  std::vector<Values> gravity;  // energies of each body
  Values gravity_of_all{};
};

// Returns the energies; with `part`, only the parts that this parameter adds.
Energies energies(const Model& model, std::optional<std::uint32_t> part) {
  Energies out;
  out.potentials.resize(model.potentials.size());
  out.gravity.resize(model.bodies.size());
  for (std::uint64_t k = 0; k < kPoints; ++k) {
    Point at(model, 1 + k, std::nullopt), without(model, 1 + k, part);
    const auto value = [&](Expr e) { return at(e) - (part ? without(e) : 0); };
    for (std::size_t i = 0; i < out.potentials.size(); ++i) out.potentials[i][k] = value(model.potentials[i].value);
    for (std::size_t b = 0; b < out.gravity.size(); ++b) {
      const Body& body = model.bodies[b];
      for (int i = 0; i < 3; ++i) out.gravity[b][k] -= at(body.mass) * value(body.gravity[i]) * at(body.center[i]);
      out.gravity_of_all[k] += out.gravity[b][k];
    }
  }
  return out;
}

// True if two functions differ by a constant and are not constants themselves.
bool same(const Values& a, const Values& b) {
  constexpr double kRoundOff = 1e-9;
  for (std::size_t k = 1; k < kPoints; ++k) {
    const double change = a[k] - a[0], other = b[k] - b[0];
    const double size = std::abs(a[k]) + std::abs(a[0]) + std::abs(b[k]) + std::abs(b[0]);
    if (!(std::abs(change) > kRoundOff * size) || !(std::abs(change - other) <= kRoundOff * size)) return false;
  }
  return true;
}

}  // namespace

void note_doubled_gravity(Model& model) {
  if (model.potentials.empty()) return;
  std::vector<std::optional<std::uint32_t>> parts = {std::nullopt};
  std::set<std::uint32_t> parameters;
  for (const Body& b : model.bodies) {
    const Expr field[] = {b.gravity.x, b.gravity.y, b.gravity.z};
    for (const NodeId id : symbols(field))
      if (const Node& n = model.graph->node(id); n.kind == Kind::parameter) parameters.insert(n.index);
  }
  parts.insert(parts.end(), parameters.begin(), parameters.end());
  std::vector<std::string> whose(model.potentials.size());
  for (const auto& part : parts) {
    const Energies e = energies(model, part);
    for (std::size_t i = 0; i < whose.size(); ++i) {
      if (whose[i].empty() && model.bodies.size() > 1 && same(e.potentials[i], e.gravity_of_all))
        whose[i] = "all bodies";
      for (std::size_t b = 0; b < e.gravity.size() && whose[i].empty(); ++b)
        if (same(e.potentials[i], e.gravity[b])) whose[i] = "'" + model.bodies[b].name + "'";
    }
  }
  for (std::size_t i = 0; i < whose.size(); ++i)
    if (!whose[i].empty())
      model.notes.push_back("the potential '" + model.potentials[i].name + "' holds the gravity of " + whose[i] +
                            ", which [gravity] holds as well: leave out one of the two");
}

}  // namespace anholon
