// The velocities that constraints admit: the constraints, linear in the velocities, are solved one after the other,
// each for one velocity (theory: quasi-velocities).
#pragma once
#include <optional>

#include "lowering/velocity_algebra.h"
#include "tape/point.h"

namespace anholon {

class AdmissibleVelocities {
 public:
  // `qd`: the velocities of the coordinates; `at`: values near the motion, by which pivots are chosen.
  AdmissibleVelocities(const Column& qd, PointValues& at, Tidy& t)
      : free(qd), qd_(qd), g_(*qd[0].graph), at_(at), tidy_(t), free_by_velocity_(qd) {}

  // Returns false if a constraint is not of a kind that this class solves; `refused` is then the number of the first
  // such constraint, and `why` the reason.
  bool solve(const Column& constraints);
  std::size_t refused = 0;
  std::string why;

  Column free;                // the free velocities: those of coordinates, or names for other ones
  Column named, definitions;  // names for velocities that are used unchanged, each defined in `free` and earlier names
  Column pivots;              // the divisors
  bool clears_poles = false;  // a constraint has poles that the velocities do not have

  // `solved` expresses a formula of q' in `free` and `named`; `in_velocities` expresses formulas of `free` in q'.
  Expr solved(Expr e) const { return eliminated(by_points(e)); }
  Column in_velocities(const Column& es) const { return put(es, free, free_by_velocity_); }

 private:
  // The constraint a X + b Y = 0, where (X, Y) is the velocity of a point.
  struct Direction {
    Expr a, X, b, Y;
  };
  // A constraint in the free velocities: sum_i a_i v_i + rest = 0.
  struct Row {
    Expr constraint, by_names;
    Column a;
    std::vector<std::size_t> in;  // the i with nonzero a_i
    Expr rest;
    double largest = 0;                     // the largest |a_i| at the start
    std::size_t best = 0, cost = SIZE_MAX;  // the pivot, and the number of its nodes that vary
    // Two velocities v and w for which a_v^2 + a_w^2 is constant, or which are the only ones: the direction (a_w, -a_v)
    // in which they are free has a length.
    struct Pair {
      std::size_t v, w;
      Expr square;  // a_v^2 + a_w^2
    };
    std::optional<Pair> pair = std::nullopt;
  };
  std::optional<Row> row(Expr constraint);
  std::optional<Row::Pair> pair_of(const Row& r);
  bool solve(Expr constraint);
  void solve(const Row& r);
  std::optional<Direction> direction(Expr constraint) const;
  void name_speed(const Direction& d);
  Expr by_points(Expr e) const;
  std::optional<Expr> without(NodeId whole, NodeId part) const;
  Expr eliminated(Expr e) const;
  Expr written_out(Expr e) const;
  Expr new_name() { return g_.quasi(static_cast<std::uint32_t>(names_++), 0); }
  void remove(std::size_t i, Expr value);
  void define(std::size_t i, Expr value);
  void erase(std::size_t i);

  const Column qd_;
  Graph& g_;
  PointValues& at_;
  Tidy& tidy_;
  Column free_by_velocity_;
  std::size_t names_ = 0;
  Column gone_, values_;
  std::vector<std::pair<Expr, Expr>> points_;  // components of velocities, and their expressions
};

}  // namespace anholon
