#!/usr/bin/env python3
"""f(t, x) of the rolling disc: anholon's dynamics() against sympy.lambdify with NumPy, on the same equations by Kane.

    lambdify.py [STATES]      with PYTHONPATH=build/release/python, in an environment with sympy

Prints the time of a batch and of one call, for both.
"""

import sys
import time

import anholon as an
import numpy as np
import sympy as sm
import sympy.physics.mechanics as me


def kane():
    q = me.dynamicsymbols("q1:4")
    u = me.dynamicsymbols("u1:4")
    r, m, g = sm.symbols("r m g")
    N = me.ReferenceFrame("N")
    Y = N.orientnew("Y", "Axis", [q[0], N.z])
    L = Y.orientnew("L", "Axis", [q[1], Y.x])
    R = L.orientnew("R", "Axis", [q[2], L.y])
    spin = R.ang_vel_in(N)
    R.set_ang_vel(N, u[0] * L.x + u[1] * L.y + u[2] * L.z)
    C = me.Point("C")
    C.set_vel(N, 0)
    center = C.locatenew("Dmc", r * L.z)
    center.v2pt_theory(C, N, R)
    body = me.RigidBody("BodyD", center, R, m, (me.inertia(L, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2), center))
    method = me.KanesMethod(N, q, u, kd_eqs=[me.dot(R.ang_vel_in(N) - spin, v) for v in L])
    method.kanes_equations([body], [(center, -m * g * Y.z)])
    right = method.mass_matrix_full.LUsolve(method.forcing_full).subs({r: 0.5, m: 1, g: 9.81})
    return sm.lambdify([*q, *u], [sm.simplify(x) for x in right], "numpy", cse=True)


def best(f, rounds):
    times = []
    for _ in range(rounds):
        begin = time.perf_counter()
        f()
        times.append(time.perf_counter() - begin)
    return min(times)


def main(states):
    f, by_sympy = an.load("disc").dynamics(), kane()
    draw = np.random.default_rng(0)
    x = f.start[:, None] * (1 + 0.01 * draw.standard_normal((len(f.start), states)))
    y = draw.uniform(0.3, 0.9, (6, states))
    out = np.empty_like(x)
    ours, theirs = best(lambda: f(0.0, x, out), 5), best(lambda: by_sympy(*y), 5)
    print(f"{states} states: anholon {ours * 1e3:.1f} ms, lambdify {theirs * 1e3:.1f} ms, ratio {theirs / ours:.1f}")
    one, buffer, few = x[:, 0].copy(), out[:, 0].copy(), y[:, 0].tolist()
    ours, theirs = best(lambda: [f(0.0, one, buffer) for _ in range(1000)], 5) / 1000, best(lambda: [by_sympy(*few) for _ in range(1000)], 5) / 1000
    print(f"one call: anholon {ours * 1e6:.2f} us, lambdify {theirs * 1e6:.2f} us")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000)
