// The steps of a plan: Taylor coefficients.

#include "jit/emitter.h"

namespace anholon::jit {

llvm::Value* Emitter::sum(const Step& s, std::uint32_t count) {
  Value* r = number(0);
  for (std::uint32_t k = 0; k < count; ++k) {
    const PlanTerm& t = p_.terms[s.first + k];
    Value* x = k < s.count ? get(t.x, s.lead) : number(1);
    const Coefficient& c = p_.coefficients[t.coefficient];
    // 1 x + 0 and 1 x + r are exact without the product.
    if (c.one() || c.minus_one())
      r = c.one() ? b_.CreateFAdd(x, r) : b_.CreateFSub(r, x);
    else
      r = fma(constant(t.coefficient), x, r);
  }
  return r;
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
  const int p = stage_ + c.lead, block = stage_ > 0 ? (stage_ - 1) / kBlock * kBlock + 1 + c.lead : 0,
            known = std::min(block, p), i = p - known;
  s = number(0);
  const auto product = [&](int j, Value* sum) { return fma(earlier(c.a, j), earlier(c.b, p - j), sum); };
  for (int j = kBlock; j < known; ++j) s = product(j, s);
  for (int j = std::min(known, kBlock) - 1; j > i; --j) s = product(j, s);
  for (int j = i < known ? i : known - 1; j >= 1; --j) s = product(j, s);
  for (int j = std::max(known, 1); j < p; ++j) t = product(j, t);
  return histories_[c] = {s, t};
}

llvm::Value* Emitter::whole_history(std::uint32_t a, std::uint32_t b, std::uint8_t lead) {
  const auto [old, new_of_a] = history({a, b, lead});
  return b_.CreateFAdd(old, new_of_a);
}

llvm::Value* Emitter::convolution(std::uint32_t a, std::uint32_t b, std::uint8_t lead, bool first, bool last,
                                  bool b_later) {
  Value* s = whole_history(a, b, lead);
  if (first && !b_later) s = fma(read(a, 0, false), newest(b, lead), s);
  if (last) s = fma(newest(a, lead), read(b, 0, false), s);
  if (first && b_later) s = fma(read(a, 0, false), newest(b, lead), s);
  return s;
}

// Emits u_0 w_p = (r sum (j u_j) w_(p-j) - sum (j w_j) u_(p-j)) / p + r u_p w_0, j = 1..p - 1.
void Emitter::coefficient_of_power(const Step& s) {
  const std::uint8_t l = s.lead;
  Value* r = fma(number(s.value), whole_history(s.c.at, s.out.at, l), b_.CreateFNeg(whole_history(s.d.at, s.a.at, l)));
  r = b_.CreateFMul(over_order(r, l), constant(s.b.at));
  if (!s.a_unknown) r = fma(get(s.a, l), constant(s.e.at), r);
  put(s.out, l, r);
  put(s.d, l, b_.CreateFMul(r, order(l)));
}

void Emitter::coefficient_of_sine_cosine(const Step& s) {
  const std::uint8_t l = s.lead;
  Value *sine = over_order(whole_history(s.b.at, s.c.at, l), l),
        *cosine = over_order(whole_history(s.b.at, s.out.at, l), l);
  if (!s.a_unknown) {
    sine = fma(get(s.a, l), read(s.c.at, 0, false), sine);
    cosine = fma(get(s.a, l), read(s.out.at, 0, false), cosine);
  }
  put(s.out, l, sine);
  put(s.c, l, b_.CreateFNeg(cosine));
}

// Emits w' = f'(u) u'.
void Emitter::coefficient_of_function(const Step& s) {
  const std::uint8_t l = s.lead;
  if (s.b_constant) {
    put(s.out, l, s.a_unknown ? number(0) : b_.CreateFMul(load(s.b.at), get(s.a, l)));
    return;
  }
  Value* r = over_order(whole_history(s.c.at, s.b.at, l), l);
  put(s.out, l, s.a_unknown ? r : fma(get(s.a, l), read(s.b.at, 0, false), r));
}

void Emitter::coefficient_of_arctan2(const Step& s) {
  const std::uint8_t l = s.lead;
  Value* r = number(0);
  if (!s.a_constant) r = b_.CreateFAdd(r, whole_history(s.e.at, s.c.at, l));
  if (!s.b_constant) r = b_.CreateFAdd(r, whole_history(s.f.at, s.d.at, l));
  r = over_order(r, l);
  if (!s.a_constant && !s.a_unknown) r = fma(get(s.a, l), read(s.c.at, 0, false), r);
  if (!s.b_constant && !s.b_unknown) r = fma(get(s.b, l), read(s.d.at, 0, false), r);
  put(s.out, l, r);
}

void Emitter::coefficient(const Step& s) {
  const std::uint8_t l = s.lead;
  switch (s.act) {
  case Act::input: {
    Value* x = earlier(s.a.at, stage_ + l + static_cast<int>(s.index));
    put(s.out, l, b_.CreateFMul(x, rising(static_cast<int>(s.index), l)));
    break;
  }
  case Act::linear:
    put(s.out, l, sum(s, s.count));
    break;
  case Act::beyond:
    break;
  case Act::multiply:
    put(s.out, l, convolution(s.a.at, s.b.at, l, !s.b_unknown, !s.a_unknown, s.b_later));
    break;
  case Act::square:
    put(s.out, l, convolution(s.a.at, s.a.at, l, !s.a_unknown, !s.a_unknown));
    break;
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
  case Act::power:
    coefficient_of_power(s);
    break;
  case Act::sine_cosine:
    coefficient_of_sine_cosine(s);
    break;
  case Act::function:
    coefficient_of_function(s);
    break;
  case Act::arctan2:
    coefficient_of_arctan2(s);
    break;
  case Act::weigh:
    put(s.out, l, b_.CreateFMul(get(s.a, l), order(l)));
    break;
  case Act::select: {
    Value* negative = b_.CreateFCmpOLT(load(s.c.at), number(0));
    put(s.out, l,
        b_.CreateSelect(negative, s.b_constant ? number(0) : get(s.b, l), s.a_constant ? number(0) : get(s.a, l)));
    break;
  }
  case Act::lookup:
    put(s.out, l, number(0));
    break;
  }
}

}  // namespace anholon::jit
