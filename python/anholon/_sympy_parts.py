"""Reads the parts that the objects of ``sympy.physics.mechanics`` have in common from a KanesMethod, LagrangesMethod or System.

Further functions decide with numbers of many digits whether expressions vanish, find states that satisfy the constraints, and find an
expression whose rate is a given velocity.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ._errors import ModelError
from ._numbers import text_of
from ._sympy_plain import mechanics_module, name_of, plain, real, sympy_module

_LONGEST = 1000  # the most operations of a velocity whose integral is looked for: expanding the 1600 of a rolling disc takes minutes


def is_particle(body: Any) -> bool:
    """True if a body has no inertia. A ``Body`` is an instance of both RigidBody and Particle; its ``is_rigidbody`` tells its kind."""
    return not getattr(body, "is_rigidbody", isinstance(body, mechanics_module().RigidBody))


def center_of(body: Any) -> Any:
    """Returns the mass centre of a body or particle."""
    return body.masscenter if hasattr(body, "masscenter") else body.point


def _inertias_of(body: Any) -> list[Any]:
    """Returns the mass of a body and the components of its inertia."""
    return [body.mass, *(part[0] for part in (() if is_particle(body) else body.central_inertia.args))]


@dataclass
class Parts:
    """The parts that the objects of SymPy have in common."""

    frame: Any
    q: list[Any]
    u: list[Any]
    kinematic: list[Any]  # expressions that vanish
    bodies: list[Any]
    loads: list[Any]
    holonomic: list[Any] = field(default_factory=list)
    velocity: list[Any] = field(default_factory=list)
    acceleration: list[Any] = field(default_factory=list)  # those given beside the velocity constraints, not derived from them
    auxiliary: list[Any] = field(default_factory=list)  # speeds that are zero
    lagrangian: Any = None  # if the inertia does not follow from bodies
    by_energies: bool = False  # whether the equations are Lagrange's of these bodies


def parts_of(method: Any) -> Parts:
    mechanics = mechanics_module()

    if isinstance(method, mechanics.KanesMethod):
        return _parts_of_kane(method)
    if isinstance(method, mechanics.LagrangesMethod):
        return _parts_of_lagrange(method)
    if isinstance(method, mechanics.System):
        by_lagrange = _lagranges_method_of(method)
        if by_lagrange is not None:
            parts = _parts_of_lagrange(by_lagrange)
            parts.u, parts.kinematic = _own_speeds(method)
            return parts
        return Parts(
            method.frame,
            list(method.q),
            list(method.u),
            list(method.kdes),
            list(method.bodies),
            list(method.loads) + [load for actuator in method.actuators for load in actuator.to_loads()],
            list(method.holonomic_constraints),
            list(method.velocity_constraints or method.nonholonomic_constraints),
            auxiliary=list(method.u_aux),
        )
    if hasattr(mechanics, "JointsMethod") and isinstance(method, mechanics.JointsMethod):
        if method.method is None:
            raise ModelError("the JointsMethod has no equations yet\nhint: call form_eoms() before")
        return parts_of(method.method)
    raise TypeError(f"from_sympy reads a KanesMethod, LagrangesMethod, System or JointsMethod, not a {type(method).__name__}")


def names_in(parts: Parts) -> set[str]:
    """Returns the names of all symbols and given functions of time in the parts."""
    sm = sympy_module()
    found = [*parts.kinematic, *parts.holonomic, *parts.velocity, *parts.acceleration, *([] if parts.lagrangian is None else [parts.lagrangian])]
    vectors = [x for load in parts.loads for x in load if hasattr(x, "to_matrix")]
    found += [x for load in parts.loads for x in load if isinstance(x, sm.Basic)]
    points = [x for load in parts.loads for x in load if isinstance(x, mechanics_module().Point)]
    for body in parts.bodies:
        found += [*_inertias_of(body), body.potential_energy]
        vectors.append(center_of(body).vel(parts.frame))
        points.append(center_of(body))
    seen = set(points)
    while points:
        point = points.pop()
        near = point._pos_dict
        vectors += [*near.values(), *point._vel_dict.values(), *point._acc_dict.values()]
        points += [p for p in near if p not in seen]
        seen.update(near)
    frames = [parts.frame] if parts.frame is not None else []
    known = set(frames)
    while frames:
        frame = frames.pop()
        found += [x for matrix in frame._dcm_dict.values() for x in matrix]
        vectors += frame._ang_vel_dict.values()
        frames += [f for f in frame._dcm_dict if f not in known]
        known.update(frame._dcm_dict)
    found += [x for vector in vectors for matrix, _ in vector.args for x in matrix]
    atoms = set().union(*(e.free_symbols | e.atoms(sm.core.function.AppliedUndef) for e in map(plain, found)))
    return {name_of(a) for a in atoms - {mechanics_module().dynamicsymbols._t, *parts.q, *parts.u, *parts.auxiliary}}


def nearest(name: str, known: Iterable[str]) -> str:
    """Returns the end of a message with the known names that are similar to a name; it is empty if there are none."""
    import difflib

    near = difflib.get_close_matches(re.sub(r"\(.*\)$", "", name), list(known), 2)
    return "; did you mean " + " or ".join(repr(n) for n in near) + "?" if near else ""


def _own_speeds(system: Any) -> tuple[list[Any], list[Any]]:
    """Returns the speeds of a System that are no rates of coordinates, and the kinematic equations in which they occur."""
    derivative = sympy_module().Derivative
    speeds = [u for u in system.u if not isinstance(u, derivative)]
    return speeds, [e for e in system.kdes if any(e.has(u) for u in speeds)]


def _lagranges_method_of(system: Any) -> Any:
    """Returns the LagrangesMethod of a System; None if its equations are Kane's. A System that has rates as speeds and no method yet is
    taken for one of Lagrange's."""
    mechanics = mechanics_module()
    if system.eom_method is not None:
        return system.eom_method if isinstance(system.eom_method, mechanics.LagrangesMethod) else None
    if not any(isinstance(u, sympy_module().Derivative) for u in system.u):
        return None
    return mechanics.LagrangesMethod(
        mechanics.Lagrangian(system.frame, *system.bodies),
        system.q,
        forcelist=list(system.loads) + [load for actuator in system.actuators for load in actuator.to_loads()],
        bodies=system.bodies,
        frame=system.frame,
        hol_coneqs=system.holonomic_constraints,
        nonhol_coneqs=system.nonholonomic_constraints,
    )


def _parts_of_kane(method: Any) -> Parts:
    if method.bodies is None:
        raise ModelError("the KanesMethod has no bodies yet\nhint: call kane.kanes_equations(bodies, loads) before")
    velocity = list(method._k_nh * method.u + method._f_nh) if method._k_nh else []
    rates = sympy_module().Matrix([q.diff(mechanics_module().dynamicsymbols._t) for q in method.q])
    # The equations are taken as they were written, since they may have denominators when solved for the rates.
    kinematic = method._k_kqdot_implicit * rates + method._k_ku_implicit * method.u + method._f_k_implicit
    return Parts(
        method._inertial,
        list(method.q),
        list(method.u),
        list(kinematic),
        list(method.bodies),
        list(method.loads or []),
        list(method._f_h or []),
        velocity,
        [] if not method._k_dnh or method._k_dnh is method._k_nh else list(method._k_dnh * method._udot + method._f_dnh),
        list(method._uaux or []),
    )


def _parts_of_lagrange(method: Any) -> Parts:
    sm, time = sympy_module(), mechanics_module().dynamicsymbols._t

    holonomic = list(method._hol_coneqs or [])
    # The velocity constraints of a LagrangesMethod begin with the rates of the holonomic ones.
    every = [] if method.coneqs is None or len(method.coneqs) == 0 else list(method.coneqs)
    parts = Parts(method.inertial, list(method.q), [], [], list(method.bodies or []), list(method.loads or []), holonomic, every[len(holonomic) :])
    energy = plain(method._L[0] if isinstance(method._L, sm.MatrixBase) else method._L)
    if parts.frame is not None and parts.bodies:
        potential = plain(sum((body.potential_energy for body in parts.bodies), sm.Integer(0)))
        kinetic = plain(sum((body.kinetic_energy(parts.frame) for body in parts.bodies), sm.Integer(0)))
        inertias = [plain(x) for body in parts.bodies for x in _inertias_of(body)]
        if not any(x.has(q.diff(time)) for x in inertias for q in parts.q) and vanish([energy - kinetic + potential], {}):
            parts.by_energies = True
            # The potential of a charge in a magnetic field depends on velocities, so its force has a time derivative, too.
            parts.loads += [(q, real(real(sm.diff(potential, q.diff(time))).diff(time) - sm.diff(potential, q))) for q in parts.q]
            return parts
    parts.bodies, parts.lagrangian = [], energy
    return parts


def atoms_of(expressions: Iterable[Any]) -> list[Any]:
    """Returns the symbols, functions of time and rates in expressions, and the time, sorted by name."""
    sm = sympy_module()
    atoms: set[Any] = {mechanics_module().dynamicsymbols._t}
    for e in expressions:
        atoms |= e.atoms(sm.Derivative) | e.atoms(sm.core.function.AppliedUndef) | e.free_symbols
    return sorted(atoms, key=str)


def numeric(arguments: Iterable[Any], what: Any) -> Any:
    """Returns a function of mpmath for an expression, a matrix or nested lists of them. Rates are arguments of their own."""
    sm = sympy_module()
    dummies = {a: sm.Dummy() for a in arguments}

    def replaced(x: Any) -> Any:
        return [replaced(y) for y in x] if isinstance(x, list) else x.xreplace(dummies)

    return sm.lambdify(list(dummies.values()), replaced(what), "mpmath", cse=True)


_LONG_DENOMINATOR = 10**12  # fractions with a larger denominator are taken for Floats that SymPy has rounded


def exact(e: Any) -> Any:
    """Returns the expression with each Float replaced by the fraction of its decimal: 3/10 for 0.3."""
    sm = sympy_module()
    return e.xreplace({f: sm.Rational(_decimal(f)) for f in e.atoms(sm.Float) if f.is_finite})


def short_decimal(e: Any) -> Any:
    """Returns a fraction as a Float if the decimal of the Float is exactly the fraction: 0.012 for 3/250."""
    sm = sympy_module()
    return sm.Float(e) if e.is_Rational and not e.is_Integer and sm.Rational(repr(float(e))) == e else e


def _decimal(f: Any) -> str:
    """Returns the decimal of a Float; the shortest one if its precision is at most that of a double."""
    return repr(float(f)) if f._prec <= 53 else str(f)


def _rounded(expressions: Iterable[Any]) -> dict[Any, tuple[Any, Any]]:
    """Returns the numbers in expressions that SymPy may have rounded, each with its value and a bound of its error."""
    import mpmath

    sm = sympy_module()
    found: dict[Any, tuple[Any, Any]] = {}
    for f in sorted(set().union(*(e.atoms(sm.Float, sm.Rational) for e in expressions)), key=str):
        if f.is_Float and f.is_finite:
            text = _decimal(f)
            value = mpmath.mpf(text)
            # A small number with all digits may be the difference of numbers of size 1, with their absolute error.
            is_rest = abs(value) < 1e-10 and len(re.sub(r"e.*|\D", "", text)) > 13
            found[f] = value, mpmath.mpf(2) ** (3 - f._prec) * (1 if is_rest else abs(value))
        elif f.is_Rational and f.q > _LONG_DENOMINATOR:
            value = mpmath.mpf(f.p) / f.q
            found[f] = value, abs(value) * mpmath.mpf(2) ** -50
    return found


def vanish(expressions: Iterable[Any], near: Mapping[Any, Any]) -> bool:
    """True if expressions vanish at the values of ``near`` and at random values of all other symbols, in arithmetic of 40 digits. If they
    hold rounded numbers, values that the rounding explains count as zero."""
    import mpmath

    sm, draw, expressions = sympy_module(), random.Random(1), list(expressions)
    expressions = [sm.sympify(e) for e in expressions]
    listed = atoms_of(expressions)
    with mpmath.workdps(40):
        rounded = _rounded(expressions)
        dummies = {f: sm.Dummy() for f in rounded}
        values = numeric([*listed, *dummies.values()], [e.xreplace(dummies) for e in expressions])
        numbers = [value for value, _ in rounded.values()]
        for _ in range(1 if near else 3):
            at = [near[a] if a in near else mpmath.mpf(draw.uniform(0.3, 1.3)) for a in listed]
            found = values(*at, *numbers)
            if not any(abs(x) > 1e-20 for x in found):
                continue
            if not rounded:
                return False
            moved = [values(*at, *(v + draw.choice((-1, 1)) * draw.uniform(0.5, 1) * error for v, error in rounded.values())) for _ in range(4)]
            if any(abs(x) > 1e-20 and abs(x) > 1000 * max(abs(y - x) for y in ys) for x, *ys in zip(found, *moved, strict=True)):
                return False
    return True


def rank_of(rows: list[Any], among: Iterable[Any]) -> int:
    """Returns the rank of rows of numbers, up to the rounding of the expressions `among` from which they come."""
    sm = sympy_module()
    least = 1e-11 if _rounded(among) else 1e-20
    sizes = [max((abs(x) for x in row), default=0) for row in rows]
    scaled = [[x / size for x in row] for row, size in zip(rows, sizes, strict=True) if size > least]
    return int(sm.Matrix(scaled).rank(iszerofunc=lambda x: abs(x) < least)) if scaled else 0


def never_zero(e: Any, where: list[Any]) -> bool:
    """True if an expression certainly has no zero where the expressions of ``where`` vanish: its remainder modulo them is not 0 and
    holds no coordinates, for example 1 for the squared length of a quaternion."""
    sm = sympy_module()

    def polynomial(x: Any) -> tuple[Any, list[Any]]:
        x = sm.nsimplify(x, rational=True)
        functions = sorted(x.atoms(sm.core.function.AppliedUndef), key=str)
        return x, functions if x.is_polynomial(*functions) and not x.has(sm.Derivative) else []

    e, own = polynomial(e)
    if not own:
        return not e.atoms(sm.core.function.AppliedUndef)
    divisors = {x: of for x, of in map(polynomial, where) if of}
    every = sorted({*own, *(q for of in divisors.values() for q in of)}, key=str)
    rest = sm.reduced(e, list(divisors), *every, order="grevlex")[1] if divisors else e
    return rest != 0 and not rest.atoms(sm.core.function.AppliedUndef)


def has_poles(e: Any, where: list[Any]) -> bool:
    """True if an expression may have a pole where the expressions of ``where`` are zero."""
    sm = sympy_module()
    return not never_zero(sm.denom(sm.together(e)), where)


_LONG = 200  # expressions with as many operations or more are not simplified, which would take seconds
_LARGE = 3  # the most unknowns of a system that is solved by determinants


def solution(a: Any, b: Any, where: list[Any]) -> list[Any]:
    """Returns the solution of a x = b. The pivots of LU may vanish where the matrix is regular, for example those of a rotation. The
    unknowns of a small block that has such poles are found by determinants."""
    sm = sympy_module()

    def short(e: Any) -> Any:
        return sm.simplify(e) if sm.count_ops(e) < _LONG else e

    found = [short(x) for x in a.LUsolve(b)]
    for rows, columns in _blocks(a):
        if len(rows) != len(columns) or not 1 < len(columns) <= _LARGE or not any(has_poles(found[k], where) for k in columns):
            continue
        part = a.extract(rows, columns)
        determinant, above = short(part.det()), part.adjugate().applyfunc(short) * b.extract(rows, [0])
        for k, e in zip(columns, above, strict=True):
            found[k] = short(e / determinant)
    return found


def _blocks(a: Any) -> list[tuple[list[int], list[int]]]:
    """Returns the rows and columns of the blocks of a matrix. Blocks have no rows or columns in common."""
    left, blocks = set(range(a.cols)), []
    while left:
        columns, rows = {min(left)}, set[int]()
        while (more := {i for i in range(a.rows) if any(a[i, j] != 0 for j in columns)}) != rows:
            rows = more
            columns |= {j for j in left if any(a[i, j] != 0 for i in rows)}
        blocks.append((sorted(rows), sorted(columns)))
        left -= columns
    return blocks


def with_values(e: Any, values: Mapping[Any, Any]) -> Any | None:
    """Returns an expression in which the symbols with given values are replaced by them: numbers, or formulas of other symbols. Returns
    None if SymPy cannot read a value, for example one with a unit."""
    sm, by_name = sympy_module(), {getattr(key, "name", str(key)): value for key, value in values.items()}
    for _ in range(len(values) + 1):
        names = {s.name: s for s in e.free_symbols}
        try:
            known = {s: values.get(s, by_name.get(name)) for name, s in names.items()}
            put = {s: v if isinstance(v, sm.Basic) else sm.sympify(text_of(v), locals=names) for s, v in known.items() if v is not None}
        except (sm.SympifyError, TypeError, ValueError):  # a value with a unit, or one that SymPy cannot read
            return None
        if not put:
            break
        e = e.xreplace(put)
    return e


def certainly_positive(e: Any, values: Mapping[Any, Any]) -> bool:
    """True if an expression of symbols is positive by their assumptions or by their values."""
    found = e if e.is_positive else with_values(e, values)
    return found is not None and bool(found.is_positive)


def state_on(holonomic: list[Any], flows: list[Any], q: list[Any], rates: list[Any]) -> dict[Any, Any]:
    """Returns random coordinates and rates that satisfy the constraints, and random values of the other symbols in the constraints; an
    empty dictionary if Newton's method finds none. The ``flows`` are velocity constraints, the rates of the holonomic ones first."""
    import mpmath

    sm, draw = sympy_module(), random.Random(7)
    if not flows:
        return {}
    others = [a for a in atoms_of([*holonomic, *flows]) if a not in q and a not in rates]
    values = {a: mpmath.mpf(draw.uniform(0.3, 1.3)) for a in others}
    f = numeric([*q, *rates, *others], [holonomic, flows, sm.Matrix(flows).jacobian(rates).tolist()])

    def satisfied(x: Any, of: Callable[[Any], tuple[Any, Any]]) -> Any:
        """Returns a zero near x of functions that `of` gives with their Jacobian, by Newton steps of least length, or None."""
        for _ in range(60):
            value, rows = of(x)
            if not value or max(abs(v) for v in value) < mpmath.mpf(10) ** -45:
                return x
            j = mpmath.matrix(rows)
            x = x - j.T * mpmath.lu_solve(j * j.T, mpmath.matrix(value))
        return None

    def positions(x: Any) -> tuple[Any, Any]:
        value, _, rows = f(*x, *start, *values.values())
        return value, rows[: len(value)]

    start = mpmath.matrix([draw.uniform(-1, 1) for _ in q])
    x = satisfied(mpmath.matrix([draw.uniform(0.3, 0.9) for _ in q]), positions)
    if x is None:
        return {}
    v = satisfied(start, lambda v: f(*x, *v, *values.values())[1:])
    return {} if v is None else {**dict(zip(q, x, strict=True)), **dict(zip(rates, v, strict=True)), **values}


def integral_of(rate: Any, q: list[Any], rates: list[Any]) -> Any | None:
    """Returns an expression of coordinates and time whose rate is `rate`, or None if none is found."""
    sm, time = sympy_module(), mechanics_module().dynamicsymbols._t
    if rate.atoms(sm.core.function.AppliedUndef) - set(q):
        return None  # the rate holds speeds that are not known yet, or given functions
    if (sum_of_them := _sum_of_coordinates(rate, q, rates)) is not None or sm.count_ops(rate) > _LONGEST:
        return sum_of_them
    dummies = [sm.Dummy() for _ in q]
    values = dict(zip(rates, dummies, strict=True))
    e = sm.expand(rate.xreplace(values))
    if any(e.has(sm.Derivative(c, time)) for c in q) or not all(sm.diff(e, d, f) == 0 for d in dummies for f in dummies):
        return None
    plain = {c: sm.Dummy() for c in q}
    whole, done = sm.Integer(0), dict(plain)
    for c, d in reversed(list(zip(q, dummies, strict=True))):
        slope = sm.diff(e, d).xreplace(done)
        if sm.count_ops(slope) > 60 or not slope.is_polynomial(plain[c]) and slope.has(sm.tan, sm.log, sm.Pow):
            return None
        part = sm.integrate(slope, plain[c])
        if part.has(sm.Integral):
            return None
        whole += part - part.subs(plain[c], 0)
        done[c] = sm.Integer(0)
    whole = whole.xreplace({d: c for c, d in plain.items()})
    alone = e.xreplace(dict.fromkeys(dummies, sm.Integer(0)))
    if not alone.atoms(sm.core.function.AppliedUndef) and sm.count_ops(alone) <= 30:
        part = sm.integrate(alone, time)
        whole += sm.Integer(0) if part.has(sm.Integral) else part - part.subs(time, 0)
    return whole if vanish([whole.diff(time) - rate], {}) else None


def _sum_of_coordinates(rate: Any, q: list[Any], rates: list[Any]) -> Any | None:
    """Returns the sum of integer multiples of coordinates whose rate is `rate`, or None if there is none. The multiples are found by
    numbers, since a velocity along axes that turn may have thousands of terms that cancel."""
    import mpmath

    listed, draw = atoms_of([rate]), random.Random(3)
    at = {a: mpmath.mpf(draw.uniform(0.3, 1.3)) for a in listed}
    f, whole = numeric(listed, [rate]), sympy_module().Integer(0)
    here = f(*at.values())[0]
    for c, r in zip(q, rates, strict=True):
        slope = f(*{**at, r: at[r] + 1}.values())[0] - here if r in at else mpmath.mpf(0)
        if not mpmath.isfinite(slope) or abs(slope - (factor := mpmath.nint(mpmath.re(slope)))) > 1e-9:
            return None  # 1e-9 is more than the rounding of 15 digits; vanish() tests the sum with more digits
        whole += int(factor) * c
    return whole if vanish([whole.diff(mechanics_module().dynamicsymbols._t) - rate], {}) else None
