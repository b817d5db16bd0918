"""Tests that take minutes; ``./dev long`` sets ANHOLON_LONG for them."""

import os
import pathlib
import resource
import subprocess
import venv

import anholon as an
import pytest
from test_arrays import memory

pytestmark = pytest.mark.skipif(not os.environ.get("ANHOLON_LONG"), reason="only under ./dev long")


def test_a_hundred_million_numbers_are_held_once() -> None:
    size, relative = memory("4400")
    assert size > 100_000_000
    assert relative < 1.2


def test_a_hundred_thousand_simulations_do_not_grow() -> None:
    model = an.load("chaplygin-sleigh")

    def rounds(count: int) -> None:
        for k in range(count):
            # Each round has another initial value, so that prepared systems are dropped, too.
            run = model.simulate(to=0.01, initial={"th": k % 1000 / 1000}, error_estimate=False)
            assert run.ok and run.q.shape[0] == len(run)

    rounds(2000)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    rounds(100_000)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20_000, "kB"


# ---- other compilers in the same process ----

OURS = """
run = an.load("disc").simulate(to=2000, at=[2000], error_estimate=False).expect()
assert run.report.steps > 20_000 and "anholon-compiler.so" in open("/proc/self/maps").read(), "machine code was not made"
found.append(run["theta"].tobytes())
"""
THEIRS = {
    "numba": "import numba\nassert numba.njit(lambda x: x * x + 1)(3.0) == 10",
    "heyoka": """import heyoka as hy
x, v = hy.make_vars("x", "v")
ta = hy.taylor_adaptive([(x, v), (v, -hy.sin(x))], [1.0, 0.0])
ta.propagate_until(10.0)
assert abs(ta.state[1] ** 2 / 2 - np.cos(ta.state[0]) + np.cos(1.0)) < 1e-13""",
    "jax": "import jax\nassert float(jax.jit(jax.grad(lambda x: x**3))(2.0)) == 12",
    "torch": "import torch\nassert float(torch.jit.script(torch.nn.Linear(2, 1))(torch.zeros(2)).shape[0]) == 1\nassert torch.from_dlpack(run['theta']).numpy()[0] == run['theta'][0]",
}


@pytest.fixture(scope="module")
def fresh(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """Returns the interpreter of a fresh environment with NumPy."""
    folder = tmp_path_factory.mktemp("others") / "env"
    venv.create(folder, with_pip=True)
    python = folder / "bin" / "python"
    installed(python, "numpy")
    return python


def installed(python: pathlib.Path, package: str) -> None:
    if package == "torch" and not os.environ.get("ANHOLON_TORCH"):
        pytest.skip("torch: PyPI has it for Linux with CUDA only, some GB; ANHOLON_TORCH=1 takes it")
    done = subprocess.run([python, "-m", "pip", "install", "-q", "--disable-pip-version-check", package], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip(f"{package} cannot be installed here: {done.stderr.strip().splitlines()[-1:]}")


@pytest.mark.parametrize("package", THEIRS)
def test_compilers_of_others_in_one_process(package: str, fresh: pathlib.Path) -> None:
    installed(fresh, package)
    paths = os.pathsep.join([str(pathlib.Path(an.__file__).parents[1])])
    for order in ("ours theirs ours", "theirs ours theirs"):
        parts = {"ours": OURS, "theirs": THEIRS[package]}
        late = order.startswith("theirs")
        head = "import numpy as np\nfound = []\n" + (f"{THEIRS[package]}\nimport anholon as an\n" if late and package != "torch" else "import anholon as an\n")
        if package == "torch" and late:
            head = "import numpy as np, torch\nimport anholon as an\nfound = []\n" + OURS
        code = head + "\n".join(parts[word] for word in order.split()) + "\nassert len(set(found)) == 1\nprint(found[0].hex())"
        done = subprocess.run([fresh, "-c", code], capture_output=True, text=True, check=False, env={**os.environ, "PYTHONPATH": paths, "ANHOLON_CACHE": ""})
        assert done.returncode == 0, f"{package}, {order}: {done.returncode}\n{done.stderr[-2000:]}"
        alone = an.load("disc").simulate(to=2000, at=[2000], error_estimate=False)["theta"]
        assert done.stdout.strip() == alone.tobytes().hex(), "the same bits as without them"
