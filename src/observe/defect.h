// Encloses the defect of the dense output: by how much the computed motion misses Newton's law and the constraints.
//
// On each step every unknown is a polynomial x_j(t) whose coefficients are binary numbers, so the polynomial and its
// derivatives are exact; the parameters are exact as the user wrote them. Put into
//
//   Newton's law    E_a - G_a - N_a                       (theory: certificate, C1; N with the polynomials of the multipliers)
//   the same without multipliers: E_a - G_a - (Phi^T lambda*)_a with any lambda*, chosen so that little is left               (C2)
//   constraints     phi_r and its derivatives by t, as far as they are hidden constraints     (C3)
//
// and evaluated in balls, these give bounds for the computed trajectory itself, whatever rounding, step control or
// linear algebra made it: a backward error. The polynomials of two steps need not meet exactly; the largest jump of the
// state is reported, too.
//
// For a single time, a ball of that time is put in. For all times of an interval c + s, |s| <= r, each residual R is a
// Taylor polynomial about c with the remainder of Lagrange (theory: defect; the coefficients by residual_series.h):
//
//   |R| <= sum_(k<K) |R_k(c)| r^k + |R_K(c +- r)| r^K
//
// The interval is halved while the remainder dominates.
//
// All bounds are relative, like those of the residual report: to the largest term, and at least to 1.
#pragma once
#include "integrate/stepper.h"
#include "observe/residual_series.h"

namespace anholon {

// x_j(t) = sum_k coefficient[j][k] (t - begin)^k for t from begin to end.
struct DenseStep {
  Ball begin, end;
  BallSeries coefficients;
};

// Returns the last step of a stepper, exactly.
template <Number N>
DenseStep dense_step(const Stepper<N>& stepper, const Wider<N>& end) {
  DenseStep step{Ball(stepper.before()), Ball(end), {}};
  for (std::size_t j = 0; j < stepper.unknowns(); ++j) {
    std::vector<Ball>& x = step.coefficients.emplace_back();
    for (int k = 0; k <= stepper.degree(j); ++k) x.emplace_back(stepper.dense(j, k));
  }
  return step;
}

struct RigorousReport {
  // The number of times, up to the end of the motion, at which the bounds hold; nullopt: at all times.
  std::optional<std::size_t> times;
  std::size_t pieces = 0;                              // the number of pieces
  std::string newton, projected, constraints, joints;  // bounds, rounded upwards; "inf" if there is no bound
  long bits = 0;                                       // of the midpoints of balls
  // The kink or jump of a formula where the bounds stay large.
  struct Kink {
    std::string formula;
    double t = 0;
  };
  std::optional<Kink> kink = {};
};

class Defect {
 public:
  // Computes bounds at `times` times, spread evenly from begin to end; at all times if 0. `significand`: the number of
  // bits of the motion's numbers.
  Defect(Workspace& scenario, std::size_t times, const Ball& begin, const Ball& end, long significand);

  // Takes the steps of the motion one after the other. REQUIRES: at least one coefficient for every derivative that
  // belongs to the state.
  void step(const DenseStep& step);
  // Returns nullopt if the motion reached none of the times.
  std::optional<RigorousReport> report() const;

 private:
  // Bounds relative to the largest terms.
  struct Bounds {
    Ball newton, projected, constraints;
    bool is_finite() const { return newton.is_finite() && projected.is_finite() && constraints.is_finite(); }
  };
  struct PieceBounds : Bounds {
    bool sharp = true;   // the remainders do not dominate
    bool smooth = true;  // there are remainders
  };
  PieceBounds at_time(const DenseStep& step, const Ball& time);
  PieceBounds over(const BallSeries& centered, const Ball& center, const Ball& radius);
  void piece(const DenseStep& step, const Ball& begin, const Ball& end, int halvings);  // `halvings`: so many so far
  // Notes the formula that keeps the bounds of a piece large; the piece contains this time.
  void gave_up_at(const Ball& center);
  static void put_larger(const Bounds& b, Bounds& in);
  bool says_more(const Bounds& b) const;
  void keep(const Bounds& b);

  const std::vector<int> d_;  // derivatives of the unknowns that belong to the state
  std::size_t times_, reached_ = 0, pieces_ = 0, pieces_of_step_ = 0;
  slong bits_;
  Ball begin_, end_, quiet_;
  ResidualSeries residuals_;
  BallSeries last_;              // derivatives of the unknowns where the last step ended
  Bounds worst_, worst_smooth_;  // of all pieces, and of those away from kinks
  std::optional<RigorousReport::Kink> kink_;
  Ball joints_;
};

}  // namespace anholon
