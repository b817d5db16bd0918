// Translates the code of the Emitter instruction by instruction into machine code for AVX2. Numbers leave registers by
// Belady's rule, and the order of operations is that of the Emitter, so the bits are those of all other code.
#pragma once
#include <llvm/IR/Module.h>

#include "kernel/code.h"

namespace anholon::jit::x86 {

// Translates the functions of a module for a machine with AVX2 and FMA. Throws Unknown if the module contains anything
// that this compiler does not know. `levels`: the number of functions for hidden constraints.
Code translated_module(llvm::Module& module, int levels, const CalledFunctions& called);

}  // namespace anholon::jit::x86
