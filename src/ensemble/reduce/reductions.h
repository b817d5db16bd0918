// What a sweep is asked to sum up of every motion: the extremes, the mean and the last value of a formula; how often an
// event fired, and when first.
#pragma once
#include <string>
#include <vector>

#include "modelfile/contacts.h"
#include "modelfile/read.h"

namespace anholon {

struct Reduction {
  enum class Kind : std::uint8_t { greatest, least, mean, last, count, first } kind = Kind::greatest;
  // The index: for a last value among the ends, for a count or a first time the event, otherwise the formula.
  std::size_t of = 0;
  std::string name;  // "max(height)", as it was written
  bool of_event() const { return kind == Kind::count || kind == Kind::first; }
};

struct Reductions {
  std::vector<Expr> formulas;       // formulas whose values along the motion are needed
  std::vector<Expr> ends;           // formulas whose last values are needed
  std::vector<std::string> events;  // their names in the report of a motion
  std::vector<Reduction> list;

  // Adds KIND(FORMULA), KIND one of max, min, mean, last; the formula is a monitor or any formula that a monitor may
  // be, without multipliers if contacts move. Or adds count(EVENT) or first(EVENT); the event is one of the model or of
  // a contact that moves. Builds in the graph of the model. Throws MistakeInWord.
  void add(const std::string& word, const OpenModel& model, const std::vector<Contact>& moving = {});
};

}  // namespace anholon
