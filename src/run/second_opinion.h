// A second opinion on Taylor's motion: the same equations from the same start by another integrator, and where the two differ most.
#pragma once
#include "integrate/sundials.h"
#include "model/model.h"

namespace anholon {

struct SecondOpinion {
  Integrator integrator = Integrator::cvode;
  double difference = 0;  // largest |q - q_Taylor| / (1 + |q_Taylor|) of any coordinate in any row
  std::string of;         // that coordinate
  double t = 0;           // and that time
  double drift = 0;       // worst hidden constraint, in relation to its terms: nothing holds it
  std::size_t steps = 0, evaluations = 0;
  double seconds = 0;     // of its integration alone
};

// The motion by SUNDIALS that goes along with Taylor's. Which one leads does not matter to it: it knows nothing but the start and
// the equations.
class SecondMotion {
 public:
  SecondMotion(const Model& model, const Program& program, const SundialsSettings& settings, long double t, long double end,
               const std::vector<long double>& state, const std::vector<long double>& leading);

  // Goes on with other equations of the same motion (another elimination) from t, where Taylor's motion changes over, too.
  void go_on_with(const Program& program, long double t);
  // Takes Taylor's point at t and puts its own there, as integrated; notes the difference.
  Outcome at(long double t, Expansion<long double>& point);
  // The first integral of the program's quadratures at the time of the last point.
  long double work() const { return motion_->integrals().at(0); }
  const SecondOpinion& report() const { return report_; }

 private:
  Outcome advance(double t);

  const Model& model_;
  std::vector<double> parameters_;
  SundialsSettings settings_;
  double end_;
  std::unique_ptr<Sundials> motion_;
  std::size_t steps_before_ = 0, evaluations_before_ = 0;  // of motions that ended with their equations
  Outcome changeover_;
  SecondOpinion report_;
};

}  // namespace anholon
