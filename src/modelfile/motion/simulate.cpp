#include "modelfile/motion/simulate.h"

#include <algorithm>

#include "modelfile/text/keys.h"

namespace anholon {

// A later end time, or a larger number of rows, is refused at once.
static const Rational kLatest(mpz_class("1000000000000000000"));
static constexpr long kMostRows = 5'000'000;

static Rational rational(const Item& i, Scope& scope) {
  const Expr e = scope.number(i);
  if (!is_number(e)) throw Failure(i.span, "'" + i.key + "' is a plain number");
  return number_value(e);
}

void read_simulate(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* s = find_section(root, "simulate", diagnostics);
  if (!s) return;
  check_keys(*s, "[simulate]", "simulate", diagnostics);
  SimulationSettings& out = model.simulate;
  const Rational start = is_number(model.initial.t) ? number_value(model.initial.t) : Rational(0);
  if (const Item* i = s->find("to")) {
    out.to = rational(*i, scope);
    if (abs(*out.to) > kLatest) throw Failure(i->span, "an end time beyond 1e18");
  }
  if (const Item* i = s->find("tolerance")) {
    out.tolerance = rational(*i, scope);
    if (*out.tolerance <= 0 || *out.tolerance >= 1) throw Failure(i->span, "the tolerance lies between 0 and 1");
  }
  if (const Item* i = s->find("every")) {
    out.every = rational(*i, scope);
    if (*out.every <= 0) throw Failure(i->span, "'every' is a positive time");
    if (out.to && abs(Rational(*out.to - start)) > kMostRows * *out.every)
      throw Failure(i->span, "'every' asks for more than " + std::to_string(kMostRows) + " rows");
  }
  if (const Item* i = s->find("at")) {
    if (i->kind != Item::Kind::array) throw Failure(i->span, "'at' is a list of times");
    for (const Item& t : i->items) out.at.push_back(rational(t, scope));
    const auto side = [&](int sign) {
      return std::any_of(out.at.begin(), out.at.end(),
                         [&](const Rational& t) { return sgn(Rational(t - start)) == sign; });
    };
    if (side(-1) && side(1))
      throw Failure(i->span, "some of these times lie before the start, others after it", "one run goes one way");
  }
  if (const Item* i = s->find("form")) {
    if (i->kind != Item::Kind::string) throw Failure(i->span, "a form is a name in quotes", "form = \"routh\"");
    out.form = i->text();
    out.form_span = i->formula.whole();
  }
  if (const Item* i = s->find("integrator")) {
    if (i->kind != Item::Kind::string)
      throw Failure(i->span, "an integrator is a name in quotes", "integrator = \"taylor\"");
    out.integrator = find_integrator(i->text());
    if (!out.integrator) {
      const std::string near = did_you_mean(i->text(), integrator_names());
      throw Failure(i->span,
                    "there is no integrator '" + i->text() + "'" +
                        (near.empty() ? "" : "; did you mean '" + near + "'?"),
                    "integrator = \"taylor\", \"cvode\" or \"ida\"");
    }
  }
}

}  // namespace anholon
