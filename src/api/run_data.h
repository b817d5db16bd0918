// What stands behind a Run.
#pragma once
#include "api/data.h"
#include "result/run_file.h"

namespace anholon::v1 {

struct Run::Data {
  System system;
  inner::RunFile run;
  Outcome outcome;
  std::vector<Column> columns;
  std::vector<Event> events;
  std::vector<std::string> notes;  // on the options
  Report report;
};

}  // namespace anholon::v1
