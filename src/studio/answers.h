// The studio's computations from a text: check, derive, simulate, prove. Each answer is a text of JSON (doc/json.md).
#pragma once
#include <memory>
#include <string>

#include "studio/worker.h"

namespace anholon {

// Keeps the model and the motion of the last text, so that equations and proof of a text with a motion do not read it
// again.
class Answers {
 public:
  Answers();
  ~Answers();
  std::string answer(const Question& question);

 private:
  class Desk;
  std::unique_ptr<Desk> desk_;
};

// The sections, keys and functions of the model language, for completion.
std::string language_json();

}  // namespace anholon
