// ANHOLON_ASSERT: a condition that only a bug of ours can violate. Always checked.
#pragma once
#include <cstdio>
#include <cstdlib>

#define ANHOLON_ASSERT(condition)                                                                                      \
  do {                                                                                                                 \
    if (!(condition)) {                                                                                                \
      std::fprintf(stderr, "%s:%d: internal fault: %s\nplease report this with the model\n", __FILE__, __LINE__,       \
                   #condition);                                                                                        \
      std::_Exit(3);                                                                                                   \
    }                                                                                                                  \
  } while (false)
