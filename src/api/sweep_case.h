// The motion of a case of a sweep in a folder, computed from the contents of the folder: the text of the model, the
// options of the sweep, and the numbers of the case.
//
// One list of command-line words describes the motion: `anholon plot` prints the list, and the functions below compute
// the motion.
#pragma once
#include "api/data.h"
#include "ensemble/store/sweep_store.h"

namespace anholon::v1 {

// An option of `anholon simulate` without its dashes, and its value: {"qdot", "phi=5"}, {"case", "wet"}, {"to", "3"}.
struct AskedWord {
  std::string option, word;
};

// Opens the folder of a sweep of which numbers are read. Throws Failure without a place as SweepStore::open does, and if
// columns of parameters that have a unit in the model are in SI units, as earlier builds wrote them.
inner::SweepStore opened_to_read(const std::string& folder);

// Returns the words that the motions of all cases of the sweep share.
std::vector<AskedWord> words_of_sweep(const inner::SweepStore& store);

// Returns the words of one case: its parameters, initial values and scenario. Throws Failure without a place if there
// is no such case, if its part is missing or damaged, or if the folder does not keep all that varies.
std::vector<AskedWord> words_of_case(const inner::SweepStore& store, std::size_t number);

// Returns the words of a case from its numbers by the names that vary; "case" names a scenario if scenarios vary.
std::vector<AskedWord> words_of_numbers(const inner::Model& model,
                                        const std::vector<std::pair<std::string, std::string>>& numbers,
                                        bool of_scenarios);

// Returns the command that computes the motion of a case, without the numbers of the case, which the caller appends. A
// model of which only the text is known is called model.toml.
std::string command_of_sweep(const inner::SweepStore& store);
// Returns the command with the numbers of the case. If the sweep is in one mode of the contacts, the command is one of
// Python.
std::string command_of_case(const inner::SweepStore& store, std::size_t number);

// Prepares the system of a case, in its initial state. The errors are those of `prepare` and of `words_of_case`.
Result<System> system_of_case(const inner::SweepStore& store, std::size_t number);
// Prepares the system from the words of a case. The errors are those of `prepare`.
Result<System> system_of_words(const inner::SweepStore& store, const std::vector<AskedWord>& of_case);

// Returns the values that the columns of grids, lists and tables take over the whole sweep, by the name of the column,
// in double. Columns that are drawn at random and grids with very many values are left out; the result is empty if the
// model cannot be read.
std::map<std::string, std::vector<double>> points_of_axes(const inner::SweepStore& store);

// Returns the options of the motion of any case: those in `given`, else those of the sweep.
MotionOptions options_of_case(const inner::SweepStore& store, const MotionOptions& given);

// Returns the options with `count` equal intervals between the rows, in place of their own rows. Throws Failure.
MotionOptions with_intervals(const System& system, MotionOptions options, int count);

// Returns the options of the motion of a case as `anholon report` draws it: rows as the sweep asks, or as many as a
// page holds. Throws Failure.
MotionOptions drawn_case(const inner::SweepStore& store, const System& system);

// Returns the units of the columns of a sweep, as far as the model tells them.
std::map<std::string, std::string> units_of_columns(const SweepStore& store);

}  // namespace anholon::v1
