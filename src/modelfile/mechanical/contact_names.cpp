#include "modelfile/mechanical/contact_names.h"

#include <algorithm>

namespace anholon {

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
