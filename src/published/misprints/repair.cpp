// Finds misprints: changes of one place of an equation, and of several places at once, that make a false equation true.
//
// Changes are tried numerically at points of the motion (published/misprints/trial.h, together.h); survivors are judged
// like any other equation. More changes are tried only if fewer do not make the equation true.
#include <algorithm>
#include <cmath>
#include <set>

#include "published/at_points.h"
#include "published/compare.h"
#include "published/identity.h"
#include "published/misprints/together.h"

namespace anholon {

namespace {

constexpr double kNothing = 1e-9;        // relative to the size of the terms
constexpr std::size_t kMostJudged = 24;  // survivors that are proved or refuted, for each number of changes

class Repair {
 public:
  Repair(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet, Comparer& comparer)
      : equation_(equation), words_(words), comparer_(comparer), syntax_(difference_of(equation)),
        motion_(comparer.motion_for_changes(words.number(syntax_))), trial_(syntax_, words, motion_.on_motion()) {
    for (Edit& e : edits_of(syntax_, words, alphabet, motion_.highest))
      if (!is_zero_factor(e)) trial_.add(std::move(e));
  }

  std::vector<Change> run() {
    Together search(trial_, syntax_);
    for (unsigned count = 1; count <= Together::kMost && changes_.empty(); ++count) judge(search.sets_of(count));
    return std::move(changes_);
  }

 private:
  struct Survivor {
    Expr whole, left;
    Syntax syntax;
    Change change;
  };

  // True for a factor that vanishes on the motion: it makes every equation true.
  bool is_zero_factor(const Edit& e) {
    if (e.kind != Edit::Kind::factor || motion_.on_motion().empty()) return false;
    try {
      return vanishes(words_.number(e.with), motion_.on_motion());
    } catch (const Failure&) {  // not a number
      return false;
    }
  }

  // True if a whole side gets a factor that the other side has as well: such factors make any two sides equal.
  bool has_common_factor(const Syntax& changed, const std::vector<const Edit*>& edits) const {
    return std::any_of(edits.begin(), edits.end(), [&](const Edit* e) {
      return e->kind == Edit::Kind::factor && !e->in_function && innermost_term(syntax_, e->path) == 1 &&
             has_factor(changed.args[1 - e->path[0]], print(e->with));
    });
  }
  static bool has_factor(const Syntax& s, const std::string& factor) {
    if (print(s) == factor) return true;
    if (s.op == Syntax::Op::negate || s.op == Syntax::Op::power) return has_factor(s.args[0], factor);
    if (s.op != Syntax::Op::multiply) return false;
    for (std::size_t i = 0; i < s.args.size(); ++i)
      if ((i == 0 || s.operators[i - 1].op == Syntax::Op::multiply) && has_factor(s.args[i], factor)) return true;
    return false;
  }

  // Judges the likely changes first, and the others only if none of these is accepted.
  void judge(const std::vector<Misprint>& list) {
    std::size_t left = kMostJudged;
    for (std::size_t from = 0; from < list.size() && left > 0 && changes_.empty();) {
      std::vector<Survivor> survivors;
      const int cost = list[from].cost;
      for (; from < list.size() && list[from].cost == cost && left > survivors.size(); ++from)
        consider(list[from], survivors);
      left -= survivors.size();
      while (from < list.size() && list[from].cost == cost) ++from;
      for (Survivor& s : survivors) accept(s);
    }
    const auto keep = [&](auto which) {
      if (std::any_of(changes_.begin(), changes_.end(), which))
        std::erase_if(changes_, [&](const Change& c) { return !which(c); });
    };
    // Unproved changes count only if no change is proved.
    keep([](const Change& c) { return c.proved; });
    const bool quantities =
        speaks_of_quantities(equation_.left, words_) || speaks_of_quantities(equation_.right, words_);
    if (!quantities)
      keep([](const Change& c) { return !c.identity; });
    else if (comparer_.without_motion(words_.number(syntax_), motion_))
      keep([](const Change& c) { return c.identity; });
  }

  // True if two numbers of one term change: a term with another number as its factor is one change
  // (published/misprints/wrong_term.cpp).
  bool has_two_numbers_in_one_term(const std::vector<const Edit*>& edits) const {
    std::set<Path> terms;
    for (const Edit* e : edits)
      if (e->kind == Edit::Kind::coefficient && !e->in_function &&
          !terms
               .emplace(e->path.begin(),
                        e->path.begin() + static_cast<std::ptrdiff_t>(innermost_term(syntax_, e->path)))
               .second)
        return true;
    return false;
  }

  void consider(const Misprint& m, std::vector<Survivor>& survivors) {
    std::vector<const Edit*> edits;
    for (std::uint32_t i : m.edits) edits.push_back(&trial_.edit(i));
    if (has_two_numbers_in_one_term(edits)) return;
    Syntax syntax = edited(syntax_, 0, edits);
    if (has_common_factor(syntax, edits)) return;
    Expr whole, left;
    try {
      whole = words_.number(syntax);
      left = words_.number(syntax.args[0]);
    } catch (const Failure&) {
      return;
    }
    Change change = worded(edits);
    change.equation = print(syntax.args[0]) + " = " + print(syntax.args[1]);
    for (Survivor& s : survivors)
      if (same(s.whole, whole, s.left, left)) {
        if (better(change, s.change)) s = {whole, left, std::move(syntax), std::move(change)};
        return;
      }
    survivors.push_back({whole, left, std::move(syntax), std::move(change)});
  }

  void accept(Survivor& s) {
    Comparison c;
    try {
      c = comparer_.decide(s.whole);
    } catch (const Failure&) {  // the changed equation has no value
      return;
    }
    if (c.verdict == Verdict::refuted) return;
    if (c.trivial && holds_by_rates(s.syntax.args[0], s.syntax.args[1], words_)) c.trivial = false, c.what = kOfRates;
    if (c.trivial && !meant_as_identity(s.syntax.args[0], s.syntax.args[1], words_)) return;
    s.change.difference = s.whole;
    s.change.what = c.what;
    s.change.proved = c.verdict == Verdict::proved;
    s.change.identity = c.trivial;
    changes_.push_back(std::move(s.change));
  }

  // True if `a` is a better form of the same change as `b`. In an equation with two terms either may be changed: the
  // shorter form is better, else the change of the right side. Among several terms the first is changed; among several
  // factors the last ones have the dots, as in m*x'' and r*r'.
  static bool better(const Change& a, const Change& b) {
    const auto added = [](const Change& c) {
      return static_cast<long>(c.to.size()) - static_cast<long>(c.from.size());
    };
    if (added(a) != added(b)) return added(a) < added(b);
    if (a.side != b.side) return a.side > b.side;
    const auto terms = [](const Change& c) {
      std::vector<std::pair<int, std::size_t>> list;
      for (const ChangedPlace& p : c.places) list.push_back({p.side, p.term});
      return list;
    };
    if (terms(a) != terms(b)) return terms(a) < terms(b);
    const auto lateness = [](const Change& c) {
      std::size_t total = 0;
      for (std::size_t i = 0; i < c.equation.size(); ++i) total += c.equation[i] == '\'' ? i : 0;
      return total;
    };
    return lateness(a) > lateness(b);
  }

  // True if both are equal up to a constant factor; for identities, if their left sides are.
  bool same(Expr a, Expr b, Expr left_a, Expr left_b) {
    std::vector<PointValues>& points = motion_.anywhere();
    const auto nothing = [&](Expr e) {
      return std::all_of(points.begin(), points.end(),
                         [&](PointValues& at) { return std::abs(at(e)) <= kNothing * (1e-6 + size_at(e, at)); });
    };
    if (nothing(a) != nothing(b)) return false;
    return nothing(a) ? proportional(left_a, left_b) : proportional(a, b);
  }

  bool proportional(Expr a, Expr b) {
    std::vector<PointValues>& points = motion_.anywhere();
    if (points.empty()) return false;
    const double ratio = points[0](a) / points[0](b);
    return std::all_of(points.begin(), points.end(),
                       [&](PointValues& at) { return std::abs(at(a) - ratio * at(b)) <= kNothing * std::abs(at(a)); });
  }

  // ---- words ---------------------------------------------------------------------------------

  // Describes a change by the smallest term around each place; a change of several terms by the symbol alone.
  Change worded(const std::vector<const Edit*>& edits) {
    std::map<Path, std::vector<const Edit*>> terms;
    for (const Edit* e : edits)
      terms[Path(e->path.begin(), e->path.begin() + static_cast<std::ptrdiff_t>(innermost_term(syntax_, e->path)))]
          .push_back(e);
    Change change;
    for (const auto& [path, list] : terms) change.places.push_back(worded(path, list, terms.size() > 1));
    std::stable_sort(change.places.begin(), change.places.end(), [](const ChangedPlace& a, const ChangedPlace& b) {
      return std::pair(a.span.line, a.span.column) < std::pair(b.span.line, b.span.column);
    });
    static_cast<ChangedPlace&>(change) = change.places[0];
    return change;
  }

  ChangedPlace worded(const Path& term, const std::vector<const Edit*>& edits, bool several) {
    ChangedPlace p;
    p.side = static_cast<int>(term[0]);
    std::size_t top = 1;
    while (is_component(node_at(syntax_, term, top)) && term.size() > top) ++top;
    if (node_at(syntax_, term, top).op == Syntax::Op::add && term.size() > top) p.term = term[top];
    if (several && edits.size() == 1 && edits[0]->effect == Edit::Effect::replaces &&
        (edits[0]->kind == Edit::Kind::dots || edits[0]->kind == Edit::Kind::name)) {
      const Syntax& symbol = node_at(syntax_, edits[0]->path);
      return placed(p, symbol, print(symbol), print(edits[0]->with));
    }
    const Syntax& sum = node_at(syntax_, term, term.size() - 1);
    const Syntax& s = node_at(syntax_, term);
    std::vector<const Edit*> inner;
    bool sign = false;
    for (const Edit* e : edits) {
      const bool operand = e->kind == Edit::Kind::sign && e->path == term;
      sign = sign || operand;
      if (!operand) inner.push_back(e);
    }
    const Syntax after = edited(s, term.size(), inner);
    if (!sign) return placed(p, s, text(s), text(after));
    const std::uint32_t i = term.back();
    if (term.size() == 1 || sum.op != Syntax::Op::add || i == 0) return placed(p, s, text(s), text(opposite(after)));
    const bool minus = sum.operators[i - 1].op == Syntax::Op::subtract;
    return placed(p, s, (minus ? "- " : "+ ") + text(s), (minus ? "+ " : "- ") + text(after));
  }

  // True if s is the component of a vector equation that represents a side.
  static bool is_component(const Syntax& s) {
    return s.op == Syntax::Op::member && s.args[0].offset == s.offset && s.args[0].end == s.end;
  }
  static std::string text(const Syntax& s) { return is_component(s) ? print(s.args[0]) : print(s); }

  ChangedPlace placed(ChangedPlace p, const Syntax& s, std::string from, std::string to) const {
    p.from = std::move(from);
    p.to = std::move(to);
    p.span = equation_.source.span(s.offset, s.end - s.offset);
    return p;
  }

  const PublishedEquation& equation_;
  Vocabulary& words_;
  Comparer& comparer_;
  Syntax syntax_;
  EquationsOfMotion& motion_;
  Trial trial_;
  std::vector<Change> changes_;
};

}  // namespace

std::vector<Change> repairs(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet,
                            Comparer& comparer) {
  return Repair(equation, words, alphabet, comparer).run();
}

}  // namespace anholon
