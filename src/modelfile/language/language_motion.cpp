// The language: unknowns beside coordinates, initial data, output, integration.
#include "model/motion_settings.h"
#include "modelfile/language/language.h"

namespace anholon {

using enum Content;
using Form = LanguageSection::Form;

// Returns the keys of [simulate]: the options of a motion on the command line.
static std::vector<LanguageKey> keys_of_simulate() {
  struct ContentOf {
    const MotionOption& option;
    Content operator()(std::optional<Rational> MotionSettings::*) const { return number; }
    Content operator()(std::optional<int> MotionSettings::*) const { return number; }
    Content operator()(std::vector<WrittenTime> MotionSettings::*) const { return numbers; }
    Content operator()(std::optional<std::string> MotionSettings::* m) const {
      return option.choices ? choice : m == &MotionSettings::form ? text : any;
    }
  };
  std::vector<LanguageKey> keys;
  for (const MotionOption& o : motion_options()) {
    const Content content = std::visit(ContentOf{o}, o.member);
    keys.push_back({o.key, content, o.in_file, o.choices ? o.choices() : std::vector<std::string>{}});
  }
  return keys;
}

std::vector<LanguageSection> language_of_motion() {
  return {
      {"state",
       Form::named,
       any,
       {{"rate", formula, "its derivative by time, a formula of anything but rates of states"},
        {"initial", number, "a number or a formula of parameters"}},
       R"md(```toml
[state]
fuel     = {rate = "-0.1", initial = 2}
integral = {rate = "theta - 0.2", initial = 0}     # of a controller
[[force]]
on = "plate"
torque = "-(3*integral + theta)*ez"
```
```toml
state.fuel = {rate = "-0.1", initial = 2}
body.plate.mass = "m + fuel"       # the mass follows
```

- A state may be used wherever a coordinate may; its derivative `fuel'` is its rate.
)md"},
      {"mode",
       Form::named,
       number,
       {},
       R"md(```toml
mode.stage = 1
define.thrust = "choose(stage, 10, 4, 0)"
[[event]]
when = "t - 2"
set = {stage = "stage + 1"}
```

- A mode is a number that only events change. An event that sets a mode to the number that it has already happens like any other, and is counted and
  reported (`stage 1 -> 1`), except in models with [`active`](#constraint). `--set` changes parameters and not modes; to start in another mode, write
  a case.
)md"},
      {"contact",
       Form::elements,
       any,
       {{"name", name, "for events and columns; `contact1`, … without it"},
        {"gap", formula, "the distance, a formula of coordinates and time that is not negative"},
        {"slip", any, "the relative tangential velocity: a number, a list of two, or a vector with `along`"},
        {"along", any,
         "the tangential directions of a vector `slip`, as in a constraint; they are made of length 1 and at right "
         "angles"},
        {"body", name, "instead of `gap` and `slip`: the body that touches, with its shape"},
        {"shape", text,
         "what touches: `point`, `ball(R)`, `disc(R)`, `torus(R, r)`, `box(a, b, c)`; the shape of the body without "
         "it"},
        {"at", vector, "the place of that point, or the middle of that shape; the centre of the body without it"},
        {"normal", vector, "of the plane on which it lies; `ez` without it"},
        {"through", vector, "a point of the plane, or the centre of the ball or bowl; 0 without it"},
        {"on", text, "not a plane: `ball(R)`, or `bowl(R)`, whose inside is touched"},
        {"friction", number, "Coulomb's coefficient while it slips; 0 without it"},
        {"static_friction", number, "the coefficient while it sticks; `friction` without it"},
        {"rolling_resistance", number,
         "a length: times the normal force, the largest moment against rolling; of a `body` that is a ball, a disc or "
         "a torus"},
        {"drilling_resistance", number,
         "a length: the same about the normal, of a ball, a disc, a torus or a point of a `body`"},
        {"restitution", number, "the coefficient of impacts, 0 to 1; 0 without it"},
        {"impact", choice, "the law of impacts with that coefficient; `newton` without it", {"newton", "poisson"}}},
       R"md(A contact pushes and does not pull. In this example a ball is thrown, bounces, slips on the floor and rolls:

```toml thrown.toml
coordinates = ["x", "z", "phi"]
parameters = {m = 2, R = 0.3, g = 9.81, mu = 0.1}
gravity.field = "-g*ez"
body = [{name = "ball", mass = "m", shape = "ball(R)", center = "x*ex + z*ez", orientation = "roty(phi)"}]
contact = [{name = "floor", body = "ball", friction = "mu", restitution = 0.2}]
initial = {z = 1, "x'" = 4}
monitor.energy = "m*(x'^2 + z'^2)/2 + m*R^2*phi'^2/5 + m*g*z"
```
```console
$ anholon simulate thrown.toml --to 2 -o thrown.csv 2>&1 | grep -E "rests|sticks"
event floor.rests at t = 0.5666576721718262
event floor.sticks at t = 1.164991990680064
$ anholon simulate thrown.toml --quiet --at 0,1,2 | cut -d, -f1,5,14-18
t,x',energy,floor.mode,floor.gap,floor.normal,floor.friction
0,4,35.62,0,0.7,0,0
1,3.019,17.4062635,1,0,19.62,-1.9620000000000002
2,2.857142857142857,17.31457142857143,2,0,19.62,0
```

In place of the body and its shape, a contact may have its gap and its slip velocity as formulas:

```toml
[[contact]]
name = "floor"
gap  = "P.y - R"                   # the plate is a wheel of radius R on the floor y = 0
slip = "vel(plate, P - R*ey)"      # of the material point that touches it
along = ["ex"]
friction = 0.3
static_friction = 0.4
restitution = 0.5
impact = "poisson"
[initial]
y = 1
```

This example has a shape other than that of the body, a wall, and the inside of a ball:

```toml
[[contact]]
body   = "plate"
shape  = "ball(R)"                 # which lies on a plane
normal = "ey"
through = "-3*ey"
friction = 0.3
rolling_resistance = "R/50"

[[contact]]
name = "pin"
body = "plate"
at   = "P"                         # a point of the body
on   = "bowl(9)"                   # inside a ball of radius 9 about 0
```

```toml
coordinates = ["z", "phi"]         # a top that spins and stops
body = [{name = "top", mass = 1, shape = "ball(1)", center = "z*ez", orientation = "rotz(phi)"}]
gravity.field = "-9.81*ez"
contact = [{body = "top", drilling_resistance = 0.02}]
initial = {z = 1, "phi'" = 9}
```

- **Shapes.** With `body` the gap and the slip velocity follow from the shape of the body and the plane. A disc has its axis along z and touches with
  its rim, a torus with its tube. The rim of a ring and the ends of a cylinder count as discs, the ends of a rod as points. A box touches with its
  corners, whose contacts are called `NAME1`, `NAME2`, …; in a plane motion there are four. `at` without `shape` is a point of the body, given by its
  position in the observer's axes as in `[point]`: `at = "s.center + s(0.3, 0, -0.1)"` is fixed in the body s, and `[0.3, 0, -0.1]` is fixed in space.
  (In `force.on.at` an array is along the axes of the body.)
- **What is touched.** A contact with the key `body` has one body, which touches a plane or a ball. The plane has no border, and the corners of a box
  are points: edges and faces of two boxes do not touch each other. For a contact of two bodies, one must be a point or a ball and the other a ball B,
  `on = "ball(R)"` with `through = "B.center"`; the turning of B is not part of the slip velocity. For other pairs write `gap` and `slip` as formulas.
- The normal of a plane does not turn; `through` may move. On a ball the directions of slip are those across `ey`.
- **Formulas.** The gap should be a length, and the slip velocity a velocity, because friction is μ times the force along the gap: with `gap = "5*z"`
  this force is a fifth of the normal force. A gap may also be an angle, like that of a door and its stop: the force along it is a moment then, and in
  a file with units a coefficient has the unit of the gap divided by those of the slip velocity and of time. Gaps and slip velocities with other
  units, such as `R^2 - norm2(P)`, are errors in a file with units. A slip velocity must be linear in the velocities and tangential: if the normal is
  known, as for a plane and the velocity of a point with `along`, a direction with a part along the normal is refused.
- A gap must change its sign where a body would pass the surface: `z^2`, `abs(z)` and `norm(P)`, which only touch zero, are refused. If max, min, abs,
  sign, piecewise or a table of steps (`fit = "hold"`) occur in a gap or a slip velocity, each kink or jump is an event of the contact, at which the
  body strikes, leaves, or slips. If a surface jumps into a body, or a body comes to rest in an edge, the motion ends with an outcome.
- **Laws of force.** A contact is open, sticks or slips. The normal force N acts along the gradient of the gap, friction against the slip velocity:
  μN while it slips, at most the static coefficient times N while it sticks. Without `slip` there is no friction.
- Contacts of one body whose gaps or slip velocities depend on each other share their forces; friction is shared in proportion to the loads:
  [two feet](contact.md#two-feet-on-a-floor). The body slips when no distribution of the forces can hold it.
- **Resistance.** `rolling_resistance` δ gives a moment against the part of the angular velocity along the surface: δN while the body rolls, at most
  δN while it does not. `drilling_resistance` gives the same about the normal. They need a `body` with an orientation. Columns are `NAME.rolling.mode`
  (0 open, 1 rolls, 2 rests), `NAME.rolling.moment`, `NAME.drilling.mode`, `NAME.drilling.moment`; events are `NAME.rolling.starts`,
  `NAME.rolling.stops`, `NAME.rolling.reverses`, and the same of `NAME.drilling`.
- **Events and columns.** Changes of mode (`NAME.hits`, `NAME.leaves`, `NAME.slips`, `NAME.sticks`) are events located to round-off. A gap that is 0
  at the start and shrinks is an impact, `NAME.hits`, at the start. At `NAME.reverses` a slip velocity passes zero, or jumps over it, and the contact
  slips on. `NAME.slips` ends a time of sticking, and `NAME.sticks` a time of slipping. If a contact slips or sticks from the start on, or from an
  impact on, there is no such event; the column `mode` tells which it does. If the impact of another contact opens a closed contact, this one has the
  event `NAME.leaves`; a contact that strikes and opens at once has only `NAME.hits`. Events of contacts at one instant are listed in the order of
  their causes: impacts, other changes of mode, `NAME.rests`. Rows have the columns `NAME.mode` (0 open, 1 slips, 2 sticks), `NAME.gap`, `NAME.normal`
  and `NAME.friction`.
- **Forces in formulas.** In monitors, outputs, rates of states, events and the definitions they use, `lambda.NAME` is N, 0 while the contact is open,
  and `lambda.NAME.t1`, `lambda.NAME.t2` are the components of friction along those of the slip velocity, as forces on what slips;
  `lambda.NAME.rolling.t1` and so on are the moments of resistance. `reaction(B)` holds the forces of contacts. An event does not happen if its
  formula changes sign only because a force jumps at a change of mode. The rate of a `[state]` must be linear in the forces of contacts: with their
  power as the rate, the state is [their work](contact.md#the-work-of-contacts).
- **Coefficients** are numbers or formulas of parameters, and constant during a motion: a floor with
  [parts](contact.md#a-floor-that-is-smooth-and-rough) has a contact for each. They are not negative, a restitution is at most 1, and
  `static_friction` is at least `friction`. Where the file has units, friction and restitution are numbers, and resistances lengths.
- **Laws of impact.** Impacts follow Newton's law in Moreau's form: the velocity of the gap is reversed and multiplied by the restitution e. With
  `impact = "poisson"` they follow Poisson's law: the impulse that stops the gap is followed by e times this impulse. The laws agree without friction;
  with friction Newton's law may raise the energy, which ends the motion. All contacts of a model have one law. Impacts at one instant are solved
  together; if bodies in a row should strike one after the other, put [small gaps](contact.md#balls-in-a-row-impacts-at-one-instant) between them. A
  series of impacts of one contact that come sooner and sooner ends with `NAME.rests`, at the limit of their times. If impacts of several contacts
  come sooner and sooner, as of a box that bounces from corner to corner, this limit is not found: there may be many impacts, and the motion may stop
  with the outcome that a gap is negative.
- **Limits.** A model has at most eight contacts, and only few of them should touch at one time, as the program tries all their modes. The number of
  soft contacts is not limited: write each as a `[[force]]` with `vector = "-k*min(P.z, 0)*ez"`. Motions, reports and sweeps treat contacts, also in
  the libraries; derivations, proofs and linear models are those of one mode, `--mode NAME=sticks`. A model with contacts must not have events that
  set values, nor servo constraints. [Recipes](contact.md).

```toml
[[contact]]
name = "floor"
gap = "P.y"
friction = 0.3
```
```text
error: the contact 'floor' has friction and no slip velocity
```
```toml
[[contact]]
body = "plate"
normal = "ey"
shape = "point"
rolling_resistance = 0.01
```
```text
error: a point does not roll
```
)md",
       {"floor", "wall", "ground", "friction", "coulomb", "impact", "impacts", "collision", "collisions", "restitution",
        "bounce", "bouncing", "stick", "slip", "stiction", "gap", "unilateral"}},
      {"event",
       Form::elements,
       any,
       {{"name", name, "for reports; `event1`, … without it"},
        {"when", formula, "it happens where this formula passes zero"},
        {"direction", choice, "only upwards or only downwards", {"up", "down"}},
        {"set", formulas, "new values of modes, states, coordinates `x` and velocities `x'`"},
        {"stop", truth, "`true`: the motion ends there"}},
       R"md(```toml
[[event]]
name = "bounce"
when = "y"
direction = "down"
set = {"y'" = "-0.8*y'"}

[[event]]
name = "top"                       # sets nothing: recorded only
when = "y'"
direction = "down"

[[event]]
name = "late"
when = "t - 5"
stop = true
```

- An event happens where its formula strictly changes its sign. If the formula is zero at the start, or right after an event, the event does not
  happen there; the sign that the formula takes next counts. A formula that touches zero without changing sign makes no event.
- A formula that jumps over zero because an event sets a value makes no event: with `hits = "hits + 1"` in the `set` of `bounce`, `when = "hits - 4.5"`
  never happens, and `when = "piecewise(hits > 3.5, y, 1)"` with `direction = "down"` passes zero with `y`, at the fifth bounce.
- The formula must have a value all along the motion. If it has none at the start, the motion ends there, with an outcome that names the event: write
  `x - 0.51` for `sqrt(x - 0.5) - 0.1`. The motion also ends where the formula loses its value, or grows without bound, as `tan(x)` and `1/x` do.
- Its time is located on the Taylor polynomial to round-off, whatever the tolerance. Events may hold `lambda.NAME`, `reaction(B)` and accelerations, also through `[define]`.
- Several events at one moment happen in the order of the file. All formulas of one `set` use the values before this event; a later event at the same
  moment uses the values that the earlier ones have set.
- Then the state is made consistent by the least change in the mass norm: positions, if an event set them, with the constraints of position, and
  velocities with all constraints. The change is reported.
- A row at the time of an event shows the motion before it.
- A jump of a mass gives no impulse: velocities stay. `expelled_velocity` counts between events only.
- An event cannot set a quantity that constraints determine. If the values that an event sets bring its formula to zero again and again, the motion
  ends with an outcome.

```toml
[[event]]
when = "y"
set = {"y''" = 1}
```
```text
error: an event sets coordinates and velocities; 'y''' follows from them
```
)md"},
      {"input",
       Form::named,
       formula,
       {},
       R"md(```toml
[input]
u = "-2*theta - theta'"            # any formula
w = {}                             # kept by a constraint, by = "w"
[[force]]
on = "plate"
torque = "(u + w)*ez"
[[constraint]]
equation = "theta'' = 0"
by = "w"
```

- An input is a control. A motion uses its formula; `linearize` gives the derivatives by the input (the matrices B and D). If a potential, a
  dissipation, a mass or a constraint contains an input whose formula contains coordinates or velocities (a mass: any input), the formula is put in
  there. B and D then lack this part, and a note says so.
- If a position or an orientation contains an input, the formula of the input may contain only t and states. The rates of the input act in the motion,
  too; a note of `linearize` says that B and D do not contain them.
- Exported programs (`derive --format c` or `python`) take inputs as an argument, and use the formulas if it is not given. An input remains a formula
  in them if it contains accelerations, if it occurs in a constraint of which derivatives are needed, or if its formula is put in. An input that is
  given acts everywhere: in forces, rates of states, outputs, events and other inputs.
- The formula of an input may contain other inputs, but not itself. An input `{}` needs a constraint that it enforces (`by`).
)md",
       {"control", "controls", "controller"}},
      {"output",
       Form::named,
       any,
       {{"value", vector, "a number or a vector, also of `lambda.NAME`"},
        {"unit", text, "shown with it"},
        {"doc", text, "what it is"},
        {"conserved", truth, "`true`: its drift is part of the report"}},
       R"md(```toml
[output]
speed = "norm(vel(P))"
place = {value = "P", unit = "m", doc = "of the centre"}     # columns place.x, place.y, place.z
turn = {value = "theta'", conserved = true}
```
)md"},
      {"initial",
       Form::named,
       any,
       {{"t", number, "0 without it"},
        {"conditions", equations, "solved together with the constraints"},
        {"guess", values, "values that are looked for nearby, 0 without"},
        {"branch", formulas, "`{NAME = \"lambda > 0\"}`: the sign of a multiplier, where there are several solutions"},
        {"q", values, "positions, where a coordinate has the name of a key"},
        {"qdot", values, "velocities"},
        {"qddot", values, "accelerations: with constraints of order 3 and more"},
        {"qdddot", values, "third derivatives: with constraints of order 4 and more"},
        {"lambda", values, "multipliers: with constraints of order 3 and more"},
        {"lambdadot", values, "their rates: with constraints of order 4 and more"}},
       R"md(```toml
[initial]
theta  = 0.3
"x'"   = "2*R"                     # a formula of parameters
conditions = ["dot(vel(P), B.y) = 0", "y = x^2 + 1"]
guess  = {x = 1}
```

```toml
title = "A constraint of order 3, nonlinear: accelerations are initial data, and one of two solutions is named"
coordinates = ["x", "y"]
particle = [{name = "p", mass = 2, position = "x*ex + y*ey"}]
gravity.field = "-9.81*ey"
constraint = [{name = "jerk", equation = "x'''^2 + y'''^2 = 9"}]
[initial]
t = 2
q = {x = 1, y = 0}                 # the same as x = 1, y = 0
qdot = {x = 0.5}
qddot = {x = 1, y = -9}
branch = {jerk = "lambda > 0"}
```
```toml
title = "A constraint of order 4: a multiplier and its rate, or accelerations and third derivatives, are initial data"
coordinates = ["x", "y"]
particle = [{name = "p", mass = 2, position = "x*ex + y*ey"}]
constraint = [{name = "snap", equation = "D(x, 4) + (1 + x'/3)*D(y, 4) = y"}]
[initial]
lambda = {snap = 0.4}
lambdadot = {snap = 0.1}
[case.other]
initial = {qddot = {x = 0.2}, qdddot = {x = 0.05}}
```

- Every coordinate and its derivatives may be a key: `theta`, `"theta'"`, `"D(theta, 3)"`. Values that are not given follow from the constraints. If
  the constraints leave some of them free, the program takes those nearest to the guess (0 without one) in the mass norm; a value that no constraint
  contains is its guess. All free values change together by the least amount, so a velocity that could be 0 need not be: a torus wheel that leans and
  spins with `phi' = 8`, without a given `psi'`, must move its centre, and the least motion that does so turns it with `psi' = -4`. Give all
  velocities of a rolling body. `check` says of each value where it comes from.
- A value is a number or a formula of parameters. Relations between unknowns stand under `conditions`, which may hold accelerations and `lambda.NAME`:
  they are solved with the equations of motion (`"theta'' = 0"`: a steady motion). `--q` and `--qdot` give numbers for positions and velocities; an
  acceleration has no such option, as it follows from the state, and a condition on it finds a state that has it. A condition on velocities changes
  positions that are not given only if no velocities satisfy it (`"c' = 0"`: the angle at which a caster does not turn).
- If values miss a constraint by no more than 1e-8 of its scale, they count as rounded and are corrected by the least change; if they miss it by more,
  an error names the clash.
- A guess also names one of several solutions: the nearest is taken.
- `--q`, `--qdot`, and `--vary` of an initial value, take the place of values that clash with them, and of a condition that alone clashes with them.
  Values of the file that take part in such a clash move together, by the least change in the mass norm, as an ideal impulse would move velocities: so the start changes continuously
  with an angle that varies. A note names each with its old and its new value. The other values of the file stay, and values of the file that clash
  without an option are an error with any options.
- Angles are in radians: `theta = 0.3`. In degrees they are written `theta = "45 deg"`; a note names an initial angle of 45 rad and others that look like degrees.
- A vector condition is one for each component.

```toml
initial = {theta = "x + 1"}
```
```text
error: an initial value is a number or a formula of parameters
```
)md",
       {"start", "guess"}},
      {"monitor",
       Form::named,
       formula,
       {},
       R"md(```toml
[monitor]
height = "P.y"
reach  = "norm(P) - 2"
```

- A monitor is a number to watch along the motion. It is a column of the rows, and the report has its range. The range covers the rows, the ends of
  Taylor's steps (if there are more than a thousand steps, ever fewer of them) and both sides of events. Between these times a monitor may exceed the
  range; rows at more times (`--every`) come nearer to its extremes, and in a sweep `--reduce "max(NAME)"` finds them. A monitor may contain
  `lambda.NAME`, `reaction(B)` and derivatives of any order, also through `[define]`.
)md"},
      {"simulate", Form::keys, any, keys_of_simulate(),
       R"md(```toml
[simulate]
to = 10
tolerance = 1e-13
every = 0.1
form = "routh"
integrator = "taylor"
```
```toml
[simulate]
to = 10
numbers = "quad"
digits = 30
order = 24
method = "taylor"
most_steps = 100000
rigorous = 64
error_estimate = "always"
```

- Each key is an option of `anholon simulate`, too. Options on the command line win.
)md"},
      {"view",
       Form::named,
       any,
       {{"camera", vector, "from where it is looked at"},
        {"target", vector, "what lies in the middle at the start"},
        {"up", vector, "the direction that is up on the page; `ez` without it"},
        {"follow", name, "the body or point that stays in the middle"},
        {"floor", any, "the height of a grid in the plane z = const; `false`: none"},
        {"hide", names, "bodies and points that are not drawn"}},
       R"md(```toml
[view]
camera = "5*ex + 3*ez"
target = "P"
up     = "ez"
follow = "plate"
floor  = -1
hide   = ["plate"]
path   = {trace = "P"}
arm    = {line = ["0*ex", "P", "plate.center"], color = "#36c"}
plate  = {shape = "box(2, 1, 1/10)"}                            # this is how the body is drawn
mast   = {shape = "rod(2)", at = "P + ez", axes = "roty(pi/2)"}  # and this stands beside the bodies
pull   = {vector = "vel(P)", at = "P"}
```

- This section describes the picture of report pages. Bodies with a `shape` are drawn as that shape. A body without a shape is drawn as the
  homogeneous box that has its moments of inertia, if these are constant, and otherwise as a point with its axes. Points are drawn as dots, and forces
  with a `tension` as lines.
- Every name other than the keys above is an element of the picture: `shape` (with `at` and `axes`; if the name is that of a body, at the place of the
  body), `line` (through a list of places), `trace` (the path of a place), `vector` (with `at`); each may have a `color`. If the section has no trace,
  particles and points leave one.
- This section does not change the motion. `anholon report MODEL -o page.html` shows the picture.

```toml
view = {follow = "plat"}
```
```text
error: there is no body or point 'plat'; did you mean 'plate'?
```
)md",
       {"animation", "picture", "film"}},
  };
}

}  // namespace anholon
