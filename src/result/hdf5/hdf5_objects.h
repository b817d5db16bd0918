// RAII wrappers of HDF5 objects for results: an open object closes itself, a failed call gives its reason. Included
// only if HDF5 is available.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "result/hdf5/hdf5_library.h"

namespace anholon::hdf5 {

// A failed call of HDF5, with the reason.
struct Trouble {
  std::string message;
};

// The first cause that HDF5 reports, with the message of the operating system if HDF5 quotes it.
std::string cause();

template <class T>
T checked(T result) {
  if (result < 0) throw Trouble{cause()};
  return result;
}

// An object of HDF5, which is closed with its owner.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closing)(hid_t)) : id_(checked(id)), close_(closing) {}
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Handle& operator=(Handle&&) = delete;
  ~Handle();
  operator hid_t() const { return id_; }
  // Closing a file writes its last bytes.
  void close() {
    const hid_t id = id_;
    id_ = -1;
    checked(close_(id));
  }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Switches off HDF5's own messages, because `cause` reports errors. Call it before any other function of HDF5; `done`
// does so. Throws Trouble if the library cannot be loaded.
void quietly();

// Calls f, which may throw Trouble. Returns the reason why f failed, or why an object could not be closed (its last
// data go to the disk then); an empty text on success.
std::string done_by(void (*f)(void*), void* with);

template <class F>
std::string done(F f) {
  return done_by([](void* with) { (*static_cast<F*>(with))(); }, &f);
}

Handle text_type();
Handle space_of(std::size_t n);  // of one dimension
Handle open_dataset(hid_t file, const std::string& name);
// Makes a data set that is extendible in all directions, in chunks.
Handle new_extendible(hid_t file, const char* name, hid_t type, std::vector<hsize_t> size,
                      const std::vector<hsize_t>& chunk);
void put_texts(hid_t file, const std::string& name, const std::vector<std::string>& texts);
void put_text(hid_t file, const std::string& name, const std::string& text);
void put_attribute(hid_t object, const char* name, const std::string& text);
void put_attribute(hid_t object, const char* name, int number);

bool exists(hid_t file, const std::string& name);
std::vector<hsize_t> size_of(hid_t set);
std::vector<std::string> texts_of(hid_t set, hid_t memory, hid_t file_space, std::size_t count);

// Writes or reads the box [from, from + size).
enum class Way { write, read };
void transfer(Way way, hid_t set, hid_t type, const std::vector<hsize_t>& from, const std::vector<hsize_t>& size,
              const void* data);

}  // namespace anholon::hdf5
