// The equations of a form as they are printed: arranged, named, with the steps that lead to them.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "formulation/formulation.h"

namespace anholon {

struct Line {
  std::string name;             // "x", "blade_edge", "T"
  std::optional<Expr> left;     // none: the name itself is the left side
  Expr right;
};

struct Derivation {
  const Formulation* form = nullptr;
  const Model* model = nullptr;
  SymbolNames names;            // masses, quasi-velocities under their own names
  std::vector<std::pair<std::string, std::vector<Line>>> steps;  // heading, lines
  std::vector<Line> equations, constraints;
  std::vector<Expr> parts;      // named in `names`, where the equations stand in parts
};

// Arranges expressions, each only once: many forms have equations in common, or equations that are the same written out.
class Arranger {
 public:
  // auto or paper (grouped), none, full (written out), parts (as they stand, with names for what occurs more than once); auto
  // means parts where there are many coordinates.
  explicit Arranger(std::string expand) : expand_(std::move(expand)) {}
  Expr operator()(Expr e, const SymbolNames& names);
  bool in_parts(std::size_t coordinates) const;

 private:
  std::string expand_;
  std::unordered_map<NodeId, Expr> known_, of_written_out_;
};

Derivation derivation(const Mechanics& m, const Formulation& form, const Elimination& e, Arranger& arranger, bool steps);

// One derivation after the other. JSON: an object, or with `list` {"forms": [objects]}.
std::string as_text(const std::vector<Derivation>& list);
std::string as_latex(const std::vector<Derivation>& list);
std::string as_mathml(const std::vector<Derivation>& list);
std::string as_json(const std::vector<Derivation>& list, bool as_list);

}  // namespace anholon
