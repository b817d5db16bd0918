// Code between expansions: the start of an expansion, the health of its pivots, the reach of its series, the next
// state.
#include <limits>

#include <llvm/IR/Intrinsics.h>

#include "jit/emitter.h"

namespace anholon::jit {

namespace {
// For one motion with few states, the increments are added as they are computed. Otherwise a second copy of that code
// does not pay: in lanes it is a fifth of all code of a small system.
constexpr std::size_t kFewStates = 32;
}  // namespace

llvm::Value* Emitter::coefficient_of(std::size_t j, int order) { return load(std::int64_t{p_.x[j]} + order); }

void Emitter::begin_motion() {
  begin("begin", 1);
  std::int64_t high = 0, guess = 2 * std::int64_t{k_.state_size};
  for (std::size_t j = 0; j < p_.x.size(); ++j)
    for (int k = 0; k <= p_.d[j]; ++k) {
      Value* x = load_from(function_->getArg(1), k < p_.d[j] ? high++ : guess++);
      x = k <= 2 ? times(x, k_.inverse_factorial[static_cast<std::size_t>(k)]) : b_.CreateFDiv(x, number(factorial(k)));
      store(x, std::int64_t{p_.x[j]} + k);
    }
  for (const Beyond& b : p_.beyond_double)
    store(load_from(function_->getArg(1), std::int64_t{k_.state_size} + b.index), b.at);
  end();
}

void Emitter::judge(const std::vector<Value*>& lu) {
  Value *zero = number(0), *health = number(std::numeric_limits<double>::max()), *determinant = number(1),
        *invalid = zero;
  std::int64_t inverse = k_.inverse_pivots;
  for (const JudgedPivot& p : k_.judged) {
    Value *ratio = b_.CreateFMul(p.at < k_.lu ? load(p.at) : lu[p.at - k_.lu], load(inverse++)),
          *size = magnitude(ratio);
    health = b_.CreateSelect(b_.CreateFCmpOLT(size, health), size, health);
    determinant = b_.CreateFMul(determinant, ratio);
    invalid = b_.CreateFAdd(invalid, b_.CreateFSub(ratio, ratio));
  }
  store(b_.CreateSelect(b_.CreateFCmpOEQ(invalid, zero), health, zero), k_.found.health);
  store(determinant, k_.found.determinant);
  store(zero, k_.found.drift);
  store(zero, k_.found.moved);
}

// Returns true at run time if the solution displaces a state in any lane.
llvm::Value* Emitter::displaced(int level) {
  Value *one = number(1), *zero = number(0), *displacement = nullptr, *drift = load(k_.found.drift);
  for (const std::vector<std::uint32_t>& scale : p_.scales) {
    Value *size = one, *most = zero;
    for (const std::uint32_t j : scale) {
      const int k = p_.d[j] - level;
      if (k < 0) continue;
      size = larger(size, times(magnitude(coefficient_of(j, k)), factorial(k)));
      most = larger(most, magnitude(solution_[j]));
    }
    Value* here = b_.CreateFDiv(most, size);
    displacement = displacement ? b_.CreateSelect(b_.CreateFCmpOLE(here, displacement), displacement, here) : here;
  }
  store(b_.CreateSelect(b_.CreateFCmpOLE(displacement, drift), drift, displacement), k_.found.drift);
  Value* moves = b_.CreateFCmpOGT(displacement, number(kQuiet));
  store(b_.CreateSelect(moves, one, zero), k_.found.weight);
  store(b_.CreateSelect(moves, one, load(k_.found.moved)), k_.found.moved);
  return lanes_ == 1 ? moves : b_.CreateOrReduce(moves);
}

void Emitter::measure() {
  begin("measure");
  const int order = p_.stages + 1;
  Value *zero = number(0), *one = number(1), *last = zero, *before_last = zero, *pole = zero, *unfit = zero;
  for (const std::vector<std::uint32_t>& scale : p_.scales) {
    double factor = 1, factor_before = 1;
    for (int k = 0; k < p_.largest_d; ++k) {
      if (k > 0) factor *= order + k, factor_before *= order - 1 + k;
      Value *size = one, *l = zero, *b = zero;
      for (const std::uint32_t j : scale) {
        if (k >= p_.d[j]) continue;
        size = larger(size, times(magnitude(coefficient_of(j, k)), factorial(k)));
        l = larger(l, magnitude(coefficient_of(j, order + k)));
        b = larger(b, magnitude(coefficient_of(j, order - 1 + k)));
      }
      Value* weight = b_.CreateFDiv(number(factor), size);
      last = larger(last, b_.CreateFMul(l, weight));
      before_last = larger(before_last, b_.CreateFMul(b, times(weight, factor_before / factor)));
    }
  }
  bool poles = false;
  for (std::size_t j = 0; j < p_.x.size(); ++j) {
    Value* top = coefficient_of(j, p_.stages + p_.d[j]);
    unfit = b_.CreateFAdd(unfit, b_.CreateFSub(top, top));
    if (p_.d[j] > 0) continue;
    Value *value = magnitude(coefficient_of(j, 0)),
          *relative = b_.CreateFMul(magnitude(top), b_.CreateFDiv(one, larger(one, value)));
    pole = b_.CreateSelect(b_.CreateFCmpOGT(value, zero), larger(pole, relative), pole);
    poles = true;
  }
  Value *margin = load(k_.margin), *most = smaller(reach(before_last, order - 1, margin), number(kFarthest));
  if (poles) most = smaller(most, reach(pole, order - 1, number(-0.7 * kLog2e)));
  store(exp2(smaller(most, reach(last, order, margin))), k_.found.reach);
  store(unfit, k_.found.unfit);
  end();
}

// Advances the state over the step, by the increments.
void Emitter::go_on() {
  begin("go_on", 2);
  std::vector<Value*> added;
  if (lanes_ == 1 && k_.state_size <= kFewStates) {
    added = increments();
  } else {
    b_.CreateCall(advance_, {w_});
    for (std::uint32_t i = 0; i < k_.state_size + p_.x.size(); ++i) added.push_back(load(k_.increments + i));
  }
  Value *base = function_->getArg(1), *to = function_->getArg(2), *step = load(k_.step), *largest = number(0),
        *invalid = number(0);
  const std::int64_t n = k_.state_size;
  std::int64_t at = 0;
  auto change = added.begin();
  for (std::size_t j = 0; j < p_.x.size(); ++j) {
    const int d = p_.d[j];
    std::vector<Value*> high, low;
    for (int k = 0; k < d; ++k) high.push_back(load_from(base, at + k)), low.push_back(load_from(base, n + at + k));
    for (int k = 0; k < d; ++k, ++at) {
      Value *s = b_.CreateFAdd(low[static_cast<std::size_t>(k)], *change++), *power = step;
      for (int i = k + 1; i < d; ++i) {
        const auto place = static_cast<std::size_t>(i);
        s = fma(b_.CreateFAdd(b_.CreateFSub(high[place], times(coefficient_of(j, i), factorial(i))), low[place]), power,
                s);
        if (i + 1 < d)
          power = b_.CreateFMul(power, times(step, k_.order.reciprocal[static_cast<std::size_t>(i - k + 1)]));
      }
      Value *h = high[static_cast<std::size_t>(k)], *sum = b_.CreateFAdd(h, s), *part = b_.CreateFSub(sum, h);
      Value* error = b_.CreateFAdd(b_.CreateFSub(h, b_.CreateFSub(sum, part)), b_.CreateFSub(s, part));
      store_to(sum, to, at);
      store_to(rest(sum, error), to, n + at);
      largest = larger(largest, magnitude(sum));
      invalid = b_.CreateFAdd(invalid, b_.CreateFSub(sum, sum));
    }
    store_to(b_.CreateFAdd(times(coefficient_of(j, d), factorial(d)), *change++), to,
             2 * n + static_cast<std::int64_t>(j));
  }
  store(b_.CreateFAdd(largest, invalid), k_.found.largest);
  end();
}

}  // namespace anholon::jit
