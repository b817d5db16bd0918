#include "run/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace anholon {

namespace {

// The error between the times that are compared may be somewhat larger.
constexpr double kSafety = 2;
constexpr int kSharper = 100;
constexpr std::size_t kMostTimesLonger = 10;
constexpr int kMoreDigits = 10;

// By runs in numbers M, of a motion computed in numbers N.
template <Number M, Number N>
void compare(const Scenario& s, const SimulationOptions& o, const StepSettings& settings, const std::vector<Sample<Wider<N>>>& samples,
             SimulationReport& report) {
  using W = Wider<M>;
  Motion<M> motion(s, settings, {}, 0);
  const auto gave_up = [&](const Outcome& why) { report.no_error = "the second run stopped: " + why.message; };
  if (Outcome start = motion.start(o.state); !start.ok()) return gave_up(start);
  const W t0 = motion.stepper().time(), end = convert<W>(samples.back().t);
  const bool forward = end > t0;
  ErrorReport e;
  std::size_t next = 0;
  while (next < samples.size()) {
    if (!(motion.stepper().time() == end))
      if (Outcome step = motion.step(end); !step.ok()) return gave_up(step);
    if (o.progress) o.progress(to_double(motion.stepper().time()), motion.stepper().steps());
    for (; next < samples.size(); ++next) {
      const W t = convert<W>(samples[next].t);
      if (forward ? t > motion.stepper().time() : t < motion.stepper().time()) break;
      if (Outcome at = motion.at(t); !at.ok()) return gave_up(at);
      const std::vector<W> values = sampled(s, motion.program(), motion.point());
      for (std::size_t i = 0; i < values.size(); ++i) {
        const W mine = convert<W>(samples[next].values[i]);
        const double miss = to_double(W(abs(W(mine - values[i])) / (W(1) + abs(values[i]))));
        if (miss <= e.error) continue;
        e.error = std::isnan(miss) ? std::numeric_limits<double>::infinity() : miss;
        e.t = number_text(to_double(t), 6);
      }
    }
    if (!motion.fired()) continue;
    std::vector<Occurrence<W>> occurrences;
    bool goes_on = true;
    if (Outcome settled = motion.settle(occurrences, goes_on); !settled.ok()) return gave_up(settled);
    if (!goes_on && next < samples.size()) break;
  }
  // What is written is rounded.
  const double roundoff = to_double(unit_roundoff<N>());
  e.error = std::max(kSafety * e.error, roundoff);
  if (e.t.empty()) e.t = number_text(to_double(end), 6);
  e.digits = e.error < 1 ? static_cast<int>(std::floor(-std::log10(e.error))) : 0;
  report.error = e;
}

}  // namespace

template <Number W>
std::vector<W> sampled(const Scenario& s, const Program& program, const Expansion<W>& point) {
  std::vector<W> values;
  for (std::size_t a = 0; a < s.system.coordinates; ++a)
    for (int k = 0; k < program.d[a]; ++k) values.push_back(point.derivative(a, k));
  return values;
}

template <Number N>
void estimate_error(const Scenario& s, const SimulationOptions& o, const std::vector<Sample<Wider<N>>>& samples, SimulationReport& report) {
  if (samples.empty()) {
    report.no_error = "the run is too short";
    return;
  }
  const Rational tolerance = o.tolerance / kSharper;
  StepSettings settings{natural_logarithm(tolerance), 0, o.most_steps, o.cancelled};
  // A stiff motion that is short by another method is long for Taylor.
  if (o.estimate == ErrorEstimate::short_runs) settings.most_steps = std::min(settings.most_steps, kMostTimesLonger * kShortRun);
  settings.order = taylor_order(settings.log_tolerance) + 2;
  if constexpr (std::same_as<N, Multi>) {
    const PrecisionScope precision(o.digits + 12 + kMoreDigits);
    compare<Multi, Multi>(s, o, settings, samples, report);
  } else if constexpr (std::same_as<N, Quad>) {
    const PrecisionScope precision(kQuadDigits + kMoreDigits);
    compare<Multi, Quad>(s, o, settings, samples, report);
  } else {
    compare<long double, N>(s, o, settings, samples, report);
  }
  if (!report.error) return;
  const std::string numbers = std::same_as<N, Multi> || std::same_as<N, Quad> ? "with " + std::to_string(kMoreDigits) + " digits more" : "in long double";
  report.error->means = "a second run " + numbers + ", tolerance " + number_text(tolerance.get_d(), 3) + ", order " + std::to_string(settings.order);
}

template std::vector<long double> sampled(const Scenario&, const Program&, const Expansion<long double>&);
template std::vector<Quad> sampled(const Scenario&, const Program&, const Expansion<Quad>&);
template std::vector<Multi> sampled(const Scenario&, const Program&, const Expansion<Multi>&);
template void estimate_error<double>(const Scenario&, const SimulationOptions&, const std::vector<Sample<long double>>&, SimulationReport&);
template void estimate_error<long double>(const Scenario&, const SimulationOptions&, const std::vector<Sample<long double>>&, SimulationReport&);
template void estimate_error<Quad>(const Scenario&, const SimulationOptions&, const std::vector<Sample<Quad>>&, SimulationReport&);
template void estimate_error<Multi>(const Scenario&, const SimulationOptions&, const std::vector<Sample<Multi>>&, SimulationReport&);

}  // namespace anholon
