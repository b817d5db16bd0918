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

# What the command line has and a keyword of simulate() has not, or what has another name here.
_ELSEWHERE = {
    "t": 'initial={"t": 1} is the time at which the motion starts',
    "save": "run.save(\"run.h5\") writes the rows; pickle.dumps(run) keeps the run with all that it can do",
    "continue": 'initial={"t": run.t[-1], "x": run["x"][-1], …}, with all coordinates and velocities of the last row, goes on from there; anholon simulate --continue has the same bits as one run',
}


class Model(Analysed):
    """A mechanical system, as a model file has it. It never changes: :meth:`with_` makes another one.

    Get one from :func:`load`, :func:`loads` or :func:`zoo`. Computations release the interpreter's lock; threads may share
    a model.

    Example:
        >>> import anholon as an
        >>> disc = an.load("disc")
        >>> disc
        <model 'Disc rolling on a plane': coordinates x, y, psi, theta, phi; 2 constraints>
    """

    def __reduce__(self) -> tuple[Callable[..., Model], tuple[Source, dict[str, str], list[str]]]:
        """Another process reads the model again."""
        return made, (self._again, self._given, self._cases)

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

    def in_mode(self, word: str, *more: str) -> Model:
        """The model of one mode, in which contacts exert ideal forces and nothing changes.

        :meth:`equations`, :meth:`prove`, :meth:`compare` and :meth:`linearize` of models with contacts need it.

        Args:
            word: ``"floor=sticks"`` (``open``, ``slips`` or ``sticks``) of a contact, or ``"caught=1"``, the number of a mode,
                where constraints have ``active``.
            more: of other contacts, which are open without a word, and of other modes, which are those of the start.

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
        """What kind of system this is: degrees of freedom, kinds of constraints, the consistent initial state.

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
        """The consistent initial state, each value with where it comes from.

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
        """One motion. What happens to it never raises: ``run.outcome`` tells why it stopped and what to do.

        The numbers are those of ``anholon simulate`` with the same options, bit by bit.

        Args:
            to: the end, s; that of the file if it is None.
            every: a row at each multiple of it after the start, s; a row at each step if it is None.
            at: rows at these times and at no other, s. They come in the order of time, and once where a time is given twice.
            initial: values instead of those of the file: ``{"theta": 1.3, "phi'": 6}``, in SI units; ``{"t": 1}`` is the time at
                which the motion starts. The initial value of a state of the model is a parameter's, which :meth:`with_` sets.
            tolerance: of each step, relative; 1e-12 if neither the file nor you say otherwise.
            form: of the equations, or ``auto``: the one whose motion takes the fewest operations.
            eliminate: coordinates that forms without multipliers eliminate; chosen if there are none.
            method: ``auto``, ``taylor``, ``rk`` or ``bdf``.
            digits: more than 16: multiple precision; see :meth:`Run.exact`.
            order: of the Taylor polynomials.
            error_estimate: digits to trust, by a second, sharper run; True: always, False: never, None: of short runs.
            most_steps: the motion ends after so many.
            dense: keeps the polynomials of all steps, so that ``run(t)`` has them; without, it makes the motion once more.
            stop: asked every 20 ms; a value that is true ends the motion, which keeps its rows.
            progress: True shows a bar, False none; a function is told the time and the number of steps every 20 ms. By default
                a bar appears after two seconds in a notebook and at a prompt.
            others: any option of ``anholon simulate`` that changes the motion, with _ for -: ``rigorous=64``.

        Raises:
            ModelError: an argument makes no sense.
            TypeError: ``dense`` is not True or False.
            Interrupted: Ctrl-C; ``.result`` is the run as far as it came.

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
                words[name.replace("_", "-")] = "" if value is True else text_of(value)
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
        """Many motions, on all cores: all combinations of the values, the last name varying fastest.

        Args:
            vary: by the name of a parameter, a coordinate or a velocity: a list or an array of values, a grid
                (:func:`grid`), or a law (:func:`normal`, :func:`uniform`) by which each case draws its own. A text is read as
                that of ``--vary`` is: ``"5,6,7"``, ``"1:7:100"``, ``"normal(1,0.1)"``. ``{"case": ["moon", "long"]}`` runs
                through scenarios [case.NAME] of the file, laid over this model; they vary slowest.
            to: the end, s; that of the file if it is None, or the last of ``at``.
            at: times, s, at which the state of each case is kept, too: ``sweep.rows("theta")`` has shape (cases, times). They
                come in the order of time, each once, as ``sweep.times`` has them.
            columns: names or patterns such as ``"theta*"``; all columns without it. What varies and the reductions are kept
                in any case.
            reduce: columns over the whole motion of a case: ``"max(theta')"``, ``"min(height)"``, ``"mean(...)"``,
                ``"last(...)"`` of an output or of any formula of the model. They are those of the Taylor polynomials,
                not of some times, and the last value is that at the end. ``"count(EVENT)"`` tells how often an event of the model or of a contact fired, as in
                ``"count(floor.hits)"``, and ``"first(EVENT)"`` its first time, NaN if it did not fire.
            cases: how many, where values are drawn; the cases go round the combinations of the lists. Or a table of cases: the
                path of a CSV or Parquet file, arrays by name, or a table of pandas, polars or pyarrow. Its columns have the
                names of what varies, and each row is a case for each combination of ``vary``. ``(table, 1000)`` is a table
                where values are drawn, too: the 1000 cases go round it.
            together: the lists have the same length and go together, one case for each place: ``vary`` is a table, as a
                DataFrame is one.
            draw: ``"random"``, or ``"sobol"`` for the points of a Sobol sequence, which lie more evenly.
            seed: of the draws, which depend on it and on the number of the case alone.
            tolerance: of each step, relative.
            initial: values common to all cases.
            form: of the equations.
            threads: 0: as many as the machine has. The numbers are the same for any.
            stop: asked every 20 ms; a value that is true ends the sweep.
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
            TypeError: ``columns`` or ``reduce`` is a single name, no list; an argument that is a whole number is none.
            ValueError: a value is not finite, a whole number is too small.
            MotionError: the initial values of the model are inconsistent.
            Interrupted: Ctrl-C; ``.result`` is the sweep as far as it came.
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
        seed, threads, refine = whole("seed", seed, 0), whole("threads", threads, 0), whole("refine", refine, 0)
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
        """None if the values of the file have no start: those of the cases may have one."""
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
        """The equations as a compiled function f(t, x, u, p) -> x', for integrators and optimizers of others.

        f is the right side between events: it holds none of them, neither what they set nor that they end a motion. An
        integrator that is to heed them looks for their times itself; the number of a mode is an entry of p, by its name.

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
        """The motion's right side as a C program that stands by itself."""
        return _core.program_text(self._system(form, texts_of(initial), ()), "c")

    def python_code(self, *, initial: Mapping[str, Number] | None = None, form: str = "routh") -> str:
        """The same as a module of NumPy."""
        return _core.program_text(self._system(form, texts_of(initial), ()), "python")



def made(again: Source, given: dict[str, str], cases: list[str]) -> Model:
    """Reads a model, for :func:`load` and for other processes."""
    return Model(again(given, cases), again, given, cases)
