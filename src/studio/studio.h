// The studio: a page on the loopback address in which a user edits a model and sees its equations, proof and motion; or
// which shows the map of a sweep in a folder, and the motions of its cases.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "studio/case_answers.h"

namespace anholon {

struct StudioOptions {
  SourceText source;                                       // of the opened model
  bool shipped = false;                                    // the model comes with the program, and is not written to
  std::string sweep;                                       // a folder of a sweep that is opened in place of a model
  int port = 0;                                            // 0: a free one
  std::vector<std::string> worker;                         // the command line that runs studio_work()
  std::function<void(const std::string& address)> opened;  // called when the page can be opened
};

// Serves until Ctrl-C. Throws std::runtime_error if the port cannot be opened.
void serve_studio(const StudioOptions& options);

// Runs the process in which a studio computes. `map` makes the data of the map of a sweep.
void studio_work(MapOfSweep map);

// False if the program was built without the viewer.
bool has_studio();

}  // namespace anholon
