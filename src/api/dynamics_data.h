// The data behind Dynamics: a function of the rates, its formulas, and the functions for other exponents.
#pragma once
#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <mutex>

#include "anholon/dynamics.h"
#include "api/data.h"
#include "dynamics/exponent_values.h"
#include "dynamics/pieces.h"
#include "dynamics/rate_formulas_of.h"

namespace anholon::v1 {

constexpr std::size_t kStatesAtOnce = 64;  // states that one thread takes at once, for outputs and derivatives

struct Dynamics::Data {
  System system;
  DynamicsOptions options;
  inner::Scenario opened;               // a scenario with outputs of its own, or with inputs as parameters
  const inner::Scenario* scenario;      // that of the system, or the opened one
  std::vector<std::string> inputs;      // names
  std::vector<inner::NodeId> formulas;  // formulas of the inputs
  std::vector<inner::NodeId> open;      // the same, in terms of the parameters that are inputs
  std::unique_ptr<const inner::Dynamics> function;
  std::string obstacle;  // why there are no independent velocities
  std::vector<StateName> states;
  inner::ExponentValues exponents;       // of the model; none in a function for other exponents
  inner::ExponentValues::Values put_in;  // the parameters whose values stand in whole exponents as numbers

  // Returns the formulas, which are made at the first call.
  const inner::FormulaValues& values() const {
    std::call_once(once_, [&] {
      inner::Workspace own(*scenario);
      values_ = std::make_unique<const inner::FormulaValues>(inner::rate_formulas_of(own, *function, formulas, open));
    });
    return *values_;
  }

  // The states of one call: number i of state k is at i * count + k.
  struct Batch {
    double t;
    std::span<const double> x;
    std::size_t count;
    const Dynamics::Given& given;
    // Returns the inputs or parameters of state k, of which there are `size`; if `all` holds no more than `size`
    // numbers, all states share them.
    std::vector<double> of_state(std::span<const double> all, std::size_t size, std::size_t k) const {
      if (all.size() <= size) return {all.begin(), all.end()};
      std::vector<double> some(size);
      for (std::size_t i = 0; i < size; ++i) some[i] = all[i * count + k];
      return some;
    }
  };

  // The points of some states, with their parameters and the leading derivatives.
  struct Points {
    std::vector<std::vector<double>> x, parameters;
    std::vector<double> lead;
    std::vector<inner::FormulaPoint> at;
  };
  // Returns the points of the states from..to of a batch.
  Points points(const Batch& batch, std::size_t from, std::size_t to, bool with_lead) const {
    const std::size_t n = states.size(), some = to - from;
    Points out;
    std::vector<double> x_of(n * some), u_of(inputs.size() * some), p_of(batch.given.p.empty() ? 0 : p_size() * some);
    for (std::size_t k = from; k < to; ++k) {
      std::vector<double> x(n);
      for (std::size_t i = 0; i < n; ++i) x_of[i * some + k - from] = x[i] = batch.x[i * batch.count + k];
      const std::vector<double> p = batch.of_state(batch.given.p, p_size(), k);
      const std::vector<double> u = given_inputs(batch.t, x, {batch.of_state(batch.given.u, inputs.size(), k), p});
      for (std::size_t i = 0; i < u.size(); ++i) u_of[i * some + k - from] = u[i];
      for (std::size_t i = 0; i < p.size(); ++i) p_of[i * some + k - from] = p[i];
      std::vector<double> all;
      for (const long double value : function->parameters({u, p}, 1, 0)) all.push_back(static_cast<double>(value));
      out.x.push_back(std::move(x)), out.parameters.push_back(std::move(all));
    }
    std::size_t unknowns = 0;
    if (with_lead && !function->minimal()) {
      const bool common = batch.given.u.size() == inputs.size() && batch.given.p.size() <= p_size();
      out.lead = function->leading(batch.t, x_of.data(), some,
                                   common ? inner::InputsAndParameters{batch.given.u, batch.given.p}
                                          : inner::InputsAndParameters{u_of, p_of});
      unknowns = out.lead.size() / some;
    }
    for (std::size_t k = 0; k < some; ++k)
      out.at.push_back({batch.t, out.x[k], out.parameters[k], std::span(out.lead).subspan(k * unknowns, unknowns)});
    return out;
  }
  // Returns the inputs u as given, or by the formulas of the model if none are given.
  std::vector<double> given_inputs(double t, const std::vector<double>& x, const Given& given) const {
    if (!given.u.empty() || inputs.empty()) return {given.u.begin(), given.u.end()};
    return values().inputs({t, x, parameters(given.p), {}});
  }
  std::size_t p_size() const { return function->free_parameters().size(); }
  // Returns the values of all parameters of the model.
  std::vector<double> parameters(std::span<const double> p) const {
    std::vector<double> all;
    for (const long double value : function->parameters({{}, p}, 1, 0)) all.push_back(static_cast<double>(value));
    return all;
  }

  void rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates, const Given& given) const;

  // Calls f(first, points) with the points of pieces of a batch, on several threads if there are many. The numbers of a
  // state do not depend on the other states.
  template <class F>
  void in_points(const Batch& batch, bool with_lead, const F& f) const {
    values();
    inner::in_pieces(batch.count, kStatesAtOnce, [&](const inner::NextPiece& next) {
      while (const std::optional<std::size_t> from = next()) {
        const Points some = points(batch, *from, std::min(batch.count, *from + kStatesAtOnce), with_lead);
        f(*from, std::span<const inner::FormulaPoint>(some.at));
      }
    });
  }

  // Returns the function for the exponents that these parameters give: this one, or one that is made at the first call
  // for them. Returns nullptr if there is none. p: empty, or that of one state.
  const Data* at(std::span<const double> p) const;
  // Returns the function in which these parameters stand in whole exponents as numbers, and all others as parameters;
  // nullptr if there is none.
  const Data* for_exponents(const inner::ExponentValues::Values& wanted) const;
  // Returns the text of the formulas in which no exponent is put in, which hold for all parameters. Throws
  // std::domain_error if there are none.
  std::string text_with_exponents(const std::function<std::string(const inner::RateFormulas&)>& text) const;

  // Computes `rows` numbers for each state of a batch: calls f(data, batch, out) with the function for the exponents of
  // the states, number i of state k at out[i * count + k], for the states of each function together. The numbers of
  // states without a function are NaN.
  template <class F>
  void by_exponents(const Batch& all, std::size_t rows, std::span<double> out, const F& f) const {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!exponents.any() || all.given.p.size() <= p_size()) {
      const Data* data = at(all.given.p);
      return data ? f(*data, all, out) : std::fill(out.begin(), out.end(), none);
    }
    std::vector<std::pair<const Data*, std::vector<std::size_t>>> groups;
    for (std::size_t k = 0; k < all.count; ++k) {
      const Data* data = at(all.of_state(all.given.p, p_size(), k));
      auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return g.first == data; });
      if (group == groups.end()) group = groups.insert(groups.end(), {data, {}});
      group->second.push_back(k);
    }
    for (const auto& [data, states_of_it] : groups) {
      const std::vector<std::size_t>& of = states_of_it;
      const auto some = [&](std::span<const double> numbers, std::size_t size) {
        if (numbers.size() <= size) return std::vector<double>(numbers.begin(), numbers.end());
        std::vector<double> list;
        for (std::size_t i = 0; i < size; ++i)
          for (const std::size_t k : of) list.push_back(numbers[i * all.count + k]);
        return list;
      };
      std::vector<double> values(rows * of.size(), none), x;
      for (std::size_t i = 0; i < states.size(); ++i)
        for (const std::size_t k : of) x.push_back(all.x[i * all.count + k]);
      const std::vector<double> u = some(all.given.u, inputs.size()), p = some(all.given.p, p_size());
      const Given given{u, p, all.given.nan_if_stopped};
      if (data) f(*data, Batch{all.t, x, of.size(), given}, std::span<double>(values));
      for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t j = 0; j < of.size(); ++j) out[i * all.count + of[j]] = values[i * of.size() + j];
    }
  }

 private:
  static constexpr std::size_t kMostExponents = 64;  // the most functions for other exponents
  // The same as for_exponents. REQUIRES: mutex_ is locked.
  const Data* found(const inner::ExponentValues::Values& wanted) const;
  // Derives the function for these values. Returns nullptr if it has no solution at the start, or another state.
  // REQUIRES: mutex_ is locked.
  std::shared_ptr<const Data> with_exponents(const inner::ExponentValues::Values& values) const;
  // True if another function has the independent velocities of this one. REQUIRES: mutex_ is locked.
  bool same_velocities(const Data& made) const;

  mutable std::once_flag once_;
  mutable std::unique_ptr<const inner::FormulaValues> values_;
  mutable std::mutex mutex_;  // of the following
  mutable std::map<inner::ExponentValues::Values, std::shared_ptr<const Data>> others_;
  mutable std::unique_ptr<const inner::RateFormulas> with_exponents_;

 public:
  Data(System of, DynamicsOptions wanted)
      : system(std::move(of)), options(std::move(wanted)), scenario(&system.data().scenario) {}
};

}  // namespace anholon::v1
