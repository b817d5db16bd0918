"""Motions and sweeps with contacts."""

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
    with pytest.raises(an.ModelError, match="linearize knows no contacts"):
        an.load("bead-in-hoop").linearize()
    with pytest.raises(an.ModelError, match="prove knows no contacts"):
        an.load("bead-in-hoop").prove()
