#include "cli/motions/sweep_folder.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>

#include "base/json.h"
#include "cli/commands.h"
#include "cli/motions/progress.h"
#include "cli/motions/sweep_output.h"
#include "cli/say.h"
#include "result/file.h"
#include "result/parquet/parquet_sweep.h"

namespace anholon::cli {

namespace {

namespace fs = std::filesystem;

// Throws UsageError for a Failure of a store.
template <class F>
auto or_refuse(const F& f) {
  try {
    return f();
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, {})};
  }
}

// --shard i/N: every N-th part, from the i-th on.
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

std::size_t chunk_asked(const std::string& word) {
  std::size_t chunk = 0;
  const auto [end, why] = std::from_chars(word.data(), word.data() + word.size(), chunk);
  if (why != std::errc() || end != word.data() + word.size() || chunk < 1 || chunk > kMostInPart)
    throw UsageError{"error: --chunk takes a number of cases from 1 to " + std::to_string(kMostInPart) + ", not '" +
                     word + "'\n"};
  return chunk;
}

std::string outcome_list(const std::map<std::string, std::size_t>& outcomes) {
  std::string list;
  for (const auto& [outcome, cases] : outcomes)
    list += (list.empty() ? "" : ", ") + std::to_string(cases) + " " + outcome;
  return list;
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

void say_progress(const SweepStore& store, const SweepStore::Progress& p) {
  say(stderr, "%s: %zu of %zu parts, %zu of %zu cases%s%s\n", store.folder().c_str(), p.parts, p.all_parts, p.cases,
      p.all_cases, p.outcomes.empty() ? "" : ": ", outcome_list(p.outcomes).c_str());
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

int sweep_into_folder(const Options& o, const FolderSweep& sweep) {
  const Shard shard = shard_of(o.shard);
  SweepRequest request{sweep.asked, {}, sweep.cases, o.chunk.empty() ? 0 : chunk_asked(o.chunk)};
  for (const SweepColumn& c : sweep.pieces.front().table->columns()) request.columns.push_back(c.name);
  if (request.chunk == 0) request.chunk = SweepStore::is_there(o.output) ? 1 : cases_in_part(sweep.pieces);
  const SweepStore store = or_refuse([&] { return SweepStore::open(o.output, request, "anholon " ANHOLON_VERSION); });
  if (!o.chunk.empty() && store.request().chunk != request.chunk)
    say(stderr, "note: the parts of %s have %zu cases; --chunk holds for new folders\n", store.folder().c_str(),
        store.request().chunk);

  FillOptions fill_options;
  fill_options.parts = or_refuse([&] { return parts_to_do(store, shard.number, shard.of); });
  fill_options.cancelled = stop_requested;
  std::size_t cases = 0;
  for (const std::size_t part : fill_options.parts) cases += store.range(part).second - store.range(part).first;
  Filled filled;
  {
    Progress progress(o.quiet, "case", "cases");
    fill_options.progress = [&](std::size_t done) {
      progress(static_cast<double>(done) / static_cast<double>(cases), static_cast<double>(done), done);
    };
    if (cases > 0) filled = fill(store, sweep.pieces, fill_options);
  }
  if (!filled.error.empty()) {
    say(stderr, "error: %s\nhint: the parts before it are kept; the same command goes on\n", filled.error.c_str());
    return kBadInput;
  }
  const SweepStore::Progress p = or_refuse([&] { return store.progress(); });
  if (!o.quiet) say_progress(store, p);
  if (filled.parts < fill_options.parts.size()) {
    print_outcome({OutcomeKind::interrupted, "interrupted", "the same command goes on where this one stopped"});
    return kStopped;
  }
  if (!o.quiet && p.parts < p.all_parts)
    say(stderr, "this share is complete; the others are missing: %zu parts\n", p.all_parts - p.parts);
  return all_finished(p) ? kOk : kStopped;
}

namespace {

// Prints one line every few seconds until all parts are there, or Ctrl-C. What was written since the last line tells how
// fast the cases come now.
void watch(const SweepStore& store) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kPause{2};
  catch_stop("");
  std::size_t before = 0;
  std::optional<Clock::time_point> last;
  while (!stop_requested()) {
    const SweepStore::Progress p = or_refuse([&] { return store.progress(); });
    const Clock::time_point now = Clock::now();
    const double seconds = last ? std::chrono::duration<double>(now - *last).count() : 0;
    const double speed =
        p.cases > before && seconds > 0 ? static_cast<double>(p.cases - before) / seconds : p.cases_per_second;
    std::string rest;
    if (p.parts < p.all_parts && speed > 0)
      rest = "; " + number_text(speed, 3) + " cases/s, " +
             duration(static_cast<double>(p.all_cases - p.cases) / speed) + " left";
    say(stdout, "%zu of %zu parts, %zu of %zu cases%s%s%s\n", p.parts, p.all_parts, p.cases, p.all_cases,
        p.outcomes.empty() ? "" : ": ", outcome_list(p.outcomes).c_str(), rest.c_str());
    std::fflush(stdout);
    if (p.parts == p.all_parts) return;
    if (!last || p.cases > before) last = now, before = p.cases;
    for (int k = 0; k < 20 && !stop_requested(); ++k) std::this_thread::sleep_for(kPause / 20.0);
  }
}

}  // namespace

int sweep_status(const Options& o) {
  const SweepStore store = or_refuse([&] { return SweepStore::open(o.folder); });
  if (o.watch && o.json) throw UsageError{"error: --watch and --json exclude each other\n"};
  if (o.watch) watch(store);
  const SweepStore::Progress p = or_refuse([&] { return store.progress(); });
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
    hand_out(j.close().close().text() + "\n");
    return p.parts == p.all_parts ? kOk : kStopped;
  }
  say(stdout, "%s: %zu of %zu parts, %zu of %zu cases\n", store.folder().c_str(), p.parts, p.all_parts, p.cases,
      p.all_cases);
  if (!p.outcomes.empty()) say(stdout, "outcomes: %s\n", outcome_list(p.outcomes).c_str());
  if (p.parts < p.all_parts && p.cases_per_second > 0)
    say(stdout, "lately %.3g cases per second; %s left\n", p.cases_per_second, duration(left(p)).c_str());
  if (p.unfinished > 0)
    say(stdout, "%zu unfinished %s of processes that run or were killed\n", p.unfinished,
        p.unfinished == 1 ? "file" : "files");
  return p.parts == p.all_parts ? kOk : kStopped;
}

int sweep_collect(const Options& o) {
  const SweepStore store = or_refuse([&] { return SweepStore::open(o.folder); });
  const ResultFormat& format = sweep_format(o);
  const std::vector<std::size_t> parts = or_refuse([&] { return store.present(); });
  if (parts.size() < store.parts() && !o.partial)
    throw UsageError{"error: " + std::to_string(store.parts() - parts.size()) + " of " + std::to_string(store.parts()) +
                     " parts are missing in " + store.folder() +
                     "\nhint: the command of the sweep computes them; --partial collects those that are there\n"};
  SweepInfo info;
  info.origin.title = store.asked("title"), info.origin.created_by = "anholon " ANHOLON_VERSION;
  info.origin.command = o.command_line;
  info.origin.model.push_back({store.folder(), store.asked("model")});
  info.form = store.asked("form");
  std::unique_ptr<SweepWriter> file;
  std::size_t cases = 0;
  for (const std::size_t part : parts) {
    const ParquetTable rows = or_refuse([&] { return store.read(part); });
    if (!file) {
      info.columns = columns_of(rows);
      file = format.open_sweep(o.output, info);
      if (!file->error().empty()) throw UsageError{"error: " + file->error() + "\n"};
    }
    or_refuse([&] { return give_rows(rows, info.columns, *file), 0; });
    cases += store.range(part).second - store.range(part).first;
    if (!file->error().empty()) break;
  }
  if (!file) throw UsageError{"error: no part is in " + store.folder() + "\n"};
  const SweepStore::Progress p = or_refuse([&] { return store.progress(); });
  JsonWriter j;
  j.open_object().key("cases").integer(static_cast<long long>(cases)).key("outcomes").open_object();
  for (const auto& [outcome, count] : p.outcomes) j.key(outcome).integer(static_cast<long long>(count));
  if (const std::string why = file->close(j.close().close().text()); !why.empty()) {
    say(stderr, "error: %s\n", why.c_str());
    return kBadInput;
  }
  if (!o.quiet) say_progress(store, p);
  return kOk;
}

}  // namespace anholon::cli
