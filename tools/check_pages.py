#!/usr/bin/env python3
"""Checks that doc/json.md explains every key of the program's JSON, doc/outcomes.md every outcome, that doc/theory/README.md lists every page,
doc/library.md every type and function of include/anholon/, and the table of doc/commands.md every command.

usage: check_pages.py [--root DIR] [--self-test]

Keys are the literals in `key("…")` of src/; those of report pages are explained by viewer/CONTRACT.md, and the
JSON Schema of model files has names of its own.
"""

import re
import sys

from checking import run, tree

KEY = re.compile(r'\bkey\("([A-Za-z_]\w*)"\)')
OUTCOME = re.compile(r'return "([a-z_]+)"')
ELSEWHERE = ("src/report/", "src/modelfile/language/")
STILL = "src/report/equations"  # the JSON of `derive`, the only part of src/report/ that is checked
PUBLIC = re.compile(  # a type or a function of a header, outside of classes
    r"^(?:template <[^\n]*\n)?(?:class|struct|enum class)(?: \[\[nodiscard\]\])?(?: ANHOLON_API)? (\w+)[^;\n]*[{:]|^(?:ANHOLON_API|inline) [^\n;(]*?(\w+)\(", re.M)


def in_code(text):
    """Returns the words of a page between backticks."""
    return set(re.findall(r"[\w.]+", " ".join(re.findall(r"`([^`\n]+)`", text))))


def check_library(root):
    """Returns a problem for each header, type and function that the row of its header in doc/library.md does not name."""
    rows = dict(re.findall(r"^\| \[`(\w+\.h)`\]\S* \|(.*)$", (root / "doc/library.md").read_text(encoding="utf-8"), re.M))
    problems = []
    for header in sorted((root / "include/anholon").glob("*.h")):
        text = re.sub(r"//.*", "", header.read_text(encoding="utf-8"))
        names = sorted({a or b for a, b in PUBLIC.findall(text)})
        said = {word.split("<")[0] for word in re.findall(r"`([^`]+)`", rows.get(header.name, ""))}
        problems += [f"doc/library.md: the row of {header.name} does not name {name}" for name in names if not any(re.match(rf"{name}\b", word) for word in said)]
    return problems


def check_commands(root):
    """Returns a problem for each command whose help is in doc/commands.md, but not in its first table."""
    page = (root / "doc/commands.md").read_text(encoding="utf-8")
    first = [re.sub(r" (?:\[?[A-Z]{2,}.*)$", "", call) for row in re.findall(r"^\|((?:[^|\\]|\\.)*)\|", page, re.M) for call in re.findall(r"`([^`]+)`", row)]
    return [f"doc/commands.md: its table does not have {name}" for name in re.findall(r"^###+ `anholon ([a-z ]+)`$", page, re.M) if name not in first]


def check(root):
    problems = []
    explained = in_code((root / "doc/json.md").read_text(encoding="utf-8"))
    for path in sorted(p for p in (root / "src").rglob("*") if p.suffix in (".cpp", ".h")):
        name = path.relative_to(root).as_posix()
        if name.startswith(ELSEWHERE) and not name.startswith(STILL):
            continue
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            problems += [f"{name}:{number}: doc/json.md does not explain the key {key}" for key in KEY.findall(line) if key not in explained]

    page = (root / "doc/outcomes.md").read_text(encoding="utf-8")
    for outcome in OUTCOME.findall((root / "src/base/outcome.cpp").read_text(encoding="utf-8")):
        if f"\n## {outcome}\n" not in page:
            problems.append(f"src/base/outcome.cpp: doc/outcomes.md has no section {outcome}")

    index = (root / "doc/theory/README.md").read_text(encoding="utf-8")
    for path in sorted((root / "doc/theory").glob("*.md")):
        if path.name != "README.md" and f"({path.name})" not in index:
            problems.append(f"doc/theory/README.md does not list {path.name}")
    return problems + check_library(root) + check_commands(root)


GOOD = {
    "doc/json.md": "| `model`, `t` | string |\n`{a, b}` of `\"form\"`\n",
    "doc/outcomes.md": "# Outcomes\n\n## finished\n\n## singular\n",
    "doc/theory/README.md": "[routh](routh.md)\n",
    "doc/theory/routh.md": "",
    "doc/library.md": "| [`run.h`](../include/anholon/run.h) | `simulate`: a motion; `Run<T>` | `Event` |\n",
    "include/anholon/run.h": "template <class T>\nclass ANHOLON_API Run {\n  struct Data;\n};\nstruct Event {\n};\nclass Ahead;\nANHOLON_API Run<int> simulate(int to);\n",
    "doc/commands.md": "| `check MODEL` | what |\n| `sweep status FOLDER`, `forms [MODEL]` | far |\n### `anholon check`\n#### `anholon sweep status`\n### `anholon forms`\n",
    "src/base/outcome.cpp": 'return "finished";\nreturn "singular";\nreturn "";\n',
    "src/cli/x.cpp": 'j.key("model").key("t").key("a").key("form").key(name);\n',
    "src/report/page/data.cpp": 'j.key("scene");\n',
    "src/report/equations_written.cpp": 'j.key("b");\n',
}
MUTANTS = [
    ("src/cli/x.cpp", 'j.key("steps")\n'),
    ("src/report/equations_written.cpp", '.key("scene")\n'),
    ("src/base/outcome.cpp", 'return "blow_up";\n'),
    ("doc/theory/forces.md", ""),
    ("include/anholon/run.h", "struct Trust {\n};\n"),
    ("include/anholon/run.h", "ANHOLON_API int stop();\n"),
    ("include/anholon/page.h", "class ANHOLON_API Page {\n};\n"),
    ("doc/commands.md", "| `check MODEL` | what |\n### `anholon check`\n### `anholon fly`\n"),
]


def self_test():
    for change in [None, *MUTANTS]:
        with tree(GOOD | ({change[0]: change[1]} if change else {})) as root:
            problems = check(root)
        if len(problems) != (change is not None):
            yield f"{'not refused' if change else 'refused'}: {change} {problems}"


def judge(root):
    problems = check(root)
    return problems, f"{len(problems)} gaps"


if __name__ == "__main__":
    sys.exit(run(__doc__, judge, self_test))
