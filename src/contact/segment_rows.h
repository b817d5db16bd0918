// The rows of the segments of a motion with contacts, in the columns that all segments have.
#pragma once
#include "contact/mode_model.h"
#include "observe/options.h"
#include "result/rows.h"

namespace anholon {

// The times of rows from the start of a motion in doubles to its end, with the end; none if rows are due at every step.
std::vector<Rational> times_of_rows(const SimulationOptions& o, const Rational& start, const Rational& end);

class SegmentRows final : public RowSink {
 public:
  SegmentRows(RowSink& to, const std::vector<Contact>& contacts) : to_(to), contacts_(contacts) {}
  // Rows at these times alone, if there are any; the ends of segments are no rows.
  void only_at(const std::vector<Rational>& times);
  // stopped: coordinates whose velocities and accelerations are 0 in the segment, and are written so; none if it is empty.
  void begin_segment(std::vector<bool> stopped = {}) { places_.clear(), stopped_ = std::move(stopped), first_ = true; }
  // Not whole: the forces of its last row are not determined, as where a slip velocity has vanished, and the row is
  // left out, as the next segment begins there.
  void end_segment(bool whole);
  // The motion has ended before its last time: its last state is worth a row of its own.
  void end_early();

  void columns(const std::vector<RunColumn>& columns) override;
  void row(const Row& row) override;
  void step(double t) override { to_.step(t); }

  // Of the times of only_at(), the first that has no row yet.
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
  std::vector<std::optional<std::size_t>> places_;  // of each joint column among those of the segment
  std::vector<bool> stopped_;
  std::vector<double> last_;
  std::optional<std::vector<double>> held_;  // the last row of the segment, until it is known whether it counts
  bool first_ = true;                        // it is the first one, too
  std::vector<double> untold_;               // the last row if it is at none of the times
  std::size_t count_ = 0;
};

}  // namespace anholon
