"""Columns for the libraries that read Arrow: pyarrow, polars, DuckDB."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from . import _core

if TYPE_CHECKING:
    import numpy.typing as npt


def stream(columns: Mapping[str, npt.NDArray[Any]], units: Mapping[str, str]) -> object:
    """Returns a capsule of the Arrow C stream interface. Arrays of numbers are not copied; arrays of objects become texts."""
    arrays = [column.tolist() if column.dtype == object else column for column in columns.values()]
    return _core.arrow_stream(list(columns), [units.get(name, "") for name in columns], arrays)
