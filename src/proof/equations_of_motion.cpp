#include "proof/equations_of_motion.h"

#include <algorithm>
#include <cmath>

#include "expr/normal.h"
#include "numeric/linear.h"
#include "proof/scattered.h"

namespace anholon {

namespace {

constexpr int kPoints = 3, kAttempts = 60, kNewtonSteps = 60;
constexpr double kSingular = 1e-7;  // a pivot, relative to its row
constexpr double kFollows = 1e-6;   // the omitted equations hold up to this residual

std::uint64_t key(const Node& n) {
  return (static_cast<std::uint64_t>(n.kind) << 40) | (static_cast<std::uint64_t>(n.order) << 32) | n.index;
}

// From this attempt on, coordinates have either sign, and are three times as large at every second attempt.
constexpr int kElsewhere = 5000;

// Returns a value for each symbol at an attempt: between 0.3 and 1.4, derivatives of either sign.
double generic(const Node& n, int attempt) {
  const std::uint64_t bits = scattered_bits(key(n) * 131 + static_cast<std::uint64_t>(attempt) * 7919 + 17);
  const double r = 0.3 + 1.1 * unit_of(bits);
  if (attempt >= kElsewhere && n.kind == Kind::jet && n.order == 0) return (bits & 1 ? -r : r) * (attempt % 2 ? 3 : 1);
  if (n.kind != Kind::jet || n.order == 0) return r;
  // Derivatives are divided by 1, 2 and 4 in turn, because a speed may be bounded.
  return (bits & 1 ? -r : r) / (1 << (attempt % 3));
}

// `above`: the attempt for accelerations, higher derivatives and multipliers.
PointValues values_of(std::unordered_map<std::uint64_t, double> known, int attempt, int above) {
  return PointValues([known = std::move(known), attempt, above](const Node& n) {
    const auto it = known.find(key(n));
    const bool is_above = n.kind == Kind::multiplier || (n.kind == Kind::jet && n.order >= 2);
    return it == known.end() ? generic(n, is_above ? above : attempt) : it->second;
  });
}

Matrix<double> values(const std::vector<std::vector<Expr>>& rows, const std::vector<std::size_t>& which,
                      const std::vector<std::size_t>& columns, PointValues& at) {
  Matrix<double> a(which.size(), columns.size());
  for (std::size_t i = 0; i < which.size(); ++i)
    for (std::size_t j = 0; j < columns.size(); ++j) a(i, j) = at(rows[which[i]][columns[j]]);
  return a;
}

std::vector<std::size_t> up_to(std::size_t n) {
  std::vector<std::size_t> all(n);
  for (std::size_t i = 0; i < n; ++i) all[i] = i;
  return all;
}

bool finite(const Matrix<double>& a) {
  return std::all_of(a.data.begin(), a.data.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace

Expr put_rates(const Model& model, Expr e) {
  if (model.states.empty()) return e;
  return put_state_rates(model, put_masses(model, put_state_rates(model, e, 1)), 1);
}

PointValues generic_values(int attempt) { return values_of({}, attempt, attempt); }

bool EquationsOfMotion::choose(Stage& s, const std::vector<std::size_t>& preferred, PointValues& at) const {
  const std::vector<std::size_t> all_rows = up_to(s.rows.size()), all = up_to(s.symbols.size());
  const Matrix<double> a = values(s.jacobian, all_rows, all, at);
  if (!finite(a)) return false;
  RowChoice<double> choice = choose_rows(a, kSingular);
  s.chosen_rows = choice.independent;
  s.dropped_rows = choice.dependent;
  s.chosen_symbols = choice.pivot_columns;
  if (preferred.size() == s.chosen_rows.size() && !preferred.empty() && preferred.size() < s.symbols.size() &&
      choose_rows(values(s.jacobian, s.chosen_rows, preferred, at), kSingular).independent.size() == preferred.size())
    s.chosen_symbols = preferred;
  std::sort(s.chosen_symbols.begin(), s.chosen_symbols.end());
  return true;
}

EquationsOfMotion::EquationsOfMotion(const Mechanics& M, unsigned highest_order,
                                     const std::vector<std::size_t>& preferred, PointValues* near)
    : highest(std::max(2U, highest_order)) {
  const Model& model = *M.model;
  Graph& g = M.graph();
  const std::size_t n = M.q.size();
  Column routh;
  {
    // D/Dt dT/dq' - dT/dq - (Q + …) - N
    const Column left = total_derivative(gradient(M.T, M.qd)) - gradient(M.T, M.q);
    routh = put_masses(model, left - forces(M) - M.N);
    for (Expr& r : routh) r = put_rates(model, r);
  }
  const auto differentiated = [&](Expr e, unsigned times) { return put_rates(model, total_derivative(e, times)); };
  int of_routh = 2;
  for (Expr r : routh) of_routh = std::max(of_routh, jet_order(r));
  for (unsigned k = 0; k <= highest; ++k) {
    Stage s;
    for (std::size_t r = 0; r < M.phi.size(); ++r)
      if (const int times = static_cast<int>(k) - M.order[r]; times >= 0)
        s.rows.push_back({true, r, static_cast<unsigned>(times),
                          differentiated(put_masses(model, M.phi[r]), static_cast<unsigned>(times))});
    s.symbols = jets(model, k);
    if (k >= 2) {
      for (std::size_t a = 0; a < n; ++a) s.rows.push_back({false, a, k - 2, differentiated(routh[a], k - 2)});
      for (std::size_t r = 0; r < M.phi.size(); ++r)
        s.symbols.push_back(g.multiplier(static_cast<std::uint32_t>(r), k - 2));
      top.insert(top.end(), s.symbols.begin(), s.symbols.end());
    }
    for (const DerivedEquation& e : s.rows) s.jacobian.push_back(gradient(e.residual, s.symbols));
    stages_.push_back(std::move(s));
  }
  regular = of_routh == 2;
  for (int attempt = 0; attempt < kAttempts && on_motion_.size() < kPoints; ++attempt) {
    if (on_motion_.empty()) {
      PointValues at = values_of({}, attempt, attempt);
      if (!std::all_of(stages_.begin(), stages_.end(), [&](Stage& s) { return choose(s, preferred, at); })) continue;
    }
    Symbols known, below;
    if (!find_point(attempt, known, &below)) continue;
    on_motion_.push_back(values_of(std::move(known), attempt, attempt));
    on_constraints_.push_back(values_of(std::move(below), attempt, attempt + 1000));
    anywhere_.push_back(values_of({}, attempt + 2000, attempt + 2000));
  }
  if (on_motion_.empty()) find_projected_points(preferred, near);
  if (on_motion_.empty()) regular = false;
  for (Stage& s : stages_) {
    for (std::size_t i : s.chosen_rows) {
      equations.push_back(s.rows[i].residual);
      (&s - stages_.data() < 2 ? lower : rows).push_back(s.rows[i]);
    }
    for (std::size_t j : s.chosen_symbols) unknowns.push_back(s.symbols[j]);
    if (s.chosen_symbols.size() != s.chosen_rows.size()) regular = false;
    for (std::size_t i : s.dropped_rows)
      for (PointValues& at : on_motion_)
        if (!(std::abs(at(s.rows[i].residual)) < kFollows)) regular = false;
  }
}

std::vector<PointValues>& EquationsOfMotion::elsewhere() {
  constexpr int kWanted = 8;
  if (elsewhere_) return *elsewhere_;
  elsewhere_.emplace();
  for (int k = kElsewhere; k < kElsewhere + kAttempts && elsewhere_->size() < kWanted; ++k) {
    Symbols known, below;
    if (projected_) known = starting_values(k, nullptr);
    if (projected_ ? project_point(k, known, &below) : find_point(k, known, &below))
      elsewhere_->push_back(values_of(std::move(known), k, k));
  }
  return *elsewhere_;
}

bool EquationsOfMotion::find_point(int attempt, Symbols& known, Symbols* below) {
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    const Stage& s = stages_[k];
    if (k == 2) *below = known;
    if (s.chosen_rows.empty()) continue;
    if (s.chosen_rows.size() != s.chosen_symbols.size()) return false;
    const Graph& g = *s.symbols[0].graph;
    for (std::size_t j : s.chosen_symbols) {
      const Node& node = g.node(s.symbols[j].id);
      known[key(node)] = generic(node, attempt);
    }
    bool done = false;
    for (int step = 0; step < kNewtonSteps && !done; ++step) {
      PointValues at = values_of(known, attempt, attempt);
      const Matrix<double> j = values(s.jacobian, s.chosen_rows, s.chosen_symbols, at);
      std::vector<double> f, x;
      for (std::size_t i : s.chosen_rows) f.push_back(at(s.rows[i].residual));
      Lu<double> lu;
      if (!finite(j) || !lu.factor(j)) return false;
      lu.solve(f, x);
      double largest = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        double& value = known[key(g.node(s.symbols[s.chosen_symbols[i]].id))];
        value -= x[i];
        largest = std::max(largest, std::abs(x[i]) / (1 + std::abs(value)));
      }
      if (!(largest < 1e6)) return false;
      done = largest < 1e-13;
    }
    if (!done) return false;
  }
  return true;
}

// Returns values of all symbols of the equations: generic ones; or, for the symbols that a state gives, values that
// differ from those at the start by up to a half of their size, and less at later attempts.
EquationsOfMotion::Symbols EquationsOfMotion::starting_values(int attempt, PointValues* near) const {
  constexpr int kSizes = 8;
  Column residuals;
  for (const Stage& s : stages_)
    for (const DerivedEquation& e : s.rows) residuals.push_back(e.residual);
  Symbols values;
  for (const NodeId id : symbols(residuals)) {
    const Expr symbol{residuals[0].graph, id};
    const Node& n = residuals[0].graph->node(id);
    const bool is_above = n.kind == Kind::multiplier || (n.kind == Kind::jet && n.order >= 2);
    double value = generic(n, attempt);
    if (near && !is_above) {
      const double start = (*near)(symbol), size = start == 0 ? 1 : std::abs(start);
      const double sign = scattered_bits(key(n) + static_cast<std::uint64_t>(attempt)) & 1 ? -1 : 1;
      const bool is_rate = n.kind == Kind::jet && n.order == 1;
      value = is_rate ? start + value : start + sign * value * std::ldexp(size, -2 - attempt % kSizes);
    }
    values[key(n)] = value;
  }
  return values;
}

// Projects the values on the manifold of the constraints, order by order, by Newton steps of least length.
bool EquationsOfMotion::project_point(int attempt, Symbols& known, Symbols* below) const {
  for (std::size_t k = 0; k < stages_.size(); ++k) {
    if (k == 2) *below = known;
    if (!stages_[k].rows.empty() && !project(stages_[k], attempt, known)) return false;
  }
  return true;
}

bool EquationsOfMotion::project(const Stage& s, int attempt, Symbols& known) const {
  const std::vector<std::size_t> all_rows = up_to(s.rows.size()), all = up_to(s.symbols.size());
  const Graph& g = *s.symbols[0].graph;
  Matrix<double> identity(all.size(), all.size());
  for (std::size_t i : all) identity(i, i) = 1;
  for (int step = 0; step < kNewtonSteps; ++step) {
    PointValues at = values_of(known, attempt, attempt);
    const Matrix<double> j = values(s.jacobian, all_rows, all, at);
    if (!finite(j)) return false;
    const std::vector<std::size_t> independent = choose_rows(j, kSingular).independent;
    std::vector<double> f, change;
    for (std::size_t r : independent) f.push_back(at(s.rows[r].residual));
    if (!least_change(identity, values(s.jacobian, independent, all, at), f, change)) return false;
    if (!std::all_of(change.begin(), change.end(), [](double v) { return std::isfinite(v); })) return false;
    double largest = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      double& value = known[key(g.node(s.symbols[i].id))];
      value -= change[i];
      largest = std::max(largest, std::abs(change[i]) / (1 + std::abs(value)));
    }
    if (!(largest < 1e6)) return false;
    if (largest < 1e-13) return true;
  }
  return false;
}

void EquationsOfMotion::find_projected_points(const std::vector<std::size_t>& preferred, PointValues* near) {
  constexpr int kFirst = 100, kGeneric = 24, kNear = 40;
  int attempt = kFirst;
  const std::vector<std::size_t> none;
  // Chooses equations and unknowns, and returns their number for each order.
  const auto ranks = [&](const Symbols& known) {
    PointValues at = values_of(known, attempt, attempt);
    std::vector<std::size_t> numbers;
    for (Stage& s : stages_) {
      if (!choose(s, preferred, at)) return none;
      numbers.push_back(s.chosen_rows.size());
    }
    return numbers;
  };
  for (int k = 0; k < kGeneric + (near ? kNear : 0) && on_motion_.size() < kPoints; ++k) {
    attempt = kFirst + k;
    Symbols known = starting_values(attempt, k < kGeneric ? nullptr : near), below;
    const Symbols start = known;
    const std::vector<std::size_t> before = on_motion_.empty() ? ranks(known) : none;
    if (!project_point(attempt, known, &below)) continue;
    // A point at which fewer equations are independent than around it is singular: the others do not follow from these.
    if (on_motion_.empty() && (before.empty() || ranks(known) != before)) continue;
    on_motion_.push_back(values_of(std::move(known), attempt, attempt));
    on_constraints_.push_back(values_of(std::move(below), attempt, attempt));
    anywhere_.push_back(values_of(start, attempt, attempt));
  }
  projected_ = !on_motion_.empty();
}

// Returns the equations of orders below `orders`, solved one after the other; none if this is impossible, or if the
// equations or their solutions have more nodes.
SolvedEquations EquationsOfMotion::solutions(std::size_t orders, std::size_t most_nodes) const {
  SolvedEquations solved;
  Column residuals;
  for (std::size_t k = 0; k < orders; ++k)
    for (std::size_t i : stages_[k].chosen_rows) residuals.push_back(stages_[k].rows[i].residual);
  if (reachable(residuals).size() > most_nodes) return {};
  for (std::size_t k = 0; k < orders; ++k) {
    const Stage& s = stages_[k];
    Column open;
    for (std::size_t j : s.chosen_symbols) open.push_back(s.symbols[j]);
    for (std::size_t i : s.chosen_rows)
      if (!solved.add(s.rows[i].residual, open) || solved.size() > most_nodes) return {};
  }
  return solved;
}

Column EquationsOfMotion::reduced(Expr e) {
  if (!lower_solved_) lower_solved_ = solutions(2, SIZE_MAX);
  return lower_solved_->empty() ? Column{} : lower_solved_->branches(e);
}

Column EquationsOfMotion::on_solutions(Expr e) {
  constexpr std::size_t kMostNodes = 1000;
  if (!solved_) try {
      solved_ = solutions(stages_.size(), kMostNodes);
    } catch (const Failure&) {  // a pivot vanishes
      solved_ = SolvedEquations();
    }
  return solved_->empty() ? Column{} : solved_->branches(e);
}

}  // namespace anholon
