#include "result/run_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "base/diagnostic.h"
#include "base/json.h"
#include "result/file.h"
#include "result/hdf5.h"

namespace anholon {

namespace {

// Columns and rows, in the form that they have within the JSON of `simulate`.
std::string json_rows(const RunTable& table) {
  JsonWriter j;
  j.open_object().key("columns").open_array();
  for (const std::string& n : table.columns) j.string(n);
  j.close().key("rows").open_array();
  for (std::size_t i = 0; i < table.rows(); ++i) {
    j.open_array();
    for (std::size_t c = 0; c < table.columns.size(); ++c) j.number(json_number(table.text(i, c)));
    j.close();
  }
  j.close().close();
  return j.text().substr(1, j.text().size() - 3);
}

std::string json_text(const RunFile& run) {
  const std::string& report = run.report;
  if (report.size() < 2) return "{" + json_rows(run.table) + "\n}\n";
  // At the place where `simulate` writes them: after the model and the form.
  const std::size_t place = report.find("\n  \"residuals\":");
  if (place == std::string::npos) return "{" + json_rows(run.table) + "," + report.substr(1) + "\n";
  return report.substr(0, place) + json_rows(run.table) + "," + report.substr(place) + "\n";
}

// Writes line by line; false at the first failure.
bool write_csv(std::FILE* file, const RunTable& table) {
  std::string line;
  for (std::size_t j = 0; j < table.columns.size(); ++j) line += (j ? "," : "") + csv_cell(table.columns[j]);
  line += '\n';
  constexpr std::size_t kBuffer = 1u << 16;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    for (std::size_t j = 0; j < table.columns.size(); ++j) {
      if (j) line += ',';
      line += table.text(i, j);
    }
    line += '\n';
    if (line.size() < kBuffer) continue;
    if (std::fwrite(line.data(), 1, line.size(), file) != line.size()) return false;
    line.clear();
  }
  return std::fwrite(line.data(), 1, line.size(), file) == line.size() && std::fflush(file) == 0;
}

bool write_text(std::FILE* file, RunFormat format, const RunFile& run) {
  if (format == RunFormat::csv) return write_csv(file, run.table);
  const std::string text = json_text(run);
  return std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
}

std::string write_hdf5(const std::string& path, const std::string& beside, const RunFile& run) {
  const auto failed = [&](const std::string& why) { return "cannot write " + path + ": " + why; };
  if (const std::string why = create_hdf5(beside, run, run.table.columns); !why.empty()) return failed(why);
  constexpr std::size_t kBlockRows = 100'000;
  RowBlock block;
  block.columns = run.table.columns.size();
  block.steps = run.steps;
  if (!run.report.empty()) block.report = run.report;
  for (std::size_t i = 0; i == 0 || i < run.table.rows(); i += kBlockRows) {
    const std::size_t end = std::min(run.table.rows(), i + kBlockRows);
    block.add(run.table, i, end);
    if (const std::string why = extend_hdf5(beside, block); !why.empty()) return failed(why);
    block.clear();
  }
  return {};
}

}  // namespace

bool format_of(const std::string& path, RunFormat& format) {
  for (const auto& [end, f] : {std::pair{".csv", RunFormat::csv},
                               {".json", RunFormat::json},
                               {".h5", RunFormat::hdf5},
                               {".hdf5", RunFormat::hdf5}})
    if (path.ends_with(end)) {
      format = f;
      return true;
    }
  return false;
}

RunFile read_run(const std::string& path, SourceText* source) {
  const bool in = path == "-";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(in ? "/dev/stdin" : path.c_str(), "rb"),
                                                             std::fclose);
  std::string text;
  constexpr std::size_t kPart = 1u << 20, kMost = std::size_t{16} << 30;  // far beyond the size of any run
  for (std::size_t n = 1; file && n > 0;) {
    const std::size_t before = text.size();
    text.resize(before + kPart);
    n = std::fread(text.data() + before, 1, kPart, file.get());
    text.resize(before + n);
    if (before == 0 && looks_like_hdf5(text)) {
      if (in) throw Failure(Span{}, "HDF5 cannot be read from the standard input", "the name of the file");
      return read_hdf5(path);
    }
    if (text.size() > kMost) throw Failure(Span{}, "the file is too large");
  }
  if (!file || std::ferror(file.get()))
    throw Failure(Span{}, "the file cannot be read: " + std::string(std::strerror(errno)));
  try {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{' ? read_json_run(text) : read_csv(text);
  } catch (const Failure&) {
    if (source) source->text = std::move(text);
    throw;
  }
}

std::string write_run(const std::string& path, RunFormat format, const RunFile& run) {
  if (format == RunFormat::hdf5)
    return write_whole_by_name(path, [&](const std::string& beside) { return write_hdf5(path, beside, run); });
  if (path.empty() || path == "-")
    return write_text(stdout, format, run) ? std::string()
                                           : "cannot write the output: " + std::string(std::strerror(errno));
  return write_whole(path, [&](std::FILE* file) { return write_text(file, format, run); });
}

}  // namespace anholon
