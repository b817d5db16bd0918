// Requests to stop long commands.
#pragma once
#include <string>

namespace anholon::cli {

// From here on Ctrl-C, a termination request of the system and a closed terminal are stop requests, which any thread
// may query. If the rows go to a file, a closed standard output or stderr does not end the run.
void catch_stop(const std::string& output);
bool stop_requested();

}  // namespace anholon::cli
