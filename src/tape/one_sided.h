// Formulas and their partial derivatives on both sides of a border between branches.
//
// min, max, abs, sign and piecewise change their branch where a condition passes zero, tables change their polynomial at a
// knot. At such a border a tape computes one branch, for each condition by itself. A formula has a derivative there if it
// and its partial derivatives are the same on both sides of each border; each border is then crossed by itself, by a shift
// of its condition.
#pragma once
#include <algorithm>
#include <optional>
#include <string>

#include "expr/diff.h"
#include "tape/bind.h"

namespace anholon {

// A condition at whose borders formulas change: it passes zero, or a knot of tables.
struct Branch {
  Expr condition;
  std::string table;            // the name of the first table; empty: min, max, abs, sign or piecewise
  std::vector<Rational> knots;  // ascending; only 0 if there is no table
  Rational shift;               // leads beyond a border, and not to the next one
};

class OneSided {
 public:
  struct Partial {
    std::size_t row, column;
  };
  OneSided() = default;
  // Conditions are shifted by parameters from number `parameters` on, the number of parameters of the model.
  OneSided(const Column& es, const Column& by, std::size_t parameters);

  const std::vector<Branch>& branches() const { return branches_; }
  const std::vector<Partial>& partials() const { return partials_; }

  // The values of the formulas, then of the partial derivatives, on both sides of a border.
  template <Scalar N>
  struct Sides {
    std::size_t branch;
    std::vector<N> below, above;
  };
  // Returns the sides of the borders on which the point lies, up to `near`. `set` sets the inputs of a machine.
  template <Scalar N, class Set>
  std::vector<Sides<N>> sides(std::vector<N> parameters, const N& near, const Set& set) const {
    std::vector<Sides<N>> out;
    if (branches_.empty()) return out;
    const std::size_t first = parameters.size();
    Machine<N> conditions(conditions_, 0, parameters);
    set(conditions);
    conditions.evaluate();
    parameters.resize(first + branches_.size(), N(0));
    for (std::size_t k = 0; k < branches_.size(); ++k) {
      const Branch& b = branches_[k];
      const N value = conditions.value(k);
      if (std::none_of(b.knots.begin(), b.knots.end(), [&](const Rational& knot) {
            const N gap = value - from_rational<N>(knot);
            return !(gap > near) && !(gap < -near);
          }))
        continue;
      const auto shifted = [&](const N& shift) {
        parameters[first + k] = shift;
        Machine<N> machine(tape_, 0, parameters);
        set(machine);
        machine.evaluate();
        std::vector<N> values;
        for (std::size_t i = 0; i < tape_.roots.size(); ++i) values.push_back(machine.value(i));
        return values;
      };
      const N shift = from_rational<N>(b.shift);
      out.push_back({k, shifted(-shift), shifted(shift)});
      parameters[first + k] = N(0);
    }
    return out;
  }

 private:
  std::vector<Branch> branches_;
  std::vector<Partial> partials_;
  Tape tape_, conditions_;
};

}  // namespace anholon
