"""Rates of the model's states that are no linear functions of accelerations and multipliers."""

from __future__ import annotations

import anholon as an
import numpy as np
import pytest

WEAR = """coordinates = ["x", "y", "th"]
parameters = {m = 2, J = 0.3, a = 0.2, k = 0.7}
input.torque = "0.1*cos(t)"
body = [{name = "plate", mass = "m", inertia = "J", center = "x*ex + y*ey + a*(cos(th)*ex + sin(th)*ey)", angle = "th"}]
force = [{on = "plate", torque = "torque*ez"}]
constraint = [{name = "blade", equation = "y'*cos(th) - x'*sin(th) = 0"}]
state.wear = {rate = "k*sqrt(1 + lambda.blade^2) + abs(th'')^2", initial = 0}
monitor.power = "wear'*lambda.blade"
initial = {th = 0.3, "x'" = 1, "th'" = 0.8}
"""


@pytest.fixture(scope="module")
def f() -> an.Dynamics:
    return an.loads(WEAR).dynamics(inputs=True)


def rates(x: np.ndarray, u: float, p: np.ndarray) -> np.ndarray:
    """By hand: x' = v cos th, y' = v sin th, v' = a w^2, (J + m a^2) w' = u - m a v w, lambda = m (v w + a w')."""
    m, J, a, k = p
    v, w = x[3] * np.cos(x[2]) + x[4] * np.sin(x[2]), x[5]
    dv, dw = a * w * w, (u - m * a * v * w) / (J + m * a * a)
    c, s = np.cos(x[2]), np.sin(x[2])
    force = m * (v * w + a * dw)
    wear = k * np.sqrt(1 + force**2) + dw**2
    return np.array([v * c, v * s, w, dv * c - v * w * s, dv * s + v * w * c, dw, wear, wear * force])


def test_they_follow_from_what_the_equations_give(f: an.Dynamics) -> None:
    assert f.linear and [state.name for state in f.states][-1] == "wear"
    for speed, heading, turn, torque in [(1, 0.3, 0.8, 0.1), (-2, 2.0, 0.0, 0.4), (0.5, -1.0, -3.0, -1)]:
        x = np.array([0.1, 0.2, heading, speed * np.cos(heading), speed * np.sin(heading), turn, 0.5])
        p = f.p0 * 1.1
        expected = rates(x, torque, p)
        np.testing.assert_allclose(f(0, x, [torque], p), expected[:7], rtol=1e-13, atol=1e-13)
        np.testing.assert_allclose(f.output(0, x, [torque], p), expected[7:], rtol=1e-13)


def test_derivatives_and_programs_of_others(f: an.Dynamics) -> None:
    x = np.array([0.1, 0.2, 0.3, np.cos(0.3), np.sin(0.3), 0.8, 0.5])
    h = 1e-6
    by_torque = (f(0, x, [0.1 + h], f.p0) - f(0, x, [0.1 - h], f.p0)) / (2 * h)
    np.testing.assert_allclose(f.jac(0, x, [0.1], f.p0, by="u")[:7, 0], by_torque, rtol=1e-8, atol=1e-8)
    pytest.importorskip("casadi")
    np.testing.assert_allclose(np.array(f.casadi()(0, x, [0.1], f.p0)[0])[:, 0], f(0, x, [0.1], f.p0), rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("method", ["rk", "bdf"])
def test_motions_by_other_methods(method: str) -> None:
    model = an.loads(WEAR)
    run, taylor = model.simulate(to=3, method=method, tolerance="1e-9"), model.simulate(to=3)
    assert run.outcome.ok and abs(run["wear"][-1] - taylor["wear"][-1]) < 1e-7
