#!/usr/bin/env python3
"""A motion by SciPy's DOP853 with the generated Python, from the start of the process to its end; for bench/speed_commands.py.

    scipy_process.py MODULE TIME EVERY FILE      MODULE: what `anholon derive MODEL --format python` wrote

Writes rows at this interval as text with 17 digits. Tolerance 1e-12, relative and absolute.
"""

import importlib.util
import sys

import numpy as np
from scipy.integrate import solve_ivp

TOLERANCE = 1e-12


def main():
    path, time, every, file = sys.argv[1:]
    specification = importlib.util.spec_from_file_location("motion", path)
    motion = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(motion)
    grid = np.linspace(0.0, float(time), round(float(time) / float(every)) + 1)
    done = solve_ivp(motion.rhs, (0.0, float(time)), motion.START, "DOP853", grid, rtol=TOLERANCE, atol=TOLERANCE)
    if not done.success:
        raise RuntimeError(done.message)
    np.savetxt(file, np.column_stack([done.t, done.y.T]), fmt="%.17g", delimiter=",")


if __name__ == "__main__":
    main()
