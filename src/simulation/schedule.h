// The times of the rows of a run, in the direction of its motion.
#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "numeric/multiples.h"
#include "observe/options.h"

namespace anholon {

// Rows are due at the times that the user asks for; without such times, at the end of every step.
template <class W>
class RowSchedule {
 public:
  struct Due {
    W t;
    std::string label;  // the time as it was written; may be empty
  };

  RowSchedule() = default;
  // `given`: an earlier part of the run has written all rows up to this time.
  RowSchedule(const SimulationOptions& o, const W& start, std::optional<W> given = {})
      : start_(start), given_(std::move(given)) {
    for (const Rational& r : o.at) times_.push_back(from_rational<W>(r));
    labels_ = o.at_text;
    labels_.resize(times_.size());
    const W to = o.to ? from_rational<W>(*o.to) : times_.back();
    const bool backwards = !times_.empty() && !(times_.back() > start_) && (times_.front() < start_ || to < start_);
    if (backwards) {
      std::reverse(times_.begin(), times_.end());
      std::reverse(labels_.begin(), labels_.end());
    }
    end_ = times_.empty() || (backwards ? to < times_.back() : to > times_.back()) ? to : times_.back();
    forward_ = end_ > start_;
    if (o.every) evenly(*o.every, o.precision == Precision::real);
    every_step_ = times_.empty();
    while (given_ && due(*given_)) ++next_;
  }

  const W& start() const { return start_; }
  const W& end() const { return end_; }
  bool forward() const { return forward_; }
  bool every_step() const { return every_step_; }

  // True if a motion that has come to `stop` has reached t.
  bool reaches(const W& stop, const W& t) const { return forward_ ? t <= stop : t >= stop; }

  // due(): true if a row is due at a time up to `stop`. due_at(): true if the next row is due at t itself.
  bool due(const W& stop) const { return next_ < times_.size() && reaches(stop, times_[next_]); }
  // The time of the next row; nullptr if there is none.
  const W* next() const { return next_ < times_.size() ? &times_[next_] : nullptr; }
  bool due_at(const W& t) const { return next_ < times_.size() && times_[next_] == t; }
  Due take() {
    const std::size_t k = next_++;
    return {times_[k], k < labels_.size() ? labels_[k] : std::string()};
  }
  // The number of times left; 0 if a row is due at the end of every step.
  std::size_t left() const { return times_.size() - next_; }
  // True if the last row taken is that of t.
  bool took(const W& t) const { return next_ > 0 && times_[next_ - 1] == t; }

  // All rows up to this time are written; nullopt before the first one.
  const std::optional<W>& given() const { return given_; }
  void set_given(const W& t) { given_ = t; }

 private:
  // `in_doubles`: the rows have their times in doubles.
  void evenly(const Rational& every, bool in_doubles) {
    const Multiples<W> steps(end_ < start_ ? Rational(-every) : every);
    for (long k = 0;; ++k) {
      const W next = start_ + steps(k);
      if (end_ < start_ ? next < end_ : next > end_) break;
      times_.push_back(next);
    }
    // A multiple whose double is that of the end has no row of its own.
    while (in_doubles && times_.size() > 1 && times_.back() != end_ && to_double(times_.back()) == to_double(end_))
      times_.pop_back();
    if (times_.empty() || times_.back() != end_) times_.push_back(end_);
  }

  W start_{0}, end_{0};
  bool forward_ = true, every_step_ = false;
  std::vector<W> times_;
  std::vector<std::string> labels_;  // of the first times, which the user asked for one by one
  std::size_t next_ = 0;
  std::optional<W> given_;
};

}  // namespace anholon
