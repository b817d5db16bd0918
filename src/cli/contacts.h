// Models with contacts in commands that do not compute their changes of mode.
#pragma once
#include <string>

#include "cli/input.h"

namespace anholon::cli {

// Throws UsageError if the model has contacts.
void without_contacts(const Reader& in, const std::string& command);

// Returns the model in the mode that --mode names. Throws UsageError if the mode is wrong, or if it is missing and the
// model has contacts.
Reader in_mode(Reader in, const SystemCommand& o, const std::string& command);

}  // namespace anholon::cli
