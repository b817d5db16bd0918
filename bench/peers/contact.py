#!/usr/bin/env python3
"""Motions with contacts: `anholon simulate` against MuJoCo and closed forms.

    contact.py --program PROGRAM [--steps 1e-3 1e-4]

MuJoCo's contacts are springs with dampers whose stiffness is bounded by the step. In its results the ball with back-spin
hops, and it slips longer by its flight. Prints a Markdown table of the deviations from the closed forms. Without MuJoCo (pip install mujoco) it says so and does nothing.
"""

import argparse
import csv
import io
import subprocess
import sys
import tempfile
from pathlib import Path

G = 9.81

BLOCK = """
coordinates = ["x", "z"]
parameters = {m = 1, mu = 0.3, g = 9.81}
gravity.field = "-g*ez"
particle = [{name = "block", mass = "m", position = "x*ex + z*ez"}]
[[contact]]
name = "floor"
gap = "z"
slip = "x'"
friction = "mu"
[initial]
"x'" = 2
"""

BALL = """
coordinates = ["x", "z", "phi"]
parameters = {m = 1, R = 0.1, mu = 0.3, g = 9.81}
gravity.field = "-g*ez"
point.C = "x*ex + z*ez"
[[body]]
name = "ball"
mass = "m"
shape = "ball(R)"
center = "C"
orientation = "roty(phi)"
[[contact]]
name = "floor"
gap = "z - R"
slip = "vel(ball, C - R*ez)"
along = ["ex"]
friction = "mu"
[initial]
z = "R"
"x'" = 2
"phi'" = -30
"""

# Slide joints and a hinge keep the body in the plane; a contact is that of a sphere with the floor. MuJoCo takes the larger
# friction of the two geoms.
WORLD = """<mujoco>
  <option timestep="{h}" gravity="0 0 -9.81" cone="elliptic" impratio="1000" integrator="{integrator}" tolerance="1e-14" iterations="200"/>
  <worldbody>
    <geom type="plane" size="50 50 1" friction="{mu} 0 0" condim="3" solref="{stiff} 1" solimp="0.9999 0.9999 0.001"/>
    {bodies}
  </worldbody>
</mujoco>"""
PLANE_BODY = """<body pos="0 0 0.1"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>{hinge}
<geom type="sphere" size="0.1" mass="1" friction="{mu} 0 0" condim="3" solref="{stiff} 1" solimp="0.9999 0.9999 0.001"/></body>"""
HINGE = '<joint type="hinge" axis="0 1 0"/>'


def anholon(program, text, to, columns):
    """Returns the last row of a motion."""
    with tempfile.TemporaryDirectory() as folder:
        model = Path(folder) / "model.toml"
        model.write_text(text)
        out = subprocess.run(
            [program, "simulate", str(model), "--at", repr(to), "--quiet", "--error-estimate", "never"],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
    row = list(csv.DictReader(io.StringIO(out)))[-1]
    return [float(row[c]) for c in columns]


def mujoco_plane(mujoco, h, mu, hinge, velocities, to):
    """Returns position and velocity along x, the angular velocity if there is a hinge, and the greatest height of the flight."""
    stiff = 2 * h
    bodies = PLANE_BODY.format(hinge=HINGE if hinge else "", mu=mu, stiff=stiff)
    text = WORLD.format(h=h, mu=mu, bodies=bodies, stiff=stiff, integrator="Euler")
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qvel[:] = velocities
    hop = 0
    for _ in range(round(to / h)):
        mujoco.mj_step(model, data)
        hop = max(hop, data.qpos[1])
    return [data.qpos[0], data.qvel[0]] + ([data.qvel[2]] if hinge else []), hop


def block_exact(t):
    v, a = 2, 0.3 * G
    t = min(t, v / a)
    return [v * t - a * t * t / 2, v - a * t]


def ball_exact(t):
    """Returns the motion of a ball with back-spin: it slips until 2 (v - R w)/(7 mu g), then rolls; w = -30 turns against the motion."""
    v, w, radius, mu = 2, -30, 0.1, 0.3
    end = 2 * (v - radius * w) / (7 * mu * G)
    slip = min(t, end)
    x, speed = v * slip - mu * G * slip**2 / 2, v - mu * G * slip
    turn = w + 5 * mu * G / (2 * radius) * slip
    return [x + speed * (t - slip), speed, turn]


CASES = [
    ("block that slides, while it slips", BLOCK, False, [2, 0], 0.5, ["x", "x'"], block_exact),
    ("block that slides, at rest", BLOCK, False, [2, 0], 1.0, ["x", "x'"], block_exact),
    ("ball with back-spin, while it slips", BALL, True, [2, 0, -30], 0.4, ["x", "x'", "phi'"], ball_exact),
    ("ball with back-spin, rolling", BALL, True, [2, 0, -30], 1.0, ["x", "x'", "phi'"], ball_exact),
]


def deviation(values, exact):
    return max(abs(a - b) for a, b in zip(values, exact))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--steps", type=float, nargs="+", default=[1e-3, 1e-4])
    args = parser.parse_args()
    try:
        import mujoco
    except ImportError:
        print("MuJoCo is not installed: python -m pip install mujoco", file=sys.stderr)
        return 0
    print(f"MuJoCo {mujoco.__version__}: largest deviation of the columns from the closed form\n")
    print("| motion | columns at t | anholon | " + " | ".join(f"MuJoCo, step {h:g} | its hop" for h in args.steps) + " |")
    print("|---|---|---:|" + "---:|---:|" * len(args.steps))
    for name, text, hinge, velocities, to, columns, exact in CASES:
        want = exact(to)
        own = deviation(anholon(args.program, text, to, columns), want)
        cells = [f"{own:.1e}"]
        for h in args.steps:
            values, hop = mujoco_plane(mujoco, h, 0.3, hinge, velocities, to)
            cells += [f"{deviation(values, want):.1e}", f"{hop:.1e}"]
        print(f"| {name} | {', '.join(columns)} at {to:g} | " + " | ".join(cells) + " |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
