"""compare, evaluate, linearize and stability have the numbers and verdicts of the command line."""

import copy
import json
import os
import pathlib
import pickle
import re
import signal
import subprocess
import threading
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import anholon as an
import numpy as np
import pytest
from anholon import _core

CtrlC = Callable[..., Callable[[], float]]
Program = Callable[..., str]


def document(program: Program, *words: str) -> Any:
    return json.loads(program(*words, "--json", "--quiet"))


COMPARED = {
    "disc": "a: m*R^2/4*theta'' = 0\nr: x' + R*phi'*cos(psi) = 0\nb: T_r = T_r",
    "chaplygin-sleigh": "blade: x'*sin(th) - y'*cos(th) = 0\nwrong: x'*sin(th) + y'*cos(th) = 0\nn: m*(x'' - a*th''*sin(th) + a*th'^2*cos(th)) = -lambda.blade_edge*sin(th)",
    "rolling-coin": "k: x' = phi'\n",
    "falling-chain": "e: y'' = 0",
}


@pytest.mark.parametrize("model", COMPARED)
def test_compare_gives_the_lines_of_the_program(model: str, program: Program, tmp_path: pathlib.Path) -> None:
    path = tmp_path / "some.eq"
    path.write_text(COMPARED[model], encoding="utf-8")
    printed = program("compare", model, str(path), "--json", "--quiet")
    if not printed:
        with pytest.raises(an.ModelError):
            an.load(model).compare(path)
        return
    expected = json.loads(printed)["equations"]
    for found in (an.load(model).compare(path), an.load(model).compare(COMPARED[model])):
        assert len(found) == len(expected)
        for line, told in zip(found, expected, strict=True):
            assert (line.label, line.text, line.verdict) == (told["label"], told["text"], told["verdict"])
            assert (line.nearest or line.what) == told["what"]
            assert (line.difference or None, line.detail, line.point or None) == (told["difference"], told["detail"], told["point"])
            assert [s.reads for s in line.suggestions] == [c["reads"] for c in told["changes"]]
            for s, c in zip(line.suggestions, told["changes"], strict=True):
                assert s.proved == c["proved"]
                assert [(p.wrong, p.right, p.line, p.column, p.place) for p in s.places] == [
                    (p["from"], p["to"], p["line"], p["column"], p["place"]) for p in c["places"]
                ]


def test_shipped_equations(program: Program) -> None:
    expected = document(program, "compare", "luo-zhao-example-1-symbolic", "luo-zhao-example-1.restored")["equations"]
    found = an.load("luo-zhao-example-1-symbolic").compare("luo-zhao-example-1.restored")
    assert [line.verdict for line in found] == [told["verdict"] for told in expected]
    assert bool(found) == all(told["verdict"] == "true" for told in expected)


def test_a_misprint_is_found_and_shown(disc: an.Model) -> None:
    sleigh = an.load("chaplygin-sleigh")
    found = sleigh.compare({"right": "x'*sin(th) = y'*cos(th)", "wrong": "x'*sin(th) = -y'*cos(th)"})
    assert found["right"] and not found["wrong"] and not found
    assert found["wrong"].suggestions and "should be" in repr(found["wrong"])
    assert "✗ false" in found._repr_html_()
    with pytest.raises(an.ModelError) as caught:
        sleigh.compare("wrong: x' = yy'")
    assert caught.value.diagnostics[0].line == 1
    with pytest.raises(an.ModelError, match="did you mean the shipped equations"):
        sleigh.compare("luo-zhao-example-1.restord")


def same_digits(number: Any, text: str, digits: int) -> bool:
    """True if a number of mpmath equals that of a text, up to the rounding of both to `digits` digits."""
    import mpmath

    return bool(abs(number - mpmath.mpf(text)) <= abs(number) * mpmath.mpf(10) ** -digits)


EVALUATED = ["disc", "chaplygin-sleigh", "rattleback", "fourbar", "snakeboard", "luo-zhao-example-1", "constant-jerk", "variable-mass-pendulum", "rocket"]


@pytest.mark.parametrize("model", EVALUATED)
def test_evaluate_gives_the_numbers_of_the_program(model: str, program: Program) -> None:
    expected = document(program, "evaluate", model)
    if expected["outcome"] != "finished":
        with pytest.raises(an.MotionError) as caught:
            an.load(model).evaluate()
        assert caught.value.outcome.kind == expected["outcome"]
        return
    state = an.load(model).evaluate()
    assert {**state.q, **state.qdot} == expected["state"]
    assert state.t == expected["t"] and state.form == expected["form"]
    assert state.forces and all(values == expected[name] for name, values in state.forces.items())
    assert state.accelerations == expected["derivatives"]
    assert state.multipliers == expected["lambda"]
    assert all(value == expected[name] for name, value in state.energies.items())
    assert state.mass_matrix.tolist() == expected["mass_matrix"]
    assert state.reactions == expected["reactions"]
    assert state.residuals == expected["residuals"]


def test_evaluate_with_digits_and_another_state(program: Program, disc: an.Model) -> None:
    mpmath = pytest.importorskip("mpmath")
    words = ("evaluate", "disc", "--q", "theta=1.2", "--digits", "40", "--json", "--quiet")
    expected = json.loads(program(*words), parse_float=str)
    state = disc.evaluate(initial={"theta": 1.2}, digits=40)
    with mpmath.workdps(60):
        for name, value in state.accelerations.items():
            assert same_digits(value, expected["derivatives"][name], 40)
        assert same_digits(state.energies["T_r"], expected["T_r"], 40)
    rough = disc.evaluate(initial={"theta": 1.2}).accelerations["theta''"]
    assert abs(rough - state.accelerations["theta''"]) < 1e-14 * abs(rough)
    with pytest.raises(an.MotionError):
        disc.evaluate(initial={"x'": 1, "phi'": 6, "psi": 0})


def numbers(pairs: Any) -> Any:
    return np.array(pairs, dtype=float).reshape(-1, 2) @ [1, 1j]


def check_linear(model: an.LinearModel, told: Any) -> None:
    assert model.motion == told["motion"] and model.t == told["t"]
    assert (model.states, model.dependent, model.inputs, model.outputs) == (told["states"], told["dependent"], told["inputs"], told["outputs"])
    assert (model.cyclic, model.core, model.multiplicities) == (told["cyclic"], told["core"], told["multiplicities"])
    assert dict(zip(model.states, model.values, strict=True)) == told["state"]
    for name in "ABCD":
        ours = getattr(model, name)
        np.testing.assert_array_equal(ours, np.array(told[name], dtype=float).reshape(ours.shape))
    np.testing.assert_array_equal(np.array(model.eigenvalues), numbers(told["eigenvalues"]))
    for mode, expected in zip(model.modes, told["modes"], strict=True):
        np.testing.assert_array_equal(mode, numbers(expected))


@pytest.mark.parametrize("model", ["disc", "whipple", "two-wheeled-pendulum", "rattleback", "chaplygin-sleigh", "double-pendulum-cartesian", "third-order-linear"])
def test_linearize_gives_the_numbers_of_the_program(model: str, program: Program) -> None:
    told = document(program, "linearize", model)
    if told["outcome"] != "finished":
        with pytest.raises(an.MotionError) as caught:
            an.load(model).linearize()
        assert caught.value.outcome.kind == told["outcome"]
        return
    check_linear(an.load(model).linearize(), told)


@pytest.mark.parametrize("model", ["double-pendulum-cartesian", "variable-mass-pendulum", "rattleback"])
def test_an_equilibrium_is_found(model: str, program: Program) -> None:
    told = document(program, "linearize", model, "--about", "equilibrium")
    if told["outcome"] != "finished":
        with pytest.raises(an.MotionError) as caught:
            an.load(model).linearize(about="equilibrium")
        assert str(caught.value.outcome.message) == told["message"]
        return
    check_linear(an.load(model).linearize(about="equilibrium"), told)


def test_a_linear_model_about_given_values_with_digits(program: Program) -> None:
    mpmath = pytest.importorskip("mpmath")
    bicycle = an.load("whipple").with_(v=5)
    told = json.loads(program("linearize", "whipple", "--set", "v=5", "--digits", "30", "--json", "--quiet"), parse_float=str)
    model = bicycle.linearize(digits=30)
    with mpmath.workdps(60):
        for row, texts in zip(model.exact("A"), told["A"], strict=True):
            assert all(same_digits(x, text, 30) for x, text in zip(row, texts, strict=True))
        for e, (re, im) in zip(model.exact("eigenvalues"), told["eigenvalues"], strict=True):
            assert same_digits(e.real, re, 30) and same_digits(e.imag, im, 30)
    with pytest.raises(ValueError, match="digits=30"):
        bicycle.linearize().exact("A")
    told = document(program, "linearize", "disc", "--q", "theta=1.2")
    check_linear(an.load("disc").linearize(initial={"theta": 1.2}), told)
    with pytest.raises(an.ModelError):
        bicycle.linearize(about="rest")
    with pytest.raises(an.ModelError):
        an.load("double-pendulum-cartesian").linearize(about="equilibrium", initial={"x1'": 1})


def test_stability_of_the_bicycle(program: Program) -> None:
    bicycle = an.load("whipple")
    told = document(program, "linearize", "whipple", "--vary", "v=0..10:1/4")
    found = bicycle.stability("v", 0, 10, 41)
    assert [c.value for c in found.crossings] == [4.292382536341104, 6.024262015388359] == [c["v"] for c in told["crossings"]]
    assert [(c.frequency, c.eigenvalues, c.destabilizes) for c in found.crossings] == [
        (c["frequency"], c["eigenvalues"], c["destabilizes"]) for c in told["crossings"]
    ]
    assert found.values.tolist() == [v["v"] for v in told["values"]]
    for model, expected in zip(found.models, told["values"], strict=True):
        assert model is not None
        check_linear(model, expected)
    assert found.stable.tolist() == [4.292382536341104 < v < 6.024262015388359 for v in found.values]


def test_curves_go_on_smoothly() -> None:
    found = an.load("whipple").stability("v", 0, 10, 201)
    eigenvalues = found.eigenvalues
    for k, model in enumerate(found.models):
        assert model is not None
        by_value = sorted(model.eigenvalues, key=lambda e: (e.real, e.imag))
        assert sorted(eigenvalues[k].tolist(), key=lambda e: (e.real, e.imag)) == by_value, "each eigenvalue lies on one curve"
    # Away from the places where a pair becomes real, a curve bends little between neighbours.
    second = np.abs(np.diff(eigenvalues, 2, axis=0)).max(axis=1)
    shuffled = np.abs(np.diff(np.sort(eigenvalues, axis=1)[:, ::-1], 2, axis=0)).max(axis=1)
    assert np.sum(second > 0.5) <= 6
    assert second.sum() <= shuffled.sum()


def test_values_without_a_linear_model_are_told() -> None:
    pendulum = an.loads("""
coordinates = ["th"]
parameters = {l = 1}
particle = [{name = "bob", mass = "sqrt(l)", position = ["l*sin(th)", "-l*cos(th)", 0]}]
gravity.field = "-9.81*ey"
[initial]
q = {th = 0}
qdot = {th = 0}
""")
    found = pendulum.stability("l", [1, -1, 2])
    assert [o.ok for o in found.outcomes] == [True, False, True]
    assert found.models[1] is None and np.isnan(found.eigenvalues[1]).all() and not found.stable[1] and found.stable[0]
    np.testing.assert_allclose(sorted(found.eigenvalues[0].imag), [-np.sqrt(9.81), np.sqrt(9.81)], rtol=1e-15)
    with pytest.raises(an.ModelError, match="did you mean 'l'"):
        pendulum.stability("ll", 0, 1)
    with pytest.raises(an.ModelError):
        pendulum.stability("l", 0, 1, 1)
    with pytest.raises(an.ModelError):
        pendulum.stability("l", [])


LONG: list[tuple[str, str, Callable[[an.Model], object]]] = [
    ("prove", "spherical-robot", lambda m: m.prove()),
    ("compare", "whipple", lambda m: m.compare(["a: phi'' = psi'' + delta''*phi"])),
]


def test_a_computation_is_counted_while_it_runs() -> None:
    model, counts = an.load("spherical-robot"), set[int]()
    ended = threading.Event()

    def look() -> None:
        while not ended.is_set():
            counts.add(_core.running())
            time.sleep(0.001)

    beside = threading.Thread(target=look)
    beside.start()
    model.equations("kane")
    model.prove("maggi")
    ended.set()
    beside.join()
    assert 1 in counts and _core.running() == 0


@pytest.mark.parametrize(("name", "call"), [row[1:] for row in LONG], ids=[row[0] for row in LONG])
def test_ctrl_c_ends_what_keeps_nothing(ctrl_c: CtrlC, name: str, call: Callable[[an.Model], object]) -> None:
    model = an.load(name)

    with pytest.raises(KeyboardInterrupt):
        works_since = ctrl_c(after=0.05)
        call(model)
    assert works_since() < 0.1
    assert _core.running() == 0  # the computation has ended
    assert model.coordinates[0].name == "x"  # the model is unchanged


BATCHES: dict[str, Callable[[an.Dynamics], Callable[[], object]]] = {
    "rates": lambda f: partial(f, 0, np.tile(f.start[:, None], 400_000)),
    "derivatives": lambda f: partial(f.jac, 0, np.tile(f.start[:, None], 40_000)),
    "outputs": lambda f: partial(f.output, 0, np.tile(f.start[:, None], 400_000)),
}


@pytest.mark.parametrize("what", BATCHES)
def test_ctrl_c_ends_a_batch_of_dynamics(ctrl_c: CtrlC, what: str) -> None:
    f = an.load("whipple").dynamics()
    call = BATCHES[what](f)
    call()  # derives the formulas and compiles them, which is not measured
    begun, worked = time.perf_counter(), time.process_time()
    call()
    lasts, works = time.perf_counter() - begun, time.process_time() - worked
    with pytest.raises(KeyboardInterrupt):
        works_since = ctrl_c(after=lasts / 8)
        call()
    assert works_since() < works / 2
    assert _core.running() == 0
    np.testing.assert_array_equal(f(0, np.tile(f.start[:, None], 2000))[:, 7], f(0, f.start))


def test_ctrl_c_ends_a_proof_of_the_command() -> None:
    """The message names the forms that were compared until then, and the exit status is 1."""
    delay, shortest, longest = 0.1, 0.0, 0.0  # before `shortest` the proof has not begun, after `longest` it has ended
    for _ in range(16):
        process = subprocess.Popen([os.environ["ANHOLON_PROGRAM"], "prove", "snake"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        time.sleep(delay)
        process.send_signal(signal.SIGINT)
        shown, said = process.communicate(timeout=60)
        if process.returncode in (0, -signal.SIGINT):
            shortest, longest = (delay, longest) if process.returncode else (shortest, delay)
            delay = (shortest + longest) / 2 if longest > shortest else 2 * shortest
            continue
        assert process.returncode == 1 and shown == ""
        told = re.match(r"stopped \(interrupted\): (\d+) of (\d+) forms were compared with Routh's equations\n((?:.+: .+\n)*)$", said)
        assert told and int(told[1]) < int(told[2]), said
        lists = {what: names.split(", ") for what, names in (line.split(": ") for line in told[3].splitlines())}
        assert lists.keys() <= {"proved", "compared, but the tangents of the constraints are not shown"}
        assert sum(len(names) for names in lists.values()) == int(told[1])
        # These forms have no multipliers. Their proof needs the tangents of the constraints, which are proved last.
        assert not {"appell-reduced", "chaplygin", "maggi"} & set(lists.get("proved", ()))
        if lists:
            return
        shortest = delay
        delay = (shortest + longest) / 2 if longest > shortest else 1.5 * shortest
    raise AssertionError("no request came during the proof")


def test_the_number_of_digits_is_bounded(disc: an.Model) -> None:
    for call in (disc.evaluate, disc.linearize):
        for digits in (0, 2001, 10**7):
            with pytest.raises(an.ModelError, match="digits is a whole number from 1 to 2000"):
                call(digits=digits)
    with pytest.raises(an.ModelError, match="about cannot be 'rest'"):
        disc.linearize(about="rest")


FLYWHEEL = """
coordinates = ["x", "y"]
parameters = {J = 0, k = 1}
particle = [{name = "a", mass = 1, position = "x*ex"}]
potential.k = "k*(x - y)^2/2 + y^2/2"
body = [{name = "w", inertia = "J", center = "0", angle = "y"}]
"""


def test_linearize_in_every_form() -> None:
    with pytest.raises(an.ModelError, match="another mechanics"):
        an.load("double-pendulum-cartesian").linearize(form="vakonomic")
    assert an.load("second-order-linear").linearize(form="udwadia-kalaba").A.shape == an.load("second-order-linear").linearize().A.shape


def test_a_parameter_that_is_zero_in_the_file() -> None:
    model = an.loads(FLYWHEEL)
    found = model.stability("J", [0, 1])
    assert [len(m.states) for m in found.models if m] == [2, 4]
    assert np.allclose(sorted(abs(found.eigenvalues[1])), np.sqrt((3 + np.sqrt(5) * np.array([-1, -1, 1, 1])) / 2), rtol=1e-14)
    f = model.dynamics(minimal=False)
    assert f.parameters == ["k"]
    with pytest.raises(KeyError, match="order of the equations"):
        f(0, f.start, p={"J": 1})
    assert model.with_(J=1).dynamics(minimal=False).parameters == ["J", "k"]


def test_sweeps_and_stability_need_no_start_of_the_file() -> None:
    model = an.loads("""
coordinates = ["a", "b"]
parameters = {m = 1, M = 0, g = 9.81}
particle = [{name = "p", mass = "m", position = "sin(a)*ex - cos(a)*ez"}, {name = "q", mass = "M", position = "p + sin(b)*ex - cos(b)*ez"}]
gravity.field = "-g*ez"
initial = {a = 0.1}
""")
    assert [o.ok for o in model.stability("M", [0.5, 1], about="equilibrium").outcomes] == [True, True]
    assert model.sweep({"M": [0.5, 1]}, to=0.1).finished == 2


def test_stability_without_any_linear_model() -> None:
    found = an.loads("""
coordinates = ["x", "y"]
parameters.L = 1
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
constraint = [{name = "c", equation = "x^2 + y^2 = L^2"}]
initial = {x = 5}
""").stability("L", [1, 2, 3])
    assert found.eigenvalues.shape == (3, 0)
    assert found.models == [None] * 3 and not found.stable.any()


def test_a_state_that_is_not_steady_is_not_called_stable() -> None:
    found = an.loads("""
coordinates = ["x"]
parameters.p = 1
particle = [{name = "a", mass = 1, position = "x*ex"}]
force = [{on = "a", vector = "(1 - 3*x - (p - 1.2)*x')*ex"}]
""").stability("p", [0, 2])
    assert not found.stable.any()
    assert [c.meaning for c in found.crossings] == ["to the left above"]


def test_linear_models_can_be_pickled_and_copied() -> None:
    linear = an.load("trailers").linearize(digits=20)
    speeds = an.load("whipple").stability("v", [3, 5, 7])
    ways: list[Callable[[Any], Any]] = [copy.copy, copy.deepcopy, lambda of: pickle.loads(pickle.dumps(of))]
    for way in ways:
        again, over = way(linear), way(speeds)
        assert repr(again) == repr(linear) and (again.A == linear.A).all() and again.exact("A") == linear.exact("A")
        assert repr(over) == repr(speeds) and (over.eigenvalues == speeds.eigenvalues).all() and (over.stable == speeds.stable).all()
        assert [c.value for c in over.crossings] == [c.value for c in speeds.crossings]
