// Models with contacts in commands that do not compute their changes of mode.
#pragma once
#include "cli/input.h"
#include "modelfile/contacts.h"

namespace anholon::cli {

// Throws UsageError if the model has contacts.
inline void without_contacts(const Reader& in, const std::string& command) {
  if (const std::vector<Contact>& list = contacts(*in.names); !list.empty())
    throw UsageError{"error: '" + command + "' knows no contacts, and the model has '" + list.front().name +
                     "'\nhint: 'simulate' and 'sweep' do; write what touches as a [[constraint]] for the others\n"};
}

// The model in the mode of its contacts that --mode names. Throws UsageError if it has contacts and no --mode is given.
Reader in_mode(Reader in, const SystemCommand& o, const std::string& command);

}  // namespace anholon::cli
