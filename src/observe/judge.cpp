#include "observe/judge.h"

#include <algorithm>

#include "numeric/more_digits.h"

namespace anholon {

template <Number N>
void Judge<N>::look_beside(const Course<N>& course) {
  if (o_.estimate != ErrorEstimate::never)
    beside_.emplace(
        s_, course.taylor().parameters(),
        RowComparison(columns_after_time(s_, highest(course)), to_double(unit_roundoff<N>()), o_.tolerance.get_d()));
}

template <Number N>
void Judge<N>::row(const W& t, const std::string& label, const std::vector<W>& numbers, const Course<N>& course) {
  if (beside_) {
    beside_->outputs.see(course.point());
    beside_->comparison.see(difference(s_, to_double(t), numbers,
                                       row_values(s_, highest(course), course.point(), beside_->outputs),
                                       beside_->outputs));
  } else {
    keep(t, label, numbers, wanted(course));
  }
}

template <Number N>
void Judge<N>::row(const W& t, const std::string& label, const std::vector<double>& numbers, bool counts) {
  std::vector<W> wide;
  if (counts)
    for (const double x : numbers) wide.push_back(W(x));
  keep(t, label, wide, counts);
}

template <Number N>
void Judge<N>::keep(const W& t, const std::string& label, const std::vector<W>& numbers, bool counts) {
  if (counts)
    run_.rows.add(label.empty() ? convert<W>(convert<N>(t)) : t, numbers, resets_, label);
  else if (!run_.rows.empty())
    run_.rows.clear();
}

template <Number N>
void Judge<N>::events(const std::vector<Occurrence<W>>& occurrences) {
  for (const Occurrence<W>& o : occurrences) run_.events.push_back({o.event, o.t});
  if (std::any_of(occurrences.begin(), occurrences.end(), [](const Occurrence<W>& o) { return !o.changes.empty(); }))
    ++resets_;
}

// The rows of another integrator are judged by the motion beside it, other rows by a second run.
template <Number N>
void Judge<N>::estimate(const Course<N>& course, const std::vector<Expr>& quadratures, WaitingRows* waiting,
                        SimulationReport& report) {
  constexpr double kBeside = 2;  // because that motion has an error, too
  if (o_.estimate == ErrorEstimate::never) return;
  if (report.outcome.kind == OutcomeKind::not_a_number) {
    report.no_error = "a formula had no value where the motion ended";
  } else if (course.steps() == 0 || report.rows == 0) {
    report.no_error = "the run is too short";
  } else if (beside_) {
    report.error = beside_->comparison.report(kBeside, written_roundoff<N>(o_));
    report.error->means = course.report().steps > 0
                              ? "the motion by method " + std::string(name(course.report().last)) + " beside it"
                              : "Taylor's motion beside it";
  } else if (!wanted(course)) {
    report.no_error = "the run has more than " + std::to_string(kShortRun) + " steps: --error-estimate makes one";
  } else {
    if constexpr (std::same_as<N, double>)
      if (o_.kernel && course.taylor().stepper().accelerated() && course.report().steps == 0)
        run_.by_kernel = true, run_.motion = &course.taylor(), run_.quadratures = quadratures, run_.waiting = waiting;
    estimate_error<N>(s_, o_, run_, report);
  }
  if (!report.error || !report.error->lost) return;
  const ErrorReport& e = *report.error;
  std::string hint = "end the motion earlier";
  // More digits follow a motion that grows without bound a little further, in very many steps.
  if (report.outcome.kind != OutcomeKind::blow_up)
    hint += ", or take a smaller tolerance, " +
            std::string(has_many_digits<N>() ? "which more digits bring" : "with more digits where it is below 1e-15") +
            " (--digits " + std::to_string(more_digits<N>()) + ")";
  report.warnings.push_back({"no digit of " + e.lost_of + " can be trusted from t = " + number_text(*e.lost, 6) +
                                 " on: the error is as large as the motion",
                             hint});
}

template class Judge<double>;
template class Judge<long double>;
template class Judge<Quad>;
template class Judge<Multi>;

}  // namespace anholon
