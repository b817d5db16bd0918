#include "modelfile/all_contacts.h"

#include "modelfile/check/states_in_contacts.h"
#include "modelfile/contact_forces.h"
#include "modelfile/mechanical/contact_names.h"

namespace anholon {

static ModelNote note_of(const std::vector<Contact>& contacts) {
  std::string names;
  std::size_t count = 0;
  for (const Contact& c : contacts)
    if (!c.under) names += (count++ == 0 ? "'" : ", '") + c.name + "'";
  const bool one = count == 1;
  return {(one ? "contact " : "contacts ") + names + (one ? " is no " : " are no ") +
              "part of these equations, which hold while " + (one ? "it is open" : "all of them are open"),
          ModelNote::About::open_contacts};
}

std::vector<Contact> read_all_contacts(const Item& root, const std::vector<Contact>& switched, Scope& scope,
                                       Model& model, Diagnostics& diagnostics) {
  std::vector<Contact> contacts = read_contacts(root, scope, model, diagnostics);
  check_names_of_contacts(contacts, model, diagnostics);
  if (!contacts.empty()) model.notes.push_back(note_of(contacts));
  contacts.insert(contacts.end(), switched.begin(), switched.end());
  settle_states_in_contacts(model, contacts, diagnostics);
  settle_contact_forces(scope, model, contacts, diagnostics);
  scope.forces.of_contacts.close();
  return contacts;
}

}  // namespace anholon
