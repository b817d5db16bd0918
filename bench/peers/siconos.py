#!/usr/bin/env python3
"""Motions with contacts: `anholon simulate` against the published results of the examples of Siconos.

    siconos.py --program PROGRAM [--own-steps 2e-5 1e-5]

The numbers are rows of the reference files (.ref) in https://github.com/siconos/siconos-tutorials, examples/mechanics
(Apache-2.0, INRIA); each example names its file and the commit. Siconos itself is not needed. Prints a Markdown table of
the largest deviations of places and of velocities. With --own-steps a second table tells how far the motions of
moreau_jean.py with these steps are from those of `simulate`; this needs NumPy.
"""

import argparse
import csv
import io
import math
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

OSCILLATOR = """
coordinates = ["x", "z"]
gravity.field = "-10*ez"
potential.spring = "x^2/2"
particle = [{name = "block", mass = 1, position = "x*ex + z*ez"}]
contact = [{name = "floor", gap = "z", slip = "x'", friction = 0.1}]
initial = {x = 12, "x'" = 6}
"""

BALL = """
coordinates = ["z"]
gravity.field = "-10*ez"
particle = [{name = "ball", mass = 1, position = "z*ez"}]
contact = [{name = "floor", gap = "z", restitution = 0.8}, {name = "ceiling", gap = "1.5 - z", restitution = 0.8}]
initial = {z = 1, "z'" = 10}
"""

PLANE = """
coordinates = ["z"]
parameters = {w = "pi/2"}
gravity.field = "-9.81*ez"
particle = [{name = "ball", mass = 1, position = "z*ez"}]
contact = [{name = "plane", gap = "z - 2*t - sin(w*t)/w", restitution = 0.9}]
initial = {z = 1}
"""

SPIN = """
coordinates = ["z", "x", "a"]
gravity.field = "-9.81*ez"
body = [{name = "ball", mass = 1, shape = "ball(0.5)", center = "x*ex + z*ez", orientation = "roty(a)"}]
contact = [{name = "floor", body = "ball", friction = 0.1, restitution = 0.9}]
initial = {z = 1, "a'" = 2}
"""

# In the results the block has the inertia of one of 1 x 0.5 and the corners of one of 0.2 x 0.1.
BLOCK = """
coordinates = ["x", "y", "th"]
parameters = {J = "(1 + 0.25)/12", a = 0.1, b = 0.05, e = 0.8}
gravity.field = "-9.81*ey"
frame.B = "rotz(th)"
point.C = "x*ex + y*ey"
body = [{name = "block", mass = 1, inertia = ["J", "J", "J"], center = "C", orientation = "B"}]
[[contact]]
name = "left"
gap = "(C - a*B.x - b*B.y).y"
restitution = "e"
[[contact]]
name = "right"
gap = "(C + a*B.x - b*B.y).y"
restitution = "e"
[initial]
x = "cos(pi/3)/2 - sin(pi/3)/4"
y = "sin(pi/3)/2 + cos(pi/3)/4"
th = "pi/3"
"""

STICK = """
coordinates = ["x", "y", "th"]
gravity.field = "-10*ey"
body = [{name = "stick", mass = 1, inertia = ["1/12", "1/12", "1/12"], center = "x*ex + y*ey", orientation = "rotz(th)"}]
[[contact]]
name = "floor"
gap = "y - cos(th)/2"
slip = "x' + cos(th)*th'/2"
friction = 0.01
restitution = 1
[initial]
x = "sin(pi/4)/2"
y = "cos(pi/4)/2 + 0.01"
th = "pi/4"
"x'" = -0.5
"y'" = 0.1
"th'" = 0.1
"""

CRANK = """
coordinates = ["th1", "th2", "th3"]
gravity.field = "-9.81*ez"
[parameters]
l1 = 0.153
l2 = 0.306
a = 0.05
b = 0.025
c = 0.001
[frame]
A = "roty(-th1)"
B = "roty(-th2)"
S = "roty(-th3)"
[point]
K = "l1*A.x"
C = "K + l2*B.x"
P1 = "C - a*S.x + b*S.z"
P2 = "C + a*S.x + b*S.z"
P3 = "C - a*S.x - b*S.z"
P4 = "C + a*S.x - b*S.z"
[[body]]
name = "crank"
mass = 0.038
inertia = [7.4e-5, 7.4e-5, 7.4e-5]
center = "l1/2*A.x"
orientation = "A"
[[body]]
name = "rod"
mass = 0.038
inertia = [5.9e-4, 5.9e-4, 5.9e-4]
center = "K + l2/2*B.x"
orientation = "B"
[[body]]
name = "slider"
mass = 0.076
inertia = [2.7e-6, 2.7e-6, 2.7e-6]
center = "C"
orientation = "S"
[initial]
"th1'" = 150
"th2'" = -75
""" + "".join(
    f"""
[[contact]]
name = "corner{k}"
gap = "b + c {sign} P{k}.z"
slip = "vel(slider, P{k}).x"
friction = 0.01
restitution = 0.4
"""
    for k, sign in enumerate("--++", 1)
)


@dataclass
class Example:
    name: str
    model: str  # a shipped model or the text of one
    file: str
    commit: str
    scheme: str
    places: list[str]
    velocities: list[str]
    rows: list[tuple[float, list[float]]]  # time; places, then velocities
    change: dict[str, float] = field(default_factory=dict)  # parameters of the model


TURN = 2 * math.pi

EXAMPLES = [
    Example(
        "woodpecker, begun as Siconos does",
        "woodpecker",
        "Woodpecker/Woodpecker.ref",
        "d73f8450550bd0f0234919822f82d83ae711c3e4",
        "Moreau-Jean, 2e-5",
        ["y", "phiM", "phiS"],
        ["y'", "phiM'", "phiS'"],
        [(0.05, [-4.407447581115698e-03, -0.1036, -3.929826323558062e-01, 0, 0, 1.466756739361719e01])],
        {"play": 0.0058 * 0.1036},
    ),
    Example(
        "woodpecker",
        "woodpecker",
        "Woodpecker/Woodpecker.ref",
        "d73f8450550bd0f0234919822f82d83ae711c3e4",
        "Moreau-Jean, 2e-5",
        ["y", "phiM", "phiS"],
        ["y'", "phiM'", "phiS'"],
        [
            (
                0.082,
                [-7.372892308861113e-03, 1.035802836008786e-01, 1.128615456441961e-01]
                + [6.836864601226841e-02, 0, -6.241529849979239e00],
            ),
            (
                0.122,
                [-1.082597072663672e-02, -1.034542612275354e-01, -1.173944200965509e-01]
                + [-3.179918501605071e-01, 0, -6.274865559623931e00],
            ),
            (0.2, [-2.388345040694624e-02, -1.034542612275354e-01, -3.309479788550502e-01, 0, 0, 1.646075215954180e01]),
            (
                0.29998,
                [-4.134818676833654e-02, -1.034684682717361e-01, -3.409339755504301e-01]
                + [-2.601373307913771e-01, 0, -8.327555353239312e00],
            ),
        ],
    ),
    Example(
        "block on a spring with dry friction",
        OSCILLATOR,
        "FrictionOscillator/FrictionOscillator.ref",
        "0472c74e27090c76361d0b59283625ea88f80f4b",
        "Euler-Moreau, 1e-2",
        ["x"],
        ["x'"],
        [
            (0.43, [1.331777943672665e01, 3.452537107654159e-02]),
            (10, [-7.256299752295587e00, 8.801721180254144e-01]),
            (99.99, [6.820441351954105e-01, 0]),
        ],
    ),
    Example(
        "ball between floor and ceiling",
        BALL,
        "BouncingBallEventDriven/BouncingBallED-TwoContacts.ref",
        "f9cbfdd162470befefe54074441218bae6f5b591",
        "event-driven, LSODAR",
        ["z"],
        ["z'"],
        [
            (0.06, [1.433721403014694e00, -7.676299364909250e00]),
            (0.73, [7.696997918828874e-02, -6.718746937951607e00]),
            (10, [2.032217136619642e-12, 1.869109338129200e-12]),
        ],
    ),
    Example(
        "ball on a plane that rises and shakes",
        PLANE,
        "BallOnMovingPlane/BallOnMovingPlane.ref",
        "d73f8450550bd0f0234919822f82d83ae711c3e4",
        "Moreau-Jean, 5e-3",
        ["z"],
        ["z'"],
        [(1.6, [4.325098947344009, 3.238813401135877]), (10, [19.99325651020532, 1.082967032474691])],
    ),
    Example(
        "ball with spin that bounces and rolls",
        SPIN,
        "RollingFriction/Ball_2d_with_kernel_only_with_rollingfriction.ref",
        "45b16f5a7b7dd338927f022837b5a09e338e72e1",
        "Moreau-Jean, 5e-3",
        ["z", "x", "a"],
        ["z'", "x'", "a'"],
        [
            (
                0.32,
                [5.125288374999982e-01, 7.142857142857604e-04, 6.364285714285712e-01]
                + [2.781134999999403e00, 2.857142857143039e-01, 5.714285714284806e-01],
            ),
            (
                10,
                [4.999671039101018e-01, 2.766428571428626e00, 6.167857142857144e00]
                + [0, 2.857142857142858e-01, 5.714285714285716e-01],
            ),
        ],
    ),
    Example(
        "rocking block",
        BLOCK,
        "RockingBlock/RockingBlockED_Lsodar_LZBimpact.ref",
        "e3d698e8e40972ef909581a3ac4e94e0fdda9de0",
        "event-driven, impulse steps 5e-5",
        ["y", "th"],
        ["y'", "th'"],
        [
            (0.35, [2.144407997314974e-01, 1.030651757297920e00, 1.891299999994262e00, -3.424262063653699e-01]),
            (1, [2.821782936546894e-01, 5.895470471068043e-01, -2.488500000089447e-01, -1.358901248085925e00]),
            (1.4, [1.128191974939628e-01, -4.829609415211609e-01, -9.415000000098087e-01, -3.749474843359462e00]),
        ],
    ),
    Example(
        "slider-crank with play",
        CRANK,
        "SliderCrank/SliderCrankMoreauJeanDirectProjectionOSI.ref",
        "01a86745119a36a009c2a544cb479977affcb151",
        "Moreau-Jean with projection, 1e-4",
        ["th1", "th2"],
        ["th1'", "th2'"],
        [
            (0.002, [4.393614652195465e-02 * TURN, -1.351018528775760e-01, 1.208242092110994e02, -5.668029347554309e01]),
            (0.01, [1.516241003214682e-01 * TURN, -4.161241947982883e-01, 6.814827174948590e01, -2.148921710498577e01]),
            (0.05, [7.704214589245456e-01 * TURN, 5.226075484687818e-01, 6.880558798089446e01, -5.080098914562762e00]),
        ],
    ),
    Example(
        "stick with friction",
        STICK,
        "ImpactingStick/ImpactingStick.ref",
        "34f16cfd6009dbe2f956369f39c9b508286fb730",
        "Moreau-Jean, 1e-4",
        ["x", "y", "th"],
        ["x'", "y'", "th'"],
        [(0.1, [3.034051457964930e-01, 3.383778702709042e-01, 8.580460693520362e-01])],
    ),
]


def simulate(program, example, times):
    """Returns the rows at the times, or the outcome of a motion that ends before."""
    with tempfile.TemporaryDirectory() as folder:
        model = example.model
        if "\n" in model:
            path = Path(folder) / "model.toml"
            path.write_text(model)
            model = str(path)
        command = [program, "simulate", model, "--at", ",".join(repr(t) for t in times), "--error-estimate", "never"]
        for name, value in example.change.items():
            command += ["--set", f"{name}={value!r}"]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode == 1:
        return next(line for line in run.stderr.splitlines() if line.startswith("stopped"))
    if run.returncode:
        raise RuntimeError(run.stderr)
    rows = list(csv.DictReader(io.StringIO(run.stdout)))
    return [[[float(row[c]) for c in columns] for columns in (example.places, example.velocities)] for row in rows]


def deviation(values, others):
    return max(abs(a - b) for a, b in zip(values, others))


def published(program):
    print("| example | Siconos' scheme and step | time | places | deviation | velocities | deviation |")
    print("|---|---|---:|---|---:|---|---:|")
    for e in EXAMPLES:
        found = simulate(program, e, [t for t, _ in e.rows])
        for k, (t, values) in enumerate(e.rows):
            first = f"| {e.name} | {e.scheme} | {t:g} | " if k == 0 else f"| | | {t:g} | "
            if isinstance(found, str):
                print(f"{first}{found} | | | |")
                continue
            places, velocities = found[k]
            n = len(places)
            cells = [", ".join(e.places), f"{deviation(places, values[:n]):.1e}"]
            cells += [", ".join(e.velocities), f"{deviation(velocities, values[n:]):.1e}"]
            print(first + " | ".join(cells) + " |")


def own(program, steps):
    from moreau_jean import moreau_jean, slider_crank, woodpecker

    print("\n| example | time | " + " | ".join(f"{h:g}" for h in steps) + " |\n|---|---:|" + "---:|" * len(steps))
    for name, system, t in (("woodpecker", woodpecker(), 0.29998), ("slider-crank with play", slider_crank(), 0.05)):
        e = next(e for e in EXAMPLES if e.name == name)
        n = len(e.places)
        cells = []
        exact = simulate(program, e, [t])[0][0]
        for h in steps:
            cells.append(f"{deviation(moreau_jean(system, h, [t])[0][0][:n], exact):.1e}")
        print(f"| {name}: {', '.join(e.places)} | {t:g} | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--own-steps", type=float, nargs="+", default=[])
    args = parser.parse_args()
    published(args.program)
    if args.own_steps:
        own(args.program, args.own_steps)
    return 0


if __name__ == "__main__":
    sys.exit(main())
