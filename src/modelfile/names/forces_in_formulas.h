// What formulas of a model file may say of forces: multipliers and reactions where they have a meaning, the forces of
// contacts, and definitions that hold them.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"

namespace anholon {

// The forces of contacts, which formulas may contain before the contacts are read: multiplier kContactForces + k is
// force asked()[k]. After close() no formula may contain further forces, because their symbols have no values.
class ContactForcesAsked {
 public:
  using Asked = std::vector<std::pair<std::string, Span>>;  // "floor.t1", and the place of its first use
  void declare(const std::string& contact) { contacts_.insert(contact); }
  // True if "floor" of the path "floor.t1" is a contact.
  bool declares(const std::string& path) const { return contacts_.count(path.substr(0, path.find('.'))) > 0; }
  // Returns the force `path`; nullopt if there is no such contact. Corners of a box have the numbered names of their
  // contact.
  std::optional<std::size_t> find(const std::string& path, Span use);
  const Asked& asked() const { return asked_; }
  void close() { closed_ = true; }

 private:
  std::set<std::string> contacts_;
  Asked asked_;
  bool closed_ = false;
};

class ForcesInFormulas {
 public:
  // While an object of this class exists, the constraints are known, so formulas may contain multipliers and reactions,
  // and definitions that contain them.
  class Allowed {
   public:
    explicit Allowed(ForcesInFormulas& forces) : forces_(forces) { ++forces_.allowed_; }
    ~Allowed() { --forces_.allowed_; }
    Allowed(const Allowed&) = delete;
    Allowed& operator=(const Allowed&) = delete;

   private:
    ForcesInFormulas& forces_;
  };
  bool allowed() const { return allowed_ > 0; }

  ContactForcesAsked of_contacts;

  // The constraints that are being read, or whose errors were reported: formulas with their multipliers fail silently.
  void begin(const std::string& constraint) { without_value_.insert(constraint); }
  void end(const std::string& constraint) { without_value_.erase(constraint); }
  // True if "roll" of the path "roll.x" is such a constraint.
  bool has_no_value(const std::string& path) const { return without_value_.count(path.substr(0, path.find('.'))) > 0; }

  // What is known of definitions that hold multipliers or reactions.
  struct Definitions {
    std::optional<bool> any;            // some definition may hold one
    std::map<std::string, bool> known;  // true for a definition that may hold one
  } definitions;

 private:
  int allowed_ = 0;  // number of objects of class Allowed
  std::set<std::string> without_value_;
};

}  // namespace anholon
