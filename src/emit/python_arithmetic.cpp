#include "emit/python_arithmetic.h"

#include <algorithm>
#include <map>

#include "base/assert.h"
#include "emit/text.h"
#include "numeric/number.h"

namespace anholon::emit {

namespace {

using Kind = Arithmetic::Kind;
using Node = Arithmetic::Node;
using Term = Arithmetic::Term;
using Id = std::uint32_t;

constexpr std::uint32_t kNone = Arithmetic::kNone;
constexpr std::size_t kLongest = 100;  // the longest text of an operand; a longer one gets a name

std::string number_of(const Rational& r) { return number_text(from_rational<double>(r)); }
std::string number_of(const Node& n) { return n.text.empty() ? number_of(n.number) : "float(\"" + n.text + "\")"; }

// Returns the name without "np.".
std::string short_name(Function f) { return std::string(info(f).numpy).substr(3); }

// A text and its binding strength: a sum, a product, or an atom that needs no parentheses.
struct Text {
  std::string s;
  enum class Bond : std::uint8_t { sum, product, atom } bond = Bond::atom;
};
using Bond = Text::Bond;

std::string in(const Text& t, Bond place) { return t.bond < place ? "(" + t.s + ")" : t.s; }

// Adds a term to the text of a sum.
void add_term(std::string& out, const Rational& c, const Text& t) {
  out += out.empty() ? (c < 0 ? "-" : "") : c < 0 ? " - " : " + ";
  const Rational size = abs(c);
  out += size == 1 ? in(t, Bond::product) : number_of(size) + "*" + in(t, Bond::product);
}

class OfOne {
 public:
  explicit OfOne(const Arithmetic& a) : a_(a), uses_(a.uses()), divisor_(a.divisors()), text_(a.nodes.size()) {}

  std::string body(std::size_t states) {
    std::string out = "    ";
    for (std::size_t i = 0; i < states; ++i) out += (i ? ", x" : "x") + std::to_string(i);
    out += states == 1 ? ", = x\n" : states == 0 ? "pass\n" : " = x\n";
    for (const Id i : a_.order()) {
      if (divisor_[i]) continue;
      text_[i] = of(i);
      const Kind kind = a_.nodes[i].kind;
      if (kind == Kind::input || kind == Kind::number || (uses_[i] == 1 && text_[i].s.size() < kLongest)) continue;
      const std::string name = "s" + std::to_string(i);
      out += "    " + name + " = " + text_[i].s + "\n";
      text_[i] = {name};
    }
    std::string roots;
    for (const Arithmetic::Value& v : a_.roots) {
      std::string root;
      if (v.node == kNone)
        root = number_of(v.coefficient);
      else if (v.coefficient == 1)
        root = text_[v.node].s;
      else
        add_term(root, v.coefficient, text_[v.node]);
      roots += (roots.empty() ? "" : ", ") + root;
    }
    return out + "    return [" + roots + "]\n";
  }

 private:
  Text of(Id id) const {
    const Node& n = a_.nodes[id];
    const auto operand = [&](std::size_t k) -> const Text& { return text_[n.of[k]]; };
    switch (n.kind) {
    case Kind::input:
      return {n.text};
    case Kind::number:
      return {number_of(n), Bond::sum};
    case Kind::product:
      return product(n);
    case Kind::reciprocal:
      return {"1.0/" + in(operand(0), Bond::atom), Bond::product};
    case Kind::sum: {
      std::string out;
      for (const bool negative : {false, true})
        for (const Term& t : n.terms)
          if ((t.coefficient < 0) == negative) add_term(out, t.coefficient, text_[t.node]);
      if (n.number != 0) out += (n.number < 0 ? " - " : " + ") + number_of(abs(n.number));
      return {out, Bond::sum};
    }
    case Kind::power:
      if (n.number == Rational(1, 2)) return {"_One.sqrt(" + operand(0).s + ")"};
      return {"_One.power(" + operand(0).s + ", " + number_of(n.number) + ")"};
    case Kind::function:
      return {"_One." + short_name(static_cast<Function>(n.index)) + "(" + operand(0).s + ")"};
    case Kind::arctan2:
      return {"_One.arctan2(" + operand(0).s + ", " + operand(1).s + ")"};
    case Kind::select:
      return {"(" + operand(1).s + " if " + operand(0).s + " >= 0 else " + operand(2).s + ")"};
    case Kind::lookup:
      return {replaced(python_lookup(a_.step_functions[n.index], operand(0).s), "np.", "_One.")};
    }
    return {};
  }

  Text product(const Node& n) const {
    std::string up, down;
    for (const Id f : n.of) {
      if (divisor_[f])
        down += "/" + in(text_[a_.nodes[f].of[0]], Bond::atom);
      else
        up += (up.empty() ? "" : "*") + in(text_[f], up.empty() ? Bond::product : Bond::atom);
    }
    return {(up.empty() ? "1.0" : up) + down, Bond::product};
  }

  const Arithmetic& a_;
  std::vector<std::size_t> uses_;
  std::vector<bool> divisor_;
  std::vector<Text> text_;
};

// Writes the statements for many states. Rows of w are assigned to results and reused after the last use of the result.
// The rows of `out` hold roots.
class OfMany {
 public:
  explicit OfMany(const Arithmetic& a) : a_(a), left_(a.uses()), divisor_(a.divisors()), place_(a.nodes.size()) {}

  PythonOfMany run() {
    for (std::size_t i = 0; i < a_.roots.size(); ++i)
      if (const Arithmetic::Value& v = a_.roots[i]; v.node != kNone && v.coefficient == 1 && computed(v.node))
        root_.try_emplace(v.node, i);
    std::map<Id, std::pair<Id, Id>> pairs = sines_and_cosines();
    for (const Id i : a_.order()) {
      if (divisor_[i] || !place_[i].empty()) continue;  // a cosine may have come with its sine
      if (const auto pair = pairs.find(i); pair != pairs.end()) {
        const Id argument = a_.nodes[i].of[0], sine = pair->second.first, cosine = pair->second.second;
        reserve(sine), reserve(cosine);
        const std::string scratch = take();
        line("_sine_and_cosine(" + at(argument) + ", " + place_[sine] + ", " + place_[cosine] + ", " + scratch + ")");
        give(scratch);
        used(argument), used(argument);
      } else if (computed(i)) {
        compute(i);
      } else {
        place_[i] = a_.nodes[i].kind == Kind::number ? number_of(a_.nodes[i]) : a_.nodes[i].text;
      }
    }
    for (std::size_t i = 0; i < a_.roots.size(); ++i) put_root(i);
    return {arguments() + text_, most_};
  }

 private:
  bool computed(Id i) const { return a_.nodes[i].kind != Kind::input && a_.nodes[i].kind != Kind::number; }
  void line(const std::string& s) { text_ += "    " + s + "\n"; }
  const std::string& at(Id i) const { return place_[i]; }

  // Returns an unused row.
  std::string take() {
    if (!idle_.empty()) {
      const std::string row = idle_.back();
      idle_.pop_back();
      return row;
    }
    return "w" + std::to_string(most_++);
  }
  void give(const std::string& row) { idle_.push_back(row); }
  void reserve(Id i) {
    const auto root = root_.find(i);
    place_[i] = root == root_.end() ? take() : "o" + std::to_string(root->second);
  }
  void used(Id i) {
    if (--left_[i] == 0 && computed(i) && !root_.count(i)) give(place_[i]);
  }
  void all_used(Id i) {
    for (const Id k : a_.operands(i)) used(k);
  }

  // Returns the pairs of sine and cosine of one angle, by that of the two that comes first.
  std::map<Id, std::pair<Id, Id>> sines_and_cosines() const {
    std::map<Id, std::pair<Id, Id>> of_angle, out;
    for (Id i = 0; i < a_.nodes.size(); ++i) {
      const Node& n = a_.nodes[i];
      if (left_[i] == 0 || n.kind != Kind::function) continue;
      auto& [sine, cosine] = of_angle.try_emplace(n.of[0], kNone, kNone).first->second;
      if (static_cast<Function>(n.index) == Function::sin) sine = i;
      if (static_cast<Function>(n.index) == Function::cos) cosine = i;
    }
    for (const auto& [angle, both] : of_angle)
      if (both.first != kNone && both.second != kNone) out[both.first] = out[both.second] = both;
    return out;
  }

  void compute(Id i) {
    reserve(i);
    const Node& n = a_.nodes[i];
    const std::string& to = place_[i];
    const auto operand = [&](std::size_t k) -> const std::string& { return at(n.of[k]); };
    switch (n.kind) {
    case Kind::input:
    case Kind::number:
      return;
    case Kind::product:
      return product(i);
    case Kind::sum:
      sum(n, to);
      break;
    case Kind::reciprocal:
      line("_divide(1.0, " + operand(0) + ", " + to + ")");
      break;
    case Kind::power:
      line(n.number == Rational(1, 2) ? "np.sqrt(" + operand(0) + ", " + to + ")"
                                      : "np.power(" + operand(0) + ", " + number_of(n.number) + ", " + to + ")");
      break;
    case Kind::function:
      line("np." + short_name(static_cast<Function>(n.index)) + "(" + operand(0) + ", " + to + ")");
      break;
    case Kind::arctan2:
      line("np.arctan2(" + operand(0) + ", " + operand(1) + ", " + to + ")");
      break;
    case Kind::select:
      line(to + "[:] = np.where(np.greater_equal(" + operand(0) + ", 0), " + operand(1) + ", " + operand(2) + ")");
      break;
    case Kind::lookup:
      line(to + "[:] = " + python_lookup(a_.step_functions[n.index], operand(0)));
      break;
    }
    all_used(i);
  }

  void product(Id i) {
    const Node& n = a_.nodes[i];
    const std::string& to = place_[i];
    std::string so_far;
    for (const bool divide : {false, true})
      for (const Id f : n.of) {
        if (divisor_[f] != divide) continue;
        const std::string& factor = at(divide ? a_.nodes[f].of[0] : f);
        if (so_far.empty() && !divide) {
          so_far = factor;
          continue;
        }
        line((divide ? "_divide(" : "_multiply(") + (so_far.empty() ? "1.0" : so_far) + ", " + factor + ", " + to +
             ")");
        so_far = to;
      }
    for (const Id f : n.of) used(divisor_[f] ? a_.nodes[f].of[0] : f);
  }

  void sum(const Node& n, const std::string& to) {
    // The sum begins with a term whose product needs no row of its own; added terms follow, then subtracted ones.
    std::vector<Term> terms;
    const auto rank = [](const Rational& c) { return abs(c) != 1 ? 0 : c == 1 ? 1 : 2; };
    for (int k = 0; k < 3; ++k)
      for (const Term& t : n.terms)
        if (rank(t.coefficient) == k) terms.push_back(t);
    std::string so_far;
    Rational constant = n.number;
    for (const Term& t : terms) {
      const Rational size = abs(t.coefficient);
      if (so_far.empty()) {
        if (size != 1) {
          line("_multiply(" + at(t.node) + ", " + number_of(t.coefficient) + ", " + to + ")");
          so_far = to;
        } else if (t.coefficient == 1) {
          so_far = at(t.node);
        } else if (constant != 0) {
          line("_subtract(" + number_of(constant) + ", " + at(t.node) + ", " + to + ")");
          so_far = to, constant = 0;
        } else {
          line("np.negative(" + at(t.node) + ", " + to + ")");
          so_far = to;
        }
        continue;
      }
      std::string term = at(t.node), scratch;
      if (size != 1) {
        scratch = take();
        line("_multiply(" + term + ", " + number_of(size) + ", " + scratch + ")");
        term = scratch;
      }
      line(std::string(t.coefficient < 0 ? "_subtract(" : "_add(") + so_far + ", " + term + ", " + to + ")");
      so_far = to;
      if (!scratch.empty()) give(scratch);
    }
    if (constant != 0)
      line("_add(" + so_far + ", " + number_of(constant) + ", " + to + ")");
    else if (so_far != to)
      line(to + "[:] = " + so_far);
  }

  void put_root(std::size_t i) {
    const Arithmetic::Value& v = a_.roots[i];
    const std::string to = "o" + std::to_string(i);
    if (v.node == kNone)
      line(to + "[:] = " + number_of(v.coefficient));
    else if (v.coefficient == -1)
      line("np.negative(" + at(v.node) + ", " + to + ")");
    else if (v.coefficient != 1)
      line("_multiply(" + at(v.node) + ", " + number_of(v.coefficient) + ", " + to + ")");
    else if (at(v.node) != to)
      line(to + "[:] = " + at(v.node));
  }

  // Returns names of the rows that are used.
  std::string arguments() const {
    std::string out;
    const auto row = [&](const std::string& name, const std::string& list, std::size_t k) {
      out += "    " + name + " = " + list + "[" + std::to_string(k) + "]\n";
    };
    for (const Node& n : a_.nodes)
      if (n.kind == Kind::input && n.text != "t") row(n.text, "x", std::stoul(n.text.substr(1)));
    for (std::size_t i = 0; i < a_.roots.size(); ++i) row("o" + std::to_string(i), "out", i);
    for (std::size_t i = 0; i < most_; ++i) row("w" + std::to_string(i), "w", i);
    return out;
  }

  const Arithmetic& a_;
  std::vector<std::size_t> left_;
  std::vector<bool> divisor_;
  std::vector<std::string> place_;
  std::map<Id, std::size_t> root_;  // nodes that are computed in the row of a root
  std::vector<std::string> idle_;
  std::string text_;
  std::size_t most_ = 0;
};

}  // namespace

std::string python_of_one(const Arithmetic& a, std::size_t states) { return OfOne(a).body(states); }

PythonOfMany python_of_many(const Arithmetic& a) { return OfMany(a).run(); }

}  // namespace anholon::emit
