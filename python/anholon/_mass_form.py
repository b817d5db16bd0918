"""The equations of motion as  M q'' = Phi^T lambda + right, without the rates of a model's states."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import Any

from ._errors import ModelError


def without_rates(
    unknowns: Sequence[str], matrix: Any, right: Any, coordinates: int, rates: Collection[str]
) -> tuple[Any, Any, Any]:
    """Returns M, Phi and the right side of  M q'' = Phi^T lambda + right, for each of some states.

    unknowns: accelerations, multipliers, and the rates of states that the equations hold. matrix and right: the equations of the
    unknowns, shapes (equations, unknowns, states) and (equations, states); the first ones are those of the coordinates. rates: the
    names of rates of states. Their own equations eliminate them, so that a force with such a rate is part of the right side.
    """
    import numpy as np

    n = coordinates
    end = len(unknowns) - sum(unknown in rates for unknown in unknowns)  # a rate that no other equation holds is no unknown
    forces, acting = matrix[:n, :n], right[:n]
    if matrix[:n, end:].any():
        rows = np.moveaxis(matrix[end:], 2, 0)
        by_rates = np.moveaxis(matrix[:n, end:], 2, 0) @ np.linalg.inv(rows[:, :, end:])
        if (by_rates @ rows[:, :, n:end]).any():
            raise ModelError("a force holds a multiplier by the rate of a state, so no M q'' + bias = Phi^T lambda is in the equations")
        forces = forces - np.moveaxis(by_rates @ rows[:, :, :n], 0, 2)
        acting = acting - np.einsum("kij,jk->ik", by_rates, right[end:])
    return forces, matrix[n:end, :n], acting
