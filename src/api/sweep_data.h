// The data behind a Sweep.
#pragma once
#include "anholon/sweep.h"
#include "api/data.h"
#include "ensemble/parts/sweep_report.h"
#include "ensemble/table.h"

namespace anholon::v1 {

struct Sweep::Data {
  std::shared_ptr<const Model::Data> model;  // without the scenarios that vary applied
  // Names of the varied values; columns of the final state, then of the reductions.
  std::vector<std::string> names, columns;
  std::vector<std::string> scenarios;               // the scenarios that vary; each has the same number of cases
  std::vector<std::vector<double>> varied, values;  // numbers by name, and by column
  std::size_t of_state = 0;                         // the number of columns that are not reductions
  std::vector<double> times;
  std::vector<std::vector<double>> rows;  // rows by column of the state: case by case, at the times
  std::vector<double> t;
  std::vector<Outcome> outcomes;
  std::vector<std::string> events;  // empty if no event has ended a motion
  std::vector<std::size_t> steps;
  Outcome outcome;
  std::size_t finished = 0;

  // The sweep as a table of the command line, in which the columns of the state and the reductions have these places
  // among all columns.
  std::optional<inner::SweepTable> table;
  std::vector<std::size_t> places;
  std::size_t all_of_state = 0, all_reductions = 0;
  std::string form;
  std::map<std::string, std::string> units;  // units of columns and of varied values, as far as they are known
  inner::StoppedByKind stopped;
  std::vector<std::string> notes;
  inner::EnsembleReport report;
};

}  // namespace anholon::v1
