"""Numbers of parameters are in the units that the file declares, on their way in and out."""

import json
import pathlib
from typing import Any

import numpy as np
import pytest

import anholon as an


@pytest.fixture(scope="module")
def model() -> an.Model:
    return an.loads("""coordinates = ["x", "th"]
parameters = {a = {value = 30, unit = "deg"}, k = {value = 2, unit = "kN/m"}, m = {value = 500, unit = "g"}}
input.u = "sin(a)*(1 N)"
body = [{name = "p", mass = "m", inertia = "1 kg*m^2", center = "x*ex", angle = "th"}]
potential.V = "k*x^2/2"
force = [{on = "p", vector = "u*ex"}]
initial = {x = "10 cm", th = "a"}
output.F = {value = "k*x", unit = "kN"}
""")


def test_parameters_are_what_with_takes(model: an.Model) -> None:
    assert model.parameters == {"a": 30, "k": 2, "m": 500}
    given: dict[str, Any] = {**model.parameters}
    same = model.with_(**given)
    assert same.parameters == model.parameters
    for name in ("x", "th", "F"):
        assert same.simulate(to=0.1)[name].tolist() == model.simulate(to=0.1)[name].tolist()
    assert [(p.name, p.value, p.unit) for p in model._core.parameters] == [("a", 30, "deg"), ("k", 2, "kN/m"), ("m", 500, "g")]


def test_functions_stay_in_si_units(model: an.Model) -> None:
    f = model.dynamics()
    assert dict(zip(f.parameters, f.p0.tolist(), strict=True)) == pytest.approx({"a": np.pi / 6, "k": 2000, "m": 0.5}, rel=1e-15)


def test_varied_values_are_the_given_ones(model: an.Model, tmp_path: pathlib.Path) -> None:
    sweep = model.sweep({"m": [250, 500], "a": [30, 0.1]}, to=0.1)
    assert sweep.varied["m"].tolist() == [250, 250, 500, 500] and sweep.varied["a"].tolist() == [30, 0.1, 30, 0.1]
    assert sweep["x"][sweep.varied["m"] == 250].shape == (2,)
    assert sweep.units["m"] == "g" and sweep.units["a"] == "deg"
    again = model.sweep(cases={name: values for name, values in sweep.varied.items()}, to=0.1, threads=1)
    table = model.sweep(cases=sweep.to_pandas()[["m", "a"]], to=0.1)
    sweep.save(tmp_path / "cases.csv")
    written = (tmp_path / "cases.csv").read_text().splitlines()
    assert [line.split(",")[1:3] for line in written] == [["m", "a"], ["250", "30"], ["250", "0.1"], ["500", "30"], ["500", "0.1"]]
    for other in (again, table):
        assert other["x"].tolist() == sweep["x"].tolist() and other.varied["a"].tolist() == sweep.varied["a"].tolist()
    mixed = model.sweep({"m": ["0.25 kg", "1 lb"]}, to=0.1)
    assert mixed.varied["m"].tolist() == [250, 453.59237]
    assert model.sweep({"a": ["pi/6 rad", "30 deg", 30]}, to=0.1).varied["a"].tolist() == [30, 30, 30]


def test_a_folder_has_the_same_numbers(model: an.Model, tmp_path: pathlib.Path) -> None:
    whole = model.sweep({"m": [250, 500, 750], "a": [30, 45]}, to=0.1)
    parts = model.sweep({"m": [250, 500, 750], "a": [30, 45]}, to=0.1, out=tmp_path / "falls", chunk=2, share=(2, 2))
    parts.fill()
    opened = an.open_sweep(tmp_path / "falls")
    for folder in (parts, opened):
        for name in ("m", "a"):
            assert folder[name].tolist() == whole.varied[name].tolist()
        assert folder["x"].tolist() == whole["x"].tolist() and folder.units["a"] == "deg"
        for case in (0, 3):
            assert folder.run(case)["x"][-1] == pytest.approx(folder["x"][case], rel=1e-13)


def test_a_folder_in_si_units_is_refused(model: an.Model, tmp_path: pathlib.Path) -> None:
    def sweep() -> Any:
        return model.sweep({"m": [250, 500]}, to=0.1, out=tmp_path / "falls")

    sweep()
    file = tmp_path / "falls" / "_sweep.json"
    asked = json.loads(file.read_text())
    assert asked["format_version"] == 2 and asked.pop("units") == "m in g"
    file.write_text(json.dumps({**asked, "format_version": 1}))
    for attempt in (sweep, lambda: an.open_sweep(tmp_path / "falls")):
        with pytest.raises(an.ModelError, match=r"falls was made by an earlier build.* m in g\nhint: compute the sweep again"):
            attempt()


def test_scenarios_have_one_unit_of_what_varies(model: an.Model, tmp_path: pathlib.Path) -> None:
    heavy = model.text + '[case.heavy]\nparameters.m = {value = 3, unit = "kg"}\n[case.light]\nparameters.m = {value = 3, unit = "g"}\n'
    refused = "the units of what varies differ: in SI units in the case 'heavy', and m in g in the case 'light'"
    with pytest.raises(an.ModelError, match=refused):
        an.loads(heavy).sweep({"case": ["heavy", "light"], "m": [1, 2]}, to=0.1)
    with pytest.raises(an.ModelError, match=refused):
        an.loads(heavy).sweep({"case": ["heavy", "light"], "m": [1, 2]}, to=0.1, out=tmp_path / "falls")
    tons = an.loads(model.text + '[case.heavy]\nparameters.m = {value = 3, unit = "t"}\n')
    swept = tons.sweep({"case": ["heavy"], "m": [1, 2]}, to=0.1)
    assert swept.units["m"] == "t" and swept.varied["m"].tolist() == [1, 2]
    folder = tons.sweep({"case": ["heavy"], "m": [1, 2]}, to=0.1, out=tmp_path / "tons")
    assert folder.units["m"] == "t" and folder["m"].tolist() == [1, 2] and folder["x"].tolist() == swept["x"].tolist()


def test_linear_models_have_the_given_values(model: an.Model) -> None:
    values = model.stability("m", [250, "0.5 kg"], about="equilibrium")
    assert values.values.tolist() == [250, 500]
    assert abs(values.eigenvalues[0]).max() == pytest.approx((2000 / 0.25) ** 0.5, rel=1e-12)
    drive = an.loads("""coordinates = ["x"]
parameters = {c = {value = 30, unit = "g"}}
particle = [{name = "a", mass = "1 kg", position = "x*ex"}]
force = [{on = "a", vector = "(-(3 N/m)*x + (c - 40 g)*(1 1/s)*x')*ex"}]
""")
    assert [c.value for c in drive.stability("c", 30, 50, 3).crossings] == [40]
    assert [c.value for c in drive.stability("c", [30, 45]).crossings] == [40]
