#!/usr/bin/env python3
"""heyoka's Taylor integrator on the systems of the speed table, reduced by hand; a worker of bench/speed.py.

    heyoka_worker.py SYSTEM N END      then one line: JSON list of positions and velocities at the start, coordinate by coordinate
    modes                              the names of the modes of compilation
    compile TOLERANCE MODE             the seconds of its first compilation, and those of now
    run TOLERANCE MODE SECONDS         as many motions as fit the time, at least one
    batch TOLERANCE MODE STARTS SECONDS motions of neighbours at once, one in each lane; STARTS: positions and velocities of each

Every answer is a line of JSON. What is compiled stays in heyoka's cache on the disk, HEYOKA_CACHE_DIR. The time of a run is that of
propagate_until less that of a call of it that has nowhere to go.

The forms of the equations are those of odeint.cpp: quasi-velocities, the trailers' speed times the root of their inertia, the
tensions of the chain's rods by elimination in their tridiagonal equations. That from both ends at once, which helps odeint, makes
no difference here.
"""

import hashlib
import json
import os
import statistics
import sys
import time

import heyoka as hy
import numpy as np

MODES = {
    "unrolled": {"compact_mode": False, "fast_math": False},
    "unrolled, fast math": {"compact_mode": False, "fast_math": True},
    "compact": {"compact_mode": True, "fast_math": False},
    "compact, fast math": {"compact_mode": True, "fast_math": True},
}


class Sleigh:
    """x, y, th, v along the blade, w = th'."""

    def __init__(self, n):
        self.names = ["x", "y", "th", "v", "w"]

    def reduce(self, g):
        x, vx, y, vy, th, w = g
        return [x, y, th, vx * np.cos(th) + vy * np.sin(th), w]

    def rates(self, f, s, t):
        m, a, J = 2.0, 0.5, 0.5
        x, y, th, v, w = s
        return [v * f.cos(th), v * f.sin(th), w, a * (w * w), -(m * a / (J + m * a * a)) * (v * w)]


class Disc:
    """x, y, psi, theta, phi, and the angular velocities w1 (lean), w2, w3 (axle) along lean.x, lean.y, lean.z."""

    def __init__(self, n):
        self.names = ["x", "y", "psi", "theta", "phi", "w1", "w2", "w3"]

    def reduce(self, g):
        c, s = np.cos(g[6]), np.sin(g[6])
        return [g[0], g[2], g[4], g[6], g[8], g[7], g[5] * s, g[5] * c + g[9]]

    def rates(self, f, s, t):
        R, g = 0.5, 9.8125
        x, y, psi, theta, phi, w1, w2, w3 = s
        c = f.cos(theta)
        turn = w2 / f.sin(theta)
        axle = turn * c
        spin = w3 - axle
        return [
            -R * (spin * f.cos(psi)), -R * (spin * f.sin(psi)), turn, w1, spin,
            w2 * (0.2 * axle - 1.2 * w3) - (0.8 * g / R) * c, w1 * (2.0 * w3 - axle), (2.0 / 3.0) * (w1 * w2),
        ]  # fmt: skip


class Trailers:
    """x, y, ph, th[0..n], p = v sqrt(I) where 2T = I v^2 + Jp s^2, s = th[0]' + ph'."""

    def __init__(self, n):
        self.n = n
        self.names = ["x", "y", "ph", *(f"th{i}" for i in range(n + 1)), "p", "s"]

    def root(self, f, th, t):
        """Returns the root of 1/I, computed from the last trailer on, with cosines and sines at the hitches."""
        M0, J0, M, J, d = 10.0, 2.0, 3.0, 0.75, 0.875
        c, s, behind = [], [], 0.0
        for i in range(1, self.n + 1):
            bend = th[i - 1] - th[i]
            c.append(f.cos(bend))
            s.append(f.sin(bend))
        for i in reversed(range(self.n)):
            behind = J / (d * d) + c[i] * c[i] * (M - J / (d * d) + behind)
        return (M0 + J0 * (t * t) + behind) ** -0.5, c, s

    def reduce(self, g):
        th = g[6::2]
        v = g[1] * np.cos(th[0]) + g[3] * np.sin(th[0])
        r, _, _ = self.root(np, th, np.tan(g[4]))
        return [g[0], g[2], g[4], *th, v / r, g[7] + g[5]]

    def rates(self, f, s, time_):
        L, Jp, d, drive = 1.0, 0.125, 0.875, 5.0
        ph, th, p, total = s[2], s[3:-2], s[-2], s[-1]
        t = f.tan(ph) / L
        r, c, sn = self.root(f, th, t)
        v = p * r
        turn = v * t
        w = total - turn
        steer = f.sin(time_) - 2.0 * ph - 0.5 * w
        rates = [v * f.cos(th[0]), v * f.sin(th[0]), w, turn]
        u = v
        for i in range(self.n):
            rates.append(u * sn[i] * (1 / d))
            u = u * c[i]
        return [*rates, (drive - t * steer) * r, steer * (1 / Jp)]


class Chain:
    """th[i], w[i] = th[i]'; tensions T over m l: -c[i] T[i-1] + 2 T[i] - c[i+1] T[i+1] = w[i]^2."""

    def __init__(self, n):
        self.n = n
        self.names = [*(f"th{i}" for i in range(n)), *(f"w{i}" for i in range(n))]

    def reduce(self, g):
        return [*g[0::2], *g[1::2]]

    def rates(self, f, s, t):
        n, l, g = self.n, 0.25, 9.8125
        th, w = s[:n], s[n:]
        c = [None, *(f.cos(th[i] - th[i - 1]) for i in range(1, n)), 0.0]
        sn = [None, *(f.sin(th[i] - th[i - 1]) for i in range(1, n)), 0.0]
        right, pivot = [w[0] * w[0] + (g / l) * f.cos(th[0])], [1.0]
        for i in range(1, n):
            share = c[i] / pivot[i - 1] if i > 1 else c[i]
            pivot.append(2.0 - c[i] * share)
            right.append(w[i] * w[i] + share * right[i - 1])
        tension = [None] * n
        tension[n - 1] = right[n - 1] / pivot[n - 1]
        for i in reversed(range(n - 1)):
            tension[i] = right[i] + c[i + 1] * tension[i + 1]
            if i > 0:
                tension[i] = tension[i] / pivot[i]
        rates = [sn[1] * tension[1] - (g / l) * f.sin(th[0])]
        for i in range(1, n):
            ahead = sn[i + 1] * tension[i + 1] if i + 1 < n else 0.0
            rates.append(ahead - sn[i] * tension[i - 1])
        return [*w, *rates]


SYSTEMS = {"sleigh": Sleigh, "disc": Disc, "trailers": Trailers, "chain": Chain}


class Worker:
    def __init__(self, name, n, end, given):
        self.name, self.n, self.end = name, n, end
        self.system = SYSTEMS[name](n)
        self.start = np.array(self.system.reduce(np.array(given)), dtype=float)
        variables = hy.make_vars(*self.system.names)
        self.equations = list(zip(variables, self.system.rates(hy, list(variables), hy.time)))
        self.integrators = {}

    def made(self, key, make):
        """Returns an integrator, the seconds of its first compilation, and the seconds of making it now."""
        if key not in self.integrators:
            begin = clocks(time.process_time)
            integrator = make()
            now = since(begin, time.process_time)
            self.integrators[key] = (integrator, self.first_seconds(key, now), now)
        return self.integrators[key]

    def first_seconds(self, key, now):
        """Returns the seconds of the first compilation, which are kept in a file in the folder of heyoka's cache."""
        folder = os.environ.get("HEYOKA_CACHE_DIR")
        if not folder:
            return now
        path = os.path.join(folder, f"seconds-{self.name}-{self.n}.json")
        seconds = {}
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                seconds = json.load(file)
        name = hashlib.sha256(f"{hy.__version__} {key} {self.equations}".encode()).hexdigest()[:16]
        if name not in seconds:
            seconds[name] = now
            os.makedirs(folder, exist_ok=True)
            with open(path, "w", encoding="utf-8") as file:
                json.dump(seconds, file, indent=1)
        return seconds[name]

    def single(self, tolerance, mode):
        def make():
            return hy.taylor_adaptive(self.equations, self.start, tol=tolerance, **MODES[mode])

        return self.made((self.name, self.n, tolerance, mode), make)

    def several(self, tolerance, mode, lanes):
        def make():
            state = np.repeat(self.start[:, None], lanes, axis=1)
            return hy.taylor_adaptive_batch(self.equations, state, tol=tolerance, force_avx512=lanes == 8, **MODES[mode])

        return self.made((self.name, self.n, tolerance, mode, lanes), make)

    def positions_and_velocities(self, state):
        rates = self.system.rates(np, list(state), self.end)
        if self.name == "chain":
            x, v = state[: self.n], state[self.n :]
        else:
            count = {"sleigh": 3, "disc": 5, "trailers": self.n + 4}[self.name]
            x, v = state[:count], rates[:count]
        return [repr(float(a)) for pair in zip(x, v) for a in pair]

    def compile(self, tolerance, mode):
        return dict(zip(("first", "now"), self.single(tolerance, mode)[1:]))

    def run(self, tolerance, mode, seconds):
        ta, jit, _ = self.single(tolerance, mode)

        def reset():
            ta.time = 0.0
            ta.state[:] = self.start

        times, steps = measure(reset, lambda: ta.propagate_until(self.end), seconds, lambda result: result[3])
        return {
            "us": 1e6 * times, "jit": jit, "steps": steps, "order": ta.order,
            "state": self.positions_and_velocities(np.array(ta.state)),
        }  # fmt: skip

    def batch(self, tolerance, mode, starts, seconds):
        lanes = len(starts)
        ta, jit, _ = self.several(tolerance, mode, lanes)
        start = np.column_stack([self.system.reduce(np.array(given)) for given in starts])

        def reset():
            ta.set_time(0.0)
            ta.state[:] = start

        times, steps = measure(reset, lambda: ta.propagate_until(self.end), seconds, lambda _: [r[3] for r in ta.propagate_res])
        ends = [self.positions_and_velocities(np.array(ta.state[:, k])) for k in range(lanes)]
        return {
            "us": 1e6 * times / lanes, "us_step": 1e6 * times / sum(steps), "jit": jit, "steps": sum(steps) / lanes, "order": ta.order,
            "lanes": lanes, "state": [x for end in ends for x in end],
        }  # fmt: skip


def clocks(core=time.thread_time):
    return core(), time.perf_counter()


def since(begin, core=time.thread_time):
    """Returns the smaller of wall time and time on the core, as stopwatch.h does."""
    wall = time.perf_counter() - begin[1]
    return min(wall, core() - begin[0])


def measure(reset, go, seconds, steps_of):
    """Returns the median seconds of a run, without those of a call that is at its end already, and the steps."""
    times, calls, begin = [], [], time.perf_counter()
    while not times or time.perf_counter() - begin < seconds:
        reset()
        started = clocks()
        result = go()
        times.append(since(started))
        steps = steps_of(result)
        started = clocks()
        go()
        calls.append(since(started))
    # The least time of the calls is subtracted, as a disturbed one would make the run look too short.
    return statistics.median(times) - min(calls), steps


def main():
    name, n, end = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
    worker = Worker(name, n, end, json.loads(sys.stdin.readline()))
    for line in sys.stdin:
        command, *words = json.loads(line)
        try:
            answer = {"modes": list(MODES), "version": hy.__version__} if command == "modes" else getattr(worker, command)(*words)
        except Exception as error:  # a failure of heyoka is an answer, too
            answer = {"failed": f"{type(error).__name__}: {error}"}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
