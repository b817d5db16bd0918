#include "mechanics/integrals.h"

#include <algorithm>
#include <functional>

#include "expr/antiderivative.h"
#include "expr/normal.h"
#include "print/arrange.h"

namespace anholon {

namespace {

// Longer expressions are neither proved nor integrated.
constexpr std::size_t kLongestProof = 2000;
// The number of echelon forms that are tried.
constexpr std::size_t kMostChoices = 12;
// Symbols that no model has represent the levels of integrals.
constexpr std::uint32_t kLevels = 100'000;

std::size_t nodes(Expr e) { return reachable({&e, 1}).size(); }
bool proved(Expr e) { return is_zero(e) || (nodes(e) <= kLongestProof && proved_zero(e)); }

// A form with its values and those of its derivatives, by which candidates are selected.
struct Tried {
  Rows d;  // dw_a/dz_b
  Matrix<Multi> w, v;

  Tried(const FormSpace& space, const Column& form, FormPoint& at) {
    for (Expr e : form) d.push_back(space.differential(e));
    w = values_at({form}, at);
    v = values_at(d, at);
  }
  Multi curl(std::size_t a, std::size_t b) const { return v(a, b) - v(b, a); }
  // True if dw = 0 in all variables but z_a, or in all variables if a = n.
  bool closed_without(std::size_t a) const {
    for (std::size_t b = 0; b < v.rows; ++b)
      for (std::size_t c = 0; c < b; ++c)
        if (b != a && c != a && abs(curl(b, c)) > Multi(kFormZero)) return false;
    return true;
  }
};

// Returns exp of the integral of mu'/mu over one variable; nullopt if mu'/mu depends on others.
std::optional<Expr> integrating_factor(const FormSpace& space, const Column& w, const Tried& t, std::size_t a) {
  if (!t.closed_without(a)) return std::nullopt;
  std::optional<Multi> ratio;
  std::size_t by = w.size();
  for (std::size_t b = 0; b < w.size(); ++b) {
    if (b == a) continue;
    if (is_zero(w[b])) {
      if (abs(t.curl(a, b)) > Multi(kFormZero)) return std::nullopt;
      continue;
    }
    const Multi r = t.curl(a, b) / t.w(0, b);
    if (ratio && abs(Multi(r - *ratio)) > Multi(kIndependent)) return std::nullopt;
    ratio = r;
    if (by == w.size() || is_number(w[b])) by = b;
  }
  if (!ratio) return std::nullopt;
  const Expr difference = t.d[a][by] - t.d[by][a];
  const Expr g = shorter(difference / w[by]);
  if (is_zero(g)) return std::nullopt;
  for (NodeId id : symbols({&g, 1}))
    for (std::size_t c = 0; c < w.size(); ++c)
      if (c != a && space.z[c].id == id) return std::nullopt;
  const std::optional<Expr> F = antiderivative(g, space.z[a]);
  if (!F) return std::nullopt;
  return exponential(*F);
}

bool holds_logarithm(Expr e) {
  for (NodeId id : reachable({&e, 1}))
    if (const Node& n = e.graph->node(id); n.kind == Kind::function && static_cast<Function>(n.index) == Function::log)
      return true;
  return false;
}

std::optional<Expr> integral_of(const FormSpace& space, const Column& w, FormPoint& at) {
  const auto integrated = [&](const Column& form) -> std::optional<Expr> {
    std::optional<Expr> f = potential(form, space.z);
    if (!f) return f;
    // A product of powers is defined on both sides of zero.
    const Expr power = exponential(*f);
    return holds_logarithm(*f) && !holds_logarithm(power) ? power : *f;
  };
  const Tried t(space, w, at);
  if (t.closed_without(w.size()))
    if (std::optional<Expr> f = integrated(w)) return f;
  for (std::size_t a = 0; a < w.size(); ++a) {
    const std::optional<Expr> mu = integrating_factor(space, w, t, a);
    if (!mu) continue;
    Column scaled = w;
    for (Expr& e : scaled) e = shorter(e * *mu);
    if (!Tried(space, scaled, at).closed_without(w.size())) continue;
    if (std::optional<Expr> f = integrated(scaled)) return f;
  }
  return std::nullopt;
}

// Tries the forms, and then their reduced echelon forms with several choices of pivots, until `serves` accepts one.
bool any_form(const Rows& forms, FormPoint& at, const std::function<bool(const Column&)>& serves) {
  if (std::any_of(forms.begin(), forms.end(), serves)) return true;
  const std::size_t p = forms.size(), n = forms[0].size();
  const Matrix<Multi> v = values_at(forms, at);
  PointValues rough = at.rough();
  std::vector<bool> chosen(n, false);
  std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(p), true);
  std::size_t choices = 0, looked_at = 0;
  do {
    Matrix<Multi> minor(p, p);
    Rows square(p);
    std::size_t k = 0;
    for (std::size_t c = 0; c < n; ++c) {
      if (!chosen[c]) continue;
      for (std::size_t i = 0; i < p; ++i) minor(i, k) = v(i, c), square[i].push_back(forms[i][c]);
      ++k;
    }
    if (rank(minor) < p) continue;
    ++choices;
    Column divisors;
    for (const Column& row : inverse(square, rough, divisors, Wanted::brief)) {
      Column w = row * forms;
      for (Expr& e : w) e = shorter(e);
      if (serves(w)) return true;
    }
  } while (choices < kMostChoices && ++looked_at < 10 * kMostChoices &&
           std::prev_permutation(chosen.begin(), chosen.end()));
  return false;
}

// The level f = c solved for one variable in which f is linear, and substituted in the forms.
class Level {
 public:
  Level(const FormSpace& space, Expr f, Expr c, FormPoint& at) {
    const Column df = space.differential(f);
    for (int pass = 0; pass < 2 && !found_; ++pass)  // variables with a constant factor first
      for (std::size_t a = space.z.size() - (space.time ? 1 : 0); a-- > 0 && !found_;) {
        if (is_zero(df[a]) || (pass == 0 && !is_number(df[a]))) continue;
        if (const std::vector<NodeId> in = symbols({&df[a], 1});
            std::binary_search(in.begin(), in.end(), space.z[a].id))
          continue;
        if (!(abs(at(df[a])) > Multi(kFormZero))) continue;
        found_ = true;
        variable_ = a;
        slopes_ = df;
        symbol_ = space.z[a];
        Graph& g = *f.graph;
        const Expr rest = substitute({&f, 1}, [&](NodeId id) { return id == symbol_.id ? g.zero() : Expr{}; })[0];
        value_ = (c - rest) / df[a];
      }
  }
  bool found() const { return found_; }
  Expr put(Expr e) const {
    return shorter(substitute({&e, 1}, [&](NodeId id) { return id == symbol_.id ? value_ : Expr{}; })[0]);
  }

  Rows restricted(const Rows& forms) const {
    Rows out;
    for (const Column& w : forms) {
      Column on;
      const Expr factor = w[variable_] / slopes_[variable_];
      for (std::size_t b = 0; b < w.size(); ++b)
        if (b != variable_) on.push_back(put(w[b] - factor * slopes_[b]));
      out.push_back(on);
    }
    return out;
  }
  void leave_out(Column& z) const { z.erase(z.begin() + static_cast<std::ptrdiff_t>(variable_)); }

 private:
  bool found_ = false;
  std::size_t variable_ = 0;
  Column slopes_;
  Expr symbol_, value_;
};

// Returns a maximal independent subset of the forms.
Rows independent_of(const Rows& forms, FormPoint& at) {
  Rows out;
  for (std::size_t i : choose_rows(values_at(forms, at), Multi(kIndependent)).independent) out.push_back(forms[i]);
  return out;
}

}  // namespace

std::vector<Expr> first_integrals(const FormSpace& whole, Rows forms, Rows own, const Column& holonomic,
                                  const Rows& kernel, FormPoint& at) {
  Graph& g = *whole.z[0].graph;
  FormSpace space = whole;
  // The values of the symbols c_k: everywhere, and where the holonomic constraints hold.
  Column levels, levels_on_surface;
  const auto written_out = [&](Expr e, const Column& levels_of) {
    return substitute({&e, 1}, [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::quasi && n.index >= kLevels ? levels_of[n.index - kLevels] : Expr{};
    })[0];
  };
  std::vector<Level> solved;
  const auto restrict_to = [&](Expr f, Expr everywhere, Expr on_surface) {
    for (const Level& l : solved) f = l.put(f);
    const Expr c = g.quasi(kLevels + static_cast<std::uint32_t>(levels.size()), 0);
    levels.push_back(everywhere);
    levels_on_surface.push_back(on_surface);
    const Level level(space, f, c, at);
    if (!level.found()) return false;
    forms = independent_of(level.restricted(forms), at);
    own = level.restricted(own);
    level.leave_out(space.z);
    solved.push_back(level);
    return true;
  };
  Rows differentials;
  for (Expr f : holonomic) {
    restrict_to(f, f, g.zero());
    differentials.push_back(whole.differential(f));
  }
  std::vector<Expr> out;
  const auto serves = [&](const Column& w) {
    const std::optional<Expr> on_level = integral_of(space, w, at);
    if (!on_level) return false;
    const Expr f = written_out(*on_level, levels), on_surface = written_out(*on_level, levels_on_surface);
    const Column df = whole.differential(f);
    Rows more = differentials;
    more.push_back(df);
    if (rank(values_at(more, at)) < more.size()) return false;
    if (!std::all_of(kernel.begin(), kernel.end(), [&](const Column& X) { return proved(applied(df, X)); }))
      return false;
    differentials = more;
    out.push_back(on_surface);
    return restrict_to(*on_level, f, on_surface);  // else it is kept with the others
  };
  while (!forms.empty()) {
    const Rows now = forms, own_now = own;
    if (!std::any_of(own_now.begin(), own_now.end(), serves) && !any_form(now, at, serves)) break;
  }
  return out;
}

Expr readable(const FormSpace& space, Expr f, const SymbolNames& names) {
  constexpr long kMostWork = 100'000;
  const Expr as_found = arranged(f, names);
  const std::optional<NormalForm> form = normal_form(f, {}, kMostWork);
  if (form && !form->numerator.empty()) {
    Rational common = 0;
    for (const Monomial& m : form->numerator) common = gcd(common, m.coefficient);
    Expr multiple = (1 / common) * expression(form->numerator, form->generators);
    const Expr below = expression(form->denominator, form->generators);
    bool varies = false;
    for (NodeId id : symbols({&below, 1}))
      varies = varies || std::any_of(space.z.begin(), space.z.end(), [&](Expr z) { return z.id == id; });
    if (varies) multiple = multiple / below;
    f = multiple;
  }
  f = arranged(f, names);
  const auto length = [&](Expr e) { return print(e, names, Format::text).size(); };
  // Exponentials do not cancel in a normal form, which may then be longer.
  if (2 * length(f) > 3 * length(as_found)) f = as_found;
  return print(f, names, Format::text)[0] == '-' ? arranged(-f, names) : f;
}

bool proved_closed(const FormSpace& space, const Rows& forms, const Rows& kernel, const Rows& brackets) {
  Rows fields = kernel;
  fields.insert(fields.end(), brackets.begin(), brackets.end());
  for (const Column& w : forms) {
    Rows d;
    for (Expr e : w) d.push_back(space.differential(e));
    for (const Column& X : fields)
      if (!proved(applied(w, X))) return false;
    for (std::size_t i = 0; i < fields.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        // dw(X, Y) = sum_ab dw_b/dz_a (X_a Y_b - X_b Y_a).
        std::vector<Expr> terms;
        for (std::size_t b = 0; b < w.size(); ++b) {
          const Expr along_x = applied(d[b], fields[i]), along_y = applied(d[b], fields[j]);
          const Expr forth = along_x * fields[j][b];
          terms.push_back(forth - along_y * fields[i][b]);
        }
        if (!proved(sum(terms))) return false;
      }
  }
  return true;
}

}  // namespace anholon
