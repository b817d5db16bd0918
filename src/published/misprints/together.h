// Changes of several places that together make left - right vanish.
//
// If changes add up (published/misprints/trial.h), the sum of their effects must equal the error of left - right. Sets of up to
// four changes are two halves of up to two; one half is looked up among the others by its value at a point. Changes in
// factors of one product are first combined and tried as one. A set holds at most one change other than lost dots, or
// two of them. The numbers of pairs and of connected sets are bounded; sets beyond these bounds are not found.
#pragma once
#include "published/misprints/trial.h"

namespace anholon {

// Changes that are made together, and their cost: a measure of how unlikely they are as a misprint.
struct Misprint {
  std::vector<std::uint32_t> edits;  // indices of edits of the trial
  int cost = 0;
};

class Together {
 public:
  static constexpr unsigned kMost = 4;

  Together(Trial& trial, const Syntax& difference);
  // Returns the sets of `count` changes by which left - right vanishes, the likely ones first. A misprint that changes
  // several places in one way counts once: a symbol that lost its dots or was mistaken for another one everywhere, an
  // exponent that moved to another factor.
  std::vector<Misprint> sets_of(unsigned count);

 private:
  struct Item {
    std::vector<std::uint32_t> edits;
    int cost;
    bool dots;
    Numbers change;
  };
  struct Items {  // up to four, in the order of insertion
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
  std::vector<Sum> singles_, dots_;       // sums of one item; sorted
  std::vector<Sum> pairs_;                // sums of two lost dots; sorted
  std::vector<Sum> bound_;                // sums of a lost dot and another change that do not add up
  std::vector<Sum> triples_;              // sums of three lost dots that do not add up
  std::vector<std::uint32_t> dot_items_;  // the items of lost dots, those of one place first
  std::uint32_t single_dots_ = 0;
  std::vector<Relation> of_dots_;  // relations of two lost dots
  bool singles_known_ = false, pairs_known_ = false;
  std::size_t tried_ = 0, looked_up_ = 0;
  std::map<std::vector<std::uint32_t>, int> found_;  // cost by edits
};

}  // namespace anholon
