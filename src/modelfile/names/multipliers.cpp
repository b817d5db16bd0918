// Multipliers and reactions in formulas, and in the definitions that such formulas use.
#include <algorithm>

#include "model/loads.h"
#include "modelfile/names/names.h"

namespace anholon {

std::string multiplier_path(const Syntax& s) {
  const Syntax& object = s.args[0];
  if (object.op == Syntax::Op::name) return object.text == "lambda" ? s.text : "";
  if (object.op != Syntax::Op::member) return "";
  const std::string inner = multiplier_path(object);
  return inner.empty() ? "" : inner + "." + s.text;
}

Value Scope::multiplier(const std::string& path, Span use) {
  const std::vector<std::string>& names = model_.names.multipliers;
  // A constraint that holds in some modes may be among the names as well, but its force has no fixed index there.
  if (forces.of_contacts.declares(path))
    if (const auto force = forces.of_contacts.find(path, use))
      return graph().multiplier(kContactForces + static_cast<std::uint32_t>(*force), 0);
  if (const auto it = std::find(names.begin(), names.end(), path); it != names.end())
    return graph().multiplier(static_cast<std::uint32_t>(it - names.begin()), 0);
  for (const std::string& n : names)
    if (n.rfind(path + ".", 0) == 0)
      return kMultipliersOfVector;  // a vector equation, of which a component must follow
  if (const auto force = forces.of_contacts.find(path, use))
    return graph().multiplier(kContactForces + static_cast<std::uint32_t>(*force), 0);
  if (forces.has_no_value(path)) throw silent_failure();
  const std::string near = did_you_mean(path, names);
  throw Failure(use, "there is no constraint '" + path + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

std::optional<std::size_t> ContactForcesAsked::find(const std::string& path, Span use) {
  std::string contact = path.substr(0, path.find('.'));
  while (!contact.empty() && !contacts_.count(contact) && contact.back() >= '0' && contact.back() <= '9')
    contact.pop_back();
  if (!contacts_.count(contact)) {
    const std::string wanted = path.substr(0, path.find('.'));
    const std::string near = did_you_mean(wanted, {contacts_.begin(), contacts_.end()});
    if (near.empty()) return std::nullopt;
    throw Failure(use, "there is no constraint or contact '" + wanted + "'; did you mean '" + near + "'?");
  }
  if (closed_)
    throw Failure(use, "'lambda." + path + "' is the force of a contact, which has no value here",
                  "an [output], [monitor] or [[event]] of the model file may hold it");
  const auto known = std::find_if(asked_.begin(), asked_.end(), [&](const auto& a) { return a.first == path; });
  if (known != asked_.end()) return static_cast<std::size_t>(known - asked_.begin());
  asked_.push_back({path, use});
  return asked_.size() - 1;
}

bool is_reaction(const std::string& function) { return function == "reaction" || function == "reaction_torque"; }

// Evaluates reaction(B) or reaction_torque(B) from the accelerations, by Newton's law.
Vector Scope::reaction_on(std::size_t body, const Syntax& call) {
  if (!forces.allowed())
    throw Failure(call.span,
                  "a reaction has no meaning here: it follows from the equations of which this formula is a part",
                  kWhereMultipliers);
  const Load r = reaction(model_, body);
  return call.text == "reaction" ? r.force : r.torque;
}

// True if any definition may contain a multiplier. The search in the texts spares most files the search below.
bool Scope::speaks_of_multipliers() {
  if (!forces.definitions.any)
    forces.definitions.any = std::any_of(declarations_.begin(), declarations_.end(), [](const auto& named) {
      const std::string& text = named.second.formula.text();
      return text.find("lambda") != std::string::npos || text.find("λ") != std::string::npos ||
             text.find("reaction") != std::string::npos;
    });
  return *forces.definitions.any;
}

// True if a definition contains a multiplier or a reaction, itself or through others.
bool Scope::holds_multiplier(const std::string& name) {
  if (!speaks_of_multipliers()) return false;
  if (const auto known = forces.definitions.known.find(name); known != forces.definitions.known.end())
    return known->second;
  std::set<std::string> seen = {name};
  std::vector<std::string> open = {name};
  bool found = false;
  const auto meet = [&](const std::string& n) {
    if (declarations_.count(n) && seen.insert(n).second) open.push_back(n);
  };
  while (!open.empty() && !found) {
    const Declaration& d = declarations_.at(open.back());
    open.pop_back();
    if (d.role == Role::parameter || d.role == Role::table || d.formula.text().empty()) continue;
    std::vector<Syntax> trees;
    try {
      trees.push_back(parse_formula(d.formula));
    } catch (const Failure&) {
      continue;  // reported at its evaluation
    }
    while (!trees.empty() && !found) {
      const Syntax s = std::move(trees.back());
      trees.pop_back();
      if (s.op == Syntax::Op::name) found = s.text == "lambda", meet(s.text);
      if (s.op == Syntax::Op::call) found = is_reaction(s.text) && !declarations_.count(s.text), meet(s.text);
      trees.insert(trees.end(), s.args.begin(), s.args.end());
    }
  }
  if (found)
    forces.definitions.known[name] = true;
  else
    for (const std::string& n : seen) forces.definitions.known[n] = false;
  return found;
}

}  // namespace anholon
