"""The functions of the model language: of numbers, vectors and rotations, and the kinematics of points and bodies."""

from __future__ import annotations

from typing import Any

from .expressions import Condition, Expr, Rotation, Term, call, expr, _Formula, _ATOM


def sin(a: Term) -> Expr:
    """The sine of an angle in radians."""
    return call("sin", a)


def cos(a: Term) -> Expr:
    """The cosine of an angle in radians."""
    return call("cos", a)


def tan(a: Term) -> Expr:
    """The tangent of an angle in radians."""
    return call("tan", a)


def asin(a: Term) -> Expr:
    """The arc sine, in radians."""
    return call("asin", a)


def acos(a: Term) -> Expr:
    """The arc cosine, in radians."""
    return call("acos", a)


def atan(a: Term) -> Expr:
    """The arc tangent, in radians."""
    return call("atan", a)


def sinh(a: Term) -> Expr:
    """The hyperbolic sine."""
    return call("sinh", a)


def cosh(a: Term) -> Expr:
    """The hyperbolic cosine."""
    return call("cosh", a)


def tanh(a: Term) -> Expr:
    """The hyperbolic tangent."""
    return call("tanh", a)


def asinh(a: Term) -> Expr:
    """The inverse of the hyperbolic sine."""
    return call("asinh", a)


def acosh(a: Term) -> Expr:
    """The inverse of the hyperbolic cosine."""
    return call("acosh", a)


def atanh(a: Term) -> Expr:
    """The inverse of the hyperbolic tangent."""
    return call("atanh", a)


def exp(a: Term) -> Expr:
    """The exponential function."""
    return call("exp", a)


def log(a: Term) -> Expr:
    """The natural logarithm."""
    return call("log", a)


def sqrt(a: Term) -> Expr:
    """The square root."""
    return call("sqrt", a)


def sign(a: Term) -> Expr:
    """The sign of a number: 1, -1, or 0 at 0."""
    return call("sign", a)


def atan2(y: Term, x: Term) -> Expr:
    """The angle of the direction (x, y), in radians."""
    return call("atan2", y, x)


def minimum(a: Term, b: Term) -> Expr:
    """The smaller one of two numbers."""
    return call("min", a, b)


def maximum(a: Term, b: Term) -> Expr:
    """The larger one of two numbers."""
    return call("max", a, b)


def piecewise(*cases: Any) -> Expr:
    """``piecewise((condition, value), …, otherwise)``: the value of the first condition that holds.

    Raises:
        TypeError: the last argument is a case, so the value otherwise is missing.
    """
    if not cases or isinstance(cases[-1], tuple):
        raise TypeError("piecewise((condition, value), …, otherwise) ends with the value where no condition holds")
    parts: list[str] = []
    for condition, value in cases[:-1]:
        parts += [condition.text if isinstance(condition, Condition) else str(condition), expr(value).text]
    return _Formula(f"piecewise({', '.join([*parts, expr(cases[-1]).text])})", _ATOM, ("piecewise",))


def choose(k: Term, *values: Term) -> Expr:
    """The k-th value, with k rounded."""
    return call("choose", k, *values)


def dot(a: Term, b: Term) -> Expr:
    """The scalar product of two vectors, which ``a @ b`` is, too."""
    return call("dot", a, b)


def cross(a: Term, b: Term) -> Expr:
    """The vector product of two vectors."""
    return call("cross", a, b)


def norm(a: Term) -> Expr:
    """The length of a vector."""
    return call("norm", a)


def norm2(a: Term) -> Expr:
    """The square of the length of a vector."""
    return call("norm2", a)


def unit(a: Term) -> Expr:
    """The vector of length 1 in the direction of a."""
    return call("unit", a)


def _rotation(function: str, *arguments: object) -> Rotation:
    made = call(function, *arguments)
    return Rotation(made.text, _ATOM, ("rotation",))


def rotx(angle: Term) -> Rotation:
    """The rotation by an angle in radians about x."""
    return _rotation("rotx", angle)


def roty(angle: Term) -> Rotation:
    """The rotation by an angle in radians about y."""
    return _rotation("roty", angle)


def rotz(angle: Term) -> Rotation:
    """The rotation by an angle in radians about z."""
    return _rotation("rotz", angle)


def rot(axis: Term, angle: Term) -> Rotation:
    """The rotation by an angle in radians about a vector of any length but 0."""
    return _rotation("rot", axis, angle)


def quat(e0: Term, e1: Term, e2: Term, e3: Term) -> Rotation:
    """The rotation of a quaternion, scalar first."""
    return _rotation("quat", e0, e1, e2, e3)


def euler(axes: str, a: Term, b: Term, c: Term) -> Rotation:
    """The rotation by Euler angles in radians: three turns, for example ``"zxz"``, each about an axis that the turns before have moved."""
    return _rotation("euler", expr(axes), a, b, c)


def vel(point: Term, seen_from: Term | None = None) -> Expr:
    """The velocity of a point relative to the observer, or as seen from a body or ``"inertial"``."""
    return call("vel", point) if seen_from is None else call("vel", point, seen_from)


def acc(point: Term, seen_from: Term | None = None) -> Expr:
    """The acceleration of a point relative to the observer, or ``"inertial"``."""
    return call("acc", point) if seen_from is None else call("acc", point, seen_from)


def angvel(body: Term, seen_from: Term | None = None) -> Expr:
    """The angular velocity of a body or frame relative to the observer, or as seen from another one."""
    return call("angvel", body) if seen_from is None else call("angvel", body, seen_from)
