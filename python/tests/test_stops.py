"""Motions that end from outside: values that `stop` may return, `run(t)` of such a motion, Ctrl-C in functions that keep no results."""

from __future__ import annotations

import dataclasses
import pathlib
import pickle
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import anholon as an
import numpy as np
import pytest

CtrlC = Callable[..., Callable[[], float]]

_SOON = 0.3  # s of processor time: a tenth of a second, and a margin for a busy machine


class Broken:
    """An object without a truth value."""

    def __bool__(self) -> bool:
        raise RuntimeError("no truth here")


def after_calls(answer: object, calls: int = 3) -> Callable[[], object]:
    """Returns a function for `stop` that is False for some calls, then the answer."""
    counted = iter(range(10**9))
    return lambda: next(counted) >= calls and answer


@pytest.mark.parametrize("answer", [True, np.bool_(True), 1, "x", [0], 0.5])
def test_what_is_true_stops(disc: an.Model, answer: object) -> None:
    run = disc.simulate(to=1e6, stop=after_calls(answer))
    assert run.outcome.kind == "interrupted"
    sweep = disc.sweep({"phi'": an.grid(5, 7, 10**6)}, to=1, stop=after_calls(answer))
    assert sweep.outcome.kind == "interrupted" and sweep.finished < sweep.cases


@pytest.mark.parametrize("answer", [False, np.bool_(False), None, 0, "", []])
def test_what_is_false_goes_on(answer: object) -> None:
    # A process of its own shows an answer that would end the interpreter.
    code = f"import anholon as an, numpy as np; print(an.load('disc').simulate(to=3000, error_estimate=False, stop=lambda: {'np.bool_(False)' if answer is not False and isinstance(answer, np.bool_) else repr(answer)}).ok)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "True\n"), done.stderr


def test_mistakes_of_stop_and_progress_reach_the_caller(disc: an.Model) -> None:
    with pytest.raises(RuntimeError, match="no truth here"):
        disc.simulate(to=1e6, stop=Broken)
    with pytest.raises(ValueError, match="ambiguous"):
        disc.simulate(to=1e6, stop=lambda: np.array([True, False]))
    with pytest.raises(TypeError, match="not callable"):
        disc.simulate(to=1e6, stop=True)  # type: ignore[arg-type]
    with pytest.raises(RuntimeError, match="no truth here"):
        disc.sweep({"phi'": an.grid(5, 7, 10**6)}, to=1, stop=Broken)
    assert disc.simulate(to=1e3, progress=lambda t, steps: np.bool_(True), error_estimate=False).ok


def stopped(model: an.Model, **options: Any) -> an.Run:
    reached = [0.0]
    return model.simulate(to=1e6, error_estimate=False, progress=lambda t, steps: reached.append(t), stop=lambda: reached[-1] > 5, **options)


@pytest.mark.parametrize("options", [{}, {"every": 1}, {"at": [0.5, 2, 1e6]}, {"dense": True}])
def test_a_stopped_motion_reaches_to_its_last_row(disc: an.Model, options: dict[str, Any]) -> None:
    run = stopped(disc, **options)
    last = float(run.t[-1])
    times = np.array([0.25 * last, 0.5 * last, last])
    for each in (run, pickle.loads(pickle.dumps(run))):
        found = each(times)["theta"]
        assert np.isfinite(found).all()
        np.testing.assert_allclose(found[-1], run["theta"][-1], rtol=1e-10)
        np.testing.assert_allclose(each(run.t)["theta"], run["theta"], rtol=1e-10)
        if "dense" not in options:
            assert np.isnan(each([-1, last + 1, 2 * last])["theta"]).all(), "it has not come there"


def test_a_motion_that_is_stopped_at_its_start_is_there(disc: an.Model) -> None:
    whole = disc.simulate(to=1, at=[0])
    first = an.Run(disc, whole._core, whole.outcome, dataclasses.replace(whole._recipe, cut=True))  # type: ignore[arg-type, type-var]
    for each in (first, pickle.loads(pickle.dumps(first))):
        assert each([0, 1])["theta"][0] == first["theta"][0] and np.isnan(each([0, 1])["theta"][1])
        assert each(0, order=1)["theta"] == first["theta'"][0]


def test_an_interrupted_motion_is_not_computed_to_the_end(disc: an.Model, ctrl_c: CtrlC) -> None:
    ctrl_c(0.3)
    with pytest.raises(an.Interrupted) as interrupted:
        disc.simulate(to=1e6, at=[1, 1e6], error_estimate=False)
    run = interrupted.value.result
    last = float(run.t[-1])
    assert np.isfinite(run(last)["theta"]) and np.isnan(run(last + 1)["theta"])


def test_a_motion_that_stop_let_end_is_made_again_without_it(disc: an.Model) -> None:
    answers = [False]
    run = disc.simulate(to=2, every=1, stop=lambda: answers[0])
    answers[0] = True
    assert np.isfinite(run(1.5)["theta"])


@pytest.mark.parametrize("ending", ["csv", "json", "parquet", "h5"])
def test_ctrl_c_leaves_no_half_of_a_file(disc: an.Model, ctrl_c: CtrlC, tmp_path: pathlib.Path, ending: str) -> None:
    run = disc.simulate(to=100, every=0.001 if ending == "csv" else 0.0005, error_estimate=False, digits=None)
    path = tmp_path / f"run.{ending}"
    path.write_text("the file of before")
    pressed = ctrl_c(0.05)
    try:
        for _ in range(100):
            run.save(path)
    except KeyboardInterrupt:
        assert pressed() < _SOON
    else:
        pytest.fail("it is not interrupted")
    assert [found.name for found in tmp_path.iterdir() if not found.name.startswith(".")] == [path.name]
    assert not [found for found in tmp_path.iterdir() if "part" in found.name]
    run.save(path)
    assert path.stat().st_size > 1000


def test_ctrl_c_in_many_times_and_states(disc: an.Model, ctrl_c: CtrlC) -> None:
    run = disc.simulate(to=10, dense=True)
    times = np.linspace(0, 10, 20_000_000)
    pressed = ctrl_c(0.2)
    with pytest.raises(KeyboardInterrupt):
        for _ in range(100):
            run(times, order=2)
    assert pressed() < _SOON
    f = disc.dynamics()
    states = np.tile(f.start[:, None], 2_000_000)
    pressed = ctrl_c(0.2)
    with pytest.raises(KeyboardInterrupt):
        for _ in range(1000):
            f(0, states)
    assert pressed() < _SOON
    assert np.isfinite(f(0, states[:, :10])).all()
