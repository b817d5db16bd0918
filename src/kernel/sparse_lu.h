// A sparse LU with a fixed order of pivots, found once and used at every step.
//
// The order is Markowitz's (least fill first) among pivots that are not small in their row, at any of the sample points
// given; exact 1 and -1 are preferred, as they need no division. What comes out are lists of operations on the entries:
// no search, no branch at run time.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace anholon {

inline constexpr std::size_t kSamples = 8;

// An entry of a square matrix with its value at the samples; `exact`: it always has this value.
struct SampledEntry {
  std::uint32_t row, column;
  std::array<double, kSamples> value;
  bool exact = false;
};

struct SparseLu {
  // Entries: those given, in their order (repeated places are summed into the first), then fill.
  std::uint32_t entries = 0;
  std::vector<std::uint32_t> place;  // of a given entry: where it is added

  // Factors: for each pivot in order, l = a / pivot, then a -= l u.
  struct Pivot {
    std::uint32_t row, column, entry;
    bool one = false, minus_one = false;
    std::uint32_t first_scaled = 0, scaled = 0;   // into `scaled_entries`: multipliers of this pivot
    std::uint32_t first_update = 0, updates = 0;  // into `update_list`
    std::array<double, kSamples> value{};         // at the samples
  };
  struct Update {
    std::uint32_t to, l, u;  // entry `to` -= l u
  };
  std::vector<Pivot> pivots;
  std::vector<std::uint32_t> scaled_entries;
  std::vector<Update> update_list;

  // Solves, on one right side of `rows` numbers. Forward: rhs[to] -= entry rhs[from], where that is not always zero.
  struct Forward {
    std::uint32_t to, entry, from;
  };
  // Backward, pivot by pivot from the last: solution[column] = (rhs[row] - sum entry solution[other]) / pivot.
  struct Backward {
    std::uint32_t column, row, pivot;  // pivot: index of it, for its reciprocal
    std::uint32_t first, count;        // into `terms`
    bool zero_side = false;            // rhs[row] is always zero
  };
  struct Term {
    std::uint32_t entry, column;
  };
  std::vector<Forward> forward, forward_all;  // all: for right sides in every row
  std::vector<Backward> backward;
  std::vector<Term> terms;

  // Of a system that is not large, the inverse in place of the two: solution[column] = sum of influence * side, side by
  // side, what becomes known last last. It is made of solutions for sides of one. `sign`: the solution is that side,
  // always, or its opposite (1, -1); else 0.
  struct Influence {
    std::uint32_t column, side;
    int sign = 0;
  };
  std::vector<Influence> influences;
  // Columns that are left to their own rows, once those before are solved: solution[column] = -sum given entry *
  // solution[other].
  struct Own {
    std::uint32_t column, first, count;  // into `own_terms`
  };
  std::vector<Own> own;
  std::vector<Term> own_terms;  // of entries as they are given

  double work() const {
    return static_cast<double>(influences.empty() ? forward.size() + terms.size() + backward.size()
                                                  : influences.size() + own_terms.size());
  }
};

// The pivots with what they update, and the rows they leave: column and entry.
struct SparseElimination {
  SparseLu lu;
  std::vector<std::map<std::uint32_t, std::uint32_t>> upper;
};

// No pivots if the matrix is singular at a sample.
SparseElimination eliminate_sparse(std::uint32_t rows, std::span<const SampledEntry> entries, std::size_t samples);

// What solves by it. `sides`: rows 0..sides-1 have a right side, all others zero. `needed`: the columns whose solution
// is asked for.
SparseLu solver(const SparseElimination& elimination, std::uint32_t sides, const std::vector<bool>& needed);

// The inverse for the columns needed, if it has no more than `most` entries: a solution then waits for its last side
// only, not for a chain of eliminations. `sides`: in the order in which they become known; `entries`: those that were
// eliminated.
bool invert(SparseLu& elimination, std::span<const SampledEntry> entries, const std::vector<std::uint32_t>& sides,
            const std::vector<bool>& needed, std::size_t most);

// Of all columns from `first` on, each with 1 on its diagonal and no column after it in its row, those that are needed
// are left to their own rows.
void leave_to_own_rows(SparseLu& elimination, std::uint32_t first, std::span<const SampledEntry> entries,
                       const std::vector<bool>& needed);

}  // namespace anholon
