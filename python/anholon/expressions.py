"""Formulas of a model as Python expressions, for :class:`Builder`.

An expression holds its text in the model language, and that text goes into the model. ``x.dt`` is a derivative by time,
``a == b`` an equation, ``a > b`` a condition. Numbers are exact: a ``float`` stands for the decimal that Python prints, an
``int``, a ``Fraction`` or a ``Decimal`` for its value. A text is a formula of the model language and may stand in place of an
expression.
"""

from __future__ import annotations

import importlib
import operator
import sys
from collections.abc import Sequence
from fractions import Fraction
from typing import Any, Union

from ._numbers import Number, text_of, whole

_SUM, _PRODUCT, _POWER, _ATOM = range(1, 5)

# NumPy's names of the operators of Python (_OPERATORS) and of functions of this package (_AS_HERE).
_OPERATORS = {"add": "add", "subtract": "sub", "multiply": "mul", "divide": "truediv", "true_divide": "truediv", "power": "pow", "float_power": "pow"}
_OPERATORS |= {"less": "lt", "less_equal": "le", "greater": "gt", "greater_equal": "ge", "equal": "eq", "not_equal": "ne", "matmul": "matmul"}
_AS_HERE = {f"arc{name}": f"an.a{name}" for name in ("sin", "cos", "tan", "tan2", "sinh", "cosh", "tanh")}
_AS_HERE |= {"absolute": "abs(…)", "minimum": "an.minimum", "maximum": "an.maximum", "where": "an.piecewise"}


def _as_given(base: Any) -> Any:
    """Returns the base of a power as the user wrote it. Before Python 3.12 Fraction.__pow__ passes its base on as a float; the frame of
    that method holds the Fraction."""
    frame = sys._getframe(2)
    return frame.f_locals["a"] if isinstance(base, float) and frame.f_code is _POWER_OF_FRACTION else base


_POWER_OF_FRACTION = Fraction.__pow__.__code__


class Expr:
    """A formula whose value is a number, a vector or a rotation. It is made of names of a :class:`Builder`, of numbers and of functions.

    Example:
        >>> import anholon as an
        >>> b = an.Builder("a bead")
        >>> x, y = b.coordinates("x y")
        >>> print(x.dt**2 / 2 + 0.1 * an.sin(y), x.d(3), x == y**2)
        x'^2/2 + 0.1*sin(y) D(x, 3) x = y^2
    """

    __slots__ = ("_strength", "_tree", "text")

    def __init__(self, text: str, strength: int = _ATOM, tree: tuple[Any, ...] = ()) -> None:
        self.text: str = text
        self._strength = strength
        self._tree = tree  # the operation with its operands, for SymPy

    # ---- arithmetic ----

    def __add__(self, other: Term) -> Expr:
        b = expr(other)
        if b._tree[:1] == ("neg",) or (b._tree[:1] == ("number",) and b.text.startswith("-")):
            return self - -b
        return _Formula(f"{self.text} + {b._inside(_SUM)}", _SUM, ("+", self, b))

    def __radd__(self, other: Term) -> Expr:
        return expr(other) + self

    def __sub__(self, other: Term) -> Expr:
        b = expr(other)
        return _Formula(f"{self.text} - {b._inside(_PRODUCT)}", _SUM, ("-", self, b))

    def __rsub__(self, other: Term) -> Expr:
        return expr(other) - self

    def __mul__(self, other: Term) -> Expr:
        b = expr(other)
        return _Formula(f"{self._inside(_PRODUCT)}*{b._inside(_POWER)}", _PRODUCT, ("*", self, b))

    def __rmul__(self, other: Term) -> Expr:
        return expr(other) * self

    def __truediv__(self, other: Term) -> Expr:
        b = expr(other)
        return _Formula(f"{self._inside(_PRODUCT)}/{b._inside(_POWER)}", _PRODUCT, ("/", self, b))

    def __rtruediv__(self, other: Term) -> Expr:
        return expr(other) / self

    def __pow__(self, other: Term) -> Expr:
        b = expr(other)
        return _Formula(f"{self._inside(_ATOM)}^{b._inside(_ATOM)}", _POWER, ("^", self, b))

    def __rpow__(self, other: Term) -> Expr:
        return expr(_as_given(other)) ** self

    def __neg__(self) -> Expr:
        if self._tree[:1] == ("number",) and self.text.startswith("-"):
            return _Formula(self.text[1:], _PRODUCT if "/" in self.text else _ATOM, ("number", self.text[1:]))
        if self._tree[:1] == ("neg",):
            return self._tree[1]  # type: ignore[no-any-return]
        return _Formula(f"-{self._inside(_PRODUCT)}", _SUM, ("neg", self))

    def __pos__(self) -> Expr:
        return self

    def __abs__(self) -> Expr:
        return call("abs", self)

    def __matmul__(self, other: Term) -> Expr:
        """Returns the scalar product of two vectors, as ``dot`` does."""
        return call("dot", self, other)

    def _inside(self, strength: int) -> str:
        return self.text if self._strength >= strength else f"({self.text})"

    # ---- conversions by Python and NumPy ----

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **more: Any) -> Any:
        """Returns sums, products, powers and comparisons with numbers of NumPy. Raises TypeError for other functions of NumPy."""
        name = str(ufunc.__name__)
        if name in _OPERATORS and method == "__call__" and not more and len(inputs) == 2:
            a, b = (x if isinstance(x, Expr) else expr(x) for x in inputs)
            return getattr(operator, _OPERATORS[name])(a, b)
        here = _AS_HERE.get(name, f"an.{name}" if name in _NUMBERS else "")
        hint = f"write {here}" if here else "functions of formulas are an.sin, an.sqrt, …"
        raise TypeError(f"np.{name} is of numbers, and {self.text} is a formula; {hint}")

    def __float__(self) -> float:
        raise TypeError(f"{self.text} is a formula, not a number; functions of formulas are an.sin, an.sqrt, …, in the place of math.sin, math.sqrt")

    # ---- derivatives, components ----

    @property
    def dt(self) -> Expr:
        """The derivative by time."""
        return self.d(1)

    def d(self, order: int = 1) -> Expr:
        """Returns the derivative by time of this order, 0 … 20.

        Raises:
            TypeError: the order is no whole number.
            ValueError: the order is below 0 or above 20.
        """
        if whole("the order of a derivative", order, 0) > 20:
            raise ValueError(f"the order of a derivative is 20 or less, not {order}")
        if order == 0:
            return self
        of, before = (self._tree[1], self._tree[2]) if self._tree[:1] == ("d",) else (self, 0)
        k = before + order
        text = of.text + "'" * k if k < 3 and of._strength == _ATOM and of._tree[:1] == ("name",) else f"D({of.text}, {k})"
        return _Formula(text, _ATOM, ("d", of, k))

    @property
    def x(self) -> Expr:
        """The component along ex of a vector; the first axis of a frame."""
        return self._component("x")

    @property
    def y(self) -> Expr:
        """The component along ey of a vector; the second axis of a frame."""
        return self._component("y")

    @property
    def z(self) -> Expr:
        """The component along ez of a vector; the third axis of a frame."""
        return self._component("z")

    def _component(self, axis: str) -> Expr:
        return _Formula(f"{self._inside(_ATOM)}.{axis}", _ATOM, ("component", self, axis))

    # ---- equations, conditions ----

    def __eq__(self, other: object) -> Equation:  # type: ignore[override]
        return Equation(self, expr(other))

    def __ne__(self, other: object) -> bool:
        return not isinstance(other, Expr) or self.text != other.text

    def __hash__(self) -> int:
        return hash(self.text)

    def __lt__(self, other: Term) -> Condition:
        return Condition(f"{self.text} < {expr(other).text}")

    def __le__(self, other: Term) -> Condition:
        return Condition(f"{self.text} <= {expr(other).text}")

    def __gt__(self, other: Term) -> Condition:
        return Condition(f"{self.text} > {expr(other).text}")

    def __ge__(self, other: Term) -> Condition:
        return Condition(f"{self.text} >= {expr(other).text}")

    # ---- as text, for SymPy ----

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return self.text

    def _sympy_(self) -> Any:
        """Returns the expression of SymPy. Coordinates, states, inputs and functions of time become dynamicsymbols, parameters
        symbols, and names of :meth:`Builder.define` their formulas.

        Raises:
            TypeError: the expression holds a vector, a rotation, a text, or a function that SymPy does not have.
        """
        return _to_sympy(self)


class _Formula(Expr):
    """A formula whose value is a number or a vector. No class derives from it: Python would swap the sides of ``a == b`` if the class of b
    did."""

    __slots__ = ()

    def __call__(self, *arguments: Any) -> Any:
        """Raises TypeError, as a formula is no function."""
        if self._tree[:1] == ("d",):
            raise TypeError(f"{self.text} is no function: the derivative is written x.dt, without parentheses, or x.d(2)")
        raise TypeError(f"{self.text} is no function; functions and tables of a model are called by an.call({self.text!r}, …)")


class Rotation(Expr):
    """A rotation or a frame. ``R.x``, ``R.y``, ``R.z`` are its axes, ``R(a, b, c)`` is a R.x + b R.y + c R.z."""

    __slots__ = ()

    def __call__(self, a: Term, b: Term, c: Term) -> Expr:
        """Returns the vector with these components along the axes of the rotation."""
        if self._tree[:1] != ("name",):
            return expr(a) * self.x + expr(b) * self.y + expr(c) * self.z
        components = ", ".join(expr(part).text for part in (a, b, c))
        return _Formula(f"{self._inside(_ATOM)}({components})", _ATOM, ("vector",))

    def __mul__(self, other: Term) -> Rotation:
        """Returns the product of two rotations: two turns, the second about axes that the first has turned."""
        product = super().__mul__(other)
        return Rotation(product.text, product._strength, product._tree)


class Place(Expr):
    """A point or a particle."""

    __slots__ = ()

    def vel(self, seen_from: Term | None = None) -> Expr:
        """Returns the velocity of the point relative to the observer, or to a body or ``"inertial"``."""
        return call("vel", self) if seen_from is None else call("vel", self, seen_from)

    def acc(self, seen_from: Term | None = None) -> Expr:
        """Returns the acceleration of the point relative to the observer, or to ``"inertial"``."""
        return call("acc", self) if seen_from is None else call("acc", self, seen_from)


class Body(Rotation):
    """A body. If it has an orientation, it is the frame of its axes, too."""

    __slots__ = ()

    @property
    def center(self) -> Place:
        """The mass centre of the body."""
        return Place(f"{self.text}.center", _ATOM, ("vector",))

    def vel(self, point: Term) -> Expr:
        """Returns the velocity of the material point of the body that is at `point` at the moment."""
        return call("vel", self, point)

    @property
    def angvel(self) -> Expr:
        """The angular velocity of the body relative to the observer."""
        return call("angvel", self)

    @property
    def reaction(self) -> Expr:
        """The force of all constraints on the body, for monitors and events."""
        return call("reaction", self)


class Equation:
    """An equation ``a == b`` of numbers or vectors. Its truth value is True if both sides are the same text, as in SymPy."""

    __slots__ = ("left", "right")

    def __init__(self, left: Expr, right: Expr) -> None:
        self.left: Expr = left
        self.right: Expr = right

    @property
    def text(self) -> str:
        """The equation in the model language, ``"a = b"``."""
        return f"{self.left.text} = {self.right.text}"

    def __bool__(self) -> bool:
        return self.left.text == self.right.text

    def __repr__(self) -> str:
        return self.text

    def _sympy_(self) -> Any:
        return importlib.import_module("sympy").Eq(_to_sympy(self.left), _to_sympy(self.right))


class Condition:
    """A condition such as ``a > b``, for :func:`piecewise`."""

    __slots__ = ("text",)

    def __init__(self, text: str) -> None:
        self.text: str = text

    def __bool__(self) -> bool:
        raise TypeError(f"whether {self.text} holds is known along a motion only; write piecewise(({self.text}, value), otherwise)")

    def __repr__(self) -> str:
        return self.text

    def _joined(self, other: object = None) -> Any:
        raise TypeError(
            f"conditions are not joined; where {self.text} and another one hold is piecewise(({self.text}, piecewise((other, value), otherwise)), otherwise), "
            f"where one of them does piecewise(({self.text}, value), (other, value), otherwise)"
        )

    __and__ = __or__ = __xor__ = __rand__ = __ror__ = __invert__ = _joined


Term = Union[Expr, Number, Sequence[Any]]
"""The arguments that are accepted as an expression: an expression, a number, a text, or three components of a vector."""


def expr(term: object) -> Expr:
    """Returns the expression for a number, a text (a formula of the model language) or the three components of a vector.

    Raises:
        TypeError: a list does not have three components, or `term` is a condition.

    Example:
        >>> import anholon as an
        >>> an.expr("x + 1") * 2, an.expr(0.1), an.expr([1, 0, "h"])
        ((x + 1)*2, 0.1, ex + h*ez)
    """
    if isinstance(term, Expr):
        return term
    if isinstance(term, str):
        return _Formula(term, _ATOM if term.isidentifier() else _SUM, ("text", term))
    if isinstance(term, (list, tuple)):
        if len(term) != 3:
            raise TypeError(f"a vector has three components, not {len(term)}")
        return vector(*term)
    if type(term).__module__.startswith("numpy") and getattr(term, "shape", ()) == (3,):
        return vector(*term.tolist())  # type: ignore[attr-defined]
    if isinstance(term, Condition):
        raise TypeError(f"{term.text!r} is a condition, and a formula is expected here: the difference of the sides, such as x - 1 of x > 1")
    text = text_of(term)  # type: ignore[arg-type]
    strength = _SUM if text.startswith("-") else _PRODUCT if "/" in text else _ATOM
    return _Formula(text, strength, ("number", text))


def call(function: str, *arguments: object) -> Expr:
    """Returns the value of a function of the model language: ``call("sin", x)`` is ``sin(x)``. Calls functions and tables of the
    model, too."""
    given = [expr(argument) for argument in arguments]
    return _Formula(f"{function}({', '.join(a.text for a in given)})", _ATOM, ("call", function, *given))


def vector(x: Term, y: Term, z: Term) -> Expr:
    """Returns the vector x ex + y ey + z ez."""
    parts = [component * axis for component, axis in zip((expr(x), expr(y), expr(z)), (ex, ey, ez), strict=True) if component.text != "0"]
    total = None
    for component, part in zip([c for c in (expr(x), expr(y), expr(z)) if c.text != "0"], parts, strict=True):
        one = part._tree[2] if component.text == "1" else part
        total = one if total is None else total + one
    return _Formula("0", _ATOM, ("vector",)) if total is None else total


def _named(name: str, kind: str = "symbol", *formula: Expr) -> Expr:
    """Returns an expression that is a name. A name of kind "formula" stands for the formula."""
    return _Formula(name, _ATOM, ("name", name, kind, *formula))


t = _named("t", "time")
pi = _named("pi", "pi")
ex, ey, ez = (_named(name, "vector") for name in ("ex", "ey", "ez"))
here = _named("here", "vector")


def _to_sympy(e: Expr) -> Any:
    sm = importlib.import_module("sympy")
    head, *rest = e._tree or ("other",)
    if head == "number":
        value = Fraction(rest[0])
        return sm.Rational(value.numerator, value.denominator)
    if head == "name":
        name, kind, *formula = rest
        if formula:
            return _to_sympy(formula[0])
        if kind == "coordinate":
            return importlib.import_module("sympy.physics.mechanics").dynamicsymbols(name)
        if kind in ("time", "pi"):
            return importlib.import_module("sympy.physics.mechanics").dynamicsymbols._t if kind == "time" else sm.pi
        if kind == "symbol":
            return sm.Symbol(name)
    if head == "neg":
        return -_to_sympy(rest[0])
    if head in ("+", "-", "*", "/", "^"):
        a, b = (_to_sympy(part) for part in rest)
        return a + b if head == "+" else a - b if head == "-" else a * b if head == "*" else a / b if head == "/" else a**b
    if head == "d":
        of, order = _to_sympy(rest[0]), rest[1]
        return of.diff(importlib.import_module("sympy.physics.mechanics").dynamicsymbols._t, order)
    if head == "call":
        names = {"abs": "Abs", "min": "Min", "max": "Max"}
        name = str(rest[0])
        if name in _NUMBERS:
            return getattr(sm, names.get(name, name))(*(_to_sympy(part) for part in rest[1:]))
    raise TypeError(f"{e.text} has no counterpart in SymPy: it is a vector, a rotation, a text, or a function that SymPy does not have")


_NUMBERS = {"sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh", "exp", "log", "sqrt", "abs", "sign", "atan2", "min", "max"}
