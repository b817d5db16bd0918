#include "cli/contacts.h"

#include "contact/chosen_mode.h"
#include "modelfile/contacts.h"

namespace anholon::cli {

void without_contacts(const Reader& in, const std::string& command) {
  const std::vector<Contact>& list = contacts(*in.names);
  if (list.empty()) return;
  const bool held = list.front().held.has_value();
  throw UsageError{"error: '" + command + "' knows no " + (held ? "constraints with 'active'" : "contacts") +
                   ", and the model has '" + list.front().name + "'\nhint: 'simulate' and 'sweep' do; write what " +
                   (held ? "holds without 'active'" : "touches as a [[constraint]]") + " for the others\n"};
}

Reader in_mode(Reader in, const SystemCommand& o, const std::string& command) {
  const std::vector<Contact>& list = contacts(*in.names);
  if (list.empty() && o.mode.empty()) return in;
  const auto usage = [](const std::string& before, const Failure& f) {
    return UsageError{"error: " + before + f.diagnostic.message + "\nhint: " + f.diagnostic.hint + "\n"};
  };
  if (o.mode.empty()) throw usage("", needs_mode(command, *in.model, list, "--mode "));
  try {
    put_chosen_mode(model_of(*in.names), list, split(o.mode));
  } catch (const Failure& f) {
    throw usage("--mode: ", f);
  }
  return in;
}

}  // namespace anholon::cli
