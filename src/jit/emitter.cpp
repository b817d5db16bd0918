#include "jit/emitter.h"

#include <llvm/IR/Intrinsics.h>

#include <algorithm>

namespace anholon::jit {

namespace {
// A longer elimination than this is a function of its own: it would be most of the code of every stage.
constexpr double kLongElimination = 100;
}  // namespace

Emitter::Emitter(const KernelTables& tables, llvm::Module& module, int lanes)
    : k_(tables), p_(*tables.plan), m_(module), b_(module.getContext()), lanes_(lanes),
      lane_(lanes == 1 ? b_.getDoubleTy() : static_cast<llvm::Type*>(llvm::FixedVectorType::get(b_.getDoubleTy(), static_cast<unsigned>(lanes)))), asked_(p_.rows, false) {
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
  auto* type = llvm::FunctionType::get(answers ? b_.getInt32Ty() : b_.getVoidTy(), std::vector<llvm::Type*>(1 + places, b_.getPtrTy()), false);
  function_ = llvm::Function::Create(type, llvm::Function::ExternalLinkage, name, m_);
  function_->addFnAttr(llvm::Attribute::NoUnwind);
  w_ = function_->getArg(0);
  b_.SetInsertPoint(llvm::BasicBlock::Create(m_.getContext(), "entry", function_));
  relative_ = false;
  known_.clear();
}

// Functions of moderate size: what the compiler does grows faster than they.
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
  if (answer) b_.CreateRet(b_.CreateZExt(answer, b_.getInt32Ty()));
  else b_.CreateRetVoid();
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
  return it != known_.end() ? it->second : load(std::int64_t{at} + order, relative_);
}

void Emitter::put(const Place& place, int lead, Value* v) {
  known_[{place.at, place.series ? stage_ + lead : kNoOrder}] = v;
  if (place.series) store(v, std::int64_t{place.at} + stage_ + lead, relative_);
  // Beyond stage 0 nobody asks for it again.
  else if (!relative_ && stage_ <= 0) store(v, place.at);
}

llvm::Value* Emitter::table(const char* name, const std::vector<double>& row, int offset) {
  if (!relative_) return number(row[static_cast<std::size_t>(stage_ + offset)]);
  llvm::GlobalVariable*& t = tables_[name];
  if (!t) {
    llvm::Constant* data = llvm::ConstantDataArray::get(m_.getContext(), llvm::ArrayRef<double>(row));
    t = new llvm::GlobalVariable(m_, data->getType(), true, llvm::GlobalValue::PrivateLinkage, data, name);
  }
  Value* at = b_.CreateInBoundsGEP(b_.getDoubleTy(), t, k0_);
  at = b_.CreateConstGEP1_64(b_.getDoubleTy(), at, static_cast<std::uint64_t>(static_cast<std::int64_t>(stage_ + offset)));
  Value* x = b_.CreateAlignedLoad(b_.getDoubleTy(), at, llvm::Align(8));
  return lanes_ == 1 ? x : b_.CreateVectorSplat(static_cast<unsigned>(lanes_), x);
}

llvm::Value* Emitter::fma(Value* a, Value* b, Value* c) { return b_.CreateIntrinsic(llvm::Intrinsic::fma, {c->getType()}, {a, b, c}); }

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

void Emitter::values() {
  begin("values");
  for (stage_ = -p_.largest_lead; stage_ <= 0; ++stage_) {
    known_.clear();
    for (const Step& s : p_.point) {
      if (stage_ + s.lead == 0) value(s);
      else if (stage_ + s.lead > 0) coefficient(s);
    }
  }
  for (const Partial& d : p_.partials) partial(d);
  end();
}

void Emitter::factor() {
  begin("factor");
  const SparseLu& e = *k_.elimination;
  std::vector<Value*> lu(e.entries, nullptr);
  const auto at = [&](std::uint32_t i) { return lu[i] ? lu[i] : number(0); };
  for (std::size_t i = 0; i < p_.entries.size(); ++i) {
    Value* v = b_.CreateFMul(number(p_.entries[i].sign), load(p_.entries[i].from));
    lu[e.place[i]] = b_.CreateFAdd(at(e.place[i]), v);
    if (k_.keeps_entries()) store(v, k_.entries + static_cast<std::int64_t>(i));
  }
  std::vector<Value*> reciprocal(e.pivots.size(), nullptr);
  for (std::size_t k = 0; k < e.pivots.size(); ++k) {
    const SparseLu::Pivot& p = e.pivots[k];
    if (!p.one) {
      reciprocal[k] = p.minus_one ? number(-1) : b_.CreateFDiv(number(1), at(p.entry));
      for (std::uint32_t i = p.first_scaled; i < p.first_scaled + p.scaled; ++i) lu[e.scaled_entries[i]] = b_.CreateFMul(at(e.scaled_entries[i]), reciprocal[k]);
    }
    for (std::uint32_t i = p.first_update; i < p.first_update + p.updates; ++i) {
      const SparseLu::Update& u = e.update_list[i];
      lu[u.to] = fma(b_.CreateFNeg(at(u.l)), at(u.u), at(u.to));
    }
  }
  for (std::uint32_t i = 0; i < e.entries; ++i) store(at(i), k_.lu + i);
  for (std::size_t k = 0; k < e.pivots.size(); ++k)
    if (reciprocal[k]) store(reciprocal[k], k_.reciprocal + static_cast<std::int64_t>(k));
  if (!e.influences.empty()) invert(lu, reciprocal);
  judge(lu);
  end();
}

void Emitter::invert(const std::vector<Value*>& lu, const std::vector<Value*>& reciprocal) {
  const SparseLu& e = *k_.elimination;
  if (!e.own.empty()) {
    if (lanes_ == 1) invert_sides_at_once(lu, reciprocal);
    else invert_sides_by_call();
    return;
  }
  for (const std::uint32_t side : p_.sides) {
    std::vector<Value*> rhs(p_.rows, nullptr);
    rhs[side] = number(1);
    const std::vector<Value*> y = solution_for(rhs, lu, reciprocal);
    for (std::size_t i = 0; i < e.influences.size(); ++i)
      if (e.influences[i].side == side) store(y[e.influences[i].column], k_.inverse + static_cast<std::int64_t>(i));
  }
}

// Without what is always zero. Right sides may be vectors of several.
std::vector<llvm::Value*> Emitter::solution_for(std::vector<Value*> rhs, const std::vector<Value*>& lu, const std::vector<Value*>& reciprocal) {
  const SparseLu& e = *k_.elimination;
  std::vector<Value*> y(p_.rows, nullptr);
  const auto as = [&](Value* v, Value* x) { return v->getType() == x->getType() ? v : b_.CreateVectorSplat(llvm::cast<llvm::FixedVectorType>(x->getType())->getNumElements(), v); };
  const auto minus = [&](Value* s, std::uint32_t entry, Value* x) {
    return x && lu[entry] ? fma(as(b_.CreateFNeg(lu[entry]), x), x, s ? s : llvm::ConstantFP::get(x->getType(), 0)) : s;
  };
  for (const SparseLu::Forward& f : e.forward) rhs[f.to] = minus(rhs[f.to], f.entry, rhs[f.from]);
  for (const SparseLu::Backward& b : e.backward) {
    Value* s = b.zero_side ? nullptr : rhs[b.row];
    for (std::uint32_t i = b.first; i < b.first + b.count; ++i) s = minus(s, e.terms[i].entry, y[e.terms[i].column]);
    y[b.column] = !s || e.pivots[b.pivot].one ? s : b_.CreateFMul(s, as(reciprocal[b.pivot], s));
  }
  return y;
}

// Every right side is an element of vectors.
void Emitter::invert_sides_at_once(const std::vector<Value*>& lu, const std::vector<Value*>& reciprocal) {
  const SparseLu& e = *k_.elimination;
  std::vector<Value*> rhs(p_.rows, nullptr);
  std::vector<std::size_t> rank(p_.sides.size());
  for (std::size_t r = 0; r < p_.sides.size(); ++r) {
    std::vector<double> unit(p_.sides.size(), 0.0);
    unit[r] = 1;
    rhs[p_.sides[r]] = llvm::ConstantDataVector::get(m_.getContext(), unit);
    rank[p_.sides[r]] = r;
  }
  const std::vector<Value*> y = solution_for(rhs, lu, reciprocal);
  for (std::size_t i = 0; i < e.influences.size();) {
    const std::uint32_t column = e.influences[i].column;
    std::size_t end = i;
    bool all = true;  // in their order
    for (; end < e.influences.size() && e.influences[end].column == column; ++end) all = all && rank[e.influences[end].side] == end - i;
    if (all && end - i == p_.sides.size()) b_.CreateAlignedStore(y[column], address(k_.inverse + static_cast<std::int64_t>(i), false), llvm::Align(8));
    else
      for (std::size_t k = i; k < end; ++k) store(b_.CreateExtractElement(y[column], rank[e.influences[k].side]), k_.inverse + static_cast<std::int64_t>(k));
    i = end;
  }
}

// Side by side, by a function of its own: in many lanes they would be most of the code.
void Emitter::invert_sides_by_call() {
  const SparseLu& e = *k_.elimination;
  for (const std::uint32_t side : p_.sides) {
    for (const std::uint32_t other : p_.sides) store(number(other == side ? 1 : 0), k_.side + std::int64_t{other});
    b_.CreateCall(substitution_, {w_});
    for (std::size_t i = 0; i < e.influences.size(); ++i)
      if (e.influences[i].side == side) store(load(k_.solution + std::int64_t{e.influences[i].column}), k_.inverse + static_cast<std::int64_t>(i));
  }
}

void Emitter::side(std::size_t i) {
  const int c = p_.c[i];
  if (!relative_ && stage_ == 0) {
    side_.push_back(b_.CreateFMul(get(p_.roots[i], c), number(-k_.factorial[static_cast<std::size_t>(c)])));
    return;
  }
  if (p_.root_is_zero[i]) {
    side_.push_back(number(0));
    return;
  }
  if (c == 0) {
    side_.push_back(b_.CreateFNeg(get(p_.roots[i], c)));
    return;
  }
  const std::vector<double> row(k_.rising_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(c) * k_.orders),
                                k_.rising_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(c + 1) * k_.orders));
  Value* factor = b_.CreateFNeg(table(("rising" + std::to_string(c)).c_str(), row, 0));
  side_.push_back(b_.CreateFMul(get(p_.roots[i], c), factor));
}

void Emitter::sides() {
  side_.clear();
  for (std::size_t i = 0; i < p_.roots.size(); ++i) side(i);
}

void Emitter::solve() {
  if (const SparseLu& e = *k_.elimination; !e.influences.empty()) {
    solution_.assign(p_.rows, nullptr);
    for (std::size_t i = 0; i < e.influences.size(); ++i) {
      Value*& y = solution_[e.influences[i].column];
      y = fma(load(k_.inverse + static_cast<std::int64_t>(i)), side_[e.influences[i].side], y ? y : number(0));
    }
    for (const SparseLu::Own& own : e.own) {
      Value* y = nullptr;
      for (std::uint32_t i = own.first; i < own.first + own.count; ++i)
        if (Value* x = solution_[e.own_terms[i].column]) y = minus_entry(e.own_terms[i].entry, x, y);
      solution_[own.column] = y;
    }
    for (std::uint32_t j = 0; j < p_.rows; ++j)
      if (asked_[j] && !solution_[j]) solution_[j] = number(0);
    return;
  }
  side_.resize(p_.rows, nullptr);
  if (!substitution_) return substitute();
  for (std::size_t i = 0; i < p_.roots.size(); ++i) store(side_[i], k_.side + static_cast<std::int64_t>(i));
  b_.CreateCall(substitution_, {w_});
  solution_.clear();
  for (std::uint32_t j = 0; j < p_.rows; ++j) solution_.push_back(asked_[j] ? load(k_.solution + j) : nullptr);
}

// s - an entry of the linearized tape times x; by 1 and -1 it is exact without the product.
llvm::Value* Emitter::minus_entry(std::uint32_t entry, Value* x, Value* s) {
  const Entry& e = p_.entries[entry];
  const Coefficient* const c = e.from < p_.coefficients.size() ? &p_.coefficients[e.from] : nullptr;
  if (!s) s = number(0);
  if (!c || !(c->one() || c->minus_one())) return fma(b_.CreateFNeg(load(k_.entries + std::int64_t{entry})), x, s);
  return (e.sign > 0) == c->one() ? b_.CreateFSub(s, x) : b_.CreateFAdd(s, x);
}

// Forward and backward, from side_ to solution_.
void Emitter::substitute(bool all_sides) {
  const SparseLu& e = *k_.elimination;
  for (Value*& v : side_)
    if (!v) v = number(0);
  for (const SparseLu::Forward& f : all_sides ? e.forward_all : e.forward) side_[f.to] = fma(b_.CreateFNeg(load(k_.lu + f.entry)), side_[f.from], side_[f.to]);
  solution_.assign(p_.rows, nullptr);
  for (const SparseLu::Backward& back : e.backward) {
    Value* s = back.zero_side && !all_sides ? number(0) : side_[back.row];
    for (std::uint32_t i = back.first; i < back.first + back.count; ++i) s = fma(b_.CreateFNeg(load(k_.lu + e.terms[i].entry)), solution_[e.terms[i].column], s);
    solution_[back.column] = e.pivots[back.pivot].one ? s : b_.CreateFMul(s, load(k_.reciprocal + back.pivot));
  }
}

void Emitter::substitution() {
  begin("substitution");
  function_->setLinkage(llvm::Function::PrivateLinkage);
  side_.clear();
  for (std::size_t i = 0; i < p_.roots.size(); ++i) side_.push_back(load(k_.side + static_cast<std::int64_t>(i)));
  side_.resize(p_.rows, nullptr);
  std::vector<Value*> left = side_;
  substitute();
  if (k_.refine) {
    // For what the solution leaves of the sides.
    const std::vector<Value*> first = solution_;
    for (Value*& v : left)
      if (!v) v = number(0);
    for (std::size_t i = 0; i < p_.entries.size(); ++i) {
      const Entry& entry = p_.entries[i];
      left[entry.row] = fma(b_.CreateFNeg(load(k_.entries + static_cast<std::int64_t>(i))), first[entry.column], left[entry.row]);
    }
    side_ = left;
    substitute(true);
    for (std::uint32_t j = 0; j < p_.rows; ++j) solution_[j] = b_.CreateFAdd(first[j], solution_[j]);
  }
  for (std::uint32_t j = 0; j < p_.rows; ++j)
    if (asked_[j] && solution_[j]) store(solution_[j], k_.solution + j);
  end();
  substitution_ = function_;
}

void Emitter::complete() {
  const bool start = !relative_ && stage_ == 0;
  const auto falling = [&](int m) -> Value* {
    const std::vector<double> row(k_.falling_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(m) * k_.orders),
                                  k_.falling_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(m + 1) * k_.orders));
    return table(("falling" + std::to_string(m)).c_str(), row, 0);
  };
  for (std::size_t j = 0; j < p_.x.size(); ++j) {
    Value* change = p_.d[j] > 0 ? b_.CreateFMul(solution_[j], falling(p_.d[j])) : solution_[j];
    put({p_.x[j], true}, p_.d[j], start ? b_.CreateFAdd(get({p_.x[j], true}, p_.d[j]), change) : change);
  }
  for (const Completion& c : p_.completions) {
    Value* change = solution_[c.column];
    if (c.lead > 0) change = b_.CreateFMul(change, falling(c.lead));
    put(c.out, c.lead, start || !c.fresh ? b_.CreateFAdd(get(c.out, c.lead), change) : change);
  }
  for (const Step& s : p_.weigh_again) {
    if (start && s.lead == 0) continue;  // order 0 weighs nothing
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
    side_.push_back(order < 0 ? number(0) : b_.CreateFMul(load(r.at + (r.series ? order : 0)), number(-k_.factorial[static_cast<std::size_t>(order)])));
  }
  solve();
  // All are asked for: they are looked at before they are used.
  for (std::uint32_t j = 0; j < p_.x.size(); ++j) store(solution_[j], k_.solution + j);
  end(displaced(level));
}

void Emitter::advance() {
  begin("advance");
  increments();
  end();
  advance_ = function_;
}

// Alone, four orders are a vector.
std::vector<llvm::Value*> Emitter::increments() {
  const int most = p_.stages + p_.largest_d, groups = (most + kBlock - 1) / kBlock;
  const bool alone = lanes_ == 1;
  auto* four = llvm::FixedVectorType::get(b_.getDoubleTy(), kBlock);
  // weights[k]: those of the orders i = 1.., or of four orders at once.
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
      Value* factor = alone ? llvm::ConstantDataVector::get(m_.getContext(), std::vector<double>{rising(order), rising(order + 1), rising(order + 2), rising(order + 3)})
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
            x = b_.CreateMaskedLoad(four, at, llvm::Align(8), llvm::ConstantVector::get(mask), llvm::ConstantAggregateZero::get(four));
          }
          sum = fma(x, weights[static_cast<std::size_t>(k)][static_cast<std::size_t>((i - 1) / kBlock)], sum);
        }
        for (std::uint64_t r = 0; r < kBlock; ++r) s[r] = b_.CreateExtractElement(sum, r);
      } else {
        for (int i = last; i >= 1; --i) {
          Value*& sum = s[static_cast<std::size_t>((i - 1) % kBlock)];
          sum = fma(load(std::int64_t{p_.x[j]} + k + i), weights[static_cast<std::size_t>(k)][static_cast<std::size_t>(i - 1)], sum);
        }
      }
      all.push_back(b_.CreateFAdd(s[0], b_.CreateFAdd(s[1], b_.CreateFAdd(s[2], s[3]))));
      store(all.back(), k_.increments + static_cast<std::int64_t>(all.size()) - 1);
    }
  return all;
}

}  // namespace anholon::jit
