#include "contact/segment_rows.h"

#include <algorithm>
#include <limits>

#include "numeric/number.h"

namespace anholon {

std::vector<Rational> times_of_rows(const SimulationOptions& o, const Rational& start, const Rational& end) {
  std::vector<Rational> times = o.at;
  if (o.every) {
    for (Rational t = start; t < end; t += *o.every) times.push_back(t);
    // Like in RowSchedule, a multiple whose number is that of the end has no row of its own.
    const double last = from_rational<double>(end);
    while (times.size() > 1 && from_rational<double>(times.back()) == last) times.pop_back();
  }
  if (!times.empty() && times.back() != end) times.push_back(end);
  return times;
}

void SegmentRows::only_at(const std::vector<Rational>& times) {
  for (const Rational& t : times) times_.push_back(from_rational<double>(t));
}

// True for columns of the forces and constraints of a contact, which differ from mode to mode; its monitors do not.
bool SegmentRows::of_contact(const RunColumn& column) const {
  return column.kind != ColumnKind::monitor && std::any_of(contacts_.begin(), contacts_.end(), [&](const Contact& c) {
           const std::string prefix = c.name + ".";
           return column.name.rfind(prefix, 0) == 0 || column.name.rfind("lambda." + prefix, 0) == 0 ||
                  (c.held && column.name == "lambda." + c.name);
         });
}

void SegmentRows::columns(const std::vector<RunColumn>& columns) {
  own_ = columns;
  if (joint_.empty()) {
    for (const RunColumn& c : columns)
      if (!of_contact(c)) joint_.push_back(c);
    to_.columns(joint_);
  }
  places_.clear();
  for (const RunColumn& j : joint_) {
    const auto it = std::find_if(columns.begin(), columns.end(), [&](const RunColumn& c) { return c.name == j.name; });
    places_.push_back(it == columns.end() ? std::nullopt
                                          : std::optional(static_cast<std::size_t>(it - columns.begin())));
  }
}

void SegmentRows::row(const Row& row) {
  last_.assign(row.values.begin(), row.values.end());
  // Velocities and accelerations of stopped coordinates are the round-off of the projection.
  for (std::size_t k = 0; k < own_.size() && !stopped_.empty(); ++k)
    if ((own_[k].kind == ColumnKind::velocity || own_[k].kind == ColumnKind::acceleration) && stopped_[own_[k].index])
      last_[k] = 0;
  std::vector<double> values;
  for (const auto& place : places_) values.push_back(place ? last_[*place] : std::numeric_limits<double>::quiet_NaN());
  if (times_.empty()) {
    first_ = first_ && !held_;
    write_held();
    held_ = std::move(values);
    return;
  }
  const double t = row.values[0];
  while (due_ < times_.size() && times_[due_] < t) ++due_;
  untold_.clear();
  if (due_ == times_.size() || times_[due_] != t) {
    // The end of a segment may be a requested row; it is not written twice.
    if (due_ == 0 || times_[due_ - 1] != t) untold_ = std::move(values);
    return;
  }
  ++due_;
  to_.row({values, {}});
  ++count_;
}

void SegmentRows::end_early() {
  if (untold_.empty()) return;
  to_.row({untold_, {}});
  untold_.clear();
  ++count_;
}

void SegmentRows::end_segment(bool whole) {
  if (whole || first_)
    write_held();
  else
    held_.reset();
}

void SegmentRows::write_held() {
  if (!held_) return;
  to_.row({*held_, {}});
  held_.reset();
  ++count_;
}

void SegmentRows::last_state(ContactState& state) const {
  if (last_.empty()) return;
  for (std::size_t k = 0; k < own_.size(); ++k) {
    const RunColumn& c = own_[k];
    if (c.kind == ColumnKind::time) state.t = Rational(last_[k]);
    if (c.kind == ColumnKind::coordinate) state.q[c.index] = last_[k];
    if (c.kind == ColumnKind::velocity) state.qd[c.index] = last_[k];
    if (c.kind == ColumnKind::state && c.order == 0) state.states[c.index] = last_[k];
  }
}

}  // namespace anholon
