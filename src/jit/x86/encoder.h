// Encodes instructions of x86-64 with AVX2 and FMA as bytes (Intel's manual, volume 2), as far as straight-line code of
// doubles needs them.
#pragma once
#include <cstdint>
#include <map>
#include <stdexcept>
#include <vector>

namespace anholon::jit::x86 {

// Thrown for code that this compiler does not know; then the caller uses another compiler.
struct Unknown : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// General registers have the numbers of the instruction set.
enum General : std::int8_t {
  rax,
  rcx,
  rdx,
  rbx,
  rsp,
  rbp,
  rsi,
  rdi,
  r8,
  r9,
  r10,
  r11,
  r12,
  r13,
  r14,
  r15,
  nowhere = -1
};

// An operand in memory: base + (index << shift) + at. Without a base it is among the constants of the code.
struct Memory {
  General base = nowhere, index = nowhere;
  int shift = 0;
  std::int64_t at = 0;
  Memory operator+(std::int64_t bytes) const { return {base, index, shift, at + bytes}; }
};

// A vector register (xmm or ymm), or memory.
struct Operand {
  int reg = -1;  // memory if negative
  Memory memory;
  static Operand of(int reg) { return {reg, {}}; }
  static Operand of(const Memory& memory) { return {-1, memory}; }
  bool in_memory() const { return reg < 0; }
};

// The encoding of an instruction with the VEX prefix. `scalar`: the prefix of the form for one double, if there is one.
struct Encoding {
  std::uint8_t opcode, map, prefix, scalar;
  bool w = false;
};

namespace encodings {
inline constexpr std::uint8_t kNone = 0xff;
inline constexpr Encoding add{0x58, 1, 1, 3}, multiply{0x59, 1, 1, 3}, subtract{0x5c, 1, 1, 3}, divide{0x5e, 1, 1, 3},
    least{0x5d, 1, 1, 3}, most{0x5f, 1, 1, 3}, square_root{0x51, 1, 1, 3}, compare{0xc2, 1, 1, 3};
inline constexpr Encoding bit_and{0x54, 1, 1, kNone}, bit_xor{0x57, 1, 1, kNone}, unpack_low{0x14, 1, 1, kNone},
    unpack_high{0x15, 1, 1, kNone}, add_integers{0xd4, 1, 1, kNone}, subtract_integers{0xfb, 1, 1, kNone},
    shift{0x73, 1, 1, kNone}, copy{0x28, 1, 1, kNone}, load{0x10, 1, 1, 3}, store{0x11, 1, 1, 3},
    signs{0x50, 1, 1, kNone}, broadcast{0x19, 2, 1, kNone}, masked_load{0x2d, 2, 1, kNone}, blend{0x0d, 3, 1, kNone},
    choose{0x4b, 3, 1, kNone}, halves{0x06, 3, 1, kNone}, upper_half{0x19, 3, 1, kNone};
}  // namespace encodings

// Conditions of jumps after a comparison.
enum class Condition : std::uint8_t { less = 0xc, not_less = 0xd, not_greater = 0xe, greater = 0xf };
inline Condition opposite(Condition c) { return static_cast<Condition>(static_cast<std::uint8_t>(c) ^ 1); }

// The place of four bytes that hold a distance from their end, plus `behind` bytes, to a target.
struct Distance {
  std::size_t at;
  int behind;
  std::int64_t target;
};

class Encoder {
 public:
  // `wide`: four lanes, otherwise one double (or 128 bits, for instructions without a scalar form). `second`: the
  // register of the first source; instructions with one source have none.
  void vector(const Encoding& e, bool wide, int to, int second, const Operand& last);
  void vector(const Encoding& e, bool wide, int to, int second, const Operand& last, std::uint8_t immediate);
  // order: 132, 213 or 231, as in the names of the instructions; the product, the addend, or both may be negated.
  void fused(int order, bool negated_product, bool negated_addend, bool wide, int to, int second, const Operand& last);
  void load(bool wide, int to, const Memory& from);
  void store(bool wide, int from, const Memory& to);
  void copy(int to, int from);
  void zero(int to);
  void end_of_vectors();  // before code that may use the older encodings

  void move(General to, General from);
  void set(General to, std::int64_t value);
  void address(General to, const Memory& of);
  void add(General to, General x);
  void subtract(General to, General x);
  void shift_left(General to, int by);
  void negate(General x);
  void compare(General a, General b);
  void compare(General a, std::int32_t b);
  void push(General x);
  void pop(General x);
  void align_stack(std::uint8_t bytes);
  void lower_stack(std::int32_t bytes);
  // Sets eax to 1 if any of the lowest `lanes` signs of a vector is set, else to 0.
  void any_sign(int vector, bool wide);
  void jump(int label);
  void jump(Condition c, int label);
  void call(int function);
  void call(General address);
  void give_back();

  void place(int label) { labels_[label] = bytes.size(); }
  // Puts distances to all labels into the code.
  void resolve_labels();

  std::vector<std::uint8_t> bytes;
  std::vector<Distance> constants, functions;  // targets: places in the constants; numbers of functions

 private:
  void byte(unsigned b) { bytes.push_back(static_cast<std::uint8_t>(b)); }
  void four(std::int64_t x);
  void prefix(const Encoding& e, std::uint8_t pp, bool wide, int to, int second, const Operand& last);
  void operand(int to, const Operand& last, int behind);
  void memory(int to, const Memory& m, int behind);
  void general(unsigned opcode, int to, General last);

  std::map<int, std::size_t> labels_;
  std::vector<Distance> jumps_;
};

}  // namespace anholon::jit::x86
