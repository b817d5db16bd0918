#include "cli/typed_words.h"

#include <algorithm>

#include "base/diagnostic.h"
#include "cli/input.h"
#include "cli/model_options.h"
#include "modelfile/language/reference.h"

namespace anholon::cli {

void rescue_model(SystemCommand& o) {
  for (const ModelOption& option : model_options()) {
    if (!option.assigns) continue;
    std::vector<std::string>& list = o.*option.words;
    for (auto it = list.begin(); it != list.end();) {
      if (o.model.empty() && it->find('=') == std::string::npos)
        o.model = *it, it = list.erase(it);
      else
        ++it;
    }
  }
}

void check_command(const std::string& word, const std::vector<std::string>& commands) {
  if (word.starts_with('-') || std::find(commands.begin(), commands.end(), word) != commands.end()) return;
  const std::string near = did_you_mean(word, commands);
  throw UsageError{"error: there is no command '" + word + "'" +
                   (near.empty() ? "" : "; did you mean '" + near + "'?") + "\nhint: anholon --help\n"};
}

bool is_topic(const std::string& word, const std::vector<std::string>& commands) {
  if (word.starts_with('-') || std::find(commands.begin(), commands.end(), word) != commands.end()) return false;
  if (is_in_reference(word)) return true;
  std::vector<std::string> known = reference_words();
  known.insert(known.end(), commands.begin(), commands.end());
  const std::string near = did_you_mean(word, known);
  throw UsageError{
      "error: there is no command and no topic '" + word + "'" +
      (near.empty() ? "" : "; did you mean '" + near + "'?") +
      "\nhint: anholon --help lists the commands; topics are the sections of model files, contacts, events, "
      "forces, …, and formulas\n"};
}

std::string command_line(const std::vector<std::string>& words) {
  std::string line = "anholon";
  for (const std::string& word : words) {
    const bool plain =
        !word.empty() &&
        word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-") ==
            std::string::npos;
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += " " + (plain ? word : quoted + "'");
  }
  return line;
}

}  // namespace anholon::cli
