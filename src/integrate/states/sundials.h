// Integrates motions by SUNDIALS, as a second opinion on Taylor's method: CVODE integrates the state's ordinary
// differential equations, IDA the implicit equations themselves.
//
//   CVODE  y' = f(t, y),           y = (x_j^(k), k < d_j): x_j^(k)' = x_j^(k+1), and at the end of each chain the leading
//                                  derivative, which the equations determine; Adams' methods, fixed-point iteration
//   IDA    F(t, y, z, y', z') = 0, z = (x_j, d_j = 0): x_j^(k)' = x_j^(k+1), and E_i^(c_i) = 0 with y' in place of the leading
//                                  derivatives; BDF, Newton's method with difference quotients for dF/dy + alpha dF/dy'
//
//   BDF    as CVODE, for stiff motions in earnest (theory: methods): BDF, Newton's method with difference quotients; f is that of
//          StateRate, every step is taken back to the hidden constraints, and each level of derivatives is measured by its own size
//
// and the integrals W of the program's quadratures, W' = P. Hypothesis: J = dE_i^(c_i) / dx_j^(d_j) is regular, so F
// has index 1 (theory: dae-view). The hidden constraints E_i^(k) = 0, k < c_i, are what the start satisfies; for CVODE
// and IDA nothing holds them, they drift with the error of the integration (theory: second-opinion). Source: Hindmarsh
// et al. 2005.
#pragma once
#include <functional>
#include <memory>

#include "integrate/states/state_rate.h"
#include "model/methods.h"
#include "model/model.h"

namespace anholon {

struct SundialsSettings {
  Method integrator = Method::cvode;  // or Method::ida
  double tolerance = 1e-12;           // relative and absolute, of each step
  std::size_t most_steps = 50'000'000;
  std::function<bool()> cancelled;    // called between steps
  double integral_tolerance = 1e-12;  // of BDF; errors of integrals do not affect later steps
};

// An object is not copied, and is used by one thread at a time; several objects may be used at once.
class Sundials {
 public:
  // Starts at t; the equations are not evaluated beyond `end`. `leading` selects the branch.
  Sundials(const Program& program, const std::vector<double>& parameters, const SundialsSettings& settings, double t,
           double end, const std::vector<double>& state, const std::vector<double>& leading,
           const std::vector<double>& integrals);
  ~Sundials();
  Sundials(const Sundials&) = delete;
  Sundials& operator=(const Sundials&) = delete;

  // Starts BDF with `rate`, which belongs to the same program.
  Sundials(StateRate rate, const SundialsSettings& settings, double t, double end, const std::vector<double>& state,
           const std::vector<double>& leading, const std::vector<double>& integrals);

  // Makes steps until one contains t, and interpolates there. REQUIRES: t goes back by at most a step.
  Outcome advance(double t);
  // Makes one step of a length that the method chooses; state() and the others are then at its end.
  Outcome step();
  // Of BDF: steps end at this time, which lies ahead.
  void stop_at(double t);
  // Of BDF: moves state() and the others from the end of the last step, before a kink that the time alone decides, to
  // a time a few round-offs ahead, behind it. The steps still lie behind; go_on_from() has to be called before the next
  // one, which begins the method anew at that point if f jumps by what a step would notice.
  Outcome pass(double behind);
  void go_on_from(double t, const std::vector<double>& state, const std::vector<double>& leading,
                  const std::vector<double>& integrals);

  // At the time of the last advance, or at the start: the state as integrated, and approximate leading derivatives.
  double time() const;
  const std::vector<double>& state() const;
  const std::vector<double>& leading() const;
  const std::vector<double>& integrals() const;

  std::size_t steps() const;
  std::size_t evaluations() const;  // evaluations of f or F
  std::size_t refused() const;      // refused steps of BDF: by the error test, or because Newton's method failed
  std::size_t setups() const;       // set-ups of Newton's method, each of which costs size^3 operations
  StateRate& rate();                // of BDF

  double drift() const;  // the largest distance of the steps from the hidden constraints

 private:
  void begin(double t, double end, const std::vector<double>& state, const std::vector<double>& leading,
             const std::vector<double>& integrals);

  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace anholon
