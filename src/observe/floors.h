// What is watched of the floors along a run: constraints that begin to pull, and rolling that needs much friction.
#pragma once
#include "observe/supports.h"
#include "observe/traction.h"

namespace anholon {

struct FloorWatch {
  explicit FloorWatch(const Scenario& s) : supports(s), traction(s) {}

  // At a row. multiplier(r): of constraint r; numbers: of the row after t.
  template <class N, class Multiplier>
  void see(double t, const Multiplier& multiplier, const std::vector<N>& numbers) {
    supports.see(t, multiplier);
    traction.see(t, numbers);
  }
  std::vector<std::string> notes() const {
    std::vector<std::string> list = supports.notes();
    for (std::string& text : traction.notes()) list.push_back(std::move(text));
    return list;
  }

  SupportWatch supports;
  TractionWatch traction;
};

}  // namespace anholon
