// A motion as the studio shows it: the player and the plots, and the sections that tell how far it can be trusted.
#pragma once
#include <functional>
#include <string>

#include "anholon/motion.h"
#include "base/json.h"
#include "report/page/page_of.h"

namespace anholon {

class MotionOnPage {
 public:
  // `command`: makes a page of the motion again. REQUIRES: the run has rows.
  MotionOnPage(const v1::Run& run, const std::string& command);
  // The parts of the page, to which equations and proof can be added.
  PageInParts& parts() { return parts_; }
  // Writes "title", "sections" and "data".
  void write(JsonWriter& json) const;

 private:
  Workspace workspace_;
  PageInParts parts_;
};

// Returns a function that ends a motion after 4 s; the motion is then shown up to there.
std::function<bool()> end_of_motion();

// Returns the reason why a run without rows cannot be shown.
v1::Error without_rows(const v1::Run& run);

}  // namespace anholon
