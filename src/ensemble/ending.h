// The endings of cases, in the words of lists and pictures.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace anholon {

// Returns the outcome of a case; for one that an event has finished, "event NAME".
std::string ending(std::string_view outcome, std::string_view event);

// Returns "10364 finished (4036 by event over), 3 singular". `events`: the finished cases by the event that ended them.
std::string list_of_endings(const std::map<std::string, std::size_t>& outcomes,
                            const std::map<std::string, std::size_t>& events);

}  // namespace anholon
