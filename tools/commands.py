#!/usr/bin/env python3
"""The options of all commands in doc/commands.md, below a line that this script looks for, are what `--help` prints.

usage: commands.py --program PROGRAM [--write] [--self-test]

Exit status 1 if the page differs. A command or an option that the program has and the page has not is therefore an error.
"""

import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "doc" / "commands.md"
MARK = "<!-- What follows is made by tools/commands.py --write. -->\n"


def help_of(program, *words):
    return subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True).stdout


def commands(text):
    """Returns the names of the commands that a help text lists."""
    found = re.search(r"^Subcommands:\n((?:  .*\n)+)", text, re.M)
    return re.findall(r"^  ([a-z]\w*)", found[1], re.M) if found else []


def sections(program):
    parts = []

    def add(words):
        text = help_of(program, *words)
        title = " ".join(words)
        parts.append(f"{'#' * (1 + len(words))}# `anholon {title}`\n\n```text\n{text.rstrip()}\n```\n")
        for name in commands(text):
            add([*words, name])

    for name in commands(help_of(program)):
        add([name])
    return "\n".join(parts)


def page(program, text):
    head, mark, _ = text.partition(MARK)
    if not mark:
        raise SystemExit(f"{PAGE}: the line {MARK.strip()!r} is missing")
    return head + mark + "\n" + sections(program)


def self_test(program):
    text = PAGE.read_text(encoding="utf-8")
    made = page(program, text)
    failures = 0
    for wrong in (made.replace("\n  --rigorous", "\n  --rigourous", 1), made.replace("#### `anholon sweep status`", "#### `anholon sweep state`"), made + "more\n"):
        failures += wrong == made or page(program, wrong) == wrong
    failures += commands("Subcommands:\n  a   x\n  b\n\nExamples:\n  c\n") != ["a", "b"]
    print(f"{failures} mistakes")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    args = parser.parse_args()
    program = args.program.resolve()
    if args.self_test:
        return self_test(program)
    text = PAGE.read_text(encoding="utf-8")
    made = page(program, text)
    if args.write:
        PAGE.write_text(made, encoding="utf-8")
    elif made != text:
        print("doc/commands.md is not what the program's --help says: tools/commands.py --write")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
