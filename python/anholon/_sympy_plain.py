"""Expressions of SymPy in the form in which the import reads them: entries of matrices as symbols, derivatives worked out, all symbols real."""

from __future__ import annotations

import importlib
import re
from typing import Any


def sympy_module() -> Any:
    return importlib.import_module("sympy")


def mechanics_module() -> Any:
    return importlib.import_module("sympy.physics.mechanics")


def real(e: Any) -> Any:
    """Returns an expression without re, im and conjugate, as all symbols and functions of time are real. SymPy brings them in when it
    differentiates Abs(x)."""
    sm = sympy_module()
    if not e.has(sm.re, sm.im, sm.conjugate):
        return e
    plain = e.replace(lambda z: isinstance(z, (sm.re, sm.conjugate)), lambda z: z.args[0]).replace(sm.im, lambda _: sm.Integer(0))
    return plain.doit()


def symbol_of(e: Any) -> Any:
    """Returns the symbol that stands for an entry of a MatrixSymbol or an IndexedBase with constant indices, such as K[0, 1]; any other
    object stays."""
    sm = sympy_module()
    entry = sm.matrices.expressions.matexpr.MatrixElement
    if not isinstance(e, (entry, sm.Indexed)) or isinstance(e, entry) and not isinstance(e.parent, sm.MatrixSymbol):
        return e
    return sm.Symbol(str(e), **e.assumptions0) if all(k.is_Integer for k in e.args[1:]) else e


def is_rate(d: Any) -> bool:
    """True if a derivative is one by the time, of any order, of a function of the time."""
    sm, time = sympy_module(), mechanics_module().dynamicsymbols._t
    return isinstance(d.expr, sm.core.function.AppliedUndef) and d.expr.args == (time,) and set(d.variables) == {time}


def plain(e: Any) -> Any:
    """Returns an expression with symbols for entries of matrices, with derivatives worked out and without re, im and conjugate."""
    sm = sympy_module()
    entry = (sm.matrices.expressions.matexpr.MatrixElement, sm.Indexed)
    e = sm.sympify(e)
    parts = e.atoms(*entry, sm.Derivative, sm.re, sm.im, sm.conjugate)
    entries = {x: symbol_of(x) for x in parts if isinstance(x, entry)}
    if entries:
        e = e.xreplace(entries)
    if not all(is_rate(d) for d in parts if isinstance(d, sm.Derivative)):
        e = e.replace(lambda d: isinstance(d, sm.Derivative) and not is_rate(d), lambda d: d.doit())
    return real(e) if any(not isinstance(x, entry) for x in parts) else e


def name_of(key: Any) -> str:
    """Returns the name of a symbol or of a function of time, without its argument; a text stays. The indices of entries stand behind
    commas with blanks."""
    key = symbol_of(key)
    applied = hasattr(key, "args") and not hasattr(key, "mro")  # the function F, without an argument, is a class
    name = str(key.func) if applied and key.args else str(key)
    return re.sub(r"\s*,\s*", ", ", name) if "[" in name else name


def is_other_time(symbol: Any) -> bool:
    """True if a symbol has the name of the time but other assumptions, so that SymPy takes it for a constant."""
    sm, time = sympy_module(), mechanics_module().dynamicsymbols._t
    return isinstance(symbol, sm.Symbol) and symbol.name == time.name and symbol != time


def not_the_time(symbol: Any) -> str:
    """Returns the beginning of a message about a symbol that has the name of the time."""
    sm, time = sympy_module(), mechanics_module().dynamicsymbols._t
    return f"{sm.srepr(symbol)} is not the time, which is me.dynamicsymbols._t = {sm.srepr(time)}"
