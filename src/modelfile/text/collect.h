// Failures of single elements are collected, so that all errors of a file are reported at once.
#pragma once
#include <functional>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

// A failure that was reported where it arose: uses of a broken definition stay silent.
Failure silent_failure();
bool is_silent(const Diagnostic& d);

// Runs f and adds what it throws to the diagnostics (a silent failure only returns false). A failure that knows no
// place of its own is one of the element at `place`.
bool collect(Diagnostics& diagnostics, const std::function<void()>& f, Span place = {});

// The same for an element of the file; of a member of a family the message says which one it is, and one member speaks
// for all whose failure has the same place.
bool collect(Diagnostics& diagnostics, const std::function<void()>& f, const Item& element);
// Whether a failure of another member of the family was reported at its place.
bool is_repeated(const Diagnostics& diagnostics, const Diagnostic& d);

// Calls f(table, index) for each element of an array of tables, collecting failures per element.
void for_each_table(const Item& list, const std::string& what, Diagnostics& diagnostics,
                    const std::function<void(const Item&, std::size_t)>& f);

}  // namespace anholon
