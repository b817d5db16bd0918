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
  // `choice`: the eliminated coordinates, and the state near which they are eliminated. Functions that depend on the
  // elimination throw Failure if it is impossible.
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
  // Decides whether the equation is true. If it is false, finds the changes that would make it true, or the numbers of
  // the file with which it is true. An equation that has no value is unknown.
  Comparison compare(const PublishedEquation& equation);
  // Decides the same, without a search for changes and for the nearest equation.
  Comparison judge(const PublishedEquation& equation) { return comparer_.decide(difference(equation)); }
  Expr difference(const PublishedEquation& equation) {
    return words_.number(equation.left) - words_.number(equation.right);
  }

 private:
  // A parameter, or an input that is free and has a number in the file.
  struct Numbered {
    std::string name;
    Expr value;  // in terms of numbers and, for a parameter, of other parameters
    bool input = false;
    std::size_t index = 0;
  };
  static bool has_formula(const Numbered& n) { return !n.input && !symbols({&n.value, 1}).empty(); }
  // The derived equations with the numbers of the file in place of some of them.
  struct WithNumbers;
  using Parameters = std::vector<std::size_t>;  // indices in numbered_

  const Elimination& elimination(bool quasi);
  WithNumbers& with_numbers(const Parameters& of);
  // Returns numbers of the file with which the difference is proved, from those that satisfy `may`, without single ones
  // that are not needed; empty if all of them do not suffice.
  Parameters needed_for(Expr difference, const std::function<bool(const Numbered&)>& may);
  // Returns "J = 0.5, c = 0.7".
  std::string values_of(const Parameters& of);
  // Proves the equation by substituting the formulas of parameters that follow from others; nullopt if these do not
  // suffice.
  std::optional<Comparison> by_formulas(Expr difference);

  // Frees inputs: an input whose formula is a number represents a function of time, as parameters represent all their
  // values.
  OpenModel with_free_inputs(OpenModel open);

  std::vector<Numbered> numbered_;
  std::shared_ptr<const Model> as_read_;  // the model before inputs were freed, if any was
  OpenModel open_;
  StateChoice choice_;
  Mechanics mechanics_;
  std::unique_ptr<const Elimination> eliminations_[2];  // the elimination of coordinates, and that in quasi-velocities
  Vocabulary words_;
  Comparer comparer_;
  Alphabet alphabet_;
  std::map<Parameters, std::unique_ptr<WithNumbers>> with_numbers_;
};

}  // namespace anholon
