"""Sweeps of many motions: arrays over the cases."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from . import _arrow, _core, _display
from ._errors import ModelError
from ._kept_sweep import KeptSweep, SweepAgain
from ._names import ByName, known, spelled
from ._numbers import Number, text_of, whole
from .run import Figure

if TYPE_CHECKING:
    import os

    import numpy as np
    import numpy.typing as npt
    import pandas
    import polars

    from .model import Model

    Array = npt.NDArray[np.float64]


class Law(str):
    """A law that gives a value to each case; see :func:`normal`, :func:`uniform` and :func:`grid`."""


def is_law(of: object) -> bool:
    """True if the values of a sweep are a law or the text of a law."""
    return isinstance(of, Law) or (isinstance(of, str) and (":" in of or re.match(r"\s*(normal|uniform)\s*\(", of) is not None))


def normal(mean: Number, deviation: Number) -> Law:
    """Returns the law of normally distributed values with a mean and a standard deviation. Those of a parameter
    are in the unit that the file declares for it, else in SI units.

    Example:
        >>> import anholon as an
        >>> sweep = an.load("disc").sweep({"theta": an.normal(1.3, "0.01")}, cases=4, to="0.1")
        >>> sweep.varied["theta"].shape
        (4,)
    """
    return Law(f"normal({text_of(mean)},{text_of(deviation)})")


def uniform(low: Number, high: Number) -> Law:
    """Returns the law of evenly distributed values between two numbers. Those of a parameter are in the unit that the file
    declares for it, else in SI units.

    Example:
        >>> import anholon as an
        >>> sweep = an.load("disc").sweep({"theta": an.uniform(1.2, 1.4)}, cases=4, to="0.1")
        >>> bool((sweep.varied["theta"] > 1.2).all())
        True
    """
    return Law(f"uniform({text_of(low)},{text_of(high)})")


def grid(low: Number, high: Number, count: int) -> Law:
    """Returns the law of evenly spaced values, both ends included. Those of a parameter are in the unit that the file declares for it,
    else in SI units. A value is computed with its case, so that 10^9 values take no memory.

    Example:
        >>> import anholon as an
        >>> sweep = an.load("disc").sweep({"phi'": an.grid(5, 7, 5)}, to="0.1")
        >>> sweep.varied["phi'"].tolist()
        [5.0, 5.5, 6.0, 6.5, 7.0]
    """
    return Law(f"{text_of(low)}:{text_of(high)}:{whole('count', count, 0)}")


def scenarios_of(core: _core.Sweep | KeptSweep) -> dict[str, npt.NDArray[Any]]:
    """Returns the scenario of each case by the name "case"; an empty dictionary if no scenarios vary."""
    import numpy as np

    names = np.array(core.scenarios, dtype=object)
    return {"case": np.repeat(names, core.cases // names.size)} if names.size else {}


class Sweep(Mapping[str, "Array"]):
    """Final states of many motions. ``sweep["x"]`` has one number for each case, NaN for a case without a final state.

    Example:
        >>> import anholon as an
        >>> sweep = an.load("disc").sweep({"phi'": [5, 6, 7]}, to=1)
        >>> sweep.varied["phi'"].tolist(), sweep.finished
        ([5.0, 6.0, 7.0], 3)

        The extremes of the motions, and rows at given times:

        >>> sweep = an.load("disc").sweep({"phi'": [5, 6, 7]}, at=[0.5, 1], reduce=["min(theta)"])
        >>> bool((sweep["min(theta)"] <= sweep["theta"]).all()), sweep.rows("theta").shape
        (True, (3, 2))

        Scenarios [case.NAME] of the file vary, too:

        >>> text = an.load("disc").text + "[case.heavy]\\nparameters.m = 9\\n[case.light]\\nparameters.m = 1\\n"
        >>> sweep = an.loads(text).sweep({"case": ["heavy", "light"], "phi'": [5, 6]}, to=1)
        >>> sweep.varied["case"].tolist(), list(sweep.to_dict())[:3]
        (['heavy', 'heavy', 'light', 'light'], ['case_name', "phi'(0)", 't'])
    """

    def __init__(self, core: _core.Sweep, names: list[str], reduced: list[str], again: SweepAgain) -> None:
        self.model: Model = again.model
        self._again = again
        self._core: _core.Sweep | KeptSweep = core
        self._reduced = [name for name in core.columns if name in reduced]
        #: The values that vary, one array for each name, shape (cases,). Scenarios come first, as ``case``, an array of texts.
        self.varied: dict[str, npt.NDArray[Any]] = ByName(scenarios_of(core))
        self.varied.update((name, core.varied(name)) for name in names if name not in self.varied)

    def __getstate__(self) -> dict[str, Any]:
        """Pickles all numbers and outcomes. For files and figures of the program the other process computes the sweep again."""
        numbers = [name for name in self.varied if name != "case" or not self._core.scenarios]
        return {**self.__dict__, "_core": KeptSweep(self._core, numbers, self._again)}

    def __getitem__(self, name: str) -> Array:
        """Returns a column at the end of each motion, shape (cases,), in SI units.

        Raises:
            KeyError: there is no such column.
        """
        return self._core.column(self._own(name))

    def _own(self, name: str) -> str:
        """Returns the name that a column has in the sweep. Raises KeyError if there is no such column."""
        columns = self._core.columns
        if not isinstance(name, str) or known(name, columns) not in columns:
            raise KeyError(f"there is no column {name!r}; there are {', '.join(columns)}")
        return known(name, columns)

    @property
    def units(self) -> dict[str, str]:
        """The units of the columns and of the names that vary, if the model has units for them."""
        return dict(self._core.units)

    @property
    def notes(self) -> list[str]:
        """Notes on reductions that have no value in some cases, and on cases that stopped: for each outcome the number of cases, the first
        case, its message and a hint."""
        return list(self._core.notes)

    @property
    def times(self) -> Array:
        """The times of ``rows``, s, shape (times,)."""
        return self._core.times

    def rows(self, name: str) -> Array:
        """Returns a column at the times of ``at``, shape (cases, times); NaN at times after the end of a motion.

        Raises:
            KeyError: there is no such column, or it is a reduction, which is one number for each motion.

        Example:
            >>> import anholon as an
            >>> sweep = an.load("disc").sweep({"phi'": [5, 6]}, at=[0, 1, 2])
            >>> sweep.rows("theta").shape, sweep.times.tolist(), bool((sweep.steps > 5).all())
            ((2, 3), [0.0, 1.0, 2.0], True)
        """
        name = self._own(name)
        if name in self._reduced:
            raise KeyError(f"{name!r} is one number for each motion: sweep[{name!r}]")
        column = self[name]
        return self._core.rows(name).reshape(column.size, self.times.size)

    def __iter__(self) -> Iterator[str]:
        return iter(self._core.columns)

    def __len__(self) -> int:
        """The number of columns; ``cases`` is the number of motions."""
        return len(self._core.columns)

    @property
    def cases(self) -> int:
        """The number of motions."""
        return self._core.cases

    @property
    def finished(self) -> int:
        """The number of motions that reached their end."""
        return self._core.finished

    @property
    def t(self) -> Array:
        """The times that the motions reached, s, shape (cases,)."""
        return self._core.t

    @property
    def outcome(self) -> _core.Outcome:
        """The outcome of the whole sweep: finished or interrupted."""
        return self._core.outcome

    def outcome_of(self, case: int) -> _core.Outcome:
        """Returns the outcome of one motion.

        Raises:
            IndexError: there is no such case.
        """
        if not 0 <= case < self.cases:
            raise IndexError(f"there are {self.cases} cases")
        return self._core.outcome_of(case)

    @property
    def outcomes(self) -> list[str]:
        """The kind of the outcome of each motion."""
        return [self._core.outcome_of(case).kind for case in range(self.cases)]

    @property
    def events(self) -> list[str]:
        """The name of the event that ended each motion; an empty text if no event did."""
        return [self._core.event(case) for case in range(self.cases)]

    @property
    def steps(self) -> Array:
        """The number of steps of each motion, shape (cases,)."""
        import numpy as np

        return np.array([self._core.steps(case) for case in range(self.cases)], dtype=float)

    def to_dict(self) -> dict[str, npt.NDArray[Any]]:
        """Returns the values that vary, named as in ``anholon sweep`` (an initial value is ``x(0)``), the times reached and all columns.

        Scenarios are in ``case_name``, an array of texts. With times (``at``) the table is long: it has a row for each case and
        time, which the columns ``case`` and ``t`` tell.
        """
        table = self._varied_columns()
        times = self.times.size
        if times == 0:
            table["t"] = self.t
            table.update({name: self[name] for name in self})
            return table
        import numpy as np

        long: dict[str, npt.NDArray[Any]] = {"case": np.repeat(np.arange(self.cases, dtype=float), times)}
        long.update({name: np.repeat(values, times) for name, values in table.items()})
        long["t"] = np.tile(self.times, self.cases)
        for name in self:
            long[name] = np.repeat(self[name], times) if name in self._reduced else self._core.rows(name)
        return long

    def _varied_columns(self) -> dict[str, npt.NDArray[Any]]:
        coordinates = {coordinate.name for coordinate in self.model.coordinates}
        table = {f"{name}(0)" if name.rstrip("'") in coordinates else name: values for name, values in self.varied.items()}
        return {"case_name": table.pop("case"), **table} if self._core.scenarios else table

    def _endings(self) -> list[str]:
        """Returns how the motions ended, for figures: the outcomes, and instead of ``finished`` the events that ended motions."""
        from ._sweep_plot import ending

        return [ending(outcome, event) for outcome, event in zip(self.outcomes, self.events, strict=True)]

    def _outcomes(self) -> tuple[int, list[str]]:
        """Returns the place of the column of outcomes in a table, and its words."""
        times = self.times.size
        if times == 0:
            return len(self.varied), self.outcomes
        return 1 + len(self.varied), [outcome for outcome in self.outcomes for _ in range(times)]

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a DataFrame with a row for each case, or for each case and time, with its outcome. Needs pandas."""
        import pandas

        frame = pandas.DataFrame(self.to_dict())
        if self.times.size > 0:
            frame["case"] = frame["case"].astype(int)
        place, outcomes = self._outcomes()
        frame.insert(place, "outcome", outcomes)
        return frame

    def to_polars(self) -> polars.DataFrame:
        """Returns the table of :meth:`to_pandas` as a DataFrame of polars. Needs polars."""
        import polars

        place, outcomes = self._outcomes()
        return polars.DataFrame(self.to_dict()).insert_column(place, polars.Series("outcome", outcomes))

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Returns the columns of :meth:`to_pandas` as an Arrow stream of one batch. Numbers are not copied; outcomes are texts."""
        import numpy as np

        place, outcomes = self._outcomes()
        columns = list(self.to_dict().items())
        columns.insert(place, ("outcome", np.array(outcomes, dtype=object)))
        units = self.units
        return _arrow.stream(dict(columns), {name: units.get(name.removesuffix("(0)"), "") for name, _ in columns})

    # ---- files, pictures ----

    def save(self, path: str | os.PathLike[str]) -> str:
        """Writes the sweep as .h5, .csv, .json or .parquet, by the end of the name, with the columns and numbers of ``anholon sweep -o``.

        Cases that were not computed because of Ctrl-C are not written. ``model.sweep(..., out="falls/")`` writes a folder while the
        sweep is computed.

        Returns:
            The name of the file.

        Raises:
            ModelError: the name has another ending, or the file cannot be written.

        Example:
            >>> import anholon as an, pandas, tempfile
            >>> sweep = an.load("disc").sweep({"phi'": [5, 6, 7]}, to=1)
            >>> file = sweep.save(tempfile.mkdtemp() + "/cases.csv")
            >>> list(pandas.read_csv(file))[:5]
            ['case', "phi'(0)", 'outcome', 't', 'x']
        """
        import os

        name = os.fspath(path)
        if name.endswith("/") or os.path.isdir(name):
            raise ModelError(f'{name} is a folder, which takes the cases while they are computed\nhint: model.sweep(..., out="{name}")')
        return self._core.write(name)

    def figure(self, *names: str, x: str | None = None, y: str | None = None) -> Figure:
        """Returns a figure of the cases as SVG, which ``anholon plot`` shows of a sweep. No other package is needed.

        If one name varies, columns at the end of the motions are curves over its values; if several cases have the same value,
        the curves are the quantiles of 10, 50 and 90 %. If two names vary, one column is a map over their values.

        Args:
            names: columns to draw, or patterns with * and ?; if there are none, the coordinates, in a map the outcomes.
            x: the column along the horizontal axis; the first that varies if it is None. An initial value is ``"phi'(0)"``.
            y: the column along the vertical axis of a map; the second that varies if it is None.

        Raises:
            ModelError: there is no such column, a map has several columns, or no number varies.

        Example:
            >>> import anholon as an
            >>> an.load("disc").sweep({"phi'": [5, 6, 7]}, to=1).figure("theta").svg[:4]
            '<svg'
        """
        return Figure(self._core.figure([spelled(name) for name in names], spelled(x or ""), spelled(y or "")))

    def plot(self, *names: str, x: str | None = None, y: str | None = None, ax: Any = None) -> Any:
        """Draws the figure of :meth:`figure` with Matplotlib and returns the axes; returns a :class:`Figure` without Matplotlib.

        If several cases have the same x, a curve is their median, in a band from the 10 % to the 90 % quantile.

        Args:
            names: columns to draw; if there are none, the coordinates, in a map the outcomes.
            x: the column along the horizontal axis; the first that varies if it is None.
            y: the column along the vertical axis of a map; the second that varies if it is None.
            ax: axes of Matplotlib; new ones if it is None.

        Raises:
            KeyError: there is no such column.
            ModelError: a map has several columns, or no number varies.

        Example:
            >>> import anholon as an
            >>> sweep = an.load("disc").sweep({"phi'": an.grid(5, 7, 5), "m": [1, 2]}, to=1)
            >>> axes = sweep.plot("theta")
        """
        if ax is None and find_spec("matplotlib") is None:
            return self.figure(*names, x=x, y=y)
        import numpy as np

        from . import _sweep_plot

        varied = self._varied_columns()
        varied.pop("case_name", None)
        table = {**varied, "outcome": np.array(self._endings(), dtype=object), "t": self.t, "steps": self.steps, **{name: self[name] for name in self}}
        usual = [c.name for c in self.model.coordinates if c.name in self] or list(self)
        over = list(varied)
        if y is None and all(name in table for name in names):
            over = _sweep_plot.not_drawn(table, over, names or ["outcome"])
        axes = _sweep_plot.axes_of(over, x, y)
        shown = list(names) or (usual if len(axes) == 1 else ["outcome"])
        for name in (*axes, *shown):
            if name not in table:
                raise KeyError(f"there is no column {name!r}; there are {', '.join(table)}")
        if "outcome" in axes:
            raise ModelError("an axis shows numbers, and 'outcome' holds words\nhint: x=\"t\"")
        if len(axes) > 1 and len(shown) > 1:
            raise ModelError(f"a map over two variations shows one column, and there are {len(shown)}\nhint: one name, or none for the outcomes")
        if ax is None:
            import matplotlib.pyplot as plt

            _, ax = plt.subplots()
        if len(axes) == 1:
            _sweep_plot.curves(ax, table, axes[0], shown, self.units)
        else:
            _sweep_plot.map_over(ax, table, axes, shown[0], self.units)
        return ax

    def _repr_html_(self) -> str:
        return _display.sweep(self, f"sweep of {self.model.title}", self._endings())

    def __repr__(self) -> str:
        return f"<sweep of {self.model.title!r}: {self.finished} of {self.cases} cases finished; varied: {', '.join(self.varied)}>"
