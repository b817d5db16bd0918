// Watches the floors along a run: constraints that begin to pull, and rolling that needs much friction.
#pragma once
#include <algorithm>

#include "observe/floors/supports.h"
#include "observe/floors/traction.h"

namespace anholon {

struct FloorWatch {
  // `carriers`: supports of one body alone are watched, too (supports.h).
  FloorWatch(const Scenario& s, bool carriers)
      : FloorWatch(s, is_held(*s.model) ? translations(s) : std::nullopt, carriers) {}

  // Looks at a row. multiplier(r): the multiplier of constraint r; `numbers`: the columns of the row after t.
  template <class N, class Multiplier>
  void see(double t, const Multiplier& multiplier, const std::vector<N>& numbers) {
    supports.see(t, multiplier, numbers);
    traction.see(t, numbers);
  }
  std::vector<std::string> notes() const {
    std::vector<std::string> list = supports.notes();
    for (std::string& text : traction.notes()) list.push_back(std::move(text));
    return list;
  }

  SupportWatch supports;
  TractionWatch traction;

 private:
  static bool is_held(const Model& m) {
    return std::any_of(m.constraints.begin(), m.constraints.end(), [](const Constraint& c) { return c.order <= 1; });
  }
  FloorWatch(const Scenario& s, const std::optional<Translations>& found, bool carriers)
      : FloorWatch(s, found, floors(s, found), carriers) {}
  FloorWatch(const Scenario& s, const std::optional<Translations>& found, std::vector<Support> known, bool more)
      : supports(s, more ? with_carriers(s, known) : known), traction(s, found, !known.empty()) {}
  static std::vector<Support> with_carriers(const Scenario& s, std::vector<Support> known) {
    const std::vector<Support> more = carriers(s, known);
    known.insert(known.end(), more.begin(), more.end());
    return known;
  }
};

}  // namespace anholon
