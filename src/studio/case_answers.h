// The studio's computations from a sweep in a folder: its map, and the motion of a case. Each answer is a text of JSON
// (doc/json.md).
#pragma once
#include <functional>
#include <string>

#include "studio/worker.h"

namespace anholon {

// Makes the data of the map of the sweep in a folder, as JSON. Throws Failure without a place.
using MapOfSweep = std::function<std::string(const std::string& folder)>;

class CaseAnswers {
 public:
  explicit CaseAnswers(MapOfSweep map) : map_(std::move(map)) {}
  static bool knows(const Question& question) { return question.command == "sweep" || question.command == "case"; }
  // Answers "sweep" by the map, and "case" by the motion of the case whose number is the text. `path` is the folder.
  std::string answer(const Question& question) const;

 private:
  MapOfSweep map_;
};

}  // namespace anholon
