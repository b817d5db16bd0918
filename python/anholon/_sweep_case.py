"""The whole motion of one case of a sweep in a folder."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import ModelError

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
    """The model of a folder. Its text is there; a text that refers to further files is read where Python found it."""
    from .reading import load, loads

    path = json.loads(core.recipe)["path"] if core.recipe else ""
    if not path and core.asked("base file 1"):
        raise ModelError(f"the model of {core.path} refers to other files\nhint: anholon simulate with the numbers of the case")
    given: Any = {"set": parameters, "case": scenarios}
    model = load(path, **given) if path else loads(core.asked("model"), **given)
    mode = core.asked("mode").split()
    return model.in_mode(*mode) if mode else model


_ORDERS = {"q": "", "qdot": "'", "qddot": "''", "qdddot": "'''"}
_MULTIPLIERS = {"lambda": "", "lambdadot": "'"}
