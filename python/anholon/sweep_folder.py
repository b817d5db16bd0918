"""Sweeps in folders: any number of processes compute the parts, and any process can read the parts."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from . import _core
from ._case_table import names_of_table
from ._errors import ModelError
from ._names import known
from ._progress import Progress
from .run import Figure

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas
    import polars
    import pyarrow
    from distributed import Client

    from .run import Run


class SweepFolder(Mapping[str, "npt.NDArray[Any]"]):
    """A sweep in a folder. Each access reads the folder, so it sees the parts that are complete at that moment.

    ``folder["theta"]`` has one number for each case (with ``at``, for each case and time), in the order of the cases, NaN if the
    part of the case is missing; columns of words (``outcome``, ``event``, ``case_name``) are arrays of strings, which are empty
    for missing parts. :meth:`to_dict` and the frames have the rows of the complete parts only. Reading a part compares it with the
    hash in its file, except in :meth:`scan`, where polars reads the files. A sweep can be pickled: another process opens the folder
    again.

    Example:
        >>> import anholon as an, tempfile
        >>> place = tempfile.mkdtemp()
        >>> falls = an.load("disc").sweep({"phi'": [5, 6, 7]}, to=1, out=place + "/falls", chunk=2)
        >>> falls.cases, falls.complete, falls["phi'(0)"].tolist()
        (3, True, [5.0, 6.0, 7.0])
        >>> opened = an.open_sweep(place + "/falls")
        >>> opened.progress(), opened.path == falls.path, opened.parts, opened.chunk
        (2 of 2 parts, 3 of 3 cases, True, 2, 2)

        A part that is missing is computed again, with the same bytes:

        >>> import os
        >>> os.remove(place + "/falls/part-000001.parquet")
        >>> opened.missing, opened.fill().missing, opened.to_arrow(["theta"]).num_rows
        ([1], [], 3)

        Chosen cases, and the whole motion of one:

        >>> opened.where({"outcome": "finished", "phi'(0)": (5.5, 7)}).tolist()
        [1, 2]
        >>> bool(abs(opened.run(2)["theta"][-1] - falls["theta"][2]) < 1e-9)
        True
        >>> opened.generations
        [3]
        >>> opened.scan().select("theta").collect().height  # doctest: +SKIP
        3
    """

    def __init__(self, core: _core.SweepFolder) -> None:
        self._core = core
        self._computed_notes: list[str] = []

    def __reduce__(self) -> tuple[Callable[[str], SweepFolder], tuple[str]]:
        return _opened, (os.path.abspath(self.path),)

    @property
    def path(self) -> str:
        """The name of the folder, without a slash at its end."""
        return self._core.path

    @property
    def cases(self) -> int:
        """The number of cases of the whole sweep."""
        return self._core.cases

    @property
    def parts(self) -> int:
        """The number of parts of the whole sweep."""
        return self._core.parts

    @property
    def chunk(self) -> int:
        """The number of cases of a part."""
        return self._core.chunk

    @property
    def missing(self) -> list[int]:
        """The numbers of the missing parts."""
        return self._core.missing()

    @property
    def complete(self) -> bool:
        """True if no part is missing."""
        return not self._core.missing()

    def progress(self) -> _core.FolderProgress:
        """Returns the progress of the sweep: parts, cases, outcomes, cases per second.

        Raises:
            ModelError: a part is damaged, or belongs to another sweep.
        """
        return self._core.progress()

    @property
    def outcomes(self) -> dict[str, int]:
        """The number of cases of each outcome, among the cases of the complete parts."""
        return self._core.progress().outcomes

    @property
    def notes(self) -> list[str]:
        """Notes on reductions that have no value in some of the cases that this object computed, and on cases that stopped: for each
        outcome the number of cases, the first case, its message and a hint."""
        return [*self._computed_notes, *self._core.progress().notes]

    @property
    def units(self) -> dict[str, str]:
        """The units of the columns, if the model has units for them."""
        return dict(self._core.units())

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        """Returns a column, shape (cases,) or with ``at`` (cases * times,), in SI units; a varied parameter is in the unit that
        the file declares for it. Without ``at``, entry k belongs to case k.

        If the part of a case is missing, a number is NaN and a word is empty; whole numbers become doubles then.

        Raises:
            KeyError: there is no such column.
            ModelError: a part was changed after it was written.
        """
        name = known(name, self._core.columns)
        columns = self._columns(["case", name])
        return _over_all(columns["case"], columns[name], self.cases) if "case" in columns else columns[name]

    def _columns(self, names: Iterable[str]) -> dict[str, npt.NDArray[Any]]:
        """Returns columns of the complete parts, read in one pass. A folder of an earlier version may lack the column "case"."""
        for name in names:
            if name not in self._core.columns and name != "case":
                raise KeyError(f"there is no column {name!r}; there are {', '.join(self._core.columns)}")
        wanted = [name for name in dict.fromkeys(names) if name in self._core.columns]
        return {name: _array(column) for name, column in self._core.read(wanted)}

    def _read(self, columns: Iterable[str]) -> Any:
        own = self._core.columns
        return self._core.read([known(name, own) for name in columns])

    @property
    def generations(self) -> list[int]:
        """The number of cases of each generation: first that of the request, then those that refine borders."""
        return self._core.progress().generations

    @property
    def varied(self) -> list[str]:
        """The names of the columns that vary."""
        names = self._core.columns
        # The command line keeps the words of --vary: NAME=VALUES or NAME~LAW.
        by_command = names_of_table(self._core.asked("table of cases")) | {re.split("[=~]", word)[0] for word in self._core.asked("vary").split()}

        def varies(name: str) -> bool:
            of = name.removesuffix("(0)")
            return name + "(0)" not in names and (of in by_command or self._core.asked("vary " + of) != "")

        return [name for name in names if name not in ("case", "case_name") and varies(name)]

    def judge(self, *, stop: Callable[[], object] | None = None) -> dict[str, Any]:
        """Estimates how far the cases can be trusted. It computes some cases once more, with digits to trust and residuals.

        The folder keeps the result, which ``anholon sweep status`` shows and a second call reads.

        Args:
            stop: a function that is called every 20 ms; True ends the computation.

        Returns:
            ``error_estimate`` and ``residuals``, as in the JSON of ``anholon sweep``, and ``text``, a list of sentences.

        Raises:
            ModelError: parts are missing, or the folder was made by the command line and is not judged yet.
            MotionError: ``stop`` ended the computation.
            KeyboardInterrupt: the user pressed Ctrl-C.

        Example:
            >>> import anholon as an, tempfile
            >>> falls = an.load("disc").sweep({"phi'": [5, 6, 7]}, to=1, out=tempfile.mkdtemp() + "/falls")
            >>> judged = falls.judge()
            >>> judged["error_estimate"]["digits"] >= 10, judged["residuals"]["newton"]["worst"] < 1e-12
            (True, True)
        """
        from ._sweep_filling import computing

        kept = os.path.exists(os.path.join(self.path, "_judgement.json"))
        judged, raised = (self._core if kept else computing(self.path)).judge(stop)
        if isinstance(raised, BaseException):
            raise raised
        answer: dict[str, Any] = json.loads(judged)
        return answer

    def where(self, conditions: Mapping[str, Any]) -> npt.NDArray[Any]:
        """Returns the numbers of the cases in which each column has the given value, or lies in the given range, ends included.

        ``{"case": "moon"}`` chooses a scenario by its name in the column ``case_name``. Other values of ``case`` are numbers of cases.

        Returns:
            Sorted numbers, shape (chosen cases,).

        Raises:
            KeyError: there is no such column.
            TypeError: `conditions` is no mapping.
            ValueError: a range is no pair.
        """
        import numpy as np

        if not isinstance(conditions, Mapping):
            raise TypeError(f"conditions are given by column, as {{'outcome': 'finished', 'theta': (1, 2)}}, not as a {type(conditions).__name__}")
        own = self._core.columns
        asked = [("case_name" if name == "case" and isinstance(wanted, str) else known(name, own), wanted) for name, wanted in conditions.items()]
        columns = self._columns(["case", *(name for name, _ in asked)])
        numbers = columns["case"]
        chosen = np.ones(numbers.shape, dtype=bool)
        for name, wanted in asked:
            if isinstance(wanted, tuple) and len(wanted) != 2:
                raise ValueError(f"{name}: a range is a pair (from, to), not {wanted!r:.60}")
            column = columns[name]
            chosen &= (column >= wanted[0]) & (column <= wanted[1]) if isinstance(wanted, tuple) else column == wanted
        return np.unique(numbers[chosen])

    def run(self, case: int, **options: Any) -> Run:
        """Simulates the whole motion of a case, with the numbers of the case.

        Args:
            case: the number of the case, as in the column ``case``.
            options: arguments of :meth:`Model.simulate`: ``every=0.01``, ``to=20``.

        Raises:
            IndexError: there is no such case.
            ModelError: the folder was made by the command line, and lacks the values that vary or the files of the model.
        """
        from ._sweep_case import run_of
        from ._sweep_filling import computing

        if not 0 <= case < self.cases:
            raise IndexError(f"there are {self.cases} cases")
        return run_of(self._core, lambda: computing(self.path), case, options)

    def figure(self, *names: str, x: str | None = None, y: str | None = None) -> Figure:
        """Returns a figure of the complete parts as SVG, which ``anholon plot`` shows of the folder. No other package is needed.

        If one name varies, columns are curves over its values; if two vary, one column is a map over their values. Up to eight cases
        with rows at several times are curves over ``t``; more than eight are shown by the quantiles of 10, 50 and 90 % at each
        time. If parts are missing, a map has the whole grid, and the title tells how many parts are complete.

        Args:
            names: columns to draw, or patterns with * and ?; the outcomes if there are none.
            x: the column along the horizontal axis; the first that varies, or ``t``, if it is None.
            y: the column along the vertical axis of a map; the second that varies if it is None.

        Raises:
            ModelError: there is no such column, a map has several columns, no number varies, or all parts are missing.

        Example:
            >>> import anholon as an, tempfile
            >>> falls = an.load("disc").sweep({"phi'": [5, 6, 7]}, to=1, out=tempfile.mkdtemp() + "/falls")
            >>> falls.figure("theta").svg[:4]
            '<svg'
        """
        return Figure(self._core.figure(list(names), x or "", y or ""))

    def plot(self, *names: str, x: str | None = None, y: str | None = None, ax: Any = None) -> Any:
        """Draws the figure of :meth:`figure` with Matplotlib and returns the axes; returns a :class:`Figure` without Matplotlib.

        If several cases have the same x, a curve is their median, in a band from the 10 % to the 90 % quantile.

        Args:
            names: columns to draw; the outcomes if there are none.
            x: the column along the horizontal axis; the first that varies, or ``t``, if it is None.
            y: the column along the vertical axis of a map; the second that varies if it is None.
            ax: axes of Matplotlib; new ones if it is None.

        Raises:
            KeyError: there is no such column.
            ModelError: a map has several columns, no number varies, or all parts are missing.

        Example:
            >>> import anholon as an, tempfile
            >>> falls = an.load("disc").sweep({"phi'": an.grid(5, 7, 5), "m": [1, 2]}, to=1, out=tempfile.mkdtemp() + "/falls")
            >>> axes = falls.plot("theta")
        """
        if ax is None and find_spec("matplotlib") is None:
            return self.figure(*names, x=x, y=y)
        from . import _sweep_plot

        return _sweep_plot.plot_folder(self, list(names), x, y, ax)

    def scan(self) -> polars.LazyFrame:
        """Returns a lazy frame of polars over the complete parts, which reads only the columns and rows that are used. Needs polars.

        polars reads the files and does not compare them with their hashes, so it may not notice a damaged file; :meth:`to_polars` does.
        """
        import polars

        return polars.scan_parquet([os.path.join(self.path, f"part-{part:06}.parquet") for part in self._core.present()])

    def __iter__(self) -> Iterator[str]:
        return iter(self._core.columns)

    def __len__(self) -> int:
        """The number of columns; ``cases`` is the number of motions."""
        return len(self._core.columns)

    def to_dict(self, columns: Sequence[str] = ()) -> dict[str, npt.NDArray[Any]]:
        """Returns columns of the complete parts as arrays by name; all columns if none is named. Each part is read once."""
        return {name: _array(column) for name, column in self._read(columns)}

    def to_pandas(self, columns: Sequence[str] = ()) -> pandas.DataFrame:
        """Returns a DataFrame with the rows of the complete parts; words are categories. Needs pandas."""
        import pandas

        def of(column: Any) -> Any:
            return pandas.Categorical.from_codes(column[1].astype("int32"), column[0]) if isinstance(column, tuple) else column

        return pandas.DataFrame({name: of(column) for name, column in self._read(columns)})

    def to_polars(self, columns: Sequence[str] = ()) -> polars.DataFrame:
        """Returns a DataFrame of polars with the rows of the complete parts; words are texts. Needs polars."""
        import polars

        def of(column: Any) -> Any:
            return polars.Series(column[0], dtype=polars.String).gather(column[1]) if isinstance(column, tuple) else column

        return polars.DataFrame({name: of(column) for name, column in self._read(columns)})

    def to_arrow(self, columns: Sequence[str] = ()) -> pyarrow.Table:
        """Returns a table of Arrow with the rows of the complete parts; words are dictionaries. Needs pyarrow."""
        import pyarrow

        def of(column: Any) -> Any:
            return pyarrow.DictionaryArray.from_arrays(column[1], column[0]) if isinstance(column, tuple) else pyarrow.array(column)

        return pyarrow.table({name: of(column) for name, column in self._read(columns)})

    def fill(
        self,
        *,
        on: Client | str | None = None,
        share: tuple[int, int] = (1, 1),
        threads: int = 0,
        stop: Callable[[], object] | None = None,
        progress: Progress = None,
        refine: int = 0,
        refine_by: tuple[str, float] | None = None,
    ) -> SweepFolder:
        """Computes the missing parts, as :meth:`Model.sweep` with the same arguments does. Returns the sweep in the folder.

        Raises:
            ModelError: the folder was made by the command line, or files of its model are missing.
            OSError: a part could not be written.
            Interrupted: the user pressed Ctrl-C; the complete parts are kept.
        """
        from ._sweep_filling import computing, fill

        core = computing(self.path)
        return fill(core, on=on, share=share, threads=threads, stop=stop, progress=progress, refine=refine, refine_by=refine_by)

    def _repr_html_(self) -> str:
        import html

        from . import _display

        p = self.progress()
        lines = [("parts", f"{p.parts} of {p.all_parts}"), ("cases", f"{p.cases} of {p.all_cases}")]
        lines += [(html.escape(kind), str(count)) for kind, count in p.outcomes.items()]
        return _display.rows(html.escape(f"sweep in {self.path}"), lines + [(html.escape(f"by event {event}"), str(count)) for event, count in p.events.items()])

    def __repr__(self) -> str:
        missing = len(self.missing)
        return f"<sweep in {self.path!r}: {self.cases} cases, {self.parts - missing} of {self.parts} parts>"


def open_sweep(folder: str | os.PathLike[str]) -> SweepFolder:
    """Opens the folder of a sweep, to read or to continue it.

    Raises:
        ModelError: the folder holds no sweep.

    Example:
        >>> import anholon as an, tempfile
        >>> try:
        ...     an.open_sweep(tempfile.mkdtemp())
        ... except an.ModelError as error:
        ...     print("holds no _sweep.json" in str(error))
        True
    """
    return SweepFolder(_core.open_sweep(os.fspath(folder)))


def _over_all(numbers: npt.NDArray[Any], values: npt.NDArray[Any], cases: int) -> npt.NDArray[Any]:
    """Returns a column over all cases. `values` are its rows in the complete parts, `numbers` the numbers of their cases, which ascend."""
    import numpy as np

    times = numbers.size // np.unique(numbers).size if numbers.size > 0 else 1
    if numbers.size >= cases * times:
        return values
    if values is numbers:
        return np.repeat(np.arange(cases), times)
    whole = np.full(cases * times, "", dtype=object) if values.dtype == object else np.full(cases * times, np.nan)
    whole[numbers.astype(np.int64) * times + np.arange(numbers.size) % times] = values
    return whole


def _array(column: Any) -> npt.NDArray[Any]:
    import numpy as np

    if not isinstance(column, tuple):
        return np.asarray(column)
    words, rows = column
    return np.array(words, dtype=object)[rows] if words else np.array([], dtype=object)


def _opened(path: str) -> SweepFolder:
    return SweepFolder(_core.open_sweep(path))
