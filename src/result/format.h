// A format of result files: its name, what it can hold, its readers and writers.
//
// The table of all formats is result/formats.cpp: another format is a file that defines its row, and its name in that
// table. The choice by the ending of a file name, the recognition by content, the help texts and the messages of all
// commands follow from the table. (doc/results.md)
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostic.h"
#include "result/run_file.h"
#include "result/writer.h"

namespace anholon {

// The parts of a run that a file of a format contains; each value includes the one before it.
enum class Holds : std::uint8_t {
  rows,        // the rows
  report,      // the rows and the report
  everything,  // the model, the rows and the report
};

struct ResultFormat {
  const char* name;                  // as in messages: HDF5
  std::vector<const char*> endings;  // of file names; messages name the first
  Holds holds;
  // False if only a file with a name can be read and written, no pipe.
  bool streams = true;
  // True if the file is also written for a motion that cannot start: its report says why.
  bool without_rows = false;
  // The limit of the numbers of a run, for a format that is kept in memory until it is written; 0: no limit.
  long most_numbers = 0;
  // The reason why this build can neither read nor write the format, and a hint; null if it can.
  const char* missing = nullptr;
  const char* missing_hint = nullptr;

  // True if a file with this beginning has this format; null for the format that is tried after all others.
  bool (*recognizes)(std::string_view beginning) = nullptr;
  // Reads a run from the text of a file, or from the file of a name; one of the two is null. Throws Failure.
  RunFile (*read_text)(std::string_view text) = nullptr;
  RunFile (*read_file)(const std::string& path) = nullptr;
  // Writes a whole run: the file is written completely or not changed. An empty path or "-" is the standard output.
  // Returns an empty string, or the reason of a failure.
  std::string (*write)(const std::string& path, const RunFile& run) = nullptr;
  // Writes a run row by row.
  std::unique_ptr<RunWriter> (*open)(const std::string& path, const RunInfo& info) = nullptr;
  // Writes a sweep; null if the format does not hold sweeps.
  std::unique_ptr<SweepWriter> (*open_sweep)(const std::string& path, const SweepInfo& info) = nullptr;
};

// All formats, in the order in which messages list them.
const std::vector<const ResultFormat*>& result_formats();

// The formats that can contain sweeps.
std::vector<const ResultFormat*> sweep_formats();

// The format that the ending of a name determines; null if no format has that ending.
const ResultFormat* format_of(const std::string& path);
// The format of rows that are written without a choice.
const ResultFormat& plain_format();
// The format of a text that holds the report, too: --json asks for it.
const ResultFormat& report_format();

// The formats in the words of messages and help texts.
//
// "FILE.h5, FILE.csv or FILE.json" for "FILE".
std::string known_files(const std::string& stem, const std::vector<const ResultFormat*>& formats = result_formats());
// "HDF5, CSV or JSON"
std::string known_formats();
// "HDF5 holds the model, the rows and the report, JSON the rows and the report, CSV the rows."
std::string held_by_formats();

// Reads a file of any format, which its content determines; "-" is the standard input. Throws Failure; if its span is a
// place in the file, `source` gets the text.
RunFile read_run(const std::string& path, SourceText* source = nullptr);

}  // namespace anholon
