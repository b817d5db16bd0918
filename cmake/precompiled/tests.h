// What most tests include. The build compiles it once.
#pragma once
#include <gtest/gtest.h>

#include "cmake/precompiled/commands.h"
