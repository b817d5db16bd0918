"""The equations as a function: the accelerations of the motion, alone and in batches, for other integrators."""

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
    # Some parameter of another value makes another motion.
    changes: list[dict[str, Any]] = [{p: 3} for p in model.parameters]
    others = [model.with_(**change).dynamics()(0.5, f.start) for change in changes]
    assert any(not np.allclose(other, f(0.5, f.start), rtol=1e-6) for other in others)


@pytest.mark.parametrize("name", [*MODELS, "rocket", "whipple"])
def test_derivatives_are_exact(name: str) -> None:
    model = an.load(name)
    f = model.dynamics(minimal=False)
    x = f.start * (1 + 0.01 * np.cos(np.arange(len(f.start)))) + 0.01
    jac = f.jac(0.25, x)
    size = np.abs(jac).max()
    for k in range(len(x)):
        # Central differences of order 6.
        h, e = 1e-3, np.eye(len(x))[k]
        g = [f(0.25, x + i * h * e) - f(0.25, x - i * h * e) for i in (1, 2, 3)]
        by_differences = (45 * g[0] - 9 * g[1] + g[2]) / (60 * h)
        np.testing.assert_allclose(jac[:, k], by_differences, rtol=1e-7, atol=1e-7 * size)
    v = np.cos(np.arange(len(x)))
    np.testing.assert_array_equal(f.jvp(0.25, x, v), jac @ v)
    np.testing.assert_array_equal(f.vjp(0.25, x, v), v @ jac)
    if name in ("fourbar", "double-pendulum-cartesian"):
        return  # with another length the start is inconsistent
    by_parameter = f.jac(0.25, x, by="p")
    for k, (p, value) in enumerate(model.parameters.items()):
        h = 1e-4 * max(1, abs(value))
        changes: list[dict[str, Any]] = [{p: value + h}, {p: value - h}]
        up, down = (model.with_(**change).dynamics(minimal=False)(0.25, x) for change in changes)
        np.testing.assert_allclose(by_parameter[:, k], (up - down) / (2 * h), rtol=1e-4, atol=1e-5 * max(1, np.abs(by_parameter).max()))


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
    """Rods along the axes, where pivots that were chosen at the start vanish: the constraints hold for the accelerations."""
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


def test_who_has_no_such_function_says_why() -> None:
    with pytest.raises(an.ModelError, match=r"no function x' = f\(t, x\)"):
        an.load("rheonomic-order-3").dynamics()
