"""The rates in independent velocities of `derive --format python` are those of dynamics(), at one state and at many."""

import re
from collections.abc import Callable
from typing import Any

import anholon as an
import numpy as np
import pytest

MODELS = ["disc", "chaplygin-sleigh", "trailers", "snakeboard", "rolling-coin", "ball-on-turntable", "roller-racer", "two-wheeled-pendulum",
          "ball-on-turntable-rotating", "car-three-trailers", "sleigh-with-moving-mass", "snake", "vertical-disc", "whipple"]  # fmt: skip


def run(text: str) -> dict[str, Any]:
    made: dict[str, Any] = {"__name__": "program"}
    exec(compile(text, "program.py", "exec"), made)
    return made


def compare(name: str, text: str) -> bool:
    """Compares the rates of a program with those of dynamics(). Returns False if the program has no rates."""
    f = an.load(name).dynamics()
    made = run(text)
    if "rates" not in made:
        return False
    assert list(made["X"]) == [state.name for state in f.states]
    np.testing.assert_allclose(made["X_START"], f.start, rtol=1e-15)
    draw = np.random.default_rng(1)
    x = f.start[:, None] + 0.1 * draw.standard_normal((len(f.start), 5000))
    rates, many = f(f.t0, x), made["rates"](f.t0, x)
    # Differences are relative to the largest rate of a state, since terms cancel.
    size = 1 + np.abs(rates).max(axis=0)
    np.testing.assert_allclose(many / size, rates / size, rtol=0, atol=1e-12)
    # One state is given as an array and as a list.
    for k in (0, 4095, 4096, 4999):
        one = made["rates"](f.t0, x[:, k].tolist())
        assert isinstance(one, list)
        np.testing.assert_array_equal(made["rates"](f.t0, x[:, k].copy()), one)
    for k in (0, 1, 4095, 4096, 4999):
        np.testing.assert_allclose(made["rates"](f.t0, x[:, k].copy()) / size[k], many[:, k] / size[k], rtol=0, atol=1e-14)
    out = np.empty_like(x)
    assert made["rates"](np.full(5000, f.t0), x, out=out) is out
    np.testing.assert_array_equal(out, many)
    # `out` may be the array of the states.
    own = x.copy()
    assert made["rates"](f.t0, own, out=own) is own
    np.testing.assert_array_equal(own, many)
    # Formulas with given parameters have another form and round differently (the snake by 1.5e-14).
    each = np.repeat(made["DEFAULTS"][:, None], 5000, axis=1)
    given = made["rates"](f.t0, x, each)
    np.testing.assert_allclose(given / size, many / size, rtol=0, atol=1e-13)
    np.testing.assert_allclose(given / size, rates / size, rtol=0, atol=1e-12)
    np.testing.assert_allclose(made["rates"](f.t0, x, made["DEFAULTS"]) / size, given / size, rtol=0, atol=1e-14)
    return True


def test_rates_are_those_of_dynamics(program: Callable[..., str]) -> None:
    # The program of the last model has no rates.
    compared = [name for name in MODELS if compare(name, program("derive", name, "--format", "python"))]
    assert compared == MODELS[:-1]


def test_a_wrong_sign_is_found(program: Callable[..., str]) -> None:
    text = program("derive", "disc", "--format", "python")
    # The signs are in the rates for given parameters, for one state and for many.
    for found, wrong in ((r"(out\[6\] = )", r"\1-"), (r"return \[", r"return [-"), (r"_add\(x6, o4", r"_subtract(x6, o4")):
        before, after = text.split("def _rates", 1)
        changed = re.sub(found, wrong, after, count=1)
        assert changed != after
        with pytest.raises(AssertionError):
            compare("disc", before + "def _rates" + changed)


FORMULAS = """
coordinates = ["x", "y", "z"]
particle = [{name = "a", mass = 2, position = ["x", "y", "z"]}]
force = [{on = "a", vector = "(%s)*ex - (3*x + abs(y))*ey"}]
constraint = [{name = "c", equation = "y' = x*z'"}]
[parameters]
k = 3
n = "k^2"
[initial]
q = {x = 0.5, y = 0.3}
qdot = {x = 0.2, z = 0.4}
"""


@pytest.mark.parametrize(
    "force",
    ["-n*x^3/(1 + y^2)", "x*cos(3*t)", "(2 + x)^(1/3)*atan2(y, x)", "exp(-x)*pi/k*x' + x'*y'*x + x*x'", "piecewise(x > y, k*x, y^2)", "sign(x)*tanh(t)",
     "(x' - y')*(x' - y')/k + sin(x)*cos(x) + cos(x)", "1/(x*y) + 1/x^2 + y/x + x^5", "0*x", "sin(y)*sin(y) - k"],
)  # fmt: skip
def test_formulas_of_all_kinds(force: str) -> None:
    model = an.loads(FORMULAS % force)
    made, f = run(model.python_code()), model.dynamics()
    assert list(made["X"]) == [state.name for state in f.states]
    x = f.start[:, None] + 0.1 * np.random.default_rng(4).standard_normal((5, 50))
    expected = f(0.7, x)
    np.testing.assert_allclose(made["rates"](0.7, x), expected, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(made["rates"](np.full(50, 0.7), x), expected, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(made["rates"](0.7, x, made["DEFAULTS"]), expected, rtol=1e-12, atol=1e-12)
    for k in (0, 49):
        np.testing.assert_allclose(made["rates"](0.7, x[:, k].tolist()), expected[:, k], rtol=1e-12, atol=1e-12)


def test_where_a_formula_has_no_value_there_is_nan() -> None:
    made = run(an.loads(FORMULAS % "x/y").python_code())
    for p in (None, made["DEFAULTS"]):
        assert np.isnan(made["rates"](0, [0.0] * 5, p)[3])
        many = made["rates"](0, np.array([[0.0, 1.0, 1.0], [0.0, 0.0, 1.0], *[[0.0] * 3] * 3]), p)
        assert np.isnan(many[3, 0]) and np.isinf(many[3, 1]) and np.isfinite(many[:, 2]).all()


def test_nearly_singular_equations_keep_their_digits(program: Callable[..., str]) -> None:
    """The matrix of the rattleback is nearly singular. Elimination loses six digits, and a correction of the solution restores them."""
    mpmath = pytest.importorskip("mpmath")
    f = an.load("rattleback").dynamics(minimal=False)
    made, names = run(program("derive", "rattleback", "--format", "python")), [state.name for state in f.states]
    own = [names.index(name) for name in made["STATE"]]
    x = f.start[:, None] + 0.1 * np.random.default_rng(0).standard_normal((len(names), 24))
    with mpmath.workdps(40):
        exact = np.array([[float(v) for v in f.formulas.mpmath(0, [mpmath.mpf(v) for v in state.tolist()])[0]] for state in x.T]).T
    size = np.maximum(1, np.abs(exact))
    assert size.max() > 1e3
    many = made["rhs"](0.0, x[own])
    np.testing.assert_allclose(many / size[own], exact[own] / size[own], rtol=0, atol=1e-12)
    for k in range(5):
        np.testing.assert_allclose(made["rhs"](0.0, x[own, k]) / size[own, k], exact[own, k] / size[own, k], rtol=0, atol=1e-12)
    assert "_y0" not in program("derive", "falling-chain", "--format", "python")  # well-conditioned equations need no correction


def test_expressions_of_casadi_keep_their_digits() -> None:
    pytest.importorskip("casadi")
    f = an.load("rattleback").dynamics(minimal=False)
    function, x = f.formulas.casadi(), f.start + 0.02 * np.random.default_rng(3).standard_normal(len(f.start))
    rates = f(0, x)
    np.testing.assert_allclose(np.array(function(0, x, [], f.p0)[0])[:, 0] / np.maximum(1, abs(rates)), rates / np.maximum(1, abs(rates)), rtol=0, atol=1e-11)
