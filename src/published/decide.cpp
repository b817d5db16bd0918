#include "published/decide.h"

#include <algorithm>
#include <chrono>

#include "expr/normal.h"
#include "setup/eliminate.h"

namespace anholon {

namespace {

Comparison judged(Subject& subject, const std::string& text) {
  Diagnostics diagnostics;
  const SourceText source{"claim", "e: " + text + "\n"};
  const std::vector<PublishedEquation> list = subject.read(source, diagnostics);
  if (diagnostics.has_errors())
    throw Failure({}, diagnostics.list().front().message + " in: " + text, diagnostics.list().front().hint);
  // A vector equation is decided by its components: by a false one if there is one, else by an unknown one.
  std::optional<Comparison> all;
  for (const PublishedEquation& e : list) {
    Comparison c = subject.judge(e);
    const bool decides = !all || (all->verdict == Verdict::proved && c.verdict != Verdict::proved) ||
                         (all->verdict == Verdict::unknown && c.verdict == Verdict::refuted);
    if (decides) all = std::move(c);
  }
  return *all;
}

std::string said(const Comparison& c) {
  switch (c.verdict) {
  case Verdict::proved:
    return c.what;
  case Verdict::refuted:
    return "left - right = " + c.detail + " at a point of the motion";
  case Verdict::unknown:
    break;
  }
  return c.detail;
}

// Returns all constraints with their derivatives, and Routh's equations, up to derivatives of the order `highest`, with
// masses substituted.
Column all_equations(const Mechanics& M, unsigned highest) {
  Column all;
  for (std::size_t r = 0; r < M.phi.size(); ++r) {
    Expr phi = put_masses(*M.model, M.phi[r]);
    for (unsigned k = static_cast<unsigned>(M.order[r]); k <= highest; ++k, phi = total_derivative(phi))
      all.push_back(phi);
  }
  Column routh = put_masses(*M.model, lagrange_operator(M) - right_side(M));
  for (unsigned k = 2; k <= highest; ++k, routh = total_derivative(routh))
    all.insert(all.end(), routh.begin(), routh.end());
  return all;
}

}  // namespace

Subject& Decider::subject(const ClaimCheck& check) {
  std::string key = check.model, lets;
  for (const std::string& l : check.lets) lets += "let " + l + "\n";
  std::unique_ptr<Subject>& known = subjects_[key + "\n" + lets];
  if (known) return *known;
  auto fresh = std::make_unique<Subject>(load_(check.model));
  if (!lets.empty()) {
    Diagnostics diagnostics;
    fresh->read({"claim", lets + "e: 0 = 0\n"}, diagnostics);
    if (diagnostics.has_errors())
      throw Failure({}, diagnostics.list().front().message, diagnostics.list().front().hint);
  }
  known = std::move(fresh);
  return *known;
}

Decision Decider::decide(const ClaimCheck& check) {
  Decision out;
  out.check = &check;
  const auto start = std::chrono::steady_clock::now();
  try {
    switch (check.kind) {
    case ClaimCheck::Kind::equation:
      equation(check, out);
      break;
    case ClaimCheck::Kind::forms:
      forms(check, out);
      break;
    case ClaimCheck::Kind::points:
      points(check, out);
      break;
    }
  } catch (const Failure& e) {
    out.verdict = Verdict::unknown;
    out.detail = e.diagnostic.message;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

void Decider::equation(const ClaimCheck& check, Decision& out) {
  Subject& s = subject(check);
  const Comparison c = judged(s, check.equation);
  out.verdict = c.verdict;
  out.detail = said(c);
  out.has_mutant = !check.mutant.empty();
  if (out.has_mutant) out.mutant = judged(s, check.mutant).verdict;
}

// Decides a claim about forms. The mutant of a form has the velocity of the first coordinate added to the left side of
// each of its equations.
void Decider::forms(const ClaimCheck& check, Decision& out) {
  Subject& s = subject(check);
  const Mechanics& M = s.mechanics();
  std::vector<Eliminations> offered;
  for (const bool solve : {true, false})
    offered.push_back({elimination_for(M, Unknowns::coordinates, {}, {}, solve),
                       elimination_for(M, Unknowns::quasi_velocities, {}, {}, solve)});
  out.verdict = out.mutant = Verdict::proved;
  out.has_mutant = true;
  const auto worse = [](Verdict a, Verdict b) {
    return a == b ? a : a == Verdict::refuted || b == Verdict::refuted ? Verdict::refuted : Verdict::unknown;
  };
  Verdict mutants = Verdict::refuted;
  for (const std::string& name : check.forms) {
    const Formulation* form = find_formulation(name);
    if (!form) throw Failure({}, "there is no form '" + name + "'");
    if (const std::string why = obstacle(*form, M); !why.empty())
      throw Failure({}, "the form " + name + " does not apply: " + why);
    out.verdict = worse(out.verdict, prove_form(M, *form, form->equations, offered).verdict);
    const auto wrong = [&](const Mechanics& m, const Elimination& e) {
      Equations q = form->equations(m, e);
      for (Expr& left : q.left) left = left + e.on(m.qd[0]);
      return q;
    };
    if (prove_form(M, *form, wrong, offered).verdict != Verdict::refuted) mutants = Verdict::unknown;
    out.detail += (out.detail.empty() ? "" : ", ") + name;
  }
  out.mutant = mutants;
  out.detail += out.verdict == Verdict::proved    ? " agree with Routh's equations"
                : out.verdict == Verdict::refuted ? ": one differs from Routh's equations"
                                                  : ": not decided";
}

// Checks points exactly: rational values are substituted in every equation. The mutant is a point that does not belong
// to the motion: its first value is changed.
void Decider::points(const ClaimCheck& check, Decision& out) {
  Subject& s = subject(check);
  const Mechanics& M = s.mechanics();
  const unsigned highest = std::max(2U, highest_order(M));
  const Column equations = all_equations(M, highest);
  const Graph& g = M.graph();
  using Values = std::map<NodeId, Expr>;
  const auto solve_all = [&](const Values& at) {
    return std::all_of(equations.begin(), equations.end(), [&](Expr e) {
      const Expr left = substitute({&e, 1}, [&](NodeId id) {
        const auto it = at.find(id);
        return it == at.end() ? Expr{} : it->second;
      })[0];
      return proved_zero(left);
    });
  };
  std::vector<Values> all;
  for (const auto& point : check.points) {
    Values at;
    for (const auto& [name, value] : point) {
      Syntax syntax = parse_formula(FormulaText(name, Span{}));
      s.words().join(syntax);
      const Expr symbol = s.words().number(syntax);
      const auto r = parse_rational(value);
      if (!r || symbols({&symbol, 1}) != std::vector<NodeId>{symbol.id})
        throw Failure({}, "a point gives a rational value to each of its symbols: " + name + " = " + value);
      at[symbol.id] = M.graph().number(*r);
    }
    all.push_back(std::move(at));
  }
  const auto is_of_state = [&](NodeId id) {
    const Node& n = g.node(id);
    return n.kind != Kind::multiplier && !(n.kind == Kind::jet && n.order >= 2);
  };
  const auto lower = [&](const Values& v) {
    Values kept;
    for (const auto& [id, x] : v)
      if (is_of_state(id)) kept.emplace(id, x);
    return kept;
  };
  const auto equal = [](const Values& a, const Values& b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
             return x.first == y.first && x.second == y.second;
           });
  };
  bool holds = true, differ = true;
  for (std::size_t i = 0; i < all.size(); ++i) {
    holds = holds && solve_all(all[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (!equal(lower(all[i]), lower(all[j]))) throw Failure({}, "the points have different positions and velocities");
      differ = differ && !equal(all[i], all[j]);
    }
  }
  out.verdict = holds && differ ? Verdict::proved : Verdict::refuted;
  out.detail = holds && differ ? std::to_string(all.size()) + " solutions at the same positions and velocities, exactly"
                               : "not all points solve the equations";
  Values moved = all[0];
  for (auto& [id, x] : moved)
    if (!is_of_state(id)) {
      x = x + M.graph().one();
      break;
    }
  out.has_mutant = true;
  out.mutant = solve_all(moved) ? Verdict::proved : Verdict::refuted;
}

}  // namespace anholon
