// A sparse LU with a fixed order of pivots, found once and used at every step.
//
// The order is Markowitz's (least fill first) among pivots that are not small in their row, at any of the sample points
// given; exact 1 and -1 are preferred, as they need no division. The result is lists of operations on the entries: no
// search, no branch at run time.
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
  // Entries: the given ones, in their order (repeated places are summed into the first), then fill.
  std::uint32_t entries = 0;
  std::vector<std::uint32_t> place;  // for a given entry: the place to which it is added

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

  // Solves for one right side of `rows` numbers. Forward: rhs[to] -= entry rhs[from], unless rhs[from] is always zero.
  struct Forward {
    std::uint32_t to, entry, from;
  };
  // Backward, pivot by pivot from the last: solution[column] = (rhs[row] - sum entry solution[other]) / pivot.
  struct Backward {
    std::uint32_t column, row, pivot;  // pivot: its index, for its reciprocal
    std::uint32_t first, count;        // into `terms`
    bool zero_side = false;            // rhs[row] is always zero
  };
  struct Term {
    std::uint32_t entry, column;
  };
  std::vector<Forward> forward, forward_all;  // all: for right sides with entries in every row
  std::vector<Backward> backward;
  std::vector<Term> terms;

  // For a small system: the inverse in place of the factors, solution[column] = sum of influence * side, the latest
  // side last. It is made from solutions for unit sides. `sign`: 1 or -1 if the solution always is this side or its
  // opposite, else 0.
  struct Influence {
    std::uint32_t column, side;
    int sign = 0;
  };
  std::vector<Influence> influences;
  // Columns that are solved from their own rows, after the columns before: solution[column] = -sum given entry *
  // solution[other].
  struct Own {
    std::uint32_t column, first, count;  // into `own_terms`
  };
  std::vector<Own> own;
  std::vector<Term> own_terms;  // terms of given entries

  double work() const {
    return static_cast<double>(influences.empty() ? forward.size() + terms.size() + backward.size()
                                                  : influences.size() + own_terms.size());
  }
};

// The pivots with their updates, and the remaining rows: column and entry.
struct SparseElimination {
  SparseLu lu;
  std::vector<std::map<std::uint32_t, std::uint32_t>> upper;
};

// Eliminates a matrix. The result has no pivots if the matrix is singular at a sample.
SparseElimination eliminate_sparse(std::uint32_t rows, std::span<const SampledEntry> entries, std::size_t samples);

// Makes the solver. Rows 0..sides-1 have a right side, all others zero. `needed`: the columns whose solution is used.
SparseLu solver(const SparseElimination& elimination, std::uint32_t sides, const std::vector<bool>& needed);

// Computes the inverse for the needed columns if it has at most `most` entries: a solution then waits only for its last
// side, not for a chain of eliminations. `sides`: in the order in which they become known; `entries`: the eliminated
// ones.
bool invert(SparseLu& elimination, std::span<const SampledEntry> entries, const std::vector<std::uint32_t>& sides,
            const std::vector<bool>& needed, std::size_t most);

// Solves the needed columns from `first` on from their own rows; each of these columns has 1 on its diagonal and no
// later column in its row.
void leave_to_own_rows(SparseLu& elimination, std::uint32_t first, std::span<const SampledEntry> entries,
                       const std::vector<bool>& needed);

}  // namespace anholon
