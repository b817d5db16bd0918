// A certificate: the record of a proof that forms of the equations agree, for an independent checker.
//
// A certificate is a straight-line program (each node uses earlier ones only) and claims about its nodes. Every claim
// is about one expression, the difference
//
//     left − Σ coefficient · node                 (the pairs of `right`)
//
// and states either that it is zero, identically in all symbols and wherever it is defined, or that it is not zero at a
// point, the witness. The text is JSON; numbers are exact rationals as text.
//
//   { "format": "anholon-certificate", "version": 1,
//     "program": "anholon 0.2.0", "model": "disc", "source_hash": "…",
//     "hypotheses": ["…"], "meaning": "…",
//     "symbols": ["x", "x'"],
//     "nodes": [[0, "number", "1/2"], [1, "pi"], [2, "symbol", 0],
//               [3, "sum", ["1/2", 2], ["-1", 0]],     coefficient, node
//               [4, "product", [2, "2"], [3, "-1/2"]], node, exponent
//               [5, "sin", 4],                         any function of Certificate::functions()
//               [6, "atan2", 4, 5]],                   y, x
//     "claims": [{"kind": "differ", "a": "routh", "b": "nielsen", "component": "x",
//                 "left": 5, "right": [[3, 4]],
//                 "witness": {"values": [[0, "1/3"]], "enclosed": [[1, "1/2", "1/1000"]], "equations": [6]}}] }
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numeric/rational.h"

namespace anholon {

struct Certificate {
  using Index = std::uint32_t;

  enum class Operation : std::uint8_t { number, pi, symbol, sum, product, function, atan2 };

  struct Term {
    Rational weight;  // a sum's coefficient, a product's exponent; 1 for operands of functions
    Index node = 0;
  };

  struct Node {
    Operation operation = Operation::number;
    Rational value;           // number
    Index symbol = 0;         // symbol: index into `symbols`
    std::string function;     // function: one of functions()
    std::vector<Term> terms;  // sum, product: any number; function: 1; atan2: 2 (y, x)
  };

  enum class ClaimKind : std::uint8_t {
    agree,   // zero: the equation `left` of form a is the combination `right` of those of form b
    differ,  // not zero at the witness: form b lacks the component of form a
    kernel,  // zero: Σ_s Φ[r][s] B[s][a], on which the combinations are based
    pivot,   // not zero at the witness: a minor that was used as a divisor
  };

  struct Pair {
    Index coefficient = 0, node = 0;
  };

  struct Value {
    Index symbol = 0;
    Rational value;
  };
  struct Enclosed {
    Index symbol = 0;
    Rational midpoint, radius;  // radius > 0
  };
  // A point: some symbols have exact values; the values of the others are the only root of the equations in the box.
  struct Witness {
    std::vector<Value> values;
    std::vector<Enclosed> enclosed;
    std::vector<Index> equations;  // nodes that vanish, as many as enclosed symbols
  };

  struct Claim {
    ClaimKind kind = ClaimKind::agree;
    std::string a, b;       // names of the two forms; b may be empty for kernel and pivot
    std::string component;  // "x", "u1"
    Index left = 0;
    std::vector<Pair> right;
    std::optional<Witness> witness;  // for differ and pivot

    bool says_zero() const { return kind == ClaimKind::agree || kind == ClaimKind::kernel; }
  };

  std::string program, model, source_hash;
  std::vector<std::string> hypotheses;
  std::string meaning;
  std::vector<std::string> symbols;
  std::vector<Node> nodes;
  std::vector<Claim> claims;

  // Returns the permitted names of a function node.
  static const std::vector<std::string>& functions();
  static bool has_function(std::string_view name);
};

const char* name(Certificate::ClaimKind kind);

std::string to_json(const Certificate& c);

// Reads a certificate. The function is safe for any bytes: it throws Failure with the place inside the JSON ("nodes[3]:
// …"), and accepts only certificates that satisfy all conditions above.
Certificate read_certificate(std::string_view text);

}  // namespace anholon
