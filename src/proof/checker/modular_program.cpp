#include "proof/checker/modular_program.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace anholon::verification {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kMostBits = 4096;  // the limit of a coefficient inside an angle

static std::uint64_t name_of(const std::string& function) {
  const auto& all = Certificate::functions();
  return static_cast<std::uint64_t>(std::find(all.begin(), all.end(), function) - all.begin());
}

// Compiling

void ModularProgram::add(Index node) {
  if (local_[node] != kNone) return;
  local_[node] = 0;
  nodes_.push_back(node);
}

void ModularProgram::collect() {
  for (const std::size_t k : claims_) {
    const Certificate::Claim& claim = c_.claims[k];
    add(claim.left);
    for (const Certificate::Pair& p : claim.right) add(p.coefficient), add(p.node);
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Certificate::Node& n = c_.nodes[nodes_[i]];
    work_.spend(1 + n.terms.size());
    for (const Certificate::Term& t : n.terms)
      if (n.operation != Operation::product || t.weight != 0) add(t.node);
  }
  std::sort(nodes_.begin(), nodes_.end());
  for (std::size_t i = 0; i < nodes_.size(); ++i) local_[nodes_[i]] = static_cast<std::uint32_t>(i);
  steps_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    steps_[i].node = &c_.nodes[nodes_[i]];
    compile(steps_[i]);
  }
}

void ModularProgram::compile(Step& s) {
  const Certificate::Node& n = *s.node;
  if (n.operation == Operation::function) {
    s.family = function(n.function).family;
    s.name = name_of(s.family == Family::complement ? "asin" : n.function);
  }
  s.constant = n.operation == Operation::sum || n.operation == Operation::product || n.operation == Operation::number ||
               s.family == Family::branch;
  cost_ += 30 + (n.operation == Operation::sum ? 5 : 400) * n.terms.size();
  for (const Certificate::Term& t : n.terms) {
    const bool used = n.operation != Operation::product || t.weight != 0;
    s.operands.push_back(used ? local_[t.node] : kNone);
    if (used && !steps_[local_[t.node]].constant) s.constant = false;
  }
  if (n.operation == Operation::product)
    for (std::size_t k = 0; k < s.operands.size(); ++k)
      if (s.operands[k] != kNone && n.terms[k].weight.has_even_denominator()) site(s.operands[k], true);
  if (s.family == Family::branch) site(s.operands[0], false);
}

std::size_t ModularProgram::site(std::uint32_t local, bool root) {
  const auto [it, is_new] = site_of_.emplace(std::pair{local, root}, static_cast<std::uint32_t>(sites_.size()));
  if (is_new) sites_.push_back({local, root, steps_[local].constant, false});
  return it->second;
}

// Writes an argument as an angle. It starts at the largest node, so that all paths to a node are added up before the
// node is expanded.
Angle ModularProgram::flatten(Index argument, bool circle) {
  Angle angle;
  Rational ones = 0, pis = 0;
  std::map<Index, Rational, std::greater<>> open{{argument, 1}};
  const auto check = [](const Rational& r) {
    if (r.bits() > kMostBits) throw Unable{"an angle has a coefficient of too many digits"};
  };
  while (!open.empty()) {
    const Index at = open.begin()->first;
    const Rational coefficient = open.begin()->second;
    open.erase(open.begin());
    if (coefficient == 0) continue;
    check(coefficient);
    const Certificate::Node& n = c_.nodes[at];
    if (!work_.spend(4 + 4 * n.terms.size())) throw Unable{"the limit of work is reached"};
    switch (n.operation) {
    case Operation::number:
      ones += coefficient * n.value;
      break;
    case Operation::pi:
      pis += coefficient;
      break;
    case Operation::sum:
      for (const Certificate::Term& t : n.terms) open[t.node] += coefficient * t.weight;
      break;
    case Operation::product: {
      Rational content = 1;
      const Certificate::Term* other = nullptr;
      std::size_t others = 0;
      for (const Certificate::Term& t : n.terms) {
        if (t.weight == 0) continue;
        const Certificate::Node& factor = c_.nodes[t.node];
        const bool number = factor.operation == Operation::number && factor.value != 0 && t.weight.is_integer();
        const auto power = number ? exact_power(factor.value, t.weight.to_long()) : std::nullopt;
        if (power)
          content *= *power, check(content);
        else
          other = &t, ++others;
      }
      if (others == 0)
        ones += coefficient * content;
      else if (others == 1 && other->weight == 1)
        open[other->node] += coefficient * content;
      else
        angle.parts.push_back({Part::Of::node, local_[at], content, coefficient * content});
      break;
    }
    case Operation::symbol:
    case Operation::function:
    case Operation::atan2:
      angle.parts.push_back({Part::Of::node, local_[at], 1, coefficient});
      break;
    }
  }
  check(ones), check(pis);
  if (circle && pis != 0) {
    const Rational twelfths = pis * 12;
    const Rational whole = floor(twelfths);
    angle.twelfths = static_cast<unsigned>(mpz_fdiv_ui(whole.get_num().get_mpz_t(), 24));
    pis = (twelfths - whole) / 12;
  }
  if (ones != 0) angle.parts.push_back({Part::Of::one, 0, 1, ones});
  if (pis != 0) angle.parts.push_back({Part::Of::pi, 0, 1, pis});
  return angle;
}

void ModularProgram::prepare() {
  for (Step& s : steps_) {
    if (!is_of_angle(s.family)) continue;
    const bool circle = s.family == Family::circle;
    s.angle = flatten(s.node->terms[0].node, circle);
    for (const Part& part : s.angle.parts) {
      mpz_class& q = circle ? circle_q_ : growth_q_;
      mpz_lcm(q.get_mpz_t(), q.get_mpz_t(), part.coefficient.get_den().get_mpz_t());
      cost_ += 1500;
      if (mpz_sizeinbase(q.get_mpz_t(), 2) > 60) throw Unable{"angles of too fine a common denominator"};
    }
  }
  degrees();
}

double ModularProgram::varying_roots() const {
  return static_cast<double>(
      std::count_if(sites_.begin(), sites_.end(), [](const Site& s) { return s.root && !s.constant; }));
}

int ModularProgram::open_branches() const {
  return static_cast<int>(
      std::count_if(sites_.begin(), sites_.end(), [](const Site& s) { return !s.failed && !s.constant; }));
}

// Degrees

// The bases of denominators.
enum : std::uint64_t { kInverted = 0, kCircle = 1, kGrowth = 2, kQuotient = 3, kBases = 4 };

double ModularProgram::total(const Degree& d) const {
  double sum = d.numerator;
  for (const auto& [base, exponent] : d.denominators) sum += exponent * base_degree_.at(base);
  return std::isnan(sum) ? kInfinity : sum;
}

Degree ModularProgram::sum_degree(const std::vector<const Degree*>& terms) {
  std::map<std::uint64_t, double> common;
  for (const Degree* d : terms)
    for (const auto& [base, exponent] : d->denominators) {
      double& e = common[base];
      e = std::max(e, exponent);
    }
  Degree sum;
  double all = 0;
  for (const auto& [base, exponent] : common)
    all += exponent * base_degree_.at(base), sum.denominators.emplace_back(base, exponent);
  for (const Degree* d : terms) {
    const double missing = all - (total(*d) - d->numerator);
    sum.numerator = std::max(sum.numerator, std::isnan(missing) ? kInfinity : d->numerator + missing);
  }
  work_.spend(10 * common.size() + 10 * terms.size());
  return sum;
}

void ModularProgram::multiply_degree(Degree& d, const Degree& by, double exponent, std::uint64_t base) {
  if (exponent < 0) {
    // 1 / (N/D) = D/N, N a new base.
    d.numerator += -exponent * (total(by) - by.numerator);
    if (by.numerator > 0) {
      base_degree_[base] = by.numerator;
      Degree inverse;
      inverse.denominators.emplace_back(base, 1);
      multiply_degree(d, inverse, -exponent, base);
    }
  } else {
    d.numerator += exponent * by.numerator;
    for (const auto& [b, e] : by.denominators) {
      const auto it = std::lower_bound(d.denominators.begin(), d.denominators.end(), std::pair{b, -kInfinity});
      if (it != d.denominators.end() && it->first == b)
        it->second += e * exponent;
      else
        d.denominators.insert(it, {b, e * exponent});
    }
  }
  if (std::isnan(d.numerator)) d.numerator = kInfinity;
  work_.spend(4 * (1 + d.denominators.size()));
}

void ModularProgram::degrees() {
  degree_.assign(steps_.size(), {});
  std::vector<std::pair<std::uint32_t, mpz_class>> roots;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& s = steps_[i];
    Degree& d = degree_[i];
    const auto operand = [&](std::size_t k) -> const Degree& { return degree_[s.operands[k]]; };
    switch (s.node->operation) {
    case Operation::number:
      break;
    case Operation::pi:
    case Operation::symbol:
      d.numerator = 1;
      break;
    case Operation::sum: {
      std::vector<const Degree*> terms;
      for (std::size_t k = 0; k < s.operands.size(); ++k)
        if (s.node->terms[k].weight != 0) terms.push_back(&operand(k));
      d = sum_degree(terms);
      break;
    }
    case Operation::product:
      for (std::size_t k = 0; k < s.operands.size(); ++k) {
        if (s.operands[k] == kNone) continue;
        const Rational& weight = s.node->terms[k].weight;
        multiply_degree(d, operand(k), weight.get_d(), s.operands[k] * kBases + kInverted);
        if (!weight.is_integer()) roots.emplace_back(s.operands[k], weight.get_den());
      }
      break;
    case Operation::atan2:
      d.numerator = 1;
      key_degree(std::max(total(operand(0)), total(operand(1))));
      break;
    case Operation::function:
      function_degree(i, d);
      break;
    }
    if (std::isnan(d.numerator)) d.numerator = kInfinity;
    if (work_.done()) throw Unable{"the limit of work is reached"};
  }
  // The norm to the field without roots has one factor for each choice of all roots.
  std::map<std::uint32_t, mpz_class> order;
  for (const auto& [local, q] : roots) {
    mpz_class& n = order.emplace(local, 1).first->second;
    mpz_lcm(n.get_mpz_t(), n.get_mpz_t(), q.get_mpz_t());
  }
  for (const auto& [local, n] : order) log2_conjugates_ += std::log2(n.get_d());
}

void ModularProgram::function_degree(std::size_t i, Degree& d) {
  const Step& s = steps_[i];
  switch (s.family) {
  case Family::branch:
    if (s.node->function == "abs") d = degree_[s.operands[0]];
    break;
  case Family::keyed:
  case Family::odd:
  case Family::complement:
    d.numerator = 1;
    key_degree(total(degree_[s.operands[0]]));
    break;
  case Family::circle:
  case Family::exponential:
    angle_degree(i, d);
    break;
  }
}

void ModularProgram::angle_degree(std::size_t i, Degree& d) {
  const Step& s = steps_[i];
  const std::string& name = s.node->function;
  const bool circle = s.family == Family::circle;
  const std::uint64_t special = static_cast<std::uint64_t>(steps_.size()) * kBases;  // bases of the atoms 1 and π
  double sum = 0;
  for (const Part& part : s.angle.parts) {
    const double times = std::abs(Rational(part.coefficient * (circle ? circle_q_ : growth_q_)).get_d());
    sum += 2 * times;
    const std::uint64_t atom =
        part.of == Part::Of::node ? part.local * kBases : special + (part.of == Part::Of::pi ? 1 : 0) * kBases;
    const std::uint64_t base = atom + (circle ? kCircle : kGrowth);
    base_degree_[base] = 2;
    Degree by;
    if (name == "exp" && part.coefficient > 0)
      by.numerator = 2 * times;
    else
      by.denominators.emplace_back(base, times);
    multiply_degree(d, by, 1, base);
    key_degree(part.of == Part::Of::node ? total(degree_[part.local]) : 1);
  }
  if (circle) d.numerator += sum;
  if (name == "sinh" || name == "cosh" || name == "tanh") d.numerator += 2 * sum;
  if (name == "tan" || name == "tanh") {
    const std::uint64_t base = i * kBases + kQuotient;
    base_degree_[base] = name == "tan" ? sum : 2 * sum;
    d = Degree{base_degree_[base], {{base, 1}}};
  }
}

double ModularProgram::difference_degree(const Certificate::Claim& claim) {
  std::vector<Degree> products(claim.right.size());
  std::vector<const Degree*> terms{&degree_[local_[claim.left]]};
  for (std::size_t k = 0; k < products.size(); ++k) {
    multiply_degree(products[k], degree_[local_[claim.right[k].coefficient]], 1, 0);
    multiply_degree(products[k], degree_[local_[claim.right[k].node]], 1, 0);
    terms.push_back(&products[k]);
  }
  return sum_degree(terms).numerator;
}

}  // namespace anholon::verification
