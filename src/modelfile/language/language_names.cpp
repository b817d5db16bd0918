// The language: names for numbers, functions, vectors and rotations.
#include "modelfile/language/language.h"

namespace anholon {

using enum Content;
using Form = LanguageSection::Form;

std::vector<LanguageSection> language_of_names() {
  return {
      {"parameters",
       Form::named,
       values,
       {{"value", vector, "a number, a formula of other parameters, or a vector"},
        {"unit", text,
         "its unit, as behind a number; a bare number from outside (`--set`, `--vary`, a table of cases, `with_` in "
         "Python) is one of this unit, too, and so are the numbers of the parameter in sweeps, tables, plots and "
         "`model.parameters`; formulas, functions of `dynamics` and generated programs have it in SI units"},
        {"doc", text, "what it is, for reports"}},
       R"md(```toml
[parameters]
l     = 0.7                        # exactly 7/10
k     = "2*m*g/l"                  # of other parameters, in any order
angle = "30 deg"
axis  = ["1", "0", "l"]            # a vector
c     = {value = 3, unit = "N*s/m", doc = "of the damper"}
```

- A parameter is constant: what depends on t stands under `[functions]`, what depends on coordinates under `[define]`.
- `--set l=0.8` gives another value; parameters that depend on `l` change with it. Decimals are exact, `0.1` is 1/10.
)md",
       {"parameter", "constants"}},
      {"functions",
       Form::named,
       formula,
       {},
       R"md(```toml
[functions]
mass     = "m - 0.05*t"            # used as mass or mass(t); mass' is its derivative
"rho(h)" = "1.2*exp(-h/8500)"      # used with an argument: rho(y)
"mix(a, b)" = "(a + b)/2"
wind     = {}                      # unknown: derived and proved with, not integrated
```

- Functions of t do not depend on coordinates. Functions with arguments may hold anything: names that are not arguments mean what they mean
  in the file. An argument hides a name of the file.
- A function that jumps is written with `piecewise`: `push = "piecewise(t < 1, 0, t < 3, 5, 0)"` is 0, from t = 1 on 5, and from t = 3 on 0 again.
  A motion makes a step to each jump.
- `f(2*t)` puts the argument in place of t; `f'` is the derivative by time. Of functions with arguments: `D(rho(y), 1)`.
)md",
       {"function"}},
      {"define",
       Form::named,
       any,
       {},
       R"md(```toml
[define]
speed = "norm(vel(P))"
v     = "vel(P)"                   # a vector
nose  = ["x", "y + R", "0"]        # a vector, too
turn  = "rotz(2*theta)"            # a rotation; with axes turn.x
```

- A definition is a name for a formula of any type. Printed equations show the name where the formula occurs as a whole.
- A definition that contains `lambda.NAME` or `reaction(B)` may be used in monitors, outputs, rates, conditions and events; forces and constraints
  refuse it.
)md",
       {"definition", "definitions"}},
      {"frame",
       Form::named,
       rotation,
       {},
       R"md(```toml
[frame]
lean  = "rotz(theta)*rotx(0.2)"    # about z, then about the new x
wheel = "lean*roty(x/R)"
[define]
tip   = "lean(0, R, 0)"            # 0 lean.x + R lean.y + 0 lean.z
```

- A frame is a rotation from the observer's axes. `lean.x` is an axis of the frame, a vector.
- Rotations are active and right-handed; products are read from left to right, and each factor turns about the axes that the factors before it have
  turned.
)md"},
      {"point",
       Form::named,
       vector,
       {},
       R"md(```toml
[point]
Q = "P + R*B.x"
O = "0"                            # the origin
S = ["1", "0", "x"]                # components along ex, ey, ez
```

- A position vector from the origin of the observer. Points and bodies may share a name: the body is meant where a body is wanted.
)md"},
      {"table",
       Form::elements,
       any,
       {{"name", name, "it is called as a function: `Cd(mach)`"},
        {"x", numbers, "the knots, ascending, at least two"},
        {"y", numbers, "the values there"},
        {"file", text,
         "instead of x and y: a text file of columns, relative to the file in which the name stands; lines with # are "
         "skipped"},
        {"columns", columns, "two names of the heading, or numbers from 1; the first two without it"},
        {"fit",
         choice,
         "between the knots: a step, straight, a cubic with one continuous derivative and no overshoot, a natural "
         "cubic spline",
         {"hold", "linear", "monotone", "spline"}},
        {"outside",
         choice,
         "beyond the knots: the last value, the tangent, or the motion ends",
         {"hold", "linear", "error"}}},
       R"md(```toml
table = [
  {name = "Cd", x = [0, 0.8, 1.2, 3], y = [0.3, 0.3, 0.5, 0.3]},
  {name = "lift", x = [0, 1, 2], y = [0, 1, 4], fit = "spline", outside = "error"},
]
force = [{on = "plate", vector = "-Cd(norm(vel(P)))*vel(P)"}]
monitor = {l = "lift(1)"}
```

- The defaults are `fit = "linear"` and `outside = "hold"`. With `fit = "hold"` the value is that of the knot below. Values are exact; those of a
  spline with many knots have 120 digits.
- A step of the motion ends at each knot. `linear` may be differentiated once, `monotone` twice, `spline` three times, where the last derivative jumps
  at the knots; `hold` not at all. A formula that needs more is an error.
- The slope of `monotone` at a knot is the weighted harmonic mean of the slopes on both sides (Fritsch and Butland 1984), 0 where these differ in
  sign, and at the first and the last knot the slope beside it. `pchip` of SciPy and MATLAB is the same but for the slopes at these two knots
  ([theory](theory/events.md#tables)).
- With `outside = "error"` the motion stops with an outcome where the argument leaves the knots, also at the start. Functions of states and
  exported programs have no value there (`nan`).
- The numbers of a table have no units and fit any dimension. In a file with units the call says which are meant:
  `Cd(t/(1 ms))*(1 N)` for columns of milliseconds and newtons.

```toml
table = [{name = "a", x = [0, 1], y = [0, 1]}]
monitor = {i = "D(a(x), 1)", j = "D(a(x), 2)"}
```
```text
error: a derivative of order 2 of the table 'a', which its fit does not have
```

Columns of a file stand between semicolons if a line has any, else between commas, else between blanks. Numbers have a decimal point. A column that `columns` names stands once in the heading, and a row has
no more cells than the first line; empty ones at the end of a line do not count.

```csv drag.csv
mach,drag,lift
0,0.3,0
1,0.5,0.1
```
```toml
[[table]]
name = "drag"
file = "drag.csv"
columns = ["mach", "drag"]
```
)md",
       {"data", "interpolation", "spline"}},
      {"notation",
       Form::named,
       text,
       {},
       R"md(```toml
[notation]
theta = '\vartheta'
m     = 'm_{\mathrm{p}}'
```

- How a name is written in LaTeX and MathML. `'…'` is a text of TOML without escapes. A name that the file does not have is an error.
)md"},
  };
}

}  // namespace anholon
