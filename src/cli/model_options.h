// The table of the options that change a model or its state. The command line, saved runs and result files use it.
#pragma once
#include "cli/commands.h"

namespace anholon::cli {

struct ModelOption {
  enum class Of : std::uint8_t { parameters, state, form };
  Of of;
  const char* name;   // "qdot" for --qdot
  const char* value;  // the name of the value in the help
  const char* help;
  std::vector<std::string> SystemCommand::* words;
  bool assigns;  // each word is NAME=VALUE, and several may follow one --name
};
const std::vector<ModelOption>& model_options();

}  // namespace anholon::cli
