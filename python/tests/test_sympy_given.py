"""The values and initial values of ``from_sympy``: formulas of the motion, entries of matrices, names of keys, and the time."""

import warnings
from typing import Any

import anholon as an
import numpy as np
import pytest

sm = pytest.importorskip("sympy")
me = pytest.importorskip("sympy.physics.mechanics")

x, y, a, b, F = me.dynamicsymbols("x y a b F")
t = me.dynamicsymbols._t
m, k, c = sm.symbols("m k c")
N = me.ReferenceFrame("N")
VALUES = {m: 1.5, k: 20, c: 0.75}
SUMS = [x.diff(t) + y.diff(t) - a, x.diff(t) - y.diff(t) - b]  # kinematic equations: a is x' + y', b is x' - y'
RATES = [x.diff(t) - a, y.diff(t) - b]
AT = {x: 0.75, y: -0.5, a: 0.625, b: 0.25}


def plane(force: Any, kinematic: list[Any], mass: Any = m) -> Any:
    """Makes a particle in the plane under a force along x."""
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * N.x + y * N.y)
    P.set_vel(N, (a + b) / 2 * N.x + (a - b) / 2 * N.y if kinematic is SUMS else a * N.x + b * N.y)
    method = me.KanesMethod(N, [x, y], [a, b], kd_eqs=kinematic)
    method.kanes_equations([me.Particle("p", P, mass)], [(P, force * N.x), (P, (-k * y + c) * N.y)])
    return method


def rates_of_sympy(method: Any, laws: dict[Any, Any]) -> dict[Any, float]:
    """Returns the rates of coordinates and speeds by SymPy's right side, with formulas in the place of symbols and functions."""
    rates = [e.subs(laws).doit() for e in method.rhs()]
    known = dict(zip([s.diff(t) for s in [*method.q, *method.u]], rates, strict=True))
    return {s: float(e.subs(known).subs(AT).subs(VALUES).subs(t, 0)) for s, e in zip([*method.q, *method.u], rates, strict=True)}


def accelerations(method: Any, laws: dict[Any, Any]) -> dict[str, float]:
    of = rates_of_sympy(method, laws)
    if method._k_kqdot_implicit[0, 1] == 0:
        return {"x''": of[a], "y''": of[b]}
    return {"x''": (of[a] + of[b]) / 2, "y''": (of[a] - of[b]) / 2}


LAWS: dict[str, tuple[Any, dict[Any, Any]]] = {
    "a feedback of a coordinate": (F, {F: -4 * x}),
    "a feedback of a speed": (F * x, {F: -4 * x - a + b**2}),
    "a feedback of a rate": (F, {F: -4 * x - y.diff(t)}),
    "a feedback with parameters": (F, {F: -k * x - c * a * sm.Abs(a)}),
    "a rate of a feedback": (F + c * F.diff(t), {F: -4 * x**2}),
    "a symbol": (k * F, {k: 3 + x * b, F: 2 - y}),
    "a symbol of the time": (c + k * x, {k: 3 + 2 * sm.cos(t)}),
    "a law of another law": (F, {F: k * x, k: 2 + a}),
    "a feedback and the time": (F, {F: sm.exp(-t) - 4 * a}),
}


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("kinematic", [RATES, SUMS], ids=["rates", "sums"])
def test_laws_are_put_into_loads(name: str, kinematic: list[Any]) -> None:
    force, laws = LAWS[name]
    method = plane(force, kinematic)
    nested = {of: e.subs(laws) for of, e in laws.items()}
    model = an.from_sympy(method, values={**VALUES, **laws}, initial=AT)
    assert model.evaluate().accelerations == pytest.approx(accelerations(method, nested), rel=1e-13)


TEXTS: list[tuple[str, Any]] = [
    ("-4*x - a", -4 * x - a),
    ("-4*x-a+b^2", -4 * x - a + b**2),
    ("-k*x*exp(-a)", -k * x * sm.exp(-a)),
    ("3e-1*x' - sin(30 deg)*b", 0.3 * x.diff(t) - b / 2),
    ("2 - c*a", 2 - c * a),
]


@pytest.mark.parametrize("text, same", TEXTS)
@pytest.mark.parametrize("kinematic", [RATES, SUMS], ids=["rates", "sums"])
def test_laws_may_be_texts(text: str, same: Any, kinematic: list[Any]) -> None:
    method = plane(F, kinematic)
    model = an.from_sympy(method, values={**VALUES, "F": text}, initial=AT)
    assert model.evaluate().accelerations == pytest.approx(accelerations(method, {F: same}), rel=1e-13)


def test_a_text_may_hold_the_rate_of_a_speed() -> None:
    # m x'' = F with F = 2 - c (x'' + y'') and m y'' = c - k y.
    model = an.from_sympy(plane(F, SUMS), values={**VALUES, "F": "2 - c*a'"}, initial=AT)
    second = (0.75 + 20 * 0.5) / 1.5
    assert model.evaluate().accelerations == pytest.approx({"x''": (2 - 0.75 * second) / (1.5 + 0.75), "y''": second}, rel=1e-13)


def test_a_controlled_motion() -> None:
    """The feedback of coordinate and speed makes a damped oscillation, whose solution is closed."""
    q, u, torque = me.dynamicsymbols("q u torque")
    B = N.orientnew("B", "Axis", [q, N.z])
    B.set_ang_vel(N, u * N.z)
    G = me.Point("G")
    G.set_vel(N, 0)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff(t) - u])
    method.kanes_equations([me.RigidBody("rotor", G, B, m, (me.inertia(B, 0, 0, 1), G))], [(B, torque * N.z)])
    laws: list[dict[Any, Any]] = [{torque: -4 * q - u}, {"torque": "-4*q-u"}, {sm.Function("torque"): -4 * q - u}]
    for law in laws:
        run = an.from_sympy(method, values={m: 1, **law}, initial={q: 1, u: -0.5}).simulate(to=3, at=[3]).expect()
        assert run["q"][-1] == pytest.approx(np.exp(-1.5) * np.cos(np.sqrt(3.75) * 3), rel=1e-10)


def test_a_law_in_a_lagrangian() -> None:
    """Lagrange's equation for m x'^2/2 - F x is m x'' = -F, in which the law stands for F."""
    method = me.LagrangesMethod(m * x.diff(t) ** 2 / 2 - F * x, [x])
    method.form_lagranges_equations()
    model = an.from_sympy(method, values={m: 2, F: 3 * x + x.diff(t)}, initial={x: 0.5, x.diff(t): 0.25})
    assert model.evaluate().accelerations == pytest.approx({"x''": -(1.5 + 0.25) / 2}, rel=1e-14)


def test_a_law_beyond_loads_is_refused() -> None:
    for mass, law, said in [
        (m, {m: 2 + x}, r"^the value of m depends on coordinates or speeds, and m occurs in a mass, .*\nhint: .* in loads and potentials alone; elsewhere put"),
        (m, {m: 2 + t}, r"^the value of m depends on the time, .* takes it for a constant\nhint: .*, m = me.dynamicsymbols\('m'\)"),
        (m, {m: 2 + F, F: a}, r"^the value of m depends on coordinates or speeds"),
        (F, {F: 2 + a}, r"^the value of F depends on coordinates or speeds, and F occurs in a mass"),
    ]:
        with pytest.raises(an.ModelError, match=said):
            an.from_sympy(plane(0, SUMS, mass), values={**VALUES, **law})
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, F * N.x)
    P = O.locatenew("P", x * N.x)
    P.set_vel(N, (a + F) * N.x)
    method = me.KanesMethod(N, [x], [a], kd_eqs=[x.diff(t) - a])
    method.kanes_equations([me.Particle("p", P, m)], [(P, -k * x * N.x)])
    assert "F'" in an.from_sympy(method, values={**VALUES, F: sm.sin(t)}).text or True
    with pytest.raises(an.ModelError, match="^the value of F depends on coordinates or speeds, and F occurs in"):
        an.from_sympy(method, values={**VALUES, F: x})


def test_a_law_of_another_system_is_left_out() -> None:
    q2, F2 = me.dynamicsymbols("q2 F2")
    model = an.from_sympy(plane(F, RATES), values={**VALUES, F: -x, F2: -4 * q2}, initial=AT)
    assert model.evaluate().accelerations["x''"] == -0.5
    assert set(model.parameters) == {"m", "k", "c"}


STARTS: list[tuple[dict[Any, Any], dict[str, float]]] = [
    ({x: 1, y: 0, a: 0.5, b: 2 * x}, {"x'": 1.25, "y'": -0.75}),
    ({x: 1, y: 0, a: 0.5, b: 2 * a}, {"x'": 0.75, "y'": -0.25}),
    ({x: 1, y: 0, a: 0.5, b: "2*a"}, {"x'": 0.75, "y'": -0.25}),
    ({x: 1, y: 0, "x'": 0.5, b: y.diff(t) + k * x}, {"x'": 0.5, "y'": -9.75}),
    ({x: 2 * y, y: 0.5, a: x, "b": "3 - x"}, {"x'": 1.5, "y'": -0.5}),
    ({x: 1 + 2 * t, y: sm.cos(t) - 1, a: k * sm.exp(t), b: k}, {"x'": 20, "y'": 0}),
    ({x: 1, y: 0, x.diff(t): 0.25, y.diff(t): x.diff(t) + sm.pi * x}, {"x'": 0.25, "y'": 0.25 + np.pi}),
]


@pytest.mark.parametrize("initial, rates", STARTS)
def test_initial_values_of_sums(initial: dict[Any, Any], rates: dict[str, float]) -> None:
    state = an.from_sympy(plane(0, SUMS), values=VALUES, initial=initial).evaluate()
    assert state.q == {"x": 1, "y": 0 if initial[y] != 0.5 else 0.5}
    assert state.qdot == pytest.approx(rates, rel=1e-13, abs=1e-13)


@pytest.mark.parametrize("value", [2 * x, 2 * y.diff(t), 2 * b, k * b / 10, "2*x", "2*b", "2*y'", F, 2 * x + t])
def test_initial_values_of_rates(value: Any) -> None:
    model = an.from_sympy(plane(0, RATES), values={**VALUES, F: 1 + sm.cos(t)}, initial={x: 1, y: 0.25, b: 1, a: value})
    assert model.evaluate().qdot == pytest.approx({"x'": 2, "y'": 1}, rel=1e-14)


@pytest.mark.parametrize("name", ["q_{1}", r"\theta_{1}", "q_1^A", "θ", "q1"])
def test_names_of_keys(name: str) -> None:
    q, u = sm.Function(name)(t), sm.Function("u")(t)
    P = me.Point("P")
    P.set_vel(N, u * N.x)
    method = me.KanesMethod(N, [q], [u], kd_eqs=[q.diff(t) - u])
    method.kanes_equations([me.Particle("p", P, m)], [(P, -k * q * N.x)])
    for initial in ({name: 0.5, name + "'": 2}, {q: 0.5, q.diff(t): 2}, {name: 0.5, "u": 2}):
        state = an.from_sympy(method, values={m: 2, k: 3}, initial=initial).evaluate()
        assert [*state.q.values(), *state.qdot.values(), *state.accelerations.values()] == [0.5, 2, -0.75]


def test_a_symbol_with_the_name_of_the_time() -> None:
    other = sm.Symbol("t", positive=True)
    method = plane(sm.cos(k * other), RATES)
    is_not = r"Symbol\('t', positive=True\) is not the time, which is me.dynamicsymbols._t = Symbol\('t'\)"
    with pytest.raises(an.ModelError, match=rf"^{is_not}\nhint: .*values=\{{Symbol\('t', positive=True\): me.dynamicsymbols._t\}}"):
        an.from_sympy(method, values=VALUES)
    for key in (other, "t"):
        with pytest.warns(UserWarning, match=rf"^{is_not}; the model has the constant 1 for it") as told:
            an.from_sympy(method, values={**VALUES, key: 1})
        assert told[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        model = an.from_sympy(method, values={**VALUES, k: 2, other: t})
    run = model.simulate(to=3, at=[3]).expect()  # 1.5 x'' = cos(2 t)
    assert run["x"][-1] == pytest.approx((1 - np.cos(6)) / 4 / 1.5, rel=1e-12)
    with pytest.raises(an.ModelError, match=rf"f\(t\) is no function of the time: {is_not}"):
        an.from_sympy(plane(sm.Function("f")(other), RATES), values=VALUES)
    with pytest.raises(an.ModelError, match=rf"^{is_not}, and it occurs in a mass"):
        an.from_sympy(plane(0, RATES, 2 + other), values={**VALUES, other: t})


K, p = sm.MatrixSymbol("K", 2, 2), sm.IndexedBase("p", positive=True)


def rod(stiff: Any, mass: Any, moment: Any, arm: Any, tilt: Any) -> Any:
    """Makes a rod that turns about the end of a slide, along an axis that is tilted."""
    A = N.orientnew("A", "Axis", [tilt, N.z])
    B = A.orientnew("B", "Axis", [y, A.z])
    B.set_ang_vel(N, b * N.z)
    O = me.Point("O")  # noqa: E741
    O.set_vel(N, 0)
    P = O.locatenew("P", x * A.x)
    P.set_vel(N, a * A.x)
    G = P.locatenew("G", arm * B.x)
    G.v2pt_theory(P, N, B)
    method = me.KanesMethod(N, [x, y], [a, b], kd_eqs=RATES)
    method.kanes_equations([me.RigidBody("rod", G, B, mass, (me.inertia(B, 0, moment, moment), G))], [(P, -stiff * x * A.x), (G, -mass * N.y)])
    return method


@pytest.mark.parametrize("entries", [[K[0, 0], K[0, 1], K[1, 0], K[1, 1], p[0]], [p[0], p[1, 2], p[2], p[3], K[1, 1]]], ids=["matrix", "indexed"])
def test_entries_of_matrices_are_symbols(entries: list[Any]) -> None:
    numbers = [20, 1.5, 0.25, 0.5, 0.3]
    plain = rod(*sm.symbols("s m J l h")).rhs().subs(dict(zip(sm.symbols("s m J l h"), numbers, strict=True))).subs(AT)
    method, expected = rod(*entries), {"x''": float(plain[2]), "y''": float(plain[3])}
    for keys in (entries, [str(e) for e in entries], [str(e).replace(" ", "") for e in entries]):
        model = an.from_sympy(method, values=dict(zip(keys, numbers, strict=True)), initial=AT)
        assert model.evaluate().accelerations == pytest.approx(expected, rel=1e-12)
    names = {str(e).replace("[", "_").replace(", ", "_").replace("]", "") for e in entries}
    assert set(model.parameters) == names
    with pytest.raises(an.ModelError, match=rf"^values are missing for .*{sm.sstr(entries[0])[0]}\[0"):
        an.from_sympy(method, values={entries[1]: 1})


def test_entries_in_values_and_constraints() -> None:
    """A bead on a parabola y = p x^2 without gravity, pushed along x: (1 + 4 p^2 x^2) x'' + 4 p^2 x x'^2 = f/m."""
    P = me.Point("P")
    P.set_vel(N, a * N.x + b * N.y)
    on = y - K[0, 1] * x**2
    method = me.KanesMethod(
        N, [x], [a], kd_eqs=RATES, q_dependent=[y], u_dependent=[b], configuration_constraints=[on],
        velocity_constraints=[b - 2 * K[0, 1] * x * a],
    )  # fmt: skip
    method.kanes_equations([me.Particle("bead", P, m)], [(P, F * N.x)])
    model = an.from_sympy(method, values={m: 2, K[0, 1]: p[0] / 2, p[0]: 3, F: K[0, 1] * x}, initial={x: 0.5, a: 0.25})
    of = 1.5
    expected = (of * 0.5 / 2 - 4 * of**2 * 0.5 * 0.25**2) / (1 + 4 * of**2 * 0.25)
    assert model.evaluate().accelerations["x''"] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    "force",
    [
        sm.diff(sm.cos(x), x, evaluate=False),
        sm.diff(k * a**2 * x, a, evaluate=False),
        sm.diff(x**2, t, evaluate=False),
        sm.diff(sm.diff(x**2 * y, x, evaluate=False) * x, x, evaluate=False),
        sm.diff(c * sm.sin(k), k, evaluate=False),
    ],
    ids=str,
)
@pytest.mark.parametrize("kinematic", [RATES, SUMS], ids=["rates", "sums"])
def test_derivatives_are_worked_out(force: Any, kinematic: list[Any]) -> None:
    expected = accelerations(plane(force.doit(), kinematic), {})
    model = an.from_sympy(plane(force, kinematic), values=VALUES, initial=AT)
    assert model.evaluate().accelerations == pytest.approx(expected, rel=1e-13)
    if kinematic is RATES and not force.has(a):
        model = an.from_sympy(plane(F, kinematic), values={**VALUES, F: force}, initial=AT)
        assert model.evaluate().accelerations == pytest.approx(expected, rel=1e-13)
