"""The text of a model file; each of its lines knows the line of Python that wrote it."""

from __future__ import annotations

import json
import linecache
import os
import re
import sys
import weakref
from collections.abc import Mapping
from dataclasses import dataclass

from ._errors import ModelError
from .expressions import Equation, expr

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")
_PACKAGE = os.path.dirname(__file__)
# Places that messages name: "line 3", "lines 3, 5 and 7"; those of data files are followed by " of" or a column.
_LINES = re.compile(r"\blines? (\d+(?:, \d+)*(?: and \d+)?)\b(?! of |, column )")
_NAMED = frozenset({"parameters", "functions", "define", "frame", "point", "mode", "state", "input", "quasi"})


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
        self.title = title
        self.coordinates: list[str] = []
        self._coordinates_at: list[_Where] = []
        self._names: set[str] = set()  # what formulas may hold, except coordinates
        self._tables: dict[str, list[_Line]] = {}  # sections of names
        self._lists: list[_Line] = []  # [[body]], [[force]], …
        _FILES.add(self)

    def add_coordinate(self, name: str) -> None:
        self.coordinates.append(name)
        self._coordinates_at.append(_caller())

    def add_to_head(self, name: str, value: str) -> None:
        self._head.append(_Line(f"{name} = {value}", _caller()))

    def add_entry(self, section: str, name: str, value: str) -> None:
        if section in _NAMED:
            self._names.add(name.partition("(")[0])
        self._tables.setdefault(section, []).append(_Line(f"{key_text(name)} = {value}", _caller()))

    def add_element(self, section: str, keys: Mapping[str, str]) -> None:
        where = _caller()
        if section in ("body", "particle"):
            self._names.add(json.loads(keys["name"]))
        self._lists.append(_Line(f"[[{section}]]", where))
        self._lists += [_Line(f"{name} = {value}", where) for name, value in keys.items()]
        self._lists.append(_Line("", None))

    def has_element(self, section: str, name: str) -> bool:
        """True if the section has an element of that name. The name must be the first key of its elements."""
        begin = [f"[[{section}]]", f"name = {quoted(name)}"]
        return any([line.text for line in self._lists[k : k + 2]] == begin for k in range(len(self._lists)))

    def _lines(self) -> list[_Line]:
        names = ", ".join(quoted(name) for name in self.coordinates)
        at = self._coordinates_at[-1] if self._coordinates_at else None
        lines = [*self._head, _Line(f"coordinates = [{names}]", at), _Line("", None)]
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
            line = lines[d.line - 1] if 0 < d.line <= len(lines) else None
            where = None if line is None else self._where(lines, d.line, d.column)
            message = self.with_lines_of_python(d.message, where)
            told = self._hint(d.message, d.hint)
            hint = f"\nhint: {self.with_lines_of_python(told, where)}" if told else ""
            if line is None or where is None:
                parts.append(f"error: {message}{hint}")
                continue
            python = linecache.getline(where.file, where.line).strip()
            shown = f"\n  {where.line} | {python}" if python else ""
            wrote = f"\n  it wrote: {line.text}\n            {' ' * max(d.column - 1, 0)}{'^' * max(d.length, 1)}"
            parts.append(f"{where}: {d.severity.name}: {message}{shown}{wrote}{hint}")
        return ModelError("\n".join(parts), error.diagnostics)

    def with_lines_of_python(self, text: str, here: _Where | None = None) -> str:
        """Returns a message in which lines of the model file are those of Python that wrote them. `here`: the place of the message, whose
        file needs no name."""
        lines = self._lines()

        def place(number: int, before: str) -> str:
            where = self._where(lines, number, None, before) if 0 < number <= len(lines) else None
            if where is None:
                return f"line {number} of Builder.text"
            return f"line {where.line}" if here is not None and where.file == here.file else str(where)

        def places(found: re.Match[str]) -> str:
            listed = [place(int(number), text[: found.start()]) for number in re.findall(r"\d+", found[1])]
            return " and ".join([*([", ".join(listed[:-1])] if listed[1:] else []), listed[-1]])

        return _LINES.sub(places, text)

    def _where(self, lines: list[_Line], number: int, column: int | None, before: str = "") -> _Where | None:
        """Returns the place in Python that wrote a line. The line of the coordinates has one for each: that of a column, or the first one
        whose name the text before ends with, as "'x' is already declared in "."""
        where = lines[number - 1].where
        if not self._coordinates_at or number != len(self._head) + 1:
            return where
        if column is not None:
            return self._coordinates_at[min(lines[number - 1].text[: column - 1].count(","), len(self._coordinates_at) - 1)]
        quoted_names = re.findall(r"'([^']*)'", before)
        return self._coordinates_at[self.coordinates.index(quoted_names[-1])] if quoted_names and quoted_names[-1] in self.coordinates else where

    def _hint(self, message: str, hint: str) -> str:
        """Returns the hint of a mistake, which tells of the builder that has an unknown name."""
        unknown = re.match(r"unknown name '([^']*)'", message)
        titles = sorted({file.title for file in _FILES if file is not self and unknown and unknown[1] in {*file.coordinates, *file._names}})
        if unknown is None or not titles:
            return hint
        further = re.search(r"it stands .*$", hint)
        told = f"another builder, {titles[0]!r}, has {unknown[1]}; formulas hold names of their own builder"
        return told + (f"; {further[0]}" if further else "")


_FILES: weakref.WeakSet[ModelFile] = weakref.WeakSet()
