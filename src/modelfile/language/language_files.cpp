// The language: the file itself, bases, cases, and families.
#include "modelfile/language/language.h"

namespace anholon {

using enum Content;
using Form = LanguageSection::Form;

std::vector<LanguageSection> language_of_files() {
  return {
      {"",
       Form::top,
       any,
       {{"title", text, "one line for reports"},
        {"source", text, "where the system comes from"},
        {"coordinates", names, "the order is that of q everywhere"},
        {"dependent", names, "coordinates that forms without multipliers eliminate; without it they are chosen"},
        {"base", text, "a file to start from"}},
       R"md(```toml
title = "Skate on ice"
source = "Caratheodory 1933"
coordinates = ["x", "y", "theta"]
dependent = ["y"]
body = [{name = "skate", mass = 2, inertia = 0.1, center = "x*ex + y*ey", angle = "theta"}]
constraint = [{name = "edge", equation = "y'*cos(theta) = x'*sin(theta)"}]
```

- Only `coordinates` and one body or particle must be there. Sections and names may come in any order: a name is looked up
  when it is needed, and a definition that needs itself is an error that prints the path.
- TOML requires that keys of the top of the file stand before the first `[section]`. There, `body = [{…}]` means the same as `[[body]]`, and
  `frame.B = "…"` the same as `B = "…"` under `[frame]`. A key with other characters than `A-Z a-z 0-9 _ -` stands in quotes: `"x'" = 1`,
  `"P[0]" = "0"`.
- By TOML's rules, each section occurs once, and a list is written either as `body = [{…}]` or as `[[body]]`, not in both ways:

```toml
coordinates = ["x"]
body = [{name = "a", mass = 1, center = "x*ex"}]
[[body]]
name = "b"
center = "0"
```
```text
error: 'body' is a list in one place and [[body]] in another
```

- All errors of a file are reported at once, except those against TOML itself, such as a missing quote: the first of these is reported alone. An
  unknown key is an error, never skipped:

```toml
coordinate = ["x"]
```
```text
error: unknown key 'coordinate' in the model file; did you mean 'coordinates'?
```

`base` names a file from which this file starts, by a path relative to this file, or a shipped model by its name. Tables of both files are merged key
by key. Elements of lists are merged by their `name`; elements without a counterpart are added at the end. Every other value (also a list of names or
numbers) is replaced. Nothing of the base can be removed. A base may have a base; `--case` may name the cases of all these files.

```toml heavy.toml
base = "model.toml"
parameters.m = 5                   # of [parameters], the other names stay
body.plate.inertia = "J + 1"       # of the body plate, the other keys stay
```
```console
$ anholon check heavy.toml --quiet > heavy.txt
```
)md",
       {"coordinates", "coordinate", "base", "title"}},
      {"index",
       Form::named,
       formula,
       {},
       R"md(```toml
coordinates = ["s[i]"]
particle = [{name = "bead[i]", mass = "mb[i]", position = "Q[i]"}]
[index]
n = 3                              # --set n=64
i = "1..n"
[parameters]
"mb[i]" = [0.1, 0.2, 0.1]          # in order; one value alone is that of all
[point]
"Q[0]" = "0"
"Q[i]" = "Q[i-1] + s[i]*ex"
[define]
total = "sum(i, mb[i])"
[initial]
"s[i]" = "0.1*i"
conditions = ["s[i]' = 0"]         # one equation for each value of i
```

- An entry is an integer formula, or an inclusive range of two. A range whose end lies before its start is empty: its sum is 0,
  its product 1.
- A name whose bracket holds a letter with a range is a *family*: an element for each value, whose formulas see the letter as a
  number. Brackets hold integer formulas: `Q[i-1]`, `c[2*i, j]`. This holds for keys of all sections, names of bodies,
  constraints, forces, events and tables, and entries of `coordinates`.
- With several letters a list gives the values in the order of the letters, the last one fastest. Its length must fit. In `[point]` a list of
  three formulas is a vector; a list of such lists gives members.
- A member written out (`"Q[0]"`) takes the place of the member of the family, wherever it stands.
- A force without `name` is a family if its `on` is one; several may act on one body.
- `--set n=64` reads the file with another integer, `--set "mb[2]=5"` another parameter of one member. A range cannot be set.
- The letters of `[index]` cannot be names of anything else. `sum` and `prod` give their letter its values themselves.
- A member that does not exist is an error with the range that does:

```toml
coordinates = ["s[i]"]
particle = [{name = "bead[i]", mass = 1, position = "s[i+1]*ex"}]
index = {i = "1..2"}
```
```text
error: in bead[2]: there is no 's[3]'; s has 1..2
```
)md",
       {"chain", "family", "families"}},
      {"case",
       Form::named,
       any,
       {},
       R"md(```toml
[case.light]                       # --case light
parameters.m = 1
body.plate.inertia = "J/2"
[[case.light.force]]               # a new element
name = "push"
on = "plate"
vector = "ex"
```

- A case changes its own file as a file changes its base, but it changes only names that exist: a misspelt name in `parameters`, `define`, `point`, …
  is an error. New elements of lists stand in a list, as above.
- `--case a --case b` applies both cases, one after the other; where both change a value, that of the later case holds. `--set` comes last. Without
  `--case` no case applies, and names in cases are not looked up.
- A case names a family as the file does (`"trailer[i]"`); to change one member alone, write it out in a new element.
)md",
       {"scenario", "scenarios"}},
  };
}

}  // namespace anholon
