#!/usr/bin/env python3
"""Checks that every equation tag cited in the code is derived in doc/theory/.

usage: check_refs.py [--root DIR] [--self-test]

Cited in src/formulation/ and src/mechanics/:
  [L 2.7]  [N 2.10, 3.1]  [L 2.8–2.13]   must stand, one by one or in a list, in a file of doc/theory/
  (theory: name)                         is a file doc/theory/name.md, a heading there (as a link would
                                         spell it), or stands there as (theory: name)
"""

import argparse
import pathlib
import re
import sys
import tempfile

NUMBER = r"\d+(?:\.\d+)*[a-z]?"
TAG = re.compile(rf"\[([A-Z]{{1,3}}) ({NUMBER}(?:\s*(?:,|–|-)\s*{NUMBER})*)\]")
THEORY = re.compile(r"\(theory: ?([\w.-]+)\)")
HEADING = re.compile(r"^#+\s+(.*?)\s*#*\s*$")


def expand(numbers):
    """'2.8–2.10, 3' -> 2.8 2.9 2.10 3; a range whose ends do not match gives its ends."""
    for part in re.split(r"\s*,\s*", numbers):
        ends = re.split(r"\s*[–-]\s*", part)
        first, last = ends[0], ends[-1]
        head, tail = first.rpartition(".")[::2]
        head2, tail2 = last.rpartition(".")[::2]
        if head == head2 and tail.isdigit() and tail2.isdigit() and int(tail) < int(tail2):
            for k in range(int(tail), int(tail2) + 1):
                yield f"{head}.{k}" if head else str(k)
        else:
            yield from dict.fromkeys(ends)


def tags(text):
    for match in TAG.finditer(text):
        for number in expand(match[2]):
            yield match.start(), f"[{match[1]} {number}]"


def slug(heading):
    return re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")


def check(root):
    known = set()
    for path in sorted((root / "doc" / "theory").glob("**/*.md")):
        text = path.read_text(encoding="utf-8")
        known.update(tag for _, tag in tags(text))
        known.update(f"(theory: {name})" for name in THEORY.findall(text))
        known.add(f"(theory: {path.stem})")
        for line in text.splitlines():
            heading = HEADING.match(line)
            if heading:
                known.add(f"(theory: {slug(heading[1])})")

    problems, cited = [], 0
    for layer in ("formulation", "mechanics"):
        for path in sorted(p for p in (root / "src" / layer).glob("**/*") if p.is_file()):
            text = path.read_text(encoding="utf-8")
            found = list(tags(text)) + [(m.start(), f"(theory: {m[1]})") for m in THEORY.finditer(text)]
            for position, tag in sorted(found):
                cited += 1
                if tag not in known:
                    line = text.count("\n", 0, position) + 1
                    problems.append(f"{path.relative_to(root)}:{line}: {tag} is not in doc/theory/")
    return problems, cited


def self_test():
    doc = "# Routh form\n\n### [L 2.7] elimination\nand [Q 13], [N 2.10, 3.1] and [L 2.8–2.11] (theory: lambda-sign)\n"
    good = "// [L 2.7] [Q 13] [N 3.1] [L 2.10] [L 2.9, 2.11] (theory: routh) (theory: routh-form) (theory: lambda-sign)\nint a[3];\n"
    bad = ["[L 2.12]", "[Q 1]", "[N 2.10, 3.2]", "[L 2.10–2.13]", "(theory: hamel)", "[NF 2.7]"]
    failures = 0
    for text, refused in [("", False), (good, False)] + [(f"//\n// {tag}\n", True) for tag in bad]:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            if text:
                (root / "doc/theory").mkdir(parents=True)
                (root / "doc/theory/routh.md").write_text(doc, encoding="utf-8")
                (root / "src/formulation/forms").mkdir(parents=True)
                (root / "src/formulation/forms/routh.cpp").write_text(text, encoding="utf-8")
            if bool(check(root)[0]) != refused:
                print(f"{'not refused' if refused else 'refused'}: {text!r} {check(root)[0]}")
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
    problems, cited = check(args.root)
    for problem in problems:
        print(problem)
    print(f"{cited} citations, {len(problems)} without a derivation")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
