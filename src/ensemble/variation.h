// The numbers that differ from case to case: grids, lists, tables and draws.
//
// Grids, lists and a table are axes: there is a case for each combination of their points, the last axis fastest. Draws
// are random, or the points of a Sobol sequence in as many dimensions as names are drawn; these points are shifted by
// the seed, and each point of the grid has the same ones.
#pragma once
#include <span>

#include "ensemble/case.h"
#include "ensemble/case_table.h"
#include "setup/words/mistake_in_word.h"
#include "setup/words/value_range.h"

namespace anholon {

class Variation {
 public:
  enum class Draws : std::uint8_t { random, sobol };
  explicit Variation(std::uint64_t seed = 0, Draws draws = Draws::random) : seed_(seed), draws_(draws) {}

  // Adds NAME=FROM:TO:COUNT, NAME=A,B,…, NAME~normal(MEAN,DEVIATION) or NAME~uniform(FROM,TO). The points of a grid are
  // computed when they are needed. Throws MistakeInWord.
  void add(const std::string& word, const Model& model);
  // Adds a list of values. Throws MistakeInWord, also if one has the unit of another quantity.
  void add(const std::string& name, const std::vector<Constant>& values, const Model& model);
  // Adds the cases of a table, all of which are read once. Throws MistakeInWord.
  void add(std::shared_ptr<const CaseTable> table, const Model& model);
  // Makes the lists that are added from here on vary together, value by value: they are one axis. Throws MistakeInWord
  // if one of them has another length.
  void together() { together_ = true; }
  // Sets the number of cases; without a number there are all points of the grid. Call it at the end. `called`: the name
  // of the number in messages. Throws Failure without a place if nothing varies or the number does not fit.
  void finish(std::optional<std::size_t> cases, const std::string& called);

  // Sets one case in which nothing differs from the model.
  void finish_with_one() { cases_ = 1; }

  static constexpr std::size_t kMostCases = 1'000'000'000'000;

  const std::vector<Varied>& varied() const { return varied_; }
  std::size_t cases() const { return cases_; }
  // The numbers of a case, as in EnsembleCase; they depend on the number of the case alone. Cases run through the grid, the last name
  // fastest.
  std::vector<Rational> operator()(std::size_t number) const;

  // The number of points of each axis, the last one fastest.
  const std::vector<std::size_t>& axes() const { return axes_; }
  // Throws Failure without a place unless all values belong to ascending or descending grids and lists.
  void must_be_a_grid() const;
  // The values at a place of a grid that is 2^halvings times as fine. REQUIRES: must_be_a_grid() does not throw.
  std::vector<Rational> between(std::span<const std::int64_t> places, unsigned halvings) const;

 private:
  struct Values {
    std::optional<ValueRange> range;  // of a grid or a list
    std::optional<std::size_t> cell;  // the cell in a line of the table
    std::size_t axis = 0;             // of a range or a cell
    enum class Law : std::uint8_t { normal, uniform } law = Law::normal;
    double a = 0, b = 0;  // parameters of the distribution
    std::uint32_t stream = 0;
    bool drawn() const { return !range && !cell; }
  };
  Values law(const std::string& word, std::size_t sign, GivenQuantity& of);
  GivenQuantity name(const std::string& word, std::size_t sign, const Model& model);
  std::size_t new_axis(std::size_t size);
  double draw(const Values& v, std::size_t number) const;

  std::vector<Varied> varied_;
  std::vector<Values> values_;
  std::vector<std::size_t> axes_;  // the sizes of the axes
  std::shared_ptr<const CaseTable> table_;
  std::optional<std::size_t> common_;  // the axis of lists that vary together
  bool together_ = false;
  std::size_t grid_ = 1, cases_ = 0;
  std::uint64_t seed_;
  Draws draws_;
  std::uint32_t streams_ = 0;  // the number of random streams
};

// Throws Failure without a place if a name is both varied and given: in the state that all cases share, or among these
// parameters.
void must_not_be_given(const std::vector<Varied>& varied, const StateChoice& state,
                       const std::vector<std::string>& parameters = {});

}  // namespace anholon
