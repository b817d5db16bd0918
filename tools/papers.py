#!/usr/bin/env python3
"""Checks what is written of the papers against their tables (papers/*.toml).

usage: papers.py --program PROGRAM [--write]
       papers.py --program PROGRAM --self-test

* doc/papers.md holds what `anholon papers --markdown` prints, between its two marks; --write puts it there.
* Each page of doc/theory that a table names is there, with the section; each form is one that `anholon forms` lists; each paper is in refs.bib.
* The tables have all numbered equations of the three papers: 48, 13 and 44.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "doc" / "papers.md"
MARKS = "<!-- the tables of papers/, by tools/papers.py -->", "<!-- end of the tables -->"
NUMBERED = {"L": 48, "Q": 13, "N": 44}


def told(program, *words):
    return subprocess.run([program, *words], capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL).stdout


def anchors(text):
    """Returns the anchors of a page's headings as GitHub makes them."""
    headings = re.findall(r"^#+ +(.*?) *#*$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", h.replace("`", "").lower()).strip().replace(" ", "-") for h in headings}


def with_tables(page, tables):
    begin, end = page.index(MARKS[0]) + len(MARKS[0]), page.index(MARKS[1])
    return page[:begin] + "\n\n" + tables.rstrip("\n") + "\n\n" + page[end:]


def problems(claims, forms, page, tables):
    found = []
    if with_tables(page, tables) != page:
        found.append("doc/papers.md does not hold the tables as they are: tools/papers.py --program build/anholon --write")
    pages = {}
    for c in claims:
        name = f"{c['paper']}{c['tag']}"
        file, _, section = c["theory"].partition("#")
        if file:
            path = ROOT / "doc" / "theory" / file
            if file not in pages:
                pages[file] = anchors(path.read_text(encoding="utf-8")) if path.is_file() else None
            if pages[file] is None:
                found.append(f"{name}: there is no page doc/theory/{file}")
            elif section and section not in pages[file]:
                found.append(f"{name}: doc/theory/{file} has no section #{section}")
        for form in re.split(r",\s*", c["form"]) if c["form"] else []:
            if form not in forms:
                found.append(f"{name}: there is no form {form}")
    for key, number in NUMBERED.items():
        have = len({c["tag"] for c in claims if c["paper"] == key and c["numbered"]})
        if have != number:
            found.append(f"[{key}] has {number} numbered equations, the table {have}")
    return found


def references(folder, bibliography):
    keys = set(re.findall(r"^@\w+\{([^,]+),", bibliography, re.M))
    used = {m for f in sorted(folder.glob("*.toml")) for m in re.findall(r'^reference *= *"([^"]+)"', f.read_text(encoding="utf-8"), re.M)}
    return [f"refs.bib has no entry '{k}'" for k in sorted(used - keys)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    claims = json.loads(told(options.program, "papers", "--json"))["claims"]
    forms = {f["name"] for f in json.loads(told(options.program, "forms", "--json"))}
    page, tables = PAGE.read_text(encoding="utf-8"), told(options.program, "papers", "--markdown")
    if options.write:
        PAGE.write_text(with_tables(page, tables), encoding="utf-8")
        page = with_tables(page, tables)
    if options.self_test:
        wrong = [dict(c) for c in claims]
        wrong[0]["theory"], wrong[1]["theory"], wrong[2]["form"] = "none.md", "routh.md#none", "none"
        del wrong[max(i for i, c in enumerate(wrong) if c["numbered"])]
        missed = 5 - len(set(problems(wrong, forms, page, tables + "more\n")) - set(problems(claims, forms, page, tables)))
        missed += not references(ROOT / "papers", "@article{other,\n")
        print(f"{missed} mistakes were not found")
        return 1 if missed > 0 else 0
    found = problems(claims, forms, page, tables) + references(ROOT / "papers", (ROOT / "refs.bib").read_text(encoding="utf-8"))
    print("\n".join(found) if found else f"{len(claims)} claims, ok")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
