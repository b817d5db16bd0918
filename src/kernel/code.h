// Machine code for a kernel of one lane or several, made at run time by a module that is loaded at the first request,
// because the compiler in it is large. Without the module everything works, only slower.
#pragma once
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>

#include "kernel/arithmetic.h"

namespace anholon {

// Machine code made quickly, or better code, which is up to a quarter faster. The bits are the same.
enum class CodeEffort : std::uint8_t { quick, full };

// The parts of one expansion, and of motions (arithmetic.h); each takes the arena. A long plan has `extend` alone. The
// code exists as long as `keeper`.
struct Code {
  using Part = void (*)(double*);
  Part values = nullptr, factor = nullptr, lead = nullptr, extend = nullptr, measure = nullptr,
       advance = nullptr;  // `factor` also judges the pivots
  void (*begin)(double*, const double* from) = nullptr;
  void (*go_on)(double*, const double* base, double* to) = nullptr;  // and executes `advance` first
  // [l - 1]: solves for the residuals at derivative order c_i - l; returns 1 if a state is displaced, otherwise 0
  std::vector<int (*)(double*)> level;
  // Calls `find(name, part)` for each part of the code of a plan that is not long; there are `levels` hidden levels.
  template <class Find>
  void for_each_part(int levels, const Find& find) {
    find("values", values), find("factor", factor), find("lead", lead), find("extend", extend);
    find("measure", measure), find("advance", advance), find("begin", begin), find("go_on", go_on);
    level.resize(static_cast<std::size_t>(levels));
    for (int l = 1; l <= levels; ++l) find(level_name(l), level[static_cast<std::size_t>(l - 1)]);
  }
  static std::string level_name(int level) { return "level" + std::to_string(level); }

  std::shared_ptr<void> keeper;
  CodeEffort effort = CodeEffort::full;
  bool translated = false;  // instruction by instruction (jit/x86), not by the compiler
};

// Functions that compiled code calls: those of the tiers (arithmetic.h), so that the bits are the same.
struct CalledFunctions {
  decltype(&power_of) power;
  decltype(&function_of) function;
  decltype(&looked_up) lookup;
  SinesOfLanes sines;  // for the number of lanes of the code
  SinesOfLanes several_sines;
  int several;  // number of lanes

  // Calls `add(name, function)` for each function that code calls by name.
  template <class Add>
  void for_each(const Add& add) const {
    add("anholon_sines", sines);
    add("anholon_several_sines", several_sines);
    add("anholon_power", power);
    add("anholon_function", function);
    add("anholon_lookup", lookup);
    add("atan2", static_cast<double (*)(double, double)>(&std::atan2));
  }
};

// The interface that the module exports as anholon_compiler.
struct CompilerModule {
  int version;  // of this interface
  // Leaves `code.values` empty and gives a message on failure. `cache`: a folder for compiled code, or empty. The code
  // may be better than asked for, if it is there.
  void (*compile)(const KernelTables& tables, int lanes, CodeEffort effort, const CalledFunctions& called,
                  const std::string& cache, Code& code, std::string& message);
};
inline constexpr int kCompilerVersion = 9;

// True if code of little effort is translated for so many lanes (jit/x86) instead of compiled; this takes a tenth to a
// quarter of the time.
inline constexpr bool translated_at_first(int lanes) { return lanes <= 4; }

// The module beside the program; null if there is none, or if this machine cannot run its code.
const CompilerModule* compiler();

// The folder that stores compiled code between runs: $ANHOLON_CACHE, else anholon in $XDG_CACHE_HOME or ~/.cache; empty
// if there is none, or if ANHOLON_CACHE is empty.
std::string code_cache();

}  // namespace anholon
