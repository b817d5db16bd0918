"""Names, lengths and singular states of the arguments of formulas."""

from collections.abc import Callable
from typing import Any

import anholon as an
import numpy as np
import pytest

# A car on a plane with a thrust and a torque, whose independent velocities would be called u1 and u2.
CAR = """
coordinates = ["x", "y", "th"]
parameters = {m = 2, J = 1.5}
input = {u1 = "1 + x", u2 = "3*u1"}
body = [{name = "car", mass = "m", inertia = "J", center = "x*ex + y*ey", angle = "th"}]
force = [{on = "car", vector = "u1*car.x"}, {on = "car", torque = "u2*ez"}]
constraint = [{name = "edge", equation = "dot(vel(car.center), car.y) = 0"}]
initial = {"x'" = 1, "th'" = 0.5}
monitor = {power = "u1*x'"}
"""

# A particle whose mass matrix is singular where y = 0.
FOLD = """
coordinates = ["x", "y"]
parameters = {m = 1}
particle = [{name = "b", mass = "m", position = "x*ex + y^2*ey"}]
force = [{on = "b", vector = "-x*ex + ey"}]
initial = {x = 1, y = 0.5}
"""

# The force along y moves the particle b, whose mass is 0, so that y has no acceleration.
MASSLESS = """
coordinates = ["x", "y"]
parameters = {m = 0, k = 2}
particle = [{name = "b", mass = "m", position = "x*ex + y*ey"}, {name = "c", mass = 1, position = "x*ex"}]
force = [{on = "b", vector = "(-k*y - y')*ey"}, {on = "c", vector = "y*ex"}]
initial = {x = 1, y = 2}
monitor = {power = "k*y*y'"}
"""


def state(f: an.Dynamics) -> Any:
    return f.start + 0.1 * np.cos(np.arange(len(f.start)))


def agree(f: an.Dynamics, x: Any, u: Any, p: Any) -> None:
    """Compares all kinds of formulas with the compiled function."""
    rates, outputs = f(0.3, x, u, p), f.output(0.3, x, u, p)

    def equal(found: Any) -> None:
        for have, expected in zip(found, (rates, outputs), strict=True):
            np.testing.assert_allclose(np.array(have, dtype=float).reshape(-1), expected, rtol=1e-12, atol=1e-14)

    equal(f.formulas.numpy()(0.3, x, u, p))
    equal(f.formulas.mpmath(0.3, list(x), list(u), list(p)))
    if jax := have("jax"):
        jax.config.update("jax_enable_x64", True)
        equal(f.formulas.jax()(0.3, x, u, p))
    if have("casadi"):
        equal(f.formulas.casadi()(0.3, x, u, p))
        equal(f.casadi()(0.3, x, u, p))
    if have("sympy"):
        s = f.formulas.sympy()
        symbols = [s.t, *s.x, *s.u, *s.p]
        assert len({symbol.name for symbol in symbols}) == len(symbols)
        values = dict(zip(symbols, (0.3, *x, *u, *p), strict=True))
        if s.matrix is not None:
            values |= dict(zip(s.lead, s.matrix.subs(values).LUsolve(s.right.subs(values)), strict=True))
        equal((s.rates.subs(values), s.outputs.subs(values)))


def have(module: str) -> Any:
    try:
        return pytest.importorskip(module)
    except pytest.skip.Exception:
        return None


@pytest.mark.parametrize(
    ("text", "names"),
    [
        (CAR, ["x", "y", "th", "u1_2", "u2_2"]),
        (CAR.replace("u2", "q"), ["x", "y", "th", "u1_2", "u2"]),
        (CAR.replace("u1", "f").replace("u2", "g").replace('"th', '"u1').replace("th'", "u1'"), ["x", "y", "u1", "u1_2", "u2"]),
        (CAR.replace("u1", "f").replace("u2", "g").replace("m = 2", "u1 = 2").replace('"m"', '"u1"'), ["x", "y", "th", "u1_2", "u2"]),
        (CAR.replace("u1", "f").replace("u2", "g"), ["x", "y", "th", "u1", "u2"]),
    ],
    ids=["inputs", "an input", "a coordinate", "a parameter", "none"],
)
def test_independent_velocities_have_names_of_their_own(text: str, names: list[str]) -> None:
    f = an.loads(text).dynamics(inputs=True)
    assert [s.name for s in f.states] == names
    agree(f, state(f), f.u0 + [0.5, -0.25], f.p0 + [0.5, 0.75])


def test_inputs_have_the_order_in_which_they_are_asked_for() -> None:
    model = an.loads(CAR)
    ab, ba = model.dynamics(inputs=["u1", "u2"]), model.dynamics(inputs=["u2", "u1"])
    assert ab.inputs == ["u1", "u2"] == model.dynamics(inputs=True).inputs
    assert ba.inputs == ["u2", "u1"]
    x, u, swapped = state(ab), np.array([0.5, 2.0]), np.array([2.0, 0.5])
    np.testing.assert_array_equal(ba.u0, ab.u0[::-1])
    np.testing.assert_array_equal(ba(0, x, swapped), ab(0, x, u))
    np.testing.assert_array_equal(ba(0, x), ab(0, x))
    np.testing.assert_array_equal(ba(0, x, {"u1": 0.5}), ab(0, x, {"u1": 0.5}))
    np.testing.assert_array_equal(ba.input(0, x), ab.input(0, x)[::-1])
    np.testing.assert_array_equal(ba.output(0, x, swapped), ab.output(0, x, u))
    np.testing.assert_allclose(ba.jac(0, x, swapped, by="u"), ab.jac(0, x, u, by="u")[:, ::-1], rtol=1e-15)
    agree(ba, x, swapped, ba.p0)
    with pytest.raises(an.ModelError, match=r"the input 'u1' is given twice"):
        model.dynamics(inputs=["u1", "u2", "u1"])


def test_a_singular_state_of_a_batch_has_rates_that_are_nan() -> None:
    f = an.loads(FOLD).dynamics()
    x = np.array([[1.0, 1, 1, 2], [0.5, 0, 0.6, 0], [0, 0.2, 0, 0], [0, 0, 0.1, 0]])
    rates, _ = f.formulas.numpy()(0, x)
    np.testing.assert_array_equal(np.isnan(rates).any(0), [False, True, False, True])
    for k in (0, 2):
        np.testing.assert_array_equal(rates[:, k], f.formulas.numpy()(0, x[:, k])[0])
        np.testing.assert_allclose(rates[:, k], f(0, x[:, k]), rtol=1e-14)
    np.testing.assert_array_equal(f.formulas.numpy()(0, x[:, 1])[0], [0.2, 0, np.nan, np.nan])
    shaped, _ = f.formulas.numpy()(0, x.reshape(4, 2, 2))
    np.testing.assert_array_equal(shaped, rates.reshape(4, 2, 2))
    assert f.formulas.numpy()(0, x[:, :0])[0].shape == (4, 0)


@pytest.mark.parametrize("library", ["numpy", "jax", "mpmath"])
def test_arguments_of_other_lengths_are_refused(library: str) -> None:
    pytest.importorskip(library)
    f = an.loads(CAR).dynamics(inputs=True)
    g: Callable[..., Any] = f.formulas.mpmath if library == "mpmath" else getattr(f.formulas, library)()
    x, u, p = f.start, f.u0, f.p0
    g(0, x, u, p), g(0, list(x), list(u), tuple(p)), g(0, x)
    for given, said in [
        ((x[:3],), "x has 3 entries; its first axis has to be the 5 states"),
        ((list(x) + [0.0],), "x has 6 entries; its first axis has to be the 5 states"),
        ((1.0,), "x has no axis; its first axis has to be the 5 states"),
        ((x, u[:1]), "u has 1 entries; its first axis has to be the 2 inputs"),
        ((x, None, [*p, 1.0]), "p has 3 entries; its first axis has to be the 2 parameters"),
    ]:
        with pytest.raises(ValueError, match=said):
            g(0, *given)


def test_a_vector_is_no_entry_of_the_parameters() -> None:
    text = """
    coordinates = ["x", "y"]
    parameters = {a = 3, axis = [1, 2, "a"], k = 2, far = "k*ex"}
    particle = [{name = "b", mass = 1, position = "x*ex + y*ey"}]
    force = [{on = "b", vector = "cross(axis, vel(b)) + k*axis + far"}]
    initial = {x = 1, "y'" = 0.3}
    """
    f = an.loads(text).dynamics()
    assert f.parameters == ["a", "k"]
    np.testing.assert_allclose(f(0, f.start)[2:], [-3 * 0.3 + 2 + 2, 4])
    np.testing.assert_allclose(f(0, f.start, p={"a": 5})[2:], [-5 * 0.3 + 2 + 2, 4])
    agree(f, state(f), f.u0, f.p0 + 1)
    with pytest.raises(KeyError, match="'axis' is not in p: it is a vector"):
        f(0, f.start, p={"axis": 1})


def test_formulas_of_a_coordinate_without_mass() -> None:
    f = an.loads(MASSLESS).dynamics()
    assert [s.name for s in f.states] == ["x", "y", "x'"]
    np.testing.assert_allclose(f(0, f.start), [0, -4, 2])
    agree(f, state(f), f.u0, f.p0 + 0.5)
    assert "m" not in f.formulas.source.split("PARAMETERS = ")[1].split("\n")[0]
