#include "dynamics/dynamics.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <thread>

#include "kernel/plan/planner.h"
#include "motion/representation.h"
#include "program/expansion.h"

namespace anholon {

namespace {

// Below these numbers of states, code for lanes, and further threads, do not pay.
constexpr std::size_t kManyLanes = 16, kManyThreads = 4096;

}  // namespace

std::unique_ptr<Dynamics> Dynamics::make(Workspace& s, const StateChoice& choice, const Choice& wanted,
                                         std::string& why) {
  const auto no = [&](std::string reason) {
    why = std::move(reason);
    return nullptr;
  };
  if (!s.elimination.pivots().empty())
    return no("the form eliminates coordinates, whose choice holds in a part of the motion");
  if (!s.redundant.empty()) return no("constraints are redundant");
  const std::size_t n = s.system.coordinates, all = s.system.size(), mechanical = s.system.mechanical();
  for (std::size_t j = 0; j < all; ++j)
    if (s.structure.d[j] != (j < n ? 2 : j < mechanical ? 0 : 1))
      return no("the equations are not solved for accelerations: constraints of order 2 and more, or coordinates "
                "without mass");
  const auto program = std::make_shared<const Program>(anholon::program(s.system, s.structure));
  if (std::string reason = no_plan(*program); !reason.empty()) return no(std::move(reason));
  Start<long double> here;
  if (const Outcome o = initial_state(s, choice, here); !o.ok()) return no(o.message);
  std::unique_ptr<Dynamics> made(new Dynamics);
  made->parameters_ = parameter_values<long double>(*s.model);
  made->find_free_parameters(*s.model, wanted.inputs);
  const std::vector<double>& state = made->motion_start_ = {here.state.begin(), here.state.end()};
  const double t = made->start_time_ = static_cast<double>(here.t);
  made->derived_ = KernelPlan::make(program, 1, made->parameters_, t, state, Company::in_lanes);
  if (!made->derived_) return no("the equations are singular at the start");
  const std::vector<Representation> list = representations(
      {made->derived_, s.structure, {}, made->parameters_, t, state, s.mechanics.get()}, WritingEffort::long_motion);
  const auto quasi = std::find_if(list.begin(), list.end(), [](const Representation& r) { return r.plan->map(); });
  const bool mapped = wanted.minimal && quasi != list.end();
  const Representation& best = mapped ? *quasi : cheapest_unmapped(list);
  made->plan_ = best.plan;
  made->coordinates_ = n;
  made->model_states_ = all - mechanical;
  const std::vector<std::string>& names = s.system.variable_names;
  std::size_t at = 0;
  for (std::size_t a = 0; a < n; ++a, ++at) made->states_.push_back({names[a], {}});
  const std::size_t velocities = mapped ? best.plan->map()->velocities() : n;
  for (std::size_t i = 0; i < velocities; ++i)
    made->states_.push_back(mapped ? State{"u" + std::to_string(i + 1), best.velocities[i]}
                                   : State{names[i] + "'", {}});
  for (std::size_t z = mechanical; z < all; ++z) made->states_.push_back({names[z], {}});
  if (mapped) {
    made->map_ = std::shared_ptr<const StateMap>(best.plan, best.plan->map());
    // The kernel's unknowns: coordinates, the model's states, then velocities.
    for (std::size_t j = 0; j < best.plan->plan().x.size(); ++j) {
      const std::size_t place = j < n ? j : j < n + made->model_states_ ? velocities + j : j - made->model_states_;
      made->unknowns_.push_back({place, place, 1});
    }
  } else {
    for (std::size_t j = 0; j < all; ++j) {
      const std::size_t place = j < n ? j : j - mechanical + 2 * n;
      made->unknowns_.push_back(j < n            ? Unknown{j, n + j, 2}
                                : j < mechanical ? Unknown{0, 0, 0}
                                                 : Unknown{place, place, 1});
    }
  }
  std::vector<double> q, qd, z;
  for (std::size_t a = 0; a < n; ++a) q.push_back(state[2 * a]), qd.push_back(state[2 * a + 1]);
  z.assign(state.begin() + static_cast<std::ptrdiff_t>(2 * n), state.end());
  made->start_ = made->from_motion(t, q, qd, z);
  made->plan_->compile(code_cache());
  return made;
}

// Parameters that follow from others are those whose values hold symbols; the inputs are the last ones.
void Dynamics::find_free_parameters(const Model& model, std::size_t inputs) {
  inputs_ = inputs;
  Graph& g = *model.graph;
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool follows = !symbols({&values[i], 1}).empty();
    some_follow_ = some_follow_ || follows;
    if (!follows && i + inputs < values.size()) free_.push_back(i);
    if (!follows) values[i] = g.parameter(static_cast<std::uint32_t>(i));
  }
  for (std::size_t depth = 0; depth < values.size(); ++depth)
    values = substitute(values, [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::parameter ? values[n.index] : Expr{};
    });
  if (some_follow_) all_parameters_ = compile(values);
}

double Dynamics::at_start(const Node& n) const {
  if (n.kind == Kind::time) return start_time_;
  if (n.kind == Kind::parameter) return static_cast<double>(parameters_[n.index]);
  if (n.kind == Kind::jet && n.index < coordinates_ && n.order < 2) return motion_start_[2 * n.index + n.order];
  if (n.kind == Kind::state && n.index < model_states_ && n.order == 0)
    return motion_start_[2 * coordinates_ + n.index];
  return 0;
}

std::vector<long double> Dynamics::parameters(InputsAndParameters given, std::size_t count, std::size_t k) const {
  std::vector<long double> all = parameters_;
  const auto number = [&](std::span<const double> of, std::size_t size, std::size_t i) {
    return of.size() == size ? of[i] : of[i * count + k];
  };
  if (!given.p.empty()) {
    for (std::size_t i = 0; i < free_.size(); ++i) all[free_[i]] = number(given.p, free_.size(), i);
    if (some_follow_) {
      Machine<long double> machine(all_parameters_, 0, all);
      machine.evaluate();
      for (std::size_t i = 0; i < all.size(); ++i) all[i] = machine.value(i);
    }
  }
  if (!given.u.empty())
    for (std::size_t i = 0; i < inputs_; ++i) all[all.size() - inputs_ + i] = number(given.u, inputs_, i);
  return all;
}

bool Dynamics::Call::common(std::size_t inputs, std::size_t parameters) const {
  return count == 1 || (given.u.size() <= inputs && given.p.size() <= parameters);
}

template <class F>
void Dynamics::with_kernel(int lanes, const Call& call, const F& f) const {
  std::vector<Worker>& pool = lanes == 1 ? alone_ : in_lanes_;
  Worker worker;
  {
    const std::lock_guard lock(idle_);
    if (!pool.empty()) worker = std::move(pool.back()), pool.pop_back();
  }
  const bool fresh = !worker.kernel;
  if (fresh) worker.kernel = std::make_unique<Kernel>(plan_, lanes);
  const auto set = [&](const std::vector<long double>& parameters) {
    for (int lane = 0; lane < lanes; ++lane) worker.kernel->set_coefficients(lane, parameters);
  };
  if (call.of_start() && (fresh || worker.as_given)) set(parameters_);
  if (!call.of_start() && call.common(inputs_, free_.size())) set(parameters(call.given, call.count, 0));
  worker.as_given = !call.of_start();
  f(*worker.kernel);
  const std::lock_guard lock(idle_);
  pool.push_back(std::move(worker));
}

// What leads one state by the reference; NaN where the equations have no solution.
std::vector<double> Dynamics::by_reference(double t, const std::function<double(std::size_t)>& state,
                                           const std::vector<long double>& parameters) const {
  Expansion<long double> point(plan_->program(), parameters, 1);
  std::vector<long double> entries;
  for (const Unknown& u : unknowns_)
    for (int k = 0; k < u.order; ++k) entries.push_back(state(k == 0 ? u.value : u.rate));
  point.load(t, entries, {});
  Outcome o = point.prepare();
  if (o.ok()) o = point.solve();
  std::vector<double> solved;
  for (std::size_t j = 0; j < unknowns_.size(); ++j)
    solved.push_back(o.ok() ? static_cast<double>(point.derivative(j, unknowns_[j].order))
                            : std::numeric_limits<double>::quiet_NaN());
  return solved;
}

// The states from..to, as many at once as the kernel has lanes; what is left over of them holds the last one.
void Dynamics::compute(Kernel& kernel, const Call& call, std::size_t from, std::size_t to) const {
  const std::size_t lanes = static_cast<std::size_t>(kernel.lanes()), count = call.count;
  const bool common = call.common(inputs_, free_.size());
  for (std::size_t first = from; first < to; first += lanes) {
    const std::size_t some = std::min(lanes, to - first);
    const auto state = [&](std::size_t i, std::size_t lane) {
      return call.x[i * count + first + std::min(lane, some - 1)];
    };
    if (!common)
      for (std::size_t lane = 0; lane < lanes; ++lane)
        kernel.set_coefficients(static_cast<int>(lane),
                                parameters(call.given, count, first + std::min(lane, some - 1)));
    kernel.load_point(call.t, [&](std::size_t j, int k, std::size_t lane) {
      const Unknown& u = unknowns_[j];
      return k < u.order ? state(k == 0 ? u.value : u.rate, lane) : 0;
    });
    kernel.solve_point();
    for (std::size_t lane = 0; lane < some; ++lane) {
      // The pivots were chosen at the start: where they are small, the reference chooses others.
      const bool healthy = kernel.pivots(static_cast<int>(lane)).health > kHealthy;
      const std::size_t k = first + lane;
      const std::vector<double> solved =
          healthy
              ? std::vector<double>()
              : by_reference(call.t, [&](std::size_t i) { return state(i, lane); }, parameters(call.given, count, k));
      for (std::size_t j = 0; j < unknowns_.size(); ++j) {
        const Unknown& u = unknowns_[j];
        if (u.order == 0) continue;
        if (u.order == 2) call.rates[u.value * count + k] = state(u.rate, lane);
        call.rates[u.rate * count + k] = healthy ? kernel.derivative(j, u.order, static_cast<int>(lane)) : solved[j];
      }
    }
  }
}

void Dynamics::rates(double t, const double* x, std::size_t count, double* rates, InputsAndParameters given) const {
  const Call call{t, x, count, rates, given};
  if (count < kManyLanes) {
    with_kernel(1, call, [&](Kernel& k) { compute(k, call, 0, count); });
    return;
  }
  const int lanes = tiers().back().lanes;
  plan_->compile(code_cache(), lanes);
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    with_kernel(lanes, call, [&](Kernel& k) {
      for (std::size_t from; (from = next.fetch_add(kManyThreads)) < count;)
        compute(k, call, from, std::min(count, from + kManyThreads));
    });
  };
  std::vector<std::jthread> others;
  const std::size_t threads = std::min<std::size_t>(std::thread::hardware_concurrency(), count / kManyThreads);
  while (others.size() + 1 < threads) others.emplace_back(work);
  work();
}

std::vector<double> Dynamics::leading(double t, const std::vector<double>& x, InputsAndParameters given) const {
  std::vector<double> list(unknowns_.size()), rates(x.size());
  const Call call{t, x.data(), 1, rates.data(), given};
  with_kernel(1, call, [&](Kernel& k) {
    compute(k, call, 0, 1);
    for (std::size_t j = 0; j < list.size(); ++j) list[j] = k.derivative(j, unknowns_[j].order);
    if (!(k.pivots(0).health > kHealthy))
      list = by_reference(t, [&](std::size_t i) { return x[i]; }, parameters(given, 1, 0));
  });
  return list;
}

std::vector<double> Dynamics::from_motion(double t, const std::vector<double>& q, const std::vector<double>& qd,
                                          const std::vector<double>& z) const {
  std::vector<double> x = q;
  if (!map_) {
    x.insert(x.end(), qd.begin(), qd.end());
  } else {
    std::vector<long double> state, own;
    for (std::size_t a = 0; a < coordinates_; ++a) state.insert(state.end(), {q[a], qd[a]});
    state.insert(state.end(), z.begin(), z.end());
    StateReader(*map_, parameters_).own(t, state, own);
    for (std::size_t i = coordinates_ + model_states_; i < own.size(); ++i) x.push_back(static_cast<double>(own[i]));
  }
  x.insert(x.end(), z.begin(), z.end());
  return x;
}

Dynamics::Full Dynamics::to_motion(double t, const std::vector<double>& x) const {
  const auto n = static_cast<std::ptrdiff_t>(coordinates_), states = static_cast<std::ptrdiff_t>(model_states_);
  Full full{{x.begin(), x.begin() + n}, {x.begin() + n, x.end() - states}, {x.end() - states, x.end()}};
  if (!map_) return full;
  std::vector<long double> own(full.q.begin(), full.q.end()), state;
  own.insert(own.end(), full.z.begin(), full.z.end());
  own.insert(own.end(), full.qd.begin(), full.qd.end());
  StateReader(*map_, parameters_).motion(t, own, state);
  full.qd.clear();
  for (std::size_t a = 0; a < coordinates_; ++a) full.qd.push_back(static_cast<double>(state[2 * a + 1]));
  return full;
}

}  // namespace anholon
