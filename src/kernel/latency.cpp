#include "kernel/latency.h"

#include <algorithm>
#include <unordered_map>

namespace anholon {

namespace {

// The latency of a quotient (lanes.h).
constexpr int kQuotient = 2;

class Clock {
 public:
  Clock(const Plan& plan, const SparseLu& elimination) : p_(plan), e_(elimination) {}

  int stage() {
    for (const Step& s : p_.stage) run(s);
    solve();
    int last = 0;
    for (std::size_t j = 0; j < p_.x.size(); ++j)
      last = std::max(last, finish({p_.x[j], true}, p_.d[j], solution_[j] + (p_.d[j] > 0 ? kQuotient : 0)));
    for (const Completion& c : p_.completions)
      last = std::max(last, finish(c.out, c.lead, solution_[c.column] + (c.lead > 0 ? kQuotient : 0) + !c.fresh));
    for (const Step& s : p_.weigh_again) last = std::max(last, finish(s.out, s.lead, ready(s.a, s.lead) + 1));
    return last;
  }

 private:
  struct Made {
    int order, at;
  };

  // The time at which the coefficient of order stage + `order` is known: 0 if an earlier stage has computed it.
  int ready(const Place& x, int order) const {
    const auto it = made_.find(x.at);
    return it != made_.end() && (!x.series || it->second.order == order) ? it->second.at : 0;
  }
  int finish(const Place& x, int order, int at) {
    made_[x.at] = {order, at};
    return at;
  }

  // The latency of a sum of two products; the later operand comes last.
  int product(const Step& s) const {
    const int a = s.a_unknown ? 0 : ready(s.a, s.lead), b = s.b_unknown ? 0 : ready(s.b, s.lead);
    return std::max(std::min(a, b) + 1, std::max(a, b)) + 1;
  }

  // The latency of the known part, divided by the order, plus the newest coefficient.
  int newest(int before, const Place& x, int lead, bool missing) const {
    return missing ? before + kQuotient : std::max(before + kQuotient, ready(x, lead)) + 1;
  }

  void run(const Step& s) {
    const int l = s.lead, a = s.act == Act::linear || s.a_unknown ? 0 : ready(s.a, l);
    switch (s.act) {
    case Act::input:
      finish(s.out, l, ready(s.a, l + static_cast<int>(s.index)) + 1);
      break;
    case Act::linear: {
      std::vector<int> terms;
      for (std::uint32_t k = s.first; k < s.first + s.count; ++k) terms.push_back(ready(p_.terms[k].x, l));
      int at = 0;
      for (const int t : terms) at = std::max(at, t) + 1;
      finish(s.out, l, at);
      break;
    }
    case Act::multiply:
      finish(s.out, l, product(s));
      break;
    case Act::square:
      finish(s.out, l, a + 2);
      break;
    case Act::divide:
      finish(s.out, l, std::max(a, ready(s.b, l) + 1) + 2);
      break;
    case Act::square_root:
      finish(s.out, l, a + 2);
      break;
    case Act::power:
      finish(s.d, l, finish(s.out, l, newest(3, s.a, l, s.a_unknown)) + 1);
      break;
    case Act::sine_cosine: {
      const int at = newest(0, s.a, l, s.a_unknown);
      finish(s.out, l, at);
      finish(s.c, l, at);
      break;
    }
    case Act::function:
      finish(s.out, l, s.b_constant ? a + 1 : newest(0, s.a, l, s.a_unknown));
      break;
    case Act::arctan2:
      finish(s.out, l,
             std::max(newest(1, s.a, l, s.a_constant || s.a_unknown), s.b_constant || s.b_unknown ? 0 : ready(s.b, l)) +
                 1);
      break;
    case Act::weigh:
      finish(s.out, l, a + 1);
      break;
    case Act::select:
      finish(s.out, l, std::max(a, ready(s.b, l)) + 1);
      break;
    case Act::beyond:
    case Act::lookup:
      break;
    }
  }

  void solve() {
    std::vector<int> side(p_.rows, 0);
    for (std::size_t i = 0; i < p_.roots.size(); ++i)
      if (!p_.root_is_zero[i]) side[i] = ready(p_.roots[i], p_.c[i]) + (p_.c[i] > 0);
    solution_.assign(p_.rows, 0);
    if (!e_.influences.empty()) {
      for (const SparseLu::Influence& of : e_.influences)
        solution_[of.column] = std::max(solution_[of.column], side[of.side]) + (of.sign == 0);
      for (const SparseLu::Own& own : e_.own)
        for (std::uint32_t i = own.first; i < own.first + own.count; ++i)
          solution_[own.column] = std::max(solution_[own.column], solution_[e_.own_terms[i].column]) + 1;
      return;
    }
    for (const SparseLu::Forward& f : e_.forward) side[f.to] = std::max(side[f.to], side[f.from]) + 1;
    for (const SparseLu::Backward& b : e_.backward) {
      int at = b.zero_side ? 0 : side[b.row];
      for (std::uint32_t i = b.first; i < b.first + b.count; ++i) at = std::max(at, solution_[e_.terms[i].column]) + 1;
      solution_[b.column] = at + !e_.pivots[b.pivot].one;
    }
  }

  const Plan& p_;
  const SparseLu& e_;
  std::unordered_map<std::uint32_t, Made> made_;
  std::vector<int> solution_;
};

}  // namespace

int latency(const Plan& plan, const SparseLu& elimination) { return Clock(plan, elimination).stage(); }

}  // namespace anholon
