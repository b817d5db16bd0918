"""The rates in independent velocities of `derive --format python`: those of dynamics(), at one state and at many."""

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
    """Compares the rates, if there are any."""
    f = an.load(name).dynamics()
    made = run(text)
    if "rates" not in made:
        return False
    assert list(made["X"]) == [state.name for state in f.states]
    np.testing.assert_allclose(made["X_START"], f.start, rtol=1e-15)
    draw = np.random.default_rng(1)
    x = f.start[:, None] + 0.1 * draw.standard_normal((len(f.start), 10000))
    rates, many = f(f.t0, x), made["rates"](f.t0, x)
    # Relative to the largest number of a state, since terms cancel.
    size = 1 + np.abs(rates).max(axis=0)
    np.testing.assert_allclose(many / size, rates / size, rtol=0, atol=1e-12)
    for k in (0, 1, 8191, 8192, 9999):
        np.testing.assert_allclose(made["rates"](f.t0, x[:, k].copy()) / size[k], many[:, k] / size[k], rtol=0, atol=1e-14)
        by_list = made["rates"](f.t0, x[:, k].tolist())
        assert type(by_list) is list
        np.testing.assert_array_equal(by_list, made["rates"](f.t0, x[:, k].copy()))
    out = np.empty_like(x)
    assert made["rates"](np.full(10000, f.t0), x, out=out) is out
    np.testing.assert_array_equal(out, many)
    each = np.repeat(made["DEFAULTS"][:, None], 10000, axis=1)
    np.testing.assert_allclose(made["rates"](f.t0, x, each) / size, many / size, rtol=0, atol=1e-14)
    return True


def test_rates_are_those_of_dynamics(program: Callable[..., str]) -> None:
    # The program of the last one has no rates.
    compared = [name for name in MODELS if compare(name, program("derive", name, "--format", "python"))]
    assert compared == MODELS[:-1]


def test_a_wrong_sign_is_found(program: Callable[..., str]) -> None:
    text = program("derive", "disc", "--format", "python")
    wrong = re.sub(r"(out\[6\] = )", r"\1-", text.split("def _rates", 1)[1], count=1)
    with pytest.raises(AssertionError):
        compare("disc", text.split("def _rates", 1)[0] + "def _rates" + wrong)
