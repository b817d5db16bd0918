// Expressions as text (which the formula parser reads back), as LaTeX and as presentation MathML.
//
// The order of terms is fixed: in a sum, terms with the highest derivatives first; in a product,
// parameters, then symbols, then functions, then sums. A sum in brackets that would start with a minus
// gives it to its product. Printing sweeps the graph upwards, so depth
// does not matter; a result beyond kLongestPrint characters is cut to "…".
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "expr/expr.h"

namespace anholon {

enum class Format : std::uint8_t { text, latex, mathml };

inline constexpr std::size_t kLongestPrint = 1 << 18;

// The names of symbols; each returns the base name, derivative marks are added by the printer.
struct SymbolNames {
  std::vector<std::string> coordinates, parameters, masses, multipliers, given;
  // Names given to subexpressions ([define]): node -> name.
  std::unordered_map<NodeId, std::string> defined;
  std::vector<std::string> quasi, states, controls;
  bool short_sums = false;  // long sums by the short way (expr.h), which may stand under names of its own
  // [notation]: how a name is written instead of as latex_name and mathml_name would.
  struct Written {
    std::string latex, mathml;
  };
  std::map<std::string, Written> notation = {};
};

std::string print(Expr e, const SymbolNames& names, Format format);
std::vector<std::string> print(std::span<const Expr> es, const SymbolNames& names, Format format);
// What stands behind names: expressions that have one in `names.defined` are written out, their operands stand under
// theirs.
std::vector<std::string> print_contents(std::span<const Expr> es, const SymbolNames& names, Format format);
// Gives names to all sums and products that occur more than once in `es`: with them, everything is as long as the graph
// is large. In the order in which they can be read.
std::vector<Expr> name_parts(std::span<const Expr> es, SymbolNames& names);

// "theta" -> "\theta", "x1" -> "x_{1}", "front_wheel" -> "\mathrm{front\_wheel}".
std::string latex_name(const std::string& name);
// "theta" -> <mi>θ</mi>, "x1" -> <msub><mi>x</mi><mn>1</mn></msub>.
std::string mathml_name(const std::string& name);
// The name of the k-th derivative: "x''", "D(x,4)"; "\ddot{x}", "x^{(4)}".
std::string derivative_name(const std::string& name, unsigned order, Format format);

}  // namespace anholon
