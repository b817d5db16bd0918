// ANHOLON_ASSERT: checks a condition that only a bug of this program can violate. It is checked in every build.
#pragma once
#include <stdexcept>

namespace anholon {

// The exception that a violated assertion throws unless set_fault_handler has chosen another handler.
struct InternalFault : std::logic_error {
  using std::logic_error::logic_error;
};

// Is called with the position and the condition of a violated assertion, and does not return. The library's default
// throws InternalFault; the program, which does not catch it, prints the fault and ends with exit status 3.
using FaultHandler = void (*)(const char* file, int line, const char* condition);
void set_fault_handler(FaultHandler handler);
[[noreturn]] void internal_fault(const char* file, int line, const char* condition);

}  // namespace anholon

#define ANHOLON_ASSERT(condition)                                                                                      \
  do {                                                                                                                 \
    if (!(condition)) ::anholon::internal_fault(__FILE__, __LINE__, #condition);                                       \
  } while (false)
