"""The whole motion of one case of a sweep in a folder."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import ModelError
from ._source import Source

if TYPE_CHECKING:
    from .model import Model
    from .run import Run


def run_of(core: _core.SweepFolder, computing: Callable[[], _core.SweepFolder], number: int, options: dict[str, Any]) -> Run:
    """Computes the motion from the words of a command, which tell that of a folder of Python, too. `computing` opens the folder for a computation."""
    parameters: dict[str, str] = {}
    scenarios: list[str] = []
    initial: dict[str, str] = {}
    eliminate: list[str] = []
    given: dict[str, Any] = {}
    for option, word in _words(core, computing, number):
        name, _, value = word.partition("=")
        if option == "set":
            parameters[name] = value
        elif option == "case":
            scenarios.append(word)
        elif option in _ORDERS:
            # --qdot "x'=2" means x', too.
            initial[name.replace("'", "") + _ORDERS[option] if _ORDERS[option] else name] = value
        elif option in _MULTIPLIERS:
            initial[f"lambda.{name}{_MULTIPLIERS[option]}"] = value
        elif option == "t":
            initial["t"] = word
        elif option == "eliminate":
            eliminate.append(word)
        else:
            given[option.replace("-", "_")] = int(word) if option in ("order", "most-steps", "digits") else word
    if "at" in options:
        given.pop("every", None)
    return _model(core, parameters, scenarios).simulate(**{**given, "initial": initial, "eliminate": eliminate, **options})


def _words(core: _core.SweepFolder, computing: Callable[[], _core.SweepFolder], number: int) -> list[tuple[str, str]]:
    """The options of a case. Where the folder does not keep its numbers, the sweep that Python asked for tells them."""
    try:
        return core.words(number)
    except ModelError:
        if not core.recipe:
            raise
        return computing().words(number)


def runs_through_scenarios(model: Model, vary: Iterable[str]) -> bool:
    """Whether the name "case" stands for scenarios of the file; a parameter or a coordinate may have that name."""
    return "case" in vary and "case" not in model.parameters and all(coordinate.name != "case" for coordinate in model.coordinates)


def model_of(core: _core.SweepFolder, recipe: dict[str, Any]) -> Model:
    """The model of a folder that Python made."""
    return _model(core, recipe["set"], recipe["case"])


def _model(core: _core.SweepFolder, parameters: Mapping[str, str], scenarios: Sequence[str]) -> Model:
    """The model of a folder, from its text there and from the files to which the text refers."""
    from .model import made
    from .reading import loads

    if core.keeps_files:
        model = made(Source(None, "", folder=os.path.abspath(core.path)), dict(parameters), list(scenarios))
    else:
        model = loads(core.asked("model"), set=parameters, case=scenarios)
    mode = core.asked("mode").split()
    return model.in_mode(*mode) if mode else model


_ORDERS = {"q": "", "qdot": "'", "qddot": "''", "qdddot": "'''"}
_MULTIPLIERS = {"lambda": "", "lambdadot": "'"}
