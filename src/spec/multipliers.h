// Formulas in which multipliers occur: lambda.NAME is a multiplier, and lambda.NAME' its rate; everything else means what it
// does elsewhere. Constraints are read before such formulas.
#pragma once
#include "spec/names.h"

namespace anholon {

class WithMultipliers final : public Names {
 public:
  WithMultipliers(Scope& scope, const Model& model) : scope_(scope), model_(model) {}

  Graph& graph() override { return scope_.graph(); }
  Value name(const std::string& name, Span span) override;
  bool call(const std::string& function, const std::vector<Value>& arguments, const Syntax& syntax, Value& result) override {
    return scope_.call(function, arguments, syntax, result);
  }
  Value member(const Value& object, const Syntax& s) override;
  std::vector<std::string> functions() const override { return scope_.functions(); }

 private:
  Scope& scope_;
  const Model& model_;
};

}  // namespace anholon
