"""Columns for whoever reads Arrow: pyarrow, polars, DuckDB."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from . import _core

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


def stream(columns: Mapping[str, npt.NDArray[np.float64]], units: Mapping[str, str]) -> object:
    """A capsule of the Arrow C stream interface; the numbers are read where they are."""
    return _core.arrow_stream(list(columns), [units.get(name, "") for name in columns], list(columns.values()))
