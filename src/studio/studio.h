// The studio: a page on the loopback address in which a model is edited, and its equations, proof and motion are seen.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/diagnostic.h"

namespace anholon {

struct StudioOptions {
  SourceText source;                                       // of the model that is opened
  bool shipped = false;                                    // it comes with the program and is not written to
  int port = 0;                                            // 0: a free one
  std::vector<std::string> worker;                         // the command line that runs studio_work()
  std::function<void(const std::string& address)> opened;  // is told when the page can be opened
};

// Serves until Ctrl-C. Throws std::runtime_error if the port cannot be opened.
void serve_studio(const StudioOptions& options);

// The process in which a studio computes.
void studio_work();

// False if the program was built without the viewer.
bool has_studio();

}  // namespace anholon
