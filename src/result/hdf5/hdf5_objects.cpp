#ifdef ANHOLON_HDF5

#include "result/hdf5/hdf5_objects.h"

#include <algorithm>

#include "base/escape.h"

namespace anholon::hdf5 {

namespace {

// The reason why an object could not be closed since `done` began: its last data go to the disk then.
std::string& lost() {
  static thread_local std::string why;
  return why;
}

// Creates missing groups; uses chunks if the data set may grow. It has no time stamps: the same run gives the same
// bytes.
Handle new_dataset(hid_t file, const std::string& name, hid_t type, hid_t space,
                   const std::vector<hsize_t>& chunk = {}) {
  const Handle links(library().H5Pcreate(library().link_creation), library().H5Pclose),
      creation(library().H5Pcreate(library().dataset_creation), library().H5Pclose);
  checked(library().H5Pset_create_intermediate_group(links, 1));
  checked(library().H5Pset_obj_track_times(creation, false));
  if (!chunk.empty()) checked(library().H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data()));
  return {library().H5Dcreate2(file, name.c_str(), type, space, links, creation, H5P_DEFAULT), library().H5Dclose};
}

}  // namespace

Handle::~Handle() {
  if (id_ >= 0 && close_(id_) < 0 && lost().empty()) lost() = cause();
}

void quietly() {
  if (const std::string& why = load_hdf5(); !why.empty()) throw Trouble{why};
  library().H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

std::string done_by(void (*f)(void*), void* with) {
  lost().clear();
  try {
    quietly();
    f(with);
    return lost();
  } catch (const Trouble& t) {
    return t.message;
  }
}

std::string cause() {
  std::string text;
  library().H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* e, void* to) -> herr_t {
        std::string& first = *static_cast<std::string*>(to);
        if (first.empty() && e->desc) first = e->desc;
        return 0;
      },
      &text);
  const std::string quote = "error message = '";
  if (const std::size_t at = text.find(quote); at != std::string::npos) {
    const std::size_t from = at + quote.size();
    return text.substr(from, text.find('\'', from) - from);
  }
  return text.empty() ? "HDF5 gives no reason" : text;
}

Handle text_type() {
  Handle type(library().H5Tcopy(library().c_string), library().H5Tclose);
  checked(library().H5Tset_size(type, H5T_VARIABLE));
  checked(library().H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

Handle space_of(std::size_t n) {
  const hsize_t size = n;
  return {library().H5Screate_simple(1, &size, nullptr), library().H5Sclose};
}

void put_texts(hid_t file, const std::string& name, const std::vector<std::string>& texts) {
  const Handle type = text_type(), space = space_of(texts.size());
  const Handle set = new_dataset(file, name, type, space);
  std::vector<std::string> held;
  std::vector<const char*> pointers;
  for (const std::string& t : texts) held.push_back(hdf5_text(t));
  for (const std::string& t : held) pointers.push_back(t.c_str());
  if (!texts.empty()) checked(library().H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()));
}

void put_text(hid_t file, const std::string& name, const std::string& text) {
  const Handle type = text_type(), space(library().H5Screate(H5S_SCALAR), library().H5Sclose);
  const Handle set = new_dataset(file, name, type, space);
  const std::string held = hdf5_text(text);
  const char* pointer = held.c_str();
  checked(library().H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, &pointer));
}

void put_attribute(hid_t object, const char* name, const std::string& text) {
  const Handle type = text_type(), space(library().H5Screate(H5S_SCALAR), library().H5Sclose);
  const Handle attribute(library().H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), library().H5Aclose);
  const std::string held = hdf5_text(text);
  const char* pointer = held.c_str();
  checked(library().H5Awrite(attribute, type, &pointer));
}

void put_attribute(hid_t object, const char* name, int number) {
  const Handle space(library().H5Screate(H5S_SCALAR), library().H5Sclose);
  const Handle attribute(
      library().H5Acreate2(object, name, library().little_endian_int, space, H5P_DEFAULT, H5P_DEFAULT),
      library().H5Aclose);
  checked(library().H5Awrite(attribute, library().native_int, &number));
}

Handle new_extendible(hid_t file, const char* name, hid_t type, std::vector<hsize_t> size,
                      const std::vector<hsize_t>& chunk) {
  const std::vector<hsize_t> most(size.size(), H5S_UNLIMITED);
  const Handle space(library().H5Screate_simple(static_cast<int>(size.size()), size.data(), most.data()),
                     library().H5Sclose);
  return new_dataset(file, name, type, space, chunk);
}

std::vector<hsize_t> size_of(hid_t set) {
  const Handle space(library().H5Dget_space(set), library().H5Sclose);
  const int rank = checked(library().H5Sget_simple_extent_ndims(space));
  std::vector<hsize_t> size(static_cast<std::size_t>(rank));
  if (rank > 0) checked(library().H5Sget_simple_extent_dims(space, size.data(), nullptr));
  return size;
}

void transfer(Way way, hid_t set, hid_t type, const std::vector<hsize_t>& from, const std::vector<hsize_t>& size,
              const void* data) {
  if (std::find(size.begin(), size.end(), 0) != size.end()) return;
  const Handle in_file(library().H5Dget_space(set), library().H5Sclose),
      in_memory(library().H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr), library().H5Sclose);
  checked(library().H5Sselect_hyperslab(in_file, H5S_SELECT_SET, from.data(), nullptr, size.data(), nullptr));
  if (way == Way::write)
    checked(library().H5Dwrite(set, type, in_memory, in_file, H5P_DEFAULT, data));
  else
    checked(library().H5Dread(set, type, in_memory, in_file, H5P_DEFAULT, const_cast<void*>(data)));
}

bool exists(hid_t file, const std::string& name) {
  for (std::size_t slash = name.find('/'); slash != std::string::npos; slash = name.find('/', slash + 1))
    if (slash > 0 && library().H5Lexists(file, name.substr(0, slash).c_str(), H5P_DEFAULT) <= 0) return false;
  return library().H5Lexists(file, name.c_str(), H5P_DEFAULT) > 0;
}

Handle open_dataset(hid_t file, const std::string& name) {
  return {library().H5Dopen2(file, name.c_str(), H5P_DEFAULT), library().H5Dclose};
}

std::vector<std::string> texts_of(hid_t set, hid_t memory, hid_t file_space, std::size_t count) {
  const Handle own(library().H5Dget_type(set), library().H5Tclose);
  if (library().H5Tis_variable_str(own) <= 0) throw Trouble{"texts of variable length are missing"};
  const Handle type = text_type();
  std::vector<char*> pointers(count, nullptr);
  std::vector<std::string> texts;
  if (count == 0) return texts;
  checked(library().H5Dread(set, type, memory, file_space, H5P_DEFAULT, pointers.data()));
  for (char* p : pointers) {
    texts.emplace_back(p ? p : "");
    library().H5free_memory(p);
  }
  return texts;
}

}  // namespace anholon::hdf5

#endif
