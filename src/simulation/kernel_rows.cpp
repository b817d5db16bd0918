#include "simulation/kernel_rows.h"

#include <algorithm>
#include <array>
#include <bit>

namespace anholon {

namespace {

// True for the rows that the residual report checks: the first ones, then ever fewer, so that checks do not dominate
// the time of a run.
bool looked_at(std::size_t row) {
  constexpr std::size_t kFirst = 128;
  return row % std::bit_ceil(row / kFirst + 1) == 0;
}

// The rows in a block, and the number of rows from which a second thread pays.
constexpr std::size_t kTogether = 256, kFew = 512;
// The steps without rows that are passed on together.
constexpr std::size_t kSteps = 4096;

// Returns the number of blocks under way for states of `numbers` numbers. At first the rows are slower than the motion,
// because the reference checks many of them, and later the motion is slower; so the motion runs ahead, as far as the
// memory for waiting rows allows.
std::size_t blocks_of(std::size_t numbers) {
  constexpr std::size_t kMemory = std::size_t{8} << 20, kFewest = 8, kMost = 64;
  const std::size_t row = sizeof(WaitingBlock::Waiting) + 2 * numbers * sizeof(long double);
  return std::clamp(kMemory / (kTogether * row), kFewest, kMost);
}

// Returns the sizes whose round-off each number of the state has: its own size, and that of its change in the time t at
// its present rate, because the time of a row is rounded. A velocity that passes zero has an error of the second kind.
std::vector<long double> sizes_of_round_off(const RowPlace& place, const std::vector<int>& orders) {
  std::vector<long double> sizes;
  for (std::size_t j = 0; j < orders.size(); ++j)
    for (int k = 0; k < orders[j]; ++k) {
      const std::size_t i = sizes.size();
      const long double rate = k + 1 < orders[j] ? place.state[i + 1] : place.leading[j];
      sizes.push_back(std::abs(place.state[i]) + std::abs(place.t * rate));
    }
  return sizes;
}

}  // namespace

// The program of the motion is copied, because the motion may rewrite its equations later.
KernelRows::KernelRows(Workspace& s, const SimulationOptions& o, const Motion<double>& motion, int stages,
                       std::shared_ptr<WaitingRows> waiting, const RowTakers& takers)
    : s_(s), o_(o), takers_(takers), waiting_(std::move(waiting)), stages_(stages), program_(motion.program()),
      point_(program_, motion.parameters(), std::max(1, stages)),
      check_(columns_after_time(s, largest_order(s, program_.d))),
      work_(std::vector<Block>(blocks_of(point_.state_size()), Block(kTogether)),
            [this](Block& block) { work(block); }) {
  program_.system = &s.system;
}

void KernelRows::add(const Motion<double>& motion, long double t, const std::string& label, bool judged) {
  note(motion, t, label, judged ? Block::Use::judged_row : Block::Use::row);
}

void KernelRows::look(const Motion<double>& motion, long double t) { note(motion, t, "", Block::Use::look); }

void KernelRows::note(const Motion<double>& motion, long double t, const std::string& label, Block::Use use) {
  Block& block = work_.filling();
  block.rows.add(motion, t, label);
  block.uses.push_back(use);
  if (++noted_ > kFew) work_.work_beside();
  if (block.rows.full()) pass_on();
}

void KernelRows::step(double end) {
  Block& block = work_.filling();
  block.steps.push_back({end, block.rows.size()});
  if (block.steps.size() >= kSteps) pass_on();
}

Outcome KernelRows::settle() {
  pass_on();
  work_.settle();
  failed_ = false;
  return std::exchange(trouble_, {});
}

void KernelRows::set_parameters(const std::vector<long double>& parameters) {
  if (parameters == point_.parameters()) return;
  waiting_->set_parameters(parameters);
  point_.set_parameters(parameters);
}

std::optional<Warning> KernelRows::warning() const {
  const auto found = check_.found();
  if (!found) return std::nullopt;
  return Warning{"the rows differ from the state solved for again in wider numbers: " + found->column + " by " +
                     number_text(found->difference, 3) +
                     " of the largest number of its kind at t = " + number_text(found->t, 6),
                 "trust the columns of this kind no further; please report the model, as this is a bug of anholon"};
}

void KernelRows::tell_steps(Block& block) {
  for (; block.told < block.steps.size() && block.steps[block.told].rows <= block.taken; ++block.told)
    takers_.writer.step(block.steps[block.told].t);
}

// Works on a block. After a row without a solution no rows are computed.
void KernelRows::work(Block& block) {
  block.taken = block.told = 0;
  if (!failed_)
    waiting_->compute(block.rows, [&](const WaitingRows::Computed& row) {
      tell_steps(block);
      const Block::Use use = block.uses[block.taken];
      if (use == Block::Use::look)
        look(row);
      else
        trouble_ = take(row, use == Block::Use::judged_row);
      if (!trouble_.ok()) failed_ = true;
      ++block.taken;
      return trouble_.ok() && !(o_.rows_lost && o_.rows_lost());
    });
  count_doubtful();
  if (!failed_) block.taken = block.uses.size();
  tell_steps(block);
  block.rows.clear(), block.uses.clear(), block.steps.clear();
}

Outcome KernelRows::take(const WaitingRows::Computed& row, bool judged) {
  const RowPlace& place = row.place();
  const bool good = row.good();
  Watch<long double>& watch = takers_.watch;
  const bool looks = !good || looked_at(takers_.writer.rows());
  if (looks) {
    if (Outcome o = settle_at(point_, place, stages_ > 0); !o.ok()) return o;
    ++takers_.report.rows_looked_at;
    if (Outcome o = watch.see(point_, takers_.report); !o.ok()) return o;
    row_values(s_, largest_order(s_, program_.d), point_, watch, wide_);
  } else {
    watch.track([&](std::size_t k) { return row.sum(k); }, [&](std::size_t k) { return row.terms(k); });
  }
  if (good)
    row.numbers(numbers_);
  else
    numbers_.assign(wide_.begin(), wide_.end());
  if (looks && good) compare(row);
  takers_.judge.row(place.t, row.label(), numbers_, judged);
  const auto multiplier = [&](std::size_t r) {
    return good ? row.multiplier(r) : static_cast<double>(watch.multiplier(r));
  };
  if (takers_.floors) takers_.floors->see(static_cast<double>(place.t), multiplier, numbers_);
  takers_.writer.row(place.t, row.label(), numbers_);
  ++takers_.report.rows;
  return {};
}

// A point without a solution is skipped: if a row needs the point, that row ends the motion.
void KernelRows::look(const WaitingRows::Computed& row) {
  if (row.good())
    takers_.watch.track_ranges([&](std::size_t i) { return row.monitor(i); });
  else if (settle_at(point_, row.place(), stages_ > 0).ok())
    takers_.watch.look_at_ranges(point_);
}

// A row whose numbers differ by more than round-off is noted, and computed again when the kernel is free.
void KernelRows::compare(const WaitingRows::Computed& row) {
  twice_.t = static_cast<double>(row.place().t);
  twice_.written = numbers_;
  twice_.solved = wide_;
  twice_.cancellation = takers_.watch.cancellation();
  twice_.made_of.clear();
  for (std::size_t i = 0; i < s_.model->monitors.size(); ++i)
    twice_.made_of.push_back(takers_.watch.made_of_monitor(i));
  if (check_.doubts(twice_)) doubtful_.push_back({row.place(), twice_});
}

void KernelRows::count_doubtful() {
  for (const Doubtful& d : doubtful_) check_.count(d.row, of_round_off(d.place, d.row.written));
  doubtful_.clear();
}

std::vector<double> KernelRows::of_round_off(const RowPlace& place, const std::vector<double>& numbers) {
  constexpr long double kRoundoff = 0x1p-52L;
  // The signs are those of four independent changes, because one change alone may leave a column unchanged.
  constexpr std::array<std::size_t, 4> kSigns = {0, 1, 2, 3};
  std::vector<double> changes(numbers.size(), 0), other;
  const std::vector<long double> sizes = sizes_of_round_off(place, program_.d);
  WaitingBlock block(kSigns.size());
  for (const std::size_t signs : kSigns) {
    RowPlace changed = place;
    changed.t *= 1 + (signs % 2 == 0 ? kRoundoff : -kRoundoff);
    for (std::size_t i = 0; i < changed.state.size(); ++i)
      changed.state[i] += (std::popcount(i & signs) % 2 == 0 ? kRoundoff : -kRoundoff) * sizes[i];
    block.add(changed);
  }
  waiting_->compute(block, [&](const WaitingRows::Computed& row) {
    row.numbers(other);
    for (std::size_t j = 0; j < numbers.size(); ++j) {
      // The root of a number near 0 may have no value after a change.
      const bool lost = std::isnan(other[j]) != std::isnan(numbers[j]);
      const double change = lost ? std::numeric_limits<double>::infinity() : std::abs(other[j] - numbers[j]);
      changes[j] = std::max(changes[j], change);
    }
    return true;
  });
  return changes;
}

}  // namespace anholon
