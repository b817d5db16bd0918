// The literature of a page: of the forms, methods and the model that occur on it, from the project's refs.bib.
#pragma once
#include <string>
#include <vector>

namespace anholon {

// An entry in words, "Jorba, À. and Zou, M.: A software package … Experimental Mathematics 14 (1), 99–117, 2005.";
// empty if there is none of that key.
std::string reference(const std::string& key);

// Of what a page used, each once, in the order of their first use.
class Bibliography {
 public:
  // A source as a formulation or a model gives it: one of the founding papers, several separated by semicolons, or
  // words.
  void source(const std::string& text);
  void key(const std::string& key);
  const std::vector<std::string>& entries() const { return entries_; }

 private:
  void add(const std::string& entry);
  std::vector<std::string> entries_;
};

}  // namespace anholon
