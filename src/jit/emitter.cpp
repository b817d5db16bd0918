#include "jit/emitter.h"

#include <algorithm>

#include <llvm/IR/Intrinsics.h>

namespace anholon::jit {

namespace {
// A longer elimination is a function of its own: it would be most of the code of every stage.
constexpr double kLongElimination = 100;
}  // namespace

Emitter::Emitter(const KernelTables& tables, llvm::Module& module, int lanes, int several_sines)
    : k_(tables), p_(*tables.plan), m_(module), b_(module.getContext()), lanes_(lanes), several_sines_(several_sines),
      lane_(lanes == 1
                ? b_.getDoubleTy()
                : static_cast<llvm::Type*>(llvm::FixedVectorType::get(b_.getDoubleTy(), static_cast<unsigned>(lanes)))),
      asked_(p_.rows, false) {
  for (std::size_t j = 0; j < p_.x.size(); ++j) asked_[j] = true;
  for (const Completion& c : p_.completions) asked_[c.column] = true;
}

void Emitter::run() {
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
  auto* type = llvm::FunctionType::get(answers ? b_.getInt32Ty() : b_.getVoidTy(),
                                       std::vector<llvm::Type*>(1 + places, b_.getPtrTy()), false);
  function_ = llvm::Function::Create(type, llvm::Function::ExternalLinkage, name, m_);
  function_->addFnAttr(llvm::Attribute::NoUnwind);
  w_ = function_->getArg(0);
  b_.SetInsertPoint(llvm::BasicBlock::Create(m_.getContext(), "entry", function_));
  relative_ = false;
  sines_ = nullptr;
  forget();
}

// Functions are of moderate size: the work of the compiler grows faster than their length.
llvm::Function* Emitter::begin_part(const std::string& name) {
  auto* type = llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy(), b_.getPtrTy(), b_.getInt64Ty()}, false);
  function_ = llvm::Function::Create(type, llvm::Function::PrivateLinkage, name, m_);
  function_->addFnAttr(llvm::Attribute::NoUnwind);
  w_ = function_->getArg(0);
  scratch_ = function_->getArg(1);
  function_->addParamAttr(1, llvm::Attribute::NoAlias);
  b_.SetInsertPoint(llvm::BasicBlock::Create(m_.getContext(), "entry", function_));
  begin_block(function_->getArg(2));
  return function_;
}

void Emitter::end(Value* answer) {
  if (answer)
    b_.CreateRet(b_.CreateZExt(answer, b_.getInt32Ty()));
  else
    b_.CreateRetVoid();
}

llvm::Value* Emitter::address(std::int64_t slot, bool relative) {
  return b_.CreateConstInBoundsGEP1_64(lane_, relative ? block_ : w_, static_cast<std::uint64_t>(slot));
}

llvm::Value* Emitter::get(const Place& place, int lead) {
  if (place.series) return known_[{place.at, stage_ + lead}] = earlier(place.at, stage_ + lead);
  const auto it = known_.find({place.at, kNoOrder});
  return it != known_.end() ? it->second : known_[{place.at, kNoOrder}] = load(place.at);
}

llvm::Value* Emitter::earlier(std::uint32_t at, int order) {
  const auto it = known_.find({at, order});
  return it != known_.end() ? it->second : read(at, order, relative_);
}

llvm::Value* Emitter::constant(std::int64_t slot) {
  return noted(load(slot), {Origin::Kind::constant, static_cast<std::uint32_t>(slot)});
}

llvm::Value* Emitter::read(std::uint32_t at, int order, bool relative) {
  Value* const x = load(std::int64_t{at} + order, relative);
  reads_.emplace_back(at, x);
  return noted(x, {Origin::Kind::series, at, order, relative});
}

void Emitter::forget() {
  known_.clear();
  elements_.clear();
  origins_.clear();
  histories_.clear();
  stores_.clear();
}

void Emitter::put(const Place& place, int lead, Value* v) {
  known_[{place.at, place.series ? stage_ + lead : kNoOrder}] = v;
  if (place.series) {
    llvm::StoreInst* const made = store(v, std::int64_t{place.at} + stage_ + lead, relative_);
    puts_.emplace_back(place.at, made);
    // No load has read the value that an earlier store of the same stage wrote.
    if (relative_ || stage_ > 0) {
      llvm::StoreInst*& before = stores_[{place.at, stage_ + lead}];
      if (before) before->eraseFromParent();
      before = made;
    }
  }
  // Beyond stage 0 the value is not needed again.
  else if (!relative_ && stage_ <= 0)
    store(v, place.at);
}

// The quotient by a whole number, as in kernel/tiers/lanes.h.
llvm::Value* Emitter::quotient(Value* x, Value* reciprocal, Value* beyond) {
  // The known part is zero.
  if (const auto* nothing = llvm::dyn_cast<llvm::Constant>(x); nothing && nothing->isZeroValue()) return x;
  return fma(x, reciprocal, b_.CreateFMul(x, beyond));
}

llvm::Value* Emitter::order(int offset) { return table("order", k_.order.number, offset); }

llvm::Value* Emitter::over_order(Value* x, int offset) {
  return quotient(x, table("reciprocal", k_.order.reciprocal, offset),
                  table("reciprocal_beyond", k_.order.beyond, offset));
}

llvm::Value* Emitter::row(const char* name, const std::vector<double>& rows, int m, int offset) {
  const auto first = rows.begin() + static_cast<std::ptrdiff_t>(k_.rising_at(m, 0));
  return table((name + std::to_string(m)).c_str(), {first, first + static_cast<std::ptrdiff_t>(k_.orders)}, offset);
}

llvm::Value* Emitter::rising(int m, int offset) { return row("rising", k_.rising_.number, m, offset); }

llvm::Value* Emitter::over_rising(Value* x, int m) {
  return quotient(x, row("falling", k_.rising_.reciprocal, m, 0), row("falling_beyond", k_.rising_.beyond, m, 0));
}

llvm::Value* Emitter::table(const char* name, const std::vector<double>& row, int offset) {
  if (!relative_) return number(row[static_cast<std::size_t>(stage_ + offset)]);
  Value*& element = elements_[{name, stage_ + offset}];
  if (element) return element;
  llvm::GlobalVariable*& t = tables_[name];
  if (!t) {
    llvm::Constant* data = llvm::ConstantDataArray::get(m_.getContext(), llvm::ArrayRef<double>(row));
    t = new llvm::GlobalVariable(m_, data->getType(), true, llvm::GlobalValue::PrivateLinkage, data, name);
  }
  Value* at = b_.CreateInBoundsGEP(b_.getDoubleTy(), t, k0_);
  at = b_.CreateConstGEP1_64(b_.getDoubleTy(), at,
                             static_cast<std::uint64_t>(static_cast<std::int64_t>(stage_ + offset)));
  Value* x = b_.CreateAlignedLoad(b_.getDoubleTy(), at, llvm::Align(8));
  return element = lanes_ == 1 ? x : b_.CreateVectorSplat(static_cast<unsigned>(lanes_), x);
}

llvm::Value* Emitter::fma(Value* a, Value* b, Value* c) {
  return b_.CreateIntrinsic(llvm::Intrinsic::fma, {c->getType()}, {a, b, c});
}

llvm::Value* Emitter::call_scalar(const char* name, const std::vector<Value*>& arguments, llvm::Type* result) {
  std::vector<llvm::Type*> types;
  for (Value* v : arguments) types.push_back(v->getType());
  return b_.CreateCall(m_.getOrInsertFunction(name, llvm::FunctionType::get(result, types, false)), arguments);
}

llvm::Value* Emitter::call(const char* name, const std::vector<Value*>& arguments) {
  Value* all = llvm::PoisonValue::get(lane_);
  for (int lane = 0; lane < lanes_; ++lane) {
    std::vector<Value*> of;
    for (Value* v : arguments) of.push_back(of_lane(v, lane));
    Value* r = call_scalar(name, of, b_.getDoubleTy());
    if (lanes_ == 1) return r;
    all = b_.CreateInsertElement(all, r, static_cast<std::uint64_t>(lane));
  }
  return all;
}

void Emitter::complete() {
  const bool start = !relative_ && stage_ == 0;
  for (std::size_t j = 0; j < p_.x.size(); ++j) {
    Value* change = p_.d[j] > 0 ? over_rising(solution_[j], p_.d[j]) : solution_[j];
    put({p_.x[j], true}, p_.d[j], start ? b_.CreateFAdd(get({p_.x[j], true}, p_.d[j]), change) : change);
  }
  for (const Completion& c : p_.completions) {
    Value* change = solution_[c.column];
    if (c.lead > 0) change = over_rising(change, c.lead);
    put(c.out, c.lead, start || !c.fresh ? b_.CreateFAdd(get(c.out, c.lead), change) : change);
  }
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
  begin(level_name(level).c_str(), 0, true);
  side_.clear();
  for (std::size_t i = 0; i < p_.roots.size(); ++i) {
    const int order = p_.c[i] - level;
    const Place r = p_.roots[i];
    side_.push_back(order < 0 ? number(0)
                              : b_.CreateFMul(load(r.at + (r.series ? order : 0)),
                                              number(-k_.factorial[static_cast<std::size_t>(order)])));
  }
  solve();
  // All are needed: callers examine them before their use.
  for (std::uint32_t j = 0; j < p_.x.size(); ++j) store(solution_[j], k_.solution + j);
  end(displaced(level));
}

void Emitter::advance() {
  begin("advance");
  increments();
  end();
  advance_ = function_;
}

// For a single motion, four orders are a vector.
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
