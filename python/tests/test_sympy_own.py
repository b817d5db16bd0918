"""The systems of SymPy's own tests of mechanics are imported with the accelerations that SymPy finds for them.

The module runs SymPy's tests and reads every KanesMethod, LagrangesMethod and System that they make.
"""

import contextlib
import importlib
import inspect
import os
import random
import re
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import anholon as an
import pytest
from anholon._sympy_import import Import
from test_sympy import accelerations_of_sympy, consistent

me = pytest.importorskip("sympy.physics.mechanics")

MODULES = ["test_kane4", "test_lagrange2", "test_models"]
if os.environ.get("ANHOLON_LONG"):
    MODULES += ["test_kane", "test_kane2", "test_kane5", "test_lagrange", "test_jointsmethod", "test_system_class", "test_linearize"]

# Systems that are refused, with a text of the message.
REFUSED = {
    "test_kane.test_issue_24887": "no inertia acts on q3",  # the mass matrix of SymPy is singular, too
    "test_kane2.test_sub_qdot2": "the model has no body",
}
# This test sets the acceleration of the point of a wheel that touches the ground to zero.
TOLD_OTHERWISE = {"test_kane.test_aux"}


def tried(module: Any) -> Iterator[tuple[str, Callable[[], None]]]:
    for name, f in list(vars(module).items()):
        if name.startswith("test") and inspect.isfunction(f) and not inspect.signature(f).parameters:
            yield name, f
        elif name.startswith("Test") and inspect.isclass(f):
            for method in [x for x in vars(f) if x.startswith("test")]:

                def run(of: Any = f, method: str = method) -> None:
                    made = of()
                    for before in ("_empty_system_setup", "_filled_system_setup", "setup_method"):
                        if hasattr(made, before):
                            with contextlib.suppress(TypeError):
                                inspect.unwrap(getattr(of, before))(made)  # unwrap() is needed for fixtures
                    getattr(made, method)()

                yield f"{name}.{method}", run


def systems(module: str, monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, Any]]:
    """Returns the systems that the tests of a module make, with the names of the tests."""
    found: list[tuple[str, Any]] = []
    here = ""
    for of, name in ((me.KanesMethod, "kanes_equations"), (me.LagrangesMethod, "form_lagranges_equations"), (me.System, "form_eoms")):
        original = getattr(of, name)

        def watched(self: Any, *args: Any, original: Any = original, **more: Any) -> Any:
            result = original(self, *args, **more)
            if not any(x is self for _, x in found):
                found.append((here, self))
            return result

        monkeypatch.setattr(of, name, watched)
    loaded = importlib.import_module("sympy.physics.mechanics.tests." + module)
    for name, test in tried(loaded):
        here = f"{module}.{name}"
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            with contextlib.suppress(Exception, pytest.skip.Exception):
                test()
    return found


def values_for(method: Any) -> dict[Any, Any]:
    """Returns random values of all symbols and given functions; products of inertia are small."""
    made, draw = Import(method), random.Random(4)
    with contextlib.suppress(an.ModelError):
        made.text("", {}, {})
    product = re.compile(r"(xy|xz|yz|zx|23|12|13|31)$")
    values: dict[Any, Any] = {s: 0.05 if product.search(s.name) else round(draw.uniform(0.8, 1.2), 3) for s in made.writer.parameters}
    moments = [s for s in values if re.fullmatch(r"I[xyz]", s.name)]
    values.update(dict.fromkeys(moments, 3.0))
    return {**values, **{f: round(draw.uniform(0.5, 1.5), 3) for f in made.writer.functions}}


def deviation(method: Any) -> float:
    """Returns the largest relative difference between the accelerations of SymPy and of the model."""
    values = values_for(method)
    model, made = an.from_sympy(method, values=values), Import(method)
    state, names = consistent(made, values), made.writer.names
    f = model.dynamics(minimal=False)
    rates = {names[c] + "'": state[c.diff(made.time)] for c in made.writer.q}
    x = f.state(0.0, q={names[c]: state[c] for c in made.writer.q}, qdot=rates)
    ours = dict(zip((s.name for s in f.states), f(0.0, x), strict=True))
    expected = accelerations_of_sympy(method, made, values, state)
    return float(max(abs(ours[names[c] + "'"] - expected[c]) / max(1, abs(expected[c])) for c in method.q))


@pytest.mark.parametrize("module", MODULES)
@pytest.mark.filterwarnings("ignore")
def test_systems_of_sympy_agree(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    found = systems(module, monkeypatch)
    assert found
    wrong: list[str] = []
    for name, method in found:
        try:
            far = deviation(method)
            told = name in TOLD_OTHERWISE
            if (far > 1e-12) != told or name in REFUSED:
                wrong.append(f"{name}: {far}")
        except Exception as e:
            if REFUSED.get(name, "\0") not in str(e):
                wrong.append(f"{name}: {type(e).__name__}: {e}")
    assert not wrong, "\n".join(wrong)
