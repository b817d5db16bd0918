// The velocities that constraints admit: one constraint after the other, linear in the velocities, solved for one of
// them (theory: quasi-velocities).
#pragma once
#include <optional>

#include "lowering/velocity_algebra.h"
#include "tape/point.h"

namespace anholon {

class AdmissibleVelocities {
 public:
  // Of coordinates; `at`: values near the motion, by which pivots are chosen.
  AdmissibleVelocities(const Column& qd, PointValues& at, Tidy& t)
      : free(qd), qd_(qd), g_(*qd[0].graph), at_(at), tidy_(t), free_by_velocity_(qd) {}

  // Returns false if the constraints are not of the kind that this solves; `refused` is then the number of the first one
  // that is not, and `why` what it is.
  bool solve(const Column& constraints);
  std::size_t refused = 0;
  std::string why;

  Column free;                // those left: of coordinates, or names for others
  Column named, definitions;  // names for velocities that are used as they are, each given in `free` and those before
  Column pivots;              // what was divided by
  bool clears_poles = false;  // a constraint has poles that the velocities do not have

  // What is given in q', in `free` and `named`; and what is given in `free`, in q'.
  Expr solved(Expr e) const { return eliminated(by_points(e)); }
  Column in_velocities(const Column& es) const { return put(es, free, free_by_velocity_); }

 private:
  // a X + b Y = 0, (X, Y) the velocity of a point.
  struct Direction {
    Expr a, X, b, Y;
  };
  // A constraint in what is free: sum_i a_i v_i + rest = 0.
  struct Row {
    Expr constraint, by_names;
    Column a;
    std::vector<std::size_t> in;  // where a is not zero
    Expr rest;
    double largest = 0;                     // of the a at the start
    std::size_t best = 0, cost = SIZE_MAX;  // the pivot, and how many of its nodes vary
    // Two of them, v and w, where a_v^2 + a_w^2 is a constant, or where there are only these: the direction (a_w, -a_v) in
    // which they are free has a length.
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
  std::vector<std::pair<Expr, Expr>> points_;  // components of velocities, and what they are
};

}  // namespace anholon
