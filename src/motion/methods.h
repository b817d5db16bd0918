// The methods by which motions are computed, one row each: what they can do, and what they refuse.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"

namespace anholon {

// By which a motion goes; automatic: the one that takes the fewest operations.
enum class Method : std::uint8_t { automatic, taylor, runge_kutta, bdf };
const std::vector<std::string>& method_names();  // auto, taylor, rk, bdf
const char* name(Method method);
std::optional<Method> find_method(const std::string& name);

// A smaller tolerance would take BDF, of order 5 at most, for ever.
inline constexpr double kLeastBdfTolerance = 1e-10;
// The round-off of f in double.
inline constexpr double kLeastRungeKuttaTolerance = 1e-14;

struct MethodInfo {
  const char* name;      // as --method or --integrator accepts it
  const char* title;     // "Runge-Kutta 8"
  const char* citation;  // key of refs.bib; empty if every page cites it
  bool wide_numbers;     // computes in numbers wider than double
  bool resumes;          // a saved run goes on with the same bits
  bool encloses;         // has a dense output that can be enclosed in balls
  bool has_order;        // its order can be chosen
  double least_tolerance;
  bool raises_tolerance;  // to the least one; else a smaller one is refused
};
const MethodInfo& info(Method method);
// Of SUNDIALS, which gives a second opinion.
const MethodInfo& info(Integrator integrator);

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
