// Machine code that is made directly from what the Emitter wrote, in about a tenth of the time that LLVM takes: a
// function is translated instruction by instruction, and numbers leave registers by Belady's rule. The order of
// operations is that of the Emitter, so the bits are those of all other code.
#pragma once
#include <optional>
#include <string>

#include <llvm/IR/Module.h>

#include "kernel/code.h"

namespace anholon::jit::x86 {

// Translates the functions of a module for a machine with AVX2 and FMA. Returns nullopt, with the reason, for a module
// that holds what this compiler does not know. `levels`: the number of functions for hidden constraints.
std::optional<Code> straight_code(llvm::Module& module, int levels, const CalledFunctions& called, std::string& why);

}  // namespace anholon::jit::x86
