#include "kernel/pairs.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "base/assert.h"

namespace anholon {

void PairMachine::Free::operator()(double* p) const { std::free(p); }

PairMachine::PairMachine(const Tape& tape, const std::vector<long double>& parameters, int lanes)
    : tape_(&tape), wide_(tape, 0, parameters), lanes_(static_cast<std::size_t>(lanes)),
      run_(lanes == 1   ? run_pairs_plain
           : lanes == 4 ? run_pairs_avx2
                        : run_pairs_avx512),
      other_([this](std::uint32_t slot) { by_long_double(slot); }) {
  ANHOLON_ASSERT(lanes == 1 || lanes == 4 || lanes == 8);
  program_.places = static_cast<std::uint32_t>(tape.code.size());
  for (std::uint32_t slot = 0; slot < tape.code.size(); ++slot)
    if (!tape.code[slot].constant && tape.code[slot].op != Op::input) add(tape.code[slot], slot);
  constexpr std::size_t kAligned = 64;
  const std::size_t bytes = (2 * sizeof(double) * program_.places * lanes_ + kAligned - 1) / kAligned * kAligned;
  numbers_.reset(static_cast<double*>(std::aligned_alloc(kAligned, std::max(bytes, kAligned))));
  std::memset(numbers_.get(), 0, bytes);
  for (std::uint32_t slot = 0; slot < tape.code.size(); ++slot)
    if (tape.code[slot].constant)
      for (int lane = 0; lane < lanes; ++lane) put(slot, lane, wide_.series(slot)[0]);
}

void PairMachine::add(const Instruction& in, std::uint32_t slot) {
  using PairAct = PairProgram::Act;
  const auto emit = [&](PairAct act, std::uint32_t a, std::uint32_t b) { program_.steps.push_back({act, slot, a, b}); };
  switch (in.op) {
  case Op::linear:
    program_.steps.push_back(
        {PairAct::linear, slot, 0, 0, static_cast<std::uint32_t>(program_.terms.size()), in.count});
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
      const long double c = wide_.rational(tape_->linear_terms[k].coefficient);
      const double high = static_cast<double>(c);
      program_.terms.push_back({high, static_cast<double>(c - high), tape_->linear_terms[k].slot});
    }
    return;
  case Op::multiply:
  case Op::scale:
    return emit(PairAct::multiply, in.a, in.b);
  case Op::square:
    return emit(PairAct::multiply, in.a, in.a);
  case Op::divide:
    return emit(PairAct::divide, in.a, in.b);
  case Op::function: {
    const Function f = static_cast<Function>(in.index);
    if (f != Function::sin && f != Function::cos) break;
    const auto known = std::find_if(sines_.begin(), sines_.end(), [&](const auto& s) { return s.first == in.a; });
    const bool fresh = known == sines_.end();
    // The sine and the cosine are a separate step, whose places come after those of the tape.
    const std::uint32_t sine = fresh ? std::exchange(program_.places, program_.places + 2) : known->second;
    if (fresh) {
      sines_.emplace_back(in.a, sine);
      program_.steps.push_back({PairAct::sine_cosine, sine, in.a, sine + 1});
    }
    return emit(PairAct::copy, f == Function::sin ? sine : sine + 1, 0);
  }
  case Op::constant:
  case Op::pi:
  case Op::input:
  case Op::parameter:
  case Op::power:
  case Op::arctan2:
  case Op::select:
  case Op::lookup:
  case Op::rate:
    break;
  }
  emit(PairAct::other, 0, 0);
}

void PairMachine::evaluate() { run_(program_, numbers_.get(), other_); }

// Copies the operands to the machine in long double, and its result back, lane by lane.
void PairMachine::by_long_double(std::uint32_t slot) {
  const Instruction& in = tape_->code[slot];
  ANHOLON_ASSERT(in.op != Op::rate);
  for (int lane = 0; lane < static_cast<int>(lanes_); ++lane) {
    const auto take = [&](std::uint32_t from) { wide_.series(from)[0] = get(from, lane); };
    take(in.a);
    if (in.op == Op::arctan2 || in.op == Op::select) take(in.b);
    if (in.op == Op::select) take(in.first);
    wide_.sweep(0, slot, slot + 1);
    put(slot, lane, wide_.series(slot)[0]);
  }
}

}  // namespace anholon
