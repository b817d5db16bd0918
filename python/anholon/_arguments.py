"""Reads times, states, inputs and parameters, the arguments of the functions of :class:`Dynamics`, as float64."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, SupportsFloat, Union

from ._names import by_spelled_names

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


Values = Union["npt.ArrayLike", Mapping[str, "npt.ArrayLike"], None]
"""Inputs or parameters: an array in their order, some values by name (names left out keep the values of the model), or None for the
values of the model. A Series of pandas whose labels are texts has values by name."""

States = Union["npt.ArrayLike", Mapping[str, "npt.ArrayLike"]]
"""States: an array in their order, or the values of all of them by name. A Series of pandas whose labels are texts has values by name."""


def time_of(t: object) -> float:
    """Returns the time as a float. Raises TypeError if t is no number."""
    if type(t) is float:
        return t
    refuse_dates("t", t)
    if not isinstance(t, SupportsFloat) or getattr(t, "ndim", 0) != 0:
        raise TypeError(f"t is a number, the time in s, not a {type(t).__name__}; the states follow: f(t, x)")
    return float(t)


def refuse_dates(name: str, value: Any) -> None:
    """Raises TypeError for a date or a duration of NumPy, whose numbers count in a unit of its own."""
    if getattr(getattr(value, "dtype", None), "kind", "") in ("m", "M"):
        raise TypeError(f"{name} is a number in SI units, a time in s, not a {value.dtype.name.partition('[')[0]}")


def labelled_values(values: Any) -> dict[str, Any] | None:
    """Returns the values by name of a mapping or of a Series of pandas whose labels are texts, and None for all else."""
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
    """Returns a value as a float. Raises TypeError if the value is no number."""
    refuse_dates(name, value)
    if not isinstance(value, SupportsFloat) or getattr(value, "ndim", 0) != 0:
        raise TypeError(f"{name} is a number in SI units, not {value!r:.60}")
    return float(value)


def without_mask(values: Any) -> Any:
    """Returns a masked array of NumPy as an array of float64 in which masked entries are NaN, and all else as it is."""
    import numpy as np

    if not isinstance(values, np.ma.MaskedArray) or values.dtype.kind not in "fiub":
        return values
    return np.where(np.ma.getmaskarray(values), np.nan, np.ma.getdata(values).astype(np.float64))


def numbers_of(name: str, values: object) -> Array:
    """Returns the values as an array of float64, in which masked entries are NaN. Raises TypeError if one of them is no number."""
    import numpy as np

    values = without_mask(values)
    if values is None or isinstance(values, (str, Mapping)):
        raise TypeError(f"{name} is a number or an array of numbers, not {'None' if values is None else f'a {type(values).__name__}'}")
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "fiub":
        found = np.asarray(values)
        if found.dtype.kind not in "fiubO" or any(x is None or isinstance(x, str) for x in (found.flat if found.dtype.kind == "O" else ())):
            raise TypeError(f"{name} is an array of numbers in SI units, not {values!r:.60}")
    return np.ascontiguousarray(values, dtype=np.float64)


def states_of(given: object, names: list[str]) -> Array:
    """Returns one state, shape (states,), or many, shape (states, …), as an array of float64 in the order of `names`.

    Raises KeyError if values by name are not those of all states, and TypeError if a value is no number.
    """
    labelled = labelled_values(given)
    if labelled is None:
        return numbers_of("x", given)
    labelled = by_spelled_names(labelled, "x")
    absent = [name for name in names if name not in labelled]
    if absent:
        raise KeyError(f"x has no value of {absent[0]!r}; by name it has all states: {', '.join(names)}")
    return in_order(labelled, names, lambda: numbers_of("x", ()), "x")


def takes_numbers(out: Array, x: Array) -> bool:
    """True if the core can write to `out` itself. Raises TypeError or ValueError if `out` cannot hold the rates of x."""
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
    """Returns values by name as rows in the order of `names`; a name left out has its row of `usual()`.

    Raises KeyError for a name that is not among them.
    """
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
    """Returns one set of numbers, shape (count,), or one set for each state of a batch, shape (count, *shape).

    Raises TypeError if a value is no number, and ValueError for another shape.
    """
    array = numbers_of(what, given)
    if array.shape[:1] != (count,) or array.shape[1:] not in ((), shape):
        raise ValueError(f"{what} has the shape {array.shape}; it has to be {(count,)}" + (f" or {(count, *shape)}" if shape else ""))
    return array
