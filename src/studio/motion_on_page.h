// A motion as the studio shows it: the player and the plots, and how far it can be trusted.
#pragma once
#include <functional>
#include <string>

#include "anholon/motion.h"
#include "base/json.h"
#include "report/page/page_of.h"

namespace anholon {

class MotionOnPage {
 public:
  // `command` makes a page of the motion again. REQUIRES: the run has rows.
  MotionOnPage(const v1::Run& run, const std::string& command);
  // Equations and proof are added to these.
  PageInParts& parts() { return parts_; }
  // "title", "sections" and "data".
  void write(JsonWriter& json) const;

 private:
  Workspace workspace_;
  PageInParts parts_;
};

// Ends a motion after 4 s, which is then shown as far as it has come.
std::function<bool()> end_of_motion();

// Why a run without rows cannot be shown.
v1::Error without_rows(const v1::Run& run);

}  // namespace anholon
