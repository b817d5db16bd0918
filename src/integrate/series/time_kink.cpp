#include "integrate/series/time_kink.h"

namespace anholon {

namespace {

constexpr int kDeepestLine = 32;  // conditions on the time are short

// The line a + b t.
template <Number N>
struct Line {
  N a{0}, b{0};
};

template <Number N>
class LineReader {
 public:
  LineReader(const Program& program, const std::vector<N>& parameters) : program_(program), parameters_(parameters) {}

  std::optional<Line<N>> read(std::uint32_t slot, int depth = 0) const {
    if (depth == kDeepestLine) return std::nullopt;
    const Instruction& in = program_.tape.code[slot];
    const auto operand = [&](std::uint32_t s) { return read(s, depth + 1); };
    switch (in.op) {
    case Op::constant:
      return Line<N>{number(in.index), N(0)};
    case Op::pi:
      return Line<N>{pi<N>(), N(0)};
    case Op::parameter:
      return Line<N>{parameters_[in.index], N(0)};
    case Op::input:
      if (program_.inputs[in.index].kind != ProgramInput::Kind::time) return std::nullopt;
      return Line<N>{N(0), N(1)};
    case Op::linear:
      return sum(in, depth);
    case Op::multiply:
    case Op::scale:
      return product(operand(in.a), operand(in.b));
    case Op::square:
      return product(operand(in.a), operand(in.a));
    case Op::divide: {
      const auto below = operand(in.b);
      if (!below || below->b != N(0)) return std::nullopt;
      return product(operand(in.a), Line<N>{N(1) / below->a, N(0)});
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

 private:
  N number(std::uint32_t index) const { return from_rational<N>(program_.tape.rationals[index]); }

  std::optional<Line<N>> sum(const Instruction& in, int depth) const {
    Line<N> line;
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
      const LinearTerm& term = program_.tape.linear_terms[k];
      const auto x = read(term.slot, depth + 1);
      if (!x) return std::nullopt;
      const N weight = number(term.coefficient);
      line.a += weight * x->a, line.b += weight * x->b;
    }
    return line;
  }

  static std::optional<Line<N>> product(const std::optional<Line<N>>& x, const std::optional<Line<N>>& y) {
    if (!x || !y || (x->b != N(0) && y->b != N(0))) return std::nullopt;
    return Line<N>{x->a * y->a, x->a * y->b + x->b * y->a};
  }

  const Program& program_;
  const std::vector<N>& parameters_;
};

}  // namespace

template <Number N>
std::optional<N> passes_at(const Program& program, const std::vector<N>& parameters, std::uint32_t slot,
                           const N& value) {
  const auto line = LineReader<N>(program, parameters).read(slot);
  if (!line || line->b == N(0)) return std::nullopt;
  const N t = (value - line->a) / line->b;
  return is_finite(t) ? std::optional<N>(t) : std::nullopt;
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

}  // namespace anholon
