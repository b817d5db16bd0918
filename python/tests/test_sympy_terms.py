"""Terms of SymPy's equations that do not follow from bodies and loads are imported: accelerations are those of SymPy's matrices."""

import math
import re
import warnings
from collections.abc import Callable, Sequence
from typing import Any

import anholon as an
import pytest
from anholon._sympy_import import Import
from test_sympy_own import deviation

sm = pytest.importorskip("sympy")
me = pytest.importorskip("sympy.physics.mechanics")

t = me.dynamicsymbols._t
x, z, vx, vz, y = me.dynamicsymbols("x z v_x v_z y")
m, k, g, l = sm.symbols("m k g l")
NUMBERS: dict[Any, Any] = {m: 1.5, k: 2, g: 9.8125, l: 0.75}


def agree(method: Any, values: dict[Any, Any], state: Sequence[float], rates: Sequence[float], at: float = 0.375) -> an.Model:
    """Asserts that the accelerations of the model are those of SymPy at a state of ``method.q``, and returns the model. The speeds must
    be the rates of the coordinates in their order."""
    functions = {f: e for f, e in values.items() if f.args}
    numbers = {**{s: sm.sympify(e) for s, e in values.items() if not s.args}, t: sm.Float(at, 40)}
    speeds = getattr(method, "u", None) or [q.diff(t) for q in method.q]
    fast = {**dict(zip([q.diff(t) for q in method.q], rates, strict=True)), **dict(zip(speeds, rates, strict=True))}
    slow = dict(zip(method.q, state, strict=True))

    def numeric(matrix: Any) -> Any:
        made = sm.Matrix(matrix).subs(functions).doit().xreplace(fast).xreplace(slow).xreplace(numbers)
        return made.evalf(40)

    solved = numeric(method.mass_matrix_full).LUsolve(numeric(method.forcing_full))
    expected = list(solved)[len(state) : 2 * len(state)]
    start = {str(q.func) + mark: v for of, mark in ((state, ""), (rates, "'")) for q, v in zip(method.q, of, strict=True)}
    model = an.from_sympy(method, values=values, initial=start)
    ours = model.evaluate(t=at).accelerations
    for q, e in zip(method.q, expected, strict=True):
        assert ours[f"{q.func}''"] == pytest.approx(float(e), rel=1e-12, abs=1e-12)
    return model


def cart_and_bob(constrained: bool, formed: bool) -> Any:
    """Makes a System of joints whose speeds are the rates of the coordinates, as Lagrange's equations need them."""
    q, p = me.dynamicsymbols("q p")
    M = sm.Symbol("M")
    rail, cart, bob, frame = me.RigidBody("rail"), me.RigidBody("cart", mass=M), me.Particle("bob", mass=m), me.ReferenceFrame("frame")
    system = me.System.from_newtonian(rail)
    system.add_joints(
        me.PrismaticJoint("slider", rail, cart, q, q.diff(t), joint_axis=rail.x),
        me.PinJoint("pin", cart, bob, p, p.diff(t), joint_axis=cart.z, child_interframe=frame, child_point=l * frame.y),
    )
    for body in system.bodies:
        body.potential_energy = body.mass * g * body.masscenter.pos_from(system.fixed_point).dot(system.y)
    if constrained:
        system.add_holonomic_constraints(bob.masscenter.pos_from(rail.masscenter).dot(system.x))
    if formed:
        system.form_eoms(me.LagrangesMethod)
    return system


@pytest.mark.parametrize("constrained", [False, True])
def test_a_system_with_lagranges_equations(constrained: bool) -> None:
    values = {sm.Symbol("M"): 3, m: 1.5, l: 0.75, g: 9.8125}
    system = cart_and_bob(constrained, True)
    state, rates = [0.2, 0.5], [0.7, -0.4]
    if constrained:  # q + l sin(p) = 0
        far = system.holonomic_constraints[0].subs({system.q[0]: 0, system.q[1]: 0.5, l: 0.75})
        state[0] = -float(far)
        rates[0] = -float(sm.diff(system.holonomic_constraints[0], system.q[1]).subs({system.q[1]: 0.5, l: 0.75})) * rates[1]
    formed = agree(system, values, state, rates)
    assert an.from_sympy(cart_and_bob(constrained, False), values=values).text == an.from_sympy(system, values=values).text
    assert "g" in formed.text  # gravity comes from the potential energies


def driven_by_lagrange(holonomic: list[Any], nonholonomic: list[Any]) -> Any:
    """Makes a particle in the plane x, z."""
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * N.x + z * N.z)
    P.set_vel(N, x.diff(t) * N.x + z.diff(t) * N.z)
    bead = me.Particle("bead", P, m)
    bead.potential_energy = m * g * z
    method = me.LagrangesMethod(me.Lagrangian(N, bead), [x, z], hol_coneqs=holonomic, nonhol_coneqs=nonholonomic, bodies=[bead], frame=N)
    method.form_lagranges_equations()
    return method


def driven_by_kane(velocity: Any, configuration: Any = None) -> Any:
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * N.x + z * N.z)
    P.set_vel(N, vx * N.x + vz * N.z)
    depends = {"q_dependent": [z], "configuration_constraints": [configuration]} if configuration is not None else {}
    kinematic = [vx - x.diff(t), vz - z.diff(t)]
    free = [x] if depends else [x, z]
    method = me.KanesMethod(N, free, [vx], kd_eqs=kinematic, u_dependent=[vz], velocity_constraints=[velocity], **depends)
    method.kanes_equations([me.Particle("bead", P, m)], [(P, -m * g * N.z)])
    return method


GIVEN = 1 + sm.sin(t) / 2
# For each constraint: the method, and a function of (y, y') that returns (z, z') at x = 1/2, x' = 3/4.
DRIVEN: dict[str, tuple[Callable[[], Any], Callable[[Any, Any], tuple[Any, Any]]]] = {
    "z = y(t)": (lambda: driven_by_lagrange([z - y], []), lambda y, dy: (y, dy)),
    "z = y(t) x^2": (lambda: driven_by_lagrange([z - y * x**2], []), lambda y, dy: (y / 4, 3 * y / 4 + dy / 4)),
    "z' = x y'(t) + x'": (lambda: driven_by_lagrange([], [z.diff(t) - x * y.diff(t) - x.diff(t)]), lambda y, dy: (0.25, dy / 2 + 0.75)),
    "Kane, z = y(t) x^2": (
        lambda: driven_by_kane(vz - 2 * y * x * vx - y.diff(t) * x**2, z - y * x**2),
        lambda y, dy: (y / 4, 3 * y / 4 + dy / 4),
    ),
    "Kane, z' = x y'(t) + x'": (lambda: driven_by_kane(vz - x * y.diff(t) - vx), lambda y, dy: (0.25, dy / 2 + 0.75)),
    "Kane, z' = x' x y'(t) + x'": (lambda: driven_by_kane(vz - x * vx * y.diff(t) - vx), lambda y, dy: (0.25, 3 * dy / 8 + 0.75)),
}


@pytest.mark.parametrize("name", DRIVEN)
def test_constraints_with_rates_of_given_functions(name: str) -> None:
    method, state = DRIVEN[name]
    height, rise = state(GIVEN.subs(t, 0.375), GIVEN.diff(t).subs(t, 0.375))
    agree(method(), {m: 1.5, g: 9.8125, y: GIVEN}, [0.5, float(height)], [0.75, float(rise)])


def test_a_constraint_that_is_not_linear_in_rates() -> None:
    method = driven_by_lagrange([], [x.diff(t) ** 2 + k * z.diff(t) ** 2 - l])
    agree(method, NUMBERS, [0.5, 0.25], [0.5, 0.5])  # 1/4 + 2/4 = 3/4


POTENTIALS: dict[str, Any] = {
    "magnetic": k / 2 * (x**2 * z.diff(t) - z * x.diff(t)),
    "magnetic, of time": g * z + sm.sin(t) * x**2 * z.diff(t),
    "quadratic": g * z + k / 10 * x.diff(t) ** 2 * (1 + x**2),
    "a given function": y * x * z.diff(t) + y.diff(t) * x,
}


@pytest.mark.parametrize("name", POTENTIALS)
def test_potential_energies_of_velocities(name: str) -> None:
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * N.x + z * N.z)
    P.set_vel(N, x.diff(t) * N.x + z.diff(t) * N.z)
    charge = me.Particle("charge", P, m)
    charge.potential_energy = POTENTIALS[name]
    method = me.LagrangesMethod(me.Lagrangian(N, charge), [x, z], bodies=[charge], frame=N)
    method.form_lagranges_equations()
    agree(method, {m: 1.5, k: 2, g: 9.8125, y: GIVEN}, [0.5, 0.25], [1, 2])


mass = me.dynamicsymbols("mu")
MASSES: dict[str, Any] = {"of time": m * sm.exp(-t), "of a coordinate": m * (2 + sm.sin(x)), "a given function": mass}


@pytest.mark.parametrize("name", MASSES)
@pytest.mark.parametrize("by", ["Kane", "Lagrange"])
def test_masses_that_vary(name: str, by: str) -> None:
    """The force on a particle on a curve is d/dt (m v) in SymPy."""
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * N.x + (z + x**2) * N.z)
    P.set_vel(N, P.pos_from(O).dt(N))
    drop = me.Particle("drop", P, MASSES[name])
    method: Any
    if by == "Kane":
        P.set_vel(N, vx * N.x + (vz + 2 * x * vx) * N.z)
        method = me.KanesMethod(N, [x, z], [vx, vz], kd_eqs=[vx - x.diff(t), vz - z.diff(t)])
        method.kanes_equations([drop], [(P, -g * N.z)])
    else:
        drop.potential_energy = g * z
        method = me.LagrangesMethod(me.Lagrangian(N, drop), [x, z], bodies=[drop], frame=N)
        method.form_lagranges_equations()
    model = agree(method, {m: 1.5, g: 9.8125, mass: 2 + sm.sin(3 * t)}, [0.5, 0.25], [1, 2])
    assert "expelled_velocity" in model.text


INERTIAS: dict[str, Callable[[Any, Any], Any]] = {
    "of time": lambda A, B: me.inertia(B, 3 + sm.sin(t), 4, 5 - t, 0.2 * t, 0.1, 0.3 * t),
    "of a coordinate": lambda A, B: me.inertia(B, 3 + sm.sin(x), 4, 5 + z**2, 0.2 * z, 0.1, 0.3 * x),
    # Inertia along the axes of a frame in which the body turns; along the body's own axes it varies with the angle.
    "along other axes": lambda A, B: me.inertia(A, 3, 4, 5, 0.1, 0.2, 0.3),
}


@pytest.mark.parametrize("name", INERTIAS)
@pytest.mark.parametrize("by", ["Kane", "Lagrange"])
def test_inertias_that_vary(name: str, by: str) -> None:
    """The torque on a body that turns about two axes is d/dt (I w) in SymPy."""
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    A = N.orientnew("A", "Axis", [x, N.x])
    B = A.orientnew("B", "Axis", [z, A.y])
    center = O.locatenew("G", l * B.z)
    center.v2pt_theory(O, N, B)
    method: Any
    if by == "Kane":
        A.set_ang_vel(N, vx * N.x)
        B.set_ang_vel(A, vz * A.y)
        center.v2pt_theory(O, N, B)
    top = me.RigidBody("top", center, B, m + t / 4, (INERTIAS[name](A, B), center))
    if by == "Kane":
        method = me.KanesMethod(N, [x, z], [vx, vz], kd_eqs=[vx - x.diff(t), vz - z.diff(t)])
        method.kanes_equations([top], [(B, -k * B.z)])
    else:
        method = me.LagrangesMethod(me.Lagrangian(N, top), [x, z], bodies=[top], forcelist=[(B, -k * B.z)], frame=N)
        method.form_lagranges_equations()
    agree(method, {m: 1.5, k: 2, l: 0.75}, [0.5, 0.25], [1, 2])


def test_masses_that_are_constant_expel_nothing() -> None:
    text = an.from_sympy(cart_and_bob(False, True), values={sm.Symbol("M"): 3, m: 1.5, l: 0.75, g: 9.8125}).text
    assert "expelled" not in text


def test_a_mass_of_the_velocity() -> None:
    """A particle whose mass grows with its speed is read by the Lagrangian, not as a body."""
    N, P = me.ReferenceFrame("N"), me.Point("P")
    P.set_vel(N, x.diff(t) * N.x)
    fast = me.Particle("fast", P, m * (1 + x.diff(t) ** 2))
    method = me.LagrangesMethod(me.Lagrangian(N, fast), [x], bodies=[fast], forcelist=[(P, -k * N.x)], frame=N)
    method.form_lagranges_equations()
    agree(method, NUMBERS, [0.5], [0.75])


def pushed(force: Any, q: Any = x, u: Any = vx, weight: Any = m) -> Any:
    """Makes a particle on a line under a force."""
    N, P = me.ReferenceFrame("N"), me.Point("P")
    P.set_vel(N, u * N.x)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[u - q.diff(t)])
    method.kanes_equations([me.Particle("p", P, weight)], [(P, force * N.x)])
    return method


F = sm.Function("F")


@pytest.mark.parametrize("what", [F(t - 1), F(2 * t), F(3), F(x), F(x, t), x.subs(t, t - 1), x.subs(t, 0)], ids=str)
def test_functions_of_other_arguments_are_refused(what: Any) -> None:
    with pytest.raises(an.ModelError, match=re.escape(str(what)) + r" is no function of the time t alone\nhint"):
        an.from_sympy(pushed(-what - 3 * F(t)), values={m: 1, F(t): sm.sin(t)}, initial={x: 1})


def test_values_belong_to_symbols_not_to_names() -> None:
    plain, positive = sm.Symbol("F"), sm.Symbol("F", positive=True)
    model = an.from_sympy(pushed(-plain - 10 * positive - 100 * F(t)), values={"m": 1, plain: 2, positive: 3, F(t): 4})
    assert model.evaluate().accelerations["x''"] == -432
    with pytest.raises(an.ModelError, match="2 symbols have the name F: "):
        an.from_sympy(pushed(-plain - 10 * positive), values={"m": 1, "F": 2})
    assert an.from_sympy(pushed(-10 * positive), values={m: 1, plain: 2}).evaluate().accelerations["x''"] == -20


def test_names_beyond_ascii() -> None:
    angle, speed, force = me.dynamicsymbols("θ ω F̈")
    weight, stiffness, sharp = sm.symbols("Μ κ é")
    method = pushed(-stiffness * angle + sharp + force, angle, speed, weight)
    model = an.from_sympy(method, values={weight: 2, "κ": 3, sharp: 5, force: 7}, initial={"θ": 2, speed: 1})
    assert model.evaluate().accelerations == {"theta''": 3} and model.evaluate().qdot == {"theta'": 1}
    assert set(model.parameters) == {"Mu", "kappa", "s_e"}


def turned_by_speeds() -> Any:
    """Makes a body whose frame has an angular velocity along its own axes, and no orientation, as in Euler's equations."""
    u, q = me.dynamicsymbols("u1:4"), me.dynamicsymbols("q1:4")
    N, B, O = me.ReferenceFrame("N"), me.ReferenceFrame("B"), me.Point("O")  # noqa: E741
    B.set_ang_vel(N, u[0] * B.x + u[1] * B.y + u[2] * B.z)
    O.set_vel(N, 0)
    method = me.KanesMethod(N, q, u, kd_eqs=[a.diff(t) - b for a, b in zip(q, u, strict=True)])
    method.kanes_equations([me.RigidBody("B", O, B, m, (me.inertia(B, 1, 2, 3), O))], [(B, -u[2] * B.x)])
    return method


def without_bodies() -> Any:
    return me.KanesMethod(me.ReferenceFrame("N"), [x], [vx], kd_eqs=[vx - x.diff(t)])


def test_what_a_method_lacks_is_named() -> None:
    with pytest.raises(an.ModelError, match=r"a velocity or load is along a frame without an orientation: .* between N and B\nhint: orient the frame"):
        an.from_sympy(turned_by_speeds(), values={m: 1})
    with pytest.raises(an.ModelError, match=r"the KanesMethod has no bodies yet\nhint: call kane.kanes_equations"):
        an.from_sympy(without_bodies())
    model = an.from_sympy(pushed(-y), values={m: 1})
    assert "y" in model.equations().text
    with pytest.raises(an.ModelError, match="y"):
        model.simulate(to=1)


def rolling_disc_with_six_speeds() -> Any:
    """Makes the disc of SymPy's test of linearization. The velocity of its centre is given along axes of the disc and has 1600 terms
    along fixed axes."""
    r = sm.Symbol("r")
    q, u = me.dynamicsymbols("q1:7"), me.dynamicsymbols("u1:7")
    N, NO = me.ReferenceFrame("N"), me.Point("NO")
    A = N.orientnew("A", "Axis", [q[0], N.z])
    B = A.orientnew("B", "Axis", [q[1], A.x])
    C = B.orientnew("C", "Axis", [q[2], B.y])
    center = NO.locatenew("CO", q[3] * N.x + q[4] * N.y + q[5] * N.z)
    spin, velocity = C.ang_vel_in(N), center.pos_from(NO).dt(N)
    C.set_ang_vel(N, u[0] * B.x + u[1] * B.y + u[2] * B.z)
    center.set_vel(N, u[3] * C.x + u[4] * C.y + u[5] * C.z)
    P = center.locatenew("P", r * B.z)
    P.v2pt_theory(center, N, C)
    method = me.KanesMethod(
        N,
        q[:5],
        u[:3],
        kd_eqs=[me.dot(spin - C.ang_vel_in(N), e) for e in B] + [me.dot(velocity - center.vel(N), e) for e in N],
        q_dependent=[q[5]],
        configuration_constraints=[q[5] - me.dot(center.pos_from(P), N.z)],
        u_dependent=u[3:],
        velocity_constraints=[me.dot(P.vel(N), e) for e in C],
    )
    disc = me.RigidBody("disc", center, C, m, (me.inertia(C, m * r**2 / 4, m * r**2 / 2, m * r**2 / 4), center))
    method.kanes_equations([disc], [(center, m * g * A.z)])
    return method


def test_velocities_of_many_terms() -> None:
    """The search for the integral of the velocity ends and finds the coordinates of the centre, so that no coordinates are added."""
    method = rolling_disc_with_six_speeds()
    assert len(Import(method).writer.q) == 6
    assert deviation(method) < 1e-12


def test_symbols_with_reserved_names_come_in() -> None:
    x, v = me.dynamicsymbols("here v")
    inertial, mass = sm.symbols("inertial m")
    frame, origin = me.ReferenceFrame("N"), me.Point("O")
    origin.set_vel(frame, 0)
    place = origin.locatenew("P", x * frame.x)
    place.set_vel(frame, v * frame.x)
    method = me.KanesMethod(frame, [x], [v], kd_eqs=[x.diff() - v])
    method.kanes_equations([me.Particle("P", place, mass)], [(place, -inertial * x * frame.x)])
    model = an.from_sympy(method, values={inertial: 3, mass: 2}, initial={x: 0.5, v: 0})
    assert list(model.evaluate().accelerations.values()) == [-0.75]


def quaternion_top() -> tuple[Any, dict[Any, Any], list[Any]]:
    """Makes a heavy top whose orientation is a quaternion, with the configuration constraint that its length is 1."""
    e, u = me.dynamicsymbols("e0:4"), me.dynamicsymbols("u1:4")
    inertia = sm.symbols("I1:4")
    N, O = me.ReferenceFrame("N"), me.Point("O")
    B = N.orientnew("B", "Quaternion", e)
    kinematic = me.kinematic_equations(u, e, "quaternion")
    B.set_ang_vel(N, u[0] * B.x + u[1] * B.y + u[2] * B.z)
    O.set_vel(N, 0)
    G = O.locatenew("G", l * B.z)
    G.v2pt_theory(O, N, B)
    method = me.KanesMethod(N, q_ind=e[1:], u_ind=u, kd_eqs=kinematic, q_dependent=e[:1], configuration_constraints=[sum(x**2 for x in e) - 1])
    method.kanes_equations([me.RigidBody("top", G, B, m, (me.inertia(B, *inertia), G))], [(G, -m * g * N.z)])
    return method, {m: 1.5, g: 9.8125, l: 0.75, **dict(zip(inertia, (0.25, 0.375, 0.5), strict=True))}, [*e, *u]


def test_a_quaternion_turns_beyond_half_a_turn() -> None:
    method, values, (e0, e1, e2, e3, u1, u2, u3) = quaternion_top()
    model = an.from_sympy(method, values=values, initial={e0: 1, e1: 0, e2: 0, e3: 0, u1: 6, u2: 1, u3: 2})
    run = model.simulate(to=0.6, every=0.1).expect()
    assert run["e0"][0] == 1 and run["e0"][-1] < 0 and min(of.digits for of in run.report.trust) >= 11
    # The state is at half a turn, where e0 vanishes; e' = S(e) u, so that e'' = S(e') u + S(e) u'.
    state, speed = {e0: 0, e1: 0.6, e2: 0.8, e3: 0}, {u1: 1, u2: 0.5, u3: 2}
    ours = an.from_sympy(method, values=values, initial={**state, **speed}).evaluate()

    def numeric(matrix: Any) -> Any:
        return matrix.xreplace(speed).xreplace(state).xreplace(values).evalf(30)

    change = numeric(method.mass_matrix_full).LUsolve(numeric(method.forcing_full))
    rates = dict(zip([*method.q, *method.u], change, strict=True))
    for q in (e0, e1, e2, e3):
        rate = method.kindiffdict()[q.diff(t)]
        second = sum(sm.diff(rate, s) * rates[s] for s in rates)
        assert ours.qdot[f"{q.func}'"] == pytest.approx(float(rates[q]), rel=1e-12, abs=1e-12)
        assert ours.accelerations[f"{q.func}''"] == pytest.approx(float(numeric(sm.Matrix([second]))[0]), rel=1e-12, abs=1e-12)


def test_a_lagrangian_whose_inertia_has_a_negative_part() -> None:
    th = me.dynamicsymbols("th")
    energy = (2 * m * l**2 * sm.cos(th) ** 2 - m * l**2 / 2) * th.diff(t) ** 2 / 2 + m * (1 + th**2) * x.diff(t) ** 2 / 2 - m * g * l * sm.cos(th)
    method = me.LagrangesMethod(energy, [x, th])
    method.form_lagranges_equations()
    for mass in (1.5, "3/2", sm.Rational(3, 2)):
        model = agree(method, {m: mass, l: 0.75, g: 9.8125}, [0.1, 0.2], [0.3, 0.4])
        assert [line for line in model.text.splitlines() if line.startswith("mass")] == ['mass = "m"', 'mass = "1"']


def craft() -> tuple[Any, dict[Any, Any], list[Any]]:
    """Makes a free body whose speeds are the components of its velocity and its spin along its own axes."""
    q, u = me.dynamicsymbols("x y z psi theta phi"), me.dynamicsymbols("u1:7")
    N, O = me.ReferenceFrame("N"), me.Point("O")
    B = N.orientnew("B", "Body", q[3:], "321")
    turning = me.kinematic_equations(u[3:], q[3:], "body", "321")
    B.set_ang_vel(N, u[3] * B.x + u[4] * B.y + u[5] * B.z)
    O.set_vel(N, 0)
    G = O.locatenew("G", q[0] * N.x + q[1] * N.y + q[2] * N.z)
    velocity = u[0] * B.x + u[1] * B.y + u[2] * B.z
    G.set_vel(N, velocity)
    method = me.KanesMethod(N, q, u, kd_eqs=[c.diff(t) - v for c, v in zip(q[:3], velocity.to_matrix(N), strict=True)] + turning)
    body = me.RigidBody("craft", G, B, m, (me.inertia(B, 0.25, 0.375, 0.5, 0, 0, 0.0625), G))
    method.kanes_equations([body], [(G, m * g * N.z + 2 * B.x - k * u[0] ** 2 * B.x - 3 * u[1] * B.y), (B, -k * u[3] * B.x)])
    return method, {m: 1.5, g: 9.8125, k: 0.25}, [*q, *u]


def test_speeds_along_the_axes_of_a_body_at_any_heading() -> None:
    method, values, names = craft()
    start = dict(zip(names, (0, 0, 0, 1.2, 0.1, 0, 2, 0, 0, 0, 0, 0.8), strict=True))
    model = an.from_sympy(method, values=values, initial=start)
    assert "cos(psi))^((-1))" not in model.text and len(model.text) < 20_000
    run = model.simulate(to=1, every=0.25).expect()
    assert run["psi"][0] < sm.pi / 2 < run["psi"][-1] and min(of.digits for of in run.report.trust) >= 11
    state = an.from_sympy(method, values=values, initial={**start, names[3]: "pi/2", names[7]: 0.5}).evaluate()
    assert [state.qdot[name] for name in ("x'", "y'")] == pytest.approx([-0.5, 2 * float(sm.cos(0.1))], rel=1e-13)


def carried_coin() -> tuple[Any, dict[Any, Any]]:
    """Makes a coin on a floor. Its first three speeds are those of a frame that does not turn about the axis of the coin, whose
    own turning is u2 / tan(beta)."""
    x, y, a, b, c, u1, u2, u3 = me.dynamicsymbols("x y alpha beta gamma u1 u2 u3")
    m, R, g = sm.symbols("m R g")
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    A = N.orientnew("A", "Axis", [a, N.z])
    L = A.orientnew("L", "Axis", [b, A.x])
    D = L.orientnew("D", "Axis", [c, L.z])
    carried, spin = u1 * L.x + u2 * L.y + u2 / sm.tan(b) * L.z, u1 * L.x + u2 * L.y + u3 * L.z
    kd = [b.diff(t) - u1, a.diff(t) * sm.sin(b) - u2, a.diff(t) * sm.cos(b) + c.diff(t) - u3]
    L.set_ang_vel(N, carried)
    D.set_ang_vel(N, spin)
    C = O.locatenew("C", x * N.x + y * N.y + R * L.y)
    C.set_vel(N, spin.cross(R * L.y))
    slip = x.diff(t) * N.x + y.diff(t) * N.y + carried.cross(R * L.y) - spin.cross(R * L.y)
    method = me.KanesMethod(N, [a, b, c, x, y], [u1, u2, u3], kd_eqs=[*kd, slip.dot(N.x).simplify(), slip.dot(N.y).simplify()])
    method.kanes_equations([me.RigidBody("coin", C, D, m, (me.inertia(L, m * R**2 / 4, m * R**2 / 4, m * R**2 / 2), C))], [(C, -m * g * N.z)])
    return method, {m: 1, R: 0.4, g: 9.81}


def test_tangents_in_denominators_have_no_poles() -> None:
    """An upright coin, at which tan(beta) has its pole, has the accelerations of equations derived by hand."""
    method, values = carried_coin()
    rates = {"alpha'": 0.4, "beta'": 0.3, "gamma'": 3}
    upright = an.from_sympy(method, values=values, initial={"alpha": 0.1, "beta": "pi/2", **rates})
    assert "tan" not in upright.text
    # By hand, for a thin disc: (5/4) beta'' = -(3/2) alpha' (gamma' + alpha' cos beta) sin beta + (1/4) alpha'^2 sin beta cos beta
    # + (g/R) cos beta, and (1/4) alpha'' sin beta = (1/2) beta' (gamma' + alpha' cos beta) - (1/2) alpha' beta' cos beta.
    found = upright.evaluate().accelerations
    assert found["beta''"] == pytest.approx(-1.2 * 0.4 * 3, rel=1e-12)
    assert found["alpha''"] == pytest.approx(2 * 0.3 * 3, rel=1e-12)
    assert upright.simulate(to=0.1).outcome.ok


@pytest.mark.parametrize("more", [0, 1])
def test_acceleration_constraints_that_say_something_else_are_told(more: int) -> None:
    x, y, ux, uy = me.dynamicsymbols("x y u_x u_y")
    N, P = me.ReferenceFrame("N"), me.Point("P")
    P.set_vel(N, ux * N.x + uy * N.y)
    slip, m = uy - sm.sin(x) * ux, sm.Symbol("m")
    rate = 2 * slip.diff(t).subs(x.diff(t), ux) + 3 * slip
    method = me.KanesMethod(
        N, [x, y], [ux], kd_eqs=[x.diff(t) - ux, y.diff(t) - uy], u_dependent=[uy], velocity_constraints=[slip], acceleration_constraints=[rate + more]
    )
    method.kanes_equations([me.Particle("p", P, m)], [(P, -m * N.y)])
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        an.from_sympy(method, values={m: 1})
    assert [("acceleration constraints are not the rates" in str(w.message), w.filename.endswith("test_sympy_terms.py")) for w in told] == [(True, True)] * more


def _bead_with_friction(load: Callable[..., Any], height: Any = 0) -> tuple[Any, Any, dict[Any, Any]]:
    """Makes a bead on a wire of this height over the coordinate q, with an auxiliary speed for the force F2 of the wire along y."""
    q, u, aux, F2 = me.dynamicsymbols("q u u_a F2")
    m, g, k, c = sm.symbols("m g k c")
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    y = sm.sympify(height).subs(sm.Symbol("q"), q)
    P = O.locatenew("P", q * N.x + y * N.y)
    P.set_vel(N, u * N.x + (y.diff(q) * u + aux) * N.y)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff(t) - u], u_auxiliary=[aux])
    method.kanes_equations([me.Particle("P", P, m)], [(P, -k * q * N.x - m * g * N.y + load(F2, c, u, N))])
    return method, F2, {m: 1, k: 3, c: 0.1, g: 9.81}


def test_a_force_of_an_auxiliary_speed_in_another_load_is_solved_for() -> None:
    """Coulomb friction of a bead on a level wire: the bead swings about k q = c m g."""
    method, _, values = _bead_with_friction(lambda F2, c, u, N: -c * sm.Abs(F2) * sm.sign(u) * N.x + F2 * N.y)
    model = an.from_sympy(method, values=values, initial={"q": 1})
    assert "F2" not in model.text
    middle = 0.1 * 9.81 / 3
    assert model.simulate(to=1, at=[1])["q"][0] == pytest.approx(middle + (1 - middle) * math.cos(math.sqrt(3)), rel=1e-12)


def test_a_solved_force_may_depend_on_accelerations() -> None:
    """On a bent wire F2 = m (y'' + g), where y'' holds q''; the drag -c F2 along x is then linear in q''."""
    method, _, values = _bead_with_friction(lambda F2, c, u, N: -c * F2 * N.x + F2 * N.y, "q**2/2")
    model = an.from_sympy(method, values=values, initial={"q": 0.5, "u": 0.2})
    q, v, c = 0.5, 0.2, 0.1
    # m (q'' + y' y'') = -k q - m g y' + F2 (y' - c), with y' = q, y'' = q q'' + v^2 and F2 = m (y'' + g).
    expected = (-3 * q - 9.81 * q + (v**2 + 9.81) * (q - c) - q * v**2) / (1 + q * q - q * (q - c))
    assert model.evaluate().accelerations["q''"] == pytest.approx(expected, rel=1e-13)


def test_a_force_of_an_auxiliary_speed_that_is_not_solved_for() -> None:
    method, F2, values = _bead_with_friction(lambda F2, c, u, N: -c * F2 * N.x + F2**3 * N.y)
    with pytest.raises(an.ModelError, match="F2 is a force along the auxiliary speed u_a, another load depends on it, and .*\nhint: replace F2 in the loads"):
        an.from_sympy(method, values=values)
    for key in (F2, "F2"):
        assert 'F2 = "2*t"' in an.from_sympy(method, values={**values, key: "2*t"}).text


def test_the_force_of_an_auxiliary_speed_needs_no_value() -> None:
    """The tension of a pendulum does no work and cancels in the generalized force."""
    q, u, aux, tension = me.dynamicsymbols("q u u_a T")
    m, l, g = sm.symbols("m l g")
    N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    B = N.orientnew("B", "Axis", [q, N.z])
    B.set_ang_vel(N, u * N.z)
    P = O.locatenew("P", l * B.x)
    P.set_vel(N, l * u * B.y + aux * B.x)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff(t) - u], u_auxiliary=[aux])
    method.kanes_equations([me.Particle("P", P, m)], [(P, m * g * N.x - tension * B.x)])
    model = an.from_sympy(method, values={m: 1, l: 0.5, g: 9.81}, initial={q: 0.3})
    assert "T" not in model.text.split("[[force]]")[1] and "[functions]" not in model.text
    assert model.evaluate().accelerations["q''"] == pytest.approx(-9.81 / 0.5 * math.sin(0.3), rel=1e-14)
