// The motion of a case of a sweep in a folder, from what the folder keeps: the text of the model, what was asked, and the
// numbers of the case.
//
// One list of words, those of a command, tells the motion: `anholon plot` prints it, and the functions below compute it.
#pragma once
#include "api/data.h"
#include "ensemble/store/sweep_store.h"

namespace anholon::v1 {

// An option of `anholon simulate` without its dashes, and its word: {"qdot", "phi=5"}, {"case", "wet"}, {"to", "3"}.
struct AskedWord {
  std::string option, word;
};

// What the sweep asks of the motions of all cases.
std::vector<AskedWord> words_of_sweep(const inner::SweepStore& store);

// What a case has of its own: its parameters, initial values and scenario. Throws Failure without a place: there is no such
// case, its part is missing or damaged, or the folder does not keep all that varies.
std::vector<AskedWord> words_of_case(const inner::SweepStore& store, std::size_t number);

// The same from the numbers of a case by the names that vary; "case" names a scenario if one is among the numbers.
std::vector<AskedWord> words_of_numbers(const inner::Model& model,
                                        const std::vector<std::pair<std::string, std::string>>& numbers,
                                        bool of_scenarios);

// The command that computes the motion of a case: without the numbers of a case, to which they are added, and with them.
// A model that is known by its text alone is model.toml.
std::string command_of_sweep(const inner::SweepStore& store);
// That of a case of a sweep in one mode of the contacts is one of Python.
std::string command_of_case(const inner::SweepStore& store, std::size_t number);

// The system of a case, in its initial state. Errors: as `prepare`, and as `words_of_case`.
Result<System> system_of_case(const inner::SweepStore& store, std::size_t number);
// The same from the words of a case. Errors: as `prepare`.
Result<System> system_of_words(const inner::SweepStore& store, const std::vector<AskedWord>& of_case);

// The values that the columns of grids, lists and tables take over the whole sweep, by the name of the column, in double. A
// column that is drawn is not among them, nor is a grid with very many values, or any column if the model cannot be read.
std::map<std::string, std::vector<double>> points_of_axes(const inner::SweepStore& store);

// The options of the motion of any case: those of the sweep where `given` does not say otherwise.
MotionOptions options_of_case(const inner::SweepStore& store, const MotionOptions& given);

// The options with so many equal intervals between the rows, whatever they say of rows. Throws Failure.
MotionOptions with_intervals(const System& system, MotionOptions options, int count);

// The options of the motion of a case as `anholon report` draws it: rows as the sweep asks, or as many as a page holds.
// Throws Failure.
MotionOptions drawn_case(const inner::SweepStore& store, const System& system);

// The units of the columns of a sweep, as far as the model tells them.
std::map<std::string, std::string> units_of_columns(const SweepStore& store);

}  // namespace anholon::v1
