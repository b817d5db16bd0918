#include "cli/motions/sweep_folder.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include <unistd.h>

#include "base/json.h"
#include "cli/commands.h"
#include "cli/motions/progress.h"
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

// The cases of a part, as they are computed.
class PartWriter final : public SweepWriter {
 public:
  explicit PartWriter(const std::vector<SweepColumn>& columns) : rows_(columns) {}
  const std::string& error() const override { return none_; }
  void row(std::span<const SweepCell> cells) override { rows_.row(cells); }
  std::string close(const std::string&) override { return {}; }
  ParquetTable take() { return rows_.take(); }

 private:
  std::string none_;
  SweepRows rows_;
};

// --shard i/N: every N-th part, from the i-th on.
struct Shard {
  std::size_t number = 1, of = 1;
  bool has(std::size_t part) const { return part % of == number - 1; }
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

constexpr std::size_t kMostInPart = 1'000'000;

// The number of cases that take some seconds on one core: 1, 2 or 5 times a power of ten. By trials of more and more
// cases, whose difference leaves out what each part takes to begin.
std::size_t chunk_by_trial(const FolderSweep& sweep) {
  constexpr double kTrial = 0.2, kPart = 8;  // seconds
  double last = 0, each = 0;                 // seconds of the last trial, of a case
  for (std::size_t count = 16, before = 0; before < sweep.cases; before = count, count *= 4) {
    count = std::min(count, sweep.cases);
    SweepOutput out(std::make_unique<PartWriter>(sweep.columns));
    const EnsembleReport r = sweep.compute(0, count, out);
    const double seconds = r.seconds * static_cast<double>(r.threads);
    each = std::max(seconds - last, 0.0) / static_cast<double>(count - before);
    if (seconds - last >= kTrial || !r.outcome.ok()) break;
    last = seconds;
  }
  const double wanted = std::clamp(kPart / std::max(each, 1e-9), 1.0, static_cast<double>(kMostInPart));
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double digit = wanted / power;
  return static_cast<std::size_t>(power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1));
}

std::size_t chunk_asked(const std::string& word) {
  std::size_t chunk = 0;
  const auto [end, why] = std::from_chars(word.data(), word.data() + word.size(), chunk);
  if (why != std::errc() || end != word.data() + word.size() || chunk < 1 || chunk > kMostInPart)
    throw UsageError{"error: --chunk takes a number of cases from 1 to " + std::to_string(kMostInPart) + ", not '" +
                     word + "'\n"};
  return chunk;
}

// The parts to compute, in the order in which this process takes them. A second process on this machine begins at the
// other end.
std::vector<std::size_t> parts_to_do(const SweepStore& store, const Shard& shard, bool alone) {
  std::vector<std::size_t> list = store.missing();
  std::erase_if(list, [&](std::size_t part) { return !shard.has(part); });
  if (!alone) std::reverse(list.begin(), list.end());
  return list;
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
  for (const SweepColumn& c : sweep.columns) request.columns.push_back(c.name);
  if (request.chunk == 0) request.chunk = SweepStore::is_there(o.output) ? 1 : chunk_by_trial(sweep);
  const SweepStore store = or_refuse([&] { return SweepStore::open(o.output, request, "anholon " ANHOLON_VERSION); });
  if (!o.chunk.empty() && store.request().chunk != request.chunk)
    say(stderr, "note: the parts of %s have %zu cases; --chunk holds for new folders\n", store.folder().c_str(),
        store.request().chunk);

  const WritingClaim claim(store.folder() + "/" + (o.shard.empty() ? "parts" : "shard " + o.shard));
  const std::vector<std::size_t> parts = or_refuse([&] { return parts_to_do(store, shard, claim.error().empty()); });
  const std::size_t all = store.parts();
  std::size_t done = 0;
  std::string error;
  {
    Progress progress(o.quiet, "part", "parts");
    for (const std::size_t part : parts) {
      if (stop_requested()) break;
      std::error_code none;
      // Another process was faster.
      if (!fs::exists(store.path_of(part), none)) {
        auto rows = std::make_unique<PartWriter>(sweep.columns);
        PartWriter& written = *rows;
        SweepOutput out(std::move(rows));
        const auto [from, to] = store.range(part);
        if (!sweep.compute(from, to, out).outcome.ok()) break;  // Ctrl-C: an unfinished part does not count
        error = store.commit(part, written.take());
        if (!error.empty()) break;
      }
      ++done;
      progress(static_cast<double>(done) / static_cast<double>(parts.size()), static_cast<double>(part), done);
    }
  }
  if (!error.empty()) {
    say(stderr, "error: %s\nhint: the parts before it are kept; the same command goes on\n", error.c_str());
    return kBadInput;
  }
  const SweepStore::Progress p = or_refuse([&] { return store.progress(); });
  if (!o.quiet) say_progress(store, p);
  if (done < parts.size()) {
    print_outcome({OutcomeKind::interrupted, "interrupted", "the same command goes on where this one stopped"});
    return kStopped;
  }
  if (!o.quiet && p.parts < all)
    say(stderr, "this share is complete; the others are missing: %zu parts\n", all - p.parts);
  return all_finished(p) ? kOk : kStopped;
}

int sweep_status(const Options& o) {
  const SweepStore store = or_refuse([&] { return SweepStore::open(o.folder); });
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
