// Misprints: changes of one place of a formula, tried one after the other.
//
// An edit replaces one node of the syntax tree of a term. It is tried in numbers at points of the motion, where only the term
// is evaluated again; what survives there is judged like any other equation.
#include <algorithm>
#include <cmath>
#include <set>

#include "published/compare.h"

namespace anholon {

namespace {

constexpr double kVanishes = 1e-9;
constexpr std::size_t kMostJudged = 24;     // survivors that are proved or refuted
constexpr std::size_t kMostPairs = 20'000;  // pairs of edits that are tried

using Path = std::vector<std::size_t>;

struct Edit {
  Path path;            // of the node that is replaced
  Syntax replacement;
  std::size_t operand = SIZE_MAX;  // a sign before this operand of the sum at `path`
};

Syntax number(std::string text) { return {Syntax::Op::number, std::move(text), {}, {}, 0, 0, {}}; }

Syntax with(Syntax::Op op, std::vector<Syntax> args, std::vector<Syntax::Operator> operators = {}) {
  return {op, {}, std::move(args), {}, 0, 0, std::move(operators)};
}

const Syntax& at(const Syntax& s, const Path& path, std::size_t length) {
  const Syntax* node = &s;
  for (std::size_t i = 0; i < length; ++i) node = &node->args[path[i]];
  return *node;
}

Syntax applied(const Syntax& s, const Edit& e) {
  Syntax out = s;
  Syntax* node = &out;
  for (std::size_t i : e.path) node = &node->args[i];
  *node = e.replacement;
  return out;
}

// -x for x and the other way round; a minus is taken from the first factor of a product.
Syntax opposite(const Syntax& s) {
  if (s.op == Syntax::Op::negate) return s.args[0];
  if (s.op == Syntax::Op::multiply && s.args[0].op == Syntax::Op::negate) {
    Syntax out = s;
    out.args[0] = s.args[0].args[0];
    return out;
  }
  if (s.op == Syntax::Op::multiply) {
    Syntax out = s;
    out.args[0] = with(Syntax::Op::negate, {s.args[0]});
    return out;
  }
  return with(Syntax::Op::negate, {s});
}

bool is_whole(const Syntax& s, long& value) {
  if (s.op != Syntax::Op::number || s.text.empty() || s.text.size() > 6) return false;
  if (!std::all_of(s.text.begin(), s.text.end(), [](char c) { return c >= '0' && c <= '9'; })) return false;
  value = std::stol(s.text);
  return true;
}

// The factor in place k of a product taken out.
Syntax without(const Syntax& s, std::size_t k) {
  Syntax out = s;
  if (k == 0) {
    if (s.operators[0].op == Syntax::Op::divide) {
      out.args[0] = number("1");
      return out;
    }
    out.operators.erase(out.operators.begin());
  } else {
    out.operators.erase(out.operators.begin() + static_cast<std::ptrdiff_t>(k - 1));
  }
  out.args.erase(out.args.begin() + static_cast<std::ptrdiff_t>(k));
  return out.args.size() == 1 ? Syntax(out.args[0]) : out;
}

// Twice the term, or half of it.
Syntax scaled(const Syntax& s, bool twice) {
  long n = 0;
  if (s.op == Syntax::Op::negate) return with(Syntax::Op::negate, {scaled(s.args[0], twice)});
  if (is_whole(s, n) && (twice || n % 2 == 0)) return number(std::to_string(twice ? 2 * n : n / 2));
  if (s.op == Syntax::Op::multiply) {
    if (is_whole(s.args[0], n) && n != 1 && (twice || n % 2 == 0)) {
      if (!twice && n == 2) return without(s, 0);
      Syntax out = s;
      out.args[0] = number(std::to_string(twice ? 2 * n : n / 2));
      return out;
    }
    for (std::size_t k = 1; k < s.args.size(); ++k)
      if (s.operators[k - 1].op == Syntax::Op::divide && is_whole(s.args[k], n)) {
        if (twice && n % 2 != 0) continue;
        if (twice && n == 2) return without(s, k);
        Syntax out = s;
        out.args[k] = number(std::to_string(twice ? n / 2 : 2 * n));
        return out;
      }
    Syntax out = s;
    if (twice) {
      out.args.insert(out.args.begin(), number("2"));
      out.operators.insert(out.operators.begin(), {Syntax::Op::multiply, {}});
    } else {
      out.args.push_back(number("2"));
      out.operators.push_back({Syntax::Op::divide, {}});
    }
    return out;
  }
  if (twice) return with(Syntax::Op::multiply, {number("2"), s}, {{Syntax::Op::multiply, {}}});
  return with(Syntax::Op::multiply, {s, number("2")}, {{Syntax::Op::divide, {}}});
}

// All edits of one term, the likely kinds first.
class Edits {
 public:
  Edits(const Syntax& term, Vocabulary& words, const Alphabet& alphabet, bool with_names) : words_(words), alphabet_(alphabet) {
    visit(term, {}, true);
    for (auto* kind : {&signs_, &primes_, &coefficients_, &exponents_, &functions_})
      for (Edit& e : *kind) list.push_back(std::move(e));
    if (with_names)
      for (Edit& e : replaced_) list.push_back(std::move(e));
  }
  std::vector<Edit> list;

 private:
  // A sum in a product, an argument, … and what stands between its signs is a term.
  void visit(const Syntax& s, const Path& path, bool term) {
    if (term && s.op != Syntax::Op::add && s.op != Syntax::Op::array) {
      coefficients_.push_back({path, scaled(s, true)});
      coefficients_.push_back({path, scaled(s, false)});
      for (const std::vector<std::string>* group : {&alphabet_.coordinates, &alphabet_.others})
        for (const std::string& n : *group) replaced_.push_back({path, times(n, s)});  // a factor is lost
    }
    switch (s.op) {
      case Syntax::Op::number: {
        long n = 0;
        if (!is_whole(s, n)) return;
        for (long k : {n - 1, n + 1})
          if (k > 0) coefficients_.push_back({path, number(std::to_string(k))});
        return;
      }
      case Syntax::Op::prime: case Syntax::Op::name: case Syntax::Op::member: {
        derivatives(s, path);
        squared(s, path);
        const Syntax* base = &s;
        Path inner = path;
        for (; base->op == Syntax::Op::prime; base = &base->args[0]) inner.push_back(0);
        if (base->op == Syntax::Op::name) other_names(*base, inner);
        else if (base->op == Syntax::Op::call || base->op == Syntax::Op::add || base->op == Syntax::Op::multiply) below(*base, inner);
        return;
      }
      case Syntax::Op::call:
        squared(s, path);
        for (const auto& [from, to] : {std::pair{"sin", "cos"}, {"cos", "sin"}, {"sinh", "cosh"}, {"cosh", "sinh"}})
          if (s.text == from) {
            Syntax other = s;
            other.text = to;
            functions_.push_back({path, other});
          }
        for (std::size_t i = 0; i < s.args.size(); ++i) visit(s.args[i], extended(path, i), true);
        return;
      case Syntax::Op::power: {
        long n = 0;
        const bool minus = s.args[1].op == Syntax::Op::negate;
        if (is_whole(minus ? s.args[1].args[0] : s.args[1], n)) {
          if (minus) n = -n;
          for (long k : {n - 1, n + 1}) {
            if (k == 0) continue;
            Syntax other = s;
            other.args[1] = k > 0 ? number(std::to_string(k)) : with(Syntax::Op::negate, {number(std::to_string(-k))});
            exponents_.push_back({path, k == 1 ? s.args[0] : other});
          }
        }
        in_power_ = true;
        visit(s.args[0], extended(path, 0), false);
        in_power_ = false;
        return;
      }
      case Syntax::Op::add: {
        for (std::size_t i = 0; i < s.args.size(); ++i) {
          Syntax other = s;
          if (i == 0) other.args[0] = opposite(s.args[0]);
          else other.operators[i - 1].op = s.operators[i - 1].op == Syntax::Op::add ? Syntax::Op::subtract : Syntax::Op::add;
          signs_.push_back({path, other, i});
        }
        if (!term) squared(s, path);
        below(s, path);
        return;
      }
      case Syntax::Op::multiply:
        for (std::size_t i = 0; i < s.args.size(); ++i) {
          long n = 0;
          if (!is_whole(s.args[i], n) && s.args[i].op != Syntax::Op::power) exponents_.push_back({path, without(s, i)});
          visit(s.args[i], extended(path, i), false);
        }
        return;
      case Syntax::Op::negate: visit(s.args[0], extended(path, 0), false); return;
      default: below(s, path); return;
    }
  }

  static Syntax times(const std::string& name, const Syntax& s) {
    const Syntax factor{Syntax::Op::name, name, {}, s.span, s.offset, s.end, {}};
    if (s.op != Syntax::Op::multiply) return with(Syntax::Op::multiply, {factor, s}, {{Syntax::Op::multiply, {}}});
    Syntax out = s;
    const std::ptrdiff_t at = s.args[0].op == Syntax::Op::number ? 1 : 0;
    if (at == 1 && s.operators[0].op == Syntax::Op::divide) return with(Syntax::Op::multiply, {factor, s}, {{Syntax::Op::multiply, {}}});
    out.args.insert(out.args.begin() + at, factor);
    out.operators.insert(out.operators.begin(), {Syntax::Op::multiply, {}});
    return out;
  }

  void below(const Syntax& s, const Path& path) {
    for (std::size_t i = 0; i < s.args.size(); ++i) visit(s.args[i], extended(path, i), true);
  }

  static Path extended(Path path, std::size_t i) {
    path.push_back(i);
    return path;
  }

  void squared(const Syntax& s, const Path& path) {
    if (std::exchange(in_power_, false)) return;  // the exponent is changed instead
    exponents_.push_back({path, with(Syntax::Op::power, {s, number("2")})});
  }

  void derivatives(const Syntax& s, const Path& path) {
    if (s.op == Syntax::Op::prime) primes_.push_back({path, s.args[0]});
    try {
      const Expr e = words_.number(s);
      if (!is_zero(total_derivative(e))) primes_.push_back({path, with(Syntax::Op::prime, {s})});
    } catch (const Failure&) {
    }
  }

  void other_names(const Syntax& s, const Path& path) {
    const auto among = [&](const std::vector<std::string>& list_of) { return std::find(list_of.begin(), list_of.end(), s.text) != list_of.end(); };
    for (const std::vector<std::string>* group : {&alphabet_.coordinates, &alphabet_.others}) {
      if (!among(*group)) continue;
      for (const std::string& n : *group)
        if (n != s.text) {
          Syntax other = s;
          other.text = n;
          replaced_.push_back({path, other});
        }
    }
    if (!among(alphabet_.others)) return;
    // c for cos(psi): an abbreviation that was taken for a name.
    for (const std::string& n : alphabet_.coordinates)
      for (const char* f : {"cos", "sin"}) {
        Syntax argument = s;
        argument.text = n;
        Syntax other = with(Syntax::Op::call, {argument});
        other.text = f;
        replaced_.push_back({path, other});
      }
  }

  Vocabulary& words_;
  const Alphabet& alphabet_;
  bool in_power_ = false;
  std::vector<Edit> signs_, primes_, coefficients_, exponents_, functions_, replaced_;
};

// A term of a side, with the sign before it.
struct TopTerm {
  int side;
  std::size_t index;
  bool minus;
  Syntax syntax;
  Expr value;
};

std::vector<TopTerm> terms_of(const PublishedEquation& equation, Vocabulary& words) {
  std::vector<TopTerm> list;
  for (const int side : {0, 1}) {
    const Syntax& s = side == 0 ? equation.left : equation.right;
    if (s.op != Syntax::Op::add) {
      list.push_back({side, 0, false, s, words.number(s)});
      continue;
    }
    for (std::size_t i = 0; i < s.args.size(); ++i)
      list.push_back({side, i, i > 0 && s.operators[i - 1].op == Syntax::Op::subtract, s.args[i], words.number(s.args[i])});
  }
  return list;
}

class Repair {
 public:
  Repair(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet, Comparer& comparer)
      : equation_(equation), words_(words), alphabet_(alphabet), comparer_(comparer), terms_(terms_of(equation, words)),
        whole_(words.number(equation.left) - words.number(equation.right)),
        motion_(comparer.motion(order_of_motion(whole_))) {
    for (PointValues& p : motion_.on_motion()) {
      value_.push_back(p(whole_));
      double size = 1e-9;
      for (const TopTerm& t : terms_) size += size_at(t.value, p);
      size_.push_back(size);
    }
  }

  std::vector<Change> run() {
    for (const TopTerm& t : terms_) {
      const bool front = t.index == 0;
      try_term(t, {opposite(t.syntax), true}, (t.minus ? "- " : front ? "" : "+ ") + print(t.syntax),
               front ? print(opposite(t.syntax)) : (t.minus ? "+ " : "- ") + print(t.syntax), t.syntax);
    }
    for (const TopTerm& t : terms_)
      for (const Edit& e : Edits(t.syntax, words_, alphabet_, true).list) try_edit(t, e);
    judge();
    if (!changes_.empty()) return changes_;
    // Short terms first: the number of pairs is bounded.
    std::stable_sort(terms_.begin(), terms_.end(), [](const TopTerm& a, const TopTerm& b) { return print(a.syntax).size() < print(b.syntax).size(); });
    std::size_t tried = 0;
    for (const TopTerm& t : terms_)
      for (const Edit& first : Edits(t.syntax, words_, alphabet_, false).list) {
        const Syntax once = applied(t.syntax, first);
        for (const Edit& second : Edits(once, words_, alphabet_, false).list) {
          if (++tried > kMostPairs) break;
          if (second.path < first.path) continue;  // tried in the other order
          const Syntax twice = applied(once, second);
          try_term(t, {twice, false}, print(t.syntax), {}, t.syntax);
        }
      }
    judge();
    return changes_;
  }

 private:
  struct Edited {
    Syntax syntax;
    bool negated;  // the sign in front has been taken into the syntax
  };
  struct Survivor {
    Expr whole;
    Change change;
  };

  // The smallest term around the place, before and after.
  void try_edit(const TopTerm& t, const Edit& e) {
    const Syntax edited = applied(t.syntax, e);
    if (e.operand != SIZE_MAX) {
      const Syntax& sum = at(t.syntax, e.path, e.path.size());
      const Syntax& operand = sum.args[e.operand];
      const bool minus = e.operand > 0 && sum.operators[e.operand - 1].op == Syntax::Op::subtract;
      if (e.operand == 0) return try_term(t, {edited, false}, print(operand), print(opposite(operand)), operand);
      return try_term(t, {edited, false}, (minus ? "- " : "+ ") + print(operand), (minus ? "+ " : "- ") + print(operand), operand);
    }
    std::size_t around = 0;
    for (std::size_t k = 0; k < e.path.size(); ++k)
      if (at(t.syntax, e.path, k).op == Syntax::Op::add) around = k + 1;
    try_term(t, {edited, false}, print(at(t.syntax, e.path, around)), print(at(edited, e.path, around)), at(t.syntax, e.path, around));
  }

  void try_term(const TopTerm& t, const Edited& edited, std::string from, std::string to, const Syntax& place) {
    if (survivors_.size() >= kMostJudged) return;
    Expr value;
    try {
      value = words_.number(edited.syntax);
    } catch (const Failure&) {
      return;
    }
    if (value == t.value) return;
    const int sign = (t.side == 0 ? 1 : -1) * (t.minus ? -1 : 1);
    std::vector<PointValues>& points = motion_.on_motion();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double now = points[k](value), all = value_[k] + sign * (now - points[k](t.value));
      if (!(std::abs(all) <= kVanishes * (size_[k] + std::abs(now)))) return;
    }
    const Expr whole = whole_ + sign * (value - t.value);
    if (to.empty()) to = print(edited.syntax);
    Change change{t.side, t.index, std::move(from), std::move(to), equation_.source.span(place.offset, place.end - place.offset), {}, false};
    for (Survivor& s : survivors_)
      if (same(s.whole, whole)) {
        // Of an equation with two terms either may be changed: the shorter way, else the right side.
        const auto added = [](const Change& c) { return static_cast<long>(c.to.size()) - static_cast<long>(c.from.size()); };
        if (added(change) < added(s.change) || (added(change) == added(s.change) && change.side > s.change.side)) s = {whole, std::move(change)};
        return;
      }
    survivors_.push_back({whole, std::move(change)});
  }

  // Equal up to a number.
  bool same(Expr a, Expr b) {
    std::vector<PointValues>& points = motion_.anywhere();
    double ratio = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double x = points[k](a), y = points[k](b);
      if (k == 0) ratio = x / y;
      else if (!(std::abs(x - ratio * y) <= 1e-9 * std::abs(x))) return false;
    }
    return true;
  }

  void judge() {
    for (Survivor& s : survivors_) {
      const Comparison c = comparer_.judge(s.whole);
      if (c.trivial || c.verdict == Verdict::refuted) continue;
      s.change.what = c.what;
      s.change.proved = c.verdict == Verdict::proved;
      changes_.push_back(std::move(s.change));
    }
    survivors_.clear();
    // What is not proved counts only where nothing is.
    if (std::any_of(changes_.begin(), changes_.end(), [](const Change& c) { return c.proved; }))
      std::erase_if(changes_, [](const Change& c) { return !c.proved; });
  }

  const PublishedEquation& equation_;
  Vocabulary& words_;
  const Alphabet& alphabet_;
  Comparer& comparer_;
  std::vector<TopTerm> terms_;
  Expr whole_;
  EquationsOfMotion& motion_;
  std::vector<double> value_, size_;
  std::vector<Survivor> survivors_;
  std::vector<Change> changes_;
};

}  // namespace

std::vector<Change> repairs(const PublishedEquation& equation, Vocabulary& words, const Alphabet& alphabet, Comparer& comparer) {
  return Repair(equation, words, alphabet, comparer).run();
}

}  // namespace anholon
