"""The kind of system that a model is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import _display

if TYPE_CHECKING:
    from . import _core
    from .model import Model


class Check:
    """The kind of system that a model is: degrees of freedom, kinds of constraints, and the initial state.

    Example:
        >>> import anholon as an
        >>> check = an.load("disc").check()
        >>> [constraint.name for constraint in check.constraints]
        ['rolling.x', 'rolling.y']
    """

    def __init__(self, model: Model, form: str, initial: dict[str, str]) -> None:
        self.model: Model = model
        self._form, self._initial = form, initial
        self._core = model._system(form, initial, ())

    def __reduce__(self) -> tuple[type[Check], tuple[Model, str, dict[str, str]]]:
        """Pickles the model and the options: another process makes the check again."""
        return Check, (self.model, self._form, self._initial)

    @property
    def degrees_of_freedom(self) -> int:
        """The number of velocities that the constraints leave free; without constraints the number of coordinates."""
        return self._core.degrees_of_freedom

    @property
    def constraints(self) -> list[_core.ConstraintClass]:
        """The kind of each constraint."""
        return self._core.constraints

    @property
    def initial(self) -> list[_core.InitialValue]:
        """The consistent initial state; each value has its origin."""
        return self._core.initial

    @property
    def notes(self) -> list[str]:
        """Notes on choices that the program made for the initial state."""
        return self._core.notes

    def __repr__(self) -> str:
        lines = [self.model.title, f"degrees of freedom {self.degrees_of_freedom}"]
        lines += [f"  {c!r}{', redundant' if c.redundant else ''}" for c in self.constraints]
        lines += [f"  {v!r} ({v.origin})" for v in self.initial]
        return "\n".join([*lines, *self.notes])

    def _repr_html_(self) -> str:
        return _display.check(self)
