#ifdef ANHOLON_HDF5

#include "result/hdf5/hdf5_library.h"

#include "base/assert.h"
#include "base/platform/shared_library.h"

namespace anholon::hdf5 {

namespace {

struct Loaded {
  Library found;
  std::string trouble;

  Loaded() {
    SharedLibrary file("HDF5", ANHOLON_HDF5_FILE);
    find_all(file);
    if (trouble.empty()) trouble = file.trouble();
  }

  void find_all(SharedLibrary& file) {
#define FUNCTION(name) found.name = reinterpret_cast<decltype(&::name)>(file.find(#name));
#include "result/hdf5/hdf5_functions.def"
#undef FUNCTION
    const auto open = reinterpret_cast<herr_t (*)()>(file.find("H5open"));
    if (!file.trouble().empty()) return;
    // HDF5's own clean-up at exit crashes after a failed write; all our files are closed by then.
    found.H5dont_atexit();
    if (open() < 0) {
      trouble = "HDF5 does not start";
      return;
    }
    const auto type = [&](const char* name) {
      const void* const address = file.find(name);
      return address ? *static_cast<const hid_t*>(address) : hid_t{-1};
    };
    found.c_string = type("H5T_C_S1_g");
    found.native_double = type("H5T_NATIVE_DOUBLE_g");
    found.native_int = type("H5T_NATIVE_INT_g");
    found.native_uint32 = type("H5T_NATIVE_UINT32_g");
    found.little_endian_double = type("H5T_IEEE_F64LE_g");
    found.little_endian_int = type("H5T_STD_I32LE_g");
    found.little_endian_uint = type("H5T_STD_U32LE_g");
    found.link_creation = type("H5P_CLS_LINK_CREATE_ID_g");
    found.dataset_creation = type("H5P_CLS_DATASET_CREATE_ID_g");
  }
};

const Loaded& loaded() {
  static const Loaded once;
  return once;
}

}  // namespace

const std::string& load_hdf5() { return loaded().trouble; }

const Library& library() {
  ANHOLON_ASSERT(loaded().trouble.empty());
  return loaded().found;
}

}  // namespace anholon::hdf5

#endif
