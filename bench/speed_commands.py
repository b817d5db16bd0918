#!/usr/bin/env python3
"""Whole processes side by side: what a user waits for, from a plain model file to the numbers.

    speed_commands.py [--rounds N] [--only SYSTEM...] [--json FILE]

Each row is one task, done by commands of anholon and by those of others, in turn, round after round; the best wall time
of each counts. Tolerance 1e-12. The others are heyoka's Python and SUNDIALS CVODE (Adams, compiled C++) on equations
reduced by hand, and SciPy's DOP853 with the Python that anholon generates. The bicycle, which nobody has reduced by
hand, meets DOP853 alone. Digits to trust are estimated in the first task, where no other gives any.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time

from speed_processes import ROOT, say

PROGRAM = os.path.join(ROOT, "build", "anholon")
# title -> model of bench/models, links, the value that sweeps vary, the end of one long motion; None for systems without
# equations reduced by hand
SYSTEMS = {
    "Whipple's bicycle": ("whipple", 1, None, None),
    "disc": ("disc", 1, "phi'=6:6.25", 10_000),
    "sleigh": ("sleigh", 1, "th'=0.5:0.75", 10_000),
    "trailers 3": ("trailers", 3, "ph'=0:0.25", 2_000),
    "chain 8": ("chain", 8, "th[8]'=0:0.25", 1_000),
}
CASES = 10_000


def model_of(name, n):
    return [os.path.join(ROOT, "bench", "models", name + ".toml"), *(["--set", f"n={n}"] if n > 1 else [])]


def start_of(name, n):
    """Returns positions and velocities, coordinate by coordinate, as heyoka's side reads them."""
    done = subprocess.run(
        [PROGRAM, "simulate", *model_of(name, n), "--at", "0", "--to", "0.001", "--json", "--quiet"], capture_output=True, text=True, check=True
    )
    run = json.loads(done.stdout)
    row = dict(zip(run["columns"], run["rows"][0], strict=True))
    names = [c for c in run["columns"][1:] if "'" not in c and not re.match(r"(lambda|N)\.", c)]
    return [row[c + d] for c in names if c + "'" in row for d in ("", "'")]


def tasks_of(title, folder):
    """Returns the tasks of a system by title: the command of Anholon, and command and environment of each peer by name."""
    name, n, vary, long = SYSTEMS[title]
    model = model_of(name, n)
    peer = [os.path.join(ROOT, "build", "peers", "bin", "python"), os.path.join(ROOT, "bench", "peers", "heyoka_process.py"), name, str(n)]
    simulate = [PROGRAM, "simulate", *model, "--tolerance", "1e-12", "--quiet"]
    sweep = [PROGRAM, "sweep", *model, "--tolerance", "1e-12", "--to", "10", "--quiet", "--vary", f"{vary}:{CASES}"]
    file = lambda ending: os.path.join(folder, "rows" + ending)  # noqa: E731
    generated = file(".py")
    with open(generated, "w", encoding="utf-8") as module:
        subprocess.run([PROGRAM, "derive", *model, "--format", "python"], stdout=module, check=True)
    scipy = os.path.join(ROOT, "bench", "peers", "scipy_process.py")
    peers = {"SciPy DOP853": ([peer[0], scipy, generated, "10", "0.1", file(".txt")], {})}
    if long:
        peers["heyoka"] = ([*peer, "rows", "10", "0.1", file(".txt")], {})
    yield "one motion to t = 10, all rows, digits to trust", [*simulate, "--to", "10", "-o", file(".csv")], peers
    if not long:
        return
    cvode = [os.path.join(ROOT, "build", "release", "cvode_adams"), name, str(n), str(long)]
    yield f"to t = {long}, last row", [*simulate, "--to", str(long), "--at", str(long), "-o", file(".csv")], {
        "heyoka": ([*peer, "last", str(long)], {}),
        "CVODE": (cvode, {}),
    }
    rows = [*simulate, "--to", str(long), "--every", str(long / 100_000)]
    yield f"to t = {long}, 100 000 rows as text", [*rows, "-o", file(".csv")], {
        "heyoka, savetxt": ([*peer, "rows", str(long), str(long / 100_000), file(".txt")], {})
    }
    yield f"to t = {long}, 100 000 rows binary", [*rows, "-o", file(".h5")], {
        "heyoka, save": ([*peer, "rows", str(long), str(long / 100_000), file(".npy")], {})
    }
    for threads in (1, 2):
        yield f"{CASES} motions to t = 10, threads: {threads}", [*sweep, "--threads", str(threads), "-o", file(".csv")], {
            "ensemble_propagate_until": ([*peer, "ensemble", "10", str(CASES)], {"TBB_NUM_THREADS": str(threads)}),
            "batch loop": ([*peer, "batch", "10", str(CASES)], {"HEYOKA_PROCESSES": str(threads)}),
        }


def said_to(peer, start):
    """Returns the standard input of a peer: the initial state, and for CVODE's worker also the request for one run."""
    return "".join(f"{x!r}\n" for x in start) + f"run {1e-12} 0\n" if peer == "CVODE" else json.dumps(start)


def seconds(command, start="", environment=None):
    begin = time.perf_counter()
    # Anholon keeps no machine code on disk here, nor does heyoka.
    environment = {**os.environ, "ANHOLON_CACHE": "", **(environment or {})}
    done = subprocess.run(command, input=start, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, env=environment, check=False)
    took = time.perf_counter() - begin
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)} ended with {done.returncode}: {done.stderr.strip()[-300:]}")
    return took


def measure_commands(systems, rounds, peers):
    """Returns rows by system: task, seconds of Anholon, seconds of each peer."""
    result = {}
    for title in systems:
        start = start_of(*SYSTEMS[title][:2])
        with tempfile.TemporaryDirectory() as folder:
            rows = []
            for task, ours, others in tasks_of(title, folder):
                row = {"task": task, "ours": float("inf"), "peers": dict.fromkeys(others if peers else (), float("inf"))}
                for _ in range(rounds):
                    row["ours"] = min(row["ours"], seconds(ours))
                    for name, (command, environment) in others.items() if peers else ():
                        row["peers"][name] = min(row["peers"][name], seconds(command, said_to(name, start), environment))
                rows.append(row)
                say(f"  {title}, {task}: {row['ours']:.3f} s; " + ", ".join(f"{k} {v:.3f} s, {v / row['ours']:.2f}" for k, v in row["peers"].items()))
        result[title] = rows
    return result


def markdown(result):
    text = "| system | task | anholon | peer | its time | peer / anholon |\n|---|---|---|---|---|---|\n"
    for title, rows in result.items():
        for row in rows:
            for name, took in row["peers"].items() or [("", float("nan"))]:
                text += f"| {title} | {row['task']} | {row['ours']:.3f} s | {name} | {took:.3f} s | {took / row['ours']:.2f} |\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--only", nargs="+", choices=SYSTEMS, default=list(SYSTEMS))
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--json", default=os.path.join(ROOT, "build", "bench-commands.json"))
    options = parser.parse_args()
    result = measure_commands(options.only, options.rounds, not options.no_peers)
    with open(options.json, "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
    print(markdown(result))
    return 0


if __name__ == "__main__":
    sys.exit(main())
