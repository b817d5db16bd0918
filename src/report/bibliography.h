// The literature of a page: sources of the forms, methods and the model on it, from the project's refs.bib.
#pragma once
#include <string>
#include <vector>

namespace anholon {

// An entry as text, "Jorba, À. and Zou, M.: A software package … Experimental Mathematics 14 (1), 99–117, 2005."; empty
// if the key does not exist.
std::string reference(const std::string& key);

// The entries that a page used, each once, in the order of first use.
class Bibliography {
 public:
  // A source as given by a formulation or a model: one of the founding papers, several separated by semicolons, or
  // words.
  void source(const std::string& text);
  void key(const std::string& key);
  const std::vector<std::string>& entries() const { return entries_; }

 private:
  void add(const std::string& entry);
  std::vector<std::string> entries_;
};

}  // namespace anholon
