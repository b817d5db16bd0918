#include "observe/defect.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon {

namespace {

// A step is halved this often before a remainder that is too large is accepted as it is.
constexpr int kMostHalvings = 7;
// Beside a kink there is no remainder: what is left is halved until its values say no more than the other pieces do, so
// often and for so many pieces at most.
constexpr int kMostHalvingsAtKinks = 60, kMostPieces = 200;

using Series = std::vector<std::vector<Ball>>;

// The polynomials about begin + by: Horner's scheme, again and again.
Series shifted(Series x, const Ball& by) {
  for (std::vector<Ball>& c : x)
    for (std::size_t i = 0; i + 1 < c.size(); ++i)
      for (std::size_t k = c.size() - 1; k-- > i;) addmul(c[k], by, c[k + 1]);
  return x;
}

// (order + k)! / order!
Ball rising(std::size_t order, std::size_t k) {
  Ball f(1);
  for (std::size_t i = 1; i <= k; ++i) f *= Ball(static_cast<int>(order + i));
  return f;
}

// Bounds, not values: balls of remainders hold 0.
bool reaches_beyond(const Ball& a, const Ball& b) { return a.symmetric().contains_inside(b.symmetric()); }

}  // namespace

Defect::Defect(Workspace& s, std::size_t times, const Ball& begin, const Ball& end, long significand)
    : s_(s), times_(times), bits_(2 * significand + 32), begin_(begin), end_(end) {
  const BallScope precision(bits_);
  quiet_ = Ball(Rational(1, mpz_class(1) << static_cast<unsigned long>(significand)));
  const Model& model = *s.model;
  const Mechanics& m = *s.mechanics;
  const Column inertia = newton_left_side(m), reaction = put_masses(model, m.N);
  const Column force = put_masses(model, forces(m));
  Column es;
  for (std::size_t a = 0; a < inertia.size(); ++a) es.push_back(inertia[a] - force[a] - reaction[a]);
  std::vector<int> leads(es.size(), 0);
  for (std::size_t r = 0; r < m.phi.size(); ++r) {
    // Those that take part hide as many derivatives as the structure says; redundant ones follow from them.
    const auto row = std::find(s.system.constraints.begin(), s.system.constraints.end(), r);
    const std::size_t equation = s.system.coordinates + static_cast<std::size_t>(row - s.system.constraints.begin());
    hidden_.push_back(row == s.system.constraints.end() ? std::max(0, 2 - m.order[r]) : s.structure.c[equation]);
    es.push_back(put_masses(model, m.phi[r]));
    leads.push_back(hidden_.back());
  }
  phi_ = es.size();
  for (const std::size_t r : s.system.constraints)
    for (Expr e : m.Phi[r]) es.push_back(put_masses(model, e)), leads.push_back(0);
  // What the residuals are related to: needed as values only.
  scale_ = es.size();
  for (const Column* part : {&inertia, &force, &reaction}) es.insert(es.end(), part->begin(), part->end());
  tape_ = compile(OutputTape<double>::put(s, es), leads);
  parameters_ = parameter_values<Ball>(model);
}

void Defect::set_inputs(const Series& x, const Ball& t, int orders) {
  if (!machine_ || orders > orders_) {
    machine_ = std::make_unique<Machine<Ball>>(tape_, static_cast<std::size_t>(orders) + 1, parameters_);
    orders_ = orders;
  }
  const Graph& g = *s_.model->graph;
  for (const Input& in : tape_.inputs) {
    const Node& n = g.node(in.symbol);
    Ball* w = machine_->series(in.slot);
    const std::size_t top = static_cast<std::size_t>(orders + tape_.code[in.slot].lead);
    const auto j = s_.system.variable(in.symbol);
    for (std::size_t p = 0; p <= top; ++p) {
      const std::size_t k = p + n.order;
      if (n.kind == Kind::time)
        w[p] = p == 0 ? t : Ball(p == 1 ? 1 : 0);
      else
        w[p] = j && k < x[*j].size() ? x[*j][k] * rising(p, n.order) : Ball(0);
    }
  }
}

void Defect::sweep(int orders) {
  for (int stage = -tape_.largest_lead; stage <= orders; ++stage) machine_->sweep(stage, 0, tape_.main_end);
}

// The largest of |E|, |G|, |N|, and at least 1: a number below it. What balls do not bound may be small and is left
// out: in relation to less, a bound is a bound as well.
Ball Defect::newton_scale() const {
  machine_->sweep(0, tape_.main_end, static_cast<std::uint32_t>(tape_.code.size()));
  Ball scale(1);
  for (std::size_t i = scale_; i < tape_.roots.size(); ++i)
    if (machine_->value(i).is_finite()) scale = max(scale, lower_end(abs(machine_->value(i))));
  return scale;
}

const Ball* Defect::phi(std::size_t constraint, std::size_t coordinate) const {
  return machine_->series(tape_.roots[phi_ + constraint * s_.mechanics->q.size() + coordinate]);
}

// What added to the multipliers leaves least of Newton's residual, order by order, by least squares. Nothing rests on
// these numbers being right: balls say what is left. Empty where there are none.
Series Defect::correction(std::size_t orders) const {
  const PrecisionScope precision(static_cast<int>(static_cast<double>(bits_) * 0.30103) + 1);
  const std::size_t n = s_.mechanics->q.size(), count = s_.system.constraints.size();
  Matrix<Multi> normal(count, count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t a = 0; a < n; ++a)
        addmul(normal(i, j), phi(i, a)[0].midpoint_multi(), phi(j, a)[0].midpoint_multi());
  Lu<Multi> lu;
  if (count == 0 || !lu.factor(normal)) return {};
  std::vector<std::vector<Multi>> delta(count);
  for (std::size_t k = 0; k < orders; ++k) {
    std::vector<Multi> right(count), solution;
    for (std::size_t a = 0; a < n; ++a) {
      Multi left = machine_->series(tape_.roots[a])[k].midpoint_multi();
      for (std::size_t j = 0; j < count; ++j)
        for (std::size_t i = 1; i <= k; ++i) addmul(left, Multi(-delta[j][k - i]), phi(j, a)[i].midpoint_multi());
      for (std::size_t j = 0; j < count; ++j) addmul(right[j], phi(j, a)[0].midpoint_multi(), left);
    }
    lu.solve(right, solution);
    for (std::size_t j = 0; j < count; ++j) {
      if (!solution[j].finite()) return {};
      delta[j].push_back(solution[j]);
    }
  }
  Series balls(count);
  for (std::size_t j = 0; j < count; ++j)
    for (const Multi& x : delta[j]) balls[j].emplace_back(x);
  return balls;
}

// The coefficient of Newton's residual with multipliers corrected by delta.
Ball Defect::corrected(std::size_t a, std::size_t order, const Series& delta) const {
  Ball left = machine_->series(tape_.roots[a])[order];
  for (std::size_t j = 0; j < delta.size(); ++j)
    for (std::size_t k = 0; k <= order && k < delta[j].size(); ++k) addmul(left, -delta[j][k], phi(j, a)[order - k]);
  return left;
}

Defect::Bound Defect::at_time(const DenseStep& step, const Ball& time) {
  set_inputs(shifted(step.coefficients, time - step.begin), time, 0);
  sweep(0);
  Bound b;
  const std::size_t n = s_.mechanics->q.size();
  for (std::size_t a = 0; a < n; ++a) b.newton = max(b.newton, abs(machine_->value(a)));
  const Series delta = correction(1);
  for (std::size_t a = 0; a < n; ++a) b.projected = max(b.projected, abs(corrected(a, 0, delta)));
  const Ball scale = newton_scale();
  b.newton /= scale;
  b.projected /= scale;
  for (std::size_t r = 0; r < hidden_.size(); ++r)
    for (std::size_t k = 0; k <= static_cast<std::size_t>(hidden_[r]); ++k) {
      const Ball factor = rising(0, k), value = machine_->series(tape_.roots[n + r])[k] * factor;
      b.constraints = max(b.constraints, abs(value) / max(Ball(1), machine_->terms(n + r, k) * factor));
    }
  return b;
}

Defect::Bound Defect::over(const Series& centered, const Ball& center, const Ball& radius) {
  int top = 1;
  for (const std::vector<Ball>& c : centered) top = std::max(top, static_cast<int>(c.size()));
  const std::size_t last = static_cast<std::size_t>(top);
  std::vector<Ball> power(last + 1, Ball(1));
  for (std::size_t k = 1; k <= last; ++k) power[k] = power[k - 1] * radius;

  // The polynomials about the center, then the coefficients that follow on all of the interval.
  const std::size_t n = s_.mechanics->q.size();
  struct Part {
    std::size_t root, derivative;
    bool projected;
    Ball polynomial, remainder, value;  // value: enclosed on all of the interval
  };
  std::vector<Part> parts;
  for (std::size_t a = 0; a < n; ++a)
    for (const bool projected : {false, true}) parts.push_back({a, 0, projected, {}, {}, {}});
  for (std::size_t r = 0; r < hidden_.size(); ++r)
    for (std::size_t k = 0; k <= static_cast<std::size_t>(hidden_[r]); ++k)
      parts.push_back({n + r, k, false, {}, {}, {}});
  Series delta;
  const auto coefficient = [&](const Part& p, std::size_t k) {
    if (p.projected) return abs(corrected(p.root, k, delta));
    return abs(machine_->series(tape_.roots[p.root])[p.derivative + k] * rising(k, p.derivative));
  };
  set_inputs(centered, center, top);
  sweep(top - 1);
  delta = correction(last);
  for (Part& p : parts)
    for (std::size_t k = 0; k < last; ++k) p.polynomial += coefficient(p, k) * power[k];
  const Ball spread = radius.symmetric();
  delta = shifted(delta, spread);
  set_inputs(shifted(centered, spread), center + spread, top);
  sweep(top);
  for (Part& p : parts) p.remainder = coefficient(p, last) * power[last], p.value = coefficient(p, 0);

  Bound b;
  const Ball newton = newton_scale();
  for (const Part& p : parts) {
    Ball scale = p.root >= n ? Ball(1) : newton;
    if (p.root >= n)
      if (const Ball terms = machine_->terms(p.root, p.derivative) * rising(0, p.derivative); terms.is_finite())
        scale = max(scale, lower_end(terms));
    const Ball taylor = p.polynomial + p.remainder;
    const bool counts = reaches_beyond(p.remainder, p.polynomial) && reaches_beyond(p.remainder / scale, quiet_);
    if (!taylor.is_finite() || counts) b.sharp = false;
    if (!taylor.is_finite()) b.smooth = false;
    // The values on the interval are a bound as well; beside a kink there is no other.
    Ball& worst = p.root >= n ? b.constraints : p.projected ? b.projected : b.newton;
    worst = max(worst, (taylor.is_finite() && !reaches_beyond(taylor, p.value) ? taylor : p.value) / scale);
  }
  return b;
}

void Defect::piece(const DenseStep& step, const Ball& begin, const Ball& end, int halvings) {
  const Ball half(Rational(1, 2)), center = (begin + end) * half, radius = abs(end - begin) * half;
  const Bound b = over(shifted(step.coefficients, center - step.begin), center, radius);
  const bool finite = b.newton.is_finite() && b.projected.is_finite() && b.constraints.is_finite();
  const auto says_more = [&] {
    return reaches_beyond(b.newton, max(newton_, quiet_)) || reaches_beyond(b.projected, max(projected_, quiet_)) ||
           reaches_beyond(b.constraints, max(constraints_, quiet_));
  };
  const bool beside_kink =
      !b.smooth && finite && halvings < kMostHalvingsAtKinks && pieces_of_step_ < kMostPieces && says_more();
  if (b.sharp || (halvings >= kMostHalvings && !beside_kink)) return keep(b);
  piece(step, begin, center, halvings + 1);
  piece(step, center, end, halvings + 1);
}

void Defect::keep(const Bound& b) {
  newton_ = max(newton_, b.newton);
  // The multipliers at hand are as good as any.
  projected_ = max(projected_, reaches_beyond(b.projected, b.newton) ? b.newton : b.projected);
  constraints_ = max(constraints_, b.constraints);
  ++pieces_, ++pieces_of_step_;
}

void Defect::step(const DenseStep& step) {
  for (std::size_t j = 0; j < step.coefficients.size(); ++j)
    ANHOLON_ASSERT(step.coefficients[j].size() >= static_cast<std::size_t>(s_.structure.d[j]));
  const BallScope precision(bits_);
  // Where the last step ended and this one begins, the state as far as it belongs to the unknowns.
  const Series ends = shifted(step.coefficients, step.end - step.begin);
  for (std::size_t j = 0; j < last_.size(); ++j)
    for (std::size_t k = 0; k < static_cast<std::size_t>(s_.structure.d[j]); ++k) {
      const Ball now = step.coefficients[j][k] * rising(0, k), jump = now - last_[j][k] * rising(0, k);
      joints_ = max(joints_, abs(jump) / max(Ball(1), abs(now)));
    }
  last_ = ends;
  pieces_of_step_ = 0;
  if (times_ == 0) return piece(step, step.begin, step.end, 0);
  for (; reached_ < times_; ++reached_) {
    Rational part(static_cast<long>(2 * reached_ + 1), static_cast<long>(2 * times_));
    part.canonicalize();
    const Ball time = begin_ + (end_ - begin_) * Ball(part);
    if (((time - step.end) * (end_ - begin_)).is_positive()) break;
    keep(at_time(step, time));
  }
}

std::optional<RigorousReport> Defect::report() const {
  if (pieces_ == 0) return std::nullopt;
  const auto times = times_ == 0 ? std::nullopt : std::optional(reached_);
  return RigorousReport{
      times, pieces_, newton_.bound_text(), projected_.bound_text(), constraints_.bound_text(), joints_.bound_text(),
      bits_};
}

}  // namespace anholon
