#include "cli/motions/sweep_folder.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "api/sweep_case.h"
#include "base/json.h"
#include "cli/commands.h"
#include "cli/motions/progress.h"
#include "cli/motions/sweep_output.h"
#include "cli/say.h"
#include "cli/stop.h"
#include "ensemble/ending.h"
#include "ensemble/parts/judgement.h"
#include "ensemble/parts/sweep_report.h"
#include "ensemble/refine/refine.h"
#include "result/file.h"
#include "result/parquet/parquet_sweep.h"

namespace anholon::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "anholon " ANHOLON_VERSION;

// The share --shard i/N: every N-th part, from the i-th part on.
struct Shard {
  std::size_t number = 1, of = 1;
};

Shard shard_of(const std::string& word) {
  Shard s;
  if (word.empty()) return s;
  const std::size_t slash = word.find('/');
  const auto number = [&](std::string_view text, std::size_t& to) {
    const auto [end, why] = std::from_chars(text.data(), text.data() + text.size(), to);
    return why == std::errc() && end == text.data() + text.size();
  };
  if (slash == std::string::npos || !number(std::string_view(word).substr(0, slash), s.number) ||
      !number(std::string_view(word).substr(slash + 1), s.of) || s.number < 1 || s.number > s.of)
    throw UsageError{"error: --shard takes a share and the number of shares, 1/8 to 8/8, not '" + word +
                     "'\nhint: each of 8 processes computes one: --shard 1/8, --shard 2/8, …\n"};
  return s;
}

// Reads a whole number from `least` to `most`. Throws UsageError.
std::size_t count_asked(const char* option, const char* what, const std::string& word, std::size_t least,
                        std::size_t most) {
  std::size_t count = 0;
  const auto [end, why] = std::from_chars(word.data(), word.data() + word.size(), count);
  if (why != std::errc() || end != word.data() + word.size() || count < least || count > most)
    throw UsageError{"error: " + std::string(option) + " takes a number of " + what + " from " + std::to_string(least) +
                     " to " + std::to_string(most) + ", not '" + word + "'\n"};
  return count;
}

// The request of --refine and --refine-by.
struct Refinement {
  std::size_t generations = 0;  // after the first one
  RefineRule rule;
};

Refinement refinement_of(const SweepCommand& o, const FolderSweep& sweep, const std::vector<std::string>& columns) {
  constexpr std::size_t kMost = 30;  // a grid that is 10^9 times as fine
  Refinement r;
  if (o.refine.empty() && o.refine_by.empty()) return r;
  if (o.refine.empty())
    throw UsageError{
        "error: --refine-by tells what a border is, and --refine how often it is refined\nhint: --refine 4 "
        "--refine-by " +
        o.refine_by + "\n"};
  r.generations = count_asked("--refine", "generations", o.refine, 1, kMost);
  try {
    r.rule = refine_rule(o.refine_by);
  } catch (const MistakeInWord& m) {
    refuse(m, "--refine-by");
  }
  if (!sweep.variation)
    throw UsageError{
        "error: the cases of a file are no grid, and --refine has nothing to halve\nhint: a sweep for each "
        "case: --case NAME\n"};
  must_be_refinable(*sweep.variation, columns, r.rule);
  return r;
}

std::string duration(double seconds) {
  const auto s = static_cast<long>(std::lround(seconds));
  if (s < 100) return std::to_string(s) + " s";
  if (s < 6000) return std::to_string(s / 60) + " min";
  return std::to_string(s / 3600) + " h " + std::to_string(s % 3600 / 60) + " min";
}

double left(const SweepStore::Progress& p) {
  return p.cases_per_second > 0 ? static_cast<double>(p.all_cases - p.cases) / p.cases_per_second : 0;
}

// Returns a text such as "160 + 24 + 31 cases"; empty if there is one generation.
std::string generation_list(const SweepStore& store) {
  std::string list;
  if (store.generations().size() == 1) return list;
  for (const Generation& g : store.generations()) list += (list.empty() ? "" : " + ") + std::to_string(g.cases);
  return list + " cases";
}

// Prints the sentences that say how far the cases can be trusted.
void say_judgement(const SweepStore& store, std::FILE* to) {
  const auto lines = judgement_text(store.judgement());
  if (!lines) return;
  for (const std::string& line : *lines) say(to, "%s\n", line.c_str());
}

// Returns the JSON object with the judgement of the folder added to it.
std::string with_judgement(std::string object, const SweepStore& store) {
  const std::string judgement = store.judgement();
  if (judgement.empty()) return object;
  object.resize(object.rfind('}'));
  while (object.ends_with('\n') || object.ends_with(' ')) object.pop_back();
  return object + ",\n  \"judgement\": " + judgement.substr(0, judgement.find_last_not_of('\n') + 1) + "\n}";
}

void say_progress(const SweepStore& store, const SweepStore::Progress& p) {
  say(stderr, "%s: %zu of %zu parts, %zu of %zu cases%s%s\n", store.folder().c_str(), p.parts, p.all_parts, p.cases,
      p.all_cases, p.outcomes.empty() ? "" : ": ", list_of_endings(p.outcomes, p.events).c_str());
  if (const std::string list = generation_list(store); !list.empty()) say(stderr, "generations: %s\n", list.c_str());
}

// Returns the counts of stopped cases by kind, from the notes of the parts.
StoppedByKind stopped_of(const SweepStore::Progress& p) {
  StoppedByKind all;
  for (const std::string& note : p.stopped) add_stopped(all, note);
  return all;
}

// Returns the number of finished cases. Outcomes are counted by rows, equally many for each case; without outcomes the
// stopped cases are subtracted.
std::size_t finished_of(const SweepStore::Progress& p) {
  std::size_t rows = 0, finished = p.cases;
  for (const auto& [outcome, count] : p.outcomes) rows += count;
  if (rows >= p.cases && p.cases > 0) {
    const auto at = p.outcomes.find(name(OutcomeKind::finished));
    return at == p.outcomes.end() ? 0 : at->second / (rows / p.cases);
  }
  for (const auto& [kind, stopped] : stopped_of(p)) finished -= std::min(finished, stopped.count);
  return finished;
}

bool all_finished(const SweepStore::Progress& p) {
  const auto finished = p.outcomes.find(name(OutcomeKind::finished));
  return p.outcomes.empty() || (p.outcomes.size() == 1 && finished != p.outcomes.end());
}

}  // namespace

bool names_folder(const std::string& output) {
  std::error_code none;
  return output.ends_with('/') || fs::is_directory(output, none);
}

namespace {

// The result of `fill_missing` for one generation.
struct Missing {
  bool complete = false;
  int status = kOk;  // the exit status if the generation is not complete
};

// Computes the parts of the share that are missing.
Missing fill_missing(const SweepCommand& o, const FolderSweep& sweep, const SweepStore& store, const Shard& shard) {
  FillOptions fill_options;
  fill_options.parts = parts_to_do(store, shard.number, shard.of);
  fill_options.cancelled = stop_requested;
  std::size_t cases = 0;
  for (const std::size_t part : fill_options.parts) cases += store.range(part).second - store.range(part).first;
  std::vector<SweepPiece> pieces = sweep.pieces;
  EnsembleOptions of_all = *pieces.front().options;
  if (store.generations().size() > 1) {
    if (!sweep.variation) throw UsageError{"error: the sweep in " + store.folder() + " was refined\n"};
    of_all.cases = store.cases();
    of_all.numbers = numbers_of(store, *sweep.variation);
    pieces.front().options = &of_all;
  }
  Filled filled;
  {
    Progress progress(o.quiet, "case", "cases");
    fill_options.progress = [&](std::size_t done) {
      progress(static_cast<double>(done) / static_cast<double>(cases), static_cast<double>(done), done);
    };
    if (cases > 0) filled = fill(store, pieces, fill_options);
  }
  report_notes_on_cases(filled.report);
  if (!filled.error.empty()) {
    say(stderr, "error: %s\nhint: the parts before it are kept; the same command goes on\n", filled.error.c_str());
    return {false, kBadInput};
  }
  return {filled.parts == fill_options.parts.size(), kStopped};
}

// Judges some cases of a complete folder, once. Returns false after Ctrl-C.
bool judge(const FolderSweep& sweep, const SweepStore& store) {
  if (!store.judgement().empty()) return true;
  EnsembleReport all;
  bool asked = false;
  for (const SweepPiece& piece : sweep.pieces) {
    add_report(all, judge_piece(piece, stop_requested));
    asked = asked || piece.options->estimate != ErrorEstimate::never;
    if (!all.outcome.ok()) return false;
  }
  if (!asked) return true;
  const std::string error = store.add_judgement(judgement_json(all));
  if (!error.empty()) say(stderr, "error: %s\n", error.c_str());
  return true;
}

int stopped_early(const SweepCommand& o, const SweepStore& store) {
  if (!o.quiet) say_progress(store, store.progress());
  print_outcome({OutcomeKind::interrupted, "interrupted", "the same command goes on where this one stopped"});
  return kStopped;
}

}  // namespace

int sweep_into_folder(const SweepCommand& o, const FolderSweep& sweep) {
  const Shard shard = shard_of(o.shard);
  SweepRequest request{
      sweep.asked, {}, sweep.cases, o.chunk.empty() ? 0 : count_asked("--chunk", "cases", o.chunk, 1, kMostInPart)};
  request.model_name = o.model;
  request.units = sweep.pieces.front().table->units();
  for (const SweepColumn& c : sweep.pieces.front().table->columns()) request.columns.push_back(c.name);
  const Refinement refinement = refinement_of(o, sweep, request.columns);
  if (request.chunk == 0) request.chunk = SweepStore::is_there(o.output) ? 1 : cases_in_part(sweep.pieces);
  SweepStore store = SweepStore::open(o.output, request, kProgram);
  if (const std::string& made_by = store.request().program; made_by != kProgram && !store.missing().empty())
    say(stderr, "note: %s was made by %s, and %s computes the parts that are missing: their last digits may differ\n",
        store.folder().c_str(), made_by.empty() ? "another program" : made_by.c_str(), kProgram);
  if (refinement.generations > 0) must_go_on(store, refinement.rule);
  if (!o.chunk.empty() && store.request().chunk != request.chunk)
    say(stderr, "note: the parts of %s have %zu cases; --chunk holds for new folders\n", store.folder().c_str(),
        store.request().chunk);

  bool waits = false, ended = false;  // waits: other shares are missing; ended: no border is left
  for (;;) {
    const Missing now = fill_missing(o, sweep, store, shard);
    if (!now.complete) return now.status == kStopped ? stopped_early(o, store) : now.status;
    if (store.generations().size() > refinement.generations) break;
    store.look_for_generations();
    waits = !store.missing().empty();
    if (waits && shard.of > 1) break;
    if (waits) continue;
    // Another process may have planned the next generation in the meantime.
    if (store.generations().size() > refinement.generations) break;
    if (stop_requested()) return stopped_early(o, store);
    ended = add_generation(store, *sweep.variation, refinement.rule) == 0;
    if (ended) break;
  }
  const SweepStore::Progress p = store.progress();
  if (p.parts == p.all_parts && !judge(sweep, store)) return stopped_early(o, store);
  if (!o.quiet) say_progress(store, p), say_judgement(store, stderr);
  report_stopped(stopped_of(p));
  if (!o.quiet && p.parts < p.all_parts)
    say(stderr, "this share is complete; the others are missing: %zu parts\n", p.all_parts - p.parts);
  if (waits && shard.of > 1) {
    say(stderr, "generation %zu begins when all shares are complete: then give the same commands again\n",
        store.generations().size());
    return kStopped;
  }
  if (!o.quiet && ended) say(stderr, "no border is left after generation %zu\n", store.generations().size() - 1);
  return all_finished(p) ? kOk : kStopped;
}

namespace {

// Prints one line every few seconds until all parts are there, or until Ctrl-C. The speed is computed from the cases
// that were written since the last line.
void watch(SweepStore& store) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kPause{2};
  catch_stop("");
  std::size_t before = 0;
  std::optional<Clock::time_point> last;
  while (!stop_requested()) {
    store.look_for_generations();
    const SweepStore::Progress p = store.progress();
    const Clock::time_point now = Clock::now();
    const double seconds = last ? std::chrono::duration<double>(now - *last).count() : 0;
    const double speed =
        p.cases > before && seconds > 0 ? static_cast<double>(p.cases - before) / seconds : p.cases_per_second;
    std::string rest;
    if (p.parts < p.all_parts && speed > 0)
      rest = "; " + number_text(speed, 3) + " cases/s, " +
             duration(static_cast<double>(p.all_cases - p.cases) / speed) + " left";
    say(stdout, "%zu of %zu parts, %zu of %zu cases%s%s%s\n", p.parts, p.all_parts, p.cases, p.all_cases,
        p.outcomes.empty() ? "" : ": ", list_of_endings(p.outcomes, p.events).c_str(), rest.c_str());
    std::fflush(stdout);
    if (p.parts == p.all_parts) return;
    if (!last || p.cases > before) last = now, before = p.cases;
    for (int k = 0; k < 20 && !stop_requested(); ++k) std::this_thread::sleep_for(kPause / 20.0);
  }
}

}  // namespace

int sweep_status(const SweepFolderCommand& o) {
  SweepStore store = SweepStore::open(o.folder);
  if (o.watch && o.json) throw UsageError{"error: --watch and --json exclude each other\n"};
  if (o.watch) watch(store);
  const SweepStore::Progress p = store.progress();
  if (o.json) {
    JsonWriter j;
    j.open_object().key("folder").string(store.folder());
    const auto count = [&](const char* key, std::size_t n) { j.key(key).integer(static_cast<long long>(n)); };
    count("parts", p.parts), count("all_parts", p.all_parts), count("cases", p.cases), count("all_cases", p.all_cases);
    count("unfinished_files", p.unfinished);
    j.key("cases_per_second").number(number_text(p.cases_per_second));
    j.key("seconds_left").number(number_text(left(p)));
    j.key("outcomes").open_object();
    for (const auto& [outcome, cases] : p.outcomes) count(outcome.c_str(), cases);
    j.close();
    if (!p.events.empty()) {
      j.key("events").open_object();
      for (const auto& [event, cases] : p.events) count(event.c_str(), cases);
      j.close();
    }
    j.key("generations").open_array();
    for (std::size_t g = 0; g < store.generations().size(); ++g) {
      const Generation& of = store.generations()[g];
      j.open_object();
      count("first_case", of.first_case), count("cases", of.cases), count("first_part", of.first_part);
      count("parts", p.parts_there[g]), count("all_parts", of.parts);
      j.close();
    }
    std::string object = j.close().close().text();
    object.resize(object.rfind('\n'));
    hand_out(with_judgement(object + ",\n  \"stopped\": " + stopped_json(stopped_of(p)) + "\n}", store) + "\n");
    return p.parts == p.all_parts ? kOk : kStopped;
  }
  say(stdout, "%s: %zu of %zu parts, %zu of %zu cases\n", store.folder().c_str(), p.parts, p.all_parts, p.cases,
      p.all_cases);
  if (const std::string list = generation_list(store); !list.empty()) say(stdout, "generations: %s\n", list.c_str());
  if (!p.outcomes.empty()) say(stdout, "outcomes: %s\n", list_of_endings(p.outcomes, p.events).c_str());
  report_stopped(stopped_of(p), stdout);
  say_judgement(store, stdout);
  if (p.parts < p.all_parts && p.cases_per_second > 0)
    say(stdout, "lately %.3g cases per second; %s left\n", p.cases_per_second, duration(left(p)).c_str());
  if (p.unfinished > 0)
    say(stdout, "%zu unfinished %s of processes that run or were killed\n", p.unfinished,
        p.unfinished == 1 ? "file" : "files");
  return p.parts == p.all_parts ? kOk : kStopped;
}

int sweep_collect(const SweepFolderCommand& o) {
  const SweepStore store = v1::opened_to_read(o.folder);
  const ResultFormat& format = sweep_format(o.output, o.json);
  const std::vector<std::size_t> parts = store.present();
  if (parts.size() < store.parts() && !o.partial)
    throw UsageError{"error: " + std::to_string(store.parts() - parts.size()) + " of " + std::to_string(store.parts()) +
                     " parts are missing in " + store.folder() +
                     "\nhint: the command of the sweep computes them; --partial collects those that are there\n"};
  SweepInfo info;
  info.origin.title = store.asked("title"), info.origin.created_by = kProgram;
  info.origin.command = o.command_line;
  info.origin.model.push_back({store.folder(), store.asked("model")});
  info.form = store.asked("form").empty() ? "routh" : store.asked("form");
  std::unique_ptr<SweepWriter> file;
  std::size_t cases = 0;
  for (const std::size_t part : parts) {
    const ParquetTable rows = store.read(part);
    if (!file) {
      info.columns = columns_of(rows);
      file = format.open_sweep(o.output, info);
      if (!file->error().empty()) throw UsageError{"error: " + file->error() + "\n"};
    }
    give_rows(rows, info.columns, *file);
    cases += store.range(part).second - store.range(part).first;
    if (!file->error().empty()) break;
  }
  if (!file) throw UsageError{"error: no part is in " + store.folder() + "\n"};
  const SweepStore::Progress p = store.progress();
  const CollectedReport report{stopped_of(p), store.judgement(), cases, finished_of(p), p.events};
  if (const std::string why = file->close(sweep_report_json(report)); !why.empty()) {
    say(stderr, "error: %s\n", why.c_str());
    return kBadInput;
  }
  if (!o.quiet) say_progress(store, p), say_judgement(store, stderr), report_stopped(report.stopped);
  return kOk;
}

}  // namespace anholon::cli
