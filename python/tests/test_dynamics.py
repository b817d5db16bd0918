"""The equations as a function have the accelerations of the motion, for one state and for batches, and serve other integrators."""

import os
import threading
from typing import Any

import anholon as an
import numpy as np
import pytest

MODELS = ["disc", "chaplygin-sleigh", "snakeboard", "car-three-trailers", "rolling-coin", "chain", "two-wheeled-pendulum", "double-pendulum-cartesian", "fourbar"]


@pytest.mark.parametrize("name", MODELS)
def test_rates_are_those_of_the_motion(name: str) -> None:
    model = an.load(name)
    run = model.simulate(to=1, every="0.25", error_estimate=False).expect()
    f = model.dynamics(minimal=False)
    names = [state.name for state in f.states]
    assert not f.minimal and all(state.meaning == "" for state in f.states)
    q = [c.name for c in model.coordinates]
    for row, t in enumerate(run.t):
        rates = dict(zip(names, f(t, [run[state][row] for state in names]), strict=True))
        for c in q:
            assert rates[c] == run[c + "'"][row]
            assert rates[c + "'"] == pytest.approx(run[c + "''"][row], rel=1e-11, abs=1e-11)


@pytest.mark.parametrize("name", ["disc", "chaplygin-sleigh", "snakeboard", "rolling-coin"])
def test_independent_velocities_give_the_same_motion(name: str) -> None:
    integrate = pytest.importorskip("scipy.integrate")
    model = an.load(name)
    run = model.simulate(to=1, at=[1], error_estimate=False).expect()
    f = model.dynamics()
    assert f.minimal and len(f.start) < 2 * len(model.coordinates)
    done = integrate.solve_ivp(f, (f.t0, 1), f.start, "DOP853", rtol=1e-12, atol=1e-12)
    motion = f.motion(done.y[:, -1], 1.0)
    for c in model.coordinates:
        assert motion[c.name] == pytest.approx(run[c.name][0], rel=1e-9, abs=1e-9)
        assert motion[c.name + "'"] == pytest.approx(run[c.name + "'"][0], rel=1e-9, abs=1e-9)
    # At least one parameter changes the rates.
    changes: list[dict[str, Any]] = [{p: 3} for p in model.parameters]
    others = [model.with_(**change).dynamics()(0.5, f.start) for change in changes]
    assert any(not np.allclose(other, f(0.5, f.start), rtol=1e-6) for other in others)


SLEIGH_WITH_A_SPRING = """
coordinates = ["x", "y", "th"]
parameters = {{m = 2, a = "3/5", J = "1/2"}}
frame.blade = "rotz(th)"
body = [{{name = "sleigh", mass = "m", inertia = "J", center = "x*ex + y*ey + a*blade.x", orientation = "blade"}}]
constraint = [{{name = "edge", equation = "y'*cos(th) - x'*sin(th) = 0"}}]
force = [{{name = "spring", generalized = {{x = "{force}"}}}}]
initial = {{th = 0, "x'" = 1}}
"""


@pytest.mark.parametrize("force", ["sqrt(2 + x^2)", "(2 + x^2)^(3/2)", "x'*sqrt(1 + x'^2 + y^2)", "sqrt(1 + t^2)", "tanh(x)"])
def test_smooth_forces_leave_velocities_independent(force: str) -> None:
    model = an.loads(SLEIGH_WITH_A_SPRING.format(force=force))
    f, whole = model.dynamics(), model.dynamics(minimal=False)
    assert f.minimal and len(f.states) == 5 and not whole.minimal
    names = [c.name for c in model.coordinates]
    x = np.array([0.4, -0.3, 0.7, 0.9, -0.6])
    motion, slopes, t = f.motion(x, 0.25), f(0.25, x), 0.25
    state = whole.state(t, q={n: motion[n] for n in names}, qdot={n + "'": motion[n + "'"] for n in names})
    expected = dict(zip((s.name for s in whole.states), whole(t, state), strict=True))
    # Differences of order 4 give the rate of each velocity, which is linear in the independent ones and trigonometric in th.
    h = 1e-3
    for n in names:
        up, down, up2, down2 = (f.motion(x + k * h * slopes, t)[n + "'"] for k in (1, -1, 2, -2))
        assert (8 * (up - down) - (up2 - down2)) / (12 * h) == pytest.approx(expected[n + "'"], rel=1e-10, abs=1e-10)


def by_differences(f: an.Dynamics, t: float, x: Any, u: Any, p: Any, directions: Any) -> Any:
    """Returns the derivatives of the rates along directions of (x, u, p) by differences of order 4 of the formulas in 40 digits."""
    mpmath = pytest.importorskip("mpmath")
    with mpmath.workdps(40):
        h = mpmath.mpf(10) ** -9
        given = [mpmath.mpf(float(v)) for v in (*x, *u, *p)]
        n, m = len(x), len(u)

        def rates(direction: Any, change: int) -> list[Any]:
            at = [v + change * h * mpmath.mpf(float(d)) for v, d in zip(given, direction, strict=True)]
            rows: list[Any] = f.formulas.mpmath(t, at[:n], at[n : n + m], at[n + m :])[0]
            return rows

        columns = []
        for direction in directions.T:
            up, down, up2, down2 = (rates(direction, change) for change in (1, -1, 2, -2))
            columns.append([float((8 * (a - b) - (c - d)) / (12 * h)) for a, b, c, d in zip(up, down, up2, down2, strict=True)])
        return np.array(columns).T


HIGHER = ["constant-acceleration", "constant-jerk", "constant-jerk-central", "rheonomic-order-2", "rheonomic-order-3", "tether-by-servo", "third-order-linear"]
CASES = [(name, False) for name in HIGHER] + [(name, minimal) for name in [*MODELS, "rocket", "trailers", "snake"] for minimal in (True, False)] + [("whipple", False)]


@pytest.mark.parametrize(("name", "minimal"), CASES)
def test_derivatives_are_exact(name: str, minimal: bool) -> None:
    model = an.load(name)
    f = model.dynamics(minimal=minimal, inputs=True)
    x = f.start + 0.01 * np.cos(np.arange(len(f.start)))
    u, p = f.u0 + 0.3, f.p0[:] * (1 if name == "whipple" else 1.01)
    count = len(x) + len(u) + len(p)
    # The formulas of the bicycle are long, so two directions are enough; every derivative contributes to both.
    few = name == "whipple" and not os.environ.get("ANHOLON_LONG")
    directions = np.cos(np.outer(np.arange(count) + 1, [1, 2])) if few else np.eye(count)
    expected = by_differences(f, 0.25, x, u, p, directions)
    found = np.hstack([f.jac(0.25, x, u, p, by=by) for by in "xup"]) @ directions
    # jac() computes with numbers that are rounded to doubles, by_differences() with exact ones.
    assert np.abs(found - expected).max() <= 1e-12 * np.abs(expected).max()
    v, w = np.cos(np.arange(len(x))), np.sin(np.arange(len(x)))
    np.testing.assert_array_equal(f.jvp(0.25, x, v, u, p), f.jac(0.25, x, u, p) @ v)
    np.testing.assert_array_equal(f.vjp(0.25, x, w, u, p, by="p"), w @ f.jac(0.25, x, u, p, by="p"))
    wrong = expected.copy()
    wrong[-1, 1] += 1e-9 * np.abs(expected).max()
    assert np.abs(found - wrong).max() > 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("name", ["trailers", "snake"])
def test_inputs_are_arguments(name: str) -> None:
    model = an.load(name)
    for minimal in (True, False):
        closed, f = model.dynamics(minimal=minimal), model.dynamics(minimal=minimal, inputs=True)
        assert f.inputs == model.inputs and closed.inputs == []
        x = f.start + 0.02
        by_formulas = f.input(0.4, x)
        np.testing.assert_allclose(f(0.4, x), closed(0.4, x), rtol=1e-11, atol=1e-12)
        np.testing.assert_allclose(f(0.4, x, by_formulas), closed(0.4, x), rtol=1e-11, atol=1e-12)
        assert not np.allclose(f(0.4, x, by_formulas + 1), closed(0.4, x), rtol=1e-3)
        named = dict(zip(f.inputs, by_formulas, strict=True))
        np.testing.assert_array_equal(f(0.4, x, named), f(0.4, x, by_formulas))
        # A batch with a set of inputs for each state has the bits of single calls.
        many = np.tile(x[:, None], 300)
        u = by_formulas[:, None] + np.linspace(-1, 1, 300)
        rates = f(0.4, many, u)
        for k in (0, 7, 299):
            np.testing.assert_array_equal(rates[:, k], f(0.4, x, u[:, k]))
    one = model.dynamics(inputs=[model.inputs[-1]])
    assert one.inputs == model.inputs[-1:]
    with pytest.raises(an.ModelError, match="there is no input 'thrust'"):
        model.dynamics(inputs=["thrust"])
    with pytest.raises(ValueError, match="u has the shape"):
        f(0.4, x, np.ones(7))
    with pytest.raises(KeyError, match="thrust"):
        f(0.4, x, {"thrust": 1})


def test_parameters_are_arguments() -> None:
    model = an.load("disc")
    f = model.dynamics()
    x = f.start + 0.1
    other = model.with_(R=2, g=1.62).dynamics()
    given = f(0, x, p={"R": 2, "g": 1.62})
    assert other.parameters == f.parameters and not np.allclose(given, f(0, x), rtol=1e-3)
    p = f.p0.copy()
    p[f.parameters.index("R")], p[f.parameters.index("g")] = 2, 1.62
    np.testing.assert_array_equal(given, f(0, x, None, p))
    np.testing.assert_allclose(given, f.formulas.numpy()(0, x, None, p)[0], rtol=1e-13)
    np.testing.assert_array_equal(f(0, x), f(0, x, None, None))
    full, full_other = model.dynamics(minimal=False), model.with_(R=2, g=1.62).dynamics(minimal=False)
    y = full.start + 0.1
    np.testing.assert_allclose(full(0, y, p={"R": 2, "g": 1.62}), full_other(0, y), rtol=1e-12)


def test_parameters_that_follow_from_others_change_with_them() -> None:
    model = an.loads(
        """
        coordinates = ["x"]
        particle = [{name = "a", mass = "m", position = ["x", 0, 0]}]
        force = [{on = "a", vector = "-k*x*ex"}]
        [parameters]
        m = 2
        w = 3
        k = "m*w^2"
        [initial]
        q = {x = 1}
        """
    )
    f = model.dynamics(minimal=False)
    assert f.parameters == ["m", "w"]
    assert f(0, [1, 0], p={"w": 5})[1] == pytest.approx(-25, rel=1e-15)
    np.testing.assert_allclose(f.jac(0, [1, 0], by="p"), [[0, 0], [0, -6]], atol=1e-15)
    assert f.formulas.sympy().lead and f.mass_matrix(0, [1, 0]).tolist() == [[2]]


def test_the_equations_of_motion_as_arrays() -> None:
    model = an.load("disc")
    f = model.dynamics(minimal=False)
    x = f.start + 0.05 * np.sin(np.arange(len(f.start)))
    n = len(model.coordinates)
    mass, phi, bias = f.mass_matrix(0, x), f.constraint_jacobian(0, x), f.bias(0, x)
    assert mass.shape == (n, n) and phi.shape == (2, n) and np.allclose(mass, mass.T)
    acceleration = f(0, x)[n:]
    free = np.linalg.svd(phi)[2][len(phi) :]  # directions that the constraints leave free
    np.testing.assert_allclose(free @ (mass @ acceleration + bias), 0, atol=1e-13)
    assert np.abs(free @ bias).max() > 0.1
    # The constraints change by terms of second order only.
    dt = 1e-6
    later = x + dt * f(0, x)
    np.testing.assert_allclose(f.constraint_jacobian(0, later) @ later[n:], phi @ x[n:], atol=1e-10)
    with pytest.raises(an.ModelError, match="no mass matrix"):
        model.dynamics().mass_matrix(0, model.dynamics().start)


def test_outputs_are_those_of_a_run() -> None:
    model = an.load("trailers")
    run = model.simulate(to=1, every="0.5", error_estimate=False).expect()
    for minimal in (True, False):
        f = model.dynamics(minimal=minimal)
        names = [state.name for state in f.states]
        for row, t in enumerate(run.t):
            full = {column.name: run[column.name][row] for column in run.columns}
            x = [full[n] for n in names] if not minimal else f.state(
                t, q={c.name: full[c.name] for c in model.coordinates}, qdot={c.name + "'": full[c.name + "'"] for c in model.coordinates}
            )
            for name, value in zip(f.outputs, f.output(t, x), strict=True):
                assert value == pytest.approx(run[name][row], rel=1e-12, abs=1e-12)


def test_states_there_and_back() -> None:
    f = an.load("disc").dynamics()
    motion = f.motion(f.start)
    again = f.state(q={k: v for k, v in motion.items() if not k.endswith("'")}, qdot={k: v for k, v in motion.items() if k.endswith("'")})
    np.testing.assert_allclose(again, f.start, rtol=0, atol=1e-15)
    with pytest.raises(KeyError, match="there is no 'thet'"):
        f.state(q={"thet": 1}, qdot={})


def test_batches_have_the_same_bits() -> None:
    f = an.load("disc").dynamics()
    x = f.start[:, None] * (1 + 1e-2 * np.random.default_rng(0).standard_normal((len(f.start), 20_001)))
    all_rates = f(0.5, x)
    for k in (0, 1, 17, 4095, 4096, 20_000):
        np.testing.assert_array_equal(all_rates[:, k], f(0.5, x[:, k]))
    np.testing.assert_array_equal(f(0.5, x[:, :7]), all_rates[:, :7])
    np.testing.assert_array_equal(f(0.5, x.reshape(len(x), 3, 6667)), all_rates.reshape(len(x), 3, 6667))
    out = np.empty_like(x)
    assert f(0.5, x, out=out) is out
    with pytest.raises(ValueError, match="first axis has to be the 8 states"):
        f(0, x[:3])


def test_small_pivots_are_no_trouble() -> None:
    """With rods along the axes, pivots that were chosen at the start vanish. The accelerations satisfy the constraints there, too."""
    f = an.load("double-pendulum-cartesian").dynamics(minimal=False)
    tiny = 1e-9
    directions = [(1, tiny), (tiny, -1), (-1, tiny), (tiny, 1), (1, 0), (0, -1)]
    for a in directions:
        for b in directions:
            x = np.array([*a, a[0] + 0.75 * b[0], a[1] + 0.75 * b[1], -0.3 * a[1], 0.3 * a[0], -0.3 * a[1] - 0.2 * b[1], 0.3 * a[0] + 0.2 * b[0]])
            first, second = f(0, x)[4:6], f(0, x)[6:8]
            assert abs(x[:2] @ first + x[4:6] @ x[4:6]) < 1e-13
            rod, rate = x[2:4] - x[:2], x[6:8] - x[4:6]
            assert abs(rod @ (second - first) + rate @ rate) < 1e-13


def test_threads_share_a_function() -> None:
    f = an.load("disc").dynamics()
    x = np.tile(f.start[:, None], 1000)
    expected = f(0, x)
    same: list[bool] = []

    def work() -> None:
        same.extend(np.array_equal(f(0, x), expected) and np.array_equal(f(0, x[:, 0]), expected[:, 0]) for _ in range(50))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(same) == 200 and all(same)


@pytest.mark.parametrize("name", HIGHER)
def test_constraints_of_higher_order_have_rates_too(name: str) -> None:
    model = an.load(name)
    end = 0.75
    run = model.simulate(to=end, every="0.25", error_estimate=False).expect()
    f = model.dynamics()
    names = [state.name for state in f.states]
    x = np.array([run[n] for n in names])
    for row, t in enumerate(run.t):
        rates = f(t, x[:, row])
        # The run has columns for all derivatives for which the equations are solved.
        np.testing.assert_allclose(rates, [run[n + "'"][row] for n in names], rtol=1e-12, atol=1e-13)
    many = f.start[:, None] * (1 + 0.001 * np.random.default_rng(2).standard_normal((len(names), 100)))
    together = f(f.t0, many)
    for k in (0, 1, 15, 16, 99):
        np.testing.assert_array_equal(together[:, k], f(f.t0, many[:, k]))
    there = f.motion(x[:, -1])
    z = {n: there.pop(n) for n in model.states}
    q, qdot = ({n: v for n, v in there.items() if n.endswith("'") == dashed} for dashed in (False, True))
    np.testing.assert_array_equal(f.state(q=q, qdot=qdot, z=z), x[:, -1])
    # Each argument may be left out.
    np.testing.assert_array_equal(f.state(), f.state(q={}, qdot={}, z={}))
    np.testing.assert_array_equal(f.state(q=q), f.state(q=q, qdot={}))
    np.testing.assert_array_equal(f.state(qdot=qdot), f.state(q={}, qdot=qdot))
    with pytest.raises(an.ModelError, match="not solved for accelerations alone"):
        f.mass_matrix(0, f.start)


def test_a_solution_stays_on_its_branch() -> None:
    """An acceleration of given magnitude has several directions. The function follows the one at the start."""
    model = an.load("constant-acceleration")
    f = model.dynamics()
    assert not f.linear
    run = model.simulate(to=2, every="0.05", error_estimate=False).expect()
    for row, t in enumerate(run.t):
        x = [run[state.name][row] for state in f.states]
        np.testing.assert_allclose(f(t, x)[3:], [run[n][row] for n in ("x''", "y''", "z''")], rtol=1e-12, atol=1e-12)
    for formula in (f.formulas.sympy, f.c_code, f.casadi):
        with pytest.raises(an.ModelError, match="not linear in what they are solved for"):
            formula()
    with pytest.raises(an.ModelError, match="not linear in what they are solved for"):
        f.formulas.numpy()(0, f.start)
    # Accelerations are NaN if the straight line from the start reaches a state without a solution.
    assert np.isnan(f(0, np.full(len(f.start), np.nan))[3:]).all()


def test_a_constraint_that_follows_from_others_takes_no_part() -> None:
    text = """
        coordinates = ["x", "y"]
        particle = [{name = "a", mass = 2, position = ["x", "y", 0]}]
        force = [{on = "a", vector = "-3*ex - 5*y*ey"}]
        constraint = [{name = "slope", equation = "y' = 2*x'"}%s]
        [initial]
        q = {x = 1, y = 0.5}
        qdot = {x = 1}
        """
    once, twice = (an.loads(text % more).dynamics(minimal=False) for more in ("", ', {name = "again", equation = "3*y\' = 6*x\'"}'))
    np.testing.assert_allclose(twice(0, twice.start), once(0, once.start), rtol=1e-14)
    np.testing.assert_allclose(twice.jac(0, twice.start), once.jac(0, once.start), rtol=1e-14, atol=1e-15)
    # 2 (x'' + 4 x'') = -3 - 10 y
    assert once(0, once.start)[2] == pytest.approx(-0.8, rel=1e-15)


def test_who_has_no_such_function_says_why() -> None:
    with pytest.raises(an.ModelError, match="the given function 'm' has no formula"):
        an.load("luo-zhao-example-1-symbolic").dynamics()


def test_a_velocity_that_is_lost_is_told() -> None:
    blade = "coordinates = ['x', 'y', 'th']\nbody = [{name = 's', mass = 1, inertia = 1, center = 'x*ex + y*ey', angle = 'th'}]\nconstraint = [{name = 'e', equation = \"y'*cos(th) = x'*sin(th)\"}]"
    model = an.loads(blade)
    f = model.dynamics()
    with pytest.warns(UserWarning, match=r"is given, and the state has .*: the velocities violate the constraints"):
        f.state(q={"th": 1.5}, qdot={"x'": 1, "y'": 0})
    wanted: dict[str, Any] = {"th": 1.5, "x'": 1}
    values = {v.name: v.value for v in model.initial(**wanted)}
    x = f.state(q={n: values[n] for n in ("x", "y", "th")}, qdot={n: values[n] for n in ("x'", "y'", "th'")})
    assert f.motion(x)["x'"] == pytest.approx(1, rel=1e-12)


def batch_of(f: an.Dynamics, count: int) -> np.ndarray:
    return f.start[:, None] * (1 + 0.01 * np.random.default_rng(3).standard_normal((len(f.start), count)))


@pytest.mark.parametrize("minimal", [True, False])
def test_batches_of_derivatives_and_outputs_have_the_bits_of_one_state(minimal: bool) -> None:
    f = an.load("two-wheeled-pendulum").dynamics(minimal=minimal, inputs=False, outputs=["al", "norm(vel(axle))"])
    x, p = batch_of(f, 600), f.p0[:, None] * np.linspace(0.9, 1.1, 600)
    for by in ("x", "p"):
        for of in ("x'", "y"):
            many = f.jac(0.1, x, p=p, by=by, of=of)
            for k in (0, 1, 255, 256, 599):
                np.testing.assert_array_equal(many[..., k], f.jac(0.1, x[:, k], p=p[:, k], by=by, of=of))
    y = f.output(0.1, x, p=p)
    assert y.shape == (2, 600)
    np.testing.assert_array_equal(y[0], x[3])
    np.testing.assert_array_equal(y[:, 7], f.output(0.1, x[:, 7], p=p[:, 7]))
    cube = x.reshape(len(x), 20, 30)
    np.testing.assert_array_equal(f.jac(0.1, cube).reshape(len(x), len(x), 600), f.jac(0.1, x))
    v, w = np.arange(1.0, len(x) + 1), np.random.default_rng(1).standard_normal(x.shape)
    jac = f.jac(0.1, x)
    np.testing.assert_allclose(f.jvp(0.1, x, v), np.einsum("ijk,j->ik", jac, v), rtol=1e-14)
    np.testing.assert_allclose(f.jvp(0.1, x, w), np.einsum("ijk,jk->ik", jac, w), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(f.vjp(0.1, x, w), np.einsum("ijk,ik->jk", jac, w), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(f.jvp(0.1, x[:, 3], w[:, 3]), f.jvp(0.1, x, w)[:, 3], rtol=1e-13)
    with pytest.raises(ValueError, match="the vector has the shape"):
        f.jvp(0.1, x, w[:, :5])


@pytest.mark.parametrize("name", ["two-wheeled-pendulum", "rattleback"])
def test_machine_code_of_derivatives_has_the_bits_of_tables(name: str) -> None:
    """After some thousand states machine code replaces the tables; the derivatives keep their bits."""
    f = an.load(name).dynamics(inputs=False)
    x = batch_of(f, 12_000)
    first = [f.jac(0.1, x[:, k]) for k in (0, 5, 11_999)]
    many = f.jac(0.1, x)
    for k, before in zip((0, 5, 11_999), first, strict=True):
        np.testing.assert_array_equal(many[..., k], before)
        np.testing.assert_array_equal(f.jac(0.1, x[:, k]), before)
    # Central differences have about ten digits.
    scale = 1e-5 * (1 + abs(x[:, 5]))
    step = np.diag(scale)
    differences = np.column_stack([(f(0.1, x[:, 5] + d) - f(0.1, x[:, 5] - d)) / (2 * scale[i]) for i, d in enumerate(step)])
    np.testing.assert_allclose(first[1], differences, rtol=1e-6, atol=1e-6 * abs(first[1]).max())


def test_batches_of_the_equations() -> None:
    f = an.load("disc").dynamics(minimal=False)
    x = batch_of(f, 300)
    M, h, Phi = f.mass_matrix(0, x), f.bias(0, x), f.constraint_jacobian(0, x)
    assert (M.shape, h.shape, Phi.shape) == ((5, 5, 300), (5, 300), (2, 5, 300))
    for k in (0, 299):
        np.testing.assert_array_equal(M[..., k], f.mass_matrix(0, x[:, k]))
        np.testing.assert_array_equal(h[..., k], f.bias(0, x[:, k]))
        np.testing.assert_array_equal(Phi[..., k], f.constraint_jacobian(0, x[:, k]))
    rates = f(0.0, x)
    force = np.einsum("ijk,jk->ik", M, rates[5:]) + h
    lam = np.stack([np.linalg.lstsq(Phi[..., k].T, force[:, k], rcond=None)[0] for k in range(300)], axis=1)
    np.testing.assert_allclose(np.einsum("ijk,ik->jk", Phi, lam), force, atol=1e-11)


def test_reactions_and_multipliers_as_outputs() -> None:
    model = an.load("disc")
    f = model.dynamics(minimal=False, outputs={"N": "reaction(disc)", "l": "lambda.rolling.y", "a": "D(theta, 2)"})
    assert f.outputs == ["N.x", "N.y", "N.z", "l", "a"]
    state = model.evaluate()
    y = f.output(0.0, f.start)
    np.testing.assert_allclose(y[:3], state.reactions["disc"]["force"], rtol=1e-13, atol=1e-13)
    assert y[3] == pytest.approx(state.multipliers["rolling.y"], rel=1e-13)
    assert y[4] == pytest.approx(state.accelerations["theta''"], rel=1e-13)
    h = 1e-6
    changed = f.start.copy()
    changed[3] += h
    assert f.jac(0, f.start, of="y")[3, 3] == pytest.approx((f.output(0, changed)[3] - y[3]) / h, rel=1e-4)
    assert model.dynamics(outputs=[]).outputs == []
    trailers = an.load("trailers")
    assert trailers.dynamics(outputs=trailers.monitors[:1]).outputs == trailers.monitors[:1]
    for mistake in ({"l": "lambda.rolling.y"}, ["thetaa"], ["lean"]):
        with pytest.raises(an.ModelError):
            model.dynamics(outputs=mistake)
    with pytest.raises(an.ModelError, match="minimal=False"):
        model.dynamics(outputs=["lambda.rolling.y"])


def test_a_text_is_one_name() -> None:
    disc = an.load("disc")
    assert list(disc.dynamics(outputs="theta").outputs) == ["theta"]
    with pytest.raises(an.ModelError, match="there is no input 'torque'"):
        disc.dynamics(inputs="torque")
    assert str(disc.prove(["maggi", "kane"])) == str(disc.prove("maggi", "kane"))
    with pytest.raises(an.ModelError, match=r"1 coordinates \(psi\)"):
        disc.evaluate(form="chaplygin", eliminate="psi")


@pytest.mark.parametrize(
    ("name", "obstacle"),
    [
        ("disc", ""),
        ("double-pendulum-cartesian", "the constraint 'rod2' is of order 0"),
        ("variable-mass-pendulum", "there are no constraints, so the velocities are independent as they are"),
        ("perpendicular-velocities", "the constraint 'square' is not linear in the velocities"),
    ],
)
def test_a_function_tells_why_velocities_are_not_independent(name: str, obstacle: str) -> None:
    f = an.load(name).dynamics()
    assert f.obstacle == obstacle and f.minimal == (obstacle == "")
    assert an.load(name).dynamics(minimal=False).obstacle == "all velocities were asked for"


def test_states_that_are_not_numbers_have_rates_that_are_none() -> None:
    # The equations have no solution at such states, and the reference expansion names a formula that has no value.
    model = an.loads(
        """
        coordinates = ["x", "y", "th"]
        body = [{name = "skate", mass = 2, inertia = 0.3, center = "x*ex + y*ey", angle = "th"}]
        force = [{on = "skate", vector = "ex - norm(vel(skate.center))*vel(skate.center)"}]
        constraint = [{name = "edge", equation = "dot(vel(skate.center), skate.y) = 0"}]
        initial = {x = 0, y = 0, th = 0.4, "th'" = 2, conditions = ["x'*cos(th) + y'*sin(th) = 1"]}
        """
    )
    for minimal in (True, False):
        f = model.dynamics(minimal=minimal)
        assert np.isnan(f(0, f.start * np.nan)[:3]).all()
        many = np.tile(f.start[:, None], 3)
        many[2, 1] = np.nan
        rates = f(0, many)
        assert np.isnan(rates[:, 1]).any()
        np.testing.assert_array_equal(rates[:, [0, 2]], f(0, many[:, [0, 2]]))
        with pytest.raises(ValueError, match="it has to be one state"):
            f.motion(f.start[:2])


def test_a_singular_state_has_no_rates() -> None:
    model = an.loads(
        """
        coordinates = ["x", "y"]
        particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
        constraint = [{name = "rod", equation = "x^2 + y^2 = 1"}]
        initial = {x = 1, "y'" = 1}
        """
    )
    f = model.dynamics(minimal=False)
    assert np.isnan(f(0, np.zeros(4))[2:]).all()


DRIFTING = """
coordinates = ["x", "y", "th"]
parameters = {m = 2, J = 0.4, w = 0.1}
point.P = "x*ex + y*ey"
frame.B = "rotz(th)"
body = [{name = "s", mass = "m", inertia = "J", center = "P", orientation = "B"}]
constraint = [{name = "blade", equation = "dot(vel(P), B.y) = w"}]
initial = {x = 0, y = 0, th = 0, "th'" = 1, "x'" = 1}
"""


def test_independent_velocities_of_a_blade_that_drifts_have_no_poles() -> None:
    model = an.loads(DRIFTING)
    f, whole = model.dynamics(), model.dynamics(minimal=False)
    assert f.minimal and all("/" not in state.meaning for state in f.states)
    for th in (1.0, 1.5707, np.pi / 2, 3.0):
        velocities = {"x'": 2 * np.cos(th) - 0.1 * np.sin(th), "y'": 2 * np.sin(th) + 0.1 * np.cos(th), "th'": 1.0}
        x, y = (of.state(q={"th": th}, qdot=velocities) for of in (f, whole))
        assert f.motion(x) == pytest.approx({"x": 0, "y": 0, "th": th, **velocities}, abs=1e-14)
        np.testing.assert_allclose(f(0, x)[:3], whole(0, y)[:3], atol=1e-14)
        # m (v' - w th') = 0 along the blade, J th'' = 0.
        assert sorted(np.abs(f(0, x)[3:])) == pytest.approx([0, 0.1], abs=1e-14)
    run = model.simulate(to=3, at=[3]).expect()
    assert run["x'"][-1] * np.cos(3) + run["y'"][-1] * np.sin(3) == pytest.approx(1.3, rel=1e-13)


def test_a_start_without_rates_is_told() -> None:
    pendulum = an.loads("""coordinates = ["theta", "phi"]
particle = [{name = "bob", mass = "1", position = "sin(theta)*cos(phi)*ex + sin(theta)*sin(phi)*ey - cos(theta)*ez"}]
""")
    with pytest.raises(an.ModelError, match=r"the equations are singular at the start\nhint: another start .*dynamics\(initial=\{…\}\)"):
        pendulum.dynamics()
    assert pendulum.dynamics(initial={"theta": 0.5})(0, [0.5, 0, 0, 0]).tolist() == [0, 0, 0, 0]
