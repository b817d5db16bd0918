#include "model/motion_settings.h"

#include <algorithm>
#include <stdexcept>

#include "model/methods.h"

namespace anholon {

namespace {

using S = MotionSettings;
using Part = MotionOption::Part;

const char* not_a_tolerance(const Rational& x) { return x <= 0 || x >= 1 ? "lies between 0 and 1" : nullptr; }
const char* too_late(const Rational& x) {
  static const Rational latest(mpz_class("1000000000000000000"));
  return abs(x) > latest ? "is at most 1e18" : nullptr;
}
const char* not_positive(const Rational& x) { return x <= 0 ? "is a positive time" : nullptr; }

const std::vector<std::string>& kinds_of_numbers() {
  static const std::vector<std::string> names = {"double", "long-double", "quad"};
  return names;
}
const std::vector<std::string>& times_of_estimates() {
  static const std::vector<std::string> names = {"always", "never", "short"};
  return names;
}
const std::vector<std::string>& methods() { return method_names(MethodInfo::Use::motion); }
const std::vector<std::string>& second_opinions() { return method_names(MethodInfo::Use::second_opinion); }

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t k = 0; k < names.size(); ++k)
    list += (k == 0 ? "" : k + 1 < names.size() ? ", " : " or ") + names[k];
  return list;
}

}  // namespace

const std::vector<MotionOption>& motion_options() {
  static const std::vector<MotionOption> rows = {
      {.name = "to",
       .key = "to",
       .value = "T",
       .help = "end time (absolute)",
       .in_file = "end time, absolute; it may lie before the start",
       .part = Part::times,
       .member = &S::to,
       .in_sweep = "end time (absolute)",
       .mistake = too_late},
      {.name = "at",
       .key = "at",
       .value = "T,…",
       .help = "rows at exactly these times: 0.25,0.5",
       .in_file = "rows at these times",
       .part = Part::times,
       .member = &S::at,
       .in_sweep = "rows of each case at exactly these times, and no others: 1,2,5"},
      {.name = "every",
       .key = "every",
       .value = "DT",
       .help = "rows at this interval",
       .in_file = "rows at this interval; at the accepted steps without it",
       .part = Part::times,
       .member = &S::every,
       .mistake = not_positive},
      {.name = "tolerance",
       .key = "tolerance",
       .value = "TOL",
       .help = "of each step, relative to the largest unknown of its dimension, at least to 1 (default 1e-12)",
       .in_file = "of each step, relative to the largest unknown of its dimension, at least to 1 in SI units; 1e-12 "
                  "without it",
       .part = Part::accuracy,
       .member = &S::tolerance,
       .in_sweep = "of each step, relative to the largest unknown of its dimension, at least to 1 (default 1e-12)",
       .kept = true,
       .mistake = not_a_tolerance},
      {.name = "digits",
       .key = "digits",
       .value = "N",
       .help = "more than 16: multiprecision, or quad if asked for",
       .in_file = "of the numbers; with more than 16 the motion is computed in multiprecision",
       .part = Part::accuracy,
       .member = &S::digits,
       .kept = true,
       .least = 1,
       .most = 2000},
      {.name = "numbers",
       .key = "numbers",
       .value = "KIND",
       .help = "double, long-double or quad (33 digits, tolerance 1e-32 unless given; faster than --digits)",
       .in_file = "in which the motion is computed",
       .part = Part::accuracy,
       .member = &S::numbers,
       .kept = true,
       .choices = kinds_of_numbers},
      {.name = "rigorous",
       .key = "rigorous",
       .value = "N",
       .help = "bound the residuals of the dense output by ball arithmetic: at so many times, or all",
       .in_file = "bounds the residuals of the dense output by ball arithmetic: at so many times, or `\"all\"`",
       .part = Part::accuracy,
       .member = &S::rigorous,
       .also_number = true},
      {.name = "order",
       .key = "order",
       .value = "N",
       .help = "order of the Taylor polynomials (default: from the tolerance)",
       .in_file = "of the Taylor polynomials; from the tolerance without it",
       .part = Part::accuracy,
       .member = &S::order,
       .in_sweep = "order of the Taylor polynomials (default: from the tolerance)",
       .kept = true,
       .least = 4,
       .most = 500},
      {.name = "most-steps",
       .key = "most_steps",
       .value = "N",
       .help = "the motion ends after so many steps (default 50000000)",
       .in_file = "the motion ends after so many steps",
       .part = Part::accuracy,
       .member = &S::most_steps,
       .in_sweep = "a case ends after so many steps (default 50000000)",
       .least = 1,
       .most = 2'000'000'000},
      {.name = "method",
       .key = "method",
       .value = "NAME",
       .help = "taylor; rk: Runge-Kutta of order 8, for loose tolerances and kinks; bdf, for stiff motions; auto "
               "(default): Taylor\nunless another one is found to be much cheaper on the way",
       .in_file = "by which the motion is computed",
       .part = Part::accuracy,
       .member = &S::method,
       .in_sweep = "taylor; rk or bdf, as for simulate: one case after the other on each core; auto (default): Taylor, "
                   "in the lanes of the processor",
       .choices = methods},
      {.name = "integrator",
       .key = "integrator",
       .value = "NAME",
       .help = "taylor, or a second opinion by SUNDIALS: cvode, ida; with its difference",
       .in_file = "SUNDIALS' for a second opinion",
       .part = Part::accuracy,
       .member = &S::integrator,
       .choices = second_opinions},
      {.name = "form",
       .key = "form",
       .value = "NAME",
       .help = "form of the equations (see `anholon forms`; derive: also all; motions: also auto)",
       .in_file = "the form of the equations, see `anholon forms`",
       .part = Part::form,
       .member = &S::form,
       .kept = true},
      {.name = "error-estimate",
       .key = "error_estimate",
       .value = "WHEN",
       .help = "digits to trust, by a second, sharper run: always, never, or of runs up to 5000 steps (short, the "
               "default)",
       .in_file = "digits to trust by a second, sharper run; without it, of runs up to 5000 steps",
       .part = Part::judgement,
       .member = &S::error_estimate,
       .in_sweep = "digits to trust, by a second, sharper run of a few cases: always, never, or of cases up to 5000 "
                   "steps (short, the default)",
       .choices = times_of_estimates},
  };
  return rows;
}

const MotionOption& motion_option(const std::string& name) {
  const std::vector<MotionOption>& rows = motion_options();
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const MotionOption& o) { return o.name == name; });
  if (it == rows.end()) throw std::logic_error("there is no option " + name);
  return *it;
}

namespace {

// Sets one member, according to its type.
class Setter {
 public:
  Setter(MotionSettings& settings, const MotionOption& option, const OptionValue& value, const std::string& called)
      : settings_(settings), option_(option), value_(value), called_(called) {}

  void operator()(std::optional<Rational> S::* member) {
    const Rational x = number();
    if (const char* why = option_.mistake ? option_.mistake(x) : nullptr) throw Failure({}, called_ + " " + why);
    settings_.*member = x;
  }
  void operator()(std::optional<int> S::* member) {
    const Rational x = number();
    if (!x.is_integer() || x < option_.least || x > option_.most)
      throw Failure({}, called_ + " is a whole number from " + std::to_string(option_.least) + " to " +
                            std::to_string(option_.most));
    settings_.*member = static_cast<int>(x.to_long());
  }
  void operator()(std::optional<std::string> S::* member) {
    if (std::holds_alternative<Rational>(value_) && option_.also_number) {
      settings_.*member = std::get<Rational>(value_).get_str();
      return;
    }
    const auto* word = std::get_if<std::string>(&value_);
    if (!word) throw Failure({}, called_ + " is a word", option_.choices ? choices() : "");
    if (option_.choices) must_be_a_choice(*word);
    settings_.*member = *word;
  }
  void operator()(std::vector<WrittenTime> S::* member) {
    const auto* times = std::get_if<std::vector<WrittenTime>>(&value_);
    if (!times || times->empty()) throw Failure({}, called_ + " has no times", called_ + " 0.25,0.5,1");
    settings_.*member = *times;
    std::stable_sort((settings_.*member).begin(), (settings_.*member).end(),
                     [](const WrittenTime& a, const WrittenTime& b) { return a.value < b.value; });
    // A time that is given twice has one row, in runs and in sweeps.
    const auto end = std::unique((settings_.*member).begin(), (settings_.*member).end(),
                                 [](const WrittenTime& a, const WrittenTime& b) { return a.value == b.value; });
    (settings_.*member).erase(end, (settings_.*member).end());
  }

 private:
  Rational number() const {
    if (const auto* x = std::get_if<Rational>(&value_)) return *x;
    throw Failure({}, called_ + " is a number");
  }
  std::string choices() const { return called_ + " " + list_of(option_.choices()); }
  void must_be_a_choice(const std::string& word) const {
    const std::vector<std::string>& known = option_.choices();
    if (std::find(known.begin(), known.end(), word) != known.end()) return;
    const std::string near = did_you_mean(word, known);
    throw Failure({}, called_ + " cannot be '" + word + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                  choices());
  }

  MotionSettings& settings_;
  const MotionOption& option_;
  const OptionValue& value_;
  const std::string& called_;
};

}  // namespace

void set(MotionSettings& settings, const MotionOption& option, const OptionValue& value, const std::string& called) {
  std::visit(Setter(settings, option, value, called), option.member);
}

void set(MotionSettings& settings, const MotionOption& option, const std::vector<std::string>& words,
         const std::string& called, const std::function<Rational(const std::string&)>& number) {
  if (std::holds_alternative<std::vector<WrittenTime> S::*>(option.member)) {
    std::vector<WrittenTime> times;
    for (const std::string& w : words) times.push_back({number(w), w});
    return set(settings, option, OptionValue(times), called);
  }
  if (words.empty()) return;
  if (std::holds_alternative<std::optional<std::string> S::*>(option.member))
    return set(settings, option, OptionValue(words.back()), called);
  set(settings, option, OptionValue(number(words.back())), called);
}

bool is_set(const MotionSettings& settings, const MotionOption& option) { return !words(settings, option).empty(); }

std::vector<std::string> words(const MotionSettings& settings, const MotionOption& option) {
  struct {
    const MotionSettings& s;
    std::vector<std::string> operator()(std::optional<Rational> S::* m) const {
      if (!(s.*m)) return {};
      return {(s.*m)->get_str()};
    }
    std::vector<std::string> operator()(std::optional<int> S::* m) const {
      if (!(s.*m)) return {};
      return {std::to_string(*(s.*m))};
    }
    std::vector<std::string> operator()(std::optional<std::string> S::* m) const {
      if (!(s.*m)) return {};
      return {*(s.*m)};
    }
    std::vector<std::string> operator()(std::vector<WrittenTime> S::* m) const {
      std::vector<std::string> list;
      for (const WrittenTime& t : s.*m) list.push_back(t.value.get_str());
      return list;
    }
  } written{settings};
  return std::visit(written, option.member);
}

MotionSettings merged(const MotionSettings& asked, const MotionSettings& file) {
  MotionSettings all = asked;
  for (const MotionOption& o : motion_options())
    if (!is_set(asked, o)) std::visit([&](auto member) { all.*member = file.*member; }, o.member);
  if (!asked.form) all.form_span = file.form_span;
  if (!asked.at.empty()) all.to = asked.to, all.every = asked.every;
  if (asked.at.empty() && asked.every) all.at.clear();
  // The tolerance in the file is meant for the number type in the file.
  if (asked.digits.value_or(16) > 16 || asked.numbers == "quad") all.tolerance = asked.tolerance;
  return all;
}

}  // namespace anholon
