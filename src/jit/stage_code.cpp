#include "jit/stage_code.h"

namespace anholon::jit {

void StageCode::begin_block(Value* k0) {
  relative_ = true;
  k0_ = k0;
  block_ = b_.CreateInBoundsGEP(lane_, w_, k0);
  forget();
}

void StageCode::forget() {
  known_.clear();
  elements_.clear();
  origins_.clear();
  histories_.clear();
  stores_.clear();
}

llvm::Value* StageCode::get(const Place& place, int lead) {
  if (place.series) return known_[{place.at, stage_ + lead}] = earlier(place.at, stage_ + lead);
  const auto it = known_.find({place.at, kNoOrder});
  return it != known_.end() ? it->second : known_[{place.at, kNoOrder}] = load(place.at);
}

void StageCode::put(const Place& place, int lead, Value* v) {
  known_[{place.at, place.series ? stage_ + lead : kNoOrder}] = v;
  if (place.series) {
    llvm::StoreInst* const made = store(v, std::int64_t{place.at} + stage_ + lead, relative_);
    puts_.emplace_back(place.at, made);
    // No load has read the value that an earlier store of the same stage wrote.
    if (relative_ || stage_ > 0) {
      llvm::StoreInst*& before = stores_[{place.at, stage_ + lead}];
      if (before) before->eraseFromParent();
      before = made;
    }
  }
  // Beyond stage 0 the value is not needed again, except in other functions.
  else if ((!relative_ && stage_ <= 0) || crossing_.count(place.at) != 0)
    store(v, place.at);
}

llvm::Value* StageCode::earlier(std::uint32_t at, int order) {
  const auto it = known_.find({at, order});
  return it != known_.end() ? it->second : read(at, order, relative_);
}

llvm::Value* StageCode::constant(std::int64_t slot) {
  return noted(load(slot), {Origin::Kind::constant, static_cast<std::uint32_t>(slot)});
}

llvm::Value* StageCode::read(std::uint32_t at, int order, bool relative) {
  Value* const x = load(std::int64_t{at} + order, relative);
  reads_.emplace_back(at, x);
  return noted(x, {Origin::Kind::series, at, order, relative});
}

llvm::Value* StageCode::table(const char* name, const std::vector<double>& row, int offset) {
  if (!relative_) return number(row[static_cast<std::size_t>(stage_ + offset)]);
  Value*& element = elements_[{name, stage_ + offset}];
  if (element) return element;
  llvm::GlobalVariable*& t = tables_[name];
  if (!t) {
    llvm::Constant* data = llvm::ConstantDataArray::get(m_.getContext(), llvm::ArrayRef<double>(row));
    t = new llvm::GlobalVariable(m_, data->getType(), true, llvm::GlobalValue::PrivateLinkage, data, name);
  }
  Value* at = b_.CreateInBoundsGEP(b_.getDoubleTy(), t, k0_);
  at = b_.CreateConstGEP1_64(b_.getDoubleTy(), at,
                             static_cast<std::uint64_t>(static_cast<std::int64_t>(stage_ + offset)));
  Value* x = b_.CreateAlignedLoad(b_.getDoubleTy(), at, llvm::Align(8));
  return element = lanes_ == 1 ? x : b_.CreateVectorSplat(static_cast<unsigned>(lanes_), x);
}

llvm::Value* StageCode::row(const char* name, const std::vector<double>& rows, int m, int offset) {
  const auto first = rows.begin() + static_cast<std::ptrdiff_t>(k_.rising_at(m, 0));
  return table((name + std::to_string(m)).c_str(), {first, first + static_cast<std::ptrdiff_t>(k_.orders)}, offset);
}

llvm::Value* StageCode::order(int offset) { return table("order", k_.order.number, offset); }

llvm::Value* StageCode::rising(int m, int offset) { return row("rising", k_.rising_.number, m, offset); }

llvm::Value* StageCode::over_order(Value* x, int offset) {
  return quotient(x, table("reciprocal", k_.order.reciprocal, offset),
                  table("reciprocal_beyond", k_.order.beyond, offset));
}

llvm::Value* StageCode::over_rising(Value* x, int m) {
  return quotient(x, row("falling", k_.rising_.reciprocal, m, 0), row("falling_beyond", k_.rising_.beyond, m, 0));
}

void StageCode::put_number(std::uint32_t at, Value* v) {
  store(v, at);
  known_[{at, kNoOrder}] = v;
}

}  // namespace anholon::jit
