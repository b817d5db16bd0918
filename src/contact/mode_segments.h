// The segments of a motion with contacts: in each segment, one mode is followed to its end.
#pragma once
#include <functional>

#include "contact/joined_report.h"
#include "contact/mode/ready_modes.h"
#include "contact/segment_rows.h"
#include "contact/touching_bodies.h"
#include "observe/options.h"

namespace anholon {

class ModeSegments {
 public:
  // All references have to outlive this object. `times`: of the rows; empty for rows at every step. `slips`: called
  // with the contact that slips at the end of a segment.
  ModeSegments(const Workspace& s, const SimulationOptions& options, TouchingBodies& bodies, JoinedReport& joined,
               RowSink& rows, std::vector<Rational> times, Rational end, std::function<void(std::size_t)> slips);

  // Follows the motion in the modes of the bodies to their end, but not beyond `to`; returns false if the motion ends
  // there. The bodies are then at the end of the segment, with what its events exclude.
  bool follow(const Rational& to, Outcome& outcome);
  // True if the modes last up to `to`; returns the state there. The motion itself does not go on.
  bool last_until(const Rational& to, ContactState& at);
  // Writes a row of the last state of a motion that has ended early.
  void end_early() { rows_.end_early(); }
  std::size_t rows() const { return rows_.rows(); }

 private:
  // Returns the mode at its consistent state; nullptr with an outcome if there is none.
  ReadyMode* begin(ModeEnds ends, Outcome& outcome);
  // Begins the mode and simulates it up to a time at most; returns nullptr, without a new report, if the mode does not
  // begin.
  ReadyMode* simulate_mode(const Rational& to, SimulationReport& report, Outcome& outcome);
  // The options of a segment up to a time: by Taylor's method, and by BDF.
  SimulationOptions asked(const Rational& to) const;
  SimulationOptions asked_of_stretch(const Rational& to, const Rational& tolerance) const;
  // Follows slow slips by BDF as long as the modes hold, but not beyond `to`. Returns true if the motion has advanced
  // in this way.
  bool by_bdf(const Rational& to);
  // True if BDF may go on where Taylor's method gave up; the number of tries is limited.
  bool may_be_stiff(const SimulationReport& r, const Rational& to);
  // True if the segment ended because the holding components of friction have become dependent: others may hold in
  // their place.
  bool may_hold_others(const SimulationReport& r) const;
  // True if the segment ended because its end is too many of its short steps away.
  bool gave_up(const SimulationReport& r) const;
  // True if the segment ended because a slip velocity with two components vanishes on a curved line, where it has no
  // Taylor series and the steps become short without end; the contact then sticks.
  bool slip_vanishes();
  // True if one of the events ends a slip with two components, whose direction there is round-off.
  bool direction_vanishes(const std::vector<EventReport>& events, const std::map<std::string, ModeEvent>& known) const;
  // True if the segment ended where a slip that has begun goes on unchanged, except for the formula of its direction.
  bool goes_on_slipping(const Rational& to) const;
  // Notes what the events of a segment exclude; returns true if one has changed the modes.
  // `length`: of the segment.
  bool note(const std::vector<EventReport>& events, const std::map<std::string, ModeEvent>& known, double length);
  void nothing_has_changed();

  const SimulationOptions& o_;
  bool looks_for_events_;  // events of the model itself
  bool has_supports_;      // there are constraints that look like floors, which may pull
  TouchingBodies& bodies_;
  JoinedReport& joined_;
  ReadyModes ready_;
  SegmentRows rows_;
  std::vector<Rational> times_;
  Rational end_;
  std::function<void(std::size_t)> slips_;
  std::optional<Rational> vanished_;  // the time at which a slip vanished last; it may vanish once at a time
  int retries_ = 0;                   // the number of times that BDF continued where Taylor's method gave up
  bool events_near_ = false;          // the last segment by BDF has come near the end of a mode
};

}  // namespace anholon
