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
    """Computes the motion of a case from its options in the words of the command line, also if Python made the folder. `computing`
    opens the folder for a computation."""
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
            # --qdot takes "x'=2" as well as "x=2".
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
    """Returns the options of a case as a command line has them. If the folder lacks the numbers of the case, the sweep that Python made
    gives them."""
    try:
        return core.words(number)
    except ModelError:
        if not core.recipe:
            raise
        return computing().words(number)


def runs_through_scenarios(model: Model, vary: Iterable[str]) -> bool:
    """True if the name "case" stands for scenarios of the file, not for a parameter or a coordinate of that name."""
    return "case" in vary and "case" not in model.parameters and all(coordinate.name != "case" for coordinate in model.coordinates)


def model_of(core: _core.SweepFolder, recipe: dict[str, Any]) -> Model:
    """Reads the model of a folder that Python made."""
    return _model(core, recipe["set"], recipe["case"])


def _model(core: _core.SweepFolder, parameters: Mapping[str, str], scenarios: Sequence[str]) -> Model:
    """Reads the model of a folder from the copies of its text, and of the files to which the text refers, that the folder keeps."""
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
