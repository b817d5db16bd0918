"""Tables of cases: files of CSV and Parquet, arrays by name, tables of pandas, polars and pyarrow."""

import csv
import pathlib
from decimal import Decimal

import anholon as an
import numpy as np
import pytest

TEXT = """
coordinates = ["x"]
parameters = {m = 1, k = 1}
particle = [{name = "p", mass = "m", position = "x*ex"}]
potential.spring = "k*x^2/2"
initial.x = 1
[case.heavy]
parameters.m = 9
[case.light]
parameters.m = 1
"""
COLUMNS: dict[str, list[float]] = {"k": [0.1, 2.5, 1e-3], "x'": [0, 1, -2]}


@pytest.fixture(scope="module")
def model() -> an.Model:
    return an.loads(TEXT)


@pytest.fixture(scope="module")
def together(model: an.Model) -> an.Sweep:
    return model.sweep(COLUMNS, together=True, to=1)


def equal(a: an.Sweep, b: an.Sweep) -> None:
    assert a.cases == b.cases and a.finished == b.finished
    assert list(a.varied) == list(b.varied)
    for name in a.varied:
        np.testing.assert_array_equal(a.varied[name], b.varied[name])
    for name in a:
        np.testing.assert_array_equal(a[name], b[name])


def test_arrays_by_name(model: an.Model, together: an.Sweep) -> None:
    equal(model.sweep(cases=COLUMNS, to=1), together)
    equal(model.sweep(cases={name: np.array(column, dtype=float) for name, column in COLUMNS.items()}, to=1), together)


def test_texts_are_formulas_and_a_column_of_numbers_of_cases_varies_nothing(model: an.Model) -> None:
    sweep = model.sweep(cases={"case": [0, 1], "k": ["1/4", "pi/2"], "x(0)": ["1", "sqrt(2)"]}, to=1)
    assert sweep.varied["k"].tolist() == [0.25, np.pi / 2] and sweep.varied["x"].tolist() == [1, np.sqrt(2)]


def test_a_csv_file(model: an.Model, together: an.Sweep, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "cases.csv"
    file.write_text("k,x'\n0.1,0\n2.5,1\n1e-3,-2\n")
    equal(model.sweep(cases=file, to=1), together)
    equal(model.sweep(cases=str(file), to=1), together)


@pytest.mark.parametrize("version", ["1.0", "2.0"])
@pytest.mark.parametrize("compression", ["none", "snappy", "zstd"])
@pytest.mark.parametrize("dictionary", [True, False])
def test_a_parquet_file(model: an.Model, together: an.Sweep, tmp_path: pathlib.Path, version: str, compression: str, dictionary: bool) -> None:
    pyarrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    table = pyarrow.table({"k": pyarrow.array(COLUMNS["k"]), "x'": pyarrow.array(COLUMNS["x'"], pyarrow.int32())})
    file = tmp_path / "cases.parquet"
    parquet.write_table(table, file, compression=compression, data_page_version=version, use_dictionary=dictionary)
    equal(model.sweep(cases=file, to=1), together)


def test_kinds_of_parquet_columns(tmp_path: pathlib.Path) -> None:
    pyarrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    rng = np.random.default_rng(5)
    rows = 3000
    whole = np.cumsum(rng.integers(-5, 500, rows))
    columns = {
        "real": pyarrow.array(rng.normal(size=rows)),
        "single": pyarrow.array(rng.random(rows).astype(np.float32)),
        "whole": pyarrow.array(whole),
        "small": pyarrow.array(rng.integers(-5, 5, rows).astype(np.int8)),
        "unsigned": pyarrow.array(rng.integers(2**63, 2**64 - 1, rows, dtype=np.uint64)),
        "decimal": pyarrow.array([Decimal(int(k)) / 1000 for k in whole - 9000], pyarrow.decimal128(20, 3)),
        "word": pyarrow.array([f'{k} cm, "{k % 3}"' for k in range(rows)]),
        "absent": pyarrow.array([None if k % 7 == 0 else k / 8 for k in range(rows)]),
        "__index_level_0__": pyarrow.array(range(rows)),
    }
    split = {"real": "BYTE_STREAM_SPLIT", "single": "BYTE_STREAM_SPLIT", "whole": "DELTA_BINARY_PACKED", "small": "DELTA_BINARY_PACKED", "word": "DELTA_LENGTH_BYTE_ARRAY"}
    table = pyarrow.table(columns)
    for options in ({}, {"use_dictionary": False, "row_group_size": 700, "data_page_size": 500}, {"use_dictionary": False, "column_encoding": split}):
        parquet.write_table(table, tmp_path / "kinds.parquet", **options)
        lines = list(csv.reader(an._core.case_table(str(tmp_path / "kinds.parquet")).splitlines()))
        assert lines[0] == list(columns)[:-1] and len(lines) == rows + 1
        for name, texts in zip(lines[0], zip(*lines[1:])):
            for text, value in zip(texts, table[name].to_pylist()):
                if value is None:
                    assert text == ""
                elif name == "single":
                    assert np.float32(text) == np.float32(value) and len(text) < 16
                else:
                    assert type(value)(text) == value


@pytest.mark.parametrize("type_name", ["timestamp", "date32", "list_"])
def test_other_columns_are_refused_by_name(model: an.Model, tmp_path: pathlib.Path, type_name: str) -> None:
    pyarrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    kinds = {"timestamp": lambda: pyarrow.timestamp("ns"), "date32": pyarrow.date32, "list_": lambda: pyarrow.list_(pyarrow.int64())}
    values = [[1], [2]] if type_name == "list_" else [1, 2]
    parquet.write_table(pyarrow.table({"day": pyarrow.array(values, kinds[type_name]())}), tmp_path / "cases.parquet")
    with pytest.raises(an.ModelError, match="the column 'day' of the table holds"):
        model.sweep(cases=tmp_path / "cases.parquet", to=1)


def test_damaged_parquet_files_are_refused(model: an.Model, tmp_path: pathlib.Path) -> None:
    pyarrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    file = tmp_path / "cases.parquet"
    parquet.write_table(pyarrow.table(COLUMNS), file)
    whole = file.read_bytes()
    rng = np.random.default_rng(1)
    for _ in range(300):
        damaged = bytearray(whole)
        for at in rng.integers(4, len(whole) - 4, 2):
            damaged[at] = rng.integers(0, 256)
        file.write_bytes(damaged if rng.random() < 0.8 else damaged[: rng.integers(4, len(whole))])
        try:
            an._core.case_table(str(file))
        except an.ModelError:
            pass


@pytest.mark.parametrize("library", ["pandas", "polars", "pyarrow"])
def test_frames(model: an.Model, together: an.Sweep, library: str) -> None:
    frames = pytest.importorskip(library)
    frame = frames.table(COLUMNS) if library == "pyarrow" else frames.DataFrame(COLUMNS)
    equal(model.sweep(cases=frame, to=1), together)


def test_a_table_is_an_axis_beside_others(model: an.Model) -> None:
    sweep = model.sweep({"case": ["heavy", "light"], "x": [1, 2]}, cases={"k": [1, 2, 3]}, to=1)
    assert sweep.cases == 12 and list(sweep.varied) == ["case", "x", "k"]
    assert sweep.varied["k"].tolist() == [1, 2, 3] * 4 and sweep.varied["x"].tolist() == ([1] * 3 + [2] * 3) * 2
    drawn = model.sweep({"x": an.uniform(0, 1)}, cases=({"k": [1, 2, 3]}, 6), to=1)
    assert drawn.cases == 6 and drawn.varied["k"].tolist() == [1, 2, 3] * 2


def test_mistakes_tell_the_place(model: an.Model, tmp_path: pathlib.Path) -> None:
    with pytest.raises(an.ModelError, match="the table, line 3: '2 kg.' is not a number"):
        model.sweep(cases={"k": ["1", "2 kg+"]}, to=1)
    with pytest.raises(an.ModelError, match="the table, line 1: there is no parameter and no coordinate 'q'"):
        model.sweep(cases={"q": [1]}, to=1)
    with pytest.raises(an.ModelError, match="between 1 and 2 rows"):
        model.sweep(cases={"k": [1], "m": [1, 2]}, to=1)
    with pytest.raises(ValueError, match="k: nan is not a finite number"):
        model.sweep(cases={"k": [float("nan")]}, to=1)
    with pytest.raises(an.ModelError, match="cannot read"):
        model.sweep(cases=tmp_path / "none.csv", to=1)
    with pytest.raises(TypeError, match="cases is a number, a table, or the path of one"):
        model.sweep(cases=object(), to=1)  # type: ignore[call-overload]


def test_a_folder_keeps_the_table(model: an.Model, tmp_path: pathlib.Path) -> None:
    folder = model.sweep(cases=COLUMNS, to=1, out=tmp_path / "falls", chunk=1)
    np.testing.assert_array_equal(folder["k"], COLUMNS["k"])
    again = model.sweep(cases=COLUMNS, to=1, out=tmp_path / "falls")
    assert again.progress().parts == 3
    with pytest.raises(an.ModelError, match="table of cases"):
        model.sweep(cases={**COLUMNS, "k": [0.1, 2.5, 2e-3]}, to=1, out=tmp_path / "falls")
    # The folder is enough to compute a case and a missing part.
    assert an.open_sweep(tmp_path / "falls").run(1)["x"][-1] == folder["x"][1]
    part = tmp_path / "falls" / "part-000001.parquet"
    before = part.read_bytes()
    part.unlink()
    from anholon import _sweep_filling

    _sweep_filling._opened.clear()
    assert _sweep_filling.fill_parts(str(tmp_path / "falls"), [1], 1) == 1
    assert part.read_bytes() == before


def test_a_folder_tells_what_a_table_varies(model: an.Model, tmp_path: pathlib.Path) -> None:
    folder = model.sweep({"m": [1, 2]}, cases=COLUMNS, to=1, out=tmp_path / "few", columns=["x"])
    assert folder.varied == ["m", "k", "x'(0)"]


def test_the_table_of_a_sweep_and_some_of_its_lines(model: an.Model, tmp_path: pathlib.Path) -> None:
    pytest.importorskip("pandas")
    import pandas

    sweep = model.sweep({"k": [1, 4], "x'": [0, 2]}, to=1)
    frame = sweep.to_pandas()
    again = model.sweep(cases=frame[frame["k"] == 4], to=1)
    assert list(again.varied) == ["k", "x'"]
    np.testing.assert_array_equal(again["x"], sweep["x"][2:])
    frame.to_csv(tmp_path / "falls.csv", index_label="case")
    for cases in (tmp_path / "falls.csv", pandas.read_csv(tmp_path / "falls.csv")):
        np.testing.assert_array_equal(model.sweep(cases=cases, to=1)["x"], sweep["x"])
    with pytest.raises(an.ModelError, match="does not choose scenarios"):
        model.sweep(cases={"case_name": ["heavy", "light"], "k": [1, 2]}, to=1)
