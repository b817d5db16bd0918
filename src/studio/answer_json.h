// Parts of the answers of the studio that are written the same way wherever they occur. (doc/json.md)
#pragma once
#include <string>

#include "anholon/result.h"
#include "base/diagnostic.h"
#include "base/json.h"

namespace anholon {

// A diagnostic; a place in another file than `source` has the name of that file.
void write(JsonWriter& json, const Diagnostic& d, const SourceText& source);

// "error": what is shown in place of an answer. `name`: of the text, whose places have no name of a file.
void write(JsonWriter& json, const v1::Error& error, const std::string& name);

// A section of a page, unless it is empty.
void section(JsonWriter& json, const char* id, const char* title, const std::string& body);

// An answer that holds an error alone.
std::string error_answer(const v1::Error& error, const std::string& name);

}  // namespace anholon
