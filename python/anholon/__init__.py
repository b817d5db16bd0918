"""Anholon: equations of nonholonomic systems, their proof and their motion.

    >>> import anholon as an
    >>> disc = an.load("disc")
    >>> run = disc.simulate(to=10, every=0.01, initial={"theta": 1.3, "phi'": 6})
    >>> run["theta"].shape
    (1001,)
"""

from ._core import version
from ._errors import ColumnError, Interrupted, ModelError, MotionError
from ._numbers import Number
from .analysis import Comparison, LinearModel, Stability, State
from .builder import Builder, Constraint
from .check import Check
from .dynamics import Dynamics
from .equations import Equations, Proof, verify
from .expressions import Body, call, Condition, Equation, ex, Expr, expr, ey, ez, here, pi, Place, Rotation, t, vector
from .from_sympy import from_sympy
from .functions import (
    acc,
    acos,
    acosh,
    angvel,
    asin,
    asinh,
    atan,
    atan2,
    atanh,
    choose,
    cos,
    cosh,
    cross,
    dot,
    euler,
    exp,
    log,
    maximum,
    minimum,
    norm,
    norm2,
    piecewise,
    quat,
    rot,
    rotx,
    roty,
    rotz,
    sign,
    sin,
    sinh,
    sqrt,
    tan,
    tanh,
    unit,
    vel,
)
from .model import Model
from .reading import load, loads, zoo
from .run import Figure, Page, Run
from .sweep import Sweep, grid, normal, uniform
from .sweep_folder import open_sweep, SweepFolder

__version__: str = version()

__all__ = [
    "Body",
    "Builder",
    "Check",
    "ColumnError",
    "Comparison",
    "Condition",
    "Constraint",
    "Dynamics",
    "Equation",
    "Equations",
    "Expr",
    "Figure",
    "Interrupted",
    "LinearModel",
    "Model",
    "ModelError",
    "MotionError",
    "Number",
    "Page",
    "Place",
    "Proof",
    "Rotation",
    "Run",
    "Stability",
    "State",
    "Sweep",
    "SweepFolder",
    "acc",
    "acos",
    "acosh",
    "angvel",
    "asin",
    "asinh",
    "atan",
    "atan2",
    "atanh",
    "call",
    "choose",
    "cos",
    "cosh",
    "cross",
    "dot",
    "euler",
    "ex",
    "exp",
    "expr",
    "ey",
    "ez",
    "from_sympy",
    "grid",
    "here",
    "load",
    "loads",
    "log",
    "maximum",
    "minimum",
    "norm",
    "norm2",
    "normal",
    "open_sweep",
    "pi",
    "piecewise",
    "quat",
    "rot",
    "rotx",
    "roty",
    "rotz",
    "sign",
    "sin",
    "sinh",
    "sqrt",
    "t",
    "tan",
    "tanh",
    "uniform",
    "unit",
    "vector",
    "vel",
    "verify",
    "version",
    "zoo",
]
