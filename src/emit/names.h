// Identifiers for the quantities of a motion in generated programs.
#pragma once
#include <set>
#include <string>
#include <unordered_map>

#include "emit/motion.h"
#include "emit/rate_formulas.h"

namespace anholon::emit {

// The local variables of the functions of a program, and the arguments that hold their values. Names become identifiers that
// neither language reserves.
class LocalNames {
 public:
  LocalNames(const System& system, const Structure& structure, const Motion& motion);
  explicit LocalNames(const RateFormulas& formulas);

  struct Place {
    std::size_t array, index;  // number `index` of arrays()[array]
  };
  const std::vector<std::string>& arrays() const { return arrays_; }
  const std::string& symbol(NodeId id) const { return symbols_.at(id); }
  // Returns nullptr for the time, which is an argument of its own.
  const Place* place(NodeId id) const;
  bool taken(const std::string& name) const { return taken_.count(name) > 0; }

 private:
  explicit LocalNames(std::vector<std::string> arrays);
  void add(NodeId id, const std::string& wanted, Place place);
  std::string fresh(const std::string& wanted);
  std::vector<std::string> arrays_;
  std::set<std::string> taken_;
  std::unordered_map<NodeId, std::string> symbols_;
  std::unordered_map<NodeId, Place> places_;
};

// Returns an identifier similar to this text; `otherwise` for an empty text.
std::string identifier(const std::string& text, const std::string& otherwise);

}  // namespace anholon::emit
