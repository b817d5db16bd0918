// Pieces of printed expressions in each format: numbers, products, quotients, powers, calls.
#pragma once
#include <string>
#include <unordered_map>

#include "print/powers.h"
#include "print/print_names.h"

namespace anholon {

// The binding strength of a text, which decides about brackets.
enum Strength : int { kSum = 1, kProduct = 2, kPower = 3, kAtom = 4 };

struct Printed {
  std::string text;
  int strength = kAtom;
  std::string opposite = {};  // the text of -e, if the text of e starts with a minus sign
  int opposite_strength = kAtom;
};

class Spelling {
 public:
  // Texts of more than `longest` bytes become "…".
  Spelling(Format format, std::size_t longest) : format_(format), longest_(longest) {}

  bool latex() const { return format_ == Format::latex; }
  bool mathml() const { return format_ == Format::mathml; }
  // Returns the sign of subtraction.
  std::string minus() const { return mathml() ? "<mo>−</mo>" : "-"; }
  std::string plus_between() const { return mathml() ? "<mo>+</mo>" : " + "; }
  std::string minus_between() const { return mathml() ? minus() : " - "; }
  std::string whole(const mpz_class& n) const { return mathml() ? "<mn>" + n.get_str() + "</mn>" : n.get_str(); }

  // Returns "…" in place of a text that is too long.
  std::string cut(std::string s) const;
  std::string brackets(const std::string& s) const;
  std::string wrap(const std::string& text, int its_strength, int strength) const {
    return its_strength >= strength ? text : brackets(text);
  }
  std::string wrap(const Printed& p, int strength) const { return wrap(p.text, p.strength, strength); }
  std::string join(const std::string& a, const std::string& b) const;  // a product
  std::string fraction(const std::string& top, const std::string& bottom) const;
  std::string call(const std::string& name, const std::string& latex_text, const std::string& arguments) const;
  Printed negated(Printed p) const { return {minus() + p.text, kSum, std::move(p.text), p.strength}; }
  Printed number(const Rational& r) const;
  Printed power(const Printed& base, const Rational& exponent) const;
  // Returns c * p without its sign.
  std::string weighted(const Rational& c, const Printed& p) const;

 protected:
  Format format_;

 private:
  std::size_t longest_;
};

// Returns the text of a power such as x^(n + 1). `of` has the texts of the operands.
Printed text_of(const Spelling& spelling, const std::unordered_map<NodeId, Printed>& of, const GeneralPower& power);

}  // namespace anholon
