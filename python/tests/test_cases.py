"""Scenarios [case.NAME] of a file, applied when the file is loaded, later, in another process and in sweeps."""

import json
import pathlib
import pickle
from collections.abc import Callable
from typing import Any

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
[case.thick]
simulate.to = 3
[case.falls]
monitor.height = "-l*cos(theta)"
'''


def test_cases_of_a_file(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "pendulum.toml"
    path.write_text(CASES)
    plain, moon = an.load(path), an.load(path, case="moon")
    assert plain.cases == moon.cases == ["moon", "long", "thick", "falls"]
    assert (plain.parameters["g"], moon.parameters["g"]) == (9.81, 1.62)
    both = an.load(path, case=["moon", "long"])
    for same in (an.loads(CASES, case=["moon", "long"]), plain.with_(case="moon").with_(case="long"), moon.with_(case="long"), pickle.loads(pickle.dumps(both))):
        assert same.parameters == both.parameters == {"l": 4, "g": 1.62}
        assert np.array_equal(same.simulate()["theta"], both.simulate()["theta"])
    # A value that is given overrides that of a case.
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


VARY: dict[str, list[str] | list[float]] = {"theta": [0.1, 0.2, 0.3], "case": ["moon", "long", "thick"], "theta'": [0.0, 0.5]}
WORDS = ["--vary", "theta=0.1,0.2,0.3", "--vary", "case=moon,long,thick", "--vary", "theta'=0,0.5"]


@pytest.fixture
def path(tmp_path: pathlib.Path) -> pathlib.Path:
    path = tmp_path / "pendulum.toml"
    path.write_text(CASES)
    return path


def collected(program: Callable[..., str], folder: pathlib.Path) -> str:
    return program("sweep", "collect", str(folder), "--quiet")


def test_a_folder_over_cases_has_the_bytes_of_the_command_line(path: pathlib.Path, tmp_path: pathlib.Path, program: Callable[..., str]) -> None:
    expected = program("sweep", str(path), *WORDS, "--quiet")
    assert expected.count("\n") == 19 and expected.startswith("case,case_name,theta(0),theta'(0),outcome,t,theta,theta'\n")
    # Parts with cases of two scenarios, one part for all, and a part for each case.
    for chunk in (4, 1000, 1):
        folder = tmp_path / f"of-{chunk}"
        swept = an.load(path).sweep(VARY, out=folder, chunk=chunk)
        assert swept.complete and collected(program, folder) == expected
    reduced = an.load(path).sweep(VARY, at=[0.25, 0.5], reduce=["max(theta)"], columns=["theta*", "max*"], out=tmp_path / "reduced", chunk=7)
    words = [*WORDS, "--at", "0.25,0.5", "--reduce", "max(theta)", "--columns", "theta*,max*"]
    assert collected(program, tmp_path / "reduced") == program("sweep", str(path), *words, "--quiet") != expected
    assert reduced["case_name"].tolist() == ["moon"] * 12 + ["long"] * 12 + ["thick"] * 12
    drawn = an.load(path).sweep({"case": ["moon", "long"], "theta": an.normal("0.1", "0.01")}, cases=5, draw="sobol", seed=3, out=tmp_path / "drawn")
    words = ["--vary", "case=moon,long", "--vary", "theta~normal(0.1,0.01)", "-n", "5", "--draw", "sobol", "--seed", "3"]
    assert drawn.cases == 10 and collected(program, tmp_path / "drawn") == program("sweep", str(path), *words, "--quiet")
    an.load(path, case="moon", set={"l": 2}).sweep({"case": "long,thick"}, to="1/2", form="nielsen", out=tmp_path / "over")
    words = ["--case", "moon", "--set", "l=2", "--vary", "case=long,thick", "--to", "1/2", "--form", "nielsen"]
    assert collected(program, tmp_path / "over") == program("sweep", str(path), *words, "--quiet")


def test_a_sweep_over_cases_in_memory(path: pathlib.Path, tmp_path: pathlib.Path) -> None:
    model = an.load(path)
    folder = model.sweep(VARY, at=["1/2", 1], out=tmp_path / "f")
    for threads in (1, 2):
        told: list[float] = []
        memory = model.sweep(VARY, at=["1/2", 1], threads=threads, progress=lambda done, _: told.append(done))
        assert memory.cases == memory.finished == 18 and list(memory.varied) == ["case", "theta", "theta'"]
        assert memory.varied["case"].tolist() == ["moon"] * 6 + ["long"] * 6 + ["thick"] * 6
        table = memory.to_dict()
        assert list(table)[:4] == ["case", "case_name", "theta(0)", "theta'(0)"] and told == sorted(told)
        for name, column in table.items():
            assert np.array_equal(column, folder[name]), name
    moon = model.with_(case="moon").sweep({"theta": [0.1, 0.2, 0.3], "theta'": [0.0, 0.5]}, at=["1/2", 1])
    chosen = memory.varied["case"] == "moon"
    assert np.array_equal(memory["theta"][chosen], moon["theta"]) and not np.array_equal(memory["theta"][6:12], moon["theta"])
    alone = model.sweep({"case": model.cases}, columns=["theta"])
    assert alone.cases == 4 and "4 of 4 cases finished; varied: case" in repr(alone) and "case" in alone._repr_html_()
    # The case of a scenario ends at the end time of the scenario.
    assert alone.t.tolist() == [1, 1, 3, 1]


def test_scenarios_in_tables(path: pathlib.Path, tmp_path: pathlib.Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    names = ["moon"] * 6 + ["long"] * 6 + ["thick"] * 6
    memory, folder = an.load(path).sweep(VARY), an.load(path).sweep(VARY, out=tmp_path / "f")
    for swept in (memory, folder):
        assert swept.to_pandas()["case_name"].tolist() == swept.to_polars()["case_name"].to_list() == names
    assert list(memory.to_pandas())[:4] == ["case_name", "theta(0)", "theta'(0)", "outcome"]
    read = pyarrow.RecordBatchReader.from_stream(memory).read_all()
    assert read["case_name"].to_pylist() == names
    assert read["theta"].to_pylist() == memory["theta"].tolist()
    assert folder.to_arrow(["case_name"])["case_name"].to_pylist() == folder["case_name"].tolist() == names


def test_a_case_of_a_folder_over_scenarios_moves_again(path: pathlib.Path, tmp_path: pathlib.Path, program: Callable[..., str]) -> None:
    ours = an.load(path, set={"g": "9.8"}).sweep({"case": ["long", "thick"], "theta": [0.1, 0.2]}, out=tmp_path / "ours")
    program("sweep", str(path), "--set", "g=9.8", "--vary", "case=long,thick", "--vary", "theta=0.1,0.2", "--quiet", "-o", str(tmp_path / "theirs") + "/")
    for folder in (ours, an.open_sweep(tmp_path / "ours"), an.open_sweep(tmp_path / "theirs")):
        assert folder.where({"case": "thick"}).tolist() == folder.where({"case": (2, 3)}).tolist() == [2, 3]
        assert folder.where({"case": "thick", "theta(0)": 0.2}).tolist() == [3] and folder.where({"case": "moon"}).size == 0
        for case in range(4):
            run = folder.run(case)
            assert run.model.parameters["l"] == (4 if case < 2 else 1) and run.t[-1] == (1 if case < 2 else 3)
            assert run["theta"][0] == folder["theta(0)"][case] and np.isclose(run["theta"][-1], folder["theta"][case], rtol=1e-9)
    assert ours.judge()["error_estimate"]["compared"] == [0, 1, 2, 3]


def test_a_folder_over_scenarios_goes_on(path: pathlib.Path, tmp_path: pathlib.Path) -> None:
    def hashes(folder: pathlib.Path) -> list[bytes]:
        return [part.read_bytes() for part in sorted(folder.glob("part-*"))]

    model = an.load(path)
    model.sweep(VARY, out=tmp_path / "once", chunk=4)
    for share in (2, 1):
        swept = model.sweep(VARY, out=tmp_path / "shares", chunk=4, share=(share, 2), threads=1)
    assert swept.complete and hashes(tmp_path / "shares") == hashes(tmp_path / "once")
    (tmp_path / "shares" / "part-000001.parquet").unlink()
    assert an.open_sweep(tmp_path / "shares").fill().complete and hashes(tmp_path / "shares") == hashes(tmp_path / "once")
    for word, vary in (("vary case is 'moon,long,thick' there and 'moon,long' here", ["moon", "long"]), ("'moon,thick,long' here", ["moon", "thick", "long"])):
        with pytest.raises(an.ModelError, match=word):
            model.sweep({**VARY, "case": vary}, out=tmp_path / "once")
    # Scenarios vary slowest, whatever the order of the names.
    assert model.sweep({"case": VARY["case"], "theta": VARY["theta"], "theta'": VARY["theta'"]}, out=tmp_path / "once").complete


def test_workers_compute_scenarios(path: pathlib.Path, tmp_path: pathlib.Path, program: Callable[..., str]) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        swept = an.load(path).sweep(VARY, out=tmp_path / "workers", chunk=4, on=client)
    assert swept.complete and collected(program, tmp_path / "workers") == program("sweep", str(path), *WORDS, "--quiet")


def test_mistakes_in_a_sweep_over_scenarios(path: pathlib.Path, tmp_path: pathlib.Path, disc: an.Model) -> None:
    model = an.load(path)
    for word, vary in (
        ("there is no case 'mon'; did you mean 'moon'", {"case": ["mon"]}),
        ("names the case 'moon' twice", {"case": ["moon", "long", "moon"]}),
        ("names no case", {"case": []}),
        ("the case 'falls' has other columns than the case 'moon'\nhint: choose columns that both have", {"case": ["moon", "falls"]}),
        ("no coordinate 'thet'; did you mean 'theta'", {"case": ["moon"], "thet": [1]}),
        ("'1:2:3' is a law of numbers", {"case": "1:2:3"}),
    ):
        for out in ({}, {"out": tmp_path / "none"}):
            with pytest.raises(an.ModelError, match=word):
                model.sweep(vary, **out)  # type: ignore[call-overload]
    with pytest.raises(an.ModelError, match="do not go together"):
        model.sweep({"case": ["moon", "long"], "theta": [1, 2]}, together=True)
    with pytest.raises(an.ModelError, match="there is no case 'heavy'"):
        disc.sweep({"case": ["heavy"]}, to=1)
    assert model.sweep({"case": ["moon", "falls"]}, columns=["theta"]).cases == 2
    # Several scenarios do not make a grid; one scenario does.
    with pytest.raises(an.ModelError, match=r'no grid.*\n.*with_\(case="NAME"\)'):
        model.sweep({"case": ["moon", "long"], "theta": [0.1, 0.2]}, refine=1, out=tmp_path / "none")
    assert not (tmp_path / "none").exists()
    several = model.sweep({"case": ["moon", "long"], "theta": [0.1, 0.2]}, out=tmp_path / "several")
    with pytest.raises(an.ModelError, match="no grid"):
        several.fill(refine=1)
    with pytest.raises(an.ModelError, match="no grid"):
        several._core.refine("", 1)
    one = model.sweep({"case": "moon", "theta'": an.grid(0, 8, 5)}, to=5, out=tmp_path / "one", refine=2, refine_by=("theta", 1.0))
    other = model.with_(case="moon").sweep({"theta'": an.grid(0, 8, 5)}, to=5, out=tmp_path / "other", refine=2, refine_by=("theta", 1.0))
    assert one.generations == other.generations and np.array_equal(one["theta"], other["theta"]) and one.run(one.cases - 1)["theta"].size > 0


def test_a_folder_of_a_file_with_a_base_tells_the_base(path: pathlib.Path, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    top = tmp_path / "top.toml"
    top.write_text('base = "pendulum.toml"\n[case.short]\nparameters.l = 0.5\n')
    swept = an.load(top).sweep({"case": ["moon", "short"], "theta": [0.1, 0.2]}, out=tmp_path / "f", chunk=1)
    assert "base file 1" in json.loads((tmp_path / "f" / "_sweep.json").read_text())["asked"]
    # The model is found from any working folder.
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    (tmp_path / "f" / "part-000003.parquet").unlink()
    here = an.open_sweep(tmp_path / "f").fill()
    assert here.complete and np.isclose(here.run(3)["theta"][-1], swept["theta"][3], rtol=1e-9)
    path.write_text(CASES.replace("9.81", "9.8"))
    requests: list[dict[str, Any]] = [{"case": ["moon", "short"], "theta": [0.1, 0.2]}, {"case": ["moon"]}]
    for vary in requests:
        with pytest.raises(an.ModelError, match="base file 1"):
            an.load(top).sweep(vary, out=tmp_path / "f")


def test_a_parameter_may_be_called_case() -> None:
    model = an.loads(CASES.replace("l = 1", "l = 1, case = 2").replace('"-g*ey"', '"-case*g*ey"'))
    swept = model.sweep({"case": [1, 2]})
    assert swept.varied["case"].tolist() == [1, 2] and swept["theta"][0] != swept["theta"][1]


BEAD = """title = "bead"
coordinates = ["x", "y"]
particle = [{name = "bead", mass = 1, position = ["x", "y", 0]}]
constraint = [{name = "wire", equation = "y = a*x^2"}]
parameters.a = 1
gravity.field = [0, "-9.81", 0]
initial = {x = 1, y = 2, "x'" = 1}
simulate.to = 1
[case.wide]
parameters.a = 0.5
[case.free]
constraint.wire.equation = "y = 2"
"""
BALL = """title = "ball"
coordinates = ["x", "y"]
particle = [{name = "ball", mass = 1, position = ["x", "y", 0]}]
contact = [{name = "floor", gap = "y", slip = "x'", friction = 0.2, restitution = 0.5}]
gravity.field = [0, "-9.81", 0]
initial = {x = 0, y = 1, "x'" = 1}
simulate.to = 1
[case.rough]
contact.floor.friction = 0.8
[case.soft]
contact.floor.restitution = 0
"""


@pytest.mark.parametrize(
    ("text", "vary", "words"),
    [
        # The initial values of the model contradict its constraint; those of some cases do not.
        (BEAD, {"case": "wide,free", "y": [3, 2, "1/2"]}, ["case=wide,free", "y=3,2,1/2"]),
        (BALL, {"case": "rough,soft", "x'": [1, 2]}, ["case=rough,soft", "x'=1,2"]),
    ],
)
def test_starts_and_contacts_of_scenarios(text: str, vary: dict[str, Any], words: list[str], tmp_path: pathlib.Path, program: Callable[..., str]) -> None:
    path = tmp_path / "model.toml"
    path.write_text(text)
    expected = program("sweep", str(path), "--vary", words[0], "--vary", words[1], "--quiet")
    folder, memory = an.load(path).sweep(vary, out=tmp_path / "f"), an.load(path).sweep(vary)
    assert collected(program, tmp_path / "f") == expected and memory.finished >= 2
    for name in memory:
        assert np.array_equal(memory[name], folder[name], equal_nan=True), name
