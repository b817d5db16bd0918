"""Computes sweeps in folders: the request for a sweep, the parts that are missing, workers of Dask."""

from __future__ import annotations

import atexit
import json
import math
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from . import _core
from ._case_table import lines_of
from ._errors import Interrupted, ModelError
from ._progress import Progress, Shown
from ._sweep_case import model_of, runs_through_scenarios
from .sweep_folder import SweepFolder

if TYPE_CHECKING:
    from distributed import Client

    from .model import Model

Words = tuple[
    list[tuple[str, list[str]]],
    dict[str, str],
    "int | None",
    int,
    str,
    bool,
    "str | None",
    "str | None",
    list[str],
    list[str],
    list[str],
    tuple[str, str],
]
"""The request for a sweep: values, laws, cases, seed, draw, together, to, tolerance, at, columns, reduce, (name, text) of a table."""


def number_of_cases(
    values: list[tuple[str, list[str]]], laws: dict[str, str], cases: int | None, together: bool, scenarios: str | None = None, table: str = ""
) -> float | None:
    """Returns the number of cases of a sweep; None if it is not known before the sweep begins. `scenarios` is the name that stands for
    scenarios, if there is one."""
    named = [of for name, of in values if name == scenarios]
    if named:
        rest = number_of_cases([(name, of) for name, of in values if name != scenarios], laws, cases, together, None, table)
        return None if rest is None else rest * len(named[0])
    if cases is not None:
        return float(cases)
    if table:
        rest = number_of_cases(values, laws, cases, together) if values else 1.0
        return None if rest is None else rest * lines_of(table)
    if together:
        return float(max((len(of) for _, of in values), default=0))
    if any("(" in law for law in laws.values()):
        return None
    return float(math.prod(int(laws[name].rpartition(":")[2]) if name in laws else len(of) for name, of in values))


_MOST_TASKS = 10_000  # the most tasks of one call: a scheduler needs some kB for each
_ATTEMPTS = 5  # after so many rounds in which no part was added, the error of the workers is raised


class SweepRequest:
    """The request for a sweep, in words that another process can read."""

    def __init__(self, model: Model, form: str, initial: dict[str, str], words: Words) -> None:
        self._model, self._form, self._initial, self._words = model, form, initial, words
        self._scenarios = runs_through_scenarios(model, [name for name, _ in words[0]])

    def fill(
        self,
        folder: str,
        chunk: int,
        *,
        on: Client | str | None,
        share: tuple[int, int],
        threads: int,
        stop: Callable[[], object] | None,
        progress: Progress,
        refine: int,
        refine_by: tuple[str, float] | None,
    ) -> SweepFolder:
        """Opens the folder or makes it, and computes the parts that are missing."""
        if refine > 0 and self._scenarios and len(dict(self._words[0])["case"]) > 1:
            raise no_grid()
        core = self.open(folder, chunk, rule_of(refine, refine_by))
        _opened[_key(core.path)] = core
        return fill(core, on=on, share=share, threads=threads, stop=stop, progress=progress, refine=refine, refine_by=refine_by)

    def open(self, folder: str, chunk: int, rule: str | None = None) -> _core.SweepFolder:
        """Opens the folder or makes it. Raises ModelError if the sweep cannot be refined by the rule."""
        system = None if self._scenarios else self._model._system_of_sweep(self._form, self._initial)
        if system is None:
            return _core.sweep_scenarios_into(self._model._core, self._form, self._initial, self._words, folder, chunk, self._recipe(), rule)
        return _core.sweep_into(system, self._words, folder, chunk, self._recipe(), rule)

    def _recipe(self) -> str:
        model = self._model
        mode = {"mode": list(model._again.mode)} if model._again.mode else {}
        return json.dumps(
            {"set": model._given, "case": model._cases, **mode, "form": self._form, "initial": self._initial, "words": self._words[:-1]}
        )


def rule_of(refine: int, refine_by: tuple[str, float] | None) -> str | None:
    """Returns the rule by which a sweep is refined, as a word; None if it is not refined."""
    if refine_by is not None and refine < 1:
        raise ModelError("refine_by tells what a border is, and refine how often it is refined\nhint: refine=4")
    if refine < 1:
        return None
    return "" if refine_by is None else f"{refine_by[0]}:{float(refine_by[1])!r}"


def no_grid() -> ModelError:
    """Returns the error for a sweep over several scenarios whose borders are to be refined."""
    return ModelError('the cases of a file are no grid, and refine has nothing to halve\nhint: a sweep of each case: model.with_(case="NAME").sweep(...)')


# Open sweeps, so that a process derives the equations of each once. They are destroyed before the core is unloaded.
_opened: dict[tuple[str, bytes], _core.SweepFolder] = {}
atexit.register(_opened.clear)


def _key(folder: str) -> tuple[str, bytes]:
    import hashlib

    path = os.path.realpath(folder)
    # Folders of earlier versions have the file sweep.json.
    names = [os.path.join(path, name) for name in ("_sweep.json", "sweep.json")]
    with open(next(filter(os.path.exists, names), names[0]), "rb") as file:
        return path, hashlib.sha256(file.read()).digest()


def computing(folder: str) -> _core.SweepFolder:
    """Returns the sweep of a folder, ready to be computed, as its _sweep.json describes it."""
    looked_at = _core.open_sweep(folder)
    key = _key(folder)
    if key not in _opened:
        if not looked_at.recipe:
            raise ModelError(f"{looked_at.path} was made by the command line\nhint: its command goes on, or anholon sweep … -o {looked_at.path}/")
        recipe = json.loads(looked_at.recipe)
        model = model_of(looked_at, recipe)
        words = recipe["words"]
        words[0] = [(name, values) for name, values in words[0]]
        # The table is kept with the request of the folder, not in the recipe.
        words.append(("the table", looked_at.asked("table of cases")))
        while len(_opened) >= 4:
            _opened.pop(next(iter(_opened)))
        _opened[key] = SweepRequest(model, recipe["form"], recipe["initial"], tuple(words)).open(looked_at.path, 0)
    return _opened[key]


def fill(
    core: _core.SweepFolder,
    *,
    on: Client | str | None,
    share: tuple[int, int],
    threads: int,
    stop: Callable[[], object] | None,
    progress: Progress,
    refine: int = 0,
    refine_by: tuple[str, float] | None = None,
) -> SweepFolder:
    """Computes the parts that are missing, and plans generations until there are `refine` after the first, or no border is left."""
    rule = rule_of(refine, refine_by)
    if rule is not None and "case_name" in core.columns and "," in core.asked("vary case"):
        raise no_grid()
    if rule is not None:
        core.refine(rule, 0)  # plans nothing: raises before the first case is computed if the sweep cannot be refined
    while True:
        folder = _fill_generation(core, on=on, share=share, threads=threads, stop=stop, progress=progress)
        # Other shares may have parts to compute before the borders are known; other processes may plan the same generation.
        if rule is None or core.missing():
            return folder
        generations = len(core.progress().generations)
        if generations > refine or not core.refine(rule, generations):
            return folder


def _fill_generation(
    core: _core.SweepFolder, *, on: Client | str | None, share: tuple[int, int], threads: int, stop: Callable[[], object] | None, progress: Progress
) -> SweepFolder:
    folder = SweepFolder(core)
    missing = [part for part in core.missing() if part % share[1] == share[0] - 1] if on is not None else None
    left = core.cases if missing is None else min(core.cases, len(missing) * core.chunk)
    with Shown(progress, f"sweep in {core.path}", float(left), unit="cases") as tell:
        if on is not None:
            _fill_by_workers(core, on, share, threads or 1, stop, tell)
            return folder
        _, notes, error, raised = core.fill(None, share[0], share[1], threads, stop, tell)
    folder._computed_notes = notes
    if isinstance(raised, KeyboardInterrupt):
        raise Interrupted(folder) from None
    if isinstance(raised, BaseException):
        raise raised
    if error:
        raise OSError(f"{error}\nhint: the parts before it are kept; the same call goes on")
    return folder


def fill_parts(folder: str, parts: list[int], threads: int) -> int:
    """Computes parts, as the task of a worker, and returns the number of cases that it computed.

    Raises:
        OSError: a part could not be written.
    """
    cases, _, error, _ = computing(folder).fill(parts, 1, 1, threads, None, None)
    if error:
        raise OSError(error)
    return cases


def _fill_by_workers(
    core: _core.SweepFolder,
    on: Any,
    share: tuple[int, int],
    threads: int,
    stop: Callable[[], object] | None,
    tell: Callable[[float, int], object] | None,
) -> None:
    """Gives parts to the workers of Dask until all parts are complete. The folder, not the scheduler, tells which parts are."""
    from asyncio import CancelledError

    import distributed

    # The functions of distributed have no types.
    api: Any = distributed
    try:
        client = api.Client(on) if isinstance(on, str) else on
    except OSError as error:
        raise OSError(f"no scheduler of Dask answers at {on}: {error}\nhint: where one answers, the same call goes on with the parts that are kept") from error
    path = os.path.realpath(core.path)
    idle, first = 0, None
    try:
        while missing := [part for part in core.missing() if part % share[1] == share[0] - 1]:
            first = len(missing) if first is None else first
            size = math.ceil(len(missing) / _MOST_TASKS)
            groups = [missing[k : k + size] for k in range(0, len(missing), size)]
            waiting = set(client.map(fill_parts, [path] * len(groups), groups, [threads] * len(groups), pure=False, retries=3))
            trouble: BaseException | None = None
            try:
                while waiting:
                    try:
                        done, waiting = api.wait(waiting, timeout=0.5, return_when="FIRST_COMPLETED")
                        trouble = next((task.exception() for task in done if task.status == "error"), trouble)
                        if isinstance(trouble, (OSError, ModelError)):
                            break
                    except api.TimeoutError:
                        pass
                    if tell is not None:
                        cases = (first - len(missing) + len(groups) * size - len(waiting) * size) * core.chunk
                        tell(float(cases), cases)
                    if stop is not None and stop():
                        client.cancel(list(waiting))
                        return
            except KeyboardInterrupt:
                client.cancel(list(waiting))
                raise Interrupted(SweepFolder(core)) from None
            except (Exception, CancelledError) as error:  # the scheduler is gone
                trouble = error
            if isinstance(trouble, (OSError, ModelError)):
                client.cancel(list(waiting))
                raise trouble
            left = sum(part % share[1] == share[0] - 1 for part in core.missing())
            idle = idle + 1 if left >= len(missing) else 0
            if left > 0 and (idle >= _ATTEMPTS or client.status != "running"):
                raise OSError(f"{left} parts are missing: {trouble or 'the workers failed'}\nhint: the same call goes on") from trouble
    finally:
        if client is not on:
            client.close()
