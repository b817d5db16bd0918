"""Rates of the model's states that are not linear in accelerations and multipliers."""

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
    """Returns the rates by hand: x' = v cos th, y' = v sin th, v' = a w^2, (J + m a^2) w' = u - m a v w, lambda = m (v w + a w')."""
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


ROCKET = """coordinates = ["x", "y"]
parameters = {c = 100, k = 0.1, g = 9.8}
state.fuel = {rate = "-2 - k*x''", initial = 3}
constraint = [{name = "rail", equation = "y' = x'*x"}]
particle = [{name = "rocket", mass = "10 + fuel", position = "x*ex + y*ey", expelled_velocity = "-c*ex"}]
force = [{on = "rocket", vector = "fuel'*ey - (10 + fuel)*g*ey"}]
initial = {x = 0.4, "x'" = 0.3}
"""


def test_forces_with_rates_of_states_are_in_the_arrays_of_the_equations(f: an.Dynamics) -> None:
    rocket = an.loads(ROCKET).dynamics(minimal=False)
    x = np.stack([rocket.start, rocket.start + [0.2, 0, 0.1, 0.12, 1]], axis=1)
    mass, phi, bias = rocket.mass_matrix(0, x), rocket.constraint_jacobian(0, x), rocket.bias(0, x)
    for k, (fuel, at) in enumerate([(3, 0.4), (4, 0.6)]):
        # By hand: fuel' = -2 - k x'', so the thrust c fuel' along -x and the force fuel' along y depend on x''.
        np.testing.assert_allclose(mass[..., k], [[10 + fuel - 100 * 0.1, 0], [0.1, 10 + fuel]], rtol=1e-14, atol=1e-14)
        np.testing.assert_allclose(bias[:, k], [-200, 2 + (10 + fuel) * 9.8], rtol=1e-14)
        direction = np.array([1, at])  # along the rail
        np.testing.assert_allclose(phi[..., k] @ direction, 0, atol=1e-15)
        assert abs(direction @ (mass[..., k] @ rocket(0, x[:, k])[2:4] + bias[:, k])) < 1e-12
        np.testing.assert_array_equal(bias[:, k], rocket.bias(0, x[:, k]))
    # The rate of 'wear' is no unknown of the equations, as it is not linear in them.
    plate = f.model.dynamics(minimal=False)
    assert phi.shape == (1, 2, 2) and plate.constraint_jacobian(0, plate.start).shape == (1, 3)


def test_the_thrust_of_a_shipped_rocket_is_in_the_bias() -> None:
    launcher = an.load("launcher").dynamics(minimal=False)
    n, x = len(launcher.model.coordinates), launcher.start
    left = launcher.mass_matrix(0, x) @ launcher(0, x)[n : 2 * n] + launcher.bias(0, x)
    assert launcher.constraint_jacobian(0, x).shape == (0, n)
    np.testing.assert_allclose(left, 0, atol=1e-9 * np.abs(launcher.bias(0, x)).max())


def test_no_bias_where_a_force_holds_a_multiplier_by_a_rate() -> None:
    held = an.loads(ROCKET.replace('"-2 - k*x\'\'"', '"-2 - k*lambda.rail"')).dynamics(minimal=False)
    with pytest.raises(an.ModelError, match="a force holds a multiplier by the rate of a state"):
        held.bias(0, held.start)


def test_a_state_of_the_motion_that_holds_the_rate_of_a_state_starts_with_it() -> None:
    model = an.loads("""coordinates = ["x", "y"]
particle = [{name = "p", mass = 2, position = "x*ex + y*ey"}]
state.s = {rate = "-s", initial = 1}
potential.k = "x^2 + y^2"
constraint = [{name = "c", equation = "y = (1 + s)*x"}]
initial = {x = 0.3}
""")
    f = model.dynamics()
    assert [state.name for state in f.states] == ["x", "y", "x'", "y'", "s", "s'"]
    motion = f.motion(f.start)
    assert motion["s"] == 1 and motion["s'"] == -1 and motion["y'"] == 2 * motion["x'"] - 0.3
    q, qdot = {"x": motion["x"], "y": motion["y"]}, {"x'": motion["x'"], "y'": motion["y'"]}
    assert f.state(q=q, qdot=qdot, z={"s": 1, "s'": -1}) == pytest.approx(f.start, abs=0)
    with pytest.warns(UserWarning, match="x holds the rate s', which counts as 0: give z="):
        f.state(q=q, qdot=qdot, z={"s": 1})
    # The rates are those of the motion.
    run = model.simulate(to="1e-6", at=["1e-6"]).expect()
    assert run["x'"][-1] - motion["x'"] == pytest.approx(1e-6 * f(0, f.start)[2], rel=1e-5)


def test_the_mass_matrix_where_the_state_holds_the_rate_of_a_state() -> None:
    curve = """coordinates = ["x", "y"]
particle = [{name = "bead", mass = 2, position = "x*ex + y*ey"}]
constraint = [{name = "rail", equation = "y = x^2*(1 + s) + s^2"}]
gravity.field = "-9.81*ey"
state.s = {rate = "cos(t)", initial = 0}
initial.x = 0.3
"""
    f = an.loads(curve).dynamics(minimal=False)
    assert [entry.name for entry in f.states][-2:] == ["s", "s'"]
    x, v, s, ds = 0.5, 0.7, 0.3, 1.0
    state = np.array([x, x * x * (1 + s) + s * s, v, 2 * x * v * (1 + s) + x * x * ds + 2 * s * ds, s, ds])
    np.testing.assert_allclose(f.mass_matrix(0, state), 2 * np.eye(2), rtol=1e-15)
    np.testing.assert_allclose(f.constraint_jacobian(0, state), [[-2 * x * (1 + s), 1]], rtol=1e-14)
    right = f.mass_matrix(0, state) @ f(0, state)[2:4] + f.bias(0, state)
    np.testing.assert_allclose(right[0] + 2 * x * (1 + s) * right[1], 0, atol=1e-13)  # the force of the rail is normal to it
    many = np.stack([state, state * 1.0], axis=1)
    assert f.mass_matrix(0, many).shape == (2, 2, 2) and f.bias(0, many).shape == (2, 2)
