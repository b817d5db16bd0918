"""Inputs that are given replace those of the model everywhere: in rates of states, outputs, reactions, events and other inputs."""

from typing import Any

import anholon as an
import numpy as np
import pytest

DRIVEN = """coordinates = ["x", "y"]
parameters = {m = 2}
input.u = "-3*x"
input.v = "u/2"
state.w = {rate = "u - x + v", initial = 0.1}
particle = [{name = "p", mass = "m", position = "x*ex + y*ey"}]
force = [{on = "p", vector = "u*ex + v*ey"}]
constraint = [{name = "c", equation = "y' = 2*x'"}]
event = [{name = "limit", when = "u - 5", set = {"x'" = "u", w = "v"}}]
[output]
thrust = "u"
power = "u*x'"
push = "reaction(p).x"
rate = "w'"
[initial]
x = 1
"x'" = 0.5
"""

GIVEN = {"u": 10.0, "v": 7.0}


def by_hand(u: float, v: float) -> tuple[float, dict[str, float]]:
    """Returns x'' and the outputs by hand: m (x'' + 2 y'') = u + 2 v with y'' = 2 x''."""
    a = (u + 2 * v) / 10
    return a, {"thrust": u, "power": 0.5 * u, "push": 2 * a - u, "rate": u - 1 + v}


@pytest.mark.parametrize("minimal", [True, False])
def test_rates_and_outputs_take_given_inputs(minimal: bool) -> None:
    f = an.loads(DRIVEN).dynamics(minimal=minimal, inputs=True)
    assert f.inputs == ["u", "v"]
    a, outputs = by_hand(**GIVEN)
    rates = dict(zip((s.name for s in f.states), f(0, f.start, GIVEN), strict=True))
    assert rates["w"] == pytest.approx(outputs["rate"])
    if not minimal:
        assert rates["x'"] == pytest.approx(a)
    u = np.array(list(GIVEN.values()))
    assert f.outputs == list(outputs)
    expected = list(outputs.values())
    np.testing.assert_allclose(f.output(0, f.start, u), expected, rtol=1e-13)
    np.testing.assert_allclose(f.formulas.numpy()(0, f.start, u, f.p0)[1], expected, rtol=1e-13)
    h = 0.5
    slope = (f.output(0, f.start, u + [h, 0]) - f.output(0, f.start, u - [h, 0])) / (2 * h)
    np.testing.assert_allclose(f.jac(0, f.start, u, by="u", of="y")[:, 0], slope, atol=1e-12)
    assert slope[f.outputs.index("thrust")] == pytest.approx(1)


def test_other_inputs_follow_the_given_one() -> None:
    f = an.loads(DRIVEN).dynamics(minimal=False, inputs="u")
    assert f.inputs == ["u"]
    a, outputs = by_hand(10, 5)
    rates = dict(zip((s.name for s in f.states), f(0, f.start, [10]), strict=True))
    assert rates["w"] == pytest.approx(outputs["rate"]) and rates["x'"] == pytest.approx(a)


def test_an_input_of_a_state_alone_is_an_argument() -> None:
    model = an.loads(
        'coordinates = ["x"]\ninput.u = "0"\nstate.w = {rate = "u", initial = 0}\n'
        'particle = [{name = "p", mass = 1, position = "x*ex"}]\nforce = [{on = "p", vector = "w*ex"}]\n'
    )
    f = model.dynamics(inputs=["u"])
    assert f.inputs == ["u"] and f(0, f.start, [3])[-1] == 3
    linear = model.linearize()
    assert linear.inputs == ["u"]
    np.testing.assert_allclose(np.array(linear.B)[list(linear.states).index("w")], [1])


def test_programs_take_given_inputs() -> None:
    made: dict[str, Any] = {"__name__": "program"}
    exec(compile(an.loads(DRIVEN).python_code(), "program.py", "exec"), made)
    assert list(made["INPUTS"]) == ["u", "v"]
    u, start = np.array(list(GIVEN.values())), made["START"]
    a, outputs = by_hand(**GIVEN)
    lead = made["leading"](0, start, None, u=u)
    np.testing.assert_allclose(made["outputs"](0, start, lead, None, u), [outputs[name] for name in made["OUTPUTS"]], rtol=1e-13)
    rates = dict(zip(made["STATE"], made["rhs"](0, start, None, u), strict=True))
    assert rates["w"] == pytest.approx(outputs["rate"]) and rates["x'"] == pytest.approx(a)
    np.testing.assert_allclose(made["events"](0, start, lead, None, u), [5])


def test_a_linear_model_has_the_input_in_reactions() -> None:
    linear = an.loads(DRIVEN.replace('input.v = "u/2"', 'input.v = "0"')).linearize()
    D = np.array(linear.D)
    assert D[list(linear.outputs).index("push"), 0] == pytest.approx(-0.8)
    assert D[list(linear.outputs).index("rate"), 0] == pytest.approx(1)


def test_a_formula_that_is_put_in_is_named() -> None:
    model = an.loads(DRIVEN + "[dissipation]\nR = \"u*x'^2/2\"\n")
    assert any("'u'" in note and "the dissipation 'R'" in note for note in model.linearize().notes)
    with pytest.raises(an.ModelError, match="the dissipation 'R'"):
        model.dynamics(inputs=["u"])


def test_the_rate_of_a_given_input_is_no_output() -> None:
    model = an.loads(DRIVEN)
    with pytest.raises(an.ModelError, match="the output 'r' holds the rate of an input"):
        model.dynamics(inputs=True, outputs={"r": "u'"})


def test_inputs_left_out_have_the_values_of_their_formulas() -> None:
    f = an.loads(DRIVEN).dynamics(inputs=True)
    x = f.start + 0.3
    formulas = f.input(0.4, x)
    np.testing.assert_array_equal(f(0.4, x, {"u": 1}), f(0.4, x, [1, 0.5]))
    np.testing.assert_array_equal(f(0.4, x, {"v": 1}), f(0.4, x, [formulas[0], 1]))
    many = np.stack([x, x + 0.2, f.start], axis=1)
    rates = f(0.4, many, {"u": 1})
    for k in range(3):
        np.testing.assert_array_equal(rates[:, k], f(0.4, many[:, k], {"u": 1}))
    np.testing.assert_array_equal(f.output(0.4, many, {"u": 1})[:, 1], f.output(0.4, many[:, 1], {"u": 1}))


THROUGH = """coordinates = ["x"]
input.V = "10 + 0*x"
input.S = "3*V"
input.R = "S - V"
input.D = "V' + x"
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "(S + R + D)*ex"}]
[output]
y = "S + R"
[initial]
x = 2
"""


def test_an_input_given_by_name_acts_in_the_other_inputs() -> None:
    f = an.loads(THROUGH).dynamics(inputs=True)
    assert f.inputs == ["V", "S", "R", "D"]
    assert f(0, f.start, {"V": 1.0})[1] == 3 + 2 + 2
    np.testing.assert_array_equal(f(0, f.start, {"V": 1.0}), f(0, f.start, [1, 3, 2, 2]))
    assert f(0, f.start, {"S": 1.0})[1] == 1 - 9 + 2
    np.testing.assert_array_equal(f.output(0, f.start, {"V": 1.0}), [5])
    np.testing.assert_array_equal(f(0, f.start, {}), f(0, f.start))
    many = np.stack([f.start, f.start + 1], axis=1)
    np.testing.assert_array_equal(f(0, many, {"V": [1.0, 2.0]})[1], [7, 13])
    with pytest.raises(ValueError, match="the input 'V' has the shape"):
        f(0, many, {"V": [1.0, 2.0, 3.0]})
    given = {"V": 1.0}
    np.testing.assert_array_equal(f.jac(0, f.start, given, by="u"), f.jac(0, f.start, [1, 3, 2, 2], by="u"))


def test_an_input_that_acts_in_another_input_alone_can_be_set() -> None:
    text = THROUGH.replace("(S + R + D)", "S").replace('input.R = "S - V"\ninput.D = "V\' + x"\n', "").replace("S + R", "S")
    f = an.loads(text).dynamics(inputs=["V"])
    assert f.inputs == ["V"] and f(0, f.start, [2.0])[1] == 6
    both = an.loads(text).dynamics(inputs=True)
    assert both.inputs == ["V", "S"] and both(0, both.start, {"V": 2.0})[1] == 6


def test_an_input_whose_rate_acts_cannot_be_set_alone() -> None:
    with pytest.raises(an.ModelError, match="acts by its rate"):
        an.loads(THROUGH).dynamics(inputs=["V"])


def test_c_code_says_whether_u_may_be_a_null_pointer() -> None:
    model = an.loads('coordinates = ["x"]\nparticle = [{name = "p", mass = 2, position = "x*ex"}]\nforce = [{on = "p", vector = "u*ex"}]\ninput.u = "cos(t)"')
    assert "u is no null pointer" in model.dynamics(inputs=True).c_code()
    assert "u may be a null pointer" in model.dynamics().c_code()
