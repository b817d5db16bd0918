#include "result/hdf5/hdf5.h"

#include "base/diagnostic.h"
#include "base/escape.h"

#ifdef ANHOLON_HDF5
#include "result/hdf5/hdf5_objects.h"
#endif

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <limits>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace anholon {

const char* const kNoHdf5 = "this build of anholon has no HDF5";

void RowBlock::add(const Row& row) {
  columns = row.values.size();
  const std::size_t before = rows();
  numbers.insert(numbers.end(), row.values.begin(), row.values.end());
  const auto add_text = [&](std::vector<std::string>& own, std::string_view digits) {
    own.resize(before);
    own.emplace_back(digits);
    text_bytes += sizeof(std::string) + digits.size();
  };
  for (std::size_t j = 0; j < row.texts.size(); ++j)
    if (const std::string_view digits = digits_beside(row, j); !digits.empty() || texts.count(j) > 0)
      add_text(texts[j], digits);
  for (auto& [j, own] : texts)
    if (j >= row.texts.size()) add_text(own, {});
}

void RowBlock::add(const RunTable& table, std::size_t from, std::size_t to) {
  columns = table.columns.size();
  const std::size_t before = rows();
  for (std::size_t k = from; k < to; ++k)
    for (std::size_t j = 0; j < columns; ++j) numbers.push_back(table.values[j][k]);
  for (std::size_t j = 0; j < columns; ++j) {
    if (table.texts[j].size() <= from && texts.count(j) == 0) continue;
    std::vector<std::string>& own = texts[j];
    own.resize(before);
    for (std::size_t k = from; k < to; ++k)
      own.push_back(k < table.texts[j].size() ? table.texts[j][k] : std::string()),
          text_bytes += sizeof(std::string) + own.back().size();
  }
}

void RowBlock::clear() {
  numbers.clear();
  texts.clear();
  steps.clear();
  report.reset();
  text_bytes = 0;
}

#ifndef ANHOLON_HDF5

bool has_hdf5() { return false; }
std::string create_hdf5(const std::string&, const RunInfo&, const std::vector<std::string>&) { return kNoHdf5; }
std::string extend_hdf5(const std::string&, const RowBlock&) { return kNoHdf5; }
RunFile read_hdf5(const std::string&) {
  throw Failure(Span{}, kNoHdf5, "a run in CSV or JSON, or build anholon where libhdf5-dev is installed");
}

#else

bool has_hdf5() { return true; }

using namespace hdf5;

namespace {

constexpr const char* kFormat = "anholon run";
constexpr int kVersion = 1;
constexpr hsize_t kChunkNumbers = 8192;  // 64 KB: the size of a small file, and the unit in which a large one is read

// Texts of columns: from the first text on /text is as long as /rows, and its attribute `columns` lists the columns.
void extend_texts(hid_t file, hsize_t before, const RowBlock& block) {
  std::vector<std::uint32_t> held;
  if (exists(file, "text")) {
    const Handle set = open_dataset(file, "text");
    held.resize(size_of(set).at(1));
    const Handle attribute(library().H5Aopen(set, "columns", H5P_DEFAULT), library().H5Aclose);
    checked(library().H5Aread(attribute, library().native_uint32, held.data()));
  }
  const std::size_t known = held.size();
  for (const auto& [column, texts] : block.texts)
    if (std::find(held.begin(), held.end(), column) == held.end()) held.push_back(static_cast<std::uint32_t>(column));
  if (held.empty()) return;
  constexpr hsize_t kChunk = 1024;
  const Handle type = text_type();
  const hsize_t rows = block.rows();
  const Handle set =
      known == 0 ? new_extendible(file, "text", type, {before, held.size()}, {kChunk, 1}) : open_dataset(file, "text");
  const std::vector<hsize_t> size = {before + rows, held.size()};
  checked(library().H5Dset_extent(set, size.data()));
  if (held.size() > known) {
    if (known > 0) checked(library().H5Adelete(set, "columns"));
    const Handle space = space_of(held.size());
    const Handle attribute(
        library().H5Acreate2(set, "columns", library().little_endian_uint, space, H5P_DEFAULT, H5P_DEFAULT),
        library().H5Aclose);
    checked(library().H5Awrite(attribute, library().native_uint32, held.data()));
  }
  for (std::size_t k = 0; k < held.size(); ++k) {
    const auto it = block.texts.find(held[k]);
    if (it == block.texts.end()) continue;
    std::vector<const char*> pointers(rows, "");
    for (std::size_t i = 0; i < it->second.size(); ++i) pointers[i] = it->second[i].c_str();
    transfer(Way::write, set, type, {before, k}, {rows, 1}, pointers.data());
  }
}

void extend_steps(hid_t file, const std::vector<double>& steps) {
  if (steps.empty()) return;
  const Handle set = open_dataset(file, "steps");
  const hsize_t before = size_of(set).at(0), after = before + steps.size();
  checked(library().H5Dset_extent(set, &after));
  transfer(Way::write, set, library().native_double, {before}, {steps.size()}, steps.data());
}

class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::string& path) : file_(open(path)) {}

  RunFile read() {
    if (attribute("format") != kFormat)
      throw Failure(Span{}, "this is an HDF5 file, but not the run of anholon",
                    "anholon simulate MODEL --to T -o run.h5 writes one");
    if (const int version = number("format_version"); version != kVersion)
      throw Failure(Span{},
                    "the run has format version " + std::to_string(version) + ", known is " + std::to_string(kVersion),
                    "a newer anholon");
    run_.title = attribute("title");
    run_.command = attribute("command");
    run_.created_by = attribute("created_by");
    const std::vector<std::string> names = texts("model/files"), files = texts("model/texts");
    for (std::size_t i = 0; i < names.size() && i < files.size(); ++i) run_.model.push_back({names[i], files[i]});
    settings();
    rows();
    if (exists(file_, "report")) run_.report = texts("report").at(0);
    if (exists(file_, "steps")) {
      const Handle set = open_dataset(file_, "steps");
      run_.steps.resize(limited(size_of(set), 1).at(0));
      transfer(Way::read, set, library().native_double, {0}, {run_.steps.size()}, run_.steps.data());
    }
    return std::move(run_);
  }

 private:
  static hid_t open_file(const std::string& path) {
    quietly();
    return library().H5Fopen(path.c_str(), Library::kRead, H5P_DEFAULT);
  }
  static Handle open(const std::string& path) { return {open_file(path), library().H5Fclose}; }

  // A file with more numbers is forged, not a run.
  static std::vector<hsize_t> limited(std::vector<hsize_t> size, std::size_t rank) {
    constexpr double kMost = 4e9;
    double product = 1;
    for (const hsize_t n : size) product *= static_cast<double>(n);
    if (size.size() != rank || product > kMost) throw Trouble{"a data set has an unfit size"};
    return size;
  }

  std::string attribute(const char* name) {
    if (library().H5Aexists(file_, name) <= 0) return {};
    const Handle a(library().H5Aopen(file_, name, H5P_DEFAULT), library().H5Aclose),
        own(library().H5Aget_type(a), library().H5Tclose), type = text_type();
    if (library().H5Tis_variable_str(own) <= 0) return {};
    char* text = nullptr;
    checked(library().H5Aread(a, type, &text));
    const std::string copy = text ? text : "";
    library().H5free_memory(text);
    return copy;
  }

  int number(const char* name) {
    int value = 0;
    const Handle a(library().H5Aopen(file_, name, H5P_DEFAULT), library().H5Aclose);
    checked(library().H5Aread(a, library().native_int, &value));
    return value;
  }

  // Reads a list, or a single text.
  std::vector<std::string> texts(const std::string& name) {
    if (!exists(file_, name)) return {};
    const Handle set = open_dataset(file_, name);
    const std::vector<hsize_t> size = size_of(set);
    return texts_of(set, H5S_ALL, H5S_ALL, size.empty() ? 1 : limited(size, 1)[0]);
  }

  void settings() {
    if (!exists(file_, "settings")) return;
    const Handle group(library().H5Gopen2(file_, "settings", H5P_DEFAULT), library().H5Gclose);
    H5G_info_t info{};
    checked(library().H5Gget_info(group, &info));
    for (hsize_t i = 0; i < info.nlinks; ++i) {
      const auto length =
          checked(library().H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, nullptr, 0, H5P_DEFAULT));
      std::string name(static_cast<std::size_t>(length), '\0');
      checked(library().H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name.data(), name.size() + 1,
                                           H5P_DEFAULT));
      run_.settings[name] = texts("settings/" + name);
    }
  }

  void rows() {
    RunTable& table = run_.table;
    table.set_columns(texts("columns"));
    const std::vector<std::string> units = texts("units");
    const std::size_t columns = table.columns.size();
    for (std::size_t j = 0; j < columns && j < units.size(); ++j)
      if (!units[j].empty()) run_.units[table.columns[j]] = units[j];
    const Handle set = open_dataset(file_, "rows");
    const std::vector<hsize_t> size = limited(size_of(set), 2);
    if (columns == 0 || size[1] != columns) throw Trouble{"/rows and /columns do not fit together"};
    for (std::size_t j = 0; j < columns; ++j) table.values.growing(j).resize(size[0]);
    const hsize_t block = std::max<hsize_t>(1, 16 * kChunkNumbers / columns);
    std::vector<double> numbers;
    for (hsize_t i = 0; i < size[0]; i += block) {
      const hsize_t n = std::min(block, size[0] - i);
      numbers.resize(n * columns);
      transfer(Way::read, set, library().native_double, {i, 0}, {n, columns}, numbers.data());
      for (hsize_t k = 0; k < n; ++k)
        for (std::size_t j = 0; j < columns; ++j) table.values.growing(j)[i + k] = numbers[k * columns + j];
    }
    written_digits(size[0]);
  }

  void written_digits(hsize_t rows) {
    if (!exists(file_, "text")) return;
    const Handle set = open_dataset(file_, "text");
    const std::vector<hsize_t> size = limited(size_of(set), 2);
    std::vector<std::uint32_t> held(size[1]);
    const Handle a(library().H5Aopen(set, "columns", H5P_DEFAULT), library().H5Aclose),
        length(library().H5Aget_space(a), library().H5Sclose);
    if (static_cast<hsize_t>(library().H5Sget_simple_extent_npoints(length)) != size[1] || size[0] > rows)
      throw Trouble{"/text does not fit to /rows"};
    checked(library().H5Aread(a, library().native_uint32, held.data()));
    for (std::size_t k = 0; k < held.size(); ++k) {
      if (held[k] >= run_.table.columns.size()) throw Trouble{"/text does not fit to /columns"};
      const hsize_t from[2] = {0, k}, count[2] = {size[0], 1};
      const Handle in_file(library().H5Dget_space(set), library().H5Sclose), in_memory = space_of(size[0]);
      checked(library().H5Sselect_hyperslab(in_file, H5S_SELECT_SET, from, nullptr, count, nullptr));
      run_.table.texts[held[k]] = texts_of(set, in_memory, in_file, size[0]);
      run_.table.texts[held[k]].resize(rows);
    }
  }

  Handle file_;
  RunFile run_;
};

}  // namespace

std::string create_hdf5(const std::string& path, const RunInfo& info, const std::vector<std::string>& columns) {
  return done([&] {
    Handle file(library().H5Fcreate(path.c_str(), Library::kReplace, H5P_DEFAULT, H5P_DEFAULT), library().H5Fclose);
    put_attribute(file, "format", kFormat);
    put_attribute(file, "format_version", kVersion);
    put_attribute(file, "title", info.title);
    put_attribute(file, "created_by", info.created_by);
    put_attribute(file, "command", info.command);
    put_texts(file, "columns", columns);
    std::vector<std::string> units;
    for (const std::string& c : columns) {
      const auto it = info.units.find(c);
      units.push_back(it == info.units.end() ? "" : it->second);
    }
    put_texts(file, "units", units);
    const hsize_t n = columns.size();
    new_extendible(file, "rows", library().little_endian_double, {0, n},
                   {std::max<hsize_t>(1, kChunkNumbers / std::max<hsize_t>(1, n)), std::max<hsize_t>(1, n)});
    new_extendible(file, "steps", library().little_endian_double, {0}, {kChunkNumbers});
    std::vector<std::string> names, texts;
    for (const RunInfo::File& f : info.model) names.push_back(f.name), texts.push_back(f.text);
    if (!names.empty()) put_texts(file, "model/files", names), put_texts(file, "model/texts", texts);
    for (const auto& [name, list] : info.settings) put_texts(file, "settings/" + name, list);
    file.close();
  });
}

std::string extend_hdf5(const std::string& path, const RowBlock& block) {
  return done([&] {
    Handle file(library().H5Fopen(path.c_str(), Library::kChange, H5P_DEFAULT), library().H5Fclose);
    if (block.rows() > 0) {
      const Handle set = open_dataset(file, "rows");
      const hsize_t before = size_of(set).at(0);
      const std::vector<hsize_t> size = {before + block.rows(), block.columns};
      checked(library().H5Dset_extent(set, size.data()));
      transfer(Way::write, set, library().native_double, {before, 0}, {block.rows(), block.columns},
               block.numbers.data());
      extend_texts(file, before, block);
    }
    extend_steps(file, block.steps);
    if (block.report) {
      if (exists(file, "report")) checked(library().H5Ldelete(file, "report", H5P_DEFAULT));
      put_text(file, "report", *block.report);
    }
    checked(library().H5Fflush(file, H5F_SCOPE_GLOBAL));
    file.close();
  });
}

// HDF5 follows addresses in a file, and a damaged file may crash it. A child process therefore reads the file first;
// its exit status tells whether it survived.
static bool is_passable(const std::string& path) {
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return true;
  if (child == 0) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    for (const int s : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) std::signal(s, SIG_DFL);
    // Hides the messages that a C library prints when it ends.
    if (const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
    try {
      Hdf5Reader(path).read();
    } catch (...) {
      // The next reader reports the error again.
    }
    ::_exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return true;
  // A sanitizer that stops the child ends it with a status, and not by a signal.
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

RunFile read_hdf5(const std::string& path) {
  if (!is_passable(path))
    throw Failure(Span{}, "the file cannot be read: it is damaged",
                  "a whole run, as `anholon simulate MODEL -o run.h5` writes it");
  try {
    return Hdf5Reader(path).read();
  } catch (const Trouble& t) {
    throw Failure(Span{}, "the file cannot be read: " + t.message,
                  "a whole run, as `anholon simulate MODEL -o run.h5` writes it");
  }
}

#endif

}  // namespace anholon
