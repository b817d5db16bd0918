// A vector of space as numbers, and the gradient of a function with given rates.
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

// Equal numbers come out of Taylor arithmetic exactly, or equal up to a few roundings.
inline constexpr double kSameRate = 1e-12;

// An orthonormal basis of directions that may be linearly dependent.
std::vector<Triple> basis(const std::vector<Triple>& directions);
// The gradient of a function of a place. The place moves along `directions[a]` with coordinate a, and the function has
// the rate `rates[a]`; the gradient is the vector in the span of the directions whose product with each of them is its
// rate. Returns nullopt if there is none, because the function depends on other things than the place.
std::optional<Triple> gradient_in_space(const std::vector<Triple>& directions, const std::vector<double>& rates);

}  // namespace anholon
