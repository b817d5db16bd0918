// Compares a published equation with the derived ones (theory: proof).
//
// P = left - right is true if it is a combination of Routh's residuals r_a and of the constraints phi_r^(k),
//
//   P = sum_a c_a r_a + sum_r d_r phi_r^(k),
//
// identically, or on the manifold of the constraints. c and d follow from dP/d(q'', lambda) = (c, d) K, where K are the
// same derivatives of the derived equations; numbers at points of the motion show which of them are not zero, so that
// only a small system is solved on the graph. It is false if it does not vanish at a point at which all derived
// equations hold.
#pragma once
#include <map>

#include "proof/equations_of_motion.h"
#include "proof/prove.h"
#include "published/edits.h"
#include "published/vocabulary.h"

namespace anholon {

// One changed place of an equation.
struct ChangedPlace {
  int side = 0;          // 0 left, 1 right
  std::size_t term = 0;  // index of the term in the side, from 0
  std::string from, to;  // the smallest term around the place; if several places change, a symbol
  Span span;
};

// The change that corrects a misprint: one place, or several that change together, of which this object is the first.
struct Change : ChangedPlace {
  std::vector<ChangedPlace> places;
  std::string equation;  // the changed equation
  Expr difference;       // left - right of the changed equation
  std::string what;      // the kind of the changed equation
  bool proved = false;
  bool identity = false;  // the changed equation holds for every motion
};

struct Comparison {
  Verdict verdict = Verdict::unknown;
  // If true, the kind of the equation; if false, the nearest true one, unless `in_places`.
  std::string what;
  std::optional<Expr> difference;       // if false, left - right less the nearest true equation
  std::optional<WitnessPoint> witness;  // if false
  std::string detail;
  std::vector<Change> changes;       // each of them makes it true
  std::optional<Change> wrong_term;  // if false without changes, the one term that is wrong or lost
  // If false or unknown, the numbers of the file with which the equation holds, "J = 0.5, c = 0.7".
  std::string with_numbers;
  // If false, true for an equation that is meant as an identity, not as an equation of motion.
  bool identity = false;
  bool trivial = false;         // the equation is true of every motion of every system
  bool of_constraints = false;  // the equation is true by the constraints alone
  bool has_value = true;        // if unknown, false for an equation that has no value on the motion
  // If false, true for an equation that holds up to round-off where all coordinates are positive.
  bool in_places = false;
};

// The kind of an equation that is true by the rates of the states alone.
inline constexpr const char* kOfRates = "a consequence of the rates of the states alone";

class Comparer {
 public:
  Comparer(const Mechanics& M, const Elimination& elimination, SymbolNames names);

  // Decides whether left - right = 0 holds; if it is false, finds the nearest true equation.
  Comparison judge(Expr published);
  // Decides only whether left - right = 0 holds.
  Comparison decide(Expr published);
  // Judges an equation; if it is false, finds the changes that would make it true.
  Comparison compare(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet);

  EquationsOfMotion& motion(unsigned highest);
  // Returns the equations of motion for an equation that may have lost its highest derivatives.
  EquationsOfMotion& motion_for_changes(Expr published);
  // Returns true if left - right contains neither accelerations nor multipliers, or they cancel.
  bool without_motion(Expr published, EquationsOfMotion& motion) const;
  const SymbolNames& names() const { return names_; }

 private:
  class Nearest;
  static constexpr const char* kIdentity = "an identity, no equation of motion";

  bool directly(Expr P, const DerivedEquation& e, EquationsOfMotion& motion, Comparison& out);
  bool combined(Expr P, EquationsOfMotion& motion, Comparison& out);
  bool on_manifold(Expr P, bool regular, Comparison& out);
  bool by_contractions(Expr P, Comparison& out);
  bool of_higher_order(Expr P, Comparison& out);
  const Column& contractions();
  void nearest(Expr P, Comparison& out);
  void nearest_of(const std::vector<Change>& changes, Expr P, Comparison& out) const;
  std::optional<Expr> combination(Expr P, EquationsOfMotion& motion, std::vector<std::pair<std::size_t, Expr>>& terms);
  std::string name(const DerivedEquation& e) const;
  std::string times(Expr factor) const;
  Expr tidy(Expr e) const;
  bool singular_at_start() const;
  bool by_solutions(Expr P, EquationsOfMotion& motion, Comparison& out) const;
  Column leading(const DerivedEquation& e, EquationsOfMotion& motion) const;

  const Mechanics& M_;
  const Elimination& elimination_;
  SymbolNames names_;
  std::map<unsigned, EquationsOfMotion> motions_;
  std::optional<Column> contractions_;
};

// Returns the order of the highest derivative that the equations of the motion must contain.
unsigned order_of_motion(Expr e);

// Returns the changes that make a false equation true: changes of one place, else the fewest of up to four places.
std::vector<Change> repairs(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet,
                            Comparer& comparer);

// Returns the change by which left - right loses `difference`: a term of a false equation gets another number as its
// factor, or is removed, or is added to a side. A lost term has an empty text before the change, a removed term an
// empty text after it. Returns nullopt if the difference is a sum or has sums among its factors.
std::optional<Change> wrong_term(const PublishedEquation& equation, Expr difference, Vocabulary& words,
                                 const SymbolNames& names, std::vector<PointValues>& points);

}  // namespace anholon
