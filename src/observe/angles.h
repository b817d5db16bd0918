// Watches angles near their singularity: a body whose orientation is made of three angles has an angular velocity
//   omega = sum_a omega_a q_a',  a = 1, 2, 3,
// and the three vectors omega_a fall into a plane at the singularity of the angles (theta = 0 of Euler's). The measure
// is
//   |omega_1 . (omega_2 x omega_3)| / (|omega_1| |omega_2| |omega_3|).  (theory: integrals)
// Angles of joints are left out: those that always lie in a plane, and those of which one or two turn another body with
// inertia.
#pragma once
#include "integrate/stretch.h"
#include "setup/outputs/output_tape.h"

namespace anholon {

struct AngleTriple {
  std::string body, angles;  // "disc", "psi, theta, phi"
  Vector rates[3];           // omega_a, components along the body's own axes
};
// The triples of all bodies with three angles, each set of angles once.
std::vector<AngleTriple> angle_triples(const Model& model);

// The measures are computed in doubles, whatever the numbers of the motion are, because they need no more. They are
// evaluated again when a coordinate has changed by an eighth of the smallest measure: a change of angles changes a
// measure by no more than that.
class AngleWatch {
 public:
  AngleWatch(Workspace& scenario, const std::vector<double>& parameters);
  // Looks at a time of the motion; coordinate(a) is the value of coordinate a there.
  template <class F>
  void see(double t, F coordinate) {
    if (!outputs_) return;
    bool near = !looked_.empty();
    for (std::size_t i = 0; near && i < coordinates_.size(); ++i)
      near = std::abs(coordinate(coordinates_[i]) - looked_[i]) < margin_;
    if (near) return;
    looked_.clear();
    for (const std::size_t a : coordinates_) looked_.push_back(coordinate(a));
    outputs_->evaluate_at([&](const Node& n, NodeId) { return n.kind == Kind::time ? t : coordinate(n.index); });
    note(t);
  }
  // Lets a stretch go on as long as no coordinate leaves the range in which no look is needed; without such a range, by
  // single steps.
  template <class W>
  void keep_in(Stretch<W>& stretch) {
    if (!outputs_) return;
    if (looked_.empty() || !(margin_ > 0)) return stretch.limit(1);
    kept_.clear();
    for (std::size_t i = 0; i < coordinates_.size(); ++i) kept_.push_back({coordinates_[i], looked_[i]});
    stretch.kept = kept_;
    stretch.margin = margin_;
  }
  void set_parameters(const std::vector<double>& parameters) {
    if (outputs_) outputs_->set_parameters(parameters);
    margin_ = 0;
  }
  // saved(): the count of numbers by which save() and resume() transfer what was seen.
  std::size_t saved() const { return 2 * least.size() + coordinates_.size() + 1; }
  void save(std::vector<double>& to) const;
  void resume(const std::vector<double>& from);
  // The smallest value so far and its time, for every triple.
  struct Least {
    double value = 1, t = 0;
  };
  std::vector<AngleTriple> triples;
  std::vector<Least> least;

 private:
  static Column expressions(const Model& model, const std::vector<AngleTriple>& triples);
  void note(double t);
  std::optional<OutputTape<double>> outputs_;  // nullopt without triples
  std::vector<std::size_t> coordinates_;       // the coordinates on which the measures depend
  bool by_coordinates_ = true;                 // the measures depend on nothing else
  std::vector<double> looked_;                 // the values of the coordinates at the last evaluation
  double margin_ = 0;
  std::vector<Kept> kept_;  // the same values for a stretch of steps
};

}  // namespace anholon
