"""The equations of a motion as a compiled function."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from . import _core
from ._arguments import States, Values, array_of_values, in_order, labelled_values, number_of, numbers_of, states_of, takes_numbers, time_of
from ._c_names import refuse_c_name
from ._errors import ModelError
from ._mass_form import without_rates
from ._names import by_spelled_names, ByName
from ._torch import torch_function
from .formulas import NOT_LINEAR, Formulas, compile_c

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    from .model import Model

    Array = npt.NDArray[np.float64]


class Dynamics:
    """A function f(t, x, u, p) -> x', with outputs y. Threads may share it; large batches use all cores.

    Numbers are in SI units; an output that has a unit in the file is in that unit.

    :meth:`Model.dynamics` returns one. It can be pickled, for example for the workers of an optimizer; each process derives the
    equations again.

    Example:
        >>> import anholon as an
        >>> f = an.load("chaplygin-sleigh").dynamics()
        >>> x = f.state(q={"x": 0, "y": 0, "th": 0}, qdot={"x'": -0.5, "y'": 0, "th'": 1.5})
        >>> sorted(f.motion(x))[:2]
        ['th', "th'"]
    """

    def __init__(self, model: Model, core: _core.Dynamics, options: dict[str, Any]) -> None:
        self.model: Model = model
        self._core = core
        self._options = options  # the arguments of Model.dynamics
        self._count = len(core.states)
        self._formulas: Formulas | None = None

    def __reduce__(self) -> tuple[Callable[..., Dynamics], tuple[Model, dict[str, Any]]]:
        """Pickles the model and the options: another process derives the equations again."""
        return _made, (self.model, self._options)

    @property
    def states(self) -> list[_core.StateName]:
        """The entries of x: coordinates, velocities (or independent ones, with their formulas), higher derivatives if
        constraints of order 2 or more need them, then the model's states. Independent velocities are called u1, u2, …, and a name
        that the model has gets a number: u1_2."""
        return self._core.states

    def _state_names(self) -> list[str]:
        return [state.name for state in self.states]

    @property
    def inputs(self) -> list[str]:
        """The entries of u: the inputs of the model that are arguments, in the order in which they were asked for, or in that of
        the model if all are arguments."""
        return self._core.inputs

    @property
    def parameters(self) -> list[str]:
        """The entries of p: the parameters that do not follow from others, except vectors and those whose values decide the order
        of the equations, such as a mass that is 0, or which constraints with ``active`` hold. Other modes are entries of p, too; f
        does not change them, as it has no events."""
        return self._core.parameters

    @property
    def outputs(self) -> list[str]:
        """The entries of y: the outputs that were asked for, or the monitors and outputs of the model. Outputs with
        multipliers are left out in independent velocities, and if constraints depend on one another."""
        return self._core.outputs

    @property
    def minimal(self) -> bool:
        """True if the velocities in x are independent; if not, ``obstacle`` tells why."""
        return self._core.minimal

    @property
    def obstacle(self) -> str:
        """The reason why the velocities are not independent; empty if they are. If they are not, the constraints hold along exact
        solutions only, and numerical solutions drift from them slowly.

        Example:
            >>> import anholon as an
            >>> f = an.load("double-pendulum-cartesian").dynamics()
            >>> f.minimal, f.obstacle
            (False, "the constraint 'rod2' is of order 0")
        """
        return self._core.obstacle

    @property
    def linear(self) -> bool:
        """True if the equations are linear in the unknowns for which they are solved (accelerations, multipliers, …).

        Nonlinear equations may have several solutions. f(t, x, u, p) then follows the solution at the start along the
        straight line from the start to (t, x, u, p); it is NaN if that solution ends on the way.

        Example:
            >>> import anholon as an
            >>> an.load("disc").dynamics().linear
            True
        """
        return self._core.linear

    @property
    def t0(self) -> float:
        """The initial time, s."""
        return self._core.start_time

    @property
    def start(self) -> Array:
        """x at the initial state with the parameters of the model, shape (states,). :meth:`state` makes x for other parameters."""
        import numpy as np

        return np.array(self._core.start)

    @property
    def u0(self) -> Array:
        """u at the initial state, shape (inputs,)."""
        import numpy as np

        return np.array(self._core.start_inputs)

    @property
    def p0(self) -> Array:
        """The values that p has in the model, shape (parameters,)."""
        import numpy as np

        return np.array(self._core.parameter_values)

    def _values(self, given: Values, names: list[str], usual: Callable[[], Array], what: str, shape: tuple[int, ...] = ()) -> Array | None:
        """Returns one set of numbers, or one set for each state of a batch of this shape; None if nothing is given.

        Raises KeyError for a name that is not among `names`, and ValueError for a shape that does not fit.
        """
        labelled = labelled_values(given)
        if labelled is not None:
            labelled = by_spelled_names(labelled, what)
            fixed = next((name for name in labelled if what == "p" and name not in names and name in self.model.parameters), None)
            if fixed is not None:
                raise KeyError(
                    f"{fixed!r} is not in p: it is a vector, follows from other parameters, or its value decides the order of the equations or which constraints hold; "
                    f"the model has a function for another value, model.with_({fixed}=...).dynamics()"
                )
            given = in_order(labelled, names, usual, what)
        return None if given is None else array_of_values(given, len(names), what, shape)

    def __call__(self, t: float, x: States, u: Values = None, p: Values = None, *, out: Array | None = None) -> Array:
        """Returns the rates x' of one state, shape (states,), or of many states, shape (states, …), whose last axes count the states.

        Args:
            t: the time, s.
            x: states in their order, or all of them by name.
            u: inputs, shape (inputs,), or (inputs, …) for each state. If it is None, the formulas of the model give them at
                (t, x); the same formulas give the inputs left out of a mapping, with the inputs that are given.
            p: parameters, shape (parameters,), or (parameters, …) for each state; those of the model if it is None.
            out: an array of float64 of the shape of x, in any layout, for the result; a new one if it is None.

        Rates are NaN where the equations have no solution. Masked entries of an array of NumPy count as NaN. The rates of a state
        have the same bits in every batch.

        Raises:
            TypeError: t is not a number, or `out` is not an array of float64.
            ValueError: a shape does not fit, or `out` cannot be written to.
            KeyError: there is no state, input or parameter of that name, or x lacks a state.

        Example:
            >>> import anholon as an
            >>> f = an.load("disc").dynamics()
            >>> bool((f(0, f.start, p={"g": 1.62}) == f(0, f.start)).all())   # on the moon
            False
        """
        import numpy as np

        time = time_of(t)
        given = x if type(x) is np.ndarray and x.dtype == np.float64 and x.flags.c_contiguous else states_of(x, self._state_names())
        if given.shape[:1] != (self._count,):
            raise ValueError(f"x has the shape {given.shape}; its first axis has to be the {self._count} states")
        # The core writes to a contiguous array that shares no memory with x.
        to = out if out is not None and takes_numbers(out, given) else np.empty_like(given)
        if u is None and p is None:
            self._core.rates(time, given, to)
        else:
            self._core.rates(time, given, to, *self._given(time, given, u, p))
        if out is None:
            return to
        if to is not out:
            out[...] = to
        return out

    def _given(self, t: float, x: Array, u: Values, p: Values) -> tuple[Array | None, Array | None]:
        """Returns inputs and parameters of these states. Inputs left out of a mapping have the values of their formulas, which are
        computed with the inputs of the mapping."""
        import numpy as np

        labelled = labelled_values(u)
        named = by_spelled_names(labelled or {}, "u")
        others = self._values(p, self.parameters, lambda: self.p0, "p", x.shape[1:])

        def by_formulas() -> Array:
            count = int(np.prod(x.shape[1:], dtype=int))
            flat = x.reshape(self._count, count)
            each = None if others is None else np.broadcast_to(others.reshape(len(others), -1), (len(others), count))
            some = [[None] * count if name not in named else numbers(name) for name in self.inputs]
            rows = [
                self._core.inputs_at(t, flat[:, k].tolist(), [] if each is None else each[:, k].tolist(), [of[k] for of in some])
                for k in range(count)
            ]
            return np.array(rows).T.reshape((len(self.inputs), *x.shape[1:]))

        def numbers(name: str) -> list[float]:
            given = numbers_of(f"u[{name!r}]", named[name]).reshape(np.shape(named[name]))
            if given.shape not in ((), x.shape[1:]):
                raise ValueError(f"the input {name!r} has the shape {given.shape}; it has to be a number" + (f" or {x.shape[1:]}" if x.shape[1:] else ""))
            made: list[float] = np.broadcast_to(given, x.shape[1:]).reshape(-1).tolist()
            return made

        usual = by_formulas if labelled is not None and any(name not in named for name in self.inputs) else lambda: self.u0
        return self._values(u if labelled is None else named, self.inputs, usual, "u", x.shape[1:]), others

    def _states(self, t: float, x: States, u: Values, p: Values) -> tuple[Array, Array | None, Array | None, tuple[int, ...]]:
        """Returns states with their inputs and parameters, and the shape of the axes that count the states."""
        import numpy as np

        state = states_of(x, self._state_names())
        if state.shape[:1] != (self._count,):
            raise ValueError(f"x has the shape {state.shape}; its first axis has to be the {self._count} states")
        some, others = self._given(t, state, u, p)
        return state, some, others, state.shape[1:]

    def output(self, t: float, x: States, u: Values = None, p: Values = None) -> Array:
        """Returns the outputs y of one state, shape (outputs,), or of many states, shape (outputs, …), with the arguments of ``f(t, x)``.

        Example:
            >>> import anholon as an, numpy as np
            >>> f = an.load("disc").dynamics(minimal=False, outputs={"N": "reaction(disc).z", "lam": "lambda.rolling.y"})
            >>> f.outputs, f.output(0, np.tile(f.start[:, None], 100)).shape
            (['N', 'lam'], (2, 100))
        """
        time = time_of(t)
        state, some, others, batch = self._states(time, x, u, p)
        made: Array = self._core.outputs_at(time, state, some, others)
        return made.reshape((len(made), *batch))

    def input(self, t: float, x: States, p: Values = None) -> Array:
        """Returns the inputs by the formulas of the model, its controller, at one state, shape (inputs,).

        Raises:
            ValueError: x does not have the shape of one state.
        """
        import numpy as np

        time = time_of(t)
        state, _, parameters, batch = self._states(time, x, None, p)
        if batch:
            raise ValueError(f"x has the shape {state.shape}; it has to be that of one state, {(self._count,)}")
        return np.array(self._core.inputs_at(time, state.tolist(), [] if parameters is None else parameters.tolist()))

    def jac(self, t: float, x: States, u: Values = None, p: Values = None, *, by: str = "x", of: str = "x'") -> Array:
        """Returns the exact derivatives of the rates (or outputs) at one state or many, not finite differences.

        Args:
            t: the time, s.
            x: states, shape (states,) or (states, …), or all of them by name.
            u: inputs, which are held constant in derivatives by x; those of the formulas of the model if it is None.
            p: parameters; those of the model if it is None.
            by: "x", "u" or "p", the variable of the derivatives, whose shape is (rows, states, …), (rows, inputs, …) or
                (rows, parameters, …).
            of: "x'" for the rates, "y" for the outputs.

        Derivatives are NaN where the equations have no solution, in the row of a formula without a value, such as log(x) for x < 0, and
        where a formula has no derivative: at a kink or a jump of abs, min, max, sign, piecewise or a table. Those of a state have
        the same bits in every batch.

        Raises:
            ValueError: a shape does not fit, or `by` or `of` is another word.

        Example:
            >>> import anholon as an, numpy as np
            >>> f = an.load("trailers").dynamics(inputs=True)
            >>> f.jac(0, f.start).shape, f.jac(0, np.tile(f.start[:, None], 1000), by="u").shape
            ((9, 9), (9, 2, 1000))
        """
        if by not in ("x", "u", "p") or of not in ("x'", "y"):
            raise ValueError("by is 'x', 'u' or 'p', and of is \"x'\" or 'y'")
        time = time_of(t)
        state, some, others, batch = self._states(time, x, u, p)
        whole: Array = self._core.jacobian(time, state, some, others, "xup".index(by))
        chosen = whole[: self._count] if of == "x'" else whole[self._count :]
        return chosen.reshape((*chosen.shape[:2], *batch))

    def jvp(self, t: float, x: States, v: npt.ArrayLike, u: Values = None, p: Values = None, *, by: str = "x", of: str = "x'") -> Array:
        """Returns the derivatives times a direction, jac(…) v, shape (rows, …). v is one direction, or one for each state."""
        import numpy as np

        jacobian, direction = self._aligned(self.jac(t, x, u, p, by=by, of=of), v, 1)
        return np.asarray(jacobian @ direction if jacobian.ndim == 2 else np.einsum("ij...,j...->i...", jacobian, direction))

    def vjp(self, t: float, x: States, w: npt.ArrayLike, u: Values = None, p: Values = None, *, by: str = "x", of: str = "x'") -> Array:
        """Returns a covector times the derivatives, w jac(…), shape (columns, …). w is one covector, or one for each state."""
        import numpy as np

        jacobian, covector = self._aligned(self.jac(t, x, u, p, by=by, of=of), w, 0)
        return np.asarray(covector @ jacobian if jacobian.ndim == 2 else np.einsum("ij...,i...->j...", jacobian, covector))

    @staticmethod
    def _aligned(jacobian: Array, vector: npt.ArrayLike, axis: int) -> tuple[Array, Array]:
        array: npt.NDArray[Any] = numbers_of("the vector", vector)
        batch = jacobian.shape[2:]
        if array.shape[:1] != (jacobian.shape[axis],) or array.shape[1:] not in ((), batch):
            fits = f"{(jacobian.shape[axis],)}" + (f" or {(jacobian.shape[axis], *batch)}" if batch else "")
            raise ValueError(f"the vector has the shape {array.shape}; it has to be {fits}")
        return jacobian, array if array.ndim > 1 else array.reshape(array.shape + (1,) * len(batch))

    def _equations(self, t: float, x: States, u: Values, p: Values) -> tuple[Array, Array, Array]:
        """Returns M, Phi and the right side of  M q'' = Phi^T lambda + right.  The rates of the model's states are eliminated by
        their equations, so that a thrust, or another force with such a rate, is part of the right side."""
        if self.minimal:
            raise ModelError("in independent velocities there is no mass matrix\nhint: dynamics(minimal=False)")
        names = [c.name for c in self.model.coordinates]
        mechanical = [*names, *(n + "'" for n in names)]
        entries = self._state_names()
        of_states = entries[len(mechanical) :]  # the model's states, and their rates where a constraint needs them
        if entries != [*mechanical, *of_states] or not {e.rstrip("'") for e in of_states} <= set(self.model.states) or not self.linear:
            raise ModelError(
                "the equations are not solved for accelerations alone, so no mass matrix times accelerations is in them\n"
                "hint: model.equations() shows what they are; f.jac has the derivatives of the rates"
            )
        time = time_of(t)
        state, some, others, batch = self._states(time, x, u, p)
        parts = without_rates(*self._core.equations(time, state, some, others), len(names), {f"{z}'" for z in of_states})
        forces, jacobian, acting = (part.reshape((*part.shape[:-1], *batch)) for part in parts)
        return forces, jacobian, acting

    def mass_matrix(self, t: float, x: States, p: Values = None) -> Array:
        """Returns M of  M q'' + bias = Phi^T lambda,  shape (coordinates, coordinates), or (coordinates, coordinates, …) of many
        states. The formulas of the model give the inputs.

        Raises:
            ModelError: the velocities are independent ones; take ``dynamics(minimal=False)``.

        Example:
            >>> import anholon as an
            >>> f = an.load("chaplygin-sleigh").dynamics(minimal=False)
            >>> f.mass_matrix(0, f.start).shape, f.constraint_jacobian(0, f.start).shape
            ((3, 3), (1, 3))
        """
        return self._equations(t, x, None, p)[0]

    def bias(self, t: float, x: States, u: Values = None, p: Values = None) -> Array:
        """Returns the bias of  M q'' + bias = Phi^T lambda:  all terms without accelerations and multipliers, among them the thrust
        of expelled matter and forces with the rate of a state, shape (coordinates, …)."""
        return -self._equations(t, x, u, p)[2]

    def constraint_jacobian(self, t: float, x: States, p: Values = None) -> Array:
        """Returns Phi of  M q'' + bias = Phi^T lambda,  the derivatives of the constraints by the velocities (those of holonomic
        constraints by the coordinates), shape (constraints, coordinates, …). If an input keeps a constraint (``by``), the formula holds
        with the forces by a unit of the input in place of the column of Phi^T."""
        return self._equations(t, x, None, p)[1]

    @property
    def formulas(self) -> Formulas:
        """The rates as formulas of NumPy, JAX, CasADi, SymPy and mpmath."""
        if self._formulas is None:
            self._formulas = Formulas(self, self._core.source(False, ""))
        return self._formulas

    def c_code(self, name: str = "motion") -> str:
        """Returns a C file that needs no other file. It has ``name_rhs(t, x, u, p, dx)``, and for CasADi's external interface
        ``name``, (t, x, u, p) -> (dx, y), with the sparse Jacobian ``jac_name``. CasADi and acados load the compiled file.

        Raises:
            ModelError: the equations are not :attr:`linear`, or `name` is no name of a function in C: it has letters, digits and _,
                begins with a letter, and is no word of C or of its standard library.
        """
        refuse_c_name(name)
        if not self.linear:
            raise ModelError(NOT_LINEAR)
        return self._core.source(True, name)

    def casadi(self, name: str = "motion") -> Any:
        """Returns a ``casadi.Function`` (t, x, u, p) -> (dx, y), compiled from :meth:`c_code`, with its Jacobian.

        ``f.formulas.casadi()`` returns a function of CasADi's own expressions, which have second derivatives, too.

        Raises:
            ModelError: there is no C compiler, or `name` is no name of a function in C, as for :meth:`c_code`.
        """
        import casadi

        return casadi.external(name, compile_c(self.c_code(name)))

    def torch(self) -> Callable[..., Any]:
        """Returns a function of PyTorch, (t, x, u, p) -> x', whose gradients by x, u and p are :meth:`vjp` and :meth:`jvp`.

        Tensors have the shapes of ``f(t, x, u, p)``; u and p may be left out. Tensors may have any device and precision; the
        rates are computed in double precision on the CPU. Second derivatives and derivatives by t are not available.

        Raises:
            ModuleNotFoundError: PyTorch is not installed.

        Example:
            >>> import anholon as an
            >>> f = an.load("disc").dynamics()
            >>> x = torch.tensor(f.start, requires_grad=True)  # doctest: +SKIP
            >>> f.torch()(0.0, x).sum().backward()             # doctest: +SKIP
        """
        return torch_function(self)

    def state(
        self,
        t: float | None = None,
        *,
        q: Mapping[str, float] | None = None,
        qdot: Mapping[str, float] | None = None,
        z: Mapping[str, float] | None = None,
        p: Values = None,
    ) -> Array:
        """Returns x, shape (states,), for values of coordinates, velocities ("x'") and states of the model by name, in SI units.

        Values left out are 0. Higher derivatives that belong to the state ("x''") are given with the velocities. In independent
        velocities (``f.minimal``), the part of the velocities that violates the constraints is lost. A state of all velocities is
        as it is given, whether or not it keeps the constraints. `Model.initial` completes a state from the values that are given.

        Independent velocities may depend on parameters, as their formulas in ``f.states`` show. A state for ``f(t, x, p=p)`` then
        needs the same ``p``; without `p` it belongs to the parameters of the model.

        Args:
            t: the time, s; the initial time if it is None.
            q: coordinates by name; all are 0 if it is None.
            qdot: velocities, and higher derivatives of the state, by name; all are 0 if it is None.
            z: states of the model by name, with their rates if x holds these; all are 0 if it is None.
            p: parameters, shape (parameters,), or some by name; those of the model if it is None.

        Warns:
            UserWarning: a velocity of the state differs from the given one, as the given values violate the constraints; or x holds
                the rate of a state of the model, which is not among the values.

        Raises:
            KeyError: there is no coordinate, velocity, state or parameter of that name.
            ValueError: the shape of p does not fit.
            TypeError: a value is no number, or the values are not given by name.
        """
        import numpy as np

        names = self._names()
        given = []
        for of, have, expected in zip(("q", "qdot", "z"), ({} if values is None else values for values in (q, qdot, z)), names, strict=True):
            if not isinstance(have, Mapping):
                raise TypeError(f"{of} has values by name, as {of}={{{(expected or ['a'])[0]!r}: 0.5}}, not a {type(have).__name__}")
            given.append(by_spelled_names(have, of))
            for name in given[-1]:
                if name not in expected:
                    raise KeyError(f"there is no {name!r}; there are {', '.join(expected)}")
        at, others = self.t0 if t is None else time_of(t), self._values(p, self.parameters, lambda: self.p0, "p")
        q_list, qdot_list, z_list = ([number_of(n, have.get(n, 0.0)) for n in expected] for have, expected in zip(given, names, strict=True))
        if unknown := [n for n in names[2] if n.endswith("'") and n not in given[2]]:
            warnings.warn(f"x holds the rate {unknown[0]}, which counts as 0: give z={{{unknown[0]!r}: …}}", stacklevel=2)
        x = np.array(self._core.from_motion(at, q_list, qdot_list, z_list, [] if others is None else others.tolist()))
        if self.minimal:
            rates = {n: number_of(n, v) for n, v in given[1].items()}
            motion, scale = self.motion(x, at, others), max([1.0, *(abs(v) for v in rates.values())])
            lost = next((n for n, v in rates.items() if not abs(motion[n] - v) < 1e-6 * scale), None)
            if lost is not None:
                what = f"{lost} = {rates[lost]:g} is given, and the state has {lost} = {motion[lost]:g}: the velocities violate the constraints (those left out are 0)"
                warnings.warn(what + "; give all of them, or take those of model.initial(…)", stacklevel=2)
        return x

    def motion(self, x: States, t: float | None = None, p: Values = None) -> dict[str, float]:
        """Returns the coordinates, velocities (and higher derivatives of the state) and states of the model at one state x, by name.

        Args:
            x: a state, or its values by name.
            t: the time, s; the initial time if it is None.
            p: the parameters with which x was made, on which independent velocities may depend; those of the model if it is
                None.

        Raises:
            ValueError: x is not one state, or the shape of p does not fit.
            KeyError: there is no parameter of that name.

        Example:
            >>> import anholon as an, numpy as np
            >>> f = an.load("sleigh-with-moving-mass").dynamics()
            >>> x = f.state(q={"th": 0.4}, qdot={"x'": np.cos(0.4), "y'": np.sin(0.4), "th'": 1}, p={"m": 3})
            >>> round(f.motion(x, p={"m": 3})["th'"], 12)
            1.0
        """
        import numpy as np

        state = states_of(x, self._state_names())
        if state.shape != (self._count,):
            raise ValueError(f"x has the shape {state.shape}; it has to be one state, ({self._count},)")
        others = self._values(p, self.parameters, lambda: self.p0, "p")
        parts = self._core.to_motion(self.t0 if t is None else time_of(t), state.tolist(), [] if others is None else others.tolist())
        return ByName({n: v for names, values in zip(self._names(), parts, strict=True) for n, v in zip(names, values, strict=True)})

    def _names(self) -> tuple[list[str], list[str], list[str]]:
        """Returns the names of the coordinates, of the velocities with higher derivatives, and of the model's states, of which
        x may hold rates."""
        if self.minimal:
            coordinates = [c.name for c in self.model.coordinates]
            return coordinates, [name + "'" for name in coordinates], list(self.model.states)
        of_states = [n for n in self._state_names() if n.rstrip("'") in self.model.states]
        mechanical = self._state_names()[: self._count - len(of_states)]
        return [n for n in mechanical if not n.endswith("'")], [n for n in mechanical if n.endswith("'")], of_states

    def __repr__(self) -> str:
        return f"<f(t, x) of {self.model.title!r}: x = {', '.join(s.name for s in self.states)}>"


def _made(model: Model, options: dict[str, Any]) -> Dynamics:
    return model.dynamics(**options)
