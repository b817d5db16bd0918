// Changes of several places that let left - right vanish together.
//
// Where changes add (published/trial.h), the sum of their growths must be what left - right lacks: sets of up to four
// are two halves of up to two, of which one is looked up among the others by its number at a point. Changes in factors
// of one product are tried together first, as one. Of changes other than lost dots a set holds one, or two. The numbers
// of pairs and of connected sets are bounded; what lies beyond is not found.
#pragma once
#include "published/trial.h"

namespace anholon {

// Changes that are made together, and how unlikely they are as a misprint.
struct Misprint {
  std::vector<std::uint32_t> edits;  // of the trial
  int cost = 0;
};

class Together {
 public:
  static constexpr unsigned kMost = 4;

  Together(Trial& trial, const Syntax& difference);
  // The sets of `count` changes by which left - right vanishes, the likely ones first. What one misprint changes in
  // several places counts once: a symbol that lost its dots or was mistaken for another one everywhere, an exponent
  // that moved to another factor.
  std::vector<Misprint> sets_of(unsigned count);

 private:
  struct Item {
    std::vector<std::uint32_t> edits;
    int cost;
    bool dots;
    Numbers change;
  };
  struct Items {  // up to four, in the order in which they were put in
    std::array<std::uint32_t, kMost> list{};
    std::uint32_t size = 0;
    Items(std::initializer_list<std::uint32_t> items = {}) {
      for (std::uint32_t i : items) list[size++] = i;
    }
    const std::uint32_t* begin() const { return list.data(); }
    const std::uint32_t* end() const { return list.data() + size; }
  };
  struct Sum {
    Items items;
    Numbers change, extent;
  };
  enum class Relation : std::uint8_t { impossible, independent, bound };

  void put(std::vector<std::uint32_t> edits, int cost, bool dots);
  void symbols_everywhere(const Syntax& difference);
  void moved_exponents(const Syntax& difference);
  Relation relation(std::uint32_t a, std::uint32_t b) const;
  bool independent(const Items& a, const Items& b) const;
  std::optional<Sum> joined(const Items& items);
  void prepare_singles();
  void prepare_pairs();
  std::vector<Sum> connected(unsigned count);
  void connect(std::vector<std::uint32_t>& set, const std::vector<std::uint32_t>& open, unsigned count,
               std::vector<Sum>& out);
  void try_bound_pairs();
  void find(const std::vector<Sum>& sums, const std::vector<Sum>& sorted);
  void check(const Sum& s);

  Trial& trial_;
  std::vector<Item> items_;
  std::vector<Sum> singles_, dots_;       // of one item; sorted
  std::vector<Sum> pairs_;                // of lost dots; sorted
  std::vector<Sum> bound_;                // a lost dot and another change that do not add
  std::vector<Sum> triples_;              // of lost dots that do not add
  std::vector<std::uint32_t> dot_items_;  // those of one place first
  std::uint32_t single_dots_ = 0;
  std::vector<Relation> of_dots_;  // of two of them
  bool singles_known_ = false, pairs_known_ = false;
  std::size_t tried_ = 0, looked_up_ = 0;
  std::map<std::vector<std::uint32_t>, int> found_;  // cost by edits
};

}  // namespace anholon
