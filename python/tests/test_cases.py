"""Scenarios [case.NAME] of a file: given when it is loaded, later, in another process, in sweeps."""

import json
import pathlib
import pickle
from collections.abc import Callable

import anholon as an
import numpy as np
import pytest

CASES = '''title = "pendulum"
coordinates = ["theta"]
particle = [{name = "bob", mass = 1, position = "l*(sin(theta)*ex - cos(theta)*ey)"}]
parameters = {l = 1, g = 9.81}
gravity.field = "-g*ey"
initial.theta = 0.3
simulate.to = 1
[case.moon]
parameters.g = 1.62
[case.long]
parameters.l = {value = 4}
'''


def test_cases_of_a_file(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "pendulum.toml"
    path.write_text(CASES)
    plain, moon = an.load(path), an.load(path, case="moon")
    assert plain.cases == moon.cases == ["moon", "long"]
    assert (plain.parameters["g"], moon.parameters["g"]) == (9.81, 1.62)
    both = an.load(path, case=["moon", "long"])
    for same in (an.loads(CASES, case=["moon", "long"]), plain.with_(case="moon").with_(case="long"), moon.with_(case="long"), pickle.loads(pickle.dumps(both))):
        assert same.parameters == both.parameters == {"l": 4, "g": 1.62}
        assert np.array_equal(same.simulate()["theta"], both.simulate()["theta"])
    # A value that is given wins over that of a case.
    assert an.load(path, case="moon", set={"g": 3}).parameters["g"] == 3
    with pytest.raises(an.ModelError, match="moon"):
        an.load(path, case="mon")
    assert "the case 'moon' is laid over the file" in json.loads(moon.prove("maggi").certificate)["hypotheses"]
    assert not any("case" in line for line in json.loads(plain.prove("maggi").certificate)["hypotheses"])


def test_borders_of_a_case_are_refined(tmp_path: pathlib.Path, program: Callable[..., str]) -> None:
    path = tmp_path / "pendulum.toml"
    path.write_text(CASES)
    folder, other = tmp_path / "ours", tmp_path / "theirs"
    swept = an.load(path, case="moon").sweep({"theta'": an.grid(0, 8, 5)}, to=5, out=folder, refine=2, refine_by=("theta", 1.0))
    program("sweep", str(path), "--case", "moon", "--vary", "theta'=0:8:5", "--to", "5", "--refine", "2", "--refine-by", "theta:1", "--quiet", "-o", f"{other}/")
    theirs = an.open_sweep(other)
    assert swept.cases == theirs.cases > 5 and len(swept.generations) == 3
    assert np.array_equal(swept["theta"], theirs["theta"])
    plain = an.load(path).sweep({"theta'": an.grid(0, 8, 5)}, to=5, out=tmp_path / "plain", refine=2, refine_by=("theta", 1.0))
    assert not np.array_equal(plain["theta"][:5], swept["theta"][:5])


def test_a_sweep_over_cases_says_how_to_write_it() -> None:
    model = an.loads(CASES)
    with pytest.raises(an.ModelError, match=r'with_\(case="NAME"\)'):
        model.sweep({"case": ["moon", "long"], "theta": [0.1]})
    ends = [model.with_(case=name).sweep({"theta": [0.1]})["theta"][0] for name in model.cases]
    assert ends[0] > ends[1] > 0  # 0.0294 and 0.0006 rad
