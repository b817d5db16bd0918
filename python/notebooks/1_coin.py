# %% [markdown]
# # 1. A coin that does not fall
#
# A coin that rolls fast enough stays up by itself. This notebook writes the coin as a model, derives its equations and proves that their forms
# agree, and then finds the speed at which the coin begins to fall.

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
# The line `vel(coin, contact) = 0` says that the coin rolls: the point of the coin that touches the table is at rest. The line gives two
# constraints that no equation between coordinates alone can replace. The coin has five coordinates and three degrees of freedom.

# %%
coin.equations()

# %% [markdown]
# Routh's equations have a multiplier for each constraint. There are many other classical forms. They look different, but each is proved to
# agree with Routh's: the proof compares no numbers, it shows that the difference is zero as a formula.

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
# The coin now starts almost upright, with less and less spin. Each motion gives the least tilt within one second; 90 degrees is upright.

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
# **The surprise.** There is a sharp limit. A coin that spins faster than $\sqrt{g/3R}$ (the grey line; a result for small tilts) only sways, a slower
# one falls. No force steers the coin and no energy is lost: each of these motions conserves its energy to the last digits.

# %%
tilts = np.degrees(least)
assert tilts[spins > edge].min() > 89, "a fast coin stays up"
assert tilts[spins < edge - 1].max() < 72, "a slow coin goes down"
[w for w in run.report.watched if w.conserved]
