#!/usr/bin/env python3
"""The speed table: motions from plain model files against heyoka, odeint and CVODE on equations reduced by hand.

    speed.py [--only NAME...] [--rounds N] [--seconds S] [--jit-limit S] [--form NAME] [--no-batch] [--no-growth] [--no-startup]
             [--no-commands]
             [--json FILE] [--markdown FILE] [--write RESULTS.md]

One process per side and system answers to requests (bench/speed_bench.cpp, bench/peers);
they are asked in turn, on the core that is idle, round after round. A time is the smaller of wall time and time on the core; the
median of the motions of a round, and the best of the rounds, which was disturbed least; for every side alike. heyoka is installed
into build/peers from PyPI, and left out with a line if that fails. What it compiled stays in build/peers/cache, with the seconds
that took the first time: the first run lasts some ten minutes longer than the others.

Errors: largest |x - x_ref| / (1 + |x_ref|) of positions and velocities at the end. The reference is an extrapolation in __float128
of the equations reduced by hand (twice, in 100 and 200 steps), compared with anholon's own motion in 32 digits where that is short.
That of neighbours in the lanes of a kernel: our motions in long double, the worst lane.
"""

import argparse
import json
import os
import platform
import re
import subprocess
import sys
import time
from decimal import Decimal

import speed_commands
import speed_report
from speed_processes import ROOT, measure_growth, measure_peak, measure_startup, measure_threads, say

PEERS = os.path.join(ROOT, "build", "peers")
HEYOKA = "heyoka==7.13.2"
SYSTEMS = {
    "sleigh": ("sleigh", 1), "disc": ("disc", 1), "trailers 3": ("trailers", 3), "trailers 10": ("trailers", 10),
    **{f"chain {n}": ("chain", n) for n in (4, 8, 16, 32, 64)},
}  # fmt: skip
LEVELS = (1e-6, 1e-9, 1e-12, 1e-15)
OWN_LEVELS = tuple(10.0**-k for k in range(4, 18))
ODEINT_LEVELS = tuple(10.0**-k for k in range(5, 17))
CVODE = ("adams", "bdf")
CVODE_LEVELS = tuple(10.0**-k for k in range(4, 14))
# Systems that are measured in lanes, too, and the coordinate in whose initial value their motions differ.
BATCHED = {
    "sleigh": "th", "disc": "theta", "trailers 3": "th[1]", "trailers 10": "th[1]",
    **{f"chain {n}": "th[1]" for n in (4, 8, 16)},
}  # fmt: skip
BATCH_LEVELS = LEVELS[:3]
OWN_BATCH_LEVELS = tuple(10.0**-k for k in range(5, 15))
OWN_REFERENCE = 16  # up to so many links and trailers, Anholon's motion in 32 digits is compared, too


class Worker:
    """A process that answers each line by a line of JSON."""

    def __init__(self, command, **options):
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, **options)

    def tell(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def answer(self):
        line = self.process.stdout.readline()
        if not line:
            return {"failed": f"the process ended with {self.process.wait()}"}
        return json.loads(line)

    def ask(self, *words):
        self.tell(" ".join(str(w) for w in words))
        return self.answer()

    def ask_json(self, *words):
        self.tell(json.dumps(words))
        return self.answer()

    def pin(self, cpu):
        os.sched_setaffinity(self.process.pid, {cpu})

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def idle_cpu(seconds=0.1):
    """Returns the core that was idle most in the last moment."""

    def rest():
        with open("/proc/stat", encoding="ascii") as file:
            return {int(w[0][3:]): int(w[4]) for w in map(str.split, file) if re.fullmatch(r"cpu\d+", w[0])}

    before = rest()
    time.sleep(seconds)
    after = rest()
    return max(sorted(os.sched_getaffinity(0)), key=lambda cpu: after[cpu] - before[cpu])


def error(state, exact):
    """Returns the error of a state. It computes in decimals, as a difference of doubles has rounding errors of the same size."""
    return max(float(abs(Decimal(x) - Decimal(y)) / (1 + abs(Decimal(y)))) for x, y in zip(state, exact, strict=True))


# ---- peers ----------------------------------------------------------------------------------------


def install_heyoka():
    """Returns the Python that has heyoka; if the installation fails, prints why and returns None."""
    python = os.path.join(PEERS, "bin", "python")
    try:
        if not os.path.exists(python):
            subprocess.run(["/usr/bin/python3", "-m", "venv", PEERS], check=True, capture_output=True, text=True)
        if subprocess.run([python, "-c", "import heyoka"], capture_output=True, check=False).returncode != 0:
            say(f"installing {HEYOKA} into {PEERS}")
            subprocess.run([python, "-m", "pip", "install", "-q", HEYOKA, "numpy"], check=True, capture_output=True, text=True, timeout=300)
        return python
    except (OSError, subprocess.SubprocessError) as problem:
        why = (getattr(problem, "stderr", None) or str(problem)).strip().splitlines()
        say(f"heyoka skipped: {why[-1] if why else problem}")
        return None


class Heyoka:
    """heyoka on one system: the modes that compile in the time allowed, of which the best is chosen for each tolerance."""

    def __init__(self, python, name, n, end, start, jit_limit):
        environment = {**os.environ, "HEYOKA_CACHE_DIR": os.path.join(PEERS, "cache")}
        command = [python, os.path.join(ROOT, "bench", "peers", "heyoka_worker.py"), name, str(n), repr(end)]
        self.worker, self.second = (Worker(command, env=environment) for _ in range(2))
        for w in (self.worker, self.second):
            w.tell(json.dumps([float(x) for x in start]))
        about = self.worker.ask_json("modes")
        self.modes, self.version = about["modes"], about["version"]
        self.limit, self.expected, self.skipped = jit_limit, {}, []

    def limit_of(self, mode):
        """Returns the time allowed for compiling a mode. Long compilation hardly ever pays without fast math."""
        return self.limit if "compact" in mode or "fast" in mode else self.limit / 30

    def affordable(self, tolerance, mode):
        """True if a mode is expected to compile in the time allowed: about 2.5 times as long as at the tolerance before."""
        if self.expected.get(mode, 0) > self.limit_of(mode):
            self.skipped.append((tolerance, mode))
            return False
        return True

    def looks_at(self, modes, *request):
        """Measures each mode for a short time. Returns the best mode, or None, and the times by mode."""
        looks = {}
        for mode in modes:
            command, tolerance, *others = request
            look = min((self.worker.ask_json(command, tolerance, mode, *others, 0.03) for _ in range(2)), key=lambda r: r.get("us", 0))
            if "failed" in look:
                say(f"  heyoka, {command}, {mode}: {look['failed']}")
                continue
            looks[mode] = {"us": look["us"], "jit": look["jit"]}
        return min(looks, key=lambda m: looks[m]["us"], default=None), looks

    def choose(self, tolerance):
        best, looks = self.looks_at([m for m in self.modes if self.affordable(tolerance, m)], "run", tolerance)
        for mode, look in looks.items():
            self.expected[mode] = 2.5 * look["jit"]
        if best:
            looks[best]["again"] = self.second.ask_json("compile", tolerance, best).get("now")  # from the cache on the disk
        return best, looks

    def choose_batch(self, tolerance, looks, starts):
        """Chooses the best mode for batches, of those that compile one motion in the time allowed: a batch compiles about as long."""
        return self.looks_at([m for m, look in looks.items() if look["jit"] <= self.limit_of(m)], "batch", tolerance, starts)


# ---- one system -----------------------------------------------------------------------------------


def better(old, new, state):
    """Returns the better of two cells, that of the round that was disturbed least."""
    if "failed" in new:
        return old or {"failed": new["failed"]}
    new = {**new, "error": error(new.pop("state"), state)}
    return new if not old or "failed" in old or new["us"] < old["us"] else old


def reference(odeint, own, n):
    coarse, fine = odeint.ask("exact", 100), odeint.ask("exact", 200)
    found = {"state": fine["state"], "change": error(coarse["state"], fine["state"]), "own": None}
    if n <= OWN_REFERENCE:
        own_end = own.ask("exact", 22)
        found["own"] = None if "failed" in own_end else error(own_end["state"], fine["state"])
    return found


def measure(title, python, options):
    name, n = SYSTEMS[title]
    build = os.path.join(ROOT, "build", "release")
    model = [os.path.join(ROOT, "bench", "models", name + ".toml"), *(["--set", f"n={n}"] if n > 1 else []), *options.form]
    cold = [Worker([os.path.join(build, "speed_bench"), *model]) for _ in range(3)]
    ready = [w.answer() for w in cold]
    for w in cold[1:]:
        w.close()
    own, setup = cold[0], min(ready, key=lambda r: r["read"] + r["scenario"] + r["program"])
    start = own.ask("start")["state"]

    variants = {}
    for variant in ("strict", "fast"):
        w = Worker([os.path.join(build, "odeint_" + variant), name, str(n), repr(setup["end"])])
        w.tell("\n".join(start))
        variants[variant] = w
    exact = reference(variants["strict"], own, n)
    cvode = {method: Worker([os.path.join(build, "cvode_" + method), name, str(n), repr(setup["end"])]) for method in CVODE}
    for w in cvode.values():
        w.tell("\n".join(start))
    flags = min(variants, key=lambda v: variants[v].ask("run", 1e-9, 0.05)["us"])
    odeint = variants[flags]

    cells = {"own": {}, "odeint": {}, "heyoka": {}, **{method: {} for method in CVODE}}
    result = {"setup": setup, "reference": {k: v for k, v in exact.items() if k != "state"}, "odeint_flags": flags, "cells": cells}
    workers, modes, heyoka = [own, *variants.values(), *cvode.values()], {}, None
    if python:
        heyoka = Heyoka(python, name, n, setup["end"], start, options.jit_limit)
        workers.append(heyoka.worker)
        result["heyoka_version"] = heyoka.version
        result["heyoka_modes"] = {}
        for level in LEVELS:
            best, result["heyoka_modes"][repr(level)] = heyoka.choose(level)
            if best:
                modes[level] = best
        result["heyoka_skipped"] = heyoka.skipped
        heyoka.second.close()
    requests = [("own", level, lambda level=level: own.ask("run", level, options.seconds)) for level in OWN_LEVELS]
    requests += [("odeint", level, lambda level=level: odeint.ask("run", level, options.seconds)) for level in ODEINT_LEVELS]
    requests += [(m, level, lambda m=m, level=level: cvode[m].ask("run", level, options.seconds)) for m in CVODE for level in CVODE_LEVELS]
    for level, mode in modes.items():
        requests.append(("heyoka", level, lambda level=level, mode=mode: heyoka.worker.ask_json("run", level, mode, options.seconds)))
    take_turns(requests, workers, cells, exact["state"], options.rounds, modes)
    if title in BATCHED and not options.no_batch:
        result["batch"] = measure_batch(title, own, heyoka, result.get("heyoka_modes"), options)
    for w in workers:
        w.close()
    return result


def take_turns(requests, workers, cells, exact, rounds, modes):
    """Makes each request in each round, on the core that is idle at the time."""
    requests.sort(key=lambda r: (-r[1], r[0]))  # both sides of a cell follow each other
    for _ in range(rounds):
        cpu = idle_cpu()
        for w in workers:
            w.pin(cpu)
        for side, level, run in requests:
            cell = run()
            if side == "heyoka" and "failed" not in cell:
                cell["mode"] = modes[level]
            cells[side][repr(level)] = better(cells[side].get(repr(level)), cell, exact)


# ---- ensembles ------------------------------------------------------------------------------------


def measure_batch(title, own, heyoka, single_modes, options):
    """Measures neighbouring motions in the lanes of one core: times, steps and expansions of a trajectory, and the largest error."""
    lanes = own.ask("lanes", BATCHED[title])
    cells = {"own": {}, "heyoka": {}}
    if "failed" in lanes:
        say(f"  ensemble: {lanes['failed']}")
        return {"cells": cells}
    starts = [[float(x) for x in start] for start in lanes["starts"]]
    requests = [("own", level, lambda level=level: own.ask("batch", level, options.seconds, BATCHED[title])) for level in OWN_BATCH_LEVELS]
    modes = {}
    for level in BATCH_LEVELS if heyoka else ():
        mode, _ = heyoka.choose_batch(level, single_modes[repr(level)], starts)
        if mode:
            modes[level] = mode
            run = lambda level=level, mode=mode: heyoka.worker.ask_json("batch", level, mode, starts, options.seconds)  # noqa: E731
            requests.append(("heyoka", level, run))
    take_turns(requests, [own, *([heyoka.worker] if heyoka else [])], cells, lanes["state"], options.rounds, modes)
    return {"lanes": len(starts), "cells": cells}


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        model = re.search(r"^model name\s*:\s*(.*)$", file.read(), re.MULTILINE)
    compiler = subprocess.run(["g++", "-dumpfullversion"], capture_output=True, text=True, check=False).stdout.strip()
    return {
        "cpu": model[1] if model else platform.machine(), "cores": os.cpu_count(), "load": os.getloadavg()[0],
        "compiler": "g++ " + compiler, "python": platform.python_version(), "date": time.strftime("%Y-%m-%d"),
    }  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="+", choices=SYSTEMS, default=list(SYSTEMS), metavar="NAME")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=0.1, help="of each cell in each round")
    parser.add_argument("--jit-limit", type=float, default=300, help="seconds that one compilation by heyoka may be expected to take")
    parser.add_argument("--form", type=lambda name: ["--form", name], default=[], help="of our equations; as auto chooses without it")
    parser.add_argument("--no-batch", action="store_true", help="leave out ensembles: neighbours in lanes, one thread and two")
    parser.add_argument("--no-growth", action="store_true")
    parser.add_argument("--no-startup", action="store_true")
    parser.add_argument("--no-commands", action="store_true", help="leave out whole commands beside whole processes of heyoka")
    parser.add_argument("--json", default=os.path.join(ROOT, "build", "bench-speed.json"))
    parser.add_argument("--markdown", default=os.path.join(ROOT, "build", "bench-speed.md"))
    parser.add_argument("--write", default="", metavar="RESULTS.md", help="put the tables between its marks there, too")
    options = parser.parse_args()

    begin = time.perf_counter()
    python = install_heyoka()
    result = {"machine": machine(), "rounds": options.rounds, "peak": measure_peak(), "systems": {}}
    for title in options.only:
        result["systems"][title] = measure(title, python, options)
        say(f"{time.perf_counter() - begin:5.0f} s  {title}")
    if not options.no_batch:
        result["threads"] = measure_threads(os.path.join(ROOT, "build", "anholon"), options.rounds)
    if not options.no_growth:
        result["growth"] = measure_growth(300, options.form)
    if not options.no_startup:
        result["startup"] = measure_startup(os.path.join(ROOT, "build", "anholon"))
    if not options.no_commands:
        result["commands"] = speed_commands.measure_commands(list(speed_commands.SYSTEMS), options.rounds, bool(python))
    result["peak"] = {k: max(x, again) for (k, x), again in zip(result["peak"].items(), measure_peak().values())}  # the larger one was disturbed less
    result["seconds"] = time.perf_counter() - begin
    with open(options.json, "w", encoding="utf-8") as file:
        json.dump(result, file, indent=1)
    text = speed_report.markdown(result)
    if "commands" in result:
        text += "\n### Whole commands\n\n" + speed_commands.markdown(result["commands"])
    with open(options.markdown, "w", encoding="utf-8") as file:
        file.write(text)
    if options.write:
        speed_report.put(text, options.write)
    print(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
