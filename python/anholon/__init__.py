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
from .dynamics import Dynamics
from .equations import Equations, Proof, verify
from .from_sympy import from_sympy
from .model import Check, Model, load, loads, zoo
from .run import Figure, Page, Run
from .sweep import Sweep, normal, uniform

__version__: str = version()

__all__ = [
    "Check",
    "ColumnError",
    "Comparison",
    "Dynamics",
    "Equations",
    "Figure",
    "Interrupted",
    "LinearModel",
    "Model",
    "ModelError",
    "MotionError",
    "Number",
    "Page",
    "Proof",
    "Run",
    "Stability",
    "State",
    "Sweep",
    "from_sympy",
    "load",
    "loads",
    "normal",
    "uniform",
    "verify",
    "version",
    "zoo",
]
