# %% [markdown]
# # 5. A map of gaits
#
# A snakeboard is a board on two trucks that can be steered. Its rider never touches the ground: the rider turns the upper body to and fro and steers in
# time with it, and the board moves. Which rhythm moves it farthest?

# %%
import anholon as an
import matplotlib.pyplot as plt
import numpy as np

text = an.load("snakeboard").text
# The rider's upper body swings with the torque A1 sin(wf t); the trucks are steered with the same rhythm, earlier by an angle `ahead`.
text = text.replace("A2*cos(wf*t)", "A2*sin(wf*t + ahead)").replace("A1 = 0.5", "ahead = 0\nA1 = 0.5")
board = an.loads(text)
rest: dict[str, an.Number] = {"th": 0, "ps": 0, "ph": "0.01", "th'": 0, "ps'": 0, "ph'": 0}
board

# %% [markdown]
# ## One gait
#
# The start is at rest.

# %%
run = board.with_(ahead=np.pi / 2, wf=3).simulate(to=20, every="0.02", initial=rest, error_estimate=False)
run

# %%
run.plot("y", x="x")
plt.axis("equal");

# %%
run.animate()

# %% [markdown]
# ## The map
#
# `sweep` computes a motion for every pair of a rhythm and an angle, on all cores, and keeps the last state of each.

# %%
rhythms = np.linspace(1, 6, 31)
angles = np.linspace(0, 2 * np.pi, 25)
sweep = board.sweep({"wf": rhythms, "ahead": angles}, to=20, initial=rest)
sweep

# %%
distance = np.hypot(sweep["x"], sweep["y"]).reshape(len(rhythms), len(angles))
plt.pcolormesh(np.degrees(angles), rhythms, distance, shading="nearest")
plt.colorbar(label="distance after 20 s, m")
plt.xlabel("steering ahead of the swing, degrees")
plt.ylabel("rhythm, rad/s");

# %%
k, j = np.unravel_index(np.argmax(distance), distance.shape)
print(f"best: {rhythms[k]:.2f} rad/s, {np.degrees(angles[j]):.0f} degrees ahead: {distance[k, j]:.2f} m")
worst = distance[k].min()
print(f"worst angle at the same rhythm: {worst:.3f} m")

# %% [markdown]
# **The surprise.** Strength does not matter as much as timing: at the best rhythm the same swing and the same steering move the board far or
# hardly at all, and only the angle between the two decides. The rider never pushes the board: with the trucks held straight it only turns to and
# fro in its place.

# %%
straight = board.with_(A2=0).simulate(to=20, every=1, initial={**rest, "ph": "1e-6"}, error_estimate=False)
print(np.hypot(straight["x"], straight["y"]).max())
assert distance[k, j] > 3 * worst
