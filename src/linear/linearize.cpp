#include "linear/linearize.h"

#include <algorithm>

#include "linear/linearizer.h"

namespace anholon {

namespace {

constexpr int kMostSteps = 200;
constexpr int kExactDigits = 40;  // digits of a parameter value between the given ones

Rational rational_of(const Multi& x) { return *parse_rational(number_text(x, kExactDigits)); }

int unstable(const LinearModel& m) {
  return static_cast<int>(
      std::count_if(m.spectrum.begin(), m.spectrum.end(), [](const Eigenvalue& e) { return e.value.re > Multi(0); }));
}

int zeros(const LinearModel& m) {
  return static_cast<int>(std::count_if(m.spectrum.begin(), m.spectrum.end(), [](const Eigenvalue& e) {
    return e.value.re == Multi(0) && e.value.im == Multi(0);
  }));
}

// The m-th largest real part (m = 1, 2, …), without the `always` eigenvalues nearest to 0, which are 0 over the whole
// range.
const Eigenvalue& ranked(const LinearModel& m, int rank, int always) {
  std::vector<const Eigenvalue*> list;
  for (const Eigenvalue& e : m.spectrum) list.push_back(&e);
  std::stable_sort(list.begin(), list.end(),
                   [](const Eigenvalue* a, const Eigenvalue* b) { return modulus(a->value) < modulus(b->value); });
  list.erase(list.begin(), list.begin() + always);
  std::stable_sort(list.begin(), list.end(),
                   [](const Eigenvalue* a, const Eigenvalue* b) { return a->value.re > b->value.re; });
  return *list[static_cast<std::size_t>(rank) - 1];
}

class Search {
 public:
  Search(Workspace& s, const StateChoice& choice, const std::optional<ParameterRange>& range, const Signals& signals)
      : s_(s), range_(range), linearizer_(s, choice, signals) {}

  LinearResult at(const Rational* value, bool check = true) const {
    LinearResult r;
    Column es;
    for (const Parameter& p : s_.model->parameters) es.push_back(p.value);
    if (value) {
      es[range_->parameter] = s_.model->graph->number(*value);
      r.value = to_string(*value);
    }
    const std::vector<Multi> parameters = evaluate_parameters<Multi>(*s_.model->graph, es);
    for (const Multi& p : parameters)
      if (!p.finite()) {
        r.outcome = {OutcomeKind::not_a_number, "a parameter has no value here", "choose another value"};
        return r;
      }
    r.outcome = linearizer_.at(parameters, check, r.model);
    return r;
  }

  void crossings(const LinearResult& from, const LinearResult& to, const Rational& a, const Rational& b,
                 Linearization& out) const {
    const int before = unstable(from.model), after = unstable(to.model);
    const int always = std::min(zeros(from.model), zeros(to.model));
    const auto kept = std::min(from.model.spectrum.size(), to.model.spectrum.size()) - static_cast<std::size_t>(always);
    const std::size_t first = out.crossings.size();
    for (int m = std::min(before, after) + 1; m <= std::max(before, after); ++m) {
      if (static_cast<std::size_t>(m) > kept) break;
      Crossing c;
      c.destabilizes = (after > before) == (a < b);
      if (!root(from.model, to.model, Multi(a), Multi(b), m, always, c)) {
        out.notes.push_back("between " + to_string(a) + " and " + to_string(b) +
                            " an eigenvalue crosses the imaginary axis where the motion could not be followed");
        continue;
      }
      if (c.frequency > Multi(0)) ++m, c.eigenvalues = 2;  // both eigenvalues of a pair cross at once
      out.crossings.push_back(c);
    }
    std::stable_sort(
        out.crossings.begin() + static_cast<std::ptrdiff_t>(first), out.crossings.end(),
        [&](const Crossing& x, const Crossing& y) { return a < b ? x.value < y.value : y.value < x.value; });
  }

 private:
  // The zero of f(p), the m-th largest real part, between a and b, by false position with halving of a retained value
  // (Illinois); by bisection if f does not change its sign but leaves 0, as for undamped systems.
  bool root(const LinearModel& from, const LinearModel& to, Multi a, Multi b, int m, int always, Crossing& c) const {
    Multi fa = ranked(from, m, always).value.re, fb = ranked(to, m, always).value.re;
    const bool leaves_zero = fa == Multi(0) || fb == Multi(0);
    const bool a_positive = fa > Multi(0);
    // the crossing eigenvalue, at the end where it is on the right
    Eigenvalue e = ranked(a_positive ? from : to, m, always);
    Multi p = b, last = a;
    const Multi narrow = Multi(1e-20) * (Multi(1) + abs(a) + abs(b));
    for (int step = 0, stayed = 0; step < kMostSteps; ++step) {
      p = leaves_zero ? (a + b) / Multi(2) : (a * fb - b * fa) / (fb - fa);
      const Rational exact = rational_of(p);
      const LinearResult r = at(&exact, false);
      if (!r.outcome.ok() || r.model.spectrum.size() < static_cast<std::size_t>(m + always)) return false;
      const Eigenvalue& found = ranked(r.model, m, always);
      const Multi f = found.value.re;
      if (f > Multi(0) || !leaves_zero) e = found;
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
      if (abs(Multi(b - a)) < narrow || abs(Multi(p - last)) < narrow) break;
      last = p;
    }
    c.value = abs(p) < narrow ? Multi(0) : p;
    c.frequency = abs(e.value.im);
    return true;
  }

  const Scenario& s_;
  const std::optional<ParameterRange>& range_;
  Linearizer linearizer_;
};

}  // namespace

Linearization linearize(const Scenario& s, const StateChoice& choice, const std::optional<ParameterRange>& range,
                        const Signals& signals) {
  Workspace own(s);
  Signals own_signals = signals;
  for (Column* list : {&own_signals.u, &own_signals.y})
    for (Expr& e : *list) e = own.graph().own(e);
  const Search search(own, choice, range, own_signals);
  Linearization out;
  if (!range) {
    out.results.push_back(search.at(nullptr));
    return out;
  }
  for (const Rational& value : range->values) out.results.push_back(search.at(&value));
  for (std::size_t k = 0; k + 1 < out.results.size(); ++k) {
    const LinearResult &from = out.results[k], &to = out.results[k + 1];
    if (from.outcome.ok() && to.outcome.ok()) search.crossings(from, to, range->values[k], range->values[k + 1], out);
  }
  return out;
}

}  // namespace anholon
