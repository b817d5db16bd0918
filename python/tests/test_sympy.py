"""Systems of sympy.physics.mechanics are imported with the accelerations that SymPy finds for them."""

import contextlib
from collections.abc import Callable
from typing import Any

import anholon as an
import numpy as np
import pytest
from anholon._sympy_import import Import

sm = pytest.importorskip("sympy")
me = pytest.importorskip("sympy.physics.mechanics")

Made = tuple[Any, dict[Any, Any]]


def rolling_disc() -> Made:
    """Makes the disc of the documentation of KanesMethod, of whose mass centre only the velocity is known."""
    q1, q2, q3, u1, u2, u3 = me.dynamicsymbols("q1 q2 q3 u1 u2 u3")
    r, m, g = sm.symbols("r m g")
    N = me.ReferenceFrame("N")
    Y = N.orientnew("Y", "Axis", [q1, N.z])
    L = Y.orientnew("L", "Axis", [q2, Y.x])
    R = L.orientnew("R", "Axis", [q3, L.y])
    spin = R.ang_vel_in(N)
    R.set_ang_vel(N, u1 * L.x + u2 * L.y + u3 * L.z)
    C = me.Point("C")
    C.set_vel(N, 0)
    center = C.locatenew("Dmc", r * L.z)
    center.v2pt_theory(C, N, R)
    body = me.RigidBody("BodyD", center, R, m, (me.inertia(L, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2), center))
    kane = me.KanesMethod(N, [q1, q2, q3], [u1, u2, u3], kd_eqs=[me.dot(R.ang_vel_in(N) - spin, v) for v in L])
    kane.kanes_equations([body], [(center, -m * g * Y.z)])
    return kane, {r: 0.5, m: 1, g: 9.8125}


def pendulum_on_cart(links: int = 2) -> Made:
    """Makes a system of sympy.physics.mechanics.models, with a force on the cart that is a function of time."""
    models = pytest.importorskip("sympy.physics.mechanics.models")
    kane = models.n_link_pendulum_on_cart(links, cart_force=False)
    symbols = sorted(set().union(*(e.free_symbols for e in kane.mass_matrix_full)) | {sm.Symbol("g")}, key=str)
    return kane, {s: 1 + k / 4 for k, s in enumerate(s for s in symbols if s != me.dynamicsymbols._t)}


def springs() -> Made:
    models = pytest.importorskip("sympy.physics.mechanics.models")
    kane = models.multi_mass_spring_damper(3, True)
    symbols = sorted(set().union(*(e.free_symbols for e in [*kane.mass_matrix_full, *kane.forcing_full])), key=str)
    return kane, {s: 1 + k / 8 for k, s in enumerate(s for s in symbols if s != me.dynamicsymbols._t)}


def torsional_pendulum() -> Made:
    q, u = me.dynamicsymbols("q u")
    J, m, k, c, l, g = sm.symbols("J m k c l g")
    N = me.ReferenceFrame("N")
    B = N.orientnew("B", "Axis", [q, N.z])
    B.set_ang_vel(N, u * N.z)
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", l * B.x)
    P.v2pt_theory(O, N, B)
    body = me.RigidBody("rod", P, B, m, (me.inertia(B, 0, J, J), P))
    kane = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff() - u])
    kane.kanes_equations([body], [(B, (-k * q - c * u) * N.z), (P, m * g * N.x)])
    return kane, {J: 0.1, m: 2, k: 3, c: 0.25, l: 0.5, g: 9.8125}


def two_particles_with_odd_speeds() -> Made:
    """Makes a system whose generalized speeds are combinations of the rates."""
    q1, q2, u1, u2 = me.dynamicsymbols("q1 q2 u1 u2")
    m, k = sm.symbols("m k")
    N = me.ReferenceFrame("N")
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P1, P2 = O.locatenew("P1", q1 * N.x), O.locatenew("P2", q2 * N.x + sm.sin(q1) * N.y)
    P1.set_vel(N, (u1 + u2) / 2 * N.x)
    P2.set_vel(N, (u1 - u2) / 2 * N.x + sm.cos(q1) * (u1 + u2) / 2 * N.y)
    kane = me.KanesMethod(N, [q1, q2], [u1, u2], kd_eqs=[q1.diff() + q2.diff() - u1, q1.diff() - q2.diff() - u2])
    kane.kanes_equations([me.Particle("A", P1, m), me.Particle("B", P2, 2 * m)], [(P1, -k * q1 * N.x), (P2, -k * (q2 - q1) ** 3 * N.x)])
    return kane, {m: 1.5, k: 2}


def skate() -> Made:
    """Makes a sleigh on a blade, which has a dependent speed."""
    x, y, th, ux, uy, w = me.dynamicsymbols("x y th u_x u_y w")
    m, J, a = sm.symbols("m J a")
    N = me.ReferenceFrame("N")
    B = N.orientnew("B", "Axis", [th, N.z])
    B.set_ang_vel(N, w * N.z)
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * N.x + y * N.y)
    P.set_vel(N, ux * N.x + uy * N.y)
    G = P.locatenew("G", a * B.x)
    G.v2pt_theory(P, N, B)
    body = me.RigidBody("sleigh", G, B, m, (me.inertia(B, 0, 0, J), G))
    kane = me.KanesMethod(
        N, [x, y, th], [ux, w], kd_eqs=[x.diff() - ux, y.diff() - uy, th.diff() - w], u_dependent=[uy], velocity_constraints=[-ux * sm.sin(th) + uy * sm.cos(th)]
    )
    kane.kanes_equations([body], [(P, -0.5 * ux * N.x)])
    return kane, {m: 2, J: 0.5, a: 0.625}


def lagrange_pendulum() -> Made:
    """Makes a LagrangesMethod with bodies, Cartesian coordinates and a holonomic constraint."""
    q1, q2 = me.dynamicsymbols("q1:3")
    L, m, g = sm.symbols("L m g")
    N = me.ReferenceFrame("N")
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", q1 * N.x + q2 * N.y)
    P.set_vel(N, P.pos_from(O).dt(N))
    bob = me.Particle("bob", P, m)
    method = me.LagrangesMethod(me.Lagrangian(N, bob), [q1, q2], hol_coneqs=[q1**2 + q2**2 - L**2], forcelist=[(P, m * g * N.x)], bodies=[bob], frame=N)
    method.form_lagranges_equations()
    return method, {L: 1.5, m: 2, g: 9.8125}


def lagrange_with_potential() -> Made:
    q = me.dynamicsymbols("th")
    l, m, g = sm.symbols("l m g")
    N = me.ReferenceFrame("N")
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", l * sm.sin(q) * N.x - l * sm.cos(q) * N.y)
    P.set_vel(N, P.pos_from(O).dt(N))
    bob = me.Particle("bob", P, m)
    bob.potential_energy = -m * g * l * sm.cos(q)
    method = me.LagrangesMethod(me.Lagrangian(N, bob), [q], bodies=[bob], frame=N)
    method.form_lagranges_equations()
    return method, {l: 0.75, m: 2, g: 9.8125}


def system_of_joints() -> Made:
    """Makes a System with joints: a cart and a pendulum."""
    M, m, l, g = sm.symbols("M m l g")
    q1, q2, u1, u2 = me.dynamicsymbols("q1 q2 u1 u2")
    rail = me.RigidBody("rail")
    cart = me.RigidBody("cart", mass=M)
    bob = me.Particle("bob", mass=m)
    frame = me.ReferenceFrame("bob_frame")
    system = me.System.from_newtonian(rail)
    slider = me.PrismaticJoint("slider", rail, cart, q1, u1, joint_axis=rail.x)
    pin = me.PinJoint("pin", cart, bob, q2, u2, joint_axis=cart.z, child_interframe=frame, child_point=l * frame.y)
    system.add_joints(slider, pin)
    system.apply_uniform_gravity(-g * rail.y)
    system.add_loads(me.Force(cart, -0.5 * u1 * rail.x))
    system.form_eoms()
    return system, {M: 3, m: 1, l: 0.75, g: 9.8125}


def four_bar() -> Made:
    """Makes the linkage of the documentation: three links on pins, closed by two holonomic constraints."""
    q = me.dynamicsymbols("q1:4")
    u = me.dynamicsymbols("u1:4")
    l1, l2, l3, l4, m1, m2, m3, g = sm.symbols("l1 l2 l3 l4 m1 m2 m3 g")
    N = me.ReferenceFrame("N")
    P = me.Point("P1")
    P.set_vel(N, 0)
    start, bodies, loads, frame, here = P, [], [], N, P
    for k, (length, mass) in enumerate([(l1, m1), (l2, m2), (l3, m3)]):
        link = frame.orientnew(f"A{k}", "Axis", [q[k], N.z])
        link.set_ang_vel(frame, u[k] * N.z)
        center = here.locatenew(f"C{k}", length / 2 * link.x)
        center.v2pt_theory(here, N, link)
        end = here.locatenew(f"E{k}", length * link.x)
        end.v2pt_theory(here, N, link)
        bodies.append(me.RigidBody(f"link{k}", center, link, mass, (me.inertia(link, 0, mass * length**2 / 12, mass * length**2 / 12), center)))
        loads.append((center, -mass * g * N.y))
        frame, here = link, end
    loop = here.pos_from(start) - l4 * N.x
    holonomic = [loop.dot(N.x), loop.dot(N.y)]
    kinematic = [c.diff() - v for c, v in zip(q, u, strict=True)]
    rates = dict(zip([c.diff() for c in q], u, strict=True))
    kane = me.KanesMethod(
        N,
        q_ind=[q[0]],
        u_ind=[u[0]],
        kd_eqs=kinematic,
        q_dependent=q[1:],
        configuration_constraints=holonomic,
        u_dependent=u[1:],
        velocity_constraints=[c.diff(me.dynamicsymbols._t).subs(rates) for c in holonomic],
    )
    kane.kanes_equations(bodies, loads)
    return kane, {l1: 1, l2: 2, l3: 1.5, l4: 1.75, m1: 1, m2: 2, m3: 1.5, g: 9.8125}


CASES: list[Callable[[], Made]] = [
    rolling_disc,
    pendulum_on_cart,
    springs,
    torsional_pendulum,
    two_particles_with_odd_speeds,
    skate,
    lagrange_pendulum,
    lagrange_with_potential,
    system_of_joints,
    four_bar,
]


def bicycle() -> Made:
    """Makes Whipple's bicycle of SymPy's tests (test_kane3), which has wheels whose frames have no orientation, and speeds without
    coordinates."""
    import inspect
    import os
    import textwrap

    if os.environ.get("ANHOLON_LONG") != "1":
        pytest.skip("SymPy needs twenty seconds for its own equations; ANHOLON_LONG=1 runs it")
    module = pytest.importorskip("sympy.physics.mechanics.tests.test_kane3")
    source = textwrap.dedent(inspect.getsource(module.test_bicycle).split(":\n", 1)[1]).split("(fr, frstar)")[0]
    made: dict[str, Any] = dict(vars(module))
    exec(source, made)
    method = made["KM"]
    method.kanes_equations(made["BL"], made["FL"])
    # The numbers are those of the benchmark of Meijaard and others, rounded.
    numbers = "WFrad 0.35 WRrad 0.3 htangle 0.314 forkoffset 0.08 forklength 0.54 framelength 0.98 forkcg1 0.03 forkcg3 0.04 framecg1 0.3 framecg3 0.6 "
    numbers += "Iwr11 0.06 Iwr22 0.12 Iwf11 0.14 Iwf22 0.28 Iframe11 9.2 Iframe22 11 Iframe33 2.8 Iframe31 2.4 Ifork11 0.06 Ifork22 0.06 Ifork33 0.01 "
    numbers += "Ifork31 -0.007 g 9.8125 mframe 85 mfork 4 mwf 3 mwr 2"
    words = numbers.split()
    return method, {sm.Symbol(name): float(value) for name, value in zip(words[::2], words[1::2], strict=True)}


def chain_of_pendulums() -> Made:
    return pendulum_on_cart(4)


def links_in_a_chain() -> Made:
    """Makes a LagrangesMethod of n links with bodies."""
    n = 3
    q = me.dynamicsymbols(f"q1:{n + 1}")
    m, l, g, J = sm.symbols("m l g J")
    N = me.ReferenceFrame("N")
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    joint, bodies, lagrangian = O, [], sm.Integer(0)
    for k, angle in enumerate(q):
        B = N.orientnew(f"B{k}", "Axis", [angle, N.z])
        center = joint.locatenew(f"C{k}", l / 2 * B.x)
        center.v2pt_theory(joint, N, B)
        bodies.append(me.RigidBody(f"link{k}", center, B, m, (me.inertia(B, 0, 0, J), center)))
        bodies[-1].potential_energy = -m * g * me.dot(center.pos_from(O), N.x)
        lagrangian += me.Lagrangian(N, bodies[-1])
        tip = joint.locatenew(f"P{k}", l * B.x)
        tip.v2pt_theory(joint, N, B)
        joint = tip
    method = me.LagrangesMethod(lagrangian, q, bodies=bodies, frame=N)
    method.form_lagranges_equations()
    return method, {m: 1.5, l: 0.75, g: 9.8125, J: 0.125}


def lagrange_skate() -> Made:
    """Makes a LagrangesMethod with a nonholonomic constraint."""
    x, y, th = q = me.dynamicsymbols("x y th")
    t = me.dynamicsymbols._t
    m, J = sm.symbols("m J")
    N = me.ReferenceFrame("N")
    B = N.orientnew("B", "Axis", [th, N.z])
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * N.x + y * N.y)
    P.set_vel(N, x.diff(t) * N.x + y.diff(t) * N.y)
    body = me.RigidBody("skate", P, B, m, (me.inertia(B, 0, 0, J), P))
    edge = x.diff(t) * sm.sin(th) - y.diff(t) * sm.cos(th)
    loads = [(P, -0.5 * x * N.x + 0.25 * N.y)]
    method = me.LagrangesMethod(me.Lagrangian(N, body), q, nonhol_coneqs=[edge], bodies=[body], forcelist=loads, frame=N)
    method.form_lagranges_equations()
    return method, {m: 2, J: 0.5}


def actuators() -> Made:
    """Makes a System whose loads are actuators: a spring, a damper and a torque."""
    for name in ("LinearSpring", "LinearDamper", "TorqueActuator", "LinearPathway"):
        if not hasattr(me, name):
            pytest.skip(f"this SymPy has no {name}")
    q1, q2, u1, u2 = me.dynamicsymbols("q1 q2 u1 u2")
    m, J, k, c, l, T, g = sm.symbols("m J k c l T g")
    N = me.ReferenceFrame("N")
    B = N.orientnew("B", "Axis", [q2, N.z])
    B.set_ang_vel(N, u2 * N.z)
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", q1 * N.x)
    P.set_vel(N, u1 * N.x)
    tip = P.locatenew("tip", l * B.y)
    tip.v2pt_theory(P, N, B)
    anchor = O.locatenew("A", -2 * N.x + N.y)
    anchor.set_vel(N, 0)
    ground, bar = me.RigidBody("ground", O, N), me.RigidBody("bar", P, B, m, (me.inertia(B, 0, 0, J), P))
    pathway = me.LinearPathway(anchor, tip)
    system = me.System(N, O)
    system.add_bodies(ground, bar)
    system.q_ind, system.u_ind, system.kdes = [q1, q2], [u1, u2], [q1.diff() - u1, q2.diff() - u2]
    system.add_actuators(
        me.LinearSpring(k, pathway, equilibrium_length=l),
        me.LinearDamper(c, pathway),
        me.TorqueActuator(T, N.z, B, N),
    )
    system.apply_uniform_gravity(-g * N.y)
    system.form_eoms()
    return system, {m: 1.5, J: 0.25, k: 20, c: 0.5, l: 0.5, T: 0.3, g: 9.8125}


CASES += [bicycle, chain_of_pendulums, links_in_a_chain, lagrange_skate, actuators]


def forces_by_auxiliary_equations(method: Any, numbers: dict[Any, Any]) -> dict[Any, Any]:
    """Returns the formulas of forces along auxiliary speeds, which have no numbers, by SymPy's own equations for them."""
    from sympy.core.function import AppliedUndef

    equations: list[Any] = []
    with contextlib.suppress(ValueError):  # there are no auxiliary speeds
        equations = list(getattr(getattr(method, "eom_method", method), "auxiliary_eqs", None) or [])
    speeds = {x for x in (*method.q, *method.u)}
    unknown = sorted({f for e in equations for f in e.atoms(AppliedUndef)} - speeds - set(numbers), key=str)
    return sm.solve(equations, unknown, dict=True)[0] if unknown else {}


def accelerations_of_sympy(method: Any, made: Import, values: dict[Any, Any], state: dict[Any, Any]) -> dict[Any, float]:
    """Returns q'' at a state (coordinates, and rates by q') by SymPy's own equations, computed with 40 digits."""
    q, u, t = list(method.q), [x for x in made.parts.u], made.writer.time
    numbers = {**{k: sm.Float(str(v), 40) for k, v in values.items()}, **{k: sm.Float(v, 40) for k, v in state.items()}}
    rates = [x.diff(t) for x in made.writer.q]
    if not u:
        speeds = [x.diff(t) for x in q]
        solved = method.mass_matrix_full, method.forcing_full
    else:
        speeds = u
        solved = method.mass_matrix_full, method.forcing_full
        for x in u:
            numbers[x] = sm.N(made.speeds[x].subs({r: numbers[r] for r in rates}).subs({k: v for k, v in numbers.items()}), 40)

    solved = tuple(matrix.xreplace(made._zero).subs(forces_by_auxiliary_equations(method, numbers)) for matrix in solved)

    def at(e: Any) -> Any:
        return sm.N(e.subs({r: numbers[r] for r in rates}).subs(numbers), 40)

    import mpmath

    # mpmath solves the equations, since substitution takes minutes for a bicycle.
    known = {**{r: numbers[r] for r in rates}, **numbers}
    with mpmath.workdps(40):
        a, b = (sm.lambdify(list(known), matrix, "mpmath", cse=True, dummify=True)(*(mpmath.mpf(str(v)) for v in known.values())) for matrix in solved)
        x = [sm.Float(str(v), 40) for v in mpmath.lu_solve(a, b)]
    before = len(method.q)
    change = dict(zip(speeds, x[before : before + len(speeds)], strict=True))
    if not u:
        return {c: float(change[c.diff(t)]) for c in q}
    # q'' is the rate of q' = F(q, u), by the chain rule.
    kinematic, own = sm.Matrix(made.parts.kinematic), [x.diff(t) for x in q]
    flow = kinematic.jacobian(own).LUsolve(-kinematic.subs(dict.fromkeys(own, 0)))
    found = {}
    for c, f in zip(q, flow, strict=True):
        moving = [*((p, numbers[p.diff(t)]) for p in q), *change.items()]
        at_rest = {z: sm.Dummy() for z, _ in moving}
        by_time = f.xreplace(at_rest).diff(t).xreplace({d: z for z, d in at_rest.items()})
        found[c] = float(at(by_time + sum(sm.diff(f, z) * dz for z, dz in moving)))
    return found


def consistent(made: Import, values: dict[Any, Any]) -> dict[Any, Any]:
    """Returns a random state that satisfies the constraints: coordinates, and rates by q'. Newton's method may fail to close a loop
    from its initial values, so several initial values are tried."""
    for seed in range(3, 12):
        with contextlib.suppress(ValueError, ZeroDivisionError):
            return drawn(made, values, seed)
    raise AssertionError("no state satisfies the holonomic constraints")


def drawn(made: Import, values: dict[Any, Any], seed: int) -> dict[Any, Any]:
    """Returns the state that `consistent` finds for one seed."""
    draw = np.random.default_rng(seed)
    q = made.writer.q
    state = {c: float(x) for c, x in zip(q, draw.uniform(0.3, 0.9, len(q)), strict=True)}
    numbers = {k: sm.Float(str(v), 40) for k, v in values.items()}
    holonomic = [sm.sympify(e).subs(numbers) for e in made.parts.holonomic]
    if holonomic:
        free = [c for c in q if any(e.has(c) for e in holonomic)][-len(holonomic) :]
        fixed = {c: state[c] for c in q if c not in free}
        state.update(zip(free, (float(x) for x in sm.nsolve([e.subs(fixed) for e in holonomic], free, [state[c] for c in free], prec=40)), strict=True))
    rates = made.writer.rates
    equations = [made.in_rates(e.diff(made.writer.time)) for e in made.parts.holonomic] + [made.in_rates(e) for e in made.parts.velocity]
    equations += [e for _, e in made.centers]
    v = draw.uniform(-1, 1, len(rates))
    if equations:
        rows = sm.Matrix(equations)
        jacobian = np.array(rows.jacobian(rates).subs(state).subs(numbers).evalf(30).tolist(), dtype=float)
        rest = np.array(rows.subs(dict.fromkeys(rates, 0)).subs(state).subs(numbers).evalf(30).tolist(), dtype=float)[:, 0]
        v -= np.linalg.pinv(jacobian) @ (jacobian @ v + rest)
        v -= np.linalg.pinv(jacobian) @ (jacobian @ v + rest)
    state.update(zip(rates, (float(x) for x in v), strict=True))
    return state


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.__name__)
def test_accelerations_agree(case: Callable[[], Made]) -> None:
    method, values = case()
    made = Import(method)
    model = an.from_sympy(method, values=values, initial={})
    state = consistent(made, values)
    names = made.writer.names
    f = model.dynamics(minimal=False)
    x = f.state(0.0, q={names[c]: state[c] for c in made.writer.q}, qdot={names[c] + "'": state[c.diff(made.writer.time)] for c in made.writer.q})
    rates = dict(zip((s.name for s in f.states), f(0.0, x), strict=True))
    expected = accelerations_of_sympy(method, made, values, state)
    for c in method.q:
        assert rates[names[c] + "'"] == pytest.approx(expected[c], rel=1e-12, abs=1e-12)


def test_what_cannot_be_read_says_why() -> None:
    method, values = torsional_pendulum()
    with pytest.raises(an.ModelError, match="values are missing for J, c, g, k, l, m"):
        an.from_sympy(method)
    with pytest.raises(TypeError, match="KanesMethod"):
        an.from_sympy(42)
    q = me.dynamicsymbols("q")


def test_a_motion_of_an_imported_system() -> None:
    method, values = skate()
    run = an.from_sympy(method, values=values, initial={"x'": -0.5, "th'": 1.5}).simulate(to=2).expect()
    assert run.report.constraints < 1e-13 and run.report.newton < 1e-12


def sleigh() -> tuple[Any, dict[Any, Any], list[Any]]:
    """Makes a sleigh whose speeds are u1 along its axis and u2 about the vertical, with an auxiliary speed for the force of the blade."""
    x, y, th, u1, u2, side, blade = me.dynamicsymbols("x y th u1 u2 side blade")
    m, J, a, c = sm.symbols("m J a c")
    N = me.ReferenceFrame("N")
    B = N.orientnew("B", "Axis", [th, N.z])
    B.set_ang_vel(N, u2 * N.z)
    O = me.Point("O")
    O.set_vel(N, 0)
    K = O.locatenew("K", x * N.x + y * N.y)
    K.set_vel(N, u1 * B.x + side * B.y)
    G = K.locatenew("G", a * B.x)
    G.set_vel(N, u1 * B.x + (side + a * u2) * B.y)
    kane = me.KanesMethod(N, [x, y, th], [u1, u2], kd_eqs=[x.diff() - u1 * sm.cos(th), y.diff() - u1 * sm.sin(th), th.diff() - u2], u_auxiliary=[side])
    kane.kanes_equations([me.RigidBody("sleigh", G, B, m, (me.inertia(B, 0, 0, J), G))], [(G, -c * u1 * B.x + 2 * B.y), (K, blade * B.y)])
    return kane, {m: 2, J: 0.3, a: 0.4, c: 0.5}, [x, y, th, u1, u2]


def test_initial_speeds_and_turns_beyond_a_right_angle() -> None:
    kane, values, (x, y, th, u1, u2) = sleigh()
    model = an.from_sympy(kane, values=values, initial={x: 0, "y": 0, th: sm.Rational(3, 10), u1: 1.2, "u2": 0.7})
    state = model.evaluate()
    assert state.qdot["x'"] == pytest.approx(1.2 * np.cos(0.3), rel=1e-15)
    assert state.qdot["y'"] == pytest.approx(1.2 * np.sin(0.3), rel=1e-15)
    run = model.simulate(to=8, at=[8]).expect()

    def by_hand(_: float, s: Any) -> list[float]:
        return [0.4 * s[1] ** 2 - 0.25 * s[0], (0.8 - 0.8 * s[0] * s[1]) / 0.62, s[1]]

    solve_ivp = pytest.importorskip("scipy.integrate").solve_ivp
    hand = solve_ivp(by_hand, (0, 8), [1.2, 0.7, 0.3], "DOP853", rtol=1e-12, atol=1e-13)
    assert run["th"][-1] == pytest.approx(hand.y[2, -1], rel=1e-10)  # 7.07, through two right angles
    with pytest.raises(an.ModelError, match=r"'u3' in initial is no coordinate, rate or speed\nhint: x, y, th, x', y', th', u1, u2"):
        an.from_sympy(kane, values=values, initial={"u3": 1})
