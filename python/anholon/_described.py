"""The contents of a model, and its prepared systems."""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping
from typing import Any

from . import _core
from ._names import ByName, names_of
from ._source import Source

_KEPT = 16  # the largest number of prepared systems that a model keeps


class Described:
    """The contents of a model file (title, names, values), and a store of the prepared systems of the model."""

    def __init__(self, core: _core.Model, again: Source, given: dict[str, str], cases: list[str]) -> None:
        self._core = core
        self._again, self._given, self._cases = again, given, cases
        self._prepared: dict[Any, _core.System] = {}

    @property
    def title(self) -> str:
        """The title of the file."""
        return self._core.title

    @property
    def text(self) -> str:
        """The text from which the model was read."""
        return self._core.text

    @property
    def coordinates(self) -> list[_core.Coordinate]:
        """Names and units of the coordinates."""
        return self._core.coordinates

    @property
    def parameters(self) -> dict[str, float]:
        """The values of the parameters by name, each in the unit that the file declares for it, as in ``{value = 50, unit = "cm"}``, else
        in SI units: as :meth:`with_` takes them. ``p`` and ``p0`` of :meth:`dynamics` are in SI units."""
        return ByName({p.name: p.value for p in self._core.parameters})

    @property
    def constraints(self) -> list[_core.Constraint]:
        """Names and orders of the constraints."""
        return self._core.constraints

    @property
    def states(self) -> list[str]:
        """The names of the states, unknowns with rates of their own beside the coordinates."""
        return self._core.states

    @property
    def inputs(self) -> list[str]:
        """The names of [input]."""
        return self._core.inputs

    @property
    def monitors(self) -> list[str]:
        """The names of [monitor] and [output], which are columns of a run."""
        return self._core.monitors

    @property
    def cases(self) -> list[str]:
        """The scenarios [case.NAME] of the file."""
        return self._core.cases

    @property
    def remarks(self) -> list[_core.Diagnostic]:
        """Warnings and notes of the reader."""
        return self._core.remarks

    def _system(self, form: str, initial: Mapping[str, str], eliminate: str | Iterable[str]) -> _core.System:
        key = (form, tuple(sorted(initial.items())), tuple(names_of(eliminate)))
        if key not in self._prepared:
            while len(self._prepared) >= _KEPT:
                self._prepared.pop(next(iter(self._prepared)), None)
            self._prepared[key] = _core.prepare(self._core, form, dict(initial), list(key[2]))
        return self._prepared[key]

    def __repr__(self) -> str:
        names = ", ".join(c.name for c in self.coordinates)
        return f"<model {self.title!r}: coordinates {names}; {len(self.constraints)} constraints>"

    def _repr_html_(self) -> str:
        rows = [
            ("coordinates", ", ".join(repr(c) for c in self.coordinates)),
            ("parameters", ", ".join(repr(p) for p in self._core.parameters)),
            ("constraints", ", ".join(repr(c) for c in self.constraints)),
            ("outputs", ", ".join(self.monitors)),
        ]
        body = "".join(f"<tr><th style='text-align:left'>{k}</th><td style='text-align:left'>{html.escape(v)}</td></tr>" for k, v in rows if v)
        return f"<table><caption>{html.escape(self.title)}</caption><tbody>{body}</tbody></table>"
