// Finds events along a motion: the strict changes of sign of given series, located on the Taylor polynomial.
//
// Each series has a side, the sign it last had. At the start and after a restart the side is the sign of the value, or,
// if the value is round-off, the sign that the series takes right afterwards; so no event fires there. If a series has
// not fired and a restart leaves it at zero, it keeps its side, because it may be about to pass zero.
//
// A series is cut off at the order of the state's, and a formula of the state converges more slowly than the state.
// Therefore its zeros are improved on values of the formula itself, by Newton's method. If a formula has no series, its
// values show the changes of sign.
//
// A gap that an impact has closed begins at zero. Its value there is round-off, which divided by its small velocity
// would be the error of the time of the next impact. Such a series begins at zero in the first step, and its values are
// differences from its first value.
#pragma once
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "program/expansion.h"

namespace anholon {

struct WatchedSeries {
  std::size_t quadrature = 0;  // of the program
  int direction = 0;           // 1: only upwards, -1: only downwards
  bool ends_step = false;
  bool of_state = false;   // its value follows from the state and the leading derivatives
  bool from_zero = false;  // zero where the motion begins, whatever round-off its value has
  // True if the event fires at a change of sign to `towards`, in the direction of time, whichever way the motion is
  // integrated.
  bool fires(int towards) const { return direction == 0 || direction == towards; }
};

template <Number N>
struct Fired {
  std::size_t series = 0;
  N where{0};  // the distance from the start of the step
};

template <Number N>
class EventWatch {
 public:
  explicit EventWatch(std::vector<WatchedSeries> series) : series_(std::move(series)), sides_(series_.size(), 0) {}

  bool empty() const { return series_.empty(); }
  const std::vector<WatchedSeries>& series() const { return series_; }
  // The sign -1 or 1; 0 if it is not known yet; -2 or 2 if it is kept over a restart.
  const std::vector<int>& sides() const { return sides_; }
  void set_sides(std::vector<int> sides) { sides_ = std::move(sides); }
  // Makes the next step find the sides anew.
  void restart();

  // Reads the series of the present expansion, which the functions below use: coefficient(q, k) is that of order k, up
  // to `degree`, of quadrature q of the program, and terms(q) the magnitude of the terms of its value.
  template <class Coefficient, class Terms>
  void read(int degree, const Coefficient& coefficient, const Terms& terms) {
    degree_ = degree;
    known_.resize(series_.size());
    for (std::size_t i = 0; i < series_.size(); ++i) {
      const std::size_t q = series_[i].quadrature;
      known_[i].c.resize(static_cast<std::size_t>(degree) + 1);
      for (int k = 0; k <= degree; ++k) known_[i].c[static_cast<std::size_t>(k)] = coefficient(q, k);
      known_[i].terms = terms(q);
      known_[i].begins.reset();
    }
  }
  // Notes that the motion begins at the present expansion.
  void begin_at_zero() {
    for (std::size_t i = 0; i < series_.size(); ++i)
      if (series_[i].from_zero) known_[i].begins = std::exchange(known_[i].c[0], N(0));
  }
  // True if all coefficients are finite numbers.
  bool have_series() const;
  // The logarithm of the distance from the present expansion over which all series are known.
  double log_reach(double log_tolerance) const;
  // The series that is known over the shortest distance. REQUIRES: there is one.
  std::size_t least_known(double log_tolerance) const;

  // Returns the value of a quadrature on the state at a time from the start of the step; nullopt if it has none.
  using Values = std::function<std::optional<N>(std::size_t quadrature, const N& where)>;
  // True if the series of formulas of the state, if finite, have their values at a point on the way, up to the
  // tolerance and the round-off of the values; `value`: the value of a quadrature there.
  using ValueThere = std::function<std::optional<N>(std::size_t quadrature)>;
  // The magnitude of all that the value is made of.
  using MadeOf = std::function<N(std::size_t quadrature)>;
  bool as_foretold(const N& where, double log_tolerance, const ValueThere& value, const MadeOf& made_of) const;
  // True if a formula of the state has a value, but no series: the root of an argument that is zero.
  bool without_series() const;
  // True if a series may pass zero within this distance of a point on the way. `t`: the time of the expansion.
  bool may_pass_near(const N& t, const N& where, const N& within) const;
  // Returns the events in (0, h], up to and with the first moment that ends the step, and sets h to that moment. They
  // are in the order of time, those of one moment in the order of the series. The sides become those after the moment.
  // `t`: the time of the expansion. `kink`: the series hold up to there only, and the step ends shortly after.
  std::vector<Fired<N>> look(const N& t, N& h, const std::optional<N>& kink, const Values& values);
  // Restores the sides before look(), because the step is not made.
  void take_back() { sides_ = sides_before_, at_zero_ = at_zero_before_; }

 private:
  struct Crossing {
    N where{0};
    int towards = 0;
  };
  struct Known {
    std::vector<N> c;
    N terms{0};
    std::optional<N> begins;  // the value that is replaced by zero, in the first step of a series that begins there
  };
  static bool has_series(const Known& known);
  double log_reach(std::size_t i, double log_tolerance) const;
  // Values of a series below this magnitude are zero.
  N noise(std::size_t i, const N& t) const;
  static std::vector<Crossing> crossings_of_values(const WatchedSeries& s, int& side, const N& h, const Values& values);
  static std::vector<Crossing> crossings(const N* c, int degree, const N& h, const N& floor, const WatchedSeries& s,
                                         int side);

  std::vector<WatchedSeries> series_;
  std::vector<Known> known_;  // of each
  int degree_ = 0;
  std::vector<int> sides_, sides_before_;
  std::vector<bool> at_zero_, at_zero_before_;  // at zero at the end of the last step, without having fired there
};

extern template class EventWatch<double>;
extern template class EventWatch<long double>;
extern template class EventWatch<Quad>;
extern template class EventWatch<Multi>;

}  // namespace anholon
