#include "integrate/series/time_kink.h"

namespace anholon {

namespace {

constexpr int kDeepestLine = 32;  // conditions on the time are short

template <Number N>
class Reader {
 public:
  using Formula = std::optional<TimePolynomial<N>>;
  Reader(const Program& program, const std::vector<N>& parameters) : program_(program), parameters_(parameters) {}

  // Reads a slot whose operands `operand` reads.
  template <class Operand>
  Formula read(std::uint32_t slot, const Operand& operand) const {
    const Instruction& in = program_.tape.code[slot];
    switch (in.op) {
    case Op::constant:
      return TimePolynomial<N>{number(in.index), N(0), N(0)};
    case Op::pi:
      return TimePolynomial<N>{pi<N>(), N(0), N(0)};
    case Op::parameter:
      return TimePolynomial<N>{parameters_[in.index], N(0), N(0)};
    case Op::input:
      if (program_.inputs[in.index].kind != ProgramInput::Kind::time) return std::nullopt;
      return TimePolynomial<N>{N(0), N(1), N(0)};
    case Op::linear:
      return sum(in, operand);
    case Op::multiply:
    case Op::scale:
      return product(operand(in.a), operand(in.b));
    case Op::square: {
      const Formula x = operand(in.a);
      return product(x, x);
    }
    case Op::divide: {
      const Formula below = operand(in.b);
      if (!below || !below->constant()) return std::nullopt;
      return product(operand(in.a), TimePolynomial<N>{N(1) / below->a, N(0), N(0)});
    }
    case Op::power:
    case Op::function:
    case Op::arctan2:
    case Op::select:
    case Op::lookup:
    case Op::rate:
      return std::nullopt;
    }
    return std::nullopt;
  }

  // Reads a slot with all that it is made of.
  Formula read_whole(std::uint32_t slot, int depth = 0) const {
    if (depth == kDeepestLine) return std::nullopt;
    return read(slot, [&](std::uint32_t s) { return read_whole(s, depth + 1); });
  }

 private:
  N number(std::uint32_t index) const { return from_rational<N>(program_.tape.rationals[index]); }

  template <class Operand>
  Formula sum(const Instruction& in, const Operand& operand) const {
    TimePolynomial<N> all;
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
      const LinearTerm& term = program_.tape.linear_terms[k];
      const Formula x = operand(term.slot);
      if (!x) return std::nullopt;
      const N weight = number(term.coefficient);
      all.a += weight * x->a, all.b += weight * x->b, all.c += weight * x->c;
    }
    return all;
  }

  static Formula product(const Formula& x, const Formula& y) {
    if (!x || !y || x->degree() + y->degree() > 2) return std::nullopt;
    return TimePolynomial<N>{x->a * y->a, x->a * y->b + x->b * y->a, x->a * y->c + x->b * y->b + x->c * y->a};
  }

  const Program& program_;
  const std::vector<N>& parameters_;
};

}  // namespace

template <Number N>
std::optional<N> passes_at(const Program& program, const std::vector<N>& parameters, std::uint32_t slot,
                           const N& value) {
  const auto line = Reader<N>(program, parameters).read_whole(slot);
  if (!line || line->degree() != 1) return std::nullopt;
  const N t = (value - line->a) / line->b;
  return is_finite(t) ? std::optional<N>(t) : std::nullopt;
}

template <Number N>
std::vector<std::optional<TimePolynomial<N>>> time_polynomials(const Program& program, const std::vector<N>& parameters,
                                                               const std::vector<bool>& of_time) {
  std::vector<std::optional<TimePolynomial<N>>> known(of_time.size());
  const Reader<N> reader(program, parameters);
  for (std::uint32_t slot = 0; slot < known.size(); ++slot)
    if (of_time[slot]) known[slot] = reader.read(slot, [&](std::uint32_t s) { return known[s]; });
  return known;
}

bool has_exact_sign(const Program& program, std::uint32_t slot) {
  const Tape& tape = program.tape;
  const auto is_time = [&](std::uint32_t s) {
    return tape.code[s].op == Op::input && program.inputs[tape.code[s].index].kind == ProgramInput::Kind::time;
  };
  const Instruction& in = tape.code[slot];
  if (is_time(slot)) return true;
  if (in.op != Op::linear || in.count != 2) return false;
  const LinearTerm *time = &tape.linear_terms[in.first], *other = time + 1;
  if (!is_time(time->slot)) std::swap(time, other);
  const auto one = [&](const Rational& r) { return abs(r) == 1; };
  if (!is_time(time->slot) || !one(tape.rationals[time->coefficient])) return false;
  const Instruction& constant = tape.code[other->slot];
  const bool unit = one(tape.rationals[other->coefficient]);
  return (constant.op == Op::constant && (unit || one(tape.rationals[constant.index]))) ||
         (constant.op == Op::parameter && unit);
}

template std::optional<long double> passes_at(const Program&, const std::vector<long double>&, std::uint32_t,
                                              const long double&);
template std::optional<Quad> passes_at(const Program&, const std::vector<Quad>&, std::uint32_t, const Quad&);
template std::optional<Multi> passes_at(const Program&, const std::vector<Multi>&, std::uint32_t, const Multi&);
template std::vector<std::optional<TimePolynomial<long double>>>
time_polynomials(const Program&, const std::vector<long double>&, const std::vector<bool>&);

}  // namespace anholon
