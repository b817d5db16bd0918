#include "ensemble/reduction.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "contact/mode/mode_model.h"
#include "formula/formula.h"
#include "integrate/motion_state.h"
#include "integrate/series/sign_change.h"
#include "modelfile/names/names.h"
#include "setup/words/mistake_in_word.h"

namespace anholon {

namespace {

constexpr const char* kReductionHint =
    "max(FORMULA), min(FORMULA), mean(FORMULA), last(FORMULA), count(EVENT) or first(EVENT), such as max(theta')";

// Returns the kind that has this name elsewhere, or the nearest one to a misspelt name; "" if there is none.
std::string kind_meant_by(const std::string& word) {
  constexpr std::pair<const char*, const char*> kOthers[] = {
      {"maximum", "max"},  {"greatest", "max"}, {"largest", "max"}, {"minimum", "min"},   {"least", "min"},
      {"smallest", "min"}, {"average", "mean"}, {"avg", "mean"},    {"final", "last"},    {"end", "last"},
      {"number", "count"}, {"times", "count"},  {"when", "first"},  {"earliest", "first"}};
  for (const auto& [other, kind] : kOthers)
    if (word == other) return kind;
  return did_you_mean(word, {"max", "min", "mean", "last", "count", "first"});
}

std::optional<Reduction::Kind> kind_of(const std::string& word) {
  if (word == "max") return Reduction::Kind::greatest;
  if (word == "min") return Reduction::Kind::least;
  if (word == "mean") return Reduction::Kind::mean;
  if (word == "last") return Reduction::Kind::last;
  if (word == "count") return Reduction::Kind::count;
  if (word == "first") return Reduction::Kind::first;
  return std::nullopt;
}

// The names of the model; lambda.NAME is a multiplier, as in a monitor.
class MonitorNames final : public Names {
 public:
  explicit MonitorNames(const OpenModel& model) : names_(*model.names), multipliers_(model.model->names.multipliers) {}

  Graph& graph() override { return names_.graph(); }
  Value name(const std::string& name, Span span) override {
    return name == "lambda" && multipliers_.size() > 1 ? Value(InertialName{}) : names_.name(name, span);
  }
  std::optional<Value> call(const std::string& function, const std::vector<Value>& arguments,
                            const Syntax& syntax) override {
    return names_.call(function, arguments, syntax);
  }
  Value member(const Value& object, const Syntax& syntax) override {
    const std::string path = multiplier_path(syntax);
    if (path.empty()) return names_.member(object, syntax);
    for (std::size_t r = 0; r < multipliers_.size(); ++r)
      if (multipliers_[r] == path) return graph().multiplier(static_cast<std::uint32_t>(r), 0);
    for (const std::string& name : multipliers_)
      if (name.starts_with(path + ".")) return InertialName{};  // of a vector equation: a component follows
    const std::string near = did_you_mean(path, multipliers_);
    throw Failure(syntax.span,
                  "there is no constraint '" + path + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
  std::vector<std::string> functions() const override { return names_.functions(); }
  std::optional<Vector> point(const BodyName& body, Span use) override { return names_.point(body, use); }
  std::optional<Rotation> frame(const BodyName& body, Span use) override { return names_.frame(body, use); }
  std::string body_name(const BodyName& body) const override { return names_.body_name(body); }
  bool declares(const std::string& name) const override { return names_.declares(name); }

 private:
  Names& names_;
  const std::vector<std::string>& multipliers_;
};

// Throws MistakeInWord if the text has the form NAME.mode, or names another column of these contacts.
void must_be_no_column(const std::string& word, std::size_t at, const std::string& text,
                       const std::vector<Contact>& contacts) {
  for (const Contact& c : contacts) {
    const std::vector<std::string> columns = contact_columns({c}), events = contact_events({c});
    if (std::find(columns.begin(), columns.end(), text) != columns.end() && !events.empty())
      mistake_in(word, at, text.size(), "'" + text + "' is a column of a contact, no formula",
                 "rows at times have it: --at 1,2 --columns t," + text + "; events: count(" + events[0] + "), first(" +
                     events[0] + ")");
  }
}

// The reactions, and the forces of contacts and of constraints that are switched, differ from mode to mode, also in the
// equations that contain them.
[[noreturn]] void refuse_force(const std::string& word, std::size_t at, const std::string& text,
                               const std::vector<Contact>& moving) {
  const bool switched = std::any_of(moving.begin(), moving.end(), [](const Contact& c) { return c.held.has_value(); });
  mistake_in(
      word, at, text.size(),
      "'" + text + "' holds " + (switched ? "forces of constraints" : "reactions or forces of contacts") +
          ", which change with the modes",
      "a formula of coordinates, velocities, accelerations and t; rows at times have the forces: --at, --columns");
}

bool holds_contact_force(const std::vector<Contact>& contacts, std::size_t monitor) {
  using Formula = ContactForces::Formula;
  if (contacts.empty() || !contacts[0].forces) return false;
  const std::vector<Formula>& list = contacts[0].forces->formulas;
  return std::any_of(list.begin(), list.end(),
                     [&](const Formula& f) { return f.of == Formula::Of::monitor && f.index == monitor; });
}

bool holds_multiplier(Expr e) {
  const std::vector<NodeId> ids = symbols({&e, 1});
  return std::any_of(ids.begin(), ids.end(), [&](NodeId id) { return e.graph->node(id).kind == Kind::multiplier; });
}

// Returns the formula of a monitor, or one that is written out.
Expr formula_of(const std::string& word, std::size_t at, const std::string& text, const OpenModel& model,
                const std::vector<Contact>& moving) {
  for (const Monitor& m : model.model->monitors)
    if (m.name == text) return m.value;
  Value value;
  try {
    Span place;
    place.line = 1, place.column = static_cast<std::uint32_t>(at + 1);
    MonitorNames names(model);
    value = evaluate(parse_formula(FormulaText(text, place)), names);
  } catch (const Failure& f) {
    const auto of_force = [&](const Contact& c) { return text.find("lambda." + c.name) != std::string::npos; };
    if (std::any_of(moving.begin(), moving.end(), of_force)) refuse_force(word, at, text, moving);
    must_be_no_column(word, at, text, contacts(*model.names));
    throw MistakeInWord{f.diagnostic, word};
  }
  if (const Expr* e = std::get_if<Expr>(&value)) return put_masses(*model.model, *e);
  mistake_in(word, at, text.size(), "'" + text + "' is " + type_name(value) + ", no number",
             std::holds_alternative<Vector>(value) ? "a component, as " + text + ".x, or its length, norm(" + text + ")"
                                                   : "a formula that is a number");
}

// Throws MistakeInWord if the contacts move and the formula contains their forces.
void must_hold_no_forces(const std::string& word, std::size_t at, const std::string& text, Expr formula,
                         const Model& model, const std::vector<Contact>& moving) {
  if (moving.empty()) return;
  for (std::size_t i = 0; i < model.monitors.size(); ++i)
    if (model.monitors[i].name == text && holds_contact_force(moving, i)) refuse_force(word, at, text, moving);
  if (holds_multiplier(formula)) refuse_force(word, at, text, moving);
}

// Returns the name without the spaces around it, if there is such an event. Throws MistakeInWord.
std::string event_of(const std::string& word, std::size_t at, const std::string& text, const OpenModel& model,
                     const std::vector<Contact>& moving) {
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  const std::string name = text.substr(begin, end - begin + 1);
  std::vector<std::string> all;
  for (const Event& e : model.model->events) all.push_back(e.name);
  for (const std::string& event : contact_events(moving)) all.push_back(event);
  if (std::find(all.begin(), all.end(), name) != all.end()) return name;
  std::string near = did_you_mean(name, all);
  for (const std::string& event : all)
    if (near.empty() && event.starts_with(name + ".")) near = event;
  constexpr std::size_t kShown = 8;
  std::string shown;
  for (std::size_t k = 0; k < std::min(all.size(), kShown); ++k) shown += (k == 0 ? "" : ", ") + all[k];
  if (all.size() > kShown) shown += ", …";
  const bool one_mode = moving.empty() && !contacts(*model.names).empty();
  mistake_in(
      word, at + begin, name.size(),
      "there is no event '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
      one_mode ? "the contacts keep their modes: leave out the mode, and their changes are events"
      : all.empty()
          ? "the model has no events: an [[event]] with name and when, or a [[contact]], whose changes are events"
          : "the events are " + shown);
}

}  // namespace

void Reductions::add(const std::string& word, const OpenModel& model, const std::vector<Contact>& moving) {
  const std::size_t open = word.find('(');
  const std::string kind = word.substr(0, open);
  const std::optional<Reduction::Kind> known = kind_of(kind);
  if (open == std::string::npos)
    mistake_in(word, 0, word.size(), "this is not of the form KIND(FORMULA)", kReductionHint);
  if (!known) {
    const std::string near = kind_meant_by(kind);
    mistake_in(word, 0, open,
               "a motion is not summed up by '" + kind + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
               kReductionHint);
  }
  if (word.back() != ')') mistake_in(word, word.size(), 1, "a bracket is missing here", kReductionHint);
  for (const Reduction& before : list)
    if (before.name == word) mistake_in(word, 0, word.size(), "'" + word + "' is asked for twice", "once is enough");
  const std::string text = word.substr(open + 1, word.size() - open - 2);
  if (text.find_first_not_of(' ') == std::string::npos)
    mistake_in(word, open + 1, 1,
               std::string(Reduction{*known, 0, ""}.of_event() ? "an event" : "a formula") + " is missing here",
               kReductionHint);
  if (Reduction r{*known, 0, word}; r.of_event()) {
    const std::string name = event_of(word, open + 1, text, model, moving);
    const auto same = std::find(events.begin(), events.end(), name);
    r.of = static_cast<std::size_t>(same - events.begin());
    list.push_back(r);
    if (same == events.end()) events.push_back(name);
    return;
  }
  const Expr e = formula_of(word, open + 1, text, model, moving);
  must_hold_no_forces(word, open + 1, text, e, *model.model, moving);
  std::vector<Expr>& place = *known == Reduction::Kind::last ? ends : formulas;
  const auto same = std::find(place.begin(), place.end(), e);
  list.push_back({*known, static_cast<std::size_t>(same - place.begin()), word});
  if (same == place.end()) place.push_back(e);
}

// ---- over the steps -----------------------------------------------------------------------------------------------------

Reducer::Reducer(const Reductions& of, double tolerance)
    : of_(&of), tolerance_(std::max(tolerance, 4 * std::numeric_limits<double>::epsilon())) {
  restart();
}

void Reducer::restart() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity(),
                   kNone = std::numeric_limits<double>::quiet_NaN();
  seen_.assign(of_->formulas.size(), {});
  for (Seen& s : seen_) s.most = -kInfinity, s.fewest = kInfinity, s.last = kNone;
  ends_.assign(of_->ends.size(), kNone);
  fired_.assign(of_->events.size(), {});
  for (Fired& f : fired_) f.first = kNone;
  for (const Reduction& r : of_->list) {
    if (r.of_event() || r.kind == Reduction::Kind::last) continue;
    Seen& s = seen_[r.of];
    s.greatest = s.greatest || r.kind == Reduction::Kind::greatest;
    s.least = s.least || r.kind == Reduction::Kind::least;
    s.mean = s.mean || r.kind == Reduction::Kind::mean;
  }
  length_ = 0;
  kinks_ = 0;
  foretold_ = false;
}

bool Reducer::step(const ReducedStep& step) {
  bool good = true;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    Seen& s = seen_[i];
    if (s.done()) continue;
    polynomial_.resize(static_cast<std::size_t>(step.degree) + 1);
    for (int k = 0; k <= step.degree; ++k) polynomial_[static_cast<std::size_t>(k)] = step.coefficient(i, k);
    if (foretold_ && std::isfinite(polynomial_[0]) && !agrees(polynomial_[0], s.last, std::abs(polynomial_[0])))
      good = false;
    if (holds(step, i))
      see(s, step.h, 1);
    else
      see_by_values(step, i);
  }
  length_ += step.h;
  const bool kink = std::exchange(kinks_, step.kinks) != step.kinks;
  foretold_ = !step.look && !kink;
  return good;
}

// True if a value agrees with a polynomial as far as a good polynomial can be told from a wrong one, also in formulas
// whose terms cancel.
bool Reducer::agrees(double is, double foretold, double size) const {
  constexpr double kRelative = 1e3, kLeast = 1e-9, kAbsolute = 10;
  return std::abs(is - foretold) <= std::max(kRelative * tolerance_, kLeast) * size + kAbsolute * tolerance_;
}

// True if the polynomial is the formula over the step. The last two terms decide, and, if these are zero or do not fall
// below the others, values.
bool Reducer::holds(const ReducedStep& step, std::size_t formula) {
  hidden_.clear();
  constexpr double kFalls = 1e-3, kTolerances = 100, kNearEnd = 31.0 / 32;
  constexpr int kPoints = 7, kNoise = 4096;
  const int degree = step.degree;
  arguments_reach_ = true;
  if (step.h != 0) find_hidden(step, formula);
  if (!arguments_reach_) return false;
  if (degree < 2 || step.h == 0) return step.h == 0 && std::isfinite(polynomial_[0]);
  double power = 1, most = 0, end = 0;
  for (int k = 0; k <= degree; ++k, power *= step.h) {
    const double term = std::abs(polynomial_[static_cast<std::size_t>(k)] * power);
    if (!std::isfinite(term)) return false;
    (k < degree - 1 ? most : end) = std::max(k < degree - 1 ? most : end, term);
  }
  if (!(end <= kFalls * most) && end > 0) return false;
  if (!(end <= kTolerances * tolerance_ * std::max(1.0, most))) return false;
  const auto shows = [&](double x) {
    const FormulaValue there = step.value(formula, x);
    const double foretold = value_at(polynomial_.data(), degree, x);
    return agrees(there.value, foretold, std::max(most, std::abs(there.value))) ||
           std::abs(there.value - foretold) <= kNoise * std::numeric_limits<double>::epsilon() * there.made_of;
  };
  if (step.look && !shows(kNearEnd * step.h)) return false;
  for (int k = 1; end == 0 && k <= kPoints; ++k)
    if (!shows((k - 0.5) / kPoints * step.h)) return false;
  return std::all_of(hidden_.begin(), hidden_.end(), shows);
}

// Finds the points at which functions may hide their variation, by the polynomials of their arguments.
void Reducer::find_hidden(const ReducedStep& step, std::size_t formula) {
  const auto add = [&](const Hiding& function, const std::vector<double>& argument) {
    const std::vector<double> nothing(argument.size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<double> points;
    const int last = static_cast<int>(argument.size()) - 1;
    if (!add_hidden_points(function, argument.data(), nothing.data(), last, 1.0, points)) arguments_reach_ = false;
    for (const double u : points)
      if (u > 0 && u < 1) hidden_.push_back(u * step.h);
  };
  if (step.hiding_polynomials) {
    for (HidingPolynomial& p : step.hiding_polynomials(formula)) {
      double power = 1;
      for (double& c : p.argument) c *= power, power *= step.h;
      if (p.argument.size() > 1 &&
          std::all_of(p.argument.begin(), p.argument.end(), [](double c) { return std::isfinite(c); }))
        add(p.function, p.argument);
    }
  } else if (step.hiding) {
    find_by_values(step, formula, add);
  }
  std::sort(hidden_.begin(), hidden_.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  hidden_.erase(std::unique(hidden_.begin(), hidden_.end()), hidden_.end());
}

// Finds these points if only values are known. The arguments are smooth, so polynomials through a few values suffice.
void Reducer::find_by_values(const ReducedStep& step, std::size_t formula,
                             const std::function<void(const Hiding&, const std::vector<double>&)>& add) {
  const std::size_t count = step.hiding(formula, 0).size();
  if (count == 0) return;
  std::map<double, std::vector<HidingArgument>> seen;
  std::vector<double> argument;
  for (std::size_t k = 0; k < count; ++k) {
    std::optional<Hiding> function;
    const Interpolation of(
        [&](double x) {
          const auto [at, is_new] = seen.try_emplace(x);
          if (is_new) at->second = step.hiding(formula, x);
          if (k >= at->second.size()) return FormulaValue{};
          function = at->second[k].function;
          return FormulaValue{at->second[k].value, 0};
        },
        0, step.h);
    if (of.without_value() > 0) continue;
    of.polynomial(argument);
    add(*function, argument);
  }
}

// Sees polynomial_ over [0, h], in units of `scale`.
void Reducer::see(Seen& s, double h, double scale) {
  std::vector<double>& c = polynomial_;
  const int degree = static_cast<int>(c.size()) - 1;
  s.last = value_at(c.data(), degree, h);
  if (s.mean) {
    double over = 0;
    for (int k = degree; k >= 0; --k) over = over * h + c[static_cast<std::size_t>(k)] / (k + 1);
    add_compensated(s.integral, s.carry, over * h * scale);
    s.weight += std::abs(over * h * scale);
  }
  if (s.greatest) s.most = greatest_on(c.data(), degree, h, s.most);
  if (!s.least) return;
  for (double& x : c) x = -x;
  s.fewest = -greatest_on(c.data(), degree, h, -s.fewest);
}

namespace {

// A part of a step.
struct Piece {
  double from, to;
  int depth;         // the number of halvings
  double error = 0;  // of the interpolation over twice the piece; 0 if there is none

  static constexpr int kDeepest = 48;
  double middle() const { return from + (to - from) / 2; }
  bool divisible() const { return depth < kDeepest && middle() != from && middle() != to; }
};

// Replaces a piece by its halves; `error`: of the interpolation over the piece.
void add_halves(const Piece& p, double error, std::vector<Piece>& left) {
  left.push_back({p.middle(), p.to, p.depth + 1, error});
  left.push_back({p.from, p.middle(), p.depth + 1, error});
}

// Returns the pieces between these points, the first one last.
std::vector<Piece> pieces_between(const std::vector<double>& points, double h) {
  std::vector<Piece> list;
  double end = h;
  for (std::size_t k = points.size(); k-- > 0; end = points[k]) list.push_back({points[k], end, 0});
  list.push_back({0, end, 0});
  return list;
}

}  // namespace

// Halves the step until an interpolation of its values is as good as the tolerance. At a moment where the formula has
// no value, or no derivatives, the pieces become as short as the time can show, and their values represent the formula.
// The formula is unbounded if these values go far beyond all others, and its integral diverges if they weigh in spite
// of the length of the pieces.
void Reducer::see_by_values(const ReducedStep& step, std::size_t formula) {
  constexpr int kFirst = 2, kTiny = 30, kShort = 20, kLongWithout = 8, kMostPieces = 1000;
  Seen& s = seen_[formula];
  const std::function<FormulaValue(double)> f = [&](double x) { return step.value(formula, x); };
  std::vector<Piece> left = pieces_between(hidden_, step.h);
  const auto ends_as = [&](const Interpolation& there, const Piece& p) {
    if (hidden_.empty()) return true;
    there.polynomial(polynomial_);
    const double first = f(p.from).value, last = f(p.to).value;
    return agrees(first, polynomial_[0], std::max(there.size(), std::abs(first))) &&
           agrees(last, value_at(polynomial_.data(), Interpolation::kPoints - 1, 1.0),
                  std::max(there.size(), std::abs(last)));
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double size = 0, weight = 0;                                 // of what is seen
  double most = -kInfinity, fewest = kInfinity, in_doubt = 0;  // of the shortest pieces
  // If a value is a small difference, no interpolation of its round-off is good: a piece is halved only as long as it
  // may contain an extreme or weighs in the mean.
  const auto matters = [&](double lowest, double highest, double length) {
    const double spread = highest - lowest;
    return !(spread * std::abs(length) <= tolerance_ * size * std::abs(step.h)) ||
           (s.greatest && highest + spread > std::max(s.most, most)) ||
           (s.least && lowest - spread < std::min(s.fewest, fewest));
  };
  for (int pieces = 0; !left.empty() && !s.lost;) {
    const Piece p = left.back();
    left.pop_back();
    const bool divisible = p.divisible() && pieces < kMostPieces;
    if (p.depth < kFirst && divisible) {
      add_halves(p, 0, left);
      continue;
    }
    ++pieces;
    const Interpolation there(f, p.from, p.to);
    size = std::max(size, there.size());
    if (there.without_value() > 0) {
      // A motion that stops has no solution at the end of its last step.
      const bool all_beyond = there.beyond_motion() == Interpolation::kPoints && p.depth >= kLongWithout;
      if (all_beyond) s.beyond += p.to - p.from;
      // Round-off may take the values away over a short piece, such as that of sqrt(z) where z comes to 0.
      const bool none_for_short = there.without_value() == Interpolation::kPoints && p.depth >= kShort;
      if (p.depth >= kTiny || all_beyond || none_for_short) {
        const double length = std::abs(p.to - p.from);
        for (const double v : there.values()) {
          if (std::isinf(v)) (v > 0 ? most : fewest) = v;
          if (std::isfinite(v)) in_doubt = std::max(in_doubt, std::abs(v) * length);
        }
        continue;
      }
      s.lost = !divisible || (p.depth >= kLongWithout && there.beyond_motion() == 0 &&
                              there.without_value() == Interpolation::kPoints);
    }
    const auto [lowest, highest] = std::minmax_element(there.values().begin(), there.values().end());
    const bool good = (there.good(tolerance_ * size) || there.is_noisy(p.error)) && ends_as(there, p);
    if (!good && divisible && (there.without_value() > 0 || matters(*lowest, *highest, p.to - p.from))) {
      add_halves(p, there.error(), left);
      continue;
    }
    if (s.lost) break;
    weight += std::abs(there.mean() * (p.to - p.from));
    if (good) {
      there.polynomial(polynomial_);
      see(s, 1, p.to - p.from);
      continue;
    }
    add_compensated(s.integral, s.carry, there.mean() * (p.to - p.from));
    s.weight += std::abs(there.mean() * (p.to - p.from));
    most = std::max(most, *highest), fewest = std::min(fewest, *lowest);
    in_doubt += (*highest - *lowest) * std::abs(p.to - p.from);
    s.last = there.values().back();
  }
  const auto far_beyond = [size](double x, double others) {
    constexpr double kFar = 1e-3;
    return std::isinf(x) || (std::isfinite(others) && x - others > kFar * size);
  };
  if (most > s.most) s.greatest = s.greatest && !far_beyond(most, s.most), s.most = most;
  if (fewest < s.fewest) s.least = s.least && !far_beyond(-fewest, -s.fewest), s.fewest = fewest;
  // Pieces that do not matter are as long as the tolerance allows.
  constexpr double kMostDoubt = 1e-6, kTolerances = 10, kCoarse = 0.1;
  if (in_doubt > std::max(kMostDoubt, std::min(kTolerances * tolerance_, kCoarse)) * weight) s.doubt += in_doubt;
  if (const double end = f(step.h).value; std::isfinite(end)) s.last = end;
}

void Reducer::event(const std::string& name, double t) {
  for (std::size_t i = 0; i < fired_.size(); ++i)
    if (of_->events[i] == name && fired_[i].times++ == 0) fired_[i].first = t;
}

void Reducer::lose_formulas() {
  for (Seen& s : seen_) s.lost = true;
  ends_.assign(of_->ends.size(), std::numeric_limits<double>::quiet_NaN());
}

void Reducer::values(std::vector<double>& to) const {
  to.clear();
  for (const Reduction& r : of_->list) {
    if (r.of_event()) {
      to.push_back(r.kind == Reduction::Kind::count ? fired_[r.of].times : fired_[r.of].first);
      continue;
    }
    if (r.kind == Reduction::Kind::last) {
      to.push_back(ends_[r.of]);
      continue;
    }
    const Seen& s = seen_[r.of];
    const bool none = s.lost || std::isnan(s.last);
    // A step so short that its values are round-off, as between the last impacts of a ball, does not weigh.
    constexpr double kNegligible = 1e-10;
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    switch (r.kind) {
    case Reduction::Kind::greatest:
      to.push_back(none || !s.greatest ? kNone : s.most);
      break;
    case Reduction::Kind::least:
      to.push_back(none || !s.least ? kNone : s.fewest);
      break;
    case Reduction::Kind::mean:
      to.push_back(none || !(s.doubt <= kNegligible * s.weight) ? kNone
                   : length_ == s.beyond                        ? s.last
                                                                : (s.integral + s.carry) / (length_ - s.beyond));
      break;
    case Reduction::Kind::last:
    case Reduction::Kind::count:
    case Reduction::Kind::first:
      break;
    }
  }
}

}  // namespace anholon
