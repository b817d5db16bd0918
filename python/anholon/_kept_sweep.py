"""The part of a sweep that is pickled: its arrays and outcomes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from . import _core
from ._errors import ModelError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from ._sweep_filling import Words
    from .model import Model

    Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class SweepAgain:
    """The model of a sweep and all arguments of the sweep, from which it can be computed again."""

    model: Model
    form: str
    initial: dict[str, str]
    words: Words
    scenarios: bool

    def run(self, threads: int, stop: Callable[[], object] | None, tell: Callable[[float, int], object] | None) -> tuple[_core.Sweep, object]:
        """Computes the sweep. Returns it with the exception that was raised meanwhile, or with None."""
        system = None if self.scenarios else self.model._system_of_sweep(self.form, self.initial)
        if system is None:
            return _core.sweep_scenarios(self.model._core, self.form, self.initial, self.words, threads, stop, tell)
        return _core.sweep(system, self.words, threads, stop, tell)


class KeptSweep:
    """The part of a sweep that is pickled: its numbers and outcomes. A file or a figure needs the sweep to be computed again."""

    def __init__(self, core: _core.Sweep | KeptSweep, varied: list[str], again: SweepAgain) -> None:
        self._again = again
        self._made: _core.Sweep | None = None
        self.cases: int = core.cases
        self.finished: int = core.finished
        self.columns: list[str] = list(core.columns)
        self.scenarios: list[str] = list(core.scenarios)
        self.units: dict[str, str] = dict(core.units)
        self.notes: list[str] = list(core.notes)
        self.outcome: _core.Outcome = core.outcome
        self.t: Array = core.t.copy()
        self.times: Array = core.times.copy()
        self._varied: dict[str, Array] = {name: core.varied(name).copy() for name in varied}
        self._ends: dict[str, Array] = {name: core.column(name).copy() for name in self.columns}
        self._rows: dict[str, Array] = {name: core.rows(name).copy() for name in self.columns} if self.times.size else {}
        # Most motions have the same outcome, so each different outcome is kept once.
        self._outcomes: list[_core.Outcome] = []
        self._outcome_numbers: list[int] = []
        known: dict[tuple[str, str, str], int] = {}
        for case in range(self.cases):
            outcome = core.outcome_of(case)
            number = known.setdefault((outcome.kind, outcome.message, outcome.hint), len(known))
            if number == len(self._outcomes):
                self._outcomes.append(outcome)
            self._outcome_numbers.append(number)
        self._events: list[str] = [core.event(case) for case in range(self.cases)]
        self._steps: list[int] = [core.steps(case) for case in range(self.cases)]

    def __getstate__(self) -> dict[str, object]:
        return {**self.__dict__, "_made": None}

    def __setstate__(self, state: dict[str, object]) -> None:
        self.__dict__.update(state)
        for arrays in (self._varied, self._ends, self._rows, {"t": self.t, "times": self.times}):
            for array in arrays.values():
                array.flags.writeable = False

    def column(self, name: str) -> Array:
        """Returns a column at the end of each motion."""
        return self._ends[name]

    def varied(self, name: str) -> Array:
        """Returns the values of a name that varies."""
        return self._varied[name]

    def rows(self, name: str) -> Array:
        """Returns a column at the times of ``at``, case by case."""
        return self._rows[name]

    def event(self, number: int) -> str:
        """Returns the name of the event that ended a motion; it is empty if none did."""
        return self._events[number]

    def steps(self, number: int) -> int:
        """Returns the number of steps of a motion."""
        return self._steps[number]

    def outcome_of(self, number: int) -> _core.Outcome:
        """Returns the outcome of a motion."""
        return self._outcomes[self._outcome_numbers[number]]

    def made(self) -> _core.Sweep:
        """Returns the sweep, computed again; its cases have the same bits.

        Raises:
            ModelError: the sweep was ended from outside.
        """
        if self.outcome.kind != "finished":
            raise ModelError("a sweep that was stopped from outside takes its numbers to another process, and no more\nhint: sweep.save where it was computed, or sweep.to_pandas() here")
        if self._made is None:
            made, raised = self._again.run(0, None, None)
            if isinstance(raised, BaseException):
                raise raised
            self._made = made
        return self._made

    def write(self, path: str) -> str:
        """Writes the sweep to a file."""
        return self.made().write(path)

    def figure(self, columns: list[str], x: str, y: str) -> str:
        """Returns a figure of the cases as SVG."""
        return self.made().figure(columns, x, y)
