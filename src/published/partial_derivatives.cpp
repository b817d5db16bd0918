// partial(e, v) in published equations: by symbols, and along the manifold of the constraints.
#include <algorithm>

#include "mechanics/mechanics.h"
#include "published/vocabulary.h"

namespace anholon {

// Returns the argument of reduced(…) or star(…) if s is such a call, or a definition that is one; else nullptr.
const Syntax* Vocabulary::reduced_argument(const Syntax& s, bool& quasi) const {
  if (s.op == Syntax::Op::name) {
    const auto it = lets_.find(s.text);
    return it == lets_.end() ? nullptr : reduced_argument(it->second.syntax, quasi);
  }
  if (s.op != Syntax::Op::call || (s.text != "reduced" && s.text != "star") || s.args.size() != 1) return nullptr;
  quasi = s.text == "star";
  return &s.args[0];
}

// True if a part of s is taken on the manifold of the constraints: reduced(…), f.y, C.y.x, or star(…), g.x, B.x.u.
bool Vocabulary::holds_reduced(const Syntax& s, bool quasi) const {
  if (s.op == Syntax::Op::name) {
    if (const auto it = lets_.find(s.text); it != lets_.end()) return holds_reduced(it->second.syntax, quasi);
    const std::vector<std::string> path = split(s.text);
    if (path.size() < 2) return false;
    const std::string& first = path[path[0] == "derived"];
    return quasi ? first == "g" || first == "B" : first == "f" || first == "C";
  }
  if (s.op == Syntax::Op::call && s.text == (quasi ? "star" : "reduced")) return true;
  return std::any_of(s.args.begin(), s.args.end(), [&](const Syntax& a) { return holds_reduced(a, quasi); });
}

// Evaluates partial(e, v). In the second argument quasi-velocities are symbols if the constraints are solved.
Value Vocabulary::partial_of(const Syntax& s, const Value& what) {
  by_symbols_ = true;
  Value by;
  try {
    by = evaluate(s.args[1], *this);
  } catch (const Failure&) {
    by_symbols_ = false;
    throw;
  }
  by_symbols_ = false;
  const Expr* v = std::get_if<Expr>(&by);
  const Span at = s.args[1].span;
  if (!v) throw Failure(at, std::string("the derivative is taken by a number, this is ") + type_name(by));
  const Value of = as_point(what, *this, s.args[0].span);
  bool quasi = false;
  if (const Syntax* inner = reduced_argument(s.args[0], quasi); inner && !elimination_(quasi).solved) {
    const Value x = as_point(evaluate(*inner, *this), *this, inner->span);
    return each(x, s.args[0].span, [&](Expr e) { return partial_along(e, *v, quasi, at); });
  }
  for (const bool in_quasi : {false, true}) {
    if (!holds_reduced(s.args[0], in_quasi) || elimination_(in_quasi).solved) continue;
    const std::vector<std::string> path = split(s.args[0].op == Syntax::Op::name ? s.args[0].text : "");
    const bool one_word = path.size() > 1 && path[path[0] == "derived"] == (in_quasi ? "g" : "f");
    if (!one_word)
      throw Failure(s.args[0].span,
                    "the constraints are not solved as formulas here: a partial derivative is taken of what is reduced "
                    "as a whole",
                    in_quasi ? "partial(star(…), u)" : "partial(reduced(…), x'), partial(f.y, x')");
    return each(of, s.args[0].span, [&](Expr e) { return partial_along(e, *v, in_quasi, at); });
  }
  return each(of, s.args[0].span, [&](Expr e) { return partial_by(e, *v, at); });
}

Expr Vocabulary::partial_by(Expr e, Expr by, Span span) {
  const Graph& g = graph();
  switch (g.node(by.id).kind) {
  case Kind::quasi:
    // A formula that is not written in quasi-velocities still depends on them.
    if (jet_order(e) >= static_cast<int>(elimination_(true).m))
      throw Failure(span, "what is differentiated by a quasi-velocity is not expressed in quasi-velocities",
                    "partial(star(T_r), u), partial(g.x, u)");
    return partial(e, by);
  case Kind::jet:
  case Kind::parameter:
  case Kind::mass:
  case Kind::multiplier:
  case Kind::given:
  case Kind::state:
  case Kind::control:
    return partial(e, by);
  case Kind::time: {
    // Functions of time alone vary with t.
    Expr rate = partial(e, by);
    for (NodeId id : symbols({&e, 1}))
      if (g.node(id).kind == Kind::given) rate = rate + partial(e, {e.graph, id}) * total_derivative(Expr{e.graph, id});
    return rate;
  }
  default:
    throw Failure(span, "a partial derivative is taken by a derivative of a coordinate, by t, or by another symbol",
                  "partial(T_r, x'), partial(f.y, D(x, 2))");
  }
}

// Returns the partial derivative along the manifold; if the constraints are not solved, by the implicit function
// theorem.
Expr Vocabulary::partial_along(Expr e, Expr by, bool quasi, Span span) {
  const Elimination& E = elimination_(quasi);
  if (quasi) used_quasi_ = true;
  const Node& n = graph().node(by.id);
  const auto position = [](const auto& list, std::size_t a) {
    return static_cast<std::size_t>(std::find(list.begin(), list.end(), a) - list.begin());
  };
  if (quasi)
    for (std::size_t k = 0; k < E.free.u.size(); ++k) {
      if (E.free.u[k] == by) return E.by_u(e)[k];
      if (total_derivative(E.free.u[k]) == by) return E.by_u_rate(e)[k];
    }
  if (n.kind == Kind::jet) {
    if (n.order < E.m) return E.by(n.order, e)[n.index];
    const std::size_t k = position(E.independent, n.index);
    if (!quasi && k == E.independent.size() && n.order <= E.m + 1) return graph().zero();
    if (!quasi && n.order == E.m) return E.by_u(e)[k];
    if (!quasi && n.order == E.m + 1) return E.by_u_rate(e)[k];
  }
  throw Failure(span,
                "this derivative of what is reduced is not known where the constraints are not solved as formulas");
}

}  // namespace anholon
