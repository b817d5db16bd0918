"""Bodies of ``sympy.physics.mechanics`` as elements of a model file: axes, inertia, and the velocity of matter that they lose."""

from __future__ import annotations

import json
import random
import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ._errors import ModelError
from ._sympy_parts import atoms_of, center_of, exact, integral_of, is_particle, numeric, short_decimal, vanish, with_values
from ._sympy_plain import mechanics_module, plain, sympy_module
from ._sympy_turns import factors_between, orientation

if TYPE_CHECKING:
    from ._sympy_import import Import


@dataclass
class Turned:
    """The rotation of a body."""

    spin: Any  # angular velocity of the body, along the inertial axes
    rotation: Any  # rotation matrix from the axes of the body to the inertial axes
    inertia: Any  # inertia matrix along the axes of the body
    factors: list[Any]  # rotation matrices whose product is the rotation
    oriented: bool = True  # whether SymPy knows the rotation
    angles: list[Any] | None = None  # of a sphere without axes: expressions whose rates are the components of its angular velocity

    @property
    def own(self) -> Any:
        """The angular velocity of the body along its own axes."""
        return self.rotation.T * self.spin


class Bodies:
    """The bodies of an import."""

    def __init__(self, made: Import) -> None:
        self._made = made
        self._turned: dict[int, Turned | None] = {}

    def spin(self, body: Any) -> list[Any]:
        """Returns the components of the angular velocity along the inertial axes; an empty list if the body does not turn."""
        made = self._made
        found = [] if is_particle(body) else made.components(body.frame.ang_vel_in(made.parts.frame))
        return found if any(found) else []

    def turned(self, body: Any) -> Turned | None:
        """Returns the rotation and inertia of a body whose speeds are known; None if it does not turn or has no inertia."""
        if id(body) not in self._turned:
            spin = self.spin(body)
            self._turned[id(body)] = self._read(body, sympy_module().Matrix(spin)) if spin else None
        return self._turned[id(body)]

    def _read(self, body: Any, spin: Any) -> Turned | None:
        """Reads the rotation and inertia of a body. A frame that has an angular velocity only is accepted for a sphere, and for a wheel:
        a body whose inertia is given along the axes of another frame, in which it turns about an axis of symmetry."""
        made, sm = self._made, sympy_module()
        frame = made.parts.frame
        try:
            inertia = body.central_inertia.to_matrix(body.frame).applyfunc(plain).applyfunc(_without_what_cancels)
            return Turned(spin, frame.dcm(body.frame).applyfunc(plain), inertia, factors_between(frame, body.frame))
        except ValueError:
            pass
        refused = ModelError(
            f"the frame of {body.name} has only an angular velocity, and its inertia is neither that of a sphere nor symmetric about the one axis of "
            f"a frame with an orientation about which it turns\nhint: orient the frame, as by {body.frame.name}.orient_axis(B, B.y, angle) with a "
            f"coordinate angle, and give the inertia along the axes of {body.frame.name}"
        )
        if not body.central_inertia.args:
            return None
        carrier = body.central_inertia.args[0][1].args[0][1]
        try:
            inertia = body.central_inertia.to_matrix(carrier).applyfunc(plain)
            products = [inertia[a, b] for a in range(3) for b in range(3) if a != b]
            if vanish([*products, inertia[0, 0] - inertia[1, 1], inertia[1, 1] - inertia[2, 2]], {}):
                angles = [self._angle(f"{body.name}_{axis}", rate) for axis, rate in zip("xyz", spin, strict=True)]
                return Turned(spin, sm.eye(3), inertia, [], False, angles)
            turn = frame.dcm(carrier).applyfunc(plain)
            own = [made.in_rates(x) for x in body.frame.ang_vel_in(carrier).to_matrix(carrier)]
        except ValueError:
            raise refused from None
        axes = [k for k, x in enumerate(own) if not vanish([x], {})]
        k = axes[0] if axes else 2
        i, j = (k + 1) % 3, (k + 2) % 3
        if len(axes) > 1 or not vanish([*products, inertia[i, i] - inertia[j, j]], {}):
            raise refused
        angle, about = self._angle(f"{body.name}_angle", own[k]), sm.eye(3)
        about[i, i], about[i, j], about[j, i], about[j, j] = sm.cos(angle), -sm.sin(angle), sm.sin(angle), sm.cos(angle)
        return Turned(spin, turn * about, inertia, [*factors_between(frame, carrier), about], False)

    def _angle(self, wish: str, rate: Any) -> Any:
        """Returns an expression with this rate, or a new coordinate to which a constraint gives this rate."""
        made = self._made
        if vanish([rate], {}):
            return sympy_module().Integer(0)
        whole = integral_of(rate, made.writer.q, made.writer.rates)
        if whole is None:
            whole = made.add_coordinate(re.sub(r"[^A-Za-z0-9]+", "_", wish))
            made.centers.append((f"turn_{whole.func}", whole.diff(made.time) - rate))
        return whole

    def entry(self, body: Any, given: Mapping[Any, Any]) -> str:
        """Returns the entry of a body or particle in the model file."""
        made, w = self._made, self._made.writer
        point, turned = center_of(body), self.turned(body)
        if turned is None and not any(made.components(point.vel(made.parts.frame))):
            return ""  # a body that does not turn needs no inertia, and one at rest no mass
        name = w.new(str(body.name))
        center, mass = json.dumps(made.center(point)), json.dumps(w.formula(plain(body.mass)))
        if turned is None:
            return f"[[particle]]\nname = {json.dumps(name)}\nmass = {mass}\nposition = {center}\n{self._expelled(body)}"
        begin = f"[[body]]\nname = {json.dumps(name)}\nmass = {mass}\n"
        if turned.angles is not None:
            axis = {"weight": turned.inertia[0, 0], "vector": turned.angles}
            return f"{begin}axes = [{self._axis(axis)}]\ncenter = {center}\n{self._expelled(body)}"
        rate = turned.rotation.diff(w.time) * turned.rotation.T
        differ = [made.in_rates(x) - s for x, s in zip((rate[2, 1], rate[0, 2], rate[1, 0]), turned.spin, strict=True)]
        if turned.oriented and not made._vanishes(differ):
            raise ModelError(f"the angular velocity that was set for the frame of {body.name} is not that of its orientation")
        axes = orientation(turned.rotation, turned.factors, w.formula)
        return f"{begin}{self._inertia(body, turned, given)}\ncenter = {center}\norientation = {json.dumps(axes)}\n{self._expelled(body)}"

    def _axis(self, axis: Mapping[str, Any]) -> str:
        formula = self._made.writer.formula
        return f'{{weight = {json.dumps(formula(short_decimal(axis["weight"])))}, vector = {json.dumps([formula(x) for x in axis["vector"]])}}}'

    def _inertia(self, body: Any, turned: Turned, given: Mapping[Any, Any]) -> str:
        """Returns the line of the inertia: a number for a body that turns about its own z axis, a matrix, or weighted axes for moments
        that no body can have. Moments that do not act on the motion are replaced by those of a body with the same motion."""
        sm, formula = sympy_module(), self._made.writer.formula
        inertia, acting = turned.inertia, [k for k in range(3) if not vanish([turned.own[k]], {})]
        others_are_zero = all(x == 0 for i, row in enumerate(inertia.tolist()) for j, x in enumerate(row) if (i, j) != (2, 2))
        if acting == [2] and (others_are_zero or not possible(inertia, given, [])):
            return f"inertia = {json.dumps(formula(inertia[2, 2]))}"
        if not possible(inertia, given, acting):
            inertia = _of_the_same_motion(inertia, acting)
            if not possible(inertia, given, acting):
                if len(acting) > 1 and not self._keeps_its_axis(turned):
                    self._warn(body, turned)
                # The decimals become fractions, so that sums in the text are not rounded.
                inertia = exact(inertia)
                weights, turn = [inertia.trace() / 2 - inertia[k, k] for k in range(3)], turned.rotation
                axes = []
                for k in range(3):
                    for l in range(k + 1, 3):
                        if inertia[k, l] != 0:
                            axes.append({"weight": -inertia[k, l], "vector": turn[:, k] + turn[:, l]})
                            weights[k], weights[l] = weights[k] + inertia[k, l], weights[l] + inertia[k, l]
                axes += [{"weight": weights[k], "vector": turn[:, k]} for k in range(3) if weights[k] != 0]
                return "axes = [" + ", ".join(map(self._axis, axes)) + "]"
        return f"inertia = {json.dumps([[formula(sm.sympify(x)) for x in row] for row in inertia.tolist()])}"

    def _keeps_its_axis(self, turned: Turned) -> bool:
        """True if the body turns about one axis that is fixed in the body, so that one moment acts."""
        import mpmath

        draw, listed = random.Random(4), atoms_of(turned.own)
        with mpmath.workdps(30):
            f = numeric(listed, list(turned.own))
            first, *others = [f(*(mpmath.mpf(draw.uniform(0.3, 1.3)) for _ in listed)) for _ in range(4)]
            return all(
                abs(first[i] * other[j] - first[j] * other[i]) < 1e-12 * mpmath.norm(first) * mpmath.norm(other)
                for other in others
                for i, j in ((0, 1), (1, 2), (2, 0))
            )

    def _warn(self, body: Any, turned: Turned) -> None:
        inertia = turned.inertia
        products = [inertia[0, 1], inertia[1, 2], inertia[2, 0]]
        what = f"moments are {', '.join(str(inertia[k, k]) for k in range(3))}" + (f" and products {', '.join(map(str, products))}" if any(products) else "")
        in_space = f"as {body.name} turns in space, "
        if any(inertia[k, k] == 0 for k in range(3)):
            in_space += f"me.inertia({body.frame.name}, Ixx, Iyy, Izz) needs all three moments"
        else:
            in_space += f"check the numbers and their order in me.inertia({body.frame.name}, Ixx, Iyy, Izz, Ixy, Iyz, Izx)"
        warnings.warn(
            f"no body has the inertia of {body.name}, whose {what}: each principal moment is at most the sum of the two others. The model has this "
            f"inertia, and so SymPy's equations; {in_space}",
            stacklevel=8,
        )

    def _expelled(self, body: Any) -> str:
        """Returns the line of the velocity of the matter that a body of varying mass loses. That matter is at rest, since SymPy's force
        is d/dt (m v)."""
        made = self._made
        velocity = made.components(center_of(body).vel(made.parts.frame))
        if plain(body.mass).diff(made.time) == 0 or not any(velocity):
            return ""
        return f"expelled_velocity = {json.dumps([made.writer.formula(-v) for v in velocity])}\n"


def _of_the_same_motion(inertia: Any, acting: list[int]) -> Any:
    """Returns the inertia of a flat body that has the same motion: the moments and products about the axes in `acting`, along which the
    angular velocity has components, are kept. With one such axis and its moment J, the two other moments are J/2; with two such
    axes, the third moment is the sum of their moments."""
    made = inertia.as_mutable()
    if len(acting) == 1:
        made = sympy_module().eye(3) * inertia[acting[0], acting[0]] / 2
        made[acting[0], acting[0]] = inertia[acting[0], acting[0]]
    if len(acting) == 2:
        (i, j), (k,) = acting, set(range(3)) - set(acting)
        made[k, k] = inertia[i, i] + inertia[j, j]
        made[i, k] = made[k, i] = made[j, k] = made[k, j] = sympy_module().Integer(0)
    return made


def _without_what_cancels(e: Any) -> Any:
    """Returns an expression without the coordinates on which its value does not depend, and without the time, if its value does not
    depend on it: J for J (sin(q)^2 + cos(q)^2)."""
    sm, time = sympy_module(), mechanics_module().dynamicsymbols._t

    def without(x: Any) -> Any:
        plain = e.xreplace({x: sm.Integer(0)})
        return e if plain.has(sm.nan, sm.zoo, sm.oo) or not vanish([e - plain], {}) else plain

    for q in sorted(e.atoms(sm.core.function.AppliedUndef), key=str):
        e = e if e.has(sm.Derivative) else without(q)
    return without(time) if e.has(time) and not e.atoms(sm.core.function.AppliedUndef) else e


def possible(inertia: Any, given: Mapping[Any, Any], acting: list[int]) -> bool:
    """True if a body may have this inertia: the inertia varies, or no principal moment is negative or more than the sum of the two others,
    for the values that are given and some random values of the other symbols. Also true if a moment that acts is negative: the model
    refuses it."""
    import mpmath

    sm = sympy_module()
    entries = [with_values(sm.sympify(x), given) or sm.sympify(x) for x in inertia]
    listed, time = atoms_of(entries), mechanics_module().dynamicsymbols._t
    if any(e.atoms(sm.core.function.AppliedUndef) or e.has(time) for e in entries):
        return True
    draw = random.Random(6)
    with mpmath.workdps(30):
        f = numeric(listed, entries)
        for _ in range(3):
            numbers = mpmath.matrix(3, 3)
            for k, x in enumerate(f(*(mpmath.mpf(draw.uniform(0.3, 1.3)) for _ in listed))):
                numbers[k // 3, k % 3] = x
            trace = sum(numbers[k, k] for k in range(3))
            if any(numbers[k, k] < 0 for k in acting) or min(mpmath.eigsy(trace / 2 * mpmath.eye(3) - numbers, eigvals_only=True)) >= -1e-9 * trace:
                return True
    return False
