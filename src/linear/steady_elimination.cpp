#include "linear/steady_elimination.h"

#include "linear/steadiness.h"

namespace anholon {

namespace {

using Coordinates = std::vector<std::size_t>;

constexpr std::size_t kMostTries = 60;  // all pairs of ten coordinates, and each of them

// Returns the coordinates that occur in no equation; only their velocities do.
Coordinates absent(const VariedEquations& l) {
  std::vector<bool> occurs(l.scenario.system.coordinates, false);
  for (const auto& [row, column] : l.partials)
    if (row < l.rows.size() && column < l.entries.size())
      if (const auto& [variable, order] = l.entries[column]; variable < occurs.size() && order == 0)
        occurs[variable] = true;
  Coordinates list;
  for (std::size_t a = 0; a < occurs.size(); ++a)
    if (!occurs[a] && l.scenario.structure.d[a] >= 2) list.push_back(a);
  return list;
}

class Trials {
 public:
  Trials(const VariedEquations& equations, const std::vector<Multi>& parameters, const LinearPoint& chosen)
      : equations_(equations), parameters_(parameters), chosen_(chosen), absent_(absent(equations)) {}

  Coordinates search() const {
    if (dependent(chosen_).empty()) return {};
    for (const Coordinates& wished : choices())
      if (Coordinates found = tried(wished); !found.empty()) return found;
    return {};
  }

 private:
  // Returns the choices: the coordinates that accelerate here, each coordinate, each pair.
  std::vector<Coordinates> choices() const {
    std::vector<Coordinates> list(1);
    const Multi still = round_off(kZeroPart) * (Multi(1) + largest(chosen_.x));
    for (const std::size_t a : absent_)
      if (abs(chosen_.x[equations_.entry(a, 2)]) > still) list[0].push_back(a);
    for (const std::size_t a : absent_) list.push_back({a});
    for (std::size_t i = 0; i < absent_.size(); ++i)
      for (std::size_t k = i + 1; k < absent_.size(); ++k) list.push_back({absent_[i], absent_[k]});
    if (list.size() > kMostTries) list.resize(kMostTries);
    return list;
  }

  // Returns the coordinates to name: those whose velocities vary if they suffice, else the wished ones.
  Coordinates tried(const Coordinates& wished) const {
    LinearPoint point(equations_, wished, parameters_);
    LinearModel model;
    if (wished.empty() || !follow(point, wished) || !steady(point, model)) return {};
    // Forms that eliminate need as many coordinates as there are constraints.
    if (equations_.scenario.system.form->eliminates()) return dependent(point);
    const Coordinates vary = varying(point, model);
    LinearPoint again(equations_, vary, parameters_);
    return !vary.empty() && follow(again, vary) && steady(again, model) ? vary : wished;
  }

  // Sets the point to the known state; returns false if one of the velocities remains independent.
  bool follow(LinearPoint& point, const Coordinates& wished) const {
    point.t = chosen_.t, point.x = chosen_.x;
    if (!point.evaluate() || !point.choose() || !point.settle()) return false;
    return std::all_of(wished.begin(), wished.end(),
                       [&](std::size_t a) { return point.follows[equations_.entry(a, 1)]; });
  }

  static bool steady(const LinearPoint& point, LinearModel& model) {
    model = {};
    point.linear(model);
    look_for_steadiness(point, true, model);
    return model.motion == LinearModel::Motion::steady || model.motion == LinearModel::Motion::equilibrium;
  }

  Coordinates dependent(const LinearPoint& point) const {
    Coordinates list;
    for (std::size_t a = 0; a < equations_.scenario.system.coordinates; ++a)
      if (equations_.scenario.structure.d[a] >= 1 && point.follows[equations_.entry(a, 1)]) list.push_back(a);
    return list;
  }

  // Returns the coordinates of the dependent velocities that have other values later in the steady motion.
  Coordinates varying(const LinearPoint& point, const LinearModel& model) const {
    LinearPoint there = point;
    const Multi later = sqrt(Multi(2)) / Multi(4);  // irrational, so that no turn ends there
    there.t += later;
    for (const std::size_t i : model.cyclic) there.x[point.independent(i)] += later * model.rates[i];
    if (!there.evaluate() || !there.settle()) return {};
    const Multi still = round_off(kZeroPart) * (Multi(1) + largest(point.x));
    Coordinates list;
    for (const std::size_t a : absent_) {
      const std::size_t velocity = equations_.entry(a, 1);
      if (point.follows[velocity] && abs(Multi(there.x[velocity] - point.x[velocity])) > still) list.push_back(a);
    }
    return list;
  }

  const VariedEquations& equations_;
  const std::vector<Multi>& parameters_;
  const LinearPoint& chosen_;
  const Coordinates absent_;
};

}  // namespace

std::vector<std::size_t> steady_elimination(const VariedEquations& equations, const std::vector<Multi>& parameters,
                                            const LinearPoint& point) {
  return Trials(equations, parameters, point).search();
}

}  // namespace anholon
