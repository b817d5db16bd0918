"""A Greek letter and its spelled name are the same name in all functions of the package."""

from __future__ import annotations

import pathlib
import pickle

import anholon as an
import numpy as np
import pytest

TEXT = """
coordinates = ["θ"]
parameters = {"μ" = 0.1, l = 1, g = 9.81}
particle = [{name = "bob", mass = "μ", position = ["l*sin(θ)", "-l*cos(θ)", 0]}]
gravity.field = "-g*ey"
"""


def test_columns_of_runs_and_sweeps(disc: an.Model) -> None:
    run = disc.simulate(to=1, every=0.25)
    np.testing.assert_array_equal(run["θ"], run["theta"])
    np.testing.assert_array_equal(run["θ'"], run["theta'"])
    assert "θ" in run and "ζ" not in run and run.exact("θ") == run.exact("theta")
    assert run.figure("θ", x="φ").svg == run.figure("theta", x="phi").svg
    assert run(0.3)["θ"] == run(0.3)["theta"]
    run.plot("θ", x="φ")
    with pytest.raises(an.ColumnError, match='did you mean "theta'):
        run["θdot"]
    sweep = disc.sweep({"φ'": [5, 6]}, to=1, at=[0.5, 1], columns=["θ"], reduce=["max(θ)"])
    np.testing.assert_array_equal(sweep["θ"], sweep["theta"])
    np.testing.assert_array_equal(sweep["max(θ)"], sweep["max(theta)"])
    np.testing.assert_array_equal(sweep.rows("θ"), sweep.rows("theta"))
    assert sweep.varied["φ'"].tolist() == sweep.varied["phi'"].tolist() == [5, 6] and list(sweep.varied) == ["phi'"]
    with pytest.raises(KeyError, match="one number for each motion"):
        sweep.rows("max(θ)")
    assert pickle.loads(pickle.dumps(sweep)).varied["φ'"].tolist() == [5, 6]


def test_columns_of_folders(disc: an.Model, tmp_path: pathlib.Path) -> None:
    folder = disc.sweep({"φ'": [5, 6]}, to=1, columns=["θ"], out=tmp_path / "falls")
    np.testing.assert_array_equal(folder["θ"], folder["theta"])
    assert folder["φ'(0)"].tolist() == [5, 6] and list(folder.to_dict(["θ"])) == ["theta"]
    assert folder.where({"φ'(0)": (5.5, 7)}).tolist() == [1]


def test_functions_parameters_and_states(disc: an.Model) -> None:
    f = disc.dynamics()
    x = f.state(q={"θ": 1.2}, qdot={"φ'": 6})
    with np.errstate(all="raise"):
        np.testing.assert_array_equal(x, f.state(q={"theta": 1.2}, qdot={"phi'": 6}))
    assert f.motion(x)["θ"] == 1.2
    with pytest.raises(an.ModelError, match="'theta' is given twice in q"):
        f.state(q={"θ": 1.2, "theta": 1.1}, qdot={})
    state = disc.evaluate(initial={"θ": 1.2})
    assert state.q["θ"] == state.q["theta"]


def test_parameters_with_greek_letters() -> None:
    model = an.loads(TEXT)
    assert model.parameters == {"mu": 0.1, "l": 1, "g": 9.81}
    assert model.parameters["μ"] == model.parameters.get("μ") == 0.1 and "μ" in model.parameters
    assert "ν" not in model.parameters and model.parameters.get("ν") is None
    with pytest.raises(KeyError, match="ν"):
        model.parameters["ν"]
    assert model.with_(**{"μ": "2"}).parameters["mu"] == 2
    f = model.dynamics()
    np.testing.assert_array_equal(f(0, [0.4, 1], p={"μ": 3}), f(0, [0.4, 1], p={"mu": 3}))
    with pytest.raises(an.ModelError, match="'mu' is given twice in p"):
        f(0, [0.4, 1], p={"μ": 3, "mu": 3})
    assert model.stability("μ", 1, 2, 3).parameter == "mu"
    assert model.sweep({"μ": [1, 2]}, to=1).varied["μ"].tolist() == [1, 2]


def test_letters_are_spelled_as_in_the_language() -> None:
    from anholon._names import _SPELLED, spelled

    letters = [chr(code) for code in _SPELLED if chr(code).isalpha()]
    assert len(letters) > 30
    for letter in letters:
        model = an.loads(f'coordinates = ["{letter}1"]\nparticle = [{{name = "P", mass = 1, position = "{letter}1*ex"}}]\n')
        assert [c.name for c in model.coordinates] == [spelled(letter + "1")], letter


def test_a_parameter_is_given_once() -> None:
    model = an.loads(TEXT, set={"μ": 2}).with_(mu=3)
    assert model.parameters["mu"] == 3
    with pytest.raises(an.ModelError, match="'mu' is given twice"):
        model.with_(mu=3, μ=4)
    with pytest.raises(an.ModelError, match="'theta' is given twice"):
        model.simulate(to=1, initial={"θ": 1, "theta": 2})
