// An index by hash values: a flat table from hash values to ids, which copies as one block of memory.
#pragma once
#include <cstdint>
#include <vector>

namespace anholon {

// Returns the hash value of the words hashed to `hash` so far and of one more word.
inline std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
  hash ^= word + 0x9e3779b97f4a7c15ULL + (hash << 6) + (hash >> 2);
  hash *= 0xff51afd7ed558ccdULL;
  return hash ^ (hash >> 33);
}

// Several ids may have the same hash value; the owner of the ids distinguishes them.
class HashIndex {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffU;

  // Returns the id that was inserted with this hash value and for which `same(id)` holds, or kNone.
  template <class Same>
  std::uint32_t find(std::uint64_t hash, Same&& same) const {
    if (slots_.empty()) return kNone;
    const std::uint32_t key = folded(hash);
    for (std::size_t at = key & mask();; at = (at + 1) & mask()) {
      const Slot& slot = slots_[at];
      if (slot.id == kNone || (slot.key == key && same(slot.id))) return slot.id;
    }
  }

  // REQUIRES: id < kNone, and `find` has not found an equal one.
  void insert(std::uint64_t hash, std::uint32_t id) {
    if (2 * (used_ + 1) > slots_.size()) grow();
    place({folded(hash), id});
    ++used_;
  }

  // Returns a table of the entries whose id is less than `end`.
  HashIndex before(std::uint32_t end) const {
    HashIndex part;
    for (const Slot& slot : slots_)
      if (slot.id < end) part.insert(slot.key, slot.id);
    return part;
  }

 private:
  struct Slot {
    std::uint32_t key = 0;
    std::uint32_t id = kNone;
  };

  static constexpr std::size_t kLeast = 64;

  // Folding a key again gives the key.
  static std::uint32_t folded(std::uint64_t hash) { return static_cast<std::uint32_t>(hash ^ (hash >> 32)); }
  std::size_t mask() const { return slots_.size() - 1; }

  void place(Slot slot) {
    std::size_t at = slot.key & mask();
    while (slots_[at].id != kNone) at = (at + 1) & mask();
    slots_[at] = slot;
  }

  void grow() {
    std::vector<Slot> old(slots_.empty() ? kLeast : 2 * slots_.size());
    old.swap(slots_);
    for (const Slot& slot : old)
      if (slot.id != kNone) place(slot);
  }

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace anholon
