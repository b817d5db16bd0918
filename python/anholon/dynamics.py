"""The equations of a motion as a compiled function."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from . import _core
from ._errors import ModelError

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from .model import Model

    Array = npt.NDArray[np.float64]


class Dynamics:
    """A function f(t, x) -> x' in SI units. Threads may share it; large batches are computed on all cores.

    Example:
        >>> import anholon as an
        >>> f = an.load("chaplygin-sleigh").dynamics()
        >>> x = f.state(q={"x": 0, "y": 0, "th": 0}, qdot={"x'": -0.5, "y'": 0, "th'": 1.5})
        >>> sorted(f.motion(x))[:2]
        ['th', "th'"]
    """

    def __init__(self, model: Model, core: _core.Dynamics) -> None:
        self.model: Model = model
        self._core = core
        self._count = len(core.states)

    @property
    def states(self) -> list[_core.StateName]:
        """What x holds: coordinates, velocities (or independent ones, with their formulas), then the model's states."""
        return self._core.states

    @property
    def minimal(self) -> bool:
        """Whether the velocities are independent ones."""
        return self._core.minimal

    @property
    def t0(self) -> float:
        """The initial time, s."""
        return self._core.start_time

    @property
    def start(self) -> Array:
        """x at the initial state, shape (states,)."""
        import numpy as np

        return np.array(self._core.start)

    def __call__(self, t: float, x: npt.ArrayLike, out: Array | None = None) -> Array:
        """The rates x' of one state, shape (states,), or of many, shape (states, …): the last axes count them.

        Args:
            t: the time, s.
            x: states.
            out: an array of that shape for the result; a new one if it is None.

        NaN where the equations have no solution. A state has the same bits alone and among others.

        Raises:
            ValueError: the shape does not fit.
        """
        import numpy as np

        given = np.ascontiguousarray(x, dtype=np.float64)
        if given.shape[:1] != (self._count,):
            raise ValueError(f"x has the shape {given.shape}; its first axis has to be the {self._count} states")
        if out is None:
            out = np.empty_like(given)
        self._core.rates(t, given, out)
        return out

    def jac(self, t: float, x: npt.ArrayLike, by: str = "x") -> Array:
        """The exact derivatives of the rates of one state, not differences.

        Args:
            t: the time, s.
            x: one state, shape (states,).
            by: "x": shape (states, states); "p": by the parameters, in the order of ``model.parameters``, shape
                (states, parameters).

        Raises:
            ModelError: the velocities are independent ones; ``dynamics(minimal=False)`` has derivatives.
            ValueError: the shape does not fit, or `by` is something else.
        """
        import numpy as np

        if self.minimal:
            raise ModelError("derivatives by independent velocities are not made yet\nhint: dynamics(minimal=False)")
        given = np.asarray(x, dtype=np.float64)
        if given.shape != (self._count,) or by not in ("x", "p"):
            raise ValueError(f"x has to have the shape ({self._count},), and by is 'x' or 'p'")
        return self._core.jacobian(t, given.tolist(), by == "p")

    def jvp(self, t: float, x: npt.ArrayLike, v: npt.ArrayLike) -> Array:
        """The derivatives times a direction: jac(t, x) v, shape (states,)."""
        import numpy as np

        return np.asarray(self.jac(t, x) @ np.asarray(v, dtype=np.float64))

    def vjp(self, t: float, x: npt.ArrayLike, w: npt.ArrayLike) -> Array:
        """A covector times the derivatives: w jac(t, x), shape (states,)."""
        import numpy as np

        return np.asarray(np.asarray(w, dtype=np.float64) @ self.jac(t, x))

    def state(self, t: float | None = None, *, q: Mapping[str, float], qdot: Mapping[str, float], z: Mapping[str, float] | None = None) -> Array:
        """x from values of coordinates, velocities ("x'") and states of the model by name; 0 for those left out.

        Velocities that violate the constraints lose what violates them.
        """
        import numpy as np

        names = [c.name for c in self.model.coordinates]
        known = {**dict.fromkeys(names, 0.0), **q}, {**{name + "'": 0.0 for name in names}, **qdot}, {**dict.fromkeys(self.model.states, 0.0), **(z or {})}
        for have, expected in zip(known, (names, [name + "'" for name in names], self.model.states), strict=True):
            for name in have:
                if name not in expected:
                    raise KeyError(f"there is no {name!r}; there are {', '.join(expected)}")
        at = self.t0 if t is None else t
        return np.array(
            self._core.from_motion(at, [known[0][n] for n in names], [known[1][n + "'"] for n in names], [known[2][n] for n in self.model.states])
        )

    def motion(self, x: npt.ArrayLike, t: float | None = None) -> dict[str, float]:
        """Coordinates, velocities and states of the model of one state x, by name."""
        import numpy as np

        q, qdot, z = self._core.to_motion(self.t0 if t is None else t, np.asarray(x, dtype=np.float64).tolist())
        names = [c.name for c in self.model.coordinates]
        return {
            **dict(zip(names, q, strict=True)),
            **{name + "'": v for name, v in zip(names, qdot, strict=True)},
            **dict(zip(self.model.states, z, strict=True)),
        }

    def __repr__(self) -> str:
        return f"<f(t, x) of {self.model.title!r}: x = {', '.join(s.name for s in self.states)}>"
