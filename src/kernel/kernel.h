// Taylor expansions of a motion in doubles, fast: one trajectory, or one in each SIMD lane.
//
// The plan, the order of pivots and the tables are made once per program and shared; a Kernel is the workspace of one
// thread. It computes the expansion of Expansion<double>, the reference, to round-off, without refinement. Pivots are
// static: if `health` is small, the reference makes the step.
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <mutex>
#include <optional>
#include <span>

#include "kernel/code.h"
#include "kernel/pivots.h"
#include "kernel/plan/planner.h"
#include "kernel/state_map.h"

namespace anholon {

// The use of a plan: one motion, whose operations wait for each other, or many lanes, where the number of operations
// and memory count.
enum class Company { alone, in_lanes };

class KernelPlan {
 public:
  // `state`: the state at and around which the pivots are chosen. Returns nullptr if the program has no plan, or the
  // equations are singular there.
  static std::shared_ptr<const KernelPlan> make(std::shared_ptr<const Program> program, int stages,
                                                const std::vector<long double>& parameters, double t,
                                                const std::vector<double>& state, Company company = Company::alone);
  // For a program in other unknowns than those of the motion. `judged`: its last quadrature is the determinant of the
  // motion's J up to a factor.
  static std::shared_ptr<const KernelPlan> make(std::shared_ptr<const Program> program,
                                                std::shared_ptr<const StateMap> map, bool judged, int stages,
                                                const std::vector<long double>& parameters, double t,
                                                const std::vector<double>& state, Company company = Company::alone);
  KernelPlan(const KernelPlan&) = delete;
  KernelPlan& operator=(const KernelPlan&) = delete;

  const Plan& plan() const { return plan_; }
  const SparseLu& elimination() const { return elimination_; }
  const KernelTables& tables() const { return tables_; }
  const Program& program() const { return *program_; }
  std::size_t state_size() const { return tables_.state_size; }
  // The map to the state of the motion if the kernel has unknowns of its own; otherwise nullptr.
  const StateMap* map() const { return map_.get(); }
  Company company() const { return company_; }
  int waits() const { return waits_; }
  double least_health() const { return tables_.refine ? kHealthyIfRefined : kHealthy; }
  int levels() const { return levels_; }  // of hidden constraints
  // Makes machine code for one lane, or for this number of lanes, with the same bits; kernels use it from their next
  // expansion on. Each code is made at most once for each effort, from any thread. Returns the reason if there is no
  // code, otherwise an empty string.
  // `most_translated`: the largest number of steps of a plan of one stage whose code is translated; such a plan
  // computes a function of states.
  static constexpr std::size_t kMostTranslated = 4000;
  std::string compile(const std::string& cache, int lanes = 1, CodeEffort effort = CodeEffort::full,
                      std::size_t most_translated = kMostTranslated) const;
  const Code* code(int lanes = 1) const {
    const Code* ready = compiled(lanes).ready.load(std::memory_order_acquire);
    return ready && ready->values ? ready : nullptr;
  }
  // The code of a long plan, which only extends; tables compute the other parts, which run once per expansion.
  const Code* code_of_stages() const {
    const Code* ready = compiled(1).ready.load(std::memory_order_acquire);
    return ready && !ready->values ? ready : nullptr;
  }
  // The cost of one expansion, and its number of operations. For a motion alone, the cost includes the operations of a
  // stage that wait for one another (latency.h).
  double cost() const;
  double work() const {
    return plan_.work() + elimination_.work() * (plan_.stages + 2) +
           static_cast<double>(elimination_.update_list.size());
  }

 private:
  KernelPlan(std::shared_ptr<const Program> program, std::shared_ptr<const StateMap> map, bool judged, int stages,
             Company company);
  struct Sampled {
    std::vector<SampledEntry> entries;
    SparseElimination elimination;
    double determinant = 1;
  };
  Sampled choose_pivots(const std::vector<long double>& parameters, double t, const std::vector<double>& state);
  void solve_by(const Sampled& sampled);
  void lay_out();
  // True if the machine code is made in pieces.
  bool is_long() const;

  std::shared_ptr<const Program> program_;
  std::shared_ptr<const StateMap> map_;
  Plan plan_;
  SparseLu elimination_;
  KernelTables tables_;
  int levels_ = 0, waits_ = 0;
  Company company_;
  struct Compiled {
    std::mutex making;
    Code quick, full;
    std::atomic<const Code*> ready{nullptr};
  };
  // `lanes`: 1, 2, 4 or 8.
  Compiled& compiled(int lanes) const {
    return compiled_[static_cast<std::size_t>(std::countr_zero(static_cast<unsigned>(lanes)))];
  }
  mutable std::array<Compiled, 4> compiled_;
};

class Kernel {
 public:
  // `lanes`: 1, or the number of the tier. Without a tier: the fastest of this machine that computes so many lanes.
  explicit Kernel(std::shared_ptr<const KernelPlan> plan, int lanes = 1, const Tier* tier = nullptr);

  int lanes() const { return lanes_; }
  const KernelPlan& plan() const { return *plan_; }
  void set_parameters(int lane, const std::vector<long double>& parameters, Rounding rounding = Rounding::nearest);
  // Like set_parameters(), for the equations alone: the reader of the lane keeps its parameters.
  void set_coefficients(int lane, const std::vector<long double>& parameters, Rounding rounding = Rounding::nearest);
  // Converts between the kernel's state and that of the motion, with the parameters of a lane, if the plan has a map.
  StateReader& reader(int lane) { return readers_[static_cast<std::size_t>(lane)]; }
  // Loads a state for `expand`: x_j^(k), k < d_j, one after the other; `leading`: a first guess of x_j^(d_j).
  template <class State>
  void load(int lane, double t, const std::vector<State>& state, const std::vector<State>& leading) {
    const Plan& p = plan_->plan();
    const double* factorial = plan_->tables().factorial.data();
    const std::size_t stride = static_cast<std::size_t>(lanes_);
    const State* from = state.data();
    for (std::size_t j = 0; j < p.x.size(); ++j) {
      double* x = &number(p.x[j], lane);
      const int d = p.d[j];
      for (int k = 0; k < d; ++k, x += stride) *x = static_cast<double>(*from++) / factorial[k];
      *x = leading.empty() ? 0 : static_cast<double>(leading[j]) / factorial[d];
    }
    for (const Beyond& b : p.beyond_double) number(b.at, lane) = 0;
    set_time(lane, t);
  }
  // Loads the states of all lanes at one time, for `solve_point`: value(j, k, lane) is x_j^(k), k <= d_j.
  template <class Value>
  void load_point(double t, const Value& value) {
    const Plan& p = plan_->plan();
    const std::vector<double>& inverse = plan_->tables().inverse_factorial;
    for (std::size_t j = 0; j < p.x.size(); ++j)
      for (int k = 0; k <= p.d[j]; ++k) {
        double* x = slot(p.x[j] + static_cast<std::uint32_t>(k));
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(lanes_); ++lane)
          x[lane] = value(j, k, lane) * inverse[static_cast<std::size_t>(k)];
      }
    for (const Beyond& b : p.beyond_double)
      for (int lane = 0; lane < lanes_; ++lane) number(b.at, lane) = 0;
    for (int lane = 0; lane < lanes_; ++lane) set_time(lane, t);
  }
  // Solves for the leading derivatives alone, without projection.
  void solve_point() {
    started_ = false;
    shows_last_ = true;
    solve(code(), false);
  }
  // Projects the state on the hidden constraints if it violates them (unless `projected` is false), solves for the
  // leading derivatives, and computes all coefficients.
  void expand(bool projected = true) { expand(code(), projected); }

  // The change of the leading derivatives by refinement, relative to their size.
  double correction_of_solution();

  // Pivots of the last expansion.
  Pivots pivots(int lane) const { return {number(found().health, lane), number(found().determinant, lane)}; }
  bool finite(int lane) const;
  // The distance of the state from the hidden constraints, relative to its size; and true if the state was moved.
  double drift(int lane) const { return number(found().drift, lane); }
  bool moved(int lane) const { return number(found().moved, lane) > 0; }

  // Motions are computed step by step in all lanes at once. The kernel keeps their states in the width of long double.
  // `place` loads states from elsewhere; then `begin` (the expansions at the set times) and `advance` (over the set
  // steps) alternate.
  void place(int lane, const std::vector<long double>& state, const std::vector<long double>& leading);
  // Stores each number of the state after `advance` as `place` stores its sum in long double.
  void round_state(int lane);
  void set_time(int lane, double t) {
    double& now = number(plan_->plan().time, lane);
    if (now != t) drop_next();
    now = t;
    number(plan_->plan().time + 1, lane) = 1;
  }
  void begin();
  // Like `begin`, but only up to the leading derivatives, and the quadratures at the point itself. There is no reach.
  void begin_point();
  // After `advance`, at the set times: the part of `begin` that solves for the leading derivatives. Then `defect` tells
  // how well the series predicted them. Until `begin` continues, or another `advance` replaces it, the last expansion's
  // series remain available; for reading them see show_last().
  void start_next();
  double defect(int lane) const { return number(found().defect, lane); }
  // Selects the states that are shown: those after `advance`, or those of the last expansion, for a caller that chooses
  // another end.
  void show_advanced(bool advanced) {
    show_last();
    gone_on_ = advanced;
  }
  // Call this before reading series of the last expansion after `start_next`; coefficients of unknowns and quadratures
  // can be read without it.
  void show_last() const {
    if (!shows_last_) swap_low_orders();
  }
  void set_step(int lane, double h) { number(plan_->tables().step, lane) = h; }
  // A finding in all lanes, one number for each.
  const double* finding(std::uint32_t Findings::* which) const {
    return arena_ + found().*which * static_cast<std::size_t>(lanes_);
  }
  // After `begin`: computes the largest change, over the set steps, of the arguments of functions that may hide their
  // variation (Findings::hidden).
  void look_for_hidden() { arithmetic_->look_for_hidden(); }
  void advance();
  // Makes a step e^-shrink of the radius of convergence (integrate/step_control.h).
  void set_shrink(double shrink);
  double reach(int lane) const { return number(found().reach, lane); }
  // reaches(): true if the highest coefficients are finite. largest(): the largest number of a state after a step.
  bool reaches(int lane) const { return number(found().unfit, lane) == 0; }
  double largest(int lane) const { return number(found().largest, lane); }
  // Reads the state and the first guess of the leading derivatives: now, at the start of the present expansion, or of
  // the one before.
  enum class Moment { now, begun, before };
  void fetch(int lane, Moment moment, std::vector<long double>& state, std::vector<long double>& leading) const;
  // The state at the expansion from which the last step started.
  void fetch_base(int lane, std::vector<long double>& state) const;

  // The series of unknown j in a lane; element k is at offset k * lanes().
  const double* unknown(std::size_t j, int lane) const {
    return arena_ + plan_->plan().x[j] * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane);
  }
  double coefficient(std::size_t j, int k, int lane = 0) const {
    return last(unknowns_[j], static_cast<std::uint32_t>(k), lane);
  }
  double derivative(std::size_t j, int k, int lane = 0) const {
    return coefficient(j, k, lane) * plan_->tables().factorial[static_cast<std::size_t>(k)];
  }
  // Taylor coefficient of quadrature i.
  double quadrature(std::size_t i, int order, int lane = 0) const {
    if (order == 0 && quadratures_[i].at == plan_->plan().time) return times_[static_cast<std::size_t>(lane)];
    return order == 0 || !constant_quadrature(i) ? last(quadratures_[i], static_cast<std::uint32_t>(order), lane) : 0;
  }
  bool constant_quadrature(std::size_t i) const { return !plan_->plan().quadratures[i].series; }
  // The integral of quadrature i over the set step.
  double integral(std::size_t i, int lane = 0) const;
  // A series in a lane; element k is at offset k * lanes().
  const double* whole_series(const Place& place, int lane) const {
    return arena_ + place.at * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane);
  }
  double series(const Place& place, int order, int lane = 0) const {
    return number(place.at + static_cast<std::uint32_t>(order), lane);
  }
  // Computes the changes of x_j^(k), k = 0..d_j, one after the other, over the set steps.
  void change_over_step();
  // After change_over_step(), for unknowns of first order: reads the state at the end of the step.
  void fetch_changed(int lane, std::vector<long double>& state) const;
  // Element i is at offset i * lanes().
  const double* increments(int lane) const {
    return arena_ + plan_->tables().increments * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane);
  }

 private:
  double number(std::uint32_t slot, int lane) const {
    return arena_[slot * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane)];
  }
  double& number(std::uint32_t slot, int lane) {
    return arena_[slot * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane)];
  }
  double* slot(std::uint32_t slot) { return arena_ + slot * static_cast<std::size_t>(lanes_); }
  void set_all(std::uint32_t slot, double x);
  bool expand(const Code* code, bool projected);
  bool solve(const Code* code, bool projected);
  void drop_next() {
    show_last();
    started_ = false;
  }
  void extend(const Code* code);
  void start_expansion();
  void keep_projected();
  void keep_times();
  void start(const Code* code);
  void swap_low_orders() const;
  bool project(const Code* code);
  const Code* code() const { return plan_->code(lanes_); }
  const Findings& found() const { return plan_->tables().found; }
  void sum_up(std::uint32_t at, int lane, std::vector<long double>& state) const;

  struct Free {
    void operator()(double* p) const;
  };
  std::shared_ptr<const KernelPlan> plan_;
  int lanes_;
  std::unique_ptr<double[], Free> memory_;
  double* arena_;
  std::unique_ptr<Arithmetic> arithmetic_;
  std::optional<CoefficientValues> coefficients_;
  std::vector<StateReader> readers_;
  // Places of motions (KernelTables): the start of the next expansion, of the present one, of the one before; the state
  // of that expansion.
  std::uint32_t next_, begun_, before_, base_;
  bool gone_on_ = true;  // the state was advanced or placed since the present expansion was made
  // Parts of the series that solving for the leading derivatives overwrites: places and lengths.
  struct LowOrders {
    std::uint32_t at, count;
  };
  std::vector<LowOrders> low_orders_;
  std::vector<std::uint32_t> low_numbers_;  // the same, number by number, for one lane
  // A series of the last expansion: its place, and how many of its first numbers are at which place of `aside_` after
  // `start_next`.
  struct LastSeries {
    std::uint32_t at, count, aside;
  };
  LastSeries last_series(std::uint32_t at) const;
  void keep_low_orders();
  double last(const LastSeries& series, std::uint32_t k, int lane) const {
    if (shows_last_ || k >= series.count) return number(series.at + k, lane);
    return aside_[(series.aside + k) * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane)];
  }
  std::vector<LastSeries> unknowns_, quadratures_;
  std::vector<double> times_;             // of the last expansion, if t itself is a quadrature: lane by lane
  mutable std::vector<double> aside_;     // the saved numbers of the last expansion, or of the next one
  bool started_ = false, moved_ = false;  // `started_`: the next expansion; `moved_`: its projection moved a state
  mutable bool shows_last_ = true;
};

}  // namespace anholon
