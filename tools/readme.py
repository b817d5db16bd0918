#!/usr/bin/env python3
"""Runs the ```console blocks of README.md and of pages of doc/ with the rules of golden.py.

usage: readme.py --program PROGRAM [--bless] [PAGE.md ...]     (default: all of PAGES)

`$ anholon …` (or `$ build/anholon …`) is run, and so are cat, head and tail of its results. Where no output is
shown only success is asked for. `$ ./dev COMMAND` must be a command of ./dev and is not run.
"""

import argparse
import pathlib
import re
import subprocess
import sys

import golden

PAGES = ("README.md", "doc/papers.md", "doc/language.md", "doc/outcomes.md", "doc/contact.md", "doc/json.md")
RUN = {"anholon", "build/anholon", "cat", "head", "tail"}
LEAVE = {"git", "cd", "sudo", "apt-get", "apt"}


def dev_commands():
    text = subprocess.run([golden.ROOT / "dev", "help"], capture_output=True, text=True, check=True).stdout
    return set(re.findall(r"^  ([a-z]+)\b", text, re.MULTILINE))


def step_mode(step, expected):
    words = step.command.split()
    if words[0] in RUN:
        return "exact" if expected else "code only"
    if words[0] == "./dev":
        if len(words) > 1 and words[1] not in dev_commands():
            raise golden.CaseError(f"line {step.number}: './dev {words[1]}' does not exist")
        return "skip"
    if words[0] in LEAVE:
        return "skip"
    raise golden.CaseError(f"line {step.number}: '{words[0]}' is neither anholon nor ./dev, so nothing checks it")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--bless", action="store_true")
    parser.add_argument("pages", nargs="*", type=pathlib.Path)
    args = parser.parse_args()
    pages = [page.resolve() for page in args.pages] or [page for page in (golden.ROOT / name for name in PAGES) if page.exists()]
    return 1 if golden.run_all(pages, args.program, args.bless, step_mode) else 0


if __name__ == "__main__":
    sys.exit(main())
