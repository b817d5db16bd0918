#include "jit/emitter.h"

#include <algorithm>

#include <llvm/IR/Intrinsics.h>

namespace anholon::jit {

namespace {
// A longer elimination is a separate function, because it would be most of the code of every stage.
constexpr double kLongElimination = 100;
}  // namespace

Emitter::Emitter(const KernelTables& tables, llvm::Module& module, int lanes, int several_sines, std::size_t part)
    : StageCode(tables, module, lanes), several_sines_(several_sines), part_(part), asked_(p_.rows, false) {
  for (std::size_t j = 0; j < p_.x.size(); ++j) asked_[j] = true;
  for (const Completion& c : p_.completions) asked_[c.column] = true;
}

void Emitter::run() {
  if (k_.sums != 0) return extend();
  const SparseLu& e = *k_.elimination;
  if (k_.refine || (e.influences.empty() ? e.work() > kLongElimination : lanes_ > 1 && !e.own.empty())) substitution();
  values();
  factor();
  lead();
  extend();
  advance();
  begin_motion();
  measure();
  go_on();
  for (int l = 1; l <= levels(k_); ++l) level(l);
}

void Emitter::begin(const char* name, unsigned places, bool answers) {
  open(name, places, answers);
  relative_ = false;
  sines_ = nullptr;
  forget();
}

llvm::Function* Emitter::begin_part(const std::string& name) {
  open_part(name);
  scratch_ = function_->getArg(1);
  begin_block(function_->getArg(2));
  return function_;
}

void Emitter::complete_unknown(std::size_t j, Value* solved, bool start) {
  Value* change = p_.d[j] > 0 ? over_rising(solved, p_.d[j]) : solved;
  put({p_.x[j], true}, p_.d[j], start ? b_.CreateFAdd(get({p_.x[j], true}, p_.d[j]), change) : change);
}

void Emitter::complete_slot(const Completion& c, Value* solved, bool start) {
  Value* change = c.lead > 0 ? over_rising(solved, c.lead) : solved;
  put(c.out, c.lead, start || !c.fresh ? b_.CreateFAdd(get(c.out, c.lead), change) : change);
}

void Emitter::complete() {
  const bool start = !relative_ && stage_ == 0;
  for (std::size_t j = 0; j < p_.x.size(); ++j) complete_unknown(j, solution_[j], start);
  for (const Completion& c : p_.completions) complete_slot(c, solution_[c.column], start);
  for (const Step& s : p_.weigh_again) {
    if (start && s.lead == 0) continue;  // the weight of order 0 is zero
    coefficient(s);
  }
}

void Emitter::lead() {
  begin("lead");
  stage_ = 0;
  sides();
  solve();
  complete();
  end();
}

void Emitter::level(int level) {
  begin(Code::level_name(level).c_str(), 0, true);
  side_.clear();
  for (std::size_t i = 0; i < p_.roots.size(); ++i) {
    const int order = p_.c[i] - level;
    const Place r = p_.roots[i];
    side_.push_back(order < 0 ? number(0)
                              : b_.CreateFMul(load(r.at + (r.series ? order : 0)),
                                              number(-k_.factorial[static_cast<std::size_t>(order)])));
  }
  solve();
  // All elements are stored, because callers examine them before their use.
  for (std::uint32_t j = 0; j < p_.x.size(); ++j) store(solution_[j], k_.solution + j);
  end(displaced(level));
}

void Emitter::advance() {
  begin("advance");
  increments();
  end();
  advance_ = function_;
}

// For a single motion, four orders are one vector.
std::vector<llvm::Value*> Emitter::increments() {
  const int most = p_.stages + p_.largest_d, groups = (most + kBlock - 1) / kBlock;
  const bool alone = lanes_ == 1;
  auto* four = llvm::FixedVectorType::get(b_.getDoubleTy(), kBlock);
  // weights[k]: the weights of the orders i = 1.., or of four orders at once.
  std::vector<std::vector<Value*>> weights(static_cast<std::size_t>(p_.largest_d) + 1);
  Value *h = load(k_.step), *square = b_.CreateFMul(h, h), *fourth = b_.CreateFMul(square, square);
  std::vector<Value*> powers{h, square, b_.CreateFMul(square, h), fourth};
  if (alone) {
    Value* first = llvm::PoisonValue::get(four);
    for (std::uint64_t i = 0; i < kBlock; ++i) first = b_.CreateInsertElement(first, powers[i], i);
    powers = {first};
    fourth = b_.CreateVectorSplat(kBlock, fourth);
  }
  const std::size_t before = powers.size(), count = static_cast<std::size_t>(alone ? groups : most);
  while (powers.size() < count) powers.push_back(b_.CreateFMul(powers[powers.size() - before], fourth));
  for (int k = 0; k <= p_.largest_d; ++k)
    for (std::size_t i = 0; i < count; ++i) {
      const auto rising = [&](int order) { return order <= most - k ? k_.rising(k, order) : 0; };
      const int order = static_cast<int>(i) * (alone ? kBlock : 1) + 1;
      Value* factor = alone ? llvm::ConstantDataVector::get(m_.getContext(),
                                                            std::vector<double>{rising(order), rising(order + 1),
                                                                                rising(order + 2), rising(order + 3)})
                            : number(rising(order));
      weights[static_cast<std::size_t>(k)].push_back(k == 0 ? powers[i] : b_.CreateFMul(powers[i], factor));
    }
  std::vector<Value*> all;
  for (std::size_t j = 0; j < p_.x.size(); ++j)
    for (int k = 0; k <= p_.d[j]; ++k) {
      const int last = p_.stages + p_.d[j] - k;
      std::vector<Value*> s(kBlock, number(0));
      if (alone) {
        Value* sum = llvm::ConstantAggregateZero::get(four);
        for (int i = (last - 1) / kBlock * kBlock + 1; i >= 1; i -= kBlock) {
          Value *at = address(std::int64_t{p_.x[j]} + k + i, false), *x = nullptr;
          if (i + kBlock - 1 <= last) {
            x = b_.CreateAlignedLoad(four, at, llvm::Align(8));
          } else {
            std::vector<llvm::Constant*> mask;
            for (int order = i; order < i + kBlock; ++order) mask.push_back(b_.getInt1(order <= last));
            x = b_.CreateMaskedLoad(four, at, llvm::Align(8), llvm::ConstantVector::get(mask),
                                    llvm::ConstantAggregateZero::get(four));
          }
          sum = fma(x, weights[static_cast<std::size_t>(k)][static_cast<std::size_t>((i - 1) / kBlock)], sum);
        }
        for (std::uint64_t r = 0; r < kBlock; ++r) s[r] = b_.CreateExtractElement(sum, r);
      } else {
        for (int i = last; i >= 1; --i) {
          Value*& sum = s[static_cast<std::size_t>((i - 1) % kBlock)];
          sum = fma(load(std::int64_t{p_.x[j]} + k + i),
                    weights[static_cast<std::size_t>(k)][static_cast<std::size_t>(i - 1)], sum);
        }
      }
      all.push_back(b_.CreateFAdd(s[0], b_.CreateFAdd(s[1], b_.CreateFAdd(s[2], s[3]))));
      store(all.back(), k_.increments + static_cast<std::int64_t>(all.size()) - 1);
    }
  return all;
}

}  // namespace anholon::jit
