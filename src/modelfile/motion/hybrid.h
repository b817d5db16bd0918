// [state], [mode] and [[event]]: additions to the mechanics, and instantaneous changes.
//
// A state z has z' = rate. A mode is constant between events. An event fires when the formula `when` strictly changes
// its sign along the motion, not at the start and not right after an event; `set` gives modes, states, coordinates or
// their derivatives new values, computed from the old ones. Several events at one moment are served in the order of the
// file; each sees the values set by the earlier ones.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

void declare_hybrid(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
void read_states(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);
void read_events(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
