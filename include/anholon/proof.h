// Proofs that forms of the equations of motion agree.  (theory: proof)
#pragma once
#include "anholon/model.h"

namespace anholon::v1 {

enum class Verdict : std::uint8_t {
  unknown,  // neither a proof nor a point that refutes was found within the limits
  proved,
  refuted,
};

struct FormVerdict {
  std::string form;
  Verdict verdict = Verdict::unknown;  // against Routh's equations
  std::string detail;                  // the first difference that is not proved to vanish
};

struct Proof {
  std::vector<FormVerdict> forms;
  // A certificate in JSON, which `verify` and `anholon verify` check without the prover; empty if the proof was stopped.
  std::string certificate;
  // A StopRequest ended it. Forms that it did not reach are `unknown`, with "stopped" as their detail, and so are forms
  // without multipliers, as the tangents of the constraints are shown last.
  bool stopped = false;
  // Whether the proof is complete and all its forms are proved.
  ANHOLON_API bool all_proved() const;
};

// Compares forms (all that apply if the list is empty) with Routh's equations. Errors: unknown forms (diagnostics).
ANHOLON_API Result<Proof> prove(const Model& model, const std::vector<std::string>& forms = {});

struct Verification {
  std::size_t claims = 0, confirmed = 0;
  bool all_confirmed() const { return claims == confirmed; }
};
// Checks a certificate, sharing nothing with the prover but numbers. Errors: a text that is no certificate.
ANHOLON_API Result<Verification> verify(const std::string& certificate);

}  // namespace anholon::v1
