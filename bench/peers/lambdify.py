#!/usr/bin/env python3
"""f(t, x) of the rolling disc: anholon against sympy.lambdify with NumPy, on the same equations by Kane.

    lambdify.py [STATES]      with PYTHONPATH=build/release/python, in an environment with sympy

Prints the time of a batch and of one call. SymPy is used as people use it: (a) lambdify of mass_matrix_full and
forcing_full, then numpy.linalg.solve; (b) lambdify of an explicit right side, simplified, with common subexpressions.
anholon: the compiled function; the formulas of the same function as they run in NumPy; and the program of
`derive --format python`, by its rates in independent velocities and by its rhs in all coordinates and velocities with
multipliers. The last three need no compiler. SymPy's functions have six rates, ours eight: also those of the place.

Then, of more models, the generated rates against lambdify of the very same rates as SymPy expressions, simplified where they are short, with common
subexpressions.
"""

import sys
import time

import anholon as an
import numpy as np
import sympy as sm
import sympy.physics.mechanics as me


def kane():
    """Returns the method, its states, and values of its parameters."""
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
    return method, [*q, *u], {r: 0.5, m: 1, g: 9.81}


def explicit(method, states, values):
    right = method.mass_matrix_full.LUsolve(method.forcing_full).subs(values)
    return sm.lambdify(states, [sm.simplify(x) for x in right], "numpy", cse=True)


def solved(method, states, values):
    """Returns the function that solves mass_matrix_full x' = forcing_full in numbers."""
    matrix, forcing = (sm.lambdify(states, x.subs(values), "numpy", cse=True) for x in (method.mass_matrix_full, method.forcing_full))
    n = len(states)

    def f(*y):
        shape = np.shape(y[0])
        # lambdify returns constant entries as numbers, not as arrays.
        m, b = np.empty((*shape, n, n)), np.empty((*shape, n))
        for i, row in enumerate(np.array(matrix(*y), dtype=object) if shape else matrix(*y)):
            for j, x in enumerate(row):
                m[..., i, j] = x
        for i, x in enumerate(np.array(forcing(*y), dtype=object)[:, 0] if shape else forcing(*y)[:, 0]):
            b[..., i] = x
        return np.linalg.solve(m, b[..., None])[..., 0]

    return f


SIMPLIFIED = 40  # operations
MODELS = ("disc", "chaplygin-sleigh", "trailers", "snakeboard", "rolling-coin", "roller-racer", "two-wheeled-pendulum")


def same_rates(name, states):
    """Compares the generated rates of a model with lambdify of the same rates; prints a line of the table."""
    model = an.load(name)
    f = model.dynamics()
    program: dict = {}
    exec(compile(model.python_code(), "program.py", "exec"), program)
    by_sympy = f.formulas.sympy()
    numbers = dict(zip(by_sympy.p, f.p0.tolist(), strict=True))
    # Longer rates are not simplified, which takes SymPy minutes.
    right = [sm.simplify(rate) if sm.count_ops(rate) < SIMPLIFIED else rate for rate in by_sympy.rates.subs(numbers)]
    peer = sm.lambdify([by_sympy.t, *by_sympy.x], right, "numpy", cse=True)
    x = f.start[:, None] + 0.01 * np.random.default_rng(0).standard_normal((len(f.start), states))
    few = x[:, :100]
    np.testing.assert_allclose(np.stack(np.broadcast_arrays(*peer(0.3, *few))), program["rates"](0.3, few), rtol=1e-9, atol=1e-9)
    one, out = x[:, 0].tolist(), np.empty_like(x)
    # The sides are measured in turn, since the speed of a machine varies.
    many, alone = [1e9, 1e9], [1e9, 1e9]
    for _ in range(5):
        for k, (batch, call) in enumerate(((lambda: program["rates"](0.3, x, out=out), lambda: program["rates"](0.3, one)), (lambda: peer(0.3, *x), lambda: peer(0.3, *one)))):
            many[k] = min(many[k], best(batch, 1, time.process_time))
            alone[k] = min(alone[k], best(lambda call=call: [call() for _ in range(300)], 1, time.process_time) / 300)
    print(f"{name:20} {states} states {many[0] * 1e3:8.1f} ms, lambdify {many[1] * 1e3:8.1f} ms; one call {alone[0] * 1e6:6.2f} us, lambdify {alone[1] * 1e6:6.2f} us")


def best(f, rounds, clock=time.perf_counter):
    times = []
    for _ in range(rounds):
        begin = clock()
        f()
        times.append(clock() - begin)
    return min(times)


def main(states):
    disc = an.load("disc")
    f = disc.dynamics()
    by_numpy = f.formulas.numpy()
    program: dict = {}
    exec(compile(disc.python_code(), "disc.py", "exec"), program)
    method, symbols, values = kane()
    peers = {"lambdify, solve": solved(method, symbols, values), "lambdify, explicit": explicit(method, symbols, values)}
    draw = np.random.default_rng(0)
    x = f.start[:, None] * (1 + 0.01 * draw.standard_normal((len(f.start), states)))
    y = draw.uniform(0.3, 0.9, (6, states))
    few = y[:, :100]
    np.testing.assert_allclose(np.stack(np.broadcast_arrays(*peers["lambdify, explicit"](*few)), -1), peers["lambdify, solve"](*few), rtol=1e-9)
    out = np.empty_like(x)
    one, buffer, single = x[:, 0].copy(), out[:, 0].copy(), y[:, 0].tolist()
    ours = best(lambda: f(0.0, x, out=out), 5), best(lambda: [f(0.0, one, out=buffer) for _ in range(1000)], 5) / 1000
    print(f"{'anholon':20} {states} states {ours[0] * 1e3:8.1f} ms, one call {ours[1] * 1e6:6.2f} us")
    rows = {"anholon, NumPy": (lambda: by_numpy(0.0, x), lambda: by_numpy(0.0, one))}
    full = program["START"][:, None] * (1 + 0.01 * draw.standard_normal((len(program["START"]), states)))
    first = full[:, 0].copy()
    values = one.tolist()
    rows["anholon, rates"] = (lambda: program["rates"](0.0, x), lambda: program["rates"](0.0, values))
    rows["anholon, program"] = (lambda: program["rhs"](0.0, full), lambda: program["rhs"](0.0, first))
    rows |= {name: (lambda peer=peer: peer(*y), lambda peer=peer: peer(*single)) for name, peer in peers.items()}
    for name, (many, alone) in rows.items():
        batch, call = best(many, 3), best(lambda alone=alone: [alone() for _ in range(300)], 3) / 300
        print(f"{name:20} {states} states {batch * 1e3:8.1f} ms, one call {call * 1e6:6.2f} us: {batch / ours[0]:6.1f} and {call / ours[1]:5.1f} times ours")


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1_000_000
    main(count)
    for model in MODELS:
        same_rates(model, count)
