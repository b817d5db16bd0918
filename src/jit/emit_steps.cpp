// The steps of a plan: values at the point, Taylor coefficients, partial derivatives.
#include <llvm/IR/Intrinsics.h>

#include "jit/emitter.h"

namespace anholon::jit {

llvm::Value* Emitter::sum(const Step& s, std::uint32_t count) {
  Value* r = number(0);
  for (std::uint32_t k = 0; k < count; ++k) {
    const PlanTerm& t = p_.terms[s.first + k];
    Value* x = k < s.count ? get(t.x, s.lead) : number(1);
    const Coefficient& c = p_.coefficients[t.coefficient];
    // 1 x + 0 and 1 x + r are exact without the product.
    if (c.one() || c.minus_one()) r = c.one() ? b_.CreateFAdd(x, r) : b_.CreateFSub(r, x);
    else r = fma(constant(t.coefficient), x, r);
  }
  return r;
}

llvm::Value* Emitter::beyond_of_sum(const Step& s) {
  Value *r = number(0), *beyond = r;
  for (std::uint32_t k = 0; k < s.count + s.constants; ++k) {
    const PlanTerm& t = p_.terms[s.first + k];
    Value *c = load(t.coefficient), *x = k < s.count ? get(t.x, s.lead) : number(1);
    Value *product = b_.CreateFMul(c, x), *sum = b_.CreateFAdd(product, r), *part = b_.CreateFSub(sum, product), *rounded = fma(c, x, r);
    Value* of_addition = b_.CreateFAdd(b_.CreateFSub(product, b_.CreateFSub(sum, part)), b_.CreateFSub(r, part));
    beyond = b_.CreateFAdd(beyond, b_.CreateFAdd(b_.CreateFAdd(b_.CreateFSub(sum, rounded), of_addition), fma(c, x, b_.CreateFNeg(product))));
    if (k < s.count && p_.terms[s.index + k].x.at != 0) beyond = fma(c, load(p_.terms[s.index + k].x.at), beyond);
    r = rounded;
  }
  return beyond;
}

std::pair<llvm::Value*, llvm::Value*> Emitter::history(const Convolution& c) {
  if (const auto it = histories_.find(c); it != histories_.end()) return it->second;
  Value *s, *t = number(0);
  if (relative_) {
    s = sum_before(c, stage_, false);
    if (history_is_whole_) return histories_[c] = {s, sum_before(c, stage_, true)};
    for (int j = stage_; j >= 1; --j) s = fma(read(c.a, j, false), earlier(c.b, stage_ + c.lead - j), s);
    for (int j = 0; j < stage_; ++j) t = fma(earlier(c.a, c.lead + j), read(c.b, stage_ - j, false), t);
    return histories_[c] = {s, t};
  }
  const int p = stage_ + c.lead, block = stage_ > 0 ? (stage_ - 1) / kBlock * kBlock + 1 + c.lead : 0, known = std::min(block, p), i = p - known;
  s = number(0);
  const auto product = [&](int j, Value* sum) { return fma(earlier(c.a, j), earlier(c.b, p - j), sum); };
  for (int j = kBlock; j < known; ++j) s = product(j, s);
  for (int j = std::min(known, kBlock) - 1; j > i; --j) s = product(j, s);
  for (int j = i < known ? i : known - 1; j >= 1; --j) s = product(j, s);
  for (int j = std::max(known, 1); j < p; ++j) t = product(j, t);
  return histories_[c] = {s, t};
}

llvm::Value* Emitter::convolution(std::uint32_t a, std::uint32_t b, std::uint8_t lead, bool first, bool last, bool b_later) {
  const auto [old, new_of_a] = history({a, b, lead});
  Value* s = b_.CreateFAdd(old, new_of_a);
  if (first && !b_later) s = fma(read(a, 0, false), newest(b, lead), s);
  if (last) s = fma(newest(a, lead), read(b, 0, false), s);
  if (first && b_later) s = fma(read(a, 0, false), newest(b, lead), s);
  return s;
}

void Emitter::coefficient(const Step& s) {
  const std::uint8_t l = s.lead;
  switch (s.act) {
    case Act::input: {
      const auto key = "rising" + std::to_string(s.index);
      const std::vector<double> row(k_.rising_.begin() + static_cast<std::ptrdiff_t>(s.index * k_.orders), k_.rising_.begin() + static_cast<std::ptrdiff_t>((s.index + 1) * k_.orders));
      Value* x = earlier(s.a.at, stage_ + l + static_cast<int>(s.index));
      put(s.out, l, b_.CreateFMul(x, table(key.c_str(), row, l)));
      break;
    }
    case Act::linear: put(s.out, l, sum(s, s.count)); break;
    case Act::beyond: break;
    case Act::multiply: put(s.out, l, convolution(s.a.at, s.b.at, l, !s.b_unknown, !s.a_unknown, s.b_later)); break;
    case Act::square: put(s.out, l, convolution(s.a.at, s.a.at, l, !s.a_unknown, !s.a_unknown)); break;
    case Act::divide: {
      Value* r = b_.CreateFNeg(convolution(s.b.at, s.out.at, l, false, !s.b_unknown));
      if (!s.a_constant && !s.a_unknown) r = b_.CreateFAdd(r, get(s.a, l));
      put(s.out, l, b_.CreateFMul(r, constant(s.c.at)));
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
      r = b_.CreateFMul(b_.CreateFMul(r, table("reciprocal", k_.reciprocal_of, l)), constant(s.b.at));
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
  Value* a = s.act == Act::linear || s.act == Act::beyond || s.act == Act::sine_cosine ? nullptr : get(s.a, l);
  switch (s.act) {
    case Act::input: put(s.out, l, b_.CreateFMul(load(s.a.at + s.index), number(k_.factorial[s.index]))); break;
    case Act::linear: put(s.out, l, sum(s, s.count + s.constants)); break;
    case Act::beyond: put(s.out, l, beyond_of_sum(s)); break;
    case Act::multiply: put(s.out, l, b_.CreateFMul(a, get(s.b, l))); break;
    case Act::square: put(s.out, l, b_.CreateFMul(a, a)); break;
    case Act::divide: {
      Value* r = b_.CreateFDiv(number(1), get(s.b, l));
      store(r, s.c.at);
      known_[{s.c.at, kNoOrder}] = r;
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
      Value* beyond = s.d.at != 0 ? address(s.d.at, false) : llvm::ConstantPointerNull::get(b_.getPtrTy());
      call_scalar("anholon_sines", {address(s.a.at, false), beyond, address(s.out.at, false), address(s.c.at, false)}, b_.getVoidTy());
      known_.erase({s.out.at, 0});
      known_.erase({s.c.at, 0});
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

}  // namespace anholon::jit
