// The words of the command line before and after they are parsed.
#pragma once
#include "cli/commands.h"

namespace anholon::cli {

// Throws UsageError with a suggestion if the first word is no option and none of the commands.
void check_command(const std::string& word, const std::vector<std::string>& commands);

// Whether a word of `help` is a topic of model files. Throws UsageError with a suggestion if the word is neither that nor an
// option nor one of the commands.
bool is_topic(const std::string& word, const std::vector<std::string>& commands);

// In --q x=1 y=2 MODEL the model slips into the list of assignments: takes a word without '=' out of these lists as the
// model, where none is named.
void rescue_model(SystemCommand& o);

// The words as they could be typed again.
std::string command_line(int argc, char** argv);

}  // namespace anholon::cli
