"""The rates as formulas of other libraries agree with the compiled function."""

import os
import subprocess
import sys
from typing import Any

import anholon as an
import numpy as np
import pytest

# The models have explicit rates, a linear system, inputs, formulas with cases, and roots.
MODELS = [("disc", True), ("disc", False), ("trailers", True), ("snake", False), ("fourbar", False), ("snakeboard", True),
          ("tether-by-servo", True), ("third-order-linear", False)]  # fmt: skip


# XLA takes up to half a minute to compile long formulas, so only ANHOLON_LONG=1 tests all models.
IN_JAX = MODELS if os.environ.get("ANHOLON_LONG") else [("disc", True), ("fourbar", False), ("snakeboard", True)]


def point(name: str, minimal: bool) -> tuple[an.Dynamics, Any, Any, Any]:
    f = an.load(name).dynamics(minimal=minimal, inputs=True)
    x = f.start + 0.02 * np.cos(np.arange(len(f.start)))
    return f, x, f.u0 + 0.25, f.p0


@pytest.mark.parametrize(("name", "minimal"), MODELS)
def test_numpy(name: str, minimal: bool) -> None:
    f, x, u, p = point(name, minimal)
    g = f.formulas.numpy()
    rates, outputs = g(0.3, x, u, p)
    np.testing.assert_allclose(rates, f(0.3, x, u, p), rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose(outputs, f.output(0.3, x, u, p), rtol=1e-11, atol=1e-12)
    many = x[:, None, None] + np.linspace(0, 0.1, 6).reshape(2, 3)
    np.testing.assert_allclose(g(0.3, many, u, p)[0], f(0.3, many, u, p), rtol=1e-10, atol=1e-11)


@pytest.mark.parametrize(("name", "minimal"), IN_JAX)
def test_jax(name: str, minimal: bool) -> None:
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    f, x, u, p = point(name, minimal)
    g = jax.jit(f.formulas.jax())
    np.testing.assert_allclose(g(0.3, x, u, p)[0], f(0.3, x, u, p), rtol=1e-11, atol=1e-12)
    for k, by in enumerate("xup"):
        jac = jax.jacfwd(lambda *z: g(0.3, *z)[0], argnums=k)(x, u, p)
        expected = f.jac(0.3, x, u, p, by=by)
        np.testing.assert_allclose(jac, expected, rtol=1e-10, atol=1e-10 * max(1, np.abs(expected).max(initial=0)))
    gradient = jax.grad(lambda x: (g(0.3, x, u, p)[0] ** 2).sum())(x)
    np.testing.assert_allclose(gradient, 2 * f.vjp(0.3, x, f(0.3, x, u, p), u, p), rtol=1e-9, atol=1e-9)
    many = x[None, :] + np.linspace(0, 0.1, 5)[:, None]
    mapped = jax.vmap(lambda x: g(0.3, x, u, p)[0])(many)
    np.testing.assert_allclose(mapped, f(0.3, many.T.copy(), u, p).T, rtol=1e-10, atol=1e-11)


def test_a_reverse_derivative_in_jax_keeps_states_alone() -> None:
    jax = pytest.importorskip("jax")
    f, x, u, p = point("trailers", True)
    g = f.formulas.jax()

    def end(p: Any) -> Any:
        return jax.lax.scan(lambda x, _: (x + 0.01 * g(0.3, x, u, p)[0], None), jax.numpy.asarray(x), None, length=5)[0].sum()

    # A loop that stores the values of all formulas has hundreds of results, and XLA compiles it for minutes.
    loops = [e for e in jax.make_jaxpr(jax.grad(end))(p).eqns if e.primitive.name == "scan"]
    assert len(loops) == 2
    assert all(len(e.outvars) < 10 for e in loops)


@pytest.mark.parametrize(("name", "minimal"), MODELS)
def test_casadi(name: str, minimal: bool) -> None:
    pytest.importorskip("casadi")
    f, x, u, p = point(name, minimal)
    for g in (f.casadi(), f.formulas.casadi()):
        assert g.name_in() == ["t", "x", "u", "p"] and g.name_out() == ["dx", "y"]
        dx, y = g(0.3, x, u, p)
        np.testing.assert_allclose(np.array(dx)[:, 0], f(0.3, x, u, p), rtol=1e-11, atol=1e-12)
        np.testing.assert_allclose(np.array(y).reshape(-1), f.output(0.3, x, u, p), rtol=1e-11, atol=1e-12)
        blocks = g.factory("derivatives", ["t", "x", "u", "p"], ["jac:dx:x", "jac:dx:u", "jac:dx:p", "jac:y:x"])(0.3, x, u, p)
        for block, by in zip(blocks, "xup", strict=False):
            expected = f.jac(0.3, x, u, p, by=by)
            assert block.shape == expected.shape
            np.testing.assert_allclose(np.array(block.full()).reshape(expected.shape), expected, rtol=1e-10, atol=1e-10 * max(1, np.abs(expected).max(initial=0)))
        np.testing.assert_allclose(np.array(blocks[3].full()).reshape(-1), f.jac(0.3, x, u, p, of="y").reshape(-1), rtol=1e-10, atol=1e-12)
    # CasADi's own expressions have second derivatives, too.
    hessian = f.formulas.casadi().factory("h", ["t", "x", "u", "p", "lam:dx"], ["hess:gamma:x:x"], {"gamma": ["dx"]})
    assert hessian.size_out(0) == (len(x), len(x))


@pytest.mark.parametrize(("name", "minimal"), [("disc", True), ("chaplygin-sleigh", False)])
def test_sympy(name: str, minimal: bool) -> None:
    sm = pytest.importorskip("sympy")
    f, x, u, p = point(name, minimal)
    s = f.formulas.sympy()
    given = {s.t: 0.3, **dict(zip([*s.x, *s.u, *s.p], [*x, *u, *p], strict=True))}
    rates = s.rates
    if s.lead:
        rates = rates.subs(dict(zip(s.lead, s.matrix.LUsolve(s.right), strict=True)))
    assert not rates.atoms(sm.Float)  # numbers are exact
    np.testing.assert_allclose(np.array(rates.evalf(subs=given), dtype=float)[:, 0], f(0.3, x, u, p), rtol=1e-12, atol=1e-13)


def test_c_stands_by_itself() -> None:
    """The C file is strict C99 and needs no other file. Its rates agree with the compiled function in almost all digits."""
    import ctypes

    from anholon.formulas import compile_c

    for name, minimal in MODELS:
        f, x, u, p = point(name, minimal)
        library = ctypes.CDLL(compile_c(f.c_code("robot"), ("-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-D_DEFAULT_SOURCE")))
        double = ctypes.POINTER(ctypes.c_double)
        library.robot_rhs.argtypes = [ctypes.c_double, double, double, double, double]
        numbers = [np.ascontiguousarray(v) for v in (x, u, p)]
        for with_p in (True, False):
            dx = np.empty_like(x)
            arguments = [v.ctypes.data_as(double) for v in numbers]
            assert library.robot_rhs(0.3, arguments[0], arguments[1], arguments[2] if with_p else None, dx.ctypes.data_as(double)) == 0
            np.testing.assert_allclose(dx, f(0.3, x, u, p), rtol=1e-11, atol=1e-12)


AFFINE = """coordinates = ["x", "y", "th", "ps"]
parameters = {m = 2, a = 0.3, w = 0.4, J = 0.2}
observer.spin = "w*t*ez"
body = [{name = "b", mass = "m", inertia = "J", center = "x*ex + y*ey + a*(cos(th)*ex + sin(th)*ey)", angle = "th"},
  {name = "c", inertia = "J/2", center = "x*ex", angle = "ps"}]
constraint = [{name = "e", equation = "y'*cos(th) - x'*sin(th) = 0.1*t*ps' + 0.2*sin(3*t)"}]
initial = {t = 0.7, x = 0.2, th = 0.3, "x'" = 0.4, "th'" = 0.6}
"""


def test_all_that_c_computes_is_read() -> None:
    """The C code has no unused values: neither for constant factors that are moved out, nor for a matrix that needs no elimination."""
    from anholon.formulas import compile_c

    for model in (an.load("rocket"), an.loads(AFFINE)):
        for minimal in (True, False):
            compile_c(model.dynamics(minimal=minimal).c_code(), ("-std=c99", "-O0", "-Wall", "-Wextra", "-Werror", "-D_DEFAULT_SOURCE"))


def test_small_pivots_do_not_harm_generated_c() -> None:
    """With rods along the axes, pivots that were chosen at the start vanish."""
    pytest.importorskip("casadi")
    f = an.load("double-pendulum-cartesian").dynamics(minimal=False)
    g = f.casadi()
    for a in [(1, 1e-9), (1e-9, -1), (-1, 0), (0, 1)]:
        for b in [(1, 1e-9), (1e-9, -1), (-1, 0), (0, 1)]:
            x = np.array([*a, a[0] + 0.75 * b[0], a[1] + 0.75 * b[1], -0.3 * a[1], 0.3 * a[0], -0.3 * a[1] - 0.2 * b[1], 0.3 * a[0] + 0.2 * b[0]])
            np.testing.assert_allclose(np.array(g(0, x, [], f.p0)[0])[:, 0], f(0, x), rtol=1e-12, atol=1e-12)


def test_compilers_that_fail_say_so(monkeypatch: pytest.MonkeyPatch) -> None:
    from anholon.formulas import compile_c

    with pytest.raises(an.ModelError, match="fails"):
        compile_c("int f(void) { return 1")
    monkeypatch.setenv("CC", "")
    monkeypatch.setenv("PATH", "")
    with pytest.raises(an.ModelError, match="no C compiler"):
        compile_c("int g(void) { return 1; }")


def test_formulas_need_no_library_of_others() -> None:
    """Importing the package loads neither CasADi nor JAX nor SymPy."""
    code = "import anholon, sys; print([m for m in ('casadi', 'jax', 'sympy', 'scipy', 'matplotlib') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


STEERED = """coordinates = ["x", "th"]
parameters = {a = 0.1, b = "1/3", c = "pi/7"}
input.V = "2*sin(3*t)"
input.S = "0.3*V - b*th"
particle = [{name = "p", mass = 1, position = "x*ex + th*ey"}]
force = [{on = "p", vector = "(V + a)*ex + (S + c)*ey"}]
constraint = [{name = "k", equation = "x' = cos(x)*th'"}]
[initial]
x = 0.4
th = 0.5
"""


@pytest.mark.parametrize("minimal", [True, False])
def test_inputs_that_are_not_given_follow_the_model(minimal: bool) -> None:
    f = an.loads(STEERED).dynamics(minimal=minimal, inputs=True)
    x = f.start + 0.1 * np.arange(len(f.start))
    many = np.stack([x, x + 0.2], axis=1)
    np.testing.assert_allclose(f.formulas.numpy()(0.37, x)[0], f(0.37, x), rtol=1e-13)
    np.testing.assert_allclose(f.formulas.numpy()(0.37, many)[0], f(0.37, many), rtol=1e-13)
    import mpmath

    np.testing.assert_allclose([float(v) for v in f.formulas.mpmath(0.37, x.tolist())[0]], f(0.37, x), rtol=1e-12)
    with mpmath.workdps(40):
        numbers = [mpmath.mpf(str(v)) for v in x]
        p = [{"a": mpmath.mpf("0.1"), "b": mpmath.mpf(1) / 3, "c": mpmath.pi / 7}[name] for name in f.parameters]
        t = mpmath.mpf("0.37")
        V = 2 * mpmath.sin(3 * t)
        th = numbers[1]
        u = [V, mpmath.mpf("0.3") * V - th / 3]
        for a, b in zip(f.formulas.mpmath(t, numbers)[0], f.formulas.mpmath(t, numbers, u, p)[0], strict=True):
            assert abs(a - b) < mpmath.mpf(10) ** -37
    jax = pytest.importorskip("jax")
    jax.config.update("jax_enable_x64", True)
    np.testing.assert_allclose(f.formulas.jax()(0.37, x)[0], f(0.37, x), rtol=1e-12)
