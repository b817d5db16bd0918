#!/usr/bin/env python3
"""The digits to trust, compared with the digits that are true.

Each motion of MOTIONS, and each shipped model with one of its parameters changed, is computed once with 30 digits or more, then by several
methods, tolerances and number types, at the same times; sweeps are judged by the final states of the cases that they compare. The true error of each kind of columns is compared with what `simulate` claims: none may be above ten times the claim
without a warning in the report, and the median of true error over claim must lie between 0.1 and 1.

    run.py PROGRAM [--all] [--jobs N] [--only TEXT] [--verbose] [--self-test]

Without --all (or ANHOLON_LONG=1) every eighth motion is taken. The scale of a column is the one that doc/results.md describes. The
self-test makes every claim a hundred times smaller, which must be noticed.
"""
import argparse
import concurrent.futures
import json
import os
import random
import statistics
import subprocess
import sys
import tempfile
import tomllib
import zlib
from decimal import Decimal, getcontext
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
getcontext().prec = 60
SECONDS = 300
MOST = 10.0                # times the claim
MEDIAN = (0.1, 1.0)

PARTICLE = 'coordinates = ["x"]\nparticle = [{name = "p", mass = 1, position = "x*ex"}]\n'
PLANE = 'coordinates = ["x", "y"]\nparticle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]\n'


def force(vector, more=""):
    return f'{more}force = [{{on = "p", vector = "{vector}"}}]\n'


# Models of kinds that no shipped model has: chaos in states, stiffness, fast phases, small motions, kinks, tables,
# events.
TEXTS = {
    "lorenz": PARTICLE + '[state]\na = {rate = "10*(b - a)", initial = 1}\nb = {rate = "a*(28 - c) - b", initial = 1}\nc = {rate = "a*b - 8*c/3", initial = 1}\n[initial]\nx = 1\n"x\'" = 1\n',
    "van-der-pol": PARTICLE.replace("particle", 'parameters = {mu = 100}\nparticle', 1) + force("(mu*(1-x^2)*x'-x)*ex") + '[initial]\nx = 2\n"x\'" = 0\n',
    "kepler": PLANE + 'parameters = {e = 0.3}\n[gravity]\nfield = "-here/norm(here)^3"\n[initial]\nx = "1 - e"\n"y\'" = "sqrt((1 + e)/(1 - e))"\n',
    "kepler-from-afar": PLANE + 'parameters = {e = 0.3}\n[gravity]\nfield = "-here/norm(here)^3"\n[initial]\nx = "1 + e"\n"y\'" = "sqrt((1 - e)/(1 + e))"\n',
    "small": PARTICLE + 'parameters = {size = 1e-9}\n' + force("-x*ex") + '[initial]\nx = "size"\n"x\'" = 0\n',
    "duffing": PARTICLE + force("(x - x^3 - 0.15*x' + 0.3*cos(t))*ex") + '[initial]\nx = 1\n"x\'" = 0\n[monitor]\nE = "x\'^2/2 - x^2/2 + x^4/4"\n',
    "henon-heiles": PLANE + force("-(x + 2*x*y)*ex - (y + x^2 - y^2)*ey") + '[initial]\nx = 0.1\ny = 0.2\n"x\'" = 0.4\n"y\'" = 0.1\n[monitor]\nE = "(x\'^2 + y\'^2 + x^2 + y^2)/2 + x^2*y - y^3/3"\n',
    "upright": 'coordinates = ["th"]\nparameters = {g = 9.81}\nparticle = [{name = "p", mass = 1, position = "sin(th)*ex - cos(th)*ey"}]\n[gravity]\nfield = "-g*ey"\n[initial]\nth = "pi"\n"th\'" = 0\n',
    "nearly-upright": 'coordinates = ["th"]\nparameters = {g = 9.81, off = 0.1}\nparticle = [{name = "p", mass = 1, position = "sin(th)*ex - cos(th)*ey"}]\n[gravity]\nfield = "-g*ey"\n[initial]\nth = "3.141592653589793 - off"\n"th\'" = 0\n',
    "circle": PLANE + 'parameters = {g = 9.81}\nconstraint = [{name = "rod", equation = "x^2 + y^2 = 1"}]\n[gravity]\nfield = "-g*ey"\n[initial]\nx = 1\ny = 0\n"y\'" = 0\n[monitor]\nE = "(x\'^2 + y\'^2)/2 + g*y"\npull = "2*lambda.rod"\n',
    "dry": PARTICLE + force("(3*sin(3*t) - 0.2*sign(x') - x)*ex") + '[initial]\nx = 1\n"x\'" = 0.5\n',
    "kinks": PARTICLE + force("(-x - 0.5*abs(x - 0.2) + 0.1*max(x, 0.5))*ex") + '[initial]\nx = 1\n"x\'" = 0\n',
    "far-centre": PARTICLE + 'parameters = {R = 1e6}\n' + force("(1/(R + x)^2 - 1/R^2)*1e12*ex") + '[initial]\nx = 1\n"x\'" = 0\n[monitor]\nF = "(1/(R + x)^2 - 1/R^2)*1e12"\n',
    "drag": PLANE + 'parameters = {g = 9.81, k = 0.05}\n' + 'force = [{on = "p", vector = "-k*norm(vel(p.center))*vel(p.center)"}]\n[gravity]\nfield = "-g*ey"\n[initial]\nx = 0\ny = 0\n"x\'" = 20\n"y\'" = 30\n',
    "bouncing": PARTICLE + 'parameters = {g = 9.81}\n[gravity]\nfield = "-g*ex"\n[initial]\nx = 1\n"x\'" = 0.3\n[[event]]\nname = "floor"\nwhen = "x"\ndirection = "down"\nset = {"x\'" = "-0.8*x\'"}\n',
    "two-springs": PLANE + force("-100*(x - y)*ex - (100*(y - x) + 1e4*y)*ey") + '[initial]\nx = 1\ny = 0\n"x\'" = 0\n"y\'" = 0\n[monitor]\napart = "x - y"\n',
    "relaxing": PARTICLE + '[state]\nfast = {rate = "1000*(cos(x) - fast)", initial = 0}\n[initial]\nx = 0\n"x\'" = 1\n',
    "swing-table": PARTICLE + force("spring(x)*ex") + '[[table]]\nname = "spring"\nx = [-3, -1, 0, 1, 3]\ny = [5, 1, 0, -1.5, -6]\nfit = "spline"\n[initial]\nx = 2\n"x\'" = 0\n',
    "swing-table-linear": PARTICLE + force("spring(x)*ex") + '[[table]]\nname = "spring"\nx = [-3, -1, 0, 1, 3]\ny = [5, 1, 0, -1.5, -6]\nfit = "linear"\n[initial]\nx = 2\n"x\'" = 0\n',
    "scales": PLANE + force("-1e6*x*ex - y*ey") + '[initial]\nx = 1e-6\ny = 1e3\n"x\'" = 0\n"y\'" = 0\n',
    "growing": PARTICLE + force("x*ex") + '[initial]\nx = 1e-3\n"x\'" = 1e-3\n',
    "decaying": PARTICLE + force("(-2*x - 3*x')*ex") + '[initial]\nx = 1\n"x\'" = 0\n',
    "blow-up": PARTICLE + force("6*x^2*ex") + '[initial]\nx = 1\n"x\'" = 2\n',
    "falling-in": PARTICLE + force("-1/x^2*ex") + '[initial]\nx = 1\n"x\'" = 0\n',
    "rod-through-its-end": PLANE + 'constraint = [{name = "slot", equation = "y = sqrt(1 - x)"}]\n[initial]\nx = 0\n"x\'" = 1\n',
    "three-body": 'coordinates = ["x", "y", "u", "v"]\nparticle = [{name = "a", mass = 1, position = "x*ex + y*ey"}, {name = "b", mass = 1, position = "u*ex + v*ey"}]\n'
                  'force = [{on = "a", vector = "-a.center/norm(a.center)^3 - 0.1*(a.center - b.center)/norm(a.center - b.center)^3"},\n'
                  ' {on = "b", vector = "-b.center/norm(b.center)^3 - 0.1*(b.center - a.center)/norm(a.center - b.center)^3"}]\n'
                  '[initial]\nx = 1\ny = 0\n"x\'" = 0\n"y\'" = 1\nu = -1.6\nv = 0\n"u\'" = 0\n"v\'" = -0.7\n',
}

# name, options, end, digits of the reference
MOTIONS = [
    ("lorenz", "", 5, 30), ("lorenz", "", 15, 40), ("lorenz", "", 30, 60), ("lorenz", "", 60, 75),
    ("van-der-pol", "--set mu=1", 30, 30), ("van-der-pol", "--set mu=20", 60, 30), ("van-der-pol", "", 200, 30),
    ("kepler", "", 60, 30), ("kepler", "--set e=0.95", 46, 30), ("kepler-from-afar", "--set e=0.95", 46, 30), ("kepler-from-afar", "--set e=0.99", 30, 30), ("kepler-from-afar", "--set e=0.999", 20, 32),
    ("small", "", 20, 30), ("small", "--set size=1e-6", 20, 30), ("small", "--set size=1e3", 20, 30),
    ("duffing", "", 20, 30), ("duffing", "", 100, 40), ("henon-heiles", "", 50, 30), ("henon-heiles", "--q x=0.3", 150, 40),
    ("upright", "", 4, 30), ("upright", "", 7, 34), ("upright", "", 12, 40), ("nearly-upright", "--set off=1e-9", 12, 40), ("nearly-upright", "", 10, 30), ("circle", "", 10, 30), ("circle", "", 40, 30),
    ("dry", "", 10, 30), ("kinks", "", 15, 30), ("drag", "", 5, 30), ("bouncing", "", 3, 30), ("two-springs", "", 5, 30), ("relaxing", "", 3, 30),
    ("swing-table", "", 20, 30), ("swing-table-linear", "", 20, 30), ("scales", "", 5, 30), ("growing", "", 30, 30), ("decaying", "", 30, 40), ("three-body", "", 30, 30),
    ("blow-up", "", 1.5, 30), ("falling-in", "", 1.2, 30), ("rod-through-its-end", "", 1.2, 30),
    ("zoo/appell-hamel", "", 2, 30), ("zoo/appell-hamel-regularised", "", 2, 30), ("zoo/ball-on-tilted-turntable", "", 1, 30), ("zoo/ball-on-turntable", "", 2, 30),
    ("zoo/ball-on-turntable-rotating", "", 2, 30), ("zoo/car-three-trailers", "", 2, 30), ("zoo/chain", "--set n=4", 2, 30), ("zoo/chaplygin-sleigh", "", 5, 30), ("zoo/chaplygin-sleigh", "", 40, 30),
    ("zoo/constant-acceleration", "", 2, 30), ("zoo/constant-jerk-central", "", 2, 30), ("zoo/constant-jerk", "", 2, 30), ("zoo/disc", "", 4, 30), ("zoo/disc", "--q theta=0.05", 1, 30),
    ("zoo/double-pendulum-cartesian", "", 1, 30), ("zoo/double-pendulum-cartesian", "", 6, 30), ("zoo/falling-chain", "", 3, 30), ("zoo/fourbar", "", 0.8, 30), ("zoo/isokinetic", "", 1, 30),
    ("zoo/launcher", "", 100, 30), ("zoo/mass-depends-on-velocity", "", 4, 30), ("zoo/rattleback", "", 0.05, 30), ("zoo/rheonomic-order-1", "", 1, 30), ("zoo/rheonomic-order-2", "", 0.5, 30),
    ("zoo/rheonomic-order-3", "", 0.3, 30), ("zoo/rocket", "", 4, 30), ("zoo/roller-racer", "", 6, 30), ("zoo/rolling-coin", "", 2, 30), ("zoo/second-order-linear", "", 2, 30),
    ("zoo/sleigh-with-moving-mass", "", 10, 30), ("zoo/snake", "", 1, 30), ("zoo/snakeboard", "", 2, 30), ("zoo/spherical-robot", "", 0.5, 30), ("zoo/tether-by-servo", "", 3000, 30), ("zoo/tether", "", 3000, 30),
    ("zoo/third-order-linear", "", 1, 30), ("zoo/trailers", "", 2, 30), ("zoo/two-wheeled-pendulum", "", 2, 30), ("zoo/variable-mass-pendulum", "", 4, 30), ("zoo/variable-mass-pendulum", "", 9, 30),
    ("zoo/vertical-disc", "", 5, 30), ("zoo/whipple", "", 1, 30), ("papers/luo-zhao-example-1", "", 2, 30), ("papers/luo-zhao-example-2-inertial-frame", "", 2, 30),
    ("papers/luo-zhao-example-2-plane-frame", "", 2, 30), ("papers/luo-zhao-example-2-regular", "", 5, 30), ("papers/luo-zhao-example-2", "", 5, 30),
    ("templates/cart", "", 3, 30), ("templates/pendulum", "", 5, 30), ("templates/rolling", "", 2, 30), ("templates/vehicle", "", 2, 30),
]
WAYS = [
    "", "--tolerance 1e-8", "--method rk --tolerance 1e-9", "--integrator cvode --tolerance 1e-9", "--tolerance 2e-16", "--method bdf --tolerance 1e-7", "--integrator ida --tolerance 1e-8",
    "--method rk --tolerance 1e-5", "--numbers long-double --tolerance 1e-18", "--tolerance 1e-4", "--every-step", "--form chaplygin",
]
# They come after the others, so that the choice of a short run does not change.
FAR = [("far-centre", "", 5, 40), ("far-centre", "", 500, 40)]
# Shipped models and their end times, with another parameter and in sweeps over it.
VARIED = {"zoo/" + k: v for k, v in {
    "appell-hamel": 1.5, "appell-hamel-regularised": 1.5, "ball-on-turntable": 1.5, "car-three-trailers": 1.5, "chaplygin-sleigh": 6, "constant-acceleration": 1.5, "constant-jerk": 1.5, "disc": 2.5,
    "double-pendulum-cartesian": 1.5, "fourbar": 0.6, "isokinetic": 0.8, "mass-depends-on-velocity": 3, "rheonomic-order-1": 0.8, "rheonomic-order-2": 0.4, "rocket": 3, "rolling-coin": 1.5,
    "second-order-linear": 1.5, "snake": 1, "snakeboard": 1.5, "third-order-linear": 0.8, "trailers": 1.5, "variable-mass-pendulum": 5, "vertical-disc": 4, "whipple": 0.7,
}.items()} | {"papers/luo-zhao-example-1": 1.5, "papers/luo-zhao-example-2-regular": 3, "templates/cart": 2, "templates/pendulum": 4, "templates/rolling": 1.5, "templates/vehicle": 1.5}

# Each motion gets the first ALWAYS of these ways, then OTHERS of the rest.
ALWAYS, OTHERS = 2, 3


def simulate(program, arguments, seconds=SECONDS):
    """The JSON of a run, or the message if it is refused."""
    try:
        done = subprocess.run([program, "simulate", *arguments, "--json", "--quiet"], capture_output=True, text=True, timeout=seconds,
                              env={**os.environ, "ANHOLON_CACHE": "", "NO_COLOR": "1"}, check=False)
    except subprocess.TimeoutExpired:
        return None, f"more than {seconds} s"
    if not done.stdout.startswith("{"):
        return None, done.stderr.strip()
    return json.loads(done.stdout, parse_float=Decimal, parse_int=Decimal), ""


STARTS = {"zoo/falling-chain": 1}  # start times that are not 0


def times_of(name, end):
    chosen = random.Random(zlib.crc32(f"{name} {end}".encode()))
    start = STARTS.get(name, 0)
    return [f"{start + chosen.uniform(0.02, 1) * (end - start):.6f}" for _ in range(39)] + [str(end)]


def kinds_of(columns, run):
    """The kind of each column, by the order of columns in rows."""
    coordinates = [c[2:] for c in columns if c.startswith("N.")]
    first_reaction = columns.index("N." + coordinates[0]) if coordinates else len(columns)
    known = {k["kind"] for k in run["error_estimate"].get("kinds", [])}
    kinds = {}
    for i, c in enumerate(columns[1:], 1):
        base = c.rstrip("'")
        order = len(c) - len(base)
        if c.startswith("D("):
            base, order = c[2:-1].split(",")[0], int(c[2:-1].split(",")[-1])
        if i >= first_reaction:
            kinds[c] = "reactions" if i < first_reaction + len(coordinates) else "monitors"
        elif base in coordinates:
            kinds[c] = ["coordinates", "velocities", "accelerations", "higher derivatives"][min(order, 3)]
        elif base.startswith("lambda.") or (base[2:] if base.startswith("D(") else base).startswith("lambda."):
            kinds[c] = "multipliers" if order == 0 else "rates of multipliers"
        else:
            kinds[c] = "rates of multipliers" if order else "inputs" if "inputs" in known and "states" not in known else "states"
    return kinds


def true_errors(run, reference, tolerance, roundoff):
    """The error of each kind, its worst column and time, by the scales of the report."""
    columns = run["columns"]
    kinds = kinds_of(columns, run)
    rows = {row[0]: row for row in reference["rows"]}
    # A row at the moment of an event lies before it or after it.
    moments = [float(e["t"]) for e in run.get("events", [])]
    width = len(columns)
    difference, most, where = [0.0] * width, [0.0] * width, [None] * width
    for row in run["rows"]:
        exact = rows.get(row[0])
        if exact is None:
            continue
        ambiguous = any(abs(float(row[0]) - t) < 1e-9 for t in moments)
        for j in range(1, width):
            if row[j] is None or exact[j] is None:
                continue
            d = float(abs(row[j] - exact[j]))
            most[j] = max(most[j], float(abs(exact[j])))
            if d > difference[j] and not ambiguous:
                difference[j], where[j] = d, float(row[0])
    others = max(tolerance, 64 * roundoff)
    greatest = {}
    for j in range(1, width):
        greatest[kinds[columns[j]]] = max(greatest.get(kinds[columns[j]], 0.0), most[j])
        if difference[j] < 0.1 * most[j]:
            others = max(others, difference[j] / most[j])
    errors = {}
    for j in range(1, width):
        kind, scale = kinds[columns[j]], most[j]
        like = greatest[kind]
        noise = 64 * roundoff * max(1.0, like)
        if most[j] <= noise and difference[j] <= noise:
            scale = max(1.0, like)
        elif difference[j] >= 0.1 * most[j] and difference[j] <= 10 * others * like:
            scale = like
        error = 0.0 if difference[j] == 0 else difference[j] / scale if scale > 0 else float("inf")
        if kind not in errors or error > errors[kind][0]:
            errors[kind] = (error, columns[j], where[j])
    return errors


def changed_parameter(name):
    """One of the parameters of a shipped model, with its value."""
    with open(ROOT / "models" / (name + ".toml"), "rb") as file:
        numbers = [(k, v) for k, v in tomllib.load(file).get("parameters", {}).items() if isinstance(v, (int, float)) and v != 0 and "[" not in k]
    return numbers[zlib.crc32(name.encode()) % len(numbers)]


def variations():
    for name, end in VARIED.items():
        parameter, value = changed_parameter(name)
        yield name, f"--set {parameter}={value * 1.125:.6g}", end, 30


class Motion:
    def __init__(self, index, entry, folder):
        self.index, (self.name, self.options, self.end, self.digits) = index, entry
        self.title = f"{self.name} {self.options} to {self.end}".replace("  ", " ")
        self.model = self.name
        if self.name in TEXTS:
            self.model = str(folder / (self.name + ".toml"))
            Path(self.model).write_text(TEXTS[self.name], encoding="utf-8")
        else:
            self.model = str(ROOT / "models" / (self.name + ".toml"))
        self.times = times_of(self.name, self.end)

    def ways(self):
        others = WAYS[ALWAYS:]
        return WAYS[:ALWAYS] + [others[(self.index * OTHERS + k) % len(others)] for k in range(OTHERS)]

    def base(self):
        return [self.model, *self.options.split()]

    def reference(self, program, times):
        return simulate(program, [*self.base(), "--at", ",".join(times), "--digits", str(self.digits + 2), "--tolerance", f"1e-{self.digits}", "--error-estimate", "never",
                                  *(["--numbers", "quad"] if self.digits <= 30 else [])])


def judge(program, motion, way, common):
    """One line for each kind: (true error, claim, …)."""
    words = way.split()
    every_step = "--every-step" in words
    arguments = [*motion.base(), *(["--to", str(motion.end)] if every_step else ["--at", ",".join(motion.times)]), *[w for w in words if w != "--every-step"]]
    run, why = simulate(program, arguments)
    label = f"{motion.title} [{way or 'as it is'}]"
    if run is None:
        return label, None, why
    estimate = run.get("error_estimate")
    if not estimate or estimate["digits"] is None:
        return label, [], f"no claim: {estimate and estimate['reason']}"
    reference = common
    if every_step:
        # Keeps the rows where the numbers change fastest, and some others.
        rows = run["rows"]
        pace = sorted(range(1, len(rows)), key=lambda i: -max(float(abs(a - b)) for a, b in zip(rows[i][1:], rows[i - 1][1:])) / max(float(rows[i][0] - rows[i - 1][0]), 1e-300))
        chosen = sorted({*pace[:20], *range(1, len(rows), max(1, len(rows) // 20)), len(rows) - 1})
        run["rows"] = [rows[i] for i in chosen]
        reference, why = motion.reference(program, [str(r[0]) for r in run["rows"]])
        if reference is None:
            return label, None, "no reference: " + why
    tolerance = float(words[words.index("--tolerance") + 1]) if "--tolerance" in words else 1e-12
    errors = true_errors(run, reference, tolerance, 2.0**-64 if "long-double" in words else 2.0**-53)
    claims = {k["kind"]: k for k in estimate["kinds"]}
    warned = bool(run.get("warnings")) or "until" in estimate
    lines = []
    for kind, (error, column, t) in errors.items():
        if kind not in claims and error == 0:
            continue
        claim = float(claims[kind]["error"]) if kind in claims else 0.0
        lines.append((error / claim if claim > 0 else 0.0 if error == 0 else float("inf"), error, claim, kind, column, t, warned))
    return label, lines, ""


def judge_sweep(program, name, end, tolerance):
    """A sweep over one parameter: its claim, against the cases that it compared."""
    parameter, value = changed_parameter(name)
    label = f"sweep of {name} over {parameter} to {end} [{tolerance}]"
    values = [f"{value * factor:.6g}" for factor in (0.9, 1, 1.05)]
    model = str(ROOT / "models" / (name + ".toml"))
    done = subprocess.run([program, "sweep", model, "--vary", f"{parameter}={','.join(values)}", "--to", str(end), "--tolerance", tolerance, "--json", "--quiet", "--threads", "1"], capture_output=True, text=True,
                          timeout=SECONDS, env={**os.environ, "ANHOLON_CACHE": ""}, check=False)
    if not done.stdout.startswith("{"):
        return label, None, done.stderr.strip()
    sweep = json.loads(done.stdout, parse_float=Decimal, parse_int=Decimal)
    estimate = sweep["error_estimate"]
    if estimate["digits"] is None:
        return label, None, estimate["reason"]
    worst = {}
    first = sweep["columns"].index("t")
    for case in estimate["compared"]:
        reference, why = simulate(program, [model, "--set", f"{parameter}={values[int(case)]}", "--at", str(end), "--digits", "32", "--tolerance", "1e-30", "--numbers", "quad", "--error-estimate", "never"])
        if reference is None:
            return label, None, "no reference: " + why
        run = {"columns": reference["columns"], "error_estimate": estimate, "rows": [[None] * len(reference["columns"])]}
        row = sweep["rows"][int(case)]
        for column, number in zip(sweep["columns"][first:], row[first:]):
            run["rows"][0][run["columns"].index(column)] = number
        run["rows"][0][0] = reference["rows"][0][0]
        for kind, error in true_errors(run, reference, float(tolerance), 2.0**-53).items():
            worst[kind] = max(worst.get(kind, (0.0, "", 0.0)), error)
    claims = {k["kind"]: float(k["error"]) for k in estimate["kinds"]}
    return label, [(error / claims[kind], error, claims[kind], kind, column, t, False) for kind, (error, column, t) in worst.items() if kind in claims], ""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--only", default="")
    parser.add_argument("--verbose", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    o = parser.parse_args()
    o.program = str(Path(o.program).resolve())
    every = o.all or os.environ.get("ANHOLON_LONG") == "1" or o.only
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(o.jobs) as pool:
        motions = [Motion(i, entry, Path(folder)) for i, entry in enumerate([*MOTIONS, *variations(), *FAR])]
        sweeps = [(name, end, tolerance) for name, end in VARIED.items() for tolerance in ("1e-12", "1e-7") if o.only in "sweep of " + name]
        motions = [m for m in motions if o.only in m.title]
        if not every:
            motions, sweeps = motions[::8] if not o.self_test else motions, sweeps[::15]

        def all_ways(motion):
            common, why = motion.reference(o.program, motion.times)
            if common is None or not common["rows"]:
                return [(motion.title, None, "no reference: " + (why or str(common["outcome"])))]
            return [judge(o.program, motion, way, common) for way in motion.ways()]

        if o.self_test:
            false_claims = [(label, lines and [(100 * ratio, error, claim / 100, *rest) for ratio, error, claim, *rest in lines], why) for label, lines, why in all_ways(next(m for m in motions if m.name == "kepler"))]
            return 0 if tell(false_claims, False) == 1 else 1

        of_sweeps = [pool.submit(judge_sweep, o.program, *s) for s in sweeps]
        results = [r for list_ in pool.map(all_ways, motions) for r in list_] + [s.result() for s in of_sweeps]
    return tell(results, o.verbose)


def tell(results, verbose):
    bad, ratios, by_kind, judged, refused = [], [], {}, 0, []
    for label, lines, why in results:
        if lines is None:
            refused.append(f"{label}: {why}")
            continue
        judged += 1
        if why:
            refused.append(f"{label}: {why}")
        for ratio, error, claim, kind, column, t, warned in lines:
            # A number that is exact but for its last written digit does not test the estimate.
            if claim > 4e-16 or error > claim:
                ratios.append(ratio)
                by_kind.setdefault(kind, []).append(ratio)
            if verbose or ratio > 2:
                print(f"{ratio:9.3g} = {error:.3g} / {claim:.3g}  {kind}: {column} at t = {t}{', warned' if warned else ''}  {label}")
            if ratio > MOST and not warned:
                bad.append(f"{label}: {kind}, {column}: true error {error:.3g}, claimed {claim:.3g}")
    for line in refused:
        print("left out:", line.replace("\n", " ")[:200])
    for kind, list_ in sorted(by_kind.items()):
        print(f"{kind:22} {len(list_):4} kinds of runs, true error / claim: median {statistics.median(list_):.3g}, largest {max(list_):.3g}, above 1: {sum(r > 1 for r in list_)}")
    median = statistics.median(ratios) if ratios else 0
    print(f"{judged} runs judged, {len(refused)} left out or without a claim; median of true error over claim {median:.3g}, above 1: {sum(r > 1 for r in ratios)}, above 2: {sum(r > 2 for r in ratios)}, above {MOST:g}: {sum(r > MOST for r in ratios)}")
    if not MEDIAN[0] <= median <= MEDIAN[1]:
        bad.append(f"the median of true error over claim is {median:.3g}")
    for line in bad:
        print("FAILED:", line)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
