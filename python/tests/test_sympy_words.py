"""Functions of SymPy that are imported by identities of real numbers, and the messages of ``from_sympy`` for wrong arguments."""

import math
import warnings
from typing import Any

import anholon as an
import numpy as np
import pytest

sm = pytest.importorskip("sympy")
me = pytest.importorskip("sympy.physics.mechanics")

x, v, F = me.dynamicsymbols("x v F")
t = me.dynamicsymbols._t
m, k = sm.symbols("m k")
N = me.ReferenceFrame("N")


def pushed(force: Any) -> Any:
    """Makes a particle on a line under a force."""
    P = me.Point("P")
    P.set_vel(N, v * N.x)
    method = me.KanesMethod(N, [x], [v], kd_eqs=[x.diff(t) - v])
    method.kanes_equations([me.Particle("p", P, m)], [(P, force * N.x)])
    return method


POTENTIALS: dict[str, Any] = {
    "Abs": lambda x: k * sm.Abs(x),
    "Abs of a product": lambda x: sm.Abs(k * x),
    "Abs of a sum": lambda x: k * sm.Abs(sm.sin(x) - k * x),
    "a power of Abs": lambda x: k * sm.Abs(x) ** 3,
    "a root of Abs": lambda x: sm.sqrt(sm.Abs(x)),
    "conjugate": lambda x: k * x * sm.conjugate(x),
    "re": lambda x: k * sm.re(x) ** 2,
    "Abs in the kinetic energy": lambda x: -x.diff(t) ** 2 * sm.Abs(sm.cos(x)) / 5,
}


@pytest.mark.parametrize("name", POTENTIALS)
@pytest.mark.parametrize("by", ["a Lagrangian", "a body"])
def test_coordinates_are_real(name: str, by: str) -> None:
    """SymPy cannot differentiate Abs(x) unless x is real, so its equations are derived for a real x."""
    real = me.dynamicsymbols("x", real=True)
    expected: Any = None
    for q in (real, x):
        energy = POTENTIALS[name](q)
        if by == "a body":
            P = me.Point("P")
            P.set_vel(N, q.diff(t) * N.x)
            body = me.Particle("p", P, m)
            body.potential_energy = energy
            method = me.LagrangesMethod(me.Lagrangian(N, body), [q], bodies=[body], frame=N)
        else:
            method = me.LagrangesMethod(m * q.diff(t) ** 2 / 2 - energy, [q])
        method.form_lagranges_equations()
        if q is real:
            k_real = sm.Symbol("k", real=True)
            matrices = [matrix.subs(k, k_real).doit() for matrix in (method.mass_matrix, method.forcing)]
            numbers = {real.diff(t): 0.25, real: 0.7, m: 1.5, k_real: 2, k: 2}
            mass, force = ([sm.N(e.subs(numbers).doit()) for e in matrix] for matrix in matrices)
            expected = float(force[0] / mass[0])
    model = an.from_sympy(method, values={m: 1.5, k: 2}, initial={x: 0.7, x.diff(t): 0.25})
    assert model.evaluate().accelerations["x''"] == pytest.approx(expected, rel=1e-12)


half = sm.Rational(1, 2)
FORCES: list[Any] = [
    sm.GoldenRatio * x,
    sm.EulerGamma * x,
    *(sm.acot(x), sm.asec(2 + x), sm.acsc(2 + x), sm.asech(x), sm.acsch(x), sm.acoth(2 + x), sm.acot(-x)),
    sm.Piecewise((x, sm.Ne(x, v)), (1, True)),
    sm.Piecewise((x, sm.Xor(x > half, v > 0)), (3, True)),
    sm.Piecewise((x, sm.Xor(x > half, v < 0)), (3, True)),
    sm.Piecewise((x, sm.Not(sm.And(x > half, v < 0))), (3, True)),
]


@pytest.mark.parametrize("force", FORCES, ids=str)
def test_functions_by_identities(force: Any) -> None:
    model = an.from_sympy(pushed(force), values={m: 1}, initial={x: 0.7, v: 0.3})
    assert model.evaluate().accelerations["x''"] == pytest.approx(float(force.subs({x: 0.7, v: 0.3})), rel=1e-14)


GIVEN: dict[Any, Any] = {m: 1, k: 2, F: 3}
MISTAKES: list[tuple[dict[str, Any], type[Exception], str]] = [
    ({"values": {**GIVEN, x: 3}}, an.ModelError, r"'x' in values is a coordinate or speed\nhint: .*initial=\{x: …\}"),
    ({"values": {**GIVEN, "v": 3}}, an.ModelError, r"'v' in values is a coordinate or speed"),
    ({"values": {**GIVEN, "kk": 3}}, an.ModelError, r"'kk' in values is no symbol and no function of the system; did you mean 'k'\?\nhint: F, k, m"),
    ({"values": {m: 1, k: 2, "F(t)": 3}}, an.ModelError, r"'F\(t\)' in values is no .*; did you mean 'F'\?"),
    ({"values": [1]}, TypeError, r"values is a mapping by symbol or name, as values=\{m: 1\}, not a list"),
    ({"values": {**GIVEN, m: None}}, TypeError, "m: a number is an int, float"),
    ({"values": GIVEN, "initial": 5}, TypeError, "initial is a mapping by symbol or name"),
    ({"values": GIVEN, "initial": {"xx": 1}}, an.ModelError, r"'xx' in initial is no coordinate, rate or speed; did you mean 'x'\?\nhint: x, x', v"),
    ({"values": {**GIVEN, x.diff(t): 4}}, an.ModelError, r"'x'' in values is a rate or an acceleration\nhint: .*initial=\{…\}"),
    ({"values": {**GIVEN, v.diff(t): 4}}, an.ModelError, r"'v'' in values is a rate or an acceleration"),
    ({"values": {**GIVEN, F.diff(t): 4}}, an.ModelError, r"'F'' in values is the rate of F, which follows from F\nhint: .*values=\{F: …\}"),
    ({"values": {**GIVEN, x + 1: 4}}, an.ModelError, r"'x\(t\) \+ 1' in values is no symbol and no function of the system"),
    ({"values": {**GIVEN, t: 4}}, an.ModelError, r"'t' in values is the time, which has no value"),
    ({"values": {**GIVEN, k: 2 * k}}, an.ModelError, r"the value of k depends on k itself"),
    ({"values": {m: 1, k: F, F: k * x}}, an.ModelError, r"the value of . depends on . itself"),
    ({"values": GIVEN, "initial": {x.diff(t, 2): 3}}, an.ModelError, r"^'x''' in initial is an acceleration, or its rate, .*\nhint: x, x', v"),
    ({"values": GIVEN, "initial": {v.diff(t): 3}}, an.ModelError, r"^'v'' in initial is an acceleration"),
    ({"values": GIVEN, "initial": {"x''": 3}}, an.ModelError, r"^'x''' in initial is an acceleration"),
    ({"values": GIVEN, "initial": {F.diff(t): 3}}, an.ModelError, r"^'F'' in initial is no coordinate, rate or speed"),
    ({"values": GIVEN, "initial": {v: 2 * x, "x'": 3 * x}}, an.ModelError, r"initial gives x' two values, \(2\*x\) and \(3\*x\)"),
    ({"values": GIVEN, "initial": {"x'": 1, v: 2}}, an.ModelError, r"initial gives x' two values, 1 and 2\nhint: a speed that is the rate"),
]


@pytest.mark.parametrize("given, kind, said", MISTAKES)
def test_mistakes_are_named(given: dict[str, Any], kind: type[Exception], said: str) -> None:
    with pytest.raises(kind, match=said):
        an.from_sympy(pushed(F - k * x), **given)


def test_values_that_are_no_mistakes() -> None:
    other = sm.Symbol("other")  # a value for a symbol of another system is allowed
    values: Any = {m: np.array(1.5), "k": 2, "F": 3, other: 1}
    model = an.from_sympy(pushed(F - k * x), values=values, initial={"x'": 1, v: 1.0})
    assert model.evaluate().accelerations == {"x''": 2} and model.evaluate().qdot == {"x'": 1}
    with pytest.raises(an.ModelError, match=r"from_sympy\(…, values=\{F: …\}\)"):
        an.from_sympy(pushed(F), values={m: 1}).evaluate()


def test_a_joints_method() -> None:
    if not hasattr(me, "JointsMethod"):
        pytest.skip("this SymPy has no JointsMethod")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        wall, bob = me.Body("wall"), me.Body("bob", mass=m, central_inertia=me.inertia(N, 0, 0, 0))
        pin = me.PinJoint("pin", wall, bob, x, v, child_point=k * bob.frame.x, joint_axis=wall.z)
        bob.apply_force(-m * wall.y)
        joints = me.JointsMethod(wall, pin)
        with pytest.raises(an.ModelError, match=r"the JointsMethod has no equations yet\nhint: call form_eoms\(\)"):
            an.from_sympy(joints, values={m: 1, k: 2})
        joints.form_eoms()
    numbers = {x: 0.4, v: 0.3, m: 1, k: 2}
    expected = joints.mass_matrix.subs(numbers).LUsolve(joints.forcing.subs(numbers))
    model = an.from_sympy(joints, values={m: 1, k: 2}, initial={x: 0.4, v: 0.3})
    assert model.evaluate().accelerations["x''"] == pytest.approx(float(expected[0]), rel=1e-13)
    assert math.isfinite(float(expected[0]))


def test_two_symbols_of_one_name() -> None:
    positive = sm.Symbol("k", positive=True)
    method = pushed(-k * x - positive * v)
    with pytest.raises(an.ModelError, match=r"2 symbols have the name k: Symbol\('k'\), Symbol\('k', positive=True\)\nhint: .*by the symbol itself"):
        an.from_sympy(method, values={m: 1, "k": 2})
    with pytest.raises(an.ModelError, match=r"values=\{Symbol\('k', positive=True\): 1\}"):
        an.from_sympy(method, values={m: 1, k: 2})
    model = an.from_sympy(method, values={m: 1, k: 2, positive: 3}, initial={x: 1, v: 1})
    assert model.evaluate().accelerations == {"x''": -5.0}


def test_symbols_of_an_orientation_have_values() -> None:
    """A tilt occurs in no velocity and no load, but its value is accepted."""
    tilt = sm.Symbol("tilt")
    A, P = N.orientnew("A", "Axis", [tilt, N.z]), me.Point("P")
    P.set_vel(N, v * A.x)
    method = me.KanesMethod(N, [x], [v], kd_eqs=[x.diff(t) - v])
    method.kanes_equations([me.Particle("p", P, m)], [(P, -m * N.y)])
    for key in (tilt, "tilt"):
        model = an.from_sympy(method, values={m: 1, key: sm.pi / 6})
        assert model.evaluate().accelerations["x''"] == pytest.approx(-0.5)
    P.set_vel(N, v * N.x)
    method = me.KanesMethod(N, [x], [v], kd_eqs=[x.diff(t) - v])
    method.kanes_equations([me.Particle("p", P, m)], [(P, -k * x * N.x), (P, k * A.z)])
    assert an.from_sympy(method, values={m: 1, k: 1, tilt: 1}).parameters == {"m": 1.0, "k": 1.0}


NO_COUNTERPART: dict[str, tuple[Any, str]] = {
    "an integral": (sm.Integral(x, (t, 0, t)), r"Integral in Integral\(x\(t\), \(t, 0, t\)\) has no counterpart"),
    "infinity": (sm.oo * x, r"nan is no real number"),
    "an imaginary number": (sm.I * x, r"I is no real number"),
    "an indexed symbol": (sm.IndexedBase("a")[m] * x, r"Indexed in a\[m\] has no counterpart"),
    "an entry of a matrix": (sm.MatrixSymbol("A", 2, 2)[0, m] * x, r"MatrixElement in A\[0, m\] has no counterpart"),
    "a derivative by a coordinate": (sm.Function("F")(x).diff(x), r"the derivative .* is not one by the time .*\nhint: put a formula in its place$"),
    "a function of a coordinate": (sm.Function("F")(x), r"F\(x\(t\)\) is no function of the time t alone\nhint: .* in the place of F\(x\(t\)\)$"),
    "a delay": (x.subs(t, t - 1), r"x\(t - 1\) is no function of the time t alone\nhint: .*, as delays have no counterpart"),
}


@pytest.mark.parametrize("name", NO_COUNTERPART)
def test_what_has_no_counterpart_has_a_name_and_a_place(name: str) -> None:
    force, said = NO_COUNTERPART[name]
    with pytest.raises(an.ModelError, match="^the generalized force of x: " + said):
        an.from_sympy(pushed(force), values=GIVEN)
