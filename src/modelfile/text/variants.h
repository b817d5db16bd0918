// Bases (base = "file.toml") and cases ([case.NAME]) of a file: one tree laid over another.
//
//  * Tables are merged key by key; elements of a list of tables by their names, key by key, and those without a
//    counterpart are added at the end; every other value is replaced. Existing entries keep their place.
//  * constraint.reel.equation = "…" changes an existing element of the list, which is addressed by its name.
//  * A case changes declarations of the file: the names in [parameters], [define], … must exist. New elements of a
//    case are given as a list, [[case.NAME.force]].
//
// A key cannot be removed.
#pragma once
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

// Returns the tree of a file laid over that of its base (and of the base's base); the files are added to source.others
// unless they are already there. The path of a base is relative to the file that names it. Throws Failure.
Item read_files(SourceText& source);

// Removes the cases of a file from its tree and returns them.
Item take_cases(Item& root, Diagnostics& diagnostics);
// Lays the case of this name over the tree.
void apply_case(Item& root, const Item& cases, const std::string& name, Diagnostics& diagnostics);

}  // namespace anholon
