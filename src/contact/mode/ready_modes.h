// The modes of one motion with contacts, each derived once: when a mode begins again, only its numbers differ.
#pragma once
#include <map>
#include <memory>

#include "contact/mode/mode_model.h"
#include "setup/scenario.h"
#include "simulation/simulate.h"

namespace anholon {

struct ReadyMode {
  ModeModel of;
  std::unique_ptr<Workspace> own;
  SimulationPlans plans;  // of the last segment in this mode
};

class ReadyModes {
 public:
  // `s`: the model with all contacts open. Both arguments outlive the modes.
  ReadyModes(const Workspace& s, const std::vector<Contact>& contacts) : s_(s), contacts_(contacts) {}
  // Returns the mode at its consistent state near `at`. The outcome fails if there is none.
  ReadyMode& begin(const ContactModes& modes, const ContactState& at, Outcome& outcome,
                   ModeEnds ends = ModeEnds::events);

 private:
  Outcome derive(const ContactModes& modes, ModeEnds ends, const std::vector<Rational>& numbers, ReadyMode& mode) const;

  ReadyMode nothing_;  // returned if a mode does not begin
  const Workspace& s_;
  const std::vector<Contact>& contacts_;
  std::map<std::pair<ModeEnds, std::vector<int>>, ReadyMode> known_;  // by their shapes and the sides of borders
};

}  // namespace anholon
