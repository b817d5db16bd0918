"""The whole motion of one case of a sweep in a folder."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import ModelError

if TYPE_CHECKING:
    from .model import Model
    from .run import Run


def run_of(core: _core.SweepFolder, computing: Any, number: int, options: dict[str, Any]) -> Run:
    """Computes the motion. `computing` opens the folder for a computation."""
    if not core.recipe:
        model, given = _of_command_line(core, number)
        return model.simulate(**{**given, **options})
    recipe = json.loads(core.recipe)
    words, initial, form = recipe["words"], dict(recipe["initial"]), recipe["form"]
    numbers = dict(computing().numbers(number))
    model = model_of(core, recipe)
    if runs_through_scenarios(model, [name for name, _ in words[0]]):
        model = model.with_(case=numbers.pop("case"))
    given = {"to": words[6] or (words[8] or [None])[-1], "tolerance": words[7]}
    parameters = {name: value for name, value in numbers.items() if name in model.parameters}
    initial.update({name: value for name, value in numbers.items() if name not in model.parameters})
    chosen = {"form": form, "initial": initial, **{name: value for name, value in given.items() if value}, **options}
    return (model.with_(**parameters) if parameters else model).simulate(**chosen)


def runs_through_scenarios(model: Model, vary: Iterable[str]) -> bool:
    """Whether the name "case" stands for scenarios of the file; a parameter or a coordinate may have that name."""
    return "case" in vary and "case" not in model.parameters and all(coordinate.name != "case" for coordinate in model.coordinates)


def model_of(core: _core.SweepFolder, recipe: dict[str, Any]) -> Model:
    """The model of a folder that Python made."""
    from .reading import load, loads

    given = {"set": recipe["set"], "case": recipe["case"]}
    model = load(recipe["path"], **given) if recipe["path"] else loads(core.asked("model"), **given)
    return model.in_mode(*recipe["mode"]) if recipe.get("mode") else model


_ORDERS = {"q": "", "qdot": "'", "qddot": "''", "qdddot": "'''"}
_MULTIPLIERS = {"lambda": "", "lambdadot": "'"}


def _of_command_line(core: _core.SweepFolder, number: int) -> tuple[Model, dict[str, Any]]:
    """The model of a case, and the options of its motion."""
    from .reading import loads

    if core.asked("base file 1"):
        raise ModelError(f"the model of {core.path} refers to other files\nhint: anholon simulate with the numbers of the case")
    parameters: dict[str, str] = {}
    scenarios: list[str] = []
    initial: dict[str, str] = {}
    eliminate: list[str] = []
    given: dict[str, Any] = {}
    for option, word in core.words(number):
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
    model = loads(core.asked("model"), set=parameters, case=scenarios)
    if core.asked("mode"):
        model = model.in_mode(*core.asked("mode").split())
    return model, {**given, "initial": initial, "eliminate": eliminate}
