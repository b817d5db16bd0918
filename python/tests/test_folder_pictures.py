"""Figures of sweeps in folders: maps, curves over the names that vary and over t, and folders with missing parts."""

import os
import pathlib
import re

import anholon as an
import pytest


@pytest.fixture
def grid(tmp_path: pathlib.Path, disc: an.Model) -> an.SweepFolder:
    """Computes a sweep of 4 x 5 cases with a part for each value of phi'."""
    return disc.sweep({"phi'": an.grid(2, 5, 4), "theta": an.grid("0.8", "1.2", 5)}, to=1, columns=["theta"], out=tmp_path / "grid", chunk=5)


def patches(svg: str) -> int:
    return svg.count("<rect") + svg.count('fill="#')


def test_a_map_with_missing_parts_has_the_whole_grid(grid: an.SweepFolder) -> None:
    pytest.importorskip("matplotlib").use("agg")
    whole = grid.figure("theta").svg
    assert "parts" not in whole and grid.plot("theta").get_title() == ""
    for part in (1, 2, 3):
        os.remove(pathlib.Path(grid.path) / f"part-{part:06}.parquet")
    svg = grid.figure("theta").svg
    assert "1 of 4 parts" in svg
    # The axes show the whole grid, and the map has fewer cells than that of the complete folder.
    for tick in ("2", "3", "4", "5"):
        assert f">{tick}<" in svg or f">{tick}.0<" in svg
    assert patches(svg) < patches(whole)
    axes = grid.plot("theta")
    assert axes.get_title() == "1 of 4 parts"
    assert axes.get_xlim() == pytest.approx((1.85, 5.15)) and axes.get_ylim() == pytest.approx((0.78, 1.22))
    os.remove(pathlib.Path(grid.path) / "part-000000.parquet")
    for draw in (grid.figure, grid.plot):
        with pytest.raises(an.ModelError, match="no part is in"):
            draw("theta")


def test_curves_over_one_number(tmp_path: pathlib.Path, disc: an.Model) -> None:
    pytest.importorskip("matplotlib").use("agg")
    folder = disc.sweep({"phi'": [6, 5, 7]}, to=1, out=tmp_path / "one")
    axes = folder.plot("theta", "x")
    assert axes.lines[0].get_xdata().tolist() == [5, 6, 7] and [line.get_label() for line in axes.lines] == ["theta", "x"]
    assert folder.figure("theta", "x").svg.startswith("<svg")
    for draw in (folder.plot, folder.figure):
        with pytest.raises(an.ModelError, match="'outcome' holds words"):
            draw()
        with pytest.raises(an.ModelError, match="an axis shows numbers"):
            draw("theta", x="outcome")
    with pytest.raises(KeyError, match="no column 'w'; there are case, "):
        folder.plot("w")
    with pytest.raises(an.ModelError, match="no column 'w'"):
        folder.figure("w")


def test_rows_at_times_are_curves_over_t(tmp_path: pathlib.Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    model = an.loads(an.load("disc").text + "[case.heavy]\nparameters.m = 9\n[case.light]\nparameters.m = 1\n")
    times: list[int | float | str] = [0, "0.1", "0.2"]
    few = model.sweep({"case": ["heavy", "light"], "phi'": [5, 6]}, at=times, columns=["theta"], out=tmp_path / "few")
    axes = few.plot("theta")
    assert [line.get_label() for line in axes.lines] == [f"{case}, phi'(0) = {spin}" for case in ("heavy", "light") for spin in (5, 6)]
    assert axes.lines[3].get_xdata().tolist() == [0, 0.1, 0.2] and axes.get_xlabel() == "t"
    assert axes.lines[3].get_ydata().tolist() == few["theta"][9:].tolist()
    assert len(re.findall("heavy, phi", few.figure("theta").svg)) == 2
    many = an.load("disc").sweep({"phi'": an.grid(4, 6, 9)}, at=times, out=tmp_path / "many")
    assert len(many.plot("theta").lines) == 1 and "50 %" in many.figure("theta").svg
    assert many.plot("theta", x="phi'(0)").get_xlabel() == "phi'(0)"
    for draw in (many.plot, many.figure):
        with pytest.raises(an.ModelError, match="9 cases are too many curves"):
            draw("theta", x="x")
