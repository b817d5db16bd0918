// The choice of columns by names and patterns.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace anholon {

// True if the pattern, with * and ? as wildcards, matches the name.
bool matches(const std::string& pattern, const std::string& name);

// The places of the columns that the names and patterns choose, each once, in the order of the names. A pattern does
// not choose the column at the place `without`. Throws Failure, which lists the columns, if a name is not a column.
std::vector<std::size_t> chosen_columns(const std::vector<std::string>& columns, const std::vector<std::string>& names,
                                        std::size_t without = static_cast<std::size_t>(-1));
// The names, with spaces between them; of very many names, the first ones.
std::string list_of_columns(const std::vector<std::string>& names);
// Throws the Failure of a name that is no column.
[[noreturn]] void unknown_column(const std::vector<std::string>& columns, const std::string& name);

}  // namespace anholon
