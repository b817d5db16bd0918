"""Motions and sweeps with contacts."""

import json
import pathlib
import pickle
import re
from collections.abc import Callable

import anholon as an
import numpy as np
import pytest


def test_bead_leaves_the_hoop_and_strikes_it() -> None:
    run = an.load("bead-in-hoop").simulate(to=2, every=0.25)
    assert [e.name for e in run.events] == ["hoop.leaves", "hoop.hits", "hoop.hits"]
    # The bead leaves where N = m (v^2/R - g cos) vanishes: z = (v0^2 - 2 g R)/(3 g) above the centre.
    there = an.load("bead-in-hoop").simulate(to=run.events[0].t)
    assert there["z"][-1] == pytest.approx((36 - 2 * 9.81) / (3 * 9.81), abs=1e-12)
    assert set(run["hoop.mode"]) == {0, 1}
    assert np.all(run["hoop.gap"] > -1e-12)


def test_cases_are_the_motions() -> None:
    model = an.load("slipping-wheel")
    sweep = model.sweep({"M": [2, 6]}, to=3)
    for k, M in enumerate((2, 6)):
        alone = model.with_(M=M).simulate(to=3)
        assert sweep["road.mode"][k] == alone["road.mode"][-1]
        assert sweep["x"][k] == alone["x"][-1]


def test_equations_refuse_contacts() -> None:
    with pytest.raises(an.ModelError, match="'linearize' needs the mode of the contacts, and the model has 'hoop'\nhint: model.in_mode\\(\"hoop=open\"\\), or slips"):
        an.load("bead-in-hoop").linearize()
    with pytest.raises(an.ModelError, match="'prove' needs the mode"):
        an.load("bead-in-hoop").prove()


def test_messages_are_in_the_words_of_python() -> None:
    model = an.load("bead-in-hoop")
    with pytest.raises(an.ModelError, match="error: there is no parameter 'mas'") as set_wrong:
        model.with_(mas=3)
    with pytest.raises(an.ModelError, match="error: there is no case 'heavy'") as case_wrong:
        model.with_(case="heavy")
    with pytest.raises(an.ModelError, match=r"no polynomials\nhint: simulate\(every=0.01\), or at=") as times_wrong:
        model.simulate(to=0.1, every=0.05)(0.02)
    with pytest.raises(an.ModelError, match="computed in doubles\nhint: leave out digits") as digits_wrong:
        model.simulate(to=0.1, digits=30)
    assert all("--" not in str(wrong.value) for wrong in (set_wrong, case_wrong, times_wrong, digits_wrong))


STRING = """
title = "Ball that a slack string catches"
coordinates = ["x", "z"]
parameters = {m = 0.5, g = 9.81, l = 1, h = 0.6}
mode.taut = 0
gravity.field = "-g*ez"
particle = [{name = "ball", mass = "m", position = "x*ex + z*ez"}]
constraint = [{name = "string", equation = "norm(ball) = l", active = "taut"}]
event = [{name = "tightens", when = "norm(ball) - l", direction = "up", set = {taut = 1}}]
initial = {x = "h"}
"""


def test_a_mode_is_that_of_the_command_line(program: Callable[..., str]) -> None:
    hoop = an.load("bead-in-hoop").in_mode("hoop=slips")
    assert str(hoop.equations()).strip() == program("derive", "bead-in-hoop", "--mode", "hoop=slips").strip()
    proof = hoop.prove("routh", "chaplygin")
    assert bool(proof)
    told = json.loads(program("linearize", "bead-in-hoop", "--mode", "hoop=slips", "--qdot", "x=0", "--json"))
    linear = hoop.linearize(initial={"x'": 0})
    assert [[z.real, z.imag] for z in linear.eigenvalues] == told["eigenvalues"]
    # Comparisons use the equations of the mode, and copies of the model keep the mode.
    assert hoop.compare(["z: m*z'' = -m*g - lambda.hoop*z/norm(P)"])["z"].verdict == "true"
    assert hoop.compare(["z: m*z'' = -m*g + lambda.hoop*z/norm(P)"])["z"].verdict == "false"
    again = pickle.loads(pickle.dumps(hoop))
    assert again.constraints[0].name == "hoop" and again.with_(R=2).constraints[0].name == "hoop"


def test_mistakes_in_a_mode_are_those_of_the_command_line() -> None:
    hoop = an.load("bead-in-hoop")
    for word, message in (
        ("hoop=stick", "mode: 'hoop=stick' names no mode; did you mean 'sticks'?\nhint: hoop=open, hoop=slips or hoop=sticks"),
        ("loop=open", "mode: there is no contact 'loop'; did you mean 'hoop'?"),
        ("hoop", "mode: 'hoop' names no mode"),
    ):
        with pytest.raises(an.ModelError, match=re.escape(message)):
            hoop.in_mode(word)
    with pytest.raises(an.ModelError, match="slips against friction, which is no ideal force"):
        an.load("slipping-wheel").in_mode("road=slips")


def test_string_catches_the_ball() -> None:
    model = an.loads(STRING)
    run = model.simulate(to=1, every=0.5)
    assert [e.name for e in run.events] == ["tightens"]
    assert run.events[0].t == pytest.approx((2 * 0.8 / 9.81) ** 0.5, rel=1e-14)
    assert list(run["string.active"]) == [0, 1, 1]
    sweep = model.sweep({"h": [0.2, 0.6]}, to=1)
    assert sweep["x"][1] == run["x"][-1] and sweep["lambda.string"][1] == run["lambda.string"][-1]
    assert model.in_mode("taut=1").equations().text.split("\n")[1:] == model.in_mode("taut=2").equations().text.split("\n")[1:]
    assert len(model.in_mode("taut=0").constraints) == 0
    with pytest.raises(an.ModelError, match="'prove' needs the mode, as the constraint 'string' holds in some only"):
        model.prove()
    with pytest.raises(an.ModelError, match="there is no mode 'tout'; did you mean 'taut'"):
        model.in_mode("tout=1")


@pytest.mark.parametrize(
    ("name", "mode", "vary"),
    [("bead-in-hoop", "hoop=slips", ("x'", [0.1, 0.2, 0.3])), ("string", "taut=1", ("h", [0.2, 0.6]))],
)
def test_a_sweep_in_a_mode(name: str, mode: str, vary: tuple[str, list[float]], tmp_path: pathlib.Path, program: Callable[..., str]) -> None:
    path = tmp_path / "string.toml"
    path.write_text(STRING)
    place = str(path) if name == "string" else name
    model, (varied, values) = an.load(place), vary
    words = ["--vary", f"{varied}={','.join(map(str, values))}", "--to", "1", "--quiet"]
    in_mode = model.in_mode(mode)
    memory, folder = in_mode.sweep({varied: values}, to=1), in_mode.sweep({varied: values}, to=1, out=tmp_path / "ours", chunk=2)
    expected = program("sweep", place, *words, "--mode", mode)
    program("sweep", place, *words, "--mode", mode, "-o", str(tmp_path / "theirs") + "/")
    assert expected.count("\n") == len(values) + 1
    assert program("sweep", "collect", str(tmp_path / "ours"), "--quiet") == expected == program("sweep", "collect", str(tmp_path / "theirs"), "--quiet")
    for column in memory:
        assert np.array_equal(memory[column], folder[column]), column
    # The folder keeps the mode with the request, and a case that is simulated again has it.
    for place_of in ("ours", "theirs"):
        assert json.loads((tmp_path / place_of / "_sweep.json").read_text())["asked"]["mode"] == mode
        again = an.open_sweep(tmp_path / place_of)
        last = again.run(len(values) - 1)
        assert not last.events and np.isclose(last["z"][-1], again["z"][-1], rtol=1e-9)
    (tmp_path / "ours" / "part-000000.parquet").unlink()
    assert an.open_sweep(tmp_path / "ours").fill().complete and program("sweep", "collect", str(tmp_path / "ours"), "--quiet") == expected
    with pytest.raises(an.ModelError, match=f"holds another sweep: mode is '{mode}' there and not given here"):
        model.sweep({varied: values}, to=1, out=tmp_path / "ours")
    # Without the mode the motion is another one, as its contacts change.
    assert program("sweep", place, *words) != expected


def test_a_folder_in_another_mode_is_refused(tmp_path: pathlib.Path) -> None:
    hoop = an.load("bead-in-hoop")
    hoop.in_mode("hoop=slips").sweep({"R": [1, 2]}, to=1, out=tmp_path / "f")
    with pytest.raises(an.ModelError, match="mode is 'hoop=slips' there and 'hoop=open' here"):
        hoop.in_mode("hoop=open").sweep({"R": [1, 2]}, to=1, out=tmp_path / "f")
    hoop.sweep({"R": [1, 2]}, to=1, out=tmp_path / "changing")
    with pytest.raises(an.ModelError, match="mode is not given there and 'hoop=open' here"):
        hoop.in_mode("hoop=open").sweep({"R": [1, 2]}, to=1, out=tmp_path / "changing")


@pytest.mark.parametrize("call", ["c_code", "python_code"])
def test_programs_of_models_with_contacts_name_the_call(call: str) -> None:
    with pytest.raises(an.ModelError, match=f"'{call}' needs the mode of the contacts"):
        getattr(an.load("stick-slip"), call)()


def test_a_state_of_a_mode_in_which_the_file_does_not_start() -> None:
    ball = an.loads(
        """
coordinates = ["x", "z"]
gravity.field = "-9.81*ez"
particle = [{name = "ball", mass = 1, position = "x*ex + z*ez"}]
contact = [{name = "floor", gap = "z", slip = "x'", friction = 0.3}]
initial = {z = 1}
"""
    ).in_mode("floor=sticks")
    hint = r"z = 1 \(line 6\) clashes with constraint 'floor'.*\nhint: the file may start in another mode: give a state of the chosen one with initial=\{…\}$"
    for call in (ball.dynamics, ball.linearize, ball.c_code, ball.python_code, ball.initial):
        with pytest.raises(an.MotionError, match=hint):
            call()
    assert ball.dynamics(initial={"z": 0, "x": 2}, minimal=False).start.tolist() == [2, 0, 0, 0]
    assert "2.0" in ball.c_code(initial={"z": 0, "x": 2})
    with pytest.raises(an.MotionError, match="hint: leave out"):
        ball.dynamics(initial={"z": 1})
