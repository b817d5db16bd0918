#include "cli/words.h"

#include "base/diagnostic.h"
#include "cli/input.h"
#include "cli/model_options.h"

namespace anholon::cli {

// --q x=1 y=2 MODEL: a word without '=' that slipped into a list of assignments is the model.
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

static constexpr const char* kCommands[] = {"check",  "derive", "evaluate",  "simulate", "sweep",  "linearize",
                                            "forms",  "models", "prove",     "compare",  "papers", "verify",
                                            "new",    "fmt",    "reference", "convert",  "plot",   "report",
                                            "render", "studio", "completion"};

// A word that is no command gets an answer of its own.
void check_command(const char* word) {
  if (word[0] == '-') return;
  std::vector<std::string> known;
  for (const char* c : kCommands) {
    if (std::string(c) == word) return;
    known.emplace_back(c);
  }
  const std::string near = did_you_mean(word, known);
  throw UsageError{"error: there is no command '" + std::string(word) + "'" +
                   (near.empty() ? "" : "; did you mean '" + near + "'?") + "\nhint: anholon --help\n"};
}

// The words as they could be typed again.
std::string command_line(int argc, char** argv) {
  std::string line = "anholon";
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
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
