#include "cli/contacts.h"

#include "contact/mode/chosen_mode.h"
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
  if (o.mode.empty()) throw usage_error(needs_mode(command, *in.model, list, "--mode "), in.source);
  try {
    put_chosen_mode(model_of(*in.names), list, split(o.mode));
  } catch (const Failure& f) {
    throw usage_error(f, in.source, "--mode: ");
  }
  return in;
}

void hint_at_state_of_mode(Outcome& start, const SystemCommand& o, const Model& model, const StateChoice& choice) {
  if (!o.mode.empty()) anholon::hint_at_state_of_mode(start, model, choice.overrides, "--q and --qdot");
}

}  // namespace anholon::cli
