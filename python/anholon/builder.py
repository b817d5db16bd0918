"""Models written in Python."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Union

from ._errors import ModelError, MotionError
from ._model_file import ModelFile, value_text
from .expressions import Body, Equation, Expr, Place, Rotation, Term, _named, expr
from .functions import norm, unit
from .model import Model
from .reading import loads

On = Union[Expr, str, "tuple[Any, Any]"]
"""The point at which a force acts: the centre of a body or particle, or ``(body, place)``. A place of three components is along the
body's axes."""


def _directions(along: Any) -> Any:
    return along if along is None or isinstance(along, (list, tuple)) else expr(along).text


class Constraint:
    """A constraint or a contact of a :class:`Builder`."""

    def __init__(self, name: str) -> None:
        self.name: str = name

    @property
    def multiplier(self) -> Expr:
        """The multiplier of the constraint, for monitors, outputs and events. A vector constraint has ``multiplier.x`` and so on."""
        return _named(f"lambda.{self.name}")

    def __repr__(self) -> str:
        return f"<constraint {self.name}>"


class Builder:
    """Writes a model in Python expressions. :meth:`model` returns the immutable :class:`Model`, `text` is its file.

    Methods add the elements of the sections of a model file (doc/language.md). Names that formulas may hold, such as those of
    coordinates, parameters and bodies, are returned as expressions. A text is a formula of the model language and may stand in
    place of an expression. Numbers are exact: a ``float`` stands for the decimal that Python prints, an ``int``, a ``Fraction``
    or a ``Decimal`` for its value.

    Example:
        >>> import anholon as an
        >>> b = an.Builder("Chaplygin sleigh")
        >>> x, y, th = b.coordinates("x y th")
        >>> m, a, J = b.parameters(m=2, a=0.6, J=0.5)
        >>> blade = b.frame("blade", an.rotz(th))
        >>> P = b.point("P", x*an.ex + y*an.ey)
        >>> sleigh = b.body("sleigh", mass=m, inertia=J, center=P + a*blade.x, orientation=blade)
        >>> edge = b.constraint("edge", an.dot(P.vel(), blade.y) == 0)
        >>> b.initial({x: 0, y: 0, th: 0, x.dt: -0.5, th.dt: 1.5})
        >>> sleigh = b.model()
        >>> len(sleigh.simulate(to=5, every=1))
        6
    """

    def __init__(self, title: str, *, source: str = "") -> None:
        self.title: str = title
        self._file = ModelFile(title, source)

    # ---- the text, the model ----

    @property
    def text(self) -> str:
        """The model file, which ``anholon check`` reads."""
        return self._file.text

    def model(self, *, check: bool = False) -> Model:
        """Returns the model.

        Args:
            check: True checks that the initial state is consistent, too.

        Raises:
            ModelError: the model has mistakes; the message names the line of Python that wrote each of them, ``.diagnostics``
                its place in `text`.
            MotionError: with `check`, no state satisfies the constraints with the values given.

        Example:
            >>> import anholon as an
            >>> b = an.Builder("a bead")
            >>> x = b.coordinate("x")
            >>> bead = b.particle("bead", mass="mm", position=x*an.ex)
            >>> try:
            ...     b.model()
            ... except an.ModelError as error:
            ...     print(str(error).split(":", 2)[2].splitlines()[0])
             error: unknown name 'mm'
        """
        try:
            made = loads(self.text, name=self.title)
        except ModelError as error:
            raise self._file.in_python(error) from None
        if check:
            try:
                made.check()
            except MotionError as error:
                raise MotionError(self._file.with_lines_of_python(str(error)), error.outcome) from None
        return made

    def _entry(self, section: str, name: str, value: object) -> None:
        self._file.add_entry(section, name, value_text(value))

    def _element(self, section: str, keys: Mapping[str, object]) -> None:
        self._file.add_element(section, {name: value_text(value) for name, value in keys.items() if value is not None})

    # ---- names ----

    def coordinate(self, name: str) -> Expr:
        """Adds a coordinate."""
        self._file.add_coordinate(name)
        return _named(name, "coordinate")

    def coordinates(self, names: str | Iterable[str]) -> tuple[Expr, ...]:
        """Adds coordinates: ``x, y = b.coordinates("x y")``."""
        listed = names.replace(",", " ").split() if isinstance(names, str) else list(names)
        return tuple(self.coordinate(name) for name in listed)

    def dependent(self, *coordinates: Term) -> None:
        """Names the coordinates that forms without multipliers eliminate. Without a call the program chooses them."""
        self._file.add_to_head("dependent", value_text(coordinates))

    def parameter(self, name: str, value: Term, *, unit: str = "", doc: str = "") -> Expr:
        """Adds a parameter; its value is a number, a text with a unit ("8 cm"), or a formula of other parameters."""
        self._entry("parameters", name, {"value": value, **_given(unit=unit, doc=doc)} if unit or doc else value)
        return _named(name)

    def parameters(self, **values: Term) -> tuple[Expr, ...]:
        """Adds parameters: ``m, R = b.parameters(m=1, R="8 cm")``."""
        return tuple(self.parameter(name, value) for name, value in values.items())

    def function(self, name: str, value: Term | None = None, *, arguments: Sequence[str] = ()) -> Expr:
        """Adds a function of time, or of arguments, whose value is then ``an.call(name, …)``. A function without a value is unknown:
        the model has equations, but cannot be integrated."""
        self._entry("functions", f"{name}({', '.join(arguments)})" if arguments else name, {} if value is None else value)
        return _named(name, "coordinate" if not arguments else "vector")

    def define(self, name: str, value: Term) -> Expr:
        """Gives a formula a name, which equations print. The expression that is returned has the type of the formula."""
        self._entry("define", name, value)
        of = value if isinstance(value, Expr) else expr(value)
        return type(of)(name, 4, ("name", name, "vector")) if isinstance(of, (Rotation, Place)) else _named(name, "formula", of)

    def frame(self, name: str, rotation: Term) -> Rotation:
        """Adds a frame, a rotation from the observer's axes."""
        self._entry("frame", name, rotation)
        return Rotation(name, 4, ("name", name, "vector"))

    def point(self, name: str, position: Term) -> Place:
        """Adds a point by its position, a vector or three components."""
        self._entry("point", name, position)
        return Place(name, 4, ("name", name, "vector"))

    # ---- bodies, particles ----

    def body(
        self,
        name: str,
        *,
        center: Term,
        mass: Term | None = None,
        inertia: Any = None,
        orientation: Term | None = None,
        angle: Term | None = None,
        shape: str | None = None,
        axes: Any = None,
        expelled_velocity: Term | None = None,
        exit_point: Term | None = None,
    ) -> Body:
        """Adds a body.

        Args:
            name: the name of the body and of the frame of its axes.
            center: the mass centre.
            mass: the mass; it may depend on time, states, coordinates and velocities.
            inertia: a number (plane, about z), three moments or a matrix, along the body's axes at the mass centre.
            orientation: the rotation of the body's axes.
            angle: instead of `orientation`: the angle of ``rotz(angle)``.
            shape: instead of `inertia`: a homogeneous solid, ``"disc(R)"``.
            axes: instead of `inertia`, for experts: a list of ``{"weight": …, "vector": …}``.
            expelled_velocity: the velocity of matter that leaves or joins, relative to the material point at `exit_point`.
            exit_point: the point at which the matter leaves or joins; three components are along the body's axes.
        """
        self._element(
            "body",
            {"name": name, "mass": mass, "shape": shape, "inertia": inertia, "center": center, "orientation": orientation, "angle": angle, "axes": axes}
            | {"expelled_velocity": expelled_velocity, "exit_point": exit_point},
        )
        return Body(name, 4, ("name", name, "vector"))

    def particle(self, name: str, *, mass: Term, position: Term, expelled_velocity: Term | None = None) -> Place:
        """Adds a particle, which is a point, too."""
        self._element("particle", {"name": name, "mass": mass, "position": position, "expelled_velocity": expelled_velocity})
        return Place(name, 4, ("name", name, "vector"))

    # ---- forces ----

    def force(
        self,
        on: On | None = None,
        vector: Term | None = None,
        *,
        from_: On | None = None,
        torque: Term | None = None,
        tension: Term | None = None,
        generalized: Mapping[Any, Term] | None = None,
        name: str | None = None,
    ) -> None:
        """Adds a force (`vector`), a torque, or a tension that pulls `on` and `from_` together; `from_` feels the opposite.

        Args:
            on: a body or particle, or ``(body, place)``.
            vector: the force, a vector.
            from_: the other body, particle or ``(body, place)``; without it the force acts from outside.
            torque: the torque, a vector.
            tension: the tension, a number, along the line from `on` to `from_`.
            generalized: instead of all these, generalized forces: ``{coordinate: force}``.
            name: the name in reports.
        """
        given = None if generalized is None else {expr(q).text: value for q, value in generalized.items()}
        self._element(
            "force",
            {"name": name, "on": _on(on), "from": _on(from_), "vector": vector, "torque": torque, "tension": tension, "generalized": given},
        )

    def spring(self, on: On, to: On, *, stiffness: Term, length: Term = 0, damping: Term = 0, name: str | None = None) -> None:
        """Adds a spring with a parallel damper between two bodies, or between a body and a point of the observer.

        Args:
            on: a body or particle, or ``(body, place)`` with a place in the observer's axes.
            to: the other body, particle or ``(body, place)``, or a :class:`Place` that is no particle.
            stiffness: the stiffness, N/m.
            length: the length without force, m.
            damping: the damping coefficient, N s/m.
            name: the name in reports.
        """
        here, there = _place(on), _place(to)
        distance = norm(here - there)
        k, c, free = expr(stiffness), expr(damping), expr(length)
        pull = k * (distance if free.text == "0" else distance - free)
        if c.text != "0":
            pull = pull + c * distance.d(1)
        if isinstance(to, tuple) or self._has_mass(to):
            self._element("force", {"name": name, "on": _on(on), "from": _on(to), "tension": pull})
        else:
            self._element("force", {"name": name, "on": _on(on), "vector": pull * unit(there - here)})

    def _has_mass(self, what: On) -> bool:
        name = expr(what).text
        return self._file.has_element("body", name) or self._file.has_element("particle", name)

    def gravity(self, field: Term, *, gradient: bool = False) -> None:
        """Sets the acceleration of gravity at the place ``an.here``; it acts on every mass."""
        self._entry("gravity", "field", field)
        if gradient:
            self._entry("gravity", "gradient", True)

    def potential(self, name: str, energy: Term) -> None:
        """Adds a potential energy."""
        self._entry("potential", name, energy)

    def dissipation(self, name: str, power: Term) -> None:
        """Adds a dissipation function R; its forces are -dR/dq'."""
        self._entry("dissipation", name, power)

    def table(
        self,
        name: str,
        x: Sequence[Term] | None = None,
        y: Sequence[Term] | None = None,
        *,
        file: str | os.PathLike[str] | None = None,
        columns: Sequence[str | int] | None = None,
        fit: str | None = None,
        outside: str | None = None,
    ) -> None:
        """Adds a function by its values; ``an.call(name, at)`` calls it.

        Args:
            name: the name of the function.
            x: the knots, ascending.
            y: the values at x.
            file: instead of x and y, a text file of columns. :meth:`model` looks for it in the working directory.
            columns: two names of the heading of the file, or numbers from 1; the first two if it is None.
            fit: ``hold``, ``linear``, ``monotone`` or ``spline``: the values between the knots; ``linear`` if it is None.
            outside: ``hold``, ``linear`` or ``error``: the values beyond the knots; ``hold`` if it is None.
        """
        keys = {"name": value_text(name)}
        for key, values in (("x", x), ("y", y)):
            if values is not None:
                keys[key] = "[" + ", ".join(expr(value).text for value in values) + "]"
        if file is not None:
            keys["file"] = value_text(os.fspath(file))
        if columns is not None:
            keys["columns"] = "[" + ", ".join(str(column) if isinstance(column, int) else value_text(column) for column in columns) + "]"
        for key, word in (("fit", fit), ("outside", outside)):
            if word is not None:
                keys[key] = value_text(word)
        self._file.add_element("table", keys)

    # ---- constraints, control, time ----

    def constraint(
        self, name: str, equation: Equation | str, *, along: Any = None, by: Any = None, active: Term | None = None, one_sided: bool = False
    ) -> Constraint:
        """Adds a constraint ``a == b`` of numbers or vectors, of any order.

        Args:
            name: the name; the multiplier of the constraint is ``lambda.NAME``.
            equation: ``dot(P.vel(), blade.y) == 0``, or a text.
            along: for a vector equation: a frame or a list of vectors along which its components are taken.
            by: the inputs that keep the constraint, which is then a servo constraint.
            active: a formula of modes; the constraint holds while it is positive.
            one_sided: True for a constraint that pushes and does not pull: left - right may become positive.
        """
        _must_be_equation(equation)
        inputs = None if by is None else [expr(u).text for u in by] if isinstance(by, (list, tuple)) else expr(by).text
        self._element(
            "constraint",
            {"name": name, "equation": equation, "along": _directions(along), "by": inputs, "active": active}
            | {"one_sided": True if one_sided else None},
        )
        return Constraint(name)

    def contact(
        self,
        name: str,
        *,
        gap: Term | None = None,
        slip: Any = None,
        along: Any = None,
        body: Term | None = None,
        shape: str | None = None,
        at: Term | None = None,
        normal: Term | None = None,
        through: Term | None = None,
        on: str | None = None,
        friction: Term | None = None,
        static_friction: Term | None = None,
        rolling_resistance: Term | None = None,
        drilling_resistance: Term | None = None,
        restitution: Term | None = None,
        impact: str | None = None,
    ) -> Constraint:
        """Adds a contact that pushes, with Coulomb friction and impacts. The ``multiplier`` of the value returned is the normal force.

        Args:
            name: the name, with which its events and columns begin: ``floor.hits``, ``floor.gap``.
            gap: the distance, which is not negative.
            slip: the relative tangential velocity: a number, a list of two, or a vector with `along`.
            along: the tangential directions of a vector `slip`.
            body: instead of `gap` and `slip`: the body that touches, with its shape.
            shape: the shape that touches, ``"ball(R)"``; that of the body if it is None.
            at: the place of the shape; the centre of the body if it is None.
            normal: the normal of the plane; ``ez`` if it is None.
            through: a point of the plane, or the centre of the ball or bowl.
            on: ``"ball(R)"`` or ``"bowl(R)"`` instead of the plane.
            friction: Coulomb's coefficient.
            static_friction: the coefficient while the contact sticks.
            rolling_resistance: the coefficient of rolling resistance, a length.
            drilling_resistance: the coefficient of drilling resistance, a length.
            restitution: the coefficient of restitution, from 0 to 1.
            impact: the law of impact, ``"newton"`` or ``"poisson"``.
        """
        self._element(
            "contact",
            {"name": name, "gap": gap, "slip": slip, "along": _directions(along), "body": body, "shape": shape, "at": at}
            | {"normal": normal, "through": through, "on": on, "friction": friction, "static_friction": static_friction}
            | {"rolling_resistance": rolling_resistance, "drilling_resistance": drilling_resistance}
            | {"restitution": restitution, "impact": impact},
        )
        return Constraint(name)

    def quasi(self, name: str, velocity: Term) -> Expr:
        """Adds a quasi-velocity."""
        self._entry("quasi", name, velocity)
        return _named(name, "formula", expr(velocity))

    def observer(self, **motion: Term) -> None:
        """Sets the motion of the observer: ``spin`` or ``rotation``, and one of ``origin_acceleration``, ``origin_velocity``,
        ``origin_velocity_inertial``, ``origin_position_inertial``."""
        for key, value in motion.items():
            self._entry("observer", key, value)

    def state(self, name: str, rate: Term, initial: Term = 0) -> Expr:
        """Adds a state, a number with a rate of its own."""
        self._entry("state", name, {"rate": rate, "initial": initial})
        return _named(name, "coordinate")

    def mode(self, name: str, value: Term) -> Expr:
        """Adds a mode, a number that only events change."""
        self._file.add_entry("mode", name, expr(value).text)
        return _named(name)

    def event(
        self, name: str, when: Term, *, direction: str | None = None, set: Mapping[Any, Term] | None = None, stop: bool = False
    ) -> None:
        """Adds an event at zeros of `when`, which sets modes, states, coordinates and velocities, or ends the motion. With the
        direction ``"up"`` or ``"down"`` only zeros at which `when` rises or falls count."""
        given = None if set is None else {expr(q).text: value for q, value in set.items()}
        self._element("event", {"name": name, "when": when, "direction": direction, "set": given, "stop": True if stop else None})

    def input(self, name: str, value: Term | None = None) -> Expr:
        """Adds an input with its formula. An input without a formula is determined by a constraint that has it in ``by=``."""
        self._entry("input", name, {} if value is None else value)
        return _named(name, "coordinate")

    def output(self, name: str, value: Term, *, unit: str = "", doc: str = "", conserved: bool = False) -> None:
        """Adds an output, a column of runs: a number or a vector, which may depend on multipliers."""
        more: dict[str, object] = {**_given(unit=unit, doc=doc), **({"conserved": True} if conserved else {})}
        self._entry("output", name, {"value": value, **more} if more else value)

    def monitor(self, name: str, value: Term) -> None:
        """Adds a monitor, a number that is recorded along the motion."""
        self._entry("monitor", name, value)

    def initial(
        self,
        values: Mapping[Any, Term] | None = None,
        *,
        conditions: Iterable[Equation | str] = (),
        guess: Mapping[Any, Term] | None = None,
        branch: Mapping[str, str] | None = None,
        t: Term | None = None,
    ) -> None:
        """Sets the initial state: values by coordinate and derivative, ``{x: 1, x.dt: 0}``, and equations that hold there.

        Args:
            values: numbers or formulas of parameters. The values left out follow from the constraints.
            conditions: equations that are solved together with the constraints.
            guess: values near which the solution is looked for.
            branch: ``{constraint: "lambda > 0"}``, which chooses one of several solutions.
            t: the initial time, s.

        Raises:
            TypeError: `values` is no mapping.
        """
        if t is not None:
            self._entry("initial", "t", t)
        if values is not None and not isinstance(values, Mapping):
            raise TypeError("initial values are given by coordinate and derivative, as {x: 1, x.dt: 0}; equations are conditions=[x.dt == y]")
        for q, value in (values or {}).items():
            self._entry("initial", expr(q).text, value)
        listed = list(conditions)
        for condition in listed:
            _must_be_equation(condition)
        if listed:
            self._entry("initial", "conditions", listed)
        if guess:
            self._entry("initial", "guess", {expr(q).text: value for q, value in guess.items()})
        if branch:
            self._entry("initial", "branch", branch)

    def simulate(self, **settings: object) -> None:
        """Sets the defaults of :meth:`Model.simulate`, the section [simulate]: ``to=10, every=0.1``."""
        for key, value in settings.items():
            written = value_text(value) if isinstance(value, (str, bool, list, tuple)) else expr(value).text
            self._file.add_entry("simulate", key.replace("_", "-"), written)

    def __repr__(self) -> str:
        return f"<builder of {self.title!r}: coordinates {', '.join(self._file.coordinates) or 'none yet'}>"


def _given(**texts: str) -> dict[str, object]:
    return {key: text for key, text in texts.items() if text}


def _must_be_equation(equation: object) -> None:
    if not isinstance(equation, (Equation, str)):
        raise TypeError(f"an equation is written a == b, with an expression on one side, or as a text; this is {equation!r}")


def _on(what: On | None) -> object:
    if what is None:
        return None
    if isinstance(what, tuple):
        body, place = what
        return {"body": expr(body).text, "at": place}
    return expr(what).text


def _place(what: On) -> Expr:
    if isinstance(what, tuple):
        body, place = what
        if isinstance(place, (list, tuple)):
            return body.center + body(*place)  # type: ignore[no-any-return]
        return expr(place)
    return what.center if isinstance(what, Body) else expr(what)
