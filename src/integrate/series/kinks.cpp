#include "integrate/series/kinks.h"

#include <algorithm>

#include "integrate/series/sign_change.h"
#include "tape/operands.h"

namespace anholon {

static constexpr double kTouches = 1e-8;  // a step may end anywhere, so a narrow miss counts as touching

template <Number N>
static bool surely_less(const N* c, int degree, const N& h, const N& than) {
  const N length = abs(h);
  N most(0);
  for (int k = degree; k >= 1; --k) most = (most + abs(c[k])) * length;
  return most < than * N(1 - 2 * kTouches);
}

template <Number N>
bool stays_positive(const N* c, int degree, const N& h) {
  return surely_less(c, degree, h, c[0]);
}

template <Number N>
bool keeps_sign(const N* c, int degree, const N& h) {
  return surely_less(c, degree, h, N(abs(c[0])));
}

namespace {

constexpr int kNoise = 64;  // values below this many round-offs of the terms that they are made of are zero

bool may_turn(const Instruction& in) {
  return !in.constant && (in.op == Op::select || in.op == Op::lookup || in.op == Op::arctan2 || turns_at_zero(in));
}

// True for a root, whose argument may touch zero.
bool may_touch(const Tape& tape, const Instruction& in) {
  return !in.constant && in.op == Op::power && tape.rationals[in.index].has_even_denominator();
}

std::uint32_t deciding(const Instruction& in) { return in.op == Op::select ? in.first : in.a; }

template <Number N>
class Search {
 public:
  Search(const Machine<N>& machine, std::uint32_t end, int degree, const N& h, bool expanded,
         const std::vector<bool>& passed_over)
      : machine_(machine), end_(end), degree_(degree), h_(h), expanded_(expanded), passed_over_(passed_over),
        c_(static_cast<std::size_t>(degree) + 1) {}

  const Kink<N>& run() {
    const Tape& tape = machine_.tape();
    for (std::uint32_t slot = 0; slot < end_; ++slot) look(tape, tape.code[slot], slot);
    return kink_;
  }

 private:
  void look(const Tape& tape, const Instruction& in, std::uint32_t slot) {
    if (in.constant) return;
    argument_ = deciding(in);
    if (argument_ < passed_over_.size() && passed_over_[argument_]) return;
    if (turns_at_zero(in)) {
      const N* c = machine_.series(in.a);
      if (c[0] > N(0) || c[0] < N(0))
        leaves(c, c[0] > N(0), {in.a, N(0), false});
      else if (std::any_of(c + 1, c + degree_ + 1, [](const N& x) { return x > N(0) || x < N(0); }))
        at_start(in.a);
    } else if (in.op == Op::select) {
      if (tape.code[in.first].constant) return;
      const N* c = machine_.series(in.first);
      leaves(c, !(c[0] < N(0)), {in.first, N(0), c[0] < N(0)});
    } else if (in.op == Op::lookup) {
      look_up(in, slot);
    } else if (in.op == Op::arctan2) {
      if (!tape.code[in.a].constant) passes_cut(machine_.series(in.a), machine_.series(in.b), in.a);
    } else if (may_touch(tape, in)) {
      touches_zero(machine_.series(in.a));
    }
  }

  struct Decides {
    std::uint32_t slot;
    N passes;
    bool enters;
    const StepFunction* table = nullptr;
  };

  void look_up(const Instruction& in, std::uint32_t slot) {
    const N* c = machine_.series(in.a);
    const StepFunction& table = machine_.tape().step_functions[in.index];
    const auto [below, above] = machine_.knots_around(slot);
    for (const N* knot : {below, above}) {
      if (!knot) continue;
      std::copy(c, c + degree_ + 1, c_.begin());
      c_[0] -= *knot;
      if (knot == below && c_[0] == N(0) && expanded_ && !holds(table, *knot, machine_.series(slot)[0]))
        at_start(in.a);
      else
        leaves(c_.data(), knot == below, {in.a, *knot, knot == above, &table});
    }
  }

  // The angle of (x, y) jumps where y passes zero while x is negative. If x may become negative within the step, y is
  // not followed beyond its first zero.
  void passes_cut(const N* y, const N* x, std::uint32_t slot) {
    if (!(x[0] > N(0) && keeps_sign(x, degree_, h_))) leaves(y, !(y[0] < N(0)), {slot, N(0), y[0] < N(0)});
  }

  // True if the value is the one from the knot on; the wider numbers of the state may lie on the other side of the
  // knot.
  static bool holds(const StepFunction& table, const N& knot, const N& value) {
    std::size_t k = 0;
    while (k < table.knots.size() && !(knot < from_rational<N>(table.knots[k]))) ++k;
    return value == from_rational<N>(table.values[k]);
  }

  // Finds where the polynomial leaves its side: p >= 0, or p < 0.
  void leaves(const N* c, bool not_negative, const Decides& by) {
    turned_.resize(static_cast<std::size_t>(degree_) + 1);
    for (int k = 0; k <= degree_; ++k) turned_[static_cast<std::size_t>(k)] = not_negative ? c[k] : N(-c[k]);
    const auto x = first_below<N>(turned_.data(), degree_, h_, N(0));
    if (!x) return;
    if (*x == N(0))
      at_start(by.slot);
    else
      ahead(*x, by);
  }

  void at_start(std::uint32_t slot) {
    kink_.at_start = true;
    kink_.slots_at_start.push_back(slot);
  }

  // The series of a root ends to hold where its argument falls and turns at zero.
  void touches_zero(const N* c) {
    if ((c[1] > N(0)) == (h_ > N(0)) || stays_positive(c, degree_, h_)) return;  // it grows, or stays away from zero
    std::vector<N> slope;
    for (int k = 1; k <= degree_; ++k) slope.push_back(c[1] > N(0) ? N(c[k] * N(k)) : N(-(c[k] * N(k))));
    const auto x = first_below<N>(slope.data(), degree_ - 1, h_, N(0));
    if (!x || *x == N(0)) return;
    if (!(value_at(c, degree_, *x) > c[0] * N(kTouches))) ahead(*x, std::nullopt);
  }

  void ahead(const N& x, const std::optional<Decides>& by) {
    if (kink_.ahead && !(abs(x) < abs(kink_.where))) return;
    kink_.ahead = true;
    kink_.where = x;
    kink_.argument = argument_;
    kink_.slot = by ? std::optional(by->slot) : std::nullopt;
    if (by) kink_.passes = by->passes, kink_.enters = by->enters, kink_.table = by->table;
  }

  const Machine<N>& machine_;
  std::uint32_t end_;
  int degree_;
  N h_;
  bool expanded_;
  const std::vector<bool>& passed_over_;
  std::uint32_t argument_ = 0;  // of the slot under inspection
  std::vector<N> c_, turned_;
  Kink<N> kink_;
};

}  // namespace

template <Number N>
Kink<N> first_kink(const Machine<N>& machine, std::uint32_t end, int degree, const N& h, bool expanded,
                   const std::vector<bool>& passed_over) {
  return Search<N>(machine, end, degree, h, expanded, passed_over).run();
}

std::vector<bool> deciding_for_others(const Tape& tape, std::uint32_t end, const std::vector<std::uint32_t>& needed) {
  std::vector<bool> is_needed(end, false), others(end, false);
  for (const std::uint32_t slot : needed)
    if (slot < end) is_needed[slot] = true;
  for (const bool of_needed : {false, true})
    for (std::uint32_t slot = 0; slot < end; ++slot) {
      const Instruction& in = tape.code[slot];
      if (is_needed[slot] == of_needed && (may_turn(in) || may_touch(tape, in))) others[deciding(in)] = !of_needed;
    }
  return others;
}

std::vector<std::uint32_t> kink_arguments(const Tape& tape, std::uint32_t end) {
  std::vector<std::uint32_t> list;
  for (std::uint32_t slot = 0; slot < end; ++slot) {
    const Instruction& in = tape.code[slot];
    const std::uint32_t argument = deciding(in);
    if (may_turn(in) && !tape.code[argument].constant) list.push_back(argument);
    if (in.op == Op::arctan2 && !in.constant && !tape.code[in.b].constant) list.push_back(in.b);
  }
  return list;
}

template <Number N>
bool is_round_off(std::uint32_t slot, const Machine<N>& machine, const Machine<N>& values, int degree, const N& h) {
  const N* c = machine.series(slot);
  const N length = abs(h);
  N most(0);
  for (int k = degree; k >= 0; --k) most = most * length + abs(c[k]);
  // The terms at this point may be smaller than earlier ones, whose round-off the slot still has.
  constexpr int kOfTermsBefore = 16;
  return most <= unit_roundoff<N>() * N(kNoise * kOfTermsBefore) * values.magnitude(slot);
}

template <Number N>
double kinks_log_reach(const std::vector<std::uint32_t>& arguments, const Machine<N>& machine, const Machine<N>& values,
                       int degree, double log_tolerance) {
  double reach = 300;
  for (const std::uint32_t argument : arguments) {
    const N floor = unit_roundoff<N>() * N(kNoise) * values.magnitude(argument);
    reach = std::min(reach, log_reach<N>(machine.series(argument), degree, floor, log_tolerance));
  }
  return reach;
}

template bool is_round_off(std::uint32_t, const Machine<double>&, const Machine<double>&, int, const double&);
template bool is_round_off(std::uint32_t, const Machine<long double>&, const Machine<long double>&, int,
                           const long double&);
template bool is_round_off(std::uint32_t, const Machine<Quad>&, const Machine<Quad>&, int, const Quad&);
template bool is_round_off(std::uint32_t, const Machine<Multi>&, const Machine<Multi>&, int, const Multi&);
template bool stays_positive(const double*, int, const double&);
template bool stays_positive(const long double*, int, const long double&);
template bool stays_positive(const Quad*, int, const Quad&);
template bool stays_positive(const Multi*, int, const Multi&);
template bool keeps_sign(const double*, int, const double&);
template bool keeps_sign(const long double*, int, const long double&);
template bool keeps_sign(const Quad*, int, const Quad&);
template bool keeps_sign(const Multi*, int, const Multi&);
template Kink<double> first_kink(const Machine<double>&, std::uint32_t, int, const double&, bool,
                                 const std::vector<bool>&);
template Kink<long double> first_kink(const Machine<long double>&, std::uint32_t, int, const long double&, bool,
                                      const std::vector<bool>&);
template Kink<Quad> first_kink(const Machine<Quad>&, std::uint32_t, int, const Quad&, bool, const std::vector<bool>&);
template Kink<Multi> first_kink(const Machine<Multi>&, std::uint32_t, int, const Multi&, bool,
                                const std::vector<bool>&);
template double kinks_log_reach(const std::vector<std::uint32_t>&, const Machine<double>&, const Machine<double>&, int,
                                double);
template double kinks_log_reach(const std::vector<std::uint32_t>&, const Machine<long double>&,
                                const Machine<long double>&, int, double);
template double kinks_log_reach(const std::vector<std::uint32_t>&, const Machine<Quad>&, const Machine<Quad>&, int,
                                double);
template double kinks_log_reach(const std::vector<std::uint32_t>&, const Machine<Multi>&, const Machine<Multi>&, int,
                                double);

}  // namespace anholon
