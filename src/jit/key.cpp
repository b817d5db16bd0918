#include "jit/key.h"

#include <cstdio>

#include <llvm/Support/xxhash.h>

namespace anholon::jit {

std::string Key::text() const {
  char digits[33];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(half[0]),
                static_cast<unsigned long long>(half[1]));
  return digits;
}

Key hash(llvm::StringRef bytes) {
  const auto h = llvm::xxh3_128bits({bytes.bytes_begin(), bytes.bytes_end()});
  return {{h.low64, h.high64}};
}

// Uses structured bindings: a member that is added later and forgotten here does not compile.

void Writer::add(const Place& place) {
  const auto& [at, series] = place;
  all(at, series);
}

void Writer::add(const Step& step) {
  const auto& [act, lead, a_constant, b_constant, a_unknown, b_unknown, b_later, out, a, b, c, d, e, f, first, count,
               constants, index, value] = step;
  all(act, lead, a_constant, b_constant, a_unknown, b_unknown, b_later, out, a, b, c, d, e, f, first, count, constants,
      index, value);
}

void Writer::add(const PlanTerm& term) {
  const auto& [coefficient, x] = term;
  all(coefficient, x);
}

// Values are numbers of the arena; the code depends only on which of them are 1 and -1.
void Writer::add(const Coefficient& coefficient) { all(coefficient.one(), coefficient.minus_one()); }

void Writer::add(const Partial& partial) {
  const auto& [kind, out, a, b] = partial;
  all(kind, out, a, b);
}

void Writer::add(const Beyond& beyond) {
  const auto& [at, index] = beyond;
  all(at, index);
}

void Writer::add(const Entry& entry) {
  const auto& [row, column, from, sign] = entry;
  all(row, column, from, sign);
}

void Writer::add(const Completion& completion) {
  const auto& [out, lead, column, fresh] = completion;
  all(out, lead, column, fresh);
}

// The values at the samples only serve the choice of the pivots.
void Writer::add(const SparseLu::Pivot& pivot) {
  [[maybe_unused]] const auto& [row, column, entry, one, minus_one, first_scaled, scaled, first_update, updates,
                                value] = pivot;
  all(row, column, entry, one, minus_one, first_scaled, scaled, first_update, updates);
}

void Writer::add(const SparseLu::Update& update) {
  const auto& [to, l, u] = update;
  all(to, l, u);
}

void Writer::add(const SparseLu::Forward& forward) {
  const auto& [to, entry, from] = forward;
  all(to, entry, from);
}

void Writer::add(const SparseLu::Backward& backward) {
  const auto& [column, row, pivot, first, count, zero_side] = backward;
  all(column, row, pivot, first, count, zero_side);
}

void Writer::add(const SparseLu::Influence& influence) {
  const auto& [column, side, sign] = influence;
  all(column, side, sign);
}

void Writer::add(const SparseLu::Own& own) {
  const auto& [column, first, count] = own;
  all(column, first, count);
}

void Writer::add(const SparseLu::Term& term) {
  const auto& [entry, column] = term;
  all(entry, column);
}

// The former value of a pivot is a number of the arena, so the code does not depend on it.
void Writer::add(const JudgedPivot& pivot) {
  [[maybe_unused]] const auto& [at, inverse] = pivot;
  all(at);
}

void Writer::add(const Findings& found) {
  // Only the tables compute the defect and what hides.
  [[maybe_unused]] const auto& [health, determinant, drift, weight, moved, reach, unfit, largest, defect, hidden] =
      found;
  all(health, determinant, drift, weight, moved, reach, unfit, largest);
}

void Writer::add(const KernelTables::Knots& knots) {
  const auto& [at, values] = knots;
  all(at, values);
}

void Writer::add(const KernelTables::Divisors& divisors) {
  const auto& [number, reciprocal, beyond] = divisors;
  all(number, reciprocal, beyond);
}

void Writer::add(const Plan& plan) {
  // What decides which functions hold, and hiding functions, affect only the choice of steps; the determinant is among
  // the judged numbers.
  [[maybe_unused]] const auto& [stages, stride, arena, coefficients, point, stage, after, terms, partials, weigh_again,
                                entries, completions, x, time, roots, root_is_zero, sides, quadratures, beyond_double,
                                deciding, hiding, rows, largest_lead, largest_d, c, d, scales, determinant] = plan;
  all(stages, stride, arena, coefficients, point, stage, after, terms, partials, weigh_again, entries, completions, x,
      time, roots, root_is_zero, sides, quadratures, beyond_double, rows, largest_lead, largest_d, c, d, scales);
}

void Writer::add(const SparseLu& elimination) {
  const auto& [entries, place, pivots, scaled_entries, update_list, forward, forward_all, backward, terms, influences,
               own, own_terms] = elimination;
  all(entries, place, pivots, scaled_entries, update_list, forward, forward_all, backward, terms, influences, own,
      own_terms);
}

void Writer::add(const KernelTables& tables) {
  // The places of motions to read and write are arguments of the code.
  [[maybe_unused]] const auto& [plan, elimination, knots, lu, reciprocal, inverse, rhs, side, solution, refined,
                                entries, step, weights, increments, sums, motions, projected, margin, inverse_pivots,
                                found, size, state_size, judged, refine, factorial, inverse_factorial, order, rising,
                                orders] = tables;
  all(*plan, *elimination, knots, lu, reciprocal, inverse, rhs, side, solution, refined, entries, step, weights,
      increments, sums, margin, inverse_pivots, found, state_size, judged, refine, factorial, inverse_factorial, order,
      rising, orders);
}

}  // namespace anholon::jit
