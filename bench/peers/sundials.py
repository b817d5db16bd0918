#!/usr/bin/env python3
"""Taylor's series against SUNDIALS CVODE and IDA on the same constrained models, from the same stepping program.

    sundials.py [--bench BENCH] [--repeat N] [--json FILE]

Runs bench/second_opinion_bench.cpp (in bench_anholon): times of the integration in CPU microseconds, and its error at the end
against 30 digits, at tolerances from 1e-3 to 1e-14. Prints two Markdown tables: at equal tolerance, and at equal error, where
each side takes its cheapest tolerance that reaches the error.
"""

import argparse
import collections
import json
import os
import subprocess
import sys
import tempfile

LEVELS = ("1e-6", "1e-9", "1e-12")  # levels of tolerance or of error
PEERS = ("cvode", "ida")


def measure(bench, repeat):
    with tempfile.TemporaryDirectory() as scratch:
        out = os.path.join(scratch, "bench.json")
        subprocess.run(
            [bench, "--benchmark_filter=^opinion/", f"--benchmark_out={out}", "--benchmark_out_format=json",
             f"--benchmark_repetitions={repeat}", "--benchmark_min_time=0.05"],
            stdout=subprocess.DEVNULL, check=True,
        )  # fmt: skip
        with open(out, encoding="utf-8") as file:
            return json.load(file)


def best(runs):
    """Returns the fastest runs by model, tolerance and integrator; None for a run that failed."""
    table = collections.defaultdict(lambda: collections.defaultdict(dict))
    for run in runs["benchmarks"]:
        if run["run_type"] != "iteration":
            continue
        _, how, tolerance, model = run["run_name"].split("/", 3)
        cell = table[model.split("/")[-1]][tolerance]
        if run.get("error_occurred"):
            cell.setdefault(how, None)
        elif not cell.get(how) or run["cpu_time"] < cell[how]["us"]:
            cell[how] = {"us": run["cpu_time"], "error": run["error"], "steps": int(run["steps"])}
    return table


def text(run):
    return "fails" if run is None else f"{run['us']:.3g} ({run['error']:.0e}, {run['steps']})"


def ratio(peer, own):
    return "–" if peer is None or own is None else f"{peer['us'] / own['us']:.1f}"


def equal_tolerance(table):
    print("| model | tolerance | Taylor | CVODE | IDA | CVODE / Taylor | IDA / Taylor |\n|---|---|---|---|---|---|---|")
    for model, cells in table.items():
        for level in LEVELS:
            c = cells[level]
            row = [model, level] + [text(c[k]) for k in ("taylor", *PEERS)] + [ratio(c[k], c["taylor"]) for k in PEERS]
            print("| " + " | ".join(row) + " |")


def cheapest(cells, how, error):
    """Returns the tolerance and the run that reach the error in the least time; None if no run reaches the error."""
    good = [(tolerance, c[how]) for tolerance, c in cells.items() if c.get(how) and c[how]["error"] <= error]
    return min(good, key=lambda g: g[1]["us"], default=None)


def equal_error(table):
    print("| model | error | Taylor | CVODE | IDA | CVODE / Taylor | IDA / Taylor |\n|---|---|---|---|---|---|---|")
    for model, cells in table.items():
        for level in LEVELS:
            found = {k: cheapest(cells, k, float(level)) for k in ("taylor", *PEERS)}
            times = [f"{g[1]['us']:.3g} ({g[0]})" if g else "not reached" for g in found.values()]
            ratios = [ratio(found[k] and found[k][1], found["taylor"] and found["taylor"][1]) for k in PEERS]
            print("| " + " | ".join([model, level, *times, *ratios]) + " |")


def main():
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", default=os.path.join(root, "build", "release", "bench_anholon"))
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--json", default="", help="file for the result")
    options = parser.parse_args()
    table = best(measure(options.bench, options.repeat))
    print("Time in microseconds (error, steps):\n")
    equal_tolerance(table)
    print("\nTime in microseconds (tolerance):\n")
    equal_error(table)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(table, file, indent=2)
            file.write("\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
