// Expressions as statements of C or Python, one operation each, from a tape: products of many factors share what they have in
// common, and what depends on parameters alone is computed apart, once for many calls.
#pragma once
#include <string>
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
  std::string text(std::uint32_t slot) const;
  std::string operation(std::uint32_t slot);
  std::string power(const std::string& x, const Rational& exponent) const;
  template <class F>
  void for_each_operand(std::uint32_t slot, const F& f) const;
  bool inline_number(std::uint32_t slot) const;
  std::string assigned(const std::string& name, const std::string& value, bool declare) const;
  std::string function_name(Function f) const;

  const RateFormulas& formulas_;
  Language language_;
  Tape tape_;
  bool time_ = false, used_sign_ = false;
  std::vector<std::string> name_;         // of each slot that is needed
  std::vector<std::uint32_t> constants_;  // slots
  std::string text_, constants_text_;
};

}  // namespace anholon::emit
