// Expressions as statements of C or Python from a tape: products of many factors share what they have in common, and what
// depends on parameters alone is computed apart, once for many calls.
//
// A factor that depends on parameters alone moves outwards through products and sums, and is multiplied with its like:
// k (a + m b) l, used once, is c0*a + c1*b with c0 = k l and c1 = k l m.
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

  // c[i] = …, of p.
  const std::string& constants() const { return constants_text_; }
  std::size_t constant_count() const { return constants_.size(); }
  // Their values for the parameters of the formulas.
  std::vector<double> default_constants() const;
  // out[i] = …, of t, x, lead, u and c; those that are zero at `sparse` are left out.
  std::string statements(bool sparse) const;
  // Whether the statements read an argument.
  bool reads(const std::string& argument) const { return text_.find(argument + "[") != std::string::npos; }
  bool reads_time() const { return time_; }
  bool used_sign() const { return used_sign_; }

 private:
  // A sum of products of whole powers of slots that do not vary, each with a rational factor.
  using Powers = std::map<std::uint32_t, long>;
  using Coefficient = std::map<Powers, Rational>;
  // A value that varies: the sum of coefficient times text.
  struct Term {
    std::string text;
    Coefficient coefficient;
  };
  using Form = std::vector<Term>;
  static const Coefficient kOne;
  // What a slot depends on and who reads it.
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
  // exp(n*log(x)) of a slot as pow(x, n); nullopt if it is none.
  std::optional<std::string> general_power(const Instruction& in);
  std::optional<std::pair<std::uint32_t, Coefficient>> logarithm(std::uint32_t slot) const;
  std::string power_of(const std::string& base, const Coefficient& exponent);
  Form scaled(std::uint32_t slot, const Coefficient& by);
  Term term_of(std::uint32_t slot);
  // Gives a slot this form. A form that several readers would each compute again becomes a named value.
  void set(std::uint32_t slot, Form f);
  Coefficient constant(std::uint32_t slot) const;
  Coefficient constant_power(std::uint32_t slot, long exponent) const;
  static Coefficient product(const Coefficient& a, const Coefficient& b);
  static bool is_sign(const Coefficient& c);
  static bool scales_freely(const Form& f);

  // The name of a value, which is computed by a statement where it has none.
  std::string named(const std::string& value);
  // The name of a slot's value, or its number.
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
  std::vector<std::string> name_;                        // of arguments, literals, and slots that constants need
  std::vector<Form> forms_;                              // of slots that vary
  std::unordered_map<std::string, std::string> values_;  // the name of what is computed
  std::unordered_map<std::string, std::pair<std::string, Coefficient>>
      powers_;                                 // base and exponent of the values pow(x, n)
  std::map<Coefficient, std::size_t> places_;  // of constants in c
  std::vector<Coefficient> constants_;
  std::vector<std::size_t> zeros_;  // roots that vanish
  std::string text_, constants_text_;
};

}  // namespace anholon::emit
