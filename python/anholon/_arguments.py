"""What the functions of :class:`Dynamics` take as times, states, inputs and parameters, read as float64."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, SupportsFloat, Union

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


Values = Union["npt.ArrayLike", Mapping[str, "npt.ArrayLike"], None]
"""Inputs or parameters: an array in their order, values by name (the others keep theirs), or None for those of the model. A
Series of pandas whose labels are texts has values by name."""


def time_of(t: object) -> float:
    """The time as a float. Raises TypeError if it is no number."""
    if type(t) is float:
        return t
    refuse_dates("t", t)
    if not isinstance(t, SupportsFloat) or getattr(t, "ndim", 0) != 0:
        raise TypeError(f"t is a number, the time in s, not a {type(t).__name__}; the states follow: f(t, x)")
    return float(t)


def refuse_dates(name: str, value: Any) -> None:
    """Raises TypeError for a date or a duration of NumPy, which would count in units of its own."""
    if getattr(getattr(value, "dtype", None), "kind", "") in ("m", "M"):
        raise TypeError(f"{name} is a number in SI units, a time in s, not a {value.dtype.name.partition('[')[0]}")


def labelled_values(values: Any) -> dict[str, Any] | None:
    """Values by name: of a mapping, or of a Series of pandas whose labels are texts; None of all else, whose values have an order."""
    if isinstance(values, Mapping):
        return dict(values)
    index = getattr(values, "index", None)
    if index is None or callable(index) or not hasattr(values, "iloc"):
        return None
    labels = list(index)
    if not labels or not all(isinstance(label, str) for label in labels):
        return None
    found: dict[str, Any] = {}
    for k, label in enumerate(labels):
        if label in found:
            raise ValueError(f"two values have the label {label!r}")
        found[label] = values.iloc[k]
    return found


def number_of(name: str, value: object) -> float:
    """A value as a float. Raises TypeError if it is no number."""
    refuse_dates(name, value)
    if not isinstance(value, SupportsFloat) or getattr(value, "ndim", 0) != 0:
        raise TypeError(f"{name} is a number in SI units, not {value!r:.60}")
    return float(value)


def numbers_of(name: str, values: object) -> Array:
    """An array of float64. Raises TypeError if there are other things than numbers."""
    import numpy as np

    if values is None or isinstance(values, (str, Mapping)):
        raise TypeError(f"{name} is a number or an array of numbers, not {'None' if values is None else f'a {type(values).__name__}'}")
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "fiub":
        found = np.asarray(values)
        if found.dtype.kind not in "fiubO" or any(x is None or isinstance(x, str) for x in (found.flat if found.dtype.kind == "O" else ())):
            raise TypeError(f"{name} is an array of numbers in SI units, not {values!r:.60}")
    return np.ascontiguousarray(values, dtype=np.float64)


def takes_numbers(out: Array, x: Array) -> bool:
    """Whether the core can write to `out` itself. Raises TypeError or ValueError if no rates of x can be put there."""
    import numpy as np

    if not isinstance(out, np.ndarray) or out.dtype != np.float64:
        kind = f"an array of {out.dtype}" if isinstance(out, np.ndarray) else f"a {type(out).__name__}"
        raise TypeError(f"out is {kind}; it has to be an array of float64")
    if out.shape != x.shape:
        raise ValueError(f"out has the shape {out.shape}; it has to be that of x, {x.shape}")
    if not out.flags.writeable:
        raise ValueError("out cannot be written to")
    return out.flags.carray and not np.may_share_memory(out, x)


def in_order(labelled: Mapping[str, Any], names: list[str], usual: Callable[[], Array], what: str) -> Array:
    """Values by name as rows in the order of `names`; those left out have their usual ones. Raises KeyError for another name."""
    import numpy as np

    for name in labelled:
        if name not in names:
            raise KeyError(f"there is no {name!r} in {what}; there are {', '.join(names) or 'none'}")
    own = usual()
    rows = [
        numbers_of(f"{what}[{name!r}]", labelled[name]).reshape(np.shape(labelled[name])) if name in labelled else own[i]
        for i, name in enumerate(names)
    ]
    return np.stack(np.broadcast_arrays(*rows)) if rows else np.empty(0)


def array_of_values(given: object, count: int, what: str, shape: tuple[int, ...]) -> Array:
    """One set of numbers, shape (count,), or one for each state of a batch of this shape. Raises TypeError, ValueError."""
    array = numbers_of(what, given)
    if array.shape[:1] != (count,) or array.shape[1:] not in ((), shape):
        raise ValueError(f"{what} has the shape {array.shape}; it has to be {(count,)}" + (f" or {(count, *shape)}" if shape else ""))
    return array
