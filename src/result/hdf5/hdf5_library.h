// The library HDF5, which is loaded when a file of it is first read or written, because loading it with its own
// libraries takes longer than most commands do. Included only if HDF5 is available.
#pragma once
#include <string>

#include <hdf5.h>

namespace anholon::hdf5 {

// All functions that are used, by their own names, and the types that are variables of the library.
struct Library {
#define FUNCTION(name) decltype(&::name) name = nullptr;
#include "result/hdf5/hdf5_functions.def"
#undef FUNCTION
  hid_t c_string = 0, native_double = 0, native_int = 0, native_uint32 = 0;
  hid_t little_endian_double = 0, little_endian_int = 0, little_endian_uint = 0;
  hid_t link_creation = 0, dataset_creation = 0;
  // The ways to open a file; the macros of HDF5 would call functions.
  static constexpr unsigned kRead = 0, kChange = 1, kReplace = 2;
};

// Loads it at the first call. Returns an empty string, or the reason why it cannot be loaded.
const std::string& load_hdf5();
// REQUIRES: load_hdf5() succeeds.
const Library& library();

}  // namespace anholon::hdf5
