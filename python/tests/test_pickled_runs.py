"""Runs that are pickled and sent to another process."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import pickle
from pathlib import Path

import anholon as an
import numpy as np
import pytest


def simulated(speed: float) -> an.Run:
    return an.load("disc").simulate(to=1, every="0.25", initial={"phi'": speed})


def test_a_pool_returns_runs(disc: an.Model) -> None:
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        for speed, run in zip((5.0, 6.0), pool.map(simulated, (5.0, 6.0)), strict=True):
            here = disc.simulate(to=1, every="0.25", initial={"phi'": speed})
            assert run.values.tobytes() == here.values.tobytes()
            assert run.keys() == here.keys() and run.units == here.units and run.outcome.ok


def test_numbers_events_and_report_are_there(tmp_path: Path) -> None:
    run = an.load("stick-slip").simulate(to=1)
    again = pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(run))))
    assert len(again) == len(run) and list(again) == list(run)
    for name in run:
        assert again[name].tobytes() == run[name].tobytes()
    assert not again["t"].flags.writeable and not again.q.flags.writeable
    assert [(e.name, e.t, e.stop, [(c.name, c.before, c.after) for c in e.changes]) for e in again.events] == [(e.name, e.t, e.stop, [(c.name, c.before, c.after) for c in e.changes]) for e in run.events]
    for name in dir(run.report):
        if not name.startswith("_") and name not in ("trust", "watched"):
            assert getattr(again.report, name) == getattr(run.report, name), name
    assert [(w.name, w.first, w.last) for w in again.report.watched] == [(w.name, w.first, w.last) for w in run.report.watched]
    assert repr(again) == repr(run)
    again.save(str(tmp_path / "again.csv"))
    run.save(str(tmp_path / "run.csv"))
    assert (tmp_path / "again.csv").read_bytes() == (tmp_path / "run.csv").read_bytes()


def test_the_rest_is_computed_again(disc: an.Model) -> None:
    run = disc.simulate(to=1, every="0.5", digits=25)
    again = pickle.loads(pickle.dumps(run))
    assert again.exact("theta") == run.exact("theta")
    dense = pickle.loads(pickle.dumps(disc.simulate(to=1, dense=True)))
    assert dense(0.7)["theta"] == disc.simulate(to=1, dense=True)(0.7)["theta"]
    assert "<svg" in dense.figure("theta").svg


def test_runs_that_were_ended_from_outside_keep_their_numbers(disc: an.Model) -> None:
    calls = iter(range(10**9))
    run = disc.simulate(to=1e6, stop=lambda: next(calls) > 2)
    assert run.outcome.kind == "interrupted"
    again = pickle.loads(pickle.dumps(run))
    assert np.array_equal(again.t, run.t)
    with pytest.raises(an.ModelError, match="was stopped from outside"):
        again.json()


def test_runs_that_did_not_begin(disc: an.Model) -> None:
    run = disc.simulate(to=1, initial={"x'": 1, "y'": 2, "psi'": 0, "phi'": 0, "theta'": 0})
    assert not run.outcome.ok
    again = pickle.loads(pickle.dumps(run))
    assert again.outcome.kind == run.outcome.kind and len(again) == 0
