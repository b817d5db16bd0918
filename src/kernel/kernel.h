// Taylor expansions of a motion in doubles, fast: one trajectory, or one in each SIMD lane.
//
// What is shared (the plan, the order of pivots, tables) is made once per program; a Kernel is the workspace of one
// thread. Against Expansion<double>, the reference: the same expansion to round-off, without refinement. The pivots are
// static: `health` says whether they still serve; where it is small, the reference takes the step.
#pragma once
#include <atomic>
#include <optional>
#include <span>

#include "kernel/code.h"
#include "kernel/pivots.h"
#include "kernel/state_map.h"

namespace anholon {

// What a plan is laid out for: one motion, where operations wait for each other, or many side by side, where their
// number and the memory they touch count.
enum class Company { alone, in_lanes };

class KernelPlan {
 public:
  // `state`: where the pivots are chosen, and around it. Nothing if the program has no plan, or the equations are
  // singular there.
  static std::shared_ptr<const KernelPlan> make(std::shared_ptr<const Program> program, int stages,
                                                const std::vector<long double>& parameters, double t,
                                                const std::vector<double>& state, Company company = Company::alone);
  // Of a program for other unknowns than those of the motion; `judged`: its last quadrature is the determinant of the
  // motion's J, up to a factor.
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
  // To the state of the motion, where the kernel has unknowns of its own; else null.
  const StateMap* map() const { return map_.get(); }
  Company company() const { return company_; }
  int waits() const { return waits_; }
  int levels() const { return levels_; }  // of hidden constraints
  // Makes machine code for one lane, or for so many, with the same bits; such kernels take it up at their next
  // expansion. At most once for each, from any thread. Why there is none, or nothing.
  std::string compile(const std::string& cache, int lanes = 1) const;
  const Code* code(int lanes = 1) const {
    const Compiled& c = lanes == 1 ? one_ : several_;
    const Code* ready = c.ready.load(std::memory_order_acquire);
    return ready && c.lanes == lanes ? ready : nullptr;
  }
  // Operations of one expansion; and what it costs, in operations: alone, it counts how many a stage makes one after
  // the other (latency.h).
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

  std::shared_ptr<const Program> program_;
  std::shared_ptr<const StateMap> map_;
  Plan plan_;
  SparseLu elimination_;
  KernelTables tables_;
  int levels_ = 0, waits_ = 0;
  Company company_;
  struct Compiled {
    Code code;
    int lanes = 1;
    std::atomic<const Code*> ready{nullptr};
  };
  mutable Compiled one_, several_;  // lanes
};

class Kernel {
 public:
  // `lanes`: 1, or what the tier has. Without a tier: the best of this machine.
  explicit Kernel(std::shared_ptr<const KernelPlan> plan, int lanes = 1, const Tier* tier = nullptr);

  int lanes() const { return lanes_; }
  const KernelPlan& plan() const { return *plan_; }
  void set_parameters(int lane, const std::vector<long double>& parameters);
  // Between the kernel's state and that of the motion, with the parameters of a lane; where the plan has a map.
  StateReader& reader(int lane) { return readers_[static_cast<std::size_t>(lane)]; }
  // A state for `expand`: x_j^(k), k < d_j, one after the other; `leading`: a first guess of x_j^(d_j).
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
  // Projects the state on the hidden constraints where it has left them (or leaves it as it is), solves for the leading
  // derivatives, and computes all coefficients.
  void expand(bool projected = true) { expand(code(), projected); }

  // By how much refinement changes the solution for the leading derivatives, in relation to it.
  double correction_of_solution();

  // Of the last expansion.
  Pivots pivots(int lane) const { return {number(found().health, lane), number(found().determinant, lane)}; }
  bool finite(int lane) const;
  // How far the state was from the hidden constraints, in relation to its size, and whether it was moved.
  double drift(int lane) const { return number(found().drift, lane); }
  bool moved(int lane) const { return number(found().moved, lane) > 0; }

  // Motions, step by step, in all lanes at once. The kernel keeps their states in the width of long double: they are
  // placed there where they come from elsewhere; then `begin` (the expansions at the times set) and, over the steps
  // set, `advance` follow each other.
  void place(int lane, const std::vector<long double>& state, const std::vector<long double>& leading);
  void set_time(int lane, double t) {
    double& now = number(plan_->plan().time, lane);
    if (now != t) drop_next();
    now = t;
    number(plan_->plan().time + 1, lane) = 1;
  }
  void begin();
  // After `advance`, at the times set: the part of `begin` that solves for the leading derivatives, which says how well
  // the series have foretold them
  // (`defect`). Until `begin` goes on from there, or another `advance` takes it back, series are those of the last
  // expansion; on request, see below.
  void start_next();
  double defect(int lane) const { return number(found().defect, lane); }
  // Whether motions are seen as they are after `advance`, or where the last expansion was made, as before: by who is to
  // choose another end.
  void show_advanced(bool advanced) {
    show_last();
    gone_on_ = advanced;
  }
  // Whoever reads series of the last expansion after `start_next` says so first.
  void show_last() const {
    if (!shows_last_) swap_low_orders();
  }
  void set_step(int lane, double h) { number(plan_->tables().step, lane) = h; }
  void advance();
  // e^-shrink of the radius of convergence is a step (integrate/step_control.h).
  void set_shrink(double shrink);
  double reach(int lane) const { return number(found().reach, lane); }
  // Whether the highest coefficients are numbers, and the largest number of a state after a step.
  bool reaches(int lane) const { return number(found().unfit, lane) == 0; }
  double largest(int lane) const { return number(found().largest, lane); }
  // The state and the first guess of the leading derivatives as they are, as the present expansion was begun, the one
  // before.
  enum class Moment { now, begun, before };
  void fetch(int lane, Moment moment, std::vector<long double>& state, std::vector<long double>& leading) const;
  // The state where the expansion was made that the last step followed.
  void fetch_base(int lane, std::vector<long double>& state) const;

  // The series of unknown j in a lane: number k lies k * lanes() further on.
  const double* unknown(std::size_t j, int lane) const {
    return arena_ + plan_->plan().x[j] * static_cast<std::size_t>(lanes_) + static_cast<std::size_t>(lane);
  }
  double coefficient(std::size_t j, int k, int lane = 0) const {
    return number(plan_->plan().x[j] + static_cast<std::uint32_t>(k), lane);
  }
  double derivative(std::size_t j, int k, int lane = 0) const {
    return coefficient(j, k, lane) * plan_->tables().factorial[static_cast<std::size_t>(k)];
  }
  // Taylor coefficient of quadrature i.
  double quadrature(std::size_t i, int order, int lane = 0) const {
    const Place q = plan_->plan().quadratures[i];
    return q.series ? number(q.at + static_cast<std::uint32_t>(order), lane) : order == 0 ? number(q.at, lane) : 0;
  }
  double series(const Place& place, int order, int lane = 0) const {
    return number(place.at + static_cast<std::uint32_t>(order), lane);
  }
  // The changes of x_j^(k), k = 0..d_j, one after the other, over the steps set.
  void change_over_step();
  // Number i lies i * lanes() further on.
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
  std::vector<StateReader> readers_;
  // Places of motions (KernelTables): where the next expansion begins, the present one was begun, the one before; where
  // that was made.
  std::uint32_t next_, begun_, before_, base_;
  bool gone_on_ = true;  // or placed, since the present one was made
  // What solving for the leading derivatives writes over of the series: so many numbers from each of these places on.
  struct LowOrders {
    std::uint32_t at, count;
  };
  std::vector<LowOrders> low_orders_;
  mutable std::vector<double> aside_;     // those of the last expansion, or of the next one
  bool started_ = false, moved_ = false;  // the next expansion; and moved a state by that
  mutable bool shows_last_ = true;
};

}  // namespace anholon
