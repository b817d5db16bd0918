#include "published/compare.h"

#include <algorithm>
#include <cmath>

#include "expr/normal.h"
#include "numeric/linear.h"
#include "print/arrange.h"
#include "proof/few_functions.h"
#include "proof/witness.h"
#include "published/at_points.h"
#include "published/identity.h"

namespace anholon {

namespace {

constexpr std::size_t kMostCombined = 6;  // the most equations in a combination that is printed

// True if e is zero by algebra; if the whole is too large, by its coefficients of the symbols in which it is affine.
bool zero_by_parts(Expr e, const Column& symbols) {
  if (shown_zero_in_few_functions(e, Effort::brief)) return true;
  const Column slopes = gradient(e, symbols);
  for (Expr slope : slopes)
    for (Expr curve : gradient(slope, symbols))
      if (!is_zero(curve)) return shown_zero_in_few_functions(e, Effort::full);
  try {
    return std::all_of(slopes.begin(), slopes.end(),
                       [&](Expr x) { return is_zero(x) || shown_zero_in_few_functions(x, Effort::full); }) &&
           shown_zero_in_few_functions(put(e, symbols, Column(symbols.size(), e.graph->zero())), Effort::full);
  } catch (const Failure&) {
    return false;
  }
}

const char* times_in_words(unsigned k) {
  return k == 1 ? ", differentiated once" : k == 2 ? ", differentiated twice" : ", differentiated three times";
}

}  // namespace

unsigned order_of_motion(Expr e) {
  unsigned highest = 2;
  for (NodeId id : symbols({&e, 1})) {
    const Node& n = e.graph->node(id);
    if (n.kind == Kind::jet) highest = std::max(highest, static_cast<unsigned>(n.order));
    if (n.kind == Kind::multiplier) highest = std::max(highest, n.order + 2U);
  }
  return highest;
}

Comparer::Comparer(const Mechanics& M, const Elimination& elimination, SymbolNames names)
    : M_(M), elimination_(elimination), names_(std::move(names)) {}

EquationsOfMotion& Comparer::motion(unsigned highest) {
  const auto it = motions_.find(highest);
  return it != motions_.end()
             ? it->second
             : motions_.try_emplace(highest, M_, highest, elimination_.dependent, elimination_.point()).first->second;
}

EquationsOfMotion& Comparer::motion_for_changes(Expr published) {
  unsigned highest = order_of_motion(published);
  const unsigned read = highest;
  for (int order : M_.order) highest = std::max(highest, static_cast<unsigned>(order));
  EquationsOfMotion& whole = motion(highest);
  return whole.on_motion().empty() ? motion(read) : whole;
}

std::string Comparer::name(const DerivedEquation& e) const {
  std::string text = e.constraint ? "the constraint " + M_.model->constraints[e.index].name
                                  : "the equation of " + M_.model->coordinates[e.index].name;
  if (e.times > 0) text += times_in_words(e.times);
  return text;
}

Expr Comparer::tidy(Expr e) const { return is_number(e) ? e : arranged(e, names_); }

std::string Comparer::times(Expr factor) const {
  if (is_number(factor) && number_value(factor) == 1) return {};
  return ", times " + print(factor, names_, Format::text);
}

// Returns the symbols by which a derived equation is recognised.
Column Comparer::leading(const DerivedEquation& e, EquationsOfMotion& motion) const {
  if (!e.constraint) return motion.top;
  return jets(*M_.model, static_cast<unsigned>(M_.order[e.index]) + e.times);
}

// True if P = f * residual identically, with some factor f.
bool Comparer::directly(Expr P, const DerivedEquation& e, EquationsOfMotion& motion, Comparison& out) {
  std::vector<PointValues>& points = motion.anywhere();
  if (points.empty()) return false;
  Column candidates;
  const Column symbols = leading(e, motion), p = gradient(P, symbols), f = gradient(e.residual, symbols);
  std::size_t best = symbols.size();
  for (std::size_t j = 0; j < symbols.size(); ++j) {
    if (is_zero(f[j]) || !is_not_zero(f[j], points[0])) continue;
    if (is_zero(p[j]) || !is_not_zero(p[j], points[0])) return false;
    if (best == symbols.size() ||
        number_of_nodes(f[j]) + number_of_nodes(p[j]) < number_of_nodes(f[best]) + number_of_nodes(p[best]))
      best = j;
  }
  if (best == symbols.size()) return false;
  Expr factor = p[best] / f[best];
  const Expr rest = P - factor * e.residual;
  if (!vanishes(rest, points)) return false;
  const auto constant = constant_ratio(p[best], f[best], points);
  factor = constant ? M_.graph().number(*constant) : tidy(factor);
  const Expr short_rest = P - factor * e.residual;
  if (!zero_by_parts(short_rest, motion.top)) return false;
  out.verdict = Verdict::proved;
  out.what = name(e) + times(factor);
  out.of_constraints = e.constraint;
  return true;
}

// Computes the coefficients of a combination of rows that has the same derivatives by q'', lambda as P, and returns the
// remainder of P.
std::optional<Expr> Comparer::combination(Expr P, EquationsOfMotion& motion,
                                          std::vector<std::pair<std::size_t, Expr>>& terms) {
  std::vector<PointValues>& points = motion.on_constraints();
  const std::size_t n = motion.rows.size();
  if (points.empty()) return std::nullopt;
  const Column p = gradient(P, motion.top);
  Rows K;
  for (const DerivedEquation& e : motion.rows) {
    K.push_back(gradient(e.residual, motion.top));
    // An entry that cancels must not become a pivot.
    for (Expr& entry : K.back())
      if (!is_zero(entry) && vanishes(entry, points)) entry = M_.graph().zero();
  }
  std::vector<bool> occurs(n, false);
  for (PointValues& at : points) {
    Matrix<double> k(n, motion.top.size());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < motion.top.size(); ++j) k(i, j) = at(K[i][j]);
    const RowChoice<double> choice = choose_rows(k, 1e-9);
    if (choice.pivot_columns.size() < n) return std::nullopt;
    Matrix<double> square(n, n);
    std::vector<double> right, c;
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < n; ++i) square(j, i) = k(i, choice.pivot_columns[j]);
      right.push_back(at(p[choice.pivot_columns[j]]));
    }
    Lu<double> lu;
    if (!lu.factor(square)) return std::nullopt;
    lu.solve(right, c);
    double largest = 0;
    for (double v : c) largest = std::max(largest, std::abs(v));
    for (std::size_t i = 0; i < n; ++i)
      if (std::abs(c[i]) > 1e-9 * largest) occurs[i] = true;
  }
  std::vector<std::size_t> support;
  for (std::size_t i = 0; i < n; ++i)
    if (occurs[i]) support.push_back(i);
  if (support.size() > kMostCombined) return std::nullopt;
  if (support.empty()) return P;
  // The shortest columns that determine the coefficients are chosen.
  std::vector<std::pair<std::size_t, std::size_t>> cost;
  for (std::size_t j = 0; j < motion.top.size(); ++j) {
    std::size_t sum = number_of_nodes(p[j]);
    for (std::size_t i : support) sum += number_of_nodes(K[i][j]);
    cost.push_back({sum, j});
  }
  std::sort(cost.begin(), cost.end());
  std::vector<std::size_t> columns;
  for (const auto& [length, j] : cost) {
    if (columns.size() == support.size()) break;
    Matrix<double> a(columns.size() + 1, support.size());
    for (std::size_t r = 0; r <= columns.size(); ++r)
      for (std::size_t i = 0; i < support.size(); ++i)
        a(r, i) = points[0](K[support[i]][r < columns.size() ? columns[r] : j]);
    if (choose_rows(a, 1e-7).independent.size() == columns.size() + 1) columns.push_back(j);
  }
  if (columns.size() < support.size()) return std::nullopt;
  // (c, d) K = p is solved for one unknown after the other if the columns allow it, else by the inverse.
  Rows square;
  for (std::size_t i : support) {
    square.emplace_back();
    for (std::size_t j : columns) square.back().push_back(K[i][j]);
  }
  Column pivots;
  Expr rest = P;
  try {
    const Rows inverted = inverse(square, points[0], pivots, Wanted::brief);
    for (std::size_t i = 0; i < support.size(); ++i) {
      std::vector<Expr> sum_of = {M_.graph().zero()};
      for (std::size_t j = 0; j < columns.size(); ++j)
        if (!is_zero(p[columns[j]]) && !is_zero(inverted[j][i])) sum_of.push_back(p[columns[j]] * inverted[j][i]);
      const Expr c = tidy(sum(sum_of));
      terms.push_back({support[i], c});
      rest = rest - c * motion.rows[support[i]].residual;
    }
  } catch (const Failure&) {
    return std::nullopt;
  }
  return rest;
}

bool Comparer::combined(Expr P, EquationsOfMotion& motion, Comparison& out) {
  std::vector<std::pair<std::size_t, Expr>> terms;
  const std::optional<Expr> rest = combination(P, motion, terms);
  if (!rest) return false;
  bool constrained = false;
  if (!vanishes(*rest, motion.anywhere()) || !zero_by_parts(*rest, motion.top)) {
    const Column branches = motion.reduced(*rest);
    if (branches.empty() ||
        !std::all_of(branches.begin(), branches.end(), [&](Expr on) { return zero_by_parts(on, motion.top); }))
      return false;
    constrained = true;
  }
  out.verdict = Verdict::proved;
  std::vector<std::pair<std::size_t, Expr>> of_motion;
  std::vector<std::string> used;
  const auto use = [&](std::size_t r) {
    const std::string& n = M_.model->constraints[r].name;
    if (std::find(used.begin(), used.end(), n) == used.end()) used.push_back(n);
  };
  for (const auto& [i, c] : terms) {
    if (motion.rows[i].constraint)
      use(motion.rows[i].index);
    else
      of_motion.push_back({i, c});
  }
  if (constrained)
    for (const DerivedEquation& e : motion.lower) use(e.index);
  std::string put_in;
  for (const std::string& n : used) put_in += (put_in.empty() ? "" : ", ") + n;
  if (of_motion.empty()) {
    out.of_constraints = true;
    out.what = std::string("a consequence of the constraint") + (used.size() == 1 ? " " : "s ") + put_in + " alone";
    return true;
  }
  if (of_motion.size() == 1) {
    out.what = name(motion.rows[of_motion[0].first]) + times(of_motion[0].second);
  } else {
    bool multipliers = false;
    for (NodeId id : symbols({&P, 1})) multipliers = multipliers || M_.graph().node(id).kind == Kind::multiplier;
    out.what = !multipliers && !M_.phi.empty() ? "a combination without multipliers: " : "a combination: ";
    for (std::size_t k = 0; k < of_motion.size(); ++k) {
      const auto& [i, c] = of_motion[k];
      std::string factor = print(c, names_, Format::text);
      const bool is_sum = M_.graph().node(c.id).kind == Kind::sum && M_.graph().terms(c.id).size() > 1;
      const bool minus = !is_sum && factor.rfind('-', 0) == 0;
      if (minus) factor.erase(0, 1);
      if (is_sum) factor = "(" + factor + ")";
      out.what += k == 0 ? (minus ? "-" : "") : minus ? " - " : " + ";
      if (factor != "1") out.what += factor + " times ";
      out.what += name(motion.rows[i]);
    }
  }
  if (!used.empty()) out.what += ", with " + put_in + " put in";
  return true;
}

// Decides equations that are not linear in accelerations, multipliers and higher derivatives: these are put in as
// functions of the lower ones.
bool Comparer::by_solutions(Expr P, EquationsOfMotion& motion, Comparison& out) const {
  constexpr std::size_t kLongest = 200;  // nodes
  if (number_of_nodes(P) > kLongest) return false;
  const Column branches = motion.on_solutions(P);
  if (branches.empty() || !std::all_of(branches.begin(), branches.end(),
                                       [](Expr e) { return shown_zero_in_few_functions(e, Effort::full); }))
    return false;
  out.verdict = Verdict::proved;
  out.what = "a consequence of the equations of motion and the constraints";
  return true;
}

bool Comparer::without_motion(Expr P, EquationsOfMotion& motion) const {
  const Column p = gradient(P, motion.top);
  return std::all_of(p.begin(), p.end(), [&](Expr x) { return is_zero(x) || vanishes(x, motion.anywhere()); });
}

Comparison Comparer::judge(Expr P) {
  Comparison out = decide(P);
  if (out.verdict == Verdict::refuted && !out.in_places) nearest(P, out);
  return out;
}

Comparison Comparer::decide(Expr P) {
  Comparison out;
  if (proved_zero(P) || shown_zero_in_few_functions(P, Effort::brief)) {
    out.verdict = Verdict::proved;
    out.trivial = true;
    out.what = "an identity: it holds whatever the motion";
    return out;
  }
  EquationsOfMotion& motion = this->motion(order_of_motion(P));
  for (const DerivedEquation& e : motion.lower)
    if (directly(P, e, motion, out)) return out;
  for (const DerivedEquation& e : motion.rows)
    if (directly(P, e, motion, out)) return out;
  if (!motion.regular) {
    const bool known = !motion.on_motion().empty() || !singular_at_start();
    if ((known && on_manifold(P, false, out)) || of_higher_order(P, out) || by_contractions(P, out)) return out;
    if (out.detail.empty())
      out.detail = motion.on_motion().empty()
                       ? "no point of a motion was found"
                       : "the equations do not determine the accelerations and multipliers at this order";
    return out;
  }
  if (!vanishes(P, motion.on_motion())) {
    Difference d{{}, P, {}, {}, {}, {}};
    WitnessSearch search =
        find_witness(d, motion.equations, motion.unknowns, *M_.model, Where::positive, motion.projected());
    out.detail = search.detail;
    out.witness = std::move(search.witness);
    if (out.witness) out.verdict = Verdict::refuted;
    return out;
  }
  if (combined(P, motion, out) || on_manifold(P, true, out) || by_solutions(P, motion, out) || by_contractions(P, out))
    return out;
  // Up to this number of nodes, a difference below the round-off of numbers is searched as well.
  constexpr std::size_t kShort = 1000;
  if (number_of_nodes(P) <= kShort || !vanishes(P, motion.elsewhere())) {
    const Difference d{{}, P, {}, {}, {}, {}};
    WitnessSearch search =
        find_witness(d, motion.equations, motion.unknowns, *M_.model, Where::elsewhere, motion.projected_elsewhere());
    if (search.witness) {
      out.verdict = Verdict::refuted;
      out.in_places = true;
      out.detail = search.detail;
      out.witness = std::move(search.witness);
      return out;
    }
  }
  double largest = 0;
  for (PointValues& at : motion.on_motion()) largest = std::max(largest, std::abs(at(P)) / (1e-6 + size_at(P, at)));
  char bound[32];
  std::snprintf(bound, sizeof bound, "%.0e", largest);
  out.detail = std::string("zero to ") + bound + " at " + std::to_string(motion.on_motion().size()) +
               " points of the motion; no proof was found";
  return out;
}

Comparison Comparer::compare(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet) {
  const Expr P = words.number(equation.left) - words.number(equation.right);
  Comparison c = decide(P);
  if (c.trivial && holds_by_rates(equation.left, equation.right, words)) c.trivial = false, c.what = kOfRates;
  if (c.verdict != Verdict::refuted) {
    std::vector<PointValues>& on_motion = motion(order_of_motion(P)).on_motion();
    std::string zero;
    for (const Syntax* side : {&equation.left, &equation.right})
      if (!on_motion.empty() && zero.empty()) zero = vanishing_divisor(*side, words, on_motion);
    if (zero.empty()) return c;
    c = {};
    c.has_value = false;
    c.detail = "it has no value on a motion: it divides by " + zero + ", which is 0 there";
    return c;
  }
  if (c.in_places) return c;
  c.changes = repairs(equation, words, alphabet, *this);
  const auto quantities = [&] {
    return speaks_of_quantities(equation.left, words) || speaks_of_quantities(equation.right, words);
  };
  c.identity =
      c.changes.empty() ? quantities() && without_motion(P, motion(order_of_motion(P))) : c.changes[0].identity;
  if (c.identity) {
    c.what = kIdentity;
    c.difference = arranged(P, names_);
  } else if (!c.changes.empty() && c.changes[0].proved) {
    nearest_of(c.changes, P, c);
  } else {
    nearest(P, c);
    if (c.changes.empty() && c.difference && decide(P - *c.difference).verdict == Verdict::proved)
      c.wrong_term = wrong_term(equation, *c.difference, words, names_, motion(order_of_motion(P)).anywhere());
  }
  return c;
}

}  // namespace anholon
