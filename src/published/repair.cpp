// Misprints: changes of one place of an equation, and of several places at once, that make a false equation true.
//
// They are tried in numbers at points of the motion (published/trial.h, together.h); what survives there is judged like any other
// equation. Fewer changes come first: more are looked for only where fewer do not serve.
#include <algorithm>
#include <cmath>

#include "published/compare.h"
#include "published/identity.h"
#include "published/together.h"

namespace anholon {

namespace {

constexpr std::size_t kMostJudged = 24;  // survivors that are proved or refuted, of each number of changes

class Repair {
 public:
  Repair(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet, Comparer& comparer)
      : equation_(equation), words_(words), comparer_(comparer), syntax_(difference_of(equation)),
        motion_(comparer.motion(order_of_motion(words.number(syntax_)))), trial_(syntax_, words, motion_.on_motion()) {
    for (Edit& e : edits_of(syntax_, words, alphabet)) trial_.add(std::move(e));
  }

  std::vector<Change> run() {
    Together search(trial_, syntax_);
    for (unsigned count = 1; count <= Together::kMost && changes_.empty(); ++count) judge(search.sets_of(count));
    return std::move(changes_);
  }

 private:
  struct Survivor {
    Expr whole;
    Syntax syntax;
    Change change;
  };

  // The likely ones; others only where none of these is accepted.
  void judge(const std::vector<Misprint>& list) {
    std::size_t left = kMostJudged;
    for (std::size_t from = 0; from < list.size() && left > 0 && changes_.empty();) {
      std::vector<Survivor> survivors;
      const int cost = list[from].cost;
      for (; from < list.size() && list[from].cost == cost && left > survivors.size(); ++from) consider(list[from], survivors);
      left -= survivors.size();
      while (from < list.size() && list[from].cost == cost) ++from;
      for (Survivor& s : survivors) accept(s);
    }
    const auto keep = [&](auto which) {
      if (std::any_of(changes_.begin(), changes_.end(), which)) std::erase_if(changes_, [&](const Change& c) { return !which(c); });
    };
    // What is not proved counts only where nothing is.
    keep([](const Change& c) { return c.proved; });
    const bool quantities = speaks_of_quantities(equation_.left, words_) || speaks_of_quantities(equation_.right, words_);
    keep([&](const Change& c) { return c.identity == quantities; });
  }

  void consider(const Misprint& m, std::vector<Survivor>& survivors) {
    std::vector<const Edit*> edits;
    for (std::uint32_t i : m.edits) edits.push_back(&trial_.edit(i));
    Syntax syntax = edited(syntax_, 0, edits);
    Expr whole;
    try {
      whole = words_.number(syntax);
    } catch (const Failure&) {
      return;
    }
    Change change = worded(edits);
    change.equation = print(syntax.args[0]) + " = " + print(syntax.args[1]);
    for (Survivor& s : survivors)
      if (same(s.whole, whole)) {
        // Of an equation with two terms either may be changed: the shorter way, else the right side.
        const auto added = [](const Change& c) { return static_cast<long>(c.to.size()) - static_cast<long>(c.from.size()); };
        if (added(change) < added(s.change) || (added(change) == added(s.change) && change.side > s.change.side)) s = {whole, std::move(syntax), std::move(change)};
        return;
      }
    survivors.push_back({whole, std::move(syntax), std::move(change)});
  }

  void accept(Survivor& s) {
    const Comparison c = comparer_.decide(s.whole);
    if (c.verdict == Verdict::refuted) return;
    if (c.trivial && !meant_as_identity(s.syntax.args[0], s.syntax.args[1], words_)) return;
    s.change.what = c.what;
    s.change.proved = c.verdict == Verdict::proved;
    s.change.identity = c.trivial;
    changes_.push_back(std::move(s.change));
  }

  // Equal up to a number.
  bool same(Expr a, Expr b) {
    std::vector<PointValues>& points = motion_.anywhere();
    double ratio = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double x = points[k](a), y = points[k](b);
      if (std::abs(x) + std::abs(y) < 1e-12) continue;  // both are identities
      if (ratio == 0) ratio = x / y;
      else if (!(std::abs(x - ratio * y) <= 1e-9 * std::abs(x))) return false;
    }
    return true;
  }

  // ---- words ---------------------------------------------------------------------------------

  // By the smallest term around each place; of several terms a symbol by itself.
  Change worded(const std::vector<const Edit*>& edits) {
    std::map<Path, std::vector<const Edit*>> terms;
    for (const Edit* e : edits) terms[Path(e->path.begin(), e->path.begin() + static_cast<std::ptrdiff_t>(innermost_term(syntax_, e->path)))].push_back(e);
    Change change;
    for (const auto& [path, list] : terms) change.places.push_back(worded(path, list, terms.size() > 1));
    std::stable_sort(change.places.begin(), change.places.end(), [](const ChangedPlace& a, const ChangedPlace& b) { return std::pair(a.span.line, a.span.column) < std::pair(b.span.line, b.span.column); });
    static_cast<ChangedPlace&>(change) = change.places[0];
    return change;
  }

  ChangedPlace worded(const Path& term, const std::vector<const Edit*>& edits, bool several) {
    ChangedPlace p;
    p.side = static_cast<int>(term[0]);
    std::size_t top = 1;
    while (is_component(node_at(syntax_, term, top)) && term.size() > top) ++top;
    if (node_at(syntax_, term, top).op == Syntax::Op::add && term.size() > top) p.term = term[top];
    if (several && edits.size() == 1 && edits[0]->effect == Edit::Effect::replaces && (edits[0]->kind == Edit::Kind::dots || edits[0]->kind == Edit::Kind::name)) {
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

  // The component of a vector equation that stands for the side.
  static bool is_component(const Syntax& s) { return s.op == Syntax::Op::member && s.args[0].offset == s.offset && s.args[0].end == s.end; }
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

std::vector<Change> repairs(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet, Comparer& comparer) {
  return Repair(equation, words, alphabet, comparer).run();
}

}  // namespace anholon
