#include "modelfile/mechanical/contact_names.h"

#include <algorithm>

namespace anholon {

void declare_contacts(const Item& root, Scope& scope) {
  for (const char* section : {"contact", "constraint"}) {
    const Item* list = root.find(section);
    if (!list || list->kind != Item::Kind::array) continue;
    for (std::size_t k = 0; k < list->items.size(); ++k) {
      const Item& c = list->items[k];
      if (c.kind != Item::Kind::table) continue;
      if (section == std::string("constraint") && !is_switched(c)) {
        const Item* word = c.find("one_sided");
        if (!word || word->kind != Item::Kind::boolean || !word->truth) continue;
      }
      const Item* named = c.find("name");
      scope.forces.of_contacts.declare(named && named->kind == Item::Kind::string ? normal_name(named->text())
                                                                                  : section + std::to_string(k + 1));
    }
  }
}

void check_names_of_contacts(const std::vector<Contact>& contacts, const Model& model, Diagnostics& diagnostics) {
  std::vector<std::string> told;
  for (const Contact& c : contacts) {
    const bool of_constraint =
        std::any_of(model.constraints.begin(), model.constraints.end(),
                    [&](const Constraint& o) { return o.name == c.name || o.name == c.element; });
    if (of_constraint && !c.held && std::find(told.begin(), told.end(), c.element) == told.end()) {
      told.push_back(c.element);
      diagnostics.error(c.span, "there are a constraint and a contact '" + c.element + "'",
                        "give one of them another name: lambda.NAME is the force of one");
    }
    for (const Event& e : model.events)
      for (const char* word : {"hits", "leaves", "rests", "slips", "sticks", "reverses", "starts", "stops"})
        if (!c.held && e.name == c.name + "." + word)
          diagnostics.error(e.span, "'" + e.name + "' is an event that the contact '" + c.name + "' has itself",
                            "name = \"" + c.name + "_" + word + "\"");
  }
}

}  // namespace anholon
