// Motions of a kernel, step by step: they are loaded, expanded, advanced and read.
#include <algorithm>
#include <bit>
#include <utility>

#include "kernel/kernel.h"

namespace anholon {

void Kernel::place(int lane, const std::vector<long double>& state, const std::vector<long double>& leading) {
  const KernelTables& t = plan_->tables();
  const std::uint32_t n = t.state_size, m = static_cast<std::uint32_t>(plan_->plan().x.size());
  bool same = true;
  const auto put = [&](std::uint32_t at, double x) {
    double& there = number(at, lane);
    same = same && std::bit_cast<std::uint64_t>(there) == std::bit_cast<std::uint64_t>(x);
    there = x;
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    const double high = static_cast<double>(state[i]);
    put(next_ + i, high);
    put(next_ + n + i, static_cast<double>(state[i] - high));
  }
  for (std::uint32_t j = 0; j < m; ++j) put(next_ + 2 * n + j, leading.empty() ? 0 : static_cast<double>(leading[j]));
  // A state that was read and written back unchanged keeps the next expansion.
  if (!same) drop_next();
  gone_on_ = true;
}

// True if two doubles are the parts of their sum in long double: the larger one is the rounded sum, and the other one a
// multiple of the last digit of a long double beside it. The answer is exact, although it is computed in doubles.
static bool is_rounded_sum(double high, double low) {
  constexpr double kLastDigits = 1.5 * 0x1p-11;
  const double grid = std::bit_cast<double>(std::bit_cast<std::uint64_t>(high) & 0x7ff0000000000000ULL) * kLastDigits;
  return high + low == high && (low + grid) - grid == low && std::bit_cast<std::uint64_t>(low) != 1ULL << 63;
}

void Kernel::round_state(int lane) {
  if (!gone_on_) return;
  bool same = true;
  for (std::uint32_t i = 0; i < plan_->tables().state_size; ++i) {
    double &high = number(next_ + i, lane), &low = number(next_ + plan_->tables().state_size + i, lane);
    if (is_rounded_sum(high, low)) continue;
    const long double sum = static_cast<long double>(high) + low;
    const double rounded = static_cast<double>(sum), rest = static_cast<double>(sum - rounded);
    same = same && rounded == high && std::bit_cast<std::uint64_t>(rest) == std::bit_cast<std::uint64_t>(low);
    high = rounded, low = rest;
  }
  if (!same) drop_next();
}

void Kernel::start_expansion() {
  if (started_) {
    if (shows_last_) swap_low_orders();
  } else {
    start(code());
  }
  shows_last_ = true;
  started_ = gone_on_ = false;
  next_ = std::exchange(before_, std::exchange(begun_, next_));
  base_ = begun_;
}

void Kernel::keep_projected() {
  if (!moved_) return;
  arithmetic_->adopt(slot(begun_));
  base_ = plan_->tables().projected;
}

void Kernel::begin_point() {
  start_expansion();
  keep_times();
  arithmetic_->quadratures();
  keep_projected();
}

void Kernel::begin() {
  start_expansion();
  const Code* code = this->code();
  extend(code);
  keep_projected();
  if (code)
    code->measure(arena_);
  else
    arithmetic_->measure();
}

// Starts the expansion at the next place.
void Kernel::start(const Code* code) {
  if (code)
    code->begin(arena_, slot(next_));
  else
    arithmetic_->begin(slot(next_));
  moved_ = solve(code, true);
}

// Calls of a copying function would take longer than the few copies.
void Kernel::keep_low_orders() {
  double* to = aside_.data();
  const std::size_t lanes = static_cast<std::size_t>(lanes_);
  if (lanes_ == 1)
    for (const std::uint32_t at : low_numbers_) *to++ = arena_[at];
  else
    for (const LowOrders& low : low_orders_) to = std::copy_n(slot(low.at), low.count * lanes, to);
}

void Kernel::start_next() {
  keep_low_orders();
  start(code());
  arithmetic_->compare(slot(next_));
  started_ = true;
  shows_last_ = false;
}

void Kernel::swap_low_orders() const {
  double* aside = aside_.data();
  const std::size_t lanes = static_cast<std::size_t>(lanes_);
  for (const LowOrders& low : low_orders_) {
    double* there = arena_ + low.at * lanes;
    std::swap_ranges(there, there + low.count * lanes, aside);
    aside += low.count * lanes;
  }
  shows_last_ = !shows_last_;
}

void Kernel::advance() {
  drop_next();
  if (const Code* code = this->code()) {
    code->go_on(arena_, slot(base_), slot(next_));
  } else {
    arithmetic_->advance();
    arithmetic_->go_on(slot(base_), slot(next_));
  }
  gone_on_ = true;
}

void Kernel::sum_up(std::uint32_t at, int lane, std::vector<long double>& state) const {
  const std::uint32_t n = plan_->tables().state_size;
  state.resize(n);
  for (std::uint32_t i = 0; i < n; ++i)
    state[i] = static_cast<long double>(number(at + i, lane)) + number(at + n + i, lane);
}

void Kernel::fetch(int lane, Moment moment, std::vector<long double>& state, std::vector<long double>& leading) const {
  const std::uint32_t at = moment == Moment::before            ? before_
                           : moment == Moment::now && gone_on_ ? next_
                                                               : begun_,
                      m = static_cast<std::uint32_t>(plan_->plan().x.size());
  sum_up(moment == Moment::now && !gone_on_ ? base_ : at, lane, state);
  leading.resize(m);
  for (std::uint32_t j = 0; j < m; ++j) leading[j] = number(at + 2 * plan_->tables().state_size + j, lane);
}

void Kernel::fetch_base(int lane, std::vector<long double>& state) const { sum_up(base_, lane, state); }

// Each unknown has two increments: that of its value and that of its derivative.
void Kernel::fetch_changed(int lane, std::vector<long double>& state) const {
  const std::uint32_t n = plan_->tables().state_size;
  const std::size_t stride = 2 * static_cast<std::size_t>(lanes_);
  const double* increment = increments(lane);
  state.resize(n);
  for (std::uint32_t i = 0; i < n; ++i, increment += stride)
    state[i] = static_cast<long double>(number(base_ + i, lane)) + number(base_ + n + i, lane) + *increment;
}

// The even and the odd terms are two sums, because a sum waits for its last term.
double Kernel::integral(std::size_t i, int lane) const {
  const LastSeries& q = quadratures_[i];
  const KernelTables& t = plan_->tables();
  const double h = number(t.step, lane);
  if (constant_quadrature(i)) return quadrature(i, 0, lane) * h;
  const std::size_t lanes = static_cast<std::size_t>(lanes_);
  const std::uint32_t count = static_cast<std::uint32_t>(plan_->plan().stages) + 1;
  const double *numbers = arena_ + q.at * lanes + static_cast<std::size_t>(lane),
               *reciprocal = t.order.reciprocal.data() + 1;
  const double square = h * h;
  // The orders below this one may be beside the series, and that of 0 is the time if t itself is the quadrature.
  const std::uint32_t low = std::max<std::uint32_t>(1, shows_last_ ? 0 : std::min(q.count, count));
  double even = 0, odd = 0;
  std::uint32_t k = count;
  const auto term = [&](std::uint32_t order) { return numbers[order * lanes] * reciprocal[order]; };
  const auto low_term = [&](std::uint32_t order) {
    const double number = order == 0 ? quadrature(i, 0, lane) : last(q, order, lane);
    return number * reciprocal[order];
  };
  if (count % 2 != 0) --k, even = k < low ? low_term(k) : term(k);
  for (; k >= low + 2; k -= 2) {
    odd = odd * square + term(k - 1);
    even = even * square + term(k - 2);
  }
  for (; k > 0; k -= 2) {
    odd = odd * square + (k - 1 < low ? low_term(k - 1) : term(k - 1));
    even = even * square + low_term(k - 2);
  }
  return (even + odd * h) * h;
}

void Kernel::change_over_step() {
  show_last();
  if (const Code* code = this->code())
    code->advance(arena_);
  else
    arithmetic_->advance();
}

}  // namespace anholon
