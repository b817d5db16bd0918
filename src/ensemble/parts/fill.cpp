#include "ensemble/parts/fill.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <ctime>
#include <deque>
#include <filesystem>
#include <mutex>
#include <random>
#include <thread>

#include "ensemble/store/stopped.h"
#include "result/parquet/parquet_sweep.h"

namespace anholon {

namespace {

bool is_there(const SweepStore& store, std::size_t part) {
  std::error_code none;
  return std::filesystem::exists(store.path_of(part), none);
}

// Writes parts in a thread of its own: while one is written, the next one may wait.
class Committer {
 public:
  explicit Committer(const SweepStore& store) : store_(store), thread_([this] { work(); }) {}
  ~Committer() { finish(); }
  Committer(const Committer&) = delete;
  Committer& operator=(const Committer&) = delete;

  void commit(std::size_t part, ParquetTable rows) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !waiting_; });
    waiting_.emplace(part, std::move(rows));
    changed_.notify_all();
  }
  bool failed() const { return failed_; }
  // Waits for all parts. Returns an empty string, or the reason why one could not be written.
  std::string finish() {
    if (thread_.joinable()) {
      {
        const std::lock_guard lock(mutex_);
        ends_ = true;
      }
      changed_.notify_all();
      thread_.join();
    }
    return error_;
  }
  std::size_t written() const { return written_; }

 private:
  void work() {
    for (std::unique_lock lock(mutex_);;) {
      changed_.wait(lock, [&] { return waiting_ || ends_; });
      if (!waiting_) return;
      auto [part, rows] = *std::move(waiting_);
      waiting_.reset();
      changed_.notify_all();
      if (failed_) continue;
      lock.unlock();
      std::string error = store_.commit(part, std::move(rows));
      lock.lock();
      if (error.empty())
        ++written_;
      else
        error_ = std::move(error), failed_ = true;
    }
  }

  const SweepStore& store_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<std::pair<std::size_t, ParquetTable>> waiting_;
  bool ends_ = false;
  std::atomic<bool> failed_{false};
  std::size_t written_ = 0;
  std::string error_;
  std::thread thread_;  // the last member, because it uses the others
};

// Consecutive cases of a piece among the cases that an ensemble has to compute.
struct Segment {
  std::size_t place = 0;  // the place of its first case among these cases
  std::size_t first = 0;  // the number of that case in the piece
  std::size_t cases = 0;
  std::size_t part = 0;
};

// A list of segments that grows while threads read it.
class Segments {
 public:
  void add(std::size_t first, std::size_t cases, std::size_t part) {
    const std::lock_guard lock(mutex_);
    list_.push_back({list_.empty() ? 0 : list_.back().place + list_.back().cases, first, cases, part});
  }
  Segment at(std::size_t place) const {
    const std::lock_guard lock(mutex_);
    return *(std::upper_bound(list_.begin(), list_.end(), place,
                              [](std::size_t p, const Segment& s) { return p < s.place; }) -
             1);
  }

 private:
  mutable std::mutex mutex_;
  std::vector<Segment> list_;
};

// The cases of a piece are those from `first` to the one before `last`.
struct Place {
  const SweepPiece* piece = nullptr;
  std::size_t first = 0, last = 0;
};

// Collects the rows of a part and passes it on when its last case has come.
class PartSink final : public CaseSink {
 public:
  PartSink(const SweepStore& store, const std::vector<SweepColumn>& columns, Committer& to)
      : store_(store), to_(to), rows_(columns) {}
  void turn_to(const Place& place, const Segments& segments) { place_ = &place, segments_ = &segments, segment_ = {}; }
  void result(const CaseResult& r) override {
    if (r.number >= segment_.place + segment_.cases) segment_ = segments_->at(r.number);
    const std::size_t number = place_->first + segment_.first + (r.number - segment_.place);
    place_->piece->table->rows(r, number, place_->piece->word,
                               [&](std::span<const SweepCell> cells) { rows_.row(cells); });
    count_stopped(stopped_, number, r.outcome);
    if (number + 1 != store_.range(segment_.part).second) return;
    ParquetTable rows = rows_.take();
    if (!stopped_.empty()) rows.notes.emplace_back(SweepStore::kStoppedNote, stopped_json(stopped_));
    stopped_.clear();
    to_.commit(segment_.part, std::move(rows));
  }
  // Drops the rows of an unfinished part.
  void clear() { rows_.take(), stopped_.clear(); }

 private:
  const SweepStore& store_;
  Committer& to_;
  SweepRows rows_;
  StoppedByKind stopped_;  // among these rows
  const Place* place_ = nullptr;
  const Segments* segments_ = nullptr;
  Segment segment_;
};

void add(EnsembleReport& all, const EnsembleReport& next) {
  all.done += next.done, all.finished += next.finished, all.in_workspaces += next.in_workspaces;
  all.most_held = std::max(all.most_held, next.most_held);
  all.seconds += next.seconds, all.threads = next.threads;
  all.replaced.add(next.replaced);
  for (const auto& [name, cases] : next.without_value) all.without_value[name].add(cases);
  if (!next.outcome.ok()) all.outcome = next.outcome;
}

class Filling {
 public:
  Filling(const SweepStore& store, std::span<const SweepPiece> pieces, const FillOptions& options)
      : store_(store), options_(options), committer_(store), sink_(store, pieces.front().table->columns(), committer_) {
    std::size_t first = 0;
    for (const SweepPiece& piece : pieces) {
      places_.push_back({&piece, first, first + piece.options->cases});
      first = places_.back().last;
    }
  }

  Filled operator()() {
    std::deque<std::size_t> across;  // parts with cases of several pieces
    for (const std::size_t part : options_.parts)
      if (std::none_of(places_.begin(), places_.end(), [&](const Place& p) { return has(p, part); }))
        across.push_back(part);
    for (const Place& place : places_)
      if (goes_on()) whole_parts(place);
    for (const std::size_t part : across)
      if (goes_on() && !there(part)) part_across(part);
    filled_.error = committer_.finish();
    filled_.parts = there_ + committer_.written();
    return std::move(filled_);
  }

 private:
  bool stopped() const { return committer_.failed() || (options_.cancelled && options_.cancelled()); }
  bool goes_on() const { return filled_.report.outcome.ok() && !stopped(); }
  bool has(const Place& place, std::size_t part) const {
    const auto [from, to] = store_.range(part);
    return place.first <= from && to <= place.last;
  }
  bool there(std::size_t part) {
    if (!is_there(store_, part)) return false;
    ++there_;
    return true;
  }

  // Computes all parts within one piece as one ensemble.
  void whole_parts(const Place& place) {
    std::deque<std::size_t> left;
    std::size_t cases = 0;
    for (const std::size_t part : options_.parts)
      if (has(place, part)) left.push_back(part), cases += store_.range(part).second - store_.range(part).first;
    compute(place, cases, [&](Segments& segments) -> std::size_t {
      while (!left.empty() && there(left.front())) left.pop_front();
      if (left.empty()) return 0;
      const auto [from, to] = store_.range(left.front());
      segments.add(from - place.first, to - from, left.front());
      left.pop_front();
      return to - from;
    });
  }

  void part_across(std::size_t part) {
    for (const Place& place : places_) {
      const auto [from, to] = store_.range(part);
      const std::size_t begin = std::max(from, place.first), end = std::min(to, place.last);
      bool asked = false;
      if (begin < end && goes_on())
        compute(place, end - begin, [&](Segments& segments) -> std::size_t {
          if (std::exchange(asked, true)) return 0;
          segments.add(begin - place.first, end - begin, part);
          return end - begin;
        });
    }
    sink_.clear();
  }

  void compute(const Place& place, std::size_t cases, const std::function<std::size_t(Segments&)>& more) {
    if (cases == 0) return;
    Segments segments;
    EnsembleOptions o = *place.piece->options;
    o.cases = cases;
    o.more = [&] { return more(segments); };
    o.numbers = [&, &of_piece = place.piece->options->numbers](std::size_t k) {
      const Segment s = segments.at(k);
      return of_piece(s.first + (k - s.place));
    };
    o.estimate = ErrorEstimate::never;
    o.cancelled = [&] { return stopped(); };
    o.progress = [&, before = filled_.report.done](std::size_t done) {
      if (options_.progress) options_.progress(before + done);
    };
    sink_.turn_to(place, segments);
    add(filled_.report, ensemble(*place.piece->scenario, o, sink_));
    if (!filled_.report.outcome.ok()) sink_.clear();
  }

  const SweepStore& store_;
  const FillOptions& options_;
  Committer committer_;
  PartSink sink_;
  std::vector<Place> places_;
  std::size_t there_ = 0;
  Filled filled_;
};

// Ignores the results of a trial.
class NoCases final : public CaseSink {
 public:
  void result(const CaseResult&) override {}
};

}  // namespace

Filled fill(const SweepStore& store, std::span<const SweepPiece> pieces, const FillOptions& options) {
  return Filling(store, pieces, options)();
}

// The seconds of CPU time that some cases of a piece take; nullopt if they were stopped.
static std::optional<double> trial(const SweepPiece& piece, std::size_t cases) {
  NoCases none;
  EnsembleOptions o = *piece.options;
  o.cases = cases;
  o.estimate = ErrorEstimate::never;
  const std::clock_t begin = std::clock();
  if (!ensemble(*piece.scenario, o, none).outcome.ok()) return std::nullopt;
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

std::size_t cases_in_part(std::span<const SweepPiece> pieces) {
  constexpr double kTrial = 0.2, kPart = 8;  // seconds
  constexpr double kNumbers = 2e6;           // numbers in a part: 16 MB
  const SweepPiece& piece = pieces.front();
  const std::size_t all = piece.options->cases;
  std::size_t before = 1;
  std::optional<double> last = trial(piece, before);
  double each = 0;  // the seconds of a case
  for (std::size_t count = 16; last && before < all; count *= 4) {
    count = std::min(count, all);
    const std::optional<double> seconds = trial(piece, count);
    if (!seconds) break;
    each = std::max(*seconds - *last, 0.0) / static_cast<double>(count - before);
    if (*seconds - *last >= kTrial) break;
    before = count, last = seconds;
  }
  const std::size_t numbers = piece.table->columns().size() * std::max<std::size_t>(1, piece.options->at.size());
  const double most = std::clamp(kNumbers / static_cast<double>(numbers), 1.0, static_cast<double>(kMostInPart));
  const double wanted = std::clamp(kPart / std::max(each, 1e-9), 1.0, most);
  const double power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double digit = wanted / power;
  return static_cast<std::size_t>(power * (digit >= 5 ? 5 : digit >= 2 ? 2 : 1));
}

std::vector<std::size_t> parts_to_do(const SweepStore& store, std::size_t share, std::size_t shares) {
  std::vector<std::size_t> list = store.missing();
  std::erase_if(list, [&](std::size_t part) { return part % shares != share - 1; });
  if (!store.made_here()) std::shuffle(list.begin(), list.end(), std::mt19937_64(std::random_device{}()));
  return list;
}

}  // namespace anholon
