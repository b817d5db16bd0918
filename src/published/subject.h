// A model as the subject of published equations: its derived equations, its vocabulary, and the names that a misprint
// may exchange.
#pragma once
#include <functional>
#include <memory>

#include "published/compare.h"
#include "published/read.h"
#include "setup/scenario.h"

namespace anholon {

class Subject {
 public:
  // `choice`: the eliminated coordinates, and the state near which they are eliminated. Functions that depend on it
  // throw Failure if it is impossible.
  explicit Subject(OpenModel open, StateChoice choice = {});
  ~Subject();
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  const Model& model() const { return *open_.model; }
  const Mechanics& mechanics() const { return mechanics_; }
  Vocabulary& words() { return words_; }
  const SymbolNames& names() const { return comparer_.names(); }

  std::vector<PublishedEquation> read(const SourceText& equations, Diagnostics& diagnostics) {
    return read_equations(equations, words_, diagnostics);
  }
  // Whether the equation is true; with the changes that would make it true, if it is false, or the numbers of the file
  // with which it is. An equation that has no value is unknown.
  Comparison compare(const PublishedEquation& equation);
  // As above, without a search for changes and for the nearest equation.
  Comparison judge(const PublishedEquation& equation) { return comparer_.decide(difference(equation)); }
  Expr difference(const PublishedEquation& equation) {
    return words_.number(equation.left) - words_.number(equation.right);
  }

 private:
  // A parameter, or an input that is free and has a number in the file.
  struct Numbered {
    std::string name;
    Expr value;  // by numbers and, of a parameter, by others
    bool input = false;
    std::size_t index = 0;
  };
  static bool has_formula(const Numbered& n) { return !n.input && !symbols({&n.value, 1}).empty(); }
  // The derived equations with the numbers of the file in place of some of them.
  struct WithNumbers;
  using Parameters = std::vector<std::size_t>;  // places in numbered_

  const Elimination& elimination(bool quasi);
  WithNumbers& with_numbers(const Parameters& of);
  // The fewest of them with which it is proved, at most all that satisfy `may`; none if there are none.
  Parameters needed_for(Expr difference, const std::function<bool(const Numbered&)>& may);
  // "J = 0.5, c = 0.7"
  std::string values_of(const Parameters& of);
  // A parameter that others give keeps its formula: an equation with the formula put in is true. Returns nullopt if none is.
  std::optional<Comparison> by_formulas(Expr difference);

  // An input whose formula is a number stands for a function of time, as parameters stand for all their values.
  OpenModel with_free_inputs(OpenModel open);

  std::vector<Numbered> numbered_;
  OpenModel open_;
  StateChoice choice_;
  Mechanics mechanics_;
  std::unique_ptr<const Elimination> eliminations_[2];  // of coordinates, in quasi-velocities
  Vocabulary words_;
  Comparer comparer_;
  Alphabet alphabet_;
  std::map<Parameters, std::unique_ptr<WithNumbers>> with_numbers_;
};

}  // namespace anholon
