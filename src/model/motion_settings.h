// What somebody asks of a motion, in the file, on the command line or in a program: one row for each option. A row is an
// option of `simulate` with its help, a key of [simulate], an entry of saved runs and one of the provenance of results.
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
  std::string text;  // as it is to be printed; empty: as a number
};

// Empty where nothing is asked for.
struct MotionSettings {
  std::optional<Rational> to, every, tolerance;
  std::vector<WrittenTime> at;  // ascending
  std::optional<int> digits, order, most_steps;
  std::optional<std::string> form, numbers, method, integrator, rigorous, error_estimate;
  Span form_span;  // of a form that the file names
};

struct MotionOption {
  using Member = std::variant<std::optional<Rational> MotionSettings::*, std::optional<int> MotionSettings::*,
                              std::optional<std::string> MotionSettings::*, std::vector<WrittenTime> MotionSettings::*>;
  // What commands ask for together: the times of a motion, how it is computed, and how it is judged.
  enum class Part : std::uint8_t { times, accuracy, judgement, form };
  const char* name;     // "error-estimate" for --error-estimate
  const char* key;      // in [simulate]: "error_estimate"
  const char* value;    // what the help calls its value: "WHEN"
  const char* help;     // of the command line
  const char* in_file;  // of [simulate]
  Part part;
  Member member;
  const char* in_sweep = nullptr;                     // its help for sweeps; nullptr if they do not take it
  bool kept = false;                                  // a saved run goes on with the same value
  const std::vector<std::string>& (*choices)() = {};  // of a word; any other word is refused
  bool also_number = false;                           // a word that may be a number
  int least = 0, most = 0;                            // of a whole number
  // What a number has to be, if it is not: "is a positive time"; nullptr if it is.
  const char* (*mistake)(const Rational&) = {};
};
const std::vector<MotionOption>& motion_options();
// The row of a name, which must be there.
const MotionOption& motion_option(const std::string& name);

using OptionValue = std::variant<Rational, std::string, std::vector<WrittenTime>>;
// Sets an option. Throws Failure without a place if its value makes no sense; `called` is its name in the message.
void set(MotionSettings& settings, const MotionOption& option, const OptionValue& value, const std::string& called);
// As above, from words as they are typed. `number` reads a number, and throws Failure.
void set(MotionSettings& settings, const MotionOption& option, const std::vector<std::string>& words,
         const std::string& called, const std::function<Rational(const std::string&)>& number);
bool is_set(const MotionSettings& settings, const MotionOption& option);
// The value as words from which it can be set again; empty if the option is not set.
std::vector<std::string> words(const MotionSettings& settings, const MotionOption& option);
// What is asked for, and what the file says where nothing is asked for. The file's end is void if times of rows are asked
// for, and its tolerance if more digits are.
MotionSettings merged(const MotionSettings& asked, const MotionSettings& file);

}  // namespace anholon
