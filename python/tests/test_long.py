"""What takes minutes: ``./dev long`` sets ANHOLON_LONG."""

import os
import resource

import anholon as an
import pytest
from test_arrays import memory

pytestmark = pytest.mark.skipif(not os.environ.get("ANHOLON_LONG"), reason="only under ./dev long")


def test_a_hundred_million_numbers_are_held_once() -> None:
    size, relative = memory("4400")
    assert size > 100_000_000
    assert relative < 1.1


def test_a_hundred_thousand_simulations_do_not_grow() -> None:
    model = an.load("chaplygin-sleigh")

    def rounds(count: int) -> None:
        for k in range(count):
            # A new initial value each time: systems that were prepared are forgotten, too.
            run = model.simulate(to=0.01, initial={"theta": k % 1000 / 1000}, error_estimate=False)
            assert run.ok and run.q.shape[0] == len(run)

    rounds(2000)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    rounds(100_000)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20_000, "kB"
