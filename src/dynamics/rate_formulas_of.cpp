#include "dynamics/rate_formulas_of.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/assert.h"
#include "emit/motion.h"
#include "emit/text.h"
#include "expr/copy.h"
#include "lowering/quasi_velocities.h"
#include "lowering/velocity_algebra.h"
#include "numeric/linear.h"
#include "program/sparse_lu.h"
#include "setup/ends_of_tables.h"

namespace anholon {

namespace {

constexpr double kAround = 0.3;  // in coordinates and velocities

class Builder {
 public:
  // `input_formulas`: first with all inputs replaced by their formulas, then with the parameters that are inputs.
  Builder(Workspace& s, const Dynamics& of, const Column& input_formulas)
      : s_(s), of_(of), motion_(emit::motion_between_events(s.system, s.structure, {})) {
    const Model& model = *s.model;
    for (const Expr e : input_formulas) input_formulas_.push_back(put_masses(model, e));
    for (const Monitor& m : model.monitors) {
      f_.output_names.push_back(m.name);
      f_.outputs.push_back(put_masses(model, m.value));
    }
    f_.title = model.title;
    f_.t = of.start_time();
    f_.start = of.start();
    for (const Dynamics::State& state : of.states())
      f_.x.names.push_back(state.name), f_.meanings.push_back(state.meaning);
  }

  RateFormulas run() {
    if (of_.minimal())
      in_independent_velocities();
    else
      in_all_velocities();
    const auto open = f_.input_formulas.begin() + static_cast<std::ptrdiff_t>(f_.input_formulas.size() / 2);
    f_.open_input_formulas.assign(open, f_.input_formulas.end());
    f_.input_formulas.erase(open, f_.input_formulas.end());
    const std::vector<Parameter>& parameters = s_.model->parameters;
    Graph& g = *f_.model->graph;
    const auto add = [&](RateFormulas::Symbols& to, std::vector<double>& values, std::size_t i) {
      to.add(parameters[i].name, g.parameter(static_cast<std::uint32_t>(i)));
      values.push_back(static_cast<double>(of_.parameters()[i]));
    };
    for (const std::size_t i : of_.free_parameters()) {
      add(f_.p, f_.parameters, i);
      f_.exact_parameters.push_back(parameters[i].value);
    }
    if (f_.model != s_.model) f_.exact_parameters = copied(f_.exact_parameters, g);
    for (std::size_t i = parameters.size() - of_.inputs(); i < parameters.size(); ++i) add(f_.u, f_.inputs, i);
    put_parameters();
    leave_out();
    choose_pivots();
    return std::move(f_);
  }

 private:
  // x: the state of the motion, in the order of Dynamics::put_state_of_motion; lead: the unknowns of the system. If
  // only rates of the model's states are nonlinear in accelerations and multipliers, these rates are explicit.
  void in_all_velocities() {
    const System& s = s_.system;
    const std::vector<int>& d = s_.structure.d;
    const std::size_t solved = of_.rates_follow() ? s.mechanical() : s.size();
    f_.model = s_.model;
    f_.linear = of_.linear();
    for (std::size_t j = 0; j < solved; ++j)
      f_.lead.add(motion_.leading_names[j], s.symbol(j, static_cast<unsigned>(d[j])));
    const auto add = [&](std::size_t j, int k) {
      f_.x.symbols.push_back(s.symbol(j, static_cast<unsigned>(k)));
      f_.rates.push_back(s.symbol(j, static_cast<unsigned>(k + 1)));
    };
    const int highest = *std::max_element(d.begin(), d.end());
    for (int k = 0; k < highest; ++k)
      for (std::size_t j = 0; j < s.mechanical(); ++j)
        if (k < d[j]) add(j, k);
    for (std::size_t j = s.mechanical(); j < s.size(); ++j)
      for (int k = 0; k < d[j]; ++k) add(j, k);
    ANHOLON_ASSERT(f_.x.symbols.size() == of_.states().size());
    f_.equations.assign(motion_.residual.begin(), motion_.residual.begin() + static_cast<std::ptrdiff_t>(solved));
    f_.input_formulas = input_formulas_;
    if (solved == s.size()) return;
    Column derivatives, rates;  // the form of equation j is  (state j)' - rate
    for (std::size_t j = solved; j < s.size(); ++j) {
      ANHOLON_ASSERT(d[j] == 1);
      derivatives.push_back(s.symbol(j, 1));
      rates.push_back(derivatives.back() - motion_.residual[j]);
    }
    f_.rates = put(f_.rates, derivatives, rates);
    f_.outputs = put(f_.outputs, derivatives, rates);
  }

  // x = q, p, z with explicit rates. Formulas with multipliers or derivatives beyond accelerations are left out.
  void in_independent_velocities() {
    const System& s = s_.system;
    const std::size_t n = s.coordinates, z = s_.model->states.size();
    Column others;
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < f_.outputs.size(); ++i)
      if (known_in_independent_velocities(f_.outputs[i])) others.push_back(f_.outputs[i]), kept.push_back(i);
    others.insert(others.end(), input_formulas_.begin(), input_formulas_.end());
    std::string unused;
    const auto q =
        quasi_velocities(s, *s_.mechanics, others, [&](const Node& symbol) { return of_.at_start(symbol); }, unused);
    // Exponents that are parameters may leave the formulas without values at the start, by which velocities are chosen.
    if (!q || q->count + z + n != of_.states().size())
      throw Failure({}, "the formulas have no values at the start by which independent velocities are chosen");
    f_.model = q->system.model;
    Graph& g = *f_.model->graph;
    const auto written = [&](Expr e) { return written_out(e, n, q->system.rates); };
    const auto unknown = [&](std::size_t i, unsigned order) { return g.state(static_cast<std::uint32_t>(i), order); };
    // The form of equation n + i is  (state i)' - rate.
    Column derivatives, rates;
    for (std::size_t i = 0; i < z + q->count; ++i) {
      derivatives.push_back(unknown(i, 1));
      rates.push_back(written(derivatives[i] - q->system.equations[n + i]));
    }
    for (std::size_t a = 0; a < n; ++a) {
      f_.x.symbols.push_back(g.jet(static_cast<std::uint32_t>(a), 0));
      f_.rates.push_back(written(q->velocities[a]));
    }
    for (const auto& [from, to] : {std::pair{z, z + q->count}, std::pair{std::size_t{0}, z}})
      for (std::size_t i = from; i < to; ++i) f_.x.symbols.push_back(unknown(i, 0)), f_.rates.push_back(rates[i]);
    Column values;
    const Column qd = jets(*f_.model, 1),
                 velocities(f_.rates.begin(), f_.rates.begin() + static_cast<std::ptrdiff_t>(n));
    for (Expr e : q->others) values.push_back(put(put(written(e), qd, velocities), derivatives, rates));
    std::vector<std::string> names;
    std::size_t next = 0;
    f_.outputs.clear();
    for (std::size_t i = 0; i < f_.output_names.size(); ++i)
      if (next < kept.size() && kept[next] == i)
        names.push_back(f_.output_names[i]), f_.outputs.push_back(values[next++]);
      else
        f_.left_out.push_back(f_.output_names[i]);
    f_.output_names = std::move(names);
    f_.input_formulas.assign(values.begin() + static_cast<std::ptrdiff_t>(next), values.end());
  }

  static bool known_in_independent_velocities(Expr e) {
    for (const NodeId id : symbols({&e, 1}))
      if (const Node& n = e.graph->node(id); n.kind == Kind::multiplier || (n.kind == Kind::jet && n.order > 2))
        return false;
    return true;
  }

  // Replaces parameters that follow from others by their formulas, and then those that decide the order of the equations
  // by their values: m q'' with m = 0 holds no unknown.
  void put_parameters() {
    Column formulas;
    for (const std::size_t i : motion_.derived) formulas.push_back(motion_.parameters[i]);
    put_parameters(motion_.derived, formulas);
    const std::vector<Parameter>& parameters = s_.model->parameters;
    const std::vector<std::size_t>& free = of_.free_parameters();
    std::vector<std::size_t> fixed;
    Column values;
    for (std::size_t i = 0; i < parameters.size() - of_.inputs(); ++i)
      if (std::find(free.begin(), free.end(), i) == free.end() && symbols({&parameters[i].value, 1}).empty())
        fixed.push_back(i), values.push_back(parameters[i].value);
    put_parameters(fixed, values);
  }

  void put_parameters(const std::vector<std::size_t>& indices, Column formulas) {
    if (indices.empty()) return;
    if (f_.model != s_.model) formulas = copied(formulas, *f_.model->graph);
    for (Column* es : {&f_.rates, &f_.equations, &f_.outputs, &f_.input_formulas, &f_.open_input_formulas})
      *es = substitute(*es, [&](NodeId id) {
        const Node& n = f_.model->graph->node(id);
        if (n.kind != Kind::parameter) return Expr{};
        for (std::size_t k = 0; k < formulas.size(); ++k)
          if (indices[k] == n.index) return formulas[k];
        return Expr{};
      });
  }

  // Chooses pivots by the values of the matrix around the start.
  void choose_pivots() {
    const std::size_t n = f_.lead.size();
    if (n == 0 || !f_.linear) return;
    const Column entries = emit::entries(f_.matrix());
    const CompiledFormulas matrix(f_, entries);
    std::vector<double> parameters(of_.parameters().begin(), of_.parameters().end()), x = f_.start;
    std::vector<SampledEntry> sampled;
    for (std::size_t k = 0; k < entries.size(); ++k)
      if (!is_zero(entries[k]))
        sampled.push_back(
            {static_cast<std::uint32_t>(k / n), static_cast<std::uint32_t>(k % n), {}, is_number(entries[k])});
    std::size_t samples = 0;
    for (std::size_t attempt = 0; attempt < 3 * kSamples && samples < kSamples; ++attempt) {
      for (std::size_t i = 0; i < x.size() && attempt > 0; ++i)
        x[i] = f_.start[i] + kAround * std::sin(static_cast<double>(64 * attempt + i));
      const FormulaPoint at{f_.t, x, parameters, {}};
      const std::vector<double> values = matrix.values({&at, 1});
      std::size_t next = 0;
      bool good = true;
      for (std::size_t k = 0; k < values.size(); ++k)
        if (!is_zero(entries[k])) good = std::isfinite(sampled[next++].value[samples] = values[k]) && good;
      samples += good;
    }
    for (; samples > 0 && f_.pivots.empty(); --samples)
      for (const SparseLu::Pivot& p : eliminate_sparse(static_cast<std::uint32_t>(n), sampled, samples).lu.pivots)
        f_.pivots.push_back({p.row, p.column});
  }

  // Leaves out formulas with other symbols: derivatives beyond those solved for, and undetermined multipliers. Formulas of inputs contain no input
  // and no unknown of the equations.
  void leave_out() {
    std::set<NodeId> known{f_.model->graph->time().id};
    for (const RateFormulas::Symbols* list : {&f_.x, &f_.p})
      for (Expr e : list->symbols) known.insert(e.id);
    const auto holds_others = [&](Expr e) {
      for (const NodeId id : symbols({&e, 1}))
        if (!known.count(id)) return true;
      return false;
    };
    for (Expr e : f_.input_formulas)
      if (holds_others(e)) {
        f_.input_formulas.clear();
        f_.open_input_formulas.clear();
        break;
      }
    for (const RateFormulas::Symbols* list : {&f_.u, &f_.lead})
      for (Expr e : list->symbols)
        if (!is_undetermined(e)) known.insert(e.id);
    for (std::size_t i = f_.outputs.size(); i-- > 0;)
      if (holds_others(f_.outputs[i])) {
        f_.left_out.push_back(f_.output_names[i]);
        f_.outputs.erase(f_.outputs.begin() + static_cast<std::ptrdiff_t>(i));
        f_.output_names.erase(f_.output_names.begin() + static_cast<std::ptrdiff_t>(i));
      }
  }

  // True for the multipliers of constraints that depend on one another: they follow from the motion by a choice, which
  // these formulas do not make. The formulas hold for all states.
  bool is_undetermined(Expr e) const {
    const Node& n = e.graph->node(e.id);
    return n.kind == Kind::multiplier && !s_.undetermined.determined_everywhere(n.index) &&
           !s_.model->constraints[n.index].by;
  }

  Workspace& s_;
  const Dynamics& of_;
  emit::Motion motion_;
  Column input_formulas_;
  RateFormulas f_;
};

}  // namespace

std::optional<RateFormulas> independent_rates(const Scenario& scenario, const StateChoice& choice,
                                              const std::vector<std::size_t>& fixed) {
  Workspace own(scenario);
  std::string why;
  const std::unique_ptr<Dynamics> function = Dynamics::make(own, choice, {.fixed = fixed}, why);
  if (!function || !function->minimal()) return std::nullopt;
  Workspace formulas(scenario);
  return rate_formulas_of(formulas, *function, {}, {});
}

RateFormulas rate_formulas_of(Workspace& s, const Dynamics& dynamics, std::span<const NodeId> input_formulas,
                              std::span<const NodeId> open) {
  Column both;
  for (const std::span<const NodeId> list : {input_formulas, open})
    for (const NodeId id : list) both.push_back({s.model->graph.get(), id});
  both = with_ends_of_tables(*s.model, both);
  put_ends_of_tables(s);
  return Builder(s, dynamics, both).run();
}

FormulaValues::FormulaValues(RateFormulas formulas) : formulas_(std::move(formulas)) {
  const RateFormulas& f = formulas_;
  inputs_ = {f, f.input_formulas};
  open_inputs_ = {f, f.open_input_formulas};
  outputs_ = {f, f.outputs};
  Column equations = emit::entries(f.matrix());
  const Column right = f.right();
  equations.insert(equations.end(), right.begin(), right.end());
  equations_ = {f, equations};
}

std::vector<double> FormulaValues::inputs(const Point& at, std::span<const std::optional<double>> given) const {
  std::vector<double> parameters(at.parameters.begin(), at.parameters.end());
  const std::span<double> u = std::span(parameters).last(given.size());
  const auto put = [&](const std::vector<double>& by_formulas) {
    for (std::size_t i = 0; i < given.size(); ++i) u[i] = given[i].value_or(by_formulas[i]);
  };
  put(inputs(at));
  // No formula contains its own input, also not through others, so each pass settles the inputs of one more depth.
  for (std::size_t pass = 0; pass < given.size(); ++pass) {
    const Point given_here{at.t, at.x, parameters, {}};
    put(open_inputs_.values({&given_here, 1}));
  }
  return {u.begin(), u.end()};
}

std::vector<RateDerivatives::Of> FormulaValues::derivatives(std::span<const Point> points, By by) const {
  const std::size_t k = static_cast<std::size_t>(by);
  std::call_once(once_[k], [&] {
    const std::lock_guard lock(building_);
    const RateFormulas::Symbols* const lists[] = {&formulas_.x, &formulas_.u, &formulas_.p};
    derivatives_[k] = std::make_unique<const RateDerivatives>(formulas_, *lists[k]);
  });
  return derivatives_[k]->at(points);
}

std::string FormulaValues::python_source() const {
  const std::lock_guard lock(building_);
  return emit_formulas(formulas_);
}

std::string FormulaValues::c_source(const std::string& name, const std::string& made_by) const {
  const std::lock_guard lock(building_);
  return emit_casadi(formulas_, name, made_by);
}

}  // namespace anholon
