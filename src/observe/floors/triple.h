// A vector of space as numbers, and the force that given rates of a function tell.
#pragma once
#include <cmath>
#include <optional>
#include <vector>

namespace anholon {

struct Triple {
  double x = 0, y = 0, z = 0;
};
inline double dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm(const Triple& a) { return std::sqrt(dot(a, a)); }
inline Triple operator-(const Triple& a, const Triple& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Triple operator*(double s, const Triple& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Triple cross(const Triple& a, const Triple& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Numbers that are the same by their meaning come out of Taylor arithmetic exactly, or within a few roundings.
inline constexpr double kSameRate = 1e-12;

// An orthonormal basis of directions that may depend on each other.
std::vector<Triple> basis(const std::vector<Triple>& directions);
// The gradient of a function of a place that moves along `directions[a]` with coordinate a, where the function has the rate
// `rates[a]`: the vector in the span of the directions whose product with each of them is its rate. Returns nullopt if there
// is none, as the function depends on other things than the place.
std::optional<Triple> gradient_in_space(const std::vector<Triple>& directions, const std::vector<double>& rates);

}  // namespace anholon
