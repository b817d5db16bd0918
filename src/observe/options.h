// The request for one motion: its time span, rows and accuracy, and what is watched.
#pragma once
#include <functional>
#include <utility>

#include "integrate/series/hidden_points.h"
#include "mechanics/conserved.h"
#include "motion/course.h"
#include "motion/saved.h"
#include "setup/scenario.h"

namespace anholon {

// The choice of motions whose global error is estimated by a second, sharper run, which costs more than the run itself.
enum class ErrorEstimate : std::uint8_t { never, short_runs, always };
inline constexpr std::size_t kShortRun = 5000;  // steps

// A step of Taylor's method: x_j(t) = sum_k coefficient(j, k) (t - begin)^k, k <= order, in doubles, for the
// coordinates and then the model's states.
struct StepPolynomials {
  double begin, end;
  int order;
  std::function<double(std::size_t j, int k)> coefficient;
  // The coefficients of SimulationOptions::followed, k < order; if `one_sided`, those at the beginning alone.
  std::function<double(std::size_t i, int k)> followed;
  bool one_sided;
  // The value of a followed formula at begin + x, NaN if it has none, and the magnitude of everything that it is made
  // of, -1 if the motion has no solution there.
  std::function<std::pair<double, double>(std::size_t i, double x)> followed_value;
  // The arguments, at begin + x, of the functions in its formula that may be nearly constant far from their variation.
  std::function<std::vector<HidingArgument>(std::size_t i, double x)> followed_hiding;
  std::size_t kinks = 0;  // that have cut a step short so far
};

// Rows for a picture, if no times of rows are given: so many in each step, at most `widest` apart, and one with the
// state after each event that changes something, in addition to the one before it.
struct PictureRows {
  int in_each_step;
  double widest;
};

struct SimulationOptions {
  StateChoice state;
  std::optional<Rational> to;
  std::vector<Rational> at;  // exactly these rows, ascending, on one side of the start
  std::optional<Rational> every;
  std::optional<PictureRows> picture;
  Rational tolerance{1, 1000000000000};
  int order = 0;                       // of the Taylor polynomials; 0: from the tolerance
  Method integrator = Method::taylor;  // another one: its rows, and their distance from Taylor's (precision real only)
  // The method of the motion. If only Taylor's method can give what is requested, automatic means Taylor's; methods
  // that are named compute in doubles, do not save, and know neither events nor enclosures.
  Method method = Method::automatic;
  Precision precision = Precision::real;
  int digits = 16;                      // of the numbers written, if more than 16 (multi: also of the computation)
  std::optional<std::size_t> rigorous;  // the defect of the dense output, enclosed at so many times; 0: at all times
  std::vector<std::string> at_text;     // the times as written, to be printed as given
  std::function<void(double t, std::size_t steps)> progress;
  std::function<bool()> cancelled;
  // Called after each row, by the thread that writes it; true ends the motion, because its rows cannot be written.
  std::function<bool()> rows_lost;
  std::function<void(const StepPolynomials&)> dense;  // called for every step of Taylor's method
  // Formulas that `dense` gets, too: expressions of the scenario without derivatives beyond those solved for. Steps are
  // short enough for their series.
  std::vector<Expr> followed;
  // Called with the values of these formulas at the last good state of a motion that stops, NaN without a value.
  std::function<void(const std::function<double(std::size_t i)>& followed)> stopped;
  std::size_t followed_at_ends = 0;  // so many of the last ones are needed at the ends of steps only, and shorten none
  std::function<void(const std::string&)> note;  // called with the notes of the report as soon as there is one
  std::size_t most_steps = 50'000'000;
  bool kernel = true;  // use a kernel if there is one: its pivots, chosen at the start, affect the last digits
  ErrorEstimate estimate = ErrorEstimate::never;
  // True if the notes tell of supports that pull and of friction that is needed (observe/floors/floor_watch.h).
  bool watches_floors = true;
  bool watches_carriers = true;  // of supports of one body alone, too
  // True if the ranges of monitors also count the ends of Taylor's steps.
  bool watches_ranges = true;
  std::vector<Conserved> conserved;    // to be watched: expressions of the scenario
  std::vector<std::size_t> from_zero;  // events whose formulas are zero at the start, and have round-off as values
  // Called at the end, and every few seconds, with what a continued run needs.
  std::function<void(const SavedRun&)> save;
  double save_seconds = 10;
  const SavedRun* resume = nullptr;  // the run to continue; only rows after its last one are made
};

}  // namespace anholon
