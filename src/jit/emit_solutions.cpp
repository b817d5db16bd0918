// The solution of a stage: the elimination of the linearized tape, or its inverse, made once per expansion.
#include "jit/emitter.h"

namespace anholon::jit {

namespace {
// From this number of unknowns on, vectors of four pay; with fewer, the sums are finished before vectors are taken
// apart.
constexpr std::size_t kManyUnknowns = 8;
}  // namespace

void Emitter::factor() {
  begin("factor");
  const SparseLu& e = *k_.elimination;
  std::vector<Value*> lu(e.entries, nullptr);
  const auto at = [&](std::uint32_t i) { return lu[i] ? lu[i] : number(0); };
  std::vector<bool> kept(p_.entries.size(), k_.refine);
  for (const SparseLu::Term& t : e.own_terms) kept[t.entry] = !unit(t.entry);
  for (std::size_t i = 0; i < p_.entries.size(); ++i) {
    Value* x = load(p_.entries[i].from);
    Value*& sum = lu[e.place[i]];
    sum = p_.entries[i].sign < 0 ? b_.CreateFSub(at(e.place[i]), x) : b_.CreateFAdd(at(e.place[i]), x);
    if (kept[i]) store(p_.entries[i].sign < 0 ? b_.CreateFNeg(x) : x, k_.entries + static_cast<std::int64_t>(i));
  }
  std::vector<Value*> reciprocal(e.pivots.size(), nullptr);
  for (std::size_t k = 0; k < e.pivots.size(); ++k) {
    const SparseLu::Pivot& p = e.pivots[k];
    if (!p.one) {
      reciprocal[k] = p.minus_one ? number(-1) : b_.CreateFDiv(number(1), at(p.entry));
      for (std::uint32_t i = p.first_scaled; i < p.first_scaled + p.scaled; ++i)
        lu[e.scaled_entries[i]] = b_.CreateFMul(at(e.scaled_entries[i]), reciprocal[k]);
    }
    for (std::uint32_t i = p.first_update; i < p.first_update + p.updates; ++i) {
      const SparseLu::Update& u = e.update_list[i];
      lu[u.to] = fma(b_.CreateFNeg(at(u.l)), at(u.u), at(u.to));
    }
  }
  if (e.influences.empty() || substitution_) {
    for (std::uint32_t i = 0; i < e.entries; ++i) store(at(i), k_.lu + i);
    for (std::size_t k = 0; k < e.pivots.size(); ++k)
      if (reciprocal[k]) store(reciprocal[k], k_.reciprocal + static_cast<std::int64_t>(k));
  }
  if (!e.influences.empty()) invert(lu, reciprocal);
  judge(lu);
  end();
}

void Emitter::invert(const std::vector<Value*>& lu, const std::vector<Value*>& reciprocal) {
  const SparseLu& e = *k_.elimination;
  if (!e.own.empty()) {
    if (lanes_ == 1)
      invert_sides_at_once(lu, reciprocal);
    else
      invert_sides_by_call();
    return;
  }
  for (const std::uint32_t side : p_.sides) {
    std::vector<Value*> rhs(p_.rows, nullptr);
    rhs[side] = number(1);
    const std::vector<Value*> y = solution_for(rhs, lu, reciprocal);
    for (std::size_t i = 0; i < e.influences.size(); ++i)
      if (e.influences[i].side == side && e.influences[i].sign == 0)
        store(y[e.influences[i].column], k_.inverse + static_cast<std::int64_t>(i));
  }
}

// Emits a solution, without entries that are always zero. Right sides may be vectors of several.
std::vector<llvm::Value*> Emitter::solution_for(std::vector<Value*> rhs, const std::vector<Value*>& lu,
                                                const std::vector<Value*>& reciprocal) {
  const SparseLu& e = *k_.elimination;
  std::vector<Value*> y(p_.rows, nullptr);
  const auto as = [&](Value* v, Value* x) {
    return v->getType() == x->getType()
               ? v
               : b_.CreateVectorSplat(llvm::cast<llvm::FixedVectorType>(x->getType())->getNumElements(), v);
  };
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

// Solves for all right sides at once: each is an element of vectors.
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
  // A full inverse is transposed in squares of four columns and sides.
  const std::size_t n = p_.x.size(), m = p_.sides.size(), full = e.influences.size() == n * m ? 4 : 0;
  const auto turned = [&](std::size_t count) { return full ? count / full * full : 0; };
  for (std::size_t column = 0; column < turned(n); column += full)
    for (std::size_t side = 0; side < turned(m); side += full) {
      std::vector<Value*> square;
      std::vector<int> part;
      for (std::size_t r = side; r < side + full; ++r) part.push_back(static_cast<int>(r));
      for (std::size_t j = column; j < column + full; ++j) square.push_back(b_.CreateShuffleVector(y[j], part));
      transpose(square);
      for (std::size_t r = 0; r < full; ++r)
        b_.CreateAlignedStore(
            square[r], address(k_.inverse + static_cast<std::int64_t>((side + r) * n + column), false), llvm::Align(8));
    }
  for (std::size_t i = 0; i < e.influences.size(); ++i) {
    const std::size_t column = e.influences[i].column, side = rank[e.influences[i].side];
    if (column >= turned(n) || side >= turned(m))
      store(b_.CreateExtractElement(y[column], side), k_.inverse + static_cast<std::int64_t>(i));
  }
}

// Transposes as many vectors as each has elements, a power of two, by swapping halves of ever larger squares.
void Emitter::transpose(std::vector<Value*>& rows) {
  const std::size_t n = rows.size();
  for (std::size_t step = 1; step < n; step *= 2)
    for (std::size_t i = 0; i < n; ++i) {
      if (i & step) continue;
      std::vector<int> upper, lower;
      for (std::size_t l = 0; l < n; ++l) {
        upper.push_back(static_cast<int>(l & step ? n + l - step : l));
        lower.push_back(static_cast<int>(l & step ? n + l : l + step));
      }
      Value *const a = rows[i], *const b = rows[i + step];
      rows[i] = b_.CreateShuffleVector(a, b, upper);
      rows[i + step] = b_.CreateShuffleVector(a, b, lower);
    }
}

// Solves side by side in a function of its own: in many lanes the solutions would be most of the code.
void Emitter::invert_sides_by_call() {
  const SparseLu& e = *k_.elimination;
  for (const std::uint32_t side : p_.sides) {
    for (const std::uint32_t other : p_.sides) store(number(other == side ? 1 : 0), k_.side + std::int64_t{other});
    b_.CreateCall(substitution_, {w_});
    for (std::size_t i = 0; i < e.influences.size(); ++i)
      if (e.influences[i].side == side)
        store(load(k_.solution + std::int64_t{e.influences[i].column}), k_.inverse + static_cast<std::int64_t>(i));
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
    side_.push_back(opposite(get(p_.roots[i], c)));
    return;
  }
  side_.push_back(b_.CreateFMul(get(p_.roots[i], c), b_.CreateFNeg(rising(c, 0))));
}

void Emitter::sides() {
  side_.clear();
  for (std::size_t i = 0; i < p_.roots.size(); ++i) side(i);
}

void Emitter::solve() {
  if (const SparseLu& e = *k_.elimination; !e.influences.empty()) {
    solution_.assign(p_.rows, nullptr);
    std::uint32_t from = 0;  // the columns before are solved
    if (lanes_ == 1 && p_.x.size() >= kManyUnknowns && e.influences.size() == p_.x.size() * p_.sides.size())
      from = multiply_by_inverse();
    for (std::size_t i = 0; i < e.influences.size(); ++i) {
      if (e.influences[i].column < from) continue;
      const SparseLu::Influence& of = e.influences[i];
      Value*& y = solution_[of.column];
      Value* const side = side_[of.side];
      y = of.sign == 0  ? fma(load(k_.inverse + static_cast<std::int64_t>(i)), side, y ? y : number(0))
           : of.sign > 0 ? side
                        : opposite(side);
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

// Multiplies by four columns of a full inverse at once; returns the number of columns done.
std::uint32_t Emitter::multiply_by_inverse() {
  auto* four = llvm::FixedVectorType::get(b_.getDoubleTy(), 4);
  const std::size_t n = p_.x.size(), whole = n / 4 * 4;
  std::vector<Value*> sums(n / 4, llvm::ConstantAggregateZero::get(four));
  for (std::size_t r = 0; r < p_.sides.size(); ++r) {
    Value* side = b_.CreateVectorSplat(4, side_[p_.sides[r]]);
    for (std::size_t c = 0; c < sums.size(); ++c)
      sums[c] = fma(b_.CreateAlignedLoad(four, address(k_.inverse + static_cast<std::int64_t>(r * n + 4 * c), false),
                                         llvm::Align(8)),
                    side, sums[c]);
  }
  for (std::size_t j = 0; j < whole; ++j) solution_[j] = b_.CreateExtractElement(sums[j / 4], j % 4);
  return static_cast<std::uint32_t>(whole);
}

// Returns s minus an entry of the linearized tape times x; for an entry 1 or -1 this is exact without the product.
llvm::Value* Emitter::minus_entry(std::uint32_t entry, Value* x, Value* s) {
  if (!s) s = number(0);
  if (!unit(entry)) return fma(b_.CreateFNeg(constant(k_.entries + std::int64_t{entry})), x, s);
  const Entry& e = p_.entries[entry];
  return (e.sign > 0) == p_.coefficients[e.from].one() ? b_.CreateFSub(s, x) : b_.CreateFAdd(s, x);
}

bool Emitter::unit(std::uint32_t entry) const {
  const std::uint32_t from = p_.entries[entry].from;
  return from < p_.coefficients.size() && (p_.coefficients[from].one() || p_.coefficients[from].minus_one());
}

// Emits forward and backward substitution, from side_ to solution_.
void Emitter::substitute(bool all_sides) {
  const SparseLu& e = *k_.elimination;
  for (Value*& v : side_)
    if (!v) v = number(0);
  for (const SparseLu::Forward& f : all_sides ? e.forward_all : e.forward)
    side_[f.to] = fma(b_.CreateFNeg(load(k_.lu + f.entry)), side_[f.from], side_[f.to]);
  solution_.assign(p_.rows, nullptr);
  for (const SparseLu::Backward& back : e.backward) {
    Value* s = back.zero_side && !all_sides ? number(0) : side_[back.row];
    for (std::uint32_t i = back.first; i < back.first + back.count; ++i)
      s = fma(b_.CreateFNeg(load(k_.lu + e.terms[i].entry)), solution_[e.terms[i].column], s);
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
    // Solves again for the residual of the solution.
    const std::vector<Value*> first = solution_;
    for (Value*& v : left)
      if (!v) v = number(0);
    for (std::size_t i = 0; i < p_.entries.size(); ++i) {
      const Entry& entry = p_.entries[i];
      left[entry.row] =
          fma(b_.CreateFNeg(load(k_.entries + static_cast<std::int64_t>(i))), first[entry.column], left[entry.row]);
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

}  // namespace anholon::jit
