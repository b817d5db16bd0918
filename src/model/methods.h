// The methods by which motions are computed, one row each: what they can do, and what they refuse.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace anholon {

// In the order of the table. `automatic` is the method that takes the fewest operations.
enum class Method : std::uint8_t { automatic, taylor, runge_kutta, bdf, cvode, ida };

struct MethodInfo {
  // The motion itself goes by a method of --method; those of --integrator give a second opinion on its rows.
  enum class Use : std::uint8_t { motion, second_opinion, both };
  Use use;
  const char* name;      // as the option accepts it
  const char* title;     // "Runge-Kutta 8"
  const char* citation;  // key of refs.bib; empty if every page cites it
  bool wide_numbers;     // computes in numbers wider than double
  bool resumes;          // a saved run goes on with the same bits
  bool encloses;         // has a dense output that can be enclosed in balls
  bool has_order;        // its order can be chosen
  int order;             // of its steps; 0: it follows from the tolerance
  double least_tolerance;
  bool raises_tolerance;  // to the least one; else a smaller one is refused
  // Whether a tolerance is one of its own; a decimal that was rounded down to a double counts as itself.
  bool serves(double tolerance) const { return tolerance >= least_tolerance * (1 - 1e-9); }
};
const MethodInfo& info(Method method);
const char* name(Method method);

// The names with this use, or with both: "auto", "taylor", "rk", "bdf" for motions.
const std::vector<std::string>& method_names(MethodInfo::Use use);
// Returns nullopt if no method with this use has the name.
std::optional<Method> find_method(const std::string& name, MethodInfo::Use use = MethodInfo::Use::motion);

// What is asked of a motion beside its method.
struct MethodDemands {
  bool wide_numbers = false, saved = false, enclosed = false, order = false;
  double tolerance = 1;
};

struct MethodRefusal {
  enum class Of : std::uint8_t { numbers, saving, enclosing, order, tolerance } of;
  std::string why;  // goes on from "the method 'rk' …"
};
// The first demand that the method cannot meet; nullopt if it meets all.
std::optional<MethodRefusal> refusal(const MethodInfo& method, const MethodDemands& demands);

}  // namespace anholon
