"""The rates as formulas of other libraries: NumPy, JAX, CasADi, SymPy, mpmath."""

from __future__ import annotations

import ast
import ctypes
import functools
import os
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from ._arguments import without_mask
from ._errors import ModelError

if TYPE_CHECKING:
    from .dynamics import Dynamics

NOT_LINEAR = (
    "the equations are not linear in what they are solved for, so no formula gives the rates\n"
    "hint: f(t, x) and f.jac(t, x) compute them; f.formulas.mpmath has more digits"
)

NO_FORMULAS_OF_INPUTS = (
    "the formulas of the inputs hold what the equations are solved for\nhint: give u, for instance f.input(t, x) of the function f that these formulas are of"
)


def _refuse_other_length(name: str, values: Any, count: int, of: str) -> None:
    """Raises ValueError unless `values`, a sequence or an array, has this number of entries in its first axis."""
    shape = getattr(values, "shape", None)
    found = (shape[0] if len(shape) > 0 else None) if isinstance(shape, tuple) else len(values) if hasattr(values, "__len__") else None
    if found != count:
        raise ValueError(f"{name} has {'no axis' if found is None else f'{found} entries'}; its first axis has to be the {count} {of}")


# NumPy's names of elementary functions, with the names in libraries that call them differently.
_SHORT = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "arctan2": "atan2", "arcsinh": "asinh", "arccosh": "acosh", "arctanh": "atanh"}


# The number of Newton steps. The first one starts with the digits of a double, and each step doubles the digits.
_CORRECTIONS = 6


class _Library:
    """The functions of a library under NumPy's names.

    Args:
        module: the library.
        names: the library's own names by NumPy's, where they differ.
        choose: the function choose(condition, a, b), for formulas with cases.
    """

    def __init__(self, module: Any, names: dict[str, str], choose: Callable[[Any, Any, Any], Any]) -> None:
        self._module, self._names, self._choose = module, names, choose

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._module, self._names.get(name, name))
        setattr(self, name, found)
        return found

    def where(self, condition: Any, a: Any, b: Any) -> Any:
        return self._choose(condition, a, b)

    def searchsorted(self, knots: Sequence[float], x: Any, side: str) -> Any:
        """Returns the knots of a table with x; take() finds the value."""
        del side
        return knots, x

    def take(self, values: Sequence[float], at: Any) -> Any:
        """Returns the value whose index is the number of knots that are not above x."""
        knots, x = at
        out: Any = values[-1]
        for knot, value in zip(reversed(knots), reversed(values[:-1]), strict=True):
            out = self._choose(x < knot, value, out)
        return out


class _DifferentiatedLibrary(_Library):
    """A library that differentiates all that it computes: both values of a choice, and roots at 0."""

    def root_of_squares(self, u: Any, r: Any = None) -> Any:
        """Returns sqrt(u), or u**r for 0 < r < 1, of a sum of squares; its derivative at u = 0 is 0.

        By the rules it is 0/0 there, although formulas such as the drag |v| v have a derivative at rest.
        """
        zero = u == 0
        positive = self.where(zero, 1.0, u)
        return self.where(zero, 0.0, self.sqrt(positive) if r is None else positive**r)


class _ExactNumbers(ast.NodeTransformer):
    """Replaces 0.5 by _number("0.5")."""

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        if not isinstance(node.value, float):
            return node
        return ast.copy_location(ast.Call(ast.Name("_number", ast.Load()), [ast.Constant(repr(node.value))], []), node)


class Formulas:
    """The rates x' = f(t, x, u, p) and outputs y as formulas; see :meth:`Dynamics.formulas`.

    Example:
        >>> import anholon as an
        >>> formulas = an.load("chaplygin-sleigh").dynamics().formulas
        >>> formulas.sympy().rates.shape
        (5, 1)
    """

    def __init__(self, dynamics: Dynamics, source: str) -> None:
        self.dynamics: Dynamics = dynamics
        self.source: str = source
        self._module: dict[str, Any] = {}
        exec(compile(source, "<formulas>", "exec"), self._module)

    def _with_numbers(self, number: Callable[[str], Any]) -> dict[str, Any]:
        """Returns the functions of the module with numbers of another kind, which `number` makes of decimals."""
        tree = ast.parse(self.source)
        tree.body = [_ExactNumbers().visit(node) if isinstance(node, ast.FunctionDef) else node for node in tree.body]
        module: dict[str, Any] = {"_number": number}
        exec(compile(ast.fix_missing_locations(tree), "<formulas>", "exec"), module)
        return module

    @property
    def left_out(self) -> tuple[str, ...]:
        """The outputs of the model that the formulas lack: in independent velocities, those with multipliers."""
        return tuple(self._module["LEFT_OUT"])

    def evaluate(
        self,
        library: Any,
        solve: Callable[[list[list[Any]], list[Any]], Any],
        t: Any,
        x: Any,
        u: Any,
        p: Any,
        number: Callable[[str], Any] | None = None,
        lead: Sequence[Any] | None = None,
    ) -> tuple[list[Any], list[Any]]:
        """Returns rates and outputs, computed with the functions of any library.

        Args:
            library: an object that has sin, cos, … and where under NumPy's names.
            solve: the function solve(matrix, right) of matrix lead = right; it takes the matrix as rows.
            t: the time, s.
            x: the state, u: the inputs, p: the parameters; anything with an index.
            number: the function that makes numbers of the decimals in the formulas; they are floats if it is None.
            lead: approximate values of the unknowns of nonlinear equations; Newton's method corrects them.

        Raises:
            ModelError: the equations are nonlinear in their unknowns, and there is no `lead`.
        """
        module = self._module if number is None else self._with_numbers(number)
        if module["LEAD"] and not module["LINEAR"]:
            if lead is None:
                raise ModelError(NOT_LINEAR)
            for _ in range(_CORRECTIONS):
                matrix, right = module["equations"](library, t, x, u, p, lead)
                lead = [a + b for a, b in zip(lead, solve(matrix, right), strict=True)]
        elif module["LEAD"]:
            matrix, right = module["equations"](library, t, x, u, p)
            lead = solve(matrix, right)
        return module["rates"](library, t, x, u, p, lead), module["outputs"](library, t, x, u, p, lead)

    def _completed(self, library: Any, t: Any, x: Any, u: Any, p: Any, number: Callable[[str], Any] | None = None) -> tuple[Any, Any]:
        """Returns u and p. If u is None, the formulas of the model give it; if p is None, the parameters of the model do.

        Raises:
            ValueError: x, u or p has another number of entries than the function.
            ModelError: u is None, and the formulas of the inputs hold unknowns of the equations.
        """
        for name, values, key, of in (("x", x, "STATES", "states"), ("u", u, "INPUTS", "inputs"), ("p", p, "PARAMETERS", "parameters")):
            if name == "x" or values is not None:
                _refuse_other_length(name, values, len(self._module[key]), of)
        module = self._module if number is None else self._with_numbers(number)
        if p is None:
            p = self._module["DEFAULTS"] if number is None else module["defaults"](library)
        if u is None and module["INPUTS"] and "inputs" not in module:
            raise ModelError(NO_FORMULAS_OF_INPUTS)
        if u is None:
            u = module["inputs"](library, t, x, p) if module["INPUTS"] else ()
        return u, p

    def numpy(self) -> Callable[..., Any]:
        """Returns a function f(t, x, u, p) -> (x', y) of NumPy only, with the shapes of :class:`Dynamics`.

        Without u the inputs follow the formulas of the model. For a state at which the linear equations of the unknowns are singular
        the unknowns are NaN, and so are the rates and outputs that contain them. Other states of a batch have their values.
        The function raises ValueError if x, u or p has another number of entries than :class:`Dynamics`.
        """
        import numpy as np

        def solved(a: Any, b: Any) -> Any:
            """Returns the solutions of many systems. np.linalg.solve refuses all of them if one is singular."""
            try:
                return np.linalg.solve(a, b)
            except np.linalg.LinAlgError:
                half = len(a) // 2
                return np.concatenate([solved(a[:half], b[:half]), solved(a[half:], b[half:])]) if half > 0 else np.full_like(b, np.nan)

        def solve(matrix: list[list[Any]], right: list[Any]) -> Any:
            rows = np.stack(np.broadcast_arrays(*(entry for row in matrix for entry in row), *right))
            n = len(right)
            a = np.moveaxis(rows[: n * n].reshape(n, n, *rows.shape[1:]), (0, 1), (-2, -1))
            b = np.moveaxis(rows[n * n :], 0, -1)[..., None]
            return np.moveaxis(solved(a.reshape(-1, n, n), b.reshape(-1, n, 1)).reshape(*b.shape[:-1]), -1, 0)

        def f(t: Any, x: Any, u: Any = None, p: Any = None) -> Any:
            x, u, p = (values if values is None else np.asarray(without_mask(values), dtype=float) for values in (x, u, p))
            with np.errstate(all="ignore"):
                u, p = self._completed(np, t, x, u, p)
                rates, outputs = self.evaluate(np, solve, t, x, u, p)
            stacked = [np.stack([np.broadcast_to(row, x.shape[1:]) for row in rows]) if rows else np.empty((0, *x.shape[1:])) for rows in (rates, outputs)]
            return stacked[0], stacked[1]

        return f

    def jax(self) -> Callable[..., Any]:
        """Returns a pure function f(t, x, u, p) -> (x', y) of JAX, for ``jit``, ``vmap`` and ``grad``.

        Without u the inputs follow the formulas of the model. JAX computes with 32 bits unless
        ``jax.config.update("jax_enable_x64", True)`` is called before. Reverse derivatives compute the formulas again instead of
        storing their intermediate values. The function raises ValueError if x, u or p has another number of entries than
        :class:`Dynamics`.
        """
        import jax
        import jax.numpy as jnp

        library = _DifferentiatedLibrary(jnp, {}, jnp.where)

        def stack(rows: Sequence[Any], x: Any) -> Any:
            return jnp.stack([jnp.broadcast_to(row, x.shape[1:]) for row in rows]) if rows else jnp.empty((0, *x.shape[1:]))

        def f(t: Any, x: Any, u: Any = None, p: Any = None) -> Any:
            x, u, p = (without_mask(values) for values in (x, u, p))
            x = jnp.asarray(x)

            def solve(matrix: list[list[Any]], right: list[Any]) -> Any:
                a = jnp.stack([stack(row, x) for row in matrix])
                b = stack(right, x)
                return jnp.moveaxis(jnp.linalg.solve(jnp.moveaxis(a, (0, 1), (-2, -1)), jnp.moveaxis(b, 0, -1)[..., None])[..., 0], -1, 0)

            u, p = self._completed(library, t, x, u, p)
            rates, outputs = self.evaluate(library, solve, t, x, u, p)
            return stack(rates, x), stack(outputs, x)

        # Without checkpoint(), a reverse derivative of a rollout stores hundreds of numbers of each step as separate arrays, and XLA
        # takes ten times as long to compile such a loop.
        g: Callable[..., Any] = jax.checkpoint(f)
        return g

    def sympy(self) -> SymPyRates:
        """Returns the formulas as SymPy expressions."""
        return SymPyRates(self)

    def casadi(self, name: str = "f") -> Any:
        """Returns a ``casadi.Function`` (t, x, u, p) -> (dx, y) of CasADi's own expressions, with all derivatives.

        For long formulas the function of :meth:`Dynamics.casadi` is faster.
        """
        import casadi

        d = self.dynamics
        t, x, u, p = (casadi.SX.sym(n, k) for n, k in (("t", 1), ("x", len(d.states)), ("u", len(d.inputs)), ("p", len(d.parameters))))

        def solve(matrix: list[list[Any]], right: list[Any]) -> Any:
            # CasADi factors without pivots and loses digits where the equations are nearly singular. The residual, solved for with
            # the same factors, corrects the solution.
            a, b = casadi.vertcat(*(casadi.horzcat(*row) for row in matrix)), casadi.vertcat(*right)
            q, r = casadi.qr(a)
            solved = casadi.solve(r, q.T @ b)
            return solved + casadi.solve(r, q.T @ (b - a @ solved))

        library = _DifferentiatedLibrary(casadi, _SHORT | {"abs": "fabs"}, casadi.if_else)
        rates, outputs = self.evaluate(library, solve, t, x, u, p)
        return casadi.Function(name, [t, x, u, p], [casadi.vertcat(*rates), casadi.vertcat(*outputs)], ["t", "x", "u", "p"], ["dx", "y"])

    def mpmath(self, t: Any, x: Sequence[Any], u: Sequence[Any] | None = None, p: Sequence[Any] | None = None) -> Any:
        """Returns the rates and outputs (x', y) of one state, two lists, with as many digits as mpmath is set to.

        Without u the inputs follow the formulas of the model. Without p the parameters of the model are used, with all their digits.

        Raises:
            ValueError: x, u or p has another number of entries than :class:`Dynamics`.
        """
        import mpmath

        def solve(matrix: list[list[Any]], right: list[Any]) -> Any:
            return list(mpmath.lu_solve(mpmath.matrix(matrix), mpmath.matrix(right)))

        library = _Library(mpmath, _SHORT | {"abs": "fabs"}, lambda condition, a, b: a if condition else b)
        t = mpmath.mpf(t)
        inputs, parameters = self._completed(library, t, x, u, p, mpmath.mpf)
        lead = None
        if not self._module["LINEAR"]:
            lead = self.dynamics._core.leading(float(t), *([float(v) for v in values] for values in (x, inputs, parameters)))
        return self.evaluate(library, solve, t, x, inputs, parameters, mpmath.mpf, lead)


class SymPyRates:
    """Rates and outputs as SymPy expressions with the exact numbers of the model. Their symbols have the names of the model; independent
    velocities have the names of :attr:`Dynamics.states`.

    If ``matrix`` is not None, the rates are not explicit: they hold the symbols ``lead``, which solve ``matrix * lead = right``.
    """

    def __init__(self, formulas: Formulas) -> None:
        import sympy

        module = formulas._with_numbers(sympy.Rational)
        if not module["LINEAR"]:
            raise ModelError(NOT_LINEAR)
        self.t: Any = sympy.Symbol("t")
        self.x, self.u, self.p, self.lead = (
            [sympy.Symbol(name, real=True) for name in module[key]] for key in ("STATES", "INPUTS", "PARAMETERS", "LEAD")
        )

        def choose(condition: Any, a: Any, b: Any) -> Any:
            return sympy.Piecewise((a, condition), (b, True))

        library = _Library(sympy, _SHORT | {"abs": "Abs", "power": "Pow"}, choose)
        given = (library, self.t, self.x, self.u, self.p)
        self.matrix: Any = None
        self.right: Any = None
        if self.lead:
            matrix, right = module["equations"](*given)
            self.matrix, self.right = sympy.Matrix(matrix), sympy.Matrix(right)
        rates, outputs = (module[key](*given, self.lead) for key in ("rates", "outputs"))
        self.rates: Any = sympy.Matrix(rates)
        self.outputs: Any = sympy.Matrix(outputs) if outputs else sympy.zeros(0, 1)


@functools.lru_cache(maxsize=64)
def compile_c(source: str, flags: tuple[str, ...] = ("-O1",)) -> str:
    """Compiles C to a shared library that lives as long as the process; returns its path.

    Raises:
        ModelError: there is no C compiler, or it fails.
    """
    compiler = os.environ.get("CC") or shutil.which("cc") or shutil.which("gcc") or shutil.which("clang")
    if not compiler:
        raise ModelError("there is no C compiler\nhint: install one, such as gcc, or name it in the variable CC")
    with tempfile.TemporaryDirectory(prefix="anholon-") as folder:
        path = os.path.join(folder, "motion.c")
        with open(path, "w", encoding="utf-8") as file:
            file.write(source)
        made = path[:-2] + ".so"
        done = subprocess.run([compiler, *flags, "-fPIC", "-shared", path, "-o", made, "-lm"], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise ModelError(f"{compiler} fails:\n{done.stderr.strip()}")
        # The process keeps a loaded library when its file is deleted, but CasADi opens the file by its name.
        kept = os.path.join(_folder(), f"{abs(hash((source, flags))):x}.so")
        shutil.copyfile(made, kept)
    ctypes.CDLL(kept)
    return kept


@functools.cache
def _folder() -> str:
    import atexit

    folder = tempfile.mkdtemp(prefix="anholon-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder
