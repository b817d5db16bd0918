#include "simulation/request.h"

#include <algorithm>
#include <regex>

#include "base/diagnostic.h"
#include "numeric/number.h"

namespace anholon {

namespace {

// A request for more rows is refused, before they fill memory or disk.
constexpr long kMostRows = 5'000'000;

Rational power_of_ten(int exponent) {
  mpz_class power;
  mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(exponent)));
  return exponent < 0 ? Rational(1, power) : Rational(power);
}

// The initial time; it is exact if it was given.
Rational start_of(const Scenario& s, const SimulationOptions& o) {
  if (o.state.t) return *o.state.t;
  return is_number(s.model->initial.t) ? number_value(s.model->initial.t) : Rational(s.state.t);
}

bool lies_between(const Rational& t, const Rational& start, const Rational& end) {
  return std::min(start, end) <= t && t <= std::max(start, end);
}

// True if the times of rows are those of the file; other times have a text.
bool of_file(const std::vector<WrittenTime>& at) {
  return std::all_of(at.begin(), at.end(), [](const WrittenTime& t) { return t.text.empty(); });
}

// True if a text is one number that each format of results reads, such as 0.25 or -1e-3. Formulas and numbers with
// units are not.
bool is_number_as_written(const std::string& text) {
  static const std::regex number(R"(-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][-+]?[0-9]+)?)");
  return std::regex_match(text, number);
}

// Returns the time at which the motion ends.
Rational set_times(const MotionSettings& settings, const Scenario& s, const Asker& asker, SimulationOptions& o) {
  o.to = settings.to;
  o.every = settings.every;
  const Rational start = start_of(s, o);
  std::vector<WrittenTime> at = settings.at;
  // If the user sets another end, rows of the file beyond it are left out.
  const bool left_out =
      o.to && of_file(at) && o.to != s.model->simulate.to &&
      std::erase_if(at, [&](const WrittenTime& t) { return !lies_between(t.value, start, *o.to); }) > 0;
  if (left_out)
    asker.note("rows that the file asks for beyond t = " + number_text(from_rational<double>(*o.to)) + " are left out");
  // The start is written with the digits of a double.
  for (WrittenTime& t : at)
    if (t.value != start && from_rational<double>(t.value) == from_rational<double>(start)) t.value = start;
  for (const WrittenTime& t : at) o.at.push_back(t.value);
  if (!of_file(at))
    for (const WrittenTime& t : at) o.at_text.push_back(is_number_as_written(t.text) ? t.text : "");
  if (!o.at.empty() && !o.to && o.at.front() < start && o.at.back() > start)
    throw Failure({}, "the time " + o.at.front().get_str() + " lies before the start, t = " + start.get_str());
  if (!o.at.empty() && o.every)
    throw Failure({}, asker.called("at") + " and " + asker.called("every") + " exclude each other",
                  "leave out one of them: rows are written at exactly the times of " + asker.called("at"));
  if (o.at.empty() && !o.to)
    throw Failure({}, "no end time", asker.example("to", "10") + ", or [simulate] to = 10 in the model file");
  if (o.to) must_lie_between(o.at, start, *o.to, asker);
  const Rational end = o.to ? *o.to : o.at.front() < start ? o.at.front() : o.at.back();
  if (o.to && !o.at.empty() && !left_out)
    if (const Rational last = end < start ? o.at.front() : o.at.back(); last != end)
      asker.note("the motion goes on after the last row, t = " + number_text(from_rational<double>(last)) +
                 ", to its end, t = " + number_text(from_rational<double>(end)) + ", where " + asker.called("at") +
                 " asks for no row");
  if (end < start)
    asker.note("the end lies before the start, t = " + number_text(from_rational<double>(start)) +
               ": the motion is computed backwards");
  if (o.every && abs(Rational(end - start)) > kMostRows * *o.every)
    throw Failure({}, asker.called("every") + " asks for more than " + std::to_string(kMostRows) + " rows");
  must_go_forwards(s, start, end);
  return end;
}

// Returns the number of times of the bounds, 0 for all times, or nullopt without the option.
std::optional<std::size_t> rigorous(const MotionSettings& settings, const Asker& asker) {
  constexpr long kMostTimes = 1'000'000;
  if (!settings.rigorous) return std::nullopt;
  if (*settings.rigorous == "all") return 0;
  const std::optional<Rational> n = parse_rational(*settings.rigorous);
  if (!n || !n->is_integer() || *n < 1 || *n > kMostTimes)
    throw Failure({},
                  asker.called("rigorous") + " takes a number of times up to " + std::to_string(kMostTimes) +
                      ", or the word all, not '" + *settings.rigorous + "'",
                  asker.example("rigorous", "64"));
  return n->get_num().get_ui();
}

MethodDemands demands(const SimulationOptions& o, const Asker& asker) {
  return {o.precision != Precision::real, !asker.saving.empty(), o.rigorous.has_value(), o.order > 0,
          o.tolerance.get_d()};
}

// Returns the option that makes a demand.
std::string option_of(MethodRefusal::Of demand, const SimulationOptions& o, const Asker& asker) {
  switch (demand) {
  case MethodRefusal::Of::numbers:
    return asker.called(o.digits > 16 ? "digits" : "numbers");
  case MethodRefusal::Of::saving:
    return asker.saving;
  case MethodRefusal::Of::enclosing:
    return asker.called("rigorous");
  case MethodRefusal::Of::order:
    return asker.called("order");
  case MethodRefusal::Of::tolerance:
    return asker.called("tolerance");
  }
  return {};
}

void note_raised(const MethodInfo& method, const SimulationOptions& o, const Asker& asker) {
  if (method.serves(o.tolerance.get_d())) return;
  const std::string least = number_text(method.least_tolerance, 3);
  asker.note("a tolerance below " + least + " means " + least + " to " + method.name);
}

// Returns the integrator; SUNDIALS computes in double, and not below its own least tolerance.
Method integrator(const MotionSettings& settings, const Model& model, const SimulationOptions& o, const Asker& asker) {
  const Method chosen =
      settings.integrator ? find_method(*settings.integrator, MethodInfo::Use::second_opinion).value_or(Method::taylor)
                          : Method::taylor;
  if (chosen == Method::taylor) return chosen;
  const MethodInfo& method = info(chosen);
  const auto refuse = [&](const std::string& what, const std::string& option) {
    throw Failure({}, "the integrator '" + std::string(method.name) + "' " + what,
                  "leave out " + option + ", or use " + asker.example("integrator", "taylor"));
  };
  if (const auto refused = refusal(method, demands(o, asker))) refuse(refused->why, option_of(refused->of, o, asker));
  if (std::any_of(model.events.begin(), model.events.end(), [](const Event& e) { return e.ends_step(); }))
    refuse("does not stop at events", "the events");
  // The rows' digits to trust come from the difference from Taylor's motion.
  if (o.estimate == ErrorEstimate::always)
    refuse("has its difference from Taylor's motion for an estimate", asker.called("error-estimate"));
  note_raised(method, o, asker);
  return chosen;
}

}  // namespace

bool sets_values(const Model& model) {
  return std::any_of(model.events.begin(), model.events.end(), [](const Event& e) { return !e.set.empty(); });
}

Precision precision(const MotionSettings& settings, Precision usual, const Asker& asker) {
  const int digits = settings.digits.value_or(16);
  if (settings.numbers == "quad" && digits > kQuadDigits)
    throw Failure({}, asker.example("numbers", "quad") + " holds " + std::to_string(kQuadDigits) + " digits",
                  asker.example("digits", std::to_string(digits)) + " without " + asker.called("numbers") +
                      " computes in multiprecision");
  if (settings.numbers == "quad") return Precision::quad;
  if (digits > 16) return Precision::multi;
  return settings.numbers == "long-double" ? Precision::long_real : usual;
}

Rational tolerance(const MotionSettings& settings, Precision precision, const Asker& asker) {
  if (!settings.tolerance) return SimulationOptions().tolerance;
  if (precision == Precision::multi) return *settings.tolerance;
  const auto [least, text] = precision == Precision::real        ? std::pair{2 * power_of_ten(-16), "2e-16"}
                             : precision == Precision::long_real ? std::pair{power_of_ten(-19), "1e-19"}
                                                                 : std::pair{2 * power_of_ten(-34), "2e-34"};
  if (*settings.tolerance >= least) return *settings.tolerance;
  asker.note(std::string("a tolerance below ") + text + " means " + text + " in these numbers");
  return least;
}

ErrorEstimate error_estimate(const MotionSettings& settings) {
  return settings.error_estimate == "always"  ? ErrorEstimate::always
         : settings.error_estimate == "never" ? ErrorEstimate::never
                                              : ErrorEstimate::short_runs;
}

void must_lie_between(const std::vector<Rational>& at, const Rational& start, const Rational& end, const Asker& asker) {
  const auto outside =
      std::find_if(at.begin(), at.end(), [&](const Rational& t) { return !lies_between(t, start, end); });
  if (outside == at.end()) return;
  const bool before_start = (*outside < start) == (start <= end);
  throw Failure({},
                "the time " + number_text(from_rational<double>(*outside)) + " lies " +
                    (before_start ? "before the start, t = " + number_text(from_rational<double>(start))
                                  : "beyond the end, t = " + number_text(from_rational<double>(end))),
                asker.called("at") + " asks for rows between the start and the end of the motion");
}

void must_go_forwards(const Scenario& s, const Rational& start, const Rational& end) {
  if (end < start && sets_values(*s.model))
    throw Failure({}, "what events set cannot be taken back: the motion goes forwards only",
                  "an end after the start, t = " + number_text(from_rational<double>(start)));
}

Method method(const MotionSettings& settings, const Scenario& s, const SimulationOptions& o, const Asker& asker) {
  const Method chosen = settings.method ? find_method(*settings.method).value_or(Method::automatic) : Method::automatic;
  if (chosen == Method::automatic || chosen == Method::taylor) return chosen;
  const MethodInfo& method = info(chosen);
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw Failure({}, "the method '" + std::string(method.name) + "' " + what,
                  (remedy.empty() ? "" : remedy + ", or ") + "use " + asker.example("method", "taylor"));
  };
  const auto refused = refusal(method, demands(o, asker));
  const bool tolerance = refused && refused->of == MethodRefusal::Of::tolerance;
  if (refused && !tolerance) refuse(refused->why, "leave out " + option_of(refused->of, o, asker));
  const bool structured = !s.structure.d.empty();  // false in a sweep of which no case has a start
  if (const std::string why = structured ? only_taylor(*s.model, program(s.system, s.structure)) : ""; !why.empty())
    refuse(why, "");
  if (tolerance) refuse(refused->why, asker.example("tolerance", "1e-8"));
  note_raised(method, o, asker);
  return chosen;
}

std::size_t most_steps(const MotionSettings& settings) {
  return settings.most_steps ? static_cast<std::size_t>(*settings.most_steps) : SimulationOptions().most_steps;
}

Rational ask(const MotionSettings& settings, const Scenario& s, const Asker& asker, SimulationOptions& o) {
  // The tolerance of quad without --digits leaves some digits for round-off.
  constexpr int kQuadTolerance = 32;
  o.most_steps = most_steps(settings);
  o.estimate = error_estimate(settings);
  o.order = settings.order.value_or(0);
  const Rational last = set_times(settings, s, asker, o);
  o.rigorous = rigorous(settings, asker);
  if (o.rigorous && sets_values(*s.model))
    throw Failure({}, asker.called("rigorous") + " encloses motions without events that set something",
                  "leave out " + asker.called("rigorous"));
  o.digits = settings.digits.value_or(16);
  o.precision = precision(settings, Precision::real, asker);
  MotionSettings sharp = settings;
  if (!settings.tolerance && (o.digits > 16 || o.precision == Precision::quad))
    sharp.tolerance = power_of_ten(o.digits > 16 ? -(o.digits + 2) : -kQuadTolerance);
  o.tolerance = tolerance(sharp, o.precision, asker);
  o.integrator = integrator(settings, *s.model, o, asker);
  o.method = method(settings, s, o, asker);
  return last;
}

}  // namespace anholon
