// Keeps what the error estimate of a run needs: rows and times of events, or the comparison with the motion beside it.
#pragma once
#include "motion/course.h"
#include "observe/estimate.h"

namespace anholon {

template <Number N>
class Judge {
 public:
  using W = Wider<N>;

  Judge(Workspace& scenario, const SimulationOptions& options) : s_(scenario), o_(options) {}

  // Notes that the run continues from here; earlier effects of events are not known.
  void goes_on_from(const W& t) { run_.since = t; }

  // Notes that the rows are those of another integrator; they are compared with the motion beside it.
  void look_beside(const Course<N>& course);
  // Takes a row, at the time that is written, after so many steps of the course.
  void row(const W& t, const std::string& label, const std::vector<W>& numbers, const Course<N>& course);
  // Takes a row in doubles. `counts`: the run was short enough for an estimate (wanted) when it came to the row.
  void row(const W& t, const std::string& label, const std::vector<double>& numbers, bool counts);
  // True if an estimate is made if the run ends here.
  bool wanted(const Course<N>& course) const {
    return o_.estimate == ErrorEstimate::always ||
           (o_.estimate == ErrorEstimate::short_runs && course.steps() <= kShortRun);
  }
  // Takes the events of one moment.
  void events(const std::vector<Occurrence<W>>& occurrences);
  // Fills `error` or `no_error` of a run that has ended. `quadratures`: the formulas integrated along the run;
  // `waiting`: the object that computed its rows, or nullptr.
  void estimate(const Course<N>& course, const std::vector<Expr>& quadratures, WaitingRows* waiting,
                SimulationReport& report);

 private:
  void keep(const W& t, const std::string& label, const std::vector<W>& numbers, bool counts);
  int highest(const Course<N>& course) const { return largest_order(s_, course.taylor().program().d); }

  Workspace& s_;
  const SimulationOptions& o_;
  RunToJudge<W> run_;
  std::size_t resets_ = 0;  // the number of times that events have changed the state
  struct Beside {
    Beside(Workspace& s, const std::vector<W>& parameters, RowComparison c)
        : outputs(s, parameters), comparison(std::move(c)) {}
    RowOutputs<W> outputs;
    RowComparison comparison;
  };
  std::optional<Beside> beside_;
};

extern template class Judge<double>;
extern template class Judge<long double>;
extern template class Judge<Quad>;
extern template class Judge<Multi>;

}  // namespace anholon
