"""Sweeps drawn by Matplotlib: curves over the number that varies, maps over two."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ._errors import ModelError

Columns = Mapping[str, npt.NDArray[Any]]


def axes_of(varied: Sequence[str], x: str | None, y: str | None) -> list[str]:
    """The columns along the axes: those that are named, then those that vary, two at most."""
    given = [name for name in (x, y) if name is not None]
    axes = (given + [name for name in varied if name not in given])[: max(2, len(given))]
    if not axes:
        raise ModelError('no number varies in this sweep\nhint: x="t"')
    if len(axes) > 1 and axes[0] == axes[1]:
        raise ModelError(f"x and y are both {axes[0]!r}\nhint: y names another column")
    return axes


def curves(ax: Any, table: Columns, x: str, names: Sequence[str], units: Mapping[str, str]) -> None:
    """Columns over x; where several cases have the same x, their median, in a band from 10 to 90 %."""
    for name in names:
        if table[name].dtype == object:
            raise ModelError(f"one variation shows numbers, and {name!r} holds words\nhint: name columns of numbers")
    for name in names:
        finite = np.isfinite(table[x]) & np.isfinite(table[name])
        places, group = np.unique(table[x][finite], return_inverse=True)
        values = table[name][finite]
        low, middle, high = np.array([np.quantile(values[group == k], (0.1, 0.5, 0.9)) for k in range(places.size)]).reshape(-1, 3).T
        (line,) = ax.plot(places, middle, label=label(name, units))
        if places.size < values.size:
            ax.fill_between(places, low, high, color=line.get_color(), alpha=0.2, linewidth=0)
    ax.set_xlabel(label(x, units))
    if len(names) == 1:
        ax.set_ylabel(label(names[0], units))
    else:
        ax.legend()


def map_over(ax: Any, table: Columns, axes: Sequence[str], name: str, units: Mapping[str, str]) -> None:
    """One column by the colours of points over two others."""
    x, y = (table[axis] for axis in axes)
    values = table[name]
    if values.dtype == object:
        for word in dict.fromkeys(values.tolist()):
            ax.scatter(x[values == word], y[values == word], label=word)
        ax.legend(title=name)
    else:
        ax.figure.colorbar(ax.scatter(x, y, c=values), ax=ax, label=label(name, units))
    ax.set_xlabel(label(axes[0], units))
    ax.set_ylabel(label(axes[1], units))


def label(name: str, units: Mapping[str, str]) -> str:
    """The name of a column with its unit; an initial value x(0) has that of x."""
    unit = units.get(name.removesuffix("(0)"), "")
    return name.replace("$", r"\$") + (f" [{unit}]" if unit else "")
