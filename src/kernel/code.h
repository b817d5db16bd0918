// Machine code for a kernel of one lane or several, made while the program runs, and what makes it: a module that is
// loaded when it is first asked for, as the compiler behind it is large. Without it everything works, slower.
#pragma once
#include <memory>
#include <string>

#include "kernel/arithmetic.h"

namespace anholon {

// The parts of one expansion, and of motions (arithmetic.h); each takes the arena. What they point to lives as long as
// `keeper`.
struct Code {
  using Part = void (*)(double*);
  Part values = nullptr, factor = nullptr, lead = nullptr, extend = nullptr, measure = nullptr,
       advance = nullptr;  // `factor` judges, too
  void (*begin)(double*, const double* from) = nullptr;
  void (*go_on)(double*, const double* base, double* to) = nullptr;  // and advances before
  std::vector<int (*)(double*)> level;  // [l - 1]: the solution for the residuals at derivative order c_i - l, and
                                        // whether a state is displaced by it
  std::shared_ptr<void> keeper;
};

// What compiled code calls: the functions that the tiers call (arithmetic.h), so that the bits are theirs.
struct CalledFunctions {
  decltype(&power_of) power;
  decltype(&function_of) function;
  SinesOfLanes sines;  // for so many lanes as the code has
  SinesOfLanes several_sines;
  int several;  // at once
};

// What the module exports, under the name anholon_compiler.
struct CompilerModule {
  int version;  // of this interface
  // Empty `code.values` and a message where it fails. `cache`: a folder for compiled code, or empty.
  void (*compile)(const KernelTables& tables, int lanes, const CalledFunctions& called, const std::string& cache,
                  Code& code, std::string& message);
};
inline constexpr int kCompilerVersion = 6;

// The module beside the program; null where there is none, or this machine cannot run what it makes.
const CompilerModule* compiler();

// The folder where compiled code is kept between runs: $ANHOLON_CACHE, else anholon in $XDG_CACHE_HOME or ~/.cache;
// empty if there is none, or ANHOLON_CACHE is empty.
std::string code_cache();

}  // namespace anholon
