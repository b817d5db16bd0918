// Emits arithmetic, and instructions that move numbers.
#include <algorithm>
#include <array>

#include "jit/x86/translator.h"

namespace anholon::jit::x86 {

namespace {

std::uint64_t index_of(const llvm::Value* v) {
  const auto* at = llvm::dyn_cast<llvm::ConstantInt>(v);
  if (!at) throw Unknown("an element is chosen at run time");
  return at->getZExtValue();
}

// The operand of a folded negation, or the value itself.
std::pair<const llvm::Value*, bool> sign_apart(const Numbers& numbers, const llvm::Value* v) {
  const auto* i = llvm::dyn_cast<llvm::Instruction>(v);
  if (i && i->getOpcode() == llvm::Instruction::FNeg && numbers.folded(i)) {
    auto [inner, negated] = sign_apart(numbers, i->getOperand(0));
    return {inner, !negated};
  }
  return {v, false};
}

}  // namespace

void Translator::instruction(const llvm::Instruction& i) {
  using I = llvm::Instruction;
  switch (i.getOpcode()) {
  case I::Load:
    return load(llvm::cast<llvm::LoadInst>(i));
  case I::Store:
    return store(llvm::cast<llvm::StoreInst>(i));
  case I::FAdd:
    return binary(i, encodings::add, true);
  case I::FMul:
    return binary(i, encodings::multiply, true);
  case I::FSub:
    return binary(i, encodings::subtract, false);
  case I::FDiv:
    return binary(i, encodings::divide, false);
  case I::Add:
    return binary(i, encodings::add_integers, true);
  case I::Sub:
    return binary(i, encodings::subtract_integers, false);
  case I::And:
    return binary(i, encodings::bit_and, true);
  case I::Shl:
  case I::AShr:
    return shift(i);
  case I::FNeg:
    return negate(i);
  case I::Select:
    return select(llvm::cast<llvm::SelectInst>(i));
  case I::ExtractElement:
    return extract(llvm::cast<llvm::ExtractElementInst>(i));
  case I::InsertElement:
    return insert(llvm::cast<llvm::InsertElementInst>(i));
  case I::ShuffleVector:
    return shuffle(llvm::cast<llvm::ShuffleVectorInst>(i));
  case I::Ret:
    return give_back(llvm::cast<llvm::ReturnInst>(i));
  case I::Call:
    if (const auto* known = llvm::dyn_cast<llvm::IntrinsicInst>(&i)) return intrinsic(*known);
    return call(llvm::cast<llvm::CallInst>(i));
  default:
    throw Unknown(std::string("an instruction ") + i.getOpcodeName());
  }
}

void Translator::load(const llvm::LoadInst& i) {
  const Memory at = addresses_.memory(i.getPointerOperand());
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    if (lanes_of(i.getType()) > 1 && lanes_of(i.getType()) % kWidth != 0) throw Unknown("a load of an odd vector");
    const int n = numbers_.number(&i, part);
    code_.load(numbers_.wide(n), registers_.define(n), at + 32 * static_cast<std::int64_t>(part));
    registers_.next_part();
  }
}

void Translator::store(const llvm::StoreInst& i) {
  const llvm::Value* v = i.getValueOperand();
  const unsigned lanes = lanes_of(v->getType());
  if (lanes > 1 && lanes % kWidth != 0) throw Unknown("a store of an odd vector");
  if (!v->getType()->getScalarType()->isDoubleTy()) throw Unknown("a store of something else than doubles");
  for (unsigned part = 0; part < parts_of(v->getType()); ++part) {
    const int reg = in_register(v, part, lanes > 1);
    code_.store(lanes > 1, reg, addresses_.memory(i.getPointerOperand()) + 32 * static_cast<std::int64_t>(part));
  }
}

void Translator::binary(const llvm::Instruction& i, const Encoding& e, bool commutes) {
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    const llvm::Value *a = i.getOperand(0), *b = i.getOperand(1);
    if (commutes && from_memory(a, part) && !from_memory(b, part)) std::swap(a, b);
    const int n = numbers_.number(&i, part);
    const bool wide = numbers_.wide(n);
    // Operations on bits have no form for one double, so their constants would have to be 16 bytes long.
    const bool short_constants = !wide && e.scalar == encodings::kNone;
    const int x = in_register(a, part, wide);
    const Operand y = short_constants ? Operand::of(in_register(b, part, wide)) : anywhere(b, part, wide);
    registers_.release();
    code_.vector(e, wide, registers_.define(n), x, y);
    registers_.next_part();
  }
}

// Shifts by a constant. There is no arithmetic shift of 64 bits: the 12 remaining bits of a number get their sign by (x
// ^ s) - s with s = 2^11.
void Translator::shift(const llvm::Instruction& i) {
  constexpr std::uint64_t kRoom = 64;
  const auto* by = llvm::dyn_cast<llvm::Constant>(i.getOperand(1));
  if (!by) throw Unknown("a shift by a number");
  const std::uint64_t bits = bits_of(element_of(*by, 0));
  const bool left = i.getOpcode() == llvm::Instruction::Shl;
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    const int n = numbers_.number(&i, part);
    const bool wide = numbers_.wide(n);
    const int x = in_register(i.getOperand(0), part, wide);
    registers_.release();
    const int to = registers_.define(n);
    code_.vector(encodings::shift, wide, left ? 6 : 2, to, Operand::of(x), static_cast<std::uint8_t>(bits));
    if (left) continue;
    const std::uint64_t sign = 1ULL << (kRoom - 1 - bits);
    const Memory signs = splatted(sign, true);
    code_.vector(encodings::bit_xor, wide, to, to, Operand::of(signs));
    code_.vector(encodings::subtract_integers, wide, to, to, Operand::of(signs));
  }
}

void Translator::negate(const llvm::Instruction& i) {
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    const int n = numbers_.number(&i, part);
    const bool wide = numbers_.wide(n);
    const int x = in_register(i.getOperand(0), part, wide);
    registers_.release();
    code_.vector(encodings::bit_xor, wide, registers_.define(n), x, Operand::of(splatted(kSign, true)));
  }
}

void Translator::fma(const llvm::Instruction& i) {
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    fma_part(i, part);
    registers_.next_part();
  }
}

// Emits a b + c: the result takes the register of an operand that is not used again, otherwise that of a copy of c.
void Translator::fma_part(const llvm::Instruction& i, unsigned part) {
  auto [a, a_negated] = sign_apart(numbers_, i.getOperand(0));
  auto [b, b_negated] = sign_apart(numbers_, i.getOperand(1));
  auto [c, c_negated] = sign_apart(numbers_, i.getOperand(2));
  const int n = numbers_.number(&i, part);
  const bool wide = numbers_.wide(n), minus = a_negated != b_negated;
  const auto ends = [&](const llvm::Value* v) {
    return numbers_.is_number(v) && registers_.held(numbers_.number(v, part)) &&
           registers_.dies(numbers_.number(v, part));
  };
  if (from_memory(a, part)) std::swap(a, b);  // only one operand may be in memory
  const bool same_factors = a == b;
  if (!ends(c) && !from_memory(c, part) && !same_factors && (ends(a) || ends(b)) && c != a && c != b) {
    if (!ends(a)) std::swap(a, b);
    // The result takes the register of a, with b or c in memory.
    const int to = in_register(a, part, wide), z = in_register(c, part, wide);
    const Operand y = anywhere(b, part, wide);
    const int from = numbers_.number(a, part);
    if (registers_.rename(from, n)) return code_.fused(132, minus, c_negated, wide, to, z, y);
    throw Unknown("an operand that does not end");
  }
  const int x = in_register(a, part, wide);
  const Operand y = same_factors ? Operand::of(x) : anywhere(b, part, wide);
  if (ends(c) && c != a && c != b) {
    const int from = numbers_.number(c, part), to = registers_.in_register(from);
    if (registers_.rename(from, n)) return code_.fused(231, minus, c_negated, wide, to, x, y);
  }
  const auto* none = llvm::dyn_cast<llvm::Constant>(c);
  const bool zero = none && none->isNullValue();
  Operand z;
  if (!zero) z = anywhere(c, part, wide);
  const int to = registers_.take();
  if (zero)
    code_.zero(to);
  else if (z.in_memory())
    code_.load(wide, to, z.memory);
  else
    code_.copy(to, z.reg);
  code_.fused(231, minus, c_negated, wide, to, x, y);
  registers_.release();
  registers_.bind(n, to);
}

void Translator::select(const llvm::SelectInst& i) {
  const auto* test = llvm::dyn_cast<llvm::FCmpInst>(i.getCondition());
  if (!test) throw Unknown("a choice that does not compare numbers");
  using P = llvm::CmpInst;
  const P::Predicate p = test->getPredicate();
  if (p != P::FCMP_OLT && p != P::FCMP_OGT && p != P::FCMP_OLE && p != P::FCMP_OEQ)
    throw Unknown("a comparison of numbers");
  const llvm::Value *a = test->getOperand(0), *b = test->getOperand(1), *yes = i.getTrueValue(),
                    *no = i.getFalseValue();
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    const int n = numbers_.number(&i, part);
    const bool wide = numbers_.wide(n);
    // a < b ? b : a and a < b ? a : b are instructions: these return the second operand unless the test holds.
    if (p == P::FCMP_OLT && ((yes == b && no == a) || (yes == a && no == b))) {
      const llvm::Value *first = yes, *second = no;
      const int x = in_register(first, part, wide);
      const Operand y = anywhere(second, part, wide);
      registers_.release();
      code_.vector(yes == b ? encodings::most : encodings::least, wide, registers_.define(n), x, y);
      continue;
    }
    const std::uint8_t relation = p == P::FCMP_OLT ? 0x11 : p == P::FCMP_OGT ? 0x1e : p == P::FCMP_OLE ? 0x12 : 0;
    const int x = in_register(a, part, wide);
    const Operand y = anywhere(b, part, wide);
    const int mask = registers_.take();
    code_.vector(encodings::compare, wide, mask, x, y, relation);
    const int otherwise = in_register(no, part, wide);
    const int chosen = in_register(yes, part, wide);
    registers_.release();
    code_.vector(encodings::choose, wide, registers_.define(n), otherwise, Operand::of(chosen),
                 static_cast<std::uint8_t>(mask << 4));
  }
}

void Translator::extract(const llvm::ExtractElementInst& i) {
  const auto at = static_cast<unsigned>(index_of(i.getIndexOperand()));
  const llvm::Value* from = Numbers::behind_casts(i.getVectorOperand());
  const unsigned part = at / kWidth, lane = at % kWidth;
  const int n = numbers_.number(&i, 0);
  if (!numbers_.is_number(from)) {
    if (llvm::isa<llvm::Constant>(from)) throw Unknown("an element of a constant");
    const Operand of = anywhere(from, part, true);
    return code_.load(false, registers_.define(n), of.memory + 8 * static_cast<std::int64_t>(lane));
  }
  const Operand of = registers_.anywhere(numbers_.number(from, part));
  if (of.in_memory()) return code_.load(false, registers_.define(n), of.memory + 8 * static_cast<std::int64_t>(lane));
  if (lane == 0) return copy(from, part, n);
  registers_.release();
  const int to = registers_.define(n);
  if (lane >= 2) code_.vector(encodings::upper_half, true, of.reg, -1, Operand::of(to), 1);
  const int pair = lane >= 2 ? to : of.reg;
  if (lane % 2 == 1) code_.vector(encodings::unpack_high, false, to, pair, Operand::of(pair));
}

void Translator::insert(const llvm::InsertElementInst& i) {
  const auto at = static_cast<unsigned>(index_of(i.getOperand(2)));
  const llvm::Value *into = Numbers::behind_casts(i.getOperand(0)), *what = i.getOperand(1);
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    const int n = numbers_.number(&i, part);
    if (at / kWidth != part) {
      copy(into, part, n);
      continue;
    }
    const unsigned lane = at % kWidth;
    int x = -1;
    if (lane == 0) {
      x = in_register(what, 0, false);
    } else {
      const Operand from = anywhere(what, 0, false);
      x = registers_.take();
      code_.vector(encodings::broadcast, true, x, -1, from);
    }
    if (is_poison(into)) {
      registers_.release();
      code_.copy(registers_.define(n), x);
      continue;
    }
    const int old = in_register(into, part, true);
    registers_.release();
    code_.vector(encodings::blend, true, registers_.define(n), old, Operand::of(x),
                 static_cast<std::uint8_t>(1U << lane));
  }
}

void Translator::splat(const llvm::ShuffleVectorInst& i) {
  const auto* insertion = llvm::cast<llvm::InsertElementInst>(i.getOperand(0));
  const llvm::Value* what = insertion->getOperand(1);
  Operand from = anywhere(what, 0, false);
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    if (part + 1 == parts_of(i.getType())) registers_.release();
    code_.vector(encodings::broadcast, true, registers_.define(numbers_.number(&i, part)), -1, from);
  }
}

void Translator::shuffle(const llvm::ShuffleVectorInst& i) {
  if (is_splat(&i)) return splat(i);
  const llvm::Value *a = i.getOperand(0), *b = i.getOperand(1);
  const auto mask = i.getShuffleMask();
  const auto n = static_cast<int>(lanes_of(a->getType())), four = static_cast<int>(kWidth);
  if (static_cast<int>(mask.size()) != four) throw Unknown("a shuffle of many elements");
  const int to = numbers_.number(&i, 0);
  const auto is = [&](std::array<int, kWidth> wanted) { return std::equal(mask.begin(), mask.end(), wanted.begin()); };
  if (mask[0] % four == 0 && mask[0] < n && is({mask[0], mask[0] + 1, mask[0] + 2, mask[0] + 3}))
    return copy(a, static_cast<unsigned>(mask[0]) / kWidth, to);
  if (n != four) throw Unknown("a shuffle of long vectors");
  std::uint8_t of_second = 0;
  bool in_place = true;
  for (int lane = 0; lane < four; ++lane) {
    const int from = mask[static_cast<std::size_t>(lane)];
    in_place = in_place && from % four == lane;
    if (from >= four) of_second = static_cast<std::uint8_t>(of_second | 1U << lane);
  }
  const bool low = is({0, 4, 2, 6}), high = is({1, 5, 3, 7}), lower = is({0, 1, 4, 5}), upper = is({2, 3, 6, 7});
  if (!in_place && !low && !high && !lower && !upper) throw Unknown("a shuffle");
  const int x = in_register(a, 0, true);
  const Operand y = anywhere(b, 0, true);
  registers_.release();
  const int r = registers_.define(to);
  if (in_place)
    code_.vector(encodings::blend, true, r, x, y, of_second);
  else if (low || high)
    code_.vector(low ? encodings::unpack_low : encodings::unpack_high, true, r, x, y);
  else
    code_.vector(encodings::halves, true, r, x, y, lower ? 0x20 : 0x31);
}

}  // namespace anholon::jit::x86
