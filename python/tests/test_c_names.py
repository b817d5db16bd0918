"""The text of generated C: names that it may have, titles, no value that is unused."""

from __future__ import annotations

import anholon as an
import pytest
from anholon.formulas import compile_c

STRICT = ("-std=c99", "-O0", "-Wall", "-Wextra", "-Werror", "-D_DEFAULT_SOURCE")


@pytest.mark.parametrize("name", ["a-b", "1a", "π", "", "_a", "a b", "double", "int", "sin", "sinf", "memcpy", "main", "isnan", "casadi_real"])
def test_names_that_are_none_of_c_are_refused(name: str) -> None:
    f = an.load("disc").dynamics()
    for call in (f.c_code, f.casadi):
        with pytest.raises(an.ModelError, match="letters of a to z|standard library"):
            call(name)
    with pytest.raises(TypeError, match="is a text"):
        f.c_code(3)  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["motion", "stretch", "member", "a1_b", "x", "t", "p", "lead", "status", "Robot"])
def test_other_names_compile(name: str) -> None:
    source = an.load("double-pendulum-cartesian").dynamics(minimal=False).c_code(name)
    assert f"int {name}_rhs(" in source
    compile_c(source, STRICT)


def test_a_free_particle_leaves_nothing_unused() -> None:
    model = an.loads('coordinates = ["x"]\nparticle = [{name = "p", mass = 1, position = "x*ex"}]\n')
    for minimal in (True, False):
        compile_c(model.dynamics(minimal=minimal).c_code(), STRICT)


def test_a_title_makes_no_trigraph() -> None:
    model = an.loads('title = "Why ??/"\ncoordinates = ["x"]\nparticle = [{name = "p", mass = 1, position = "x*ex"}]\n')
    for source in (model.c_code(), model.dynamics().c_code()):
        assert "Why ?? /" in source
        compile_c(source, STRICT)
