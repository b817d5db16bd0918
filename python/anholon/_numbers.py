"""Numbers as the texts that the library takes: exact decimals, fractions or formulas with units."""

from __future__ import annotations

import math
import numbers
import re
from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Union

from ._names import by_spelled_names

if TYPE_CHECKING:
    import numpy as np

Number = Union[int, float, str, Fraction, Decimal, "np.floating[Any]", "np.integer[Any]"]
"""A number: an ``int``, ``Fraction`` or ``Decimal`` is exact; a ``float`` stands for the decimal that Python prints, so
0.1 is 1/10, as in a model file; a ``str`` is a formula with an optional unit: ``"pi/2"``, ``"30 deg"``, ``"8 cm"``."""


def text_of(number: Number) -> str:
    """Returns the text of a number or of an array without axes. Raises TypeError if it is no number, ValueError for infinity and NaN."""
    if type(number).__module__ == "numpy" and getattr(number, "shape", None) == ():
        kind = number.dtype  # type: ignore[union-attr]
        if kind.kind in "mM":  # item() would return a count in their unit
            raise TypeError(f"a number is an int, float, Fraction, Decimal or str, not a {kind.name.partition('[')[0]}: a time is given in s")
        if kind.kind == "f" and kind.itemsize < 8 and math.isfinite(number):  # type: ignore[arg-type]
            return str(number)  # the decimal that Python prints for a float32
        if not isinstance(number, numbers.Number):
            number = number.item()  # type: ignore[union-attr]
    if isinstance(number, str):
        return number
    if isinstance(number, bool):
        raise TypeError("a truth value is not a number")
    if isinstance(number, numbers.Integral):
        return str(int(number))
    if isinstance(number, (Fraction, Decimal)):
        if not math.isfinite(number):
            raise ValueError(f"{number} is not a finite number")
        return str(number)
    if isinstance(number, numbers.Real):
        value = float(number)
        if not math.isfinite(value):
            raise ValueError(f"{value} is not a finite number")
        return repr(value)
    raise TypeError(f"a number is an int, float, Fraction, Decimal or str, not {type(number).__name__}")


def texts_of(values: Mapping[str, Number] | None) -> dict[str, str]:
    """Returns the texts of values by name, by their spelled names.

    Raises:
        TypeError: `values` is no mapping of names to numbers.
        ModelError: two of the names have the same spelled name, for example "μ" and "mu".
    """
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise TypeError(f"values are given by name, as {{'theta': 1.3}}, not as a {type(values).__name__}")
    for name, value in values.items():
        if not isinstance(name, str):
            raise TypeError(f"a name is a str, such as 'theta', not a {type(name).__name__}")
        try:
            text_of(value)
        except (TypeError, ValueError) as mistake:
            raise type(mistake)(f"{name}: {mistake}") from None
    return {name: text_of(value) for name, value in by_spelled_names(values, "the values").items()}


def whole(name: str, number: object, least: int, most: int = 2**63 - 1) -> int:
    """Returns a whole number that is at least `least` and at most `most`.

    Raises:
        TypeError: `number` is no whole number.
        ValueError: `number` is below `least` or above `most`.
    """
    if isinstance(number, bool) or not isinstance(number, numbers.Integral):
        raise TypeError(f"{name} is a whole number, not {number!r:.60}")
    value = int(number)
    if value < least:
        raise ValueError(f"{name} is {least} or more, not {value}")
    if value > most:
        raise ValueError(f"{name} is {most} or less, not {value}")
    return value


def float_of(text: str | None) -> float | None:
    """Returns the value of a text that is a decimal or a fraction, and None for a formula."""
    try:
        return None if text is None else float(Fraction(text))
    except (ValueError, ZeroDivisionError):
        return None


def list_of(values: Number | Iterable[Number]) -> list[str]:
    """Returns the texts of the numbers in a list, in an array or in a text with commas (``"0.4, 0.5"``), or that of one number."""
    if isinstance(values, str):
        # A comma within parentheses belongs to a function.
        return [text.strip() for text in re.split(r",(?![^(]*\))", values)]
    kind: Any = getattr(values, "dtype", None)
    if getattr(kind, "kind", "") == "f" and getattr(kind, "itemsize", 8) < 8:
        import numpy as np

        values = np.asarray(values)  # iterating over a Series of float32 gives floats, whose decimals are longer
    several = isinstance(values, Iterable) and getattr(values, "ndim", 1) != 0  # an array of no axes is one number
    return [text_of(value) for value in values] if several else [text_of(values)]  # type: ignore[union-attr, arg-type]


def varied_list(name: object, values: Number | Iterable[Number]) -> list[str]:
    """Returns the texts of the values that a sweep varies. Raises TypeError or ValueError with the name if a value is no number."""
    try:
        return list_of(values)
    except (TypeError, ValueError) as mistake:
        raise type(mistake)(f"{name}: {mistake}") from None


def exact_numbers(texts: Sequence[str]) -> list[Any]:
    """Returns numbers with all digits of their texts: ``mpmath.mpf`` if mpmath is installed, else the texts."""
    try:
        import mpmath
    except ImportError:
        return list(texts)
    with mpmath.workdps(max(len(text) for text in texts) if texts else 15):
        return [mpmath.mpf(text) for text in texts]


def spaced(low: Number, high: Number, n: int) -> list[str]:
    """Returns n equally spaced values from low to high, as exact fractions. Raises ValueError if an end is no decimal or fraction."""
    ends = text_of(low), text_of(high)
    try:
        first, last = Fraction(ends[0]), Fraction(ends[1])
    except ValueError:
        raise ValueError(f"{low!r} and {high!r} have to be decimals or fractions; give a list of other values") from None
    return [str(first + (last - first) * k / (n - 1)) for k in range(n)]
