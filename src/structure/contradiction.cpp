#include "structure/contradiction.h"

namespace anholon {

namespace {

// ---- linear equations ------------------------------------------------------------------------

template <Number N>
class Circuits {
 public:
  Circuits(Stage<N>& stage, const InitialState<N>& state, const std::vector<bool>& given)
      : s_(stage), state_(state), given_(given) {
    for (std::size_t j = 0; j < given.size(); ++j)
      if (!given[j]) free_.push_back(j);
  }

  std::optional<Contradiction<N>> smallest() {
    std::optional<Contradiction<N>> best;
    for (Contradiction<N>& found : all())
      if (!best || members(found) < members(*best)) best = std::move(found);
    return best;
  }

  // Returns the contradictions of the rows beyond a basis.
  std::vector<Contradiction<N>> all() {
    Matrix<N> a(s_.size(), free_.size());
    for (std::size_t i = 0; i < s_.size(); ++i)
      for (std::size_t j = 0; j < free_.size(); ++j) a(i, j) = s_.jacobian(i, free_[j]);
    const RowChoice<N> rows = choose_rows(a, N(kDependent));
    basis_ = rows.independent;
    const std::size_t n = basis_.size();
    Matrix<N> transposed(n, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) transposed(j, i) = a(basis_[i], rows.pivot_columns[j]);
    std::vector<Contradiction<N>> list;
    Lu<N> lu;
    if (n > 0 && !lu.factor(transposed)) return list;
    for (std::size_t r : rows.dependent) {
      std::vector<N> right(n, N(0)), c;
      for (std::size_t j = 0; j < n; ++j) right[j] = a(r, rows.pivot_columns[j]);
      if (n > 0) lu.solve(right, c);
      if (auto found = circuit(a, r, c)) list.push_back(std::move(*found));
    }
    return list;
  }

 private:
  static std::size_t members(const Contradiction<N>& c) { return c.equations.size() + c.given.size(); }

  // Returns the contradiction of row r with its combination of the basis; nullopt if the combination holds.
  std::optional<Contradiction<N>> circuit(const Matrix<N>& a, std::size_t r, const std::vector<N>& c) const {
    std::vector<N> part(c.size(), N(0));
    N largest(0);
    for (std::size_t j = 0; j < a.cols; ++j) {
      if (N v = abs(a(r, j)); v > largest) largest = v;
      for (std::size_t i = 0; i < c.size(); ++i)
        if (N v = abs(N(c[i] * a(basis_[i], j))); v > part[i]) part[i] = v;
    }
    for (const N& v : part)
      if (v > largest) largest = v;
    Contradiction<N> out;
    std::vector<std::pair<std::size_t, N>> terms = {{r, N(1)}};
    for (std::size_t i = 0; i < c.size(); ++i)
      if (part[i] > N(kDependent) * largest) terms.push_back({basis_[i], N(-c[i])});
    N rho(0), scale(0);
    for (const auto& [i, factor] : terms) {
      out.equations.push_back(i);
      rho += factor * s_.residual[i];
      scale += abs(factor) * s_.scale[i];
    }
    if (!(abs(rho) > N(kRounded) * scale)) return std::nullopt;
    std::sort(out.equations.begin(), out.equations.end());
    N coefficient(0);
    for (std::size_t j = 0; j < given_.size(); ++j) {
      if (!given_[j]) continue;
      N sum(0), size(0);
      for (const auto& [i, factor] : terms) {
        const N term = factor * s_.jacobian(i, j);
        sum += term;
        size += abs(term);
      }
      if (abs(sum) > N(kDependent) * size) out.given.push_back(j), coefficient = sum;
    }
    if (out.given.size() == 1) out.wanted = s_.x_of(state_, out.given[0]) - rho / coefficient;
    return out;
  }

  Stage<N>& s_;
  const InitialState<N>& state_;
  const std::vector<bool>& given_;
  std::vector<std::size_t> free_, basis_;
};

// ---- nonlinear equations ---------------------------------------------------------------------

constexpr std::size_t kMostMembers = 40;  // each costs a search for a solution
constexpr std::size_t kMostUnknowns = 60;

template <Number N>
class DeletionFilter {
 public:
  DeletionFilter(Stage<N>& stage, InitialState<N>& state, const std::vector<bool>& given)
      : s_(stage), state_(state), start_(state), given_(given),
        holds_(stage.size(), std::vector<bool>(stage.unknowns(), false)) {
    for (std::size_t i = 0; i < s_.size(); ++i)
      for (std::size_t j = 0; j < s_.unknowns(); ++j) holds_[i][j] = s_.holds(i, j);
  }
  ~DeletionFilter() {
    s_.keep_all();
    state_ = start_;
  }

  // Returns all equations coupled with this one through free unknowns, and the given values in them.
  Contradiction<N> whole(std::size_t row) const {
    const std::vector<bool> rows = neighbours(row);
    Contradiction<N> out;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (rows[i]) out.equations.push_back(i);
    for (std::size_t j = 0; j < given_.size(); ++j)
      if (given_[j] && touched(rows, j)) out.given.push_back(j);
    return out;
  }
  bool too_many(std::size_t worst) const {
    const Contradiction<N> c = whole(worst);
    const std::vector<bool> rows = neighbours(worst);
    std::size_t unknowns = 0;
    for (std::size_t j = 0; j < given_.size(); ++j) unknowns += touched(rows, j) ? 1 : 0;
    return c.equations.size() + c.given.size() > kMostMembers || unknowns > kMostUnknowns;
  }

  std::optional<Contradiction<N>> run(std::size_t worst) {
    std::vector<bool> rows = neighbours(worst), fixed(given_.size(), false);
    for (std::size_t j = 0; j < given_.size(); ++j) fixed[j] = given_[j] && touched(rows, j);
    if (too_many(worst) || solvable(rows, fixed)) return std::nullopt;
    // If the equations contradict each other without given values, no given value takes part.
    if (const std::vector<bool> none(given_.size(), false); !solvable(rows, none)) fixed = none;
    for (std::vector<bool>* list : {&rows, &fixed})
      for (std::size_t k = 0; k < list->size(); ++k) {
        if (!(*list)[k]) continue;
        (*list)[k] = false;
        if (solvable(rows, fixed)) (*list)[k] = true;
      }
    Contradiction<N> out;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (rows[i]) out.equations.push_back(i);
    for (std::size_t j = 0; j < fixed.size(); ++j)
      if (fixed[j]) out.given.push_back(j);
    if (out.given.size() == 1)
      if (fixed[out.given[0]] = false; solvable(rows, fixed)) out.wanted = s_.x(state_, out.given[0]);
    return out;
  }

 private:
  bool touched(const std::vector<bool>& rows, std::size_t j) const {
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (rows[i] && holds_[i][j]) return true;
    return false;
  }

  // Returns the equations coupled with this one through free unknowns.
  std::vector<bool> neighbours(std::size_t row) const {
    std::vector<bool> rows(s_.size(), false);
    std::vector<std::size_t> open = {row};
    rows[row] = true;
    while (!open.empty()) {
      const std::size_t i = open.back();
      open.pop_back();
      for (std::size_t j = 0; j < given_.size(); ++j) {
        if (given_[j] || !holds_[i][j]) continue;
        for (std::size_t k = 0; k < s_.size(); ++k)
          if (holds_[k][j] && !rows[k]) rows[k] = true, open.push_back(k);
      }
    }
    return rows;
  }

  // True if these equations have a solution with these values given.
  bool solvable(const std::vector<bool>& rows, const std::vector<bool>& fixed) {
    state_ = start_;
    s_.keep(rows);
    std::vector<std::size_t> free;
    for (std::size_t j = 0; j < fixed.size(); ++j)
      if (!fixed[j] && touched(rows, j)) free.push_back(j);
    return find_by_least_change(s_, state_, free) && to_double(s_.worst()) <= kRounded;
  }

  Stage<N>& s_;
  InitialState<N>& state_;
  const InitialState<N> start_;
  const std::vector<bool>& given_;
  std::vector<std::vector<bool>> holds_;  // true if equation i contains unknown j
};

}  // namespace

template <Number N>
std::optional<Contradiction<N>> contradiction(Stage<N>& stage, InitialState<N>& state, const std::vector<bool>& given,
                                              std::size_t worst) {
  if (!stage.linear()) return DeletionFilter<N>(stage, state, given).run(worst);
  if (!stage.evaluate(state)) return std::nullopt;
  return Circuits<N>(stage, state, given).smallest();
}

template <Number N>
std::vector<PartialContradiction<N>> contradictions(Stage<N>& stage, InitialState<N>& state,
                                                    const std::vector<bool>& given, const std::vector<bool>& fails) {
  std::vector<PartialContradiction<N>> list;
  if (stage.linear()) {
    if (!stage.evaluate(state)) return list;
    for (Contradiction<N>& c : Circuits<N>(stage, state, given).all()) list.push_back({std::move(c), true});
    return list;
  }
  DeletionFilter<N> filter(stage, state, given);
  std::vector<bool> seen(stage.size(), false);
  for (std::size_t i = 0; i < stage.size(); ++i) {
    if (!fails[i] || seen[i]) continue;
    Contradiction<N> whole = filter.whole(i);
    for (const std::size_t k : whole.equations) seen[k] = true;
    if (filter.too_many(i))
      list.push_back({std::move(whole), false});
    else if (auto c = filter.run(i))
      list.push_back({std::move(*c), true});
  }
  return list;
}

#define INSTANTIATE(N)                                                                                                 \
  template std::optional<Contradiction<N>> contradiction(Stage<N>&, InitialState<N>&, const std::vector<bool>&,        \
                                                         std::size_t);                                                 \
  template std::vector<PartialContradiction<N>> contradictions(Stage<N>&, InitialState<N>&, const std::vector<bool>&,  \
                                                               const std::vector<bool>&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
