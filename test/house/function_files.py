#!/usr/bin/env python3
"""Lists the files that name one elementary function, artanh: they are those that one touches to add a function.

usage: function_files.py [--root DIR] [--self-test]

Counted are the sources of the program and of the viewer. A file may name the function in a comment, or in a list of
spellings that other languages have: those are not what a new function needs.
"""

import argparse
import pathlib
import re
import sys
import tempfile

FUNCTION, MOST = "atanh", 4
NAMED = re.compile(r"(?<![A-Za-z_])(?:\w*_)?" + FUNCTION + r"\b")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
SPELLINGS = "src/formula/habits.cpp"  # what users of other programs write


def naming(root):
    for folder in ("include", "src", "viewer/src"):
        for path in sorted((root / folder).rglob("*")):
            name = path.relative_to(root).as_posix()
            if path.suffix not in (".h", ".cpp", ".def", ".ts") or name == SPELLINGS:
                continue
            if NAMED.search(COMMENT.sub("", path.read_text(encoding="utf-8"))):
                yield name


def self_test():
    failures = 0
    for count in (MOST, MOST + 1):
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            (root / "src/a").mkdir(parents=True)
            for i in range(count):
                (root / f"src/a/f{i}.cpp").write_text(f"Ball g(Ball x) {{ return arb_{FUNCTION}(x); }}\n")
            (root / "src/a/comment.h").write_text(f"// The inverse, {FUNCTION}.\nint arc{FUNCTION};\n")
            if len(list(naming(root))) != count:
                print(f"{count} files are not found: {list(naming(root))}")
                failures += 1
    print(f"2 trees, {failures} mistakes")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent.parent)
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        return self_test()
    files = list(naming(options.root))
    for name in files:
        print(name)
    print(f"{len(files)} files name {FUNCTION}; at most {MOST} may")
    return 1 if len(files) > MOST else 0


if __name__ == "__main__":
    sys.exit(main())
