// A second opinion on Taylor's motion: the same motion from the same start by another integrator, and the largest
// difference between the two.
//
// For forms that eliminate coordinates, the integrator gets Routh's equations. The equations of such forms hold on the
// constraints only, which SUNDIALS leaves by its error, and near small pivots this error grows without bound (theory:
// second-opinion).
#pragma once
#include "integrate/states/sundials.h"
#include "setup/scenario.h"

namespace anholon {

struct SecondOpinion {
  Method integrator = Method::cvode;
  std::string form;       // of the equations that it integrates
  double difference = 0;  // largest |q - q_Taylor| / (1 + |q_Taylor|) of any coordinate in any row
  std::string of;         // the coordinate of this difference
  double t = 0;           // its time
  double drift = 0;       // worst hidden constraint, relative to its terms: the method does not enforce them
  std::size_t steps = 0, evaluations = 0;
  double seconds = 0;  // of the integration alone
};

class SecondMotion {
 public:
  // Starts the motion towards `end`; the power is integrated along with it.
  SecondMotion(Workspace& scenario, const StateChoice& choice, Expr power, const SundialsSettings& settings,
               long double end);

  // Computes its own point at t, given Taylor's: the state as integrated, not projected, and the solution of the
  // equations there. Notes the difference of the two.
  Outcome at(long double t, const Expansion<long double>& taylor);
  const Expansion<long double>& point() const { return *point_; }
  // The work up to that point.
  const long double& work() const { return work_; }
  const SecondOpinion& report() const { return report_; }

 private:
  Outcome put(long double t, const Expansion<long double>& taylor);
  Outcome start(Workspace& scenario, const StateChoice& choice, Expr power, const SundialsSettings& settings,
                long double end);

  const Model& model_;
  std::unique_ptr<Workspace> routh_;  // if the form eliminates
  std::unique_ptr<Program> program_;
  std::unique_ptr<Sundials> motion_;
  std::optional<Expansion<long double>> point_;
  long double work_ = 0;
  Outcome start_;
  SecondOpinion report_;
};

}  // namespace anholon
