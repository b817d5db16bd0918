"""Figures of sweeps by Matplotlib: curves over one name that varies, maps over two."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ._errors import ModelError

if TYPE_CHECKING:
    from .sweep_folder import SweepFolder

Columns = Mapping[str, npt.NDArray[Any]]

MOST_CURVES = 8


def not_drawn(table: Columns, varied: Sequence[str], shown: Sequence[str]) -> list[str]:
    """Returns the columns that may be axes. If there is a grid, columns with a different value in each case are left out, as the figure
    shows quantiles over the grid."""
    if any(table[name].dtype == object for name in shown):
        return list(varied)
    different = {name: np.unique(table[name]).size for name in varied if table[name].dtype != object}
    cases = np.unique(table["case"]).size if "case" in table else max((table[name].size for name in varied), default=0)
    grids = [name for name in varied if different.get(name, 0) != cases]
    return grids if any(different.get(name, 0) > 1 for name in grids) else list(varied)


def ending(outcome: str, event: str) -> str:
    """Returns the outcome of a case, or the event if an event ended a case that finished."""
    return f"event {event}" if event and outcome == "finished" else outcome


def axes_of(varied: Sequence[str], x: str | None, y: str | None) -> list[str]:
    """Returns the columns along the axes: those that are named, then those that vary, two at most."""
    given = [name for name in (x, y) if name is not None]
    axes = (given + [name for name in varied if name not in given])[: max(2, len(given))]
    if not axes:
        raise ModelError('no number varies in this sweep\nhint: x="t"')
    if len(axes) > 1 and axes[0] == axes[1]:
        raise ModelError(f"x and y are both {axes[0]!r}\nhint: y names another column")
    return axes


def curves(ax: Any, table: Columns, x: str, names: Sequence[str], units: Mapping[str, str]) -> None:
    """Draws columns over x. If several cases have the same x, it draws their median in a band from the 10 % to the 90 % quantile."""
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
    """Draws one column as the colours of points over two other columns."""
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


def plot_folder(folder: SweepFolder, names: list[str], x: str | None, y: str | None, ax: Any) -> Any:
    """Draws the complete parts of a folder: curves over t if cases have several rows, else curves or a map over the names that vary."""
    shown = names or ["outcome"]
    for name in [*shown, *(axis for axis in (x, y) if axis is not None)]:
        if name not in folder:
            raise KeyError(f"there is no column {name!r}; there are {', '.join(folder)}")
    missing = len(folder.missing)
    if missing == folder.parts:
        raise ModelError(f"no part is in {folder.path}\nhint: folder.fill() computes them")
    if ax is None:
        import matplotlib.pyplot as plt

        _, ax = plt.subplots()
    if missing:
        ax.set_title(f"{folder.parts - missing} of {folder.parts} parts")
    varied = [name for name in folder.varied if name not in shown]
    wanted = [*shown, *varied, "case", *(name for name in ("case_name", "t", x, y) if name is not None and name in folder)]
    ends = "outcome" in shown and "event" in folder
    table = folder.to_dict(list(dict.fromkeys(wanted + ["event"] * ends)))
    if ends:
        table["outcome"] = np.array([ending(*pair) for pair in zip(table["outcome"], table["event"], strict=True)], dtype=object)
    at_times = "t" in table and bool((np.diff(table["case"]) == 0).any())
    if at_times and y is None and x not in varied and all(table[name].dtype != object for name in shown):
        over = x or "t"
        units = folder.units
        if np.unique(table["case"]).size <= MOST_CURVES:
            cases_over(ax, table, over, shown, varied, units)
        elif over == "t":
            curves(ax, table, over, shown, units)
        else:
            raise ModelError(f"{np.unique(table['case']).size} cases are too many curves for one figure\nhint: without x their quantiles over t, or x and y for a map")
        return ax
    axes = axes_of(not_drawn(table, varied, shown) if y is None else varied, x, y)
    for axis in axes:
        if table[axis].dtype == object:
            raise ModelError(f"an axis shows numbers, and {axis!r} holds words\nhint: x names a column of numbers")
    if len(axes) == 1:
        curves(ax, table, axes[0], shown, folder.units)
        return ax
    if len(shown) > 1:
        raise ModelError(f"a map over two variations shows one column, and there are {len(shown)}\nhint: one name, or none for the outcomes")
    map_over(ax, table, axes, shown[0], folder.units)
    if missing:
        points = folder._core.points()
        for axis, limits in zip(axes, (ax.set_xlim, ax.set_ylim), strict=True):
            if len(points.get(axis, ())) > 1:
                low, high = min(points[axis]), max(points[axis])
                limits(low - (high - low) / 20, high + (high - low) / 20)
    return ax


def cases_over(ax: Any, table: Columns, x: str, names: Sequence[str], varied: Sequence[str], units: Mapping[str, str]) -> None:
    """Draws a curve of each case and column over x."""
    numbers = table["case"]
    for case in np.unique(numbers):
        rows = numbers == case
        first = int(np.flatnonzero(rows)[0])
        parts = [str(table["case_name"][first])] if "case_name" in table else []
        parts += [f"{name} = {table[name][first]:.6g}" for name in varied]
        for name in names:
            ax.plot(table[x][rows], table[name][rows], label=", ".join(([name] if len(names) > 1 else []) + (parts or [f"case {case}"])).replace("$", r"\$"))
    ax.set_xlabel(label(x, units))
    if len(names) == 1:
        ax.set_ylabel(label(names[0], units))
    ax.legend()


def label(name: str, units: Mapping[str, str]) -> str:
    """Returns the name of a column with its unit. The unit of an initial value x(0) is that of x."""
    unit = units.get(name.removesuffix("(0)"), "")
    return name.replace("$", r"\$") + (f" [{unit}]" if unit else "")
