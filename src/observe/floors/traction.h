// The friction, relative to the load, that wheels without slip need. Rolling constraints assume that it is there.
//
//   F = sum m (a - g) - F_ext,   mu >= |F sideways| / F upwards
//
// F is the whole force of the floor by Newton's law, and upwards means along the normal of the floor, a plane. Contacts
// with the friction mu transmit at most mu times the sum of their loads, so the quotient is a lower bound of the
// friction that the contact with the greatest need needs.
//
// Hypotheses, without which nothing is watched: a weight, coordinates that move all bodies as one sideways, no
// geometric constraint that holds the system sideways, constraints of velocities that do, forces that are torques, act
// between bodies or have a vector, an inertial observer, masses that do not vary.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "numeric/number.h"
#include "observe/floors/translations.h"
#include "tape/tape.h"

namespace anholon {

// Formulas of a model that is watched: the load of the floor with this normal, and |F sideways|^2 - load^2.
Expr load_of_floor(const Model& model, const Triple& normal);
Expr friction_above_load(const Model& model, const Triple& normal);

class TractionWatch {
 public:
  // `found`: translations(s). `has_floor`: a geometric constraint is a support, and SupportWatch reports its pull.
  TractionWatch(const Scenario& s, const std::optional<Translations>& found, bool has_floor);
  bool any() const { return machine_.has_value(); }
  // `numbers`: the columns of a row after t, which begin with the derivatives of the coordinates of order 0, 1 and 2.
  // After the first kAllRows rows of a long run, one of kOneOf rows is used.
  template <class N>
  void see(double t, const std::vector<N>& numbers) {
    if (!any() || (++rows_ > kAllRows && rows_ % kOneOf != 0)) return;
    for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i] = to_double(numbers[i]);
    look(t);
  }
  // Locates between two rows when the floor first pulls, and when the friction needed first passes 1. first(formula,
  // direction, t) returns when the formula of a model first passes zero in this direction, before the row at t; the
  // start if it has passed zero there.
  template <class F>
  void locate(F first) {
    if (pulls_ && *pulls_ != start_)
      if (const std::optional<double> t = first([&](const Model& m) { return load_of_floor(m, normal_); }, -1, *pulls_))
        pulls_ = t;
    if (above_ && *above_ != start_)
      if (const std::optional<double> t =
              first([&](const Model& m) { return friction_above_load(m, normal_); }, 1, *above_))
        above_ = t;
  }
  // Returns a sentence if the friction needed passes 1, and one if the floor would have to pull.
  std::vector<std::string> notes() const;

 private:
  static constexpr std::size_t kAllRows = 4096, kOneOf = 8;
  void look(double t);
  std::string rolling() const;  // the names of the constraints
  std::string how_to_lift() const;
  void find_what_holds_the_normal(const Workspace& s, const Translations& found);

  const Scenario& s_;
  std::vector<std::string> names_;
  std::vector<std::size_t> hold_normal_;  // those of them that hold the normal direction, too
  bool has_floor_, level_ = true;
  Triple normal_;
  std::optional<Tape> tape_;
  std::optional<Machine<double>> machine_;
  std::vector<double> numbers_;
  double start_;
  std::size_t rows_ = 0;
  double largest_ = 0;  // the largest load
  double need_ = 0, need_t_ = 0, least_ = 0, least_t_ = 0;
  std::optional<double> above_, pulls_;  // the times of the first rows beyond
};

}  // namespace anholon
