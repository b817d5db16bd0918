// The segments of a motion with contacts: in each, one mode is followed to its end.
#pragma once
#include <functional>

#include "contact/joined_report.h"
#include "contact/ready_modes.h"
#include "contact/segment_rows.h"
#include "contact/touching_bodies.h"
#include "observe/options.h"

namespace anholon {

class ModeSegments {
 public:
  // Refers to all of them. `times`: of the rows, none for rows at every step. `slips`: told which contact slips where a
  // segment ends.
  ModeSegments(const Workspace& s, const SimulationOptions& options, TouchingBodies& bodies, JoinedReport& joined,
               RowSink& rows, std::vector<Rational> times, Rational end, std::function<void(std::size_t)> slips);

  // Follows the motion in the modes of the bodies to their end, but not beyond `to`; returns false if it ends there. The bodies
  // are then at the end of the segment, with what its events exclude.
  bool follow(const Rational& to, Outcome& outcome);
  // Whether the modes last up to `to`, with the state there: the motion itself does not go on.
  bool last_until(const Rational& to, ContactState& at);
  // The motion has ended before its end: its last state gets a row.
  void end_early() { rows_.end_early(); }
  std::size_t rows() const { return rows_.rows(); }

 private:
  // The mode, at its consistent state; nullptr with an outcome if there is none.
  ReadyMode* begin(ModeEnds ends, Outcome& outcome);
  // Begins the mode and simulates it up to a time at most; nullptr, and no new report, if it does not begin.
  ReadyMode* simulate_mode(const Rational& to, SimulationReport& report, Outcome& outcome);
  // What is asked of a segment up to a time, by Taylor's method, and of one by BDF.
  SimulationOptions asked(const Rational& to) const;
  SimulationOptions asked_of_stretch(const Rational& to, const Rational& tolerance) const;
  // Follows slips that are slow by BDF as long as the modes hold, but not beyond `to`. Returns whether the motion has come
  // further so.
  bool by_bdf(const Rational& to);
  // Whether BDF may go on where Taylor's method gave up, which is not tried without end.
  bool may_be_stiff(const SimulationReport& r, const Rational& to);
  // Whether the segment ended because components of friction that hold have become dependent: others may hold in their place.
  bool may_hold_others(const SimulationReport& r) const;
  // Whether the segment ended because its end lies too many of its short steps ahead.
  bool gave_up(const SimulationReport& r) const;
  // A slip velocity with two components that vanishes on a curved line has no Taylor series there, and the steps become
  // short without end. Returns whether that is how the segment ended; the contact then sticks.
  bool slip_vanishes();
  // Whether one of the events ends a slip with two components, whose direction round-off tells there.
  bool direction_vanishes(const std::vector<EventReport>& events, const std::map<std::string, ModeEvent>& known) const;
  // Whether the segment ended where a slip that has begun goes on as it was, up to the way its direction is written.
  bool goes_on_slipping(const Rational& to) const;
  // Notes what the events of a segment exclude; returns whether one has changed the modes.
  bool note(const std::vector<EventReport>& events, const std::map<std::string, ModeEvent>& known);
  void nothing_has_changed();

  const SimulationOptions& o_;
  bool looks_for_events_;  // those of the model itself
  bool has_supports_;      // constraints that look like floors, which may pull
  TouchingBodies& bodies_;
  JoinedReport& joined_;
  ReadyModes ready_;
  SegmentRows rows_;
  std::vector<Rational> times_;
  Rational end_;
  std::function<void(std::size_t)> slips_;
  std::optional<Rational> vanished_;  // when a slip vanished last, which it does once at a time
  int retries_ = 0;                   // how often BDF went on where Taylor's method gave up
  bool events_near_ = false;          // the last segment by BDF has come near the end of a mode
};

}  // namespace anholon
