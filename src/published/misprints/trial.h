// Numerical trials of changes in an equation: left - right at some points, and its value after changes.
//
// Only the nodes above a changed place are computed again. Sums, products, powers, elementary functions and products of
// vectors are computed from numbers; another operation around a place (a derivative, the velocity of a point, …) is
// evaluated as a formula once for each set of changes in it, up to a bounded number of sets.
//
// The effects of two changes add up if they are in two operands of one sum and everything around the sum is linear.
// Other changes, in two factors of a product, have to be tried together.
#pragma once
#include <array>
#include <map>
#include <span>

#include "published/edits.h"
#include "published/vocabulary.h"
#include "tape/point.h"

namespace anholon {

inline constexpr std::size_t kTrialPoints = 3;
// values at the points; if there are fewer points, the last one is repeated
using Numbers = std::array<double, kTrialPoints>;

class Trial {
 public:
  Trial(const Syntax& difference, Vocabulary& words, std::vector<PointValues>& points);
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  // Adds an edit if the edited formula has a meaning and another value at the points.
  void add(Edit edit);
  std::size_t size() const { return edits_.size(); }
  const Edit& edit(std::size_t i) const { return edits_[i].edit; }

  // Returns the increase of left - right by edit i.
  const Numbers& change_of(std::size_t i) const { return edits_[i].change; }
  Numbers change(std::vector<std::uint32_t> edits);
  // Returns the tolerance below which a value at a point counts as zero beside changes of that size.
  double tolerance(std::size_t point, double extent) const;
  // True if left - right vanishes after changes with the effect `change`, with `extent` the sum of their sizes.
  bool vanishes(const Numbers& change, const Numbers& extent) const;
  bool vanishes(const Numbers& change) const { return vanishes(change, change); }
  const Numbers& value() const { return root_.value.c[0]; }

  bool possible(std::size_t a, std::size_t b) const;     // true if both edits can be made at once
  bool independent(std::size_t a, std::size_t b) const;  // true if possible, and the effects add up

 private:
  // A number, or the components of a vector.
  struct Amount {
    bool vector = false;
    std::array<Numbers, 3> c{};
  };
  struct Node {
    enum class Way : std::uint8_t { whole, sum, negative, product, power, function, component, entries, dot, cross };
    const Syntax* syntax = nullptr;
    Way way = Way::whole;
    bool known = false;  // the value is a number or a vector
    std::vector<Node> args;
    Amount value;
    Numbers extent{};  // for a sum, the sum of the sizes of its terms
    double (*function)(double) = nullptr;
  };
  struct Tried {
    Edit edit;
    std::optional<Amount> amount;  // the new value, or the factor
    std::size_t linear = 0;        // depth on the path from which on the effects of changes add up
    Numbers change{};
  };

  Node read(const Syntax& s);
  bool read_parts(Node& n);
  Numbers extent_of(const Node& n) const;
  Amount combined(const Node& n, const std::vector<const Amount*>& args) const;
  std::optional<Amount> evaluated(const Syntax& s);
  Amount with(const Node& n, std::size_t depth, std::span<const std::uint32_t> edits);
  Amount as_formula(const Node& n, std::size_t depth, std::span<const std::uint32_t> edits);

  Vocabulary& words_;
  std::vector<PointValues>& points_;
  const Syntax& syntax_;
  Node root_;
  std::vector<Tried> edits_;
  std::map<std::string, std::optional<Amount>> known_;                    // by text
  std::map<std::vector<std::uint32_t>, std::optional<Amount>> formulas_;  // by the edits
  std::size_t formulas_left_;
};

}  // namespace anholon
