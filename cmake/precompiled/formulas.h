// What every layer above the expressions includes. The build compiles it once.
#pragma once
#include "cmake/precompiled/standard.h"
#include "formula/formula.h"
#include "tape/tape.h"
