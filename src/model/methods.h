// The methods by which motions are computed, one row each: what they can do, and what they refuse.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace anholon {

// The methods, in the order of the table. `automatic` chooses the method that takes the fewest operations.
enum class Method : std::uint8_t { automatic, taylor, runge_kutta, bdf, cvode, ida };

struct MethodInfo {
  // `motion` methods, named by --method, compute the motion; `second_opinion` methods, named by --integrator, check its
  // rows.
  enum class Use : std::uint8_t { motion, second_opinion, both };
  Use use;
  const char* name;      // the name that the option accepts
  const char* title;     // "Runge-Kutta 8"
  const char* citation;  // key of refs.bib; empty if every page cites it
  bool wide_numbers;     // computes in numbers wider than double
  bool resumes;          // a saved run is continued with the same bits
  bool encloses;         // has a dense output that can be enclosed in balls
  bool has_order;        // true if the order can be chosen
  int order;             // order of the steps; 0: the tolerance determines it
  double least_tolerance;
  bool raises_tolerance;  // a smaller tolerance is raised to the least one; else it is refused
  // True if the method serves the tolerance. A decimal that was rounded down to a double is accepted as least
  // tolerance.
  bool serves(double tolerance) const { return tolerance >= least_tolerance * (1 - 1e-9); }
};
const MethodInfo& info(Method method);
const char* name(Method method);

// Returns the names of the methods with this use, or with both uses: "auto", "taylor", "rk", "bdf" for motions.
const std::vector<std::string>& method_names(MethodInfo::Use use);
// Returns nullopt if no method with this use has the name.
std::optional<Method> find_method(const std::string& name, MethodInfo::Use use = MethodInfo::Use::motion);

// The demands on a motion besides its method.
struct MethodDemands {
  bool wide_numbers = false, saved = false, enclosed = false, order = false;
  double tolerance = 1;
};

struct MethodRefusal {
  enum class Of : std::uint8_t { numbers, saving, enclosing, order, tolerance } of;
  std::string why;  // continues "the method 'rk' …"
};
// Returns the first demand that the method cannot meet; nullopt if it meets all demands.
std::optional<MethodRefusal> refusal(const MethodInfo& method, const MethodDemands& demands);

}  // namespace anholon
