// Joins the reports of the segments of a motion with contacts.
#pragma once
#include "contact/mode/mode_model.h"
#include "observe/report.h"

namespace anholon {

class JoinedReport {
 public:
  JoinedReport(const Model& model, const std::vector<Contact>& contacts);
  // Adds the report of a segment; `contacts`: its events that change a mode. Returns false if an event of the model
  // ends the motion.
  bool add(const SimulationReport& segment, const std::map<std::string, ModeEvent>& contacts);
  // Adds a segment by BDF that begins at t.
  void by_bdf(double t, SimulationReport segment);
  // Adds velocities that an impact has set to the event of this name, or else to the last event of that instant; an
  // impact at the start has no event, and becomes one of this name.
  void set(double t, const std::vector<EventReport::Change>& changes, const std::string& without_event);
  void event(const std::string& name, double t);
  // has(): true if the last event of this name is at that time. event_once(): adds the event unless it is there.
  bool has(const std::string& name, double t) const;
  void event_once(const std::string& name, double t);
  // Removes the last event of this name, because it has changed nothing.
  void take_back(const std::string& name);
  // Gives the last event of this name another name.
  void rename(const std::string& name, const std::string& other);
  std::size_t segments() const { return segments_; }
  std::size_t steps() const { return segments_ > 0 ? all_.steps : 0; }
  // Returns the report. The events of contacts at one instant are in the order of their causes: impacts, other changes
  // of mode, then gaps that have come to rest. The outcome and the warnings use the names that a user knows.
  SimulationReport report(Outcome outcome, double t, std::size_t rows);

 private:
  void order_events();
  std::optional<int> rank(const EventReport& e) const;

  SimulationReport all_;
  std::vector<std::string> contacts_;
  std::vector<std::string> floors_;  // the segments' notes of constraints that pull
  std::size_t segments_ = 0;
  double power_miss_ = 0;  // the largest miss of a segment, in units of energy
};

}  // namespace anholon
