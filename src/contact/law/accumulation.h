// Finds the limit of impacts of a contact whose intervals shrink by one ratio r: after an interval d it is d r/(1 - r)
// away (theory: contact).
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

namespace anholon {

class Accumulation {
 public:
  explicit Accumulation(std::size_t contacts) : impacts_(contacts) {}

  // Notes an impact of this contact at the time t.
  void impact(std::size_t contact, double t);
  // The limit of the times of the impacts; nullopt if their intervals do not shrink by one ratio.
  std::optional<double> limit(std::size_t contact) const;
  // True if there is such a limit, and the time t is so near to it that the remaining impacts are negligible.
  bool near_limit(std::size_t contact, double t) const;
  // Forgets the impacts of a contact that has come to rest.
  void forget(std::size_t contact) { impacts_[contact] = {}; }

 private:
  static constexpr std::size_t kAlike = 4;
  struct Impacts {
    double first = 0, last = 0, interval = 0, ratio = 0;
    std::size_t alike = 0, count = 0;
  };
  std::vector<Impacts> impacts_;
};

}  // namespace anholon
