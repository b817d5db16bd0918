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

// Tells in the hint of an inconsistent start that a state of the mode of --mode is needed, if that mode was chosen.
void hint_at_state_of_mode(Outcome& start, const SystemCommand& o, const Model& model, const StateChoice& choice);

}  // namespace anholon::cli
