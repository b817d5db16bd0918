// The options that change a model or its state by words, one row each: of the command line, saved runs and provenance.
#pragma once
#include "cli/commands.h"

namespace anholon::cli {

struct ModelOption {
  enum class Of : std::uint8_t { parameters, state, form };
  Of of;
  const char* name;   // "qdot" for --qdot
  const char* value;  // how the help calls its value
  const char* help;
  std::vector<std::string> SystemCommand::* words;
  bool assigns;  // each word is NAME=VALUE, and several may follow one --name
};
const std::vector<ModelOption>& model_options();

}  // namespace anholon::cli
