// The file of a sweep, and the report on its cases.
#pragma once
#include <atomic>
#include <cstdio>

#include "cli/input.h"
#include "ensemble/parts/sweep_report.h"
#include "ensemble/table.h"
#include "result/format.h"

namespace anholon::cli {

// Hands the rows of the cases to the writer of a file, and counts the outcomes of those that stopped.
class SweepOutput final : public CaseSink {
 public:
  SweepOutput(const ResultFormat& format, const std::string& path, const SweepInfo& info);
  // Turns to the next table, which has the columns of the file, for the cases that follow. The numbers of these cases
  // continue those of the cases before; `word` is the text of their added column.
  void turn_to(SweepTable& table, const std::string& word) { table_ = &table, word_ = word, before_ = taken_; }
  void result(const CaseResult& r) override;
  // Called by all threads.
  bool failed() const { return failed_; }
  const StoppedByKind& stopped() const { return stopped_; }
  // Returns an empty string, or the reason why the file could not be written.
  std::string close(const EnsembleReport& report);

 private:
  std::unique_ptr<SweepWriter> file_;
  SweepTable* table_ = nullptr;
  std::string word_;
  std::size_t before_ = 0, taken_ = 0;  // cases
  std::atomic<bool> failed_{false};
  StoppedByKind stopped_;
};

// Returns the format of the file that -o names; without a file --json decides. Throws UsageError.
const ResultFormat& sweep_format(const std::string& output, bool json);

// Prints on stderr how many cases finished, why the others stopped, and how far the cases can be trusted.
void report_sweep(const EnsembleReport& report, std::size_t cases, const SweepOutput& output);
void report_stopped(const StoppedByKind& stopped, std::FILE* to = stderr);
// Notes on stderr initial values of the file that give way, and formulas of reductions that have no value.
void report_notes_on_cases(const EnsembleReport& report);

}  // namespace anholon::cli
