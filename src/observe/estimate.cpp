#include "observe/estimate.h"

#include <algorithm>
#include <cmath>

#include "observe/rows/quad_row.h"
#include "observe/watch.h"

namespace anholon {

namespace {

// The error between the compared rows may be somewhat larger, and the sharper run has an error of its own.
constexpr double kSafety = 2;
constexpr int kSharper = 100;
constexpr std::size_t kMostTimesLonger = 10;
constexpr int kMoreDigits = 10;
// Errors that two runs in long double have in common are sought at so many rows; their accumulation, in motions of so
// few steps.
constexpr std::size_t kMostInQuad = 16, kFewSteps = 32;

// The sharper run, in numbers M, of a motion computed in numbers N.
template <Number M, Number N>
class SharperRun {
 public:
  using W = Wider<M>;
  using V = Wider<N>;

  SharperRun(Workspace& s, const SimulationOptions& o, const StepSettings& settings, RunToJudge<V>& run)
      : s_(s), o_(o), motion_(s, settings, run.quadratures, orders_of_rows(s)), outputs_(s, motion_.parameters()),
        tolerance_(std::exp(settings.log_tolerance)), run_(run), rows_(run.rows.take()) {
    for (const SampledRow<V>& r : rows_) times_.push_back(time_of(r));
    compared_.resize(rows_.size());
  }

  // Follows the motion to the last row, or as far as it goes.
  Outcome go() {
    // Two runs in one type of numbers would round their start alike, and the lost digits would grow alike.
    motion_.start_in_other_digits(std::same_as<W, V>);
    if constexpr (std::same_as<M, double>)
      if (const std::optional<MotionPlans> known = known_plans()) motion_.use(*known);
    if (Outcome o = motion_.start(o_.state); !o.ok()) return o;
    t0_ = motion_.stepper().time();
    end_ = times_.back();
    forward_ = end_ > t0_;
    if constexpr (std::same_as<M, double>)
      if (motion_.stepper().accelerated()) {
        waiting_.rows = run_.waiting ? run_.waiting : rows_of_plans();
        if (waiting_.rows) waiting_.rows->set_parameters(motion_.parameters());
        if (waiting_.rows) waiting_.block.emplace(waiting_.rows->lanes());
      }
    const Outcome o = follow();
    const Outcome last = compare_waiting();
    if constexpr (std::same_as<M, double>)
      if (!run_.motion && motion_.plans().plan) plans().motion = motion_.plans();
    return o.ok() ? last : o;
  }

  Outcome follow() {
    for (;;) {
      if (Outcome o = rows_of_step(); !o.ok()) return o;
      bool goes_on = true;
      if (motion_.fired())
        if (Outcome o = settle(goes_on); !o.ok()) return o;
      if (!goes_on || done()) return {};
      const std::size_t kinks = motion_.stepper().kinks();
      stretch_.begin(false, next_ < times_.size() ? &times_[next_] : nullptr);
      if (Outcome o = motion_.steps(end_, stretch_); !o.ok()) return o;
      kink_.before = stretch_.times.size() == 1 && kink_.here;
      kink_.here = motion_.stepper().kinks() != kinks;
      if (o_.progress) o_.progress(to_double(motion_.stepper().time()), motion_.stepper().steps());
    }
  }

  // Returns the comparison of the rows up to where the run came.
  RowComparison comparison(double roundoff) {
    RowComparison c(kept(columns_after_time(s_, highest())), roundoff, o_.tolerance.get_d());
    for (std::optional<RowComparison::Row>& row : compared_)
      if (row) c.see(std::move(*row));
    if (lost_) c.lose(to_double(*lost_));
    for (std::size_t i = 0; i < s_.model->events.size(); ++i) {
      std::size_t mine = 0;
      for (const EventMoment<V>& e : run_.events) {
        if (e.event != i) continue;
        while (mine < met_.size() && met_[mine].event != i) ++mine;
        if (mine == met_.size()) break;
        c.event(s_.model->events[i].name, to_double(e.t), to_double(W(abs(W(convert<W>(e.t) - met_[mine++].t)))));
      }
    }
    return c;
  }
  std::optional<double> last_compared() const {
    for (std::size_t i = compared_.size(); i-- > 0;)
      if (compared_[i]) return to_double(rows_[i].t);
    return std::nullopt;
  }
  bool whole() const { return lost_ || (!compared_.empty() && compared_.back()); }

 private:
  typename RunToJudge<V>::Plans& plans() { return run_.plans ? *run_.plans : own_plans_; }
  std::optional<MotionPlans> known_plans()
    requires std::same_as<M, double>
  {
    if (run_.motion) return run_.motion->plans();
    return plans().motion.plan ? std::optional(plans().motion) : std::nullopt;
  }
  WaitingRows* rows_of_plans()
    requires std::same_as<M, double>
  {
    std::unique_ptr<WaitingRows>& rows = plans().rows;
    if (rows)
      rows->set_end(to_double(end_));
    else
      rows =
          WaitingRows::make(s_, {}, orders_of_rows(s_), motion_.parameters(), motion_.start_state(), to_double(end_));
    return rows.get();
  }

  int highest() const { return largest_order(s_, motion_.program().d); }
  static int orders_of_rows(const Scenario& s) {
    Column monitors;
    for (const Monitor& m : s.model->monitors) monitors.push_back(m.value);
    return std::max(orders_beyond(s, s.structure.d), orders_needed(s, monitors));
  }

  // The time as the user wrote it, if these numbers can represent it.
  static W time_of(const SampledRow<V>& r) {
    if (const auto t = r.label.empty() ? std::nullopt : parse_rational(r.label)) return from_rational<W>(*t);
    return convert<W>(r.t);
  }
  std::size_t resets_before(std::size_t row) const {
    return run_.knows_resets ? uncounted_ + rows_[row].resets : resets_;
  }

  // Returns the columns of a row that the run has.
  template <class T>
  std::vector<T> kept(std::vector<T> all) const {
    if (run_.columns.empty()) return all;
    std::vector<T> some;
    for (std::size_t j : run_.columns) some.push_back(std::move(all[j]));
    return some;
  }

  bool passed(const W& t) const { return forward_ ? !(t > motion_.stepper().time()) : !(t < motion_.stepper().time()); }
  W last_step() const { return abs(W(motion_.stepper().time() - motion_.stepper().before())); }
  W from_now(std::size_t row) const { return abs(W(times_[row] - motion_.stepper().time())); }

  // Compares the rows in the last step. If a kink ends the step, the kink of the other run may lie on the other side of
  // a row: such a row is compared with the motions before and after the kink, and the smaller difference counts.
  Outcome rows_of_step() {
    constexpr double kAboutAKink = 1e-3;
    const std::size_t first = next_;
    for (; next_ < rows_.size() && resets_before(next_) <= resets_ && passed(times_[next_]); ++next_)
      if (Outcome o = compare(next_); !o.ok()) return o;
    const W about = W(kAboutAKink) * last_step();
    if (kink_.before)
      for (std::size_t i = first; i-- > 0 && abs(W(times_[i] - motion_.stepper().before())) < about;) compare(i);
    if (kink_.here)
      for (std::size_t i = next_; i < rows_.size() && resets_before(i) == resets_ && from_now(i) < about; ++i)
        compare(i);
    return {};
  }

  // Applies events. The other run may have met an event somewhat sooner or later, so rows are compared on the side of
  // the event on which they were computed.
  Outcome settle(bool& goes_on) {
    const W within = last_step();
    std::vector<Occurrence<W>> occurrences;
    // All rows of a continued run come after its earlier events.
    const bool counted = !run_.since || (forward_ ? motion_.stepper().time() > convert<W>(*run_.since)
                                                  : motion_.stepper().time() < convert<W>(*run_.since));
    for (; counted && next_ < rows_.size() && is_before_events(next_) && from_now(next_) < within; ++next_)
      if (Outcome o = compare(next_); !o.ok()) return o;
    if (Outcome o = compare_waiting(); !o.ok()) return o;
    const Outcome o = motion_.settle(occurrences, goes_on);
    bool set = false;
    for (const Occurrence<W>& each : occurrences) {
      if (counted) met_.push_back({each.event, each.t});
      set = set || !each.changes.empty();
    }
    if (!o.ok()) return o;
    if (set) {
      ++resets_;
      if (!counted) ++uncounted_;
      outputs_.set_parameters(motion_.parameters());
      if constexpr (std::same_as<M, double>)
        if (waiting_.rows) waiting_.rows->set_parameters(motion_.parameters());
      kink_ = {};
      for (; next_ < rows_.size() && resets_before(next_) < resets_; ++next_) lose(next_);
    }
    for (; next_ < rows_.size() && resets_before(next_) == resets_ && (set || !goes_on) &&
           (passed(times_[next_]) || !goes_on) && from_now(next_) < within;
         ++next_)
      if (Outcome at = compare(next_); !at.ok()) return at;
    // Events at one moment may come in another order.
    if (!goes_on && next_ < rows_.size() && from_now(next_) > later()) lose(next_);
    return {};
  }

  // True if the run has computed a row near the events of the last step before them: no row comes after events that end
  // the motion.
  bool is_before_events(std::size_t row) const {
    if (!run_.knows_resets) return any_fired([](const Event& e) { return e.stop; });
    return resets_before(row) == resets_ && any_fired([](const Event& e) { return !e.set.empty(); });
  }

  template <class Is>
  bool any_fired(const Is& is) const {
    for (const auto& f : motion_.stepper().fired())
      if (f.series < s_.model->events.size() && is(s_.model->events[f.series])) return true;
    return false;
  }

  // True if no further row can be compared. If a row comes after an event that has not happened yet, the run goes on a
  // little further.
  bool done() {
    if (lost_) return true;
    const bool at_end = motion_.stepper().time() == end_;
    const auto before_end = [&](const EventMoment<V>& e) {
      return forward_ ? !(convert<W>(e.t) > times_.back()) : !(convert<W>(e.t) < times_.back());
    };
    const auto expected = static_cast<std::size_t>(std::count_if(run_.events.begin(), run_.events.end(), before_end));
    if (!at_end || (next_ == rows_.size() && met_.size() >= expected)) return at_end;
    if (extended_) {
      lose(std::min(next_, rows_.size() - 1));
      return true;
    }
    extended_ = true;
    end_ += forward_ ? later() : W(-later());
    return false;
  }

  // The times of an event may differ by this much.
  W later() const { return abs(W(times_.back() - t0_)) * W(1e-6); }

  void lose(std::size_t row) {
    if (!lost_) lost_ = rows_[row].t;
  }

  Outcome compare(std::size_t i) {
    const W t = times_[i];
    if constexpr (std::same_as<M, double>)
      if (waiting_.rows && motion_.stepper().steps() > 0 && !motion_.stepper().one_sided()) {
        waiting_.block->add(motion_, t, {});
        waiting_.foretold.push_back(foretold(i));
        return waiting_.block->full() ? compare_waiting() : Outcome{};
      }
    const Outcome at = motion_.at(t);
    if (!at.ok()) return at;
    Foretold f = foretold(i);
    if (wanted_in_quad(i) && solved_in_quad()) {
      f.lost = lost_on_the_way(i);
      f.in_quad = !run_.waiting;  // otherwise a kernel in doubles has made the row
    }
    compare_with_point(f);
    return at;
  }

  // The leading derivatives of the coordinates at a row, by the polynomials of a step; and the length of the step, or 0
  // if the row is not inside of a step that ends at its horizon.
  struct Foretold {
    std::size_t row;
    std::vector<W> leading;
    double step;
    std::vector<double> lost = {};  // the errors of each column that both runs have in common on their way
    bool in_quad = false;           // the row is computed in quadruple precision
  };
  Foretold foretold(std::size_t i) const {
    return {i, leading_of_polynomials(times_[i]), inside_step(times_[i]) ? to_double(last_step()) : 0};
  }

  Outcome compare_waiting() {
    Outcome o;
    if constexpr (std::same_as<M, double>)
      if (waiting_.rows) {
        std::size_t next = 0;
        waiting_.rows->compute(*waiting_.block, [&](const WaitingRows::Computed& row) {
          const Foretold& foretold = waiting_.foretold[next++];
          if (row.good())
            compare(foretold, row, row);
          else if (o = motion_.settle_at(row.place()); o.ok())
            compare_with_point(foretold);
          return o.ok();
        });
        waiting_.foretold.clear();
      }
    return o;
  }

  void compare_with_point(const Foretold& foretold) {
    outputs_.see(motion_.point());
    compare(foretold, motion_.point(), outputs_);
  }

  template <class Point, class Outputs>
  void compare(const Foretold& foretold, const Point& here, const Outputs& outputs) {
    const std::size_t i = foretold.row;
    std::vector<W> run, sharper;
    for (const V& v : rows_[i].values) run.push_back(convert<W>(v));
    row_values(s_, highest(), here, outputs, sharper);
    if constexpr (std::same_as<W, long double>)
      if (foretold.in_quad) quad_->values(sharper);
    std::vector<double> missed = missed_at(foretold, here);
    for (std::size_t j = 0; j < foretold.lost.size(); ++j) missed[j] += foretold.lost[j];
    missed = kept(std::move(missed));
    RowComparison::Row row = difference(s_, to_double(times_[i]), run, kept(std::move(sharper)), outputs);
    for (std::size_t j = 0; j < row.differences.size(); ++j) row.differences[j] += missed[j];
    if (!compared_[i] || weight(row) < weight(*compared_[i])) compared_[i] = std::move(row);
  }

  // Computes a row in quadruple precision, for a second run in long double of a motion in double. Rows beside kinks and
  // events are left out. REQUIRES: the motion has been taken to the row.
  bool solved_in_quad() {
    if constexpr (std::same_as<M, long double> && std::same_as<N, double>) {
      if (!quad_) quad_.emplace(s_, highest(), orders_of_rows(s_));
      return quad_->solve(motion_.point());
    } else {
      return false;
    }
  }
  bool wanted_in_quad(std::size_t i) const {
    const std::size_t stride = (rows_.size() + kMostInQuad - 1) / kMostInQuad;
    return std::same_as<M, long double> && std::same_as<N, double> && inside_step(times_[i]) &&
           (rows_.size() - 1 - i) % stride == 0;
  }

  // Returns the errors of the columns if the leading derivatives of both runs have the same error all along, which is
  // possible in few steps.
  std::vector<double> lost_on_the_way(std::size_t i) const {
    if (motion_.stepper().steps() > kFewSteps) return {};
    const double time = to_double(abs(W(times_[i] - t0_)));
    const std::vector<double>& errors = quad_->leading_differences();
    const std::size_t n = s_.system.coordinates, mechanical = s_.system.mechanical();
    const std::vector<RunColumn> columns = columns_after_time(s_, highest());
    std::vector<double> lost(columns.size(), 0.0);
    for (std::size_t a = 0; a < n; ++a) {
      double error = errors[a];
      for (int k = motion_.program().d[a] - 1, order = 1; k >= 0; --k, ++order)
        lost[static_cast<std::size_t>(k) * n + a] = error *= time / order;
    }
    for (std::size_t j = 0; j < columns.size(); ++j)
      if (columns[j].kind == ColumnKind::state) lost[j] = errors[mechanical + columns[j].index] * time;
    return lost;
  }

  // Returns the errors from sudden changes that both runs may have stepped over: if the polynomial of the step misses
  // the equations at a row by far more than the tolerance, the state misses by this difference times the step. Kinks
  // and events cause jumps at the ends of a step, so such steps do not count.
  template <class Point>
  std::vector<double> missed_at(const Foretold& foretold, const Point& here) {
    constexpr double kFarMore = 1e4;
    const std::size_t n = s_.system.coordinates;
    std::vector<double> missed(columns_after_time(s_, highest()).size(), 0.0);
    const double h = foretold.step;
    if (h == 0) return missed;
    for (std::size_t a = 0; a < n; ++a) {
      const int d = motion_.program().d[a];
      if (d == 0) continue;
      const W leading = W(here.derivative(a, d));
      const double by = to_double(W(abs(W(foretold.leading[a] - leading)))) * h,
                   size = std::max(1.0, std::abs(to_double(W(here.derivative(a, d - 1)))));
      if (!(by > kFarMore * tolerance_ * size)) continue;
      missed[static_cast<std::size_t>(d - 1) * n + a] = by;
      if (d > 1) missed[static_cast<std::size_t>(d - 2) * n + a] = by * h;
    }
    return missed;
  }

  bool inside_step(const W& t) const {
    const Stepper<M>& stepper = motion_.stepper();
    if (kink_.here || kink_.before || motion_.fired()) return false;
    return forward_ ? t > stepper.before() && !(t > stepper.time()) : t < stepper.before() && !(t < stepper.time());
  }

  // The leading derivatives of the coordinates, by the last step's polynomials.
  std::vector<W> leading_of_polynomials(const W& t) const {
    std::vector<W> list;
    for (std::size_t a = 0; a < s_.system.coordinates; ++a) list.push_back(leading_of_polynomial(a, t));
    return list;
  }
  W leading_of_polynomial(std::size_t j, const W& t) const {
    const Stepper<M>& stepper = motion_.stepper();
    const int d = motion_.program().d[j];
    const W dt = t - stepper.before();
    W sum(0);
    for (int k = stepper.degree(j); k >= d; --k) {
      W factor(1);
      for (int i = 0; i < d; ++i) factor *= W(k - i);
      sum = sum * dt + factor * convert<W>(stepper.coefficient(j, k));
    }
    return sum;
  }

  static double weight(const RowComparison::Row& row) {
    double w = 0;
    for (std::size_t j = 0; j < row.differences.size(); ++j)
      if (row.differences[j] > 0) w += row.differences[j] / (row.differences[j] + row.magnitudes[j]);
    return w;
  }

  Workspace& s_;
  const SimulationOptions& o_;
  Motion<M> motion_;
  RowOutputs<W> outputs_;
  std::optional<QuadRow> quad_;
  double tolerance_;  // of this run
  const RunToJudge<V>& run_;
  std::vector<SampledRow<V>> rows_;
  std::vector<W> times_;
  std::vector<std::optional<RowComparison::Row>> compared_;
  struct {
    WaitingRows* rows = nullptr;  // nullptr if the reference computes the rows
    std::optional<WaitingBlock> block;
    std::vector<Foretold> foretold;
  } waiting_;
  typename RunToJudge<V>::Plans own_plans_;
  std::vector<EventMoment<W>> met_;
  W t0_{0}, end_{0};
  bool forward_ = true, extended_ = false;
  struct {
    bool here = false, before = false;
  } kink_;  // whether a kink has ended the last step, and the one before
  std::size_t next_ = 0, resets_ = 0, uncounted_ = 0;
  PacedStretch<W> stretch_;
  std::optional<V> lost_;
};

template <Number M, Number N>
void compare(Workspace& s, const SimulationOptions& o, const StepSettings& settings, RunToJudge<Wider<N>>& run,
             SimulationReport& report) {
  SharperRun<M, N> sharper(s, o, settings, run);
  const Outcome outcome = sharper.go();
  const std::optional<double> until = sharper.last_compared();
  if (!outcome.ok() && (!until || *until == s.state.t)) {
    report.no_error = "the second run stopped: " + outcome.message;
    return;
  }
  report.error = sharper.comparison(to_double(unit_roundoff<N>())).report(kSafety, written_roundoff<N>(o));
  if (outcome.ok() || sharper.whole()) return;
  report.error->until = until;
  report.error->stopped = outcome.message;
}

}  // namespace

template <Number N>
double written_roundoff(const SimulationOptions& o) {
  const double of_text = 0.5 * std::pow(10.0, -(o.digits + 1));
  if constexpr (std::same_as<N, Multi>)
    return of_text;
  else if constexpr (std::same_as<N, Quad>)
    return o.digits > 16 ? std::max(of_text, to_double(unit_roundoff<N>())) : to_double(unit_roundoff<N>());
  else
    return to_double(unit_roundoff<N>());
}

// True if a kernel in doubles, with other roundings, makes the second run of a motion in doubles. If the tolerance is
// near the round-off of doubles, or the motion has few steps, such a run would not differ from the motion by enough.
static bool in_doubles(const SimulationOptions& o, bool by_kernel, std::size_t steps) {
  constexpr std::size_t kFew = 32;
  constexpr double kLastDigits = 1e-13;
  return by_kernel && steps > kFew && o.tolerance.get_d() >= kLastDigits * (1 - 1e-9);
}

template <Number N>
void estimate_error(Workspace& s, const SimulationOptions& o, RunToJudge<Wider<N>>& run, SimulationReport& report) {
  Rational tolerance = o.tolerance / kSharper;
  const bool doubles = std::same_as<N, double> && in_doubles(o, run.by_kernel, report.steps);
  if (doubles) tolerance = std::max(tolerance, Rational(1, 100'000'000'000'000));
  StepSettings settings{natural_logarithm(tolerance), 0, o.most_steps, o.cancelled};
  // Otherwise both runs would round the times of events alike.
  settings.other_rounding = settings.coarse_times = doubles;
  // A stiff motion may have few steps by another method, and many by Taylor's.
  if (o.estimate == ErrorEstimate::short_runs)
    settings.most_steps = std::min(settings.most_steps, kMostTimesLonger * kShortRun);
  settings.order = taylor_order(settings.log_tolerance) + 2;
  if constexpr (std::same_as<N, double>)
    if (doubles && run.motion) settings.order = run.motion->stepper().order();
  std::string numbers = "with " + std::to_string(kMoreDigits) + " digits more";
  if constexpr (std::same_as<N, Multi>) {
    const PrecisionScope precision(o.digits + 12 + kMoreDigits);
    compare<Multi, Multi>(s, o, settings, run, report);
  } else if constexpr (std::same_as<N, Quad>) {
    const PrecisionScope precision(kQuadDigits + kMoreDigits);
    compare<Multi, Quad>(s, o, settings, run, report);
  } else if (doubles) {
    numbers = "with other roundings";
    if constexpr (std::same_as<N, double>) compare<double, double>(s, o, settings, run, report);
  } else {
    numbers = std::same_as<N, double> ? "in long double" : "in quadruple precision";
    compare<std::conditional_t<std::same_as<N, double>, long double, Quad>, N>(s, o, settings, run, report);
  }
  if (report.error)
    report.error->means = "a second run " + numbers + ", tolerance " + number_text(tolerance.get_d(), 3) + ", order " +
                          std::to_string(settings.order);
}

#define INSTANTIATE(N)                                                                                                 \
  template void estimate_error<N>(Workspace&, const SimulationOptions&, RunToJudge<Wider<N>>&, SimulationReport&);     \
  template double written_roundoff<N>(const SimulationOptions&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon
