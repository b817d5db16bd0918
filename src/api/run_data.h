// The data behind a Run.
#pragma once
#include "api/data.h"
#include "result/run_file.h"

namespace anholon::v1 {

// The polynomials of all steps, in the order of time.
struct DenseOutput {
  std::vector<std::string> names;  // coordinates, then the model's states
  int order = 0;
  std::vector<double> begin, end;    // times of the steps; a step backwards ends before it begins
  std::vector<double> coefficients;  // step by step, in a step name by name, order + 1 coefficients for each name
};

struct Run::Data {
  System system;
  inner::RunFile run;
  Outcome outcome;
  std::vector<Column> columns;
  std::vector<Event> events;
  std::vector<std::string> notes;  // about the options
  Report report;
  DenseOutput dense;
};

}  // namespace anholon::v1
