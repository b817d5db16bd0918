// Runs in HDF5. Only the files behind these functions use HDF5; the schema is in doc/results.md.
//
// HDF5 does not keep a file complete at every moment, so a file that others may read is never changed: a copy of it is
// extended and replaces it (Hdf5Sink). These functions work on a file that no other process has opened yet.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "result/run_file.h"

namespace anholon {

// True if this build can read and write HDF5; otherwise kNoHdf5 is the message.
bool has_hdf5();
extern const char* const kNoHdf5;

// Rows that are appended to a file together.
struct RowBlock {
  std::size_t columns = 0;
  std::vector<double> numbers;  // row after row
  // by column: one text per row, empty if the number's own text suffices
  std::map<std::size_t, std::vector<std::string>> texts;
  std::vector<double> steps;
  std::optional<std::string> report;

  std::size_t rows() const { return columns == 0 ? 0 : numbers.size() / columns; }
  std::size_t bytes() const { return sizeof(double) * (numbers.size() + steps.size()) + text_bytes; }
  void add(const Row& row);
  void add(const RunTable& table, std::size_t from, std::size_t to);
  void clear();
  std::size_t text_bytes = 0;
};

// Creates a file without rows. Returns an empty string, or the reason of a failure.
std::string create_hdf5(const std::string& path, const RunInfo& info, const std::vector<std::string>& columns);
std::string extend_hdf5(const std::string& path, const RowBlock& block);
// Throws Failure.
RunFile read_hdf5(const std::string& path);

}  // namespace anholon
