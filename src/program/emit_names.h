// Identifiers for the quantities of a motion in generated programs.
#pragma once
#include <set>
#include <string>
#include <unordered_map>

#include "program/emit_motion.h"

namespace anholon::emit {

// Turns names into identifiers that neither language reserves.
class LocalNames {
 public:
  LocalNames(const System& system, const Structure& structure, const Motion& motion);
  const std::string& symbol(NodeId id) const { return symbols_.at(id); }
  bool taken(const std::string& name) const { return taken_.count(name) > 0; }

 private:
  std::string fresh(const std::string& wanted);
  std::set<std::string> taken_;
  std::unordered_map<NodeId, std::string> symbols_;
};

// An identifier like this text; empty text gives `otherwise`.
std::string identifier(const std::string& text, const std::string& otherwise);

}  // namespace anholon::emit
