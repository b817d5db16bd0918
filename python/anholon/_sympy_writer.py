"""Formulas and names of a model file for expressions and symbols of SymPy."""

from __future__ import annotations

import re
import unicodedata
from typing import Any

from ._errors import ModelError
from ._numbers import text_of
from ._sympy_parts import Parts
from ._sympy_plain import is_other_time, mechanics_module, not_the_time, symbol_of, sympy_module

_SAME = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "log", "sign"}
_RECIPROCAL = {"cot": "tan", "sec": "cos", "csc": "sin", "coth": "tanh", "sech": "cosh", "csch": "sinh"}
_OF_RECIPROCAL = {"acot": "atan", "asec": "acos", "acsc": "asin", "acoth": "atanh", "asech": "acosh", "acsch": "asinh"}
_OTHER_NAMES = {"Abs": "abs", "Max": "max", "Min": "min"}

RESERVED = {"t", "pi", "ex", "ey", "ez", "e", "i", "D", "lambda", "here", "inertial"}


def _in_ascii(letter: str) -> str:
    """Returns a letter in ASCII: theta for θ, e for é. Letters without such a form stay; names of a model cannot hold them."""
    greek = re.fullmatch(r"GREEK (SMALL|CAPITAL) LETTER (?:FINAL )?([A-Z]+)", unicodedata.name(letter, ""))
    if greek:
        return greek[2].lower() if greek[1] == "SMALL" else greek[2].capitalize()
    plain = unicodedata.normalize("NFKD", letter)[0]
    return plain if plain.isascii() and plain.isalnum() else letter


class Writer:
    """Writes expressions of SymPy as formulas of a model file, and gives every symbol a name."""

    def __init__(self, parts: Parts) -> None:
        sm, dynamicsymbols = sympy_module(), mechanics_module().dynamicsymbols

        self._sm = sm
        self.time = dynamicsymbols._t
        self.names: dict[Any, str] = {}
        self._taken = set(RESERVED)
        self.parameters: dict[Any, str] = {}
        self.functions: dict[Any, str] = {}
        self.q: list[Any] = []
        self.rates: list[Any] = []
        for q in parts.q:
            self.add(q)

    def add(self, q: Any) -> None:
        """Names a coordinate."""
        self.names[q] = self.new(str(q.func))
        self.q.append(q)
        self.rates.append(q.diff(self.time))

    def new(self, wish: str) -> str:
        """Returns a name that is not taken yet, similar to `wish`."""
        name = re.sub(r"\W+", "_", "".join(map(_in_ascii, wish)), flags=re.ASCII).strip("_") or "s"
        if name[0].isdigit() or name in self._taken:
            name = "s_" + name
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name

    def formula(self, e: Any, place: str = "") -> str:
        """Returns the formula of an expression in coordinates, rates, parameters and the time. Errors name the place, if it is given."""
        sm = self._sm
        if place:
            try:
                return self.formula(e)
            except ModelError as mistake:
                raise ModelError(f"{place}: {mistake}") from None
        e = symbol_of(sm.sympify(e))
        if e in self.names:
            return self.names[e]
        if isinstance(e, sm.Derivative):
            inner, (variable, order) = e.args[0], e.args[1]
            if len(e.args) == 2 and variable == self.time and (inner in self.names or inner.args == (self.time,)):
                return self.formula(inner) + "'" * int(order)
            if (worked := e.doit()) != e:
                return self.formula(worked)
            raise ModelError(f"the derivative {e} is not one by the time of a coordinate or a given function\nhint: put a formula in its place")
        if e == self.time:
            return "t"
        if e is sm.pi:
            return "pi"
        if e is sm.E:
            return "exp(1)"
        if e is sm.GoldenRatio:
            return "((1 + sqrt(5))/2)"
        if e.is_NumberSymbol:
            return f"({e.evalf(40)})"
        if e.has(sm.nan, sm.zoo, sm.oo, -sm.oo) or e is sm.I:
            raise ModelError(f"{e} is no real number\nhint: formulas of a model have finite real numbers alone")
        if e.is_Integer:
            return f"({int(e)})" if int(e) < 0 else str(int(e))
        if e.is_Rational:
            return f"({e.p}/{e.q})"
        if e.is_Float:
            return f"({text_of(float(e))})"
        if isinstance(e, sm.Symbol):
            return self.parameters.get(e) or self._parameter(e)
        if isinstance(e, sm.core.function.AppliedUndef):
            if any(map(is_other_time, e.free_symbols)):
                other = next(filter(is_other_time, e.free_symbols))
                raise ModelError(f"{e} is no function of the time: {not_the_time(other)}\nhint: put me.dynamicsymbols._t in its place in the system")
            if e.args != (self.time,):
                why = ", as delays have no counterpart in a model" if not any(x.atoms(sm.core.function.AppliedUndef) for x in e.args) else ""
                raise ModelError(
                    f"{e} is no function of the time {self.time} alone\n"
                    f"hint: a given function has the argument {self.time}; put a formula in the place of {e}{why}"
                )
            if e not in self.functions:
                self.functions[e] = self.new(str(e.func))
            return self.functions[e]
        if e.is_Add:
            return "(" + " + ".join(self.formula(x) for x in e.args) + ")"
        if e.is_Mul:
            return "(" + "*".join(self.formula(x) for x in e.args) + ")"
        if e.is_Pow:
            base, exponent = e.as_base_exp()
            return f"sqrt({self.formula(base)})" if exponent == sm.Rational(1, 2) else f"({self.formula(base)})^({self.formula(exponent)})"
        return self._function(e)

    def _function(self, e: Any) -> str:
        """Returns the formula of a function of SymPy."""
        sm, name = self._sm, e.func.__name__
        if isinstance(e, sm.Piecewise):
            return self._piecewise(e)
        if isinstance(e, sm.Heaviside):
            return self._where(e.args[0] > 0, "1", self._where(e.args[0] < 0, "0", self.formula(e.args[1])))
        if name in ("re", "conjugate"):
            return self.formula(e.args[0])
        if name == "im":
            return "0"
        if name not in _SAME | _OTHER_NAMES.keys() | _RECIPROCAL.keys() | _OF_RECIPROCAL.keys():
            if (plain := e.doit()) != e:
                return self.formula(plain)  # for example the curves of muscles
            raise ModelError(
                f"{name} in {e} has no counterpart in a model\n"
                "hint: put a formula of elementary functions or Piecewise in its place, or a function of time that is given by values={f: …}"
            )
        arguments = [self.formula(x) for x in e.args]
        if name in ("Max", "Min"):
            made = arguments[0]
            for argument in arguments[1:]:
                made = f"{_OTHER_NAMES[name]}({made}, {argument})"
            return made
        if name in _RECIPROCAL:
            return f"(1/{_RECIPROCAL[name]}({arguments[0]}))"
        if name in _OF_RECIPROCAL:
            return f"{_OF_RECIPROCAL[name]}(1/{arguments[0]})"
        return f"{_OTHER_NAMES.get(name, name)}({', '.join(arguments)})"

    def _piecewise(self, e: Any) -> str:
        """Returns the formula of a Piecewise whose last condition is True."""
        *pieces, (last, otherwise) = e.args
        if otherwise != True:  # noqa: E712
            raise ModelError(f"{e} has no value elsewhere\nhint: let it end with (value, True)")
        made = self.formula(last)
        for value, condition in reversed(pieces):
            made = self._where(condition, self.formula(value), made)
        return made

    def _where(self, condition: Any, value: str, otherwise: str) -> str:
        """Returns the formula that is `value` where the condition holds, else `otherwise`."""
        sm = self._sm
        signs = {sm.StrictGreaterThan: ">", sm.GreaterThan: ">=", sm.StrictLessThan: "<", sm.LessThan: "<="}
        if condition.func in signs:
            return f"piecewise({self.formula(condition.lhs)} {signs[condition.func]} {self.formula(condition.rhs)}, {value}, {otherwise})"
        if isinstance(condition, (sm.And, sm.Or)):
            first, *others = condition.args
            rest = self._where(condition.func(*others), value, otherwise)
            return self._where(first, rest, otherwise) if isinstance(condition, sm.And) else self._where(first, value, rest)
        if condition in (sm.true, sm.false):
            return value if condition == sm.true else otherwise
        if isinstance(condition, sm.Ne):
            above, below = condition.lhs > condition.rhs, condition.lhs < condition.rhs
            return self._where(above, value, self._where(below, value, otherwise))
        if isinstance(condition, sm.Not):
            return self._where(condition.args[0], otherwise, value)
        if isinstance(condition, sm.Xor):
            first, *others = condition.args
            rest = sm.Xor(*others)
            return self._where(first, self._where(rest, otherwise, value), self._where(rest, value, otherwise))
        raise ModelError(f"the condition {condition} is none of >, >=, < and <=\nhint: compare two formulas; And and Or join comparisons")

    def _parameter(self, symbol: Any) -> str:
        self.parameters[symbol] = name = self.new(symbol.name)
        return name
