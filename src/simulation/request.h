// What is asked of a motion, made into the options of its computation. The command line, the library and sweeps share it.
#pragma once
#include <functional>
#include <string>

#include "model/motion_settings.h"
#include "observe/options.h"

namespace anholon {

// Who asks: how messages call the options, and who is told of what is changed in them.
struct Asker {
  std::string prefix;  // of the names of options in messages: "--" on the command line
  std::string saving;  // the option that saves or continues the run; empty if none does
  std::function<void(const std::string&)> note;

  std::string called(const std::string& option) const { return prefix + option; }
  // The option with a value, as one writes it: "--to 10" or "to = 10".
  std::string example(const std::string& option, const std::string& value) const {
    return called(option) + (prefix.empty() ? " = " : " ") + value;
  }
};

// All of these throw Failure without a place.

// The option --numbers, with --digits.
Precision precision(const MotionSettings& settings, Precision usual, const Asker& asker);
// Never below what the numbers can hold, and then with a note.
Rational tolerance(const MotionSettings& settings, Precision precision, const Asker& asker);
ErrorEstimate error_estimate(const MotionSettings& settings);
std::size_t most_steps(const MotionSettings& settings);
// Throws if one of these times of rows, in ascending order, lies before the start or beyond the end of a motion.
void must_lie_between(const std::vector<Rational>& at, const Rational& start, const Rational& end, const Asker& asker);
// Throws if events would have to be undone on the way from `start` to `end`.
void must_go_forwards(const Scenario& scenario, const Rational& start, const Rational& end);
// The method, which can meet what the options demand.
Method method(const MotionSettings& settings, const Scenario& scenario, const SimulationOptions& options,
              const Asker& asker);

// Fills the options from the settings, which are complete but for what the program chooses. Returns the time at which the
// motion ends.
Rational ask(const MotionSettings& settings, const Scenario& scenario, const Asker& asker, SimulationOptions& options);

// True if an event sets a value: such a motion goes forwards only, and conserves what it does between events alone.
bool sets_values(const Model& model);

}  // namespace anholon
