#include "mechanics/integrability.h"

#include <algorithm>
#include <memory>

#include "base/diagnostic.h"
#include "mechanics/expression_matrix.h"
#include "mechanics/integrals.h"
#include "mechanics/pfaff.h"
#include "print/arrange.h"

namespace anholon {

namespace {

// A vector field with more nodes is not differentiated: the flag is then undecided.
constexpr std::size_t kLongestField = 1'200;

struct GaveUp {
  std::string why;
};

// The forms of a model, and a basis of their kernel.
struct Pfaffian {
  FormSpace space;
  Rows forms;  // forms of holonomic constraints first, then of `constraints`
  std::size_t holonomic = 0;
  std::vector<std::size_t> constraints;
  std::vector<std::size_t> pivots;  // pivot columns, as many as forms
  Rows inverse;                     // inverse of the pivot columns
  Rows kernel;                      // vector fields X with w(X) = 0
  Column phi;                       // the holonomic constraints

  std::size_t s() const { return constraints.size(); }
  Column of(std::size_t i) const { return forms[holonomic + i]; }
};

// Returns (A, b) of a linear constraint. A does not depend on velocities; if its formula contains velocities
// nevertheless, they may have any values except 0, for which the formula may be 0/0.
Column coefficients(const Mechanics& m, std::size_t r) {
  Graph& g = m.graph();
  Column row = put_masses(*m.model, m.Phi[r]);
  const Expr phi = put_masses(*m.model, m.phi[r]);
  const bool clean = std::all_of(row.begin(), row.end(), [](Expr e) { return jet_order(e) <= 0; });
  const auto velocity = [&](std::size_t a) {
    return clean ? g.zero() : g.number(Rational(static_cast<long>(a * a + 2 * a + 3), 2));
  };
  const auto put = [&](Expr e) {
    return substitute({&e, 1}, [&](NodeId id) {
      const Node n = g.node(id);
      return n.kind == Kind::jet && n.order > 0 ? velocity(n.index) : Expr{};
    })[0];
  };
  Expr b = put(phi);
  for (std::size_t a = 0; a < row.size(); ++a) {
    row[a] = shorter(put(row[a]));
    b = b - velocity(a) * row[a];
  }
  row.push_back(shorter(b));
  return row;
}

// The order of pivots among the coordinates: constant columns first, columns of few entries first, then the large ones,
// or those of the first or the last coordinates.
enum class Prefer : std::uint8_t { large, early, late };

std::vector<std::size_t> pivots_of(const Pfaffian& p, FormPoint& at, Prefer prefer) {
  constexpr double kConstant = 100, kSparser = 10, kNext = 10;
  Matrix<Multi> a = values_at(p.forms, at);
  const std::size_t coordinates = a.cols - (p.space.time ? 1 : 0);
  for (std::size_t c = 0; c < a.cols; ++c) {
    const bool constant = std::all_of(p.forms.begin(), p.forms.end(), [&](const Column& w) { return is_number(w[c]); });
    Multi weight(c >= coordinates ? 0 : constant ? kConstant : 1);
    for (const Column& w : p.forms)
      if (!is_zero(w[c])) weight /= Multi(kSparser);
    const std::size_t behind = prefer == Prefer::large   ? 0
                               : prefer == Prefer::early ? c
                                                         : coordinates - std::min(c, coordinates);
    for (std::size_t k = 0; k < std::min<std::size_t>(behind, 12); ++k) weight /= Multi(kNext);
    for (std::size_t i = 0; i < a.rows; ++i) a(i, c) *= weight;
  }
  std::vector<std::size_t> pivots = choose_rows(a, Multi(kIndependent)).pivot_columns;
  if (pivots.size() < p.forms.size()) throw GaveUp{"the constraints contradict each other at a point nearby"};
  std::sort(pivots.begin(), pivots.end());
  return pivots;
}

// Computes the kernel with these pivots: X_i = d_i - sum C_si d_s, C = A_D^-1 A_I.
void solve(Pfaffian& p, std::vector<std::size_t> pivots, FormPoint& at) {
  Graph& g = *p.space.z[0].graph;
  p.pivots = std::move(pivots);
  Rows square;
  for (const Column& w : p.forms) {
    square.emplace_back();
    for (std::size_t c : p.pivots) square.back().push_back(w[c]);
  }
  Column divisors;
  PointValues rough = at.rough();
  if (!square.empty()) p.inverse = inverse(square, rough, divisors, Wanted::brief);
  for (std::size_t i = 0; i < p.space.z.size(); ++i) {
    if (std::binary_search(p.pivots.begin(), p.pivots.end(), i)) continue;
    Column X(p.space.z.size(), g.zero()), column;
    X[i] = g.one();
    for (const Column& w : p.forms) column.push_back(w[i]);
    for (std::size_t k = 0; k < p.pivots.size(); ++k) X[p.pivots[k]] = shorter(-applied(p.inverse[k], column));
    p.kernel.push_back(X);
  }
}

Pfaffian pfaffian(const Mechanics& m, const std::vector<std::size_t>& linear, bool values, FormPoint& at,
                  FormPoint& generic, bool& special) {
  const Model& model = *m.model;
  Graph& g = m.graph();
  // Rows (A, b) of all relevant constraints, and phi of the holonomic ones.
  Rows rows;
  Column phi;
  std::vector<std::size_t> from;
  for (std::size_t r = 0; r < m.phi.size(); ++r)
    if (m.order[r] == 0) {
      const Expr e = put_state_rates(model, put_masses(model, m.phi[r]), 1);
      phi.push_back(values ? parameters_put(model, e) : e), from.push_back(r);
    }
  const std::size_t holonomic = phi.size();
  from.insert(from.end(), linear.begin(), linear.end());
  bool time = false;
  const auto rheonomic = [&](const Column& es) {
    for (NodeId id : symbols(es)) time = time || g.node(id).kind == Kind::time || is_function_of_time(g.node(id));
  };
  for (std::size_t r : linear) {
    Column row = coefficients(m, r);
    for (Expr& e : row) e = put_state_rates(model, e, 1);
    if (values)
      for (Expr& e : row) e = parameters_put(model, e);
    time = time || !is_zero(row.back());
    rheonomic(row);
    rows.push_back(row);
  }
  rheonomic(phi);
  Pfaffian p;
  p.space = {m.q, time, &model};
  if (time) p.space.z.push_back(g.time());
  for (Expr f : phi) p.forms.push_back(p.space.differential(f));
  for (Column& row : rows) {
    if (!time) row.pop_back();
    p.forms.push_back(row);
  }
  // Independent rows, the holonomic ones first.
  Rows kept;
  std::vector<std::size_t> kept_from;
  for (std::size_t i = 0; i < p.forms.size(); ++i) {
    Rows more = kept;
    more.push_back(p.forms[i]);
    const bool independent = rank(values_at(more, at)) == more.size();
    special = special || independent != (rank(values_at(more, generic)) == more.size());
    if (!independent) continue;
    kept = more;
    if (i < holonomic)
      ++p.holonomic, p.phi.push_back(phi[i]);
    else
      p.constraints.push_back(from[i]);
  }
  p.forms = kept;
  // Of several choices of pivots, the one with the shortest basis of ker I is taken: brackets of brackets grow with it.
  constexpr std::size_t kShortKernel = 500;  // characters: sharing of nodes hides the length of a formula
  std::optional<Pfaffian> best;
  std::size_t shortest = SIZE_MAX;
  for (const Prefer prefer : {Prefer::large, Prefer::early, Prefer::late}) {
    Pfaffian trial = p;
    solve(trial, pivots_of(p, at, prefer), at);
    std::size_t size = 0;
    for (const Column& X : trial.kernel)
      for (const std::string& text : print(X, model.names, Format::text)) size += text.size();
    if (size < shortest) shortest = size, best = trial;
    if (size <= kShortKernel) break;
  }
  return *best;
}

// A vector field with its values and those of its derivatives at a point.
struct FieldValues {
  std::vector<Multi> X;
  Matrix<Multi> d;  // dX_a/dz_b

  FieldValues(const VectorField& field, FormPoint& at) : d(values_at(field.differentials, at)) {
    const Matrix<Multi> row = values_at({field.X}, at);
    X = row.data;
  }
};

// Returns w_r([X, Y]) at the point, for all forms.
std::vector<Multi> on_bracket(const Matrix<Multi>& forms, const FieldValues& x, const FieldValues& y) {
  const std::size_t n = x.X.size();
  std::vector<Multi> bracket(n, Multi(0)), out(forms.rows, Multi(0));
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      addmul(bracket[a], x.X[b], y.d(a, b));
      addmul(bracket[a], Multi(-y.X[b]), x.d(a, b));
    }
  for (std::size_t r = 0; r < forms.rows; ++r)
    for (std::size_t a = 0; a < n; ++a) addmul(out[r], forms(r, a), bracket[a]);
  return out;
}

// Returns V reduced by the fields before it, with 1 in the component that becomes its pivot: the same span with short
// formulas, which brackets of brackets need.
Column reduced(Column V, const Rows& before, std::vector<std::size_t>& pivots, FormPoint& at) {
  for (std::size_t k = 0; k < before.size(); ++k) {
    const Expr factor = V[pivots[k]];
    if (is_zero(factor)) continue;
    for (std::size_t a = 0; a < V.size(); ++a)
      if (!is_zero(before[k][a]))
        V[a] = a == pivots[k] ? factor.graph->zero() : simplified(V[a] - factor * before[k][a]);
  }
  // The pivot is the shortest of the components that are not small.
  constexpr double kPivot = 1e-3;
  const Matrix<Multi> v = values_at({V}, at);
  Multi largest(0);
  for (const Multi& x : v.data)
    if (abs(x) > largest) largest = abs(x);
  std::size_t pivot = V.size(), shortest = SIZE_MAX;
  for (std::size_t a = 0; a < V.size(); ++a) {
    if (!(abs(v(0, a)) >= Multi(kPivot) * largest)) continue;
    const std::size_t size = reachable({&V[a], 1}).size();
    if (size < shortest) shortest = size, pivot = a;
  }
  pivots.push_back(pivot);
  const Expr divisor = V[pivot];
  for (Expr& e : V)
    if (!is_zero(e)) e = simplified(e / divisor);
  return V;
}

// Computes D^(0), D^(1), … until stable: the dimensions of the flag, and the brackets independent of the kernel, in
// reduced echelon form with their pivots. Only these brackets become formulas; for the others values at the point
// suffice.
Rows derived_flag(const Pfaffian& p, FormPoint& at, FormPoint& generic, std::vector<int>& flag,
                  std::vector<std::size_t>& pivots, bool& special) {
  const std::size_t s = p.s();
  flag = {static_cast<int>(s)};
  const Matrix<Multi> forms_here = values_at(p.forms, at), forms_elsewhere = values_at(p.forms, generic);
  Echelon span, span_elsewhere;
  std::vector<VectorField> fields;
  std::vector<FieldValues> here, elsewhere;
  Rows fresh = p.kernel, formulas;
  std::vector<std::pair<std::size_t, std::size_t>> found;  // independent brackets [i, j] that have no formulas yet
  while (span.dimension() < s) {
    const std::size_t first_new = fields.size();
    for (const auto& [i, j] : found) {
      fresh.push_back(reduced(bracket(fields[i], fields[j]), formulas, pivots, at));
      formulas.push_back(fresh.back());
    }
    found.clear();
    for (const Column& X : fresh) {
      if (reachable(X).size() > kLongestField) throw GaveUp{"the brackets of the admissible motions grow too long"};
      fields.emplace_back(p.space, X);
      here.emplace_back(fields.back(), at);
      elsewhere.emplace_back(fields.back(), generic);
    }
    fresh.clear();
    for (std::size_t j = first_new; j < fields.size(); ++j)
      for (std::size_t i = 0; i < j && span.dimension() < s; ++i) {
        span_elsewhere.add(on_bracket(forms_elsewhere, elsewhere[i], elsewhere[j]));
        if (span.add(on_bracket(forms_here, here[i], here[j]))) found.emplace_back(i, j);
      }
    if (found.empty()) break;
    flag.push_back(static_cast<int>(s - span.dimension()));
  }
  if (span.dimension() == s) return {};  // nothing is integrable, so no formulas are needed
  special = special || span_elsewhere.dimension() > span.dimension();
  for (std::size_t k = formulas.size(); k-- > 0;)
    for (std::size_t i = 0; i < k; ++i) {
      const Expr factor = formulas[i][pivots[k]];
      if (is_zero(factor)) continue;
      for (std::size_t a = 0; a < formulas[i].size(); ++a)
        formulas[i][a] = simplified(formulas[i][a] - factor * formulas[k][a]);
    }
  return formulas;
}

// Returns the forms that annul the kernel and the brackets V, in reduced echelon form. They are built from w_s = dz_s -
// sum_i X_i,s dz_i of the pivot columns: for each s that is not the pivot of a V_k, the form is w_s less V_k,s times
// the form of the pivot of V_k.
Rows annihilator(const Pfaffian& p, const Rows& brackets, const std::vector<std::size_t>& pivots) {
  Graph& g = *p.space.z[0].graph;
  const auto unit = [&](std::size_t s) {
    Column w(p.space.z.size(), g.zero());
    w[s] = g.one();
    std::size_t k = 0;
    for (std::size_t i = 0; i < w.size(); ++i)
      if (!std::binary_search(p.pivots.begin(), p.pivots.end(), i)) w[i] = -p.kernel[k++][s];
    return w;
  };
  Rows out;
  for (std::size_t s : p.pivots) {
    if (std::find(pivots.begin(), pivots.end(), s) != pivots.end()) continue;
    Column w = unit(s);
    for (std::size_t k = 0; k < brackets.size(); ++k) {
      const Expr factor = brackets[k][s];
      if (is_zero(factor)) continue;
      const Column of_pivot = unit(pivots[k]);
      for (std::size_t a = 0; a < w.size(); ++a) w[a] = w[a] - factor * of_pivot[a];
    }
    for (Expr& e : w) e = simplified(e);
    out.push_back(w);
  }
  return out;
}

// Gives up if a constraint holds a state that the motion moves: the forms are those of positions and time alone.
void check_states(const Mechanics& m, const std::vector<std::size_t>& linear) {
  for (std::size_t r = 0; r < m.phi.size(); ++r)
    if (m.order[r] == 0 || std::find(linear.begin(), linear.end(), r) != linear.end())
      if (const StateVariable* s = state_moved_by_motion(*m.model, {m.phi[r]}))
        throw GaveUp{"the constraint '" + m.model->constraints[r].name + "' holds the state '" + s->name +
                     "', whose rate depends on the motion"};
}

void decide(const Mechanics& m, const std::vector<std::size_t>& linear, PointValues& near, bool values,
            Integrability& out) {
  FormPoint at(m, near, 1, false), generic(m, near, 2, true);
  bool special = false;
  const Pfaffian p = pfaffian(m, linear, values, at, generic, special);
  out.constraints = p.constraints;
  out.time = p.space.time;
  std::vector<std::size_t> pivots;
  const Rows brackets = derived_flag(p, at, generic, out.flag, pivots, special);
  if (special && !values) {
    decide(m, linear, near, true, out);
    out.these_values = out.integrable() > 0;
    return;
  }
  if (out.integrable() == 0) return;
  // The forms of I^(p), then functions with these differentials. The user's own forms may be more readable.
  const Rows forms = annihilator(p, brackets, pivots);
  Rows own;
  for (std::size_t r = 0; r < p.s(); ++r) {
    Column on_brackets;
    for (const Column& V : brackets) on_brackets.push_back(applied(p.of(r), V));
    if (on_brackets.empty() || rank(values_at({on_brackets}, at)) == 0) own.push_back(p.of(r));
  }
  // Returns the coefficients of w as a combination of the constraints.
  const auto made_of = [&](const Column& w) {
    Column on_pivots, all(m.phi.size(), m.graph().zero());
    for (std::size_t c : p.pivots) on_pivots.push_back(w[c]);
    const Column k = on_pivots * p.inverse;
    for (std::size_t r = 0; r < p.s(); ++r) all[p.constraints[r]] = arranged(k[p.holonomic + r], m.model->names);
    return all;
  };
  Rows found;  // differentials of holonomic constraints and of the integrals
  for (Expr f : p.phi) found.push_back(p.space.differential(f));
  for (Expr f : first_integrals(p.space, forms, own, p.phi, p.kernel, at)) {
    f = readable(p.space, f, m.model->names);
    found.push_back(p.space.differential(f));
    out.combinations.push_back({made_of(found.back()), f});
  }
  if (found.size() == forms.size()) return;
  // The remaining forms are integrable by Frobenius' theorem, without a formula.
  out.proved = proved_closed(p.space, forms, p.kernel, brackets);
  for (const Column& w : forms) {
    Rows more = found;
    more.push_back(w);
    if (rank(values_at(more, at)) < more.size()) continue;
    found = more;
    out.combinations.push_back({made_of(w), std::nullopt});
  }
}

}  // namespace

Integrability integrability(const Mechanics& m, const std::vector<std::size_t>& linear, PointValues& near) {
  Integrability out;
  if (linear.empty()) return out;
  const PrecisionScope precision(kFormDigits);
  try {
    check_states(m, linear);
    decide(m, linear, near, false, out);
  } catch (const GaveUp& e) {
    out.undecided = e.why;
  } catch (const NoValue&) {
    out.undecided = "a constraint has no value near the initial data";
  } catch (const Failure& e) {
    out.undecided = e.diagnostic.message;
  }
  return out;
}

}  // namespace anholon
