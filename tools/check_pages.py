#!/usr/bin/env python3
"""Checks that doc/json.md explains every key of the program's JSON, doc/outcomes.md every outcome, and that doc/theory/README.md lists every page.

usage: check_pages.py [--root DIR] [--self-test]

Keys are the literals in `key("…")` of src/; those of report pages are explained by viewer/CONTRACT.md, and the
JSON Schema of model files has names of its own.
"""

import argparse
import pathlib
import re
import sys
import tempfile

KEY = re.compile(r'\bkey\("([A-Za-z_]\w*)"\)')
OUTCOME = re.compile(r'return "([a-z_]+)"')
ELSEWHERE = ("src/report/", "src/modelfile/language/")
STILL = "src/report/equations"  # of src/report/: the JSON of `derive`


def check(root):
    problems = []
    page = (root / "doc/json.md").read_text(encoding="utf-8")
    explained = set(re.findall(r"[\w.]+", " ".join(re.findall(r"`([^`\n]+)`", page))))
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
    return problems


GOOD = {
    "doc/json.md": "| `model`, `t` | string |\n`{a, b}` of `\"form\"`\n",
    "doc/outcomes.md": "# Outcomes\n\n## finished\n\n## singular\n",
    "doc/theory/README.md": "[routh](routh.md)\n",
    "doc/theory/routh.md": "",
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
]


def self_test():
    failures = 0
    for change in [None, *MUTANTS]:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            for name, text in (GOOD | ({change[0]: change[1]} if change else {})).items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            problems = check(root)
            if len(problems) != (change is not None):
                print(f"{'not refused' if change else 'refused'}: {change} {problems}")
                failures += 1
    print(f"{failures} mistakes")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--self-test", action="store_true")
    args = parser.parse_args()
    if args.self_test:
        return self_test()
    problems = check(args.root)
    for problem in problems:
        print(problem)
    print(f"{len(problems)} gaps")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
