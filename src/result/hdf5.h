// Runs in HDF5. The only layer of ours that knows HDF5 is behind these functions; the schema is in doc/results.md.
//
// HDF5 has no notion of a file that is whole at every moment, so a file that somebody may read is never changed: a copy
// of it is extended and takes its place (Hdf5Sink). These functions work on a file that nobody else has seen yet.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "result/run_file.h"

namespace anholon {

// Whether this build can read and write HDF5, and what to say where it cannot.
bool has_hdf5();
extern const char* const kNoHdf5;
extern const char* const kNoHdf5Hint;

// Whether a file that begins so is one of HDF5.
bool looks_like_hdf5(std::string_view beginning);

// Rows that go to the end of a file together.
struct RowBlock {
  std::size_t columns = 0;
  std::vector<double> numbers;                            // row after row
  std::map<std::size_t, std::vector<std::string>> texts;  // by column: one per row, empty where the number says it all
  std::vector<double> steps;
  std::optional<std::string> report;

  std::size_t rows() const { return columns == 0 ? 0 : numbers.size() / columns; }
  std::size_t bytes() const { return sizeof(double) * (numbers.size() + steps.size()) + text_bytes; }
  void add(const Row& row);
  void add(const RunTable& table, std::size_t from, std::size_t to);
  void clear();
  std::size_t text_bytes = 0;
};

// A file without rows. Empty, or what went wrong.
std::string create_hdf5(const std::string& path, const RunInfo& info, const std::vector<std::string>& columns);
std::string extend_hdf5(const std::string& path, const RowBlock& block);
// Throws Failure.
RunFile read_hdf5(const std::string& path);

}  // namespace anholon
