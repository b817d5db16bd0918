#include "cli/completion.h"

#include <functional>

#include "base/join.h"

namespace anholon::cli {

namespace {

// Returns the text in single quotes of a shell.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string with_backslashes(const std::string& text, const std::string& before) {
  std::string out;
  for (const char c : text) {
    if (before.find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

void for_each_command(const CommandWords& c, const std::function<void(const CommandWords&)>& f) {
  f(c);
  for (const CommandWords& i : c.inner) for_each_command(i, f);
}

std::string bash(const CommandWords& program) {
  std::string cases;
  std::vector<std::string> names;
  for_each_command(program, [&](const CommandWords& c) {
    std::vector<std::string> words;
    for (const CommandWords& i : c.inner) words.push_back(i.words.substr(i.words.rfind(' ') + 1));
    for (const CommandWords::Flag& f : c.flags) words.insert(words.end(), f.names.begin(), f.names.end());
    cases += "    \"" + c.words + "\") words=\"" + joined(words, " ") + "\" ;;\n";
    if (!c.words.empty()) names.push_back(with_backslashes(c.words, " "));
  });
  return "# Completion of anholon for bash: source <(anholon completion bash)\n"
         "_anholon() {\n"
         "  local current=\"${COMP_WORDS[COMP_CWORD]}\" path=\"\" word words=\"\" i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    word=\"${path:+$path }${COMP_WORDS[i]}\"\n"
         "    case \"$word\" in " +
         joined(names, "|") +
         ") path=\"$word\" ;; esac\n"
         "  done\n"
         "  case \"$path\" in\n" +
         cases +
         "  esac\n"
         "  # Names of models complete a word that is no option.\n"
         "  if [[ -n \"$path\" && \"$current\" != -* ]]; then words+=\" $(\"${COMP_WORDS[0]}\" models 2>/dev/null | "
         "sed -n "
         "'s/^ *\\([a-z][a-z0-9-]*\\)  .*/\\1/p')\"; fi\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\"; [[ -n \"$path\" && \"$current\" != -* ]] "
         "&& "
         "compgen -f -- \"$current\")\n"
         "}\n"
         "complete -o filenames -F _anholon anholon\n";
}

std::string zsh(const CommandWords& program) {
  std::string cases, names;
  for (const CommandWords& c : program.inner) {
    std::string options;
    for (const CommandWords::Flag& f : c.flags)
      for (const std::string& name : f.names)
        options += " " + quoted("*" + name + "[" + with_backslashes(f.about, "[]:\\") + "]" +
                                (f.takes_value ? ":value:_files" : ""));
    cases += "    " + c.words + ") _arguments" + options + " '*:file:_files' ;;\n";
    names += " " + quoted(c.words + ":" + c.about);
  }
  return "#compdef anholon\n# Completion of anholon for zsh: anholon completion zsh > FOLDER/_anholon, a folder of "
         "$fpath\n"
         "local -a commands\ncommands=(" +
         names +
         ")\nif (( CURRENT == 2 )); then\n  _describe command commands\nelse\n"
         "  case $words[2] in\n" +
         cases + "  esac\nfi\n";
}

std::string fish(const CommandWords& program) {
  std::string out = "# Completion of anholon for fish: anholon completion fish | source\n";
  for (const CommandWords& c : program.inner) {
    out += "complete -c anholon -n __fish_use_subcommand -a " + c.words + " -d " + quoted(c.about) + "\n";
    for (const CommandWords::Flag& f : c.flags) {
      out += "complete -c anholon -n '__fish_seen_subcommand_from " + c.words + "'";
      for (const std::string& name : f.names)
        out += name.rfind("--", 0) == 0 ? " -l " + name.substr(2) : " -s " + name.substr(1);
      out += (f.takes_value ? " -r -d " : " -d ") + quoted(f.about) + "\n";
    }
  }
  return out;
}

}  // namespace

const std::vector<std::string>& shells_with_completion() {
  static const std::vector<std::string> list = {"bash", "zsh", "fish"};
  return list;
}

std::string completion_script(const CommandWords& program, const std::string& shell) {
  return shell == "bash" ? bash(program) : shell == "zsh" ? zsh(program) : fish(program);
}

}  // namespace anholon::cli
