# %% [markdown]
# # 6. From SymPy and back
#
# A model that is written for `sympy.physics.mechanics` is imported as it is. Anholon takes the *mechanics* from it (bodies, velocities, loads, constraints),
# not the equations, and derives these anew. Afterwards the rates go back to SymPy as expressions. Here it is the rolling disc of SymPy's documentation.

# %%
from typing import Any

import anholon as an
import numpy as np
import sympy as sm
import sympy.physics.mechanics as me

q1, q2, q3, u1, u2, u3 = me.dynamicsymbols("q1 q2 q3 u1 u2 u3")
r, m, g = sm.symbols("r m g")
N = me.ReferenceFrame("N")
Y = N.orientnew("Y", "Axis", [q1, N.z])
L = Y.orientnew("L", "Axis", [q2, Y.x])
R = L.orientnew("R", "Axis", [q3, L.y])
spin = R.ang_vel_in(N)
R.set_ang_vel(N, u1 * L.x + u2 * L.y + u3 * L.z)
C = me.Point("C")
C.set_vel(N, 0)
center = C.locatenew("center", r * L.z)
center.v2pt_theory(C, N, R)
disc = me.RigidBody("disc", center, R, m, (me.inertia(L, m / 4 * r**2, m / 2 * r**2, m / 4 * r**2), center))
kane = me.KanesMethod(N, [q1, q2, q3], [u1, u2, u3], kd_eqs=[me.dot(R.ang_vel_in(N) - spin, v) for v in L])
kane.kanes_equations([disc], [(center, -m * g * Y.z)])

# %%
values = {r: 0.5, m: 1, g: 9.81}
model = an.from_sympy(kane, values=values, initial={q2: 0.2, "q3'": 6})
print(model.text)

# %% [markdown]
# SymPy's model has only the velocity of the centre, not its *position*: the point of contact is at rest at each moment, but it is another point of the
# disc at the next moment. The import gives the centre coordinates of its own, and constraints equate their rates to the velocity.
#
# ## The same accelerations
#
# SymPy solves Kane's equations; Anholon derived its own. Both are evaluated at a state.

# %%
speeds = [q1.diff(), q2.diff(), q3.diff()]
rates: dict[Any, Any] = kane.kindiffdict()
state = {q1: 0.3, q2: 0.2, q3: 0.1, u1: 0.4, u2: -0.7, u3: 0.5}
qdot = {v: float(rates[v].subs(state)) for v in speeds}
matrix, forcing = (sm.Matrix(part).subs(values).subs({v: qdot[v] for v in speeds}).subs(state) for part in (kane.mass_matrix, kane.forcing))
udot = matrix.LUsolve(forcing)
accelerations = [rates[v].diff(sm.Symbol("t")) for v in speeds]
dots = {u.diff(): a for u, a in zip((u1, u2, u3), udot, strict=True)}
by_sympy = [float(a.subs(dots).subs({v: qdot[v] for v in speeds}).subs(state)) for a in accelerations]

# %%
initial = {"q1": 0.3, "q2": 0.2, "q3": 0.1, "q1'": qdot[speeds[0]], "q2'": qdot[speeds[1]], "q3'": qdot[speeds[2]]}
ours = model.simulate(to=0, at=[0], initial=initial, error_estimate=False)
by_anholon = [ours[f"{name}''"][0] for name in ("q1", "q2", "q3")]
print(by_sympy, by_anholon, sep="\n")
assert np.allclose(by_sympy, by_anholon, rtol=1e-12)

# %% [markdown]
# ## What it adds
#
# **The surprise.** SymPy's way to such a force is to add auxiliary speeds, derive all equations once more and set these speeds to zero. Here the force
# that holds the contact is a column of every run: a multiplier for each constraint.

# %%
run = model.simulate(to=3, every="0.01")
run

# %%
run.plot("q2", "q1'");

# %%
run.plot(*[column.name for column in run.columns if column.kind == "multipliers"]);

# %% [markdown]
# ## And back
#
# The equations in all coordinates are SymPy expressions with exact numbers: nothing is rounded on the way. They are linear in the accelerations and the multipliers;
# the cell shows the second equation.

# %%
formulas = model.dynamics(minimal=False).formulas.sympy()
assert not formulas.matrix.atoms(sm.Float) and not formulas.right.atoms(sm.Float)
sm.Eq((formulas.matrix * sm.Matrix(formulas.lead))[1], formulas.right[1])
