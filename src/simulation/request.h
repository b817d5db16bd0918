// Makes the settings of a motion into the options of its computation. The command line, the library and sweeps share
// it.
#pragma once
#include <functional>
#include <string>

#include "model/motion_settings.h"
#include "observe/options.h"

namespace anholon {

// The interface that asks: the names of options in messages, and the function that notes changes of options.
struct Asker {
  std::string prefix;  // the prefix of the names of options in messages: "--" on the command line
  std::string saving;  // the option that saves or continues the run; empty if none does
  std::function<void(const std::string&)> note;

  std::string called(const std::string& option) const { return prefix + option; }
  // The option with a value, as a user writes it: "--to 10" or "to = 10".
  std::string example(const std::string& option, const std::string& value) const {
    return called(option) + (prefix.empty() ? " = " : " ") + value;
  }
};

// All these functions throw Failure without a place.

// The option --numbers, with --digits.
Precision precision(const MotionSettings& settings, Precision usual, const Asker& asker);
// Returns the tolerance, raised with a note to the least that the numbers allow.
Rational tolerance(const MotionSettings& settings, Precision precision, const Asker& asker);
ErrorEstimate error_estimate(const MotionSettings& settings);
std::size_t most_steps(const MotionSettings& settings);
// Throws if one of these times of rows, in ascending order, lies before the start or beyond the end of a motion.
void must_lie_between(const std::vector<Rational>& at, const Rational& start, const Rational& end, const Asker& asker);
// Throws if events would have to be undone on the way from `start` to `end`.
void must_go_forwards(const Scenario& scenario, const Rational& start, const Rational& end);
// Returns the method. Throws if it cannot do what the options demand.
Method method(const MotionSettings& settings, const Scenario& scenario, const SimulationOptions& options,
              const Asker& asker);

// Fills the options from the settings, which are complete except for what the program chooses. Returns the time at
// which the motion ends.
Rational ask(const MotionSettings& settings, const Scenario& scenario, const Asker& asker, SimulationOptions& options);

// True if an event sets a value. Such a motion runs forwards only, and its integrals are conserved between events
// alone.
bool sets_values(const Model& model);

}  // namespace anholon
