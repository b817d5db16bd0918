"""The examples of README.md and of the pages of doc/, run in order."""

import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "doc").rglob("*.md"))]
READ_RESULTS = {"doc/results.md", "doc/sweeps.md"}  # their Python reads files of runs that the reader has
DOCUMENTS = [p.relative_to(ROOT).as_posix() for p in PAGES if "\n```python\n" in p.read_text(encoding="utf-8")]
DOCUMENTS = [name for name in DOCUMENTS if name not in READ_RESULTS]


@pytest.mark.parametrize("document", DOCUMENTS)
def test_examples_run(document: str, tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / document).read_text(encoding="utf-8"), re.M | re.S)
    assert blocks
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, document, "exec"), names)
