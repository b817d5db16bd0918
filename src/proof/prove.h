// Proofs that forms of the equations of motion agree, and that others do not (theory: proof).
//
// Every form is compared with Routh's equations a = E - G - N [L 2.7]:
//   with multipliers      each residual is that of Routh's equations, identically in all derivatives;
//   without               each residual is sum_s B_s,nu a_s, where B spans the kernel of dphi/dq^(m) on the manifold of the
//                         constraints. N drops out, and B^T a = 0 means that a is a combination of constraint rows: the
//                         multipliers exist, and the form has the solutions of Routh's equations.
// Two forms that agree with Routh's agree with each other; if one does and the other does not, they differ.
//
// A proof states that the forms follow from each other given the same T, forces and constraints. It does not state that
// these describe the machine.
#pragma once
#include <functional>

#include "formulation/formulation.h"
#include "proof/checker/certificate.h"
#include "proof/difference.h"

namespace anholon {

// The effort of a proof: `brief` tries only the general form of a long expression, which is far shorter; `full` tries
// everything.
enum class Effort : std::uint8_t { brief, full };
// True if algebra (expr/normal.h) shows that e, or the general statement behind it, is zero.
bool shown_zero(Expr e, Effort effort);

struct FormProof {
  const Formulation* form = nullptr;
  Verdict verdict = Verdict::unknown;
  std::vector<Difference> differences;
  std::size_t elimination = 0;  // index of the elimination that was used
};

struct Proof {
  std::vector<FormProof> forms;    // comparisons with Routh's equations
  std::vector<Difference> kernel;  // B spans the kernel, and the solved constraints satisfy the constraints
  std::vector<Difference> pivots;  // no divisor is identically zero
  // True if a stop request (base/stop.h) ended the proof: forms that were not compared are unknown, and so are all
  // pairs that need the tangents of the constraints.
  bool stopped = false;
  std::size_t compared = 0;  // the number of forms that were compared, the first ones
  // Returns the verdict on one form and Routh's equations. The comparison of a form without multipliers counts only if
  // the tangents of the constraints are proved; without them it is unknown.
  Verdict with_routh(std::size_t a) const;
  Verdict between(std::size_t a, std::size_t b) const;
};

struct Eliminations {
  Elimination coordinates, quasi;
  const Elimination& of(const Formulation& form) const;
};

struct ProofOptions {
  std::function<void(const Formulation&)> progress;
  int digits = 308;  // maximal precision of the balls at witnesses: a smaller difference is not distinguished from zero
  long bits() const { return static_cast<long>(digits * 3.3219281) + 1; }
};

// Compares one form's equations with Routh's. Several equivalent eliminations may be offered (with constraints solved
// or not): a form is proved with the first one that succeeds.
using EquationsOf = std::function<Equations(const Mechanics&, const Elimination&)>;
FormProof prove_form(const Mechanics& M, const Formulation& form, const EquationsOf& equations,
                     const std::vector<Eliminations>& eliminations, const ProofOptions& options = {});
// Compares all forms. A stop request ends the proof and keeps the comparisons that are complete.
Proof prove(const Mechanics& M, const std::vector<const Formulation*>& forms,
            const std::vector<Eliminations>& eliminations, const ProofOptions& options = {});

// Adds to the hypotheses which cases were applied to the file of the model, and which values were given beside it
// ("m=2").
void add_reading(Certificate& c, const std::vector<std::string>& cases, const std::vector<std::string>& values);

// Returns all results, for an independent checker.
Certificate certificate(const Mechanics& M, const Proof& proof, const Eliminations& eliminations,
                        const std::string& program, const std::string& source_hash);

}  // namespace anholon
