#!/usr/bin/env python3
"""Taylor's series against SUNDIALS CVODE and IDA on the same constrained models, from the same stepping program.

    sundials.py [--bench BENCH] [--repeat N] [--json FILE]

Runs bench/second_opinion_bench.cpp (in bench_anholon) and prints a Markdown table: time of the integration and its error at
the end against 30 digits, at three tolerances, and the ratio of times. Equal tolerance is not equal error, so there is a second
ratio: of SUNDIALS at the loosest tolerance whose error is not above Taylor's at this one.
"""

import argparse
import collections
import json
import os
import subprocess
import sys
import tempfile

TOLERANCES = ("1e-6", "1e-9", "1e-12")
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
    """model -> tolerance -> integrator -> the fastest run, or None where it failed."""
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
    return "–" if peer is None else f"{peer['us'] / own['us']:.0f}"


def at_equal_error(cells, peer, own):
    """The cheapest run of the peer that is at least as exact; none: it does not get there."""
    good = [c[peer] for c in cells.values() if c.get(peer) and c[peer]["error"] <= own["error"]]
    return min(good, key=lambda c: c["us"], default=None)


def main():
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", default=os.path.join(root, "build", "release", "bench_anholon"))
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--json", default="", help="file for the result")
    options = parser.parse_args()
    table = best(measure(options.bench, options.repeat))
    print("| model | tolerance | Taylor | CVODE | IDA | CVODE / Taylor | IDA / Taylor | at Taylor's error: CVODE | IDA |")
    print("|---|---|---|---|---|---|---|---|---|")
    for model, cells in table.items():
        for tolerance in TOLERANCES:
            c = cells[tolerance]
            row = [model, tolerance, text(c["taylor"])] + [text(c[p]) for p in PEERS]
            row += [ratio(c[p], c["taylor"]) for p in PEERS]
            row += [ratio(at_equal_error(cells, p, c["taylor"]), c["taylor"]) for p in PEERS]
            print("| " + " | ".join(row) + " |")
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(table, file, indent=2)
            file.write("\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
