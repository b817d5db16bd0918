"""The options of a motion, by which it is computed again: for its polynomials, or in another process."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import ModelError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from .model import Model

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Recipe:
    """The model of a motion with all options that change it."""

    model: Model
    form: str
    initial: dict[str, str]
    eliminate: str | list[str]
    words: dict[str, str]
    times: list[str]
    cut: bool = False  # whether the motion was ended from outside, which cannot be repeated

    def run(self) -> _core.Run:
        """Computes the motion again, with the same bits."""
        return self._made(self.words, self.times, dense=False)

    @property
    def start(self) -> float:
        """The time at which the motion starts."""
        return self.model._system(self.form, self.initial, self.eliminate).start

    def polynomials(self, last: float | None) -> _core.Run:
        """Computes the motion again and keeps the polynomials of its steps; up to the time `last`, if it is given."""
        if last is None:
            return self._made({**self.words, "error-estimate": "never"}, self.times, dense=True)
        words = {name: word for name, word in self.words.items() if name not in ("to", "every")}
        end = repr(float(last))
        return self._made({**words, "to": end, "error-estimate": "never"}, [end], dense=True)

    def _made(self, words: dict[str, str], times: list[str], *, dense: bool) -> _core.Run:
        system = self.model._system(self.form, self.initial, self.eliminate)
        made, raised = _core.simulate(system, words, times, dense, None, None)
        if isinstance(raised, BaseException):
            raise raised
        return made


class KeptRun:
    """The part of a run that is pickled: its numbers, events and report. The rest is computed again when it is needed."""

    has_dense: bool = False

    def __init__(self, core: _core.Run | KeptRun, recipe: Recipe) -> None:
        self.columns: list[_core.Column] = core.columns
        self.rows: int = core.rows
        self.events: list[_core.Event] = core.events
        self.report: _core.Report = core.report
        self._block: Array = core.block(0, len(self.columns)).copy(order="F")
        self._recipe = recipe
        self._made: _core.Run | None = None

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_made": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._block.flags.writeable = False

    def column(self, name: str) -> Array:
        """Returns the numbers of a column, shape (rows,)."""
        return self._block[:, [column.name for column in self.columns].index(name)]

    def block(self, first: int, count: int) -> Array:
        """Returns the numbers of neighbouring columns, shape (rows, count)."""
        return self._block[:, first : first + count]

    def made(self) -> _core.Run:
        """Returns the run, computed again.

        Raises:
            ModelError: the run was ended from outside.
        """
        if self._recipe.cut:
            raise ModelError("a run that was stopped from outside takes its numbers, events and report to another process, and no more\nhint: save it, or make its page, where it was computed")
        if self._made is None:
            self._made = self._recipe.run()
        return self._made

    def text(self, row: int, column: str) -> str:
        """Returns a number with all its digits."""
        return self.made().text(row, column)

    def page(self, forms: list[str], proof: bool) -> str:
        """Returns the page of the run."""
        return self.made().page(forms, proof)

    def picture_data(self) -> str:
        """Returns the data that the animation plays."""
        return self.made().picture_data()

    def figure(self, columns: list[str], x: str) -> str:
        """Returns a figure of columns as SVG."""
        return self.made().figure(columns, x)

    def json(self) -> str:
        """Returns the text that ``anholon simulate --json`` prints."""
        return self.made().json()

    def write(self, path: str) -> str:
        """Writes the run to a file."""
        return self.made().write(path)
