# %% [markdown]
# # 7. A car that backs up with two trailers
#
# Backing up with a trailer is hard, with two it is a trick for experts: the trailers fold at the least error. CasADi and its solver Ipopt find the best way
# of steering with the equations of Anholon; the solution is then replayed by Anholon itself.

# %%
import anholon as an
import casadi as ca
import matplotlib.pyplot as plt
import numpy as np

car = an.load("trailers", set={"n": 2})
f = car.dynamics(inputs=True)
print(f.inputs)
f.states

# %% [markdown]
# The state has two independent velocities, any values of which satisfy the constraints, so the solver cannot violate them. The formulas of the rates are CasADi
# expressions.

# %%
rate = f.formulas.casadi()
N, parts, T = 40, 6, 8.0  # intervals, Runge-Kutta steps in each, seconds
h = T / N
names = [state.name for state in f.states]

# Butcher's method of order 6.
C = [0, 1 / 3, 2 / 3, 1 / 3, 1 / 2, 1 / 2, 1]
A = [
    [],
    [1 / 3],
    [0, 2 / 3],
    [1 / 12, 1 / 3, -1 / 12],
    [-1 / 16, 9 / 8, -3 / 16, -3 / 8],
    [0, 9 / 8, -3 / 8, -3 / 4, 1 / 2],
    [9 / 44, -9 / 11, 63 / 44, 18 / 11, 0, -16 / 11],
]
b = [11 / 120, 0, 27 / 40, 27 / 40, -4 / 15, -4 / 15, 11 / 120]

x, first, last = ca.SX.sym("x", len(names)), ca.SX.sym("first", 2), ca.SX.sym("last", 2)
z = x
for k in range(parts):
    slopes: list[ca.SX] = []
    for c, row in zip(C, A, strict=True):
        at = z + h / parts * sum((a * s for a, s in zip(row, slopes, strict=True)), ca.SX.zeros(len(names)))
        slopes.append(rate(0, at, first + (last - first) * (k + c) / parts, f.p0)[0])
    z = z + h / parts * sum((w * s for w, s in zip(b, slopes, strict=True)), ca.SX.zeros(len(names)))
step = ca.Function("step", [x, first, last], [z])

# %% [markdown]
# ## The problem
#
# From a straight line the car drives backward at 1 m/s. After eight seconds the car is 8 m behind, and car and trailers stand one metre to the
# left, in a straight line again. The controls are linear between 41 times; the problem minimizes their squares.

# %%
start = f.state(q={c.name: 0.0 for c in car.coordinates}, qdot={"x'": -1.0})
end = start.copy()
end[names.index("x")], end[names.index("y")] = -8, 1

problem = ca.Opti()
X, U = problem.variable(len(names), N + 1), problem.variable(2, N + 1)
problem.subject_to(X[:, 0] == start)
problem.subject_to(X[:, N] == end)
problem.subject_to(X[:, 1:] == step.map(N)(X[:, :-1], U[:, :-1], U[:, 1:]))
problem.subject_to(problem.bounded(-0.7, X[names.index("ph"), :], 0.7))
problem.minimize(h * (ca.sumsqr(U[0, :]) / 100 + ca.sumsqr(U[1, :])))
problem.set_initial(X, np.linspace(start, end, N + 1).T)
problem.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes", "tol": 1e-10})
solution = problem.solve()
controls, states = np.asarray(solution.value(U)), np.asarray(solution.value(X))
solution.stats()["iter_count"]

# %% [markdown]
# ## The replay
#
# The controls go into the model as tables, and `simulate` integrates the full equations, with multipliers and all constraints.

# %%
moments = [h * k for k in range(N + 1)]
text = car.text.replace("drive = 5 ", 'drive = "drive_law(t)" ').replace("steer = \"-2*(ph - sin(t)/2) - ph'/2\"", 'steer = "steer_law(t)"')
text = text.replace("dot(vel(P[0]), T[0].x) = 1", "dot(vel(P[0]), T[0].x) = -1")
for name, values in zip(("drive_law", "steer_law"), controls, strict=True):
    text += f'[[table]]\nname = "{name}"\nx = {moments}\ny = {values.tolist()}\n'
replay = an.loads(text, set={"n": 2}).simulate(to=T, every="0.05").expect()
replay

# %%
wanted = f.motion(states[:, -1])
misses = {c.name: abs(wanted[c.name] - replay[c.name][-1]) for c in car.coordinates}
print(misses, replay.report.constraints)
assert max(misses.values()) < 2e-6 and replay.report.constraints < 1e-12

# %% [markdown]
# **The surprise.** To get to the left the car first goes to the right. The trailers must point to the new line before the car may follow them, and
# only a swing to the other side turns them.

# %%
replay.plot("ph", "th[0]", "th[1]", "th[2]")
plt.figure()
plt.plot(replay["x"], replay["y"])
plt.gca().set_aspect("equal");

# %%
replay.animate()
