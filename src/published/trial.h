// An equation in numbers, with changes tried in it: left - right at some points, and what becomes of it.
//
// Only what stands above a changed place is computed again. Sums, products, powers, elementary functions and products
// of vectors are computed from numbers; what surrounds a place otherwise (a derivative, the velocity of a point, …) is
// evaluated as a formula once for each set of changes in it, so many of them at most.
//
// Changes add where nothing but sums lie around both: two operands of one sum, as long as all around it is linear.
// Others, in two factors of a product, have to be tried together.
#pragma once
#include <array>
#include <map>
#include <span>

#include "published/edits.h"
#include "published/vocabulary.h"
#include "tape/point.h"

namespace anholon {

inline constexpr std::size_t kTrialPoints = 3;
using Numbers = std::array<double, kTrialPoints>;  // at the points; where there are fewer, the last one again

class Trial {
 public:
  Trial(const Syntax& difference, Vocabulary& words, std::vector<PointValues>& points);
  Trial(const Trial&) = delete;
  Trial& operator=(const Trial&) = delete;

  // Edits that mean something and change something at the points; others are left out.
  void add(Edit edit);
  std::size_t size() const { return edits_.size(); }
  const Edit& edit(std::size_t i) const { return edits_[i].edit; }

  // By which left - right grows.
  const Numbers& change_of(std::size_t i) const { return edits_[i].change; }
  Numbers change(std::vector<std::uint32_t> edits);
  // What counts as nothing at a point, beside changes of that size.
  double tolerance(std::size_t point, double extent) const;
  // With growths that add up to `change`, the sum of their sizes being `extent`.
  bool vanishes(const Numbers& change, const Numbers& extent) const;
  bool vanishes(const Numbers& change) const { return vanishes(change, change); }
  const Numbers& value() const { return root_.value.c[0]; }

  bool possible(std::size_t a, std::size_t b) const;     // both at once
  bool independent(std::size_t a, std::size_t b) const;  // possible, and the changes add

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
    bool known = false;  // a number or a vector
    std::vector<Node> args;
    Amount value;
    Numbers extent{};  // of a sum, the sum of the sizes of its terms
    double (*function)(double) = nullptr;
  };
  struct Tried {
    Edit edit;
    std::optional<Amount> amount;  // what stands there then, or the factor
    std::size_t linear = 0;        // nodes on the path from which on its changes add with others
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
