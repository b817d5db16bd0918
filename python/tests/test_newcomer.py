"""The first steps of a user who has read the README only: a rolling disc in ten lines, a table, a plot, an animation, and mistakes."""

import math
import pathlib
import re
from collections.abc import Callable
from typing import Any

import anholon as an
import numpy as np
import pytest

TEN_LINES = '''
disc = an.loads("""
coordinates = ["x", "y", "psi", "theta", "phi"]
parameters = {m = 1, R = "50 cm", g = "9.81 m/s^2"}
frame.lean = "rotz(psi)*rotx(theta)"
body = [{name = "disc", mass = "m", shape = "disc(R)", center = "x*ex + y*ey + R*lean.y", orientation = "lean*rotz(phi)"}]
constraint = [{name = "rolling", equation = "vel(disc, x*ex + y*ey) = 0"}]
gravity.field = "-g*ez"
""")
run = disc.simulate(to=5, every=0.01, initial={"theta": 1.3, "psi'": 0.2, "phi'": 6})
'''


@pytest.fixture(scope="module")
def run() -> an.Run:
    assert len(TEN_LINES.strip().splitlines()) <= 10
    names: dict[str, object] = {"an": an}
    exec(TEN_LINES, names)
    made = names["run"]
    assert isinstance(made, an.Run) and made.ok
    return made


def test_a_disc_in_ten_lines(run: an.Run, disc: an.Model) -> None:
    shipped = disc.simulate(to=5, every=0.01, initial={"theta": 1.3, "psi'": 0.2, "phi'": 6})
    assert run["theta"].tolist() == shipped["theta"].tolist()


def test_a_table_a_plot_an_animation(run: an.Run, tmp_path: pathlib.Path) -> None:
    pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert len(frame) == 501 and frame["theta"].max() < 1.6
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    run.plot("theta", "phi'").figure.savefig(tmp_path / "disc.png")
    run.page(str(tmp_path / "disc.html"), proof=False)
    assert hasattr(run.animate(), "_repr_mimebundle_") or hasattr(run.animate(), "_repr_html_")


# Mistakes of new users: (name, call, exception, texts of the message).
MISTAKES: list[tuple[str, Callable[[an.Model, an.Run], object], type[Exception], tuple[str, ...]]] = [
    ("a name of a model", lambda disc, run: an.load("disk"), an.ModelError, ("did you mean the shipped model 'disc'",)),
    ("a name of a parameter", lambda disc, run: disc.with_(mass=2), an.ModelError, ("no parameter 'mass'", "the parameters are m, R, g")),
    ("a velocity", lambda disc, run: disc.simulate(to=1, initial={"phi_dot": 6}), an.ModelError, ("no coordinate 'phi_dot'", "the coordinates are x, y, psi, theta, phi")),
    ("a unit", lambda disc, run: disc.simulate(to="10 sec"), an.ModelError, ("'10 sec' is not a number", "30 deg")),
    ("an option", lambda disc, run: disc.simulate(to=1, tolerence=1e-3), an.ModelError, ("did you mean 'tolerance'?",)),
    ("a column", lambda disc, run: run["thetadot"], KeyError, ("did you mean \"theta'\"", "the columns are t, x, y")),
    ("a form", lambda disc, run: disc.prove("kanes"), an.ModelError, ("did you mean 'kane'?",)),
    ("a format", lambda disc, run: run.save("disc.xlsx"), an.ModelError, (".h5, .csv, .json or .parquet",)),
    ("a file", lambda disc, run: an.loads("coordinates = x"), an.ModelError, ("1:15", "^", "quotes")),
    ("a vector", lambda disc, run: an.loads('coordinates = ["x"]\nparticle = [{name = "p", mass = 1, position = ["x", 0]}]'), an.ModelError, ("^~~", "the third is 0")),
    ("values that clash", lambda disc, run: disc.simulate(to=1, initial={"x'": 1, "phi'": 6, "psi": 0})["x"], KeyError, ("has not begun", "clash", "hint: leave out one of")),
    ("a run that never began", lambda disc, run: disc.simulate(to=1, initial={"x'": 1, "phi'": 6, "psi": 0}).expect(), an.MotionError, ("clash", "hint: leave out one of")),
]


@pytest.mark.parametrize(("made", "kind", "said"), [case[1:] for case in MISTAKES], ids=[case[0] for case in MISTAKES])
def test_mistakes_are_explained(made: Callable[[an.Model, an.Run], object], kind: type[Exception], said: tuple[str, ...], disc: an.Model, run: an.Run) -> None:
    with pytest.raises(kind) as caught:
        made(disc, run)
    for part in said:
        assert part in str(caught.value)


def test_values_by_name_have_names_and_numbers() -> None:
    disc = an.load("disc")
    for wrong, said in (
        ([1.3], "values are given by name, as {'theta': 1.3}, not as a list"),
        ({"theta": [1, 2]}, "theta: a number is an int, float, Fraction, Decimal or str, not list"),
        ({disc.coordinates[0]: 1}, "a name is a str, such as 'theta'"),
    ):
        with pytest.raises(TypeError) as raised:
            disc.simulate(to=1, initial=wrong)  # type: ignore[arg-type]
        assert said in str(raised.value)


def test_a_shipped_model_of_the_list_is_loaded() -> None:
    first = an.zoo()[0]
    assert an.load(first).title == first.title


def test_a_unit_of_another_quantity_is_refused(disc: an.Model) -> None:
    spring = an.loads(SPRING)
    for made, said in (
        (lambda: disc.with_(m="3 m"), ("a mass (kg) is expected here, this is a length (m)",)),
        (lambda: spring.with_(m="3 m"), ("a mass (kg) is expected here",)),
        (lambda: spring.simulate(to=1, initial={"x": "3 kg"}), ("initial x: a length (m) is expected here, this is a mass (kg)", "hint: a number in m")),
        (lambda: spring.simulate(to=1, initial={"x'": "3 m"}), ("initial x': a velocity (m/s) is expected here",)),
        (lambda: spring.linearize(initial={"x": "3 s"}), ("initial x: a length (m) is expected here",)),
    ):
        with pytest.raises(an.ModelError) as raised:
            made()
        for part in said:
            assert part in str(raised.value)
    assert disc.with_(m="300 g", R="50 cm").parameters["m"] == 0.3
    assert spring.check(initial={"x": "30 cm", "x'": "36 km/h"}).initial[0].value == 0.3


def test_times_have_the_unit_of_a_time(disc: an.Model) -> None:
    for made, said in (
        (lambda: disc.simulate(to="3 kg"), ("to: a time (s) is expected here, this is a mass (kg)", "hint: a number in s")),
        (lambda: disc.simulate(to=1, every="1 m"), ("every: a time (s) is expected here, this is a length (m)",)),
        (lambda: disc.simulate(at=["1 kg"]), ("at: a time (s) is expected here",)),
        (lambda: disc.simulate(to="30 deg"), ("to: a time (s) is expected here, this is a pure number",)),
        (lambda: disc.simulate(to=1, tolerance="1 m"), ("tolerance: a pure number is expected here, this is a length (m)",)),
        (lambda: disc.check(initial={"t": "3 kg"}), ("initial t: a time (s) is expected here",)),
        (lambda: disc.evaluate(t="3 m"), ("initial t: a time (s) is expected here",)),
        (lambda: disc.sweep({"m": [1]}, to="1 kg"), ("to: a time (s) is expected here",)),
        (lambda: disc.sweep({"m": [1]}, at=["1 kg"]), ("at: a time (s) is expected here",)),
    ):
        with pytest.raises(an.ModelError) as raised:
            made()
        for part in said:
            assert part in str(raised.value)
    assert disc.simulate(to="100 ms", at=["0.1 s"])["t"].tolist() == [0.1]


def test_lists_have_units_of_their_quantity() -> None:
    for text in (SPRING, SPRING_WITHOUT_UNITS):
        spring = an.loads(text)
        for made, said in (
            (lambda: spring.sweep({"m": ["1 m", "2 m"]}, to=1), "vary m: a mass (kg) is expected here, this is a length (m)"),
            (lambda: spring.sweep({"x": [0, "1 kg"]}, to=1), "vary x: a length (m) is expected here, this is a mass (kg)"),
            (lambda: spring.sweep({"x'": ["1 m"]}, to=1), "vary x': a velocity (m/s) is expected here"),
            (lambda: spring.sweep({"m": an.normal("1 m", "2 m")}, cases=3, to=1), "a mass (kg) is expected here"),
            (lambda: spring.stability("m", ["1 m", "2 m"]), "m: a mass (kg) is expected here, this is a length (m)"),
            (lambda: spring.initial(x="3 kg"), "initial x: a length (m) is expected here"),
        ):
            with pytest.raises(an.ModelError) as raised:
                made()
            assert said in str(raised.value)
        assert spring.sweep({"m": ["500 g", 2]}, to=1).cases == 2
        assert spring.check(initial={"x": "30 cm"}).initial[0].value == 0.3


def test_a_file_without_units_says_so() -> None:
    scaled = an.loads(SPRING_WITHOUT_UNITS.replace('["x", 0, 0]', '["x^2 + x^3", 0, 0]'))
    with pytest.raises(an.ModelError) as raised:
        scaled.simulate(to=1, initial={"x": "3 kg"})
    assert "initial x: the model has no units from which that of 'x' follows, and this is a mass (kg)" in str(raised.value)
    assert "hint: a bare number" in str(raised.value)


def test_another_value_has_the_unit_of_that_of_the_file() -> None:
    with pytest.raises(an.ModelError, match=r"error: k=3 m: a stiffness \(N/m\) is expected here, this is a length \(m\)"):
        an.loads(SPRING).with_(k="3 m")


SPRING_WITHOUT_UNITS = """
coordinates = ["x"]
parameters = {m = 1, k = 3}
particle = [{name = "p", mass = "m", position = ["x", 0, 0]}]
potential.spring = "k*x^2/2"
"""

SPRING = """
coordinates = ["x"]
parameters = {m = "1 kg", k = "3 N/m"}
particle = [{name = "p", mass = "m", position = ["x", 0, 0]}]
potential.spring = "k*x^2/2"
"""


def test_load_and_loads_name_each_other() -> None:
    with pytest.raises(an.ModelError, match=r"hint: anholon.load\('disc.toml'\)"):
        an.loads("disc.toml")
    with pytest.raises(an.ModelError, match=r"hint: anholon.loads\(text\)"):
        an.load(SPRING)


def test_a_time_is_a_number(disc: an.Model) -> None:
    f = disc.dynamics()
    for wrong in ("a", [0], None):
        for function in (f, f.jac, f.output):
            with pytest.raises(TypeError, match="t is a number, the time in s"):
                function(wrong, f.start)  # type: ignore[arg-type]


def test_numbers_in_the_place_of_names_and_equations_are_named() -> None:
    model: Any = an.loads(SPRING)
    with pytest.raises(TypeError, match="equations are a text, a path, .* not a int"):
        model.compare(3)
    with pytest.raises(TypeError, match="a name is a str, such as 'kane', .* not 3"):
        model.prove(3)


@pytest.mark.parametrize("right_angle", ["pi/2", 1.5707963267948966])
def test_a_velocity_across_the_blade_of_a_sleigh_that_is_turned_clashes(right_angle: str | float) -> None:
    sleigh = an.load("chaplygin-sleigh")
    turned = an.loads(re.sub(r"(?m)^th +=.*$", f'th = "{right_angle}"', sleigh.text))
    for call in (lambda: turned.check(), lambda: turned.evaluate(), lambda: turned.simulate(to=1).expect()):
        with pytest.raises((an.MotionError, an.ModelError), match="x' = -0.5 .*clashes with constraint 'blade_edge'"):
            call()
    # Values that are given in the call are kept; the velocities of the file change, and as little as possible.
    found = {value.name: value.value for value in sleigh.check(initial={"th": right_angle}).initial}
    assert found["x'"] == pytest.approx(0, abs=1e-15) and abs(found["y'"]) < 1
    run = sleigh.simulate(to=1, initial={"th": right_angle, "x'": 0, "y'": 0.5}).expect()
    assert run["y'"][0] == 0.5


def bead() -> tuple[an.Builder, an.Expr, an.Expr]:
    b = an.Builder("a bead")
    x = b.coordinate("x")
    return b, x, b.particle("p", mass=1, position=x * an.ex)


def test_numbers_are_not_formulas() -> None:
    x: Any = bead()[1]
    mistakes: list[tuple[Any, str]] = [
        (lambda: np.sin(x), r"np\.sin is of numbers, and x is a formula; write an\.sin"),
        (lambda: np.arctan2(x, 1), r"write an\.atan2"),
        (lambda: np.abs(x), r"write abs\(…\)"),
        (lambda: np.floor(x), r"functions of formulas are an\.sin, an\.sqrt"),
        (lambda: math.sin(x), r"x is a formula, not a number; functions of formulas are an\.sin, an\.sqrt, …, in the place of math\.sin"),
        (lambda: x.dt(), r"x' is no function: the derivative is written x\.dt, without parentheses"),
        (lambda: x(1), r"x is no function; functions and tables of a model are called by an\.call\('x', …\)"),
        (lambda: (x > 0) & (x < 1), r"conditions are not joined; where x > 0 and another one hold is piecewise"),
        (lambda: x.d(1.5), r"the order of a derivative is a whole number, not 1\.5"),
    ]
    for made, said in mistakes:
        with pytest.raises(TypeError, match=said):
            made()
    for order in (-1, 21):
        with pytest.raises(ValueError, match="the order of a derivative is"):
            x.d(order)


def test_operators_with_numbers_of_numpy() -> None:
    _, x, _ = bead()
    two: list[Any] = [np.float64(2), np.int64(2), np.array(2)]
    for number in two:
        shown = [str(e) for e in (number * x, x * number, number + x, number - x, number / x, x**number, number**x, number > x, x < number)]
        n = "2.0" if isinstance(number, np.float64) else "2"
        assert shown == [f"{n}*x", f"x*{n}", f"{n} + x", f"{n} - x", f"{n}/x", f"x^{n}", f"{n}^x", f"{n} > x", f"x < {n}"]
    assert str(np.array([1, 2, 3]) * x) == "(ex + 2*ey + 3*ez)*x"


def test_an_inertia_may_be_an_array() -> None:
    b, x, _ = bead()
    b.body("q", mass=1, inertia=np.diag([1.0, 2.0, 2.5]), center="0", orientation=an.rotz(x))
    b.force(generalized={x: 7})
    b.initial({x: 0, x.dt: 0})
    assert b.model().evaluate().accelerations == {"x''": 2}


def test_what_is_given_to_a_function_of_a_model() -> None:
    disc = an.load("disc")
    f: Any = disc.dynamics()
    x: Any = f.start
    nothing: Any = None
    mistakes: list[tuple[Any, str]] = [
        (lambda: f.state(q={"x": "1 m"}, qdot={}), "x is a number in SI units, not '1 m'"),
        (lambda: f.state(q={"x": [1, 2]}, qdot={}), r"x is a number in SI units, not \[1, 2\]"),
        (lambda: f.state(q=[1]), r"q has values by name, as q=\{'x': 0\.5\}, not a list"),
        (lambda: f.state(q={}, qdot=[1]), r"qdot has values by name, as qdot=\{\"x'\": 0\.5\}, not a list"),
        (lambda: f(0, x, p={"m": nothing}), r"p\['m'\] is a number or an array of numbers, not None"),
        (lambda: f(0, x, p={"m": "3 kg"}), r"p\['m'\] is a number or an array of numbers, not a str"),
        (lambda: f(0, nothing), "x is a number or an array of numbers, not None"),
        (lambda: f(0, ["1 m"] * 8), "x is an array of numbers in SI units, not"),
        (lambda: f.jac(0, nothing), "x is a number or an array of numbers, not None"),
        (lambda: f.motion(nothing), "x is a number or an array of numbers, not None"),
        (lambda: an.verify(nothing), "verify takes a proof or the text of a certificate, not None"),
    ]
    for call, said in mistakes:
        with pytest.raises(TypeError, match=said):
            call()
    assert (f(np.array(0.0), list(x), p={"m": np.array(2)}) == f(0, x, p={"m": 2})).all()
    with pytest.raises(an.ModelError, match=r"error: m: the formula is empty"):
        disc.with_(m="")
    half: Any = np.array(2.5)
    assert disc.with_(m=half).parameters["m"] == disc.with_(m=2.5).parameters["m"]
