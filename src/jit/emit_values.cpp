// Code for the values at the point of an expansion: values, partial derivatives, coefficients without unknowns.
#include <set>

#include <llvm/IR/Intrinsics.h>

#include "jit/emitter.h"

namespace anholon::jit {

void Emitter::values() {
  begin("values");
  for (stage_ = -p_.largest_lead; stage_ <= 0; ++stage_) {
    forget();
    values_of_stage();
  }
  for (const Partial& d : p_.partials) partial(d);
  end();
}

// Sines are delayed until nothing else can be computed without them; then several are computed at once.
void Emitter::values_of_stage() {
  std::vector<const Step*> left;
  for (const Step& s : p_.point)
    if (stage_ + s.lead >= 0) left.push_back(&s);
  while (!left.empty()) {
    std::vector<const Step*> sines, later;
    std::set<std::uint32_t> missing;
    const auto waits = [&](const Step& s) {
      for (const Place& x : {s.a, s.b, s.c, s.d, s.e, s.f})
        if (missing.count(x.at)) return true;
      const std::uint32_t count = s.count + (s.act == Act::beyond ? 0 : s.constants);
      for (std::uint32_t k = 0; k < count; ++k)
        if (missing.count(p_.terms[s.first + k].x.at) ||
            (s.act == Act::beyond && missing.count(p_.terms[s.index + k].x.at)))
          return true;
      return false;
    };
    for (const Step* s : left) {
      const bool waiting = waits(*s), sine = s->act == Act::sine_cosine && stage_ + s->lead == 0 && lanes_ == 1;
      if (!waiting && !sine) {
        stage_ + s->lead == 0 ? value(*s) : coefficient(*s);
        continue;
      }
      (waiting ? later : sines).push_back(s);
      missing.insert(s->out.at);
      if (s->act == Act::sine_cosine || s->act == Act::divide) missing.insert(s->c.at);
      if (s->act == Act::power) missing.insert({s->b.at, s->d.at, s->e.at});
    }
    several_sines(sines);
    left = std::move(later);
  }
}

void Emitter::several_sines(const std::vector<const Step*>& steps) {
  constexpr std::size_t kFew = 1;
  const std::size_t most = static_cast<std::size_t>(several_sines_);
  for (std::size_t from = 0; from < steps.size(); from += most) {
    const std::size_t count = std::min(most, steps.size() - from);
    if (count <= kFew) {
      for (std::size_t i = from; i < from + count; ++i) value(*steps[i]);
      continue;
    }
    // Angles, their parts beyond their doubles, sines, cosines.
    if (!sines_) {
      llvm::IRBuilder<> top(&function_->getEntryBlock(), function_->getEntryBlock().begin());
      auto* memory = top.CreateAlloca(lane_, top.getInt32(static_cast<std::uint32_t>(4 * most)));
      memory->setAlignment(llvm::Align(64));
      sines_ = memory;
    }
    const auto row = [&](std::size_t r) { return b_.CreateConstInBoundsGEP1_64(lane_, sines_, r * most); };
    // Stores whole vectors: a load of a vector waits if its parts have just been stored.
    auto* all = llvm::FixedVectorType::get(lane_, several_sines_);
    Value *angles = llvm::ConstantAggregateZero::get(all), *beyond = angles;
    for (std::size_t i = 0; i < count; ++i) {
      const Step& s = *steps[from + i];
      angles = b_.CreateInsertElement(angles, get(s.a, s.lead), i);
      if (s.d.at != 0) beyond = b_.CreateInsertElement(beyond, load(s.d.at), i);
    }
    const llvm::Align whole(8 * most);
    b_.CreateAlignedStore(angles, row(0), whole);
    b_.CreateAlignedStore(beyond, row(1), whole);
    call_scalar("anholon_several_sines", {row(0), row(1), row(2), row(3)}, b_.getVoidTy());
    for (std::size_t i = 0; i < count; ++i) {
      const Step& s = *steps[from + i];
      put(s.out, s.lead, load_from(row(2), static_cast<std::int64_t>(i)));
      put(s.c, s.lead, load_from(row(3), static_cast<std::int64_t>(i)));
    }
  }
}

llvm::Value* Emitter::beyond_of_sum(const Step& s) {
  Value *r = number(0), *beyond = r;
  for (std::uint32_t k = 0; k < s.count + s.constants; ++k) {
    const PlanTerm& t = p_.terms[s.first + k];
    Value *c = load(t.coefficient), *x = k < s.count ? get(t.x, s.lead) : number(1);
    Value *product = b_.CreateFMul(c, x), *sum = b_.CreateFAdd(product, r), *part = b_.CreateFSub(sum, product),
          *rounded = fma(c, x, r);
    Value* of_addition = b_.CreateFAdd(b_.CreateFSub(product, b_.CreateFSub(sum, part)), b_.CreateFSub(r, part));
    beyond = b_.CreateFAdd(beyond, b_.CreateFAdd(b_.CreateFAdd(b_.CreateFSub(sum, rounded), of_addition),
                                                 fma(c, x, b_.CreateFNeg(product))));
    if (k < s.count && p_.terms[s.index + k].x.at != 0) beyond = fma(c, load(p_.terms[s.index + k].x.at), beyond);
    r = rounded;
  }
  return beyond;
}

void Emitter::value(const Step& s) {
  const std::uint8_t l = s.lead;
  Value* a = s.act == Act::linear || s.act == Act::beyond || s.act == Act::sine_cosine ? nullptr : get(s.a, l);
  switch (s.act) {
  case Act::input:
    put(s.out, l, b_.CreateFMul(load(s.a.at + s.index), number(k_.factorial[s.index])));
    break;
  case Act::linear:
    put(s.out, l, sum(s, s.count + s.constants));
    break;
  case Act::beyond:
    put(s.out, l, beyond_of_sum(s));
    break;
  case Act::multiply:
    put(s.out, l, b_.CreateFMul(a, get(s.b, l)));
    break;
  case Act::square:
    put(s.out, l, b_.CreateFMul(a, a));
    break;
  case Act::divide: {
    Value* r = b_.CreateFDiv(number(1), get(s.b, l));
    put_number(s.c.at, r);
    put(s.out, l, b_.CreateFMul(a, r));
    break;
  }
  case Act::square_root:
    put(s.out, l, b_.CreateIntrinsic(llvm::Intrinsic::sqrt, {lane_}, {a}));
    break;
  case Act::power: {
    Value *power = call("anholon_power", {a, llvm::ConstantFP::get(b_.getDoubleTy(), s.value)}),
          *r = b_.CreateFDiv(number(1), a);
    put(s.out, l, power);
    store(r, s.b.at);
    put(s.d, l, number(0));
    store(b_.CreateFMul(b_.CreateFMul(number(s.value), power), r), s.e.at);
    break;
  }
  case Act::sine_cosine: {
    Value* beyond = s.d.at != 0 ? address(s.d.at, false) : llvm::ConstantPointerNull::get(b_.getPtrTy());
    call_scalar("anholon_sines", {address(s.a.at, false), beyond, address(s.out.at, false), address(s.c.at, false)},
                b_.getVoidTy());
    known_.erase({s.out.at, 0});
    known_.erase({s.c.at, 0});
    break;
  }
  case Act::function:
    put(s.out, l, call("anholon_function", {b_.getInt32(s.index), a}));
    break;
  case Act::arctan2:
    put(s.out, l, call("atan2", {a, get(s.b, l)}));
    break;
  case Act::weigh:
    put(s.out, l, number(0));
    break;
  case Act::select: {
    Value* negative = b_.CreateFCmpOLT(load(s.c.at), number(0));
    put(s.out, l, b_.CreateSelect(negative, get(s.b, l), get(s.a, l)));
    break;
  }
  case Act::lookup: {
    const KernelTables::Knots& f = k_.knots[s.index];
    const std::string name = std::to_string(s.index);
    put(s.out, l,
        call("anholon_lookup",
             {constants("knots" + name, f.at), b_.getInt64(f.at.size()), constants("steps" + name, f.values), a}));
    break;
  }
  }
}

void Emitter::partial(const Partial& d) {
  using K = Partial::Kind;
  Value* a = load(d.a);
  Value* r = nullptr;
  switch (d.kind) {
  case K::twice:
    r = b_.CreateFAdd(a, a);
    break;
  case K::half_reciprocal:
    r = b_.CreateFDiv(number(0.5), a);
    break;
  case K::quotient:
    r = b_.CreateFMul(a, load(d.b));
    break;
  case K::chosen:
    r = b_.CreateSelect(b_.CreateFCmpOLT(a, number(0)), number(0), number(1));
    break;
  case K::not_chosen:
    r = b_.CreateSelect(b_.CreateFCmpOLT(a, number(0)), number(1), number(0));
    break;
  }
  store(r, d.out);
}

}  // namespace anholon::jit
