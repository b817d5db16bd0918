// Parts of the answers of the studio that are the same in all answers (doc/json.md).
#pragma once
#include <string>

#include "anholon/result.h"
#include "base/diagnostic.h"
#include "base/json.h"

namespace anholon {

// Writes a diagnostic; a place in another file than `source` has the name of that file.
void write(JsonWriter& json, const Diagnostic& d, const SourceText& source);

// Writes "error", which is shown in place of an answer. `name`: of the text, whose places have no name of a file.
void write(JsonWriter& json, const v1::Error& error, const std::string& name);

// Writes a section of a page, unless it is empty.
void section(JsonWriter& json, const char* id, const char* title, const std::string& body);

// Returns an answer that contains only an error.
std::string error_answer(const v1::Error& error, const std::string& name);

}  // namespace anholon
