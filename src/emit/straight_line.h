// Expressions as statements of C or Python from a tape: products of many factors share common parts, and expressions
// that depend on parameters alone are computed separately, once for many calls.
//
// A factor that depends on parameters alone moves outwards through products and sums, where such factors are
// multiplied: k (a + m b) l, used once, is c0*a + c1*b with c0 = k l and c1 = k l m.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "emit/rate_formulas.h"
#include "emit/statements.h"
#include "tape/tape.h"

namespace anholon::emit {

class StraightLine {
 public:
  StraightLine(const RateFormulas& formulas, const Column& es, Language language = Language::c);

  // Returns the statements c[i] = …, functions of p.
  const std::string& constants() const { return constants_text_; }
  std::size_t constant_count() const { return constants_.size(); }
  // Returns the values of the constants for the parameters of the formulas.
  std::vector<double> default_constants() const;
  // Returns the statements out[i] = …, functions of t, x, lead, u and c; outputs that are zero are left out if
  // `sparse`.
  std::string statements(bool sparse) const;
  // True if the statements read an argument.
  bool reads(const std::string& argument) const { return text_.find(argument + "[") != std::string::npos; }
  bool reads_time() const { return time_; }
  bool used_sign() const { return used_sign_; }

 private:
  // A sum of products of whole powers of slots that do not vary, each with a rational factor.
  using Powers = std::map<std::uint32_t, long>;
  using Coefficient = std::map<Powers, Rational>;
  // A term, coefficient times text, of a value that varies.
  struct Term {
    std::string text;
    Coefficient coefficient;
  };
  using Form = std::vector<Term>;
  static const Coefficient kOne;
  // The dependence of a slot, and the number of its readers.
  struct Use {
    bool needed = false, varies = false;
    std::size_t readers = 0;
  };

  void find_uses(const std::unordered_map<std::uint32_t, std::string>& parameters);
  void write_constants();
  void write_rates();

  Form sum_of(const Instruction& in);
  Form product_of(std::uint32_t a, std::uint32_t b);
  Form quotient_of(std::uint32_t a, std::uint32_t b);
  // Returns exp(n*log(x)) of a slot as pow(x, n); nullopt if the slot is no such power.
  std::optional<std::string> general_power(const Instruction& in);
  std::optional<std::pair<std::uint32_t, Coefficient>> logarithm(std::uint32_t slot) const;
  std::string power_of(const std::string& base, const Coefficient& exponent);
  Form scaled(std::uint32_t slot, const Coefficient& by);
  Term term_of(std::uint32_t slot);
  // Sets the form of a slot. A form that several readers would each compute again becomes a named value.
  void set(std::uint32_t slot, Form f);
  Coefficient constant(std::uint32_t slot) const;
  Coefficient constant_power(std::uint32_t slot, long exponent) const;
  static Coefficient product(const Coefficient& a, const Coefficient& b);
  static bool is_sign(const Coefficient& c);
  static bool scales_freely(const Form& f);

  // Returns the name of a value; a value without a name is computed by a statement.
  std::string named(const std::string& value);
  // Returns the name of a slot's value, or its number.
  std::string operand(std::uint32_t slot);
  std::string place_of(const Coefficient& c);
  std::string sum_text(Form f);
  std::string operation(const Instruction& in, const std::function<std::string(std::uint32_t)>& text);
  std::string constant_text(const Coefficient& c) const;
  std::string power(const std::string& x, const Rational& exponent) const;
  bool is_literal(std::uint32_t slot) const;
  std::string assigned(const std::string& name, const std::string& value, bool declare) const;
  std::string function_name(Function f) const;

  const RateFormulas& formulas_;
  Language language_;
  Tape tape_;
  bool time_ = false, used_sign_ = false;
  std::vector<Use> uses_;
  std::vector<std::string> name_;                        // names of arguments, literals, and slots that constants need
  std::vector<Form> forms_;                              // forms of slots that vary
  std::unordered_map<std::string, std::string> values_;  // the name of a computed text
  std::unordered_map<std::string, std::pair<std::string, Coefficient>>
      powers_;                                 // base and exponent of the values pow(x, n)
  std::map<Coefficient, std::size_t> places_;  // places of constants in c
  std::vector<Coefficient> constants_;
  std::vector<std::size_t> zeros_;  // roots that vanish
  std::string text_, constants_text_;
};

}  // namespace anholon::emit
