#include "jit/x86/encoder.h"

namespace anholon::jit::x86 {

void Encoder::four(std::int64_t x) {
  if (x < INT32_MIN || x > INT32_MAX) throw Unknown("a distance is long");
  for (int k = 0; k < 4; ++k) byte(static_cast<unsigned>(x >> (8 * k)) & 0xff);
}

// ---- vectors --------------------------------------------------------------------------------------------------------

void Encoder::prefix(const Encoding& e, std::uint8_t pp, bool wide, int to, int second, const Operand& last) {
  const auto high = [](int x) { return x >= 8 ? 1U : 0U; };
  const bool in_memory = last.in_memory();
  const unsigned r = high(to), x = in_memory && last.memory.index != nowhere ? high(last.memory.index) : 0U,
                 b = in_memory ? (last.memory.base != nowhere ? high(last.memory.base) : 0U) : high(last.reg),
                 v = second < 0 ? 0xfU : static_cast<unsigned>(~second & 0xf), w = e.w ? 1U : 0U, l = wide ? 1U : 0U;
  if (x == 0 && b == 0 && w == 0 && e.map == 1) {
    byte(0xc5);
    byte((r ^ 1) << 7 | v << 3 | l << 2 | pp);
  } else {
    byte(0xc4);
    byte((r ^ 1) << 7 | (x ^ 1) << 6 | (b ^ 1) << 5 | e.map);
    byte(w << 7 | v << 3 | l << 2 | pp);
  }
  byte(e.opcode);
}

void Encoder::memory(int to, const Memory& m, int behind) {
  const unsigned reg = static_cast<unsigned>(to & 7) << 3;
  if (m.base == nowhere) {
    if (m.index != nowhere) throw Unknown("an index into the constants");
    byte(reg | 5);
    constants.push_back({bytes.size(), behind, m.at});
    return four(0);
  }
  const unsigned base = static_cast<unsigned>(m.base) & 7;
  const bool with_index = m.index != nowhere, none = m.at == 0 && base != 5, small = m.at >= -128 && m.at <= 127;
  const unsigned mode = none ? 0U : small ? 0x40U : 0x80U;
  if (with_index || base == 4) {
    byte(mode | reg | 4);
    const unsigned index = with_index ? static_cast<unsigned>(m.index) & 7 : 4U;
    byte(static_cast<unsigned>(with_index ? m.shift : 0) << 6 | index << 3 | base);
  } else {
    byte(mode | reg | base);
  }
  if (mode == 0x40)
    byte(static_cast<unsigned>(m.at) & 0xff);
  else if (mode == 0x80)
    four(m.at);
}

void Encoder::operand(int to, const Operand& last, int behind) {
  if (last.in_memory()) return memory(to, last.memory, behind);
  byte(0xc0U | static_cast<unsigned>(to & 7) << 3 | static_cast<unsigned>(last.reg & 7));
}

void Encoder::vector(const Encoding& e, bool wide, int to, int second, const Operand& last) {
  prefix(e, !wide && e.scalar != encodings::kNone ? e.scalar : e.prefix, wide, to, second, last);
  operand(to, last, 0);
}

void Encoder::vector(const Encoding& e, bool wide, int to, int second, const Operand& last, std::uint8_t immediate) {
  prefix(e, !wide && e.scalar != encodings::kNone ? e.scalar : e.prefix, wide, to, second, last);
  operand(to, last, 1);
  byte(immediate);
}

void Encoder::fused(int order, bool negated_product, bool negated_addend, bool wide, int to, int second,
                    const Operand& last) {
  const int first = order == 132 ? 0x98 : order == 213 ? 0xa8 : 0xb8;
  const int opcode = first + (negated_product ? 4 : 0) + (negated_addend ? 2 : 0) + (wide ? 0 : 1);
  prefix({static_cast<std::uint8_t>(opcode), 2, 1, encodings::kNone, true}, 1, wide, to, second, last);
  operand(to, last, 0);
}

void Encoder::load(bool wide, int to, const Memory& from) { vector(encodings::load, wide, to, -1, Operand::of(from)); }

void Encoder::store(bool wide, int from, const Memory& to) {
  vector(encodings::store, wide, from, -1, Operand::of(to));
}

void Encoder::copy(int to, int from) {
  if (to != from) vector(encodings::copy, true, to, -1, Operand::of(from));
}

void Encoder::zero(int to) { vector(encodings::bit_xor, false, to, to, Operand::of(to)); }

void Encoder::end_of_vectors() {
  byte(0xc5);
  byte(0xf8);
  byte(0x77);
}

void Encoder::any_sign(int vector_, bool wide) {
  vector(encodings::signs, wide, rax, -1, Operand::of(vector_));
  if (!wide) byte(0x83), byte(0xe0), byte(1);  // and eax, 1
  byte(0x85), byte(0xc0);                      // test eax, eax
  byte(0x0f), byte(0x95), byte(0xc0);          // setne al
  byte(0x0f), byte(0xb6), byte(0xc0);          // movzx eax, al
}

// ---- general registers ----------------------------------------------------------------------------------------------

void Encoder::general(unsigned opcode, int to, General last) {
  byte(0x48U | (to >= 8 ? 4U : 0U) | (last >= 8 ? 1U : 0U));
  byte(opcode);
  byte(0xc0U | static_cast<unsigned>(to & 7) << 3 | static_cast<unsigned>(last & 7));
}

void Encoder::move(General to, General from) {
  if (to != from) general(0x89, from, to);
}

void Encoder::set(General to, std::int64_t value) {
  if (value >= INT32_MIN && value <= INT32_MAX) {
    general(0xc7, 0, to);
    return four(value);
  }
  byte(0x48U | (to >= 8 ? 1U : 0U));
  byte(0xb8U | static_cast<unsigned>(to & 7));
  for (int k = 0; k < 8; ++k) byte(static_cast<unsigned>(value >> (8 * k)) & 0xff);
}

void Encoder::address(General to, const Memory& of) {
  const auto high = [](General x) { return x != nowhere && x >= 8 ? 1U : 0U; };
  byte(0x48U | high(to) << 2 | high(of.index) << 1 | high(of.base));
  byte(0x8d);
  memory(to, of, 0);
}

void Encoder::add(General to, General x) { general(0x01, x, to); }
void Encoder::subtract(General to, General x) { general(0x29, x, to); }
void Encoder::negate(General x) { general(0xf7, 3, x); }
void Encoder::compare(General a, General b) { general(0x39, b, a); }

void Encoder::shift_left(General to, int by) {
  general(0xc1, 4, to);
  byte(static_cast<unsigned>(by));
}

void Encoder::compare(General a, std::int32_t b) {
  general(0x81, 7, a);
  four(b);
}

void Encoder::push(General x) {
  if (x >= 8) byte(0x41);
  byte(0x50U | static_cast<unsigned>(x & 7));
}

void Encoder::pop(General x) {
  if (x >= 8) byte(0x41);
  byte(0x58U | static_cast<unsigned>(x & 7));
}

void Encoder::align_stack(std::uint8_t bytes_) {
  general(0x83, 4, rsp);
  byte(static_cast<unsigned>(-bytes_) & 0xff);
}

void Encoder::lower_stack(std::int32_t bytes_) {
  general(0x81, 5, rsp);
  four(bytes_);
}

void Encoder::jump(int label) {
  byte(0xe9);
  jumps_.push_back({bytes.size(), 0, label});
  four(0);
}

void Encoder::jump(Condition c, int label) {
  byte(0x0f);
  byte(0x80U | static_cast<unsigned>(c));
  jumps_.push_back({bytes.size(), 0, label});
  four(0);
}

void Encoder::call(int function) {
  byte(0xe8);
  functions.push_back({bytes.size(), 0, function});
  four(0);
}

void Encoder::call(General address) {
  if (address >= 8) byte(0x41);
  byte(0xff);
  byte(0xd0U | static_cast<unsigned>(address & 7));
}

void Encoder::give_back() { byte(0xc3); }

void Encoder::resolve_labels() {
  for (const Distance& d : jumps_) {
    const std::int64_t distance =
        static_cast<std::int64_t>(labels_.at(static_cast<int>(d.target))) - static_cast<std::int64_t>(d.at) - 4;
    for (std::size_t k = 0; k < 4; ++k) bytes[d.at + k] = static_cast<std::uint8_t>(distance >> (8 * k));
  }
  jumps_.clear();
}

}  // namespace anholon::jit::x86
