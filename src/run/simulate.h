// One motion: from the consistent state to the rows of a table, with its residual report.
#pragma once
#include <functional>

#include "result/rows.h"
#include "run/scenario.h"
#include "run/second_opinion.h"

namespace anholon {

enum class Precision : std::uint8_t { real, long_real, multi };

struct SimulationOptions {
  StateChoice state;
  std::optional<Rational> to;
  std::vector<Rational> at;        // exactly these rows, ascending, on one side of the start
  std::optional<Rational> every;
  Rational tolerance{1, 1000000000000};
  int order = 0;                   // of the Taylor polynomials; 0: from the tolerance
  Integrator integrator = Integrator::taylor;  // another one: its rows, and how far they are from Taylor's (precision real only)
  Precision precision = Precision::real;
  int digits = 16;                 // of the numbers written (multi: also of the computation)
  std::vector<std::string> at_text;  // the times as written, to be printed as given
  std::function<void(double t, std::size_t steps)> progress;
  std::function<bool()> cancelled;
  std::size_t most_steps = 50'000'000;
};

struct SimulationReport {
  Outcome outcome;
  std::string t;                 // reached
  std::size_t steps = 0, rows = 0;
  int order = 0;
  double seconds = 0;
  double newton = 0;             // C1: Newton's law with ideal reactions
  double projected = 0;          // C2: the same without multipliers
  double constraints = 0;        // C3: worst hidden constraint, before it was projected
  double constraints_kept = 0;   // C3 at the rows, after projection
  double power = 0;              // |h - h0 - work| in relation to the energies turned over
  double smallest_sigma = 1;     // scaled, of the system Jacobian
  std::size_t eliminations = 0;  // how often other coordinates were eliminated on the way
  std::optional<SecondOpinion> second;  // where another integrator was asked for
};

SimulationReport simulate(const Scenario& scenario, const SimulationOptions& options, RowSink& sink);

}  // namespace anholon
