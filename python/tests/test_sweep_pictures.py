"""Files, tables and figures of sweeps in memory."""

import json
import pathlib
from collections.abc import Callable
from typing import Any

import anholon as an
import numpy as np
import pytest

Program = Callable[..., str]

MEASURED = """coordinates = ["x", "z"]
parameters = {m = "2 kg", k = "8 N/m"}
particle = [{name = "P", mass = "m", position = "x*ex + z*ez"}]
gravity.field = "-9.81*ez"
potential.spring = "k*x^2/2"
initial = {x = "1 m", z = "2 m"}
event = [{name = "low", when = "z", stop = true}]
simulate.to = 1
"""


@pytest.fixture
def measured() -> an.Model:
    return an.loads(MEASURED)


# ---- files ----


@pytest.mark.parametrize("options", [{}, {"at": ["1/2", 1]}, {"columns": ["x", "max*"]}, {"columns": ["x"], "at": ["1/2"]}])
def test_a_file_is_that_of_the_command_line(options: dict[str, Any], measured: an.Model, program: Program, tmp_path: pathlib.Path) -> None:
    model = tmp_path / "m.toml"
    model.write_text(MEASURED)
    words = ["--at", ",".join(str(t) for t in options["at"])] if "at" in options else []
    if "columns" in options:
        # With --at the command line always writes t, after the number of the case.
        usual = ["m", "x(0)", "outcome", "event"] + ([] if "at" in options else ["t"])
        words += ["--columns", ",".join(usual + options["columns"])]
    program("sweep", str(model), "--vary", "m=1,2", "--vary", "x=1:3:3", "--reduce", "max(x)", *words, "--quiet", "-o", str(tmp_path / "a.csv"))
    sweep = measured.sweep({"m": [1, 2], "x": an.grid(1, 3, 3)}, reduce=["max(x)"], **options)
    assert sweep.save(tmp_path / "b.csv") == str(tmp_path / "b.csv")
    ours, theirs = (file.read_text().splitlines() for file in (tmp_path / "b.csv", tmp_path / "a.csv"))
    assert ours == theirs and "event" in ours[0]


def test_a_file_of_scenarios_is_that_of_the_command_line(program: Program, tmp_path: pathlib.Path) -> None:
    model = tmp_path / "m.toml"
    model.write_text(MEASURED + "[case.soft]\nparameters.k = 1\n[case.stiff]\nparameters.k = 100\n")
    program("sweep", str(model), "--vary", "case=soft,stiff", "--vary", "x=1,2", "--quiet", "-o", str(tmp_path / "a.csv"))
    an.load(model).sweep({"case": ["soft", "stiff"], "x": [1, 2]}).save(tmp_path / "b.csv")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def test_files_of_other_formats(measured: an.Model, tmp_path: pathlib.Path) -> None:
    sweep = measured.sweep({"m": [1, 2]})
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(sweep.save(tmp_path / "a.parquet"))
    assert table.column_names[:5] == ["case", "m", "outcome", "event", "t"] and table["x"].to_pylist() == sweep["x"].tolist()
    told = json.loads(pathlib.Path(sweep.save(tmp_path / "a.json")).read_text())
    assert told["cases"] == 2 and told["finished"] == sweep.finished and told["error_estimate"]["reason"] == "not asked for"


def test_cases_that_were_not_computed_are_left_out_of_a_file(disc: an.Model, tmp_path: pathlib.Path) -> None:
    sweep = disc.sweep({"phi'": an.grid(5, 7, 100_000)}, to=50, stop=lambda: True, columns=["theta"])
    assert not sweep.outcome.ok and sweep.finished < sweep.cases
    lines = pathlib.Path(sweep.save(tmp_path / "a.csv")).read_text().splitlines()
    assert len(lines) == 1 + sweep.outcomes.count("finished") and all(",finished," in line for line in lines[1:])


def test_names_that_are_no_files(measured: an.Model, tmp_path: pathlib.Path) -> None:
    sweep = measured.sweep({"m": [1, 2]})
    with pytest.raises(an.ModelError, match=r"names no format that holds sweeps\nhint: end it in .*\.parquet"):
        sweep.save("cases.xlsx")
    with pytest.raises(an.ModelError, match=r"takes the cases while they are computed\nhint: .*out="):
        sweep.save(tmp_path)
    with pytest.raises(an.ModelError, match="No such file"):
        sweep.save(tmp_path / "nowhere" / "a.csv")


# ---- tables ----


def test_a_stream_of_arrow_has_outcomes_and_units(measured: an.Model, tmp_path: pathlib.Path) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    for times in ([], ["1/2"]):
        sweep = measured.sweep({"m": [1, 2], "x": [1]}, at=times)
        table = pyarrow.table(sweep)
        assert table.column_names == list(sweep.to_pandas())
        assert table["outcome"].to_pylist() == sweep.to_pandas()["outcome"].tolist()
        units = {field.name: (field.metadata or {}).get(b"unit", b"").decode() for field in table.schema}
        assert (units["m"], units["x(0)"], units["x'"], units["t"], units["outcome"]) == ("kg", "m", "m/s", "s", "")
    assert sweep.units == {"m": "kg", "t": "s", "x": "m", "z": "m", "x'": "m/s", "z'": "m/s"}


# ---- pictures ----


def test_curves_over_one_number(measured: an.Model) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    sweep = measured.sweep({"m": [3, 1, 2]}, to="0.2")
    axes = sweep.plot("x", "x'")
    assert axes.lines[0].get_xdata().tolist() == [1, 2, 3] and axes.get_xlabel() == "m [kg]"
    assert axes.lines[1].get_ydata().tolist() == sweep["x'"][[1, 2, 0]].tolist()
    assert [line.get_label() for line in axes.lines] == ["x [m]", "x' [m/s]"]
    assert [line.get_label() for line in sweep.plot().lines] == ["x [m]", "z [m]"]
    own = matplotlib.pyplot.figure().subplots()
    assert sweep.plot("x", ax=own) is own and own.get_ylabel() == "x [m]"
    figure = sweep.figure("x*")
    assert isinstance(figure, an.Figure) and "(kg)" in figure.svg
    assert sweep.figure("steps").svg.startswith("<svg")


def test_several_cases_of_one_value_are_a_band(measured: an.Model) -> None:
    pytest.importorskip("matplotlib").use("agg")
    sweep = measured.sweep({"m": [1, 1, 1, 2]}, to="0.2")
    axes = sweep.plot("x")
    assert axes.lines[0].get_xdata().tolist() == [1, 2] and len(axes.collections) == 1
    assert "50 %" in sweep.figure("x").svg


def test_a_map_over_two_numbers(measured: an.Model) -> None:
    pytest.importorskip("matplotlib").use("agg")
    sweep = measured.sweep({"m": [1, 2], "x": [1, 2, 3]})
    axes = sweep.plot("x'")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("m [kg]", "x(0) [m]")
    assert axes.collections[0].get_array().tolist() == sweep["x'"].tolist()
    assert [text.get_text() for text in sweep.plot().get_legend().get_texts()] == ["event low"]
    assert sweep.plot("z", x="x(0)").get_ylabel() == "m [kg]"
    assert "event low" in sweep.figure().svg
    with pytest.raises(an.ModelError, match="shows one column, and there are 2"):
        sweep.plot("x", "z")
    with pytest.raises(an.ModelError, match="shows one column, and there are 2"):
        sweep.figure("x", "z")


def test_mistakes_in_names(measured: an.Model, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("matplotlib").use("agg")
    sweep = measured.sweep({"m": [1, 2]}, to="0.2")
    with pytest.raises(KeyError, match="no column 'w'; there are m, outcome, t, steps, x, z"):
        sweep.plot("w")
    with pytest.raises(an.ModelError, match="no column 'w'"):
        sweep.figure("w")
    for draw in (sweep.plot, sweep.figure):
        with pytest.raises(an.ModelError, match="'outcome' holds words"):
            draw("outcome")
        with pytest.raises(an.ModelError, match="x and y are both 'm'"):
            draw("x", x="m", y="m")
        with pytest.raises(an.ModelError, match="an axis shows numbers"):
            draw("x", x="outcome")
    scenarios = an.loads(MEASURED + "[case.soft]\nparameters.k = 1\n").sweep({"case": ["soft"]}, to="0.2")
    for draw in (scenarios.plot, scenarios.figure):
        with pytest.raises(an.ModelError, match="no number varies"):
            draw("x")
    monkeypatch.setattr("anholon.sweep.find_spec", lambda name: None)
    assert isinstance(sweep.plot("x"), an.Figure)


def test_cases_without_numbers_are_left_out(measured: an.Model) -> None:
    pytest.importorskip("matplotlib").use("agg")
    sweep = measured.sweep({"m": [1, -1, 2]}, to="0.2", columns=["x"])
    lines = sweep.plot("x").lines
    assert lines[0].get_xdata().tolist() == np.sort(sweep.varied["m"][np.isfinite(sweep["x"])]).tolist()


def test_pictures_tell_which_event_ended_a_case(measured: an.Model, tmp_path: pathlib.Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    vary = {"m": [1, 2], "z": [2, 20]}
    sweep, folder = measured.sweep(vary), measured.sweep(vary, out=tmp_path / "all")
    assert sweep.outcomes == ["finished"] * 4 and folder.outcomes == {"finished": 4}
    assert folder.progress().events == {"low": 2}
    for of in (sweep, folder):
        assert [text.get_text() for text in of.plot().get_legend().get_texts()] == ["event low", "finished"]
        assert all(word in of.figure().svg for word in (">event low<", ">finished<"))
        assert "event low" in of._repr_html_()
