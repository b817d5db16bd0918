"""Notes and units of a sweep, and files that another process writes."""

import pathlib
import pickle

import anholon as an
import pytest

TEXT = """
coordinates = ["x"]
parameters = {a = 1}
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "a/(x - 2)*ex"}]
initial = {x = 0, "x'" = 1}
"""


@pytest.fixture(scope="module")
def sweep() -> an.Sweep:
    return an.loads(TEXT).sweep({"a": [-1, 1], "x'": [1, 3]}, to=3, reduce=["max(sqrt(1 - x))"])


def test_notes_are_those_of_the_command_line(sweep: an.Sweep, tmp_path: pathlib.Path) -> None:
    assert sweep.finished < sweep.cases
    assert sweep.notes[-1].startswith("stopped (")
    assert f"first case {sweep.outcomes.index(sweep.notes[-1].split('(')[1].split(')')[0])}: " in sweep.notes[-1] and "\nhint: " in sweep.notes[-1]
    folder = an.loads(TEXT).sweep({"a": [-1, 1], "x'": [1, 3]}, to=3, reduce=["max(sqrt(1 - x))"], out=tmp_path / "falls", chunk=2)
    assert folder.notes == sweep.notes
    assert an.open_sweep(folder.path).notes == [note for note in sweep.notes if note.startswith("stopped")]


def test_a_reduction_without_a_value_is_noted() -> None:
    model = an.loads(TEXT)
    sweep = model.sweep({"x'": [0.1, 1]}, to=0.9, reduce=["max(sqrt(0.5 - x))"])
    assert any(note.startswith("max(sqrt(0.5 - x)) has no value in ") for note in sweep.notes)
    assert model.sweep({"x'": [0.1, 0.2]}, to=0.1).notes == []


def test_a_pickled_sweep_writes_and_draws(sweep: an.Sweep, tmp_path: pathlib.Path) -> None:
    again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(sweep))))
    assert again.notes == sweep.notes
    for ending in ("csv", "json", "parquet"):
        sweep.save(tmp_path / f"here.{ending}"), again.save(tmp_path / f"there.{ending}")
        assert (tmp_path / f"here.{ending}").read_bytes() == (tmp_path / f"there.{ending}").read_bytes()
    assert again.figure("x").svg == sweep.figure("x").svg


def test_a_pickled_sweep_that_was_stopped_says_so() -> None:
    asked = iter([False, True])
    cut = an.loads(TEXT).sweep({"a": an.grid(-1, -0.5, 200_000)}, to=3, threads=1, stop=lambda: next(asked, True))
    if cut._core.outcome.kind == "finished":
        pytest.skip("the sweep ended before it was stopped")
    with pytest.raises(an.ModelError, match="stopped from outside"):
        pickle.loads(pickle.dumps(cut)).save("cut.csv")


def test_a_folder_has_units_and_shows_them(tmp_path: pathlib.Path) -> None:
    pytest.importorskip("matplotlib").use("Agg")
    model = an.loads(TEXT.replace("a = 1", 'a = "1 J"').replace("mass = 1", 'mass = "2 kg"').replace("(x - 2)", "(x - 2 m)").replace("x = 0", 'x = "0 m"').replace('"x\'" = 1', '"x\'" = "1 m/s"'))
    folder = model.sweep({"x'": [0.1, 0.2, 0.3]}, to=1, out=tmp_path / "falls")
    assert folder.units["x"] == "m" and folder.units["x'(0)"] == "m/s" and "outcome" not in folder.units
    ax = folder.plot("x")
    assert ax.get_xlabel() == "x'(0) [m/s]" and ax.get_ylabel() == "x [m]"


def test_draws_on_a_grid_are_quantiles_over_the_grid() -> None:
    pytest.importorskip("matplotlib").use("Agg")
    sweep = an.loads(TEXT).sweep({"a": an.uniform(-1, 1), "x'": [0.1, 0.2]}, cases=12, to=1)
    axes = sweep.plot("x")
    assert axes.get_xlabel() == "x'(0)" and len(axes.lines) == 1 and len(axes.lines[0].get_xdata()) == 2
    assert sweep.plot("x", x="x'(0)", y="a").get_ylabel() == "a"
