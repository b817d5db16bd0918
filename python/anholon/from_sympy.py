"""Models from ``sympy.physics.mechanics``: KanesMethod, LagrangesMethod with bodies, System.

What is read is the mechanical system itself: bodies, velocities, loads and constraints; the equations are then derived anew.
Generalized speeds are replaced by the rates of the coordinates, and loads become generalized forces. A mass centre whose
position SymPy does not know (only its velocity was set) gets coordinates of its own, which follow its velocity by constraints.
A speed without a coordinate (the spin of a wheel) gets one whose rate it is.
"""

from __future__ import annotations

import importlib
import json
import random
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from ._errors import ModelError
from ._numbers import Number, text_of
from .model import Model, loads

_RESERVED = {"t", "pi", "ex", "ey", "ez", "e", "i", "D", "lambda"}


def _sympy() -> Any:
    return importlib.import_module("sympy")


def _mechanics() -> Any:
    return importlib.import_module("sympy.physics.mechanics")


@dataclass
class _Parts:
    """What the objects of SymPy have in common."""

    frame: Any
    q: list[Any]
    u: list[Any]
    kinematic: list[Any]  # expressions that vanish
    bodies: list[Any]
    loads: list[Any]
    holonomic: list[Any] = field(default_factory=list)
    velocity: list[Any] = field(default_factory=list)


def _parts_of(method: Any) -> _Parts:
    mechanics = _mechanics()

    if isinstance(method, mechanics.KanesMethod):
        rates = method.kindiffdict()
        velocity = list(method._k_nh * method.u + method._f_nh) if method._k_nh else []
        return _Parts(
            method._inertial,
            list(method.q),
            list(method.u),
            [rate - value for rate, value in rates.items()],
            list(method.bodies),
            list(method.loads or []),
            list(method._f_h or []),
            velocity,
        )
    if isinstance(method, mechanics.LagrangesMethod):
        if not method.bodies:
            raise ModelError("a LagrangesMethod is read by its bodies, and this one has none\nhint: LagrangesMethod(L, q, bodies=[…], frame=N)")
        return _Parts(
            method.inertial,
            list(method.q),
            [],
            [],
            list(method.bodies),
            list(method.loads or []) + _potential_loads(method),
            list(method._hol_coneqs or []),
            list(getattr(method, "_nonhol_coneqs", None) or []) or _nonholonomic_of(method),
        )
    if isinstance(method, mechanics.System):
        return _Parts(
            method.frame,
            list(method.q),
            list(method.u),
            list(method.kdes),
            list(method.bodies),
            list(method.loads) + [load for actuator in method.actuators for load in actuator.to_loads()],
            list(method.holonomic_constraints),
            list(method.velocity_constraints or method.nonholonomic_constraints),
        )
    raise TypeError(f"from_sympy reads a KanesMethod, LagrangesMethod or System, not a {type(method).__name__}")


def _nonholonomic_of(method: Any) -> list[Any]:
    """The nonholonomic constraints of a LagrangesMethod: its velocity constraints beyond the rates of the holonomic ones."""
    count = len(method._hol_coneqs or [])
    return [] if method.coneqs is None or len(method.coneqs) == 0 else list(method.coneqs)[count:]


def _potential_loads(method: Any) -> list[Any]:
    """The loads of the potential energies of the bodies, as generalized forces ``(coordinate, force)``."""
    sm = _sympy()

    energy = sum((body.potential_energy for body in method.bodies), sm.Integer(0))
    return [(q, -sm.diff(energy, q)) for q in method.q]


class _Writer:
    """Writes expressions of SymPy as formulas of a model file, and gives every symbol a name."""

    def __init__(self, parts: _Parts) -> None:
        sm, dynamicsymbols = _sympy(), _mechanics().dynamicsymbols

        self._sm = sm
        self.time = dynamicsymbols._t
        self.names: dict[Any, str] = {}
        self._taken = set(_RESERVED)
        for q in parts.q:
            self.names[q] = self.new(str(q.func))
        self.q = parts.q
        self.rates = [q.diff(self.time) for q in parts.q]
        self.parameters: dict[Any, str] = {}
        self.functions: dict[Any, str] = {}

    def new(self, wish: str) -> str:
        """A name that is not taken yet."""
        name = re.sub(r"\W+", "_", wish).strip("_") or "s"
        if name[0].isdigit() or name in self._taken:
            name = "s_" + name
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name

    def formula(self, e: Any) -> str:
        """The formula of an expression in coordinates, rates, parameters and the time."""
        sm = self._sm
        e = sm.sympify(e)
        if e in self.names:
            return self.names[e]
        if isinstance(e, sm.Derivative):
            inner, (variable, order) = e.args[0], e.args[1]
            if inner in self.names and variable == self.time:
                return self.names[inner] + "'" * int(order)
            raise ModelError(f"the derivative {e} is not one of a coordinate by the time")
        if e == self.time:
            return "t"
        if e is sm.pi:
            return "pi"
        if e is sm.E:
            return "exp(1)"
        if e.is_Integer:
            return f"({int(e)})" if int(e) < 0 else str(int(e))
        if e.is_Rational:
            return f"({e.p}/{e.q})"
        if e.is_Float:
            return f"({text_of(float(e))})"
        if isinstance(e, sm.Symbol):
            return self.parameters.get(e) or self._parameter(e)
        if isinstance(e, sm.core.function.AppliedUndef):
            if e not in self.functions:
                self.functions[e] = self.new(str(e.func))
            return self.functions[e]
        if e.is_Add:
            return "(" + " + ".join(self.formula(x) for x in e.args) + ")"
        if e.is_Mul:
            return "(" + "*".join(self.formula(x) for x in e.args) + ")"
        if e.is_Pow:
            base, exponent = e.as_base_exp()
            return f"sqrt({self.formula(base)})" if exponent == sm.Rational(1, 2) else f"({self.formula(base)})^({self.formula(exponent)})"
        known = {sm.Abs: "abs", sm.log: "log", sm.sign: "sign"}
        function = known.get(e.func, str(e.func))
        return f"{function}({', '.join(self.formula(x) for x in e.args)})"

    def _parameter(self, symbol: Any) -> str:
        self.parameters[symbol] = name = self.new(symbol.name)
        return name


def _name_of(key: Any) -> str:
    """The name of a symbol, of a function of time without its argument, or a name itself."""
    return str(key.func) if getattr(key, "args", ()) else str(key)


class _Import:
    """One import: the parts with speeds replaced by rates, and the text that is made of them."""

    def __init__(self, method: Any) -> None:
        sm = _sympy()

        self.sm = sm
        self.parts = parts = _parts_of(method)
        self._add_angles(parts)
        self.writer = _Writer(parts)
        self.speeds = self._speeds()
        self.extra: list[tuple[str, Any]] = []  # coordinates of mass centres, and their rates

    @staticmethod
    def _add_angles(parts: _Parts) -> None:
        """Coordinates for speeds that no kinematic differential equation knows."""
        symbols = _mechanics().dynamicsymbols
        unknown = [u for u in parts.u if not any(e.has(u) for e in parts.kinematic)]
        if len(unknown) != len(parts.u) - len(parts.q):
            return
        for u in unknown:
            angle = symbols(f"{u.func}_angle")
            parts.q.append(angle)
            parts.kinematic.append(angle.diff(symbols._t) - u)

    def _speeds(self) -> dict[Any, Any]:
        """Generalized speeds in coordinates and their rates."""
        sm, parts = self.sm, self.parts
        if not parts.u:
            return {}
        rates = self.writer.rates
        dummies = [sm.Dummy() for _ in parts.u]
        equations = sm.Matrix([e.xreplace(dict(zip(parts.u, dummies, strict=True))) for e in parts.kinematic])
        a = equations.jacobian(dummies)
        if a.shape[0] != a.shape[1]:
            raise ModelError(f"{len(parts.u)} generalized speeds for {len(rates)} rates of coordinates: from_sympy needs as many")
        b = equations.xreplace(dict.fromkeys(dummies, sm.Integer(0)))
        solved = a.LUsolve(-b)
        if any(x.has(sm.nan, sm.zoo) for x in solved):
            raise ModelError("the kinematic differential equations cannot be solved for the generalized speeds")
        return dict(zip(parts.u, (sm.simplify(x) if sm.count_ops(x) < 200 else x for x in solved), strict=True))

    def in_rates(self, e: Any) -> Any:
        """An expression without generalized speeds."""
        e = self.sm.sympify(e)
        # Rates of speeds come from the product rule in velocities of velocities; there are none in velocities.
        return e.xreplace(self.speeds)

    def components(self, vector: Any) -> list[Any]:
        """Components along the inertial axes."""
        return [self.in_rates(x) for x in vector.to_matrix(self.parts.frame)]

    def _vanishes(self, expressions: Iterable[Any]) -> bool:
        """Whether expressions vanish at random values of all that is in them, with 30 digits."""
        sm, draw = self.sm, random.Random(1)
        expressions = list(expressions)
        atoms: set[Any] = set()
        for e in expressions:
            atoms |= e.atoms(sm.Derivative) | e.atoms(sm.core.function.AppliedUndef) | {s for s in e.free_symbols if s != self.writer.time}
        for _ in range(3):
            values = {a: sm.Float(draw.uniform(0.3, 1.3), 30) for a in atoms}
            order = sorted(values, key=lambda a: not isinstance(a, sm.Derivative))
            for e in expressions:
                for a in order:
                    e = e.subs(a, values[a])
                if abs(sm.N(e.subs(self.writer.time, sm.Float("0.7", 30)), 30)) > 1e-20:
                    return False
        return True

    def position(self, point: Any) -> list[Any] | None:
        """The position of a point in the inertial frame if its rate is the point's velocity, else None."""
        velocity = self.components(point.vel(self.parts.frame))
        seen, queue = {point}, [point]
        while queue:
            here = queue.pop(0)
            if here._vel_dict.get(self.parts.frame) == 0:
                place = [self.sm.sympify(x) for x in point.pos_from(here).to_matrix(self.parts.frame)]
                if self._vanishes([self.in_rates(x.diff(self.writer.time)) - v for x, v in zip(place, velocity, strict=True)]):
                    return place
            for neighbour in here._pos_dict:
                if neighbour not in seen:
                    seen.add(neighbour)
                    queue.append(neighbour)
        return None

    def center(self, name: str, point: Any) -> list[str]:
        """The formulas of a mass centre; without a position it gets coordinates."""
        place = self.position(point)
        if place is not None:
            return [self.writer.formula(x) for x in place]
        velocity = self.components(point.vel(self.parts.frame))
        names = []
        for axis, rate in zip("xyz", velocity, strict=True):
            if rate == 0:
                names.append("0")
                continue
            coordinate = self.writer.new(f"{name}_{axis}")
            self.extra.append((coordinate, rate))
            names.append(coordinate)
        return names

    def _turn(self, body: Any) -> tuple[Any, Any]:
        """The rotation of a body's axes against the inertial ones, and its inertia along them.

        A frame that only has an angular velocity is that of a wheel, if the inertia is given along the axes of another
        frame in which it turns about an axis of symmetry.
        """
        frame = self.parts.frame
        try:
            return frame.dcm(body.frame), body.central_inertia.to_matrix(body.frame)
        except ValueError:
            pass
        carrier = body.central_inertia.args[0][1].args[0][1]
        inertia = body.central_inertia.to_matrix(carrier)
        spin = [self.in_rates(x) for x in body.frame.ang_vel_in(carrier).to_matrix(carrier)]
        axes = [k for k, x in enumerate(spin) if x != 0]
        rates = self.writer.rates
        if len(axes) != 1 or spin[axes[0]] not in rates:
            raise ModelError(f"the frame of {body.name} has no orientation, and does not turn about one axis of the frame of its inertia")
        k = axes[0]
        i, j = (k + 1) % 3, (k + 2) % 3
        if inertia[i, i] != inertia[j, j] or any(inertia[a, b] != 0 for a in range(3) for b in range(3) if a != b):
            raise ModelError(f"the frame of {body.name} has no orientation, and its inertia is not symmetric about the axis of its spin")
        angle = self.writer.q[rates.index(spin[k])]
        sm = self.sm
        about = sm.eye(3)
        about[i, i], about[i, j], about[j, i], about[j, j] = sm.cos(angle), -sm.sin(angle), sm.sin(angle), sm.cos(angle)
        return frame.dcm(carrier) * about, inertia

    def body(self, body: Any) -> str:
        """The entry of a body or particle."""
        Particle = _mechanics().Particle

        point = body.point if isinstance(body, Particle) else body.masscenter
        spin = [] if isinstance(body, Particle) else self.components(body.frame.ang_vel_in(self.parts.frame))
        if not any(spin):
            # What does not turn has no use for an inertia, what rests none for a mass.
            if not any(self.components(point.vel(self.parts.frame))):
                return ""
            name = self.writer.new(str(body.name))
            center = json.dumps(self.center(name, point))
            return f"[[particle]]\nname = {json.dumps(name)}\nmass = {json.dumps(self.writer.formula(body.mass))}\nposition = {center}\n"
        name = self.writer.new(str(body.name))
        turn, tensor = self._turn(body)
        rows = tensor.tolist()
        inertia: Any = [[self.writer.formula(x) for x in row] for row in rows]
        if all(x == 0 for i, row in enumerate(rows) for j, x in enumerate(row) if (i, j) != (2, 2)):
            inertia = inertia[2][2]  # of a body in the plane
        turned = [[self.writer.formula(x) for x in row] for row in turn.tolist()]
        rate = turn.diff(self.writer.time) * turn.T
        if not self._vanishes([self.in_rates(rate[2, 1]) - spin[0], self.in_rates(rate[0, 2]) - spin[1], self.in_rates(rate[1, 0]) - spin[2]]):
            raise ModelError(f"the angular velocity that was set for the frame of {body.name} is not that of its orientation")
        matrix = "matrix([" + ", ".join("[" + ", ".join(row) + "]" for row in turned) + "])"
        return (
            f"[[body]]\nname = {json.dumps(name)}\nmass = {json.dumps(self.writer.formula(body.mass))}\n"
            f"inertia = {json.dumps(inertia)}\ncenter = {json.dumps(self.center(name, body.masscenter))}\norientation = {json.dumps(matrix)}\n"
        )

    def generalized_forces(self) -> dict[Any, Any]:
        """The sum of all loads, by coordinate."""
        Point, ReferenceFrame = _mechanics().Point, _mechanics().ReferenceFrame

        sm, frame = self.sm, self.parts.frame
        sums: dict[Any, Any] = {}
        for load in self.parts.loads:
            at, what = load[0], load[1]
            if isinstance(at, (Point, ReferenceFrame)):
                flow = self.components(at.vel(frame) if isinstance(at, Point) else at.ang_vel_in(frame))
                force = self.components(what)
                for q, rate in zip(self.writer.q, self.writer.rates, strict=True):
                    sums[q] = sums.get(q, 0) + sum((f * sm.diff(v, rate) for f, v in zip(force, flow, strict=True)), sm.Integer(0))
            else:
                sums[at] = sums.get(at, 0) + self.in_rates(what)
        return {q: s for q, s in sums.items() if s != 0}

    def velocity_constraints(self) -> list[Any]:
        """Those that do not follow from the holonomic ones or from others, by the rank at random points."""
        sm, draw = self.sm, random.Random(2)
        rates = self.writer.rates
        listed = [self.in_rates(e.diff(self.writer.time)) for e in self.parts.holonomic]
        rows, kept = [sm.Matrix([e]).jacobian(rates) for e in listed], []
        atoms: set[Any] = set()
        wanted = [self.in_rates(e) for e in self.parts.velocity]
        for e in [*listed, *wanted]:
            atoms |= e.atoms(sm.core.function.AppliedUndef) | e.free_symbols
        values = {a: sm.Float(draw.uniform(0.3, 1.3), 40) for a in atoms}

        def at_point(row: Any) -> list[Any]:
            return [sm.N(x.xreplace(values), 40) for x in row]

        numbers = [at_point(row) for row in rows]
        rank = sm.Matrix(numbers).rank(iszerofunc=lambda x: abs(x) < 1e-20) if numbers else 0
        for e in wanted:
            numbers.append(at_point(sm.Matrix([e]).jacobian(rates)))
            if sm.Matrix(numbers).rank(iszerofunc=lambda x: abs(x) < 1e-20) > rank:
                rank += 1
                kept.append(e)
            else:
                numbers.pop()
        return kept

    def text(self, title: str, values: Mapping[Any, Number], initial: Mapping[Any, Number]) -> str:
        """The model file."""
        w = self.writer
        bodies = [self.body(b) for b in self.parts.bodies]
        constraints = [(f"holonomic{k + 1}", w.formula(e)) for k, e in enumerate(self.parts.holonomic)]
        constraints += [(f"velocity{k + 1}", w.formula(e)) for k, e in enumerate(self.velocity_constraints())]
        constraints += [(f"center_{name}", f"{name}' - {w.formula(rate)}") for name, rate in self.extra]
        forces = {w.names[q]: w.formula(s) for q, s in self.generalized_forces().items()}
        by_name = {_name_of(key): value for key, value in values.items()}
        missing = sorted(symbol.name for symbol in w.parameters if symbol.name not in by_name)
        if missing:
            raise ModelError(f"values are missing for {', '.join(missing)}\nhint: from_sympy(…, values={{{missing[0]}: 1}})")
        lines = [f"title = {json.dumps(title)}", 'source = "imported from sympy.physics.mechanics"', ""]
        lines.append(f"coordinates = {json.dumps([w.names[q] for q in w.q] + [name for name, _ in self.extra])}\n")
        if w.parameters:
            lines.append("[parameters]")
            for symbol, name in w.parameters.items():
                lines.append(f"{name} = {json.dumps(text_of(by_name[symbol.name]))}")
            lines.append("")
        if w.functions:
            lines.append("[functions]")
            for function, name in w.functions.items():
                value = by_name.get(str(function.func))
                lines.append(f"{name} = {json.dumps(text_of(value)) if value is not None else '{}'}")
            lines.append("")
        lines += bodies
        if forces:
            lines.append("[[force]]\ngeneralized = {" + ", ".join(f"{q} = {json.dumps(f)}" for q, f in forces.items()) + "}\n")
        lines += [f'[[constraint]]\nname = "{name}"\nequation = {json.dumps(e + " = 0")}\n' for name, e in constraints]
        given = {self.writer.names.get(key, _name_of(key)): value for key, value in initial.items()}
        if given:
            lines.append("[initial]")
            lines += [f"{json.dumps(name)} = {json.dumps(text_of(value))}" for name, value in given.items()]
        return "\n".join(lines) + "\n"


def from_sympy(method: Any, *, title: str = "from SymPy", values: Mapping[Any, Number] | None = None, initial: Mapping[Any, Number] | None = None) -> Model:
    """The model of a KanesMethod, a LagrangesMethod with bodies, or a System of ``sympy.physics.mechanics``.

    Args:
        method: the object of SymPy.
        title: of the model.
        values: of all symbols, and of given functions of time; without one of these nothing is simulated.
        initial: values of coordinates (symbols or names) and of their rates (names such as ``"q1'"``).

    Returns:
        A model; ``model.text`` is its file. Coordinates and parameters keep their names where these are names.

    Raises:
        ModelError: something has no counterpart in a model.
        TypeError: the object is none of these.

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
    made = _Import(method)
    text = made.text(title, values or {}, initial or {})
    return loads(text, name="model from SymPy")
