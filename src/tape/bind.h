// Sets the inputs of a tape's machine. The caller's rule returns the value of a symbol.
#pragma once
#include "tape/tape.h"

namespace anholon {

// Sets every input to its value at a point: rule(node, symbol) for the node of a symbol. The graph is that of the tape.
template <Scalar N, class Rule>
void bind(Machine<N>& machine, const Graph& graph, const Rule& rule) {
  for (const Input& in : machine.tape().inputs) machine.series(in.slot)[0] = rule(graph.node(in.symbol), in.symbol);
}

// Sets the series of every input: rule(node, symbol, series, lead) fills the coefficients, of which the input has `lead`
// beyond those of the stages.
template <Scalar N, class Rule>
void bind_series(Machine<N>& machine, const Graph& graph, const Rule& rule) {
  for (const Input& in : machine.tape().inputs)
    rule(graph.node(in.symbol), in.symbol, machine.series(in.slot), int{machine.tape().code[in.slot].lead});
}

}  // namespace anholon
