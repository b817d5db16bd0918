// Converts expressions to the straight-line program of a certificate.
#include <set>
#include <unordered_map>

#include "base/assert.h"
#include "mechanics/notes_on_rank.h"
#include "print/print.h"
#include "proof/enclose.h"
#include "proof/prove.h"

namespace anholon {

namespace {

using Index = Certificate::Index;

class Exporter {
 public:
  Exporter(Certificate& c, Graph& g, SymbolNames names) : c_(c), g_(g), names_(std::move(names)) {
    names_.defined.clear();
  }

  Index node(Expr e) {
    for (NodeId id : reachable({&e, 1}))
      if (!index_.count(id)) index_.emplace(id, add(id));
    return index_.at(e.id);
  }

  Index symbol(NodeId id) {
    const auto [it, fresh] = symbol_.try_emplace(id, static_cast<Index>(c_.symbols.size()));
    if (fresh) {
      // Two symbols may be printed alike, for example two branching functions whose long formulas are shortened.
      const std::string name = print(Expr{&g_, id}, names_, Format::text);
      std::string own = name;
      for (int k = 2; !used_.insert(own).second; ++k) own = name + " #" + std::to_string(k);
      c_.symbols.push_back(own);
    }
    return it->second;
  }

  void claim(Certificate::ClaimKind kind, const std::string& a, const std::string& b, const Difference& all) {
    Certificate::Claim claim{kind, a, b, all.component, 0, {}, {}};
    const bool at_witness = !claim.says_zero() && all.witness;
    const Difference d = at_witness ? on_branches_of_witness(all) : all;
    claim.left = node(d.left);
    for (const auto& [coefficient, term] : d.right) claim.right.push_back({node(coefficient), node(term)});
    if (at_witness) claim.witness = witness(*d.witness);
    c_.claims.push_back(std::move(claim));
  }

  // True if a branching function was replaced by its branch at a witness.
  bool took_branches() const { return took_branches_; }

 private:
  Certificate::Witness witness(const WitnessPoint& w) {
    Certificate::Witness out;
    for (const auto& [s, value] : w.values) out.values.push_back({symbol(s.id), value});
    for (const WitnessPoint::Enclosed& e : w.enclosed)
      out.enclosed.push_back({symbol(e.symbol.id), e.midpoint, e.radius});
    for (Expr e : w.equations) out.equations.push_back(node(e));
    return out;
  }

  // Returns the difference with branching functions replaced by their branches at its witness, because the checker
  // knows no other branching functions than its own.
  Difference on_branches_of_witness(Difference d) {
    constexpr slong kBits = 1024;
    const BallScope precision(kBits);
    BallPoint at;
    for (const auto& [s, value] : d.witness->values) at.emplace(s.id, Ball(value));
    for (const WitnessPoint::Enclosed& e : d.witness->enclosed) at.emplace(e.symbol.id, Ball(e.midpoint, e.radius));
    Column all = {d.left};
    for (const auto& [coefficient, term] : d.right) all.insert(all.end(), {coefficient, term});
    all.insert(all.end(), d.witness->equations.begin(), d.witness->equations.end());
    const Column own = on_branches(all, at);
    took_branches_ = took_branches_ || own != all;
    std::size_t k = 0;
    d.left = own[k++];
    for (auto& [coefficient, term] : d.right) coefficient = own[k++], term = own[k++];
    for (Expr& e : d.witness->equations) e = own[k++];
    return d;
  }

  Index add(NodeId id) {
    const Node& n = g_.node(id);
    Certificate::Node out;
    const auto terms = [&](std::span<const Term> from) {
      for (const Term& t : from) out.terms.push_back({g_.rational(t.weight), index_.at(t.node)});
    };
    switch (n.kind) {
    case Kind::number:
      out.operation = Certificate::Operation::number;
      out.value = g_.value(id);
      break;
    case Kind::pi:
      out.operation = Certificate::Operation::pi;
      break;
    case Kind::sum:
      out.operation = Certificate::Operation::sum;
      terms(g_.summands(id));
      break;
    case Kind::product:
      out.operation = Certificate::Operation::product;
      terms(g_.terms(id));
      break;
    case Kind::function:
      out.operation = Certificate::Operation::function;
      out.function = info(static_cast<Function>(n.index)).name;
      out.terms.push_back({1, index_.at(g_.terms(id)[0].node)});
      break;
    case Kind::atan2:
      out.operation = Certificate::Operation::atan2;
      for (const Term& t : g_.terms(id)) out.terms.push_back({1, index_.at(t.node)});
      break;
    case Kind::time:
    case Kind::jet:
    case Kind::parameter:
    case Kind::mass:
    case Kind::multiplier:
    case Kind::given:
    case Kind::quasi:
    case Kind::state:
    case Kind::control:
    // A branching function is a symbol: a proof uses only that equal arguments give equal values.
    case Kind::select:
    case Kind::lookup:
      out.operation = Certificate::Operation::symbol;
      out.symbol = symbol(id);
      break;
    }
    c_.nodes.push_back(std::move(out));
    return static_cast<Index>(c_.nodes.size() - 1);
  }

  Certificate& c_;
  Graph& g_;
  SymbolNames names_;
  std::unordered_map<NodeId, Index> index_, symbol_;
  std::set<std::string> used_;  // names of symbols
  bool took_branches_ = false;
};

std::string list_of(const Model& model, const std::vector<std::size_t>& which) {
  std::string list;
  for (std::size_t a : which) list += (list.empty() ? "" : ", ") + model.coordinates[a].name;
  return list;
}

void hypotheses(const Mechanics& M, const Proof& proof, const Eliminations& eliminations, Certificate& c) {
  const Model& model = *M.model;
  const Elimination& e = eliminations.coordinates;
  c.hypotheses.push_back("T, the forces and the constraints are those of the model; masses are frozen symbols in every "
                         "derivative of T and S");
  if (e.asked) c.hypotheses.push_back("the forms of order m are taken with m = " + std::to_string(e.asked));
  if (e.constraints.empty()) {
    c.hypotheses.push_back("there are no constraints");
    return;
  }
  std::string names, kept;
  for (std::size_t r : e.constraints) {
    const Constraint& constraint = model.constraints[r];
    std::string& list = constraint.by ? kept : names;
    list += (list.empty() ? "" : ", ") + constraint.name +
            (constraint.by ? " by " + model.controls[*constraint.by].name : "");
  }
  if (!names.empty())
    c.hypotheses.push_back("the reactions are ideal (Chetaev-Niu): N = sum lambda dphi/dq^(m); constraints: " + names);
  if (!kept.empty()) c.hypotheses.push_back("inputs keep constraints, and no reaction does: " + kept);
  if (e.constraints.size() < model.constraints.size())
    c.hypotheses.push_back("constraints not listed follow from these; their multipliers are zero");
  c.hypotheses.push_back("the constraints are lifted to order " + std::to_string(e.m) + " and have rank " +
                         std::to_string(e.constraints.size()) + ": the columns " + list_of(model, e.dependent) +
                         " of dphi/dq^(" + std::to_string(e.m) + ") are regular");
  c.hypotheses.push_back(e.solved
                             ? "the derivatives of order " + std::to_string(e.m) + " of " +
                                   list_of(model, e.dependent) + " are put in as the constraints give them"
                             : "the constraints are not solved: the derivatives of order " + std::to_string(e.m) +
                                   " of " + list_of(model, e.dependent) + " stand for their values on the manifold");
  for (const std::string& n : notes_on_rank(model, e)) c.hypotheses.push_back(n);
  for (const Difference& d : proof.pivots)
    if (d.verdict != Verdict::proved) c.hypotheses.push_back(d.component + " does not vanish (not shown)");
}

}  // namespace

void add_reading(Certificate& c, const std::vector<std::string>& cases, const std::vector<std::string>& values) {
  for (const std::string& name : cases) c.hypotheses.push_back("the case '" + name + "' is laid over the file");
  for (const std::string& value : values) c.hypotheses.push_back(value + " is given beside the file");
}

Certificate certificate(const Mechanics& M, const Proof& proof, const Eliminations& eliminations,
                        const std::string& program, const std::string& source_hash) {
  Certificate c;
  c.program = program;
  c.model = M.model->title;
  c.source_hash = source_hash;
  c.meaning = "The forms follow from each other given the same T, forces and constraints. This does not prove that the "
              "model describes the machine.";
  hypotheses(M, proof, eliminations, c);
  SymbolNames names = M.model->names;
  for (std::size_t i = 0; i < names.masses.size() || i < M.model->masses.size(); ++i) {
    if (i >= names.masses.size()) names.masses.emplace_back();
    names.masses[i] = mass_name(*M.model, i) + (M.model->masses[i].weight ? "." + std::to_string(i) : "");
  }
  if (eliminations.quasi.quasi) names.quasi = eliminations.quasi.free.names;
  Exporter out(c, M.graph(), names);
  for (const Difference& d : proof.kernel)
    if (d.verdict == Verdict::proved) out.claim(Certificate::ClaimKind::kernel, "routh", "", d);
  for (const Difference& d : proof.pivots)
    if (d.verdict == Verdict::proved) out.claim(Certificate::ClaimKind::pivot, "routh", "", d);
  for (const FormProof& f : proof.forms)
    for (const Difference& d : f.differences) {
      if (d.verdict == Verdict::unknown) continue;
      out.claim(d.verdict == Verdict::proved ? Certificate::ClaimKind::agree : Certificate::ClaimKind::differ,
                f.form->name, "routh", d);
    }
  if (out.took_branches())
    c.hypotheses.push_back("where forms differ, a branching function stands for the branch that holds at the witness");
  return c;
}

}  // namespace anholon
