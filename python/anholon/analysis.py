"""Results of analyses of a model: comparisons of published equations, states, linear models, stability."""

from __future__ import annotations

import html
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Union

from . import _core, _display
from ._names import ByName
from ._numbers import exact_numbers

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]
    ComplexArray = npt.NDArray[np.complex128]

PublishedEquations = Union[str, "os.PathLike[str]", Mapping[str, str], Iterable[str]]
"""Equations: a text with one equation per line, ``LABEL: left = right``; a path or the name of shipped equations; equations
by their labels; or a list of equations."""

_DOUBLE = 16  # digits


def equation_text(equations: PublishedEquations) -> tuple[str, bool]:
    """Returns the text of equations or the path of their file, and True if it is a path."""
    if isinstance(equations, str):
        return equations, "=" not in equations
    if isinstance(equations, os.PathLike):
        return os.fspath(equations), True
    if isinstance(equations, Mapping):
        return "\n".join(f"{label}: {equation}" for label, equation in equations.items()), False
    if not isinstance(equations, Iterable):
        raise TypeError(f"equations are a text, a path, {{label: equation}} or a list, not a {type(equations).__name__}")
    return "\n".join(equations), False


class Comparison(Sequence[_core.ComparedEquation]):
    """Published equations, each with its verdict: ``true``, ``false`` or ``unknown``.

    Example:
        >>> import anholon as an
        >>> pendulum = an.loads('''
        ... coordinates = ["th"]
        ... parameters = {m = 1, l = 1, g = 9.81}
        ... particle = [{name = "bob", mass = "m", position = ["l*sin(th)", "-l*cos(th)", 0]}]
        ... gravity.field = "-g*ey"
        ... ''')
        >>> found = pendulum.compare({"good": "l*th'' + g*sin(th) = 0", "bad": "l*th'' + g*cos(th) = 0"})
        >>> [line.verdict for line in found]
        ['true', 'false']
        >>> found["bad"].suggestions[0].reads
        "l*th'' + g*sin(th) = 0"
    """

    def __init__(self, title: str, lines: list[_core.ComparedEquation]) -> None:
        self.title: str = title
        self.lines: list[_core.ComparedEquation] = lines

    @property
    def all_true(self) -> bool:
        """True if every equation is proved to be true."""
        return all(line.verdict == "true" for line in self.lines)

    def __bool__(self) -> bool:
        return self.all_true

    def __len__(self) -> int:
        return len(self.lines)

    def __iter__(self) -> Iterator[_core.ComparedEquation]:
        return iter(self.lines)

    def __getitem__(self, which: Any) -> Any:
        """Returns an equation by its label or number.

        Raises:
            KeyError: no equation has this label.
        """
        if isinstance(which, str):
            for line in self.lines:
                if line.label == which:
                    return line
            raise KeyError(which)
        return self.lines[which]

    def __repr__(self) -> str:
        return "\n".join([self.title, *(repr(line) for line in self.lines)])

    def _repr_html_(self) -> str:
        signs = {"true": "✓", "false": "✗", "unknown": "?"}
        rows = ""
        for line in self.lines:
            told = line.what or line.detail
            if line.verdict == "false":
                near = f"nearest: {line.nearest}" if line.nearest else f"not zero at {line.point}"
                told = "; ".join(s.text for s in line.suggestions) or near
            cells = (line.label, line.text, f"{signs[line.verdict]} {line.verdict}", told)
            rows += "<tr>" + "".join(f"<td style='text-align:left'>{html.escape(cell)}</td>" for cell in cells) + "</tr>"
        return f"<table><caption>{html.escape(self.title)}</caption><tbody>{rows}</tbody></table>"


class State:
    """Forces, accelerations, multipliers, reactions, energies and residuals at one state; see :meth:`Model.evaluate`.

    Numbers are in SI units. They are ``float``; those of more than 16 digits are ``mpmath.mpf`` if mpmath is installed, else texts.

    Example:
        >>> import anholon as an
        >>> state = an.load("chaplygin-sleigh").evaluate()
        >>> round(state.multipliers["blade_edge"], 12)
        -0.614754098361
        >>> sorted(state.energies)[:2]
        ['S_r', 'T_r']
    """

    def __init__(self, core: _core.StateReport, coordinates: Sequence[str], digits: int, again: tuple[Any, dict[str, Any]]) -> None:
        self._core, self._coordinates, self._digits = core, list(coordinates), digits
        self._again = again  # the model, and the options of Model.evaluate

    def __reduce__(self) -> tuple[Any, tuple[Any, dict[str, Any]]]:
        """Pickles the model and the options: another process evaluates the state again, with the same numbers."""
        return _evaluated, self._again

    def _numbers(self, texts: Sequence[str]) -> list[Any]:
        return [float(text) for text in texts] if self._digits <= _DOUBLE else exact_numbers(texts)

    def _named(self, pairs: Sequence[tuple[str, str]]) -> dict[str, Any]:
        return ByName(zip([name for name, _ in pairs], self._numbers([text for _, text in pairs]), strict=True))

    @property
    def form(self) -> str:
        """The form of the equations."""
        return self._core.form

    @property
    def t(self) -> Any:
        """The time, s."""
        return self._numbers([self._core.t])[0]

    @property
    def q(self) -> dict[str, Any]:
        """The coordinates by name."""
        return self._named(self._core.q)

    @property
    def qdot(self) -> dict[str, Any]:
        """The velocities by name, "x'"."""
        return self._named([(name + "'", text) for name, text in self._core.qdot])

    @property
    def forces(self) -> dict[str, dict[str, Any]]:
        """The generalized forces by their symbol of the notation ("Q", "QR", "N", …), then by coordinate."""
        return {name: dict(zip(self._coordinates, self._numbers(values), strict=True)) for name, values in self._core.forces}

    @property
    def accelerations(self) -> dict[str, Any]:
        """Accelerations by name, "x''", and higher derivatives that the equations determine."""
        return self._named(self._core.derivatives)

    @property
    def multipliers(self) -> dict[str, Any]:
        """The multipliers by the names of their constraints."""
        return self._named([(name.removeprefix("lambda."), text) for name, text in self._core.multipliers])

    @property
    def energies(self) -> dict[str, Any]:
        """Kinetic energy ``T_r``, energy of accelerations ``S_r``, potentials, and the terms of the power identity."""
        return self._named(self._core.numbers)

    @property
    def mass_matrix(self) -> Any:
        """The mass matrix d²T/dq'dq', shape (coordinates, coordinates): an array, or lists if numbers have more than 16 digits."""
        rows = [self._numbers(row) for row in self._core.mass_matrix]
        if self._digits > _DOUBLE:
            return rows
        import numpy as np

        return np.array(rows).reshape(len(self._coordinates), -1)

    @property
    def reactions(self) -> dict[str, dict[str, list[Any]]]:
        """The reaction on each body: ``force`` (N) and ``torque`` (N m) about its mass centre, along the observer's axes."""
        return {body: {"force": self._numbers(force), "torque": self._numbers(torque)} for body, force, torque in self._core.reactions}

    @property
    def residuals(self) -> dict[str, float]:
        """Relative residuals of Newton's law, the constraints and the power identity."""
        return {name: float(text) for name, text in self._core.residuals}

    def __repr__(self) -> str:
        parts = [("accelerations", self.accelerations), ("multipliers", self.multipliers), ("energies", self.energies)]
        lines = [f"state at t = {self._core.t}", *(f"  {name} = {value}" for name, value in {**self.q, **self.qdot}.items())]
        for title, values in parts:
            if values:
                lines += [title, *(f"  {name} = {value}" for name, value in values.items())]
        return "\n".join(lines)


def _evaluated(model: Any, options: dict[str, Any]) -> State:
    state: State = model.evaluate(**options)
    return state


class LinearModel:
    """The linear model z' = A z + B u, y = C z + D u of a motion at one state; see :meth:`Model.linearize`.

    Example:
        >>> import anholon as an
        >>> bicycle = an.load("whipple").linearize()
        >>> bicycle.motion, len(bicycle.core), bicycle.A.shape == 2 * (len(bicycle.states),)
        ('steady', 5, True)
    """

    def __init__(self, core: _core.LinearModel) -> None:
        self._core = core

    @property
    def motion(self) -> str:
        """The kind of the motion: 'equilibrium', 'steady' (only coordinates and states without influence move), 'unsteady' (A holds for an
        instant, and its eigenvalues tell nothing about stability) or 'unchecked'."""
        return self._core.motion

    @property
    def why(self) -> str:
        """The reason why a motion is unsteady or unchecked."""
        return self._core.why

    @property
    def t(self) -> float:
        """The time of the state, s."""
        return self._core.t

    @property
    def states(self) -> list[str]:
        """The independent coordinates and velocities z."""
        return self._core.states

    @property
    def dependent(self) -> list[str]:
        """Coordinates and velocities that follow from z by the constraints."""
        return self._core.dependent

    @property
    def cyclic(self) -> list[str]:
        """The coordinates and states among z that do not influence the core, such as the place of a bicycle on the ground."""
        return self._core.cyclic

    @property
    def core(self) -> list[str]:
        """The entries of z that are not cyclic. The eigenvalues are those of the rows and columns of A that belong to them."""
        return self._core.core

    @property
    def inputs(self) -> list[str]:
        """The names of the inputs u."""
        return self._core.inputs

    @property
    def outputs(self) -> list[str]:
        """The names of the outputs y."""
        return self._core.outputs

    @property
    def notes(self) -> list[str]:
        """Inputs and outputs that do not occur in the model."""
        return self._core.notes

    @property
    def values(self) -> list[float]:
        """The values of z at the state, in SI units."""
        return self._core.values

    @property
    def A(self) -> Array:
        """The matrix A of z' = A z + B u, shape (states, states), in SI units."""
        return self._core.A

    @property
    def B(self) -> Array:
        """The matrix B of z' = A z + B u, shape (states, inputs), in SI units."""
        return self._core.B

    @property
    def C(self) -> Array:
        """The matrix C of y = C z + D u, shape (outputs, states). An output that has a unit in the file is in that unit, as in a run; the
        rest is in SI units."""
        return self._core.C

    @property
    def D(self) -> Array:
        """The matrix D of y = C z + D u, shape (outputs, inputs), in the units of C."""
        return self._core.D

    @property
    def eigenvalues(self) -> list[complex]:
        """The eigenvalues of A over the core, 1/s. An eigenvalue of multiplicity k occurs k times."""
        return self._core.eigenvalues

    @property
    def multiplicities(self) -> list[int]:
        """The multiplicity of each eigenvalue."""
        return self._core.multiplicities

    @property
    def modes(self) -> ComplexArray:
        """The eigenvectors over the core, whose largest entries are 1, shape (eigenvalues, core): row i belongs to eigenvalue i."""
        import numpy as np

        return np.array(self._core.modes, dtype=np.complex128).reshape(-1, len(self.core))

    def exact(self, name: str) -> Any:
        """Returns A, B, C, D (as rows), ``values`` or ``eigenvalues`` with all digits that were asked for: numbers of mpmath if it
        is installed, else texts.

        Raises:
            ValueError: no more than 16 digits were asked for.
            KeyError: `name` is another word.
        """
        if name in ("A", "B", "C", "D"):
            texts = list(getattr(self._core, name + "_texts"))
            rows, columns = getattr(self, name).shape
            self._sharp(texts or rows * columns == 0)
            numbers = exact_numbers(texts)
            return [numbers[r * columns : (r + 1) * columns] for r in range(rows)]
        if name == "values":
            self._sharp(self._core.value_texts or not self.values)
            return exact_numbers(self._core.value_texts)
        if name == "eigenvalues":
            self._sharp(self._core.eigenvalue_texts or not self.eigenvalues)
            parts = [exact_numbers(pair) for pair in self._core.eigenvalue_texts]
            if parts and isinstance(parts[0][0], str):
                return [tuple(pair) for pair in parts]
            import mpmath

            return [mpmath.mpc(re, im) for re, im in parts]
        raise KeyError(name)

    @staticmethod
    def _sharp(there: Any) -> None:
        if not there:
            raise ValueError("there are no more digits than those of floats; ask for some: linearize(digits=30)")

    def __repr__(self) -> str:
        listed = ", ".join(f"{e:.6g}" for e in self.eigenvalues)
        motion = {
            "equilibrium": "an equilibrium",
            "steady": "a steady motion",
            "unsteady": "a state that is not steady",
            "unchecked": "a motion not checked to be steady",
        }[self.motion]
        return f"<linear model of {motion}: {len(self.states)} states, {len(self.inputs)} inputs; eigenvalues {listed}>"

    def _repr_html_(self) -> str:
        return _display.linear_model(self)

    def _repr_latex_(self) -> str:
        return _display.linear_model_latex(self)


class Stability:
    """Eigenvalues over values of a parameter, and the values at which they cross the imaginary axis; see :meth:`Model.stability`.

    Example:
        >>> import anholon as an
        >>> bicycle = an.load("whipple").stability("v", 0, 10, 21)
        >>> [crossing.value for crossing in bicycle.crossings]
        [4.292382536341104, 6.024262015388359]
        >>> bicycle.eigenvalues.shape
        (21, 5)
    """

    def __init__(self, core: _core.Stability) -> None:
        self._core = core

    @property
    def parameter(self) -> str:
        """The name of the parameter."""
        return self._core.parameter

    @property
    def values(self) -> Array:
        """The values of the parameter, shape (values,), in the unit that the model declares for it, else in SI units."""
        import numpy as np

        return np.array(self._core.values)

    @property
    def eigenvalues(self) -> ComplexArray:
        """The eigenvalues as curves, shape (values, curves), 1/s: each column is a smooth curve, NaN at values without an eigenvalue."""
        import numpy as np

        return np.array(self._core.curves, dtype=np.complex128).reshape(len(self._core.curves), len(self._core.values)).T

    @property
    def models(self) -> list[LinearModel | None]:
        """The linear model at each value; None at a value without one, for which `outcomes` tells the reason."""
        return [LinearModel(m) if o.ok else None for m, o in zip(self._core.models, self._core.outcomes, strict=True)]

    @property
    def outcomes(self) -> list[_core.Outcome]:
        """The outcome of the computation at each value."""
        return self._core.outcomes

    @property
    def crossings(self) -> list[_core.Crossing]:
        """The crossings of the imaginary axis, to round-off, in the order of the values."""
        return self._core.crossings

    @property
    def stable(self) -> npt.NDArray[np.bool_]:
        """True where no eigenvalue has a positive real part, shape (values,). False where there is no linear model, and where the
        state is not steady, since its eigenvalues tell nothing about stability."""
        import numpy as np

        eigenvalues = self.eigenvalues
        known = np.array([o.ok and m.motion != "unsteady" for m, o in zip(self._core.models, self._core.outcomes, strict=True)], dtype=bool)
        return np.asarray(known & ~(np.nan_to_num(eigenvalues.real) > 0).any(axis=1))

    @property
    def notes(self) -> list[str]:
        """Crossings that were not found, and values at which one motion ends and another one is found."""
        return self._core.notes

    def plot(self, axes: Any = None) -> Any:
        """Draws real parts (lines) and imaginary parts (dashed) over the parameter with Matplotlib; returns the axes."""
        if axes is None:
            import matplotlib.pyplot

            axes = matplotlib.pyplot.figure().add_subplot()
        for k in range(self.eigenvalues.shape[1]):
            (line,) = axes.plot(self.values, self.eigenvalues[:, k].real)
            axes.plot(self.values, self.eigenvalues[:, k].imag, "--", color=line.get_color(), linewidth=0.7)
        for crossing in self.crossings:
            axes.axvline(crossing.value, color="0.7", linewidth=0.7)
        axes.axhline(0, color="0.3", linewidth=0.7)
        axes.set_xlabel(self.parameter)
        axes.set_ylabel("eigenvalues, 1/s")
        return axes

    def __repr__(self) -> str:
        lines = [f"eigenvalues over {len(self._core.values)} values of {self.parameter}", *(repr(c) for c in self.crossings), *self.notes]
        return "\n".join(lines)
