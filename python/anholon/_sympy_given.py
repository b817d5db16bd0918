"""The values and the initial values of ``from_sympy``, as sections of a model file.

A formula of the coordinates and speeds that is given for a function of time, or for a symbol, becomes a definition of the model. It
may act through generalized forces alone: SymPy has derived velocities and constraints for a function that depends on the time only.
"""

from __future__ import annotations

import json
import re
import warnings
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ._errors import ModelError
from ._names import spelled
from ._numbers import float_of, Number, text_of
from ._sympy_parts import names_in, nearest
from ._sympy_plain import is_other_time, is_rate, name_of, not_the_time, symbol_of

if TYPE_CHECKING:
    from ._sympy_import import Import

_CONSTANT, _OF_TIME, _OF_MOTION = 0, 1, 2  # what a formula depends on
_SECTIONS = ("parameters", "functions", "define")
_BEYOND_FORCES = "a mass, an inertia, a position, a velocity or a constraint"

_NAME = re.compile(r"(?<![\w.])[^\W\d]\w*")
_UNIT = re.compile(r"(?<=[\d.])\s+(?:1/)?[^\W\d]\w*(?:[*/·^]-?\w+)*")  # a number, a blank and a unit, such as 3 m/s


def _names(text: str) -> list[str]:
    """Returns the names in a formula of the model language, without those of units."""
    return [spelled(name) for name in _NAME.findall(_UNIT.sub("", text))]


class Given:
    """The values and initial values of one import."""

    def __init__(self, made: Import, values: Mapping[Any, Number], initial: Mapping[Any, Number]) -> None:
        self._made = made
        self.values = {symbol_of(key): value for key, value in values.items()}
        self._initial = initial
        self._found: dict[Any, str | None] = {}  # the formulas of symbols and functions; None if they have none

    def sections(self, fixed: list[Any]) -> tuple[list[str], list[str]]:
        """Returns the lines of the values and those of the initial values. The formulas of bodies and constraints hold the symbols and
        functions of `fixed`."""
        self._must_be_known()
        start = self._start()
        self._find()
        w = self._made.writer
        self._must_have_values([symbol for symbol in w.parameters if self._found[symbol] is None])
        self._look_at_dependences(fixed)
        lists: dict[str, list[str]] = {section: [] for section in _SECTIONS}
        for of, name in {**w.parameters, **w.functions}.items():
            written = self._found[of]
            least = _OF_TIME if of in w.functions else _CONSTANT
            section = _SECTIONS[max(least, self._dependence(of))]
            lists[section].append(f"{name} = {json.dumps(written) if written is not None else '{}'}")
        lines = [line for section, of in lists.items() if of for line in (f"[{section}]", *of, "")]
        return lines, self._initial_lines(start)

    def _initial_lines(self, start: Mapping[str, str]) -> list[str]:
        """Returns the lines of the initial values. A formula of the motion, and one for a sum of rates, is a condition."""
        w = self._made.writer
        entries = {name + prime for name in w.names.values() for prime in ("", "'")}
        constant = [of for of, written in start.items() if of in entries and self._dependence_of(written) == _CONSTANT]
        lines = [f"{json.dumps(of)} = {json.dumps(start[of])}" for of in constant]
        conditions = [f"{of} = {written}" for of, written in start.items() if of not in constant]
        if conditions:
            lines.append(f"conditions = {json.dumps(conditions)}")
        return ["[initial]", *lines] if lines else []

    def _must_be_known(self) -> None:
        """Raises ModelError if a key of the values is a coordinate, a speed, a rate or no symbol, or a text that names no symbol and no
        function of the system. Other symbols are allowed, as they may belong to other systems."""
        if not self.values:
            return
        sm, w, parts = self._made.sm, self._made.writer, self._made.parts
        states = {name_of(x) for x in [*parts.q, *parts.u]}
        known = names_in(parts) | {name_of(x) for x in [*w.parameters, *w.functions]}
        for key in self.values:
            if isinstance(key, sm.Derivative):
                self._refuse_rate(key, states, known)
                continue
            name = name_of(key)
            if key == self._made.time:
                raise ModelError(f"'{name}' in values is the time, which has no value\nhint: put a number in its place in the system")
            if name in states - known:
                raise ModelError(f"'{name}' in values is a coordinate or speed\nhint: from_sympy(…, initial={{{name}: …}}) gives its value at the start")
            named = isinstance(key, (str, sm.Symbol, sm.core.function.AppliedUndef, sm.FunctionClass))
            if not named or isinstance(key, str) and name not in known:
                name = name if named else str(key)
                raise ModelError(f"'{name}' in values is no symbol and no function of the system{nearest(name, known)}\nhint: {', '.join(sorted(known))}")

    def _refuse_rate(self, key: Any, states: set[str], known: set[str]) -> None:
        """Raises ModelError if a key of the values is the derivative of a coordinate, a speed or a function of the system."""
        name = name_of(key.expr)
        if name in states - known:
            raise ModelError(f"'{_shown(key)}' in values is a rate or an acceleration\nhint: from_sympy(…, initial={{…}}) gives values at the start")
        if name in known:
            said = f"'{_shown(key)}' in values is the rate of {name}, which follows from {name}"
            raise ModelError(f"{said}\nhint: from_sympy(…, values={{{name}: …}}) gives {name} as a formula")

    def _find(self) -> None:
        """Writes the values of the symbols and functions in the formulas of the model, and of those in the values themselves."""
        w = self._made.writer
        while new := [of for of in [*w.parameters, *w.functions] if of not in self._found]:
            names = [name_of(x) for x in [*w.parameters, *w.functions]]
            by_name = {name_of(key): key for key in self.values if names.count(name_of(key)) < 2}
            for of in new:
                key = of if of in self.values else by_name.get(name_of(of))
                self._found[of] = None if key is None else self._written(self.values[key], key)

    def _must_have_values(self, missing: list[Any]) -> None:
        """Raises ModelError for symbols without a value. Several symbols of one name need values by the symbols themselves."""
        if not missing:
            return
        sm, w = self._made.sm, self._made.writer
        for symbol in filter(is_other_time, missing):
            raise ModelError(
                f"{not_the_time(symbol)}\nhint: put me.dynamicsymbols._t in its place in the system; "
                f"if it acts in loads alone, from_sympy(…, values={{{sm.srepr(symbol)}: me.dynamicsymbols._t}}) does so"
            )
        names = [name_of(symbol) for symbol in w.parameters]
        twice = next((s for s in sorted(missing, key=sm.srepr) if names.count(name_of(s)) > 1), None)
        if twice is not None:
            of_name = sorted(sm.srepr(symbol) for symbol in w.parameters if name_of(symbol) == name_of(twice))
            raise ModelError(
                f"{len(of_name)} symbols have the name {twice.name}: {', '.join(of_name)}\n"
                f"hint: give the value of each by the symbol itself, from_sympy(…, values={{{sm.srepr(twice)}: 1}}), or make one symbol of them"
            )
        listed = sorted(symbol.name for symbol in missing)
        raise ModelError(f"values are missing for {', '.join(listed)}\nhint: from_sympy(…, values={{{listed[0]}: 1}})")

    def _look_at_dependences(self, fixed: list[Any]) -> None:
        """Raises ModelError if a formula of the motion, or one of the time for a constant of SymPy, acts beyond generalized forces. Warns if
        a symbol that has the name of the time is constant."""
        w = self._made.writer
        for of in filter(is_other_time, w.parameters):
            if self._dependence(of) == _CONSTANT:
                warnings.warn(
                    f"{not_the_time(of)}; the model has the constant {self._found[of]} for it. Put me.dynamicsymbols._t in its place if the time is meant",
                    stacklevel=5,
                )
        for of in fixed:
            on, name = self._dependence(of), name_of(of)
            if on == _CONSTANT or on == _OF_TIME and of in w.functions:
                continue
            if is_other_time(of):
                raise ModelError(f"{not_the_time(of)}, and it occurs in {_BEYOND_FORCES}\nhint: put me.dynamicsymbols._t in its place in the system")
            what = f"the value of {name} depends on {'the time' if on == _OF_TIME else 'coordinates or speeds'}, and {name} occurs in {_BEYOND_FORCES}"
            if on == _OF_TIME:
                of_time = f"let {name} be a function of the time in the system, {name} = me.dynamicsymbols('{name}')"
                raise ModelError(f"{what}, where SymPy takes it for a constant\nhint: {of_time}")
            elsewhere = f"elsewhere put the formula in the place of {name} in the system"
            raise ModelError(f"{what}\nhint: values may depend on coordinates and speeds in loads and potentials alone; {elsewhere}")

    def _dependence(self, of: Any, seen: frozenset[Any] = frozenset()) -> int:
        """Returns on what the value of a symbol or of a function depends."""
        if of in seen:
            raise ModelError(f"the value of {name_of(of)} depends on {name_of(of)} itself\nhint: give it by coordinates, rates and other symbols")
        own = _OF_TIME if of in self._made.writer.functions else _CONSTANT
        written = self._found.get(of)
        return own if written is None else max(own, self._dependence_of(written, seen | {of}))

    def _dependence_of(self, text: str, seen: frozenset[Any] = frozenset()) -> int:
        """Returns on what a formula of the model language depends."""
        w = self._made.writer
        by_name = {name: of for of, name in {**w.parameters, **w.functions}.items()}
        coordinates, found = set(w.names.values()), _CONSTANT
        for name in _names(text):
            own = _OF_MOTION if name in coordinates else _OF_TIME if name == "t" else _CONSTANT
            found = max(found, self._dependence(by_name[name], seen) if name in by_name else own)
        return found

    def _start(self) -> dict[str, str]:
        """Returns the initial values by the formulas of coordinates, rates and generalized speeds."""
        start: dict[str, str] = {}
        for key, value in self._initial.items():
            of, written = self._place(key), self._written(value, key)
            before = start.get(of, written)
            if before != written and (float_of(written) is None or float_of(before) != float_of(written)):
                raise ModelError(
                    f"initial gives {of} two values, {before} and {written}\nhint: a speed that is the rate of a coordinate has one value with it"
                )
            start[of] = written
        return start

    def _place(self, key: Any) -> str:
        """Returns the formula of the coordinate, rate or generalized speed that a key of the initial values names."""
        w = self._made.writer
        coordinates, speeds = {name_of(q): q for q in w.q}, {name_of(u): u for u in self._made.speeds}
        name, order = _base_of(key)
        if name in coordinates and order < 2:
            return w.names[coordinates[name]] + "'" * order
        if name in speeds and order == 0:
            return w.formula(self._made.speeds[speeds[name]])
        known = [*coordinates, *(f"{name}'" for name in coordinates), *speeds]
        if name in coordinates or name in speeds:
            raise ModelError(f"'{_shown(key)}' in initial is an acceleration, or its rate, which the equations give\nhint: {', '.join(known)}")
        raise ModelError(f"'{_shown(key)}' in initial is no coordinate, rate or speed{nearest(_shown(key), known)}\nhint: {', '.join(known)}")

    def _written(self, value: Any, key: Any) -> str:
        """Returns a number, a text or a formula of SymPy as a formula of the model language, with rates in place of generalized speeds."""
        made = self._made
        if isinstance(value, made.sm.Basic):
            return made.writer.formula(made.in_rates(value), f"the value of {_shown(key)}")
        try:
            return self._with_rates(value) if isinstance(value, str) else text_of(value)
        except (TypeError, ValueError) as mistake:
            raise mistake if isinstance(mistake, ModelError) else type(mistake)(f"{name_of(key)}: {mistake}") from None

    def _with_rates(self, text: str) -> str:
        """Returns a formula of the model language with rates in place of generalized speeds. A name before a parenthesis is a function."""
        w = self._made.writer
        taken = {*w.names.values(), *w.parameters.values(), *w.functions.values()}
        speeds = {spelled(name_of(u)): rate for u, rate in self._made.speeds.items() if name_of(u) not in taken}
        units = [m.span() for m in _UNIT.finditer(text)]

        def replaced(found: re.Match[str]) -> str:
            rate = speeds.get(spelled(found[1]))
            if rate is None or any(begin <= found.start() < end for begin, end in units):
                return found[0]
            formula, order = w.formula(rate), len(found[2])
            if isinstance(rate, self._made.sm.Derivative):
                return formula + "'" * order
            return f"D({formula}, {order})" if order else f"({formula})"

        return re.sub(rf"({_NAME.pattern})(?!\w|\s*\()('*)", replaced, text) if speeds else text


def _base_of(key: Any) -> tuple[str, int]:
    """Returns the name of a coordinate, speed or function in a key, and the order of its derivative by the time."""
    if isinstance(key, str):
        name = key.replace("′", "'").rstrip("'")
        return name_of(name), len(key) - len(name)
    if hasattr(key, "derivative_count"):
        return (name_of(key.expr), key.derivative_count) if is_rate(key) else (str(key), 0)
    return name_of(key), 0


def _shown(key: Any) -> str:
    """Returns a key as messages show it, such as q' for the rate of q."""
    name, order = _base_of(key)
    return name + "'" * order
