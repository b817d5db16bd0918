// Expressions as text (which the formula parser reads back), as LaTeX and as presentation MathML.
//
// The order of terms is fixed: in a sum, terms with the highest derivatives first; in a product, parameters, then
// symbols, then functions, then sums. If a sum in brackets would start with a minus sign, the sign moves to its
// product. Printing sweeps the graph from the leaves up, so the depth is not limited; a result beyond kLongestPrint
// characters is cut to "…".
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "expr/expr.h"
#include "print/format.h"
#include "print/print_names.h"

namespace anholon {

inline constexpr std::size_t kLongestPrint = 1 << 18;

// The names of symbols. Each is the base name; the printer adds marks of derivatives.
struct SymbolNames {
  std::vector<std::string> coordinates, parameters, masses, multipliers, given;
  // Names given to subexpressions ([define]): node -> name.
  std::unordered_map<NodeId, std::string> defined;
  std::vector<std::string> quasi, states, controls;
  bool short_sums = false;  // long sums are printed by their chains (expr.h), which may have names of their own
  // [notation]: the spelling of a name, instead of latex_name and mathml_name.
  struct Written {
    std::string latex, mathml;
  };
  std::map<std::string, Written> notation = {};
};

std::string print(Expr e, const SymbolNames& names, Format format);
std::vector<std::string> print(std::span<const Expr> es, const SymbolNames& names, Format format);
// Prints the expressions behind names: each named expression is printed in full, with its operands under their names.
std::vector<std::string> print_contents(std::span<const Expr> es, const SymbolNames& names, Format format);
// Gives names to all sums and products that occur more than once in `es`; the printed length is then proportional to
// the size of the graph. The result is in the order of definition.
std::vector<Expr> name_parts(std::span<const Expr> es, SymbolNames& names);

}  // namespace anholon
