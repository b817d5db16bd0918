"""The whole motion of one case of a sweep in a folder."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

from . import _core
from ._errors import ModelError

if TYPE_CHECKING:
    from .model import Model
    from .run import Run


def run_of(core: _core.SweepFolder, computing: Any, number: int, row: dict[str, Any], options: dict[str, Any]) -> Run:
    """Computes the motion. `computing` opens the folder for a computation; `row` holds what varies, as the folder keeps it."""
    if core.recipe:
        recipe = json.loads(core.recipe)
        words, initial, form = recipe["words"], dict(recipe["initial"]), recipe["form"]
        numbers = dict(computing().numbers(number))
        model = model_of(core, recipe)
        if runs_through_scenarios(model, [name for name, _ in words[0]]):
            model = model.with_(case=numbers.pop("case"))
        given = {"to": words[6] or (words[8] or [None])[-1], "tolerance": words[7]}
    else:
        model, initial, numbers, given = _of_command_line(core, row)
        form = core.asked("form") or "routh"
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


def _of_command_line(core: _core.SweepFolder, row: dict[str, Any]) -> tuple[Model, dict[str, str], dict[str, str], dict[str, str]]:
    from .reading import loads

    if core.asked("base file 1"):
        raise ModelError(f"the model of {core.path} refers to other files\nhint: anholon simulate with the numbers of the case")
    cases = core.asked("case").split()
    if "case_name" in row:
        # The command line keeps the options of its first scenario, which is the last of these.
        cases[-1] = row["case_name"]
    model = loads(core.asked("model"), set=_pairs(core.asked("set")), case=cases)
    if core.asked("mode"):
        model = model.in_mode(*core.asked("mode").split())
    initial: dict[str, str] = {}
    for order, option in enumerate(("q", "qdot", "qddot", "qdddot")):
        initial.update({name + "'" * order: value for name, value in _pairs(core.asked(option)).items()})
    numbers = {name.removesuffix("(0)"): repr(float(value)) for name, value in row.items() if name != "case_name"}
    times = core.asked("at").split()
    return model, initial, numbers, {"to": core.asked("to") or (times[-1] if times else ""), "tolerance": core.asked("tolerance")}


def _pairs(text: str) -> dict[str, str]:
    """"a=1 b=8 cm" by names."""
    return dict(word.split("=", 1) for word in re.split(r" (?=[^ =]+=)", text) if word) if text else {}
