#include "kernel/kernel.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "base/assert.h"
#include "kernel/latency.h"
#include "tape/function_value.h"

namespace anholon {

namespace {

// The samples for the choice of pivots are within this distance of the given state: an angle may take any value.
constexpr double kAround = 3.3;
// An operation that waits for the previous one costs as much as this number of others: measured on small systems and
// chains.
constexpr double kWaiting = 5;
// The limits of steps of a stage and of operations of the elimination: beyond them machine code is made in pieces, for
// one lane; the compilation as a whole would take more than some five seconds.
constexpr std::size_t kMostCompiled = 1000, kMostEliminated = 12000;
// The limits for code in pieces; it takes 2 (128 links) to 10 ms (512, refined) a link of a chain.
constexpr std::size_t kMostInPieces = 100'000, kMostEliminatedInPieces = 1'000'000;
// The inverse of J replaces an elimination if it has at most this number of entries: it has more operations, but they
// do not wait for each other. It is tried first for all that a stage needs, then for the unknowns alone.
constexpr std::size_t kMostInfluences = 64;
constexpr std::size_t kMostInfluencesOfUnknowns = 48 * 48, kMostInLanes = 100;
// Solutions are refined if that changes them by more than this. Below, at the tightest tolerance, refinement improves
// motions by a factor of two at most, mostly not at all (chains of 8 to 64 links, whose solutions it changes by 8 to
// 360 round-offs: bench/RESULTS.md).
constexpr double kRefined = 512 * 0x1p-53;

// The most histories that the pieces of a long plan sum: for each lead in a piece, a multiple of those at once.
std::uint32_t histories_in_pieces(const Plan& p) {
  std::size_t count = 0;
  for (const Step& s : p.stage) {
    if (s.act == Act::power || s.act == Act::sine_cosine || s.act == Act::arctan2) count += 2;
    if (s.act == Act::multiply || s.act == Act::square || s.act == Act::divide || s.act == Act::square_root ||
        s.act == Act::function)
      ++count;
  }
  const std::size_t pieces = p.stage.size() / kStepsOfPiece + 1, leads = static_cast<std::size_t>(p.largest_lead) + 1;
  return static_cast<std::uint32_t>(count + pieces * leads * (kHistoriesAtOnce - 1));
}

// Numbers in [-1, 1) from a counter (a step of splitmix64).
double scattered(std::uint64_t i) {
  std::uint64_t z = (i + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
}

}  // namespace

double looked_up(const double* knots, std::int64_t count, const double* values, double x) {
  return values[std::upper_bound(knots, knots + count, x) - knots];
}

double power_of(double x, double exponent) {
  return exponent == -0.5   ? 1 / std::sqrt(x)
         : exponent == 1.5  ? x * std::sqrt(x)
         : exponent == -1.5 ? 1 / (x * std::sqrt(x))
                            : std::pow(x, exponent);
}

double function_of(std::uint32_t function, double x) { return function_value(static_cast<Function>(function), x); }

void sine_and_cosine(double x, double& sine, double& cosine) { ::sincos(x, &sine, &cosine); }

const std::vector<Tier>& tiers() {
  static const std::vector<Tier> list = [] {
    std::vector<Tier> all{tier_plain};
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) all.push_back(tier_avx2);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
      all.push_back(tier_avx512);
    return all;
  }();
  return list;
}

const Tier& tier_of(int lanes) {
  const std::vector<Tier>& all = tiers();
  const auto found =
      std::find_if(all.rbegin(), all.rend(), [&](const Tier& t) { return lanes == 1 || t.lanes == lanes; });
  ANHOLON_ASSERT(found != all.rend());
  return *found;
}

int lanes_at_first() {
  int lanes = 1;
  for (const Tier& t : tiers())
    if (translated_at_first(t.lanes)) lanes = std::max(lanes, t.lanes);
  return lanes > 1 ? lanes : tiers().back().lanes;
}

void KernelTables::Divisors::add(long double n) {
  const long double reciprocal_of_n = n > 0 ? static_cast<double>(1 / n) : 0;
  number.push_back(static_cast<double>(n));
  reciprocal.push_back(static_cast<double>(reciprocal_of_n));
  beyond.push_back(n > 0 ? static_cast<double>(std::fma(-reciprocal_of_n, n, 1.0L) / n) : 0);
}

KernelPlan::KernelPlan(std::shared_ptr<const Program> program, std::shared_ptr<const StateMap> map, bool judged,
                       int stages, Company company)
    : program_(std::move(program)), map_(std::move(map)), plan_(anholon::plan(*program_, stages, judged)),
      company_(company) {
  for (int d : plan_.d) tables_.state_size += static_cast<std::uint32_t>(d);
  levels_ = *std::max_element(plan_.c.begin(), plan_.c.end());
  tables_.plan = &plan_;
  tables_.elimination = &elimination_;
  for (const StepFunction& f : program_->tape.step_functions) {
    KernelTables::Knots k;
    for (const Rational& r : f.knots) k.at.push_back(from_rational<double>(r));
    for (const Rational& r : f.values) k.values.push_back(from_rational<double>(r));
    tables_.knots.push_back(std::move(k));
  }
  long double factorial = 1;
  for (std::uint32_t k = 0; k < plan_.stride + 8; ++k) {
    if (k > 0) factorial *= k;
    tables_.factorial.push_back(static_cast<double>(factorial));
    tables_.inverse_factorial.push_back(static_cast<double>(1 / factorial));
    tables_.order.add(k);
  }
  tables_.orders = plan_.stride;
  for (int m = 0; m <= kMostRising; ++m)
    for (std::size_t s = 0; s < tables_.orders; ++s) {
      long double r = 1;
      for (int i = 1; i <= m; ++i) r *= static_cast<long double>(s) + i;
      tables_.rising_.add(r);
    }
}

void KernelPlan::lay_out() {
  const auto even = [](std::uint32_t x) { return (x + 7) / 8 * 8; };
  tables_.lu = even(plan_.arena);
  tables_.reciprocal = tables_.lu + elimination_.entries;
  tables_.inverse = tables_.reciprocal + static_cast<std::uint32_t>(elimination_.pivots.size());
  tables_.rhs = tables_.inverse + static_cast<std::uint32_t>(elimination_.influences.size());
  tables_.side = tables_.rhs + plan_.rows;
  tables_.solution = tables_.side + static_cast<std::uint32_t>(plan_.roots.size());
  tables_.refined = tables_.solution + plan_.rows;
  tables_.entries = tables_.refined + plan_.rows;
  tables_.step = tables_.entries + (tables_.keeps_entries() ? static_cast<std::uint32_t>(plan_.entries.size()) : 0);
  tables_.weights = tables_.step + 1;
  tables_.increments = tables_.weight(plan_.largest_d + 1, 0);
  std::uint32_t at = tables_.increments + tables_.state_size + static_cast<std::uint32_t>(plan_.x.size());
  const auto take = [&](std::uint32_t count) { return std::exchange(at, at + count); };
  for (std::uint32_t& place : tables_.motions) place = take(tables_.motion_size());
  tables_.projected = take(2 * tables_.state_size);
  tables_.margin = take(1);
  tables_.inverse_pivots = take(static_cast<std::uint32_t>(elimination_.pivots.size()) + (plan_.determinant ? 1 : 0));
  Findings& f = tables_.found;
  for (std::uint32_t* place :
       {&f.health, &f.determinant, &f.drift, &f.weight, &f.moved, &f.reach, &f.unfit, &f.largest, &f.defect, &f.hidden})
    *place = take(1);
  at = even(at);
  tables_.sums = is_long() ? take(kSumsOfHistory * histories_in_pieces(plan_)) : 0;
  tables_.size = even(at);
}

bool KernelPlan::is_long() const {
  const std::size_t substitution = elimination_.forward.size() + elimination_.terms.size();
  return company_ == Company::alone && elimination_.influences.empty() &&
         (plan_.stage.size() > kMostCompiled ||
          elimination_.update_list.size() + substitution * (tables_.refine ? 3 : 1) > kMostEliminated);
}

std::shared_ptr<const KernelPlan> KernelPlan::make(std::shared_ptr<const Program> program, int stages,
                                                   const std::vector<long double>& parameters, double t,
                                                   const std::vector<double>& state, Company company) {
  return make(std::move(program), nullptr, false, stages, parameters, t, state, company);
}

std::shared_ptr<const KernelPlan> KernelPlan::make(std::shared_ptr<const Program> program,
                                                   std::shared_ptr<const StateMap> map, bool judged, int stages,
                                                   const std::vector<long double>& parameters, double t,
                                                   const std::vector<double>& motion, Company company) {
  if (!no_plan(*program).empty()) return nullptr;
  std::vector<double> state = motion;
  if (map) {
    std::vector<long double> own;
    StateReader(*map, parameters).own(t, {motion.begin(), motion.end()}, own);
    state.assign(own.begin(), own.end());
  }
  std::shared_ptr<KernelPlan> p(new KernelPlan(std::move(program), std::move(map), judged, stages, company));
  // The state itself decides whether solutions need refinement.
  p->tables_.refine = true;
  const Sampled sampled = p->choose_pivots(parameters, t, state);
  if (sampled.elimination.lu.pivots.empty()) return nullptr;
  p->solve_by(sampled);
  Kernel probe(p);
  probe.set_parameters(0, parameters);
  probe.load<double>(0, t, state, {});
  if (probe.correction_of_solution() > kRefined) return p;
  p->tables_.refine = false;
  p->solve_by(sampled);
  return p;
}

// Samples the state and points around it, so that no pivot is chosen that vanishes later in the motion.
KernelPlan::Sampled KernelPlan::choose_pivots(const std::vector<long double>& parameters, double t,
                                              const std::vector<double>& state) {
  lay_out();
  Sampled out;
  std::vector<SampledEntry>& entries = out.entries;
  for (const Entry& e : plan_.entries) {
    const bool exact = e.from < plan_.coefficients.size() &&
                       (plan_.coefficients[e.from].one() || plan_.coefficients[e.from].minus_one());
    entries.push_back({e.row, e.column, {}, exact});
  }
  std::vector<double> arena(tables_.size, 0.0);
  const std::vector<double> coefficients = CoefficientValues(plan_, *program_, parameters).rounded();
  std::copy(coefficients.begin(), coefficients.end(), arena.begin());
  const std::unique_ptr<Arithmetic> arithmetic = tier_plain.make(tables_, arena.data(), 1);
  std::size_t samples = 0;
  for (std::uint64_t attempt = 0; attempt < 3 * kSamples && samples < kSamples; ++attempt) {
    std::size_t i = 0;
    for (std::size_t j = 0; j < plan_.d.size(); ++j) {
      for (int k = 0; k < plan_.d[j]; ++k, ++i)
        arena[plan_.x[j] + static_cast<std::uint32_t>(k)] =
            (state[i] + (attempt == 0 ? 0 : kAround * scattered(64 * attempt + i))) *
            tables_.inverse_factorial[static_cast<std::size_t>(k)];
      arena[plan_.x[j] + static_cast<std::uint32_t>(plan_.d[j])] = 0;
    }
    arena[plan_.time] = t;
    arena[plan_.time + 1] = 1;
    arithmetic->values(-plan_.largest_lead);
    bool good = true;
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const double value = plan_.entries[e].sign * arena[plan_.entries[e].from];
      good = good && std::isfinite(value);
      entries[e].value[samples] = value;
    }
    if (good)
      ++samples;
    else if (attempt == 0)
      return out;
    if (attempt == 0 && plan_.determinant) out.determinant = arena[plan_.determinant->at];
  }
  // The system may be singular at a sample: use fewer samples then.
  for (; samples > 0; --samples) {
    out.elimination = eliminate_sparse(plan_.rows, entries, samples);
    if (!out.elimination.lu.pivots.empty()) break;
  }
  for (SparseLu::Pivot& p : out.elimination.lu.pivots)
    for (std::size_t k = samples; k < kSamples; ++k) p.value[k] = p.value[0];
  return out;
}

// Prepares solutions with these pivots, refined or not; by the inverse if it is small.
void KernelPlan::solve_by(const Sampled& sampled) {
  std::vector<bool> needed(plan_.rows, tables_.refine);
  for (std::size_t j = 0; j < plan_.d.size(); ++j) needed[j] = true;
  for (const Completion& c : plan_.completions) needed[c.column] = true;
  const std::uint32_t sides = static_cast<std::uint32_t>(plan_.roots.size());
  elimination_ = solver(sampled.elimination, sides, needed);
  if (!tables_.refine && !invert(elimination_, sampled.entries, plan_.sides, needed, kMostInfluences)) {
    const std::uint32_t n = static_cast<std::uint32_t>(plan_.d.size());
    std::vector<bool> unknowns(plan_.rows, false);
    std::fill_n(unknowns.begin(), n, true);
    SparseLu e = solver(sampled.elimination, sides, unknowns);
    if (invert(e, sampled.entries, plan_.sides, unknowns,
               company_ == Company::alone ? kMostInfluencesOfUnknowns : kMostInLanes)) {
      leave_to_own_rows(e, n, sampled.entries, needed);
      elimination_ = std::move(e);
    }
  }
  lay_out();
  tables_.judged.clear();
  for (const SparseLu::Pivot& p : elimination_.pivots)
    if (!p.one && !p.minus_one) tables_.judged.push_back({tables_.lu + p.entry, 1 / p.value[0]});
  if (plan_.determinant) tables_.judged.push_back({plan_.determinant->at, 1 / sampled.determinant});
  waits_ = latency(plan_, elimination_);
}

double KernelPlan::cost() const {
  return company_ == Company::alone ? work() + kWaiting * waits_ * (plan_.stages + 1) : work();
}

std::string KernelPlan::compile(const std::string& cache, int lanes, CodeEffort effort,
                                std::size_t most_translated) const {
  const CompilerModule* module = compiler();
  if (!module) return "there is no compiler beside the program";
  const SparseLu& e = elimination_;
  const std::size_t substitution = e.forward.size() + e.terms.size();
  const std::size_t solved = substitution * (tables_.refine ? 3 : 1);
  const bool in_pieces = lanes == 1 && tables_.sums != 0 && plan_.after.size() <= kMostCompiled &&
                         plan_.stage.size() <= kMostInPieces && solved <= kMostEliminatedInPieces;
  const bool at_once = effort == CodeEffort::quick && translated_at_first(lanes) && plan_.stages == 1;
  const std::size_t most = at_once ? most_translated : kMostCompiled;
  if (!in_pieces && (plan_.stage.size() + plan_.after.size() > most || e.update_list.size() + solved > kMostEliminated))
    return "it is too large to be compiled in a short time";
  Compiled& made = compiled(lanes);
  const std::lock_guard lock(made.making);
  if (const Code* known = this->code(lanes); known && known->effort >= effort) return {};
  if (lanes == 1 && code_of_stages()) return {};
  Code code;
  std::string message;
  const Tier& tier = tier_of(lanes);
  module->compile(tables_, lanes, effort,
                  {power_of, function_of, looked_up, lanes == 1 ? tier.sines_of_one : tier.sines_of_all,
                   tier.sines_of_all, tier.lanes},
                  cache, code, message);
  if (!code.extend) return message;
  Code& place = code.effort == CodeEffort::full ? made.full : made.quick;
  place = std::move(code);
  made.ready.store(&place, std::memory_order_release);
  return {};
}

void Kernel::Free::operator()(double* p) const { std::free(p); }

Kernel::Kernel(std::shared_ptr<const KernelPlan> plan, int lanes, const Tier* tier)
    : plan_(std::move(plan)), lanes_(lanes), next_(plan_->tables().motions[0]), begun_(plan_->tables().motions[1]),
      before_(plan_->tables().motions[2]), base_(next_) {
  if (!tier) tier = &tier_of(lanes);
  ANHOLON_ASSERT(lanes == 1 || lanes == tier->lanes);
  const std::size_t bytes = plan_->tables().size * sizeof(double) * static_cast<std::size_t>(lanes);
  memory_.reset(static_cast<double*>(std::aligned_alloc(64, (bytes + 63) / 64 * 64)));
  if (!memory_) throw std::bad_alloc();
  arena_ = memory_.get();
  std::memset(arena_, 0, bytes);
  arithmetic_ = tier->make(plan_->tables(), arena_, lanes);
  const KernelTables& t = plan_->tables();
  for (std::uint32_t i = 0; i < t.judged.size(); ++i) set_all(t.inverse_pivots + i, t.judged[i].inverse);
  set_shrink(2);
  const Plan& p = plan_->plan();
  for (std::size_t j = 0; j < p.x.size(); ++j) low_orders_.push_back({p.x[j], static_cast<std::uint32_t>(p.d[j]) + 1});
  for (const Place& q : p.quadratures)
    low_orders_.push_back({q.at, q.series ? static_cast<std::uint32_t>(p.largest_lead) + 1 : 1});
  for (const Plan::HidingSeries& slot : p.hiding)
    for (const Place& place : {slot.argument, slot.value})
      low_orders_.push_back({place.at, static_cast<std::uint32_t>(p.largest_lead) + 1});
  // Unites parts that overlap, so that each series has all that is saved of it in one part.
  std::sort(low_orders_.begin(), low_orders_.end(), [](const LowOrders& a, const LowOrders& b) { return a.at < b.at; });
  std::vector<LowOrders> united;
  for (const LowOrders& low : low_orders_)
    if (united.empty() || low.at >= united.back().at + united.back().count)
      united.push_back(low);
    else
      united.back().count = std::max(united.back().count, low.at + low.count - united.back().at);
  low_orders_ = std::move(united);
  std::size_t numbers = 0;
  for (const LowOrders& low : low_orders_) numbers += low.count;
  aside_.resize(numbers * static_cast<std::size_t>(lanes_));
  if (lanes_ == 1)
    for (const LowOrders& low : low_orders_)
      for (std::uint32_t k = 0; k < low.count; ++k) low_numbers_.push_back(low.at + k);
  for (const std::uint32_t x : p.x) unknowns_.push_back(last_series(x));
  for (const Place& q : p.quadratures) {
    quadratures_.push_back(last_series(q.at));
    if (q.at == p.time) times_.resize(static_cast<std::size_t>(lanes_));
  }
}

// REQUIRES: `low_orders_` holds the series' first number.
Kernel::LastSeries Kernel::last_series(std::uint32_t at) const {
  std::uint32_t before = 0;
  for (const LowOrders& low : low_orders_) {
    if (at >= low.at && at < low.at + low.count) return {at, low.at + low.count - at, before + at - low.at};
    before += low.count;
  }
  return {at, 0, 0};
}

void Kernel::set_all(std::uint32_t slot, double x) {
  for (int lane = 0; lane < lanes_; ++lane) number(slot, lane) = x;
}

void Kernel::set_shrink(double shrink) {
  set_all(plan_->tables().margin, -(shrink + 0.7 / plan_->plan().stages) * kLog2e);
}

void Kernel::set_coefficients(int lane, const std::vector<long double>& parameters, Rounding rounding) {
  if (coefficients_)
    coefficients_->set_parameters(parameters);
  else
    coefficients_.emplace(plan_->plan(), plan_->program(), parameters);
  const std::vector<double> values = coefficients_->rounded(rounding);
  for (std::size_t i = 0; i < values.size(); ++i) number(static_cast<std::uint32_t>(i), lane) = values[i];
}

void Kernel::set_parameters(int lane, const std::vector<long double>& parameters, Rounding rounding) {
  set_coefficients(lane, parameters, rounding);
  if (!plan_->map()) return;
  while (readers_.size() < static_cast<std::size_t>(lanes_)) readers_.emplace_back(*plan_->map(), parameters);
  reader(lane).set_parameters(parameters);
}

bool Kernel::expand(const Code* code, bool projected) {
  started_ = false;
  shows_last_ = true;
  const bool moved = solve(code, projected);
  extend(code);
  return moved;
}

// Computes an expansion up to the leading derivatives.
bool Kernel::solve(const Code* code, bool projected) {
  if (code) {
    code->values(arena_);
    code->factor(arena_);
  } else {
    arithmetic_->values(-plan_->plan().largest_lead);
    arithmetic_->factor();
    arithmetic_->judge();
  }
  const bool moved = projected && project(code);
  if (code) {
    code->lead(arena_);
  } else {
    arithmetic_->residual(0);
    arithmetic_->complete(0);
  }
  return moved;
}

// The time is set to that of the next expansion long before the quadratures of the last one are read.
void Kernel::keep_times() {
  for (std::size_t lane = 0; lane < times_.size(); ++lane)
    times_[lane] = number(plan_->plan().time, static_cast<int>(lane));
}

void Kernel::extend(const Code* code) {
  keep_times();
  if (!code && lanes_ == 1) code = plan_->code_of_stages();
  if (code)
    code->extend(arena_);
  else
    arithmetic_->extend();
}

double Kernel::correction_of_solution() {
  const KernelTables& t = plan_->tables();
  arithmetic_->values(-plan_->plan().largest_lead);
  arithmetic_->factor();
  arithmetic_->residual(0);
  double size = 0, change = 0;
  for (std::uint32_t j = 0; j < plan_->plan().rows; ++j) {
    size = std::max(size, std::abs(number(t.solution + j, 0)));
    change = std::max(change, std::abs(number(t.refined + j, 0)));
  }
  return size > 0 ? change / size : 0;
}

// Projects the states; returns whether a state has moved.
bool Kernel::project(const Code* code) {
  bool moved = false;
  for (int level = plan_->levels(); level >= 1; --level) {
    if (code ? code->level[static_cast<std::size_t>(level - 1)](arena_) == 0
             : (arithmetic_->residual(level), !arithmetic_->displaced(level)))
      continue;
    moved = true;
    arithmetic_->correct(level);
    if (code)
      code->values(arena_);
    else
      arithmetic_->values(-plan_->plan().largest_lead);
  }
  return moved;
}

bool Kernel::finite(int lane) const {
  const Plan& p = plan_->plan();
  for (std::size_t j = 0; j < p.x.size(); ++j)
    if (!std::isfinite(number(p.x[j] + static_cast<std::uint32_t>(p.stages + p.d[j]), lane))) return false;
  return true;
}

}  // namespace anholon
