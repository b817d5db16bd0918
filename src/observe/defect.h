// The defect of the dense output, enclosed: by how much the motion that was delivered misses Newton's law and the
// constraints.
//
// On each step every unknown is a polynomial x_j(t) whose coefficients are binary numbers, so exact, and so are its
// derivatives; the parameters are exact as the user wrote them. Put into
//
//   Newton's law    E_a - G_a - N_a                       (theory: certificate, C1; N with the polynomials of the multipliers)
//   the same without multipliers: E_a - G_a - (Phi^T lambda*)_a with any lambda*, chosen so that little is left               (C2)
//   constraints     phi_r and its derivatives by t, as far as they are hidden constraints     (C3)
//
// and evaluated in balls, these give bounds that hold for the trajectory itself, whatever rounding, step control or
// linear algebra made it: a backward error. Where steps meet the polynomials need not: the largest jump of the state is
// reported beside.
//
// For one time a ball of that time is put in. For all times of an interval c + s, |s| <= r, each residual R is a Taylor
// polynomial about c with the remainder of Lagrange (theory: defect; the coefficients by residual_series.h):
//
//   |R| <= sum_(k<K) |R_k(c)| r^k + |R_K(c +- r)| r^K
//
// The interval is halved while the remainder is what counts.
//
// All bounds are relative as those of the residual report: to the largest term, and at least to 1.
#pragma once
#include "integrate/stepper.h"
#include "observe/residual_series.h"

namespace anholon {

// x_j(t) = sum_k coefficient[j][k] (t - begin)^k for t from begin to end.
struct DenseStep {
  Ball begin, end;
  BallSeries coefficients;
};

// The last step of a stepper, exactly.
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
  std::optional<std::size_t> times;  // that the motion reached, at which the bounds hold; nullopt: at all times
  std::size_t pieces = 0;            // in which these were found
  std::string newton, projected, constraints, joints;  // bounds, rounded upwards; "inf" where there is none
  long bits = 0;                                       // of the midpoints of balls
  // Where the bounds stay large, because a formula has a kink or jumps there.
  struct Kink {
    std::string formula;
    double t = 0;
  };
  std::optional<Kink> kink = {};
};

class Defect {
 public:
  // Bounds at `times` times, spread evenly from begin to end; at all times if 0. `significand`: bits of the numbers of
  // the motion.
  Defect(Workspace& scenario, std::size_t times, const Ball& begin, const Ball& end, long significand);

  // The steps of the motion, one after the other. REQUIRES: a coefficient at least for every derivative that belongs to
  // the state.
  void step(const DenseStep& step);
  // nullopt if the motion reached none of the times.
  std::optional<RigorousReport> report() const;

 private:
  // In relation to the largest terms.
  struct Bounds {
    Ball newton, projected, constraints;
    bool is_finite() const { return newton.is_finite() && projected.is_finite() && constraints.is_finite(); }
  };
  struct PieceBounds : Bounds {
    bool sharp = true;   // the remainders are not what counts
    bool smooth = true;  // there are remainders
  };
  PieceBounds at_time(const DenseStep& step, const Ball& time);
  PieceBounds over(const BallSeries& centered, const Ball& center, const Ball& radius);
  void piece(const DenseStep& step, const Ball& begin, const Ball& end, int halvings);  // so many so far
  // Looks for what keeps the bounds of a piece large that contains this time.
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
  Bounds worst_, worst_smooth_;  // of all pieces, and of those that lie away from kinks
  std::optional<RigorousReport::Kink> kink_;
  Ball joints_;
};

}  // namespace anholon
