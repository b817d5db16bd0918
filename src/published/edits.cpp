#include "published/edits.h"

#include <algorithm>

#include "published/vocabulary.h"

namespace anholon {

namespace {

using Effect = Edit::Effect;
using Words = std::vector<std::string>;

Syntax number(std::string text) { return {Syntax::Op::number, std::move(text), {}, {}, 0, 0, {}}; }
Syntax named(std::string text) { return {Syntax::Op::name, std::move(text), {}, {}, 0, 0, {}}; }

Syntax with(Syntax::Op op, std::vector<Syntax> args, std::vector<Syntax::Operator> operators = {}) {
  return {op, {}, std::move(args), {}, 0, 0, std::move(operators)};
}

bool has(const Words& list, const std::string& name) { return std::find(list.begin(), list.end(), name) != list.end(); }

bool is_whole(const Syntax& s, long& value) {
  if (s.op != Syntax::Op::number || s.text.empty() || s.text.size() > 6) return false;
  if (!std::all_of(s.text.begin(), s.text.end(), [](char c) { return c >= '0' && c <= '9'; })) return false;
  value = std::stol(s.text);
  return true;
}

bool is_one(const Syntax& s) {
  long n = 0;
  return is_whole(s, n) && n == 1;
}

Syntax whole(long n) {
  return n < 0 ? with(Syntax::Op::negate, {number(std::to_string(-n))}) : number(std::to_string(n));
}

// Returns the product without its factor k.
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

// Returns twice the term, or half of it.
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

Syntax multiplied(const Syntax& factor, const Syntax& s) {
  if (s.op != Syntax::Op::multiply) return with(Syntax::Op::multiply, {factor, s}, {{Syntax::Op::multiply, {}}});
  Syntax out = s;
  const bool divided = s.operators[0].op == Syntax::Op::divide;
  const bool behind = s.args[0].op == Syntax::Op::number || (s.args[0].op == Syntax::Op::negate && !divided);
  const std::ptrdiff_t at = behind ? 1 : 0;
  if (at == 1 && s.operators[0].op == Syntax::Op::divide)
    return with(Syntax::Op::multiply, {factor, s}, {{Syntax::Op::multiply, {}}});
  out.args.insert(out.args.begin() + at, factor);
  out.operators.insert(out.operators.begin(), {Syntax::Op::multiply, {}});
  return out;
}

Syntax after(const Syntax& s, const Edit& e) {
  switch (e.effect) {
  case Effect::replaces:
    return e.with;
  case Effect::squares:
    return with(Syntax::Op::power, {s, number("2")});
  case Effect::multiplies:
    break;
  }
  if (e.kind == Edit::Kind::sign) return opposite(s);
  if (e.kind == Edit::Kind::coefficient) return scaled(s, e.with.op == Syntax::Op::number);
  return multiplied(e.with, s);
}

// Groups of names in which any name may be mistaken for another.
const Words kAlike[] = {
    {"Q", "QR", "QD", "Qomega", "minus_dVO", "minus_dVomega", "Gamma", "G"},
    {"T_r", "S_r"},
    {"V_O", "V_omega"},
    {"ex", "ey", "ez"},
};
const Words kComponents = {"x", "y", "z"};
const Words kElementary = {"sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log", "asin", "acos", "atan", "sqrt"};
const std::pair<const char*, const char*> kFunctions[] = {
    {"sin", "cos"}, {"sinh", "cosh"}, {"vel", "acc"}, {"D", "Dt"}, {"reduced", "star"}};

class Search {
 public:
  Search(Vocabulary& words, const Alphabet& alphabet, unsigned most_dots)
      : words_(words), alphabet_(alphabet), most_dots_(most_dots) {
    for (const Words& group : {alphabet.coordinates, alphabet.others, words.local_names()})
      for (const std::string& n : group) factors_.push_back(named(n));
    for (const std::string& n : alphabet.coordinates) factors_.push_back(with(Syntax::Op::prime, {named(n)}));
    for (const std::string& n : alphabet.free) factors_.push_back(named(n));
  }

  std::vector<Edit> of(const Syntax& difference) {
    for (std::uint32_t side : {0U, 1U}) {
      path_ = {side};
      const Syntax& s = difference.args[side];
      if (s.op != Syntax::Op::add && !is_zero_number(s)) add(Edit::Kind::sign, Effect::multiplies, whole(-1));
      visit(s, true);
    }
    std::stable_sort(list_.begin(), list_.end(), [](const Edit& a, const Edit& b) { return a.kind < b.kind; });
    return std::move(list_);
  }

 private:
  static bool is_zero_number(const Syntax& s) {
    long n = 1;
    return is_whole(s, n) && n == 0;
  }

  void add(Edit::Kind kind, Effect effect, Syntax with) {
    list_.push_back({path_, kind, effect, std::move(with), in_function_ > 0});
  }
  // Adds an edit at a node below the visited one.
  void add_at(std::initializer_list<std::size_t> below, Edit::Kind kind, Effect effect, Syntax with) {
    for (std::size_t i : below) path_.push_back(static_cast<std::uint32_t>(i));
    add(kind, effect, std::move(with));
    path_.resize(path_.size() - below.size());
  }
  void visit_at(const Syntax& s, std::size_t i, bool term, bool base_of_power = false) {
    path_.push_back(static_cast<std::uint32_t>(i));
    visit(s.args[i], term, base_of_power);
    path_.pop_back();
  }
  void below(const Syntax& s) {
    for (std::size_t i = 0; i < s.args.size(); ++i) visit_at(s, i, true);
  }

  // Visits a node. In a sum within a product, an argument, …, each part between the signs is a term.
  void visit(const Syntax& s, bool term, bool base_of_power = false) {
    if (term && s.op != Syntax::Op::add && s.op != Syntax::Op::array) {
      add(Edit::Kind::coefficient, Effect::multiplies, number("2"));
      add(Edit::Kind::coefficient, Effect::multiplies,
          with(Syntax::Op::multiply, {number("1"), number("2")}, {{Syntax::Op::divide, {}}}));
      for (const Syntax& lost : factors_) add(Edit::Kind::factor, Effect::multiplies, lost);
    }
    // For the base of a power the exponent is changed instead.
    const auto square = [&] {
      if (!base_of_power) add(Edit::Kind::exponent, Effect::squares, number("2"));
    };
    switch (s.op) {
    case Syntax::Op::number: {
      long n = 0;
      if (!is_whole(s, n)) return;
      for (long k : {n - 1, n + 1})
        if (k > 0) add(Edit::Kind::coefficient, Effect::replaces, whole(k));
      return;
    }
    case Syntax::Op::prime:
    case Syntax::Op::name:
    case Syntax::Op::member:
      derivatives(s);
      square();
      undotted(s);
      return;
    case Syntax::Op::call:
      square();
      call(s);
      return;
    case Syntax::Op::power:
      power(s);
      return;
    case Syntax::Op::add:
      for (std::size_t i = 0; i < s.args.size(); ++i) add_at({i}, Edit::Kind::sign, Effect::multiplies, whole(-1));
      if (!term) square();
      below(s);
      return;
    case Syntax::Op::array:
      for (std::size_t i = 0; i < s.args.size(); ++i) add_at({i}, Edit::Kind::sign, Effect::multiplies, whole(-1));
      below(s);
      return;
    case Syntax::Op::multiply:
      for (std::size_t i = 0; i < s.args.size(); ++i) {
        long n = 0;
        if (!is_whole(s.args[i], n) && s.args[i].op != Syntax::Op::power)
          add_at({i}, Edit::Kind::exponent, Effect::replaces, number("1"));
        visit_at(s, i, false);
      }
      return;
    case Syntax::Op::negate:
      visit_at(s, 0, false);
      return;
    case Syntax::Op::quantity:
    case Syntax::Op::index:
    case Syntax::Op::apply:
    case Syntax::Op::compare:
      below(s);
      return;
    case Syntax::Op::subtract:
    case Syntax::Op::divide:
    case Syntax::Op::dot:
    case Syntax::Op::cross:
      return;
    }
  }

  void power(const Syntax& s) {
    long n = 0;
    const bool minus = s.args[1].op == Syntax::Op::negate;
    if (is_whole(minus ? s.args[1].args[0] : s.args[1], n)) {
      if (minus) n = -n;
      for (long k : {n - 1, n + 1})
        if (k != 0) add_at({1}, Edit::Kind::exponent, Effect::replaces, whole(k));
      add_at({1}, Edit::Kind::exponent, Effect::replaces, whole(-n));
    } else {
      ++in_function_;
      visit_at(s, 1, true);
      --in_function_;
    }
    visit_at(s, 0, false, true);
  }

  void call(const Syntax& s) {
    for (const auto& [a, b] : kFunctions)
      if (s.text == a || s.text == b) renamed(s, s.text == a ? b : a, Edit::Kind::function);
    for (const std::string& n : alike(s.text)) renamed(s, n, Edit::Kind::name);  // Q(x)
    const bool elementary = has(kElementary, s.text);
    in_function_ += elementary;
    below(s);
    in_function_ -= elementary;
  }

  void renamed(const Syntax& s, const std::string& name, Edit::Kind kind) {
    Syntax other = s;
    other.text = name;
    add(kind, Effect::replaces, std::move(other));
  }

  // Adds edits with more dots, and with one or two fewer.
  void derivatives(const Syntax& s) {
    try {
      Expr rate = words_.number(s);
      Syntax dotted = s;
      for (unsigned k = 0; k < most_dots_; ++k) {
        rate = total_derivative(rate);
        if (is_zero(rate)) break;
        dotted = with(Syntax::Op::prime, {dotted});
        add(Edit::Kind::dots, Effect::replaces, dotted);
      }
    } catch (const Failure&) {  // not a number
    }
    if (s.op != Syntax::Op::prime) return;
    add(Edit::Kind::spare_dots, Effect::replaces, s.args[0]);
    if (s.args[0].op == Syntax::Op::prime) add(Edit::Kind::spare_dots, Effect::replaces, s.args[0].args[0]);
  }

  // Visits the symbol before the dots of a derivative.
  void undotted(const Syntax& s) {
    if (s.op == Syntax::Op::prime) {
      path_.push_back(0);
      ++dots_;
      if (s.args[0].op == Syntax::Op::prime || s.args[0].op == Syntax::Op::name || s.args[0].op == Syntax::Op::member)
        undotted(s.args[0]);
      else
        below(s.args[0]);
      --dots_;
      path_.pop_back();
    } else if (s.op == Syntax::Op::member) {
      if (has(kComponents, s.text))
        for (const std::string& n : kComponents)
          if (n != s.text) renamed(s, n, Edit::Kind::name);
      below(s);
    } else {
      for (const std::string& n : exchanged(s.text))
        if (dots_ == 0 || varies(n)) renamed(s, n, Edit::Kind::name);
      if (!has(alphabet_.others, s.text)) return;
      // cos(psi) may replace c: an abbreviation was taken for a name.
      for (const std::string& n : alphabet_.coordinates)
        for (const char* f : {"cos", "sin"}) {
          Syntax other = with(Syntax::Op::call, {named(n)});
          other.text = f;
          add(Edit::Kind::name, Effect::replaces, std::move(other));
        }
    }
  }

  bool varies(const std::string& name) {
    try {
      return !is_zero(words_.number(with(Syntax::Op::prime, {named(name)})));
    } catch (const Failure&) {  // not a number
      return true;
    }
  }

  Words alike(const std::string& name) const {
    Words out;
    if (has(alphabet_.coordinates, name) || has(alphabet_.others, name)) return out;
    for (const Words& group : kAlike)
      if (has(group, name))
        std::copy_if(group.begin(), group.end(), std::back_inserter(out),
                     [&](const std::string& n) { return n != name; });
    return out;
  }

  // Returns the names that may replace a name; for Q.x another member, or another force.
  Words exchanged(const std::string& name) const {
    Words out = alike(name);
    const auto put = [&](std::size_t from, std::size_t length, const Words& list) {
      const std::string part = name.substr(from, length);
      if (!has(list, part)) return;
      for (const std::string& n : list)
        if (n != part) out.push_back(name.substr(0, from) + n + name.substr(from + part.size()));
    };
    const Words* const lists[] = {&alphabet_.coordinates, &alphabet_.others, &alphabet_.constraints, &alphabet_.masses,
                                  &alphabet_.free};
    const std::size_t first = name.find('.');
    if (first == std::string::npos) {
      put(0, name.size(), alphabet_.coordinates);
      put(0, name.size(), alphabet_.others);
      if (name.rfind("m_", 0) == 0 && !has(alphabet_.others, name)) put(2, name.size(), alphabet_.masses);
      return out;
    }
    for (const std::string& n : alike(name.substr(0, first))) out.push_back(n + name.substr(first));
    // A name of the model may contain dots.
    for (std::size_t from = first; from != std::string::npos; from = name.find('.', from + 1)) {
      for (const Words* list : lists) put(from + 1, std::string::npos, *list);
      for (std::size_t to = name.find('.', from + 1); to != std::string::npos; to = name.find('.', to + 1))
        put(from + 1, to - from - 1, alphabet_.coordinates);
    }
    return out;
  }

  Vocabulary& words_;
  const Alphabet& alphabet_;
  unsigned most_dots_;
  std::vector<Syntax> factors_;  // the factors that a term may have lost
  Path path_;
  int in_function_ = 0, dots_ = 0;  // around the visited node
  std::vector<Edit> list_;
};

}  // namespace

Syntax difference_of(const PublishedEquation& e) {
  return with(Syntax::Op::add, {e.left, e.right}, {{Syntax::Op::subtract, {}}});
}

const Syntax& node_at(const Syntax& s, const Path& path, std::size_t length) {
  const Syntax* node = &s;
  for (std::size_t i = 0; i < length; ++i) node = &node->args[path[i]];
  return *node;
}

std::size_t innermost_term(const Syntax& difference, const Path& path) {
  const Syntax* node = &difference;
  std::size_t length = 1;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (node->op == Syntax::Op::add) length = i + 1;
    node = &node->args[path[i]];
  }
  return length;
}

std::vector<Edit> edits_of(const Syntax& difference, Vocabulary& words, const Alphabet& alphabet, unsigned most_dots) {
  return Search(words, alphabet, most_dots).of(difference);
}

// Returns the opposite. The minus of a product is taken from its first factor.
Syntax opposite(const Syntax& s) {
  if (s.op == Syntax::Op::negate) return s.args[0];
  if (s.op == Syntax::Op::multiply) {
    Syntax out = s;
    out.args[0] = s.args[0].op == Syntax::Op::negate ? s.args[0].args[0] : with(Syntax::Op::negate, {s.args[0]});
    return out;
  }
  return with(Syntax::Op::negate, {s});
}

Syntax edited(const Syntax& s, std::size_t depth, const std::vector<const Edit*>& edits) {
  Syntax out = s;
  std::vector<bool> ones(s.args.size(), false);
  for (std::size_t i = 0; i < s.args.size(); ++i) {
    std::vector<const Edit*> below;
    const Edit* sign = nullptr;
    for (const Edit* e : edits) {
      if (e->path.size() <= depth || e->path[depth] != i) continue;
      const bool operand =
          e->kind == Edit::Kind::sign && e->path.size() == depth + 1 && s.op == Syntax::Op::add && i > 0 && depth > 0;
      if (operand)
        sign = e;
      else
        below.push_back(e);
    }
    if (sign)
      out.operators[i - 1].op = s.operators[i - 1].op == Syntax::Op::add ? Syntax::Op::subtract : Syntax::Op::add;
    if (below.empty()) continue;
    out.args[i] = edited(s.args[i], depth + 1, below);
    ones[i] = is_one(out.args[i]);
  }
  // A factor or an exponent that becomes 1 is not printed.
  if (out.op == Syntax::Op::multiply) {
    std::size_t left = out.args.size();
    for (std::size_t i = left; i-- > 0 && left > 1;)
      if (ones[i]) {
        out = without(out, i);
        --left;
      }
  } else if (out.op == Syntax::Op::power && ones[1]) {
    out = Syntax(out.args[0]);
  }
  for (const Edit* e : edits)
    if (e->path.size() == depth) out = after(out, *e);
  return out;
}

}  // namespace anholon
