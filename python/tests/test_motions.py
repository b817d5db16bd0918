"""Runs and sweeps: their arrays are views of the memory of the library and have the numbers of the command line."""

import ctypes
import gc
import pathlib
import pickle
import resource
import subprocess
import sys
import threading
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import anholon as an
import numpy as np
import pytest

CtrlC = Callable[..., Callable[[], float]]
Program = Callable[..., str]


@pytest.mark.parametrize("model", [model.name for model in an.zoo()])
def test_the_same_bytes_as_the_command_line(model: str, program: Program, tmp_path: pathlib.Path) -> None:
    by_program, by_python = tmp_path / "program.csv", tmp_path / "python.csv"
    program("simulate", model, "--quiet", "--error-estimate", "never", "-o", str(by_program))
    try:
        run = an.load(model).simulate(error_estimate=False)
    except an.ModelError:
        assert not by_program.exists(), "the program simulates it"
        return
    if len(run) == 0:
        assert not run.ok and not by_program.exists()
        return
    run.save(str(by_python))
    assert by_python.read_bytes() == by_program.read_bytes()


def test_arrays_are_views(disc: an.Model) -> None:
    run = disc.simulate(to=1, every=0.01)
    theta = run["theta"]
    assert theta.ctypes.data == run["theta"].ctypes.data, "no copy is made"
    assert not theta.flags.owndata and not theta.flags.writeable
    with pytest.raises(ValueError):
        theta[0] = 1
    first = theta[0]
    del run
    gc.collect()
    assert theta[0] == first and len(theta) == 101, "the array keeps its numbers alive"
    assert ctypes.cast(theta.ctypes.data, ctypes.POINTER(ctypes.c_double))[0] == first


def test_columns(disc: an.Model) -> None:
    run = disc.simulate(to=1, every="0.25")
    assert run.t.tolist() == [0, 0.25, 0.5, 0.75, 1]
    assert run.q.shape == run.qdot.shape == (5, 5)
    assert run.lam.shape == (5, 2)
    np.testing.assert_array_equal(run.q[:, 3], run["theta"])
    assert dict(run)["x'"] is not None
    with pytest.raises(KeyError, match="there is no column 'thet'"):
        run["thet"]
    assert run.report.newton < 1e-12 and run.report.trust
    assert "digits to trust" in run._repr_html_()


def test_physics_never_raises() -> None:
    run = an.load("luo-zhao-example-2").simulate(to=1000)
    assert not run.ok and run.outcome.kind == "negative_mass" and run.outcome.hint
    assert len(run) > 0, "what was computed is there"
    with pytest.raises(an.MotionError) as caught:
        run.expect()
    assert caught.value.outcome.kind == run.outcome.kind


def test_an_inconsistent_start_is_an_outcome(disc: an.Model) -> None:
    run = disc.simulate(to=1, initial={"x'": 1, "phi'": 6, "psi": 0})
    assert run.outcome.kind == "inconsistent" and len(run) == 0
    with pytest.raises(KeyError):
        run["x"]


def test_more_digits() -> None:
    mpmath = pytest.importorskip("mpmath")
    run = an.load("disc").simulate(to="0.1", at=["0.1"], digits=30, tolerance="1e-28", error_estimate=False)
    (text,) = run.exact("theta")
    assert mpmath.nstr(text, 30, strip_zeros=False)[:20] == run._required().text(0, "theta")[:20]
    assert abs(float(text) - run["theta"][0]) < 1e-15


def test_ctrl_c_keeps_what_was_computed(disc: an.Model, ctrl_c: CtrlC) -> None:
    with pytest.raises(an.Interrupted) as caught:
        works_since = ctrl_c(after=0.5)
        disc.simulate(to=1_000_000, at=[1, 1_000_000], error_estimate=False)
    assert works_since() < 0.1
    assert caught.value.result["t"][0] == 1
    assert isinstance(caught.value, KeyboardInterrupt)
    assert caught.value.result.outcome.kind == "interrupted"


def test_stop_progress_and_their_mistakes(disc: an.Model) -> None:
    told: list[float] = []
    run = disc.simulate(to=1_000_000, at=[1_000_000], error_estimate=False, stop=lambda: len(told) > 3, progress=lambda t, steps: told.append(t))
    assert run.outcome.kind == "interrupted" and told == sorted(told)

    def wrong() -> bool:
        raise RuntimeError("mine")

    with pytest.raises(RuntimeError, match="mine"):
        disc.simulate(to=1_000_000, at=[1_000_000], error_estimate=False, stop=wrong)


def test_threads_share_a_model(disc: an.Model) -> None:
    expected = disc.simulate(to=3, every=0.1, error_estimate=False)["theta"]
    found: list[bool] = []

    def work() -> None:
        run = disc.simulate(to=3, every=0.1, error_estimate=False)
        found.append(np.array_equal(run["theta"], expected) and an.load("snakeboard").simulate(to=1).ok)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [True] * 4


def test_sweeps(disc: an.Model, program: Program, tmp_path: pathlib.Path) -> None:
    file = tmp_path / "cases.csv"
    program("sweep", "disc", "--vary", "phi'=5:7:9", "--vary", "m=1,2", "--to", "1", "--quiet", "-o", str(file), "--error-estimate", "never")
    sweep = disc.sweep({"phi'": np.linspace(5, 7, 9), "m": [1, 2]}, to=1)
    assert (sweep.cases, sweep.finished, sweep.outcomes[0]) == (18, 18, "finished")
    lines = file.read_text().splitlines()
    k = lines[0].split(",").index("theta")
    assert [float(line.split(",")[k]) for line in lines[1:]] == sweep["theta"].tolist()
    drawn = disc.sweep({"theta": an.normal(0.3, 0.01)}, to=0.5, cases=20, seed=7)
    assert np.unique(drawn.varied["theta"]).size == 20
    assert drawn.to_dict()["theta(0)"] is not None


def test_sweeps_of_times_and_extremes(disc: an.Model, program: Program, tmp_path: pathlib.Path) -> None:
    sweep = disc.sweep({"phi'": [5, 6, 7]}, at=[0.5, 1], reduce=["min(theta)", "max(theta')"], columns=["theta", "m*(*"])
    assert sweep.rows("theta").shape == (3, 2) and sweep.times.tolist() == [0.5, 1]
    assert (sweep["theta"] == sweep.rows("theta")[:, 1]).all() and sweep.events == ["", "", ""]
    dense = [disc.simulate(initial={"phi'": v}, to=1, every=0.001)["theta"].min() for v in (5, 6, 7)]
    assert np.all(sweep["min(theta)"] <= dense) and np.allclose(sweep["min(theta)"], dense, atol=1e-5)
    file = tmp_path / "cases.csv"
    program("sweep", "disc", "--vary", "phi'=5,6,7", "--at", "0.5,1", "--reduce", "min(theta),max(theta')", "--quiet", "-o", str(file),
            "--columns", "phi'(0),theta,m*(*", "--error-estimate", "never")  # fmt: skip
    lines = [line.split(",") for line in file.read_text().splitlines()]
    table = sweep.to_dict()
    assert lines[0] == ["case", "t", "phi'(0)", "theta", "min(theta)", "max(theta')"] and set(lines[0]) == set(table)
    for k, name in enumerate(lines[0]):
        assert [float(line[k]) for line in lines[1:]] == table[name].tolist(), name
    with pytest.raises(KeyError, match="one number for each motion"):
        sweep.rows("min(theta)")


def test_sweeps_of_tables_and_sequences(disc: an.Model) -> None:
    table = disc.sweep({"phi'": [5, 6], "m": [1, 2]}, together=True, to=0.1)
    assert table.cases == 2 and table.varied["m"].tolist() == [1, 2]
    with pytest.raises(an.ModelError, match="go together"):
        disc.sweep({"phi'": [5, 6], "m": [1, 2, 3]}, together=True, to=0.1)
    even = disc.sweep({"theta": an.uniform(1, 2)}, cases=16, draw="sobol", seed=3, to=0.01).varied["theta"]
    assert sorted(np.floor((even - 1) * 16).astype(int).tolist()) == list(range(16))
    with pytest.raises(an.ModelError, match="did you mean 'sobol'"):
        disc.sweep({"theta": an.uniform(1, 2)}, cases=16, draw="sobl", to=0.01)
    with pytest.raises(an.ModelError, match="beyond the end"):
        disc.sweep({"m": [1, 2]}, to=0.1, at=[1])
    with pytest.raises(an.ModelError, match="no column"):
        disc.sweep({"m": [1, 2]}, to=0.1, columns=["nothing"])
    with pytest.raises(TypeError, match="lists of names"):
        disc.sweep({"m": [1, 2]}, to=0.1, columns="theta")


def test_a_loop_does_not_grow() -> None:
    model = an.load("chaplygin-sleigh")

    def rounds(count: int) -> None:
        for _ in range(count):
            assert model.simulate(to=0.01, error_estimate=False).ok

    rounds(100)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    rounds(400)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20_000, "kB"


def test_dense_output(disc: an.Model) -> None:
    rows = disc.simulate(to=3, every="0.07", error_estimate=False)
    run = disc.simulate(to=3, at=[3], error_estimate=False)
    at = rows.t
    # Each derivative of a polynomial loses about one digit.
    for order, (mark, within) in enumerate([("", 1e-12), ("'", 1e-11), ("''", 1e-9)]):
        values = run(at, order)
        for c in disc.coordinates:
            np.testing.assert_allclose(values[c.name], rows[c.name + mark], rtol=within, atol=within)
    assert np.isnan(run([-0.1, 3.1])["theta"]).all() and run(np.ones((2, 3)))["theta"].shape == (2, 3)
    assert disc.simulate(to=1, dense=True)._dense is not None
    # run(t, 1) is the derivative of run(t).
    h = 1e-6
    slope = (run(1.0 + h)["theta"] - run(1.0 - h)["theta"]) / (2 * h)
    assert abs(slope - run(1.0, 1)["theta"]) < 1e-8
    with pytest.raises(an.ModelError, match="polynomials of Taylor"):
        disc.simulate(to=1, dense=True, method="rk")


def test_a_page(disc: an.Model, tmp_path: pathlib.Path) -> None:
    run = disc.simulate(to=1, every=0.1)
    page = run.page(str(tmp_path / "disc.html"), forms=["maggi"], proof=False)
    assert "<!doctype html>" in page.html.lower()[:200] and "The proof was left out" in page.html
    assert (tmp_path / "disc.html").read_text(encoding="utf-8") == page.html
    assert page._repr_html_().startswith("<iframe srcdoc=") and "<script" not in page._repr_html_().split(">")[0]
    assert "claims" in run.page().html
    with pytest.raises(an.ModelError):
        run.page(forms=["magi"])


def test_other_libraries(disc: an.Model) -> None:
    run = disc.simulate(to=1, every=0.1)
    pandas = pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == list(run)
    polars = pytest.importorskip("polars")
    assert run.to_polars()["theta"].to_list() == run["theta"].tolist()
    assert isinstance(disc.sweep({"m": [1, 2]}, to=0.1).to_polars(), polars.DataFrame)
    pytest.importorskip("xarray")
    assert run.to_xarray()["theta"].dims == ("t",)
    pyarrow = pytest.importorskip("pyarrow")
    table = pyarrow.table(run)
    column = table.column("theta").chunk(0)
    assert column.buffers()[1].address == run["theta"].ctypes.data, "read where it is"
    del run
    gc.collect()
    assert column.to_pylist()[0] == frame["theta"][0]


def test_texts_of_values_and_times_are_those_of_the_command_line(disc: an.Model) -> None:
    """A text is not read as the list of its characters."""
    for of, values in (("10", [10]), (10, [10]), ("5, 6,7", [5, 6, 7]), ("1:7:3", [1, 4, 7]), ("max(2,3),4", [3, 4])):
        assert disc.sweep({"phi'": of}, to="0.01").varied["phi'"].tolist() == values
    written, made = (disc.sweep({"phi'": of}, cases=3, to="0.01").varied["phi'"] for of in ("normal(5,0.1)", an.normal(5, 0.1)))
    assert np.array_equal(written, made) and len(made) == 3
    assert disc.simulate(at="0.5, 1").t.tolist() == [0.5, 1] and disc.simulate(at=0.25).t.tolist() == [0.25]
    assert disc.sweep({"phi'": 5}, at="0.01,0.02").times.tolist() == [0.01, 0.02]


def test_a_run_is_called_with_times(disc: an.Model) -> None:
    run = disc.simulate(to=1)
    halves: list[Any] = [Fraction(1, 2), Decimal("0.5"), np.float32(0.5)]
    assert all(run(half)["x"] == run(0.5)["x"] for half in halves) and np.all(run(halves)["x"] == run(0.5)["x"])
    assert np.array_equal(run("0.5")["x"], run(0.5)["x"])
    others = (["x", "y"], {"t": 1}, 1j, None, [None, 1], b"1", np.array([1, None], dtype=object))
    for what, hint in (("x", r"hint: run\['x'\] is the column of that name"), *((other, r"hint: run\(1.5\)") for other in others)):
        with pytest.raises(an.ModelError, match=r"run\(t\) takes times in seconds, one number or an array, not .*\n" + hint):
            run(what)  # type: ignore[arg-type]


def test_names_that_a_run_at_times_does_not_have(disc: an.Model) -> None:
    run = disc.simulate(to=1)
    column = next(name for name in run if name.startswith("lambda."))
    for order, name, hint in (
        (0, "theta'", "hint: run(t, order=1)['theta']"),
        (0, "θ′", "hint: run(t, order=1)['theta']"),
        (1, "theta''", "hint: run(t, order=3)['theta']"),
        (0, column, f"hint: run[{column!r}] is a column over the rows; simulate(at=[…]) has rows at any times"),
    ):
        with pytest.raises(KeyError) as told:
            run(0.3, order=order)[name]
        assert str(told.value) == f"there is no {name!r} here\nthe names are x, y, psi, theta, phi\n{hint}"
    with pytest.raises(KeyError, match="there is no 'w' here\nthe names are x, y, psi, theta, phi$"):
        run(0.3)["w"]
    with pytest.raises(KeyError, match="hint: run"):
        pickle.loads(pickle.dumps(run(0.3)))["theta'"]
    assert "theta'" not in run(0.3) and run(0.3).get("theta'") is None and run(0.3)["θ"] == run(0.3)["theta"]


def test_a_derivative_that_the_polynomials_do_not_have_is_refused(disc: an.Model) -> None:
    run = disc.simulate(to=1, every=0.5)
    assert np.isfinite(run(0.3, order=3)["theta"])
    for order in (-1, 100, 1.5, True):
        with pytest.raises(an.ModelError, match="order is a whole number from 0 to"):
            run(0.3, order=order)  # type: ignore[arg-type]


def test_a_run_is_saved_under_a_path(disc: an.Model, tmp_path: pathlib.Path) -> None:
    assert disc.simulate(to=0.1).save(tmp_path / "disc.csv") == str(tmp_path / "disc.csv")


def test_wrong_arguments_of_a_sweep_are_named(disc: an.Model, tmp_path: pathlib.Path) -> None:
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"vary": None}, "nothing is varied"),
        ({"vary": 5}, "given by name"),
        ({"vary": {}}, "nothing is varied\nhint: sweep"),
        ({"vary": {"m": [1, float("nan")]}}, "m: nan is not a finite number"),
        ({"vary": {"m": an.uniform(1, 2)}, "cases": -1}, "cases is 1 or more, not -1"),
        ({"vary": {"m": an.uniform(1, 2)}, "cases": 2.5}, "cases is a whole number, not 2.5"),
        ({"vary": {"m": an.uniform(1, 2)}}, "how many cases are to be drawn"),
        ({"vary": {"m": an.uniform(1, 2)}, "cases": 4, "seed": -1}, "seed is 0 or more"),
        ({"vary": {"m": [1, 2]}, "out": tmp_path / "f", "share": "1/2"}, "share is a pair"),
        ({"vary": {"m": [1, 2]}, "out": tmp_path / "f", "share": (1, 2.5)}, "the second number of share is a whole number"),
        ({"vary": {"m": [1, 2]}, "out": tmp_path / "f", "chunk": 0}, "chunk is 1 or more"),
        ({"vary": {"m": [1, 2]}, "out": tmp_path / "f", "refine": "2"}, "refine is a whole number"),
    ]
    for options, text in wrong:
        with pytest.raises((an.ModelError, TypeError, ValueError), match=text):
            disc.sweep(to=1, **options)
    with pytest.raises(TypeError, match="count is a whole number, not 2.5"):
        an.grid(0, 1, 2.5)  # type: ignore[arg-type]
    folder = disc.sweep({"m": [1, 2]}, to=0.1, out=tmp_path / "g")
    with pytest.raises(TypeError, match="conditions are given by column"):
        folder.where([])  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="a range is a pair"):
        folder.where({"m": (1,)})


ENDS = {
    "simulate": "begin(lambda: disc.simulate(to=1e6, every=0.5))",
    "progress": "begin(lambda: disc.simulate(to=1e6, every=0.5, progress=lambda *_: time.sleep(0.01)))",
    "sweep": "begin(lambda: disc.sweep({\"phi'\": an.uniform(5, 6)}, cases=200_000, to=5))",
    "prove": "begin(lambda: [an.load('spherical-robot').prove() for _ in range(99)])",
    "short": "begin(lambda: [disc.simulate(to=0.1) for _ in range(9999)])",
    "at_exit": "begin(lambda: disc.simulate(to=1e6, every=0.5)); atexit.register(lambda: disc.simulate(to=0.1).expect())",
    "arrays": "run = disc.simulate(to=0.1); column = np.from_dlpack(run['theta'])",
    "fork": "begin(lambda: disc.simulate(to=1e6, every=0.5)); child = os.fork(); child and os.waitpid(child, 0)",
}


@pytest.mark.parametrize("what", ENDS)
def test_a_program_ends_while_a_daemon_thread_computes(what: str) -> None:
    script = f"""import atexit, os, threading, time
import anholon as an, numpy as np
disc = an.load("disc")
def begin(f):
    threading.Thread(target=f, daemon=True).start()
    time.sleep(0.2)
{ENDS[what]}
"""
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", script], capture_output=True, text=True, check=False, timeout=60)
    # A machine with other work to do tells that it waits.
    said = done.stderr.replace("anholon: a computation in another thread ends first; Ctrl-C ends the process now\n", "")
    assert (done.returncode, said) == (0, "")
