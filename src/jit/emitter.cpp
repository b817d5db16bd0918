#include "jit/emitter.h"

#include <llvm/IR/Intrinsics.h>

#include <algorithm>

namespace anholon::jit {

namespace {
// Convolutions summed side by side: enough to hide the latency of a fused multiplication, few enough for the registers.
constexpr std::size_t kSideBySide = 8;
// The same where four orders of a convolution are four sums of lanes.
constexpr std::size_t kSideBySideInLanes = 3;
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
  if (k_.elimination->work() > kLongElimination) substitution();
  values();
  factor();
  lead();
  extend();
  advance();
  for (int l = 1; l <= levels(k_); ++l) level(l);
}

void Emitter::begin(const char* name) {
  auto* type = llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy()}, false);
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
  k0_ = function_->getArg(2);
  b_.SetInsertPoint(llvm::BasicBlock::Create(m_.getContext(), "entry", function_));
  block_ = b_.CreateInBoundsGEP(lane_, w_, k0_);
  known_.clear();
  return function_;
}

void Emitter::end() { b_.CreateRetVoid(); }

llvm::Value* Emitter::address(std::int64_t slot, bool relative) {
  return b_.CreateConstInBoundsGEP1_64(lane_, relative ? block_ : w_, static_cast<std::uint64_t>(slot));
}

llvm::Value* Emitter::get(const Place& place, int lead) {
  const auto key = std::make_pair(place.at, place.series ? lead : -1000);
  if (const auto it = known_.find(key); it != known_.end()) return it->second;
  Value* v = !place.series ? load(place.at) : relative_ ? load(std::int64_t{place.at} + i_ + lead, true) : load(std::int64_t{place.at} + stage_ + lead);
  return known_[key] = v;
}

void Emitter::put(const Place& place, int lead, Value* v) {
  known_[{place.at, place.series ? lead : -1000}] = v;
  if (!place.series) {
    // Beyond stage 0 nobody asks for it again.
    if (!relative_ && stage_ <= 0) store(v, place.at);
    return;
  }
  if (relative_) store(v, std::int64_t{place.at} + i_ + lead, true);
  else store(v, std::int64_t{place.at} + stage_ + lead);
}

llvm::Value* Emitter::table(const char* name, const std::vector<double>& row, int offset) {
  if (!relative_) return number(row[static_cast<std::size_t>(stage_ + offset)]);
  llvm::GlobalVariable*& t = tables_[name];
  if (!t) {
    llvm::Constant* data = llvm::ConstantDataArray::get(m_.getContext(), llvm::ArrayRef<double>(row));
    t = new llvm::GlobalVariable(m_, data->getType(), true, llvm::GlobalValue::PrivateLinkage, data, name);
  }
  Value* at = b_.CreateInBoundsGEP(b_.getDoubleTy(), t, k0_);
  at = b_.CreateConstGEP1_64(b_.getDoubleTy(), at, static_cast<std::uint64_t>(static_cast<std::int64_t>(i_ + offset)));
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

llvm::Value* Emitter::sum(const Step& s, std::uint32_t count) {
  Value* r = number(0);
  for (std::uint32_t k = 0; k < count; ++k) {
    const PlanTerm& t = p_.terms[s.first + k];
    Value* x = k < s.count ? get(t.x, s.lead) : number(1);
    const Coefficient& c = p_.coefficients[t.coefficient];
    // 1 x + 0 and 1 x + r are exact without the product.
    if (c.one() || c.minus_one()) r = c.one() ? b_.CreateFAdd(x, r) : b_.CreateFSub(r, x);
    else r = fma(load(t.coefficient), x, r);
  }
  return r;
}

llvm::Value* Emitter::convolution(std::uint32_t a, std::uint32_t b, std::uint8_t lead, bool first, bool last) {
  Value *s, *t = number(0);
  if (relative_) {
    s = b_.CreateAlignedLoad(lane_, scratch(bulk_.at({a, b, lead}), static_cast<unsigned>(i_)), align());
    const auto recent = [&](std::uint32_t x, int m) { return m == i_ ? newest(x, lead) : load(std::int64_t{x} + lead + m, true); };
    for (int j = i_; j >= 1; --j) s = fma(load(a + j), recent(b, i_ - j), s);
    if (first) s = fma(load(a), newest(b, lead), s);
    for (int m = 0; m < i_; ++m) t = fma(recent(a, m), load(b + i_ - m), t);
    if (last) t = fma(newest(a, lead), load(b), t);
    return b_.CreateFAdd(s, t);
  }
  const std::int64_t p = stage_ + lead, block = stage_ > 0 ? (stage_ - 1) / kBlock * kBlock + 1 + lead : 0, known = std::min(block, p), i = p - known;
  const auto at = [&](std::uint32_t x, std::int64_t order) { return order == p ? newest(x, lead) : load(x + order); };
  s = number(0);
  for (std::int64_t j = i + 1; j < known; ++j) s = fma(at(a, j), at(b, p - j), s);
  for (std::int64_t j = i < known ? i : known - 1; j >= 1; --j) s = fma(at(a, j), at(b, p - j), s);
  if (first) s = fma(at(a, 0), at(b, p), s);
  for (std::int64_t j = known > 1 ? known : 1; j < p; ++j) t = fma(at(a, j), at(b, p - j), t);
  if (last) t = fma(at(a, p), at(b, 0), t);
  return b_.CreateFAdd(s, t);
}

std::vector<Emitter::Convolution> Emitter::convolutions(const Step& s) {
  switch (s.act) {
    case Act::multiply: return {{s.a.at, s.b.at, s.lead}};
    case Act::square: return {{s.a.at, s.a.at, s.lead}};
    case Act::divide: return {{s.b.at, s.out.at, s.lead}};
    case Act::square_root: return {{s.out.at, s.out.at, s.lead}};
    case Act::power: return {{s.c.at, s.out.at, s.lead}, {s.d.at, s.a.at, s.lead}};
    case Act::sine_cosine: return {{s.b.at, s.c.at, s.lead}, {s.b.at, s.out.at, s.lead}};
    case Act::function: if (s.b_constant) return {}; return {{s.c.at, s.b.at, s.lead}};
    case Act::arctan2: {
      std::vector<Convolution> r;
      if (!s.a_constant) r.push_back({s.e.at, s.c.at, s.lead});
      if (!s.b_constant) r.push_back({s.f.at, s.d.at, s.lead});
      return r;
    }
    case Act::input: case Act::linear: case Act::weigh: case Act::select: case Act::lookup: return {};
  }
  return {};
}

void Emitter::coefficient(const Step& s) {
  const std::uint8_t l = s.lead;
  switch (s.act) {
    case Act::input: {
      const auto key = "rising" + std::to_string(s.index);
      const std::vector<double> row(k_.rising_.begin() + static_cast<std::ptrdiff_t>(s.index * k_.orders), k_.rising_.begin() + static_cast<std::ptrdiff_t>((s.index + 1) * k_.orders));
      Value* x = relative_ ? load(std::int64_t{s.a.at} + i_ + l + s.index, true) : load(std::int64_t{s.a.at} + stage_ + l + s.index);
      put(s.out, l, b_.CreateFMul(x, table(key.c_str(), row, l)));
      break;
    }
    case Act::linear: put(s.out, l, sum(s, s.count)); break;
    case Act::multiply: put(s.out, l, convolution(s.a.at, s.b.at, l, !s.b_unknown, !s.a_unknown)); break;
    case Act::square: put(s.out, l, convolution(s.a.at, s.a.at, l, !s.a_unknown, !s.a_unknown)); break;
    case Act::divide: {
      Value* r = b_.CreateFNeg(convolution(s.b.at, s.out.at, l, false, !s.b_unknown));
      if (!s.a_constant && !s.a_unknown) r = b_.CreateFAdd(r, get(s.a, l));
      put(s.out, l, b_.CreateFMul(r, load(s.c.at)));
      break;
    }
    case Act::square_root: {
      Value* r = b_.CreateFNeg(convolution(s.out.at, s.out.at, l, false, false));
      if (!s.a_unknown) r = b_.CreateFAdd(r, get(s.a, l));
      put(s.out, l, b_.CreateFMul(r, b_.CreateFDiv(number(0.5), load(s.out.at))));
      break;
    }
    case Act::power: {
      Value* r = b_.CreateFMul(number(s.value), convolution(s.c.at, s.out.at, l, false, !s.a_unknown));
      r = b_.CreateFSub(r, convolution(s.d.at, s.a.at, l, false, false));
      r = b_.CreateFMul(b_.CreateFMul(r, table("reciprocal", k_.reciprocal_of, l)), load(s.b.at));
      put(s.out, l, r);
      put(s.d, l, b_.CreateFMul(r, table("order", k_.order, l)));
      break;
    }
    case Act::sine_cosine: {
      Value* r = table("reciprocal", k_.reciprocal_of, l);
      Value* sine = b_.CreateFMul(convolution(s.b.at, s.c.at, l, false, !s.a_unknown), r);
      Value* cosine = b_.CreateFMul(convolution(s.b.at, s.out.at, l, false, !s.a_unknown), r);
      put(s.out, l, sine);
      put(s.c, l, b_.CreateFNeg(cosine));
      break;
    }
    case Act::function:
      if (s.b_constant) put(s.out, l, s.a_unknown ? number(0) : b_.CreateFMul(load(s.b.at), get(s.a, l)));
      else put(s.out, l, b_.CreateFMul(convolution(s.c.at, s.b.at, l, false, !s.a_unknown), table("reciprocal", k_.reciprocal_of, l)));
      break;
    case Act::arctan2: {
      Value* r = number(0);
      if (!s.a_constant) r = b_.CreateFAdd(r, convolution(s.e.at, s.c.at, l, false, !s.a_unknown));
      if (!s.b_constant) r = b_.CreateFAdd(r, convolution(s.f.at, s.d.at, l, false, !s.b_unknown));
      put(s.out, l, b_.CreateFMul(r, table("reciprocal", k_.reciprocal_of, l)));
      break;
    }
    case Act::weigh: put(s.out, l, b_.CreateFMul(get(s.a, l), table("order", k_.order, l))); break;
    case Act::select: {
      Value* negative = b_.CreateFCmpOLT(load(s.c.at), number(0));
      put(s.out, l, b_.CreateSelect(negative, s.b_constant ? number(0) : get(s.b, l), s.a_constant ? number(0) : get(s.a, l)));
      break;
    }
    case Act::lookup: put(s.out, l, number(0)); break;
  }
}

void Emitter::value(const Step& s) {
  const std::uint8_t l = s.lead;
  Value* a = s.act == Act::linear ? nullptr : get(s.a, l);
  switch (s.act) {
    case Act::input: put(s.out, l, b_.CreateFMul(load(s.a.at + s.index), number(k_.factorial[s.index]))); break;
    case Act::linear: put(s.out, l, sum(s, s.count + s.constants)); break;
    case Act::multiply: put(s.out, l, b_.CreateFMul(a, get(s.b, l))); break;
    case Act::square: put(s.out, l, b_.CreateFMul(a, a)); break;
    case Act::divide: {
      Value* r = b_.CreateFDiv(number(1), get(s.b, l));
      store(r, s.c.at);
      known_[{s.c.at, -1000}] = r;
      put(s.out, l, b_.CreateFMul(a, r));
      break;
    }
    case Act::square_root: put(s.out, l, b_.CreateIntrinsic(llvm::Intrinsic::sqrt, {lane_}, {a})); break;
    case Act::power:
      put(s.out, l, call("anholon_power", {a, llvm::ConstantFP::get(b_.getDoubleTy(), s.value)}));
      store(b_.CreateFDiv(number(1), a), s.b.at);
      put(s.d, l, number(0));
      break;
    case Act::sine_cosine: {
      Value *sine = address(s.out.at, false), *cosine = address(s.c.at, false);
      for (int lane = 0; lane < lanes_; ++lane) {
        const auto at = [&](Value* all) { return b_.CreateConstInBoundsGEP1_64(b_.getDoubleTy(), all, static_cast<std::uint64_t>(lane)); };
        call_scalar("anholon_sincos", {of_lane(a, lane), at(sine), at(cosine)}, b_.getVoidTy());
      }
      known_.erase({s.out.at, l});
      known_.erase({s.c.at, l});
      break;
    }
    case Act::function: put(s.out, l, call("anholon_function", {b_.getInt32(s.index), a})); break;
    case Act::arctan2: put(s.out, l, call("atan2", {a, get(s.b, l)})); break;
    case Act::weigh: put(s.out, l, number(0)); break;
    case Act::select: {
      Value* negative = b_.CreateFCmpOLT(load(s.c.at), number(0));
      put(s.out, l, b_.CreateSelect(negative, get(s.b, l), get(s.a, l)));
      break;
    }
    case Act::lookup: break;  // refused before
  }
}

void Emitter::partial(const Partial& d) {
  using K = Partial::Kind;
  Value* a = load(d.a);
  Value* r = nullptr;
  switch (d.kind) {
    case K::twice: r = b_.CreateFAdd(a, a); break;
    case K::half_reciprocal: r = b_.CreateFDiv(number(0.5), a); break;
    case K::quotient: r = b_.CreateFMul(a, load(d.b)); break;
    case K::power: r = b_.CreateFDiv(b_.CreateFMul(number(d.value), a), load(d.b)); break;
    case K::chosen: r = b_.CreateSelect(b_.CreateFCmpOLT(a, number(0)), number(0), number(1)); break;
    case K::not_chosen: r = b_.CreateSelect(b_.CreateFCmpOLT(a, number(0)), number(1), number(0)); break;
  }
  store(r, d.out);
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
  end();
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
  side_.resize(p_.rows, nullptr);
  if (!substitution_) return substitute();
  for (std::size_t i = 0; i < p_.roots.size(); ++i) store(side_[i], k_.side + static_cast<std::int64_t>(i));
  b_.CreateCall(substitution_, {w_});
  solution_.clear();
  for (std::uint32_t j = 0; j < p_.rows; ++j) solution_.push_back(asked_[j] ? load(k_.solution + j) : nullptr);
}

// Forward and backward, from side_ to solution_.
void Emitter::substitute() {
  const SparseLu& e = *k_.elimination;
  for (Value*& v : side_)
    if (!v) v = number(0);
  for (const SparseLu::Forward& f : e.forward) side_[f.to] = fma(b_.CreateFNeg(load(k_.lu + f.entry)), side_[f.from], side_[f.to]);
  solution_.assign(p_.rows, nullptr);
  for (const SparseLu::Backward& back : e.backward) {
    Value* s = back.zero_side ? number(0) : side_[back.row];
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
  substitute();
  for (std::uint32_t j = 0; j < p_.rows; ++j)
    if (asked_[j]) store(solution_[j], k_.solution + j);
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
    Value* change = b_.CreateFMul(solution_[j], falling(p_.d[j]));
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
  begin(level_name(level).c_str());
  side_.clear();
  for (std::size_t i = 0; i < p_.roots.size(); ++i) {
    const int order = p_.c[i] - level;
    const Place r = p_.roots[i];
    side_.push_back(order < 0 ? number(0) : b_.CreateFMul(load(r.at + (r.series ? order : 0)), number(-k_.factorial[static_cast<std::size_t>(order)])));
  }
  solve();
  // All are asked for: they are looked at before they are used.
  for (std::uint32_t j = 0; j < p_.x.size(); ++j) store(solution_[j], k_.solution + j);
  end();
}

void Emitter::advance() {
  begin("advance");
  Value* step = load(k_.step);
  std::int64_t out = k_.increments;
  for (std::size_t j = 0; j < p_.x.size(); ++j)
    for (int k = 0; k <= p_.d[j]; ++k) {
      Value* s = number(0);
      for (int i = p_.stages + p_.d[j] - k; i >= 1; --i) {
        Value* x = load(std::int64_t{p_.x[j]} + k + i);
        const double rising = k_.rising(k, i);
        s = b_.CreateFMul(rising == 1 ? b_.CreateFAdd(x, s) : fma(x, number(rising), s), step);
      }
      store(s, out++);
    }
  end();
}

void Emitter::stage(const std::vector<Step>& steps, bool solved) {
  known_.clear();
  for (const Step& s : steps) coefficient(s);
  if (!solved) return;
  sides();
  solve();
  complete();
}

std::vector<llvm::Value*> Emitter::over_known(std::uint8_t lead, const std::vector<Value*>& sums, const std::function<std::vector<Value*>(Value*, const std::vector<Value*>&)>& body) {
  // A block begins at stage 5 or later, so there is at least one.
  llvm::BasicBlock* before = b_.GetInsertBlock();
  auto* loop = llvm::BasicBlock::Create(m_.getContext(), "known", function_);
  auto* after = llvm::BasicBlock::Create(m_.getContext(), "new", function_);
  Value* last = b_.CreateAdd(k0_, b_.getInt64(lead));
  b_.CreateBr(loop);
  b_.SetInsertPoint(loop);
  llvm::PHINode* j = b_.CreatePHI(b_.getInt64Ty(), 2);
  j->addIncoming(b_.getInt64(kBlock), before);
  std::vector<llvm::PHINode*> running;
  for (Value* s : sums) {
    running.push_back(b_.CreatePHI(s->getType(), 2));
    running.back()->addIncoming(s, before);
  }
  const std::vector<Value*> next_sums = body(j, {running.begin(), running.end()});
  for (std::size_t k = 0; k < sums.size(); ++k) running[k]->addIncoming(next_sums[k], loop);
  Value* next = b_.CreateAdd(j, b_.getInt64(1));
  j->addIncoming(next, loop);
  b_.CreateCondBr(b_.CreateICmpSLT(next, last), loop, after);
  b_.SetInsertPoint(after);
  return next_sums;
}

// For the four orders of a block at once: sum over j of a_j b_(p-j) with both known before the block.
void Emitter::known_before(const Convolution* group, std::size_t count) {
  auto* four = llvm::FixedVectorType::get(b_.getDoubleTy(), kBlock);
  const std::uint8_t l = group[0].lead;
  Value* zero = llvm::ConstantAggregateZero::get(four);
  std::vector<Value*> sums(count, zero);
  const auto b_at = [&](std::uint32_t b, Value* j) {  // b_(K-j) .. b_(K-j+3), K = k0 + lead
    Value* base = b_.CreateInBoundsGEP(b_.getDoubleTy(), address(std::int64_t{b} + l, true), b_.CreateNeg(j));
    return b_.CreateAlignedLoad(four, base, llvm::Align(8));
  };
  const auto a_at = [&](std::uint32_t a, Value* j) {
    Value* at = b_.CreateInBoundsGEP(b_.getDoubleTy(), address(a, false), j);
    return b_.CreateVectorSplat(kBlock, b_.CreateAlignedLoad(b_.getDoubleTy(), at, llvm::Align(8)));
  };
  // The nearest ones: only the first j orders of the block have both.
  for (int j = 1; j < kBlock; ++j)
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<int> mask;
      for (int lane = 0; lane < kBlock; ++lane) mask.push_back(lane < j ? lane : kBlock + lane);
      Value* b = b_.CreateShuffleVector(b_at(group[k].b, b_.getInt64(static_cast<std::uint64_t>(j))), zero, mask);
      sums[k] = fma(a_at(group[k].a, b_.getInt64(static_cast<std::uint64_t>(j))), b, sums[k]);
    }
  sums = over_known(l, sums, [&](Value* j, const std::vector<Value*>& so_far) {
    std::vector<Value*> r;
    for (std::size_t k = 0; k < count; ++k) r.push_back(fma(a_at(group[k].a, j), b_at(group[k].b, j), so_far[k]));
    return r;
  });
  for (std::size_t k = 0; k < count; ++k) b_.CreateAlignedStore(sums[k], scratch(bulk_.at(group[k]), 0), llvm::Align(32));
}

// The same where every order is a vector of lanes: b_(K-j) .. b_(K-j+3) move on by one with j.
void Emitter::known_before_in_lanes(const Convolution* group, std::size_t count) {
  const std::uint8_t l = group[0].lead;
  constexpr std::size_t n = kBlock;
  std::vector<Value*> sums(count * n, number(0));
  const auto b_at = [&](std::uint32_t b, Value* j, int i) {
    return b_.CreateAlignedLoad(lane_, b_.CreateInBoundsGEP(lane_, address(std::int64_t{b} + l + i, true), b_.CreateNeg(j)), align());
  };
  const auto a_at = [&](std::uint32_t a, Value* j) { return b_.CreateAlignedLoad(lane_, b_.CreateInBoundsGEP(lane_, address(a, false), j), align()); };
  for (int j = 1; j < kBlock; ++j)
    for (std::size_t k = 0; k < count; ++k) {
      Value* at = b_.getInt64(static_cast<std::uint64_t>(j));
      Value* a = a_at(group[k].a, at);
      for (int i = 0; i < j; ++i) sums[k * n + static_cast<std::size_t>(i)] = fma(a, b_at(group[k].b, at, i), sums[k * n + static_cast<std::size_t>(i)]);
    }
  // After the sums: b of the orders 0 .. 2 of the block for the present j.
  for (std::size_t k = 0; k < count; ++k)
    for (int i = 0; i + 1 < kBlock; ++i) sums.push_back(b_at(group[k].b, b_.getInt64(kBlock), i + 1));
  sums = over_known(l, sums, [&](Value* j, const std::vector<Value*>& so_far) {
    std::vector<Value*> r(so_far.size(), nullptr);
    for (std::size_t k = 0; k < count; ++k) {
      Value* a = a_at(group[k].a, j);
      Value* const* window = &so_far[count * n + k * (n - 1)];
      Value* newest = b_at(group[k].b, j, 0);
      for (std::size_t i = 0; i < n; ++i) r[k * n + i] = fma(a, i == 0 ? newest : window[i - 1], so_far[k * n + i]);
      for (std::size_t i = 0; i + 1 < n; ++i) r[count * n + k * (n - 1) + i] = i == 0 ? newest : window[i - 1];
    }
    return r;
  });
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = 0; i < n; ++i) b_.CreateAlignedStore(sums[k * n + i], scratch(bulk_.at(group[k]), static_cast<unsigned>(i)), align());
}

void Emitter::bulk() {
  std::vector<Convolution> all;
  for (const auto& [c, place] : bulk_) all.push_back(c);
  for (std::size_t from = 0; from < all.size();) {
    std::size_t to = from + 1;
    while (to < all.size() && to - from < (lanes_ == 1 ? kSideBySide : kSideBySideInLanes) && all[to].lead == all[from].lead) ++to;
    if (lanes_ == 1) known_before(&all[from], to - from);
    else known_before_in_lanes(&all[from], to - from);
    from = to;
  }
}

// Each stage is a function of its own.
void Emitter::stages(const std::vector<Step>& steps, bool solved) {
  const int last = p_.stages;
  llvm::Function* const whole = function_;
  Value* const arena = w_;
  const std::string list = solved ? "stage" : "after";
  const auto back = b_.saveIP();

  std::vector<llvm::Function*> first, later;
  relative_ = false;
  for (stage_ = 1; stage_ <= std::min(last, kBlock); ++stage_) {
    first.push_back(begin_part(list + std::to_string(stage_)));
    stage(steps, solved);
    end();
  }
  bulk_.clear();
  llvm::Function* before_block = nullptr;
  if (last > kBlock) {
    for (const Step& s : steps)
      for (const Convolution& c : convolutions(s)) bulk_.try_emplace(c, 0U);
    unsigned place = 0;
    for (auto& [c, where] : bulk_) where = place++;
    before_block = begin_part(list + "_known");
    bulk();
    end();
    relative_ = true;
    for (i_ = 0; i_ < kBlock; ++i_) {
      later.push_back(begin_part(list + "_later" + std::to_string(i_)));
      stage(steps, solved);
      end();
    }
    relative_ = false;
  }

  function_ = whole;
  w_ = arena;
  b_.restoreIP(back);
  known_.clear();
  Value* scratch = nullptr;
  {
    llvm::BasicBlock& entry = function_->getEntryBlock();
    llvm::IRBuilder<> top(&entry, entry.begin());
    auto* memory = top.CreateAlloca(lane_, top.getInt32(static_cast<std::uint32_t>(kBlock * (bulk_.size() + 1))));
    memory->setAlignment(llvm::Align(64));
    scratch = memory;
  }
  for (llvm::Function* f : first) b_.CreateCall(f, {w_, scratch, b_.getInt64(1)});
  if (!before_block) return;
  llvm::BasicBlock* before = b_.GetInsertBlock();
  auto* loop = llvm::BasicBlock::Create(m_.getContext(), "block", function_);
  auto* done = llvm::BasicBlock::Create(m_.getContext(), "done", function_);
  b_.CreateBr(loop);
  b_.SetInsertPoint(loop);
  llvm::PHINode* k0 = b_.CreatePHI(b_.getInt64Ty(), 2);
  k0->addIncoming(b_.getInt64(kBlock + 1), before);
  b_.CreateCall(before_block, {w_, scratch, k0});
  for (int i = 0; i < kBlock; ++i) {
    if (i > 0) {
      auto* next = llvm::BasicBlock::Create(m_.getContext(), "stage", function_);
      b_.CreateCondBr(b_.CreateICmpSLE(b_.CreateAdd(k0, b_.getInt64(static_cast<std::uint64_t>(i))), b_.getInt64(static_cast<std::uint64_t>(last))), next, done);
      b_.SetInsertPoint(next);
    }
    b_.CreateCall(later[static_cast<std::size_t>(i)], {w_, scratch, k0});
  }
  Value* next = b_.CreateAdd(k0, b_.getInt64(kBlock));
  k0->addIncoming(next, b_.GetInsertBlock());
  b_.CreateCondBr(b_.CreateICmpSLE(next, b_.getInt64(static_cast<std::uint64_t>(last))), loop, done);
  b_.SetInsertPoint(done);
}

void Emitter::extend() {
  begin("extend");
  stages(p_.stage, true);
  if (!p_.after.empty()) {
    stage_ = 0;
    known_.clear();
    for (const Step& s : p_.after) value(s);
    stages(p_.after, false);
  }
  end();
}

}  // namespace anholon::jit
