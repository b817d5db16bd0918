"""Cases of sweeps whose numbers need other equations, or are not possible."""

import pathlib

import anholon as an
import numpy as np
import pytest


def test_a_parameter_that_varies_switches_a_constraint() -> None:
    model = an.loads("""
coordinates = ["x", "y"]
parameters = {on = 0.5, c = 1}
mode.k = 0
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
gravity.field = "-2*ey"
constraint = [{name = "rail", equation = "y' = c*x'", active = "k - on"}]
initial = {"x'" = 1}
""")
    for switched in (model.in_mode("k=0"), model):
        sweep = switched.sweep({"on": [0.5, -1, 0.5]}, to=3, reduce=["max(y)"])
        assert list(sweep["y"]) == [-9, -1.5, -9]
        assert list(sweep["max(y)"]) == [0, 0.5, 0]  # y = t - t^2/2
    forces = model.in_mode("k=1").sweep({"on": [0.5, 2]}, to=3, reduce=["max(lambda.rail)"])
    assert list(forces["max(lambda.rail)"]) == [1, 0]
    with pytest.raises(an.ModelError, match="'k' is both given and varied"):
        model.in_mode("k=0").sweep({"k": [0, 1]}, to=3)


def test_a_case_in_a_folder_is_that_of_the_sweep(tmp_path: pathlib.Path) -> None:
    model = an.loads("""
coordinates = ["x", "y"]
parameters = {on = 0.5}
mode.k = 0
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
gravity.field = "-2*ey"
constraint = [{name = "rail", equation = "y' = x'", active = "k - on"}]
initial = {"x'" = 1}
""")
    folder = model.in_mode("k=0").sweep({"on": [0.5, -1]}, to=3, out=tmp_path / "rails")
    assert [folder.run(k)["y"][-1] for k in (0, 1)] == list(folder["y"]) == [-9, -1.5]


def test_each_case_has_an_outcome_where_none_has_a_start() -> None:
    model = an.loads("""
coordinates = ["x"]
parameters = {n = 2, c = 1}
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "-c*x^n*ex"}]
initial = {x = -1}
""")
    sweep = model.with_(n="5/2").sweep({"c": [1, 2]}, to=1, reduce=["max(x)"])
    assert sweep.outcomes == ["not_a_number"] * 2
    assert np.isnan(sweep["x"]).all()
    powers = model.sweep({"n": [2, 3]}, to=1, reduce=["max(x)"])
    for k, n in enumerate((2, 3)):
        assert powers["x"][k] == model.with_(n=n).simulate(to=1)["x"][-1]


def test_axes_are_checked_in_each_case() -> None:
    model = an.loads("""
coordinates = ["p"]
parameters = {s = 0}
frame.B = "rotx(p)*matrix([[1,0,0],[0,1,-s],[0,s,1]])"
body = [{name = "b", mass = 1, inertia = [1, 1, 1], center = "B.y", orientation = "B*quat(1,s^2,0,0)"}]
gravity.field = "-ez"
""")
    sweep = model.sweep({"s": [0, 1]}, to=1)
    assert sweep.outcomes == ["finished", "inconsistent"]
    assert "quaternion in line 5 is no rotation" in sweep.outcome_of(1).message


@pytest.mark.parametrize("seed", [-1, 2**64])
def test_a_seed_has_64_bits(seed: int) -> None:
    with pytest.raises(ValueError, match="seed is .* or (more|less), not"):
        an.load("disc").sweep({"m": an.uniform(1, 2)}, cases=2, to=1, seed=seed)
    assert an.load("disc").sweep({"m": an.uniform(1, 2)}, cases=1, to=0, seed=2**64 - 1).varied["m"][0] == pytest.approx(1.4478220364738066)
