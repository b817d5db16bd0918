// What every layer above the mechanics includes. The build compiles it once.
#pragma once
#include "cmake/precompiled/formulas.h"
#include "formulation/formulation.h"
#include "mechanics/mechanics.h"
