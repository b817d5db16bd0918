// The checker of certificates. It uses only the numbers and the format: it simplifies no expression, and it shares no
// code with the program that wrote the certificate.
//
// A verified certificate means that the forms named in it are equivalent, given the same kinetic energy, forces and
// constraints. Each equation of one form is the stated combination of the equations of the other, as an identity in all
// symbols. It does not prove that the model describes the machine, nor that its energy, forces, constraints and the
// postulate on reactions were translated to nodes correctly.
//
// "zero" is tested modulo primes at random points (modular.h), with a bound on the probability that a false
// claim passes. The points depend on the seed and on the text of the certificate, so no certificate can be fitted to
// them. At some real points the difference is enclosed as well: a claim is called contradicted only if a real point
// shows it. "not zero" is a proof: at a rational point, or at the only root, proved to exist, of the witness's
// equations.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "proof/checker/certificate.h"

namespace anholon {

struct VerifyOptions {
  int points = 6;  // modulo each of two primes; more if signs have to be tried
  std::uint64_t seed = 0;
  int digits = 308;  // maximal precision of the balls at witnesses
};

enum class Finding : std::uint8_t { confirmed, contradicted, unchecked };
const char* name(Finding f);

struct ClaimFinding {
  Finding finding = Finding::unchecked;
  bool proved = false;     // confirmed with certainty
  double log2_chance = 0;  // confirmed: log2 of a bound on the probability that it is false
  std::string detail;      // contradicted: the point and the value; unchecked: why
};

struct Verification {
  std::vector<ClaimFinding> claims;  // as in the certificate
  bool all_confirmed() const;        // true if there are claims, and all are confirmed
};

Verification verify(const Certificate& c, const VerifyOptions& options = {});

}  // namespace anholon
