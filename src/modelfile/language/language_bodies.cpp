// The language: bodies, forces, constraints, the observer.
#include "modelfile/language/language.h"

namespace anholon {

using enum Content;
using Form = LanguageSection::Form;

std::vector<LanguageSection> language_of_bodies() {
  return {
      {"body",
       Form::elements,
       any,
       {{"name", name, "with an orientation also the name of a frame"},
        {"mass", formula, "may depend on t, states, coordinates, velocities"},
        {"inertia", inertia,
         "a number (plane, about z), three moments or a matrix, along the body axes at the mass centre"},
        {"center", vector, "the mass centre; `B.center` in formulas"},
        {"orientation", rotation, "of the body axes"},
        {"angle", formula, "the orientation `rotz(angle)`"},
        {"axes", any, "expert form instead of inertia: a list of `{weight, vector}`"},
        {"expelled_velocity", vector,
         "of the matter that leaves or joins, relative to the material point at `exit_point`"},
        {"exit_point", vector, "where it does; an array is along the body axes from the centre; the centre without it"},
        {"shape", text,
         "a homogeneous solid: `disc(R)`, `ring(R)`, `cylinder(R, h)`, `torus(R, r)` about z, the full tube of radius "
         "r around the circle of radius R, `rod(l)` along x, `ball(R)`, `shell(R)`, `box(a, b, c)` of these edges, "
         "`ellipsoid(a, b, c)` of these half axes; beside `inertia` it is only the picture"}},
       R"md(```toml
[[body]]
name = "wheel"
mass = 3
shape = "disc(R)"                  # moments of inertia from mass and radius
center = "P + R*ez"
orientation = "B*rotx(pi/2)*rotz(x/R)"

[[body]]
name = "rotor"                     # no mass: only a moment of inertia
inertia = ["J", "J", "2*J"]
center = "P"
orientation = "B*rotz(y)"

[[body]]
name = "table"                     # neither: a carrier, a body that only has a place
center = "0"
orientation = "rotz(0.3*t)"
```

- Only `name` and `center` must be there. Without inertia and orientation a body is a point.
- An inertia needs an orientation. `inertia` wins over `shape`. A matrix holds J_xz = −∫ x z dm; one that no body can have is an error.
- A body with an `orientation` is a frame wherever one is wanted: `wheel*rotx(0.2)`. It is not a point: write `wheel.center`. `wheel.x` is an axis,
  `wheel(a, b, c)` is a `wheel.x` + b `wheel.y` + c `wheel.z`.
- The centre and the orientation are formulas of coordinates and t, not of velocities, nor of inputs.
- If a mass varies, the matter that leaves or joins exerts a force, which follows from `expelled_velocity`. Without this key the matter has the
  velocity of the body's point, and there is no force.
- The motion of the matter inside the body is left out, and with it jet damping: matter that flows to the nozzle carries away more angular momentum
  than it had at its place in the body. To include jet damping, write a `[[force]]` with the torque `"(m'*l^2 - J')*theta'*ez"`, where l is the
  distance from the mass centre to the nozzle: [a recipe](recipes/models.md#jet-damping-of-a-rocket).

```toml
[[body]]
name = "spinning"
mass = 1
inertia = [1, 1, 3]
center = "0"
orientation = "rotz(theta)"
```
```text
error: no body has this inertia: 'spinning' violates the triangle inequality
```

`quat(a, b, c, d)` is a rotation only if the sum of squares is 1. If this does not hold identically, and the file has no such constraint, the program
adds the constraint `norm.a`, and `check` says so. If no initial value of `a` is given, the start is looked for near `a = 1`.

```toml
coordinates = ["a", "b", "c", "d"]
body = [{name = "ball", mass = 1, shape = "ball(1)", center = "0", orientation = "quat(a, b, c, d)"}]
```
)md",
       {"rigid", "inertia", "shape", "orientation", "mass", "wheel", "rod", "disc", "ball", "box", "quaternion"}},
      {"body.axes",
       Form::part,
       any,
       {{"weight", formula, "may vary as a mass does"},
        {"vector", vector, "a second-moment axis, in the observer's axes"}},
       R"md(```toml
[[body]]
name = "bar"
mass = 1
center = "P"
axes = [{weight = "1/12", vector = ["cos(theta)", "sin(theta)", "0"]}]
```

- The moment of second order of the body is the sum of weight · vector vectorᵀ. Such a body has no orientation.
)md"},
      {"particle",
       Form::elements,
       any,
       {{"name", name, ""},
        {"mass", formula, ""},
        {"position", vector,
         "a particle is a point: `vel(p)`, `p + ex`; also `p.position`, `p.center`; its coordinates are `p.x`, `p.y`, "
         "`p.z`"},
        {"expelled_velocity", vector, "of the matter that leaves or joins, relative to the particle"}},
       R"md(```toml
functions.mr = "5 - t/10"
[[particle]]
name = "rocket"
mass = "mr"
position = "P + y*ez"
expelled_velocity = "-3*ez"

[[body]]
name = "truck"                     # sand falls out at its tail, and falls behind
mass = "mr"
inertia = 4
center = "y*ex"
angle = "x"
expelled_velocity = "-truck.x"
exit_point = [-2, 0, 0]            # along its axes
```
)md"},
      {"force",
       Form::elements,
       any,
       {{"name", name, "for reports"},
        {"on", place, "on what it acts: a body or particle (at its centre) or `{body, at}`"},
        {"from", place, "where the opposite force or torque acts"},
        {"vector", vector, "one of these four must be there"},
        {"torque", vector, ""},
        {"tension", formula, "along the line from `on` to `from`; positive pulls them together"},
        {"generalized", formulas, "by coordinate: `{theta = \"-theta\"}`, without `on`"}},
       R"md(```toml
[[body]]
name = "arm"
mass = 1
inertia = "J"
center = "x*ey"
angle = "y"

[[force]]
on = "plate"
vector = "-0.1*vel(P)"

[[force]]
on = "arm"
from = "plate"                     # the plate feels the opposite
torque = "-2*(y - theta)*ez"

[[force]]
on = {body = "plate", at = ["R", "0", "0"]}     # an array: along the body axes, from the centre
from = {body = "arm", at = "arm.center"}        # a formula: the place itself
tension = "10*(norm(P - arm.center) - 1)"

[[force]]
generalized = {theta = "-theta'"}
```

- A force without `from` acts from outside; `check` lists these.
- The power of a force is that on the material point: if the place of the force moves over the body, the velocity of the body at this place counts,
  not that of the place.
- Forces may depend on anything but `lambda.NAME` and `reaction(B)`, and definitions that hold them.
)md",
       {"torque", "torques", "damper", "motor", "tension", "cable", "thrust", "actuator"}},
      {"force.on",
       Form::part,
       any,
       {{"body", name, "a body or particle"},
        {"at", vector, "an array along its axes from the centre, or a formula of the place"}},
       ""},
      {"gravity",
       Form::keys,
       any,
       {{"field", vector, "the acceleration at the place `here`"},
        {"gradient", truth, "`true`: also the torque of a field that varies over a body"}},
       R"md(```toml
[gravity]
field = "-3.986e14*here/norm(here)^3"
gradient = true
[initial]
x = 7e6
```

- The field acts on every mass with its current value, so it needs no `[[force]]` and no potential beside it. A note names a
  potential that holds the same weight.
)md",
       {"weight"}},
      {"potential",
       Form::named,
       formula,
       {},
       R"md(```toml
[potential]
spring = "10*(x^2 + y^2)/2"
weight = "m*g*y"
```

- Forces are −∂V/∂q. The name of a varying mass within it counts as frozen. A potential does not depend on velocities.
)md",
       {"spring", "springs", "energy"}},
      {"dissipation",
       Form::named,
       formula,
       {},
       R"md(```toml
[dissipation]
damper = "0.2*x'^2/2"              # the force -0.2 x'
```

- Forces are −∂R/∂q′.
)md",
       {"damping", "rayleigh", "drag"}},
      {"constraint",
       Form::elements,
       any,
       {{"name", name, "its multiplier is `lambda.NAME`; where the constraint is kept by an input, that input is it"},
        {"equation", equation, "of numbers or vectors, of any order"},
        {"along", any, "a vector equation: a frame or a list of vectors, along which components are taken"},
        {"by", names, "the inputs that keep it (servo constraint), one name or as many as equations"},
        {"active", formula, "a formula of modes: the constraint holds while it is positive"},
        {"one_sided", truth, "`true`: it pushes and does not pull, so that left − right is not negative: a contact"}},
       R"md(```toml
[[constraint]]
name = "edge"
equation = "dot(vel(P), B.y) = 0"

[[constraint]]
name = "hold"
equation = "theta'' + 2*theta' + theta = sin(t)"
by = "u"                           # a motor holds it, not a guide
[input]
u = {}
[[force]]
on = "plate"
torque = "u*ez"
```

```toml
mode.caught = 0
[[constraint]]
name = "latch"
equation = "theta = 1"
active = "caught"
[[event]]
when = "theta - 1"
set = {caught = 1}
```

- The order m of a constraint is that of the highest derivative on which it truly depends. Its reaction is λ ∂φ/∂q⁽ᵐ⁾ with φ = left − right: λ > 0
  pushes towards a growing left side. `check` states the hypothesis that reactions are ideal.
- A vector equation gives `name.x`, `name.y`, `name.z` along ex, ey, ez. With `along = "B"` the components are those along the axes
  of the frame or body B; with `along = ["v1", "v2"]` those along these vectors, `name.1`, `name.2`. Components that vanish identically are dropped with a
  note; those that vanish with the values of the parameters, as `s*x' = 0` with s = 0, are left out, and their multipliers are 0. `0` is also the zero vector.
- Constraints that depend on one another share forces, such as `z = R` and the normal component of a rolling condition `vel(P) = 0`. Their multipliers
  are not determined one by one: notes name them, rows have the least ones, which depend on how the equations are scaled, and `reaction(B)` and the
  motion are determined. `along` in the vector equation, with the directions that count, leaves one constraint for each direction. A
  contact whose gap another constraint keeps is refused.
- With `one_sided = true` the left side may become larger than the right one: the constraint opens where its force would pull, and closes again
  without rebound. It is a [contact](#contact) without friction, with its events and columns (`NAME.leaves`, `NAME.normal`), and
  `lambda.NAME` is its force, as that of a contact.
- With `active` the constraint holds while this formula of [modes](#mode) and parameters is positive; events that set the modes switch it. When the
  constraint begins to hold, positions must satisfy it, and the velocities jump by the least change in the mass norm, which takes away energy and adds
  none unless the constraint moves. In such a model an event does not happen if it sets only modes and all of them have the new values already: while
  a constraint holds, its formula is zero up to round-off and changes sign again and again. Rows have `NAME.active` and `lambda.NAME`, which is 0
  while the constraint does not hold; monitors, outputs and the `when` of events may contain this force. `active` is possible for constraints of
  positions and velocities without `by` and `one_sided`, in models without contacts. [A recipe](contact.md#a-string-that-catches).
- With `by` no ideal reaction acts: the input, which has no formula (`u = {}`), becomes the unknown instead of λ. An input enforces one equation only.
  Forms that eliminate multipliers do not apply.
- An input with a formula may occur in a constraint: its formula is put in.
- An equation that always holds, or never, is an error; one that follows from others is found when the motion starts.

```toml
[[constraint]]
name = "rolling"
equation = "vel(plate, P + R*B.y) = 0"
along = "B"
```
```toml
[[constraint]]
name = "edge"
equation = "x' = 0"
by = "motor"
```
```text
error: there is no input 'motor'
```
```toml
[[constraint]]
name = "floor"
equation = "y = 0"
one_sided = true
```
)md",
       {"rolling", "roll", "rope", "joint", "hinge", "nonholonomic", "holonomic", "multiplier", "multipliers", "lambda",
        "rheonomic"}},
      {"quasi",
       Form::named,
       formula,
       {},
       R"md(```toml
[quasi]
forward = "x'*cos(theta) + y'*sin(theta)"
```

- These are the quasi-velocities of the forms that use them. If there are too few, velocities of coordinates are added.
)md"},
      {"observer",
       Form::keys,
       any,
       {{"spin", vector, "the angular velocity of its axes, along its axes; these are the inertial ones at t = 0"},
        {"rotation", rotation, "instead: from its axes to the inertial ones"},
        {"origin_acceleration", vector, "inertial acceleration of its origin, along its axes"},
        {"origin_velocity", vector, "inertial velocity of its origin, along its axes"},
        {"origin_velocity_inertial", vector, "the same along inertial axes"},
        {"origin_position_inertial", vector, "its place along inertial axes"}},
       R"md(```toml
[observer]
spin = "0.1*ez"
origin_velocity_inertial = ["0.2*cos(t)", "0", "0"]
```

```toml
[observer]
rotation = "rotz(t^2/10)*rotx(0.1)"
origin_position_inertial = ["sin(t)", "0", "0"]
```
```toml
observer.origin_velocity = "0.3*ex"
```

- Without this section the observer is inertial. Give at most one of `spin` and `rotation`, and at most one of the four keys of the origin. They are
  functions of t, inputs and states, whose formulas contain no coordinates either.
- Inertial forces contain two derivatives of the position of the origin and of `rotation`, and one derivative of its velocity and of `spin`. A jump of
  a lower derivative would make an impulse, so it is an error: a table of which two derivatives are needed must have `fit = "monotone"`, and modes may
  stand only in `origin_acceleration`.
- A derivative of a vector, `v'`, is relative to the observer: component by component.
- Inertial components need a rotation: the program finds it if `spin` is about one axis and can be integrated; otherwise give `rotation`.
- `vel(P, inertial)` needs the velocity of the origin, which `origin_acceleration` does not tell.

```toml
observer = {origin_acceleration = "ex"}
monitor = {v = "norm(vel(P, inertial))"}
```
```text
error: the inertial velocity of the observer's origin is not known
```
)md",
       {"noninertial", "rotating", "coriolis", "earth"}},
  };
}

}  // namespace anholon
