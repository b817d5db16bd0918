// The method that makes stiff motions (theory: methods).
#pragma once
#include "model/methods.h"

namespace anholon {

// That to which `auto` turns where Taylor's steps are short, as the motion is stiff.
Method stiff_method();

}  // namespace anholon
