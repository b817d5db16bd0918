"""Each notebook runs within 20 seconds of processor time and is the one that its text gives."""

import importlib.util
import pathlib
from types import ModuleType

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TEXTS = sorted((ROOT / "python" / "notebooks").glob("*.py"))


def converter() -> ModuleType:
    spec = importlib.util.spec_from_file_location("notebooks", ROOT / "tools" / "notebooks.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_there_are_six_and_more() -> None:
    assert len(TEXTS) >= 6


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: text.stem)
def test_a_notebook_runs(text: pathlib.Path) -> None:
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    pytest.importorskip("ipykernel")
    for library in ("matplotlib", "scipy", "sympy", "casadi"):
        if f"import {library}" in text.read_text(encoding="utf-8"):
            pytest.importorskip(library)
    place = text.with_suffix(".ipynb")
    assert place.read_text(encoding="utf-8") == converter().notebook(text.read_text(encoding="utf-8")), "tools/notebooks.py --write"
    notebook = nbformat.read(place, as_version=4)
    nbformat.validate(notebook)
    assert all(not cell.get("outputs") for cell in notebook.cells)
    # The limit is on processor time, as the machine may have other work.
    notebook.cells.append(nbformat.v4.new_code_cell("import time\ntime.process_time()"))
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    seconds = float(notebook.cells[-1].outputs[0].data["text/plain"])
    assert seconds < 20
    kinds = {kind for cell in notebook.cells for output in cell.get("outputs", []) for kind in output.get("data", {})}
    assert "text/html" in kinds
