"""The examples of README.md and of the pages of doc/ run in order, and the pages name all of the package."""

import inspect
import pathlib
import re

import anholon as an
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


def words(text: str) -> set[str]:
    """Returns the names in the code of a page: in blocks of Python and between backticks."""
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)
    spans = re.findall(r"`([^`\n]+)`", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S))
    return set(re.findall(r"\w+", "\n".join(blocks + spans)))


def names() -> list[str]:
    """Returns the public names of the package, and the members of its classes that are written in Python."""
    found = []
    for name in an.__all__:
        found.append(name)
        if inspect.isclass(getattr(an, name)):
            found += [f"{name}.{member}" for member in vars(getattr(an, name)) if not member.startswith("_")]
    return found


REFERENCE = words("\n".join((ROOT / page).read_text(encoding="utf-8") for page in ("doc/python.md", "doc/sweeps.md")))


@pytest.mark.parametrize("name", names())
def test_a_name_is_on_a_page(name: str) -> None:
    assert name.split(".")[-1] in REFERENCE, f"neither doc/python.md nor doc/sweeps.md shows {name}"


def test_words_of_code_alone_are_names() -> None:
    assert words("The run has `run.rows`.\n```python\nsweep = 1\n```\n```text\nlist\n```\n") == {"run", "rows", "sweep", "1"}
    assert len(names()) > 200
