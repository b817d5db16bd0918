#include "kernel/plan.h"

#include <algorithm>
#include <map>

#include "base/assert.h"

namespace anholon {

namespace {

constexpr std::uint32_t kNone = 0xffffffffU;
// A sum takes in the sums it is made of up to so many terms.
constexpr std::size_t kLongestSum = 48;
// The tables of a kernel reach so far (arithmetic.h: kMostRising).
constexpr int kHighestOrder = 12;
// In the slots of a coefficient: a divisor.
constexpr std::uint32_t kReciprocal = 0x80000000U;

bool is(const Instruction& in, Function f) { return in.op == Op::function && in.index == static_cast<std::uint32_t>(f); }

class Planner {
 public:
  Planner(const Program& p, int stages) : p_(p), tape_(p.tape), code_(tape_.code), stages_(stages) {}

  Plan run() {
    const std::size_t n = code_.size();
    inputs_.assign(n, nullptr);
    for (const ProgramInput& in : p_.inputs) inputs_[in.slot] = &in;
    pair_functions();
    mark_live();
    gather_sums();
    share_sums();
    mark_series();
    inline_sums();
    taint();
    lay_out();
    emit();
    linearize();
    finish();
    return std::move(plan_);
  }

 private:
  struct Summand {
    Coefficient c;
    std::uint32_t slot;  // kNone: constant in time
  };

  bool sum_like(std::uint32_t s) const { return code_[s].op == Op::linear || code_[s].op == Op::scale || (code_[s].op == Op::divide && code_[code_[s].b].constant); }
  bool in_main(std::uint32_t s) const { return s < tape_.main_end; }

  // The slot whose value this one repeats.
  std::uint32_t same_as(std::uint32_t s) const {
    while (code_[s].op == Op::linear && code_[s].count == 1 && tape_.rationals[tape_.linear_terms[code_[s].first].coefficient] == 1)
      s = tape_.linear_terms[code_[s].first].slot;
    return s;
  }

  void pair_functions() {
    std::map<std::uint32_t, std::uint32_t> sine, cosine;
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      if (is(code_[s], Function::sin)) sine[code_[s].a] = s;
      if (is(code_[s], Function::cos)) cosine[code_[s].a] = s;
    }
    for (const auto& [a, s] : sine)
      if (const auto it = cosine.find(a); it != cosine.end()) cosine_of_[s] = it->second, sine_of_[it->second] = s;
  }

  // The operands of a slot that is no sum, with repeats seen through.
  std::vector<std::uint32_t> operands(std::uint32_t s) const {
    const Instruction& in = code_[s];
    std::vector<std::uint32_t> r;
    switch (in.op) {
      case Op::constant: case Op::pi: case Op::input: case Op::parameter: break;
      case Op::linear:
        for (std::uint32_t k = in.first; k < in.first + in.count; ++k) r.push_back(tape_.linear_terms[k].slot);
        break;
      case Op::multiply: case Op::scale: case Op::divide: r = {in.a, in.b}; break;
      case Op::square: case Op::power: case Op::lookup: case Op::rate: r = {in.a}; break;
      case Op::function:
        r = {in.a};
        if (!cosine_of_.count(s) && !sine_of_.count(s)) r.push_back(in.b);
        break;
      case Op::arctan2: r = {in.a, in.b, in.first, in.count}; break;
      case Op::select: r = {in.a, in.b, in.first}; break;
    }
    for (std::uint32_t& x : r) x = same_as(x);
    return r;
  }

  void mark_live() {
    live_.assign(code_.size(), false);
    std::vector<std::uint32_t> todo;
    const auto add = [&](std::uint32_t s) {
      if (!live_[s]) live_[s] = true, todo.push_back(s);
    };
    for (std::uint32_t r : tape_.roots) add(same_as(r));
    while (!todo.empty()) {
      const std::uint32_t s = todo.back();
      todo.pop_back();
      if (code_[s].constant) continue;
      for (std::uint32_t o : operands(s)) add(o);
      if (const auto it = cosine_of_.find(s); it != cosine_of_.end()) add(it->second);
      if (const auto it = sine_of_.find(s); it != sine_of_.end()) add(it->second);
    }
  }

  static Coefficient product(const Coefficient& a, const Coefficient& b) {
    Coefficient c{a.rational * b.rational, a.slots};
    c.slots.insert(c.slots.end(), b.slots.begin(), b.slots.end());
    std::sort(c.slots.begin(), c.slots.end());
    return c;
  }

  void gather_sums() {
    sums_.resize(code_.size());
    uses_.assign(code_.size(), 0);
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      const Instruction& in = code_[s];
      if (!live_[s] || in.constant) continue;
      for (std::uint32_t o : operands(s)) ++uses_[o];
      if (!sum_like(s)) continue;
      const auto add = [&](Coefficient c, std::uint32_t slot) {
        slot = same_as(slot);
        if (code_[slot].constant) sums_[s].push_back({product(c, {Rational(1), {slot}}), kNone});
        else sums_[s].push_back({std::move(c), slot});
      };
      if (in.op == Op::scale) {
        add({Rational(1), {in.a}}, in.b);
      } else if (in.op == Op::divide) {
        add({Rational(1), {in.b | kReciprocal}}, in.a);
      } else {
        for (std::uint32_t k = in.first; k < in.first + in.count; ++k) add({tape_.rationals[tape_.linear_terms[k].coefficient], {}}, tape_.linear_terms[k].slot);
      }
    }
    for (std::uint32_t r : tape_.roots) ++uses_[same_as(r)];
  }

  static bool same_up_to_sign(const Coefficient& a, const Coefficient& b, int sign) { return a.slots == b.slots && a.rational == sign * b.rational; }

  // Where all terms of `part` are in `whole`, with the same sign or the opposite one: which. Else 0. Terms are ordered by their slots.
  static int contained(const std::vector<Summand>& part, const std::vector<Summand>& whole) {
    int sign = 0;
    std::size_t at = 0;
    for (const Summand& t : part) {
      while (at < whole.size() && whole[at].slot < t.slot) ++at;
      if (at == whole.size() || whole[at].slot != t.slot) return 0;
      if (sign == 0) sign = same_up_to_sign(whole[at].c, t.c, 1) ? 1 : -1;
      if (!same_up_to_sign(whole[at].c, t.c, sign)) return 0;
    }
    return sign;
  }

  // A sum takes over what an earlier one has added already, the longest first: along a chain of links every sum is the last one and a term.
  void share_sums() {
    std::map<std::uint32_t, std::vector<std::uint32_t>> sums_with;  // by their first term
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      std::vector<Summand>& terms = sums_[s];
      const auto unfit = [](const Summand& t) { return t.slot == kNone; };
      if (terms.size() < 2 || std::any_of(terms.begin(), terms.end(), unfit)) continue;
      std::sort(terms.begin(), terms.end(), [](const Summand& a, const Summand& b) { return a.slot < b.slot; });
      const auto twice = [](const Summand& a, const Summand& b) { return a.slot == b.slot; };
      if (std::adjacent_find(terms.begin(), terms.end(), twice) != terms.end()) continue;
      for (bool again = true; again;) {
        again = false;
        std::uint32_t longest = kNone;
        for (const Summand& t : terms)
          if (const auto with = sums_with.find(t.slot); with != sums_with.end())
            for (const std::uint32_t r : with->second)
              if (code_[r].lead == code_[s].lead && in_main(r) == in_main(s) && sums_[r].size() < terms.size() && (longest == kNone || sums_[r].size() > sums_[longest].size()) &&
                  contained(sums_[r], terms) != 0)
                longest = r;
        if (longest == kNone) break;
        const Rational sign(contained(sums_[longest], terms));
        for (const Summand& t : sums_[longest]) {
          --uses_[t.slot];
          terms.erase(std::find_if(terms.begin(), terms.end(), [&](const Summand& u) { return u.slot == t.slot; }));
        }
        const Summand taken{{sign, {}}, longest};
        ++uses_[longest];
        terms.insert(std::upper_bound(terms.begin(), terms.end(), taken, [](const Summand& a, const Summand& b) { return a.slot < b.slot; }), taken);
        again = true;
      }
      if (terms.size() > 1) sums_with[terms.front().slot].push_back(s);
    }
  }

  void mark_series() {
    series_.assign(code_.size(), false);
    const auto keep = [&](std::uint32_t s) {
      if (!code_[s].constant) series_[s] = true;
    };
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      const Instruction& in = code_[s];
      if (!live_[s] || in.constant) continue;
      for (std::uint32_t o : operands(s))
        if (code_[o].lead > in.lead || (in_main(o) && !in_main(s))) keep(o);
      if (sum_like(s)) continue;
      if (in.op != Op::input)
        for (std::uint32_t o : operands(s)) keep(o);
      if (in.op == Op::divide || in.op == Op::power || in.op == Op::function) keep(s);
      if (in.op == Op::input && inputs_[s]->kind != ProgramInput::Kind::variable) keep(s);
      if (in.op == Op::input && inputs_[s]->kind == ProgramInput::Kind::variable && inputs_[s]->order == 0) keep(s);
    }
    for (std::size_t i = 0; i < tape_.roots.size(); ++i) {
      const std::uint32_t r = same_as(tape_.roots[i]);
      if (i >= p_.unknowns() || p_.c[i] > 0 || code_[r].lead > code_[tape_.roots[i]].lead) keep(r);
    }
  }

  void inline_sums() {
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      if (!live_[s] || code_[s].constant || !sum_like(s)) continue;
      std::vector<Summand> all;
      for (Summand& t : sums_[s]) {
        const bool inlined = t.slot != kNone && sum_like(t.slot) && uses_[t.slot] == 1 && !series_[t.slot] && code_[t.slot].lead == code_[s].lead &&
                             in_main(t.slot) == in_main(s) && sums_[t.slot].size() + sums_[s].size() + all.size() <= kLongestSum;
        if (!inlined) {
          all.push_back(t);
          continue;
        }
        for (const Summand& u : sums_[t.slot]) all.push_back({product(t.c, u.c), u.slot});
        live_[t.slot] = false;
      }
      sums_[s] = std::move(all);
    }
  }

  // Whose newest coefficient depends on the unknowns of the stage; purely: is zero without them.
  void taint() {
    tainted_.assign(code_.size(), false);
    pure_.assign(code_.size(), false);
    for (std::uint32_t s = 0; s < tape_.main_end; ++s) {
      const Instruction& in = code_[s];
      if (!live_[s] || in.constant || in.op == Op::lookup) continue;
      if (in.op == Op::input) {
        tainted_[s] = pure_[s] = inputs_[s]->leading;
        continue;
      }
      if (in.op == Op::rate) {
        const std::uint32_t a = same_as(in.a);
        tainted_[s] = unknown(a, static_cast<std::uint8_t>(in.lead + in.index));
        pure_[s] = tainted_[s] && pure_[a];
        continue;
      }
      if (sum_like(s)) {
        bool all = true;
        for (const Summand& t : sums_[s]) {
          if (t.slot == kNone) continue;
          const bool here = unknown(t.slot, in.lead);
          tainted_[s] = tainted_[s] || here;
          all = all && here && pure_[t.slot];
        }
        pure_[s] = tainted_[s] && all;
        continue;
      }
      std::vector<std::uint32_t> by = operands(s);
      if (in.op == Op::function || in.op == Op::power) by.resize(1);
      if (in.op == Op::arctan2 || in.op == Op::select) by.resize(2);
      for (std::uint32_t o : by) tainted_[s] = tainted_[s] || unknown(o, in.lead);
    }
  }
  bool unknown(std::uint32_t s, std::uint8_t lead) const { return tainted_[s] && code_[s].lead == lead; }

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
    // Coefficients first: their number is known when all steps are made, so make the sums' now.
    coefficient({Rational(1), {}});
    coefficient({Rational(-1), {}});
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      if (!live_[s]) continue;
      if (code_[s].constant) coefficient({Rational(1), {s}});
      for (const Summand& t : sums_[s]) coefficient(t.c);
    }
    plan_.arena = static_cast<std::uint32_t>(plan_.coefficients.size());
    for (std::size_t j = 0; j < p_.unknowns(); ++j) plan_.x.push_back(take(plan_.stride));
    plan_.time = take(plan_.stride);
    zero_ = take(plan_.stride);
    place_.resize(code_.size());
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      const Instruction& in = code_[s];
      if (!live_[s]) continue;
      if (in.constant) {
        place_[s] = {coefficient({Rational(1), {s}}), false};
      } else if (in.op == Op::input && inputs_[s]->kind == ProgramInput::Kind::time) {
        place_[s] = {plan_.time, true};
      } else if (in.op == Op::input && inputs_[s]->kind == ProgramInput::Kind::other) {
        place_[s] = {zero_, true};
      } else if (in.op == Op::input && inputs_[s]->order == 0) {
        place_[s] = {plan_.x[inputs_[s]->variable], true};
      } else if (series_[s]) {
        place_[s] = {take(plan_.stride), true};
      }
    }
    for (std::uint32_t s = 0; s < code_.size(); ++s)
      if (live_[s] && !code_[s].constant && !series_[s]) place_[s] = {take(1), false};
  }

  Place at(std::uint32_t s) const { return place_[same_as(s)]; }

  std::vector<Step>& list(std::uint32_t s, bool beyond) { return !in_main(s) ? plan_.after : beyond ? plan_.stage : plan_.point; }

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
      plan_.after.push_back(w);
    } else {
      plan_.point.push_back(w);
      if (!(tainted_[a] && pure_[a])) plan_.stage.push_back(w);
      if (tainted_[a]) plan_.weigh_again.push_back(w);
    }
    return it->second;
  }

  void emit_sum(std::uint32_t s) {
    // Those known early first, so that the sum waits for the last only.
    std::vector<Summand> terms = sums_[s];
    std::stable_sort(terms.begin(), terms.end(), [&](const Summand& x, const Summand& y) {
      return x.slot != kNone && y.slot != kNone ? depth_[x.slot] < depth_[y.slot] : x.slot != kNone && y.slot == kNone;
    });
    for (const bool beyond : {false, true}) {
      if (beyond && (!in_main(s) || (tainted_[s] && pure_[s]))) break;
      Step step;
      step.lead = code_[s].lead;
      step.out = place_[s];
      step.first = static_cast<std::uint32_t>(plan_.terms.size());
      for (const Summand& t : terms) {
        if (t.slot == kNone) {
          if (beyond) continue;
          plan_.terms.push_back({coefficient(t.c), {}});
          ++step.constants;
        } else if (!(beyond && unknown(t.slot, step.lead) && pure_[t.slot])) {
          plan_.terms.push_back({coefficient(t.c), place_[t.slot]});
          ++step.count;
        }
      }
      list(s, beyond).push_back(step);
    }
  }

  // What a stage has computed before is there first.
  int arrival(std::uint32_t s, std::uint8_t lead) const { return code_[s].constant || code_[s].lead > lead ? -1 : depth_[s]; }

  void emit() {
    depth_.assign(code_.size(), 0);
    for (std::uint32_t s = 0; s < code_.size(); ++s) {
      const Instruction& in = code_[s];
      if (!live_[s] || in.constant) continue;
      for (std::uint32_t o : operands(s))
        if (o < s) depth_[s] = std::max(depth_[s], depth_[o] + 1);
      if (sum_like(s)) {
        emit_sum(s);
        continue;
      }
      Step step;
      step.lead = in.lead;
      step.out = place_[s];
      const bool after = !in_main(s);
      switch (in.op) {
        case Op::constant: case Op::pi: case Op::parameter: case Op::linear: case Op::scale: continue;
        case Op::input:
          if (inputs_[s]->kind != ProgramInput::Kind::variable || inputs_[s]->order == 0) continue;
          step.act = Act::input;
          step.a = {plan_.x[inputs_[s]->variable], true};
          step.index = static_cast<std::uint32_t>(inputs_[s]->order);
          break;
        case Op::rate:
          step.act = Act::input;
          step.index = in.index;
          break;
        case Op::multiply: step.act = Act::multiply; break;
        case Op::square: step.act = Act::square; break;
        case Op::divide:
          step.act = Act::divide;
          step.c = {take(1), false};
          reciprocal_[s] = step.c.at;
          break;
        case Op::power:
          step.act = tape_.rationals[in.index] == Rational(1, 2) ? Act::square_root : Act::power;
          step.value = tape_.rationals[in.index].get_d();
          if (step.act == Act::power) {
            step.c = weighted(same_as(in.a), after);
            step.b = {take(1), false};
            step.d = {take(plan_.stride), true};
            if (tainted_[s]) again_ = true;
          }
          break;
        case Op::function:
          if (sine_of_.count(s) || cosine_of_.count(s)) {
            const std::uint32_t sine = sine_of_.count(s) ? sine_of_.at(s) : s, cosine = cosine_of_.at(sine);
            if (std::max(sine, cosine) == s) continue;  // made with the first of the two
            ANHOLON_ASSERT(code_[cosine].lead == code_[sine].lead && in_main(sine) == in_main(cosine));
            step.act = Act::sine_cosine;
            step.b = weighted(same_as(in.a), after);
            step.out = place_[sine];
            step.c = place_[cosine];
          } else {
            step.act = Act::function;
            step.c = weighted(same_as(in.a), after);
          }
          step.index = in.index;
          break;
        case Op::arctan2:
          step.act = Act::arctan2;
          step.c = at(in.first);
          step.d = at(in.count);
          if (!code_[in.a].constant) step.e = weighted(same_as(in.a), after);
          if (!code_[in.b].constant) step.f = weighted(same_as(in.b), after);
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
        const std::uint32_t a = same_as(in.a);
        step.a = place_[a];
        step.a_constant = code_[a].constant;
        if (in.op == Op::multiply || in.op == Op::divide || in.op == Op::arctan2 || in.op == Op::select || step.act == Act::function) {
          const std::uint32_t b = same_as(in.b);
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
      if (in.op == Op::input && inputs_[s]->leading) continue;
      if (in.op == Op::rate && pure_[s]) continue;
      const std::uint32_t a = same_as(in.a);
      step.a_unknown = in.op != Op::input && unknown(a, in.lead) && pure_[a];
      if (in.op == Op::multiply || in.op == Op::divide || in.op == Op::arctan2) {
        const std::uint32_t b = same_as(in.b);
        step.b_unknown = unknown(b, in.lead) && pure_[b];
      }
      plan_.stage.push_back(step);
    }
  }

  std::uint32_t column(std::uint32_t s) const {
    if (code_[s].op == Op::rate) return column(same_as(code_[s].a));
    return code_[s].op == Op::input ? static_cast<std::uint32_t>(inputs_[s]->variable) : column_[s];
  }

  std::uint32_t partial(Partial::Kind kind, std::uint32_t a, std::uint32_t b, double value = 0) {
    const std::uint32_t out = take(1);
    plan_.partials.push_back({kind, out, a, b, value});
    return out;
  }

  // Rows and columns beyond the unknowns: one for every slot that depends on them. The rows of the equations: root = right side.
  void linearize() {
    const std::uint32_t n = static_cast<std::uint32_t>(p_.unknowns()), unit = coefficient({Rational(1), {}});
    column_.assign(code_.size(), kNone);
    plan_.rows = n;
    for (std::uint32_t s = 0; s < tape_.main_end; ++s)
      if (live_[s] && tainted_[s] && code_[s].op != Op::input && code_[s].op != Op::rate) column_[s] = plan_.rows++;
    const auto enter = [&](std::uint32_t s, std::uint32_t o, std::uint32_t from, double sign) {
      plan_.entries.push_back({column_[s], column(o), from, sign});
    };
    for (std::uint32_t s = 0; s < tape_.main_end; ++s) {
      if (column_[s] == kNone) continue;
      const Instruction& in = code_[s];
      plan_.entries.push_back({column_[s], column_[s], unit, 1});
      if (sum_like(s)) {
        for (const Summand& t : sums_[s])
          if (t.slot != kNone && unknown(t.slot, in.lead)) enter(s, t.slot, coefficient(t.c), -1);
        continue;
      }
      const std::uint32_t a = same_as(in.a), w = place_[s].at;
      const std::uint32_t b = in.op == Op::multiply || in.op == Op::divide || in.op == Op::arctan2 || in.op == Op::select ? same_as(in.b) : a;
      const bool by_a = unknown(a, in.lead), by_b = unknown(b, in.lead);
      switch (in.op) {
        case Op::multiply:
          if (by_a) enter(s, a, place_[b].at, -1);
          if (by_b) enter(s, b, place_[a].at, -1);
          break;
        case Op::square: enter(s, a, partial(Partial::Kind::twice, place_[a].at, 0), -1); break;
        case Op::divide: {
          const std::uint32_t reciprocal = reciprocal_.at(s);
          if (by_a) enter(s, a, reciprocal, -1);
          if (by_b) enter(s, b, partial(Partial::Kind::quotient, w, reciprocal), 1);
          break;
        }
        case Op::power:
          if (tape_.rationals[in.index] == Rational(1, 2)) enter(s, a, partial(Partial::Kind::half_reciprocal, w, 0), -1);
          else enter(s, a, partial(Partial::Kind::power, w, place_[a].at, tape_.rationals[in.index].get_d()), -1);
          break;
        case Op::function:
          if (const auto cosine = cosine_of_.find(s); cosine != cosine_of_.end()) enter(s, a, place_[cosine->second].at, -1);
          else if (const auto sine = sine_of_.find(s); sine != sine_of_.end()) enter(s, a, place_[sine->second].at, 1);
          else enter(s, a, at(in.b).at, -1);
          break;
        case Op::arctan2:
          if (by_a) enter(s, a, at(in.first).at, -1);
          if (by_b) enter(s, b, at(in.count).at, -1);
          break;
        case Op::select:
          if (by_a) enter(s, a, partial(Partial::Kind::chosen, at(in.first).at, 0), -1);
          if (by_b) enter(s, b, partial(Partial::Kind::not_chosen, at(in.first).at, 0), -1);
          break;
        default: ANHOLON_ASSERT(!"no slot that depends on unknowns");
      }
    }
    for (std::size_t i = 0; i < p_.unknowns(); ++i) {
      const std::uint32_t alias = tape_.roots[i], r = same_as(alias);
      plan_.roots.push_back(place_[r]);
      plan_.root_is_zero.push_back(code_[r].constant || (unknown(r, code_[alias].lead) && pure_[r]));
      if (!code_[r].constant && unknown(r, code_[alias].lead)) plan_.entries.push_back({static_cast<std::uint32_t>(i), column(r), unit, 1});
    }
    std::vector<int> depth;
    for (std::uint32_t i = 0; i < p_.unknowns(); ++i) {
      plan_.sides.push_back(i);
      depth.push_back(depth_[same_as(tape_.roots[i])]);
    }
    std::stable_sort(plan_.sides.begin(), plan_.sides.end(), [&](std::uint32_t i, std::uint32_t j) { return depth[i] < depth[j]; });
    for (std::size_t i = p_.unknowns(); i < tape_.roots.size(); ++i) plan_.quadratures.push_back(place_[same_as(tape_.roots[i])]);
  }

  void finish() {
    for (std::uint32_t s = 0; s < code_.size(); ++s)
      if (live_[s] && !code_[s].constant && code_[s].op == Op::power && tape_.rationals[code_[s].index].get_den() % 2 == 0)
        plan_.roots_of_even_powers.push_back({code_[s].a, at(code_[s].a)});
    for (std::uint32_t s = 0; s < tape_.main_end; ++s) {
      if (!live_[s] || !tainted_[s] || !series_[s]) continue;
      if (code_[s].op == Op::input) {
        if (inputs_[s]->order > 0) plan_.completions.push_back({place_[s], code_[s].lead, column(s), true});
      } else {
        plan_.completions.push_back({place_[s], code_[s].lead, column(s), pure_[s]});
      }
    }
  }

  const Program& p_;
  const Tape& tape_;
  const std::vector<Instruction>& code_;
  int stages_;
  Plan plan_;
  std::vector<const ProgramInput*> inputs_;
  std::map<std::uint32_t, std::uint32_t> cosine_of_, sine_of_;
  std::vector<bool> live_, series_, tainted_, pure_;
  std::vector<std::vector<Summand>> sums_;
  std::vector<int> uses_, depth_;
  std::vector<Place> place_;
  std::vector<std::uint32_t> column_;
  std::map<std::string, std::uint32_t> coefficient_;
  std::map<std::uint32_t, std::uint32_t> reciprocal_;
  std::map<std::pair<std::uint32_t, bool>, Place> weighted_;
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

Plan plan(const Program& program, int stages) {
  ANHOLON_ASSERT(no_plan(program).empty());
  return Planner(program, stages).run();
}

std::vector<double> coefficient_values(const Plan& plan, const Program& program, const std::vector<long double>& parameters) {
  const Machine<long double> machine(program.tape, 0, parameters);
  std::vector<double> values;
  for (const Coefficient& c : plan.coefficients) {
    long double v = from_rational<long double>(c.rational);
    for (std::uint32_t s : c.slots) {
      const long double x = machine.series(s & ~kReciprocal)[0];
      v = s & kReciprocal ? v / x : v * x;
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
        case Act::linear: w += orders * s.count; break;
        case Act::multiply: case Act::divide: case Act::function: w += convolution; break;
        case Act::square: case Act::square_root: w += convolution / 2; break;
        case Act::power: case Act::sine_cosine: case Act::arctan2: w += 2 * convolution; break;
        case Act::input: case Act::weigh: case Act::select: case Act::lookup: w += orders; break;
      }
  return w;
}

}  // namespace anholon
