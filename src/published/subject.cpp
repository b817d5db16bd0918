#include "published/subject.h"

#include <algorithm>

#include "numeric/number.h"
#include "published/at_points.h"
#include "setup/eliminate.h"

namespace anholon {

namespace {

// Masses get the names that equations use for them.
SymbolNames names_of(const Model& model) {
  SymbolNames names = model.names;
  for (std::size_t i = 0; i < model.masses.size(); ++i) names.masses[i] = mass_name(model, i);
  return names;
}

Alphabet alphabet_of(const Model& model) {
  Alphabet a{model.names.coordinates, {}, model.names.multipliers, {}, {}};
  for (const Parameter& p : model.parameters) a.others.push_back(p.name);
  std::vector<std::string> defined;
  for (const auto& [id, name] : model.names.defined) defined.push_back(name);
  std::sort(defined.begin(), defined.end());
  a.others.insert(a.others.end(), defined.begin(), defined.end());
  a.others.insert(a.others.end(), model.unknown_functions.begin(), model.unknown_functions.end());
  for (const VaryingMass& m : model.masses) a.masses.push_back(m.name);
  for (const QuasiVelocity& u : model.quasi) a.free.push_back(u.name);
  return a;
}

}  // namespace

Subject::Subject(OpenModel open, StateChoice choice)
    : open_(std::move(open)), choice_(std::move(choice)), mechanics_(anholon::mechanics(*open_.model)),
      words_(mechanics_, open_.names, [this](bool quasi) -> const Elimination& { return elimination(quasi); }),
      comparer_(mechanics_, elimination(false), names_of(*open_.model)), alphabet_(alphabet_of(*open_.model)) {}

struct Subject::WithNumbers {
  Model model;
  std::unordered_map<NodeId, Expr> values;  // of the parameters
  Mechanics mechanics;
  Elimination elimination;
  std::optional<Comparer> comparer;

  Expr put(Expr e) const {
    return substitute({&e, 1}, [&](NodeId id) {
      const auto at = values.find(id);
      return at == values.end() ? Expr{} : at->second;
    })[0];
  }

  bool proves(Expr difference) {
    const Expr P = put(difference);
    EquationsOfMotion& motion = comparer->motion(order_of_motion(P));
    if (motion.regular && !vanishes(P, motion.on_motion())) return false;
    return comparer->decide(P).verdict == Verdict::proved;
  }
};

Subject::~Subject() = default;

std::unique_ptr<Subject::WithNumbers> Subject::with_numbers(const Parameters& of) {
  auto out = std::make_unique<WithNumbers>();
  out->model = *open_.model;
  Graph& g = *out->model.graph;
  const std::vector<Parameter>& all = open_.model->parameters;
  for (std::size_t k : of) {
    // A value may refer to other parameters.
    Expr value = all[k].value;
    for (std::size_t depth = 0; depth <= all.size() && !symbols({&value, 1}).empty(); ++depth)
      value = substitute({&value, 1}, [&](NodeId id) {
        const Node& n = g.node(id);
        return n.kind == Kind::parameter ? all[n.index].value : Expr{};
      })[0];
    out->values.emplace(g.parameter(static_cast<std::uint32_t>(k)).id, value);
  }
  for_each_expression(out->model, [&](Expr& e) {
    if (e.graph) e = out->put(e);
  });
  out->mechanics = anholon::mechanics(out->model);
  out->elimination = elimination_for(out->mechanics, Unknowns::coordinates, choice_.overrides, choice_.eliminate);
  out->comparer.emplace(out->mechanics, out->elimination, names());
  return out;
}

std::string Subject::numbers_that_make_true(Expr difference) {
  constexpr std::size_t kMostFreed = 12;  // parameters of which it is tried whether they may stay free
  const std::vector<Parameter>& all = open_.model->parameters;
  Parameters needed;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (!all[k].mode) needed.push_back(k);
  if (needed.empty()) return {};
  try {
    if (!with_all_numbers_) with_all_numbers_ = with_numbers(needed);
    if (!with_all_numbers_->proves(difference)) return {};
    for (std::size_t k = needed.size(); k-- > 0 && needed.size() <= kMostFreed;) {
      Parameters fewer = needed;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      if (!fewer.empty() && with_numbers(fewer)->proves(difference)) needed = std::move(fewer);
    }
  } catch (const Failure&) {
    return {};
  }
  std::string text;
  for (std::size_t k : needed) {
    const Expr value = with_all_numbers_->values.at(open_.model->graph->parameter(static_cast<std::uint32_t>(k)).id);
    text += (text.empty() ? "" : ", ") + all[k].name + " = " +
            (is_number(value) ? number_text(number_value(value).get_d()) : print(value, names(), Format::text));
  }
  return text;
}

Comparison Subject::compare(const PublishedEquation& equation) {
  Comparison c;
  try {
    c = comparer_.compare(equation, words_, alphabet_);
  } catch (const Failure& f) {
    c = {};
    c.detail = "line " + std::to_string(equation.span.line) + ": " + f.diagnostic.message +
               " where the derived equations hold";
    return c;
  }
  if (c.verdict == Verdict::unknown || (c.verdict == Verdict::refuted && !c.in_places && c.changes.empty()))
    c.with_numbers = numbers_that_make_true(difference(equation));
  return c;
}

const Elimination& Subject::elimination(bool quasi) {
  std::unique_ptr<const Elimination>& known = eliminations_[quasi];
  if (!known)
    known = std::make_unique<const Elimination>(elimination_for(
        mechanics_, quasi ? Unknowns::quasi_velocities : Unknowns::coordinates, choice_.overrides, choice_.eliminate));
  return *known;
}

}  // namespace anholon
