"""An optimal control problem for a car with trailers: CasADi solves it with Anholon's formulas, and ``simulate`` replays the solution."""

from typing import Any

import anholon as an
import numpy as np
import pytest

CONTROLS = (
    ("drive = 5 ", 'drive = "drive_law(t)" '),
    ("steer = \"-2*(ph - sin(t)/2) - ph'/2\"", 'steer = "steer_law(t)"'),
)


def solved(car: an.Model, f: an.Dynamics, intervals: int, end_time: float, aside: float) -> tuple[Any, Any]:
    """Returns controls, shape (inputs, times), and states of the cheapest change of lane with a speed of 1 m/s at both ends."""
    ca = pytest.importorskip("casadi")
    rate, names = f.formulas.casadi(), [state.name for state in f.states]
    h, parts = end_time / intervals, 4
    x, first, last = ca.SX.sym("x", len(names)), ca.SX.sym("first", 2), ca.SX.sym("last", 2)

    def slope(z: Any, part: float) -> Any:
        return rate(0, z, first + (last - first) * part / parts, f.p0)[0]

    z, d = x, h / parts
    for k in range(parts):
        a = slope(z, k)
        b = slope(z + d / 2 * a, k + 0.5)
        c = slope(z + d / 2 * b, k + 0.5)
        z = z + d / 6 * (a + 2 * b + 2 * c + slope(z + d * c, k + 1))
    step = ca.Function("step", [x, first, last], [z])

    start = f.state(q={c.name: 0.0 for c in car.coordinates}, qdot={"x'": 1.0})
    end = start.copy()
    end[names.index("x")], end[names.index("y")] = end_time, aside
    problem = ca.Opti()
    states, controls = problem.variable(len(names), intervals + 1), problem.variable(2, intervals + 1)
    problem.subject_to(states[:, 0] == start)
    problem.subject_to(states[:, intervals] == end)
    problem.subject_to(states[:, 1:] == step.map(intervals)(states[:, :-1], controls[:, :-1], controls[:, 1:]))
    problem.minimize(h * (ca.sumsqr(controls[0, :]) / 100 + ca.sumsqr(controls[1, :])))
    problem.set_initial(states, np.linspace(start, end, intervals + 1).T)
    problem.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes", "tol": 1e-10})
    solution = problem.solve()
    assert solution.stats()["success"]
    return solution.value(controls), solution.value(states)


def test_a_car_with_trailers_changes_its_lane() -> None:
    car = an.load("trailers", set={"n": 2})
    f = car.dynamics(inputs=True)
    assert f.minimal and f.inputs == ["drive", "steer"]
    controls, states = solved(car, f, 40, 6.0, 0.5)
    text = car.text
    for old, new in CONTROLS:
        assert text.count(old) == 1
        text = text.replace(old, new)
    moments = np.linspace(0, 6, 41).tolist()
    for name, values in zip(("drive_law", "steer_law"), controls, strict=True):
        text += f'[[table]]\nname = "{name}"\nx = {moments}\ny = {values.tolist()}\n'
    run = an.loads(text, set={"n": 2}).simulate(to=6, every="0.05", error_estimate=False).expect()
    assert run.report.constraints < 1e-12 and run.report.newton < 1e-12
    # The states differ by the error of the method of order 4 that the problem uses.
    for k in (10, 20, 30, 40):
        wanted = f.motion(states[:, k], t=moments[k])
        row = int(round(moments[k] / 0.05))
        for c in car.coordinates:
            assert abs(wanted[c.name] - run[c.name][row]) < 1e-6, (c.name, k)
    assert abs(run["y"][-1] - 0.5) < 1e-6 and abs(run["th[2]"][-1]) < 1e-6
    assert np.abs(run["ph"]).max() > 0.01, "it had to steer"
