"""Rates put into an array of the caller, derivatives at kinks, and outputs beyond velocities."""

import anholon as an
import numpy as np
import pytest


def test_rates_are_put_into_an_array_of_any_layout() -> None:
    f = an.load("disc").dynamics()
    n = len(f.start)
    x = f.start[:, None] + np.linspace(0, 0.1, 4)
    expected = f(0, x)
    for out in (np.zeros((2 * n, 8))[::2, ::2], np.zeros((n, 4), order="F"), np.zeros((n, 4))):
        assert f(0, x, out=out) is out
        np.testing.assert_array_equal(out, expected)
    column = np.zeros((n, 2))
    f(0, f.start, out=column[:, 0])
    np.testing.assert_array_equal(column[:, 0], f(0, f.start))
    same = x.copy()
    np.testing.assert_array_equal(f(0, same, out=same), expected)
    for wrong in (np.zeros((n, 4), "f4"), np.zeros((n, 4), int), [0.0] * n):
        with pytest.raises(TypeError, match="it has to be an array of float64"):
            f(0, x, out=wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="out has the shape"):
        f(0, x, out=np.zeros(n))
    locked = np.zeros((n, 4))
    locked.flags.writeable = False
    with pytest.raises(ValueError, match="cannot be written to"):
        f(0, x, out=locked)
