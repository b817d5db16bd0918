"""Functions of the mechanics mean what the motion means: in the corners of independent velocities, modes and redundancy."""

from __future__ import annotations

import math

import anholon as an
import numpy as np
import pytest

ON_A_LINE = """
coordinates = ["x", "y", "z"]
particle = [{name = "p", mass = 2, position = ["x", "y", "z"]}]
constraint = [{name = "c", equation = "x' = cos(t)"}]
"""


def rate(f: an.Dynamics, name: str) -> float:
    return float(f(1.0, f.start)[[state.name for state in f.states].index(name)])


@pytest.mark.parametrize(
    "force, expected",
    [
        ('force = [{generalized = {z = "x\'\'"}}]', -math.sin(1) / 2),
        ('input = {u = "x\'\'"}\nforce = [{generalized = {z = "u"}}]', -math.sin(1) / 2),
        ('define = {b = "D(x, 2)"}\nforce = [{generalized = {z = "b"}}]', -math.sin(1) / 2),
        ('force = [{on = "p", vector = "-0.2*acc(p) + t*ez"}]', 1 / 2.2),
    ],
)
def test_forces_hold_accelerations(force: str, expected: float) -> None:
    model = an.loads(ON_A_LINE + force)
    for minimal in (True, False):
        f = model.dynamics(minimal=minimal)
        if minimal:
            assert "acceleration" in f.obstacle
        assert rate(f, "z'") == pytest.approx(expected, rel=1e-14)
    f.c_code()
    model.python_code()


def test_a_rate_holds_an_acceleration() -> None:
    model = an.loads(ON_A_LINE + 'state = {w = {rate = "x\'\'", initial = 0}}')
    f = model.dynamics()
    assert rate(f, "w") == pytest.approx(-math.sin(1), rel=1e-14)


GEARS = """
coordinates = ["x", "y"]
{decides}
particle = [{{name = "a", mass = 1, position = "x*ex + y*ey"}}]
gravity.field = "-9.81*ey"
force = [{{on = "a", vector = "-gear*(x - 1)*ex"}}]
constraint = [{{name = "v2", equation = "x' = y'", active = "{active}"}}]
initial = {{x = 0.6, y = 0.8}}
"""


@pytest.mark.parametrize(
    "decides, active, fixed",
    [
        ("mode = {gear = 2}", "gear - 1.5", ["gear"]),
        ("mode = {gear = 2}\nparameters = {half = 1.5, k = 3, a = \"k/2\"}", "gear*a - 1", ["gear", "k"]),
    ],
)
def test_what_decides_constraints_is_no_argument(decides: str, active: str, fixed: list[str]) -> None:
    model = an.loads(GEARS.format(decides=decides, active=active)).in_mode("gear=2")
    f = model.dynamics(minimal=False)
    assert not set(fixed) & set(f.parameters)
    assert "half" in f.parameters or "half" not in decides
    with pytest.raises((KeyError, ValueError, an.ModelError)):
        f(0, f.start, p={"gear": 1})
    code = model.c_code()
    for name in fixed:
        assert f"The value of {name} decides which constraints hold" in " ".join(code.replace("*", " ").split())


def test_multipliers_of_dependent_constraints_are_left_out() -> None:
    model = an.loads("""
        coordinates = ["x", "y"]
        particle = [{name = "a", mass = 2, position = ["x", "y", "0"]}]
        constraint = [{name = "c1", equation = "x' = t*y'"}, {name = "c2", equation = "2*x' - 2*t*y' = 0"}]
        initial = {"x'" = 0, "y'" = 1}
        monitor = {l1 = "lambda.c1", l2 = "lambda.c2", d = "x + y"}
    """)
    f = model.dynamics(minimal=False)
    assert f.outputs == ["d"]
    np.testing.assert_allclose(f.output(0, f.start), [0])
    for name in ("l1", "l2"):
        with pytest.raises(an.ModelError, match="depend on one another"):
            model.dynamics(minimal=False, outputs={"own": f"lambda.c{name[1]}"})


def test_determined_multipliers_beside_dependent_constraints_are_outputs() -> None:
    model = an.loads("""
        coordinates = ["x", "z"]
        particle = [{name = "a", mass = 2, position = ["x", "0", "z"]}]
        force = [{on = "a", vector = "3*ex - 20*ez"}]
        constraint = [{name = "floor", equation = "z = 0"}, {name = "stop", equation = "vel(a) = 0"}]
    """)
    f = model.dynamics(minimal=False, outputs={"side": "lambda.stop.x"})
    np.testing.assert_allclose(f.output(0, f.start), [-3])
    for held in ("lambda.floor", "lambda.stop.z"):
        with pytest.raises(an.ModelError, match="depend on one another"):
            model.dynamics(minimal=False, outputs={"load": held})
    notes = model.check().notes
    assert any("lambda.floor and lambda.stop.z are not determined one by one" in note for note in notes)


def test_outputs_hold_forces_of_the_mode() -> None:
    gears = GEARS.format(decides="mode = {gear = 2}", active="gear - 1.5") + 'monitor = {L = "lambda.v2"}'
    model = an.loads(gears).in_mode("gear=2")
    f, own = (model.dynamics(minimal=False, outputs=outputs) for outputs in (None, {"own": "2*lambda.v2"}))
    np.testing.assert_allclose(2 * f.output(0, f.start), own.output(0, own.start), rtol=1e-15)
    with pytest.raises(an.ModelError, match="no value here"):
        an.loads(gears).in_mode("gear=1").dynamics(minimal=False, outputs={"own": "lambda.v2"})
