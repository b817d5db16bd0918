"""Functions of a model that has no parameters: their values are those of the same model with a parameter that nothing holds."""

from __future__ import annotations

import anholon
import numpy as np

MODEL = """
coordinates = ["x", "y"]
{parameters}
particle = [{{name = "p", mass = 2, position = "x*ex + y*ey"}}]
force = [{{name = "f", on = "p", vector = "x^2*ex - 3*x*y*ey"}}]
constraint = [{{name = "c", equation = "y' = x*x'"}}]
monitor = {{s = "sin(x) + y'"}}
"""


def functions(parameters: str) -> list[np.ndarray]:
    f = anholon.loads(MODEL.format(parameters=parameters)).dynamics(minimal=False, outputs=["s"])
    x = np.linspace(0.3, 0.9, len(f.states))
    many = x[:, None] + 0.01 * np.arange(11)
    v = np.ones(len(x))
    values = [g(0.5, at) for g in (f, f.output, f.mass_matrix, f.bias, f.constraint_jacobian) for at in (x, many)]
    return [*values, f.jac(0.5, x), f.jac(0.5, many), f.jvp(0.5, x, v), f.vjp(0.5, x, v)]


def test_no_parameters() -> None:
    for ours, twin in zip(functions(""), functions("parameters = {k = 1}"), strict=True):
        np.testing.assert_array_equal(ours, twin)


def test_closed_form() -> None:
    model = anholon.loads('coordinates = ["x"]\nparticle = [{name = "p", mass = 2, position = "x*ex"}]\nforce = [{name = "f", on = "p", vector = "x^2*ex"}]\n')
    np.testing.assert_allclose(model.dynamics().jac(0.0, [0.5, 0.1]), np.array([[0.0, 1.0], [0.5, 0.0]]), rtol=1e-15)
