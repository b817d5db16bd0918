"""The rates as a function of PyTorch, differentiated by autograd."""

from __future__ import annotations

import importlib
import types
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .dynamics import Dynamics


def torch_function(f: Dynamics) -> Callable[..., Any]:
    """Returns the function (t, x, u, p) -> x' of tensors; see :meth:`Dynamics.torch`."""
    torch = importlib.import_module("torch")

    def array(tensor: Any) -> Any:
        return None if tensor is None else tensor.detach().cpu().double().numpy()

    def like(values: Any, tensor: Any) -> Any:
        return torch.as_tensor(values).to(dtype=tensor.dtype, device=tensor.device)

    def forward(t: float, x: Any, u: Any, p: Any) -> Any:
        return like(f(t, array(x), array(u), array(p)), x)

    def setup_context(ctx: Any, inputs: tuple[Any, ...], output: Any) -> None:
        ctx.t, *tensors = inputs
        ctx.save_for_backward(*tensors)
        ctx.save_for_forward(*tensors)

    def backward(ctx: Any, w: Any) -> tuple[Any, ...]:
        x, u, p = ctx.saved_tensors
        gradients: list[Any] = [None]  # no gradient by t
        for by, tensor, needed in zip("xup", (x, u, p), ctx.needs_input_grad[1:], strict=True):
            if tensor is None or not needed:
                gradients.append(None)
                continue
            made = f.vjp(ctx.t, array(x), array(w), array(u), array(p), by=by)
            if made.ndim > tensor.ndim:  # the tensor has one set of numbers for all states of the batch
                made = made.sum(axis=tuple(range(tensor.ndim, made.ndim)))
            gradients.append(like(made, tensor))
        return tuple(gradients)

    def jvp(ctx: Any, _: Any, *directions: Any) -> Any:
        x, u, p = ctx.saved_tensors
        total = torch.zeros_like(x)
        for by, direction in zip("xup", directions, strict=True):
            if direction is not None:
                total = total + like(f.jvp(ctx.t, array(x), array(direction), array(u), array(p), by=by), x)
        return total

    members = {
        "forward": staticmethod(forward),
        "setup_context": staticmethod(setup_context),
        # The compiled function has no second derivatives, so autograd has to refuse them.
        "backward": staticmethod(torch.autograd.function.once_differentiable(backward)),
        "jvp": staticmethod(jvp),
    }
    function: Any = types.new_class("Rates", (torch.autograd.Function,), {}, lambda names: names.update(members))

    def rates(t: float, x: Any, u: Any = None, p: Any = None) -> Any:
        return function.apply(float(t), x, u, p)

    return rates
