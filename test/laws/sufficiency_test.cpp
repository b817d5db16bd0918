// The sufficiency of Routh's equations, tested numerically [L 2.8-2.13] (theory: certificate). For a motion that
// satisfies [L 2.7], reactions of the holonomic and of the nonholonomic constraints are chosen as the paper allows: any
// ideal R^H, any R^N with the generalized reactions of [L 2.6]. The forces f_i that are then missing in Newton's law of
// each particle do no work in any virtual displacement, R^N - f is ideal again, and with it Newton's law holds for each
// particle.
//
// Reactions act on the particles of random systems, with g = 3N - n > 0 holonomic constraints in their coordinates or
// with g = 0.
#include <gtest/gtest.h>

#include "model/loads.h"
#include "setup/eliminate.h"
#include "support/least_norm.h"
#include "support/models.h"
#include "support/motion_point.h"
#include "support/particle_system.h"

namespace anholon::sufficiency_test {
namespace {

constexpr double kExact = 1e-26;   // 40 digits, less those that a few systems of equations in turn lose
constexpr double kRefuted = 1e-6;  // a mutant misses by much more

using Vectors = std::vector<Multi>;  // three components for each particle

struct Particles {
  std::shared_ptr<const Model> model;
  Mechanics m;
  Column places, law;  // law: the braces of [L 2.8] without reactions
  std::vector<std::size_t> dependent;

  explicit Particles(const std::string& text) : model(test::model_of(text)), m(mechanics(*model)) {
    const Vector &omega = model->observer.spin, &a0 = model->observer.origin_acceleration;
    const std::vector<Load> given = given_loads(*model);
    for (std::size_t i = 0; i < model->bodies.size(); ++i) {
      const Body& p = model->bodies[i];
      const Vector r = p.center, v = total_derivative(r), a = total_derivative(v), omega_rate = total_derivative(omega);
      const Vector twice = model->graph->number(2) * v;
      const Vector inertial = a + a0 + cross(omega_rate, r) + cross(omega, cross(omega, r)) + cross(omega, twice);
      for (int c = 0; c < 3; ++c) {
        places.push_back(r[c]);
        const Expr mass = put_masses(*model, p.mass);
        Expr miss = given[i].force[c] - mass * inertial[c];
        if (p.expelled_velocity) miss += total_derivative(mass) * (*p.expelled_velocity)[c];
        law.push_back(put_masses(*model, miss));
      }
    }
    dependent = elimination_for(m, Unknowns::coordinates, {}, {}, false).dependent;
  }
  std::size_t n() const { return m.q.size(); }
};

// The quantities of the theorem at one point.
struct State {
  const Particles& p;
  test::Point at;
  Matrix<Multi> by_q;  // dr/dq, transposed: n x 3N
  Matrix<Multi> phi;   // dphi/dq^(m)
  Vectors law, N;
  std::uint64_t draws;

  State(const Particles& particles, test::Point point, std::uint64_t seed)
      : p(particles), at(std::move(point)), draws(seed * 1000) {
    Rows rows, constraints;
    for (Expr x : p.places) rows.push_back(gradient(x, p.m.q));
    for (const Column& row : p.m.Phi) constraints.push_back(put_masses(*p.model, row));
    by_q = test::transposed(test::values_of(rows, at));
    phi = test::values_of(constraints, at);
    law = test::values(p.law, at);
    N = test::values(put_masses(*p.model, p.m.N), at);
  }
  // Random components.
  Vectors any(std::size_t size) {
    Vectors out;
    const test::Point random(++draws);
    for (std::size_t i = 0; i < size; ++i)
      out.push_back(random(*p.model->graph, p.model->graph->given(static_cast<std::uint32_t>(i), 0).id));
    return out;
  }
  // sum R . dr/dq = 0
  Vectors ideal_holonomic() { return test::in_kernel(by_q, any(p.places.size())); }
  // sum R . dr/dq = N  [L 2.6]
  Vectors with_generalized(const Vectors& of) {
    const Vectors holonomic = ideal_holonomic();
    return test::plus(test::least_norm(by_q, of), holonomic);
  }
  // A virtual displacement of the particles: dr/dq delta q, dphi/dq^(m) delta q = 0
  Vectors displacement() {
    const Vectors delta = test::in_kernel(phi, any(p.n()));
    return test::times(test::transposed(by_q), delta);
  }
  // |forces . displacement| in units of both.
  double work(const Vectors& forces, const Vectors& displacement) const {
    return std::abs(to_double(test::product(forces, displacement))) / (1 + test::largest(forces)) /
           (1e-3 + test::largest(displacement));
  }
  double generalized(const Vectors& forces) const {
    return test::largest(test::times(by_q, forces)) / (1 + test::largest(forces));
  }
};

struct Choice {
  std::size_t coordinates, particles;
  unsigned order;
};
void PrintTo(const Choice& c, std::ostream* out) {
  *out << c.coordinates << " coordinates, " << c.particles << " particles, order " << c.order;
}

class Sufficiency : public testing::TestWithParam<Choice> {
 protected:
  PrecisionScope precision{40};
  std::unique_ptr<Particles> particles;
  std::vector<State> states;
  bool holonomic() const { return GetParam().coordinates < 3 * GetParam().particles; }  // g > 0

  void SetUp() override {
    const auto& [n, count, order] = GetParam();
    const test::ParticleSystem system({n, count, order, n > 3 ? 2U : 1U, order % 2 == 0}, 7 * n + 31 * count + order);
    SCOPED_TRACE(system.text());
    particles = std::make_unique<Particles>(system.text());
    for (std::uint64_t seed = 1; seed <= 3; ++seed)
      if (const auto at = test::motion_point(particles->m, particles->dependent, order, seed))
        states.emplace_back(*particles, *at, seed);
    ASSERT_GE(states.size(), 2U) << system.text();
  }
};

// [L 2.9] and what follows from [L 2.8]; [L 2.10]
TEST_P(Sufficiency, WhatNewtonsLawMissesDoesNoWork) {
  for (State& s : states) {
    const Vectors f = test::plus(test::plus(s.law, s.ideal_holonomic()), s.with_generalized(s.N));
    EXPECT_LE(s.generalized(f), kExact);
    EXPECT_LE(s.work(f, s.displacement()), kExact);
    if (!holonomic()) {
      EXPECT_LE(test::largest(f), kExact * test::largest(s.law));  // g = 0: nothing is missing
    } else {
      EXPECT_GT(test::largest(f), kRefuted);
    }
    // Mutants: another reaction than that of Routh's equations, and a motion that does not satisfy them.
    Vectors other = s.N;
    for (Multi& x : other) x *= Multi(2);
    EXPECT_GT(s.generalized(test::plus(test::plus(s.law, s.ideal_holonomic()), s.with_generalized(other))), kRefuted);
    test::Point moved = s.at;
    const Expr acceleration = s.p.m.qdd[0];
    moved.set(acceleration, test::value(acceleration, s.at) + Multi(1));
    const State wrong(s.p, moved, 1);
    EXPECT_GT(s.generalized(test::plus(test::plus(wrong.law, s.ideal_holonomic()), s.with_generalized(wrong.N))),
              kRefuted);
  }
}

// [L 2.11, 2.12]
TEST_P(Sufficiency, TheReactionsLessThatAreIdealAgain) {
  for (State& s : states) {
    const Vectors R_N = s.with_generalized(s.N), f = test::plus(test::plus(s.law, s.ideal_holonomic()), R_N),
                  R = test::plus(R_N, f, -1);
    for (int k = 0; k < 3; ++k) {
      const Vectors delta = s.displacement();
      EXPECT_LE(s.work(R_N, delta), kExact);
      EXPECT_LE(s.work(R, delta), kExact);
    }
    // Mutants: missing forces that are not ideal, and a displacement that the constraints do not allow.
    const Vectors not_ideal = test::plus(f, s.any(f.size())),
                  free = test::times(test::transposed(s.by_q), s.any(s.p.n()));
    EXPECT_GT(s.work(test::plus(R_N, not_ideal, -1), s.displacement()), kRefuted);
    EXPECT_GT(s.work(R, free), kRefuted);
  }
}

// [L 2.13], and the reactions that the program reports.
TEST_P(Sufficiency, NewtonsLawHoldsForEachParticle) {
  Column reported;
  for (const Load& load : reactions(*particles->model))
    for (int c = 0; c < 3; ++c) reported.push_back(load.force[c]);
  for (State& s : states) {
    const Vectors R_H = s.ideal_holonomic(), R_N = s.with_generalized(s.N), f = test::plus(test::plus(s.law, R_H), R_N);
    const Vectors total = test::plus(R_H, test::plus(R_N, f, -1)), have = test::values(reported, s.at);
    const double size = 1 + test::largest(total);
    EXPECT_LE(test::largest(test::plus(s.law, total)) / size, kExact);
    EXPECT_LE(test::largest(test::plus(total, have, -1)) / size, kExact);
    // A mutant: the sign of f. For g = 0, where f vanishes, it is the reactions of twice the law.
    const Vectors wrong = holonomic() ? test::plus(R_H, test::plus(R_N, f)) : test::plus(total, s.law);
    EXPECT_GT(test::largest(test::plus(wrong, have, -1)) / size, kRefuted);
  }
}

// For g > 0 only the sum of the reactions is unique; for g = 0 the reactions of the nonholonomic constraints are
// unique, too.
TEST_P(Sufficiency, OnlyTheTotalReactionIsUnique) {
  for (State& s : states) {
    Vectors R_N[2], total[2];
    for (int k = 0; k < 2; ++k) {
      const Vectors R_H = s.ideal_holonomic(), first = s.with_generalized(s.N),
                    f = test::plus(test::plus(s.law, R_H), first);
      R_N[k] = test::plus(first, f, -1);
      total[k] = test::plus(R_H, R_N[k]);
    }
    const double size = 1 + test::largest(total[0]);
    EXPECT_LE(test::largest(test::plus(total[0], total[1], -1)) / size, kExact);
    const double apart = test::largest(test::plus(R_N[0], R_N[1], -1)) / size;
    if (holonomic()) {
      EXPECT_GT(apart, kRefuted);
    } else {
      EXPECT_LE(apart, kExact);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(System, Sufficiency,
                         testing::Values(Choice{4, 2, 1}, Choice{3, 2, 1}, Choice{5, 3, 2}, Choice{2, 1, 2},
                                         Choice{4, 2, 3}, Choice{4, 2, 0}, Choice{3, 1, 1}, Choice{3, 1, 2},
                                         Choice{6, 2, 1}, Choice{3, 1, 3}),
                         [](const auto& p) {
                           return "n" + std::to_string(p.param.coordinates) + "N" + std::to_string(p.param.particles) +
                                  "m" + std::to_string(p.param.order);
                         });

}  // namespace
}  // namespace anholon::sufficiency_test
