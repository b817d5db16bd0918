"""Values of the file that give way to values that are given are named; constraints may vanish with the parameters."""

import pathlib

import anholon as an
import pytest

SLEDGE = """
coordinates = ["x", "y", "p"]
body = [{name = "b", mass = 1, inertia = 0.2, center = "x*ex + y*ey", angle = "p"}]
constraint = [{name = "blade", equation = "dot(vel(b, b.center + 0.2*b.x), b.y) = 0"}]
initial = {x = 0.3, "x'" = 0.4, "y'" = 0.3, "p'" = -1.5}
"""
ROD = """
coordinates = ["q", "X"]
parameters = {s = 0}
particle = [{name = "a", mass = 1, position = "q*ex + s*q*ez"}, {name = "b", mass = 2, position = "X*ex + s*X*ez"}]
constraint = [{name = "rod", equation = "vel(a) = vel(b)"}]
initial = {"q'" = 1}
"""
WORDS = "initial data of the file clash with p = 0.2 and give way: x' = 0.4 is replaced by 0.385853"


def test_values_that_give_way_are_named(tmp_path: pathlib.Path) -> None:
    model = an.loads(SLEDGE)
    given = {"p": 0.2}
    for notes in (
        model.check(initial=given).notes,
        model.simulate(to=0.1, initial=given).report.notes,
        model.linearize(initial=given).notes,
        model.sweep({"p": [0, 0.2]}, to=0.1).notes,
        model.sweep({"p": [0, 0.2]}, to=0.1, out=tmp_path / "cases").notes,
    ):
        assert [WORDS in note for note in notes].count(True) == 1, notes
    assert not any("give way" in note for note in model.simulate(to=0.1, initial={"x": 7}).report.notes)


def test_values_that_clash_among_themselves_remain_an_error() -> None:
    model = an.loads(SLEDGE.replace("-1.5", "0.6"))
    with pytest.raises(an.MotionError, match="clash with constraint 'blade'"):
        model.simulate(to=1, initial={"x": 0.3}).expect()
    assert set(model.sweep({"x": [0.3, 0.4]}, to=1).outcomes) == {"inconsistent"}


def test_a_motion_with_contacts_may_end_where_it_begins() -> None:
    model = an.load("stick-slip")
    run = model.simulate(to=0)
    assert len(run["x"]) == 1 and run["belt.normal"][0] == 9.81
    assert model.sweep({"V": [0.1, 0.2]}, to=0)["x'"].tolist() == [0.1, 0.2]


def test_a_constraint_may_vanish_with_the_parameters() -> None:
    model = an.loads(ROD)
    assert model.simulate(to=1)["X"][-1] == pytest.approx(1)
    for values in ([0], [0, 1], [1, 0]):
        sweep = model.sweep({"s": values}, to=1)
        assert set(sweep.outcomes) == {"finished"}
        assert sweep["q"] == pytest.approx([1] * len(values))
    f = model.dynamics()
    assert f(0, f.start) is not None
    with pytest.raises(KeyError, match="which constraints hold"):
        f(0, f.start, p={"s": 1})  # another value may let the constraint hold again
