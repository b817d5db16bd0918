// The words of the command line before and after they are parsed.
#pragma once
#include "cli/commands.h"

namespace anholon::cli {

// Throws UsageError with a suggestion if the first word is no option and none of the commands.
void check_command(const std::string& word, const std::vector<std::string>& commands);

// True if a word after `help` is a topic of model files. Throws UsageError with a suggestion if the word is neither a
// topic nor an option nor one of the commands.
bool is_topic(const std::string& word, const std::vector<std::string>& commands);

// Takes a word without '=' out of the lists of assignments as the model, if no model is named: in --q x=1 y=2 MODEL the
// parser puts the model into the list of --q.
void rescue_model(SystemCommand& o);

// Returns "anholon" and the words after it in a form that can be typed again in a shell.
std::string command_line(const std::vector<std::string>& words);

}  // namespace anholon::cli
