// Scripts that complete the words of the command line in a shell.
#pragma once
#include <string>
#include <vector>

namespace anholon::cli {

// A command with its options and the commands inside it; the program itself has no words.
struct CommandWords {
  struct Flag {
    std::vector<std::string> names;  // "-o", "--output"
    bool takes_value = false;
    std::string about;
  };
  std::string words, about;  // "sweep collect"
  std::vector<Flag> flags;
  std::vector<CommandWords> inner;
};

// The shells for which there is a script: bash, zsh, fish.
const std::vector<std::string>& shells_with_completion();
// REQUIRES: one of these shells.
std::string completion_script(const CommandWords& program, const std::string& shell);

}  // namespace anholon::cli
