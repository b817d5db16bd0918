// The residuals of Newton's law and of the constraints as Taylor series in balls, for given series of the unknowns
// (theory: certificate, C1 to C3).
//
// Residual i < coordinates() is Newton's law E_i - G_i - N_i, residual coordinates() + r is the constraint phi_r.
#pragma once
#include "numeric/ball.h"
#include "setup/scenario.h"

namespace anholon {

using BallSeries = std::vector<std::vector<Ball>>;  // the coefficients of several series

// Returns (order + k)! / order!.
Ball rising(std::size_t order, std::size_t k);

class ResidualSeries {
 public:
  // `bits`: the precision of the balls.
  ResidualSeries(Workspace& scenario, slong bits);

  std::size_t coordinates() const { return coordinates_; }
  // The number of derivatives of each constraint that have to vanish.
  const std::vector<int>& hidden() const { return hidden_; }

  // Makes room for series up to this order.
  void reserve(int orders);
  // Computes the residuals up to this order about the time t, where the unknowns have the series x.
  void evaluate(const BallSeries& x, const Ball& t, int orders);

  // Coefficient k of residual i is at [k].
  const Ball* residual(std::size_t i) const { return machine_->series(tape_.roots[i]); }
  // The sum of the absolute values of the terms of a coefficient.
  Ball terms(std::size_t i, std::size_t order) const { return machine_->terms(i, order); }
  // A lower bound of the largest of |E|, |G|, |N| at the time t, and at least 1. Parts that no ball bounds are left
  // out: a bound relative to a smaller number is a bound, too.
  Ball newton_scale();

  // The formula with a kink or a jump within the ball of the time of the last evaluation; empty if there is none.
  std::string turning() const;

  // Series whose addition to the multipliers makes Newton's residual least, order by order, by least squares; empty if
  // there are none. The bounds do not depend on these series: balls enclose what is left.
  BallSeries correction(std::size_t orders) const;
  // A coefficient of Newton's residual with the multipliers corrected by delta.
  Ball corrected(std::size_t coordinate, std::size_t order, const BallSeries& delta) const;

 private:
  const Ball* phi(std::size_t constraint, std::size_t coordinate) const;

  const Scenario& s_;
  slong bits_;
  std::size_t coordinates_;
  Tape tape_;
  std::size_t phi_ = 0, scale_ = 0;  // the first root of Phi, and that of E, G, N
  std::vector<int> hidden_;
  std::vector<Ball> parameters_;
  std::unique_ptr<Machine<Ball>> machine_;
  int orders_ = -1;  // the orders that the machine has room for
};

}  // namespace anholon
