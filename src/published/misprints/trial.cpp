#include "published/misprints/trial.h"

#include <algorithm>
#include <cmath>

namespace anholon {

namespace {

constexpr double kVanishes = 1e-9;            // relative to the size of the terms
constexpr double kChanges = 1e-13;            // a smaller change is a rounding error
constexpr std::size_t kMostFormulas = 6'000;  // evaluations of formulas that contain changes

struct Elementary {
  const char* name;
  double (*f)(double);
};
const Elementary kElementary[] = {{"sin", std::sin},   {"cos", std::cos},   {"tan", std::tan},   {"exp", std::exp},
                                  {"sqrt", std::sqrt}, {"sinh", std::sinh}, {"cosh", std::cosh}, {"tanh", std::tanh}};

template <typename F>
Numbers each(F f) {
  Numbers out;
  for (std::size_t k = 0; k < kTrialPoints; ++k) out[k] = f(k);
  return out;
}

Numbers operator+(const Numbers& a, const Numbers& b) {
  return each([&](std::size_t k) { return a[k] + b[k]; });
}
Numbers operator-(const Numbers& a, const Numbers& b) {
  return each([&](std::size_t k) { return a[k] - b[k]; });
}
Numbers operator*(const Numbers& a, const Numbers& b) {
  return each([&](std::size_t k) { return a[k] * b[k]; });
}

// True if the value of s is linear in the argument i, with the others held.
bool linear_in(const Syntax& s, std::size_t i) {
  switch (s.op) {
  case Syntax::Op::add:
  case Syntax::Op::negate:
  case Syntax::Op::array:
  case Syntax::Op::member:
  case Syntax::Op::prime:
    return true;
  case Syntax::Op::multiply:
    return i == 0 || s.operators[i - 1].op != Syntax::Op::divide;
  case Syntax::Op::call: {
    static const char* const linear[] = {"D", "Dt", "frozen", "reduced", "star", "partial"};
    if (s.text == "dot" || s.text == "cross") return true;
    return i == 0 && std::any_of(std::begin(linear), std::end(linear), [&](const char* f) { return s.text == f; });
  }
  case Syntax::Op::number:
  case Syntax::Op::quantity:
  case Syntax::Op::name:
  case Syntax::Op::power:
  case Syntax::Op::index:
  case Syntax::Op::apply:
  case Syntax::Op::subtract:
  case Syntax::Op::divide:
  case Syntax::Op::compare:
  case Syntax::Op::dot:
  case Syntax::Op::cross:
    return false;
  }
  return false;
}

}  // namespace

Trial::Trial(const Syntax& difference, Vocabulary& words, std::vector<PointValues>& points)
    : words_(words), points_(points), syntax_(difference), formulas_left_(kMostFormulas) {
  root_ = read(syntax_);
}

std::optional<Trial::Amount> Trial::evaluated(const Syntax& s) {
  const auto [place, is_new] = known_.try_emplace(print(s));
  if (!is_new) return place->second;
  try {
    const Value v = words_.value(s);
    Amount out;
    const Vector* vector = std::get_if<Vector>(&v);
    out.vector = vector != nullptr;
    for (int i = 0; i < (vector ? 3 : 1); ++i) {
      const Expr e = vector ? (*vector)[i] : std::get<Expr>(v);
      out.c[static_cast<std::size_t>(i)] =
          each([&](std::size_t k) { return points_[std::min(k, points_.size() - 1)](e); });
    }
    place->second = out;
  } catch (const Failure&) {  // neither a number nor a vector
  }
  return place->second;
}

// ---- the equation as it stands -----------------------------------------------------------------

// Reads how the node is computed from its arguments; returns false if it is not one of these operations.
bool Trial::read_parts(Node& n) {
  const Syntax& s = *n.syntax;
  using Way = Node::Way;
  bool vectors = false;  // vectors are expected as arguments
  switch (s.op) {
  case Syntax::Op::add:
    n.way = Way::sum;
    break;
  case Syntax::Op::negate:
    n.way = Way::negative;
    break;
  case Syntax::Op::multiply:
    for (const Syntax::Operator& o : s.operators)
      if (o.op != Syntax::Op::multiply && o.op != Syntax::Op::divide) return false;
    n.way = Way::product;
    break;
  case Syntax::Op::power:
    n.way = Way::power;
    break;
  case Syntax::Op::array:
    n.way = Way::entries;
    break;
  case Syntax::Op::member:
    n.way = Way::component;
    vectors = true;
    break;
  case Syntax::Op::call:
    if (s.text == "dot" || s.text == "cross") {
      n.way = s.text == "dot" ? Way::dot : Way::cross;
      vectors = true;
      break;
    }
    for (const Elementary& e : kElementary)
      if (s.text == e.name) n.function = e.f;
    if (!n.function) return false;
    n.way = Way::function;
    break;
  case Syntax::Op::number:
  case Syntax::Op::quantity:
  case Syntax::Op::name:
  case Syntax::Op::prime:
  case Syntax::Op::index:
  case Syntax::Op::apply:
  case Syntax::Op::subtract:
  case Syntax::Op::divide:
  case Syntax::Op::compare:
  case Syntax::Op::dot:
  case Syntax::Op::cross:
    return false;
  }
  std::size_t of_vectors = 0;
  for (const Syntax& a : s.args) {
    n.args.push_back(read(a));
    if (!n.args.back().known) return false;
    of_vectors += n.args.back().value.vector;
  }
  switch (n.way) {
  case Way::sum:
    return of_vectors == 0 || of_vectors == s.args.size();
  case Way::negative:
    return true;
  case Way::product:
    for (std::size_t i = 1; i < s.args.size(); ++i)
      if (n.args[i].value.vector && s.operators[i - 1].op == Syntax::Op::divide) return false;
    return of_vectors <= 1;
  case Way::component:
    return of_vectors == 1 && s.text.size() == 1 && s.text[0] >= 'x' && s.text[0] <= 'z';
  case Way::dot:
  case Way::cross:
    return vectors && of_vectors == 2 && s.args.size() == 2;
  case Way::entries:
    return of_vectors == 0 && s.args.size() == 3;
  case Way::function:
    return of_vectors == 0 && s.args.size() == 1;
  case Way::power:
    return of_vectors == 0;
  case Way::whole:
    return false;
  }
  return false;
}

Trial::Node Trial::read(const Syntax& s) {
  Node n;
  n.syntax = &s;
  if (read_parts(n)) {
    std::vector<const Amount*> args;
    for (const Node& a : n.args) args.push_back(&a.value);
    n.value = combined(n, args);
    n.known = true;
  } else {
    n.way = Node::Way::whole;
    n.args.clear();
    const std::optional<Amount> amount = evaluated(s);
    n.known = amount.has_value();
    if (amount) n.value = *amount;
  }
  n.extent = extent_of(n);
  return n;
}

Numbers Trial::extent_of(const Node& n) const {
  const Numbers own =
      each([&](std::size_t k) { return std::hypot(n.value.c[0][k], n.value.c[1][k], n.value.c[2][k]); });
  if (n.way == Node::Way::sum) {
    Numbers total{};
    for (const Node& a : n.args) total = total + a.extent;
    return total;
  }
  if (n.way == Node::Way::negative) return n.args[0].extent;
  if (n.way != Node::Way::product) return own;
  Numbers total = each([](std::size_t) { return 1.0; });
  for (std::size_t i = 0; i < n.args.size(); ++i) {
    const bool divides = i > 0 && n.syntax->operators[i - 1].op == Syntax::Op::divide;
    total = divides ? each([&](std::size_t k) { return total[k] / std::abs(n.args[i].value.c[0][k]); })
                    : total * n.args[i].extent;
  }
  return total;
}

Trial::Amount Trial::combined(const Node& n, const std::vector<const Amount*>& args) const {
  Amount out;
  const auto components = [&](auto f) {
    for (std::size_t i = 0; i < (out.vector ? 3U : 1U); ++i) out.c[i] = f(i);
  };
  switch (n.way) {
  case Node::Way::sum:
    out.vector = args[0]->vector;
    components([&](std::size_t i) {
      Numbers total = args[0]->c[i];
      for (std::size_t a = 1; a < args.size(); ++a)
        total = n.syntax->operators[a - 1].op == Syntax::Op::subtract ? total - args[a]->c[i] : total + args[a]->c[i];
      return total;
    });
    return out;
  case Node::Way::negative:
    out.vector = args[0]->vector;
    components([&](std::size_t i) { return each([&](std::size_t k) { return -args[0]->c[i][k]; }); });
    return out;
  case Node::Way::product: {
    Numbers factor = each([](std::size_t) { return 1.0; });
    const Amount* vector = nullptr;
    for (std::size_t a = 0; a < args.size(); ++a) {
      if (args[a]->vector)
        vector = args[a];
      else if (a > 0 && n.syntax->operators[a - 1].op == Syntax::Op::divide)
        factor = each([&](std::size_t k) { return factor[k] / args[a]->c[0][k]; });
      else
        factor = factor * args[a]->c[0];
    }
    out.vector = vector != nullptr;
    components([&](std::size_t i) { return vector ? factor * vector->c[i] : factor; });
    return out;
  }
  case Node::Way::power:
    out.c[0] = each([&](std::size_t k) { return std::pow(args[0]->c[0][k], args[1]->c[0][k]); });
    return out;
  case Node::Way::function:
    out.c[0] = each([&](std::size_t k) { return n.function(args[0]->c[0][k]); });
    return out;
  case Node::Way::component:
    out.c[0] = args[0]->c[static_cast<std::size_t>(n.syntax->text[0] - 'x')];
    return out;
  case Node::Way::entries:
    out.vector = true;
    components([&](std::size_t i) { return args[i]->c[0]; });
    return out;
  case Node::Way::dot:
    for (std::size_t i = 0; i < 3; ++i) out.c[0] = out.c[0] + args[0]->c[i] * args[1]->c[i];
    return out;
  case Node::Way::cross:
    out.vector = true;
    components([&](std::size_t i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      return args[0]->c[j] * args[1]->c[k] - args[0]->c[k] * args[1]->c[j];
    });
    return out;
  case Node::Way::whole:
    return n.value;
  }
  return out;
}

// ---- changes -----------------------------------------------------------------------------------

void Trial::add(Edit edit) {
  Tried t{std::move(edit), {}, 0, {}};
  const Node* node = &root_;
  const Syntax* s = &syntax_;
  bool inside = false;  // inside a node that is evaluated as a whole
  bool linear = true;
  for (std::size_t d = 0; d < t.edit.path.size(); ++d) {
    const std::uint32_t i = t.edit.path[d];
    inside = inside || node->way == Node::Way::whole;
    linear = linear && linear_in(*s, i);
    if (linear) t.linear = d + 1;
    if (!inside) node = &node->args[i];
    s = &s->args[i];
  }
  if (!inside && t.edit.effect != Edit::Effect::squares) {
    t.amount = evaluated(t.edit.with);
    const bool wants_vector = t.edit.effect == Edit::Effect::replaces && node->value.vector;
    if (!t.amount || t.amount->vector != wants_vector) return;
  }
  if (!inside && t.edit.effect == Edit::Effect::squares && node->value.vector) return;
  edits_.push_back(std::move(t));
  Tried& now = edits_.back();
  now.change = change({static_cast<std::uint32_t>(edits_.size() - 1)});
  bool changes = false, finite = true;
  for (std::size_t k = 0; k < kTrialPoints; ++k) {
    changes = changes || std::abs(now.change[k]) > kChanges * root_.extent[k];
    finite = finite && std::isfinite(now.change[k]);
  }
  if (changes && finite) return;
  edits_.pop_back();
  formulas_.erase({static_cast<std::uint32_t>(edits_.size())});  // the number is reused for the next edit
}

Numbers Trial::change(std::vector<std::uint32_t> edits) {
  std::sort(edits.begin(), edits.end(), [&](std::uint32_t a, std::uint32_t b) {
    return edits_[a].edit.path != edits_[b].edit.path ? edits_[a].edit.path < edits_[b].edit.path : a < b;
  });
  return with(root_, 0, edits).c[0] - root_.value.c[0];
}

// Returns the value of a node after edits. `edits` are in the order of their paths: those of the node itself first,
// then those of each argument together.
Trial::Amount Trial::with(const Node& n, std::size_t depth, std::span<const std::uint32_t> edits) {
  std::size_t own = 0;
  while (own < edits.size() && edits_[edits[own]].edit.path.size() == depth) ++own;
  Amount out = n.value;
  if (const auto below = edits.subspan(own); !below.empty()) {
    if (n.way == Node::Way::whole) {
      out = as_formula(n, depth, below);
    } else {
      const bool sum = n.way == Node::Way::sum;
      std::vector<const Amount*> args;
      std::vector<Amount> changed;
      if (!sum) {
        for (const Node& a : n.args) args.push_back(&a.value);
        changed.reserve(below.size());
      }
      for (std::size_t from = 0; from < below.size();) {
        const std::uint32_t i = edits_[below[from]].edit.path[depth];
        std::size_t to = from + 1;
        while (to < below.size() && edits_[below[to]].edit.path[depth] == i) ++to;
        const Amount now = with(n.args[i], depth + 1, below.subspan(from, to - from));
        from = to;
        if (sum) {
          const bool minus = i > 0 && n.syntax->operators[i - 1].op == Syntax::Op::subtract;
          for (std::size_t c = 0; c < (out.vector ? 3U : 1U); ++c)
            out.c[c] =
                minus ? out.c[c] - (now.c[c] - n.args[i].value.c[c]) : out.c[c] + (now.c[c] - n.args[i].value.c[c]);
        } else {
          changed.push_back(now);
          args[i] = &changed.back();
        }
      }
      if (!sum) out = combined(n, args);
    }
  }
  for (std::size_t k = 0; k < own; ++k) {
    const Tried& t = edits_[edits[k]];
    switch (t.edit.effect) {
    case Edit::Effect::replaces:
      out = *t.amount;
      break;
    case Edit::Effect::multiplies:
      for (Numbers& c : out.c) c = c * t.amount->c[0];
      break;
    case Edit::Effect::squares:
      out.c[0] = out.c[0] * out.c[0];
      break;
    }
  }
  return out;
}

Trial::Amount Trial::as_formula(const Node& n, std::size_t depth, std::span<const std::uint32_t> edits) {
  Amount unknown;
  unknown.vector = n.value.vector;
  for (Numbers& c : unknown.c) c.fill(std::nan(""));
  const auto found = formulas_.find(std::vector<std::uint32_t>(edits.begin(), edits.end()));
  std::optional<Amount> amount;
  if (found != formulas_.end()) {
    amount = found->second;
  } else {
    if (formulas_left_ == 0) return unknown;
    --formulas_left_;
    std::vector<const Edit*> list;
    for (std::uint32_t i : edits) list.push_back(&edits_[i].edit);
    amount = evaluated(edited(*n.syntax, depth, list));
    formulas_.emplace(std::vector<std::uint32_t>(edits.begin(), edits.end()), amount);
  }
  return amount && amount->vector == n.value.vector ? *amount : unknown;
}

double Trial::tolerance(std::size_t k, double extent) const { return kVanishes * (root_.extent[k] + extent); }

bool Trial::vanishes(const Numbers& change, const Numbers& extent) const {
  for (std::size_t k = 0; k < kTrialPoints; ++k)
    if (!(std::abs(root_.value.c[0][k] + change[k]) <= tolerance(k, std::abs(extent[k])))) return false;
  return true;
}

bool Trial::possible(std::size_t a, std::size_t b) const {
  const Edit &x = edits_[a].edit, &y = edits_[b].edit;
  if (a == b || (x.path == y.path &&
                 (x.effect != Edit::Effect::multiplies || y.effect != Edit::Effect::multiplies || x.kind == y.kind)))
    return false;
  const Edit& outer = x.path.size() <= y.path.size() ? x : y;
  const Edit& inner = x.path.size() <= y.path.size() ? y : x;
  return outer.effect != Edit::Effect::replaces ||
         !std::equal(outer.path.begin(), outer.path.end(), inner.path.begin());
}

bool Trial::independent(std::size_t a, std::size_t b) const {
  if (!possible(a, b)) return false;
  const Path &x = edits_[a].edit.path, &y = edits_[b].edit.path;
  const std::size_t shorter = std::min(x.size(), y.size());
  std::size_t common = 0;
  while (common < shorter && x[common] == y[common]) ++common;
  if (common == shorter) return false;  // one of the places contains the other
  const Syntax& meets = node_at(syntax_, x, common);
  return (meets.op == Syntax::Op::add || meets.op == Syntax::Op::array) && edits_[a].linear >= common &&
         edits_[b].linear >= common;
}

}  // namespace anholon
