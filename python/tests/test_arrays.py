"""The arrays of a run: views, their lifetime, names and units, and their memory."""

import gc
import subprocess
import sys

import anholon as an
import numpy as np
import pytest

# Together the models have many bodies, events, outputs, a servo constraint of order 3, and units.
MODELS = ["disc", "whipple", "snakeboard", "luo-zhao-example-2", "tether-by-servo", "roller-racer"]


def short(name: str) -> an.Run:
    return an.load(name).simulate(to="0.01", every="0.005", error_estimate=False)


@pytest.mark.parametrize("name", MODELS)
def test_groups_of_columns_are_views(name: str) -> None:
    run = short(name)
    everything = run.values
    assert everything.shape == (len(run), len(run.columns)) and not everything.flags.owndata and not everything.flags.writeable
    for k, column in enumerate(run):
        assert everything[:, k].ctypes.data == run[column].ctypes.data, "no copy is made"
        np.testing.assert_array_equal(everything[:, k], run[column])
    for kind, group in (("coordinates", run.q), ("velocities", run.qdot), ("accelerations", run.qddot), ("multipliers", run.lam)):
        names = [column.name for column in run.columns if column.kind == kind]
        assert group.shape == (len(run), len(names))
        for k, column in enumerate(names):
            assert group[:, k].ctypes.data == run[column].ctypes.data, f"{kind} are views"
    assert [column.name for column in run.columns if column.kind == "coordinates"] == [c.name for c in run.model.coordinates]


def test_a_group_keeps_its_numbers_alive(disc: an.Model) -> None:
    run = disc.simulate(to=1, every="0.1", error_estimate=False)
    q, expected = run.q, run.q.copy()
    del run
    gc.collect()
    np.testing.assert_array_equal(q, expected)
    with pytest.raises(ValueError):
        q[0, 0] = 1


def test_no_rows_are_no_numbers(disc: an.Model) -> None:
    run = disc.simulate(to=1, initial={"x'": 1, "phi'": 6, "psi": 0})
    assert len(run) == 0 and run.q.shape == (0, 0) and run.values.size == 0


def test_other_libraries_read_by_dlpack(disc: an.Model) -> None:
    run = disc.simulate(to=1, every="0.1", error_estimate=False)
    for array in (run["theta"], run.q):
        taken = np.from_dlpack(array)
        assert taken.ctypes.data == array.ctypes.data and not taken.flags.writeable
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    np.testing.assert_array_equal(np.asarray(jax.numpy.asarray(run["theta"])), run["theta"])


def test_names_and_units_go_along() -> None:
    run = an.load("roller-racer").simulate(to="0.1", every="0.05", error_estimate=False)
    assert run.units["x'"] == "m/s" and run.units["t"] == "s"
    assert run.long_names["x'"] == "rate of x" and run.long_names["t"] == "time"
    symbols = {column.name: (column.latex, column.mathml) for column in run.columns}
    assert symbols["x'"] == (r"\dot{x}", '<mover><mi>x</mi><mo stretchy="false" scriptlevel="+0">˙</mo></mover>')
    pandas = pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert isinstance(frame, pandas.DataFrame)
    assert frame.attrs["units"] == run.units and frame.attrs["long_names"] == run.long_names
    pytest.importorskip("xarray")
    data = run.to_xarray()
    assert data["x'"].attrs == {"units": "m/s", "long_name": "rate of x"} and data["t"].attrs["units"] == "s"


# Prints the peak memory of one run, which has a process of its own, since the peak belongs to the whole process.
MEMORY = """
import resource, sys
import anholon as an, numpy as np

def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

model = an.load("disc")
model.simulate(to=1, every="0.01", error_estimate=False).q.sum()
before = peak()
run = model.simulate(to=sys.argv[1], every="0.001", error_estimate=False)
assert run.ok, run.outcome
total = sum(float(run[name].sum()) for name in run) + float(run.q.sum()) + float(run.lam.max())
table = run.values
assert np.isfinite(total) and table.size == len(run) * len(run.columns)
print(table.size, (peak() - before) * 1024 / table.nbytes)
"""


def memory(to: str) -> tuple[int, float]:
    """Returns the count of the numbers of a run of the disc to a time, and the peak memory over their size."""
    done = subprocess.run([sys.executable, "-c", MEMORY, to], capture_output=True, text=True, check=True)
    size, relative = done.stdout.split()
    return int(size), float(relative)


def test_ten_million_numbers_are_held_once() -> None:
    size, relative = memory("440")
    assert size > 10_000_000
    # Columns are moved one at a time, of 23; steps and interpreter need some more memory.
    assert relative < 1.25
