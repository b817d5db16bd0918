// The scenarios of a model file, [case.NAME], that a sweep runs through: each is a piece of the sweep, one after the
// other.
#pragma once
#include <string>
#include <vector>

#include "ensemble/table.h"

namespace anholon {

// Throws Failure without a place if the list of scenarios is empty or contains a name twice. `called`: the name of the
// option in messages.
void must_name_each_once(const std::vector<std::string>& scenarios, const std::string& called);

// Throws Failure without a place, which says that a scenario has other columns than the first one. `hint`: how columns
// are chosen.
[[noreturn]] void has_other_columns(const std::string& scenario, const std::string& first, const std::string& hint);
// Throws Failure without a place if the units of what varies (units_of) differ between two scenarios.
void must_have_units_of(const std::string& first, const std::string& first_scenario, const std::string& units,
                        const std::string& scenario);
// Throws one of these Failures if the tables of two scenarios have other columns or units.
void must_have_columns_of(const SweepTable& first, const std::string& first_scenario, const SweepTable& table,
                          const std::string& scenario, const std::string& hint);

}  // namespace anholon
