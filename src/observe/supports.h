// Supports that look like floors: which constraints hold the whole system up against gravity, and when one of them
// begins to pull.
//
// A constraint is called a support where it is geometric, of a single equation, and speaks of a height alone: a
// coordinate moves all bodies upwards as one, another (or two) sideways, and the residual of the constraint changes
// with the first at a constant rate and with the others not at all, here and at other places. What is held sideways as
// well is a hinge, which may pull. This is about notes, so what is in doubt is no support.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "setup/scenario.h"

namespace anholon {

struct Support {
  std::size_t constraint = 0;
  double upwards = 0;  // the force on the system against gravity is this times its multiplier
};
std::vector<Support> supports(const Scenario& s);

// Whether a note tells that a support pulls; and the note without the size of the pull, which is that of one part of a motion.
bool is_of_support(const std::string& note);
std::string without_size_of_pull(std::string note);

// What the supports bear along a run, at its rows.
class SupportWatch {
 public:
  explicit SupportWatch(const Scenario& s) : s_(s) {
    for (const Support& support : supports(s)) loads_.emplace_back(support);
  }
  bool any() const { return !loads_.empty(); }
  // multiplier(r): of constraint r.
  template <class F>
  void see(double t, F multiplier) {
    for (Load& l : loads_) l.see(t, l.support.upwards * multiplier(l.support.constraint));
  }
  // Locates the first pull of each support between two rows. first(support, t): its time, if it is found, before the row
  // at t.
  template <class F>
  void locate(F first) {
    for (Load& l : loads_)
      if (l.pulls && *l.pulls != l.begin)
        if (const std::optional<double> t = first(l.support, *l.pulls)) l.pulls = t;
  }
  // A sentence for each support that pulls.
  std::vector<std::string> notes() const;

 private:
  struct Load {
    explicit Load(const Support& s) : support(s) {}
    void see(double t, double force);
    Support support;
    bool any = false;
    double begin = 0, largest = 0, least = 0,
           least_t = 0;           // the time of the first row; what it bears at most; the strongest pull
    std::optional<double> pulls;  // since when
  };
  const Scenario& s_;
  std::vector<Load> loads_;
};

}  // namespace anholon
