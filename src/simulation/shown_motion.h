// The motion whose rows are written: that of the course, or that of another integrator beside it.
#pragma once
#include <memory>

#include "motion/course.h"
#include "observe/second_opinion.h"

namespace anholon {

template <Number N>
class ShownMotion {
 public:
  using W = Wider<N>;
  explicit ShownMotion(Course<N>& course) : course_(course) {}

  // Shows the motion of another integrator, which computes in doubles.
  void show(std::unique_ptr<SecondMotion> second) { second_ = std::move(second); }
  // The other integrator; nullptr if the motion of the course is shown.
  const SecondMotion* second() const { return second_.get(); }

  // Goes to time t; then `point` and `work` belong to that time.
  Outcome at(const W& t) {
    Outcome o = course_.at(t);
    if constexpr (std::same_as<N, double>)
      if (o.ok() && second_) o = second_->at(t, course_.point());
    return o;
  }
  const Expansion<W>& point() const {
    if constexpr (std::same_as<N, double>)
      if (second_) return second_->point();
    return course_.point();
  }
  // The work of the forces since the start.
  const W& work() const {
    if constexpr (std::same_as<N, double>)
      if (second_) return second_->work();
    return course_.integrals()[0];
  }

 private:
  Course<N>& course_;
  std::unique_ptr<SecondMotion> second_;
};

}  // namespace anholon
