// The settings of a motion from the file, the command line or a program, with one row of a table for each option. A row
// is an option of `simulate` with its help, a key of [simulate], an entry of saved runs and an entry of the provenance
// of results.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/diagnostic.h"
#include "numeric/rational.h"

namespace anholon {

struct WrittenTime {
  Rational value;
  std::string text;  // the text to be printed; if empty, the number is printed
};

// The settings of a motion; a member is empty if it is not set.
struct MotionSettings {
  std::optional<Rational> to, every, tolerance;
  std::vector<WrittenTime> at;  // ascending
  std::optional<int> digits, order, most_steps;
  std::optional<std::string> form, numbers, method, integrator, rigorous, error_estimate;
  Span form_span;  // place of the form in the file
};

struct MotionOption {
  using Member = std::variant<std::optional<Rational> MotionSettings::*, std::optional<int> MotionSettings::*,
                              std::optional<std::string> MotionSettings::*, std::vector<WrittenTime> MotionSettings::*>;
  // The group of an option: the times of a motion, how it is computed, how it is judged, or the form of its equations.
  enum class Part : std::uint8_t { times, accuracy, judgement, form };
  const char* name;     // "error-estimate" for --error-estimate
  const char* key;      // key in [simulate]: "error_estimate"
  const char* value;    // name of its value in the help: "WHEN"
  const char* help;     // text of the command line
  const char* in_file;  // text of [simulate]
  Part part;
  Member member;
  const char* in_sweep = nullptr;                     // its help for sweeps; nullptr if sweeps do not take the option
  bool kept = false;                                  // a saved run is continued with the same value
  const std::vector<std::string>& (*choices)() = {};  // the allowed words; nullptr if the value is no word
  bool also_number = false;                           // the value may be a number instead of a word
  int least = 0, most = 0;                            // bounds of a whole number
  // Returns what is required of the number if it is wrong: "is a positive time"; nullptr if the number is right.
  const char* (*mistake)(const Rational&) = {};
};
const std::vector<MotionOption>& motion_options();
// Returns the option of that name, which must exist.
const MotionOption& motion_option(const std::string& name);

using OptionValue = std::variant<Rational, std::string, std::vector<WrittenTime>>;
// Sets an option. Throws Failure without a place if its value makes no sense; `called` is its name in the message.
void set(MotionSettings& settings, const MotionOption& option, const OptionValue& value, const std::string& called);
// Sets an option from words as they are typed. `number` reads a number, and throws Failure.
void set(MotionSettings& settings, const MotionOption& option, const std::vector<std::string>& words,
         const std::string& called, const std::function<Rational(const std::string&)>& number);
bool is_set(const MotionSettings& settings, const MotionOption& option);
// Returns the value as words from which it can be set again; empty if the option is not set.
std::vector<std::string> words(const MotionSettings& settings, const MotionOption& option);
// Returns the settings in `asked`, and those of the file where `asked` has none. The end in the file is ignored if
// `asked` has times of rows, and the tolerance in the file if `asked` has more digits.
MotionSettings merged(const MotionSettings& asked, const MotionSettings& file);

}  // namespace anholon
