// The system Jacobian J as a sparse matrix: one row and one unknown more for every slot that depends on the leading
// derivatives.
//
// With delta the changes of these slots and y those of the leading derivatives,
//   delta_s - sum_a (d s / d a) delta_a = 0 for every slot s,    delta_root(i) = r_i for every equation i
// is J y = r. For a chain of links J is full, and this matrix has a few entries a link (theory: taylor).
#pragma once
#include <mutex>

#include "program/program.h"
#include "program/sparse_lu.h"
#include "program/threshold_lu.h"

namespace anholon {

// The places of the entries, without numbers. Threads may share them.
class Linearized {
 public:
  // A partial derivative of slot `tainted[k]` of the program.
  enum class Source : std::uint8_t { rational, by_a, by_b };
  struct Term {
    std::uint32_t column;  // column of the operand
    std::uint32_t index;   // index of the rational, or k
    Source source;
  };

  explicit Linearized(const Program& program);

  std::uint32_t slots() const { return static_cast<std::uint32_t>(first_.size() - 1); }
  std::uint32_t unknowns() const { return static_cast<std::uint32_t>(roots_.size()); }
  std::uint32_t size() const { return slots() + unknowns(); }
  // Row and column k < slots() are of slot k; row slots() + i is of equation i, and column slots() + j of unknown j.
  const std::vector<Term>& terms() const { return terms_; }
  // The terms of slot k are first(k) to first(k + 1).
  std::uint32_t first(std::uint32_t k) const { return first_[k]; }
  // The column of the root of an equation, or kNone if it does not depend on the leading derivatives.
  static constexpr std::uint32_t kNone = 0xffffffffU;
  std::uint32_t root(std::uint32_t i) const { return roots_[i]; }

  // Returns the matrix by columns; its entries are minus the terms, in their order within a column, and ones.
  const SparseColumns& columns() const { return columns_; }
  // Returns for every entry of columns() its term, or kNone for a one.
  const std::vector<std::uint32_t>& term_of() const { return term_of_; }

  // Returns an order of elimination with little fill, found at the first call. It depends on the places of the entries
  // and on their rational numbers alone. Empty if the elimination is not much cheaper than that of a full J.
  const EliminationOrder& order() const;
  // Returns an order with little fill for these numbers of the entries of columns(); empty if J is singular.
  EliminationOrder order_for(const std::vector<double>& values) const;

 private:
  void make_columns();
  EliminationOrder make_order() const;
  // `values`: those of the entries of columns().
  SparseElimination eliminated(const std::vector<double>& values) const;

  std::vector<std::uint32_t> first_, roots_;
  std::vector<Term> terms_;
  std::vector<double> sample_;  // for each term: its number, or a number of typical size that represents any value
  SparseColumns columns_;
  std::vector<std::uint32_t> term_of_;
  mutable std::once_flag once_;
  mutable EliminationOrder order_;
};

// The Jacobian with numbers: partial derivatives at a point, in the order of the terms.
template <Number N>
using Partials = std::vector<N>;

// Computes y := J x.
template <Number N>
void multiply(const Linearized& l, const Partials<N>& partials, const std::vector<N>& x, std::vector<N>& y);

// Computes y_i := sum of |products of partials| |x_j| over all paths from unknown j to equation i: the sizes of the
// terms that the unknowns cause in an equation.
template <Number N>
void multiply_sizes(const Linearized& l, const Partials<N>& partials, const std::vector<N>& x, std::vector<N>& y);

// Computes the same with the transposed matrix.
template <Number N>
void multiply_sizes_transposed(const Linearized& l, const Partials<N>& partials, const std::vector<N>& y,
                               std::vector<N>& x);

// Returns the largest |J_ij| of each equation i over the unknowns j of class `of_class[j]` and above, for all classes:
// entry [class][i]. Makes a few columns of J at a time. Entries that are not finite give infinity.
std::vector<std::vector<double>> largest_of_rows(const Linearized& l, const Partials<double>& partials,
                                                 const std::vector<int>& of_class);

}  // namespace anholon
