"""Models and their motions."""

from __future__ import annotations

import numbers
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, overload

from . import _core
from ._analysed import Analysed
from ._case_table import CaseTable, table_of
from ._errors import Interrupted, ModelError, MotionError
from ._kept_sweep import SweepAgain
from ._names import by_spelled_names, names_of, spelled
from ._numbers import Number, float_of, list_of, text_of, texts_of, varied_list, whole
from ._progress import Progress, Shown
from ._recipe import Recipe
from ._source import Source
from ._sweep_case import runs_through_scenarios
from ._sweep_filling import number_of_cases, SweepRequest, Words
from .check import Check
from .dynamics import Dynamics
from .expressions import Expr
from .run import Run
from .sweep import Law, Sweep, is_law
from .sweep_folder import SweepFolder

if TYPE_CHECKING:
    from distributed import Client

# Options of anholon simulate that are no keywords of simulate(), with hints how Python does the same.
_ELSEWHERE = {
    "t": 'initial={"t": 1} is the time at which the motion starts',
    "save": "run.save(\"run.h5\") writes the rows; pickle.dumps(run) keeps the run with all that it can do",
    "inputs": "[input] in the model has the formulas of its inputs; model.with_(k=2) changes their parameters, and a [[table]] has measured values",
    "input": "[input] in the model has the formulas of its inputs; model.with_(k=2) changes their parameters, and a [[table]] has measured values",
    "rtol": "tolerance=1e-10 is relative to the largest unknown of its dimension, at least to 1 in SI units",
    "atol": "tolerance=1e-10 is relative to the largest unknown of its dimension, at least to 1 in SI units",
    "parameters": "model.with_(m=2) is the model with another value",
    "x0": 'initial={"x": 1, "x\'": 0} gives values in place of those of the file',
    "y0": 'initial={"x": 1, "x\'": 0} gives values in place of those of the file',
    "t_span": "to=10 is the end; initial={\"t\": 1} is the time at which the motion starts",
    "t_eval": "at=[0, 0.5, 1] are the times of rows",
    "continue": 'initial={"t": run.t[-1], "x": run["x"][-1], …}, with all coordinates and velocities of the last row, goes on from there; anholon simulate --continue has the same bits as one run',
}


class Model(Analysed):
    """A mechanical system as a model file describes it. A model never changes; :meth:`with_` makes another one.

    :func:`load` and :func:`loads` return models. Computations release the interpreter's lock, and threads may share a model.

    Example:
        >>> import anholon as an
        >>> disc = an.load("disc")
        >>> disc
        <model 'Disc rolling on a plane': coordinates x, y, psi, theta, phi; 2 constraints>
    """

    def __reduce__(self) -> tuple[Callable[..., Model], tuple[Source, dict[str, str], list[str]]]:
        """Pickles the source of the model: another process reads the model again."""
        return made, (self._again, self._given, self._cases)

    def with_(self, *, case: str | Sequence[str] = (), **parameters: Number) -> Model:
        """Returns the same model with other values of parameters, or with scenarios of the file laid over it.

        Args:
            case: names of [case.NAME], applied one after the other, after the scenarios that this model has already.
            parameters: new values; a name that is no Python identifier is written ``**{"k'": 2}``.

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

    def in_mode(self, word: str, *more: str) -> Model:
        """Returns the model of one mode, in which contacts exert ideal forces and keep their state.

        :meth:`equations`, :meth:`prove`, :meth:`compare` and :meth:`linearize` need it if the model has contacts.

        Args:
            word: ``"floor=sticks"`` (``open``, ``slips`` or ``sticks``) for a contact, or ``"caught=1"``, the number of a mode, if
                constraints have ``active``.
            more: words for other contacts and modes. Without a word a contact is open, and a mode has its initial number.

        Raises:
            ModelError: a word names no contact or no mode, or a contact slips against friction, which is no ideal force.

        Example:
            >>> import anholon as an
            >>> print(an.load("bead-in-hoop").in_mode("hoop=slips").constraints[0])
            hoop, order 0
        """
        again = replace(self._again, mode=(word, *more))
        return Model(again(self._given, self._cases), again, self._given, self._cases)

    def check(self, *, form: str = "routh", initial: Mapping[str, Number] | None = None) -> Check:
        """Finds the kind of the system: degrees of freedom, kinds of constraints, the consistent initial state.

        Raises:
            MotionError: no state satisfies the constraints with the values given, or the configuration is singular.

        Example:
            >>> import anholon as an
            >>> check = an.load("disc").check()
            >>> check.degrees_of_freedom, check.constraints[0].kind
            (3, 'linear')
        """
        return Check(self, form, texts_of(initial))

    # ---- its motion ----

    def initial(self, *, form: str = "routh", eliminate: str | Iterable[str] = (), **values: Number) -> list[_core.InitialValue]:
        """Returns the consistent initial state; each value has its origin.

        Raises:
            MotionError: no state satisfies the constraints with the values given.
        """
        return self._system(form, texts_of(values), eliminate).initial

    def simulate(
        self,
        to: Number | None = None,
        *,
        every: Number | None = None,
        at: Number | Iterable[Number] = (),
        initial: Mapping[str, Number] | None = None,
        tolerance: Number | None = None,
        form: str = "routh",
        eliminate: str | Iterable[str] = (),
        method: str | None = None,
        digits: int | None = None,
        order: int | None = None,
        error_estimate: bool | None = None,
        most_steps: int | None = None,
        dense: bool = False,
        stop: Callable[[], object] | None = None,
        progress: Progress = None,
        **others: Number | bool,
    ) -> Run:
        """Simulates one motion. A motion that stops early raises nothing: ``run.outcome`` tells why it stopped, and what to do.

        The numbers are those of ``anholon simulate`` with the same options, bit by bit.

        Args:
            to: the end, s; that of the file if it is None.
            every: the interval of rows, s, counted from the start; there is a row at each step if it is None.
            at: times, s. The run has rows at these times only, in the order of time; a time that is given twice has one row.
            initial: values instead of those of the file: ``{"theta": 1.3, "phi'": 6}``, in SI units; ``{"t": 1}`` is the time at
                which the motion starts. The initial value of a state of the model is the value of a parameter, which :meth:`with_`
                sets.
            tolerance: the tolerance of each step, relative to the largest unknown of its dimension, at least to 1 in SI units; that
                of the file if it is None, and 1e-12 if the file has none.
            form: the form of the equations; ``auto`` is the form whose motion takes the fewest operations.
            eliminate: coordinates that forms without multipliers eliminate; the program chooses them if there are none.
            method: ``auto``, ``taylor``, ``rk`` or ``bdf``.
            digits: the number of digits; more than 16 need multiple precision, see :meth:`Run.exact`.
            order: the order of the Taylor polynomials.
            error_estimate: estimates the digits to trust by a second run of higher accuracy: True always, False never, None for
                short runs.
            most_steps: the number of steps after which the motion ends.
            dense: True keeps the polynomials of all steps for ``run(t)``, which else simulates the motion once more.
            stop: a function that is called every 20 ms; a value that is true ends the motion, which keeps its rows.
            progress: True shows a bar, False none; a function is called with the time and the number of steps every 20 ms. By
                default a bar appears after two seconds in a notebook and at a prompt.
            others: any other option of ``anholon simulate`` that changes the motion, with _ for -: ``rigorous=64``.

        Raises:
            ModelError: an argument makes no sense.
            TypeError: ``dense`` is not True or False.
            Interrupted: the user pressed Ctrl-C; ``.result`` is the run with its rows until then.

        Example:
            >>> import anholon as an
            >>> run = an.load("disc").simulate(to=10, every=0.01, initial={"phi'": 6})
            >>> len(run)
            1001
        """
        options = {"to": to, "every": every, "tolerance": tolerance, "method": method, "digits": digits, "order": order, "most-steps": most_steps}
        words = {name: text_of(value) for name, value in options.items() if value is not None}
        eliminate = eliminate if isinstance(eliminate, str) else list(eliminate)
        if error_estimate is not None:
            words["error-estimate"] = "always" if error_estimate else "never"
        if dense not in (True, False):
            raise TypeError(f"dense is True or False, not {dense!r:.60}")
        for name, value in others.items():
            if name in _ELSEWHERE:
                raise ModelError(f"there is no option {name!r}\nhint: {_ELSEWHERE[name]}")
            if value is not False and value is not None:
                try:
                    words[name.replace("_", "-")] = "" if value is True else text_of(value)
                except TypeError as mistake:
                    raise TypeError(f"{name}: {mistake}") from None
        try:
            system = self._system(form, texts_of(initial), eliminate)
        except MotionError as error:
            return Run(self, None, error.outcome)
        times = list_of(at)
        end = float_of(times[-1] if times else words.get("to"))
        with Shown(progress, self.title, end, start=system.start) as tell:
            core, raised = _core.simulate(system, words, times, bool(dense), stop, tell)
        cut = raised is not None or (stop is not None and core.outcome.kind == "interrupted")
        run = Run(self, core, core.outcome, Recipe(self, form, texts_of(initial), eliminate, words, times, cut))
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(run) from None
        if isinstance(raised, BaseException):
            raise raised
        return run

    @overload
    def sweep(
        self,
        vary: Mapping[str, Number | Iterable[Number] | Law] | None = None,
        *,
        to: Number | None = None,
        at: Number | Iterable[Number] = (),
        columns: Iterable[str] = (),
        reduce: Iterable[str] = (),
        cases: int | CaseTable | tuple[CaseTable, int] | None = None,
        together: bool = False,
        draw: str = "random",
        seed: int = 0,
        tolerance: Number | None = None,
        initial: Mapping[str, Number] | None = None,
        form: str = "routh",
        threads: int = 0,
        stop: Callable[[], object] | None = None,
        progress: Progress = None,
        out: None = None,
    ) -> Sweep: ...

    @overload
    def sweep(
        self,
        vary: Mapping[str, Number | Iterable[Number] | Law] | None = None,
        *,
        to: Number | None = None,
        at: Number | Iterable[Number] = (),
        columns: Iterable[str] = (),
        reduce: Iterable[str] = (),
        cases: int | CaseTable | tuple[CaseTable, int] | None = None,
        together: bool = False,
        draw: str = "random",
        seed: int = 0,
        tolerance: Number | None = None,
        initial: Mapping[str, Number] | None = None,
        form: str = "routh",
        threads: int = 0,
        stop: Callable[[], object] | None = None,
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
        vary: Mapping[str, Number | Iterable[Number] | Law] | None = None,
        *,
        to: Number | None = None,
        at: Number | Iterable[Number] = (),
        columns: Iterable[str] = (),
        reduce: Iterable[str] = (),
        cases: int | CaseTable | tuple[CaseTable, int] | None = None,
        together: bool = False,
        draw: str = "random",
        seed: int = 0,
        tolerance: Number | None = None,
        initial: Mapping[str, Number] | None = None,
        form: str = "routh",
        threads: int = 0,
        stop: Callable[[], object] | None = None,
        progress: Progress = None,
        out: str | os.PathLike[str] | None = None,
        on: Client | str | None = None,
        chunk: int | None = None,
        share: tuple[int, int] = (1, 1),
        refine: int = 0,
        refine_by: tuple[str, float] | None = None,
    ) -> Sweep | SweepFolder:
        """Simulates many motions on all cores: all combinations of the values; the last name varies fastest.

        Args:
            vary: by the name of a parameter, a coordinate or a velocity: a list or an array of values, a grid
                (:func:`grid`), or a law (:func:`normal`, :func:`uniform`) by which each case draws a value. A text has the form
                of ``--vary``: ``"5,6,7"``, ``"1:7:100"``, ``"normal(1,0.1)"``. ``{"case": ["moon", "long"]}`` runs through
                scenarios [case.NAME] of the file, laid over this model; scenarios vary slowest.
            to: the end, s; that of the file if it is None, or the last of ``at``.
            at: times, s, at which the state of each case is kept, too: ``sweep.rows("theta")`` has shape (cases, times). The
                times are sorted, and each is kept once, in ``sweep.times``.
            columns: names or patterns such as ``"theta*"``; all columns if there are none. The names that vary and the
                reductions are always kept.
            reduce: columns over the whole motion of a case: ``"max(theta')"``, ``"min(height)"``, ``"mean(...)"``,
                ``"last(...)"`` (the value at the end) of an output or of any formula of the model. They are computed from
                the Taylor polynomials, not from values at some times. ``"count(EVENT)"`` is the number of times that an event
                of the model or of a contact fired, as in ``"count(floor.hits)"``, and ``"first(EVENT)"`` the time when it
                first fired, NaN if it did not.
            cases: the number of cases, if values are drawn; the cases go round the combinations of the lists. Or a table of
                cases: the path of a CSV or Parquet file, arrays by name, or a table of pandas, polars or pyarrow. Its columns
                have the names that vary, and each row is a case for each combination of ``vary``. ``(table, 1000)`` is a
                table together with values that are drawn: the 1000 cases go round its rows.
            together: True takes the lists, which have the same length, place by place, one case for each: ``vary`` is then a
                table, for example a DataFrame.
            draw: ``"random"``, or ``"sobol"`` for the points of a Sobol sequence, which are distributed more evenly.
            seed: the seed of the draws, which depend on the seed and on the number of the case only.
            tolerance: the tolerance of each step, as in :meth:`simulate`.
            initial: values common to all cases.
            form: the form of the equations.
            threads: the number of threads; 0 takes as many as the machine has. The results do not depend on it.
            stop: a function that is called every 20 ms; a value that is true ends the sweep.
            progress: as in :meth:`simulate`; both arguments of a function are the number of cases done.

            out: a folder to which the cases are written, part by part; parts that the folder has already are not computed
                again. The result is then a :class:`SweepFolder`. After Ctrl-C the folder has all complete parts, and the same
                call computes the rest.
            on: with ``out``, a client of Dask distributed, or the address of its scheduler: its workers compute the parts.
                The workers need only anholon and the folder; if a worker dies, another one computes its part.
            chunk: the number of cases in a part of a new folder; None takes as many as need some seconds.
            share: (i, n): the i-th of n shares, for n processes on one folder.
            refine: with ``out``, the number of further generations of cases, which halve the grid between neighbours that
                ended in different ways.
            refine_by: (column, bound): halves the grid also between neighbours whose numbers differ by more than the bound.

        Raises:
            ModelError: an argument makes no sense; the folder holds another sweep or other files.
            OSError: a part could not be written.
            TypeError: ``columns`` or ``reduce`` is a single name, no list; an argument has to be a whole number and is not.
            ValueError: a value is not finite; a whole number is too small or too large.
            Interrupted: the user pressed Ctrl-C; ``.result`` is the sweep with the cases computed until then.
        """
        vary, table = {} if vary is None else vary, ("", "")
        if not hasattr(vary, "items"):
            raise TypeError(f"what varies is given by name, as {{'m': [1, 2]}}, not as a {type(vary).__name__}")
        vary = by_spelled_names(vary, "what varies")
        if isinstance(cases, tuple) and len(cases) == 2:
            table, cases = table_of(cases[0]), cases[1]
        elif cases is not None and not isinstance(cases, (int, numbers.Number)):
            table, cases = table_of(cases), None
        if len(vary.keys()) == 0 and not table[1]:
            raise ModelError("nothing is varied\nhint: sweep({'m': [1, 2, 5], \"x'\": anholon.grid(0, 1, 11)}, to=10)")
        laws = {name: str(of) for name, of in vary.items() if is_law(of)}
        values = [(str(name), [] if name in laws else varied_list(name, of)) for name, of in vary.items()]
        seed, threads, refine = whole("seed", seed, 0, 2**64 - 1), whole("threads", threads, 0), whole("refine", refine, 0)
        cases = None if cases is None else whole("cases", cases, 1)
        chunk = None if chunk is None else whole("chunk", chunk, 1)
        if not isinstance(share, (tuple, list)) or len(share) != 2:
            raise TypeError(f"share is a pair (i, n), the i-th of n shares, such as (3, 8), not {share!r:.60}")
        share = whole("the first number of share", share[0], 1), whole("the second number of share", share[1], 1)
        if isinstance(columns, str) or isinstance(reduce, str):
            raise TypeError('columns and reduce are lists of names: ["theta"]')
        end, relative = (None if number is None else text_of(number) for number in (to, tolerance))
        own_columns, reductions = ([spelled(str(name)) for name in names] for names in (columns, reduce))
        words: Words = (values, laws, cases, seed, draw, together, end, relative, list_of(at), own_columns, reductions, table)
        if out is not None:
            return SweepRequest(self, form, texts_of(initial), words).fill(
                os.fspath(out), chunk or 0, on=on, share=share, threads=threads, stop=stop, progress=progress, refine=refine, refine_by=refine_by
            )
        if on is not None or chunk is not None or share != (1, 1) or refine or refine_by is not None:
            raise ModelError('on, chunk, share and refine belong to a sweep in a folder\nhint: out="falls/"')
        scenarios = runs_through_scenarios(self, vary)
        count = number_of_cases(values, laws, cases, together, "case" if scenarios else None, table[1])
        again = SweepAgain(self, form, texts_of(initial), words, scenarios)
        with Shown(progress, self.title, count, unit="cases") as tell:
            core, raised = again.run(threads, stop, tell)
        sweep = Sweep(core, [*vary, *core.varied_names[len(vary) - scenarios :]], reductions, again)
        if isinstance(raised, KeyboardInterrupt):
            raise Interrupted(sweep) from None
        if isinstance(raised, BaseException):
            raise raised
        return sweep

    def _system_of_sweep(self, form: str, initial: dict[str, str]) -> _core.System | None:
        """Returns the prepared system; None if the values of the file have no consistent initial state. Those of the cases may have one."""
        try:
            return self._system(form, initial, ())
        except MotionError:
            return None

    def dynamics(
        self,
        *,
        minimal: bool = True,
        inputs: bool | str | Sequence[str] = False,
        outputs: str | Sequence[str] | Mapping[str, str | Expr] | None = None,
        initial: Mapping[str, Number] | None = None,
    ) -> Dynamics:
        """Compiles the equations to a function f(t, x, u, p) -> x', for integrators and optimizers of other libraries.

        f is the right side between events: it has neither the values that events set nor the end of a motion by an event. The user
        of f finds the times of events; a mode is an entry of p, by its name.

        Args:
            minimal: True takes independent velocities, any values of which satisfy the constraints, if the equations have them.
                Else x is the state of the motion: all coordinates and velocities, and higher derivatives if constraints of
                order 2 or more need them.
            inputs: the inputs of the model that are arguments u: True for all that can be set, in the order of the model; names,
                whose order is that of u; or False for none. f computes the other inputs by their formulas.
            outputs: instead of all monitors and outputs of the model: some of them, formulas in names of the model, or
                ``{name: formula}``. ``lambda.NAME`` is a multiplier, ``reaction(BODY)`` the force of the constraints;
                both need ``minimal=False``. A vector gives ``name.x``, ``name.y``, ``name.z``.
            initial: values instead of those of the file, for ``f.start``.

        Raises:
            ModelError: the equations have no solution at the start, an input cannot be set from outside or is given twice, or
                an output is not known.

        Example:
            >>> import anholon as an, numpy as np
            >>> f = an.load("disc").dynamics()
            >>> [state.name for state in f.states]
            ['x', 'y', 'psi', 'theta', 'phi', 'u1', 'u2', 'u3']
            >>> f(0, f.start).shape, f(0, np.tile(f.start[:, None], 1000)).shape
            ((8,), (8, 1000))
        """
        names = [] if isinstance(inputs, bool) else names_of(inputs)
        chosen: list[tuple[str, str]] | None = None
        if isinstance(outputs, Mapping):
            chosen = [(name, str(formula)) for name, formula in outputs.items()]
        elif outputs is not None:
            chosen = [(name, "") for name in names_of(outputs)]
        core = _core.dynamics(self._system("routh", texts_of(initial), ()), minimal, inputs is True, names, chosen)
        given = {} if initial is None else dict(initial)
        return Dynamics(self, core, {"minimal": minimal, "inputs": True if inputs is True else names, "outputs": None if chosen is None else dict(chosen), "initial": given})

    def c_code(self, *, initial: Mapping[str, Number] | None = None, form: str = "routh") -> str:
        """Returns the right side of the motion as a C program that needs no other file."""
        return _core.program_text(self._system(form, texts_of(initial), ()), "c")

    def python_code(self, *, initial: Mapping[str, Number] | None = None, form: str = "routh") -> str:
        """Returns the right side of the motion as a Python module, which needs NumPy."""
        return _core.program_text(self._system(form, texts_of(initial), ()), "python")



def made(again: Source, given: dict[str, str], cases: list[str]) -> Model:
    """Reads a model, for :func:`load` and for other processes."""
    return Model(again(given, cases), again, given, cases)
