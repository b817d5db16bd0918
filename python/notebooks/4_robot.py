# %% [markdown]
# # 4. A robot on two wheels
#
# A body on two coaxial wheels with a motor in each wheel: without control it falls over. A controller for it takes four steps: the model, a linear model,
# a gain from SciPy, and the full nonlinear motion with that gain.

# %%
import anholon as an
import matplotlib.pyplot as plt
import numpy as np
from scipy.linalg import solve_continuous_are

text = """
title = "A robot on two wheels"
coordinates = ["x", "y", "psi", "al", "l", "r"]      # middle of the axle, heading, lean forward, turn of the wheels left and right
parameters = {M = "30 kg", mw = "2 kg", R = "20 cm", b = "25 cm", h = "50 cm", g = "9.81 m/s^2"}
gravity.field = "-g*ez"
frame.head = "rotz(psi)"
frame.lean = "head*roty(al)"
point.axle = "x*ex + y*ey + R*ez"
body = [
  {name = "rider", mass = "M", shape = "box(b, 2*b, 2*h)", center = "axle + h*lean.z", orientation = "lean"},
  {name = "left", mass = "mw", inertia = ["mw*R^2/4", "mw*R^2/2", "mw*R^2/4"], center = "axle + b*head.y", orientation = "head*roty(l)"},
  {name = "right", mass = "mw", inertia = ["mw*R^2/4", "mw*R^2/2", "mw*R^2/4"], center = "axle - b*head.y", orientation = "head*roty(r)"},
]
force = [{on = "left", from = "rider", torque = "left_motor*head.y"}, {on = "right", from = "rider", torque = "right_motor*head.y"}]
constraint = [
  {name = "left_rolls", equation = "vel(left, left.center - R*ez) = 0", along = ["head.x", "head.y"]},
  {name = "right_rolls", equation = "vel(right, right.center - R*ez) = 0", along = ["head.x"]},
]
input = {left_motor = LEFT, right_motor = RIGHT}
simulate.to = 4
view.left = {shape = "disc(R)", axes = "head*roty(l)*rotx(pi/2)"}
view.right = {shape = "disc(R)", axes = "head*roty(r)*rotx(pi/2)"}
view.hide = ["axle"]
view.floor = 0
"""
robot = an.loads(text.replace("LEFT", "0").replace("RIGHT", "0"))
robot.check()

# %% [markdown]
# ## The linear model
#
# The robot is upright and at rest; its motors are the inputs u. One eigenvalue is positive: the robot falls within about a fifth of a second.

# %%
linear = robot.linearize()
linear

# %% [markdown]
# The place and the heading follow from the turns of the wheels, so six states are enough. SciPy solves the Riccati equation for the gain
# $u = -Kz$ that weighs errors against the work of the motors.

# %%
states = ["al", "l", "r", "al'", "l'", "r'"]
chosen = [linear.states.index(name) for name in states]
A, B = linear.A[np.ix_(chosen, chosen)], linear.B[chosen]
Q, W = np.diag([10, 20, 20, 1, 1, 1]), np.eye(2)
P = solve_continuous_are(A, B, Q, W)
K = np.linalg.solve(W, B.T @ P)
np.linalg.eigvals(A - B @ K).round(3)

# %% [markdown]
# CasADi gets the same derivatives from the formulas of the equations, by its own differentiation, and the compiled function has them, too.

# %%
import casadi as ca

f = robot.dynamics(inputs=True)
upright = f.state(q={c.name: 0.0 for c in robot.coordinates}, qdot={})
formulas = f.formulas.casadi()
t, x, u, p = (ca.SX.sym(name, *formulas.sparsity_in(name).shape) for name in "txup")
jacobian = ca.Function("A", [t, x, u, p], [ca.jacobian(formulas(t, x, u, p)[0], x), ca.jacobian(formulas(t, x, u, p)[0], u)])
by_casadi = [np.array(m) for m in jacobian(0, upright, [0, 0], f.p0)]
assert np.allclose(by_casadi[0], f.jac(0, upright, [0, 0]), atol=1e-12)
assert np.allclose(by_casadi[1], f.jac(0, upright, [0, 0], by="u"), atol=1e-12)

# %% [markdown]
# ## The full robot with the controller
#
# The gain goes into the model as the formula of its inputs. The robot is asked to roll one metre forward.

# %%
goal = 1 / robot.parameters["R"]  # turn of the wheels, rad


def law(row: "np.ndarray") -> str:
    terms = [f"({gain!r})*({name if name not in 'lr' else f'({name} - {goal!r})'})" for gain, name in zip(row.tolist(), states, strict=True)]
    return '"-(' + " + ".join(terms) + ')"'


controlled = an.loads(text.replace("LEFT", law(K[0])).replace("RIGHT", law(K[1])))
run = controlled.simulate(every="0.01").expect()
run

# %%
figure, (above, below) = plt.subplots(2, sharex=True)
run.plot("x", ax=above)
run.plot("al", ax=below);

# %% [markdown]
# **The surprise.** To go forward the robot first rolls *backward*. Only then it leans forward, and then it can accelerate without falling on its back. No
# controller can avoid that: the zeros of the system have positive real parts.

# %%
back = run["x"].min()
print(f"first {-100 * back:.1f} cm backward, at last {run['x'][-1]:.3f} m forward")
assert back < -0.005 and abs(run["x"][-1] - 1) < 0.02
run.animate()
