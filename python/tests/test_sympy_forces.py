"""Forces of SymPy's models (functions with branches, actuators, pathways, friction) are imported with SymPy's accelerations."""

from collections.abc import Callable
from typing import Any

import anholon as an
import pytest
from anholon._sympy_import import Import
from test_sympy import accelerations_of_sympy, consistent

sm = pytest.importorskip("sympy")
me = pytest.importorskip("sympy.physics.mechanics")

Made = tuple[Any, dict[Any, Any]]
x, th, v, w = me.dynamicsymbols("x th v w")
m, J, k, l, c = sm.symbols("m J k l c", positive=True)
t = me.dynamicsymbols._t
f = me.dynamicsymbols("f")
NUMBERS = {m: 1.5, J: 0.25, k: 20, l: 0.5, c: 0.75}


def agree(method: Any, values: dict[Any, Any]) -> an.Model:
    """Asserts that the accelerations of the model at a random state are those of SymPy's equations; returns the model."""
    made = Import(method)
    model = an.from_sympy(method, values=values)
    state, names = consistent(made, values), made.writer.names
    function = model.dynamics(minimal=False)
    rates = {names[q] + "'": state[q.diff(t)] for q in made.writer.q}
    start = function.state(0.0, q={names[q]: state[q] for q in made.writer.q}, qdot=rates)
    ours = dict(zip((s.name for s in function.states), function(0.0, start), strict=True))
    expected = accelerations_of_sympy(method, made, {**values, t: 0}, state)
    for q in method.q:
        assert ours[names[q] + "'"] == pytest.approx(expected[q], rel=1e-12, abs=1e-12)
    return model


def pushed(force: Any, torque: Any = 0) -> Any:
    """Makes a rod on a slide with coordinates x, th, a force along x and a torque."""
    N = me.ReferenceFrame("N")
    B = N.orientnew("B", "Axis", [th, N.z])
    B.set_ang_vel(N, w * N.z)
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * N.x)
    P.set_vel(N, v * N.x)
    G = P.locatenew("G", l * B.x)
    G.v2pt_theory(P, N, B)
    kane = me.KanesMethod(N, [x, th], [v, w], kd_eqs=[x.diff() - v, th.diff() - w])
    rod = me.RigidBody("rod", G, B, m, (me.inertia(B, 0, 0, J), G))
    kane.kanes_equations([rod], [(P, force * N.x), (B, torque * N.z)])
    return kane


FORCES: dict[str, tuple[Any, Any]] = {
    "abs": (-c * sm.Abs(v) * v, sm.Abs(sm.sin(th))),
    "sign": (-c * sm.sign(v), -k * sm.sign(th) * th**2),
    "max": (sm.Max(0, k * (x - l)), sm.Max(th, w, x * w)),
    "min": (sm.Min(c, k * x), sm.Min(th, w, v, x)),
    "piecewise": (sm.Piecewise((-k * x, x > l), (c * v, x > 0), (0, True)), sm.Piecewise((1, th <= 1), (2, True))),
    "and, or": (sm.Piecewise((3, sm.And(x > 0, v > 0)), (5, True)), sm.Piecewise((w, sm.Or(th < 0, x >= 1, w < 0)), (th, True))),
    "heaviside": (-k * x * sm.Heaviside(x - l) - c * sm.Heaviside(v), sm.Heaviside(w, 1)),
    "atan2": (sm.atan2(th, x), k * sm.atan2(w, sm.cos(th))),
    "reciprocals": (sm.sec(th) + sm.csc(th) + sm.cot(th), sm.sech(w) + sm.csch(x) + sm.coth(x)),
    "hyperbolic": (sm.tanh(v / c) + sm.asinh(v), sm.atanh(sm.sin(th) / 2) + sm.acosh(1 + x**2)),
    "roots": (-k * x / sm.sqrt(x**2 + l**2), -(c + w**2) ** sm.Rational(3, 2) + sm.cbrt(1 + th**2)),
    "logarithms": (sm.log(1 + x**2, 10), sm.exp(-(th**2)) * sm.E),
    "time": (sm.sin(3 * t) + t**2, sm.Piecewise((1, t < 1), (0, True))),
    "pi": (sm.pi * x, sm.asin(sm.sin(th) / sm.pi) + sm.acos(x / 4) + sm.atan(v)),
    "rates": (-c * x.diff(t) * sm.Abs(x.diff(t)), -c * th.diff(t) ** 3),
}


@pytest.mark.parametrize("name", FORCES)
def test_functions_of_forces(name: str) -> None:
    agree(pushed(*FORCES[name]), NUMBERS)


def test_a_given_function_has_rates() -> None:
    model = an.from_sympy(pushed(m * f.diff(t, 2) + c * f.diff(t), f), values={**NUMBERS, f: "sin(3*t)"})
    function = model.dynamics(minimal=False)
    start = function.state(0.0, q={"x": 0.3, "th": 0.0}, qdot={"x'": 0.0, "th'": 0.0})
    # At th = 0 the force is -9 m sin(3 t) + 3 c cos(3 t) = 3 c, and the torque is 0.
    rates = dict(zip((s.name for s in function.states), function(0.0, start), strict=True))
    assert rates["x'"] == pytest.approx(3 * 0.75 / 1.5, rel=1e-12) and rates["th'"] == pytest.approx(0, abs=1e-12)


REFUSED: dict[str, tuple[Any, str]] = {
    "erf": (sm.erf(x), r"erf in erf\(x\(t\)\) has no counterpart in a model\nhint: put a formula"),
    "no value elsewhere": (sm.Piecewise((x, x > 0)), r"has no value elsewhere\nhint: let it end with \(value, True\)"),
    "equality": (sm.Piecewise((x, sm.Eq(x, v)), (0, True)), r"the condition .* is none of >, >=, < and <=\nhint"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_counterpart_is_named(name: str) -> None:
    force, said = REFUSED[name]
    with pytest.raises(an.ModelError, match=said):
        an.from_sympy(pushed(force), values=NUMBERS)


def pulled(pathway: Callable[[Any, Any, Any, Any], Any], actuator: Callable[[Any], Any]) -> Made:
    """Makes a particle in the plane at (x, th), on which an actuator acts along a pathway from a fixed point."""
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", (2 + x) * N.x + (1 + th) * N.y)
    P.set_vel(N, v * N.x + w * N.y)
    kane = me.KanesMethod(N, [x, th], [v, w], kd_eqs=[x.diff() - v, th.diff() - w])
    loads = actuator(pathway(N, O, P, kane)).to_loads()
    kane.kanes_equations([me.Particle("bob", P, m)], loads)
    functions = {e for load in loads for z in load.vector.to_matrix(N) for e in z.atoms(sm.core.function.AppliedUndef)} - {x, th, v, w}
    parameters = {s for load in loads for z in load.vector.to_matrix(N) for s in z.free_symbols} - {t}
    return kane, {**dict.fromkeys(functions, 0.4), **dict.fromkeys(parameters, 0.3), **NUMBERS}


def straight(N: Any, O: Any, P: Any, _: Any) -> Any:  # noqa: E741
    return me.LinearPathway(O, P)


def over_pins(N: Any, O: Any, P: Any, _: Any) -> Any:  # noqa: E741
    pins = [O.locatenew("A", N.x + 2 * N.y), O.locatenew("C", 1.5 * N.x + 2 * N.y)]
    for pin in pins:
        pin.set_vel(N, 0)
    return me.ObstacleSetPathway(O, *pins, P)


def round_a_cylinder(N: Any, O: Any, P: Any, _: Any) -> Any:  # noqa: E741
    if not hasattr(me, "WrappingPathway"):
        pytest.skip("this SymPy wraps nothing")
    q = sm.Matrix([x, th])  # P lies on the cylinder, whose radius is that of P
    hub = me.Point("hub")
    hub.set_pos(O, 0)
    hub.set_vel(N, 0)
    start = hub.locatenew("start", l * N.x)
    start.set_vel(N, 0)
    B = N.orientnew("W", "Axis", [q[1], N.z])
    end = hub.locatenew("end", l * B.x)
    end.set_vel(N, end.pos_from(hub).dt(N).subs({th.diff(t): w}))
    return me.WrappingPathway(start, end, me.WrappingCylinder(l, hub, N.z))


def muscle(path: Any) -> Any:
    from sympy.physics.biomechanics import MusculotendonDeGroote2016, ZerothOrderActivation

    return MusculotendonDeGroote2016.with_defaults(
        "muscle", path, ZerothOrderActivation("muscle"), tendon_slack_length=sm.Rational(1, 4), peak_isometric_force=30, optimal_fiber_length=2
    )


PULLED: dict[str, tuple[Any, Callable[[Any], Any]]] = {
    "spring": (straight, lambda path: me.LinearSpring(k, path, equilibrium_length=l)),
    "damper": (straight, lambda path: me.LinearDamper(c, path)),
    "force of rates": (straight, lambda path: me.ForceActuator(-k * path.extension_velocity**3, path)),
    "hardening spring": (straight, lambda path: me.DuffingSpring(k, c, path, l)),
    "spring over pins": (over_pins, lambda path: me.LinearSpring(k, path, equilibrium_length=l)),
    "damper over pins": (over_pins, lambda path: me.LinearDamper(c, path)),
    "spring round a cylinder": (round_a_cylinder, lambda path: me.LinearSpring(k, path)),
    "muscle": (straight, muscle),
    "dry friction": (straight, lambda path: me.CoulombKineticFriction(c, k, path, v_s=l, sigma=J, mu_s=m)),
}


@pytest.mark.parametrize("name", PULLED)
def test_actuators_along_pathways(name: str) -> None:
    agree(*pulled(*PULLED[name]))


def joined(kind: str) -> Made:
    """Makes a System of a body on a joint to a body on a slide."""
    system = me.System.from_newtonian(me.RigidBody("floor"))
    N = system.frame
    cart, bob = me.RigidBody("cart", mass=m), me.RigidBody("bob", mass=2)
    cart.central_inertia, bob.central_inertia = me.inertia(cart.frame, J, J, J), me.inertia(bob.frame, 0.3, 0.4, 0.5)
    system.add_joints(me.PrismaticJoint("slide", system.bodies[0], cart, joint_axis=N.x))
    arm = {"parent_point": l * cart.frame.x, "child_point": 0.25 * bob.frame.y}
    system.add_joints(getattr(me, kind)("joint", cart, bob, **arm))
    system.apply_uniform_gravity(-9.8125 * N.y)
    system.form_eoms()
    return system, NUMBERS


@pytest.mark.parametrize("kind", ["PinJoint", "PrismaticJoint", "CylindricalJoint", "PlanarJoint", "SphericalJoint"])
def test_joints(kind: str) -> None:
    agree(*joined(kind))
