#include "jit/random_code.h"

#include <algorithm>

namespace anholon::jit {

RandomCode::RandomCode(llvm::Module& module, const char* name, std::uint32_t seed, unsigned lanes, int operations)
    : random_(seed), lanes_(lanes), context_(module.getContext()), b_(context_) {
  auto* type = llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy()}, false);
  function_ = llvm::Function::Create(type, llvm::Function::ExternalLinkage, name, module);
  b_.SetInsertPoint(llvm::BasicBlock::Create(context_, "", function_));
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < kInputs; ++i) begin_[i] = i % 9 == 0 ? 0 : i % 13 == 0 ? -0.0 : normal(random_);
  expected_ = begin_;
  for (int k = 0; k < 6; ++k) keep(load(1, below(kInputs))), keep(load(lanes_, below(kInputs / 8) * 8));
  straight_line(operations);
  loop(operations);
  straight_line(operations);
  for (std::size_t k = numbers_.size(); k-- > 0 && numbers_.size() - k < 16;) store(numbers_[k]);
  b_.CreateRetVoid();
}

llvm::Type* RandomCode::type(std::size_t lanes) {
  return lanes == 1
             ? b_.getDoubleTy()
             : static_cast<llvm::Type*>(llvm::FixedVectorType::get(b_.getDoubleTy(), static_cast<unsigned>(lanes)));
}

llvm::Value* RandomCode::place(std::size_t at) {
  return b_.CreateConstInBoundsGEP1_64(b_.getDoubleTy(), function_->getArg(0), at);
}

// Draws from all numbers so far, so that many of them live for a long time.
RandomCode::Number& RandomCode::any(std::size_t lanes) {
  for (;;) {
    Number& n = numbers_[below(numbers_.size())];
    if (n.value.size() == lanes) return n;
  }
}

template <class F>
std::vector<double> RandomCode::each(std::size_t lanes, const F& f) const {
  std::vector<double> value;
  for (std::size_t lane = 0; lane < lanes; ++lane) value.push_back(f(lane));
  return value;
}

RandomCode::Number RandomCode::load(std::size_t lanes, std::size_t at) {
  return {b_.CreateAlignedLoad(type(lanes), place(at), llvm::Align(8)),
          each(lanes, [&](std::size_t lane) { return expected_[at + lane]; })};
}

RandomCode::Number RandomCode::constant(std::size_t lanes) {
  constexpr std::array<double, 5> kValues{0, 1, -1, 0.375, -2.5};
  std::vector<llvm::Constant*> elements;
  const std::vector<double> value = each(lanes, [&](std::size_t) { return kValues[below(kValues.size())]; });
  for (const double x : value) elements.push_back(llvm::ConstantFP::get(b_.getDoubleTy(), x));
  return {lanes == 1 ? elements[0] : llvm::ConstantVector::get(elements), value};
}

void RandomCode::store(const Number& n) {
  b_.CreateAlignedStore(n.ir, place(next_), llvm::Align(8));
  for (const double x : n.value) expected_[next_++] = x;
}

void RandomCode::arithmetic(std::size_t lanes) {
  const Number a = any(lanes), b = below(8) == 0 ? constant(lanes) : any(lanes);
  const auto of = [&](llvm::Value* ir, auto operation) {
    keep({ir, each(lanes, [&](std::size_t lane) { return operation(a.value[lane], b.value[lane]); })});
  };
  switch (below(4)) {
  case 0:
    return of(b_.CreateFAdd(a.ir, b.ir), [](double x, double y) { return x + y; });
  case 1:
    return of(b_.CreateFSub(a.ir, b.ir), [](double x, double y) { return x - y; });
  case 2:
    return of(b_.CreateFMul(a.ir, b.ir), [](double x, double y) { return x * y; });
  default:
    return of(b_.CreateFDiv(a.ir, b.ir), [](double x, double y) { return x / y; });
  }
}

// Factors and terms have any signs; a negation with no other use becomes part of the instruction.
void RandomCode::fused(std::size_t lanes) {
  std::array<Number, 3> of{any(lanes), any(lanes), below(6) == 0 ? constant(lanes) : any(lanes)};
  for (Number& n : of)
    if (below(3) == 0) {
      n.ir = b_.CreateFNeg(n.ir);
      for (double& x : n.value) x = -x;
    }
  keep({b_.CreateIntrinsic(llvm::Intrinsic::fma, {type(lanes)}, {of[0].ir, of[1].ir, of[2].ir}),
        each(lanes, [&](std::size_t k) { return std::fma(of[0].value[k], of[1].value[k], of[2].value[k]); })});
}

void RandomCode::choice(std::size_t lanes) {
  const Number a = any(lanes), b = any(lanes);
  const bool of_compared = below(2) == 0, swapped = below(2) == 0;
  const Number yes = of_compared ? (swapped ? b : a) : any(lanes), no = of_compared ? (swapped ? a : b) : any(lanes);
  const auto of = [&](llvm::Value* test, auto holds) {
    keep({b_.CreateSelect(test, yes.ir, no.ir),
          each(lanes, [&](std::size_t k) { return holds(a.value[k], b.value[k]) ? yes.value[k] : no.value[k]; })});
  };
  switch (below(4)) {
  case 0:
    return of(b_.CreateFCmpOLT(a.ir, b.ir), [](double x, double y) { return x < y; });
  case 1:
    return of(b_.CreateFCmpOGT(a.ir, b.ir), [](double x, double y) { return x > y; });
  case 2:
    return of(b_.CreateFCmpOLE(a.ir, b.ir), [](double x, double y) { return x <= y; });
  default:
    return of(b_.CreateFCmpOEQ(a.ir, b.ir), [](double x, double y) { return x == y; });
  }
}

void RandomCode::function(std::size_t lanes) {
  const Number a = any(lanes);
  const auto of = [&](llvm::Value* ir, auto operation) {
    keep({ir, each(lanes, [&](std::size_t lane) { return operation(a.value[lane]); })});
  };
  switch (below(3)) {
  case 0:
    return of(b_.CreateUnaryIntrinsic(llvm::Intrinsic::fabs, a.ir), [](double x) { return std::abs(x); });
  case 1:
    return of(b_.CreateUnaryIntrinsic(llvm::Intrinsic::sqrt, a.ir), [](double x) { return std::sqrt(x); });
  default:
    return of(b_.CreateFNeg(a.ir), [](double x) { return -x; });
  }
}

// Moves elements between vectors and single numbers.
void RandomCode::move_lanes() {
  Number v = any(lanes_);
  const Number x = any(1);
  const std::size_t lane = below(lanes_);
  switch (below(3)) {
  case 0:
    return keep({b_.CreateExtractElement(v.ir, lane), {v.value[lane]}});
  case 1:
    v.value[lane] = x.value[0];
    return keep({b_.CreateInsertElement(v.ir, x.ir, lane), v.value});
  default:
    return keep({b_.CreateVectorSplat(lanes_, x.ir), std::vector<double>(lanes_, x.value[0])});
  }
}

// Shuffles two vectors in the orders that transpose a matrix of four by four.
void RandomCode::shuffle() {
  const Number a = any(4), b = any(4);
  constexpr std::array<std::array<int, 4>, 5> kMasks{
      {{0, 4, 2, 6}, {1, 5, 3, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {4, 1, 2, 7}}};
  const auto& mask = kMasks[below(kMasks.size())];
  keep({b_.CreateShuffleVector(a.ir, b.ir, mask), each(4, [&](std::size_t lane) {
          const auto from = static_cast<std::size_t>(mask[lane]);
          return from < 4 ? a.value[from] : b.value[from - 4];
        })});
}

void RandomCode::operation() {
  const std::size_t lanes = below(4) == 0 ? 1 : lanes_;
  switch (below(9)) {
  case 0:
    return store(any(lanes));
  case 1:
    return keep(load(lanes, below((next_ - 8) / 8) * 8));
  case 2:
  case 3:
    return arithmetic(lanes);
  case 4:
  case 5:
    return fused(lanes);
  case 6:
    return choice(lanes);
  case 7:
    return function(lanes);
  default:
    return lanes_ == 1 ? arithmetic(1) : lanes_ == 4 && below(2) == 0 ? shuffle() : move_lanes();
  }
}

void RandomCode::straight_line(int operations) {
  for (int k = 0; k < operations; ++k) operation();
}

void RandomCode::loop(int operations) {
  const std::size_t count = 3 + below(14), turns = 1 + below(6);
  llvm::BasicBlock *const before = b_.GetInsertBlock(), *body = llvm::BasicBlock::Create(context_, "", function_),
                          *after = llvm::BasicBlock::Create(context_, "", function_);
  b_.CreateBr(body);
  b_.SetInsertPoint(body);
  llvm::PHINode* turn = b_.CreatePHI(b_.getInt64Ty(), 2);
  turn->addIncoming(b_.getInt64(0), before);
  std::vector<llvm::PHINode*> nodes;
  std::vector<std::vector<double>> values;
  for (std::size_t k = 0; k < count; ++k) {
    const Number start = below(5) == 0 ? constant(lanes_) : any(lanes_);
    nodes.push_back(b_.CreatePHI(type(lanes_), 2));
    nodes.back()->addIncoming(start.ir, before);
    values.push_back(start.value);
  }
  // Each node takes the value of another one, in a random order; every third node adds a number from before the loop.
  std::vector<std::size_t> from(count);
  for (std::size_t k = 0; k < count; ++k) from[k] = k;
  std::shuffle(from.begin(), from.end(), random_);
  std::vector<std::pair<llvm::Value*, std::vector<double>>> added(count);
  for (std::size_t k = 0; k < count; ++k)
    if (k % 3 == 0) {
      const Number term = any(lanes_);
      added[k] = {b_.CreateFAdd(nodes[from[k]], term.ir), term.value};
    }
  llvm::Value* next = b_.CreateAdd(turn, b_.getInt64(1));
  turn->addIncoming(next, body);
  for (std::size_t k = 0; k < count; ++k) nodes[k]->addIncoming(added[k].first ? added[k].first : nodes[from[k]], body);
  b_.CreateCondBr(b_.CreateICmpSLT(next, b_.getInt64(turns)), body, after);
  b_.SetInsertPoint(after);
  // After the loop the nodes hold the values with which its last turn began.
  for (std::size_t t = 1; t < turns; ++t) {
    std::vector<std::vector<double>> moved;
    for (std::size_t k = 0; k < count; ++k) {
      moved.push_back(values[from[k]]);
      if (added[k].first)
        for (std::size_t lane = 0; lane < lanes_; ++lane) moved[k][lane] += added[k].second[lane];
    }
    values = moved;
  }
  for (std::size_t k = 0; k < count; ++k) keep({nodes[k], values[k]});
  straight_line(operations / 4);
}

}  // namespace anholon::jit
