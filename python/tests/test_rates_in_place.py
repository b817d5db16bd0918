"""Rates that are written to an array of the caller, derivatives at kinks, and outputs beyond velocities."""

import anholon as an
import numpy as np
import pytest


@pytest.mark.parametrize("name", ["trailers", "snakeboard", "two-wheeled-pendulum", "roller-racer", "snake", "car-three-trailers", "disc"])
def test_accelerations_as_outputs_in_independent_velocities(name: str) -> None:
    model = an.load(name)
    outputs = {f"a{k}": f"{c.name}'' + {c.name}'*{c.name}''" for k, c in enumerate(model.coordinates)}
    f, full = model.dynamics(outputs=outputs), model.dynamics(minimal=False, outputs=outputs)
    assert f.minimal
    for shift in (0, 0.05):
        x = f.start + shift
        motion = f.motion(x, t=0.3)
        names = [state.name for state in full.states]
        y = np.array([motion[state] for state in names])
        expected = full.output(0.3, y)
        np.testing.assert_allclose(f.output(0.3, x), expected, rtol=1e-9, atol=1e-9 * (1 + np.abs(expected).max()))


def test_an_output_beyond_accelerations_is_named() -> None:
    text = (
        'coordinates = ["x", "y", "th"]\nbody = [{name = "b", mass = 2, inertia = 0.5, center = "x*ex + y*ey", angle = "th"}]\n'
        "constraint = [{name = \"e\", equation = \"y'*cos(th) = x'*sin(th)\"}]\nforce = [{on = \"b\", vector = \"ex\"}]\n"
        "monitor = {jerk = \"x'''\", a = \"x''\"}\ninitial = {\"x'\" = 1, \"th'\" = 0.4}\n"
    )
    model = an.loads(text)
    f = model.dynamics()
    assert f.minimal and f.outputs == ["a"] and "jerk" in f.formulas.left_out
    with pytest.raises(an.ModelError, match="the output 'jerk' holds what the equations are not solved for"):
        model.dynamics(outputs=["jerk"])
    assert "jerk" in model.python_code()


def test_rates_are_put_into_an_array_of_any_layout() -> None:
    f = an.load("disc").dynamics()
    n = len(f.start)
    x = f.start[:, None] + np.linspace(0, 0.1, 4)
    expected = f(0, x)
    for out in (np.zeros((2 * n, 8))[::2, ::2], np.zeros((n, 4), order="F"), np.zeros((n, 4))):
        assert f(0, x, out=out) is out
        np.testing.assert_array_equal(out, expected)
    column = np.zeros((n, 2))
    f(0, f.start, out=column[:, 0])
    np.testing.assert_array_equal(column[:, 0], f(0, f.start))
    same = x.copy()
    np.testing.assert_array_equal(f(0, same, out=same), expected)
    for wrong in (np.zeros((n, 4), "f4"), np.zeros((n, 4), int), [0.0] * n):
        with pytest.raises(TypeError, match="it has to be an array of float64"):
            f(0, x, out=wrong)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="out has the shape"):
        f(0, x, out=np.zeros(n))
    locked = np.zeros((n, 4))
    locked.flags.writeable = False
    with pytest.raises(ValueError, match="cannot be written to"):
        f(0, x, out=locked)


@pytest.mark.parametrize("minimal", [True, False])
@pytest.mark.parametrize(
    ("force", "kink"),
    [("-4*min(x,0) - 9*max(x,0)", True), ("-abs(x)", True), ("sign(x)", True), ("F(x)", True), ("-x*abs(x)", False), ("G(x)", False)],
)
def test_a_kink_has_no_derivative(force: str, kink: bool, minimal: bool) -> None:
    tables = 'table = [{name = "F", x = [-1, 0, 1], y = [4, 0, -9]}, {name = "G", x = [-1, 0, 1], y = [4, 0, -9], fit = "spline"}]'
    model = an.loads(
        'coordinates = ["x", "y"]\nparticle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]\n'
        f'{tables}\nforce = [{{on = "p", vector = "({force})*ex - y*ey"}}]\n'
    )
    f = model.dynamics(minimal=minimal)
    at, beside = f.jac(0, f.start), f.jac(0, f.start + 0.1)
    assert np.isfinite(beside).all()
    assert np.isnan(at[2, 0]) == kink and np.isfinite(at[:, 1:]).all()
    assert at[3, 1] == pytest.approx(-1)


def line(force: str, more: str = "") -> an.Model:
    particle = 'coordinates = ["x"]\nparticle = [{name = "p", mass = 1, position = "x*ex"}]\n'
    return an.loads(f'{particle}force = [{{on = "p", vector = "({force})*ex"}}]\n{more}\n')


@pytest.mark.parametrize(
    ("model", "place"),
    [
        (line("-4*min(x,0) - 9*max(x,0)"), "where -x passes 0|where x passes 0"),
        (line("-x - sign(x')"), "where -?x' passes 0"),
        (line("F(x)", 'table = [{name = "F", x = [-1, 0, 1], y = [4, 0, -9]}]'), "where x passes a knot of the table 'F'"),
        (line("-piecewise(x > 0, 9*x, 4*x)"), "where -?x passes 0"),
    ],
)
def test_no_linear_model_at_a_kink(model: an.Model, place: str) -> None:
    with pytest.raises(an.MotionError, match=f"the equation of x has a kink or a jump ({place})"):
        model.linearize()
    beside = model.linearize(initial={"x": 0.5, "x'": 0.5})
    assert np.isfinite(np.array(beside.A)).all()


def test_sides_that_agree_have_a_linear_model() -> None:
    linear = line("-x - abs(x')*x'", 'output = {distance = "abs(x)", place = "2*x"}').linearize()
    np.testing.assert_allclose(linear.A, [[0, 1], [-1, 0]])
    assert linear.outputs == ["place"] and np.array(linear.C).tolist() == [[2, 0]] and np.array(linear.D).shape[0] == 1
    assert any("the output 'distance' has a kink or a jump" in note for note in linear.notes)


def test_a_search_for_an_equilibrium_finds_states() -> None:
    held = line("f - x' - 9.81", 'state.f = {rate = "(-50*x - f)/0.1", initial = 0}').linearize(about="equilibrium")
    assert held.motion == "equilibrium"
    assert held.states == ["x", "x'", "f"]
    np.testing.assert_allclose(held.values, [-9.81 / 50, 0, 9.81], rtol=1e-15)
    endless = line("f - x^2 - 1", 'state.f = {rate = "1 + f^2", initial = 0}')
    with pytest.raises(an.MotionError, match="no equilibrium was found near the initial positions\nhint: .*; so do the values of f of"):
        endless.linearize(about="equilibrium")


@pytest.mark.parametrize("name", ["abs", "len", "range", "matrix", "right", "sum", "zip", "enumerate", "print"])
def test_names_of_generated_programs_are_free_for_models(name: str) -> None:
    text = (
        f'coordinates = ["x", "y"]\nparameters = {{{name} = 0.7}}\nparticle = [{{name = "p", mass = 1, position = "x*ex + y*ey"}}]\n'
        f"force = [{{on = \"p\", vector = \"{name}*abs(x)*ex\"}}]\nconstraint = [{{name = \"c\", equation = \"x' = {name}*x*y'\"}}]\n"
        "monitor.m = \"lambda.c\"\ninitial = {x = 0.3, \"y'\" = 1}\n"
    )
    model = an.loads(text)
    f = model.dynamics(minimal=False)
    np.testing.assert_allclose(f.formulas.numpy()(0.0, f.start, f.u0, f.p0)[0], f(0, f.start), rtol=1e-13)
    made: dict[str, object] = {"__name__": "program"}
    exec(compile(model.python_code(), "program.py", "exec"), made)
    start, rhs = np.asarray(made["START"]), made["rhs"]
    assert callable(rhs)
    one = rhs(0, start)
    np.testing.assert_allclose(np.asarray(rhs(0, np.tile(start[:, None], (1, 3))))[:, 1], one, rtol=1e-13)
    for function, arguments in {"residual": (start, np.zeros(3)), "hidden": (start,)}.items():
        if callable(call := made.get(function)):
            call(0, *arguments)
