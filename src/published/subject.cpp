#include "published/subject.h"

#include <algorithm>
#include <set>

#include "numeric/number.h"
#include "published/at_points.h"
#include "setup/eliminate.h"

namespace anholon {

namespace {

// Returns the names of symbols; masses have the names that equations use for them.
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
    : open_(with_free_inputs(std::move(open))), choice_(std::move(choice)),
      mechanics_(anholon::mechanics(*open_.model)),
      words_(mechanics_, open_.names, [this](bool quasi) -> const Elimination& { return elimination(quasi); }),
      comparer_(mechanics_, elimination(false), names_of(*open_.model)), alphabet_(alphabet_of(*open_.model)) {}

OpenModel Subject::with_free_inputs(OpenModel open) {
  const std::vector<Parameter>& parameters = open.model->parameters;
  for (std::size_t k = 0; k < parameters.size(); ++k)
    if (!parameters[k].mode) numbered_.push_back({parameters[k].name, parameters[k].value, false, k});
  std::set<std::size_t> free;
  for (std::size_t k = 0; k < open.model->controls.size(); ++k) {
    const Control& u = open.model->controls[k];
    if (!u.value || !is_number(*u.value) || u.constraint || !u.put_into.empty()) continue;
    numbered_.push_back({u.name, *u.value, true, k});
    free.insert(k);
  }
  if (free.empty()) return open;
  as_read_ = open.model;
  auto model = std::make_shared<Model>(*open.model);
  for (const std::size_t k : free) model->controls[k].value.reset();
  put_inputs_into_inputs(*model, free);
  put_inputs(*model);
  open.model = std::move(model);
  return open;
}

struct Subject::WithNumbers {
  Model model;
  std::unordered_map<NodeId, Expr> values;  // values of parameters and inputs
  Mechanics mechanics;
  Elimination elimination;
  std::optional<Comparer> comparer;

  Expr put(Expr e) const {
    return substitute({&e, 1}, [&](NodeId id) {
      const auto at = values.find(id);
      return at == values.end() ? Expr{} : at->second;
    })[0];
  }

  Comparison decide(Expr difference) { return comparer->decide(put(difference)); }
  bool proves(Expr difference) {
    const Expr P = put(difference);
    EquationsOfMotion& motion = comparer->motion(order_of_motion(P));
    if (motion.regular && !vanishes(P, motion.on_motion())) return false;
    return comparer->decide(P).verdict == Verdict::proved;
  }
};

Subject::~Subject() = default;

Subject::WithNumbers& Subject::with_numbers(const Parameters& of) {
  std::unique_ptr<WithNumbers>& out = with_numbers_[of];
  if (out) return *out;
  out = std::make_unique<WithNumbers>();
  out->model = *open_.model;
  Graph& g = *out->model.graph;
  std::unordered_map<NodeId, Expr> given;
  for (std::size_t k : of)
    if (!numbered_[k].input)
      given.emplace(g.parameter(static_cast<std::uint32_t>(numbered_[k].index)).id, numbered_[k].value);
  for (std::size_t k : of) {
    const Numbered& number = numbered_[k];
    const auto index = static_cast<std::uint32_t>(number.index);
    if (number.input) {
      constexpr std::uint32_t kMostRates = 4;
      out->values.emplace(g.control(index, 0).id, number.value);
      for (std::uint32_t order = 1; order <= kMostRates; ++order)
        out->values.emplace(g.control(index, order).id, g.zero());
      continue;
    }
    // A value may refer to other parameters.
    Expr value = number.value;
    for (std::size_t depth = 0; depth <= of.size() && !symbols({&value, 1}).empty(); ++depth)
      value = substitute({&value, 1}, [&](NodeId id) {
        const auto at = given.find(id);
        return at == given.end() ? Expr{} : at->second;
      })[0];
    out->values.emplace(g.parameter(index).id, value);
  }
  for_each_expression(out->model, [&](Expr& e) {
    if (e.graph) e = out->put(e);
  });
  out->mechanics = anholon::mechanics(out->model);
  out->elimination = elimination_for(out->mechanics, Unknowns::coordinates, choice_.overrides, choice_.eliminate, true,
                                     0, as_read_.get());
  out->comparer.emplace(out->mechanics, out->elimination, names());
  return *out;
}

Subject::Parameters Subject::needed_for(Expr difference, const std::function<bool(const Numbered&)>& may) {
  constexpr std::size_t kMostFreed = 12;  // if there are more parameters, none of them is freed
  Parameters needed;
  for (std::size_t k = 0; k < numbered_.size(); ++k)
    if (may(numbered_[k])) needed.push_back(k);
  try {
    if (needed.empty() || !with_numbers(needed).proves(difference)) return {};
    for (std::size_t k = needed.size(); k-- > 0 && needed.size() <= kMostFreed;) {
      Parameters fewer = needed;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(k));
      if (!fewer.empty() && with_numbers(fewer).proves(difference)) needed = std::move(fewer);
    }
  } catch (const Failure&) {
    return {};
  }
  return needed;
}

std::string Subject::values_of(const Parameters& of) {
  std::string text;
  Graph& g = *open_.model->graph;
  for (std::size_t k : of) {
    const auto index = static_cast<std::uint32_t>(numbered_[k].index);
    const Expr symbol = numbered_[k].input ? g.control(index, 0) : g.parameter(index);
    const Expr value = with_numbers(of).values.at(symbol.id);
    text += (text.empty() ? "" : ", ") + numbered_[k].name + " = " +
            (is_number(value) ? exact_text_if_short(number_value(value)) : print(value, names(), Format::text));
  }
  return text;
}

std::optional<Comparison> Subject::by_formulas(Expr difference) {
  const Parameters needed = needed_for(difference, has_formula);
  if (needed.empty()) return std::nullopt;
  Comparison c = with_numbers(needed).decide(difference);
  c.what += ", with " + values_of(needed) + " put in";
  return c;
}

Comparison Subject::compare(const PublishedEquation& equation) {
  Comparison c;
  try {
    const Expr P = difference(equation);
    if (std::any_of(numbered_.begin(), numbered_.end(), has_formula) && comparer_.decide(P).verdict != Verdict::proved)
      if (auto proved = by_formulas(P)) return *std::move(proved);
    c = comparer_.compare(equation, words_, alphabet_);
  } catch (const Failure& f) {
    c = {};
    c.detail = "line " + std::to_string(equation.span.line) + ": " + f.diagnostic.message +
               " where the derived equations hold";
    return c;
  }
  if (!c.has_value) return c;
  if (c.verdict == Verdict::unknown || (c.verdict == Verdict::refuted && !c.in_places && c.changes.empty()))
    c.with_numbers = values_of(needed_for(difference(equation), [](const Numbered&) { return true; }));
  return c;
}

const Elimination& Subject::elimination(bool quasi) {
  std::unique_ptr<const Elimination>& known = eliminations_[quasi];
  if (!known)
    known = std::make_unique<const Elimination>(
        elimination_for(mechanics_, quasi ? Unknowns::quasi_velocities : Unknowns::coordinates, choice_.overrides,
                        choice_.eliminate, true, 0, as_read_.get()));
  return *known;
}

}  // namespace anholon
