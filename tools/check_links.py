#!/usr/bin/env python3
"""Checks that every relative link of the Markdown files leads to a file, a folder or a heading that exists.

usage: check_links.py [--root DIR] [--self-test]

Checked are [text](target), ![text](target) and [name]: target, outside of code and formulas. A target with a
scheme (https:) is not looked at. An anchor (#heading) is spelt as GitHub spells it.
"""

import re
import sys
import urllib.parse

from checking import run, tree

SKIPPED = {"node_modules", "shared"}  # folders whose names begin with "." or "build" are skipped, too

FENCE = re.compile(r"^ {0,3}(```+|~~~+)")
CODE = re.compile(r"(`+)(?!`).*?(?<!`)\1(?!`)")
FORMULA = re.compile(r"\$[^$\n]+\$")
LINK = re.compile(r"\]\(\s*<?([^()\s<>]*(?:\([^()\s]*\)[^()\s<>]*)*)>?(?:\s+\"[^\"]*\")?\s*\)")
DEFINITION = re.compile(r"^ {0,3}\[[^\]^]+\]:\s*<?([^\s<>]+)>?")
HEADING = re.compile(r"^ {0,3}#{1,6}\s+(.*?)\s*#*\s*$")
NAMED = re.compile(r"<a\s+(?:name|id)=\"([^\"]+)\"")
SCHEME = re.compile(r"^(?:[a-zA-Z][a-zA-Z0-9+.-]*:|//)")


def lines_of_text(text):
    """Yields (line number, line) of all lines outside of fenced code."""
    fence = None
    for number, line in enumerate(text.splitlines(), 1):
        mark = FENCE.match(line)
        if fence is None and mark:
            fence = mark[1]
        elif fence is not None:
            if mark and mark[1].startswith(fence) and not line.strip().strip(fence[0]):
                fence = None
        else:
            yield number, line


def slug(heading):
    """Returns the anchor that GitHub gives a heading."""
    heading = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


def anchors(text):
    found = set()
    for _, line in lines_of_text(text):
        found.update(NAMED.findall(line))
        heading = HEADING.match(line)
        if heading:
            name, n = slug(heading[1]), 0
            while (name if n == 0 else f"{name}-{n}") in found:
                n += 1
            found.add(name if n == 0 else f"{name}-{n}")
    return found


def targets(text):
    for number, line in lines_of_text(text):
        line = FORMULA.sub("", CODE.sub("", line))
        definition = DEFINITION.match(line)
        if definition:
            yield number, definition[1]
        for link in LINK.finditer(line):
            yield number, link[1]


def pages(root):
    for path in sorted(root.rglob("*.md")):
        folders = path.relative_to(root).parts[:-1]
        if not any(part in SKIPPED or part.startswith((".", "build")) for part in folders):
            yield path


def check(root):
    problems, links = [], 0
    headings = {}
    for page in pages(root):
        for number, target in targets(page.read_text(encoding="utf-8")):
            if SCHEME.match(target):
                continue
            links += 1
            where = f"{page.relative_to(root)}:{number}"
            file, _, anchor = target.partition("#")
            path = page if not file else page.parent / urllib.parse.unquote(file)
            if not path.exists():
                problems.append(f"{where}: there is no {file}")
            elif not path.resolve().is_relative_to(root.resolve()):
                problems.append(f"{where}: {file} lies outside of the repository")
            elif anchor and path.suffix == ".md":
                if path not in headings:
                    headings[path] = anchors(path.read_text(encoding="utf-8"))
                if urllib.parse.unquote(anchor) not in headings[path]:
                    problems.append(f"{where}: {file or page.name} has no heading #{anchor}")
            elif anchor:
                problems.append(f"{where}: {file} is no page with headings, but #{anchor} is asked for")
    return problems, links


PAGE = """# Digits to trust, `evaluate`

## Twice
## Twice

```
[no link](in/code.md)
```
`[nor](here.md)` and $f[x](y.z)$
"""
GOOD = [
    "[a](page.md) ![b](../a.svg) [c](page.md#digits-to-trust-evaluate) [d](#here) [e](https://x.y/z#q)\n# Here\n",
    "[a](page.md#twice-1 \"title\") [b](<page.md>) [folder](..)\n\n[ref]: page.md#twice\n",
    "[a](with%20space.md)\n",
]
BAD = ["[a](pages.md)\n", "[a](page.md#twice-2)\n", "[a](#there)\n# Here\n", "[ref]: no.md\n", "[a](../a.svg#x)\n", "[a](../../..)\n"]


def self_test():
    around = {"build/bad.md": "[a](nowhere.md)\n", "a.svg": "", "doc/page.md": PAGE, "doc/with space.md": ""}
    for text, refused in [(t, False) for t in GOOD] + [(t, True) for t in BAD]:
        with tree(around | {"doc/test.md": text}) as root:
            problems, _ = check(root)
        if len(problems) != refused:
            yield f"{'not refused' if refused else 'refused'}: {text!r} {problems}"


def judge(root):
    problems, count = check(root)
    return problems, f"{count} links, {len(problems)} broken"


if __name__ == "__main__":
    sys.exit(run(__doc__, judge, self_test))
