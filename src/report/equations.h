// The equations of a form in printed form: arranged, named, with the steps of their derivation and the reactions.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "formulation/formulation.h"

namespace anholon {

struct Line {
  std::string name;          // "x", "blade_edge", "d T/d x'"
  std::optional<Expr> left;  // nullopt: the name itself is the left side
  Expr right;
  std::string latex = {}, mathml = {};  // the name in these formats; empty: as text
};
using Section = std::pair<std::string, std::vector<Line>>;  // heading, lines

struct Derivation {
  const Formulation* form = nullptr;
  const Model* model = nullptr;
  unsigned m = 0;     // the order asked for; 0: none
  SymbolNames names;  // masses and quasi-velocities under their own names
  std::vector<Section> steps, reactions;
  std::vector<Line> equations, constraints, rates;  // rates: of the states
  std::vector<Expr> parts;                          // named in `names`, if the equations are printed in parts
  std::vector<std::string> left_out;                // names of constraints that the elimination leaves out
  std::vector<std::string> notes;                   // on the rank of the constraints
};

// Arranges expressions, each only once: many forms share equations, or have equations that are equal when they are
// expanded.
class Arranger {
 public:
  // auto or paper (grouped), none, full (expanded), parts (unchanged, with names for repeated subexpressions); auto
  // means parts if there are many coordinates.
  explicit Arranger(std::string expand) : expand_(std::move(expand)) {}
  Expr operator()(Expr e, const SymbolNames& names);
  bool in_parts(std::size_t coordinates) const;

 private:
  std::string expand_;
  std::unordered_map<NodeId, Expr> known_, of_written_out_;
};

// `of_reactions`: an elimination of the ideal constraints by coordinates, if the reactions are needed; a form without
// multipliers uses its own elimination.
Derivation derivation(const Mechanics& m, const Formulation& form, const Elimination& e, Arranger& arranger, bool steps,
                      const Elimination* of_reactions = nullptr);

// Joins lines of steps for a reader: the vanishing lines of one family become "Q.x = Q.y" = 0.
std::vector<Line> joined(const std::vector<Line>& lines);

// Prints one derivation after the other. JSON: an object, or with `list` {"forms": [objects]}.
std::string as_text(const std::vector<Derivation>& list);
std::string as_latex(const std::vector<Derivation>& list);
std::string as_mathml(const std::vector<Derivation>& list);
// Prints the formulas as lines that wrap, for a notebook.
std::string as_html(const std::vector<Derivation>& list);
std::string as_json(const std::vector<Derivation>& list, bool as_list);

}  // namespace anholon
