#include "cli/contacts.h"

#include <algorithm>

#include "contact/mode_model.h"
#include "modelfile/contacts.h"

namespace anholon::cli {

void without_contacts(const Reader& in, const std::string& command) {
  if (const std::vector<Contact>& list = contacts(*in.names); !list.empty())
    throw UsageError{"error: '" + command + "' knows no contacts, and the model has '" + list.front().name +
                     "'\nhint: 'simulate' and 'sweep' do; write what touches as a [[constraint]] for the others\n"};
}

Reader in_mode(Reader in, const SystemCommand& o, const std::string& command) {
  const std::vector<Contact>& list = contacts(*in.names);
  if (list.empty() && o.mode.empty()) return in;
  if (o.mode.empty())
    throw UsageError{"error: '" + command + "' needs the mode of the contacts, and the model has '" +
                     list.front().name + "'\nhint: --mode " + list.front().name + "=open, or slips, or sticks\n"};
  std::vector<Touch> touches(list.size(), Touch::open);
  std::vector<std::string> names;
  for (const Contact& c : list) names.push_back(c.name);
  for (const std::string& word : split(o.mode)) {
    const std::size_t at = word.find('=');
    const std::string name = word.substr(0, at), mode = at == std::string::npos ? "" : word.substr(at + 1);
    const auto known = std::find(names.begin(), names.end(), name);
    if (known == names.end())
      throw UsageError{"error: --mode: there is no contact '" + name +
                       "'\nhint: " + (names.empty() ? "the model has none" : "--mode " + names[0] + "=sticks") + "\n"};
    if (mode != "open" && mode != "slips" && mode != "sticks")
      throw UsageError{"error: --mode: '" + word + "' names no mode\nhint: " + name + "=open, " + name + "=slips or " +
                       name + "=sticks\n"};
    touches[static_cast<std::size_t>(known - names.begin())] = mode == "open"    ? Touch::open
                                                               : mode == "slips" ? Touch::slips
                                                                                 : Touch::sticks;
  }
  try {
    in.model = ideal_model(*in.model, list, touches);
  } catch (const Failure& f) {
    throw UsageError{"error: --mode: " + f.diagnostic.message + "\nhint: " + f.diagnostic.hint + "\n"};
  }
  return in;
}

}  // namespace anholon::cli
