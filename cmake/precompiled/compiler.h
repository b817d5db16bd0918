// What most files of the compiler of kernels include. The build compiles it once.
#pragma once
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Intrinsics.h>

#include "cmake/precompiled/standard.h"
