// Finds supports: constraints that hold a body up against its weight as a floor or a surface does; and tells when one
// of them begins to pull.
//
// A geometric constraint of a single equation is a support in one of these cases:
// - floor: coordinates move all bodies as one, and the residual changes with them at constant rates: a plane.
// - ground: the same, but the rate is constant with one of these coordinates alone: a height above a street or a bowl.
// - carrier: the residual depends on the place of one body alone, whose coordinates move no other body, and which no
//   other geometric constraint holds in the plane of the normal and the weight; the normal force carries the weight at
//   the start: a sphere, a hoop, but also a rod.
// A support that also holds sideways is a hinge, which may pull. The results are used for notes only, so a doubtful
// case is no support.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "numeric/number.h"
#include "observe/floors/translations.h"

namespace anholon {

struct Support {
  enum class Kind : std::uint8_t { floor, ground, carrier };
  std::size_t constraint = 0;
  // The force along the normal, against the weight, is `upwards` times the multiplier; for grounds and carriers also
  // times the length of the gradient, which varies.
  double upwards = 0;
  Kind kind = Kind::floor;
  bool level = true;                 // the normal is vertical everywhere
  std::size_t body = 0;              // the body that is carried
  std::vector<std::string> rolls{};  // constraints of velocities that hold this body, too
};
// Returns floors and grounds. `found`: translations(s).
std::vector<Support> floors(const Scenario& s, const std::optional<Translations>& found);
// Returns the carriers among the constraints that are not `known`.
std::vector<Support> carriers(const Scenario& s, const std::vector<Support>& known);

// is_of_support(): true if a note tells that a support pulls. without_size_of_pull(): the note without the size of the
// pull, which belongs to one part of a motion.
bool is_of_support(const std::string& note);
std::string without_size_of_pull(std::string note);

// Watches the loads of the supports along a run, at its rows.
class SupportWatch {
 public:
  SupportWatch(const Scenario& s, std::vector<Support> supports);
  bool any() const { return !loads_.empty(); }
  // multiplier(r): the multiplier of constraint r, the least one with the same forces if constraints depend on one
  // another; `numbers`: the columns of a row after t, which begin with the coordinates.
  template <class F, class N>
  void see(double t, F multiplier, const std::vector<N>& numbers) {
    for (Load& l : loads_) {
      const double force = l.support.upwards * l.whole(multiplier);
      if (!l.see(t, force)) continue;
      if (l.support.kind == Support::Kind::floor) {
        l.pull(t, force);
        continue;
      }
      if (++pulling_ > kAllRows && pulling_ % kOneOf != 0) continue;
      q_.resize(s_.model->coordinates.size());
      for (std::size_t a = 0; a < q_.size(); ++a) q_[a] = to_double(numbers[a]);
      l.pull(t, force * length_of_gradient(l.support, t));
    }
  }
  // The start of the first pull: its time, if it is known, and whether the support carries weight at the start of the
  // motion.
  struct Begin {
    std::optional<double> t;
    bool carries = false;
  };
  // Locates the first pull of each support between two rows. first(support, t) returns its begin before the row at t,
  // or nullopt.
  template <class F>
  void locate(F first) {
    for (Load& l : loads_)
      if (l.pulls && *l.pulls != start_) {
        const std::optional<Begin> found = first(l.support, *l.pulls);
        if (!found) continue;
        l.carries = found->carries;
        if (found->t) l.pulls = found->t;
      }
  }
  // A sentence for each support that pulls.
  std::vector<std::string> notes() const;

 private:
  static constexpr std::size_t kAllRows = 1024, kOneOf = 16;  // of the rows at which a support pulls
  struct Load {
    explicit Load(const Support& s) : support(s) {}
    // Returns the multiplier that the support would have if it alone held its direction. Constraints with parallel rows,
    // Phi_k = c_k Phi_r, share its force: sum c_k lambda_k, and the least multipliers have c_k = lambda_k / lambda_r.
    template <class F>
    double whole(F multiplier) const {
      const double own = multiplier(support.constraint);
      double sum = own;
      for (const std::size_t k : parallel)
        if (const double other = multiplier(k); own != 0) sum += other / own * other;
      return sum;
    }
    // Returns true if the support pulls.
    bool see(double t, double force);
    void pull(double t, double force);
    Support support;
    std::vector<std::size_t>
        parallel;  // the other constraints that hold its direction, if their rows are parallel to its own
    bool any = false, carries = false;  // a row has been seen; the support carries weight at the start
    double largest = 0;                 // the largest force
    double least = 0, least_t = 0;      // the strongest pull
    std::optional<double> pulls;        // the time of the first pull
  };
  double length_of_gradient(const Support& support, double t);
  std::string note(const Load& l) const;
  std::string others_that_hold(std::size_t constraint) const;

  const Scenario& s_;
  double start_;
  std::vector<Load> loads_;
  std::unique_ptr<PlaceRates> rates_;  // of the constraints in `varying_`
  std::vector<std::size_t> varying_;
  std::vector<double> q_;
  std::size_t pulling_ = 0;
};

}  // namespace anholon
