"""Numbers with many digits, as other programs print them."""

from __future__ import annotations

import anholon as an
import numpy as np
import pytest

MODEL = """
coordinates = ["p", "q"]
particle = [{name = "b", mass = 1, position = ["(1.03 + 1.7654321*p)^2*q", "p", "0"]}]
force = [{on = "b", vector = "-p*ex"}]
initial = {p = 0.3, q = 0.1, "q'" = 1}
"""


def test_products_of_sums_have_rates() -> None:
    model = an.loads(MODEL)
    f = model.dynamics(minimal=False)
    assert f(0, f.start)[2:] == pytest.approx(list(model.evaluate().accelerations.values()), rel=1e-13, abs=1e-15)
    x = np.array([-0.2, 0.7, 1.1, -0.4])
    # By hand: the mass matrix has a mass along the curve X = u^2 q, u = c + k p, and the mass of p.
    c, k = 1.03, 1.7654321
    u = c + k * x[0]
    jacobian = np.array([2 * u * k * x[1], u * u])
    drift = 2 * k * k * x[2] ** 2 * x[1] + 4 * u * k * x[2] * x[3]
    mass = np.outer(jacobian, jacobian) + np.diag([1, 0])
    assert f(0, x)[2:] == pytest.approx(np.linalg.solve(mass, jacobian * (-x[0] - drift)), rel=1e-12)
