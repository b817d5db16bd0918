// Slips so slow that their friction makes the motion stiff (theory: contact, slow slips).
#pragma once
#include "contact/mode/mode_model.h"
#include "contact/touching_bodies.h"
#include "result/rows.h"

namespace anholon {

// The time for which the motion in the present modes is stiff; nullopt if it is not. `left`: the time to the end.
std::optional<long double> stiff_for(const TouchingBodies& bodies, long double left);

// Times from `from` to `to` that are close together at first.
std::vector<Rational> times_of_stretch(const Rational& from, const Rational& to);

// The rows of a stretch without events, kept until it is known how long its mode holds.
class StretchRows final : public RowSink {
 public:
  // `conditions`: ModeModel::conditions.
  explicit StretchRows(std::vector<int> conditions) : conditions_(std::move(conditions)) {}
  void columns(const std::vector<RunColumn>& columns) override;
  void row(const Row& row) override;

  // True if the conditions have held in all rows.
  bool held() const { return held_; }
  // The time of the last row before the first one that violates a condition; nullopt if that is the first row.
  std::optional<double> held_until() const;
  void pass_to(RowSink& sink) const;

 private:
  std::vector<int> conditions_;
  std::vector<RunColumn> columns_;         // without the conditions
  std::vector<bool> passed_;               // for each column of the stretch
  std::vector<std::vector<double>> rows_;  // as long as the conditions hold
  bool held_ = true;
};

}  // namespace anholon
