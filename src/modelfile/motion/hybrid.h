// [state], [mode] and [[event]]: what the user adds to the mechanics, and what changes at a moment.
//
// A state z has z' = rate. A mode is constant between events. An event fires where the formula `when` strictly changes
// its sign along the motion, not at the start and not right after an event; `set` gives modes, states, coordinates or
// their derivatives new values, by the values before. Of several events at one moment each is served in the order of
// the file, and finds what those before it have set.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void declare_hybrid(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
void read_states(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
void read_events(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
