"""Models, numbers, errors."""

import math
import pickle
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction

import anholon as an
import numpy as np
import pytest
from anholon._numbers import text_of

PENDULUM = """
title = "Pendulum"
coordinates = ["th"]
parameters = {l = 1, g = 9.8125}
particle = [{name = "bob", mass = 1, position = ["l*sin(th)", "-l*cos(th)", 0]}]
gravity.field = "-g*ey"
[initial]
q = {th = 1}
qdot = {th = 0}
"""


def test_a_float_is_the_decimal_that_python_prints() -> None:
    assert text_of(0.1) == "0.1"
    assert text_of(np.float64(0.1)) == "0.1"
    assert text_of(np.int32(3)) == "3"
    assert text_of(Fraction(1, 3)) == "1/3"
    assert text_of(Decimal("0.10")) == "0.10"
    for bad in (math.nan, math.inf, Decimal("NaN")):
        with pytest.raises(ValueError):
            text_of(bad)
    for none in (True, None, [1], 1j):
        with pytest.raises(TypeError):
            text_of(none)  # type: ignore[arg-type]


def test_what_a_model_says(disc: an.Model) -> None:
    assert [c.name for c in disc.coordinates] == ["x", "y", "psi", "theta", "phi"]
    assert disc.parameters["m"] == 1
    assert [c.order for c in disc.constraints] == [1, 1]
    assert "theta" in disc._repr_html_()
    assert disc.with_(m=2).parameters["m"] == 2
    assert disc.parameters["m"] == 1, "a model never changes"
    again = disc.with_(m=2).with_(R="8 cm")
    assert (again.parameters["m"], again.parameters["R"]) == (2, 0.08)


def test_mistakes_name_their_place() -> None:
    with pytest.raises(an.ModelError) as caught:
        an.loads(PENDULUM.replace("cos(th)", "cos(thh)"), name="pendulum.toml")
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.file, diagnostic.line) == ("pendulum.toml", 5)
    assert "thh" in diagnostic.message
    assert "did you mean 'th'" in diagnostic.message
    assert "^" in str(caught.value), "the text has the line and a caret"
    assert "^" in caught.value._repr_html_()
    for mistake in (
        lambda: an.load("disk"),
        lambda: an.load("disc").equations("lagrnge"),
        lambda: an.load("disc").with_(mass=2),
        lambda: an.load("disc").simulate(to="soon"),
        lambda: an.load("disc").simulate(to=1, tolerence=1),
        lambda: an.load("disc").simulate(to=1, initial={"thet": 1}),
        lambda: an.load("disc").sweep({"mm": [1]}, to=1),
        lambda: an.verify("no certificate"),
    ):
        with pytest.raises(an.ModelError):
            mistake()


def test_equations_and_proofs(disc: an.Model) -> None:
    names = {form.name: form for form in disc.forms()}
    assert names["maggi"].applies and names["maggi"].source
    equations = disc.equations("maggi")
    assert equations.latex and "<math" in equations._repr_html_() and equations.json
    # Notebooks show lines that wrap, in a box that scrolls; the table of `mathml` would be as wide as its longest line.
    assert "overflow-x:auto" in equations._repr_html_() and "<mtable" not in equations._repr_html_()
    assert 'text-align:left' in equations.mathml
    proof = disc.prove("maggi")
    assert proof and an.verify(proof)


def test_exceptions_can_be_pickled() -> None:
    error = pickle.loads(pickle.dumps(an.ModelError("text")))
    assert str(error) == "text"


def test_exceptions_of_the_library_can_be_pickled(disc: an.Model) -> None:
    run = disc.simulate(to=0.1)
    mistakes: list[Callable[[], object]] = [
        lambda: disc.with_(mm=2),
        lambda: run["thetadot"],
        lambda: an.load("luo-zhao-example-2").simulate(to=1000).expect(),
    ]
    for mistake in mistakes:
        with pytest.raises((an.ModelError, an.ColumnError, an.MotionError)) as raised:
            mistake()
        again = pickle.loads(pickle.dumps(raised.value))
        assert type(again) is type(raised.value) and str(again) == str(raised.value)
        if isinstance(again, an.ModelError) and isinstance(raised.value, an.ModelError):
            assert again.diagnostics[0].message == raised.value.diagnostics[0].message
        if isinstance(again, an.MotionError):
            assert again.outcome.kind == "negative_mass"


def test_a_text_that_is_none_and_numbers_that_are_not_finite_are_named(disc: an.Model) -> None:
    with pytest.raises(TypeError, match="takes the text of a model"):
        an.loads(None)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="m: nan is not a finite number"):
        disc.with_(m=float("nan"))
    with pytest.raises(ValueError, match="^nan is not a finite number"):
        disc.stability("m", 1, float("nan"))
