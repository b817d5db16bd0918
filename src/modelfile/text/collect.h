// Collects failures of single elements, so that all errors of a file are reported at once.
#pragma once
#include <functional>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

// Returns a failure that was already reported at its origin: uses of a broken definition are not reported again.
Failure silent_failure();
bool is_silent(const Diagnostic& d);

// Runs f and adds its failure to the diagnostics (a silent failure only returns false). A failure without a position
// gets `place`.
bool collect(Diagnostics& diagnostics, const std::function<void()>& f, Span place = {});

// Does the same for an element of the file. For a member of a family the message names the member; of failures at the
// same place only that of one member is reported.
bool collect(Diagnostics& diagnostics, const std::function<void()>& f, const Item& element);
// True if a failure of another member of the family was already reported at the same place.
bool is_repeated(const Diagnostics& diagnostics, const Diagnostic& d);

// Calls f(table, index) for each element of an array of tables, collecting failures per element.
void for_each_table(const Item& list, const std::string& what, Diagnostics& diagnostics,
                    const std::function<void(const Item&, std::size_t)>& f);

}  // namespace anholon
