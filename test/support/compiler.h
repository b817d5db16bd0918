// True if kernels can be compiled here: if the module was built, a test that cannot load it fails.
#pragma once

namespace anholon::test {

inline bool compiler_expected() {
#ifdef ANHOLON_COMPILER_BUILT
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

}  // namespace anholon::test
