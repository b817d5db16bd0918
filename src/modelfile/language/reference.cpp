#include "modelfile/language/reference.h"

#include <algorithm>

#include "base/diagnostic.h"
#include "formula/units.h"
#include "modelfile/language/language.h"

namespace anholon {

namespace {

using Form = LanguageSection::Form;

// The model that examples complete.
constexpr const char* kModel = R"md(```toml model.toml
coordinates = ["x", "y", "theta"]
parameters = {m = 2, J = "1/2", R = 0.3, g = 9.81}
frame.B = "rotz(theta)"
point.P = "x*ex + y*ey"
body = [{name = "plate", mass = "m", inertia = "J", center = "P", orientation = "B"}]
```
)md";

constexpr const char* kStart = R"md(# The language of model files

This page is printed by `anholon reference`, from the table that the reader of model files uses; `anholon reference event` prints one section.
Every example on it is run by a test. Those that are no whole model complete this one:

)md";

constexpr const char* kFiles = R"md(
A model file is [TOML 1.0](https://toml.io) with formulas as strings. `anholon new pendulum -o mine.toml` writes one to start from, `anholon check
mine.toml` says what is read, `anholon fmt mine.toml` formats it. Editors with a language server for TOML (Taplo, Even Better TOML)
complete and check keys by [anholon.schema.json](anholon.schema.json), named in the first line of the file:

```toml
#:schema ./anholon.schema.json
monitor = {height = "P.y"}
```

The name is a path relative to the model file, or a URL. `anholon reference --schema > anholon.schema.json` writes the schema. For the program the
line is a comment.

## Formulas

```toml
[define]
kinetic  = "m/2*norm2(vel(P)) + J/2*theta'^2"
sideways = "dot(vel(P), B.y)"      # a component along an axis
along_x  = "vel(P).x"              # of the observer
climb    = "D(y, 3)"               # the third derivative, y'''
switch   = "piecewise(x > 1, 1, x > 0, x, 0)"
```

- A formula has a type: number, vector or rotation; a wrong type is an error with its place. A vector may be written as an array of three
  formulas along ex, ey, ez. `0` is also the zero vector. A formula that is only a number needs no quotes.
- `+ - * / ^`, in the order of mathematics: `-x^2` is −(x²), `2^3^2` is 2^(3^2), `a/b*c` is (a/b)·c. A product needs its `*`. `a*b` of two vectors is an
  error: write `dot` or `cross`.
- `'` is the total derivative by time of a number or vector: of a coordinate, a definition or a function. Derivatives go up to order 20.
- Numbers are exact: `0.1` is 1/10, `1e-3` is 1/1000. `1/2` is a formula: in quotes.
- `x²`, `x³`, `·`, `×`, `−`, `≤`, `≥` are read. A Greek letter and its spelled name are one name: `θ` is `theta`, in keys, too (`"θ'" = 0.2`).
- Names are letters, digits and `_`. A name before `(` is a function, elsewhere a value, so that a parameter may be called `D`. Values
  share one set of names, bodies have another.
- A text in three quotes may go over several lines and hold `# comments`.

```toml
define.a = "cross(vel(P), ex)*ey"
```
```text
error: product of two vectors
```
```toml
monitor.a = "2x"
```
```text
error: an operator is missing before 'x'
```

**Kinks.** `abs`, `sign`, `min`, `max`, `piecewise`, `choose` and tables switch to another function where their conditions change sign along the
motion; `atan2(y, x)` switches where y changes sign at a negative x. The program locates the time of the switch and ends a step there; the next step
uses the function that holds after the switch. BDF, a method for stiff motions, does so where the time alone decides; elsewhere its steps become short at
a switch, and one that is taken back within a step may be missed. The argument of `sqrt`, `norm`, `unit` or of a power may be zero at the start (a ball with quadratic
drag falls from rest) or on the way; the motion then goes on with the values on the side that it enters. If this side is not determined (dry friction
that holds, a thrust along a velocity that is zero), the motion stops, and the outcome names the formula. A row at exactly that moment holds the value
there: `sign` is 0, and `unit` has no value (`nan`); accelerations are those right after it.

**Powers.** `x^n` has a value at x = 0 and below only if `n` is known to be a whole number: a number of the formula, or a parameter such as `n = 3`, which is then put into the
equations of a motion, the formulas of its contacts and those of reductions. A sweep over `n` derives each case with a whole exponent anew, and so
does a function of states (`dynamics` in Python) for an `n` in its parameters. For other
exponents, and for those that depend on a mode, write `abs(x)^n*sign(x)` or `abs(x)^n`.

**Conditions** `a > b`, `>=`, `<`, `<=` stand in `piecewise` only.

)md";

constexpr const char* kUnits = R"md(
### Units

```toml
[parameters]
height = "6371 km"
mu     = "3.986e14 m^3/s^2"
tilt   = "30 deg"
push   = "2*(10 N + 3 kp)"
```

- A quantity is a number, a blank and a unit, and is converted to SI exactly. The factors of a unit stand without blanks between them, `kg*m^2`, with
  whole powers; `/` divides by the next factor only: `m/s/s`, `J/kg/K`. `10 1/s` is `10 s^-1`.
- After a number and a blank, a name is a unit even if the file defines the same name: with a parameter `m`, `3 m` is a length and `3*m` is three
  times the parameter. A unit ends before a name that is not a unit: `10 m/s*R` is a velocity times the parameter R. Write `(10 m/s)*m` to multiply by
  a parameter m.
- `t` is a tonne only right after the number: `5 t`; elsewhere, as in `5 m/s*t`, it is the time.
- A bare number fits any dimension, so files without units need none. If a file has units, the dimensions of all its formulas must agree: in sums, on
  both sides of equations, in arguments of `sin`, and in the keys of forces and bodies. In such a file a bare number as a term of a sum, like the 2 of
  `2 + r` with a length r, counts in SI units, and a warning names it; `0` has any unit, and `1*2` says that 2 is meant in SI.
- An angle is a pure number: `rad` is 1, `deg` is pi/180.
- Prefixes `Y Z E P T G M k h da d c m u (or mu) n p f a z y` stand before units marked ⁺.

```toml
parameters.l = "3 m"
define.s = "l + 2 s"
```
```text
error: a length (m) plus a time (s)
```

)md";

// A rule for a formula whose meaning is not obvious; the test of the page checks it.
struct Decision {
  const char* formula;
  const char* value;
  const char* why;
};
constexpr Decision kDecisions[] = {
    {"-x^2", "-9", "a power before a minus"},
    {"2^3^2", "512", "powers from the right"},
    {"8/2*4", "16", "division and product from the left"},
    {"1/2*x", "1.5", "likewise"},
    {"2**3 + x²", "17", "other ways to write powers"},
    {"ex×ey·ez", "1", "of vectors"},
    {"piecewise(x > 3, 1, 2)", "2", "3 is not above 3"},
    {"piecewise(x >= 3, 1, 2)", "1", ""},
    {"choose(0, 7, 8)", "7", "below 1: the first"},
    {"choose(1.4, 7, 8)", "7", "rounded"},
    {"choose(9, 7, 8)", "8", "above their number: the last"},
    {"sign(x - 3)", "0", "at rest there"},
    {"atan2(0, -1)", "3.141592653589793", "pi, not -pi"},
    {"norm(0*ex)", "0", ""},
    {"3*m", "6", "m is a parameter"},
    {"3 m", "3", "three metres"},
    {"10 m/s*m", "10", "m is a unit within a unit"},
    {"3 1/s^2", "3", "the unit is s^-2"},
    {"10 m/s*R", "3", "R is none"},
    {"5 t", "5000", "tonnes"},
    {"5 m/s*t", "5", "the time"},
    {"2 min", "120", "minutes; `min(…)` is the function"},
    {"30 deg", "0.5235987755982989", ""},
};

std::string cell(std::string text) {
  std::string out;
  for (char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out;
}

std::string rows(const std::vector<FunctionRow>& table) {
  std::string out = "| | |\n|---|---|\n";
  for (const FunctionRow& r : table) out += "| `" + cell(r.call) + "` | " + cell(r.meaning) + " |\n";
  return out;
}

std::string formulas() {
  std::string out = std::string(kStart) + kModel + kFiles;
  out += "### Functions\n\n" + rows(function_table());
  out += "\n### Decided\n\nIn the model above with x = 3, everything at rest, at t = 1:\n\n| formula | value | "
         "|\n|---|---|---|\n";
  for (const Decision& d : kDecisions) out += "| `" + cell(d.formula) + "` | " + d.value + " | " + d.why + " |\n";
  out += "\n### Kinematics\n\n" + rows(kinematic_functions());
  out += "\n### Reserved names\n\n| | |\n|---|---|\n";
  for (const ReservedName& r : reserved_names()) out += std::string("| `") + r.name + "` | " + r.meaning + " |\n";
  out += "\nLikewise the letters of `[index]`.\n";
  out += kUnits;
  out += "| | | |\n|---|---|---|\n";
  for (const UnitRow& u : unit_table()) {
    const std::string dimension = print(find_unit(u.name)->dimension);
    out += std::string("| `") + u.name + "`" + (u.prefixes ? "⁺" : "") + " | " + u.meaning + " | " + u.factor +
           (u.pi == 1 ? "·pi" : "") + (dimension == "1" ? "" : " " + dimension) + " |\n";
  }
  return out;
}

const char* describe(Content c) {
  switch (c) {
  case Content::text:
    return "text";
  case Content::name:
    return "name";
  case Content::names:
    return "list of names";
  case Content::formula:
    return "formula";
  case Content::vector:
    return "vector";
  case Content::rotation:
    return "rotation";
  case Content::equation:
    return "equation";
  case Content::equations:
    return "list of equations";
  case Content::number:
    return "number";
  case Content::numbers:
    return "list of numbers";
  case Content::truth:
    return "true or false";
  case Content::choice:
    return "";
  case Content::inertia:
    return "number, list or matrix";
  case Content::place:
    return "name or table";
  case Content::columns:
    return "two names";
  case Content::formulas:
    return "table of formulas";
  case Content::values:
    return "table of values";
  case Content::any:
    return "";
  }
  return "";
}

std::string heading(const LanguageSection& s) {
  const std::string name = s.name;
  switch (s.form) {
  case Form::top:
    return "The file";
  case Form::keys:
    return "`[" + name + "]`";
  case Form::elements:
    return "`[[" + name + "]]`";
  case Form::named:
    return name == "case" ? "`[case.NAME]`" : "`[" + name + "]`";
  case Form::part:
    return "`{…}` of `" + name + "`";
  }
  return name;
}

std::string part(const LanguageSection& s) {
  std::string out = std::string(s.form == Form::part ? "#### " : "## ") + heading(s) + "\n\n";
  if (s.form == Form::named && s.keys.empty() && s.content != Content::any)
    out += std::string("Entries: `NAME` = ") +
           (std::string(s.name) == "index" ? "whole number or range" : describe(s.content)) + ".\n\n";
  std::string page = s.page;
  if (!s.keys.empty()) {
    if (s.form == Form::named && std::string(s.name) != "initial")
      out += "Either the value alone or a table with these keys:\n\n";
    out += "| key | | |\n|---|---|---|\n";
    for (const LanguageKey& k : s.keys) {
      std::string kind = describe(k.content);
      for (std::size_t i = 0; i < k.choices.size(); ++i) kind += (i ? ", " : "") + ("`\"" + k.choices[i] + "\"`");
      out += std::string("| `") + k.name + "` | " + kind + " | " + cell(k.meaning) + " |\n";
    }
    if (!page.empty()) out += "\n";
  }
  return out + page;
}

}  // namespace

std::string reference_page() {
  std::string out = formulas();
  for (const LanguageSection& s : language()) out += "\n" + part(s);
  return out;
}

// Returns words for the chapter on formulas, which also describes units.
static const std::vector<std::string>& words_of_formulas() {
  static const std::vector<std::string> words = {"formulas", "formula", "units", "unit", "numbers"};
  return words;
}

static bool is_about_formulas(const std::string& word) {
  const std::vector<std::string>& words = words_of_formulas();
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool is_in_reference(const std::string& word) { return is_about_formulas(word) || find_subject(word); }

std::vector<std::string> reference_words() {
  std::vector<std::string> known = words_of_formulas();
  for (const LanguageSection& s : language()) {
    if (s.form == Form::part) continue;
    if (s.form != Form::top) known.emplace_back(s.name);
    known.insert(known.end(), s.words.begin(), s.words.end());
  }
  return known;
}

std::string reference_section(const std::string& word) {
  if (is_about_formulas(word)) return formulas();
  if (const LanguageSection* s = find_subject(word)) {
    const std::string text = part(*s);
    return text.find("```toml\n") == std::string::npos
               ? text
               : text + "\nExamples that are no whole model complete this one, by `base = \"model.toml\"`:\n\n" +
                     kModel;
  }
  std::string list = "there is formulas";
  for (const LanguageSection& s : language())
    if (s.form != Form::part && s.form != Form::top) list += ", " + std::string(s.name);
  const std::string near = did_you_mean(word, reference_words());
  throw Failure(Span{},
                "there is no section '" + word.substr(0, 40) + "'" +
                    (near.empty() ? "" : "; did you mean '" + near + "'?"),
                near.empty() ? list : "");
}

}  // namespace anholon
