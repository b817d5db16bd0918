# %% [markdown]
# # 1. A coin that does not fall
#
# A coin that rolls fast enough stays up by itself. This notebook writes the coin as a model, lets the equations be derived and proved, and then
# asks at which speed the coin begins to fall.

# %%
import anholon as an
import numpy as np

coin = an.loads("""
title = "A coin on a table"
coordinates = ["x", "y", "psi", "theta", "phi"]          # place of the contact, heading, tilt (pi/2 is upright), spin
parameters = {m = 0.005, R = 0.01, g = 9.81}
frame.lean = "rotz(psi)*rotx(theta)"
point.contact = "x*ex + y*ey"
body = [{name = "coin", mass = "m", shape = "disc(R)", center = "contact + R*lean.y", orientation = "lean*rotz(phi)"}]
constraint = [{name = "rolling", equation = "vel(coin, contact) = 0"}]
gravity.field = "-g*ez"
initial = {theta = 1.5, "phi'" = 40, "psi'" = 0}
simulate.to = 1
view = {path = {trace = "contact"}, hide = ["contact"]}
""")
coin.check()

# %% [markdown]
# The one line `vel(coin, contact) = 0` is the whole of rolling: the point of the coin that touches the table is at rest. It gives two
# constraints that no formula in the coordinates alone can replace. The coin has five coordinates and three degrees of freedom.

# %%
coin.equations()

# %% [markdown]
# Routh's equations have a multiplier for each constraint. There are many other classical forms. They look different, and each is proved to say the
# same: no number is compared, the difference is shown to be zero as a formula.

# %%
coin.prove("maggi", "kane", "boltzmann-hamel")

# %% [markdown]
# ## The motion
#
# The coin starts almost upright and spins at 40 radians a second. The report below says how far the numbers can be trusted.

# %%
run = coin.simulate(every="0.002")
run

# %%
run.plot("theta", "psi'");

# %%
run.animate()

# %% [markdown]
# ## Where does it begin to fall?
#
# A start that is upright but for a hair's breadth, with ever less spin: the least tilt that the coin has in one second. Upright is 90 degrees.

# %%
spins = np.arange(10, 32.1, 1)
least = []
for spin in spins:
    second = coin.simulate(to=1, every="0.002", initial={"phi'": spin, "theta": "1.5707"}, error_estimate=False)
    least.append(second["theta"].min())

# %%
import matplotlib.pyplot as plt

R, g = coin.parameters["R"], coin.parameters["g"]
edge = np.sqrt(g / (3 * R))
plt.plot(spins, np.degrees(least), "o-")
plt.axvline(edge, color="0.6")
plt.xlabel("spin, rad/s")
plt.ylabel("least tilt, degrees");

# %% [markdown]
# **The surprise.** There is an edge. A coin that spins faster than $\sqrt{g/3R}$ (the grey line; a result for small tilts) only sways, a slower one
# goes down. Nothing steers the coin and nothing is lost: the energy of every one of these motions is conserved to the last digits.

# %%
tilts = np.degrees(least)
assert tilts[spins > edge].min() > 89, "a fast coin stays up"
assert tilts[spins < edge - 1].max() < 72, "a slow coin goes down"
[w for w in run.report.watched if w.conserved]
