// What a file builds on, base = "file.toml", and its scenarios, [case.NAME]: one tree put over another.
//
// * Tables are merged key by key; elements of a list of tables by their name, key by key, those without a counterpart
// are added
//   at the end; every other value is replaced. What came first keeps its place.
// * constraint.reel.equation = "…" changes an element of the list that is there: its name stands for it. * A scenario
// changes what the file declares: the names in [parameters], [define], … must be there. New elements of a scenario
//   stand in a list, [[case.NAME.force]].
// A key cannot be taken away again.
#pragma once
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

// The tree of a file with that of its base (and of the base's base) under it; the files are added to source.others,
// where they are not there yet. A base lies relative to the file that names it. Throws Failure.
Item read_files(SourceText& source);

// The scenarios of a file, taken out of its tree.
Item take_cases(Item& root, Diagnostics& diagnostics);
// Puts the scenario of this name over the tree.
void apply_case(Item& root, const Item& cases, const std::string& name, Diagnostics& diagnostics);

}  // namespace anholon
