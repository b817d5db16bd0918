// What stands behind a Run.
#pragma once
#include "api/data.h"
#include "result/run_file.h"

namespace anholon::v1 {

// The polynomials of all steps, in the order of time.
struct DenseOutput {
  std::vector<std::string> names;  // coordinates, then the model's states
  int order = 0;
  std::vector<double> begin, end;    // of the steps; a step backwards ends before it begins
  std::vector<double> coefficients;  // of a step after the other, in it of a name after the other, order + 1 each
};

struct Run::Data {
  System system;
  inner::RunFile run;
  Outcome outcome;
  std::vector<Column> columns;
  std::vector<Event> events;
  std::vector<std::string> notes;  // on the options
  Report report;
  DenseOutput dense;
};

}  // namespace anholon::v1
