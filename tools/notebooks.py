#!/usr/bin/env python3
"""Makes the notebooks NAME.ipynb from their texts python/notebooks/NAME.py, which editors open as cells.

    notebooks.py --write       writes all .ipynb anew
    notebooks.py               exits with status 1 if a .ipynb is not the one of its text
    notebooks.py --self-test

A line `# %%` begins a cell of code, `# %% [markdown]` a cell of words, whose lines are comments.
"""

import json
import pathlib
import sys

FOLDER = pathlib.Path(__file__).resolve().parents[1] / "python" / "notebooks"
KERNEL = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}, "language_info": {"name": "python"}}


def cells(text):
    """Returns (kind, source) of each cell."""
    found = []
    for line in text.splitlines():
        if line.startswith("# %%"):
            found.append(("markdown" if line.strip() == "# %% [markdown]" else "code", []))
        elif not found:
            if line.strip():
                raise ValueError(f"a text begins with a cell, not with {line!r}")
        elif found[-1][0] == "markdown":
            if line and not line.startswith("#"):
                raise ValueError(f"a line of words begins with #: {line!r}")
            found[-1][1].append(line[1:].removeprefix(" "))
        else:
            found[-1][1].append(line)
    return [(kind, "\n".join(lines).strip("\n")) for kind, lines in found]


def notebook(text):
    """Returns the notebook of a text as JSON without outputs."""
    made = []
    for number, (kind, source) in enumerate(cells(text)):
        cell = {"cell_type": kind, "id": f"cell-{number}", "metadata": {}, "source": source.splitlines(keepends=True)}
        made.append(cell if kind == "markdown" else {**cell, "execution_count": None, "outputs": []})
    return json.dumps({"cells": made, "metadata": KERNEL, "nbformat": 4, "nbformat_minor": 5}, indent=1, ensure_ascii=False) + "\n"


def main(write):
    status = 0
    for text in sorted(FOLDER.glob("*.py")):
        place = text.with_suffix(".ipynb")
        wanted = notebook(text.read_text(encoding="utf-8"))
        if write:
            place.write_text(wanted, encoding="utf-8")
        elif not place.exists() or place.read_text(encoding="utf-8") != wanted:
            print(f"{place.name} is not what {text.name} gives: tools/notebooks.py --write")
            status = 1
    for place in sorted(FOLDER.glob("*.ipynb")):
        if not place.with_suffix(".py").exists():
            print(f"{place.name} has no text beside it")
            status = 1
    return status


def self_test():
    text = "# %% [markdown]\n# # A\n#\n# words\n\n# %%\nx = 1\n\n\ny = 2\n"
    assert cells(text) == [("markdown", "# A\n\nwords"), ("code", "x = 1\n\n\ny = 2")]
    made = json.loads(notebook(text))
    assert [c["cell_type"] for c in made["cells"]] == ["markdown", "code"] and made["cells"][1]["outputs"] == []
    for wrong in ("x = 1\n# %%\n", "# %% [markdown]\nx = 1\n"):
        try:
            cells(wrong)
        except ValueError:
            continue
        raise AssertionError(wrong)
    assert notebook(text) != notebook(text.replace("y = 2", "y = 3"))


if __name__ == "__main__":
    if sys.argv[1:] == ["--self-test"]:
        self_test()
    else:
        sys.exit(main(sys.argv[1:] == ["--write"]))
