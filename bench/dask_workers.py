#!/usr/bin/env python3
"""How much faster two workers of Dask compute a sweep in a folder than one.

    dask_workers.py [--cases 400000] [--chunk 20000] [--workers 1,2] [--repeat 3]

Each worker is a process with one thread on this machine, begun and warmed up before the clock runs; a new folder takes the parts. For
each number of workers the table shows the best wall time, the CPU time of the workers and of the scheduler in that run. The speed-up is
the ratio of the wall times. On a machine that computes other things, too, compare the CPU times: they say how much work was done twice.
"""

import argparse
import pathlib
import socket
import subprocess
import sys
import tempfile
import time

import anholon as an
import psutil
from distributed import Client


def address():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp://127.0.0.1:{probe.getsockname()[1]}"


def cpu(process):
    times = psutil.Process(process.pid).cpu_times()
    return times.user + times.system


class Cluster:
    def __init__(self, place, workers):
        self.address = address()
        self.place = place
        self.scheduler = self.begin("scheduler", "--host", self.address, "--no-dashboard")
        self.workers = [self.begin("worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard") for _ in range(workers)]

    def begin(self, kind, *words):
        command = [sys.executable, "-m", "distributed.cli.dask_" + kind, *words]
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self.place)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in [*self.workers, self.scheduler]:
            process.kill()
            process.wait()


def sweep(folder, cases, chunk, client):
    return an.load("disc").sweep({"phi'": an.grid(1, 7, cases)}, to=3, out=folder, chunk=chunk, on=client)


def warm():
    import anholon

    anholon.load("disc").sweep({"phi'": [5, 6]}, to=3)


def measure(place, arguments, workers):
    """Returns wall time, CPU time of the workers and CPU time of the scheduler of the best of several runs."""
    runs = []
    with Cluster(place, workers) as cluster, Client(cluster.address, timeout=60) as client:
        client.wait_for_workers(workers, timeout=60)
        client.run(warm)
        for number in range(arguments.repeat):
            folder = pathlib.Path(place) / f"{workers}-{number}"
            before = sum(map(cpu, cluster.workers)), cpu(cluster.scheduler)
            begin = time.perf_counter()
            done = sweep(folder, arguments.cases, arguments.chunk, client)
            wall = time.perf_counter() - begin
            if not done.complete:
                sys.exit(f"{folder} is not complete")
            runs.append((wall, sum(map(cpu, cluster.workers)) - before[0], cpu(cluster.scheduler) - before[1]))
    return min(runs)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cases", type=int, default=400_000)
    parser.add_argument("--chunk", type=int, default=20_000)
    parser.add_argument("--workers", default="1,2")
    parser.add_argument("--repeat", type=int, default=3)
    arguments = parser.parse_args()
    print("workers   wall s   CPU s of workers   CPU s of scheduler   speed-up")
    first = None
    with tempfile.TemporaryDirectory() as place:
        for workers in map(int, arguments.workers.split(",")):
            wall, work, scheduling = measure(place, arguments, workers)
            first = first or wall
            print(f"{workers:7}  {wall:7.2f}  {work:17.2f}  {scheduling:19.2f}  {first / wall:9.2f}", flush=True)


if __name__ == "__main__":
    main()
