#include "kernel/plan.h"

#include <algorithm>
#include <map>

#include "base/assert.h"
#include "kernel/slots.h"

namespace anholon {

namespace {

constexpr std::uint32_t kNone = Slots::kNone;
// The limit of the tables of a kernel (arithmetic.h: kMostRising).
constexpr int kHighestOrder = 12;

class Planner {
 public:
  Planner(const Program& p, int stages, bool judged)
      : p_(p), tape_(p.tape), code_(tape_.code), slots_(p), stages_(stages), judged_(judged) {}

  Plan run() {
    if (judged_) find_values_only();
    lay_out();
    emit();
    linearize();
    finish();
    return std::move(plan_);
  }

 private:
  std::uint32_t take(std::uint32_t size) {
    const std::uint32_t at = plan_.arena;
    plan_.arena += size;
    return at;
  }

  std::uint32_t coefficient(const Coefficient& c) {
    std::string key = c.rational.get_str(62);
    for (std::uint32_t s : c.slots) key += "," + std::to_string(s);
    const auto [it, fresh] = coefficient_.try_emplace(key, static_cast<std::uint32_t>(plan_.coefficients.size()));
    if (fresh) plan_.coefficients.push_back(c);
    return it->second;
  }

  void lay_out() {
    plan_.stages = stages_;
    plan_.c = p_.c;
    plan_.d = p_.d;
    plan_.largest_lead = tape_.largest_lead;
    plan_.largest_d = *std::max_element(p_.d.begin(), p_.d.end());
    // An odd stride keeps series off the same cache sets.
    int beyond = std::max(plan_.largest_lead, plan_.largest_d);
    for (const ProgramInput& in : p_.inputs) beyond = std::max(beyond, in.order);
    plan_.stride = static_cast<std::uint32_t>(stages_ + beyond + 2) | 1U;
    // Coefficients come first in the arena: their number must be known before the steps are made, so make those of the
    // sums now.
    coefficient({Rational(1), {}});
    coefficient({Rational(-1), {}});
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      if (!slots_.live[s]) continue;
      if (code_[s].constant) coefficient({Rational(1), {s}});
      for (const Slots::Summand& t : slots_.sums[s]) coefficient(t.c);
    }
    // A vector of coefficients may begin before the first series.
    plan_.arena = std::max(static_cast<std::uint32_t>(plan_.coefficients.size()), std::uint32_t{kBlock});
    for (std::size_t j = 0; j < p_.unknowns(); ++j) plan_.x.push_back(take(plan_.stride));
    plan_.time = take(plan_.stride);
    zero_ = take(plan_.stride);
    place_.resize(code_.size());
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      const Instruction& in = code_[s];
      if (!slots_.live[s]) continue;
      if (in.constant) {
        place_[s] = {coefficient({Rational(1), {s}}), false};
      } else if (in.op == Op::input && slots_.inputs[s]->kind == ProgramInput::Kind::time) {
        place_[s] = {plan_.time, true};
      } else if (in.op == Op::input && slots_.inputs[s]->kind == ProgramInput::Kind::other) {
        place_[s] = {zero_, true};
      } else if (in.op == Op::input && slots_.inputs[s]->order == 0) {
        place_[s] = {plan_.x[slots_.inputs[s]->variable], true};
        coordinate_at_[place_[s].at] = s;
      } else if (slots_.series[s]) {
        place_[s] = {take(plan_.stride), true};
      }
    }
    for (std::uint32_t s = 0; s < code_.size(); ++s)
      if (slots_.live[s] && !code_[s].constant && !slots_.series[s]) place_[s] = {take(1), false};
  }

  Place at(std::uint32_t s) const { return place_[slots_.same_as(s)]; }

  std::vector<Step>& list(std::uint32_t s, bool beyond) {
    return !slots_.in_main(s) && !value_only(s) ? plan_.after : beyond ? plan_.stage : plan_.point;
  }
  bool value_only(std::uint32_t s) const { return judged_ && value_only_[s]; }

  // Finds the slots that only the last root needs; only their values are computed.
  void find_values_only() {
    value_only_.assign(code_.size(), true);
    std::fill(value_only_.begin(), value_only_.begin() + tape_.main_end, false);
    for (std::size_t i = p_.unknowns(); i + 1 < tape_.roots.size(); ++i)
      value_only_[slots_.same_as(tape_.roots[i])] = false;
    for (std::uint32_t s = static_cast<std::uint32_t>(code_.size()); s-- > 0;)
      if (!value_only_[s] && slots_.live[s] && !code_[s].constant) {
        for (const std::uint32_t o : slots_.operands(s)) value_only_[o] = false;
        for (const Slots::Summand& t : slots_.sums[s])
          if (t.slot != kNone) value_only_[t.slot] = false;
      }
    for (const auto& [sine, cosine] : slots_.cosine_of)
      if (!value_only_[sine] || !value_only_[cosine]) value_only_[sine] = value_only_[cosine] = false;
  }

  // The series j a_j.
  Place weighted(std::uint32_t a, bool after) {
    const auto [it, fresh] = weighted_.try_emplace({a, after}, Place{});
    if (!fresh) return it->second;
    it->second = {take(plan_.stride), true};
    Step w;
    w.act = Act::weigh;
    w.lead = after ? 0 : code_[a].lead;
    w.out = it->second;
    w.a = place_[a];
    if (after) {
      if (!value_only(a)) plan_.after.push_back(w);
    } else {
      plan_.point.push_back(w);
      if (!(slots_.tainted[a] && slots_.pure[a])) plan_.stage.push_back(w);
      if (slots_.tainted[a]) plan_.weigh_again.push_back(w);
    }
    return it->second;
  }

  // The part of a slot's value beyond its double, for a coordinate or a sum with coordinates.
  Place beyond_double(std::uint32_t s) {
    if (const auto it = beyond_.find(s); it != beyond_.end()) return it->second;
    Place& out = beyond_[s];
    if (const ProgramInput* const in = code_[s].op == Op::input ? slots_.inputs[s] : nullptr) {
      if (in->kind != ProgramInput::Kind::variable || in->order > 0 || p_.d[in->variable] == 0) return out;
      std::uint32_t index = 0;
      for (std::size_t j = 0; j < in->variable; ++j) index += static_cast<std::uint32_t>(p_.d[j]);
      out = {take(1), false};
      plan_.beyond_double.push_back({out.at, index});
    } else if (const auto sum = sums_.find(s); sum != sums_.end()) {
      Step step = sum->second;
      std::vector<PlanTerm> terms;
      bool any = false;
      for (std::uint32_t k = step.first; k < step.first + step.count; ++k) {
        terms.push_back({plan_.terms[k].coefficient, {}});
        if (const auto x = coordinate_at_.find(plan_.terms[k].x.at); x != coordinate_at_.end())
          terms.back().x = beyond_double(x->second);
        any = any || terms.back().x.at != 0;
      }
      if (!any) return out;
      step.act = Act::beyond;
      step.out = out = {take(1), false};
      step.index = static_cast<std::uint32_t>(plan_.terms.size());
      plan_.terms.insert(plan_.terms.end(), terms.begin(), terms.end());
      list(s, false).push_back(step);
    }
    return out;
  }

  void emit_sum(std::uint32_t s) {
    // Sorts terms that are known early to the front, so that the sum waits for the last one only.
    std::vector<Slots::Summand> terms = slots_.sums[s];
    std::stable_sort(terms.begin(), terms.end(), [&](const Slots::Summand& x, const Slots::Summand& y) {
      return x.slot != kNone && y.slot != kNone ? depth_[x.slot] < depth_[y.slot] : x.slot != kNone && y.slot == kNone;
    });
    for (const bool beyond : {false, true}) {
      if (beyond && (!slots_.in_main(s) || (slots_.tainted[s] && slots_.pure[s]))) break;
      Step step;
      step.lead = code_[s].lead;
      step.out = place_[s];
      step.first = static_cast<std::uint32_t>(plan_.terms.size());
      for (const Slots::Summand& t : terms) {
        if (t.slot == kNone) {
          if (beyond) continue;
          plan_.terms.push_back({coefficient(t.c), {}});
          ++step.constants;
        } else if (!(beyond && slots_.unknown(t.slot, step.lead) && slots_.pure[t.slot])) {
          plan_.terms.push_back({coefficient(t.c), place_[t.slot]});
          ++step.count;
        }
      }
      list(s, beyond).push_back(step);
      if (!beyond) sums_[s] = step;
    }
  }

  // The time at which a coefficient is known; coefficients of earlier stages come first.
  int arrival(std::uint32_t s, std::uint8_t lead) const {
    return code_[s].constant || code_[s].lead > lead ? -1 : depth_[s];
  }

  void emit() {
    depth_.assign(code_.size(), 0);
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      const Instruction& in = code_[s];
      if (!slots_.live[s] || in.constant) continue;
      for (std::uint32_t o : slots_.operands(s))
        if (o < s) depth_[s] = std::max(depth_[s], depth_[o] + 1);
      if (slots_.sum_like(s)) {
        emit_sum(s);
        continue;
      }
      Step step;
      step.lead = in.lead;
      step.out = place_[s];
      const bool after = !slots_.in_main(s);
      switch (in.op) {
      case Op::constant:
      case Op::pi:
      case Op::parameter:
      case Op::linear:
      case Op::scale:
        continue;
      case Op::input:
        if (slots_.inputs[s]->kind != ProgramInput::Kind::variable || slots_.inputs[s]->order == 0) continue;
        step.act = Act::input;
        step.a = {plan_.x[slots_.inputs[s]->variable], true};
        step.index = static_cast<std::uint32_t>(slots_.inputs[s]->order);
        break;
      case Op::rate:
        step.act = Act::input;
        step.index = in.index;
        break;
      case Op::multiply:
        step.act = Act::multiply;
        break;
      case Op::square:
        step.act = Act::square;
        break;
      case Op::divide:
        step.act = Act::divide;
        step.c = {take(1), false};
        reciprocal_[s] = step.c.at;
        break;
      case Op::power:
        step.act = tape_.rationals[in.index] == Rational(1, 2) ? Act::square_root : Act::power;
        step.value = tape_.rationals[in.index].get_d();
        if (step.act == Act::power) {
          step.c = weighted(slots_.same_as(in.a), after);
          step.b = {take(1), false};
          step.d = {take(plan_.stride), true};
          step.e = {take(1), false};
          derivative_[s] = step.e.at;
          if (slots_.tainted[s]) again_ = true;
        }
        break;
      case Op::function:
        if (slots_.sine_of.count(s) || slots_.cosine_of.count(s)) {
          const std::uint32_t sine = slots_.sine_of.count(s) ? slots_.sine_of.at(s) : s,
                              cosine = slots_.cosine_of.at(sine);
          if (std::max(sine, cosine) == s) continue;  // made together with the first of the two
          ANHOLON_ASSERT(code_[cosine].lead == code_[sine].lead && slots_.in_main(sine) == slots_.in_main(cosine));
          step.act = Act::sine_cosine;
          step.b = weighted(slots_.same_as(in.a), after);
          step.out = place_[sine];
          step.c = place_[cosine];
          step.d = beyond_double(slots_.same_as(in.a));
        } else {
          step.act = Act::function;
          step.c = weighted(slots_.same_as(in.a), after);
        }
        step.index = in.index;
        break;
      case Op::arctan2:
        step.act = Act::arctan2;
        step.c = at(in.first);
        step.d = at(in.count);
        if (!code_[in.a].constant) step.e = weighted(slots_.same_as(in.a), after);
        if (!code_[in.b].constant) step.f = weighted(slots_.same_as(in.b), after);
        break;
      case Op::select:
        step.act = Act::select;
        step.c = at(in.first);
        break;
      case Op::lookup:
        step.act = Act::lookup;
        step.index = in.index;
        break;
      }
      if (in.op != Op::input) {
        const std::uint32_t a = slots_.same_as(in.a);
        step.a = place_[a];
        step.a_constant = code_[a].constant;
        if (in.op == Op::multiply || in.op == Op::divide || in.op == Op::arctan2 || in.op == Op::select ||
            step.act == Act::function) {
          const std::uint32_t b = slots_.same_as(in.b);
          step.b = place_[b];
          step.b_constant = code_[b].constant;
          step.b_later = arrival(b, in.lead) > arrival(a, in.lead);
        }
      }
      if (again_) {
        Step w;
        w.act = Act::weigh;
        w.lead = in.lead;
        w.out = step.d;
        w.a = step.out;
        plan_.weigh_again.push_back(w);
        again_ = false;
      }
      list(s, false).push_back(step);
      if (after) continue;
      if (in.op == Op::input && slots_.inputs[s]->leading) continue;
      if (in.op == Op::rate && slots_.pure[s]) continue;
      const std::uint32_t a = slots_.same_as(in.a);
      step.a_unknown = in.op != Op::input && slots_.unknown(a, in.lead) && slots_.pure[a];
      if (in.op == Op::multiply || in.op == Op::divide || in.op == Op::arctan2) {
        const std::uint32_t b = slots_.same_as(in.b);
        step.b_unknown = slots_.unknown(b, in.lead) && slots_.pure[b];
      }
      plan_.stage.push_back(step);
    }
  }

  std::uint32_t column(std::uint32_t s) const {
    if (code_[s].op == Op::rate) return column(slots_.same_as(code_[s].a));
    return code_[s].op == Op::input ? static_cast<std::uint32_t>(slots_.inputs[s]->variable) : column_[s];
  }

  std::uint32_t partial(Partial::Kind kind, std::uint32_t a, std::uint32_t b) {
    const std::uint32_t out = take(1);
    plan_.partials.push_back({kind, out, a, b});
    return out;
  }

  // Rows and columns beyond the unknowns: one for every slot that depends on them. The rows of the equations: root =
  // right side.
  void linearize() {
    const std::uint32_t n = static_cast<std::uint32_t>(p_.unknowns()), unit = coefficient({Rational(1), {}});
    column_.assign(code_.size(), kNone);
    plan_.rows = n;
    for (std::uint32_t s = 0; s < tape_.main_end; ++s)
      if (slots_.live[s] && slots_.tainted[s] && code_[s].op != Op::input && code_[s].op != Op::rate)
        column_[s] = plan_.rows++;
    const auto enter = [&](std::uint32_t s, std::uint32_t o, std::uint32_t from, double sign) {
      plan_.entries.push_back({column_[s], column(o), from, sign});
    };
    for (std::uint32_t s = 0; s < tape_.main_end; ++s) {
      if (column_[s] == kNone) continue;
      const Instruction& in = code_[s];
      plan_.entries.push_back({column_[s], column_[s], unit, 1});
      if (slots_.sum_like(s)) {
        for (const Slots::Summand& t : slots_.sums[s])
          if (t.slot != kNone && slots_.unknown(t.slot, in.lead)) enter(s, t.slot, coefficient(t.c), -1);
        continue;
      }
      const std::uint32_t a = slots_.same_as(in.a), w = place_[s].at;
      const std::uint32_t b =
          in.op == Op::multiply || in.op == Op::divide || in.op == Op::arctan2 || in.op == Op::select
              ? slots_.same_as(in.b)
              : a;
      const bool by_a = slots_.unknown(a, in.lead), by_b = slots_.unknown(b, in.lead);
      switch (in.op) {
      case Op::multiply:
        if (by_a) enter(s, a, place_[b].at, -1);
        if (by_b) enter(s, b, place_[a].at, -1);
        break;
      case Op::square:
        enter(s, a, partial(Partial::Kind::twice, place_[a].at, 0), -1);
        break;
      case Op::divide: {
        const std::uint32_t reciprocal = reciprocal_.at(s);
        if (by_a) enter(s, a, reciprocal, -1);
        if (by_b) enter(s, b, partial(Partial::Kind::quotient, w, reciprocal), 1);
        break;
      }
      case Op::power:
        if (tape_.rationals[in.index] == Rational(1, 2))
          enter(s, a, partial(Partial::Kind::half_reciprocal, w, 0), -1);
        else
          enter(s, a, derivative_.at(s), -1);
        break;
      case Op::function:
        if (const auto cosine = slots_.cosine_of.find(s); cosine != slots_.cosine_of.end())
          enter(s, a, place_[cosine->second].at, -1);
        else if (const auto sine = slots_.sine_of.find(s); sine != slots_.sine_of.end())
          enter(s, a, place_[sine->second].at, 1);
        else
          enter(s, a, at(in.b).at, -1);
        break;
      case Op::arctan2:
        if (by_a) enter(s, a, at(in.first).at, -1);
        if (by_b) enter(s, b, at(in.count).at, -1);
        break;
      case Op::select:
        if (by_a) enter(s, a, partial(Partial::Kind::chosen, at(in.first).at, 0), -1);
        if (by_b) enter(s, b, partial(Partial::Kind::not_chosen, at(in.first).at, 0), -1);
        break;
      default:
        ANHOLON_ASSERT(!"no slot that depends on unknowns");
      }
    }
    for (std::size_t i = 0; i < p_.unknowns(); ++i) {
      const std::uint32_t alias = tape_.roots[i], r = slots_.same_as(alias);
      plan_.roots.push_back(place_[r]);
      plan_.root_is_zero.push_back(code_[r].constant || (slots_.unknown(r, code_[alias].lead) && slots_.pure[r]));
      if (!code_[r].constant && slots_.unknown(r, code_[alias].lead))
        plan_.entries.push_back({static_cast<std::uint32_t>(i), column(r), unit, 1});
    }
    std::vector<int> depth;
    for (std::uint32_t i = 0; i < p_.unknowns(); ++i) {
      plan_.sides.push_back(i);
      depth.push_back(depth_[slots_.same_as(tape_.roots[i])]);
    }
    std::stable_sort(plan_.sides.begin(), plan_.sides.end(),
                     [&](std::uint32_t i, std::uint32_t j) { return depth[i] < depth[j]; });
    for (std::size_t i = p_.unknowns(); i < tape_.roots.size(); ++i)
      plan_.quadratures.push_back(place_[slots_.same_as(tape_.roots[i])]);
    plan_.apart = p_.unknowns();
    if (judged_) {
      plan_.determinant = plan_.quadratures.back();
      plan_.quadratures.pop_back();
    }
  }

  void finish() {
    for (std::uint32_t s = 0; s < code_.size(); ++s)
      if (slots_.live[s] && !code_[s].constant && code_[s].op == Op::power &&
          tape_.rationals[code_[s].index].get_den() % 2 == 0)
        plan_.roots_of_even_powers.push_back({code_[s].a, at(code_[s].a)});
    for (std::uint32_t s = 0; s < tape_.main_end; ++s)
      if (const auto function = slots_.live[s] && !code_[s].constant ? may_hide(tape_, code_[s]) : std::nullopt)
        plan_.hiding.push_back({*function, at(hidden_argument(code_[s])), at(s)});
    for (std::uint32_t s = 0; s < tape_.main_end; ++s) {
      if (!slots_.live[s] || !slots_.tainted[s] || !slots_.series[s]) continue;
      if (code_[s].op == Op::input) {
        if (slots_.inputs[s]->order > 0) plan_.completions.push_back({place_[s], code_[s].lead, column(s), true});
      } else {
        plan_.completions.push_back({place_[s], code_[s].lead, column(s), slots_.pure[s]});
      }
    }
  }

  const Program& p_;
  const Tape& tape_;
  const std::vector<Instruction>& code_;
  const Slots slots_;
  int stages_;
  bool judged_;
  std::vector<bool> value_only_;
  Plan plan_;
  std::vector<int> depth_;
  std::vector<Place> place_;
  std::vector<std::uint32_t> column_;
  std::map<std::string, std::uint32_t> coefficient_;
  std::map<std::uint32_t, std::uint32_t> reciprocal_, derivative_;  // of divisors, of powers
  std::map<std::pair<std::uint32_t, bool>, Place> weighted_;
  std::map<std::uint32_t, Place> beyond_;                 // the parts of slots beyond their doubles, if known
  std::map<std::uint32_t, Step> sums_;                    // of slots
  std::map<std::uint32_t, std::uint32_t> coordinate_at_;  // slots of coordinates by their places
  std::uint32_t zero_ = 0;
  bool again_ = false;  // the weighted series of a power depends on the unknowns of the stage
};

}  // namespace

std::string no_plan(const Program& p) {
  if (p.nonlinear) return "the leading derivatives enter nonlinearly";
  int highest = p.tape.largest_lead;
  for (int d : p.d) highest = std::max(highest, d);
  for (const ProgramInput& in : p.inputs) highest = std::max(highest, in.order);
  if (highest > kHighestOrder) return "derivatives of order " + std::to_string(highest) + " occur";
  return {};
}

Plan plan(const Program& program, int stages, bool judged) {
  ANHOLON_ASSERT(no_plan(program).empty());
  return Planner(program, stages, judged).run();
}

std::vector<double> coefficient_values(const Plan& plan, const Program& program,
                                       const std::vector<long double>& parameters) {
  const Machine<long double> machine(program.tape, 0, parameters);
  std::vector<double> values;
  for (const Coefficient& c : plan.coefficients) {
    long double v = from_rational<long double>(c.rational);
    for (std::uint32_t s : c.slots) {
      const long double x = machine.series(s & ~Slots::kReciprocal)[0];
      v = s & Slots::kReciprocal ? v / x : v * x;
    }
    values.push_back(static_cast<double>(v));
  }
  return values;
}

double Plan::work() const {
  const double orders = stages + 1, convolution = orders * orders / 2;
  double w = 0;
  for (const std::vector<Step>* list : {&stage, &after})
    for (const Step& s : *list) switch (s.act) {
      case Act::linear:
        w += orders * s.count;
        break;
      case Act::multiply:
      case Act::divide:
      case Act::function:
        w += convolution;
        break;
      case Act::square:
      case Act::square_root:
        w += convolution / 2;
        break;
      case Act::power:
      case Act::sine_cosine:
      case Act::arctan2:
        w += 2 * convolution;
        break;
      case Act::input:
      case Act::weigh:
      case Act::select:
      case Act::lookup:
        w += orders;
        break;
      case Act::beyond:
        break;  // once only
      }
  return w;
}

}  // namespace anholon
