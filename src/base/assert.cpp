#include "base/assert.h"

#include <atomic>
#include <cstdlib>
#include <string>

namespace anholon {

static std::atomic<FaultHandler> handler{nullptr};

void set_fault_handler(FaultHandler chosen) { handler = chosen; }

void internal_fault(const char* file, int line, const char* condition) {
  if (const FaultHandler chosen = handler) {
    chosen(file, line, condition);
    std::abort();
  }
  throw InternalFault(std::string(file) + ":" + std::to_string(line) + ": internal fault: " + condition +
                      "; please report this with the model");
}

}  // namespace anholon
