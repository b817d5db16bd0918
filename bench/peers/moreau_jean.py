"""The time stepping of Moreau and Jean with impacts by Newton's law and Coulomb's friction in a plane.

A step of length h takes the smooth forces at its middle, then solves, for the contacts whose gap closes within half a step,

    u = W p + b,   0 <= u_N + e u_N(before)  and  0 <= p_N,  one of them zero,   |p_T| <= mu p_N against u_T,

and moves the places by the mean of the velocities before and after. Its error is of first order in h from the first impact on.
Rows of `rows(q)` are the gradients of gap and tangential place of each contact, one after the other.
"""

import math
from dataclasses import dataclass
from typing import Callable

import numpy as np


@dataclass
class System:
    places: list[float]
    velocities: list[float]
    mass: Callable  # (q) -> matrix
    force: Callable  # (q, v) -> forces, including those that depend on velocities
    gaps: Callable  # (q) -> list
    rows: Callable  # (q) -> matrix of two rows for each contact
    restitution: list[float]
    friction: float


def impulses(W, b, before, restitution, friction):
    """Returns the impulses by the method of Gauss and Seidel, to round-off. Raises ArithmeticError if it does not converge."""
    p = np.zeros(len(b))
    for _ in range(100000):
        old = p.copy()
        for c, e in enumerate(restitution):
            n, t = 2 * c, 2 * c + 1
            for _ in range(60):
                p[n] = max(0.0, p[n] - (W[n] @ p + b[n] + e * before[n]) / W[n, n])
                held, most = p[t] - (W[t] @ p + b[t]) / W[t, t], friction * p[n]
                last, p[t] = p[t], min(max(held, -most), most)
                if abs(p[t] - last) <= 1e-15 * abs(last):
                    break
        if np.abs(p - old).max() <= 1e-14 * np.abs(p).max():
            return p
    raise ArithmeticError("the impulses do not converge")


def smooth_step(s, q, v, h):
    after = v
    for _ in range(40):
        last, mean = after, (after + v) / 2
        middle = q + h / 2 * mean
        after = v + h * np.linalg.solve(s.mass(middle), s.force(middle, mean))
        if np.abs(after - last).max() <= 1e-15 * np.abs(after).max():
            break
    return after


def moreau_jean(s, h, times):
    """Returns places and velocities at the times, which are multiples of the step."""
    q, v, found = np.array(s.places, float), np.array(s.velocities, float), []
    for k in range(round(max(times) / h) + 1):
        if any(round(t / h) == k for t in times):
            found.append((q.copy(), v.copy()))
        after, rows = smooth_step(s, q, v, h), s.rows(q)
        closing = [c for c, gap in enumerate(s.gaps(q)) if gap + h / 2 * (rows[2 * c] @ v) <= 0]
        if closing:
            H = rows[[j for c in closing for j in (2 * c, 2 * c + 1)]]
            inverse = np.linalg.inv(s.mass(q))
            p = impulses(H @ inverse @ H.T, H @ after, H @ v, [s.restitution[c] for c in closing], s.friction)
            after = after + inverse @ H.T @ p
        q, v = q + h / 2 * (v + after), after
    return found


def woodpecker():
    """Returns the system of models/contacts/woodpecker.toml."""
    mM, JM, mS, JS, c, g = 0.0003, 5e-9, 0.0045, 7e-7, 0.0056, 9.81
    play, rM, hM, lM, lG, hS, lS, r0 = 0.0006, 0.0031, 0.0058, 0.01, 0.015, 0.02, 0.0201, 0.0025
    bird = np.array([1, lM, lG])  # the height of its mass centre
    mass = np.diag([mM, JM, JS]) + mS * np.outer(bird, bird)
    spring = c * np.array([[0, 0, 0], [0, 1, -1], [0, -1, 1]])
    weight = -g * (mS * bird + np.array([mM, 0, 0]))
    rows = np.array([[0, 0, -hS], [1, lM, lG - lS], [0, hM, 0], [1, rM, 0], [0, -hM, 0], [1, rM, 0]])
    open_by = np.array([lM + lG - lS - r0, play, play])
    return System(
        [0, -play / hM, -0.2788],
        [-0.3411, 0, -7.4583],
        lambda q: mass,
        lambda q, v: weight - spring @ q,
        lambda q: open_by + rows[::2] @ q,
        lambda q: rows,
        [0.5, 0, 0],
        0.3,
    )


def slider_crank():
    """Returns the system CRANK of siconos.py."""
    l1, l2, a, b, c = 0.153, 0.306, 0.05, 0.025, 0.001
    m1, m2, m3, J1, J2, J3, g = 0.038, 0.038, 0.076, 7.4e-5, 5.9e-4, 2.7e-6, 9.81
    joint = (m2 / 2 + m3) * l1 * l2
    crank, rod = J1 + (m1 / 4 + m2 + m3) * l1**2, J2 + (m2 / 4 + m3) * l2**2
    corners = [(-1, 1), (1, 1), (-1, -1), (1, -1)]

    def mass(q):
        k = joint * math.cos(q[1] - q[0])
        return np.array([[crank, k, 0], [k, rod, 0], [0, 0, J3]])

    def force(q, v):
        k = joint * math.sin(q[0] - q[1])
        weights = [(m1 / 2 + m2 + m3) * g * l1 * math.cos(q[0]), (m2 / 2 + m3) * g * l2 * math.cos(q[1])]
        return np.array([-k * v[1] ** 2 - weights[0], k * v[0] ** 2 - weights[1], 0])

    def gaps(q):
        middle = l1 * math.sin(q[0]) + l2 * math.sin(q[1])
        return [b + c - up * (middle + ahead * a * math.sin(q[2]) + up * b * math.cos(q[2])) for ahead, up in corners]

    def rows(q):
        (s1, s2, s3), (c1, c2, c3) = [[f(x) for x in q] for f in (math.sin, math.cos)]
        return np.array(
            [
                row
                for ahead, up in corners
                for row in (
                    [-up * l1 * c1, -up * l2 * c2, -up * (ahead * a * c3 - up * b * s3)],
                    [-l1 * s1, -l2 * s2, -ahead * a * s3 - up * b * c3],
                )
            ]
        )

    return System([0, 0, 0], [150, -75, 0], mass, force, gaps, rows, [0.4] * 4, 0.01)
