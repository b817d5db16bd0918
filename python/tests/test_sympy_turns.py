"""Bodies of SymPy that turn: inertias about one axis, tilts by floats, and frames that have only an angular velocity."""

import re
import warnings
from typing import Any

import anholon as an
import pytest
from anholon._sympy_import import Import
from test_sympy import accelerations_of_sympy, consistent, rolling_disc

sm = pytest.importorskip("sympy")
me = pytest.importorskip("sympy.physics.mechanics")

q, u, p, v = me.dynamicsymbols("q u p v")
t = me.dynamicsymbols._t
m, J, l, r, c = sm.symbols("m J l r c", positive=True)
NUMBERS = {m: 1.5, J: 0.25, l: 0.75, r: 0.4, c: 0.5}
N, O = me.ReferenceFrame("N"), me.Point("O")  # noqa: E741
O.set_vel(N, 0)


def agree(method: Any, values: dict[Any, Any]) -> an.Model:
    """Asserts that the accelerations of the model at a random state are those of SymPy's equations; returns the model."""
    made = Import(method)
    numbers = {**values, t: 0}
    state, names = consistent(made, numbers), made.writer.names
    start = {names[x] + mark: state[y] for x in method.q for y, mark in ((x, ""), (x.diff(t), "'"))}
    model = an.from_sympy(method, values=values, initial=start)
    ours, expected = model.evaluate().accelerations, accelerations_of_sympy(method, made, numbers, state)
    for x in method.q:
        assert ours[names[x] + "''"] == pytest.approx(expected[x], rel=1e-12, abs=1e-12)
    return model


def one_axis(axis: Any, moments: Any, products: Any = (0, 0, 0)) -> Any:
    """Makes a body on a fixed axis, under its weight and a torque."""
    B = me.ReferenceFrame("B")
    B.orient_axis(N, axis, q)
    B.set_ang_vel(N, u * axis.normalize())
    G = O.locatenew("G", l * B.x + l * B.y / 2 + r * B.z)
    G.v2pt_theory(O, N, B)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff() - u])
    method.kanes_equations([me.RigidBody("b", G, B, m, (me.inertia(B, *moments, *products), G))], [(B, 3 * axis), (G, 2 * N.x - N.y + 4 * N.z)])
    return method


ONE_AXIS: dict[str, tuple[Any, Any, Any]] = {
    "z about x": (N.x, (0, 0, J), (0, 0, 0)),
    "x about x": (N.x, (J, 0, 0), (0, 0, 0)),
    "y about y": (N.y, (0, J, 0), (0, 0, 0)),
    "z about z": (N.z, (0, 0, J), (0, 0, 0)),
    "z about a tilted axis": (N.x + 2 * N.y - N.z, (0, 0, J), (0, 0, 0)),
    "x about an axis of a plane": (N.x + N.y, (J, 0, 0), (0, 0, 0)),
    "products that do not act": (N.z, (0, 0, J), (J, J, J)),
    "a product that acts": (N.x + N.z, (J, 0, 3 * J), (0, 0, J)),
}


@pytest.mark.parametrize("name", ONE_AXIS)
def test_of_a_body_on_an_axis_one_moment_acts(name: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model = agree(one_axis(*ONE_AXIS[name]), NUMBERS)
    assert ('inertia = "J"' in model.text) == (name in ("z about z", "products that do not act"))


def two_axes(inertia: Any) -> Any:
    """Makes a body that turns about z and about its own x axis."""
    A = N.orientnew("A", "Axis", [q, N.z])
    B = A.orientnew("B", "Axis", [p, A.x])
    A.set_ang_vel(N, u * N.z)
    B.set_ang_vel(A, v * A.x)
    G = O.locatenew("G", l * B.y)
    G.v2pt_theory(O, N, B)
    method = me.KanesMethod(N, [q, p], [u, v], kd_eqs=[q.diff() - u, p.diff() - v])
    method.kanes_equations([me.RigidBody("b", G, B, m, (inertia(B), G))], [(G, -m * N.y), (B, 2 * B.x)])
    return method


@pytest.mark.parametrize("moments", [(0, 0, J), (J, 0, 0), (J, J, 3 * J, J / 8, J / 4, 0)], ids=str)
def test_moments_that_no_body_has_are_told(moments: Any) -> None:
    given = re.escape(", ".join(map(str, moments[:3]))) + (re.escape(" and products J/8, J/4, 0") if len(moments) > 3 else "")
    advice = re.escape(
        "check the numbers and their order in me.inertia(B, Ixx, Iyy, Izz, Ixy, Iyz, Izx)"
        if len(moments) > 3
        else "me.inertia(B, Ixx, Iyy, Izz) needs all three moments"
    )
    with pytest.warns(UserWarning, match=rf"no body has the inertia of b, whose moments are {given}: .* in space, {advice}$") as told:
        agree(two_axes(lambda B: me.inertia(B, *moments)), NUMBERS)
    assert told[0].filename.endswith("test_sympy_turns.py")  # the place at which from_sympy is called


def test_sums_of_decimals_are_written_as_decimals() -> None:
    with pytest.warns(UserWarning, match="no body has the inertia of b"):
        model = an.from_sympy(two_axes(lambda B: me.inertia(B, 0.02, 0.03, 0.01, 0.002)), values={m: 1, l: 1})
    assert re.findall(r'weight = "(.*?)"', model.text) == ["(-0.002)", "(0.012)", "(0.002)", "(0.02)"]


def test_moments_that_a_body_has_are_not_told() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model = agree(two_axes(lambda B: me.inertia(B, J, J, 2 * J)), NUMBERS)
    assert "axes" not in model.text


def tilted(tilt: Any, point: Any = lambda D: 0.1 * D.z + 0.2 * D.y) -> Any:
    """Makes a bead on a tilted bar that turns."""
    A = N.orientnew("A", "Axis", [q, N.z])
    D = A.orientnew("D", "Axis", [tilt, A.y])
    A.set_ang_vel(N, u * N.z)
    D.set_ang_vel(A, 0)
    P = O.locatenew("P", p * D.x + point(D))
    P.set_vel(D, v * D.x)
    P.v1pt_theory(O, N, D)
    method = me.KanesMethod(N, [q, p], [u, v], kd_eqs=[q.diff() - u, p.diff() - v])
    method.kanes_equations([me.Particle("bead", P, m)], [(P, -p * D.x + N.z)])
    return method


@pytest.mark.parametrize("tilt", [0.3, sm.Rational(3, 10)], ids=str)
def test_a_bead_on_a_bar_tilted_by_a_float(tilt: Any) -> None:
    model = agree(tilted(tilt), NUMBERS)
    assert [x.name for x in model.coordinates] == ["q", "p"] and "constraint" not in model.text


def test_a_velocity_that_differs_by_little_is_another_one() -> None:
    """A difference of 1e-9 between factors is no rounding error: the model then follows the velocity of the bead."""
    P = O.locatenew("P", 0.3 * q * N.x)
    P.set_vel(N, 0.300000001 * u * N.x)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff() - u])
    method.kanes_equations([me.Particle("bead", P, m)], [(P, -N.x)])
    assert "0.300000001" in agree(method, NUMBERS).text


def tilted_body(by: str) -> Any:
    """Makes a body that turns in a frame whose tilt is given by floats."""
    A = N.orientnew("A", "Axis", [q, N.z])
    A.set_ang_vel(N, u * N.z)
    D = A.orientnew("D", "Body", (0.3, 0.2, 0.7), "321") if by != "axis" else A
    axis = A.x + 0.3 * A.y if by == "axis" else D.x
    B = D.orientnew("B", "Axis", [p, axis])
    B.set_ang_vel(D, v * axis.normalize())
    Q = O.locatenew("Q", 0.1 * D.x + 0.7 * A.y)
    Q.v2pt_theory(O, N, A)
    G = Q.locatenew("G", 0.3 * B.y)
    G.v2pt_theory(Q, N, B)
    w1, w2 = q.diff() - u, p.diff() - v
    kinematic = [0.1 * w1 + 0.7 * w2, 0.3 * w1 - 0.2 * w2] if by == "kinematics" else [w1, w2]
    body = me.RigidBody("b", G, B, 1.5, (me.inertia(B, 0.3, 0.4, 0.5), G))
    if by == "Lagrange":
        body.potential_energy = 1.5 * 9.81 * G.pos_from(O).dot(N.x)
        slow = {u: q.diff(), v: p.diff()}
        A.set_ang_vel(N, q.diff() * N.z)
        B.set_ang_vel(D, p.diff() * axis)
        Q.v2pt_theory(O, N, A)
        G.v2pt_theory(Q, N, B)
        method = me.LagrangesMethod(sm.simplify(me.Lagrangian(N, body).subs(slow)), [q, p], bodies=[body], frame=N)
        method.form_lagranges_equations()
        return method
    method = me.KanesMethod(N, [q, p], [u, v], kd_eqs=kinematic)
    method.kanes_equations([body], [(G, -1.5 * 9.81 * N.x)])
    return method


@pytest.mark.parametrize("by", ["orientation", "axis", "kinematics", "Lagrange"])
def test_bodies_in_frames_that_floats_tilt(by: str) -> None:
    model = agree(tilted_body(by), NUMBERS)
    assert "[[body]]" in model.text and "constraint" not in model.text


def test_speeds_that_floats_mix() -> None:
    fast, slow = 0.7 * u - 0.2 * v, 0.1 * 3 * u + 0.3 * v  # in floats 0.1*3 is not 0.3
    A = N.orientnew("A", "Axis", [q, N.z])
    B = A.orientnew("B", "Axis", [p, A.x])
    A.set_ang_vel(N, fast * N.z)
    B.set_ang_vel(N, 0.3 * (u + v) * B.x + fast * (sm.sin(p) * B.y + sm.cos(p) * B.z))
    G = O.locatenew("G", 0.3 * B.y)
    G.v2pt_theory(O, N, B)
    method = me.KanesMethod(N, [q, p], [u, v], kd_eqs=[q.diff() - fast, p.diff() - slow])
    method.kanes_equations([me.RigidBody("b", G, B, 1.5, (me.inertia(B, 0.3, 0.4, 0.5), G))], [(G, -1.5 * 9.81 * N.x)])
    assert "constraint" not in agree(method, NUMBERS).text


def test_a_joint_about_an_axis_of_floats() -> None:
    floor, arm = me.RigidBody("floor"), me.RigidBody("arm", mass=1.5)
    arm.central_inertia = me.inertia(arm.frame, 0.3, 0.4, 0.5)
    system = me.System.from_newtonian(floor)
    system.add_joints(me.PinJoint("pin", floor, arm, q, u, joint_axis=floor.x + 0.2 * floor.z, child_point=0.3 * arm.frame.y))
    system.apply_uniform_gravity(-9.81 * floor.z)
    system.form_eoms()
    agree(system, NUMBERS)


def test_a_tilt_has_its_own_angle_in_the_model() -> None:
    A = N.orientnew("A", "Axis", [0.3, N.y])
    B = A.orientnew("B", "Axis", [q, A.x])
    B.set_ang_vel(A, u * A.x)
    A.set_ang_vel(N, 0)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff() - u])
    method.kanes_equations([me.RigidBody("b", O, B, m, (me.inertia(B, 1, 1, 1), O))], [(B, B.x)])
    assert 'orientation = "rot(ey, 0.3)*matrix(' in agree(method, NUMBERS).text


x, y, th, w, s = me.dynamicsymbols("x y th w s")


def wheel(spin: Any, speeds: list[Any], moments: Any = (J / 2, J, J / 2)) -> Any:
    """Makes a wheel on a carriage with a blade; the frame of the wheel has only an angular velocity, relative to the carriage."""
    B = N.orientnew("B", "Axis", [th, N.z])
    B.set_ang_vel(N, w * N.z)
    C = O.locatenew("C", x * N.x + y * N.y + r * N.z)
    C.set_vel(N, v * B.x)
    W = me.ReferenceFrame("W")
    W.set_ang_vel(B, spin * B.y)
    kinematic = [x.diff() - v * sm.cos(th), y.diff() - v * sm.sin(th), th.diff() - w]
    method = me.KanesMethod(N, [x, y, th], [v, w, *speeds], kd_eqs=kinematic)
    method.kanes_equations([me.RigidBody("wheel", C, W, m, (me.inertia(B, *moments), C))], [(W, B.y), (B, -B.y + N.z), (C, B.x)])
    return method


SPINS: dict[str, tuple[Any, list[Any]]] = {
    "s": (s, [s]),
    "-s": (-s, [s]),
    "2 s": (2 * s, [s]),
    "s + w": (s + w, [s]),
    "v/r": (v / r, []),
    "(v - l w)/r": ((v - l * w) / r, []),
    "constant": (c, []),
    "of time": (sm.sin(t), []),
}


@pytest.mark.parametrize("name", SPINS)
def test_spins_of_wheels(name: str) -> None:
    model = agree(wheel(*SPINS[name]), NUMBERS)
    assert ("turn_" in model.text) == ("v" in name)  # v is the speed along a blade and the rate of no coordinate


def test_moments_of_a_wheel_are_equal_by_value() -> None:
    agree(wheel(s, [s], (0.5 * J, J, J / 2)), NUMBERS)
    refused = r"the frame of wheel has only an angular velocity, .*\nhint: orient the frame, as by W\.orient_axis\(B, B\.y, angle\)"
    with pytest.raises(an.ModelError, match=refused):
        an.from_sympy(wheel(s, [s], (J / 3, J, J / 2)), values=NUMBERS)


def test_a_sphere_whose_frame_has_only_an_angular_velocity() -> None:
    u1, u2, u3 = me.dynamicsymbols("u1 u2 u3")
    B = me.ReferenceFrame("B")
    B.set_ang_vel(N, u1 * N.x + u2 * N.y + u3 * N.z)
    C = O.locatenew("C", x * N.x + y * N.y + r * N.z)
    vx, vy = r * u2 - sm.sin(t) * y, -r * u1 + sm.sin(t) * x  # on a turntable
    C.set_vel(N, vx * N.x + vy * N.y)
    method = me.KanesMethod(N, [x, y], [u1, u2, u3], kd_eqs=[x.diff() - vx, y.diff() - vy])
    moment = sm.Rational(2, 5) * m * r**2
    ball = me.RigidBody("ball", C, B, m, (me.inertia(N, moment, 0.4 * m * r**2, moment), C))
    method.kanes_equations([ball], [(C, m * N.x), (B, 0.1 * N.z - c * u1 * N.x)])
    agree(method, NUMBERS)


def test_a_moment_about_a_pivot_that_is_not_the_mass_centre() -> None:
    """SymPy transforms the moments (0, 0, J) to the mass centre, where those that do not act become negative."""
    B = N.orientnew("B", "Axis", [q, N.z])
    B.set_ang_vel(N, u * N.z)
    G = O.locatenew("G", l * B.y)
    G.v2pt_theory(O, N, B)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff() - u])
    method.kanes_equations([me.RigidBody("b", G, B, m, (me.inertia(B, 0, 0, J), O))], [(G, -m * 9.81 * N.y)])
    model = agree(method, {m: 1.5, J: 1.1, l: 0.75})
    start = model.evaluate()
    assert start.accelerations["q''"] == pytest.approx(1.5 * 9.81 * 0.75 * sm.sin(start.q["q"]) / 1.1)
    with pytest.raises(an.ModelError, match="the moment of inertia is -0.7"):
        an.from_sympy(method, values={m: 1.5, J: 0.1, l: 0.75})


def test_an_inertia_along_the_axes_of_another_frame_is_constant() -> None:
    """The rolling disc of SymPy's documentation has its inertia along a frame that does not turn with the disc."""
    disc, values = rolling_disc()
    model = an.from_sympy(disc, values=values, initial={"q2": 0.3})
    assert "cos" not in next(line for line in model.text.splitlines() if line.startswith("inertia"))
    f = model.dynamics()
    assert f.minimal, f.obstacle
