#include "program/linearized.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace anholon {

namespace {

// The largest number of operations of the sparse elimination as a part of those of a full J.
constexpr double kMuchCheaper = 0.1;

// Returns a number between 1/2 and 2, of either sign, that represents a partial derivative: no two sums of such numbers
// cancel by chance.
double stand_in(std::uint32_t k) {
  const std::uint32_t draw = (k + 1) * 2654435761U;
  const double size = 0.5 + 1.5 * static_cast<double>(draw >> 8) / 16777216.0;
  return (draw & 1U) != 0 ? size : -size;
}

EliminationOrder order_of(const SparseLu& lu) {
  EliminationOrder order;
  for (const SparseLu::Pivot& pivot : lu.pivots) order.column.push_back(pivot.column), order.row.push_back(pivot.row);
  order.entries = lu.entries;
  return order;
}

}  // namespace

Linearized::Linearized(const Program& p) {
  const Tape& tape = p.tape;
  std::vector<std::uint32_t> column(tape.main_end, kNone);
  const std::uint32_t slots = static_cast<std::uint32_t>(p.tainted.size());
  for (const ProgramInput& in : p.inputs)
    if (in.leading) column[in.slot] = slots + static_cast<std::uint32_t>(in.variable);
  for (std::uint32_t k = 0; k < slots; ++k) column[p.tainted[k].slot] = k;
  const auto add = [&](std::uint32_t operand, std::uint32_t index, Source source) {
    terms_.push_back({column[operand], index, source});
    sample_.push_back(source == Source::rational ? tape.rationals[index].get_d()
                                                 : stand_in(static_cast<std::uint32_t>(terms_.size())));
  };
  for (std::uint32_t k = 0; k < slots; ++k) {
    first_.push_back(static_cast<std::uint32_t>(terms_.size()));
    const TaintedSlot& t = p.tainted[k];
    const Instruction& in = tape.code[t.slot];
    if (in.op == Op::linear) {
      for (std::uint32_t i = in.first; i < in.first + in.count; ++i)
        if (const LinearTerm& term = tape.linear_terms[i];
            column[term.slot] != kNone && tape.code[term.slot].lead == in.lead)
          add(term.slot, term.coefficient, Source::rational);
    } else {
      if (t.a) add(in.a, k, Source::by_a);
      if (t.b) add(in.b, k, Source::by_b);
    }
  }
  first_.push_back(static_cast<std::uint32_t>(terms_.size()));
  for (std::size_t i = 0; i < p.unknowns(); ++i) roots_.push_back(column[tape.roots[i]]);
  make_columns();
}

std::shared_ptr<const Linearized> linearized(const Program& program) {
  return std::make_shared<const Linearized>(program);
}

void Linearized::make_columns() {
  const std::uint32_t n = size();
  columns_.first.assign(n + 1, 0);
  const auto each = [&](auto&& visit) {
    for (std::uint32_t k = 0; k < slots(); ++k) {
      visit(k, k, kNone);
      for (std::uint32_t t = first_[k]; t < first_[k + 1]; ++t) visit(k, terms_[t].column, t);
    }
    for (std::uint32_t i = 0; i < unknowns(); ++i)
      if (roots_[i] != kNone) visit(slots() + i, roots_[i], kNone);
  };
  each([&](std::uint32_t, std::uint32_t column, std::uint32_t) { ++columns_.first[column + 1]; });
  for (std::uint32_t j = 0; j < n; ++j) columns_.first[j + 1] += columns_.first[j];
  std::vector<std::uint32_t> next(columns_.first.begin(), columns_.first.end() - 1);
  columns_.row.resize(columns_.first.back()), term_of_.resize(columns_.first.back());
  each([&](std::uint32_t row, std::uint32_t column, std::uint32_t term) {
    columns_.row[next[column]] = row;
    term_of_[next[column]++] = term;
  });
}

const EliminationOrder& Linearized::order() const {
  std::call_once(once_, [this] { order_ = make_order(); });
  return order_;
}

EliminationOrder Linearized::make_order() const {
  std::vector<double> values;
  for (const std::uint32_t t : term_of_) values.push_back(t == kNone ? 1 : -sample_[t]);
  const SparseElimination e = eliminated(values);
  const double n = unknowns(), full = n * n * n / 3;
  if (static_cast<double>(e.lu.update_list.size() + e.lu.scaled_entries.size() + values.size()) > kMuchCheaper * full)
    return {};
  return order_of(e.lu);
}

EliminationOrder Linearized::order_for(const std::vector<double>& values) const {
  return order_of(eliminated(values).lu);
}

SparseElimination Linearized::eliminated(const std::vector<double>& values) const {
  std::vector<SampledEntry> entries;
  for (std::uint32_t j = 0; j < size(); ++j)
    for (std::uint32_t e = columns_.first[j]; e < columns_.first[j + 1]; ++e) {
      const std::uint32_t t = term_of_[e];
      SampledEntry entry{columns_.row[e], j, {}, t == kNone || terms_[t].source == Source::rational};
      entry.value[0] = values[e];
      entries.push_back(entry);
    }
  return eliminate_sparse(size(), entries, 1);
}

namespace {

// Carries numbers of the unknowns through the slots to the equations; `factor` returns that of a term.
template <Number N, class Factor>
void carry(const Linearized& l, const std::vector<N>& x, std::vector<N>& y, Factor factor) {
  const std::uint32_t slots = l.slots();
  std::vector<N> change(slots, N(0));
  const auto at = [&](std::uint32_t column) -> const N& { return column < slots ? change[column] : x[column - slots]; };
  for (std::uint32_t k = 0; k < slots; ++k)
    for (std::uint32_t t = l.first(k); t < l.first(k + 1); ++t)
      addmul(change[k], N(factor(t)), at(l.terms()[t].column));
  y.resize(l.unknowns());
  for (std::uint32_t i = 0; i < l.unknowns(); ++i) y[i] = l.root(i) == Linearized::kNone ? N(0) : at(l.root(i));
}

}  // namespace

template <Number N>
void multiply(const Linearized& l, const Partials<N>& partials, const std::vector<N>& x, std::vector<N>& y) {
  carry<N>(l, x, y, [&](std::uint32_t t) -> const N& { return partials[t]; });
}

template <Number N>
void multiply_sizes(const Linearized& l, const Partials<N>& partials, const std::vector<N>& x, std::vector<N>& y) {
  std::vector<N> sizes(x.size());
  for (std::size_t j = 0; j < x.size(); ++j) sizes[j] = abs(x[j]);
  carry<N>(l, sizes, y, [&](std::uint32_t t) { return abs(partials[t]); });
}

template <Number N>
void multiply_sizes_transposed(const Linearized& l, const Partials<N>& partials, const std::vector<N>& y,
                               std::vector<N>& x) {
  const std::uint32_t slots = l.slots();
  std::vector<N> weight(slots, N(0));
  x.assign(l.unknowns(), N(0));
  const auto at = [&](std::uint32_t column) -> N& { return column < slots ? weight[column] : x[column - slots]; };
  for (std::uint32_t i = 0; i < l.unknowns(); ++i)
    if (l.root(i) != Linearized::kNone) at(l.root(i)) += abs(y[i]);
  for (std::uint32_t k = slots; k-- > 0;)
    for (std::uint32_t t = l.first(k); t < l.first(k + 1); ++t)
      addmul(at(l.terms()[t].column), N(abs(partials[t])), weight[k]);
}

std::vector<std::vector<double>> largest_of_rows(const Linearized& l, const Partials<double>& partials,
                                                 const std::vector<int>& of_class) {
  constexpr std::uint32_t kColumns = 16;  // columns that are computed at a time
  const std::uint32_t slots = l.slots(), n = l.unknowns();
  const int classes = *std::max_element(of_class.begin(), of_class.end()) + 1;
  std::vector<std::vector<double>> most(static_cast<std::size_t>(classes), std::vector<double>(n, 0));
  std::vector<double> tangent(std::size_t{slots} * kColumns);
  std::vector<unsigned char> zero(slots);
  double own[kColumns];
  for (std::uint32_t from = 0; from < n; from += kColumns) {
    const std::uint32_t end = std::min(from + kColumns, n);
    // Returns the row of a column of the matrix, nullptr if it is zero.
    const auto row = [&](std::uint32_t column) -> const double* {
      if (column < slots) return zero[column] ? nullptr : &tangent[std::size_t{column} * kColumns];
      if (column - slots < from || column - slots >= end) return nullptr;
      std::fill(own, own + kColumns, 0.0);
      own[column - slots - from] = 1;
      return own;
    };
    for (std::uint32_t k = 0; k < slots; ++k) {
      double* const to = &tangent[std::size_t{k} * kColumns];
      zero[k] = 1;
      for (std::uint32_t t = l.first(k); t < l.first(k + 1); ++t) {
        const double* const other = row(l.terms()[t].column);
        if (!other) continue;
        const double factor = partials[t];
        if (zero[k])
          for (std::uint32_t c = 0; c < kColumns; ++c) to[c] = factor * other[c];
        else
          for (std::uint32_t c = 0; c < kColumns; ++c) to[c] += factor * other[c];
        zero[k] = 0;
      }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      const double* const values = l.root(i) == Linearized::kNone ? nullptr : row(l.root(i));
      for (std::uint32_t j = from; values && j < end; ++j) {
        double& m = most[static_cast<std::size_t>(of_class[j])][i];
        const double size = std::abs(values[j - from]);
        m = std::isnan(size) ? std::numeric_limits<double>::infinity() : std::max(m, size);
      }
    }
  }
  for (std::size_t c = most.size() - 1; c-- > 0;)
    for (std::uint32_t i = 0; i < n; ++i) most[c][i] = std::max(most[c][i], most[c + 1][i]);
  return most;
}

#define INSTANTIATE(N)                                                                                                 \
  template void multiply(const Linearized&, const Partials<N>&, const std::vector<N>&, std::vector<N>&);               \
  template void multiply_sizes(const Linearized&, const Partials<N>&, const std::vector<N>&, std::vector<N>&);         \
  template void multiply_sizes_transposed(const Linearized&, const Partials<N>&, const std::vector<N>&,                \
                                          std::vector<N>&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
