"""States at which a function has no rates or no derivatives: singular equations, formulas without a value, tables that are left, masks."""

from __future__ import annotations

import subprocess
import tempfile
from typing import Any

import anholon as an
import numpy as np
import pytest

# Calls the Jacobian with null pointers, which stand for zeros, and prints its status and its number of finite entries.
MAIN = """
#include <stdio.h>
#include <stdlib.h>
int main(void)
{
  const double *arg[6] = {0};
  double *res[8];
  int i, k, finite = 0, status;
  for (i = 0; i < 8; ++i) res[i] = calloc((size_t)(jac_motion_sparsity_out(i)[2 + jac_motion_sparsity_out(i)[1]] + 1), sizeof(double));
  status = jac_motion(arg, res, 0, 0, 0);
  for (i = 0; i < 8; ++i) {
    for (k = 0; k < jac_motion_sparsity_out(i)[2 + jac_motion_sparsity_out(i)[1]]; ++k) finite += isfinite(res[i][k]) != 0;
    free(res[i]);
  }
  printf("%d %d\\n", status, finite);
  return 0;
}
"""
SANITIZED = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-D_DEFAULT_SOURCE", "-fsanitize=address,undefined", "-fno-sanitize-recover=undefined",
             "-fno-sanitize=float-divide-by-zero")  # fmt: skip


@pytest.mark.parametrize("name", ["double-pendulum-cartesian", "closed-chain", "fekete", "luo-zhao-example-1"])
def test_the_jacobian_in_c_of_a_singular_state_is_nan(name: str) -> None:
    source = an.load(name).dynamics(minimal=False).c_code()
    with tempfile.TemporaryDirectory() as folder:
        path = f"{folder}/motion"
        subprocess.run(["cc", *SANITIZED, "-x", "c", "-", "-o", path, "-lm"], input=source + MAIN, text=True, check=True)
        done = subprocess.run([path], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "1 0\n"), done.stderr


def test_casadi_refuses_values_and_derivatives_of_a_singular_state() -> None:
    pytest.importorskip("casadi")
    f = an.load("double-pendulum-cartesian").dynamics(minimal=False)
    g, z = f.casadi(), np.zeros(len(f.states))
    jacobian = g.jacobian()
    for function, outputs in ((g, []), (jacobian, [0, 0])):
        with pytest.raises(RuntimeError):
            function(0, z, [], f.p0, *outputs)
    assert np.isnan(f.jac(0, z)).all()


POINT = """coordinates = ["x", "y"]
parameters = {{a = 1}}
particle = [{{name = "p", mass = 1, position = "x*ex + y*ey"}}]
force = [{{generalized = {{x = "{}"}}}}]
output.e = "2*y + {}"
initial = {{x = {}}}
"""


@pytest.mark.parametrize("minimal", [True, False])
@pytest.mark.parametrize(("force", "inside", "beyond"), [("log(x) + a*y", 1, -2), ("atanh(x) + a*y", 0.5, 2), ("sqrt(x) + a*y", 1, -1)])
def test_a_formula_without_a_value_has_no_derivatives(force: str, inside: float, beyond: float, minimal: bool) -> None:
    f = an.loads(POINT.format(force, force, inside)).dynamics(minimal=minimal)
    at, off = [inside, 0.1, 0.2, 0.3], [beyond, 0.1, 0.2, 0.3]
    row = [s.name for s in f.states].index("x'") if not minimal else int(np.flatnonzero(np.isnan(f(0, off)))[0])
    assert np.isfinite(f.jac(0, at)).all() and np.isfinite(f.jac(0, at, of="y")).all()
    assert list(np.flatnonzero(np.isnan(f(0, off)))) == [row]
    for by in ("x", "p"):
        jac = f.jac(0, off, by=by)
        assert np.isnan(jac[row]).all() and np.isfinite(jac[:2]).all()  # x' and y' are entries of the state
        assert np.isnan(f.jac(0, off, by=by, of="y")).all()
    np.testing.assert_array_equal(f.jac(0, np.array([at, off]).T)[:, :, 1], f.jac(0, off))
    casadi = pytest.importorskip("casadi")
    blocks = f.casadi().jacobian()(0, off, [], f.p0, 0, 0)
    of_x = np.array(casadi.DM(blocks[1]))
    assert np.isnan(of_x[row][f.jac(0, at)[row] != 0]).all() and np.isfinite(of_x[:2]).all()
    assert np.isnan(np.array(casadi.DM(blocks[5]))[0, 0])


TABLE = """coordinates = ["x"]
table = [{name = "w", x = [0, 1, 2], y = [0, 1, 4], fit = "FIT", outside = "error"}]
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{generalized = {x = "w(x)"}}]
output.W = "w(x)^2"
initial = {x = 0.5}
"""


@pytest.mark.parametrize("minimal", [True, False])
@pytest.mark.parametrize("fit", ["hold", "linear", "spline"])
def test_a_table_that_must_not_be_left_has_no_value_outside(fit: str, minimal: bool) -> None:
    f = an.loads(TABLE.replace("FIT", fit)).dynamics(minimal=minimal)
    x = np.array([[-1e-9, 0, 0.5, 2, 2.1], np.full(5, 0.3)])
    outside = [True, False, False, False, True]
    g = f.formulas.numpy()
    for rates in (f(0, x), g(0, x, [], f.p0)[0], np.array([f(0, x[:, k]) for k in range(5)]).T, np.tile(f(0, np.tile(x, 100)), 1)[:, -5:]):
        assert list(np.isnan(rates[1])) == outside and np.isfinite(rates[0]).all()
        assert rates[1, 3] == pytest.approx(4)
    assert list(np.isnan(f.output(0, x)[0])) == outside
    assert list(np.isnan(f.jac(0, x)[1]).any(axis=0)) == [True, True, False, True, True]  # at the ends the slope is one-sided
    pytest.importorskip("casadi")
    for h in (f.casadi(), f.formulas.casadi()):
        assert list(np.isnan([float(h(0, x[:, k], [], f.p0)[0][1]) for k in range(5)])) == outside


def test_inputs_by_a_table_have_no_value_outside() -> None:
    text = TABLE.replace("FIT", "spline").replace('x = "w(x)"}', 'x = "F"}').replace("particle =", 'input.F = "w(x)"\nparticle =')
    f = an.loads(text).dynamics(inputs=True)
    assert f.input(0, [2, 0])[0] == pytest.approx(4) and np.isnan(f.input(0, [2.1, 0])[0])
    assert np.isnan(f(0, [2.1, 0.3])[1]) and f(0, [2.1, 0.3], {"F": 1})[1] == 1
    assert np.isnan(f.formulas.numpy()(0, [2.1, 0.3])[0][1])


def test_programs_have_no_value_of_a_table_that_is_left() -> None:
    import ctypes

    from anholon.formulas import compile_c

    model = an.loads(TABLE.replace("FIT", "spline"), name="motion")
    module: dict[str, Any] = {}
    exec(model.python_code(), module)
    library = ctypes.CDLL(compile_c(model.c_code()))
    array = ctypes.c_double * 2
    library.motion_rhs.argtypes = [ctypes.c_double, array, ctypes.POINTER(ctypes.c_double), array]
    for x, known in [(0.5, True), (2.0, True), (2.1, False), (-0.1, False)]:
        rate = array()
        status = library.motion_rhs(0, array(x, 0.3), None, rate)
        assert (status == 0) is known and np.isfinite(rate[1]) == known
        assert np.isfinite(module["rhs"](0, np.array([x, 0.3]))[1]) == known


def test_rates_in_independent_velocities_end_with_a_table() -> None:
    model = an.loads(
        """
        coordinates = ["x", "y"]
        table = [{name = "w", x = [0, 1, 2], y = [0, 1, 4], fit = "spline", outside = "error"}]
        particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
        constraint = [{name = "c", equation = "y' = w(x)*x'"}]
        force = [{on = "p", vector = "w(x)*ex"}]
        initial = {x = 0.5, "x'" = 0.3}
        """
    )
    module: dict[str, Any] = {}
    exec(model.python_code(), module)
    f = model.dynamics()
    for rates in (f, module["rates"]):
        made = np.array([rates(0, [x, 0, 0.3]) for x in (0.5, 2.0, 2.1, -0.1)])
        assert list(np.isnan(made[:, 2])) == [False, False, True, True]


def test_masked_entries_count_as_nan() -> None:
    f = an.load("disc").dynamics(inputs=True)
    many = np.tile(f.start[:, None], 3)
    mask = np.zeros_like(many, dtype=bool)
    mask[2, 1] = True
    hidden, told = np.ma.masked_array(many, mask=mask), np.where(mask, np.nan, many)
    np.testing.assert_array_equal(f(0, hidden), f(0, told))
    assert np.isnan(f(0, hidden)[:, 1]).any() and np.isfinite(f(0, hidden)[:, 0]).all()
    for function in (f.output, f.jac):
        np.testing.assert_array_equal(function(0, hidden), function(0, told))
    np.testing.assert_array_equal(f.formulas.numpy()(0, hidden, [], f.p0)[0], f.formulas.numpy()(0, told, [], f.p0)[0])
    p = np.ma.masked_array(f.p0, mask=[True, *[False] * (len(f.p0) - 1)])
    assert np.isnan(f(0, f.start, p=p)).any()
    with pytest.raises(TypeError):
        f(0, np.ma.masked_array(["a"] * len(f.start), mask=False))
