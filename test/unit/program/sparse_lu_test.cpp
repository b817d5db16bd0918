// The fixed order of pivots, for coefficients that have no common scale.
#include <gtest/gtest.h>

#include "program/sparse_lu.h"

namespace anholon::sparse_lu_test {
namespace {

// Slots of a program in terms of the unknowns a and b: (1.03 + 1.77 p)^2 q, expanded with whole coefficients.
enum Column : std::uint32_t { a, b, s13, s15, s16, s20, s22, s23, s24, kColumns };

struct Term {
  Column slot, of;
  double coefficient;
};

std::size_t pivots(const std::vector<Term>& slots) {
  std::vector<SampledEntry> entries;
  const auto add = [&](std::uint32_t row, Column column, double value) {
    SampledEntry e{row, column, {}, value == 1};
    e.value.fill(value);
    entries.push_back(e);
  };
  for (std::uint32_t k = s13; k < kColumns; ++k) add(k, static_cast<Column>(k), 1);
  for (const Term& t : slots) add(t.slot, t.of, -t.coefficient);
  add(0, s23, 1), add(1, s24, 1);  // the equations
  return eliminate_sparse(kColumns, entries, kSamples).lu.pivots.size();
}

const std::vector<Term> kFirst = {{s13, a, 1.5596e6}, {s15, b, 2.4324e14},      {s16, s13, 3.5308642e7},
                                  {s16, s15, 1},      {s20, s16, 2.4324e14},    {s22, s16, 1.5596e6},
                                  {s23, a, 1},        {s23, s22, 3.5308642e-21}};

TEST(SparseLu, CoefficientsMayHaveNoCommonScale) {
  std::vector<Term> slots = kFirst;
  slots.push_back({s24, s20, 1e-28});
  EXPECT_EQ(pivots(slots), kColumns);
}

// The second equation is three tenths of the first one, up to round-off.
TEST(SparseLu, RoundOffIsNoPivot) {
  std::vector<Term> slots = kFirst;
  slots.push_back({s24, a, 0.3});
  slots.push_back({s24, s22, 0.3 * 3.5308642e-21});
  EXPECT_EQ(pivots(slots), 0U);
  slots.back().coefficient *= 1 + 1e-6;
  EXPECT_EQ(pivots(slots), kColumns);
}

}  // namespace
}  // namespace anholon::sparse_lu_test
