"""Measurements of bench/speed.py in separate processes: the peak, growth with n, start-up, ensembles by one thread and by two."""

import json
import os
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
GROWTH = (4, 8, 16, 32, 64, 128, 256, 500, 1000)
# Ensembles: title -> model of bench/models, options, the variation.
SWEEPS = {"sleigh": ("sleigh", (), "th~uniform(0,1)"), "chain 8": ("chain", ("--set", "n=8"), "th[1]~uniform(0,0.5)")}


def say(*words):
    print(*words, file=sys.stderr, flush=True)


def measure_peak():
    """Measures the peak of a core in GF/s."""
    command = [os.path.join(ROOT, "build", "release", "speed_bench"), "--peak"]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def measure_growth(limit, form):
    """Measures five steps of chains of more and more links, each in a process of its own."""
    rows = []
    for n in GROWTH:
        model = [os.path.join(ROOT, "bench", "models", "chain.toml"), "--set", f"n={n}", *form]
        command = [os.path.join(ROOT, "build", "release", "speed_bench"), *model]
        try:
            done = subprocess.run(command, input="run 1e-12 1 5\n", capture_output=True, text=True, timeout=limit, check=True)
        except subprocess.TimeoutExpired:
            rows.append({"n": n, "failed": f"not in {limit:g} s"})
            break
        except subprocess.CalledProcessError as problem:
            rows.append({"n": n, "failed": problem.stderr.strip() or f"ended with {problem.returncode}"})
            break
        setup, run = map(json.loads, done.stdout.splitlines())
        run.pop("state", None)
        rows.append({"n": n, "setup": setup, "run": run})
        say(f"  chain {n}: " + (run.get("failed") or f"{run['us'] / run['steps']:.0f} us per step, {run['megabytes']:.0f} MB"))
    return rows


def measure_startup(program, repeat=3):
    """Measures the time from the start of a process to its end for each shipped model."""
    listing = json.loads(subprocess.run([program, "models", "--json"], capture_output=True, text=True, check=True).stdout)
    rows = []
    for model in [m["name"] for m in listing]:
        best, code = float("inf"), 0
        for _ in range(repeat):
            begin = time.perf_counter()
            process = subprocess.Popen([program, "simulate", model], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = code = os.waitstatus_to_exitcode(status)
            best = min(best, time.perf_counter() - begin, used.ru_utime + used.ru_stime)
        rows.append({"model": model, "seconds": best, "exit": code})
    return rows


def sweep_seconds(program, sweep, cases, threads):
    """Returns the wall time of a sweep and its time on all cores, s."""
    name, options, vary = sweep
    model = os.path.join(ROOT, "bench", "models", name + ".toml")
    command = [program, "sweep", model, *options, "--vary", vary, "-n", str(cases), "--threads", str(threads), "--quiet"]
    begin = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = code = os.waitstatus_to_exitcode(status)
    if code not in (0, 1):
        raise RuntimeError(f"{' '.join(command)} ended with {code}")
    return time.perf_counter() - begin, used.ru_utime + used.ru_stime


def measure_threads(program, rounds, seconds=3):
    """Measures the same sweep by one thread and by two, in turn, with as many cases as one thread computes in a few seconds."""
    rows = []
    for title, sweep in SWEEPS.items():
        few = 2000
        sweep_seconds(program, sweep, few, 1)  # leaves its machine code in the cache
        cases = int(few * max(1, seconds / sweep_seconds(program, sweep, few, 1)[0]))
        row = {"model": title, "cases": cases, "load": os.getloadavg()[0]}
        for _ in range(rounds):
            for threads in (1, 2):
                wall, cores = sweep_seconds(program, sweep, cases, threads)
                best = row.get(str(threads))
                if not best or wall < best["wall"]:
                    row[str(threads)] = {"wall": wall, "cores": cores}
        rows.append(row)
        say(f"  {title}: two threads {row['1']['wall'] / row['2']['wall']:.2f} times as fast as one")
    return rows
