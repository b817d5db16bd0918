"""Models: what they say, their equations and their motions."""

from __future__ import annotations

import html
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, overload

from . import _core
from ._errors import Interrupted, ModelError, MotionError
from ._numbers import Number, float_of, list_of, spaced, text_of, texts_of
from ._progress import Progress, Shown
from ._source import Source
from ._sweep_filling import SweepRequest, Words
from .analysis import Comparison, LinearModel, PublishedEquations, Stability, State, equation_text
from .check import Check
from .dynamics import Dynamics
from .equations import Equations, Proof
from .expressions import Expr
from .run import Run
from .sweep import Law, Sweep
from .sweep_folder import SweepFolder

if TYPE_CHECKING:
    from distributed import Client

_KEPT = 16  # prepared systems of a model


class Model:
    """A mechanical system, as a model file has it. It never changes: :meth:`with_` makes another one.

    Get one from :func:`load`, :func:`loads` or :func:`zoo`. Computations release the interpreter's lock; threads may share
    a model.

    Example:
        >>> import anholon as an
        >>> disc = an.load("disc")
        >>> disc
        <model 'Disc rolling on a plane': coordinates x, y, psi, theta, phi; 2 constraints>
    """

    def __init__(self, core: _core.Model, again: Source, given: dict[str, str], cases: list[str]) -> None:
        self._core = core
        self._again, self._given, self._cases = again, given, cases
        self._prepared: dict[Any, _core.System] = {}

    def __reduce__(self) -> tuple[Callable[..., Model], tuple[Source, dict[str, str], list[str]]]:
        """Another process reads the model again."""
        return made, (self._again, self._given, self._cases)

    # ---- what it says ----

    @property
    def title(self) -> str:
        """The title of the file."""
        return self._core.title

    @property
    def text(self) -> str:
        """The text it was read from."""
        return self._core.text

    @property
    def coordinates(self) -> list[_core.Coordinate]:
        """Names and units of the coordinates."""
        return self._core.coordinates

    @property
    def parameters(self) -> dict[str, float]:
        """The values of the parameters by name, in SI units."""
        return {p.name: p.value for p in self._core.parameters}

    @property
    def constraints(self) -> list[_core.Constraint]:
        """Names and orders of the constraints."""
        return self._core.constraints

    @property
    def states(self) -> list[str]:
        """Further states with rates of their own."""
        return self._core.states

    @property
    def inputs(self) -> list[str]:
        """The names of [input]."""
        return self._core.inputs

    @property
    def monitors(self) -> list[str]:
        """The names of [monitor] and [output], which are columns of a run."""
        return self._core.monitors

    @property
    def cases(self) -> list[str]:
        """The scenarios [case.NAME] of the file."""
        return self._core.cases

    @property
    def remarks(self) -> list[_core.Diagnostic]:
        """Warnings and notes of the reader."""
        return self._core.remarks

    def with_(self, *, case: str | Sequence[str] = (), **parameters: Number) -> Model:
        """The same model with other values of parameters, or with scenarios of the file laid over it.

        Args:
            case: names of [case.NAME], applied one after the other, after those that this model has already.
            parameters: new values; names that are no Python identifiers come as ``**{"k'": 2}``.

        Raises:
            ModelError: a parameter or a case is not known.

        Example:
            >>> import anholon as an
            >>> an.load("disc").with_(m=2, R="1/4").parameters["R"]
            0.25
        """
        given = {**self._given, **texts_of(parameters)}
        cases = [*self._cases, *([case] if isinstance(case, str) else case)]
        return Model(self._again(given, cases), self._again, given, cases)

    # ---- its equations ----

    def forms(self) -> list[_core.Form]:
        """All classical forms of the equations, with whether they apply, and why not.

        Example:
            >>> import anholon as an
            >>> [form.name for form in an.load("disc").forms() if form.name.startswith("chaplygin")]
            ['chaplygin']
        """
        return self._core.forms()

    def equations(self, form: str = "routh", *, expand: str = "auto", steps: bool = False, reactions: bool = False) -> Equations:
        """The equations of motion in a classical form.

        Args:
            form: a name that :meth:`forms` lists.
            expand: ``auto``, ``none``, ``paper``, ``full`` or ``parts``: how far sums and products are written out.
            steps: with the quantities that lead to them: energies, momenta, forces.
            reactions: with the ideal reactions.

        Raises:
            ModelError: the form is not known, or does not apply.
        """
        return Equations(_core.derive(self._core, form, expand, steps, reactions))

    def reactions(self, form: str = "routh") -> Equations:
        """The equations together with the ideal reactions of the constraints."""
        return self.equations(form, reactions=True)

    def prove(self, *forms: str) -> Proof:
        """Proves that forms (all that apply if none is named) agree with Routh's equations.

        Raises:
            ModelError: a form is not known.
        """
        return Proof(_core.prove(self._core, list(forms)))

    def check(self, *, form: str = "routh", initial: Mapping[str, Number] | None = None) -> Check:
        """What kind of system this is: degrees of freedom, kinds of constraints, the consistent initial state.

        Raises:
            MotionError: no state satisfies the constraints with the values given, or the configuration is singular.

        Example:
            >>> import anholon as an
            >>> check = an.load("disc").check()
            >>> check.degrees_of_freedom, check.constraints[0].kind
            (3, 'linear')
        """
        return Check(self, self._system(form, texts_of(initial), ()))

    # ---- its motion ----

    def initial(self, *, form: str = "routh", eliminate: Iterable[str] = (), **values: Number) -> list[_core.InitialValue]:
        """The consistent initial state, each value with where it comes from.

        Raises:
            MotionError: no state satisfies the constraints with the values given.
        """
        return self._system(form, texts_of(values), eliminate).initial

    def _system(self, form: str, initial: Mapping[str, str], eliminate: Iterable[str]) -> _core.System:
        key = (form, tuple(sorted(initial.items())), tuple(eliminate))
        if key not in self._prepared:
            while len(self._prepared) >= _KEPT:
                self._prepared.pop(next(iter(self._prepared)), None)
            self._prepared[key] = _core.prepare(self._core, form, dict(initial), list(key[2]))
        return self._prepared[key]

    def simulate(
        self,
        to: Number | None = None,
        *,
        every: Number | None = None,
        at: Iterable[Number] = (),
        initial: Mapping[str, Number] | None = None,
        tolerance: Number | None = None,
        form: str = "routh",
        eliminate: Iterable[str] = (),
        method: str | None = None,
        digits: int | None = None,
        order: int | None = None,
        error_estimate: bool | None = None,
        most_steps: int | None = None,
        dense: bool = False,
        stop: Callable[[], bool] | None = None,
        progress: Progress = None,
        **others: Number | bool,
    ) -> Run:
        """One motion. What happens to it never raises: ``run.outcome`` tells why it stopped and what to do.

        The numbers are those of ``anholon simulate`` with the same options, bit by bit.

        Args:
            to: the end, s; that of the file if it is None.
            every: a row at each multiple of it after the start, s; a row at each step if it is None.
            at: rows at these times and at no other, s.
            initial: values instead of those of the file: ``{"theta": 1.3, "phi'": 6}``, in SI units.
            tolerance: of each step, relative; 1e-12 if neither the file nor you say otherwise.
            form: of the equations, or ``auto``: the one whose motion takes the fewest operations.
            eliminate: coordinates that forms without multipliers eliminate; chosen if there are none.
            method: ``auto``, ``taylor``, ``rk`` or ``bdf``.
            digits: more than 16: multiple precision; see :meth:`Run.exact`.
            order: of the Taylor polynomials.
            error_estimate: digits to trust, by a second, sharper run; True: always, False: never, None: of short runs.
            most_steps: the motion ends after so many.
            dense: keeps the polynomials of all steps, so that ``run(t)`` has them; without, it makes the motion once more.
            stop: asked every 20 ms; True ends the motion.
            progress: True shows a bar, False none; a function is told the time and the number of steps every 20 ms. By default
                a bar appears after two seconds in a notebook and at a prompt.
            others: any option of ``anholon simulate`` that changes the motion, with _ for -: ``rigorous=64``.

        Raises:
            ModelError: an argument makes no sense.
            Interrupted: Ctrl-C; ``.result`` is the run as far as it came.

        Example:
            >>> import anholon as an
            >>> run = an.load("disc").simulate(to=10, every=0.01, initial={"phi'": 6})
            >>> len(run)
            1001
        """
        options = {"to": to, "every": every, "tolerance": tolerance, "method": method, "digits": digits, "order": order, "most-steps": most_steps}
        words = {name: text_of(value) for name, value in options.items() if value is not None}
        if error_estimate is not None:
            words["error-estimate"] = "always" if error_estimate else "never"
        for name, value in others.items():
            if value is not False and value is not None:
                words[name.replace("_", "-")] = "" if value is True else text_of(value)
        try:
            system = self._system(form, texts_of(initial), eliminate)
        except MotionError as error:
            return Run(self, None, error.outcome)
        times = list_of(at)

        def again() -> _core.Run:
            made, raised = _core.simulate(system, {**words, "error-estimate": "never"}, times, True, stop, None)
            if isinstance(raised, BaseException):
                raise raised
            return made

        end = float_of(times[-1] if times else words.get("to"))
        with Shown(progress, self.title, end, start=system.start) as tell:
            core, raised = _core.simulate(system, words, times, dense, stop, tell)
        run = Run(self, core, core.outcome, again)
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(run) from None
        if isinstance(raised, BaseException):
            raise raised
        return run

    def compare(self, equations: PublishedEquations, *, eliminate: Iterable[str] = (), initial: Mapping[str, Number] | None = None) -> Comparison:
        """Compares published equations with the derived ones: which are true, and where the others are wrong.

        Args:
            equations: a text with one equation per line, ``LABEL: left = right``, in the names of the model; a path, or
                the name of shipped equations; ``{label: equation}``; or a list.
            eliminate: coordinates that reduced forms eliminate.
            initial: the state near which they are eliminated.

        Returns:
            A list of lines with ``verdict``, ``nearest``, ``difference`` and ``suggestions``; true if all are.

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
        return Comparison(self.title, _core.compare(self._core, text, is_file, "equations", list(eliminate), texts_of(initial)))

    def evaluate(
        self,
        *,
        initial: Mapping[str, Number] | None = None,
        t: Number | None = None,
        form: str = "routh",
        eliminate: Iterable[str] = (),
        digits: int = 16,
    ) -> State:
        """Everything about one state: forces, accelerations, multipliers, reactions, energies, residuals.

        Args:
            initial: values instead of those of the file: ``{"theta": 1.3, "phi'": 6}``, SI.
            t: the time, s.
            form: of the equations.
            eliminate: coordinates that forms without multipliers eliminate.
            digits: of the numbers; more than 16 come as ``mpmath.mpf``.

        Raises:
            ModelError: an argument makes no sense.
            MotionError: no state satisfies the constraints, the configuration is singular, or a formula has no value.

        Example:
            >>> import anholon as an
            >>> state = an.load("disc").evaluate(initial={"phi'": 6})
            >>> len(state.accelerations), state.residuals["newton"] < 1e-14
            (5, True)
        """
        given = texts_of(initial)
        if t is not None:
            given["t"] = text_of(t)
        return State(_core.evaluate(self._system(form, given, eliminate), digits), [c.name for c in self.coordinates], digits)

    def linearize(
        self,
        *,
        about: str = "state",
        initial: Mapping[str, Number] | None = None,
        t: Number | None = None,
        form: str = "routh",
        eliminate: Iterable[str] = (),
        digits: int = 16,
    ) -> LinearModel:
        """The linear model z' = A z + B u, y = C z + D u, with [input] as u and [output] as y.

        Args:
            about: ``"state"``: the initial state; ``"equilibrium"``: the state of rest near the initial positions.
            initial: values instead of those of the file; for an equilibrium, positions where the search begins.
            t: the time, s.
            form: of the equations.
            eliminate: coordinates that forms without multipliers eliminate.
            digits: more than 16: :meth:`LinearModel.exact` has them.

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
        return LinearModel(_core.linearize(self._core, form, self._linear(about, initial, t), list(eliminate), about == "equilibrium", digits))

    @staticmethod
    def _linear(about: str, initial: Mapping[str, Number] | None, t: Number | None) -> dict[str, str]:
        if about not in ("state", "equilibrium"):
            raise ModelError(f"about: {about!r}\nhint: 'state' or 'equilibrium'")
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
        eliminate: Iterable[str] = (),
        digits: int = 16,
    ) -> Stability:
        """Eigenvalues over a parameter, as curves, and the values at which they cross the imaginary axis.

        The initial data are solved anew for each value. Two opposite crossings between neighbouring values are not
        detected.

        Args:
            parameter: its name.
            low: the first value, SI, or all values.
            high: the last value.
            n: how many values, equally far apart.
            about: ``"state"`` or ``"equilibrium"``, as in :meth:`linearize`, likewise the others.

        Raises:
            ModelError: there is no such parameter, or an argument makes no sense.
            MotionError: no initial state satisfies the constraints.

        Example:
            >>> import anholon as an
            >>> [c.value for c in an.load("whipple").stability("v", 0, 10, 11).crossings]
            [4.292382536341104, 6.024262015388359]
        """
        if isinstance(low, Iterable) and not isinstance(low, str):
            values = list_of(low)
        elif high is None:
            values = [text_of(low)]
        elif n < 2:
            raise ModelError(f"n: {n} values do not reach from low to high\nhint: 2 or more")
        else:
            values = spaced(low, high, n)
        given = self._linear(about, initial, t)
        return Stability(_core.stability(self._core, parameter, values, form, given, list(eliminate), about == "equilibrium", digits))

    @overload
    def sweep(
        self,
        vary: Mapping[str, Iterable[Number] | Law],
        *,
        to: Number | None = None,
        at: Iterable[Number] = (),
        columns: Iterable[str] = (),
        reduce: Iterable[str] = (),
        cases: int | None = None,
        together: bool = False,
        draw: str = "random",
        seed: int = 0,
        tolerance: Number | None = None,
        initial: Mapping[str, Number] | None = None,
        form: str = "routh",
        threads: int = 0,
        stop: Callable[[], bool] | None = None,
        progress: Progress = None,
        out: None = None,
    ) -> Sweep: ...

    @overload
    def sweep(
        self,
        vary: Mapping[str, Iterable[Number] | Law],
        *,
        to: Number | None = None,
        at: Iterable[Number] = (),
        columns: Iterable[str] = (),
        reduce: Iterable[str] = (),
        cases: int | None = None,
        together: bool = False,
        draw: str = "random",
        seed: int = 0,
        tolerance: Number | None = None,
        initial: Mapping[str, Number] | None = None,
        form: str = "routh",
        threads: int = 0,
        stop: Callable[[], bool] | None = None,
        progress: Progress = None,
        out: str | os.PathLike[str],
        on: Client | str | None = None,
        chunk: int | None = None,
        share: tuple[int, int] = (1, 1),
        refine: int = 0,
        refine_by: tuple[str, float] | None = None,
    ) -> SweepFolder: ...

    def sweep(
        self,
        vary: Mapping[str, Iterable[Number] | Law],
        *,
        to: Number | None = None,
        at: Iterable[Number] = (),
        columns: Iterable[str] = (),
        reduce: Iterable[str] = (),
        cases: int | None = None,
        together: bool = False,
        draw: str = "random",
        seed: int = 0,
        tolerance: Number | None = None,
        initial: Mapping[str, Number] | None = None,
        form: str = "routh",
        threads: int = 0,
        stop: Callable[[], bool] | None = None,
        progress: Progress = None,
        out: str | os.PathLike[str] | None = None,
        on: Client | str | None = None,
        chunk: int | None = None,
        share: tuple[int, int] = (1, 1),
        refine: int = 0,
        refine_by: tuple[str, float] | None = None,
    ) -> Sweep | SweepFolder:
        """Many motions, on all cores: all combinations of the values, the last name varying fastest.

        Args:
            vary: by the name of a parameter, a coordinate or a velocity: a list or an array of values, a grid
                (:func:`grid`), or a law (:func:`normal`, :func:`uniform`) by which each case draws its own.
            to: the end, s; that of the file if it is None, or the last of ``at``.
            at: times, s, at which the state of each case is kept, too: ``sweep.rows("theta")`` has shape (cases, times).
            columns: names or patterns such as ``"theta*"``; all columns without it.
            reduce: columns over the whole motion of a case: ``"max(theta')"``, ``"min(height)"``, ``"mean(...)"``,
                ``"last(...)"`` of an output or of any formula of the model. They are those of the Taylor polynomials,
                not of some times.
            cases: how many, where values are drawn; the cases go round the combinations of the lists.
            together: the lists have the same length and go together, one case for each place: ``vary`` is a table, as a
                DataFrame is one.
            draw: ``"random"``, or ``"sobol"`` for the points of a Sobol sequence, which lie more evenly.
            seed: of the draws, which depend on it and on the number of the case alone.
            tolerance: of each step, relative.
            initial: values common to all cases.
            form: of the equations.
            threads: 0: as many as the machine has. The numbers are the same for any.
            stop: asked every 20 ms; True ends the sweep.
            progress: as in :meth:`simulate`; a function is told the number of cases done, twice.

            out: a folder that takes the cases, part by part; what is there already is not computed again. The value is a
                :class:`SweepFolder`. Ctrl-C keeps all parts that are complete, and the same call goes on.
            on: with ``out``, a client of Dask distributed, or the address of its scheduler: its workers compute the parts.
                They need anholon and the folder, nothing else; a part whose worker died is computed by another one.
            chunk: cases of a part of a new folder; None: as many as take some seconds.
            share: (i, n): the i-th of n shares, for n processes on one folder.
            refine: with ``out``, so many further generations of cases, which halve the grid where neighbours ended in
                different ways.
            refine_by: (column, bound): halves it, too, where the numbers of neighbours differ by more than the bound.

        Raises:
            ModelError: an argument makes no sense; the folder holds another sweep or other files.
            OSError: a part could not be written.
            TypeError: ``columns`` or ``reduce`` is a single name, no list.
            MotionError: the initial values of the model are inconsistent.
            Interrupted: Ctrl-C; ``.result`` is the sweep as far as it came.
        """
        values = [(str(name), [] if isinstance(of, Law) else list_of(of)) for name, of in vary.items()]
        if isinstance(columns, str) or isinstance(reduce, str):
            raise TypeError('columns and reduce are lists of names: ["theta"]')
        laws = {name: str(of) for name, of in vary.items() if isinstance(of, Law)}
        end, relative = (None if number is None else text_of(number) for number in (to, tolerance))
        words: Words = (values, laws, cases, seed, draw, together, end, relative, list_of(at), list(columns), list(reduce))
        if out is not None:
            return SweepRequest(self, form, texts_of(initial), words).fill(
                os.fspath(out), chunk or 0, on=on, share=share, threads=threads, stop=stop, progress=progress, refine=refine, refine_by=refine_by
            )
        if on is not None or chunk is not None or share != (1, 1) or refine or refine_by is not None:
            raise ModelError('on, chunk, share and refine belong to a sweep in a folder\nhint: out="falls/"')
        system = self._system(form, texts_of(initial), ())
        with Shown(progress, self.title, _count(values, laws, cases, together), unit="cases") as tell:
            core, raised = _core.sweep(system, words, threads, stop, tell)
        sweep = Sweep(self, core, list(vary), list(reduce))
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(sweep) from None
        if isinstance(raised, BaseException):
            raise raised
        return sweep

    def dynamics(
        self,
        *,
        minimal: bool = True,
        inputs: bool | Sequence[str] = False,
        outputs: Sequence[str] | Mapping[str, str | Expr] | None = None,
        initial: Mapping[str, Number] | None = None,
    ) -> Dynamics:
        """The equations as a compiled function f(t, x, u, p) -> x', for integrators and optimizers of others.

        Args:
            minimal: in independent velocities, which satisfy the constraints whatever they are, if the equations have
                them; else in the state of the motion: all coordinates and velocities, and higher derivatives where
                constraints of order 2 and more ask for them.
            inputs: which inputs of the model are arguments u: all that can be set, those named, or none. The formulas
                of the others stand in f.
            outputs: instead of all monitors and outputs of the model: some of them, formulas in its names, or
                ``{name: formula}``. ``lambda.NAME`` is a multiplier, ``reaction(BODY)`` the force of the constraints;
                both need ``minimal=False``. A vector gives ``name.x``, ``name.y``, ``name.z``.
            initial: values instead of those of the file, for ``f.start``.

        Raises:
            ModelError: the equations have no solution at the start, an input cannot be set from outside, or an output
                is not known.

        Example:
            >>> import anholon as an, numpy as np
            >>> f = an.load("disc").dynamics()
            >>> [state.name for state in f.states]
            ['x', 'y', 'psi', 'theta', 'phi', 'u1', 'u2', 'u3']
            >>> f(0, f.start).shape, f(0, np.tile(f.start[:, None], 1000)).shape
            ((8,), (8, 1000))
        """
        names = [] if isinstance(inputs, bool) else list(inputs)
        chosen: list[tuple[str, str]] | None = None
        if isinstance(outputs, Mapping):
            chosen = [(name, str(formula)) for name, formula in outputs.items()]
        elif outputs is not None:
            chosen = [(str(name), "") for name in outputs]
        return Dynamics(self, _core.dynamics(self._system("routh", texts_of(initial), ()), minimal, inputs is True, names, chosen))

    def c_code(self, *, initial: Mapping[str, Number] | None = None, form: str = "routh") -> str:
        """The motion's right side as a C program that stands by itself."""
        return _core.program_text(self._system(form, texts_of(initial), ()), "c")

    def python_code(self, *, initial: Mapping[str, Number] | None = None, form: str = "routh") -> str:
        """The same as a module of NumPy."""
        return _core.program_text(self._system(form, texts_of(initial), ()), "python")

    def __repr__(self) -> str:
        names = ", ".join(c.name for c in self.coordinates)
        return f"<model {self.title!r}: coordinates {names}; {len(self.constraints)} constraints>"

    def _repr_html_(self) -> str:
        rows = [
            ("coordinates", ", ".join(repr(c) for c in self.coordinates)),
            ("parameters", ", ".join(repr(p) for p in self._core.parameters)),
            ("constraints", ", ".join(repr(c) for c in self.constraints)),
            ("outputs", ", ".join(self.monitors)),
        ]
        body = "".join(f"<tr><th style='text-align:left'>{k}</th><td style='text-align:left'>{html.escape(v)}</td></tr>" for k, v in rows if v)
        return f"<table><caption>{html.escape(self.title)}</caption><tbody>{body}</tbody></table>"


def _count(values: list[tuple[str, list[str]]], laws: dict[str, str], cases: int | None, together: bool) -> float | None:
    """How many cases a sweep has, if that is known before it begins."""
    if cases is not None:
        return float(cases)
    if together:
        return float(max((len(of) for _, of in values), default=0))
    if any("(" in law for law in laws.values()):
        return None
    return float(math.prod(int(laws[name].rpartition(":")[2]) if name in laws else len(of) for name, of in values))


def made(again: Source, given: dict[str, str], cases: list[str]) -> Model:
    """Reads a model, for :func:`load` and for other processes."""
    return Model(again(given, cases), again, given, cases)
