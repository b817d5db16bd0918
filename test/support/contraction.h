// Compares equations without multipliers with Newton's law: both are projected on the tangents of the constraints,
// which are found numerically. Free higher derivatives are random, so derivatives that must cancel do.
#pragma once
#include "formulation/formulation.h"
#include "support/manifold.h"

namespace anholon::test {

// |B^T residual - B^T (E - G)| in units of the largest term, or |residual - B^T (E - G)| if there are as many equations
// as columns of B. Returns the largest of `points` points, or 1e300 if no point is found.
inline double miss_along_constraints(const Mechanics& M, const Elimination& e, const Column& residual, int points) {
  const PrecisionScope precision(40);
  const Model& model = *M.model;
  const Column a = newton_left_side(M) - put_masses(model, forces(M)),
               r = put_masses(model, e.in_coordinates(residual));
  double worst = 0;
  int found = 0;
  for (int seed = 1; seed <= points; ++seed) {
    const std::optional<Point> at = manifold_point(model, e, static_cast<std::uint64_t>(seed));
    if (!at) continue;
    ++found;
    const Matrix<Multi> B = tangents(model, e, *at);
    const std::vector<Multi> av = values(a, *at), rv = values(r, *at);
    const auto contracted = [&](const std::vector<Multi>& x, std::size_t k, double& scale) {
      Multi sum(0);
      for (std::size_t i = 0; i < x.size(); ++i) {
        sum += B(i, k) * x[i];
        scale = std::max(scale, std::abs(to_double(B(i, k) * x[i])));
      }
      return sum;
    };
    for (std::size_t k = 0; k < B.cols; ++k) {
      double scale = 1;
      const Multi want = contracted(av, k, scale);
      const Multi have = rv.size() == B.cols ? rv[k] : contracted(rv, k, scale);
      const double off = std::abs(to_double(Multi(have - want))) / scale;
      if (!(off <= worst)) worst = off == off ? off : 1e300;
    }
  }
  return found > 0 ? worst : 1e300;
}

}  // namespace anholon::test
