#include "jit/packer.h"

#include <algorithm>
#include <queue>

#include <llvm/IR/IntrinsicInst.h>

namespace anholon::jit {

namespace {

bool is_fma(const llvm::Instruction& i) {
  const auto* call = llvm::dyn_cast<llvm::IntrinsicInst>(&i);
  return call && call->getIntrinsicID() == llvm::Intrinsic::fma;
}

bool calculates(const llvm::Instruction& i) {
  switch (i.getOpcode()) {
  case llvm::Instruction::FAdd:
  case llvm::Instruction::FSub:
  case llvm::Instruction::FMul:
  case llvm::Instruction::FNeg:
    return i.getType()->isDoubleTy();
  case llvm::Instruction::Call:
    return is_fma(i) && i.getType()->isDoubleTy();
  default:
    return false;
  }
}

unsigned operand_count(const llvm::Instruction& i) { return is_fma(i) ? 3 : i.getNumOperands(); }

// A called function may read and write anything; fused multiplications do not.
bool is_call(const llvm::Instruction& i) { return llvm::isa<llvm::CallInst>(i) && !llvm::isa<llvm::IntrinsicInst>(i); }

}  // namespace

Packer::Packer(llvm::BasicBlock& block, llvm::IRBuilder<>& builder, PackedMemory& memory,
               const std::unordered_map<Value*, Origin>& origins, std::function<Value*(PackedMemory::Place)> address)
    : block_(block), b_(builder), memory_(memory), origins_(origins), address_(std::move(address)),
      width_(memory.width()), vector_type_(llvm::FixedVectorType::get(builder.getDoubleTy(), memory.width())) {}

void Packer::run() {
  read();
  for (const Lanes& w : wanted_) form(w);
  for (const Kept& k : kept_) form(k.values);
  for (std::size_t g = 0; g < groups_.size(); ++g) grow(g);
  write();
  clear();
}

// Collects the instructions before the end of the block, and, for each, the instructions that have to come before it:
// its operands and, for memory, earlier stores and calls.
void Packer::read() {
  for (Instruction& i : block_)
    if (!i.isTerminator()) {
      index_[&i] = static_cast<int>(code_.size());
      code_.push_back(&i);
    }
  needs_.resize(code_.size());
  users_.resize(code_.size());
  group_.assign(code_.size(), kNone);
  seen_.assign(code_.size(), 0);
  // An address is a base and an offset; stores to other bases do not matter.
  using Address = std::pair<const Value*, std::int64_t>;
  const auto address = [](const Value* pointer) -> Address {
    const auto* at = llvm::dyn_cast<llvm::GetElementPtrInst>(pointer);
    if (at && at->getNumIndices() == 1)
      if (const auto* offset = llvm::dyn_cast<llvm::ConstantInt>(at->getOperand(1)))
        return {at->getPointerOperand(), offset->getSExtValue()};
    return {pointer, 0};
  };
  std::map<Address, std::vector<int>> touched;  // accesses since the last store, and that store
  int last_call = kNone;
  std::vector<int> since_call;
  for (int i = 0; i < static_cast<int>(code_.size()); ++i) {
    Instruction& in = *code_[i];
    std::vector<int>& needs = needs_[i];
    for (const Value* v : in.operands())
      if (const auto it = index_.find(v); it != index_.end())
        needs.push_back(it->second), users_[it->second].push_back(i);
    if (is_call(in)) {
      needs.insert(needs.end(), since_call.begin(), since_call.end());
      if (last_call != kNone) needs.push_back(last_call);
      last_call = i;
      since_call.clear();
      continue;
    }
    const bool stores = llvm::isa<llvm::StoreInst>(in);
    if (!stores && !llvm::isa<llvm::LoadInst>(in)) continue;
    if (last_call != kNone) needs.push_back(last_call);
    since_call.push_back(i);
    std::vector<int>& before = touched[address(llvm::getLoadStorePointerOperand(&in))];
    for (const int o : before)
      if (stores || llvm::isa<llvm::StoreInst>(code_[o])) needs.push_back(o);
    if (stores) before.clear();
    before.push_back(i);
  }
}

const Origin* Packer::origin(const Value* v) const {
  const auto it = origins_.find(const_cast<Value*>(v));
  return it == origins_.end() ? nullptr : &it->second;
}

bool Packer::alike(const Value* x, const Value* y) const {
  if (x == y) return true;
  const Origin *a = origin(x), *b = origin(y);
  return a && b && *a == *b;
}

int Packer::group_of(const Value* v) const {
  const auto it = index_.find(v);
  return it == index_.end() ? kNone : group_[it->second];
}

// True if the values are one value in all lanes, constants, or the members of a group in their lanes.
bool Packer::ready(const Lanes& values) const {
  const Value* first = nullptr;
  int group = kNone;
  bool splat = true, constants = true, grouped = true;
  for (unsigned l = 0; l < width_; ++l) {
    const Value* v = values[l];
    if (!v) continue;
    if (!first) first = v, group = group_of(v);
    splat = splat && alike(v, first);
    constants = constants && llvm::isa<llvm::ConstantFP>(v);
    grouped = grouped && group != kNone && group_of(v) == group && groups_[group].lanes[l] == v;
  }
  return splat || constants || grouped;
}

bool Packer::same_operation(const std::vector<Instruction*>& members) const {
  const Instruction* first = nullptr;
  unsigned count = 0;
  for (const Instruction* i : members) {
    if (!i) continue;
    if (!first) first = i;
    if (i->getOpcode() != first->getOpcode() || i->getType() != first->getType() ||
        (llvm::isa<llvm::CallInst>(i) && !is_fma(*i)))
      return false;
    ++count;
  }
  return count >= fewest_lanes(width_);
}

// True if no member depends on another, directly or through groups.
bool Packer::independent(const std::vector<Instruction*>& members) {
  ++search_;
  std::vector<int> open;
  const auto visit = [&](int i) {
    const auto add = [&](int k) {
      if (seen_[k] != search_) seen_[k] = search_, open.push_back(k);
    };
    if (group_[i] == kNone) return add(i);
    for (const Instruction* m : groups_[group_[i]].lanes)
      if (m) add(index_.at(m));
  };
  for (const Instruction* m : members)
    if (m)
      for (const int o : needs_[index_.at(m)]) visit(o);
  while (!open.empty()) {
    const int i = open.back();
    open.pop_back();
    if (std::find(members.begin(), members.end(), code_[i]) != members.end()) return false;
    for (const int o : needs_[i]) visit(o);
  }
  return true;
}

Packer::Lanes Packer::operands(const Group& g, unsigned k) const {
  Lanes values(width_, nullptr);
  for (unsigned l = 0; l < width_; ++l)
    if (g.lanes[l]) values[l] = g.lanes[l]->getOperand(k);
  return values;
}

bool Packer::form(const Lanes& values) {
  if (ready(values)) return true;
  std::vector<Instruction*> members(width_, nullptr);
  std::vector<const Origin*> origins(width_, nullptr);
  bool known = true;
  for (unsigned l = 0; l < width_; ++l) {
    if (!values[l]) continue;
    const auto it = index_.find(values[l]);
    if (it == index_.end() || group_[it->second] != kNone ||
        std::find(members.begin(), members.end(), code_[it->second]) != members.end())
      return false;
    members[l] = code_[it->second];
    origins[l] = origin(values[l]);
    known = known && origins[l];
  }
  if (!same_operation(members)) return false;
  const Instruction& some =
      **std::find_if(members.begin(), members.end(), [](const Instruction* m) { return m != nullptr; });
  Group g{members, {}, false, nullptr, std::vector<Value*>(width_, nullptr)};
  if (llvm::isa<llvm::LoadInst>(some)) {
    if (!known || !(g.place = memory_.find(origins))) return false;
  } else if (const auto* part = llvm::dyn_cast<llvm::ExtractElementInst>(&some)) {
    if (part->getVectorOperandType() != vector_type_) return false;
    for (unsigned l = 0; l < width_; ++l)
      if (members[l]) {
        const auto* lane = llvm::dyn_cast<llvm::ConstantInt>(members[l]->getOperand(1));
        if (!lane || lane->getZExtValue() != l || members[l]->getOperand(0) != part->getVectorOperand()) return false;
      }
    g.parts = true;
  } else if (!calculates(some)) {
    return false;
  }
  if (!independent(members)) return false;
  const int number = static_cast<int>(groups_.size());
  groups_.push_back(g);
  const auto put = [&](int of) {
    for (const Instruction* m : members)
      if (m) group_[index_.at(m)] = of;
  };
  put(number);
  if (g.place || g.parts) return true;
  unsigned by_hand = 0;
  for (unsigned k = 0; k < operand_count(some); ++k)
    if (!form(operands(g, k))) ++by_hand;
  if (by_hand <= (some.getOpcode() == Instruction::FNeg ? 0U : 1U)) return true;
  put(kNone);
  groups_[number].lanes.assign(width_, nullptr);  // the group is dissolved
  return false;
}

// Forms groups of the operations that use a group in the same way in all its lanes.
void Packer::grow(std::size_t number) {
  // Key: operation, index of the operand, the other operands.
  using Use = std::vector<unsigned>;
  std::map<Use, std::vector<std::vector<Instruction*>>> uses;  // the n-th use of each lane
  for (unsigned l = 0; l < width_; ++l) {
    const Instruction* member = groups_[number].lanes[l];
    if (!member) continue;
    std::map<Use, std::size_t> count;
    for (const int u : users_[index_.at(member)]) {
      Instruction& user = *code_[u];
      if (group_[u] != kNone || !calculates(user)) continue;
      Use use{user.getOpcode()};
      for (unsigned k = 0; k < operand_count(user); ++k) {
        const Value* v = user.getOperand(k);
        const auto* made = llvm::dyn_cast<Instruction>(v);
        use.push_back(v == member ? 0 : made ? 1 + made->getOpcode() : 1);
      }
      std::vector<std::vector<Instruction*>>& lanes = uses[use];
      const std::size_t n = count[use]++;
      if (lanes.size() <= n) lanes.resize(n + 1, std::vector<Instruction*>(width_, nullptr));
      lanes[n][l] = &user;
    }
  }
  for (const auto& [use, list] : uses)
    for (const std::vector<Instruction*>& lanes : list) form(Lanes(lanes.begin(), lanes.end()));
}

// Writes all instructions in an order in which each comes after those that it needs: the old order, but with the
// members of a group together.
void Packer::write() {
  const int groups = static_cast<int>(groups_.size());
  const auto unit = [&](int i) { return group_[i] == kNone ? groups + i : group_[i]; };
  std::vector<int> waits(static_cast<std::size_t>(groups) + code_.size(), 0),
      first(waits.size(), static_cast<int>(code_.size()));
  std::vector<std::vector<int>> next(waits.size());
  for (int i = 0; i < static_cast<int>(code_.size()); ++i) {
    first[unit(i)] = std::min(first[unit(i)], i);
    for (const int o : needs_[i])
      if (unit(o) != unit(i)) next[unit(o)].push_back(unit(i)), ++waits[unit(i)];
  }
  std::priority_queue<std::pair<int, int>, std::vector<std::pair<int, int>>, std::greater<>>
      open;  // in the order of the code
  for (std::size_t u = 0; u < waits.size(); ++u)
    if (waits[u] == 0 && first[u] < static_cast<int>(code_.size())) open.push({first[u], static_cast<int>(u)});
  b_.SetInsertPoint(block_.getTerminator());
  while (!open.empty()) {
    const int u = open.top().second;
    open.pop();
    if (u < groups) {
      write_group(groups_[u]);
    } else {
      Instruction& in = *code_[u - groups];
      in.moveBefore(block_.getTerminator());
      for (llvm::Use& use : in.operands()) {
        b_.SetInsertPoint(&in);
        use.set(scalar(use.get()));
        b_.SetInsertPoint(block_.getTerminator());
      }
    }
    for (const int o : next[u])
      if (--waits[o] == 0) open.push({first[o], o});
  }
  for (const Kept& k : kept_) b_.CreateAlignedStore(vector(k.values), address_(k.place), llvm::Align(8 * width_));
}

void Packer::write_group(Group& g) {
  const Instruction& some =
      **std::find_if(g.lanes.begin(), g.lanes.end(), [](const Instruction* m) { return m != nullptr; });
  if (g.place) {
    g.vector = b_.CreateAlignedLoad(vector_type_, address_(*g.place), llvm::Align(8 * width_));
    return;
  }
  if (g.parts) {
    g.vector = some.getOperand(0);
    return;
  }
  std::vector<Value*> x;
  for (unsigned k = 0; k < operand_count(some); ++k) x.push_back(vector(operands(g, k)));
  switch (some.getOpcode()) {
  case Instruction::FAdd:
    g.vector = b_.CreateFAdd(x[0], x[1]);
    break;
  case Instruction::FSub:
    g.vector = b_.CreateFSub(x[0], x[1]);
    break;
  case Instruction::FMul:
    g.vector = b_.CreateFMul(x[0], x[1]);
    break;
  case Instruction::FNeg:
    g.vector = b_.CreateFNeg(x[0]);
    break;
  default:
    g.vector = b_.CreateIntrinsic(llvm::Intrinsic::fma, {vector_type_}, x);
    break;
  }
}

llvm::Value* Packer::scalar(Value* v) {
  const int g = group_of(v);
  if (g == kNone) return v;
  Group& group = groups_[g];
  const std::size_t lane =
      static_cast<std::size_t>(std::find(group.lanes.begin(), group.lanes.end(), v) - group.lanes.begin());
  if (!group.scalars[lane]) group.scalars[lane] = b_.CreateExtractElement(group.vector, lane);
  return group.scalars[lane];
}

llvm::Value* Packer::vector(const Lanes& values) {
  Value*& made = gathered_[values];
  if (made) return made;
  Value* first = nullptr;
  for (Value* v : values)
    if (v && !first) first = v;
  if (ready(values)) {
    bool splat = true, constants = true;
    for (Value* v : values)
      splat = splat && (!v || alike(v, first)), constants = constants && (!v || llvm::isa<llvm::ConstantFP>(v));
    if (splat) return made = b_.CreateVectorSplat(width_, scalar(first));
    if (!constants) return made = groups_[group_of(first)].vector;
  }
  made = llvm::ConstantAggregateZero::get(vector_type_);
  for (unsigned l = 0; l < width_; ++l)
    if (values[l]) made = b_.CreateInsertElement(made, scalar(values[l]), l);
  return made;
}

void Packer::clear() {
  for (const Group& g : groups_)
    for (Instruction* m : g.lanes)
      if (m) m->replaceAllUsesWith(llvm::PoisonValue::get(m->getType()));
  for (const Group& g : groups_)
    for (Instruction* m : g.lanes)
      if (m) m->eraseFromParent();
  erase_dead(block_);
}

void erase_dead(llvm::BasicBlock& block) {
  std::vector<llvm::Instruction*> all;
  for (llvm::Instruction& i : block) all.push_back(&i);
  for (auto i = all.rbegin(); i != all.rend(); ++i)
    if ((*i)->use_empty() && !(*i)->mayHaveSideEffects() && !(*i)->isTerminator()) (*i)->eraseFromParent();
}

}  // namespace anholon::jit
