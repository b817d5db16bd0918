#include "mechanics/integrals.h"

#include <algorithm>

#include "expr/antiderivative.h"
#include "expr/arrange.h"
#include "expr/normal.h"

namespace anholon {

namespace {

// Longer expressions are not proved, nor integrated.
constexpr std::size_t kLongestProof = 2000;
// Echelon forms that are tried.
constexpr std::size_t kMostChoices = 12;
// Levels of integrals stand as symbols that no model has.
constexpr std::uint32_t kLevels = 100'000;

std::size_t nodes(Expr e) { return reachable({&e, 1}).size(); }
bool proved(Expr e) { return is_zero(e) || (nodes(e) <= kLongestProof && proved_zero(e)); }

bool closed(const FormSpace& space, const Column& w, FormPoint& at) {
  Rows d;
  for (Expr e : w) d.push_back(space.differential(e));
  const Matrix<Multi> v = values_at(d, at);
  for (std::size_t a = 0; a < w.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (abs(Multi(v(a, b) - v(b, a))) > Multi(kFormZero)) return false;
  return true;
}

// exp of the integral of mu'/mu over one variable, if that depends on it alone.
std::optional<Expr> integrating_factor(const FormSpace& space, const Column& w, std::size_t a) {
  for (std::size_t b = 0; b < w.size(); ++b) {
    if (b == a || is_zero(w[b])) continue;
    const Column dwa = space.differential(w[a]), dwb = space.differential(w[b]);
    const Expr difference = dwa[b] - dwb[a];
    const Expr g = shorter(difference / w[b]);
    if (is_zero(g)) return std::nullopt;
    for (NodeId id : symbols({&g, 1}))
      for (std::size_t c = 0; c < w.size(); ++c)
        if (c != a && space.z[c].id == id) return std::nullopt;
    const std::optional<Expr> F = antiderivative(g, space.z[a]);
    if (!F) return std::nullopt;
    return exponential(*F);
  }
  return std::nullopt;
}

bool holds_logarithm(Expr e) {
  for (NodeId id : reachable({&e, 1}))
    if (const Node& n = e.graph->node(id); n.kind == Kind::function && static_cast<Function>(n.index) == Function::log) return true;
  return false;
}

std::optional<Expr> integral_of(const FormSpace& space, const Column& w, FormPoint& at) {
  const auto attempt = [&](const Column& form) -> std::optional<Expr> {
    if (!closed(space, form, at)) return std::nullopt;
    std::optional<Expr> f = potential(form, space.z);
    if (!f) return f;
    // A product of powers has a value on both sides of zero.
    const Expr power = exponential(*f);
    return holds_logarithm(*f) && !holds_logarithm(power) ? power : *f;
  };
  if (std::optional<Expr> f = attempt(w)) return f;
  for (std::size_t a = 0; a < w.size(); ++a) {
    const std::optional<Expr> mu = integrating_factor(space, w, a);
    if (!mu) continue;
    Column scaled = w;
    for (Expr& e : scaled) e = shorter(e * *mu);
    if (std::optional<Expr> f = attempt(scaled)) return f;
  }
  return std::nullopt;
}

// The forms, and their reduced echelon forms with several choices of pivots.
std::vector<Column> candidates(const Rows& forms, FormPoint& at) {
  std::vector<Column> list(forms.begin(), forms.end());
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
    Column divisors;
    for (const Column& row : inverse(square, rough, divisors, false)) {
      Column w = row * forms;
      for (Expr& e : w) e = shorter(e);
      list.push_back(w);
    }
    ++choices;
  } while (choices < kMostChoices && ++looked_at < 10 * kMostChoices && std::prev_permutation(chosen.begin(), chosen.end()));
  return list;
}

// f = c solved for one variable, f being linear in it, and put into the forms.
class Level {
 public:
  Level(const FormSpace& space, Expr f, Expr c, FormPoint& at) {
    const Column df = space.differential(f);
    for (int pass = 0; pass < 2 && !found_; ++pass)  // a constant factor first
      for (std::size_t a = space.z.size() - (space.time ? 1 : 0); a-- > 0 && !found_;) {
        if (is_zero(df[a]) || (pass == 0 && !is_number(df[a]))) continue;
        if (const std::vector<NodeId> in = symbols({&df[a], 1}); std::binary_search(in.begin(), in.end(), space.z[a].id)) continue;
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

  void restrict(FormSpace& space, Rows& forms) const {
    Rows out;
    for (const Column& w : forms) {
      Column on;
      const Expr factor = w[variable_] / slopes_[variable_];
      for (std::size_t b = 0; b < w.size(); ++b)
        if (b != variable_) on.push_back(put(w[b] - factor * slopes_[b]));
      out.push_back(on);
    }
    forms = out;
    space.z.erase(space.z.begin() + static_cast<std::ptrdiff_t>(variable_));
  }

 private:
  bool found_ = false;
  std::size_t variable_ = 0;
  Column slopes_;
  Expr symbol_, value_;
};

// As many of the forms as are independent.
Rows independent_of(const Rows& forms, FormPoint& at) {
  Rows out;
  for (std::size_t i : choose_rows(values_at(forms, at), Multi(kIndependent)).independent) out.push_back(forms[i]);
  return out;
}

}  // namespace

std::vector<Expr> first_integrals(const FormSpace& whole, Rows forms, const Column& holonomic, const Rows& kernel, FormPoint& at) {
  Graph& g = *whole.z[0].graph;
  FormSpace space = whole;
  // What the symbols c_k stand for: everywhere, and where the holonomic constraints hold.
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
    level.restrict(space, forms);
    solved.push_back(level);
    return true;
  };
  Rows differentials;
  for (Expr f : holonomic) {
    restrict_to(f, f, g.zero());
    differentials.push_back(whole.differential(f));
  }
  std::vector<Expr> out;
  for (bool again = true; again && !forms.empty();) {
    again = false;
    for (const Column& w : candidates(forms, at)) {
      const std::optional<Expr> on_level = integral_of(space, w, at);
      if (!on_level) continue;
      const Expr f = written_out(*on_level, levels), on_surface = written_out(*on_level, levels_on_surface);
      const Column df = whole.differential(f);
      Rows more = differentials;
      more.push_back(df);
      if (rank(values_at(more, at)) < more.size()) continue;
      if (!std::all_of(kernel.begin(), kernel.end(), [&](const Column& X) { return proved(applied(df, X)); })) continue;
      differentials = more;
      out.push_back(on_surface);
      if (!restrict_to(*on_level, f, on_surface)) continue;
      forms = independent_of(forms, at);
      again = true;
      break;
    }
  }
  return out;
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
