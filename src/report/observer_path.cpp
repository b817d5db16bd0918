#include "report/observer_path.h"

#include <algorithm>
#include <cmath>

#include "tape/bind.h"

namespace anholon {

namespace {

constexpr double kAngle = 0.02;  // maximal angle of a step
constexpr int kStepsToTheStart = 1000, kStepsBetweenRows = 4;
constexpr double kShortest = 1e-5;     // fraction of the time between rows: an unbounded spin must not take forever
using State = std::array<double, 10>;  // quaternion, origin, its velocity

class Path {
 public:
  Path(const Model& model, const std::vector<double>& parameters)
      : by_velocity_(model.observer.origin_velocity.has_value()), graph_(*model.graph),
        tape_(compile(expressions(model))), machine_(tape_, 0, parameters) {}

  State rate(double t, const State& x) {
    bind(machine_, graph_, [t](const Node&, NodeId) { return t; });
    machine_.evaluate();
    const auto given = [&](std::size_t k) { return machine_.value(k); };
    const double w = x[0], a = x[1], b = x[2], c = x[3], p = given(0), q = given(1), r = given(2);
    State out{};
    out[0] = (-a * p - b * q - c * r) / 2;
    out[1] = (w * p + b * r - c * q) / 2;
    out[2] = (w * q + c * p - a * r) / 2;
    out[3] = (w * r + a * q - b * p) / 2;
    const std::array<double, 3> turned = turn(x, {given(3), given(4), given(5)});
    for (std::size_t k = 0; k < 3; ++k)
      out[4 + k] = by_velocity_ ? turned[k] : x[7 + k], out[7 + k] = by_velocity_ ? 0 : turned[k];
    return out;
  }

  // Takes at least `steps` steps: an observer that turns later may be at rest now.
  void go(double& t, State& x, double end, int steps, double shortest) {
    const double longest = std::abs(end - t) / steps;
    while (t != end) {
      const State k1 = rate(t, x);
      const double spin = 2 * std::hypot(k1[0], k1[1], std::hypot(k1[2], k1[3]));
      double h = std::max(spin > 0 ? std::min(kAngle / spin, longest) : longest, shortest);
      h = h >= std::abs(end - t) ? end - t : std::copysign(h, end - t);
      const auto moved = [&](const State& k, double by) {
        State y = x;
        for (std::size_t i = 0; i < y.size(); ++i) y[i] += by * k[i];
        return y;
      };
      const State k2 = rate(t + h / 2, moved(k1, h / 2)), k3 = rate(t + h / 2, moved(k2, h / 2)),
                  k4 = rate(t + h, moved(k3, h));
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
      const double norm = std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2] + x[3] * x[3]);
      for (std::size_t i = 0; i < 4; ++i) x[i] /= norm;
      t = h == end - t ? end : t + h;
    }
  }

 private:
  static Column expressions(const Model& model) {
    const Observer& o = model.observer;
    const Vector& origin = o.origin_velocity ? *o.origin_velocity : o.origin_acceleration;
    return {o.spin.x, o.spin.y, o.spin.z, origin.x, origin.y, origin.z};
  }

  static std::array<double, 3> turn(const State& q, const std::array<double, 3>& v) {
    const double w = q[0], a = q[1], b = q[2], c = q[3];
    const double x = 2 * (b * v[2] - c * v[1]), y = 2 * (c * v[0] - a * v[2]), z = 2 * (a * v[1] - b * v[0]);
    return {v[0] + w * x + b * z - c * y, v[1] + w * y + c * x - a * z, v[2] + w * z + a * y - b * x};
  }

  bool by_velocity_;
  const Graph& graph_;
  Tape tape_;
  Machine<double> machine_;
};

}  // namespace

std::vector<ObserverPose> observer_path(const Model& model, const std::vector<double>& parameters,
                                        const std::vector<double>& times) {
  Path path(model, parameters);
  std::vector<ObserverPose> poses;
  State x{1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  double t = 0;
  const double interval =
      times.size() > 1 ? std::abs(times.back() - times.front()) / static_cast<double>(times.size() - 1) : 1;
  for (double end : times) {
    path.go(t, x, end, poses.empty() ? kStepsToTheStart : kStepsBetweenRows, interval * kShortest);
    poses.push_back({{x[0], x[1], x[2], x[3]}, {x[4], x[5], x[6]}});
  }
  return poses;
}

}  // namespace anholon
