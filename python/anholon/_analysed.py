"""The analyses of a model that need no motion: equations, proofs, comparisons, states, linear models."""

from __future__ import annotations

import numbers
from collections.abc import Iterable, Mapping

from . import _core
from ._described import Described
from ._errors import ModelError
from ._names import names_of, spelled
from ._numbers import Number, list_of, spaced, text_of, texts_of
from .analysis import Comparison, LinearModel, PublishedEquations, Stability, State, equation_text
from .equations import Equations, Proof


def _whole_digits(digits: object) -> int:
    if isinstance(digits, bool) or not isinstance(digits, numbers.Integral):
        raise ModelError(f"digits is a whole number from 1 to 2000, not {digits!r:.60}")
    return int(digits)


class Analysed(Described):
    """A model with its equations, proofs and comparisons, and with analyses at one state or over a parameter."""

    # ---- its equations ----

    def forms(self) -> list[_core.Form]:
        """Lists all classical forms of the equations; each form tells whether it applies to the model, and if not, why.

        Example:
            >>> import anholon as an
            >>> [form.name for form in an.load("disc").forms() if form.name.startswith("chaplygin")]
            ['chaplygin']
        """
        return self._core.forms()

    def equations(self, form: str = "routh", *, expand: str = "auto", steps: bool = False, reactions: bool = False) -> Equations:
        """Derives the equations of motion in a classical form.

        Args:
            form: a name that :meth:`forms` lists.
            expand: how far sums and products are written out: ``auto``, ``none``, ``paper``, ``full`` or ``parts``.
            steps: adds the quantities from which the equations follow: energies, momenta, forces.
            reactions: adds the ideal reactions of the constraints.

        Raises:
            ModelError: the form is not known or does not apply to the model.
        """
        return Equations(_core.derive(self._core, form, expand, steps, reactions))

    def reactions(self, form: str = "routh") -> Equations:
        """Derives the equations together with the ideal reactions of the constraints."""
        return self.equations(form, reactions=True)

    def prove(self, *forms: str | Iterable[str]) -> Proof:
        """Proves that the forms named agree with Routh's equations; without names, all forms that apply.

        Raises:
            ModelError: a form is not known.
        """
        return Proof(_core.prove(self._core, [name for form in forms for name in names_of(form)]))

    # ---- at a state ----

    def compare(self, equations: PublishedEquations, *, eliminate: str | Iterable[str] = (), initial: Mapping[str, Number] | None = None) -> Comparison:
        """Compares published equations with the derived ones: tells which are true, and where the others are wrong.

        Args:
            equations: a text with one equation per line, ``LABEL: left = right``, in the names of the model; a path, or
                the name of shipped equations; ``{label: equation}``; or a list.
            eliminate: coordinates that reduced forms eliminate.
            initial: the state near which these coordinates are eliminated.

        Returns:
            A sequence with ``verdict``, ``nearest``, ``difference`` and ``suggestions`` for each equation. Its truth value is
            True if all equations are true.

        Raises:
            ModelError: an equation has a mistake, or there is no such file.

        Example:
            >>> import anholon as an
            >>> sleigh = an.load("chaplygin-sleigh")
            >>> sleigh.compare(["blade: x'*sin(th) - y'*cos(th) = 0"])["blade"].verdict
            'true'

        Source: the criterion of ``anholon compare`` (theory: proof).
        """
        text, is_file = equation_text(equations)
        return Comparison(self.title, _core.compare(self._core, text, is_file, "equations", names_of(eliminate), texts_of(initial)))

    def evaluate(
        self,
        *,
        initial: Mapping[str, Number] | None = None,
        t: Number | None = None,
        form: str = "routh",
        eliminate: str | Iterable[str] = (),
        digits: int = 16,
    ) -> State:
        """Computes forces, accelerations, multipliers, reactions, energies and residuals at one state.

        Args:
            initial: values instead of those of the file: ``{"theta": 1.3, "phi'": 6}``, SI. The initial value of a state of the
                model is the value of a parameter, which :meth:`Model.with_` sets.
            t: the time, s.
            form: the form of the equations.
            eliminate: coordinates that forms without multipliers eliminate.
            digits: the number of digits; numbers of more than 16 digits are ``mpmath.mpf``.

        Raises:
            ModelError: an argument makes no sense.
            MotionError: no state satisfies the constraints, the configuration is singular, or a formula has no value.

        Example:
            >>> import anholon as an
            >>> state = an.load("disc").evaluate(initial={"phi'": 6})
            >>> len(state.accelerations), state.residuals["newton"] < 1e-14
            (5, True)
        """
        given, digits = texts_of(initial), _whole_digits(digits)
        if t is not None:
            given["t"] = text_of(t)
        core = _core.evaluate(self._system(form, given, eliminate), digits)
        options = {"initial": given, "form": form, "eliminate": names_of(eliminate), "digits": digits}
        return State(core, [c.name for c in self.coordinates], digits, (self, options))

    def linearize(
        self,
        *,
        about: str = "state",
        initial: Mapping[str, Number] | None = None,
        t: Number | None = None,
        form: str = "routh",
        eliminate: str | Iterable[str] = (),
        digits: int = 16,
    ) -> LinearModel:
        """Computes the linear model z' = A z + B u, y = C z + D u, in which u are the inputs of the file and y its outputs.

        An input with a formula is a feedback, which A contains; u is then what is added to the formula.

        Args:
            about: ``"state"`` for the initial state, ``"equilibrium"`` for the state of rest near the initial positions.
            initial: values instead of those of the file; for an equilibrium, the positions at which the search begins.
            t: the time, s.
            form: the form of the equations.
            eliminate: coordinates that forms without multipliers eliminate.
            digits: the number of digits; :meth:`LinearModel.exact` returns numbers of more than 16 digits.

        Raises:
            ModelError: an argument makes no sense.
            MotionError: the configuration is singular, there is no equilibrium, or eigenvalues could not be enclosed.

        Example:
            >>> import anholon as an
            >>> tractor = an.load("trailers").linearize()
            >>> tractor.inputs, tractor.B.shape[1]
            (['drive', 'steer'], 2)

        Source: dE/dx of the equations and of their derivatives (theory: linear-models).
        """
        digits = _whole_digits(digits)
        return LinearModel(_core.linearize(self._core, form, self._linear(about, initial, t), names_of(eliminate), about == "equilibrium", digits))

    @staticmethod
    def _linear(about: str, initial: Mapping[str, Number] | None, t: Number | None) -> dict[str, str]:
        if about not in ("state", "equilibrium"):
            raise ModelError(f"about cannot be {about!r}\nhint: 'state' or 'equilibrium'")
        given = texts_of(initial)
        if t is not None:
            given["t"] = text_of(t)
        return given

    def stability(
        self,
        parameter: str,
        low: Number | Iterable[Number],
        high: Number | None = None,
        n: int = 101,
        *,
        about: str = "state",
        initial: Mapping[str, Number] | None = None,
        t: Number | None = None,
        form: str = "routh",
        eliminate: str | Iterable[str] = (),
        digits: int = 16,
    ) -> Stability:
        """Computes eigenvalues over a parameter, as curves, and the values at which they cross the imaginary axis.

        The initial data are solved anew for each value. Two opposite crossings between neighbouring values are not
        detected.

        Args:
            parameter: the name of the parameter.
            low: the first value, or all values. A bare number is in the unit that the model declares for the parameter, else in
                SI units.
            high: the last value.
            n: the number of values, which are equally far apart.
            about: ``"state"`` or ``"equilibrium"``, as in :meth:`linearize`, which has the other arguments, too.

        Raises:
            ModelError: there is no such parameter, or an argument makes no sense.
            MotionError: no initial state satisfies the constraints.

        Example:
            >>> import anholon as an
            >>> [c.value for c in an.load("whipple").stability("v", 0, 10, 11).crossings]
            [4.292382536341104, 6.024262015388359]
        """
        digits = _whole_digits(digits)
        if isinstance(low, Iterable) and not isinstance(low, str):
            values = list_of(low)
        elif high is None:
            values = [text_of(low)]
        elif n < 2:
            raise ModelError(f"n: {n} values do not reach from low to high\nhint: 2 or more")
        else:
            values = spaced(low, high, n)
        given = self._linear(about, initial, t)
        return Stability(_core.stability(self._core, spelled(parameter), values, form, given, names_of(eliminate), about == "equilibrium", digits))
