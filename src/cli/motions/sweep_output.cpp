#include "cli/motions/sweep_output.h"

#include "cli/input.h"
#include "cli/motions/result_file.h"
#include "cli/say.h"
#include "ensemble/ending.h"
#include "ensemble/parts/judgement.h"

namespace anholon::cli {

SweepOutput::SweepOutput(const ResultFormat& format, const std::string& path, const SweepInfo& info)
    : file_(format.open_sweep(path, info)) {
  if (!file_->error().empty()) throw UsageError{"error: " + file_->error() + "\n"};
}

void SweepOutput::result(const CaseResult& r) {
  const std::size_t number = before_ + r.number;
  count_stopped(stopped_, number, r.outcome);
  table_->rows(r, number, word_, [&](std::span<const SweepCell> cells) { file_->row(cells); });
  ++taken_;
  failed_ = !file_->error().empty();
}

std::string SweepOutput::close(const EnsembleReport& report) {
  return file_->close(sweep_report_json(stopped_, report));
}

const ResultFormat& sweep_format(const std::string& output, bool json) {
  const ResultFormat* named = format_of(output);
  // A data base is planned.
  const char* unable = output.ends_with(".db") ? ".db" : named && !named->open_sweep ? named->endings[0] : nullptr;
  if (unable)
    throw UsageError{"error: " + std::string(unable) +
                     " files are not written yet\nhint: " + known_files("-o cases", sweep_formats()) + "\n"};
  check_ending(output, sweep_formats());
  if (named && named->missing)
    throw UsageError{"error: " + std::string(named->missing) + "\nhint: " + named->missing_hint + "\n"};
  if (json && named && named != &report_format())
    throw UsageError{"error: --json and '" + output + "' ask for two formats\nhint: leave out --json\n"};
  if (json) return report_format();
  return named ? *named : plain_format();
}

void report_sweep(const EnsembleReport& r, std::size_t cases, const SweepOutput& out) {
  const std::string finished = list_of_endings({{name(OutcomeKind::finished), r.finished}}, r.events);
  std::string list;
  for (const auto& [kind, s] : out.stopped()) list += ", " + std::to_string(s.count) + " " + name(kind);
  say(stderr, "%zu of %zu cases: %s%s; %.3g s on %zu %s\n", r.done, cases, finished.c_str(), list.c_str(), r.seconds,
      r.threads, r.threads == 1 ? "thread" : "threads");
  for (const std::string& line : judgement_lines(r)) say(stderr, "%s\n", line.c_str());
}

void report_notes_on_cases(const EnsembleReport& r) {
  for (const std::string& note : notes_on_cases(r, asker())) say(stderr, "note: %s\n", note.c_str());
}

void report_stopped(const StoppedByKind& all, std::FILE* to) {
  for (const auto& [kind, stopped] : all) say_lines(to, stopped_note(kind, stopped) + "\n");
}

}  // namespace anholon::cli
