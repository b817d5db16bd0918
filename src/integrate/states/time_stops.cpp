#include "integrate/states/time_stops.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kernel/plan/plan.h"
#include "tape/operands.h"

namespace anholon {

namespace {

// Kinks are known to a few round-offs of double numbers, in which the deciding value is computed. A step of
// Runge-Kutta over this margin is not cut again.
constexpr long double kMargin = 8 * 0x1p-53L;
constexpr int kLongestChain = 8;  // formulas of the time are short

bool is_function(const Instruction& in, Function f) {
  return in.op == Op::function && in.index == static_cast<std::uint32_t>(f);
}

// The slots that decide which function holds.
std::vector<std::uint32_t> deciding(const Tape& tape, const Instruction& in) {
  if (in.op == Op::select) return {in.first};
  if (in.op == Op::lookup || in.op == Op::arctan2 || turns_at_zero(in)) return {in.a};
  if (in.op == Op::power && tape.rationals[in.index].has_even_denominator()) return {in.a};
  return {};
}

std::vector<long double> roots(const TimePolynomial<long double>& p, long double value) {
  const long double a = p.a - value;
  if (p.degree() == 0) return {};
  if (p.degree() == 1) return {-a / p.b};
  const long double square = p.b * p.b - 4 * p.c * a;
  if (!(square >= 0)) return {};
  const long double q = -(p.b + std::copysign(std::sqrt(square), p.b)) / 2;
  if (q == 0) return {0};
  return {q / p.c, a / q};
}

// The times at which a smooth function that may be almost constant elsewhere shows its variation: the centre, and times
// on both sides of it, because a pulse of both signs is zero at its centre.
std::vector<long double> telling_times(const Hiding& function, const TimePolynomial<long double>& argument) {
  std::vector<long double> times, values;
  const bool inverse = function.quotient;
  if (!inverse && !function.function) return times;
  if (argument.degree() == 2) {
    const auto centre = -argument.b / (2 * argument.c), extremum = argument.a + argument.b * centre / 2;
    times.push_back(centre);
    values = inverse ? std::vector{2 * extremum} : std::vector{extremum + 1, extremum - 1};
  }
  // A divisor that vanishes is found by its poles.
  if (!inverse) values.insert(values.end(), {0, 1, -1});
  for (const long double value : values)
    for (const long double t : roots(argument, value)) times.push_back(t);
  return times;
}

}  // namespace

TimeStops::TimeStops(const Program& program, const std::vector<double>& parameters, std::size_t quadratures,
                     long double from, long double end)
    : program_(&program), forward_(end > from), scale_(std::abs(from)) {
  const Tape& tape = program.tape;
  std::vector<bool> looked_at(tape.code.size(), false);
  std::fill_n(looked_at.begin(), tape.main_end, true);
  std::vector<std::uint32_t> watched;
  for (std::size_t i = 0; i < std::min(quadratures, program.quadratures); ++i)
    watched.push_back(tape.roots[program.unknowns() + i]);
  if (!watched.empty())
    for (const std::uint32_t slot : precedents(tape, watched)) looked_at[slot] = true;
  of_time_.assign(tape.code.size(), false);
  for (std::uint32_t slot = 0; slot < tape.code.size(); ++slot) {
    const Instruction& in = tape.code[slot];
    bool of_time = in.op != Op::rate;
    if (in.op == Op::input) of_time = program.inputs[in.index].kind == ProgramInput::Kind::time;
    for_each_operand(tape, in, [&](std::uint32_t s) { of_time = of_time && of_time_[s]; });
    of_time_[slot] = of_time;
  }
  const auto candidate = [&](std::uint32_t slot) {
    const Instruction& in = tape.code[slot];
    if (!looked_at[slot] || in.constant) return false;
    const std::vector<std::uint32_t> by = deciding(tape, in);
    return std::any_of(by.begin(), by.end(), [&](std::uint32_t s) { return of_time_[s]; }) ||
           ((in.op == Op::function || in.op == Op::power) && of_time_[in.a]) || (in.op == Op::divide && of_time_[in.b]);
  };
  bool any = false;
  for (std::uint32_t slot = 0; slot < tape.code.size() && !any; ++slot) any = candidate(slot);
  if (!any) return;
  polynomials_ = time_polynomials<W>(program, {parameters.begin(), parameters.end()}, of_time_);
  find_kinks(looked_at);
  find_smooth(looked_at);
}

void TimeStops::find_kinks(const std::vector<bool>& looked_at) {
  const Tape& tape = program_->tape;
  std::vector<std::pair<std::uint32_t, const std::vector<Rational>*>> tables;
  for (std::uint32_t slot = 0; slot < tape.code.size(); ++slot) {
    const Instruction& in = tape.code[slot];
    if (!looked_at[slot] || in.constant) continue;
    for (const std::uint32_t by : deciding(tape, in)) {
      if (!of_time_[by] || tape.code[by].constant) continue;
      if (in.op != Op::lookup) {
        const auto same = [&](const Kink& k) { return k.slot == by && k.knots.size() == 1 && k.knots[0] == 0; };
        if (std::none_of(kinks_.begin(), kinks_.end(), same)) kinks_.push_back({by, {0}});
        continue;
      }
      // The coefficients of a table have the same knots.
      const std::vector<Rational>& knots = tape.step_functions[in.index].knots;
      const auto same = [&](const auto& table) { return table.first == by && *table.second == knots; };
      if (std::any_of(tables.begin(), tables.end(), same)) continue;
      tables.emplace_back(by, &knots);
      Kink kink{by, {}};
      for (const Rational& knot : knots) kink.knots.push_back(from_rational<W>(knot));
      kinks_.push_back(std::move(kink));
    }
  }
}

// Notes the polynomials of which a slot is made by sums, products and powers.
void TimeStops::note_polynomials(std::uint32_t slot, std::vector<std::uint32_t>& noted) const {
  std::vector<std::uint32_t> open{slot};
  std::vector<bool> seen(of_time_.size(), false);
  while (!open.empty()) {
    const std::uint32_t s = open.back();
    const Instruction& in = program_->tape.code[s];
    open.pop_back();
    if (!of_time_[s] || in.constant || seen[s]) continue;
    seen[s] = true;
    if (polynomials_[s])
      noted.push_back(s);
    else if (in.op != Op::function && in.op != Op::select && in.op != Op::lookup && in.op != Op::arctan2)
      for_each_operand(program_->tape, in, [&](std::uint32_t operand) { open.push_back(operand); });
  }
}

void TimeStops::find_smooth(const std::vector<bool>& looked_at) {
  const Tape& tape = program_->tape;
  for (std::uint32_t slot = 0; slot < tape.code.size(); ++slot) {
    const auto hides = looked_at[slot] ? may_hide(tape, slot) : std::nullopt;
    if (!hides) continue;
    std::vector<std::uint32_t> arguments;
    note_polynomials(hides->argument, arguments);
    for (const std::uint32_t argument : arguments)
      for (const W t : telling_times(hides->function, *polynomials_[argument]))
        if (std::isfinite(t)) smooth_.push_back(t);
  }
  std::sort(smooth_.begin(), smooth_.end());
  if (!forward_) std::reverse(smooth_.begin(), smooth_.end());
  const auto same = [&](W a, W b) { return std::abs(b - a) < margin(b); };
  smooth_.erase(std::unique(smooth_.begin(), smooth_.end(), same), smooth_.end());
}

void TimeStops::keep_first(std::optional<W>& first, W time, W t) const {
  if (std::isfinite(time) && (forward_ ? time > t : time < t) && (!first || (forward_ ? time < *first : time > *first)))
    first = time;
}

// Returns the first time beyond t at which a slot passes a value; nullopt if there is none or it is not known.
std::optional<TimeStops::W> TimeStops::passing(std::uint32_t slot, W value, W t, int depth) const {
  const Instruction& in = program_->tape.code[slot];
  if (!of_time_[slot] || in.constant || depth == kLongestChain) return std::nullopt;
  std::optional<W> first;
  if (const auto& p = polynomials_[slot]) {
    for (const W time : roots(*p, value)) keep_first(first, time, t);
    return first;
  }
  const auto by_argument = [&](W x) {
    if (const auto time = passing(in.a, x, t, depth + 1)) keep_first(first, *time, t);
  };
  if (in.op == Op::linear || in.op == Op::multiply || in.op == Op::scale || in.op == Op::divide)
    return passing_sum(in, value, t, depth);
  if (is_function(in, Function::sin) || is_function(in, Function::cos)) return passing_wave(in, value, t);
  if (is_function(in, Function::exp) && value > 0) by_argument(std::log(value));
  if (const bool square = in.op == Op::square; (square || is_function(in, Function::abs)) && value >= 0) {
    const W x = square ? std::sqrt(value) : value;
    by_argument(x);
    if (x > 0) by_argument(-x);
  }
  return first;
}

// Like passing(), for a sum, a product or a quotient of one slot that varies and constants.
std::optional<TimeStops::W> TimeStops::passing_sum(const Instruction& in, W value, W t, int depth) const {
  const Tape& tape = program_->tape;
  const auto constant = [&](std::uint32_t s) { return polynomials_[s] && polynomials_[s]->constant(); };
  if (in.op == Op::divide)
    return constant(in.b) ? passing(in.a, value * polynomials_[in.b]->a, t, depth + 1) : std::nullopt;
  if (in.op != Op::linear) {
    if (constant(in.b)) return passing(in.a, value / polynomials_[in.b]->a, t, depth + 1);
    return constant(in.a) ? passing(in.b, value / polynomials_[in.a]->a, t, depth + 1) : std::nullopt;
  }
  const LinearTerm* varies = nullptr;
  for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
    const LinearTerm& term = tape.linear_terms[k];
    if (constant(term.slot))
      value -= from_rational<W>(tape.rationals[term.coefficient]) * polynomials_[term.slot]->a;
    else if (varies)
      return std::nullopt;
    else
      varies = &term;
  }
  if (!varies) return std::nullopt;
  return passing(varies->slot, value / from_rational<W>(tape.rationals[varies->coefficient]), t, depth + 1);
}

// Like passing(), for a sine or cosine of a + b t.
std::optional<TimeStops::W> TimeStops::passing_wave(const Instruction& in, W value, W t) const {
  constexpr W kTurn = 2 * std::numbers::pi_v<W>;
  const auto& line = polynomials_[in.a];
  if (!line || line->degree() != 1 || !(std::abs(value) <= 1)) return std::nullopt;
  const bool sine = is_function(in, Function::sin);
  const W angle = sine ? std::asin(value) : std::acos(value), other = sine ? kTurn / 2 - angle : -angle;
  const W here = line->a + line->b * t;
  std::optional<W> first;
  for (const W from : {angle, other})
    for (int k = -1; k <= 2; ++k)
      keep_first(first, (from + kTurn * (std::floor((here - from) / kTurn) + k) - line->a) / line->b, t);
  return first;
}

std::optional<TimeStops::W> TimeStops::passing_kink(const Kink& kink, W t) const {
  std::optional<W> first;
  const auto& p = polynomials_[kink.slot];
  auto from = kink.knots.begin(), to = kink.knots.end();
  // Of a line, only the knots beside the present value are next.
  if (p && p->degree() == 1) {
    const auto at = std::lower_bound(from, to, p->a + p->b * t);
    from = at - std::min<std::ptrdiff_t>(2, at - from), to = at + std::min<std::ptrdiff_t>(2, to - at);
  }
  for (; from != to; ++from)
    if (const auto time = passing(kink.slot, *from, t)) keep_first(first, *time, t);
  return first;
}

TimeStops::W TimeStops::margin(W t) const { return kMargin * std::max(std::abs(t), scale_); }

TimeStops::Stop TimeStops::around(W kink) const {
  const W way = forward_ ? margin(kink) : -margin(kink);
  return {static_cast<double>(kink - way), static_cast<double>(kink + way)};
}

std::optional<TimeStops::Stop> TimeStops::next(long double t, long double end) const {
  const auto ahead = [&](W a, W b) { return forward_ ? a > b : a < b; };
  const W since = forward_ ? t - 2 * margin(t) : t + 2 * margin(t);
  std::optional<W> first;
  for (const Kink& kink : kinks_) {
    std::optional<W> time = passing_kink(kink, since);
    while (time && !ahead(around(*time).behind, t)) time = passing_kink(kink, *time);
    if (time) keep_first(first, *time, since);
  }
  std::optional<Stop> stop;
  if (first) stop = around(*first);
  for (const W time : smooth_) {
    const double rounded = static_cast<double>(time);
    if (!ahead(rounded, t)) continue;
    if (!stop || ahead(stop->before, rounded)) stop = {rounded, rounded};
    break;
  }
  // Steps end at the end in any case.
  const W most = 2 * margin(end);
  return stop && ahead(forward_ ? end - most : end + most, stop->behind) ? stop : std::nullopt;
}

}  // namespace anholon
