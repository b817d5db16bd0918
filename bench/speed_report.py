"""The Markdown report on measurements of bench/speed.py: at equal tolerance, at equal error, and against the goals."""

import math

from speed_cells import LEVELS, cell_text, equal_error, least_error, number, per_step, ratio, span, table, time_at, verdict
from speed_ensembles import ensembles, ensembles_of, gain_by_threads, gigaflops, lanes_checked, peak_parts, threads, vector_peak

BEGIN, END = "<!-- speed: begin (bench/speed.py --write) -->", "<!-- speed: end -->"
SMALL = ("sleigh", "disc", "trailers 3")
CHAINS = tuple(f"chain {n}" for n in (4, 8, 16, 32, 64))
# (name, systems, peer, {level: least ratio of times at equal error}); ENSEMBLE_GOALS are for motions in the lanes of one core
GOALS = [
    ("small systems against heyoka", SMALL, "heyoka", {"1e-06": 1.0, "1e-09": 1.2, "1e-12": 1.4, "1e-15": 1.4}),
    ("trailers 10 against heyoka", ("trailers 10",), "heyoka", dict.fromkeys(LEVELS, 1.5)),
    ("chains against heyoka", CHAINS, "heyoka", {"1e-06": 1.5, "1e-09": 4.0, "1e-12": 8.0}),
    ("against odeint", (*SMALL, "trailers 10", *CHAINS), "odeint", {"1e-06": 1.0, "1e-12": 3.0}),
    ("against CVODE, Adams", (*SMALL, "trailers 10", *CHAINS), "adams", dict.fromkeys(LEVELS[:3], 10.0)),
    ("against CVODE, BDF", (*SMALL, "trailers 10", *CHAINS), "bdf", dict.fromkeys(LEVELS[:3], 10.0)),
]
ENSEMBLE_GOALS = [
    ("ensembles: small systems against heyoka's batch", SMALL, "heyoka", dict.fromkeys(LEVELS[:3], 1.5)),
    ("ensembles: chains against heyoka's batch", CHAINS, "heyoka", dict.fromkeys(LEVELS[:3], 4.0)),
]
# (name, systems, least part of the vector peak, at the best tolerance)
PEAK_GOALS = [("small systems", SMALL, 0.5), ("large systems", ("trailers 10", *CHAINS), 0.3)]
THREADS_GOAL = 1.9


def times(result):
    rows = []
    for title, s in result["systems"].items():
        for level in LEVELS:
            own, heyoka, odeint = (s["cells"][side].get(level) for side in ("own", "heyoka", "odeint"))
            equal = heyoka["us"] / own["us"] if heyoka and own and "us" in heyoka and "us" in own else None
            rows.append([
                title, level, cell_text(own), cell_text(heyoka), cell_text(odeint), per_step(own), per_step(heyoka),
                number(equal), *(ratio(equal_error(s, peer, level)) for peer in ("heyoka", "odeint", "adams", "bdf")),
            ])  # fmt: skip
    return table(
        ["system", "tolerance", "anholon, us (error)", "heyoka", "odeint", "us per step: anholon", "heyoka",
         "heyoka / anholon, equal tolerance", "equal error", "odeint / anholon", "CVODE Adams / anholon", "CVODE BDF / anholon"], rows,
    )  # fmt: skip


def goals_of(goals, systems):
    """Returns rows of the table of goals. `systems` maps titles to objects with cells."""
    rows = []
    for what, titles, peer, levels in goals:
        there = [t for t in titles if t in systems]
        for level, least in levels.items():
            found = {t: equal_error(systems[t], peer, level) for t in there if systems[t]["cells"].get(peer, {}).get(level)}
            if not found:
                continue
            reached = [r for r in found.values() if r is not None]
            judged = verdict({t: (r, r is not None and r >= least) for t, r in found.items()})
            rows.append([what, level, f"≥ {least:g}", span(reached), judged])
    return rows


def goals(result):
    rows = goals_of(GOALS, result["systems"]) + goals_of(ENSEMBLE_GOALS, ensembles_of(result))
    for what, titles, least in PEAK_GOALS:
        parts = {t: max(peak_parts(result, b), default=0) for t, b in ensembles_of(result).items() if t in titles}
        if any(parts.values()):
            judged = verdict({t: (100 * p, p >= least) for t, p in parts.items()})
            reached = span([100 * p for p in parts.values()])
            rows.append([f"ensembles: {what}, percent of the vector peak", "the best", f"≥ {100 * least:g}", reached, judged])
    if gains := {r["model"]: gain_by_threads(r) for r in result.get("threads", [])}:
        rows.append(["ensembles: two threads against one", "", f"≥ {THREADS_GOAL:g}", span(list(gains.values())),
                     verdict({m: (g, g >= THREADS_GOAL) for m, g in gains.items()})])  # fmt: skip
    floors, compared = [], False
    for title, s in result["systems"].items():
        own, heyoka = least_error(s["cells"]["own"]), least_error(s["cells"]["heyoka"])
        compared = compared or math.isfinite(heyoka)
        if math.isfinite(heyoka) and own > heyoka:
            floors.append(f"{title} {own:.0e} > {heyoka:.0e}")
    if compared:
        rows.append(["least error of all tolerances", "", "≤ heyoka's", "", "met" if not floors else "missed: " + ", ".join(floors)])
    return table(["goal", "tolerance of the peer", "ratio", "measured", ""], rows)


def flops_per_step(setup, order):
    """Returns the multiplications and additions of a step, estimated from the counts of the program: a product of series of order p has
    (p+1)(p+2)/2 of each, a function counts as two products, a linear slot has an addition per order. Solving is not counted."""
    series = (order + 1) * (order + 2)
    return (setup["products"] + 2 * setup["functions"]) * series + setup["linear"] * (order + 1)


def fractions(result):
    peak = vector_peak(result)
    rows = []
    for title, s in result["systems"].items():
        cell = s["cells"]["own"].get("1e-15")
        if not cell or "failed" in cell or not peak:
            continue
        rate = flops_per_step(s["setup"], cell["order"]) * cell["steps"] / cell["us"] / 1e3  # GF/s
        rows.append([title, cell["order"], number(rate), f"{100 * rate / peak:.1f} %", f"{100 * rate / result['peak']['scalar']:.0f} %"])
    return table(["system", "order", "GF/s", "of the vector peak", "of the scalar peak"], rows)


def setups(result):
    rows = []
    for title, s in result["systems"].items():
        u = s["setup"]
        jit = []
        for level in LEVELS:
            cell = s["cells"]["heyoka"].get(level)
            jit.append(f"{cell['jit']:.2g} ({cell['mode']})" if cell and "jit" in cell else "–")
        looks = [m for looks in s.get("heyoka_modes", {}).values() for m in looks.values()]
        again = [1e3 * m["again"] for m in looks if m.get("again")]
        shortest = min((m["jit"] for m in looks), default=None)
        rows.append([title, *(number(1e3 * u[k]) for k in ("read", "scenario", "program")), *jit, number(shortest),
                     f"{number(min(again))} to {number(max(again))}" if again else "–"])  # fmt: skip
    return table(
        ["system", "read, ms", "equations, start, structure, ms", "program, ms", *(f"heyoka compiles, s: {level}" for level in LEVELS),
         "its shortest", "again, from its disk cache, ms"], rows,
    )  # fmt: skip


def growth(result):
    rows = []
    for r in result.get("growth", []):
        if "failed" in r or "failed" in r["run"]:
            rows.append([r["n"], r.get("failed") or r["run"]["failed"], "", "", ""])
            continue
        setup, run = r["setup"], r["run"]
        step = run["us"] / run["steps"]
        ready = setup["read"] + setup["scenario"] + setup["program"]
        rows.append([r["n"], number(step), number(step / r["n"]), number(1e3 * ready), number(run["megabytes"])])
    return table(["links", "us per step", "per step and link", "made ready, ms", "memory, MB"], rows)


TWINS = {"chaplygin-sleigh": "sleigh", "disc": "disc", "trailers": "trailers 3", "chain": "chain 4"}  # shipped models with a system above


def compilation(system, level="1e-12"):
    """Returns the shortest compilation time of heyoka at the default tolerance of `simulate`."""
    return min((m["jit"] for m in system.get("heyoka_modes", {}).get(level, {}).values()), default=None)


def startup(result):
    rows = sorted(result.get("startup", []), key=lambda r: r["seconds"])
    if not rows:
        return "not measured."
    ms = [1e3 * r["seconds"] for r in rows]
    text = f"{len(rows)} models, {number(ms[0])} to {number(ms[-1])} ms, median {number(ms[len(ms) // 2])} ms"
    bad = [r["model"] for r in rows if r["exit"] not in (0, 1)]
    if bad:
        text += f" (no run, by the exit code: {', '.join(bad)})"
    seconds = {r["model"]: r["seconds"] for r in rows}
    both = [(m, compilation(result["systems"][t])) for m, t in TWINS.items() if t in result["systems"] and m in seconds]
    pairs = [f"{model} {number(1e3 * seconds[model])} ({number(1e3 * c)})" for model, c in both if c]
    if not pairs:
        return text + "."
    text += f". Ours, and in brackets heyoka's shortest compilation of the like at 1e-12, ms: {', '.join(pairs)}. "
    least = min(c for t in result["systems"].values() if (c := compilation(t)) is not None)
    longer = [f"{r['model']} ({number(1e3 * r['seconds'])})" for r in rows if r["seconds"] > least]
    text += f"Of all systems above the shortest is {number(1e3 * least)} ms: "
    return text + ("every model was through before it." if not longer else "longer than that took " + ", ".join(longer) + ".")


def checks(result):
    rows = []
    for title, s in result["systems"].items():
        r = s["reference"]
        rows.append(f"{title} {r['change']:.0e}" + (f" ({r['own']:.0e})" if r["own"] is not None else ""))
    return ", ".join(rows)


def skipped(result):
    rows = [f"{t}: {mode} at {level:g}" for t, s in result["systems"].items() for level, mode in s.get("heyoka_skipped", [])]
    return "; ".join(rows) if rows else "none"


def markdown(result):
    m, peak = result["machine"], result["peak"]
    heyoka = next((s["heyoka_version"] for s in result["systems"].values() if "heyoka_version" in s), None)
    return f"""## Speed: motions from model files against heyoka, odeint and CVODE

`./dev bench speed` ({m["date"]}, {result["seconds"]:.0f} s, compilations of heyoka that were cached not counted): the models are in
`bench/models`, read as they are; the others get the equations reduced by hand (`bench/peers`). heyoka's time is that of its
best mode, unrolled or compact, with fast math or without; odeint's rkf78 that of the better of `-O3 -march=native` with and without
`-ffast-math`, on arrays of fixed length, O(n) for chains and trailers. A time is the smaller of wall time and time on the core, the
median of a round, and the best of {result["rounds"]} rounds in which all sides take turns. Ratios above 1: anholon is ahead.

Machine: {m["cores"]} cores of {m["cpu"]}, shared, load {m["load"]:.1f}; {m["compiler"]}, release build; heyoka {heyoka or "not installed"}.
Peak of fused multiply-adds on a core, GF/s: {", ".join(f"{k} {v:.1f}" for k, v in peak.items())}.

{times(result)}

The last four columns are at equal error: the peer's time over ours where we reach its error, between our tolerances by logarithms; – where we do not.

### Goals

{goals(result)}

### From the file to the first step

Milliseconds of ours, cold; seconds that heyoka compiles (mode chosen).

{setups(result)}

Modes of heyoka left out because they were expected to compile for longer than the limit: {skipped(result)}.

From the start of `anholon simulate MODEL` to its end, best of 3: {startup(result)}

### Ensembles

Neighbours, one in each SIMD lane of one core; us of a trajectory, the error that of the worst. GF/s: twice the operations of the
kernel's plan, for each of its expansions, by the whole time; the peak is that of fused multiply-adds. {lanes_checked(result)}

{ensembles(result)}

`anholon sweep` by one thread and by two, wall time of whole processes, the best of the rounds. Two threads need two cores, which
others use as well: what these took lowers the ratio, while the time on the cores tells what a second thread costs the first.

{threads(result)}

### Distance to the limit

At 1e-15; operations estimated from the counts of the program, solving not counted.

{fractions(result)}

### Growth with the links of a chain

Five steps at 1e-12, a process each.

{growth(result)}

### The references

Extrapolation in __float128, change from 100 to 200 steps (distance of our own motion in 32 digits): {checks(result)}.
"""


def put(text, path):
    """Writes the text between the marks of a file, or at its end."""
    with open(path, encoding="utf-8") as file:
        old = file.read()
    before, mark, rest = old.partition(BEGIN)
    after = rest.partition(END)[2] if mark else "\n"
    with open(path, "w", encoding="utf-8") as file:
        file.write(before.rstrip("\n") + f"\n\n{BEGIN}\n{text}{END}{after}")


def self_test():
    """Checks the rules of comparison on curves in closed form: time = 100 error^(-1/10)."""
    import os
    import tempfile

    curve = {f"1e-{k:02}": {"us": 100 * 10 ** (k / 10), "error": 10.0**-k} for k in (6, 8, 10)}
    assert abs(time_at(curve, 1e-9) / (100 * 10**0.9) - 1) < 1e-12, "between two tolerances"
    assert abs(time_at(curve, 1e-5) / (100 * 10**0.6) - 1) < 1e-12, "the cheapest run, where all reach the error"
    assert time_at(curve, 1e-11) is None, "an error that is not reached has no time"
    slow_and_bad = {**curve, "1e-12": {"us": 1.0, "error": 1.0}, "1e-13": {"failed": "singular"}}
    assert abs(time_at(slow_and_bad, 1e-9) / (100 * 10**0.9) - 1) < 1e-12, "a fast run with a large error, or none, is no help"
    peer = {"1e-09": {"us": 200.0, "error": 1e-8}}
    ratio_here = equal_error({"cells": {"own": curve, "peer": peer}}, "peer", "1e-09")
    assert abs(ratio_here - 2 / 10**0.8) < 1e-12, "the peer's time over ours, both at the peer's error"
    lanes = {"us": 2.0, "us_step": 0.5, "steps": 4, "by_kernel": 5, "work": 400.0, "error": 1e-9, "apart": 0.0, "code": True}
    assert gigaflops(lanes) == 2.0, "twice 400 operations, five times in 2 us"
    sides = {"own": {"1e-06": lanes}, "heyoka": {}, "odeint": {}}
    result = {"peak": {"avx2": 1.0, "avx512": 4.0}, "systems": {"sleigh": {"batch": {"cells": sides}, "cells": sides}}}
    result["threads"] = [{"model": m, "1": {"wall": 2.0}, "2": {"wall": w}} for m, w in (("sleigh", 1.0), ("chain", 1.25))]
    found = goals(result)
    assert "| ensembles: small systems, percent of the vector peak | the best | ≥ 50 | 50 | met |" in found, "half the peak is enough"
    assert "| ensembles: two threads against one |  | ≥ 1.9 | 1.6 to 2 | missed: chain 1.6 |" in found, "the one that misses the goal is named"
    assert "at most 0e+00 from" in lanes_checked(result) and "Without" not in lanes_checked(result), "lanes as they should be"
    lanes |= {"apart": 1e-3, "code": False}
    said = lanes_checked(result)
    assert "at most 1e-03 from" in said and "Without machine code: sleigh at 1e-06" in said, "and not"
    lanes["work"] = 399.0
    assert "missed: sleigh 49.9" in goals(result), "less than half is not"
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "r.md")
        with open(path, "w", encoding="utf-8") as file:
            file.write("before\n\nafter\n")
        for text in ("one\n", "two\n"):
            put(text, path)
        with open(path, encoding="utf-8") as file:
            assert file.read() == f"before\n\nafter\n\n{BEGIN}\ntwo\n{END}\n", "the tables of a new run take the place of the old ones"
    print("speed_report: all well")


if __name__ == "__main__":
    self_test()
