#include "kernel/plan/slots.h"

#include <algorithm>

namespace anholon {

namespace {

// A sum absorbs the sums among its terms, up to this number of terms.
constexpr std::size_t kLongestSum = 48;

bool is(const Instruction& in, Function f) {
  return in.op == Op::function && in.index == static_cast<std::uint32_t>(f);
}

}  // namespace

Slots::Slots(const Program& program) : tape(program.tape), code(tape.code), p_(program) {
  inputs.assign(code.size(), nullptr);
  for (const ProgramInput& in : p_.inputs) inputs[in.slot] = &in;
  pair_functions();
  mark_live();
  gather_sums();
  share_sums();
  mark_series();
  inline_sums();
  taint();
}

std::uint32_t Slots::same_as(std::uint32_t s) const {
  while (code[s].op == Op::linear && code[s].count == 1 &&
         tape.rationals[tape.linear_terms[code[s].first].coefficient] == 1)
    s = tape.linear_terms[code[s].first].slot;
  return s;
}

void Slots::pair_functions() {
  std::map<std::uint32_t, std::uint32_t> sine, cosine;
  for (std::uint32_t s = 0; s < code.size(); ++s) {
    if (is(code[s], Function::sin)) sine[code[s].a] = s;
    if (is(code[s], Function::cos)) cosine[code[s].a] = s;
  }
  for (const auto& [a, s] : sine)
    if (const auto it = cosine.find(a); it != cosine.end()) cosine_of[s] = it->second, sine_of[it->second] = s;
}

std::vector<std::uint32_t> Slots::operands(std::uint32_t s) const {
  const Instruction& in = code[s];
  std::vector<std::uint32_t> r;
  switch (in.op) {
  case Op::constant:
  case Op::pi:
  case Op::input:
  case Op::parameter:
    break;
  case Op::linear:
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) r.push_back(tape.linear_terms[k].slot);
    break;
  case Op::multiply:
  case Op::scale:
  case Op::divide:
    r = {in.a, in.b};
    break;
  case Op::square:
  case Op::power:
  case Op::lookup:
  case Op::rate:
    r = {in.a};
    break;
  case Op::function:
    r = {in.a};
    if (!cosine_of.count(s) && !sine_of.count(s)) r.push_back(in.b);
    break;
  case Op::arctan2:
    r = {in.a, in.b, in.first, in.count};
    break;
  case Op::select:
    r = {in.a, in.b, in.first};
    break;
  }
  for (std::uint32_t& x : r) x = same_as(x);
  return r;
}

void Slots::mark_live() {
  live.assign(code.size(), false);
  std::vector<std::uint32_t> todo;
  const auto add = [&](std::uint32_t s) {
    if (!live[s]) live[s] = true, todo.push_back(s);
  };
  for (std::uint32_t r : tape.roots) add(same_as(r));
  while (!todo.empty()) {
    const std::uint32_t s = todo.back();
    todo.pop_back();
    if (code[s].constant) continue;
    for (std::uint32_t o : operands(s)) add(o);
    if (const auto it = cosine_of.find(s); it != cosine_of.end()) add(it->second);
    if (const auto it = sine_of.find(s); it != sine_of.end()) add(it->second);
  }
}

static Coefficient product(const Coefficient& a, const Coefficient& b) {
  Coefficient c{a.rational * b.rational, a.slots};
  c.slots.insert(c.slots.end(), b.slots.begin(), b.slots.end());
  std::sort(c.slots.begin(), c.slots.end());
  return c;
}

void Slots::gather_sums() {
  sums.resize(code.size());
  uses_.assign(code.size(), 0);
  for (std::uint32_t s = 0; s < code.size(); ++s) {
    const Instruction& in = code[s];
    if (!live[s] || in.constant) continue;
    for (std::uint32_t o : operands(s)) ++uses_[o];
    if (!sum_like(s)) continue;
    const auto add = [&](Coefficient c, std::uint32_t slot) {
      slot = same_as(slot);
      if (code[slot].constant)
        sums[s].push_back({product(c, {Rational(1), {slot}}), kNone});
      else
        sums[s].push_back({std::move(c), slot});
    };
    if (in.op == Op::scale) {
      add({Rational(1), {in.a}}, in.b);
    } else if (in.op == Op::divide) {
      add({Rational(1), {in.b | Coefficient::kReciprocal}}, in.a);
    } else {
      for (std::uint32_t k = in.first; k < in.first + in.count; ++k)
        add({tape.rationals[tape.linear_terms[k].coefficient], {}}, tape.linear_terms[k].slot);
    }
  }
  for (std::uint32_t r : tape.roots) ++uses_[same_as(r)];
}

static bool same_up_to_sign(const Coefficient& a, const Coefficient& b, int sign) {
  return a.slots == b.slots && a.rational == sign * b.rational;
}

// Returns 1 or -1 if all terms of `part` are in `whole` with the same or the opposite sign, else 0. Terms are ordered
// by slots.
static int contained(const std::vector<Slots::Summand>& part, const std::vector<Slots::Summand>& whole) {
  int sign = 0;
  std::size_t at = 0;
  for (const Slots::Summand& t : part) {
    while (at < whole.size() && whole[at].slot < t.slot) ++at;
    if (at == whole.size() || whole[at].slot != t.slot) return 0;
    if (sign == 0) sign = same_up_to_sign(whole[at].c, t.c, 1) ? 1 : -1;
    if (!same_up_to_sign(whole[at].c, t.c, sign)) return 0;
  }
  return sign;
}

// A sum uses an earlier sum that it contains, the longest first: along a chain of links every sum is the previous one
// and a term.
void Slots::share_sums() {
  std::map<std::uint32_t, std::vector<std::uint32_t>> sums_with;  // by their first term
  for (std::uint32_t s = 0; s < code.size(); ++s) {
    std::vector<Slots::Summand>& terms = sums[s];
    const auto unfit = [](const Slots::Summand& t) { return t.slot == kNone; };
    if (terms.size() < 2 || std::any_of(terms.begin(), terms.end(), unfit)) continue;
    std::sort(terms.begin(), terms.end(),
              [](const Slots::Summand& a, const Slots::Summand& b) { return a.slot < b.slot; });
    const auto twice = [](const Slots::Summand& a, const Slots::Summand& b) { return a.slot == b.slot; };
    if (std::adjacent_find(terms.begin(), terms.end(), twice) != terms.end()) continue;
    for (bool again = true; again;) {
      again = false;
      std::uint32_t longest = kNone;
      for (const Slots::Summand& t : terms)
        if (const auto with = sums_with.find(t.slot); with != sums_with.end())
          for (const std::uint32_t r : with->second)
            if (code[r].lead == code[s].lead && in_main(r) == in_main(s) && sums[r].size() < terms.size() &&
                (longest == kNone || sums[r].size() > sums[longest].size()) && contained(sums[r], terms) != 0)
              longest = r;
      if (longest == kNone) break;
      const Rational sign(contained(sums[longest], terms));
      for (const Slots::Summand& t : sums[longest]) {
        --uses_[t.slot];
        terms.erase(
            std::find_if(terms.begin(), terms.end(), [&](const Slots::Summand& u) { return u.slot == t.slot; }));
      }
      const Slots::Summand taken{{sign, {}}, longest};
      ++uses_[longest];
      terms.insert(std::upper_bound(terms.begin(), terms.end(), taken,
                                    [](const Slots::Summand& a, const Slots::Summand& b) { return a.slot < b.slot; }),
                   taken);
      again = true;
    }
    if (terms.size() > 1) sums_with[terms.front().slot].push_back(s);
  }
}

void Slots::mark_series() {
  series.assign(code.size(), false);
  const auto keep = [&](std::uint32_t s) {
    if (!code[s].constant) series[s] = true;
  };
  for (std::uint32_t s = 0; s < code.size(); ++s) {
    const Instruction& in = code[s];
    if (!live[s] || in.constant) continue;
    for (std::uint32_t o : operands(s))
      if (code[o].lead > in.lead || (in_main(o) && !in_main(s))) keep(o);
    if (sum_like(s)) continue;
    if (in.op != Op::input)
      for (std::uint32_t o : operands(s)) keep(o);
    if (in.op == Op::divide || in.op == Op::power || in.op == Op::function) keep(s);
    if (in.op == Op::input && inputs[s]->kind != ProgramInput::Kind::variable) keep(s);
    if (in.op == Op::input && inputs[s]->kind == ProgramInput::Kind::variable && inputs[s]->order == 0) keep(s);
  }
  for (std::size_t i = 0; i < tape.roots.size(); ++i) {
    const std::uint32_t r = same_as(tape.roots[i]);
    if (i >= p_.unknowns() || p_.c[i] > 0 || code[r].lead > code[tape.roots[i]].lead) keep(r);
  }
}

void Slots::inline_sums() {
  for (std::uint32_t s = 0; s < code.size(); ++s) {
    if (!live[s] || code[s].constant || !sum_like(s)) continue;
    std::vector<Slots::Summand> all;
    for (Slots::Summand& t : sums[s]) {
      const bool inlined = t.slot != kNone && sum_like(t.slot) && uses_[t.slot] == 1 && !series[t.slot] &&
                           code[t.slot].lead == code[s].lead && in_main(t.slot) == in_main(s) &&
                           sums[t.slot].size() + sums[s].size() + all.size() <= kLongestSum;
      if (!inlined) {
        all.push_back(t);
        continue;
      }
      for (const Slots::Summand& u : sums[t.slot]) all.push_back({product(t.c, u.c), u.slot});
      live[t.slot] = false;
    }
    sums[s] = std::move(all);
  }
}

// Marks slots whose newest coefficient depends on the unknowns of the stage (tainted) and those for which it is zero
// without them (pure).
void Slots::taint() {
  tainted.assign(code.size(), false);
  pure.assign(code.size(), false);
  for (std::uint32_t s = 0; s < tape.main_end; ++s) {
    const Instruction& in = code[s];
    if (!live[s] || in.constant || in.op == Op::lookup) continue;
    if (in.op == Op::input) {
      tainted[s] = pure[s] = inputs[s]->leading;
      continue;
    }
    if (in.op == Op::rate) {
      const std::uint32_t a = same_as(in.a);
      tainted[s] = unknown(a, static_cast<std::uint8_t>(in.lead + in.index));
      pure[s] = tainted[s] && pure[a];
      continue;
    }
    if (sum_like(s)) {
      bool all = true;
      for (const Slots::Summand& t : sums[s]) {
        if (t.slot == kNone) continue;
        const bool here = unknown(t.slot, in.lead);
        tainted[s] = tainted[s] || here;
        all = all && here && pure[t.slot];
      }
      pure[s] = tainted[s] && all;
      continue;
    }
    std::vector<std::uint32_t> by = operands(s);
    if (in.op == Op::function || in.op == Op::power) by.resize(1);
    if (in.op == Op::arctan2 || in.op == Op::select) by.resize(2);
    for (std::uint32_t o : by) tainted[s] = tainted[s] || unknown(o, in.lead);
  }
}

}  // namespace anholon
