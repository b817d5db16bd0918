#include "published/identity.h"

#include <algorithm>

#include "expr/normal.h"
#include "published/at_points.h"

namespace anholon {

namespace {

// True for functions of numbers, which denote no quantity of mechanics.
bool is_arithmetic(const std::string& f) { return find_function(f) >= 0 || f == "sqrt" || f == "atan2" || f == "D"; }

bool holds(Expr e, bool (*which)(const Node&)) {
  const std::vector<NodeId> ids = symbols({&e, 1});
  return std::any_of(ids.begin(), ids.end(), [&](NodeId id) { return which(e.graph->node(id)); });
}

bool is_multiplier(const Node& n) { return n.kind == Kind::multiplier; }
bool is_of_motion(const Node& n) { return is_multiplier(n) || (n.kind == Kind::jet && n.order >= 2); }
bool is_jet(const Node& n) { return n.kind == Kind::jet; }

bool plain_name(const Syntax& s, Vocabulary& words) {
  const Value v = words.name(s.text, s.span);
  const Expr* e = std::get_if<Expr>(&v);
  if (!e) return false;
  const Kind kind = e->graph->node(e->id).kind;
  if (s.text.find('.') != std::string::npos) return kind == Kind::multiplier || words.declares(s.text);
  if (is_number(*e)) return words.declares(s.text) || s.text == "pi";
  return kind == Kind::jet || !holds(*e, is_jet);
}

}  // namespace

std::string vanishing_divisor(const Syntax& s, Vocabulary& words, std::vector<PointValues>& points) {
  const auto is_divisor = [&](std::size_t i) {
    if (s.op == Syntax::Op::multiply) return i > 0 && s.operators[i - 1].op == Syntax::Op::divide;
    return s.op == Syntax::Op::power && i == 0 && s.args[1].op == Syntax::Op::negate;
  };
  for (std::size_t i = 0; i < s.args.size(); ++i) {
    if (std::string below = vanishing_divisor(s.args[i], words, points); !below.empty()) return below;
    if (!is_divisor(i)) continue;
    try {
      if (vanishes(words.number(s.args[i]), points)) return print(s.args[i]);
    } catch (const Failure&) {  // the part has no value of its own
    }
  }
  return {};
}

bool speaks_of_quantities(const Syntax& s, Vocabulary& words) {
  switch (s.op) {
  case Syntax::Op::name:
    return !plain_name(s, words);
  case Syntax::Op::member:
  case Syntax::Op::array:
  case Syntax::Op::apply:
    return true;
  case Syntax::Op::call:
    if (!is_arithmetic(s.text)) return true;
    break;
  case Syntax::Op::number:
  case Syntax::Op::quantity:
  case Syntax::Op::negate:
  case Syntax::Op::power:
  case Syntax::Op::prime:
  case Syntax::Op::index:
  case Syntax::Op::add:
  case Syntax::Op::subtract:
  case Syntax::Op::multiply:
  case Syntax::Op::divide:
  case Syntax::Op::compare:
  case Syntax::Op::dot:
  case Syntax::Op::cross:
    break;
  }
  return std::any_of(s.args.begin(), s.args.end(), [&](const Syntax& a) { return speaks_of_quantities(a, words); });
}

bool holds_by_rates(const Syntax& left, const Syntax& right, Vocabulary& words) {
  return proved_zero(words.number(left) - words.number(right)) &&
         !proved_zero(words.number_before_rates(left) - words.number_before_rates(right));
}

bool meant_as_identity(const Syntax& left, const Syntax& right, Vocabulary& words) {
  const Expr a = words.number(left), b = words.number(right);
  const auto is_0 = [](const Syntax& s) { return s.op == Syntax::Op::number && s.text == "0"; };
  if (print(left) == print(right) || (!is_0(left) && !is_0(right) && proved_zero(a) && proved_zero(b))) return false;
  if (speaks_of_quantities(left, words) || speaks_of_quantities(right, words)) return true;
  return !holds(a, is_of_motion) && !holds(b, is_of_motion);
}

}  // namespace anholon
