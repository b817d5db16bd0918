#include "dynamics/dynamics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "dynamics/pieces.h"
#include "kernel/plan/planner.h"
#include "motion/representation.h"
#include "program/expansion.h"
#include "setup/ends_of_tables.h"
#include "structure/parameters_of_order.h"

namespace anholon {

namespace {

// For fewer states, code for lanes (kManyLanes) and further threads (kManyThreads) do not pay.
constexpr std::size_t kManyLanes = 16, kManyThreads = 4096;

// Newton's method stays on its branch while each correction is at most the part kContraction of the one before; a line
// is followed in steps of at least kLeastStep.
constexpr long double kContraction = 0.25L, kLeastStep = 1.0L / 4096;
constexpr int kMostCorrections = 40;
// Corrections of this size, relative to the largest number, are the round-off of sums of larger terms: far below that
// of a double.
constexpr long double kSettled = 1e-17L;

// Corrects `leading` by Newton's method. Returns false if it does not contract.
bool contracts(Expansion<long double>& point, long double t, const std::vector<long double>& state,
               std::vector<long double>& leading) {
  std::vector<long double> residual, correction;
  long double before = std::numeric_limits<long double>::infinity();
  for (int k = 0; k < kMostCorrections; ++k) {
    point.load(t, state, leading);
    if (!point.prepare().ok()) return false;
    point.equations(residual);
    point.system_jacobian().solve(residual, correction);
    long double size = 0, of = 0;
    for (std::size_t j = 0; j < leading.size(); ++j) {
      leading[j] -= correction[j];
      size = std::max(size, std::abs(correction[j])), of = std::max(of, std::abs(leading[j]));
    }
    if (!std::isfinite(size)) return false;
    // The rest is round-off of the largest number, which does not contract.
    if (size <= kQuietRoundoffs * std::numeric_limits<long double>::epsilon() * of) return true;
    if (size > kContraction * before) return size <= kSettled * of;
    before = size;
  }
  return false;
}

}  // namespace

// The program of a copy of the system that lives as long as the program: faults of the program name formulas of its
// system.
static std::shared_ptr<const Program> with_own_system(const System& system, const Structure& structure) {
  struct Owned {
    System system;
    Program program;
  };
  const auto owned = std::make_shared<Owned>(Owned{system, {}});
  owned->program = anholon::program(owned->system, structure);
  return {owned, &owned->program};
}

std::unique_ptr<Dynamics> Dynamics::make(Workspace& s, const StateChoice& choice, const Choice& wanted,
                                         std::string& why) {
  const auto no = [&](std::string reason) {
    why = std::move(reason);
    return nullptr;
  };
  if (!s.elimination.pivots().empty())
    return no("the form eliminates coordinates, whose choice holds in a part of the motion");
  const std::size_t n = s.system.coordinates, all = s.system.size(), mechanical = s.system.mechanical();
  std::unique_ptr<Dynamics> made(new Dynamics);
  put_ends_of_tables(s);
  made->program_ = with_own_system(s.system, s.structure);
  Start<long double> here;
  if (const Outcome o = initial_state(s, choice, here); !o.ok()) return no(o.message);
  made->parameters_ = parameter_values<long double>(*s.model);
  made->find_free_parameters(*s.model, wanted.inputs);
  // These parameters are not free: with other values the equations have another state.
  for (const std::size_t i : parameters_of_order(*s.mechanics, s.elimination, s.system, s.structure))
    std::erase(made->free_, i);
  for (const std::size_t i : wanted.fixed) std::erase(made->free_, i);
  const std::vector<double>& state = made->motion_start_ = {here.state.begin(), here.state.end()};
  const double t = made->start_time_ = static_cast<double>(here.t);
  made->coordinates_ = n;
  made->model_states_ = all - mechanical;
  std::optional<Representation> mapped;
  why = wanted.minimal ? no_plan(*made->program_) : "all velocities were asked for";
  if (no_plan(*made->program_).empty()) {
    const auto derived = KernelPlan::make(made->program_, 1, made->parameters_, t, state, Company::in_lanes);
    if (!derived) return no("the equations are singular at the start");
    const ToRepresent equations{derived, s.structure, {}, made->parameters_, t, state, s.mechanics.get()};
    if (wanted.minimal) mapped = in_independent_velocities(equations, why);
    made->plan_ =
        mapped ? mapped->plan : cheapest_unmapped(representations(equations, WritingEffort::long_motion)).plan;
  } else {
    Expansion<long double> point(*made->program_, made->parameters_, 1);
    point.load(here.t, here.state, here.leading);
    Outcome o = point.prepare();
    if (o.ok()) o = point.solve();
    if (!o.ok()) return no(o.message);
    point.leading(made->start_leading_);
  }
  if (mapped)
    made->put_independent_velocities(s.system, *mapped);
  else
    made->put_state_of_motion(s.system, s.structure.d);
  if (made->plan_ && !made->plan_->compile(code_cache()).empty())
    made->plan_->compile(code_cache(), 1, CodeEffort::quick);
  return made;
}

// Sets x: coordinates, independent velocities, the model's states. The kernel's unknowns are coordinates, the model's
// states, then velocities.
void Dynamics::put_independent_velocities(const System& s, const Representation& mapped) {
  const std::size_t n = coordinates_, velocities = mapped.plan->map()->velocities();
  map_ = std::shared_ptr<const StateMap>(mapped.plan, mapped.plan->map());
  values_ = n;
  for (std::size_t a = 0; a < n; ++a) states_.push_back({s.variable_names[a], {}});
  for (std::size_t i = 0; i < velocities; ++i)
    states_.push_back({automatic_name(*s.model, "u" + std::to_string(i + 1)), mapped.velocities[i]});
  for (std::size_t z = s.mechanical(); z < s.size(); ++z) states_.push_back({s.variable_names[z], {}});
  state_entries_ = model_states_;
  for (std::size_t j = 0; j < mapped.plan->plan().x.size(); ++j)
    unknowns_.push_back({{j < n ? j : j < n + model_states_ ? velocities + j : j - model_states_}});
  std::vector<double> q, qd;
  for (std::size_t a = 0; a < n; ++a) q.push_back(motion_start_[2 * a]), qd.push_back(motion_start_[2 * a + 1]);
  start_ = from_motion(start_time_, q, qd,
                       {motion_start_.begin() + static_cast<std::ptrdiff_t>(2 * n), motion_start_.end()});
}

// Sets x: the derivatives below the leading ones d, by order and then by variable; the model's states come last.
void Dynamics::put_state_of_motion(const System& s, const std::vector<int>& d) {
  unknowns_.resize(s.size());
  std::vector<std::size_t> offset{0};  // in the state of the motion
  for (const int order : d) offset.push_back(offset.back() + static_cast<std::size_t>(order));
  const auto add = [&](std::size_t j, int k) {
    unknowns_[j].places.push_back(states_.size());
    states_.push_back({derivative_name(s.variable_names[j], static_cast<unsigned>(k), Format::text), {}});
    start_.push_back(motion_start_[offset[j] + static_cast<std::size_t>(k)]);
  };
  const int highest = *std::max_element(d.begin(), d.end());
  for (int k = 0; k < highest; ++k) {
    for (std::size_t j = 0; j < s.mechanical(); ++j)
      if (k < d[j]) add(j, k);
    if (k == 0) values_ = states_.size();
  }
  const std::size_t mechanical = states_.size();
  for (std::size_t j = s.mechanical(); j < s.size(); ++j)
    for (int k = 0; k < d[j]; ++k) add(j, k);
  state_entries_ = states_.size() - mechanical;
}

// A parameter follows from others if its value contains symbols; the inputs are the last parameters. The components of
// a vector parameter stand in the equations as numbers or as formulas of other parameters.
void Dynamics::find_free_parameters(const Model& model, std::size_t inputs) {
  inputs_ = inputs;
  Graph& g = *model.graph;
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool follows = !symbols({&values[i], 1}).empty();
    some_follow_ = some_follow_ || follows;
    if (!follows && !model.parameters[i].vector && i + inputs < values.size()) free_.push_back(i);
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
  Idle<Worker>& idle = lanes == 1 ? alone_ : in_lanes_;
  Worker worker = idle.take().value_or(Worker());
  const bool fresh = !worker.kernel;
  if (fresh) worker.kernel = std::make_unique<Kernel>(plan_, lanes);
  const auto set = [&](const std::vector<long double>& parameters) {
    for (int lane = 0; lane < lanes; ++lane) worker.kernel->set_coefficients(lane, parameters);
  };
  if (call.of_start() && (fresh || worker.as_given)) set(parameters_);
  if (!call.of_start() && call.common(inputs_, free_.size())) set(parameters(call.given, call.count, 0));
  worker.as_given = !call.of_start();
  f(*worker.kernel);
  idle.give_back(std::move(worker));
}

// Returns the state of the motion, unknown by unknown.
std::vector<long double> Dynamics::entries(const std::function<double(std::size_t)>& state) const {
  std::vector<long double> out;
  for (const Unknown& u : unknowns_)
    for (const std::size_t place : u.places) out.push_back(state(place));
  return out;
}

// Returns the leading derivatives of one state by the reference; NaN if the equations have no solution.
std::vector<double> Dynamics::by_reference(double t, const std::function<double(std::size_t)>& state,
                                           const std::vector<long double>& parameters) const {
  if (!linear()) return along_branch(t, state, parameters);
  const Program& program = plan_ ? plan_->program() : *program_;
  Expansion<long double> point(program, parameters, 1);
  point.load(t, entries(state), {});
  Outcome o = point.prepare();
  if (o.ok()) o = point.solve();
  std::vector<double> solved;
  for (std::size_t j = 0; j < unknowns_.size(); ++j)
    solved.push_back(o.ok() ? static_cast<double>(point.derivative(j, unknowns_[j].order()))
                            : std::numeric_limits<double>::quiet_NaN());
  return solved;
}

// Follows the solution from the start along a straight line in time, state and parameters, by steps in which Newton's
// method contracts from its first iteration on, so that it stays on its branch. Returns NaN if such steps become tiny.
std::vector<double> Dynamics::along_branch(double t, const std::function<double(std::size_t)>& state,
                                           const std::vector<long double>& parameters) const {
  const std::vector<long double> to = entries(state), from(motion_start_.begin(), motion_start_.end());
  const auto between = [](long double a, long double b, long double s) { return s == 1 ? b : a + s * (b - a); };
  const auto all_between = [&](const std::vector<long double>& a, const std::vector<long double>& b, long double s) {
    std::vector<long double> out(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) out[i] = between(a[i], b[i], s);
    return out;
  };
  std::vector<long double> leading = start_leading_;
  std::optional<Expansion<long double>> point;
  for (long double s = 0, step = 1; s < 1;) {
    const long double next = std::min(1.0L, s + step);
    if (!point || parameters != parameters_) point.emplace(*program_, all_between(parameters_, parameters, next), 1);
    std::vector<long double> found = leading;
    if (contracts(*point, between(start_time_, t, next), all_between(from, to, next), found)) {
      s = next, step *= 2;
      leading = std::move(found);
    } else if ((step /= 2) < kLeastStep) {
      return std::vector<double>(unknowns_.size(), std::numeric_limits<double>::quiet_NaN());
    }
  }
  return {leading.begin(), leading.end()};
}

template <class Put>
void Dynamics::compute_by_reference(const Call& call, std::size_t from, std::size_t to, const Put& put) const {
  for (std::size_t k = from; k < to; ++k) {
    const std::vector<double> solved = by_reference(
        call.t, [&](std::size_t i) { return call.x[i * call.count + k]; }, parameters(call.given, call.count, k));
    put(k, [&](std::size_t j) { return solved[j]; });
  }
}

// Computes as many states at once as the kernel has lanes; lanes without a state get the last one.
template <class Put>
void Dynamics::compute(Kernel& kernel, const Call& call, std::size_t from, std::size_t to, const Put& put) const {
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
      return k < u.order() ? state(u.places[static_cast<std::size_t>(k)], lane) : 0;
    });
    kernel.solve_point();
    for (std::size_t lane = 0; lane < some; ++lane) {
      // The pivots were chosen at the start; if they are small here, the reference chooses others.
      if (kernel.pivots(static_cast<int>(lane)).health > plan_->least_health())
        put(first + lane,
            [&](std::size_t j) { return kernel.derivative(j, unknowns_[j].order(), static_cast<int>(lane)); });
      else
        compute_by_reference(call, first + lane, first + lane + 1, put);
    }
  }
}

template <class Put>
void Dynamics::solve(const Call& call, const Put& put) const {
  const std::size_t count = call.count;
  if (!plan_) {
    in_pieces(count, kManyLanes, [&](const NextPiece& next) {
      while (const std::optional<std::size_t> from = next())
        compute_by_reference(call, *from, std::min(count, *from + kManyLanes), put);
    });
    return;
  }
  if (count < kManyLanes) {
    with_kernel(1, call, [&](Kernel& k) { compute(k, call, 0, count, put); });
    return;
  }
  int lanes = tiers().back().lanes;
  // The code of a plan that is too large for the compiler is translated.
  if (!plan_->compile(code_cache(), lanes).empty() &&
      plan_->compile(code_cache(), lanes_at_first(), CodeEffort::quick).empty())
    lanes = lanes_at_first();
  in_pieces(count, kManyThreads, [&](const NextPiece& next) {
    with_kernel(lanes, call, [&](Kernel& k) {
      while (const std::optional<std::size_t> from = next())
        compute(k, call, *from, std::min(count, *from + kManyThreads), put);
    });
  });
}

// The rates of a state are entries of the state, and the leading derivatives.
void Dynamics::rates(double t, const double* x, std::size_t count, double* rates, InputsAndParameters given) const {
  solve({t, x, count, given}, [&](std::size_t k, const auto& solved) {
    for (std::size_t j = 0; j < unknowns_.size(); ++j) {
      const std::vector<std::size_t>& places = unknowns_[j].places;
      for (std::size_t i = 0; i < places.size(); ++i)
        rates[places[i] * count + k] = i + 1 < places.size() ? x[places[i + 1] * count + k] : solved(j);
    }
  });
}

std::vector<double> Dynamics::leading(double t, const double* x, std::size_t count, InputsAndParameters given) const {
  const std::size_t n = unknowns_.size();
  std::vector<double> list(n * count);
  solve({t, x, count, given}, [&](std::size_t k, const auto& solved) {
    for (std::size_t j = 0; j < n; ++j) list[k * n + j] = solved(j);
  });
  return list;
}

std::vector<double> Dynamics::from_motion(double t, const std::vector<double>& q, const std::vector<double>& qd,
                                          const std::vector<double>& z, std::span<const double> p) const {
  std::vector<double> x = q;
  if (!map_) {
    x.insert(x.end(), qd.begin(), qd.end());
  } else {
    std::vector<long double> state, own;
    for (std::size_t a = 0; a < coordinates_; ++a) state.insert(state.end(), {q[a], qd[a]});
    state.insert(state.end(), z.begin(), z.end());
    StateReader(*map_, parameters({{}, p}, 1, 0)).own(t, state, own);
    for (std::size_t i = coordinates_ + model_states_; i < own.size(); ++i) x.push_back(static_cast<double>(own[i]));
  }
  x.insert(x.end(), z.begin(), z.end());
  return x;
}

Dynamics::Full Dynamics::to_motion(double t, const std::vector<double>& x, std::span<const double> p) const {
  const auto n = static_cast<std::ptrdiff_t>(values_), states = static_cast<std::ptrdiff_t>(state_entries_);
  Full full{{x.begin(), x.begin() + n}, {x.begin() + n, x.end() - states}, {x.end() - states, x.end()}};
  if (!map_) return full;
  std::vector<long double> own(full.q.begin(), full.q.end()), state;
  own.insert(own.end(), full.z.begin(), full.z.end());
  own.insert(own.end(), full.qd.begin(), full.qd.end());
  StateReader(*map_, parameters({{}, p}, 1, 0)).motion(t, own, state);
  full.qd.clear();
  for (std::size_t a = 0; a < coordinates_; ++a) full.qd.push_back(static_cast<double>(state[2 * a + 1]));
  return full;
}

}  // namespace anholon
