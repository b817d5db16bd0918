// The method that makes stiff motions (theory: methods).
#pragma once
#include "model/methods.h"

namespace anholon {

// Returns the method to which `auto` turns if Taylor's steps are short because the motion is stiff.
Method stiff_method();

}  // namespace anholon
