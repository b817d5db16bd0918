// How cases ended, in the words of lists and pictures.
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace anholon {

// The outcome of a case; of one that finished by an event, the event: "event NAME".
std::string ending(std::string_view outcome, std::string_view event);

// "10364 finished (4036 by event over), 3 singular". `events`: of the cases that finished, by the event that ended them.
std::string list_of_endings(const std::map<std::string, std::size_t>& outcomes,
                            const std::map<std::string, std::size_t>& events);

}  // namespace anholon
