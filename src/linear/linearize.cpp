#include "linear/linearize.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "linear/linearizer.h"

namespace anholon {

namespace {

constexpr int kMostSteps = 300;
constexpr int kExactDigits = 40;   // digits of a parameter value between the given ones
constexpr int kMostHalvings = 12;  // halvings of an interval whose crossings do not add up
constexpr int kMostSlow = 3;       // steps that do not halve the interval, before the first bisection
constexpr int kMostSides = 4;      // distances at which an eigenvalue may be off the axis
constexpr double kNarrow = 1e-20;  // relative width of the interval in which a crossing is found
// A continuous real part, even if it varies as the fourth root of the parameter, is smaller than this over such an
// interval, in relation to its values at the ends.
constexpr double kJump = 1e-3;
// The relative distance from a jump at which the start of a search, in doubles, does not distinguish the branches.
constexpr double kBeside = 1e-12;

Rational rational_of(const Multi& x) { return *parse_rational(number_text(x, kExactDigits)); }

int unstable(const LinearModel& m) {
  return static_cast<int>(
      std::count_if(m.spectrum.begin(), m.spectrum.end(), [](const Eigenvalue& e) { return e.value.re > Multi(0); }));
}

// Returns all eigenvalues of A: each coordinate without influence adds a 0 to those of the others.
std::vector<Complex> eigenvalues_of(const LinearModel& m) {
  std::vector<Complex> list(m.cyclic.size());
  for (const Eigenvalue& e : m.spectrum) list.push_back(e.value);
  return list;
}

int zeros(const LinearModel& m) {
  const std::vector<Complex> list = eigenvalues_of(m);
  return static_cast<int>(
      std::count_if(list.begin(), list.end(), [](const Complex& e) { return e.re == Multi(0) && e.im == Multi(0); }));
}

// Returns the eigenvalue with the m-th largest real part (m = 1, 2, …), without the `always` eigenvalues nearest to 0,
// which are 0 over the whole range. Returns nullopt if there are fewer eigenvalues.
std::optional<Complex> ranked(const LinearModel& m, int rank, int always) {
  std::vector<Complex> list = eigenvalues_of(m);
  if (list.size() < static_cast<std::size_t>(rank + always)) return std::nullopt;
  std::stable_sort(list.begin(), list.end(),
                   [](const Complex& a, const Complex& b) { return modulus(a) < modulus(b); });
  list.erase(list.begin(), list.begin() + always);
  std::stable_sort(list.begin(), list.end(), [](const Complex& a, const Complex& b) { return a.re > b.re; });
  return list[static_cast<std::size_t>(rank) - 1];
}

// True if the equations for two values of the parameter have the same unknowns and derivatives, so that formulas made
// for one of them hold for the other. Divisors of an elimination must be chosen anew for each value.
bool same_structure(const Scenario& a, const Scenario& b) {
  const auto routh = [](const Scenario& s) {
    return std::make_tuple(s.routh ? s.routh->variable_names : std::vector<std::string>(), s.routh_structure.c,
                           s.routh_structure.d);
  };
  return a.structure.c == b.structure.c && a.structure.d == b.structure.d && a.independent == b.independent &&
         a.system.variable_names == b.system.variable_names && a.elimination.dependent == b.elimination.dependent &&
         a.elimination.pivots().empty() && b.elimination.pivots().empty() && routh(a) == routh(b);
}

// Linear models at values of a parameter.
class Values {
 public:
  Values(ScenarioAt scenario_at, const StateChoice& choice, bool each_anew, const Signals& signals)
      : scenario_at_(std::move(scenario_at)), choice_(choice), each_anew_(each_anew), signals_(signals) {}

  // `check`: true if the steadiness of the motion is decided.
  LinearResult at(const Rational& value, bool check = true) {
    LinearResult r;
    Scenario scenario;
    try {
      r.outcome = scenario_at_(value, scenario);
    } catch (const Failure& f) {
      r.outcome = {OutcomeKind::inconsistent, f.diagnostic.message, f.diagnostic.hint};
    }
    if (r.outcome.ok()) r = of(scenario, check);
    r.value = to_string(value);
    return r;
  }

  LinearResult of(const Scenario& scenario, bool check = true) {
    LinearResult r;
    Column es;
    for (const Parameter& p : scenario.model->parameters) es.push_back(p.value);
    const std::vector<Multi> parameters = evaluate_parameters<Multi>(*scenario.model->graph, es);
    for (const Multi& p : parameters)
      if (!p.finite()) {
        r.outcome = {OutcomeKind::not_a_number, "a parameter has no value here", "choose another value"};
        return r;
      }
    if (!made_ || each_anew_ || !same_structure(made_->scenario, scenario))
      made_ = std::make_unique<Made>(scenario, choice_, signals_);
    r.outcome = made_->linearizer.at(parameters, scenario.state, check, r.model);
    return r;
  }

 private:
  struct Made {
    Made(const Scenario& of, const StateChoice& choice, Signals signals)
        : scenario(of), linearizer(scenario, choice, own(std::move(signals))) {}
    Signals own(Signals signals) const {
      for (Column* list : {&signals.u, &signals.y})
        for (Expr& e : *list) e = scenario.graph().own(e);
      return signals;
    }
    Workspace scenario;
    Linearizer linearizer;
  };

  const ScenarioAt scenario_at_;
  const StateChoice& choice_;
  const bool each_anew_;  // each value has equations of its own
  const Signals& signals_;
  std::unique_ptr<Made> made_;  // scenario and linearizer of the last value
};

// One end of an interval of the parameter.
struct End {
  Rational value;
  const LinearModel& model;
};

class Search {
 public:
  explicit Search(Values& values) : values_(values) {}

  // Finds the crossings between two values, a < b.
  void crossings(const End& a, const End& b, Linearization& out) {
    std::vector<Crossing> found;
    between(a, b, kMostHalvings, found, out.notes);
    std::stable_sort(found.begin(), found.end(),
                     [](const Crossing& x, const Crossing& y) { return x.value < y.value; });
    for (Crossing& c : found)
      c.steady = a.model.motion != LinearModel::Motion::unsteady && b.model.motion != LinearModel::Motion::unsteady;
    out.crossings.insert(out.crossings.end(), found.begin(), found.end());
  }

 private:
  enum class Root : std::uint8_t { found, lost, jump };

  void between(const End& a, const End& b, int halvings, std::vector<Crossing>& out, std::vector<std::string>& notes) {
    known_.clear();
    const int before = unstable(a.model), after = unstable(b.model);
    const int always = std::min(zeros(a.model), zeros(b.model));
    const std::string place = "between " + to_string(a.value) + " and " + to_string(b.value);
    std::vector<Crossing> found;
    std::vector<Multi> jumps;
    int change = 0;
    bool lost = false;
    const auto note = [&](const std::string& text) {
      lost = true;
      if (std::find(notes.begin(), notes.end(), text) == notes.end()) notes.push_back(text);
    };
    const bool same_states = eigenvalues_of(a.model).size() == eigenvalues_of(b.model).size();
    for (int m = std::min(before, after) + 1; m <= std::max(before, after) && same_states; ++m) {
      Crossing c;
      c.destabilizes = after > before;
      switch (root(a, b, m, always, c)) {
      case Root::lost:
        note(place + " an eigenvalue crosses the imaginary axis where the motion could not be followed");
        continue;
      case Root::jump:
        note("at " + number_text(to_double(c.value)) +
             " the eigenvalues jump: the motion on one side is not continued by that on the other, and no crossing is "
             "told there");
        jumps.push_back(c.value);
        continue;
      case Root::found:
        break;
      }
      if (c.frequency > Multi(0)) ++m, c.eigenvalues = 2;  // both eigenvalues of a pair cross at once
      change += c.destabilizes ? c.eigenvalues : -c.eigenvalues;
      found.push_back(c);
    }
    if (!lost && change != after - before && halvings > 0) {
      const Rational middle = (a.value + b.value) / 2;
      const LinearResult r = values_.at(middle);
      if (r.outcome.ok()) {
        between(a, {middle, r.model}, halvings - 1, out, notes);
        between({middle, r.model}, b, halvings - 1, out, notes);
        return;
      }
    }
    if (!lost && !same_states && before != after)
      note(place + " the number of states changes, and with it that of the unstable eigenvalues");
    else if (!lost && change != after - before)
      note(place + " the number of unstable eigenvalues changes from " + std::to_string(before) + " to " +
           std::to_string(after) + ", which the crossings that were found do not explain");
    // A branch of equilibria ends with an eigenvalue 0, which is no crossing.
    for (const Multi& jump : jumps)
      std::erase_if(found, [&](const Crossing& c) { return abs(Multi(c.value - jump)) < Multi(kBeside) * abs(jump); });
    out.insert(out.end(), found.begin(), found.end());
  }

  // Finds the zero of f(p), the m-th largest real part, between a and b by false position with halving of a retained
  // value (Illinois). If that makes no progress, bisection follows, and earlier each time; this happens at a jump, or
  // if f does not change its sign but leaves 0, as for undamped systems.
  Root root(const End& from, const End& to, int m, int always, Crossing& c) {
    const Multi first(from.value), second(to.value);
    Multi a = first, b = second;
    const std::optional<Complex> at_a = ranked(from.model, m, always), at_b = ranked(to.model, m, always);
    if (!at_a || !at_b) return Root::lost;
    Multi fa = at_a->re, fb = at_b->re;
    const bool leaves_zero = fa == Multi(0) || fb == Multi(0);
    const bool a_positive = fa > Multi(0);
    const Multi size = std::max(abs(fa), abs(fb));
    // The crossing eigenvalue, at the end where it is on the right.
    Complex e = a_positive ? *at_a : *at_b;
    Multi p = b;
    const Multi narrow = Multi(kNarrow) * (abs(a) + abs(b)), half = narrow / Multi(2);
    int patience = kMostSlow;
    for (int step = 0, stayed = 0, slow = 0; step < kMostSteps && b - a > narrow; ++step) {
      const Multi width = b - a;
      if (leaves_zero || slow >= patience)
        p = (a + b) / Multi(2), slow = 0, patience = std::max(0, patience - 1);
      else  // not so near to an end that the other end would never move
        p = std::min(Multi(b - half), std::max(Multi(a + half), Multi((a * fb - b * fa) / (fb - fa))));
      const LinearResult& r = unchecked_at(p);
      const auto found = r.outcome.ok() ? ranked(r.model, m, always) : std::nullopt;
      if (!found) return Root::lost;
      const Multi f = found->re;
      if (f > Multi(0) || !leaves_zero) e = *found;
      if (!leaves_zero && f == Multi(0)) break;
      if ((f > Multi(0)) == a_positive) {
        a = p, fa = f;
        if (stayed == 1) fb /= Multi(2);
        stayed = 1;
      } else {
        b = p, fb = f;
        if (stayed == -1) fa /= Multi(2);
        stayed = -1;
      }
      slow = Multi(2) * (b - a) > width ? slow + 1 : 0;
    }
    c.value = abs(p) < narrow ? Multi(0) : p;
    c.frequency = abs(e.im);
    const Multi before = std::max(first, Multi(p - Multi(2) * narrow)),
                after = std::min(second, Multi(p + Multi(2) * narrow));
    if (c.frequency > Multi(0) &&
        (real_beside(first, p, narrow, m, always) || real_beside(second, p, narrow, m, always)))
      c.frequency = Multi(0);
    return continuous(before, after, m, always, size, c.unstable_above);
  }

  // True if the eigenvalue is real where it has left the axis, on the side of `end`: if two eigenvalues meet at 0, they
  // may be a pair on one side alone.
  bool real_beside(const Multi& end, const Multi& p, const Multi& narrow, int m, int always) {
    Multi away = narrow;
    for (int k = 0; k < kMostSides; ++k, away *= Multi(1000)) {
      const Multi at = end < p ? std::max(end, Multi(p - away)) : std::min(end, Multi(p + away));
      const LinearResult& r = unchecked_at(at);
      const auto found = r.outcome.ok() ? ranked(r.model, m, always) : std::nullopt;
      if (found && !(found->re == Multi(0))) return found->im == Multi(0);
    }
    return false;
  }

  // Decides whether f is small on both sides of its zero, which are so near to each other that only a jump makes f
  // large, and the states are the same. `unstable_at_b`: the number of unstable eigenvalues at b.
  Root continuous(const Multi& a, const Multi& b, int m, int always, const Multi& size, int& unstable_at_b) {
    std::vector<Multi> before;
    std::vector<std::string> states;
    for (const Multi& p : {a, b}) {
      const LinearResult& r = unchecked_at(p);
      const auto found = r.outcome.ok() ? ranked(r.model, m, always) : std::nullopt;
      if (!found) return Root::lost;
      if (abs(found->re) > Multi(kJump) * size) return Root::jump;
      for (std::size_t i = 0; i < before.size() && states == r.model.states; ++i)
        if (abs(Multi(r.model.values[i] - before[i])) > Multi(kJump) * (Multi(1) + abs(before[i]))) return Root::jump;
      before = r.model.values, states = r.model.states;
      unstable_at_b = unstable(r.model);
    }
    return Root::found;
  }

  // Returns the linear model at a value between the given ones. Eigenvalues that jump together are searched at the same
  // values.
  const LinearResult& unchecked_at(const Multi& p) {
    const Rational exact = rational_of(p);
    const auto [place, is_new] = known_.try_emplace(to_string(exact));
    if (is_new) place->second = values_.at(exact, false);
    return place->second;
  }

  Values& values_;
  std::map<std::string, LinearResult> known_;  // results in the present interval
};

// Returns the indices of the values in increasing order.
std::vector<std::size_t> growing(const std::vector<Rational>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) { return values[i] < values[k]; });
  return order;
}

}  // namespace

std::string meaning(const Crossing& c) {
  if (!c.steady) return c.destabilizes ? "to the right above" : "to the left above";
  if (c.destabilizes) return "unstable above";
  const int others = c.unstable_above;
  if (others == 0) return "stable above";
  return "to the left above, where " + std::to_string(others) + (others == 1 ? " eigenvalue is" : " eigenvalues are") +
         " still unstable";
}

Linearization linearize(const ScenarioAt& scenario_at, const StateChoice& choice, const ParameterRange& range,
                        bool each_anew, const Signals& signals) {
  Values values(scenario_at, choice, each_anew, signals);
  Linearization out;
  for (const Rational& value : range.values) out.results.push_back(values.at(value));
  Search search(values);
  const std::vector<std::size_t> order = growing(range.values);
  for (std::size_t k = 0; k + 1 < order.size(); ++k) {
    const LinearResult &from = out.results[order[k]], &to = out.results[order[k + 1]];
    const Rational &a = range.values[order[k]], &b = range.values[order[k + 1]];
    if (!(a < b)) continue;
    ++out.intervals;
    if (!from.outcome.ok() || !to.outcome.ok()) continue;
    ++out.searched;
    search.crossings({a, from.model}, {b, to.model}, out);
  }
  const auto replaced = std::find_if(out.results.begin(), out.results.end(),
                                     [](const LinearResult& r) { return !r.model.replaced.empty(); });
  if (replaced != out.results.end()) out.notes.push_back("at " + replaced->value + ": " + replaced->model.replaced);
  if (!range.values.empty() && range.values.back() < range.values.front())
    std::reverse(out.crossings.begin(), out.crossings.end());
  return out;
}

Linearization linearize(const Scenario& s, const StateChoice& choice, const Signals& signals) {
  Linearization out;
  out.results.push_back(Values(nullptr, choice, false, signals).of(s));
  return out;
}

Linearization linearize(const Scenario& s, const StateChoice& choice, const ParameterRange& range,
                        const Signals& signals) {
  const ScenarioAt scenario_at = [&](const Rational& value, Scenario& scenario) {
    const std::shared_ptr<Model> model = given_model(s);
    model->parameters[range.parameter].value = model->graph->number(range.unit.in_si(value));
    return make_scenario(model, *s.system.form, choice, scenario);
  };
  return linearize(scenario_at, choice, range, true, signals);
}

}  // namespace anholon
