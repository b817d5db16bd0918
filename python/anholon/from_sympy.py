"""Models from ``sympy.physics.mechanics``: KanesMethod, LagrangesMethod, System.

The import reads the mechanical system (bodies, velocities, loads and constraints) and derives its equations anew. It replaces
generalized speeds by the rates of the coordinates, sets auxiliary speeds to zero, and turns loads into generalized forces. If loads
depend on forces along auxiliary speeds, these are solved for by the auxiliary equations.

A mass centre of which SymPy knows the velocity only, not the position, gets coordinates of its own, whose rates constraints equate to
the velocity, unless the velocity is the rate of an expression. A speed without a coordinate (the spin of a wheel) gets a coordinate
whose rate is the speed. If a mass or an inertia varies, the equations are those of SymPy, d/dt (m v) = F: matter that leaves a body is
at rest.

A LagrangesMethod without bodies is read by its Lagrangian: each coordinate gets a particle, and generalized forces supply the terms of
Lagrange's equations that the particles lack. The energies in reports are then those of the particles.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ._numbers import Number
from ._sympy_import import Import
from .model import Model
from .reading import loads


def from_sympy(method: Any, *, title: str = "from SymPy", values: Mapping[Any, Number] | None = None, initial: Mapping[Any, Number] | None = None) -> Model:
    """Returns the model of a KanesMethod, a LagrangesMethod, a System or a JointsMethod of ``sympy.physics.mechanics``.

    Args:
        method: the object of SymPy.
        title: the title of the model.
        values: values of symbols and of given functions of time, by symbol or name: numbers, texts or formulas of SymPy. All symbols need
            values. A function without a value stays in the equations, and the model cannot be simulated. Functions, and symbols, that
            occur in loads and potentials alone may have formulas of coordinates, rates and speeds, such as the law of a controller,
            ``{F: -4*q - u}``. Entries of matrices with constant indices, ``K[0, 1]``, are symbols.
        initial: values of coordinates, their rates and generalized speeds, by symbol or name (``"q1'"``), in the same forms. Formulas may
            hold other coordinates, rates and speeds; such a formula is a condition of the start.

    Returns:
        A model; ``model.text`` is its file. Coordinates and parameters keep their names if the model language allows them.

    Raises:
        ModelError: a part of the system has no counterpart in a model; a load depends on a force along an auxiliary speed that the
            auxiliary equations do not determine; the system has no symbol or function of a name in `values`, or no
            coordinate, rate or speed of a key of `initial`; a formula of coordinates or speeds is given for a symbol or function in a mass,
            an inertia, a position, a velocity or a constraint.
        TypeError: `method` is another object; `values` or `initial` is no mapping.

    Warns:
        UserWarning: an acceleration was set that is not the rate of the velocity of its point; acceleration constraints are not the
            rates of the velocity constraints; a body that turns in space has moments of inertia that no body can have; a symbol has the
            name of the time, but other assumptions, and a number as its value.

    Example:
        >>> import anholon as an, sympy as sm
        >>> import sympy.physics.mechanics as me
        >>> x, v = me.dynamicsymbols("x v")
        >>> m, k = sm.symbols("m k")
        >>> N, P = me.ReferenceFrame("N"), me.Point("P")
        >>> P.set_vel(N, v * N.x)
        >>> kane = me.KanesMethod(N, [x], [v], kd_eqs=[x.diff() - v])
        >>> _ = kane.kanes_equations([me.Particle("mass", P, m)], [(P, -k * x * N.x)])
        >>> spring = an.from_sympy(kane, values={m: 1, k: 4}, initial={x: 1})
        >>> float(abs(spring.simulate(to="pi", at=["pi"])["x"][-1] - 1).round(12))
        0.0
    """
    for name, given, example in (("values", values, "{m: 1}"), ("initial", initial, "{q: 1, u: 0}")):
        if given is not None and not isinstance(given, Mapping):
            raise TypeError(f"{name} is a mapping by symbol or name, as {name}={example}, not a {type(given).__name__}")
    return loads(Import(method).text(title, values or {}, initial or {}), name="model from SymPy")
