// What the layers that talk to the user include. The build compiles it once.
#pragma once
#include "cmake/precompiled/mechanics.h"
#include "simulation/simulate.h"
