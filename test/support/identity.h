// Identities at points: systems in which everything occurs that equations of order m can contain, and the residual of a
// sum of terms at a point, at arbitrary jets or on the manifold of the constraints.
#pragma once
#include <map>

#include "expr/normal.h"
#include "setup/eliminate.h"
#include "support/generic_system.h"
#include "support/manifold.h"
#include "support/models.h"

namespace anholon::test {

inline constexpr int kIdentityPoints = 2;

struct System {
  std::shared_ptr<const Model> model;
  Mechanics m;
  explicit System(std::shared_ptr<const Model> from) : model(std::move(from)), m(mechanics(*model)) {}
  Graph& g() const { return *model->graph; }
  Column by(unsigned order, Expr e) const { return gradient(e, jets(*model, order)); }
};

inline std::vector<std::shared_ptr<const System>> rheonomic() {
  static std::vector<std::shared_ptr<const System>> systems;
  if (systems.empty())
    for (const char* order : {"1", "2", "3"})
      systems.push_back(std::make_shared<System>(shipped(std::string("zoo/rheonomic-order-") + order)));
  return systems;
}

inline std::shared_ptr<const System> generic(unsigned m, Shape shape, Speeds speeds = Speeds::none) {
  static std::map<std::tuple<unsigned, Shape, Speeds>, std::shared_ptr<const System>> known;
  std::shared_ptr<const System>& s = known[{m, shape, speeds}];
  if (!s) s = std::make_shared<System>(model_of(generic_system(static_cast<int>(m), shape, speeds)));
  return s;
}

// An identity states that the sum of its terms is zero.
using Terms = std::vector<Column>;

inline Column sum_of(const Terms& terms) {
  Column all;
  for (const Column& c : terms) all = all + c;
  return all;
}

// |sum of the terms| in units of the largest of them and 1.
inline double miss_at(const System& s, const Terms& terms, const Point& at) {
  double largest = 1, worst = 0;
  std::vector<Multi> total;
  for (const Column& c : terms) {
    const std::vector<Multi> v = values(put_masses(*s.model, c), at);
    total.resize(v.size(), Multi(0));
    for (std::size_t i = 0; i < v.size(); ++i) {
      total[i] += v[i];
      largest = std::max(largest, std::abs(to_double(v[i])));
    }
  }
  for (const Multi& x : total) {
    const double miss = std::abs(to_double(x)) / largest;
    if (!(miss <= worst)) worst = miss == miss ? miss : 1e300;
  }
  return worst;
}

inline double miss(const System& s, const Terms& terms) {
  const PrecisionScope precision(40);
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= kIdentityPoints; ++seed)
    worst = std::max(worst, miss_at(s, terms, random_point(*s.model, seed)));
  return worst;
}

inline double miss(const System& s, const Elimination& e, Terms terms) {
  const PrecisionScope precision(40);
  for (Column& c : terms) c = e.in_coordinates(c);
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= kIdentityPoints; ++seed) {
    const std::optional<Point> at = manifold_point(*s.model, e, seed);
    if (!at) return 1e300;
    worst = std::max(worst, miss_at(s, terms, *at));
  }
  return worst;
}

inline bool proved(const Terms& terms) {
  for (Expr e : sum_of(terms))
    if (!proved_zero(e)) return false;
  return true;
}

}  // namespace anholon::test
