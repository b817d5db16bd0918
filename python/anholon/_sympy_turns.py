"""Orientations of frames of ``sympy.physics.mechanics`` as rotations of a model file.

A matrix of Floats is a rotation up to rounding errors. It is replaced by turns about axes, which are exact rotations.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

from ._sympy_parts import numeric
from ._sympy_plain import plain, sympy_module

Formula = Callable[[Any], str]


def orientation(turn: Any, factors: list[Any], formula: Formula) -> str:
    """Returns the formula of the rotation `turn`, which is the product of the factors."""
    sm = sympy_module()
    if not turn.has(sm.Float):
        return _matrix(turn, formula)
    made = [_turns(f, formula) if f.has(sm.Float) else _matrix(f, formula) for f in factors]
    return "*".join(filter(None, made)) or _matrix(sm.eye(3), formula)


def factors_between(frame: Any, other: Any) -> list[Any]:
    """Returns the rotations along the chain of frames from `frame` to `other`; their product is the rotation between the two."""
    before: dict[Any, Any] = {frame: None}
    queue = [frame]
    while queue and other not in before:
        here = queue.pop(0)
        for there in here._dcm_dict:
            if there not in before:
                before[there] = here
                queue.append(there)
    found: list[Any] = []
    while before.get(other) is not None:
        found.insert(0, before[other]._dcm_dict[other].applyfunc(plain))
        other = before[other]
    return found


def _matrix(turn: Any, formula: Formula) -> str:
    rows = ["[" + ", ".join(formula(x) for x in row) + "]" for row in turn.tolist()]
    return "matrix([" + ", ".join(rows) + "])"


def _turns(factor: Any, formula: Formula) -> str:
    """Returns a rotation of Floats as a product of turns about fixed axes; as a matrix if there is no such product."""
    sm = sympy_module()
    angles = sorted({a.args[0] for a in factor.atoms(sm.sin, sm.cos) if a.args[0].free_symbols}, key=str)
    dummies = {a: sm.Dummy() for a in angles}
    left, made = factor.replace(lambda e: isinstance(e, (sm.sin, sm.cos)) and e.args[0] in dummies, lambda e: e.func(dummies[e.args[0]])), []
    while dummies:
        found = next(((a, axis) for a, d in dummies.items() if (axis := _axis(left, d, list(dummies.values()))) is not None), None)
        if found is None:
            return _matrix(factor, formula)
        made.append(_turn(found[1], formula(found[0])))
        left = left.subs(dummies.pop(found[0]), 0)
    if left.free_symbols:
        return _matrix(factor, formula)
    return "*".join([*made, *_constant(left)])


def _axis(rotation: Any, angle: Any, angles: list[Any]) -> list[Any] | None:
    """Returns the fixed axis about which a rotation turns with one of its angles, as the first factor; None if there is no such axis."""
    import mpmath

    draw, found = random.Random(8), []
    if rotation.free_symbols - set(angles):
        return None
    with mpmath.workdps(30):
        f = numeric(angles, [rotation.diff(angle), rotation])
        for _ in range(3):
            slope, value = f(*(mpmath.mpf(draw.uniform(-1, 1)) for _ in angles))
            spin = slope * value.T
            found.append([spin[2, 1], spin[0, 2], spin[1, 0]])
        first = found[0]
        if any(abs(a - b) > 1e-12 for other in found for a, b in zip(first, other, strict=True)) or abs(mpmath.norm(first) - 1) > 1e-12:
            return None
    return first


def _constant(rotation: Any) -> list[str]:
    """Returns a constant rotation as a turn, computed by its quaternion; an empty list for the unit matrix."""
    import mpmath

    with mpmath.workdps(30):
        m = mpmath.matrix([[mpmath.mpf(str(x.evalf(25))) for x in row] for row in rotation.tolist()])
        four = [[1 + m[0, 0] + m[1, 1] + m[2, 2], m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1]]]
        for k in range(3):
            i, j = (k + 1) % 3, (k + 2) % 3
            row = [m[j, i] - m[i, j], 0, 0, 0]
            row[1 + k], row[1 + i], row[1 + j] = 1 + m[k, k] - m[i, i] - m[j, j], m[i, k] + m[k, i], m[j, k] + m[k, j]
            four.append(row)
        scalar, *axis = max(four, key=mpmath.norm)
        length = mpmath.norm(axis)
        angle = 2 * mpmath.atan2(length, scalar)
        return [] if abs(angle) < 1e-15 else [_turn(axis, _decimal(angle))]


def _turn(axis: list[Any], angle: str) -> str:
    """Returns the formula of a turn about an axis, scaled so that its largest component is 1."""
    largest = max(axis, key=abs)
    if largest < 0:
        axis, largest, angle = [-x for x in axis], -largest, f"-({angle})"
    parts = [(_decimal(x / largest), e) for x, e in zip(axis, ("ex", "ey", "ez"), strict=True) if abs(x / largest) > 1e-15]
    along = " + ".join(e if x == "1" else f"({x})*{e}" for x, e in parts)
    return f"rot({along}, {angle})"


def _decimal(x: Any) -> str:
    """Returns a number rounded to the 15 digits of a Float: 0.3 for 0.29999999999999999."""
    import mpmath

    text = repr(float(str(mpmath.nstr(x, 15))))
    return text.removesuffix(".0")
