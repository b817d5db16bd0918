#!/usr/bin/env python3
"""Lagrange's equations of the planar chain of n links: `anholon derive` against SymPy.

    chain.py --program PROGRAM [--links 5 10 20 64] [--limit SECONDS] [--json FILE] [--anholon-only]

The chain: n massless links of length l, absolute angles, a bob of mass m at the end of each, gravity. SymPy forms the same
equations by LagrangesMethod and by KanesMethod of sympy.physics.mechanics, each in a process of its own; nothing is
simplified, printed or solved there. What takes longer than the limit is given up, and not tried for longer chains.

Two times each: of the whole process, and of the equations alone. For anholon the latter is its process less one of a chain
with one link, printing included; for SymPy from the first symbol to the last equation, the import left out. The best of
several runs, in wall time. Prints a Markdown table and writes JSON. Without SymPy it says so and does nothing.
"""

import argparse
import importlib.util
import json
import os
import platform
import re
import subprocess
import sys
import tempfile
import time

METHODS = ("lagrange", "kane")


def chain_model(n):
    """Returns the text that test/support/chain.h writes, too."""
    links = range(1, n + 1)
    coordinates = ", ".join(f'"a{i}"' for i in links)
    points = "".join(
        f'P{i} = "{f"P{i - 1} + " if i > 1 else ""}l*sin(a{i})*ex - l*cos(a{i})*ey"\n' for i in links
    )
    bobs = "".join(f'[[particle]]\nname = "bob{i}"\nmass = "m"\nposition = "P{i}"\n' for i in links)
    return (
        f"coordinates = [{coordinates}]\n[parameters]\nm = 0.1\nl = 0.2\ng = 9.81\n[point]\n{points}{bobs}"
        '[gravity]\nfield = "-g*ey"\n'
    )


# ---- SymPy, in a process of its own ---------------------------------------------------------------


def form_lagrange(n):
    from sympy import cos, sin, symbols
    from sympy.physics.mechanics import LagrangesMethod, dynamicsymbols

    m, length, g = symbols("m l g")
    q = dynamicsymbols(f"a1:{n + 1}")
    u = dynamicsymbols(f"a1:{n + 1}", 1)
    vx = vy = y = energy = 0
    for i in range(n):
        vx += length * cos(q[i]) * u[i]
        vy += length * sin(q[i]) * u[i]
        y -= length * cos(q[i])
        energy += m * (vx**2 + vy**2) / 2 - m * g * y
    return LagrangesMethod(energy, q).form_lagranges_equations()


def form_kane(n):
    from sympy import cos, sin, symbols
    from sympy.physics.mechanics import KanesMethod, Particle, Point, ReferenceFrame, dynamicsymbols

    m, length, g = symbols("m l g")
    q = dynamicsymbols(f"a1:{n + 1}")
    u = dynamicsymbols(f"u1:{n + 1}")
    frame = ReferenceFrame("N")
    velocity = 0 * frame.x
    bobs, forces = [], []
    for i in range(n):
        velocity = velocity + length * u[i] * (cos(q[i]) * frame.x + sin(q[i]) * frame.y)
        point = Point(f"P{i + 1}")
        point.set_vel(frame, velocity)
        bobs.append(Particle(f"bob{i + 1}", point, m))
        forces.append((point, -m * g * frame.y))
    kane = KanesMethod(frame, q_ind=q, u_ind=u, kd_eqs=[q[i].diff() - u[i] for i in range(n)])
    fr, frstar = kane.kanes_equations(bobs, forces)
    return fr + frstar


def worker(method, n):
    import sympy
    import sympy.physics.mechanics  # noqa: F401

    begin = time.perf_counter()
    equations = {"lagrange": form_lagrange, "kane": form_kane}[method](n)
    seconds = time.perf_counter() - begin
    assert len(equations) == n
    print(json.dumps({"seconds": seconds, "version": sympy.__version__}))


def run_sympy(method, n, limit):
    command = [sys.executable, os.path.abspath(__file__), "--worker", method, str(n)]
    begin = time.perf_counter()
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=limit)
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        raise SystemExit(f"SymPy failed:\n{done.stderr}")
    return {"process": time.perf_counter() - begin, "equations": json.loads(done.stdout)["seconds"]}


# ---- measuring ------------------------------------------------------------------------------------


def best(measure, patience=10.0, most=7):
    """Returns the best of several runs: as many as fit into some seconds, at least one."""
    results, begin = [], time.perf_counter()
    while len(results) < most and (not results or time.perf_counter() - begin < patience):
        results.append(measure())
        if results[-1] is None:
            return None
    return {key: min(r[key] for r in results) for key in results[0]}


def run_anholon(program, model, expand):
    begin = time.perf_counter()
    subprocess.run([program, "derive", model, "--quiet", "--expand", expand], stdout=subprocess.DEVNULL, check=True)
    return {"process": time.perf_counter() - begin}


def measure_anholon(program, n, expand):
    with tempfile.TemporaryDirectory() as scratch:
        times = {}
        for links in (1, n):
            path = os.path.join(scratch, f"chain{links}.toml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(chain_model(links))
            times[links] = best(lambda path=path: run_anholon(program, path, expand))["process"]
    return {"process": times[n], "equations": times[n] - times[1]}


def machine():
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            model = re.search(r"^model name\s*:\s*(.*)$", file.read(), re.MULTILINE)[1]
    except (OSError, TypeError):
        pass
    return f"{os.cpu_count()} cores, {model}"


def seconds(result, key):
    return "–" if result is None else f"{result[key]:.3g}"


def ratio(anholon, peer, key):
    return "–" if anholon is None or peer is None else f"{peer[key] / anholon[key]:.0f}"


HEAD = [
    "| links | anholon derive | equations alone | `--expand none` | SymPy Lagrange: process | equations | SymPy Kane: process | equations "
    "| faster SymPy / anholon: process | equations |",
    "|---|---|---|---|---|---|---|---|---|---|",
]


def row(n, r, limit):
    peers = {m: r.get(m) for m in METHODS}
    fastest = {
        key: min((p for p in peers.values() if p), key=lambda p, key=key: p[key], default=None)
        for key in ("process", "equations")
    }
    cells = [str(n), seconds(r["anholon"], "process"), seconds(r["anholon"], "equations"), seconds(r["anholon_none"], "process")]
    for m in METHODS:
        given_up = m in r and r[m] is None
        cells += [f"> {limit:g}", "–"] if given_up else [seconds(peers[m], "process"), seconds(peers[m], "equations")]
    cells += [ratio(r["anholon"], fastest[key], key) for key in ("process", "equations")]
    return "| " + " | ".join(cells) + " |"


def main():
    if sys.argv[1:2] == ["--worker"]:
        worker(sys.argv[2], int(sys.argv[3]))
        return 0
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=os.path.join(root, "build", "anholon"))
    parser.add_argument("--links", type=int, nargs="+", default=[5, 10, 20, 64])
    parser.add_argument("--limit", type=float, default=600, help="seconds for one process of SymPy")
    parser.add_argument("--json", default="", help="file for the result")
    parser.add_argument("--anholon-only", action="store_true")
    options = parser.parse_args()
    methods = () if options.anholon_only else METHODS
    if methods and importlib.util.find_spec("sympy") is None:
        print("bench/peers/chain.py: skipped, SymPy is not installed (Debian: python3-sympy)")
        return 0

    result = {"machine": machine(), "python": platform.python_version(), "limit": options.limit, "unit": "s", "chains": {}}
    if methods:
        import sympy

        result["sympy"] = sympy.__version__
        print(f"SymPy {sympy.__version__}, Python {result['python']}, {result['machine']}; seconds\n", flush=True)
    print("\n".join(HEAD), flush=True)
    given_up = set()
    for n in sorted(options.links):
        r = {"anholon": measure_anholon(options.program, n, "auto"), "anholon_none": measure_anholon(options.program, n, "none")}
        for method in methods:
            if method in given_up:
                continue
            r[method] = best(lambda method=method, n=n: run_sympy(method, n, options.limit), most=3)
            if r[method] is None:
                given_up.add(method)
        result["chains"][str(n)] = r
        print(row(n, r, options.limit), flush=True)
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump(result, file, indent=2)
            file.write("\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
