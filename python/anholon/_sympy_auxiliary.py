"""Forces along auxiliary speeds of SymPy, which the auxiliary equations determine."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ._errors import ModelError
from ._sympy_plain import name_of, sympy_module


class AuxiliaryForces:
    """The forces that a KanesMethod with ``u_auxiliary`` brings into evidence: functions of time without a formula.

    Such a force does no work at the speeds of the motion. If another load depends on it, as friction on a normal force, the motion
    does, too: ``found`` is then its formula, by the auxiliary equations, which are linear in it.
    """

    def __init__(self, method: Any, auxiliary: list[Any], in_rates: Callable[[Any], Any], motion: set[Any]) -> None:
        self._auxiliary = auxiliary
        self._in_rates = in_rates
        self._motion = motion  # the time, coordinates and speeds, which are no forces
        self._equations = list(_equations_of(method)) if auxiliary else []

    def found(self, forces: Mapping[Any, Any], values: Mapping[Any, Any]) -> dict[Any, Any]:
        """Returns the formulas of these forces, if generalized forces hold some that have no values; else an empty dictionary.

        Raises:
            ModelError: the auxiliary equations do not determine them.
        """
        sm = sympy_module()
        if not self._equations:
            return {}
        named = {name_of(key) for key in values}
        equations = [self._in_rates(e) for e in self._equations]

        def unknown(expressions: list[Any]) -> set[Any]:
            functions = set().union(*(e.atoms(sm.core.function.AppliedUndef) for e in expressions)) - self._motion
            return {f for f in functions if f not in values and name_of(f) not in named}

        wanted = sorted(unknown(equations), key=str)
        used = [f for f in wanted if f in unknown(list(forces.values()))]
        if not used:
            return {}
        dummies = {f: sm.Dummy() for f in wanted}
        matrix = sm.Matrix([e.xreplace(dummies) for e in equations])
        a = matrix.jacobian(list(dummies.values())).applyfunc(sm.simplify)
        linear = not any(a.has(d) for d in dummies.values()) and not any(e.has(sm.Derivative(f, f.args[0])) for e in equations for f in wanted)
        if not linear or a.rows != a.cols or sm.simplify(a.det()) == 0:
            self._refuse(used)
        b = matrix.xreplace(dict.fromkeys(dummies.values(), sm.Integer(0)))
        return dict(zip(wanted, a.LUsolve(-b), strict=True))

    def _refuse(self, used: list[Any]) -> None:
        names, speeds = ", ".join(name_of(f) for f in used), ", ".join(name_of(u) for u in self._auxiliary)
        several = len(used) > 1
        raise ModelError(
            f"{names} {'are forces' if several else 'is a force'} along the auxiliary speed{'s' if len(self._auxiliary) > 1 else ''} {speeds}, "
            f"another load depends on {'them' if several else 'it'}, and the auxiliary equations are no regular linear equations for {'them' if several else 'it'}\n"
            f"hint: replace {names} in the loads by {'formulas' if several else 'a formula'} that the auxiliary_eqs of the KanesMethod give, or give {'them' if several else 'it'} "
            f"by from_sympy(…, values={{{name_of(used[0])}: …}})"
        )


def _equations_of(method: Any) -> list[Any]:
    """Returns the auxiliary equations of a KanesMethod, also of one that belongs to a System; none if there are none yet."""
    for of in (method, getattr(method, "eom_method", None), getattr(method, "method", None)):
        try:
            equations = getattr(of, "auxiliary_eqs", None)
        except ValueError:  # SymPy: the equations are not formed yet
            continue
        if equations is not None:
            return list(equations)
    return []
