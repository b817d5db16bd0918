// What is watched along a motion, point by point: the residual report by another way than the equations integrated, and the
// reactions N that the rows show.
//
//   C1, C2  Newton's law by the points themselves, with and without multipliers  (theory: certificate)
//   C3      hidden constraints
//   power   h - h(0) - W, W the integral of the right side of the power identity
#pragma once
#include "run/motion.h"
#include "run/simulate.h"

namespace anholon {

// What has to be integrated for it: the power of all forces first, then the masses that vary.
std::vector<Expr> watched_quadratures(const Scenario& s, const Power& p);

template <Number W>
class Watch {
 public:
  Watch(const Scenario& scenario, const Power& power, const std::vector<W>& parameters);

  // At a point of the motion: fills the residuals of the report. Not ok if a redundant constraint no longer follows from the others.
  Outcome see(const Expansion<W>& point, SimulationReport& report);
  // N at the point seen last.
  const W& reaction(std::size_t coordinate) const { return outputs_[coordinate]; }

  // The energy balance from one point to another, between which the work is integrated.
  void start_balance(const Expansion<W>& point) { h0_ = energy(point); }
  double balance(const Expansion<W>& point, const W& work);

 private:
  Column expressions(const Power& power) const;
  W energy(const Expansion<W>& point);

  const Scenario& s_;
  OutputTape<W> outputs_;
  W h0_{0};
};

extern template class Watch<long double>;
extern template class Watch<Quad>;
extern template class Watch<Multi>;

}  // namespace anholon
