#!/usr/bin/env python3
"""Compiles and runs the C and Python that `anholon derive --format c|python` writes, and compares them with the program.

    check_generated.py path/to/anholon                some shipped models, and models made to be awkward
    check_generated.py path/to/anholon --only disc    models whose name contains `disc`
    check_generated.py path/to/anholon --form appell  from the equations of another form

At the initial state the leading derivatives must be those of `anholon evaluate`, the hidden constraints must vanish, the
jacobian must be the change of the residual; both languages must agree anywhere; and a Runge-Kutta method must follow
`anholon simulate`. A sign flipped in the generated text must be noticed. With ANHOLON_LONG=1: all shipped models.
Needs a C compiler, cc; NumPy for the half that is about Python.
"""

import argparse
import contextlib
import ctypes
import json
import os
import subprocess
import sys
import tempfile
import types
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

os.environ.setdefault("ANHOLON_CACHE", "")  # no compiled code is kept in the home folder

try:
    import numpy
except ImportError:
    numpy = None

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = ["disc", "luo-zhao-example-2", "snakeboard", "rheonomic-order-1", "second-order-linear", "fourbar",
           "mass-depends-on-velocity", "falling-chain", "appell-hamel", "trailers", "constant-jerk", "third-order-linear",
           "rheonomic-order-2", "launcher"]  # fmt: skip
FLAGS = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O1", "-ffp-contract=off"]
SAME = 1e-10  # relative difference of two ways to compute the same number
MOTION = 1e-8  # difference of the Runge-Kutta method with its step from the Taylor series
STEPS = {"rattleback": 800}  # its Euler angles turn fast
DOUBLE = ctypes.POINTER(ctypes.c_double)

AWKWARD = {
    # Names that C, Python and the generated text use themselves; a title that would end a comment.
    "names": r'''
title = "*/ /* \"\"\" \\ ??/ $x$ \u2028 \u202e end"
coordinates = ["x", "x_1", "int", "p", "state", "w1", "w2"]
[parameters]
np = 1.5
D = 2
i = 0.5
lead = "np + D^2/3"
out = "lead*i"
EOF = 3
_m = { value = "out + pi", doc = "*/ said of a \"mass\"" }
def = 1
double = "sqrt(2)"
exp_ = 0.3
[[particle]]
name = "a"
mass = "np"
position = ["x", "x_1", "int"]
[[particle]]
name = "b"
mass = "_m"
position = ["p + i*sin(w2)", "state*exp_", "w1"]
[[particle]]
name = "c"
mass = "def*double"
position = ["w2", "D*w1 + EOF*cos(w2)", "x*p"]
[[constraint]]
name = "lambda"
equation = "x' = sin(w1)*x_1'"
[[constraint]]
name = "while"
equation = "ex*(p' + lead*w1') + ey*(state' - int') = 0*ez"
[initial]
x = 1
x_1 = 0.3
int = 0.2
p = 2
state = 0.1
w1 = 0.7
w2 = 0.4
"w1'" = 0.3
"w2'" = 0.2
"x_1'" = 1
''',
    "free": '''
coordinates = ["x"]
[[particle]]
name = "a"
mass = "2"
position = ["x", "0", "0"]
[[force]]
name = "f"
on = "a"
vector = ["-x^3", "0", "0"]
[initial]
x = 1
''',
    "redundant": '''
coordinates = ["x", "y"]
[parameters]
m = 2
[[particle]]
name = "bead"
mass = "m"
position = ["x", "y", "0"]
[[constraint]]
name = "edge"
equation = "y' = x"
[[constraint]]
name = "twice"
equation = "2*y' = 2*x"
[initial]
x = 1
"x'" = 1
''',
    # Choices and tables; a Runge-Kutta method would not see kinks on the way.
    "choices": '''
coordinates = ["x", "y", "z"]
[mode]
gear = 2
[[table]]
name = "line"
x = [-1, 0, 0.5, 2]
y = [1, -0.5, -1, 0]
[[table]]
name = "steps"
x = [-5, 50]
y = [0.5, 1]
fit = "hold"
[[table]]
name = "smooth"
x = [-1, 0, 1, 3]
y = [0, 1, 1.5, 4]
fit = "spline"
outside = "linear"
[[particle]]
name = "a"
mass = "choose(gear, 1, 2, 3)"
position = ["x", "y + smooth(x)/4", "z"]
[[force]]
on = "a"
vector = ["line(x) + piecewise(y > 0.3, -1, y >= 0.29, -0.5, x <= 2, 0.25, 1)", "max(-y, -1) + min(x, abs(z))", "steps(t) - z"]
[initial]
x = 1.2
y = 3
z = 0.1
"x'" = 0.1
"y'" = 0.5
''',
    # Two inputs are arguments; one occurs in a constraint that is differentiated, and stays a formula.
    "inputs": '''
coordinates = ["x", "y", "z"]
[parameters]
push0 = 2
[input]
push = "push0"
steer = "-2*y - 3*y' + t"
path = "0.2*sin(t)"
[[particle]]
name = "a"
mass = "2 + x^2"
position = ["x", "y", "z"]
[[force]]
on = "a"
vector = ["push*cos(y) - x", "steer - y^3", "push - steer*x"]
[[constraint]]
name = "guide"
equation = "z = x*y + path"
[initial]
x = 0.4
y = -0.3
"x'" = 0.2
"y'" = 0.5
''',
    # Newton's method has to iterate.
    "nonlinear": '''
coordinates = ["x", "y"]
[[particle]]
name = "a"
mass = "2"
position = ["x", "y", "0"]
[[force]]
name = "f"
on = "a"
vector = ["-x - 0.1*x''^3 - y''", "1 - 0.2*sinh(x'' + y'')", "0"]
[initial]
x = 3
"y'" = 1
''',
    # Exponents that are parameters.
    "powers": '''
coordinates = ["x", "y"]
[parameters]
m = 2
k = 3
n = 2.5
[[particle]]
name = "a"
mass = "m"
position = ["x", "y", "0"]
[potential]
spring = "k*x^(n + 1)/(n + 1) + k*(1 + y^2)^(n/2)"
[[force]]
on = "a"
vector = ["-y^n*x^(n + 1)", "-2*y^(n - 1)", "0"]
[initial]
x = 0.8
y = 0.6
"x'" = 0.1
''',
    # Every elementary function, roots and powers, large and small numbers.
    "functions": '''
coordinates = ["x", "y", "z"]
[parameters]
m = 1
large = 1e30
small = 1.25e-20
third = "1/3"
[[particle]]
name = "a"
mass = "m + 0.1*cosh(x)^2"
position = ["x", "y*(1 + tan(x/5))", "z + exp(-y)"]
[[force]]
name = "f"
on = "a"
vector = ["abs(x) + sign(y)*asin(x/4) + acos(x/5) + atan(y) + sinh(z/7) + atanh(x/9)",
          "tanh(y) + asinh(z) + acosh(2 + x) + log(3 + y) + atan2(y - 2, x - 3) + pi*(1 + x^2)^(1/3)",
          "(2 + y)^(-5/2) + (1 + x^2)^(3/2) + (1 + z^2)^(-1/2) + x^7/(1 + y^2)^6 + large*x/(large + third) + (small*z^2 + 2/7)^third - 12345678/1000003*t/(1 + x^4)"]
[[constraint]]
name = "roll"
equation = "z' = x*y' + abs(y)*t"
[initial]
x = 0.4
y = -0.3
z = 0.2
"x'" = 0.3
"y'" = -0.5
''',
}  # fmt: skip


class Failure(Exception):
    pass


def run(arguments, **more):
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=600, cwd=ROOT, **more)
    if done.returncode != 0:
        raise Failure(f"{' '.join(map(str, arguments))}: exit {done.returncode}: {(done.stderr or done.stdout)[:600]}")
    return done.stdout


def same(values, reference, what, tolerance=SAME, floor=1e-3):
    values, reference = [float(v) for v in values], [float(v) for v in reference]
    scale = max([floor, *map(abs, reference)])
    for i, (v, r) in enumerate(zip(values, reference, strict=True)):
        if not abs(v - r) <= tolerance * scale:
            raise Failure(f"{what}[{i}] is {v!r}, not {r!r}")


def given(point, names, otherwise):
    """Values of a point; the rate of a state, which no table shows, has the value that is computed otherwise."""
    return [point.known.get(name, value) for name, value in zip(names, otherwise, strict=True)]


class Compiled:
    """The generated C, called by the names of its functions."""

    def __init__(self, text, name, folder, number):
        source = folder / f"{name}{number}.c"
        source.write_text(text, encoding="utf-8")
        run(["cc", *FLAGS, "-shared", "-fPIC", "-o", source.with_suffix(".so"), source, "-lm"])
        self.library = ctypes.CDLL(str(source.with_suffix(".so")))
        self.prefix = "".join(c if c.isalnum() else "_" for c in name)
        self.state_names, self.lead_names = self.names("state_names"), self.names("lead_names")
        self.parameter_names = self.names("parameter_names")
        self.input_names = self.names("input_names") if hasattr(self.library, f"{self.prefix}_input_names") else []
        self.output_names = self.names("output_names") if hasattr(self.library, f"{self.prefix}_output_names") else []
        self.u = None  # the inputs; None: by their formulas
        self.p = (ctypes.c_double * (len(self.parameter_names) + 1))()
        self.call("defaults", None, self.p)

    def names(self, table):
        listed = ctypes.cast(getattr(self.library, f"{self.prefix}_{table}"), ctypes.POINTER(ctypes.c_char_p))
        names = []
        while listed[len(names)] is not None:
            names.append(listed[len(names)].decode())
        return names

    def call(self, function, t, *arrays):
        if function == "rhs_many":
            count, states, out = arrays
            flat = self.array(states.ravel().tolist())
            return getattr(self.library, f"{self.prefix}_rhs_many")(ctypes.c_double(t), ctypes.c_long(count), flat, self.p, *self.given("rhs"), out)
        f = getattr(self.library, f"{self.prefix}_{function}")
        arrays = [ctypes.cast(a, DOUBLE) for a in arrays]
        return f(*arrays) if t is None else f(ctypes.c_double(t), *arrays)

    @staticmethod
    def array(values):
        return (ctypes.c_double * max(1, len(values)))(*values)

    def given(self, function):
        """The inputs as an argument, if the function has one."""
        if not self.input_names or function in ("hidden", "inputs"):
            return []
        return [ctypes.cast(None, DOUBLE) if self.u is None else self.array(self.u)]

    def out(self, function, size, t, *arrays):
        result = self.array([0.0] * size)
        self.call(function, t, *map(self.array, arrays), self.p, *self.given(function), result)
        return list(result)[:size]

    def solved(self, function, size, t, state):
        result = self.array([0.0] * size)
        if function == "leading":
            begin = (ctypes.c_double * size).in_dll(self.library, f"{self.prefix}_begin")
            result = self.array(list(begin))
        status = self.call(function, t, self.array(state), self.p, *self.given(function), result)
        if status != 0:
            raise Failure(f"{function} returns {status}")
        return list(result)[:size]


def gathered(path, known):
    """A program keeps one of two equivalent constraints; `evaluate` and `simulate` spread the reaction over both."""
    if Path(path).stem == "redundant":
        known["lambda.edge"] += 2 * known["lambda.twice"]  # the second is twice the first
    if Path(path).stem == "tether-by-servo" and "pull" in known:  # its reaction is an input, whose name it has in rows
        known["lambda.reel"] = known["pull"]
    return known


class Point:
    """A state of the motion with its leading derivatives, from `evaluate` or from a row of `simulate`."""

    def __init__(self, t, known):
        self.t, self.known = t, known

    @classmethod
    def evaluated(cls, program, path, *options):
        answer = json.loads(run([program, "evaluate", path, "--json", *options]))
        multipliers = {f"lambda.{name}": value for name, value in answer["lambda"].items()}
        return cls(answer["t"], gathered(path, answer["state"] | answer["derivatives"] | multipliers))

    @classmethod
    def later(cls, program, path, t):
        motion = json.loads(run([program, "simulate", path, "--json", "--quiet", "--tolerance", "1e-15", "--at", repr(t)]))
        row = dict(zip(motion["columns"], motion["rows"][0]))
        return cls(row["t"], gathered(path, row))

    def __getitem__(self, names):
        return [self.known[name] for name in names]


def off(values, by):
    """Another state nearby, the same in every run."""
    return [v + by * (((7 * i) % 5) - 2) / 3 for i, v in enumerate(values)]


def check_c(c, points, hidden_count):
    for point in points:
        t, state, n = point.t, point[c.state_names], len(c.lead_names)
        solved = c.solved("leading", n, t, state)
        lead = given(point, c.lead_names, solved)
        same(solved, lead, f"C leading at {t}")
        if c.output_names:
            outputs = c.out("outputs", len(c.output_names), t, state, solved)
            same(outputs, given(point, c.output_names, outputs), f"C outputs at {t}")
        same(c.out("hidden", hidden_count, t, state), [0] * hidden_count, f"C hidden at {t}", SAME, floor=1)
    # The jacobian is compared with differences of the residual at a state that satisfies no equation.
    state, lead = off(state, 0.01), off(lead, 0.1)
    jacobian = c.out("jacobian", n * n, t, state, lead)
    for j in range(n):
        up, down = list(lead), list(lead)
        up[j] += 1e-4
        down[j] -= 1e-4
        plus, minus = c.out("residual", n, t, state, up), c.out("residual", n, t, state, down)
        difference = [(a - b) / 2e-4 for a, b in zip(plus, minus)]
        same(jacobian[j::n], difference, f"C jacobian column {j}", 1e-6)
    rate = c.solved("rhs", len(state), t, state)
    solution = dict(zip(c.state_names, state)) | dict(zip(c.lead_names, c.solved("leading", n, t, state)))
    same(rate, [solution[k + "'"] for k in c.state_names], "C rhs", 0)


def check_python(module, c, points, hidden_count):
    for point in reversed(points):
        t, state, n = point.t, point[module.STATE], len(module.LEAD)
        solved = module.leading(t, state)
        lead = given(point, module.LEAD, solved)
        same(solved, lead, f"Python leading at {t}")
        if c.output_names:
            at = t, state, solved
            same(module.outputs(*at), c.out("outputs", len(c.output_names), *at), "outputs in Python and C", 1e-13, floor=1)
        same(module.hidden(t, state), [0] * hidden_count, f"Python hidden at {t}", SAME, floor=1)
    same([module.T0, *module.START], [t, *state], "Python START", 1e-15)
    states = numpy.array([state, off(state, 0.01), off(state, -0.02)]).T
    leads = numpy.array([lead, off(lead, 0.1), off(lead, -0.3)]).T
    times = numpy.array([t, t + 0.1, t - 0.2])
    many = [module.residual(times, states, leads), module.jacobian(times, states, leads), module.hidden(times, states)]
    for k in range(3):
        at = times[k], states[:, k], leads[:, k]
        one = [module.residual(*at), module.jacobian(*at), module.hidden(*at[:2])]
        for a, b, what in zip(one, many, ("residual", "jacobian", "hidden")):
            same(a.ravel(), b[..., k].ravel(), f"Python {what} of many", 1e-14, floor=1)
        same(one[0], c.out("residual", n, *at), "residual in Python and C", 1e-13, floor=1)
        same(one[1].ravel(), c.out("jacobian", n * n, *at), "jacobian in Python and C", 1e-13)
        same(one[2], c.out("hidden", hidden_count, *at[:2]), "hidden in Python and C", 1e-13, floor=1)
    same(module.rhs(t, state), c.solved("rhs", len(state), t, state), "rhs in Python and C")
    check_many(module, c, t, state)
    same(module.DEFAULTS, list(c.p)[:-1], "DEFAULTS in Python and C", 1e-15)


def check_many(module, c, t, state):
    """Many states at once, one of them without a solution, give the values of each alone; the elimination agrees with Newton's method."""
    states = numpy.array([off(state, 0.003 * k) for k in range(5)]).T.copy()
    states[:, 3] = numpy.nan
    rates = module.rhs(t, states)
    if not numpy.isnan(rates[:, 3]).any():
        raise Failure("Python rhs of many gives rates where there is no state")
    out = c.array([0.0] * states.size)
    c.call("rhs_many", t, len(states.T), states, out)
    many = numpy.array(list(out)[: states.size]).reshape(states.shape)
    for k in (0, 1, 2, 4):
        one = c.solved("rhs", len(state), t, states[:, k])
        same(rates[:, k], one, f"Python rhs of many, state {k}")
        same(many[:, k], one, f"C rhs of many, state {k}", 0)
        same(module._newton(t, states[:, k], None, module.BEGIN), module.leading(t, states[:, k]), "the elimination in Python")
    if not numpy.isnan(many[:, 3]).any():
        raise Failure("C rhs of many gives rates where there is no state")
    deep = module.rhs(t, states[:, [0, 1, 2, 4]].reshape(len(states), 2, 2))
    same(deep.ravel(), rates[:, [0, 1, 2, 4]].ravel(), "Python rhs over two axes", 0)


def check_events(c, module, point):
    """The launcher: burn-out sets the stage and the propellant, and an output and an event hold accelerations."""
    t, state = point.t, point[c.state_names]
    lead = c.solved("leading", len(c.lead_names), t, state)
    if c.names("event_names") != ["burn_out", "max_q"]:
        raise Failure(f"the events are {c.names('event_names')}")
    fuel, stage = c.state_names.index("fuel"), c.parameter_names.index("stage")
    values = c.out("events", 2, t, state, lead)
    same(values[:1], [state[fuel]], "C events")
    for k, expected in ((0, (2.0, 90e3)), (1, (1.0, state[fuel]))):
        after, p = c.array(state), (ctypes.c_double * (len(c.parameter_names) + 1))(*c.p)
        getattr(c.library, f"{c.prefix}_reset")(k, ctypes.c_double(t), after, c.array(lead), p)
        same((p[stage], after[fuel]), expected, f"C reset {k}", 0)
        if module is not None:
            same(module.events(t, state, lead), values, "events in Python and C", 1e-13)
            new, parameters = module.reset(k, t, state, lead)
            same(new, list(after)[: len(state)], f"Python reset {k}", 0)
            same(parameters, list(p)[:-1], f"Python reset {k}", 0)
    if module is not None and (module.EVENTS, module.EVENT_DIRECTIONS, module.EVENT_STOPS) != (("burn_out", "max_q"), (-1, -1), (False, False)):
        raise Failure("the tables of events in Python")


def check_motion(c, points, steps):
    """Integrates by Runge-Kutta with the generated right side from the first point to the second."""
    t, y, h = points[0].t, points[0][c.state_names], (points[1].t - points[0].t) / steps
    f = lambda t, y: c.solved("rhs", len(y), t, y)  # noqa: E731
    for k in range(steps):
        s = t + k * h
        k1 = f(s, y)
        k2 = f(s + h / 2, [a + h / 2 * b for a, b in zip(y, k1)])
        k3 = f(s + h / 2, [a + h / 2 * b for a, b in zip(y, k2)])
        k4 = f(s + h, [a + h * b for a, b in zip(y, k3)])
        y = [a + h / 6 * (b1 + 2 * b2 + 2 * b3 + b4) for a, b1, b2, b3, b4 in zip(y, k1, k2, k3, k4)]
    same(y, points[1][c.state_names], "motion", MOTION)


def check_set(c, program, name, path):
    """A parameter changed in p, with those that depend on it, gives the values of --set."""
    c.p[c.parameter_names.index(name)] *= 1.25
    changed = c.p[c.parameter_names.index(name)]
    c.call("derived", None, c.p)
    point = Point.evaluated(program, path, "--set", f"{name}={changed!r}")
    lead = point[c.lead_names]
    same(c.solved("leading", len(lead), point.t, point[c.state_names]), lead, f"C with another {name}")


def check_inputs(c, module, program, path):
    """The inputs by their formulas have the values of the model; an input set from outside acts as its formula with that value."""
    if c.input_names != ["push", "steer"]:
        raise Failure(f"the inputs are {c.input_names}")
    point = Point.evaluated(program, path)
    t, state = point.t, point[c.state_names]
    own = c.out("inputs", 2, t, state)
    same(own, [2, 0.6 - 1.5 + t], "C inputs")
    for u, reference in ((own, point), ([3.5, own[1]], Point.evaluated(program, path, "--set", "push0=3.5"))):
        c.u = u
        lead = reference[c.lead_names]
        same(c.solved("leading", len(lead), t, state), lead, f"C leading with the inputs {u}")
        if module is not None:
            same(module.leading(t, state, u=u), lead, f"Python leading with the inputs {u}")
            same(module.rhs(t, state, u=u), c.solved("rhs", len(state), t, state), f"rhs with the inputs {u}")
    c.u = None


def check_powers(c, module):
    """A whole exponent that is set in p also works for coordinates that are negative or zero."""
    c.p[c.parameter_names.index("n")] = 3
    for x, y in ((-0.5, -0.4), (0.0, 0.0), (-0.3, 0.7)):
        expected = [(-3 * x**3 - y**3 * x**4) / 2, (-9 * y * (1 + y * y) ** 0.5 - 2 * y**2) / 2]
        same(c.solved("leading", 2, 0.0, [x, y, 0.1, 0.2]), expected, f"C leading at {x}, {y}")
        if module is not None:
            same(module.leading(0.0, [x, y, 0.1, 0.2], list(c.p)[:3]), expected, f"Python leading at {x}, {y}")


def check_refusal(c, module, state, status):
    """If there is no answer, C gives the reason, and Python raises or gives nan."""
    got = c.call("leading", 0.0, c.array(state), c.p, c.array([0.0] * len(c.lead_names)))
    if got != status:
        raise Failure(f"leading at {state} returns {got}, not {status}")
    if module is None:
        return
    try:
        with numpy.errstate(all="ignore"):
            refused = numpy.isnan(module.leading(0.0, state)).all() and status == 3
    except numpy.linalg.LinAlgError:
        refused = status == 1
    if not refused:
        raise Failure(f"Python leading at {state} gives an answer")


def flipped(text):
    """The text with the last sign of the residual's sums reversed; nothing cancels after it any more."""
    c = "#include" in text
    begin = text.rindex("_residual(double t") if c else text.index("def residual")
    end = text.index("\n}\n" if c else "return out", begin)
    at = max(text.rfind(" + ", begin, end), text.rfind(" - ", begin, end))
    return text[:at] + (" - " if text[at + 1] == "+" else " + ") + text[at + 3 :]


def module_of(text):
    module = types.ModuleType("generated")
    exec(compile(text, "generated.py", "exec"), module.__dict__)
    return module


def check(program, form, name, path, folder):
    points = [Point.evaluated(program, path)]
    if "[state]" in (text := Path(path).read_text(encoding="utf-8")) or "\nstate." in text:  # which `evaluate` does not show
        points = [Point.later(program, path, points[0].t)]
    points.append(Point.later(program, path, points[0].t + 0.0625))
    text = run([program, "derive", path, "--format", "c", "--form", form])
    prefix = name.replace("-", "_")
    hidden = int(text.split(f"{prefix}_HIDDEN = ")[1].split(",")[0])
    c = Compiled(text, name, folder, 0)
    check_c(c, points, hidden)
    check_motion(c, points, STEPS.get(name, 100))
    module = None
    mutants = [lambda: check_c(Compiled(flipped(text), name, folder, 1), points, hidden)]
    if numpy:
        source = run([program, "derive", path, "--format", "python", "--form", form])
        with numpy.errstate(all="raise"):
            module = module_of(source)
            check_python(module, c, points, hidden)
        mutants.append(lambda: check_python(module_of(flipped(source)), c, points, hidden))
    for mutant in mutants:
        try:
            with numpy.errstate(all="ignore") if numpy else contextlib.nullcontext():
                mutant()
        except (Failure, ArithmeticError):  # or the system has no solution
            continue
        raise Failure("a flipped sign in the residual was not noticed")
    if name == "appell-hamel":  # its constraint does not determine the motion of a body at rest
        check_refusal(c, module, [0, 0, 10, 0, 0, 0], 1)
    if name == "functions":  # the logarithm of a negative number
        check_refusal(c, module, [0.4, -10, 0.2, 0.3, -0.5, -0.2], 3)
    if name == "powers":
        check_powers(c, module)
    if name == "inputs":
        check_inputs(c, module, program, path)
    if name == "launcher":
        check_events(c, module, points[1])
    if name == "names":
        check_set(c, program, "np", path)
    return f"{name:32} {len(c.state_names):3} states, {len(c.lead_names):3} unknowns, {len(text):7} characters"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--only", default="")
    parser.add_argument("--form", default="routh")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.program)
    if numpy is None:
        print("NumPy is not there: the generated Python is NOT checked (Debian: python3-numpy)")
    shipped = {path.stem: path for path in sorted((ROOT / "models").rglob("*.toml")) if path.parent.name != "templates" and not path.stem.endswith("-symbolic")}
    names = list(shipped) if os.environ.get("ANHOLON_LONG") == "1" else SHIPPED
    failed = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        cases = [(name, shipped[name]) for name in names]
        for name, text in AWKWARD.items():
            path = folder / f"{name}.toml"
            path.write_text(text, encoding="utf-8")
            cases.append((name, path))
        cases = [case for case in cases if arguments.only in case[0]]
        with ThreadPoolExecutor(min(4, os.cpu_count() or 1)) as pool:
            jobs = [(name, pool.submit(check, program, arguments.form, name, path, folder)) for name, path in cases]
            for name, job in jobs:
                try:
                    print(job.result(), "ok", flush=True)
                except (Failure, KeyError, ValueError, ArithmeticError, SyntaxError) as error:
                    failed += 1
                    print(f"{name:32} FAIL {type(error).__name__}: {error}", flush=True)
    print(f"{len(cases) - failed} of {len(cases)} models pass")
    return 1 if failed or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
