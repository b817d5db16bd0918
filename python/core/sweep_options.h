// The options of a sweep, as they come from Python.
#pragma once
#include "core.h"

namespace anholon::python {

// Values by name in their order; laws by name; the number of cases; seed; draw; together; the end; the tolerance; times;
// columns; reductions; the table of cases, whose name in messages stands before it.
using SweepWords =
    std::tuple<std::vector<std::pair<std::string, std::vector<std::string>>>, std::map<std::string, std::string>,
               std::optional<std::size_t>, std::uint64_t, std::string, bool, std::optional<std::string>,
               std::optional<std::string>, std::vector<std::string>, std::vector<std::string>, std::vector<std::string>,
               std::pair<std::string, std::string>>;
SweepOptions options_of(const SweepWords& words);

}  // namespace anholon::python
