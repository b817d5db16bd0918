"""Autograd of ``Dynamics.torch`` gives the derivatives of the compiled function."""

import anholon as an
import numpy as np
import pytest

torch = pytest.importorskip("torch")


@pytest.mark.parametrize("shape", [(), (4,), (2, 3)], ids=str)
def test_gradients_are_those_of_the_compiled_function(shape: tuple[int, ...]) -> None:
    f = an.load("trailers").dynamics(inputs=True)
    rates = f.torch()
    state = f.start.reshape(f.start.shape + (1,) * len(shape)) + 0.1 * np.random.default_rng(1).random((len(f.start), *shape))
    x, u, p = (torch.tensor(values, requires_grad=True) for values in (state, f.u0 + 0.3, f.p0))
    made = rates(0.0, x, u, p)
    assert np.array_equal(made.detach().numpy(), f(0.0, state, f.u0 + 0.3, f.p0))
    w = torch.arange(made.numel(), dtype=torch.float64).reshape(made.shape) + 1
    made.backward(w)
    for by, tensor in zip("xup", (x, u, p), strict=True):
        expected = f.vjp(0.0, state, w.numpy(), f.u0 + 0.3, f.p0, by=by)
        expected = expected if by == "x" or not shape else expected.sum(axis=tuple(range(1, expected.ndim)))
        assert np.allclose(tensor.grad.numpy(), expected, rtol=1e-14, atol=0)


def test_gradients_agree_with_differences() -> None:
    f = an.load("trailers").dynamics(inputs=True)
    rates = f.torch()
    x, u, p = (torch.tensor(values, requires_grad=True) for values in (f.start + 0.05, f.u0 + 0.3, f.p0))
    assert torch.autograd.gradcheck(lambda *given: rates(0.0, *given), (x, u, p), check_forward_ad=True)


def test_without_inputs_and_in_single_precision() -> None:
    f = an.load("disc").dynamics()
    x = torch.tensor(f.start, dtype=torch.float32, requires_grad=True)
    f.torch()(0.0, x).sum().backward()
    assert x.grad.dtype == torch.float32
    expected = f.vjp(0.0, x.detach().numpy(), np.ones(len(f.start)))
    assert np.allclose(x.grad.numpy(), expected, rtol=1e-6)
