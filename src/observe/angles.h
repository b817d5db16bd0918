// Angles that are about to fail: a body whose orientation is made of three angles has an angular velocity
//   omega = sum_a omega_a q_a',  a = 1, 2, 3,
// and the three vectors omega_a fall into a plane at the singularity of the angles (theta = 0 of Euler's). Watched is
//   |omega_1 . (omega_2 x omega_3)| / (|omega_1| |omega_2| |omega_3|).  (theory: integrals)
// Angles of joints are none of these: neither those that lie in a plane always, nor those of which some turn another
// body with inertia.
#pragma once
#include "integrate/stretch.h"
#include "setup/output_tape.h"

namespace anholon {

struct AngleTriple {
  std::string body, angles;  // "disc", "psi, theta, phi"
  Vector rates[3];           // omega_a, components along the body's own axes
};
// Of the bodies with three angles, each set of angles once.
std::vector<AngleTriple> angle_triples(const Model& model);

// In doubles, whatever the numbers of the motion are: a measure of nearness needs no more. It is evaluated again when a
// coordinate has changed by an eighth of the smallest measure: for angles, that changes by no more than they do.
class AngleWatch {
 public:
  AngleWatch(Workspace& scenario, const std::vector<double>& parameters);
  // At a time of the motion; coordinate(a) is the value of coordinate a there.
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
  // What it looks at next is far: as long as no coordinate of `stretch` leaves its value. Else after each step.
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
  // All that has been seen, as `saved` numbers, from which it goes on.
  std::size_t saved() const { return 2 * least.size() + coordinates_.size() + 1; }
  void save(std::vector<double>& to) const;
  void resume(const std::vector<double>& from);
  // The smallest value so far and when, for every triple.
  struct Least {
    double value = 1, t = 0;
  };
  std::vector<AngleTriple> triples;
  std::vector<Least> least;

 private:
  static Column expressions(const Model& model, const std::vector<AngleTriple>& triples);
  void note(double t);
  std::optional<OutputTape<double>> outputs_;  // if there are any
  std::vector<std::size_t> coordinates_;       // on which the measures depend
  bool by_coordinates_ = true;                 // on nothing else
  std::vector<double> looked_;                 // their values when the measures were evaluated last
  double margin_ = 0;
  std::vector<Kept> kept_;  // the same for a stretch of steps
};

}  // namespace anholon
