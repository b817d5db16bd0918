"""Inputs that are given act wherever the model holds them: in rates of states, outputs, reactions, events, other inputs."""

from typing import Any

import anholon as an
import numpy as np
import pytest

DRIVEN = """coordinates = ["x", "y"]
parameters = {m = 2}
input.u = "-3*x"
input.v = "u/2"
state.w = {rate = "u - x + v", initial = 0.1}
particle = [{name = "p", mass = "m", position = "x*ex + y*ey"}]
force = [{on = "p", vector = "u*ex + v*ey"}]
constraint = [{name = "c", equation = "y' = 2*x'"}]
event = [{name = "limit", when = "u - 5", set = {"x'" = "u", w = "v"}}]
[output]
thrust = "u"
power = "u*x'"
push = "reaction(p).x"
rate = "w'"
[initial]
x = 1
"x'" = 0.5
"""

GIVEN = {"u": 10.0, "v": 7.0}


def by_hand(u: float, v: float) -> tuple[float, dict[str, float]]:
    """x'', and the outputs: m (x'' + 2 y'') = u + 2 v with y'' = 2 x''."""
    a = (u + 2 * v) / 10
    return a, {"thrust": u, "power": 0.5 * u, "push": 2 * a - u, "rate": u - 1 + v}


def test_inputs_left_out_have_the_values_of_their_formulas() -> None:
    f = an.loads(DRIVEN).dynamics(inputs=True)
    x = f.start + 0.3
    formulas = f.input(0.4, x)
    np.testing.assert_array_equal(f(0.4, x, {"u": 1}), f(0.4, x, [1, formulas[1]]))
    many = np.stack([x, x + 0.2, f.start], axis=1)
    rates = f(0.4, many, {"u": 1})
    for k in range(3):
        np.testing.assert_array_equal(rates[:, k], f(0.4, many[:, k], {"u": 1}))
    np.testing.assert_array_equal(f.output(0.4, many, {"u": 1})[:, 1], f.output(0.4, many[:, 1], {"u": 1}))
