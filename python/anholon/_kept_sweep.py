"""What a sweep takes to another process: its arrays and outcomes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

from . import _core
from ._errors import ModelError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


class KeptSweep:
    """The numbers of a sweep without the computation that made them."""

    def __init__(self, core: _core.Sweep | KeptSweep, varied: list[str]) -> None:
        self.cases: int = core.cases
        self.finished: int = core.finished
        self.columns: list[str] = list(core.columns)
        self.scenarios: list[str] = list(core.scenarios)
        self.units: dict[str, str] = dict(core.units)
        self.outcome: _core.Outcome = core.outcome
        self.t: Array = core.t.copy()
        self.times: Array = core.times.copy()
        self._varied: dict[str, Array] = {name: core.varied(name).copy() for name in varied}
        self._ends: dict[str, Array] = {name: core.column(name).copy() for name in self.columns}
        self._rows: dict[str, Array] = {name: core.rows(name).copy() for name in self.columns} if self.times.size else {}
        # Most motions end alike: each outcome and event is kept once.
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

    def __setstate__(self, state: dict[str, object]) -> None:
        self.__dict__.update(state)
        for arrays in (self._varied, self._ends, self._rows, {"t": self.t, "times": self.times}):
            for array in arrays.values():
                array.flags.writeable = False

    def column(self, name: str) -> Array:
        """A column at the end of each motion."""
        return self._ends[name]

    def varied(self, name: str) -> Array:
        """The values of what varies."""
        return self._varied[name]

    def rows(self, name: str) -> Array:
        """A column at the times of ``at``, case by case."""
        return self._rows[name]

    def event(self, number: int) -> str:
        """The name of the event that ended a motion."""
        return self._events[number]

    def steps(self, number: int) -> int:
        """The steps of a motion."""
        return self._steps[number]

    def outcome_of(self, number: int) -> _core.Outcome:
        """How a motion ended."""
        return self._outcomes[self._outcome_numbers[number]]

    def write(self, path: str) -> NoReturn:
        """Raises ModelError: the program writes files of sweeps where they are computed."""
        raise ModelError(f"a sweep from another process has its numbers, and {path} is written where it was computed\nhint: sweep.save there, or sweep.to_pandas() here")

    def figure(self, columns: list[str], x: str, y: str) -> NoReturn:
        """Raises ModelError: the program draws sweeps where they are computed."""
        raise ModelError("a sweep from another process has its numbers, and the program draws it where it was computed\nhint: sweep.figure there, or sweep.plot with Matplotlib here")
