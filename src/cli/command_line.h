// The command line of the program.
#pragma once

namespace anholon::cli {

// Runs the command that the words name, and returns the exit status. Throws UsageError for words that make no command.
int run_command_line(int argc, char** argv);

}  // namespace anholon::cli
