// Supports: which constraints hold a body up against its weight as a floor or a surface does, and when one of them begins to
// pull.
//
// A geometric constraint of a single equation is a support in one of these cases.
// - floor: coordinates move all bodies as one, and the residual changes with them at constant rates: a plane.
// - ground: the same, but the rate is constant with one of these coordinates alone: a height above a street or a bowl.
// - carrier: the residual depends on the place of one body alone, whose coordinates move no other body, and which no other geometric
//   constraint holds in the plane of the normal and the weight; the normal force carries the weight at the start: a sphere, a
//   hoop, but also a rod.
// What is held sideways as well is a hinge, which may pull. This is about notes, so what is in doubt is no support.
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
  // The force along the normal, against the weight, is this times the multiplier; times the length of the gradient where
  // that varies, which it does but for floors.
  double upwards = 0;
  Kind kind = Kind::floor;
  bool level = true;                 // the normal is vertical everywhere
  std::size_t body = 0;              // that is carried
  std::vector<std::string> rolls{};  // constraints of velocities that hold this body, too
};
// Floors and grounds. `found`: translations(s).
std::vector<Support> floors(const Scenario& s, const std::optional<Translations>& found);
// Carriers among the constraints that are not `known`.
std::vector<Support> carriers(const Scenario& s, const std::vector<Support>& known);

// Whether a note tells that a support pulls; and the note without the size of the pull, which is that of one part of a motion.
bool is_of_support(const std::string& note);
std::string without_size_of_pull(std::string note);

// What the supports bear along a run, at its rows.
class SupportWatch {
 public:
  SupportWatch(const Scenario& s, std::vector<Support> supports);
  bool any() const { return !loads_.empty(); }
  // multiplier(r): of constraint r; numbers: of a row after t, which begin with the coordinates.
  template <class F, class N>
  void see(double t, F multiplier, const std::vector<N>& numbers) {
    for (Load& l : loads_) {
      const double force = l.support.upwards * multiplier(l.support.constraint);
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
  // What is known of the start of the first pull: its time, and whether the support carries the weight at the start of the motion.
  struct Begin {
    std::optional<double> t;
    bool carries = false;
  };
  // Locates the first pull of each support between two rows. first(support, t): its begin, if it is found, before the row
  // at t.
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
  static constexpr std::size_t kAllRows = 1024, kOneOf = 16;  // of the rows at which something pulls
  struct Load {
    explicit Load(const Support& s) : support(s) {}
    // Returns whether it pulls.
    bool see(double t, double force);
    void pull(double t, double force);
    Support support;
    bool any = false, carries = false;  // a row has been seen; it carries weight at the start
    double largest = 0;                 // force
    double least = 0, least_t = 0;      // the strongest pull
    std::optional<double> pulls;        // since when
  };
  double length_of_gradient(const Support& support, double t);
  std::string note(const Load& l) const;

  const Scenario& s_;
  double start_;
  std::vector<Load> loads_;
  std::unique_ptr<PlaceRates> rates_;  // of the constraints of `varying_`
  std::vector<std::size_t> varying_;
  std::vector<double> q_;
  std::size_t pulling_ = 0;
};

}  // namespace anholon
