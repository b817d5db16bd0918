// The rows of the segments of a motion with contacts, in the columns that all segments have.
#pragma once
#include "contact/mode/mode_model.h"
#include "observe/options.h"
#include "result/rows.h"

namespace anholon {

// The times of rows from the start of a motion in doubles to its end, the end included; empty if rows are due at every
// step.
std::vector<Rational> times_of_rows(const SimulationOptions& o, const Rational& start, const Rational& end);

class SegmentRows final : public RowSink {
 public:
  SegmentRows(RowSink& to, const std::vector<Contact>& contacts) : to_(to), contacts_(contacts) {}
  // Writes rows at these times alone, if there are any; the ends of segments are not rows.
  void only_at(const std::vector<Rational>& times);
  // `stopped`: the coordinates whose velocities and accelerations are 0 in the segment, and are written so; none if
  // empty.
  void begin_segment(std::vector<bool> stopped = {}) { places_.clear(), stopped_ = std::move(stopped), first_ = true; }
  // `whole`: false if the forces of its last row are not determined, as where a slip velocity has vanished. Then the
  // row is left out, because the next segment begins there.
  void end_segment(bool whole);
  // Writes a row of the last state of a motion that has ended before its last time.
  void end_early();

  void columns(const std::vector<RunColumn>& columns) override;
  void row(const Row& row) override;
  void step(double t) override { to_.step(t); }

  // The index of the first time of only_at() that has no row yet.
  std::size_t due() const { return due_; }
  // The state of the last row.
  void last_state(ContactState& state) const;
  std::size_t rows() const { return count_; }

 private:
  bool of_contact(const RunColumn& column) const;
  void write_held();

  RowSink& to_;
  const std::vector<Contact>& contacts_;
  std::vector<double> times_;
  std::size_t due_ = 0;
  std::vector<RunColumn> joint_;                    // the columns that are written
  std::vector<RunColumn> own_;                      // those of the segment
  std::vector<std::optional<std::size_t>> places_;  // for each joint column its place in the segment
  std::vector<bool> stopped_;
  std::vector<double> last_;
  std::optional<std::vector<double>> held_;  // the last row of the segment, until it is known whether it counts
  bool first_ = true;                        // it is the first row, too
  std::vector<double> untold_;               // the last row, if it is at none of the times
  std::size_t count_ = 0;
};

}  // namespace anholon
