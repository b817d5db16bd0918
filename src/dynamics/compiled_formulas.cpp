#include "dynamics/compiled_formulas.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <unordered_map>

#include "base/assert.h"
#include "dynamics/idle.h"
#include "expr/copy.h"
#include "kernel/kernel.h"

namespace anholon {

namespace {

// The limit of steps of a plan that machine code is made for.
constexpr std::size_t kMostSteps = 40'000;

// A program with its system, in a graph of its own.
struct FormulaProgram {
  System system;
  Program program;
};

// The states of the program are the symbols in which formulas are written, with zero rates, and one for each formula,
// which is its rate.
std::shared_ptr<const FormulaProgram> program_of(const RateFormulas& f, const Column& es, const Column& symbols) {
  auto model = std::make_shared<Model>();
  model->graph = std::make_shared<Graph>();
  model->names = f.model->names;
  model->names.defined.clear();
  model->names.states.clear();
  Graph& g = *model->graph;
  Column all = symbols;
  all.insert(all.end(), es.begin(), es.end());
  all = copied(all, g);
  std::unordered_map<NodeId, std::uint32_t> index;
  for (std::size_t i = 0; i < symbols.size(); ++i) index[all[i].id] = static_cast<std::uint32_t>(i);
  const Column values =
      substitute(Column(all.begin() + static_cast<std::ptrdiff_t>(symbols.size()), all.end()), [&](NodeId id) {
        const auto at = index.find(id);
        return at == index.end() ? Expr{} : g.state(at->second, 0);
      });
  auto made = std::make_shared<FormulaProgram>();
  System& s = made->system;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Expr rate = g.state(static_cast<std::uint32_t>(i), 1);
    s.equations.push_back(i < symbols.size() ? rate : rate - values[i - symbols.size()]);
    model->names.states.push_back("s" + std::to_string(i + 1));
  }
  s.equation_names = s.variable_names = model->names.states;
  s.model = std::move(model);
  Structure first_order;
  first_order.c.assign(s.size(), 0);
  first_order.d.assign(s.size(), 1);
  made->program = program(s, first_order);
  return made;
}

}  // namespace

class CompiledFormulas::Evaluator {
 public:
  Evaluator(const RateFormulas& f, const Column& es) : size_(es.size()) {
    Column symbols = f.x.symbols, formulas;
    symbols.insert(symbols.end(), f.lead.symbols.begin(), f.lead.symbols.end());
    for (std::size_t i = 0; i < es.size(); ++i)
      if (is_number(es[i]))
        numbers_.push_back({i, number_value(es[i]).get_d()});
      else
        formulas.push_back(es[i]), places_.push_back(i);
    states_ = f.x.size(), symbols_ = symbols.size();
    if (formulas.empty()) return;
    const auto own = program_of(f, formulas, symbols);
    std::vector<long double> parameters(f.model->names.parameters.size());
    for (const auto& [list, values] : {std::pair{&f.p, &f.parameters}, std::pair{&f.u, &f.inputs}})
      for (std::size_t i = 0; i < list->size(); ++i)
        parameters[f.model->graph->node(list->symbols[i].id).index] = (*values)[i];
    std::vector<double> state(f.start);
    state.resize(own->system.size());
    plan_ = KernelPlan::make({own, &own->program}, 1, parameters, f.t, state, Company::in_lanes);
    ANHOLON_ASSERT(plan_);
  }

  std::size_t size() const { return size_; }

  std::vector<double> values(std::span<const FormulaPoint> points) const {
    std::vector<double> out(points.size() * size_);
    for (const auto& [i, value] : numbers_)
      for (std::size_t k = 0; k < points.size(); ++k) out[k * size_ + i] = value;
    if (!plan_) return out;
    const std::size_t before = asked_.fetch_add(points.size());
    const bool many = points.size() >= static_cast<std::size_t>(lanes_at_first());
    const int lanes = many ? lanes_at_first() : 1;
    if (before + points.size() >= worth_code()) plan_->compile(code_cache(), lanes, CodeEffort::quick, kMostSteps);
    Idle<Worker>& idle = many ? in_lanes_ : alone_;
    std::optional<Worker> worker = idle.take();
    if (!worker) worker.emplace(Worker{std::make_unique<Kernel>(plan_, lanes), {}});
    for (std::size_t first = 0; first < points.size(); first += static_cast<std::size_t>(lanes))
      compute(*worker, points.subspan(first, std::min(static_cast<std::size_t>(lanes), points.size() - first)),
              {out.begin() + static_cast<std::ptrdiff_t>(first * size_), out.end()});
    idle.give_back(std::move(*worker));
    return out;
  }

 private:
  // The number of points after which machine code is made: it takes about as long as these points took by tables.
  std::size_t worth_code() const { return 1000 + plan_->plan().stage.size() / 2; }

  struct Worker {
    std::unique_ptr<Kernel> kernel;
    std::vector<std::optional<std::vector<double>>> parameters;  // those of each lane; nullopt until they are set
  };

  // Computes as many points as the kernel has lanes, or fewer: further lanes then have the last point.
  void compute(Worker& worker, std::span<const FormulaPoint> points, std::span<double> out) const {
    Kernel& kernel = *worker.kernel;
    worker.parameters.resize(static_cast<std::size_t>(kernel.lanes()));
    const auto point = [&](std::size_t lane) -> const FormulaPoint& {
      return points[std::min(lane, points.size() - 1)];
    };
    for (std::size_t lane = 0; lane < worker.parameters.size(); ++lane) {
      const std::span<const double> p = point(lane).parameters;
      std::optional<std::vector<double>>& set = worker.parameters[lane];
      if (!set || !std::equal(p.begin(), p.end(), set->begin(), set->end())) {
        set.emplace(p.begin(), p.end());
        kernel.set_coefficients(static_cast<int>(lane), {p.begin(), p.end()});
      }
    }
    kernel.load_point(point(0).t, [&](std::size_t j, int k, std::size_t lane) {
      if (k > 0 || j >= symbols_) return 0.0;
      if (j < states_) return point(lane).x[j];
      return point(lane).lead.empty() ? 0.0 : point(lane).lead[j - states_];
    });
    for (std::size_t lane = 0; lane < worker.parameters.size(); ++lane)
      kernel.set_time(static_cast<int>(lane), point(lane).t);
    kernel.solve_point();
    for (std::size_t k = 0; k < points.size(); ++k)
      for (std::size_t i = 0; i < places_.size(); ++i)
        out[k * size_ + places_[i]] = kernel.derivative(symbols_ + i, 1, static_cast<int>(k));
  }

  std::size_t size_, states_ = 0, symbols_ = 0;  // symbols: x, then the unknowns of the equations
  std::vector<std::pair<std::size_t, double>> numbers_;
  std::vector<std::size_t> places_;         // of the formulas among all expressions
  std::shared_ptr<const KernelPlan> plan_;  // nullptr if all expressions are numbers
  mutable std::atomic<std::size_t> asked_ = 0;
  mutable Idle<Worker> alone_, in_lanes_;
};

CompiledFormulas::CompiledFormulas() = default;
CompiledFormulas::CompiledFormulas(const RateFormulas& formulas, const Column& es) {
  if (!es.empty()) evaluator_ = std::make_unique<const Evaluator>(formulas, es);
}
CompiledFormulas::CompiledFormulas(CompiledFormulas&&) noexcept = default;
CompiledFormulas& CompiledFormulas::operator=(CompiledFormulas&&) noexcept = default;
CompiledFormulas::~CompiledFormulas() = default;

std::size_t CompiledFormulas::size() const { return evaluator_ ? evaluator_->size() : 0; }

std::vector<double> CompiledFormulas::values(std::span<const FormulaPoint> points) const {
  return evaluator_ ? evaluator_->values(points) : std::vector<double>();
}

}  // namespace anholon
