#!/usr/bin/env python3
"""Lists the files that name one option of motions, most-steps: they are those that one touches to add an option.

usage: option_files.py [PROGRAM] [--root DIR] [--self-test]

With a PROGRAM the option is also looked for where it has to appear without being named in the sources: on the command
line of each command that computes a motion, in the reference of [simulate], in the provenance of a result.
"""

import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

NAME, MOST = "most-steps", 3
KEY = NAME.replace("-", "_")
# The member of the settings, the row, and each use. Other things have that name, too: limits of a stepper, of the library.
NAMED = re.compile(rf'"{NAME}"|\bo_?\.settings\.{KEY}\b|&S::{KEY}\b|optional<int> [\w, ]*\b{KEY}\b')


def naming(root):
    for path in sorted((root / "src").rglob("*")):
        if path.suffix in (".h", ".cpp", ".def") and NAMED.search(path.read_text(encoding="utf-8")):
            yield path.relative_to(root).as_posix()


def missing(program):
    def run(*words):
        return subprocess.run([program, *words], capture_output=True, text=True, check=True).stdout

    for command in ("simulate", "report", "render"):
        if f"--{NAME}" not in run(command, "--help"):
            yield f"anholon {command} --help"
    schema = json.loads(run("reference", "--schema"))
    if KEY not in json.dumps(schema["properties"]["simulate"]):
        yield "anholon reference --schema"
    with tempfile.TemporaryDirectory() as scratch:
        model = pathlib.Path(scratch) / "x.toml"
        model.write_text(f'title = "x"\ncoordinates = ["x"]\n[[body]]\nname = "b"\nmass = 1\ncenter = "x*ex"\n'
                         f"[initial]\nx = 0\n\"x'\" = 1\n[simulate]\nto = 1\n{KEY} = 1\nevery = 1\n")
        done = subprocess.run([program, "simulate", model, "--tolerance", "1e-12"], capture_output=True, text=True)
        if done.returncode == 2:
            yield "[simulate]: " + done.stderr


def self_test():
    failures = 0
    for count in (MOST, MOST + 1):
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            (root / "src/a").mkdir(parents=True)
            for i in range(count):
                (root / f"src/a/f{i}.cpp").write_text(f"int f() {{ return *o.settings.{KEY}; }}\n")
            (root / "src/a/other.h").write_text(f"std::size_t {KEY} = 5;\n")
            if len(list(naming(root))) != count:
                print(f"self-test: {count} files were not counted")
                failures += 1
    return failures


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", nargs="?")
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--self-test", action="store_true")
    asked = parser.parse_args()
    if asked.self_test:
        return 1 if self_test() else 0
    found = list(naming(asked.root))
    print(f"{NAME} is named in {len(found)} files: {', '.join(found)}")
    lacking = list(missing(asked.program)) if asked.program else []
    for place in lacking:
        print(f"it is missing in: {place}")
    return 1 if not found or len(found) > MOST or lacking else 0


if __name__ == "__main__":
    sys.exit(main())
