"""Formulas and names of a model file for expressions and symbols of SymPy."""

from __future__ import annotations

import re
from typing import Any

from ._errors import ModelError
from ._numbers import text_of
from ._sympy_parts import mechanics_module, Parts, sympy_module

RESERVED = {"t", "pi", "ex", "ey", "ez", "e", "i", "D", "lambda"}


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
        """A name that is not taken yet."""
        name = re.sub(r"\W+", "_", wish).strip("_") or "s"
        if name[0].isdigit() or name in self._taken:
            name = "s_" + name
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name

    def formula(self, e: Any) -> str:
        """The formula of an expression in coordinates, rates, parameters and the time."""
        sm = self._sm
        e = sm.sympify(e)
        if e in self.names:
            return self.names[e]
        if isinstance(e, sm.Derivative):
            inner, (variable, order) = e.args[0], e.args[1]
            if inner in self.names and variable == self.time:
                return self.names[inner] + "'" * int(order)
            raise ModelError(f"the derivative {e} is not one of a coordinate by the time")
        if e == self.time:
            return "t"
        if e is sm.pi:
            return "pi"
        if e is sm.E:
            return "exp(1)"
        if e.is_Integer:
            return f"({int(e)})" if int(e) < 0 else str(int(e))
        if e.is_Rational:
            return f"({e.p}/{e.q})"
        if e.is_Float:
            return f"({text_of(float(e))})"
        if isinstance(e, sm.Symbol):
            return self.parameters.get(e) or self._parameter(e)
        if isinstance(e, sm.core.function.AppliedUndef):
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
        known = {sm.Abs: "abs", sm.log: "log", sm.sign: "sign"}
        function = known.get(e.func, str(e.func))
        return f"{function}({', '.join(self.formula(x) for x in e.args)})"

    def _parameter(self, symbol: Any) -> str:
        self.parameters[symbol] = name = self.new(symbol.name)
        return name


def name_of(key: Any) -> str:
    """The name of a symbol, of a function of time without its argument, or a name itself."""
    return str(key.func) if getattr(key, "args", ()) else str(key)
