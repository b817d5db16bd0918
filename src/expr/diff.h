// Differentiation and substitution on the expression graph. Each call is one sweep, O(nodes).
//
// Partial derivatives treat every symbol (t, each q_a^(k), lambda, mu) as independent. The total derivative is
//   D f = f_,t + sum_{a,k} f_,q_a^(k) q_a^(k+1) + (the same for lambda and given functions),
// with frozen masses mu constant: before masses are substituted for their symbols it is the frozen derivative D/Dt of
// the papers, afterwards the ordinary d/dt  (theory: derivatives).
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "expr/expr.h"

namespace anholon {

using Column = std::vector<Expr>;

Expr derivative(Function f, Expr argument, Expr value);  // f'(argument); value = f(argument)

Column total_derivative(std::span<const Expr> es);
Expr total_derivative(Expr e);
Expr total_derivative(Expr e, unsigned times);

// Returns all partial derivatives of e with respect to `symbols` by one reverse sweep.
Column gradient(Expr e, std::span<const Expr> symbols);
Expr partial(Expr e, Expr symbol);

// Returns sum_c seeds[c] * d outputs[c] / d symbols[a] for every a, by one reverse sweep: the gradient of sum_c
// seeds[c] * outputs[c] with the seeds held.
Column pullback(std::span<const Expr> outputs, std::span<const Expr> seeds, std::span<const Expr> symbols);

// Replaces symbols: `replacement(symbol id)` gives the new expression, or a handle with graph ==
// nullptr to keep the symbol.
Column substitute(std::span<const Expr> es, const std::function<Expr(NodeId)>& replacement);

// Replaces the symbol from[k] by to[k].
Column put(std::span<const Expr> es, const Column& from, const Column& to);
Expr put(Expr e, const Column& from, const Column& to);

// Replaces the nodes in the table, whatever their operands.
Column replace_nodes(std::span<const Expr> es, const std::unordered_map<NodeId, Expr>& replacement);

// Returns the symbols (leaves that are not numbers) on which the expressions depend, ascending.
std::vector<NodeId> symbols(std::span<const Expr> es);

// Returns the highest order k of a jet q_a^(k) that occurs; -1 if none does.
int jet_order(Expr e);

// Operators on columns, so that a formulation reads like the paper's equation. An empty column is an
// empty sum and counts as zero.
Column operator+(const Column& a, const Column& b);
Column operator-(const Column& a, const Column& b);
Column operator-(const Column& a);
Column operator*(const Rational& c, const Column& a);

}  // namespace anholon
