#include "motion/representation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "expr/copy.h"
#include "expr/normal.h"
#include "lowering/by_rates.h"
#include "lowering/quasi_velocities.h"
#include "lowering/velocity_algebra.h"
#include "print/arrange.h"
#include "print/print.h"
#include "print/print_names.h"

namespace anholon {

namespace {

// In larger systems, such as chains, there are few pairs, and equations become longer when they are written out.
constexpr std::size_t kMostUnknowns = 12, kMostNodes = 2000;
// In larger systems a plan takes longer to make than it saves: with refined solutions, and in quasi-velocities.
constexpr std::size_t kMostRefined = 64, kMostInQuasi = 64;
// The bound of products of terms for one equation, which take a fraction of a millisecond.
constexpr long kMostProducts = 4000;
// Two writings of one equation have to agree to this, relative to the largest coefficient of the order; otherwise one
// of them loses digits.
constexpr double kAgree = 1e-11;

// A program with its system, in a graph of its own.
struct Rewritten {
  System system;
  Program program;
};

System names_and_graph(const System& from) {
  auto model = std::make_shared<Model>();
  model->graph = std::make_shared<Graph>();
  model->names = from.model->names;
  model->names.defined.clear();
  System s = from;
  s.equations.clear();
  s.model = std::move(model);
  return s;
}

// True if no derivative beyond those solved for occurs. Such derivatives had cancelled before, and a program could not
// compute their values.
bool same_offsets(const System& s, const Structure& structure) {
  for (std::size_t i = 0; i < s.equations.size(); ++i)
    for (NodeId id : symbols({&s.equations[i], 1}))
      if (const auto j = s.variable(id); j && s.model->graph->node(id).order + structure.c[i] > structure.d[*j])
        return false;
  return true;
}

std::shared_ptr<const Program> rewritten(const ToRepresent& e, Writing writing) {
  const System& derived = *e.derived->program().system;
  Column all = derived.equations;
  all.insert(all.end(), e.quadratures.begin(), e.quadratures.end());
  if (reachable(all).size() > kMostNodes) return nullptr;
  auto r = std::make_shared<Rewritten>();
  r->system = names_and_graph(derived);
  Graph& g = *r->system.model->graph;
  Column written;
  for (Expr x : copied(all, g)) {
    const std::optional<Expr> out = expanded(x, kMostProducts);
    written.push_back(!out ? x : writing == Writing::expanded ? *out : arranged(x, r->system.model->names));
  }
  const auto equations = static_cast<std::ptrdiff_t>(derived.size());
  r->system.equations.assign(written.begin(), written.begin() + equations);
  if (!same_offsets(r->system, e.structure)) return nullptr;
  r->program = program(r->system, e.structure, std::span(written).subspan(derived.size()), true);
  return {r, &r->program};
}

std::shared_ptr<const Program> left_to_series(const ToRepresent& e) {
  if (!e.mechanics) return nullptr;
  std::optional<ByRates> by = by_rates(*e.derived->program().system, *e.mechanics, e.quadratures);
  if (!by || !same_offsets(by->system, e.structure)) return nullptr;
  auto r = std::make_shared<Rewritten>(Rewritten{std::move(by->system), {}});
  r->program = program(r->system, e.structure, by->others, true);
  return {r, &r->program};
}

// The value of a symbol of the derived system at the start; 0 if there is none.
double value_at_start(const ToRepresent& e, const Node& n) {
  const Program& p = e.derived->program();
  if (n.kind == Kind::time) return e.t;
  if (n.kind == Kind::parameter) return static_cast<double>(e.parameters[n.index]);
  std::size_t at = 0, j = n.kind == Kind::state ? p.system->mechanical() + n.index : n.index;
  if ((n.kind != Kind::state && n.kind != Kind::jet) || j >= p.unknowns() || n.order >= p.d[j]) return 0;
  for (std::size_t i = 0; i < j; ++i) at += static_cast<std::size_t>(p.d[i]);
  return e.state[at + n.order];
}

// The largest difference of two expansions at one state, over all orders.
double difference(const ToRepresent& e, const std::shared_ptr<const KernelPlan>& a,
                  const std::shared_ptr<const KernelPlan>& b) {
  Kernel one(a), other(b);
  for (Kernel* k : {&one, &other}) {
    k->set_parameters(0, e.parameters);
    std::vector<long double> state(e.state.begin(), e.state.end()), own;
    if (k->plan().map())
      k->reader(0).own(e.t, state, own);
    else
      own = state;
    k->load<long double>(0, e.t, own, {});
    k->expand();
    if (!k->finite(0)) return std::numeric_limits<double>::infinity();
  }
  double worst = 0;
  const std::size_t unknowns = a->plan().d.size();
  for (int k = 0; k <= a->plan().stages; ++k) {
    double size = 1e-9, off = 0;
    for (std::size_t j = 0; j < unknowns; ++j) {
      const auto of_other = b->map() ? b->map()->own(j, unknowns) : std::optional<std::size_t>(j);
      if (!of_other) continue;
      const int order = k + b->plan().d[*of_other];
      size = std::max(size, std::abs(one.coefficient(j, order)));
      off = std::max(off, std::abs(one.coefficient(j, order) - other.coefficient(*of_other, order)));
    }
    worst = std::max(worst, off / size);
  }
  return worst;
}

// The reason why equations cannot be written in quasi-velocities, as far as it is known before these are sought; empty
// if there is none.
std::string obstacle_to_quasi_velocities(const ToRepresent& e) {
  const Program& derived = e.derived->program();
  const System& s = *derived.system;
  if (!e.mechanics || s.form != find_formulation("routh")) return "the equations have another form than Routh's";
  for (std::size_t j = 0; j < derived.unknowns(); ++j)
    if (derived.d[j] != (j < s.coordinates ? 2 : j < s.mechanical() ? 0 : 1))
      return "the equations are solved for " +
             derivative_name(s.variable_names[j], static_cast<unsigned>(derived.d[j]), Format::text) +
             ", not for accelerations and multipliers alone";
  if (s.constraints.empty()) return "there are no constraints, so the velocities are independent as they are";
  if (derived.unknowns() > kMostInQuasi)
    return "there are " + std::to_string(derived.unknowns()) +
           " unknowns, and independent velocities are sought for at most " + std::to_string(kMostInQuasi);
  if (e.derived->tables().refine) return "the equations are nearly singular at the start";
  return {};
}

// Writes the equations in quasi-velocities. It serves only systems that are solved for accelerations and multipliers
// alone.
std::optional<Representation> in_quasi_velocities(const ToRepresent& e, std::string& why) {
  if (why = obstacle_to_quasi_velocities(e); !why.empty()) return std::nullopt;
  const System& s = *e.derived->program().system;
  std::optional<QuasiVelocities> q =
      quasi_velocities(s, *e.mechanics, e.quadratures, [&](const Node& n) { return value_at_start(e, n); }, why);
  if (!q) return std::nullopt;
  Representation found{Writing::quasi, nullptr, {}, q->clears_poles};
  for (Expr p : q->of_state)
    found.velocities.push_back(
        print(written_out(p, s.coordinates, q->system.rates), q->system.model->names, Format::text));
  const bool judged = !is_number(q->determinant);
  if (judged) q->others.push_back(q->determinant);
  auto map = std::make_shared<const StateMap>(*q);
  auto r = std::make_shared<Rewritten>(Rewritten{std::move(q->system), {}});
  Structure first_order;
  first_order.c.assign(r->system.size(), 0);
  first_order.d.assign(r->system.size(), 1);
  r->program = program(r->system, first_order, q->others, true);
  found.plan = KernelPlan::make({r, &r->program}, std::move(map), judged, e.derived->plan().stages, e.parameters, e.t,
                                e.state, e.derived->company());
  if (!found.plan || !(difference(e, e.derived, found.plan) < kAgree)) {
    why = "in independent velocities the equations lose digits at the start";
    return std::nullopt;
  }
  return found;
}

// True if the stepper has to follow, by the slots of the derived tape, what decides which functions hold.
bool followed_by_slots(const KernelPlan& plan) { return !plan.plan().deciding.empty(); }

bool large(const KernelPlan& derived) { return derived.program().unknowns() > kMostUnknowns; }

// If a system of few unknowns needs refined solutions, J has lost digits to round-off, and no other writing is as good.
// A long chain is so badly conditioned that it needs them in any writing, sooner or later.
void add(const ToRepresent& e, Writing writing, std::shared_ptr<const Program> p, std::vector<Representation>& list) {
  if (!p) return;
  const KernelPlan& first = *e.derived;
  auto plan = KernelPlan::make(std::move(p), first.plan().stages, e.parameters, e.t, e.state, first.company());
  if (plan && (large(first) || plan->tables().refine == first.tables().refine) && !followed_by_slots(*plan) &&
      difference(e, e.derived, plan) < kAgree)
    list.push_back({writing, std::move(plan), {}});
}

}  // namespace

const char* name(Writing writing) {
  switch (writing) {
  case Writing::derived:
    return "derived";
  case Writing::paired:
    return "paired";
  case Writing::rates:
    return "rates";
  case Writing::quasi:
    return "quasi";
  case Writing::expanded:
    return "expanded";
  case Writing::arranged:
    return "arranged";
  }
  return "";
}

std::vector<Representation> representations(const ToRepresent& e, WritingEffort effort) {
  std::vector<Representation> list{{Writing::derived, e.derived, {}}};
  const KernelPlan& first = *e.derived;
  const Program& derived = first.program();
  if (followed_by_slots(first)) return list;
  if (!first.tables().refine || (large(first) && derived.unknowns() <= kMostRefined))
    add(e, Writing::rates, left_to_series(e), list);
  std::string unused;
  if (auto quasi = in_quasi_velocities(e, unused)) list.push_back(std::move(*quasi));
  if (large(first)) return list;
  add(e, Writing::paired, std::make_shared<const Program>(program(*derived.system, e.structure, e.quadratures, true)),
      list);
  add_representations(e, effort, list);
  return list;
}

std::optional<Representation> in_independent_velocities(const ToRepresent& e, std::string& why) {
  return in_quasi_velocities(e, why);
}

void add_representations(const ToRepresent& e, WritingEffort effort, std::vector<Representation>& list) {
  const KernelPlan& first = *e.derived;
  if (followed_by_slots(first) || large(first) || first.tables().refine) return;
  if (effort >= WritingEffort::long_motion) add(e, Writing::expanded, rewritten(e, Writing::expanded), list);
  if (effort >= WritingEffort::very_long_motion) add(e, Writing::arranged, rewritten(e, Writing::arranged), list);
}

std::size_t steps_before(WritingEffort effort) {
  switch (effort) {
  case WritingEffort::at_once:
    return 0;
  case WritingEffort::long_motion:
    return 2000;
  case WritingEffort::very_long_motion:
    return 200'000;
  }
  return 0;
}

WritingEffort effort_after(std::size_t steps) {
  WritingEffort most = WritingEffort::at_once;
  for (const WritingEffort e : kWritingEfforts)
    if (steps >= steps_before(e)) most = e;
  return most;
}

std::size_t steps_with_effort(std::size_t steps) {
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const WritingEffort e : kWritingEfforts)
    if (steps_before(e) > steps) least = std::min(least, steps_before(e) - steps);
  return least;
}

const Representation& cheapest(const std::vector<Representation>& list) {
  return *std::min_element(list.begin(), list.end(), [](const Representation& a, const Representation& b) {
    return a.clears_poles != b.clears_poles ? a.clears_poles : a.plan->cost() < b.plan->cost();
  });
}

const Representation& cheapest_unmapped(const std::vector<Representation>& list) {
  const auto cost = [](const Representation& r) {
    return r.plan->map() ? std::numeric_limits<double>::infinity() : r.plan->cost();
  };
  return *std::min_element(list.begin(), list.end(),
                           [&](const Representation& a, const Representation& b) { return cost(a) < cost(b); });
}

ExpansionWork work_of(const KernelPlan& plan) {
  ExpansionWork w;
  for (const std::vector<Step>* list : {&plan.plan().stage, &plan.plan().after})
    for (const Step& s : *list) switch (s.act) {
      case Act::linear:
        w.sums += s.count;
        break;
      case Act::multiply:
      case Act::divide:
      case Act::function:
      case Act::square:
      case Act::square_root:
      case Act::power:
      case Act::sine_cosine:
      case Act::arctan2:
        ++w.products;
        break;
      case Act::input:
      case Act::beyond:
      case Act::weigh:
      case Act::select:
      case Act::lookup:
        break;
      }
  w.solve = static_cast<std::size_t>(plan.elimination().work());
  w.operations = plan.work();
  w.waits = plan.waits();
  w.total = plan.cost();
  return w;
}

}  // namespace anholon
