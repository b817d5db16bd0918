"""The C code of ``Dynamics.c_code`` has the functions that templates of acados call: names, shapes, sparsities. CasADi generates
variational equations that call it.

acados itself is not needed: its explicit integrators call functions that CasADi generates for the rates, their forward sensitivities
and their adjoint.
"""

import ctypes
import pathlib
import subprocess
from typing import Any

import anholon as an
import numpy as np
import pytest
from anholon.formulas import compile_c

ca = pytest.importorskip("casadi")


@pytest.fixture(scope="module")
def f() -> an.Dynamics:
    return an.load("trailers").dynamics(inputs=True)


def sparsity(library: Any, function: str, of: str, k: int) -> tuple[list[int], list[int]]:
    """Returns ([rows, columns], row of each entry, column by column) from a sparsity function of CasADi's interface."""
    call = getattr(library, f"{function}_sparsity_{of}")
    call.restype = ctypes.POINTER(ctypes.c_longlong)
    told = call(ctypes.c_longlong(k))
    rows, columns = told[0], told[1]
    count = told[2 + columns] if not (told[2] == 1) else rows * columns
    return [rows, columns], [told[3 + columns + i] for i in range(count)]


def test_names_and_sizes_that_a_template_reads(f: an.Dynamics) -> None:
    library = ctypes.CDLL(compile_c(f.c_code("car")))
    sizes = [1, len(f.states), len(f.inputs), len(f.parameters)]
    assert library.car_n_in() == 4 and library.car_n_out() == 2
    library.car_name_in.restype = library.car_name_out.restype = ctypes.c_char_p
    assert [library.car_name_in(ctypes.c_longlong(k)) for k in range(5)] == [b"t", b"x", b"u", b"p", None]
    assert [library.car_name_out(ctypes.c_longlong(k)) for k in range(3)] == [b"dx", b"y", None]
    assert [sparsity(library, "car", "in", k)[0] for k in range(4)] == [[size, 1] for size in sizes]
    assert sparsity(library, "car", "out", 0)[0] == [len(f.states), 1]
    work = [ctypes.c_longlong(-1) for _ in range(4)]
    assert library.car_work(*(ctypes.byref(number) for number in work)) == 0
    assert [number.value for number in work] == [4, 2, 0, 0]  # the sizes of the arrays that acados allocates
    names = [library.jac_car_n_out(), library.jac_car_n_in()]
    assert names == [8, 6]


def test_the_sparsity_holds_every_entry_of_the_jacobian(f: an.Dynamics) -> None:
    g = f.casadi()
    pattern = np.array(ca.DM(g.jacobian().sparsity_out(1), 1))  # dx by x
    some = np.random.default_rng(3)
    for _ in range(5):
        at = f.start + 0.2 * some.random(len(f.start))
        exact = f.jac(0.0, at, f.u0 + some.random(2))
        assert not exact[pattern == 0].any()
    assert 0 < pattern.sum() < pattern.size


def test_the_variational_equations_of_an_explicit_integrator(f: an.Dynamics, tmp_path: pathlib.Path) -> None:
    """Forward and adjoint sensitivities are generated as acados does, as C code that calls the code of Anholon."""
    source = f.c_code("car")
    rate = ca.external("car", compile_c(source))
    n, inputs = len(f.states), len(f.inputs)
    x, u, sx, su, adjoint = (ca.MX.sym(name, *shape) for name, shape in (("x", (n,)), ("u", (inputs,)), ("Sx", (n, n)), ("Su", (n, inputs)), ("a", (n,))))
    dx = rate(0.0, x, u, f.p0)[0]
    forward = [ca.jtimes(dx, x, sx), ca.jacobian(dx, u) + ca.jtimes(dx, x, su)]
    backward = ca.jtimes(dx, ca.vertcat(x, u), adjoint, True)
    generator = ca.CodeGenerator("vde.c", {"with_header": False})
    generator.add(ca.Function("forw", [x, sx, su, u], [dx, *forward]))
    generator.add(ca.Function("adj", [x, adjoint, u], [backward]))
    generator.generate(str(tmp_path) + "/")
    (tmp_path / "car.c").write_text(source)
    subprocess.run(["cc", "-O1", "-fPIC", "-shared", "vde.c", "car.c", "-o", "vde.so", "-lm"], cwd=tmp_path, check=True)
    made = str(tmp_path / "vde.so")
    some = np.random.default_rng(5)
    at, command, sx0, su0, a0 = f.start + 0.1 * some.random(n), some.random(inputs), some.random((n, n)), some.random((n, inputs)), some.random(n)
    by_x, by_u = f.jac(0.0, at, command), f.jac(0.0, at, command, by="u")
    got = [np.array(part) for part in ca.external("forw", made)(at, sx0, su0, command)]
    assert np.allclose(got[0][:, 0], f(0.0, at, command), rtol=1e-13, atol=1e-13)
    assert np.allclose(got[1], by_x @ sx0, rtol=1e-11, atol=1e-11)
    assert np.allclose(got[2], by_u + by_x @ su0, rtol=1e-11, atol=1e-11)
    back = np.array(ca.external("adj", made)(at, a0, command))[:, 0]
    assert np.allclose(back, np.concatenate([a0 @ by_x, a0 @ by_u]), rtol=1e-11, atol=1e-11)
