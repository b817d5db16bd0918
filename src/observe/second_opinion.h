// A second opinion on Taylor's motion: the same motion from the same start by another integrator, and where the two
// differ most.
//
// Forms that eliminate coordinates are asked in Routh's equations: theirs hold on the constraints only, which SUNDIALS
// leaves by its error, and where a pivot becomes small that error grows without bound (theory: second-opinion).
#pragma once
#include "integrate/states/sundials.h"
#include "setup/scenario.h"

namespace anholon {

struct SecondOpinion {
  Method integrator = Method::cvode;
  std::string form;       // of the equations it integrates
  double difference = 0;  // largest |q - q_Taylor| / (1 + |q_Taylor|) of any coordinate in any row
  std::string of;         // that coordinate
  double t = 0;           // and that time
  double drift = 0;       // worst hidden constraint, in relation to its terms: nothing holds it
  std::size_t steps = 0, evaluations = 0;
  double seconds = 0;  // of its integration alone
};

class SecondMotion {
 public:
  // Towards `end`; the power is integrated along.
  SecondMotion(Workspace& scenario, const StateChoice& choice, Expr power, const SundialsSettings& settings,
               long double end);

  // Its own point at t, given Taylor's: the state as integrated, not projected, and what the equations say there. Notes
  // the difference of the two.
  Outcome at(long double t, const Expansion<long double>& taylor);
  const Expansion<long double>& point() const { return *point_; }
  // The work done until that point.
  const long double& work() const { return work_; }
  const SecondOpinion& report() const { return report_; }

 private:
  Outcome put(long double t, const Expansion<long double>& taylor);
  Outcome start(Workspace& scenario, const StateChoice& choice, Expr power, const SundialsSettings& settings,
                long double end);

  const Model& model_;
  std::unique_ptr<Workspace> routh_;  // where the form eliminates
  std::unique_ptr<Program> program_;
  std::unique_ptr<Sundials> motion_;
  std::optional<Expansion<long double>> point_;
  long double work_ = 0;
  Outcome start_;
  SecondOpinion report_;
};

}  // namespace anholon
