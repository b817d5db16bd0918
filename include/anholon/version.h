// The version of the library.
#pragma once
#include "anholon/result.h"

namespace anholon::v1 {

// "0.2.0"
ANHOLON_API const char* version();

}  // namespace anholon::v1
