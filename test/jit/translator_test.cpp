// Code that is translated instruction by instruction computes what C++ computes, bit by bit. Code that the translator
// does not know is refused by name.
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <llvm/Support/raw_ostream.h>

#include "jit/random_code.h"
#include "jit/x86/encoder.h"
#include "jit/x86/translated_module.h"

namespace anholon::jit {

namespace {

bool machine_has_avx2() { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }

// Adds empty functions for the parts of a kernel that a test does not use.
void add_empty_parts(llvm::Module& module) {
  llvm::IRBuilder<> b(module.getContext());
  Code code;
  code.for_each_part(0, [&](const std::string& name, auto&) {
    if (module.getFunction(name)) return;
    auto* type = llvm::FunctionType::get(b.getVoidTy(), {b.getPtrTy()}, false);
    auto* f = llvm::Function::Create(type, llvm::Function::ExternalLinkage, name, module);
    b.SetInsertPoint(llvm::BasicBlock::Create(module.getContext(), "", f));
    b.CreateRetVoid();
  });
}

Code translate(llvm::Module& module) {
  add_empty_parts(module);
  return x86::translated_module(module, 0, {});
}

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

// The count of numbers of the arena in which the translated code differs from C++.
int differences(std::uint32_t seed, unsigned lanes, int operations) {
  llvm::LLVMContext context;
  llvm::Module module("random", context);
  const RandomCode random(module, "values", seed, lanes, operations);
  const Code code = translate(module);
  alignas(64) RandomCode::Arena arena = random.begin();
  code.values(arena.data());
  int count = 0;
  for (std::size_t i = 0; i < arena.size(); ++i) count += same(arena[i], random.expected()[i]) ? 0 : 1;
  return count;
}

void expect_same_bits(unsigned lanes) {
  if (!machine_has_avx2()) GTEST_SKIP() << "needs AVX2";
  for (std::uint32_t seed = 1; seed <= 150; ++seed)
    EXPECT_EQ(differences(seed, lanes, static_cast<int>(10 + seed % 50)), 0) << "seed " << seed;
}

// The message by which the translator refuses a function of one double that `body` makes.
std::string refusal(const std::function<void(llvm::IRBuilder<>&, llvm::Function&)>& body) {
  llvm::LLVMContext context;
  llvm::Module module("odd", context);
  llvm::IRBuilder<> b(context);
  auto* type = llvm::FunctionType::get(b.getVoidTy(), {b.getPtrTy()}, false);
  auto* f = llvm::Function::Create(type, llvm::Function::ExternalLinkage, "values", module);
  b.SetInsertPoint(llvm::BasicBlock::Create(context, "", f));
  body(b, *f);
  try {
    translate(module);
  } catch (const x86::Unknown& e) {
    return e.what();
  }
  return "";
}

llvm::Value* number(llvm::IRBuilder<>& b, llvm::Function& f) { return b.CreateLoad(b.getDoubleTy(), f.getArg(0)); }

llvm::Value* vector(llvm::IRBuilder<>& b, llvm::Function& f, unsigned lanes) {
  return b.CreateAlignedLoad(llvm::FixedVectorType::get(b.getDoubleTy(), lanes), f.getArg(0), llvm::Align(8));
}

void give(llvm::IRBuilder<>& b, llvm::Function& f, llvm::Value* v) {
  b.CreateAlignedStore(v, f.getArg(0), llvm::Align(8));
  b.CreateRetVoid();
}

}  // namespace

TEST(Translator, one_lane_has_the_bits_of_cpp) { expect_same_bits(1); }

TEST(Translator, four_lanes_have_the_bits_of_cpp) { expect_same_bits(4); }

TEST(Translator, eight_lanes_in_two_registers_have_the_bits_of_cpp) { expect_same_bits(8); }

TEST(Translator, a_known_instruction_is_not_refused) {
  EXPECT_EQ(refusal([](auto& b, auto& f) { give(b, f, b.CreateFAdd(number(b, f), number(b, f))); }), "");
}

TEST(Translator, refuses_an_unknown_instruction_by_name) {
  EXPECT_EQ(refusal([](auto& b, auto& f) { give(b, f, b.CreateFRem(number(b, f), number(b, f))); }),
            "an instruction frem");
}

TEST(Translator, refuses_a_comparison_that_the_emitter_does_not_make) {
  EXPECT_EQ(refusal([](auto& b, auto& f) {
              llvm::Value* x = number(b, f);
              give(b, f, b.CreateSelect(b.CreateFCmpUNE(x, b.CreateFNeg(x)), x, b.CreateFMul(x, x)));
            }),
            "a comparison of numbers");
}

TEST(Translator, refuses_orders_of_elements_that_take_more_than_one_instruction) {
  EXPECT_EQ(refusal([](auto& b, auto& f) {
              llvm::Value* v = vector(b, f, 4);
              give(b, f, b.CreateShuffleVector(v, b.CreateFNeg(v), llvm::ArrayRef<int>{3, 2, 1, 0}));
            }),
            "a shuffle");
}

TEST(Translator, refuses_vectors_that_fill_no_register) {
  EXPECT_EQ(refusal([](auto& b, auto& f) {
              llvm::Value* v = vector(b, f, 2);
              give(b, f, b.CreateFMul(v, v));
            }),
            "a load of an odd vector");
}

TEST(Translator, refuses_calls_of_functions_that_are_nowhere) {
  EXPECT_EQ(refusal([](auto& b, auto& f) {
              auto* type = llvm::FunctionType::get(b.getDoubleTy(), {b.getDoubleTy()}, false);
              auto* other = llvm::Function::Create(type, llvm::Function::ExternalLinkage, "nowhere", *f.getParent());
              give(b, f, b.CreateCall(other, {number(b, f)}));
            }),
            "a call of a function that is nowhere");
}

TEST(Translator, refuses_an_end_amid_the_code) {
  EXPECT_NE(refusal([](auto& b, auto& f) {
              llvm::LLVMContext& context = b.getContext();
              auto *one = llvm::BasicBlock::Create(context, "", &f), *two = llvm::BasicBlock::Create(context, "", &f);
              llvm::Value* count = b.CreatePtrToInt(f.getArg(0), b.getInt64Ty());
              b.CreateCondBr(b.CreateICmpSLT(count, b.getInt64(1)), one, two);
              b.SetInsertPoint(one);
              give(b, f, number(b, f));
              b.SetInsertPoint(two);
              give(b, f, number(b, f));
            }),
            "");
}

}  // namespace anholon::jit
