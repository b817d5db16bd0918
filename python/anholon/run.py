"""A run of a motion: arrays, events, and a report on their accuracy."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from . import _arrow, _core, _display, _widget
from ._errors import ColumnError, ModelError, MotionError
from ._names import ByName, known, spelled
from ._recipe import KeptRun, Recipe

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas
    import polars
    import xarray

    from .model import Model

    Array = npt.NDArray[np.float64]


class Page:
    """A page of HTML that needs no other file. A notebook shows it in a frame.

    Example:
        >>> import anholon as an
        >>> an.load("disc").simulate(to=1).page(proof=False)
        <page, ... kB; a notebook shows it, save(path) writes it>
    """

    def __init__(self, html: str) -> None:
        self.html: str = html

    def save(self, path: str) -> None:
        """Writes the page to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{html.escape(self.html)}" style="width:100%;height:44em;border:0" sandbox="allow-scripts allow-downloads"></iframe>'

    def __repr__(self) -> str:
        return f"<page, {len(self.html) / 1000:.0f} kB; a notebook shows it, save(path) writes it>"


class Figure:
    """A figure as SVG, which a notebook shows. :meth:`Run.plot` returns one if Matplotlib is not installed.

    Example:
        >>> import anholon as an
        >>> an.load("disc").simulate(to=1).figure("theta").svg[:4]
        '<svg'
    """

    def __init__(self, svg: str) -> None:
        self.svg: str = svg

    def save(self, path: str) -> None:
        """Writes the SVG to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.svg)

    def _repr_svg_(self) -> str:
        return self.svg

    def _repr_html_(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"<figure, {len(self.svg) / 1000:.0f} kB of SVG; a notebook shows it, save(path) writes it>"


class _AtTimes(ByName[Any]):
    """The derivatives of one order of a motion at given times, by the names of coordinates and states."""

    def __init__(self, values: dict[str, Any], order: int, columns: list[str]) -> None:
        super().__init__(values)
        self._order, self._columns = order, columns

    def _hint(self, name: object) -> str:
        if not isinstance(name, str):
            return ""
        plain = spelled(name)
        base = plain.rstrip("'")
        if base != plain and base in self:
            return f"\nhint: run(t, order={self._order + len(plain) - len(base)})[{base!r}]"
        column = known(name, self._columns)
        return f"\nhint: run[{column!r}] is a column over the rows; simulate(at=[…]) has rows at any times" if column in self._columns else ""


class Run:
    """The run of one motion. ``run["theta"]`` is a read-only array of the memory of the library, not a copy.

    A run can be pickled with its numbers, events and report, so that processes of a pool can return it. For pages, files and
    ``run(t)`` the other process computes the motion again.

    Example:
        >>> import anholon as an
        >>> run = an.load("disc").simulate(to=2, every="0.5")
        >>> run.outcome.ok, run.t.tolist()
        (True, [0.0, 0.5, 1.0, 1.5, 2.0])
        >>> run["theta"].shape
        (5,)
    """

    def __init__(self, model: Model, core: _core.Run | None, outcome: _core.Outcome, recipe: Recipe | None = None) -> None:
        self._core: _core.Run | KeptRun | None = core
        self._dense = core if core is not None and core.has_dense else None
        self._recipe = recipe
        self._columns = {} if core is None else {column.name: column for column in core.columns}
        self.model: Model = model
        #: How the motion ended, with a remedy if it stopped early. simulate() does not raise for an early stop; expect() does.
        self.outcome: _core.Outcome = outcome

    def __getstate__(self) -> dict[str, Any]:
        """Pickles the numbers, the events and the report. The other process computes the rest again when it is needed."""
        kept = None if self._core is None or self._recipe is None else KeptRun(self._core, self._recipe)
        return {**self.__dict__, "_core": kept, "_dense": None}

    # ---- arrays ----

    def __getitem__(self, name: str) -> Array:
        """Returns the numbers of a column, shape (rows,): "t", "x", "x'", "lambda.rod", "N.x", a state, a monitor.

        Numbers are in SI units; an output that has a unit in the file is in that unit.
        A Greek letter and its spelled name are the same name, as in all other functions: ``run["θ"]`` is ``run["theta"]``.

        Raises:
            ColumnError: there is no such column. It is a KeyError and names the columns of the run.
        """
        core, name = self._column(name)
        return core.column(name)

    def _column(self, name: str) -> tuple[_core.Run | KeptRun, str]:
        """Returns the core with a column, and the name of the column there. Raises ColumnError if there is no such column."""
        if self._core is None or not isinstance(name, str) or known(name, self._columns) not in self._columns:
            raise ColumnError(name, list(self._columns), self.outcome)
        return self._core, known(name, self._columns)

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and known(name, self._columns) in self._columns

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        """The number of rows."""
        return 0 if self._core is None else self._core.rows

    def keys(self) -> list[str]:
        """Returns the names of the columns; by them ``dict(run)`` has all arrays."""
        return list(self._columns)

    @property
    def columns(self) -> list[_core.Column]:
        """Name, kind, unit and order of each column."""
        return list(self._columns.values())

    @property
    def units(self) -> dict[str, str]:
        """The units of the columns that have one."""
        return {name: column.unit for name, column in self._columns.items() if column.unit}

    @property
    def long_names(self) -> dict[str, str]:
        """The meaning of each column in words: "rate of theta", "multiplier of rolling.x"."""
        return {name: _long_name(column) for name, column in self._columns.items()}

    @property
    def t(self) -> Array:
        """The times of the rows, s, shape (rows,)."""
        return self["t"]

    def _of_kind(self, kind: str) -> Array:
        import numpy as np

        places = [k for k, column in enumerate(self._columns.values()) if column.kind == kind]
        if not places or self._core is None or len(self) == 0:
            return np.empty((len(self), len(places)))
        if places == list(range(places[0], places[-1] + 1)):
            return self._core.block(places[0], len(places))
        # If servo constraints stand between ideal ones, the multipliers of the ideal ones are not neighbours.
        return np.column_stack([self[list(self._columns)[k]] for k in places])

    @property
    def values(self) -> Array:
        """All numbers, shape (rows, columns), a view: column k is ``run.keys()[k]``."""
        import numpy as np

        return np.empty((0, 0)) if self._core is None or len(self) == 0 else self._core.block(0, len(self._columns))

    @property
    def q(self) -> Array:
        """The coordinates, shape (rows, coordinates), in the order of ``model.coordinates``: a view."""
        return self._of_kind("coordinates")

    @property
    def qdot(self) -> Array:
        """The velocities, the rates of the coordinates, shape (rows, coordinates): a view."""
        return self._of_kind("velocities")

    @property
    def qddot(self) -> Array:
        """The accelerations of the coordinates, shape (rows, coordinates): a view."""
        return self._of_kind("accelerations")

    @property
    def lam(self) -> Array:
        """The multipliers of the ideal constraints, shape (rows, constraints): a view, unless servo constraints stand between them."""
        return self._of_kind("multipliers")

    def exact(self, name: str) -> list[Any]:
        """Returns the numbers of a column with all digits of the run: ``mpmath.mpf`` if mpmath is installed, else texts.

        Raises:
            ColumnError: there is no such column.
        """
        core, name = self._column(name)
        texts = [core.text(row, name) for row in range(len(self))]
        try:
            import mpmath
        except ImportError:
            return list(texts)
        with mpmath.workdps(max(len(text) for text in texts) if texts else 15):
            return [mpmath.mpf(text) for text in texts]

    def __call__(self, t: npt.ArrayLike, order: int = 0) -> dict[str, Array]:
        """Returns the motion at any times. The values are those of the polynomials of its steps, not interpolated between rows.

        Coordinates have the accuracy of the rows; each derivative loses about one digit.

        Args:
            t: times, s, any shape.
            order: the order of the derivative: 0 for the coordinates, 1 for their rates, 2, …

        Returns:
            An array of the shape of t for each coordinate and each state of the model, by their names also for ``order=1``; NaN
            outside of the motion. A motion that ``stop`` or Ctrl-C ended reaches to its last row. Another name is a KeyError, which
            lists these names.

        Raises:
            ModelError: `t` is no time or array of times (``run["x"]`` is the column of a name), or there is no such derivative.
            MotionError: the motion has not begun.

        Example:
            >>> import anholon as an
            >>> run = an.load("disc").simulate(to=2, every=1)
            >>> bool(abs(run(1.0)["theta"] - run["theta"][1]) < 1e-14)
            True
        """
        import numpy as np

        try:
            given = np.asarray(t)
            # Truth values, dates, durations and None would convert to numbers, but are no times in seconds.
            no_times = (bool, np.bool_, np.datetime64, np.timedelta64, bytes, type(None))
            if given.dtype.kind in "bmMcS" or (given.dtype.kind == "O" and any(isinstance(x, no_times) for x in given.flat)):
                raise TypeError
            times = np.asarray(given, dtype=np.float64)
        except (TypeError, ValueError):
            hint = f"run[{t!r}] is the column of that name" if isinstance(t, str) and t in self else "run(1.5), run([1, 2.5])"
            raise ModelError(f"run(t) takes times in seconds, one number or an array, not {t!r:.60}\nhint: {hint}") from None
        if self._dense is None:
            if self._recipe is None:
                raise MotionError(repr(self.outcome), self.outcome)
            if self._recipe.cut and (len(self) == 0 or self.t[-1] == self._recipe.start):
                return self._at_start(times, order)
            self._dense = self._recipe.polynomials(self.t[-1] if self._recipe.cut else None)
        most = self._dense.report.order
        if isinstance(order, bool) or not isinstance(order, (int, np.integer)) or not 0 <= order <= most:
            raise ModelError(f"order is a whole number from 0 to {most}, the order of the polynomials of this run, not {order!r:.60}\nhint: run(t, order=1) has the rates")
        names = self._moving()
        flat = np.ascontiguousarray(times.ravel())
        return _AtTimes({name: self._dense.at(name, flat, order).reshape(times.shape) for name in names}, order, self.keys())

    def _moving(self) -> list[str]:
        return [c.name for c in self.model.coordinates] + self.model.states

    def _at_start(self, times: Array, order: int) -> dict[str, Array]:
        """Returns run(t) of a motion that was ended before its first step, which has one row or none."""
        import numpy as np

        found: dict[str, Array] = _AtTimes({}, order, self.keys())
        for name in self._moving():
            column = name + "'" * order
            value = self[column][0] if len(self) and column in self else np.nan
            found[name] = np.where(times == self._recipe.start, value, np.nan) if self._recipe else np.full(times.shape, np.nan)
        return found

    # ---- outcome, events, report ----

    @property
    def ok(self) -> bool:
        """True if the motion reached the end that was asked for."""
        return self.outcome.ok

    def expect(self) -> Run:
        """Returns the run itself. Raises MotionError if the motion stopped before its end."""
        if not self.ok:
            raise MotionError(repr(self.outcome), self.outcome)
        return self

    @property
    def events(self) -> list[_core.Event]:
        """The events that happened, in order."""
        return [] if self._core is None else self._core.events

    @property
    def report(self) -> _core.Report:
        """Residuals, digits to trust, conserved quantities, warnings. Raises MotionError if the motion has not begun."""
        if self._core is None:
            raise MotionError(repr(self.outcome), self.outcome)
        return self._core.report

    # ---- other libraries, files ----

    def to_dict(self) -> dict[str, Array]:
        """Returns all columns by name, without copies."""
        return {name: self[name] for name in self}

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a DataFrame with the columns of the run. Needs pandas.

        ``.attrs`` has "units" and "long_names" by column, and the "title".
        """
        import pandas

        frame = pandas.DataFrame(self.to_dict())
        frame.attrs["units"] = self.units
        frame.attrs["long_names"] = self.long_names
        frame.attrs["title"] = self.model.title
        return frame

    def to_polars(self) -> polars.DataFrame:
        """Returns a DataFrame of polars, which reads the run as an Arrow stream. Needs polars."""
        import polars

        return polars.DataFrame(self)

    def to_xarray(self) -> xarray.Dataset:
        """Returns a Dataset over the dimension t. Its variables have the attributes "units" and "long_name". Needs xarray."""
        import xarray

        def attributes(column: _core.Column) -> dict[str, str]:
            return {"long_name": _long_name(column), **({"units": column.unit} if column.unit else {})}

        return xarray.Dataset(
            {name: ("t", self[name], attributes(column)) for name, column in self._columns.items() if name != "t"},
            coords={"t": ("t", self.t, {"units": "s", **attributes(self._columns["t"])})},
            attrs={"title": self.model.title},
        )

    def __arrow_c_stream__(self, requested_schema: object = None) -> object:
        """Returns the columns as an Arrow stream of one batch, without copying the numbers."""
        return _arrow.stream(self.to_dict(), self.units)

    def save(self, path: str | os.PathLike[str]) -> str:
        """Writes the run as .csv, .json, .h5 or .parquet, by the end of the name. A write that fails leaves the file as it was.

        Raises:
            ModelError: the name has another ending, or the file cannot be written.
        """
        return self._required().write(os.fspath(path))

    def json(self) -> Any:
        """Returns columns, rows and the report, which ``anholon simulate --json`` prints."""
        return json.loads(self._required().json())

    def _required(self) -> _core.Run | KeptRun:
        if self._core is None:
            raise MotionError(repr(self.outcome), self.outcome)
        return self._core

    # ---- pictures ----

    def page(self, path: str | None = None, *, forms: Sequence[str] = (), proof: bool = True) -> Page:
        """Returns a page of HTML on the motion that needs no other file: equations, proof, plots, animation, trust.

        Args:
            path: a file to which the page is written, too; a notebook shows the page in its output.
            forms: the forms whose equations are shown; the program chooses them if there are none.
            proof: True proves that the forms agree, if the equations are not too long.

        Raises:
            ModelError: a form is not known, or there are no rows.
        """
        page = Page(self._required().page(list(forms), proof))
        if path is not None:
            page.save(path)
        return page

    def animate(self, *, plots: bool = False) -> Any:
        """Returns an animation of the motion for a notebook.

        If anywidget is installed, the animation is a widget for Jupyter, VS Code, Colab and marimo, whose ``time`` and
        ``playing`` can be set. Without anywidget it is the page of the motion in a frame.

        Args:
            plots: True shows plots of all columns below the animation, with the same time.

        Raises:
            ModelError: there are no rows.
        """
        if not _widget.available():
            return self.page(proof=False)
        return _widget.widget(self._required().picture_data(), plots=plots)

    def figure(self, *names: str, x: str = "t") -> Figure:
        """Returns a figure of columns over another one as SVG. The program draws it; no other package is needed.

        Args:
            names: columns to draw, or patterns with * and ?; the coordinates if there are none.
            x: the column along the horizontal axis.

        Raises:
            ModelError: there is no such column, or there are no rows.
        """
        return Figure(self._required().figure([known(name, self._columns) for name in names], known(x, self._columns)))

    def plot(self, *names: str, x: str = "t", ax: Any = None) -> Any:
        """Draws columns over another one. Returns the axes of Matplotlib, or a :class:`Figure` if Matplotlib is not installed.

        Args:
            names: columns to draw; the coordinates if there are none.
            x: the column along the horizontal axis.
            ax: axes of Matplotlib; new ones if it is None.

        Raises:
            ColumnError: there is no such column.

        Example:
            >>> import anholon as an
            >>> run = an.load("disc").simulate(to=2, every="0.01")
            >>> axes = run.plot("theta", "phi'", x="t")
        """
        chosen: Sequence[str] = names or [name for name, column in self._columns.items() if column.kind == "coordinates"]
        columns = [(self[name], self._columns[known(name, self._columns)]) for name in chosen]
        if ax is None:
            try:
                import matplotlib.pyplot as plt
            except ImportError:
                return self.figure(*chosen, x=x)
            _, ax = plt.subplots()
        over = self[x]
        for values, column in columns:
            ax.plot(over, values, label=_label(column))
        ax.set_xlabel(_label(self._columns[known(x, self._columns)]))
        if len(columns) == 1:
            ax.set_ylabel(_label(columns[0][1]))
        else:
            ax.legend()
        return ax

    def __repr__(self) -> str:
        if self._core is None:
            return f"<run of {self.model.title!r}: {self.outcome!r}>"
        reached = f" to t = {self.t[-1]:g}" if len(self) else ""
        digits = [trust.digits for trust in self.report.trust]
        trusted = f", {min(digits)} digits to trust" if digits else ""
        return f"<run of {self.model.title!r}: {self.outcome.kind}{reached}, {len(self)} rows{trusted}>"

    def _repr_html_(self) -> str:
        return _display.run(self)


def _long_name(column: _core.Column) -> str:
    """Returns the meaning of a column in words."""
    base = column.name.rstrip("'")
    of = base.split(".", 1)[1] if column.kind in ("multipliers", "rates of multipliers", "reactions") and "." in base else base
    words = {
        "time": "time",
        "coordinates": f"coordinate {of}",
        "velocities": f"rate of {of}",
        "accelerations": f"second derivative of {of}",
        "higher derivatives": f"derivative of order {column.order} of {of}",
        "multipliers": f"multiplier of {of}",
        "rates of multipliers": f"derivative of order {column.order} of the multiplier of {of}",
        "reactions": f"generalized reaction along {of}",
        "states": f"state {of}",
        "inputs": f"input {of}",
    }
    return words.get(column.kind, column.name)


def _label(column: _core.Column) -> str:
    """Returns the symbol of a column with its unit, for Matplotlib."""
    from matplotlib.mathtext import MathTextParser

    unit = f" [{column.unit}]" if column.unit else ""
    try:
        MathTextParser("path").parse(f"${column.latex}$")
    except ValueError:  # the user wrote LaTeX that Matplotlib cannot read
        return column.name.replace("$", r"\$") + unit
    return f"${column.latex}$" + unit
