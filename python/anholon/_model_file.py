"""The text of a model file; each of its lines knows the line of Python that wrote it."""

from __future__ import annotations

import json
import linecache
import os
import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass

from ._errors import ModelError
from .expressions import Equation, expr

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")
_PACKAGE = os.path.dirname(__file__)


@dataclass(frozen=True)
class _Where:
    """The place of a line of Python."""

    file: str
    line: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"


def _caller() -> _Where:
    """Returns the nearest line on the call stack outside of this package."""
    frame = sys._getframe(1)
    while os.path.dirname(frame.f_code.co_filename) == _PACKAGE and frame.f_back is not None:
        frame = frame.f_back
    return _Where(frame.f_code.co_filename, frame.f_lineno)


@dataclass
class _Line:
    text: str
    where: _Where | None


def quoted(text: str) -> str:
    """Returns a text as a value of TOML."""
    return json.dumps(text, ensure_ascii=False)


def key_text(name: str) -> str:
    """Returns a name as a key of TOML."""
    return name if _BARE.match(name) else quoted(name)


def value_text(value: object) -> str:
    """Returns a formula, an equation or the components of a vector as a value of TOML."""
    if isinstance(value, Equation):
        return quoted(value.text)
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if type(value).__module__ == "numpy" and len(getattr(value, "shape", ())) == 2:
        value = value.tolist()  # type: ignore[attr-defined]
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(value_text(part) for part in value) + "]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key_text(str(k))} = {value_text(v)}" for k, v in value.items()) + "}"
    return quoted(expr(value).text)


class ModelFile:
    """The sections of a model file: its head, then tables of names, then lists of elements."""

    def __init__(self, title: str, source: str) -> None:
        self._head: list[_Line] = [_Line(f"title = {quoted(title)}", None)]
        if source:
            self._head.append(_Line(f"source = {quoted(source)}", None))
        self.coordinates: list[str] = []
        self._coordinates_at: _Where | None = None
        self._tables: dict[str, list[_Line]] = {}  # sections of names
        self._lists: list[_Line] = []  # [[body]], [[force]], …

    def add_coordinate(self, name: str) -> None:
        self.coordinates.append(name)
        self._coordinates_at = _caller()

    def add_to_head(self, name: str, value: str) -> None:
        self._head.append(_Line(f"{name} = {value}", _caller()))

    def add_entry(self, section: str, name: str, value: str) -> None:
        self._tables.setdefault(section, []).append(_Line(f"{key_text(name)} = {value}", _caller()))

    def add_element(self, section: str, keys: Mapping[str, str]) -> None:
        where = _caller()
        self._lists.append(_Line(f"[[{section}]]", where))
        self._lists += [_Line(f"{name} = {value}", where) for name, value in keys.items()]
        self._lists.append(_Line("", None))

    def has_element(self, section: str, name: str) -> bool:
        """True if the section has an element of that name. The name must be the first key of its elements."""
        begin = [f"[[{section}]]", f"name = {quoted(name)}"]
        return any([line.text for line in self._lists[k : k + 2]] == begin for k in range(len(self._lists)))

    def _lines(self) -> list[_Line]:
        names = ", ".join(quoted(name) for name in self.coordinates)
        lines = [*self._head, _Line(f"coordinates = [{names}]", self._coordinates_at), _Line("", None)]
        for section, entries in self._tables.items():
            lines += [_Line(f"[{section}]", None), *entries, _Line("", None)]
        return lines + self._lists

    @property
    def text(self) -> str:
        return "\n".join(line.text for line in self._lines()) + "\n"

    def in_python(self, error: ModelError) -> ModelError:
        """Returns an error with the same mistakes, each at the line of Python that wrote it."""
        lines, parts = self._lines(), []
        for d in error.diagnostics:
            hint = f"\nhint: {d.hint}" if d.hint else ""
            line = lines[d.line - 1] if 0 < d.line <= len(lines) else None
            if line is None or line.where is None:
                parts.append(f"error: {d.message}{hint}")
                continue
            python = linecache.getline(line.where.file, line.where.line).strip()
            shown = f"\n  {line.where.line} | {python}" if python else ""
            wrote = f"\n  it wrote: {line.text}\n            {' ' * max(d.column - 1, 0)}{'^' * max(d.length, 1)}"
            parts.append(f"{line.where}: {d.severity.name}: {d.message}{shown}{wrote}{hint}")
        return ModelError("\n".join(parts), error.diagnostics)
