#include "modelfile/motion/simulate.h"

#include <algorithm>

#include "modelfile/text/keys.h"
#include "numeric/number.h"

namespace anholon {

static constexpr long kMostRows = 5'000'000;  // a request for more rows is refused at once

static Rational rational(const Item& i, Scope& scope) {
  const Expr e = scope.number(i);
  if (!is_number(e))
    throw Failure(i.span, "'" + i.key + "' is a plain number",
                  i.key != "to"
                      ? ""
                      : "a motion of a length that a formula tells ends with an event: [[event]] with when = \"t - (" +
                            i.text() + ")\" and stop = true, and a number for 'to' that is larger");
  return number_value(e);
}

static OptionValue value(const Item& i, const MotionOption& option, Scope& scope) {
  if (std::holds_alternative<std::vector<WrittenTime> MotionSettings::*>(option.member)) {
    if (i.kind != Item::Kind::array) throw Failure(i.span, "'" + i.key + "' is a list of times");
    std::vector<WrittenTime> times;
    for (const Item& t : i.items) times.push_back({rational(t, scope), {}});
    return times;
  }
  const bool word = std::holds_alternative<std::optional<std::string> MotionSettings::*>(option.member);
  if (!word || (i.kind != Item::Kind::string && option.also_number)) return rational(i, scope);
  if (i.kind != Item::Kind::string)
    throw Failure(i.span, "'" + i.key + "' is a name in quotes",
                  i.key + " = \"" + (option.choices ? option.choices().front() : "routh") + "\"");
  return i.text();
}

// Returns the hint: method = "auto", "taylor", "rk" or "bdf".
static std::string values_of(const MotionOption& option) {
  const std::vector<std::string>& choices = option.choices();
  std::string text = std::string(option.key) + " = ";
  for (std::size_t k = 0; k < choices.size(); ++k)
    text += (k == 0 ? "" : k + 1 < choices.size() ? ", " : " or ") + ("\"" + choices[k] + "\"");
  return text;
}

static void check_times(const Item& section, const Model& model) {
  const MotionSettings& s = model.simulate;
  const Rational start = is_number(model.initial.t) ? number_value(model.initial.t) : Rational(0);
  if (s.every && s.to && abs(Rational(*s.to - start)) > kMostRows * *s.every)
    throw Failure(section.find("every")->span, "'every' asks for more than " + std::to_string(kMostRows) + " rows");
  const auto side = [&](int sign) {
    return std::any_of(s.at.begin(), s.at.end(),
                       [&](const WrittenTime& t) { return sgn(Rational(t.value - start)) == sign; });
  };
  if (side(-1) && side(1))
    throw Failure(section.find("at")->span, "some of these times lie before the start, others after it",
                  "one run goes one way");
  if (!s.to) return;
  const auto [low, high] = std::minmax(start, *s.to);
  for (const WrittenTime& t : s.at)
    if (t.value < low || t.value > high)
      throw Failure(section.find("at")->span,
                    "the time " + exact_text_if_short(t.value) + " lies " +
                        ((t.value < low) == (start <= *s.to) ? "before the start, t = " + exact_text_if_short(start)
                                                             : "beyond the end, t = " + exact_text_if_short(*s.to)),
                    "'at' asks for rows between the start and 'to'");
}

void read_simulate(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* s = find_section(root, "simulate", diagnostics);
  if (!s) return;
  check_keys(*s, "[simulate]", "simulate", diagnostics);
  for (const MotionOption& option : motion_options())
    if (const Item* i = s->find(option.key)) {
      const OptionValue v = value(*i, option, scope);
      if (const auto* times = std::get_if<std::vector<WrittenTime>>(&v); times && times->empty()) continue;
      try {
        set(model.simulate, option, v, "'" + i->key + "'");
      } catch (const Failure& f) {
        throw Failure(i->span, f.diagnostic.message, option.choices ? values_of(option) : f.diagnostic.hint);
      }
      if (option.member == motion_option("form").member) model.simulate.form_span = i->formula.whole();
    }
  check_times(*s, model);
}

}  // namespace anholon
