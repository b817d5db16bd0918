// Integrals of the motion in the output of `check`.
#pragma once
#include "base/json.h"
#include "mechanics/conserved.h"

namespace anholon::cli {

void print_conserved(const Mechanics& m);
void write_conserved(JsonWriter& j, const Mechanics& m);  // the key `conserved`

}  // namespace anholon::cli
