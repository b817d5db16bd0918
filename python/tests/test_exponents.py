"""Powers whose exponents are parameters, in functions of states."""

from __future__ import annotations

import anholon as an
import numpy as np
import pytest

DUFFING = """coordinates = ["x"]
parameters = {n = 3, k = 2}
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{generalized = {x = "-k*x^n"}}]
output.E = "k*x^(n + 1)/(n + 1)"
initial = {x = START}
"""


def function(start: float, minimal: bool = True) -> an.Dynamics:
    return an.loads(DUFFING.replace("START", str(start))).dynamics(minimal=minimal)


@pytest.mark.parametrize("minimal", [True, False])
@pytest.mark.parametrize("start", [-0.5, 0, 0.5])
def test_whole_exponents_have_values_at_every_state(start: float, minimal: bool) -> None:
    f = function(start, minimal)
    assert f.parameters == ["n", "k"]
    for x in (-0.5, 0.0, 0.7):
        expected = np.array([0.3, -2 * x**3])
        np.testing.assert_allclose(f(0, [x, 0.3]), expected, atol=1e-15)
        np.testing.assert_allclose(f(0, [x, 0.3], p=f.p0), expected, atol=1e-15)
        np.testing.assert_allclose(f.formulas.numpy()(0, [x, 0.3], [], f.p0)[0], expected, atol=1e-15)
        np.testing.assert_allclose(f.jac(0, [x, 0.3]), np.array([[0.0, 1.0], [-6 * x**2, 0.0]]), atol=1e-14)
        np.testing.assert_allclose(f.output(0, [x, 0.3]), [x**4 / 2], atol=1e-15)
    assert f(0, [-0.5, 0])[1] == an.loads(DUFFING.replace("START", "-0.5")).simulate(to=0)["x''"][0]


def test_other_exponents_are_right_or_nan() -> None:
    f = function(0.5)
    x = np.array([-0.5, 0.3])
    for n in (0, 1, 2, 5):
        assert f(0, x, p={"n": n})[1] == pytest.approx(-2 * (-0.5) ** n, rel=1e-14)
        assert f.output(0, x, p={"n": n})[0] == pytest.approx(2 * (-0.5) ** (n + 1) / (n + 1), rel=1e-14)
        assert f.jac(0, x, p={"n": n})[1, 0] == pytest.approx(-2 * n * (-0.5) ** (n - 1), rel=1e-14)
    assert np.isnan(f(0, x, p={"n": 2.5})[1])
    assert f(0, [0.5, 0.3], p={"n": 2.5})[1] == pytest.approx(-2 * 0.5**2.5, rel=1e-14)
    # A start at which the other exponent has no value leaves the function without one.
    assert function(-0.5)(0, x, p={"n": 2})[1] == pytest.approx(-0.5, rel=1e-14)
    rate = function(-0.5)(0, [0.5, 0.3], p={"n": 2.5})[1]
    assert np.isnan(rate) or rate == pytest.approx(-2 * 0.5**2.5, rel=1e-14)


def test_each_state_of_a_batch_has_its_own_exponent() -> None:
    f = function(0.5)
    n = np.array([3, 2, 2.5, 3, 2.5, 4.0])
    x = np.array([[-0.5, -0.5, -0.5, 0.7, 0.7, 0.0], np.linspace(0, 1, 6)])
    p = np.array([n, np.linspace(1, 2, 6)])
    for call in (f, f.output, f.jac, lambda t, x, p: f.jac(t, x, p=p, by="p")):
        many = call(0, x, p=p)
        for k in range(6):
            np.testing.assert_array_equal(many[..., k], call(0, x[:, k], p=p[:, k]))
    assert list(np.isnan(f(0, x, p=p)[1])) == [False, False, True, False, False, False]


def test_derivatives_by_an_exponent() -> None:
    f = function(0.5)
    jac = f.jac(0, [0.5, 0], by="p")
    np.testing.assert_allclose(jac[1], [-2 * 0.5**3 * np.log(0.5), -(0.5**3)], rtol=1e-14)
    jac = f.jac(0, [-0.5, 0], by="p")
    assert np.isnan(jac[1, 0]) and jac[1, 1] == pytest.approx(0.125, rel=1e-14)


def test_generated_code_takes_the_exponent_as_an_argument() -> None:
    pytest.importorskip("casadi")
    for start in (-0.5, 0.5):
        f = function(start)
        g = f.casadi()
        for n in (2, 3):
            assert float(g(0, [-0.5, 0], [], [n, 2])[0][1]) == pytest.approx(-2 * (-0.5) ** n, rel=1e-14)
            assert float(f.formulas.mpmath(0, [-0.5, 0], [], [n, 2])[0][1]) == pytest.approx(-2 * (-0.5) ** n, rel=1e-14)


STEERED = """coordinates = ["x", "y"]
parameters = {n = 3, m = "n - 1", a = 0}
input.F = "-x^n"
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
force = [{on = "p", vector = "F*ex + a*y^m*ey"}]
initial = {x = -0.5, y = -1}
"""


def test_exponents_in_inputs_and_exponents_that_follow_from_others() -> None:
    f = an.loads(STEERED).dynamics(minimal=False, inputs=True, outputs={"s": "y^m"})
    x = [-0.5, -1.5, 0, 0]
    assert f.input(0, x)[0] == pytest.approx(0.125) and f.input(0, x, p={"n": 2})[0] == pytest.approx(-0.25)
    np.testing.assert_allclose(f(0, x), [0, 0, 0.125, 0], rtol=1e-14)
    np.testing.assert_allclose(f(0, x, {"F": 1}, {"n": 2, "a": 1}), [0, 0, 1, -1.5], rtol=1e-14)
    assert f.output(0, x)[0] == pytest.approx(2.25) and f.output(0, x, p={"n": 4})[0] == pytest.approx(-(1.5**3))


def test_independent_velocities_with_an_exponent() -> None:
    text = """coordinates = ["x", "y"]
parameters = {n = 3}
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
constraint = [{name = "c", equation = "y' = x^n*x'"}]
initial = {x = START, "x'" = 0.3}
"""
    for start in (0.5, -0.5):
        f = an.loads(text.replace("START", str(start))).dynamics()
        assert f.minimal
        for n in (3, 2):
            for x in (0.7, -0.7):
                state = f.state(q={"x": x, "y": 0}, qdot={"x'": 0.4, "y'": 0.4 * x**n}, p={"n": n})
                rates = f(0, state, p={"n": n})
                if n == 2 and start < 0:  # no function for all exponents tells whether the velocity is the same one
                    assert np.isnan(rates).all() or rates[1] == pytest.approx(0.4 * x**n, rel=1e-12)
                else:
                    np.testing.assert_allclose(rates[:2], [0.4, 0.4 * x**n], rtol=1e-12)
        if start > 0:
            np.testing.assert_allclose(f.formulas.numpy()(0, f.start, [], f.p0)[0], f(0, f.start), atol=1e-15)
        else:
            with pytest.raises(ValueError, match="exponent has no value at the start"):
                f.c_code()


def test_sympy_has_powers_with_parameters_as_exponents() -> None:
    pytest.importorskip("sympy")
    text = """coordinates = ["x"]
parameters = {k = 2.5}
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{generalized = {x = "-abs(x)^k*sign(x)"}}]
initial = {x = 1}
"""
    f = an.loads(text).dynamics()
    s = f.formulas.sympy()
    rates = s.rates if not s.lead else s.rates.subs(dict(zip(s.lead, s.matrix.LUsolve(s.right), strict=True)))
    value = rates.subs({**dict(zip(s.x, [0.5, 0], strict=True)), **dict(zip(s.p, [2.5], strict=True))})
    assert float(value[1]) == pytest.approx(-(0.5**2.5), rel=1e-14)
