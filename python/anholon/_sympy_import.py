"""The reading of a mechanical system of SymPy: bodies, velocities, loads and constraints, and the model file that they make."""

from __future__ import annotations

import contextlib
import json
import random
import re
import warnings
from collections.abc import Iterable, Mapping
from typing import Any

from ._errors import ModelError
from ._numbers import Number
from ._sympy_auxiliary import AuxiliaryForces
from ._sympy_bodies import Bodies
from ._sympy_given import Given
from ._sympy_parts import (
    atoms_of,
    center_of,
    certainly_positive,
    exact,
    has_poles,
    integral_of,
    numeric,
    parts_of,
    rank_of,
    solution,
    state_on,
    vanish,
)
from ._sympy_plain import mechanics_module, plain, real, sympy_module
from ._sympy_writer import RESERVED, Writer


class Import:
    """One import: the parts with speeds replaced by rates, and the text that is made of the parts."""

    def __init__(self, method: Any) -> None:
        sm = sympy_module()

        self.sm = sm
        self.parts = parts = parts_of(method)
        self.time = mechanics_module().dynamicsymbols._t
        self._without_auxiliary()
        known = [u for u in parts.u if any(e.has(u) for e in parts.kinematic)]
        self.speeds: dict[Any, Any] = {}  # expressions in coordinates and rates
        parts.velocity += self._solve(list(parts.kinematic), known)
        self.centers: list[tuple[str, Any]] = []  # constraints on coordinates that the import adds: their names and expressions that vanish
        self.writer = Writer(parts)
        self._given: Mapping[Any, Number] = {}  # the values of symbols
        self._places: dict[Any, list[Any]] = {}
        self._kept: tuple[Any, list[Any]] | None = None
        self.bodies = Bodies(self)
        self._place_centers([u for u in parts.u if u not in known])
        self._look_at_acceleration_constraints()
        motion = {self.time, *parts.q, *parts.u, *parts.auxiliary}
        self._auxiliary_forces = AuxiliaryForces(method, parts.auxiliary, self.in_rates, motion)

    def _without_auxiliary(self) -> None:
        """Sets auxiliary speeds to zero in equations and constraints; ``in_rates`` sets them to zero in velocities and loads."""
        zero = self.sm.Integer(0)
        self._zero = {**{u.diff(self.time): zero for u in self.parts.auxiliary}, **dict.fromkeys(self.parts.auxiliary, zero)}
        for name in ("kinematic", "holonomic", "velocity", "acceleration"):
            setattr(self.parts, name, [plain(e).xreplace(self._zero) for e in getattr(self.parts, name)])

    def _solve(self, equations: list[Any], speeds: list[Any]) -> list[Any]:
        """Solves linear equations for speeds and adds them to ``self.speeds``; returns the equations that remain."""
        sm, draw = self.sm, random.Random(5)
        if not speeds:
            return [e for e in equations if e != 0]
        equations = [exact(sm.sympify(e)) for e in equations]
        dummies = {u: sm.Dummy() for u in speeds}
        matrix = sm.Matrix([e.xreplace(dummies) for e in equations])
        a = matrix.jacobian(list(dummies.values()))
        b = matrix.xreplace(dict.fromkeys(dummies.values(), sm.Integer(0)))
        atoms = atoms_of(a)
        numbers = numeric(atoms, a)(*(sm.Float(draw.uniform(0.3, 1.3), 30) for _ in atoms))
        rows: list[int] = []
        for k in sorted(range(len(equations)), key=lambda k: (sm.count_ops(equations[k]), k)):
            trial = [[sm.Float(str(numbers[i, j]), 30) for j in range(a.cols)] for i in [*rows, k]]
            if rank_of(trial, a) > len(rows):
                rows.append(k)
        if len(rows) < len(speeds):
            raise ModelError("the kinematic differential equations cannot be solved for the generalized speeds")
        rows.sort()
        found = self._solution(speeds, a.extract(rows, list(range(a.cols))), -b.extract(rows, [0]))
        before = self.speeds
        self.speeds = {**{u: e.xreplace(found) for u, e in before.items()}, **found}
        left = [self._without_denominator(self.in_rates(e)) for k, e in enumerate(equations) if k not in rows]
        left = [e for e in left if sm.simplify(e) != 0 and not vanish([e], {})]
        if left:
            # The least-squares solution of all equations is the same where they hold, and its pivots may vanish nowhere.
            among_all = self._solution(speeds, a.T * a, -(a.T * b))
            if not any(has_poles(e, self.parts.holonomic) for e in among_all.values()):
                self.speeds = {**{u: e.xreplace(among_all) for u, e in before.items()}, **among_all}
        return left

    def _solution(self, speeds: list[Any], a: Any, b: Any) -> dict[Any, Any]:
        """Returns the solution of a x = b by speeds."""
        return dict(zip(speeds, solution(a, b, self.parts.holonomic), strict=True))

    def _coordinates_of(self, e: Any) -> set[Any]:
        return set(e.atoms(self.sm.core.function.AppliedUndef))

    def _without_denominator(self, e: Any) -> Any:
        """Returns the numerator of e, which vanishes where e does and has no pole: x' sin(q) - y' cos(q) for x' tan(q) - y'. Tangents,
        cotangents, secants and cosecants become fractions of sines and cosines before."""
        sm = self.sm
        for function, above, below in ((sm.tan, sm.sin, sm.cos), (sm.cot, sm.cos, sm.sin), (sm.sec, None, sm.cos), (sm.csc, None, sm.sin)):
            e = e.replace(function, lambda x, above=above, below=below: (above(x) if above else sm.Integer(1)) / below(x))
        above, below = self.sm.fraction(self.sm.together(e))
        return above if self._coordinates_of(below) else e

    def add_coordinate(self, wish: str) -> Any:
        """Adds a coordinate that SymPy does not have, and returns it."""
        taken = {str(q.func) for q in self.parts.q} | RESERVED
        while wish in taken:
            wish += "_"
        q = mechanics_module().dynamicsymbols(wish)
        self.parts.q.append(q)
        self.writer.add(q)
        return q

    def _place_centers(self, unknown: list[Any]) -> None:
        """Finds the positions of mass centres. A mass centre of which only the velocity is known gets coordinates with that velocity,
        from which speeds without a kinematic equation follow. A speed that turns a body, and any other speed that remains, becomes
        the rate of an angle."""
        open_equations: list[Any] = []
        names: list[str] = []
        for body in self.parts.bodies:
            point = center_of(body)
            if point in self._places:
                continue
            velocity = self.components(point.vel(self.parts.frame))
            self._look_at_acceleration(point)
            place = self.position(point)
            if place is None:
                place = []
                for axis, rate in zip("xyz", velocity, strict=True):
                    whole = self.sm.Integer(0) if rate == 0 else integral_of(rate, self.writer.q, self.writer.rates)
                    if whole is None:
                        whole = self.add_coordinate(f"{re.sub(r'[^A-Za-z0-9]+', '_', str(body.name)) or 'body'}_{axis}")
                        open_equations.append(whole.diff(self.time) - rate)
                        names.append(str(whole.func))
                    place.append(whole)
            self._places[point] = place
        spins = [x for b in self.parts.bodies for x in self.bodies.spin(b)]
        joined = [u for u in unknown if any(e.has(u) for e in open_equations) and not any(x.has(u) for x in spins)]
        for u in [u for u in unknown if u not in joined]:
            self.speeds[u] = self.add_coordinate(f"{u.func}_angle").diff(self.time)
        open_equations = [self.in_rates(e) for e in open_equations]
        left = self._solve(open_equations, joined) if joined else open_equations
        self.centers = [(f"center{k + 1}" if joined else f"center_{names[k]}", e) for k, e in enumerate(left)]
        for body in self.parts.bodies:
            self.bodies.turned(body)  # turned() may add coordinates

    def _look_at_acceleration(self, point: Any) -> None:
        """Warns if an acceleration was set that is not the rate of the velocity of the point."""
        told = point._acc_dict.get(self.parts.frame)
        if told is None:
            return
        rates = [x.diff(self.time) for x in self.components(point.vel(self.parts.frame))]
        if not self._vanishes([self.in_rates(r) - a for r, a in zip(rates, self.components(told), strict=True)]):
            warnings.warn(
                f"the acceleration that was set for the point {point.name} is not the rate of its velocity; "
                "the model follows the velocity, and SymPy's equations differ from its equations",
                stacklevel=6,
            )

    def _look_at_acceleration_constraints(self) -> None:
        """Warns if acceleration constraints do not follow from the rates of the other constraints."""
        import mpmath

        sm, draw, at = self.sm, random.Random(8), self._on_constraints() if self.parts.acceleration else {}
        if not at:
            return
        rates = [self.in_rates(e.diff(self.time)) for e in self.velocity_constraints()]
        rates += [self.in_rates(e.diff(self.time, 2)) for e in self.parts.holonomic]
        every, second = sm.Matrix([*rates, *map(self.in_rates, self.parts.acceleration)]), [r.diff(self.time) for r in self.writer.rates]
        table = every.jacobian(second).row_join(every.xreplace(dict.fromkeys(second, sm.Integer(0))))
        listed = atoms_of(table)
        with mpmath.workdps(40):
            numbers = numeric(listed, table.tolist())(*(at.get(a, mpmath.mpf(draw.uniform(0.3, 1.3))) for a in listed))
            rows = [[sm.Float(str(x), 40) for x in row] for row in numbers]
        if rank_of(rows, every) > rank_of(rows[: len(rates)], every):
            warnings.warn(
                "the acceleration constraints are not the rates of the velocity constraints; "
                "the model follows the velocity constraints, and SymPy's equations differ from its equations",
                stacklevel=4,
            )

    def in_rates(self, e: Any) -> Any:
        """Returns an expression with generalized speeds and their rates replaced by those of coordinates."""
        e = plain(e).xreplace(self._zero)
        second = {u.diff(self.time): x.diff(self.time) for u, x in self.speeds.items()} if e.has(self.sm.Derivative) else {}
        return plain(e.xreplace({k: v for k, v in second.items() if e.has(k)}).xreplace(self.speeds))

    def components(self, vector: Any) -> list[Any]:
        """Returns the components of a vector along the inertial axes."""
        try:
            return [self.in_rates(x) for x in vector.to_matrix(self.parts.frame)]
        except ValueError as e:
            raise ModelError(
                f"a velocity or load is along a frame without an orientation: {str(e).rstrip('.')}\n"
                "hint: orient the frame, as by B.orient_body_fixed(N, (q1, q2, q3), '123'), and take kinematic_equations for its speeds"
            ) from None

    def _vanishes(self, expressions: Iterable[Any]) -> bool:
        """True if expressions vanish at a random state that satisfies the constraints."""
        return vanish(expressions, self._on_constraints())

    def _on_constraints(self) -> dict[Any, Any]:
        """Returns random values of all coordinates and rates, with 40 digits, that satisfy the constraints, and the values of the other
        symbols in the constraints; an empty dictionary if there are no constraints or no such values are found."""
        import mpmath

        if not hasattr(self, "_drawn"):
            self._drawn: dict[Any, Any] = {}
            if self.parts.holonomic or self.parts.velocity:
                flows = [self.in_rates(e.diff(self.time)) for e in self.parts.holonomic] + self.velocity_constraints()
                with mpmath.workdps(50), contextlib.suppress(ZeroDivisionError):
                    self._drawn = state_on(self.parts.holonomic, flows, list(self.writer.q), list(self.writer.rates))
        return self._drawn

    def position(self, point: Any) -> list[Any] | None:
        """Returns the position of a point in the inertial frame if the rate of the position is the velocity of the point, else None."""
        velocity = self.components(point.vel(self.parts.frame))
        seen, queue = {point}, [point]
        while queue:
            here = queue.pop(0)
            if here._vel_dict.get(self.parts.frame) == 0:
                place = [self.in_rates(x) for x in point.pos_from(here).to_matrix(self.parts.frame)]
                if self._vanishes([self.in_rates(x.diff(self.time)) - v for x, v in zip(place, velocity, strict=True)]):
                    return place
            for neighbour in here._pos_dict:
                if neighbour not in seen:
                    seen.add(neighbour)
                    queue.append(neighbour)
        return None

    def center(self, point: Any) -> list[str]:
        """Returns the formulas of the position of a mass centre."""
        return [self.writer.formula(x) for x in self._places[point]]

    def _add_varying(self, sums: dict[Any, Any]) -> None:
        """Adds the generalized forces of varying inertia: the torque -I' w, since SymPy's torque is d/dt (I w), and for Lagrange's
        equations the derivatives of the kinetic energy by coordinates on which masses and inertias depend."""
        sm = self.sm
        for body in self.parts.bodies:
            mass, velocity = plain(body.mass), sm.Matrix(self.components(center_of(body).vel(self.parts.frame)))
            turned = self.bodies.turned(body)
            inertia, own = (turned.inertia, turned.own) if turned else (sm.zeros(3, 3), sm.zeros(3, 1))
            rise = inertia.diff(self.time)
            varies = any(rise) and not vanish(rise, {})
            for q, rate in zip(self.writer.q, self.writer.rates, strict=True):
                more = sm.Integer(0)
                if varies:
                    more -= own.diff(rate).dot(rise * own)
                if varies and self.parts.by_energies:
                    more += own.dot(inertia.diff(q) * own) / 2
                if self.parts.by_energies:
                    more += mass.diff(q) * velocity.dot(velocity) / 2
                if more != 0:
                    sums[q] = sums.get(q, 0) + more

    def _inertia_of(self, q: Any) -> Any:
        """Returns the mass of the particle of a coordinate if only a Lagrangian is known: the constant part of d²L/dq'² if that is
        positive, else 1."""
        sm = self.sm
        own = sm.expand(sm.diff(self.parts.lagrangian, q.diff(self.time), 2))
        constant = own.as_independent(*self.writer.q, *self.writer.rates, self.time, as_Add=True)[0]
        return constant if certainly_positive(constant, self._given) else sm.Integer(1)

    def stand_ins(self) -> list[str]:
        """Returns a particle on a line for each coordinate. Its kinetic energy is one term of the Lagrangian, and
        ``generalized_forces`` adds the other terms, so that the equations are Lagrange's."""
        bodies = []
        for q in self.writer.q:
            name, mass = self.writer.new(f"{self.writer.names[q]}_inertia"), self.writer.formula(self._inertia_of(q))
            bodies.append(f"[[particle]]\nname = {json.dumps(name)}\nmass = {json.dumps(mass)}\nposition = {json.dumps([self.writer.names[q], '0', '0'])}\n")
        return bodies

    def _lagrange_terms(self) -> dict[Any, Any]:
        """Returns the terms of Lagrange's equations that the particles of ``stand_ins`` lack, by coordinate."""
        sm, energy = self.sm, self.parts.lagrangian
        terms = {}
        for q in self.writer.q:
            rate = q.diff(self.time)
            whole = real(real(sm.diff(energy, rate)).diff(self.time) - sm.diff(energy, q)).doit()
            terms[q] = sm.expand(self._inertia_of(q) * rate.diff(self.time) - whole)
        return terms

    def generalized_forces(self) -> dict[Any, Any]:
        """Returns the sum of the generalized forces of all loads, by coordinate. Forces along auxiliary speeds that remain in it are
        replaced by the formulas that the auxiliary equations give."""
        sums = self._sums_of_forces({})
        found = self._auxiliary_forces.found(sums, self._given)
        return self._sums_of_forces(found) if found else sums

    def _sums_of_forces(self, found: Mapping[Any, Any]) -> dict[Any, Any]:
        """Returns the sum of the generalized forces of all loads, by coordinate, in which these symbols have these values."""
        Point, ReferenceFrame = mechanics_module().Point, mechanics_module().ReferenceFrame

        sm, frame = self.sm, self.parts.frame
        sums: dict[Any, Any] = self._lagrange_terms() if self.parts.lagrangian is not None else {}
        for load in self.parts.loads:
            at, what = load[0], load[1]
            if isinstance(at, (Point, ReferenceFrame)):
                flow = self.components(at.vel(frame) if isinstance(at, Point) else at.ang_vel_in(frame))
                force = [x.xreplace(found) for x in self.components(what)]
                for q, rate in zip(self.writer.q, self.writer.rates, strict=True):
                    sums[q] = sums.get(q, 0) + sum((f * sm.diff(v, rate) for f, v in zip(force, flow, strict=True)), sm.Integer(0))
            else:
                sums[at] = sums.get(at, 0) + self.in_rates(what).xreplace(found)
        self._add_varying(sums)
        sums = {q: self._without_what_cancels(real(s)) for q, s in sums.items()}
        return {q: s for q, s in sums.items() if s != 0}

    def _without_what_cancels(self, force: Any) -> Any:
        """Returns a generalized force without the symbols of loads that cancel in it. Such are the forces at auxiliary speeds, which do no
        work and have no values."""
        sm, loads = self.sm, [x for load in self.parts.loads for x in load if self.parts.auxiliary and hasattr(x, "to_matrix")]
        told = {x for vector in loads for matrix, _ in vector.args for e in map(plain, matrix) for x in e.free_symbols | e.atoms(sm.core.function.AppliedUndef)}
        for x in sorted((force.free_symbols | force.atoms(sm.core.function.AppliedUndef)) & told - {self.time, *self.parts.q}, key=str):
            less = force.xreplace({x: sm.Integer(0)})
            if not less.has(sm.nan, sm.zoo, sm.oo) and self._vanishes([force - less]):
                force = less
        return force

    def velocity_constraints(self) -> list[Any]:
        """Returns the velocity constraints that do not follow from the holonomic ones or from others, by the rank at a random point."""
        now = (list(self.writer.q), dict(self.speeds))  # the result is the same as long as these are
        if self._kept is not None and self._kept[0] == now:
            return self._kept[1]
        sm, draw = self.sm, random.Random(2)
        rates = self.writer.rates
        listed = [self.in_rates(e.diff(self.writer.time)) for e in self.parts.holonomic]
        rows, kept = [sm.Matrix([e]).jacobian(rates) for e in listed], []
        wanted = [self.in_rates(e) for e in self.parts.velocity]
        values = {a: sm.Float(draw.uniform(0.3, 1.3), 40) for a in atoms_of([*listed, *wanted])}

        def at_point(row: Any) -> list[Any]:
            return [sm.N(x.xreplace(values), 40) for x in row]

        numbers = [at_point(row) for row in rows]
        rank = rank_of(numbers, [*listed, *wanted])
        for e in wanted:
            numbers.append(at_point(sm.Matrix([e]).jacobian(rates)))
            if rank_of(numbers, [*listed, *wanted]) == rank:
                numbers.pop()
                continue
            rank += 1
            if sm.count_ops(e) < 400 and any(x.exp.is_negative and x.base.has(*self.writer.q) for x in e.atoms(sm.Pow)):
                e = sm.simplify(e)  # simplifying removes pivots of SymPy that vanish at the origin
            kept.append(e)
        self._kept = now, kept
        return kept

    def text(self, title: str, values: Mapping[Any, Number], initial: Mapping[Any, Number]) -> str:
        """Returns the text of the model file."""
        w, given = self.writer, Given(self, values, initial)
        self._given = given.values
        bodies = [self.bodies.entry(b, given.values) for b in self.parts.bodies] if self.parts.lagrangian is None else self.stand_ins()
        constraints = [(f"holonomic{k + 1}", w.formula(e)) for k, e in enumerate(self.parts.holonomic)]
        constraints += [(f"velocity{k + 1}", w.formula(e)) for k, e in enumerate(self.velocity_constraints())]
        constraints += [(name, w.formula(e)) for name, e in self.centers]
        fixed = [*w.parameters, *w.functions]
        forces = {w.names[q]: w.formula(s, f"the generalized force of {w.names[q]}") for q, s in self.generalized_forces().items()}
        value_lines, initial_lines = given.sections(fixed)
        lines = [f"title = {json.dumps(title)}", 'source = "imported from sympy.physics.mechanics"', ""]
        lines.append(f"coordinates = {json.dumps([w.names[q] for q in w.q])}\n")
        lines += [*value_lines, *bodies]
        if forces:
            lines.append("[[force]]\ngeneralized = {" + ", ".join(f"{q} = {json.dumps(f)}" for q, f in forces.items()) + "}\n")
        lines += [f'[[constraint]]\nname = "{name}"\nequation = {json.dumps(e + " = 0")}\n' for name, e in constraints]
        return "\n".join([*lines, *initial_lines]) + "\n"
