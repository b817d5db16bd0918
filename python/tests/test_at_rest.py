"""Derivatives at rest, where norms of velocities have a kink, and optimal control that begins there."""

from typing import Any

import anholon as an
import numpy as np
import pytest

PLANE = """coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
potential.s = "x^2 + 2*y^2"
input.u = "0"
"""
DRAG = PLANE + 'force = [{on = "p", vector = "u*ex - norm(vel(p))*vel(p)"}]\n'
FRICTION = PLANE + 'force = [{on = "p", vector = "u*ex - norm(vel(p))*ex"}]\n'
RESTING = [[0, 0, 1, 0], [0, 0, 0, 1], [-2, 0, 0, 0], [0, -4, 0, 0]]
# At x' = 3, y' = 4: |v| + x'^2/|v|, x' y'/|v|, |v| + y'^2/|v|.
MOVING = [[0, 0, 1, 0], [0, 0, 0, 1], [-2, 0, -6.8, -2.4], [0, -4, -2.4, -8.2]]
STATES = [((0.5, 0, 0, 0), RESTING), ((0, 0, 3, 4), MOVING)]


def of(text: str, minimal: bool) -> an.Dynamics:
    return an.loads(text).dynamics(minimal=minimal, inputs=["u"])


def by_casadi(g: Any, x: Any) -> Any:
    return np.array(g.factory("j", ["t", "x", "u", "p"], ["jac:dx:x"])(0, x, [0], []))


def by_jax(g: Any, x: Any, mode: str) -> Any:
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    return getattr(jax, mode)(lambda x: g(0.0, x, np.zeros(1))[0])(np.array(x, dtype=float))


@pytest.mark.parametrize("minimal", [True, False])
@pytest.mark.parametrize(("x", "expected"), STATES)
def test_a_drag_has_derivatives_at_rest(x: Any, expected: Any, minimal: bool) -> None:
    f = of(DRAG, minimal)
    np.testing.assert_allclose(f.jac(0, x), expected, atol=1e-14)
    pytest.importorskip("casadi")
    for g in (f.casadi(), f.formulas.casadi()):
        np.testing.assert_allclose(by_casadi(g, x), expected, atol=1e-14)
        np.testing.assert_allclose(np.array(g(0, x, [0], [])[0])[:, 0], f(0, x), atol=1e-14)
    for mode in ("jacfwd", "jacrev"):
        np.testing.assert_allclose(by_jax(f.formulas.jax(), x, mode), expected, atol=1e-14)


@pytest.mark.parametrize("minimal", [True, False])
def test_a_kink_is_nan_or_a_number_between_both_sides(minimal: bool) -> None:
    pytest.importorskip("casadi")
    f, x = of(FRICTION, minimal), (0.5, 0, 0, 0)
    jac = f.jac(0, x)
    assert np.isnan(jac[2, 2:]).all() and not np.isnan(jac[:2]).any() and not np.isnan(jac[:, :2]).any()
    for g in (f.casadi(), f.formulas.casadi()):
        np.testing.assert_allclose(by_casadi(g, x), RESTING, atol=1e-14)
    np.testing.assert_allclose(by_jax(f.formulas.jax(), x, "jacfwd"), RESTING, atol=1e-14)


@pytest.mark.parametrize("exponent", ["1/2", "3/2", "3"])
def test_other_powers_of_the_speed(exponent: str) -> None:
    pytest.importorskip("casadi")
    f = of(PLANE + f'force = [{{on = "p", vector = "u*ex - norm(vel(p))^({exponent})*vel(p)"}}]\n', False)
    for g in (f.casadi(), f.formulas.casadi()):
        np.testing.assert_allclose(by_casadi(g, (0.5, 0, 0, 0)), RESTING, atol=1e-14)
        np.testing.assert_allclose(by_casadi(g, (0, 0, 3, 4)), f.jac(0, (0, 0, 3, 4)), rtol=1e-13)


def test_formulas_of_sympy_and_numpy_keep_their_roots() -> None:
    pytest.importorskip("sympy")
    f = of(DRAG, False)
    rates = f.formulas.sympy()
    assert "Piecewise" not in str(rates.right) + str(rates.rates)
    np.testing.assert_allclose(f.formulas.numpy()(0, (0, 0, 3, 4))[0], f(0, (0, 0, 3, 4)), rtol=1e-14)
    assert np.isnan(f.formulas.numpy()(0, (0, 0, np.nan, 4))[0][2:]).all()


def test_optimal_control_from_rest() -> None:
    casadi = pytest.importorskip("casadi")
    f = of(DRAG, False)
    rates, steps, h = f.formulas.casadi(), 20, 0.1
    x, u = casadi.MX.sym("x", 4, steps + 1), casadi.MX.sym("u", 1, steps)
    gaps = [x[:, 0] - f.start, x[:2, steps] - [1, 0], x[2:, steps]]
    for k in range(steps):
        middle = (x[:, k] + x[:, k + 1]) / 2
        gaps.append(x[:, k + 1] - x[:, k] - h * rates(0, middle, u[:, k], [])[0])
    problem = {"x": casadi.veccat(x, u), "f": casadi.sumsqr(u), "g": casadi.vertcat(*gaps)}
    solver = casadi.nlpsol("s", "ipopt", problem, {"ipopt.print_level": 0, "print_time": False})
    solver(x0=0, lbg=0, ubg=0)
    assert solver.stats()["success"], solver.stats()["return_status"]
