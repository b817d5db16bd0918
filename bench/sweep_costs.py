#!/usr/bin/env python3
"""What a large sweep in a folder costs: constants measured on this machine, and the times that follow for many cores.

    sweep_costs.py --program build/anholon [--place FOLDER] [--cases 1e9] [--cores 1000] [--bandwidth 1e9] [--case-seconds S]

Measured: CPU time and bytes of a case, the time of a commit (create, write, synchronize, link, unlink) by one and two processes, the time
of `sweep status` for a part, the time of Dask's scheduler for a task. `--place` is the file system that is measured; `--bandwidth` is what
the file system of the cluster writes in a second, which this machine cannot tell. Each row of the table is a number of cases in a part. It
shows the seconds for which each resource is busy; the resource that is busy longest, marked *, bounds the sweep.
"""

import argparse
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor

COMMITS = 400


def sweep(program, folder, cases, chunk):
    """Returns the CPU time of a sweep in a folder, s."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    words = ["sweep", "disc", "--vary", f"phi'=1:7:{cases}", "--to", "3", "--chunk", str(chunk), "--error-estimate", "never", "--quiet"]
    subprocess.run([program, *words, "--threads", "1", "-o", f"{folder}/"], check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def commit(folder, name, text):
    own = f"{folder}/.tmp-{name}"
    file = os.open(own, os.O_WRONLY | os.O_CREAT | os.O_EXCL)
    os.write(file, text)
    os.fsync(file)
    os.close(file)
    os.link(own, f"{folder}/{name}")
    os.unlink(own)
    directory = os.open(folder, os.O_RDONLY)
    os.fsync(directory)
    os.close(directory)


def commits(task):
    folder, first = task
    for k in range(COMMITS):
        commit(folder, str(first + k), b"x" * 4096)


def commits_per_second(place, processes):
    with tempfile.TemporaryDirectory(dir=place) as folder, ProcessPoolExecutor(processes) as pool:
        list(pool.map(abs, range(processes)))  # starts the processes
        begin = time.perf_counter()
        list(pool.map(commits, [(folder, k * COMMITS) for k in range(processes)]))
        return processes * COMMITS / (time.perf_counter() - begin)


def bytes_of(folder):
    return sum(path.stat().st_size for path in pathlib.Path(folder).glob("part-*"))


def scheduler_seconds_per_task():
    """Returns the CPU time of Dask's scheduler for a task such as that of a part; None without Dask."""
    try:
        from distributed import Client, LocalCluster
    except ImportError:
        return None
    tasks = 2000
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None, protocol="tcp://") as cluster, Client(cluster) as client:
        client.gather(client.map(len, [[k] for k in range(100)], pure=False))
        # The scheduler and the client are threads of this process, the worker is a process of its own.
        begin = time.process_time()
        client.gather(client.map(len, [[k] for k in range(tasks)], pure=False))
        return (time.process_time() - begin) / tasks


def measure(program, place):
    known = {}
    with tempfile.TemporaryDirectory(dir=place) as folder:
        few, many = 20_000, 120_000
        base = sweep(program, f"{folder}/few", few, few)
        known["case s"] = (sweep(program, f"{folder}/many", many, many) - base) / (many - few)
        known["case bytes"] = (bytes_of(f"{folder}/many") - bytes_of(f"{folder}/few")) / (many - few)
        known["part bytes"] = bytes_of(f"{folder}/few") - few * known["case bytes"]
        parts = 2000
        sweep(program, f"{folder}/small", 2 * parts, 2)
        begin = time.perf_counter()
        subprocess.run([program, "sweep", "status", f"{folder}/small/"], check=True, stdout=subprocess.DEVNULL)
        known["status s"] = (time.perf_counter() - begin) / parts
    known["commits/s, 1 process"] = commits_per_second(place, 1)
    known["commits/s, 2 processes"] = commits_per_second(place, 2)
    known["task s"] = scheduler_seconds_per_task()
    return known


def table(known, arguments):
    case = arguments.case_seconds or known["case s"]
    print(f"{arguments.cases:.0e} cases of {case:.2g} s on {arguments.cores} cores; the file system writes {arguments.bandwidth:.1e} bytes/s")
    print("cases/part      files   GB written   computing s   writing s   committing s   scheduling s   status s")
    for chunk in (10**k for k in range(2, 7)):
        parts = arguments.cases / chunk
        size = arguments.cases * known["case bytes"] + parts * known["part bytes"]
        busy = [
            arguments.cases * case / min(arguments.cores, parts),
            size / arguments.bandwidth,
            parts / known["commits/s, 2 processes"],
            parts * (known["task s"] or 0),
        ]
        cells = [f"{seconds:.3g}" + ("*" if seconds == max(busy) else " ") for seconds in busy]
        row = f"{chunk:10.0e} {parts:10.0e} {size / 1e9:12.0f} {cells[0]:>13} {cells[1]:>11} {cells[2]:>14} {cells[3]:>14}"
        print(f"{row} {parts * known['status s']:10.3g}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True, type=os.path.abspath)
    parser.add_argument("--place", default=".")
    parser.add_argument("--cases", type=float, default=1e9)
    parser.add_argument("--cores", type=int, default=1000)
    parser.add_argument("--bandwidth", type=float, default=1e9)
    parser.add_argument("--case-seconds", type=float)
    arguments = parser.parse_args()
    known = measure(arguments.program, arguments.place)
    for name, value in known.items():
        print(f"{name:24}", "not measured: distributed is missing" if value is None else f"{value:.3g}")
    print()
    table(known, arguments)


if __name__ == "__main__":
    sys.exit(main())
