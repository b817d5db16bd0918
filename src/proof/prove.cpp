#include "proof/prove.h"

#include <algorithm>

#include "base/stop.h"
#include "expr/normal.h"
#include "proof/generalize.h"
#include "proof/witness.h"

namespace anholon {

bool shown_zero(Expr e, Effort effort) {
  constexpr std::size_t kLong = 60;  // nodes
  const bool is_long = reachable({&e, 1}).size() > kLong;
  if (is_long)
    if (const Expr general = generalized(e); !(general == e) && proved_zero(general)) return true;
  return (!is_long || effort == Effort::full) && proved_zero(e);
}

namespace {

// Shows by algebra that a difference is zero, or finds a point at which it is not.
void decide(Difference& d, const Elimination& e, const Model& model, Effort effort, long bits) {
  const Expr x = d.expression();
  const bool likely = seems_zero(x);
  if ((likely || effort == Effort::full) && shown_zero(x, effort)) {
    d.verdict = Verdict::proved;
    return;
  }
  if (likely && effort == Effort::brief) return;
  WitnessSearch search = find_witness(d, e, model, bits);
  d.detail = search.detail;
  if (!search.witness) return;
  d.witness = std::move(search.witness);
  d.verdict = Verdict::refuted;
}

Verdict of_all(const std::vector<Difference>& list) {
  Verdict v = Verdict::proved;
  for (const Difference& d : list) {
    if (d.verdict == Verdict::refuted) return Verdict::refuted;
    if (d.verdict == Verdict::unknown) v = Verdict::unknown;
  }
  return v;
}

// Claims that Phi B = 0 on the manifold, and that the solved constraints are satisfied.
void kernel_claims(const Mechanics& M, const Elimination& e, long bits, std::vector<Difference>& out) {
  Graph& g = M.graph();
  const Model& model = *M.model;
  for (std::size_t k = 0; k < e.constraints.size(); ++k) {
    const std::string& name = model.constraints[e.constraints[k]].name;
    if (e.solved) {
      out.push_back({name + " solved", e.on(e.phi[k]), {}, {}, {}, {}});
      decide(out.back(), e, model, Effort::full, bits);
    }
    const Column row = e.on(put_masses(model, M.Phi[e.constraints[k]]));
    for (std::size_t a = 0; a < e.free.names.size(); ++a) {
      Difference d{name + ", " + e.free.names[a], g.zero(), {}, {}, {}, {}};
      for (std::size_t s = 0; s < row.size(); ++s)
        if (!is_zero(row[s]) && !is_zero(e.g_by_u()[s][a])) d.right.push_back({-row[s], e.g_by_u()[s][a]});
      decide(d, e, model, Effort::full, bits);
      out.push_back(std::move(d));
    }
  }
}

void pivot_claims(const Mechanics& M, const Elimination& e, long bits, std::vector<Difference>& out) {
  for (Expr pivot : e.pivots()) {
    const Expr p = e.on(pivot);
    if (std::any_of(out.begin(), out.end(), [&](const Difference& d) { return d.left == p; })) continue;
    Difference d{"pivot " + std::to_string(out.size() + 1), p, {}, {}, {}, {}};
    WitnessSearch search = find_witness(d, e, *M.model, bits);
    d.witness = std::move(search.witness);
    d.verdict = d.witness ? Verdict::proved : Verdict::unknown;
    d.detail = search.detail;
    out.push_back(std::move(d));
  }
}

// Returns the equations of another mechanics in which the multipliers of constraints that the elimination leaves out are
// zero: these constraints follow from the others, and so do the reactions that they would have.
Column without_redundant(const Column& equations, const Elimination& e, const Model& model) {
  if (e.constraints.size() == model.constraints.size()) return equations;
  Graph& g = *model.graph;
  return substitute(equations, [&](NodeId id) {
    const Node& n = g.node(id);
    const bool left_out = n.kind == Kind::multiplier &&
                          std::find(e.constraints.begin(), e.constraints.end(), n.index) == e.constraints.end();
    return left_out ? g.zero() : Expr{};
  });
}

FormProof against_routh(const Mechanics& M, const Formulation& form, const Equations& equations, const Elimination& e,
                        Effort effort, long bits) {
  FormProof proof{&form, Verdict::unknown, {}};
  const Model& model = *M.model;
  const Column residual = equations.left - equations.right;
  if (form.unknowns == Unknowns::multipliers) {
    const Column routh = lagrange_operator(M) - right_side(M);
    for (std::size_t a = 0; a < residual.size(); ++a) {
      Difference d{model.coordinates[a].name, residual[a], {{M.graph().one(), routh[a]}}, {}, {}, {}};
      decide(d, e, model, effort, bits);
      proof.differences.push_back(std::move(d));
    }
  } else {
    const Column a = e.on(lagrange_operator(M) - forces(M));
    const Column own = form.unknowns == Unknowns::variational ? without_redundant(residual, e, model) : residual;
    const bool along =
        // The projection of n equations without multipliers along the constraints is taken.
        own.size() == M.q.size() && !e.constraints.empty();
    const Column contracted = along ? e.contract(own) : own;
    for (std::size_t nu = 0; nu < contracted.size(); ++nu) {
      Difference d{e.free.names[nu], contracted[nu], {}, {}, {}, {}};
      for (std::size_t s = 0; s < a.size(); ++s)
        if (!is_zero(e.g_by_u()[s][nu])) d.right.push_back({e.g_by_u()[s][nu], a[s]});
      decide(d, e, model, effort, bits);
      proof.differences.push_back(std::move(d));
    }
  }
  proof.verdict = of_all(proof.differences);
  return proof;
}

}  // namespace

const Elimination& Eliminations::of(const Formulation& form) const {
  return form.unknowns == Unknowns::quasi_velocities ? quasi : coordinates;
}

FormProof prove_form(const Mechanics& M, const Formulation& form, const EquationsOf& equations,
                     const std::vector<Eliminations>& eliminations, const ProofOptions& options) {
  FormProof proof;
  for (const Effort effort : {Effort::brief, Effort::full})
    for (std::size_t k = 0; k < eliminations.size(); ++k) {
      const Elimination& e = eliminations[k].of(form);
      proof = against_routh(M, form, equations(M, e), e, effort, options.bits());
      proof.elimination = k;
      if (proof.verdict != Verdict::unknown) return proof;
    }
  return proof;
}

Proof prove(const Mechanics& M, const std::vector<const Formulation*>& forms,
            const std::vector<Eliminations>& eliminations, const ProofOptions& options) {
  Proof proof;
  try {
    std::vector<const Elimination*> used;
    for (const Formulation* form : forms) {
      if (options.progress) options.progress(*form);
      proof.forms.push_back(prove_form(M, *form, form->equations, eliminations, options));
      const Elimination* e = &eliminations[proof.forms.back().elimination].of(*form);
      if (form->unknowns != Unknowns::multipliers && std::find(used.begin(), used.end(), e) == used.end())
        used.push_back(e);
    }
    for (const Elimination* e : used) {
      kernel_claims(M, *e, options.bits(), proof.kernel);
      pivot_claims(M, *e, options.bits(), proof.pivots);
    }
  } catch (const StopRequested&) {
    proof.stopped = true;
    proof.compared = proof.forms.size();
    for (std::size_t k = proof.forms.size(); k < forms.size(); ++k)
      proof.forms.push_back({forms[k], Verdict::unknown, {}});
    return proof;
  }
  proof.compared = proof.forms.size();
  return proof;
}

Verdict Proof::with_routh(std::size_t a) const {
  const bool tangents = !stopped && of_all(kernel) == Verdict::proved;
  const bool rests_on_tangents = forms[a].form->unknowns != Unknowns::multipliers;
  return tangents || !rests_on_tangents ? forms[a].verdict : Verdict::unknown;
}

Verdict Proof::between(std::size_t a, std::size_t b) const {
  const Verdict va = with_routh(a), vb = with_routh(b);
  if (va == Verdict::proved && vb == Verdict::proved) return Verdict::proved;
  if (va == Verdict::refuted && vb == Verdict::proved) return Verdict::refuted;
  if (va == Verdict::proved && vb == Verdict::refuted) return Verdict::refuted;
  return Verdict::unknown;
}

}  // namespace anholon
