# %% [markdown]
# # 2. A bicycle without a rider's hands
#
# A bicycle that rolls by itself is stable in a window of speeds. The model is the benchmark of Meijaard, Papadopoulos, Ruina and Schwab (2007): four
# rigid bodies, of which the two thin wheels roll without slipping, and a constraint that keeps the front wheel on the ground.

# %%
import anholon as an
import matplotlib.pyplot as plt
import numpy as np

bicycle = an.load("whipple")
bicycle.check()

# %% [markdown]
# ## Two modes and a window
#
# `linearize` takes the exact derivatives of the equations at the steady motion straight ahead. `stability` does that at many speeds and then
# looks for the speeds at which an eigenvalue crosses the imaginary axis.

# %%
stability = bicycle.stability("v", 0, 10, 41)
stability.crossings

# %%
stability.plot();

# %%
found = sorted(crossing.value for crossing in stability.crossings if crossing.value > 1)
published = [4.292382536341, 6.024262015388]
assert np.allclose(found, published, rtol=0, atol=1e-9)

# %% [markdown]
# Between 4.29 and 6.02 m/s all real parts are negative: the oscillation (*weave*) has died out, and the slow falling (*capsize*) has not begun. The paper
# gives the two speeds with 13 digits; these are the same.
#
# ## The same by a push
#
# Linear models are about small motions. The full equations tell what a bicycle does after a push against its frame.

# %%
figure, axes = plt.subplots()
lean = {}
for speed in (3.5, 5.0, 8.0):
    pushed = bicycle.with_(v=speed).simulate(to=4, every="0.02", initial={"phi'": "0.1"}, error_estimate=False)
    lean[speed] = pushed
    axes.plot(pushed.t, np.degrees(pushed["phi"]), label=f"{speed} m/s, {pushed.outcome.kind}")
axes.set_xlabel("t, s")
axes.set_ylabel("lean, degrees")
axes.set_ylim(-30, 30)
axes.legend();

# %% [markdown]
# **The surprise.** At 5 m/s the bicycle recovers, and it does so by steering *into* the fall: the handlebar turns to the side to which the frame leans,
# with nobody holding it. It does not return to its old heading, since no force of the system depends on the heading.

# %%
run = lean[5.0]
run.plot("phi", "delta", "psi");

# %%
assert abs(run["phi"][-1]) < 0.1 * np.abs(run["phi"]).max()
assert abs(run["psi"][-1]) > 0.01, "another direction"
early = (run.t > 0.1) & (run.t < 0.4)
assert (np.sign(run["phi"][early]) == np.sign(run["delta"][early])).all(), "it steers into the fall"
run.animate()
