#!/usr/bin/env python3
"""Checks that every equation tag cited in the code, the tests and the documents is derived in doc/theory/.

usage: check_refs.py [--root DIR] [--self-test]

Cited in src/, test/, doc/ and NOTATION.md:
  [L 2.7]  [N 2.10, 3.1]  [L 2.8–2.13]   occurs, alone or in a list, in a file of doc/theory/
  (theory: name)                         is a file doc/theory/name.md or a heading there, as a link would spell it
"""

import re
import sys

from checking import run, tree

NUMBER = r"\d+(?:\.\d+)*[a-z]?"
TAG = re.compile(rf"\[([A-Z]{{1,3}}) ({NUMBER}(?:\s*(?:,|–|-)\s*{NUMBER})*)\]")
THEORY = re.compile(r"\(theory: ?([\w.-]+)\)")
HEADING = re.compile(r"^#+\s+(.*?)\s*#*\s*$")
FOLDERS = ("src", "test", "doc")
SUFFIXES = {".h", ".cpp", ".def", ".py", ".md"}
EXAMPLE = "(theory: name)"  # an example of a citation, which is not checked


def expand(numbers):
    """Yields the numbers of a list with ranges: '2.8–2.10, 3' -> 2.8 2.9 2.10 3. Of a range whose ends do not match, yields the ends."""
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
        known.add(f"(theory: {path.stem})")
        for line in text.splitlines():
            heading = HEADING.match(line)
            if heading:
                known.add(f"(theory: {slug(heading[1])})")

    problems, cited = [], 0
    files = [p for folder in FOLDERS for p in sorted((root / folder).rglob("*")) if p.suffix in SUFFIXES]
    for path in [*files, *root.glob("NOTATION.md")]:
        text = path.read_text(encoding="utf-8")
        found = list(tags(text)) + [(m.start(), f"(theory: {m[1]})") for m in THEORY.finditer(text)]
        for position, tag in sorted(found):
            cited += 1
            if tag not in known and tag != EXAMPLE:
                line = text.count("\n", 0, position) + 1
                problems.append(f"{path.relative_to(root)}:{line}: {tag} is not in doc/theory/")
    return problems, cited


def self_test():
    doc = "# Routh form\n\n### [L 2.7] elimination\nand [Q 13], [N 2.10, 3.1] and [L 2.8–2.11] (theory: routh)\n"
    good = "// [L 2.7] [Q 13] [N 3.1] [L 2.10] [L 2.9, 2.11] (theory: routh) (theory: routh-form)\nint a[3];\n"
    bad = ["[L 2.12]", "[Q 1]", "[N 2.10, 3.2]", "[L 2.10–2.13]", "(theory: hamel)", "[NF 2.7]"]
    places = ["src/formulation/forms/multipliers/routh.cpp", "test/laws/forms_test.cpp", "doc/results.md", "NOTATION.md"]
    cases = [("", False, places[0])] + [(good, False, p) for p in places]
    for text, refused, place in cases + [(f"//\n// {tag}\n", True, p) for tag in bad for p in places]:
        with tree({"doc/theory/routh.md": doc, place: text} if text else {}) as root:
            problems, _ = check(root)
        if bool(problems) != refused:
            yield f"{'not refused' if refused else 'refused'}: {place}: {text!r} {problems}"


def judge(root):
    problems, cited = check(root)
    return problems, f"{cited} citations, {len(problems)} without a derivation"


if __name__ == "__main__":
    sys.exit(run(__doc__, judge, self_test))
