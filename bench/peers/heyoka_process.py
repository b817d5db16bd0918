#!/usr/bin/env python3
"""One task of a user, done with heyoka from the start of the process to its end; for bench/speed_commands.py.

    heyoka_process.py SYSTEM N TASK      the state at the start as in heyoka_worker.py, on standard input

    last TIME             the state at TIME
    rows TIME EVERY FILE  rows at this interval: text with 17 digits (numpy.savetxt), or what they are in memory (.npy)
    ensemble TIME CASES   many motions, one coordinate spread, by ensemble_propagate_until
    batch TIME CASES      the same in the lanes of taylor_adaptive_batch, by a loop written by hand, in two processes if
                          HEYOKA_PROCESSES=2

Prints the last state of the first motion as JSON. Nothing is kept on disk: each process compiles.
"""

import json
import multiprocessing
import os
import sys

import heyoka as hy
import numpy as np
from heyoka_worker import Worker

hy.llvm_state.set_diskcache_enabled(False)

TOLERANCE = 1e-12
SPREAD = 0.25
LANES = 8 if "avx512f" in open("/proc/cpuinfo", encoding="ascii").read() else 4


def make(worker):
    return hy.taylor_adaptive(worker.equations, worker.start, tol=TOLERANCE, fast_math=True)


def last(worker, time):
    ta = make(worker)
    ta.propagate_until(float(time))
    return ta.state


def rows(worker, time, every, file):
    ta = make(worker)
    grid = np.linspace(0.0, float(time), round(float(time) / float(every)) + 1)
    table = np.column_stack([grid, ta.propagate_grid(grid)[-1]])
    np.save(file, table) if file.endswith(".npy") else np.savetxt(file, table, fmt="%.17g", delimiter=",")
    return table[-1, 1:]


def spread(worker, cases):
    """Returns initial states that differ in the last velocity."""
    starts = np.repeat(worker.start[:, None], cases, axis=1)
    starts[-1] += np.linspace(0.0, SPREAD, cases)
    return starts


def ensemble(worker, time, cases):
    starts = spread(worker, int(cases))
    ta = make(worker)

    def begin(ta, k):
        ta.time = 0.0
        ta.state[:] = starts[:, k]
        return ta

    done = hy.ensemble_propagate_until(ta, float(time), int(cases), begin)
    return np.array([one[0].state for one in done])[0]


def in_lanes(worker, time, starts):
    ta = hy.taylor_adaptive_batch(
        worker.equations, np.repeat(worker.start[:, None], LANES, axis=1), tol=TOLERANCE, fast_math=True, force_avx512=LANES == 8
    )
    ends = np.empty_like(starts)
    for k in range(0, starts.shape[1], LANES):
        some = starts[:, k : k + LANES]
        ta.set_time(0.0)
        ta.state[:, : some.shape[1]] = some
        ta.propagate_until(float(time))
        ends[:, k : k + LANES] = ta.state[:, : some.shape[1]]
    return ends


def batch(worker, time, cases):
    starts = spread(worker, int(cases))
    if os.environ.get("HEYOKA_PROCESSES", "1") == "1":
        return in_lanes(worker, time, starts)[:, 0]
    with multiprocessing.get_context("fork").Pool(2) as pool:
        ends = pool.starmap(in_lanes, [(worker, time, half) for half in np.array_split(starts, 2, axis=1)])
    return ends[0][:, 0]


def main():
    name, n, task, *words = sys.argv[1:]
    worker = Worker(name, int(n), 0.0, json.load(sys.stdin))
    print(json.dumps([float(x) for x in globals()[task](worker, *words)]))


if __name__ == "__main__":
    main()
