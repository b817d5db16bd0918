#!/usr/bin/env python3
"""Lists the files that name one method of integration, BDF, beside its own: they are those that one touches to add one.

usage: method_files.py [--root DIR] [--self-test]

Not counted are the files of the method itself, and the choice that `--method auto` makes between methods: a new method is
asked for by its name until somebody measures when it pays.
"""

import argparse
import pathlib
import re
import sys
import tempfile

METHOD, MOST = "bdf", 3
NAMED = re.compile(rf'\bMethod::{METHOD}\b|"{METHOD}"|\bBdf\b|enum class Method [^}}]*\b{METHOD}\b')
COMMENT = re.compile(r"//[^\n]*")
OWN = re.compile(rf"src/integrate/states/{METHOD}\.(h|cpp)$")
CHOICE = "src/motion/method_choice.cpp"


def naming(root):
    for path in sorted((root / "src").rglob("*")):
        name = path.relative_to(root).as_posix()
        if path.suffix not in (".h", ".cpp", ".def") or OWN.search(name) or name == CHOICE:
            continue
        if NAMED.search(COMMENT.sub("", path.read_text(encoding="utf-8"))):
            yield name


def self_test():
    failures = 0
    for count in (MOST, MOST + 1):
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            (root / "src/motion").mkdir(parents=True)
            for i in range(count):
                (root / f"src/motion/f{i}.cpp").write_text(f"bool f(Method m) {{ return m == Method::{METHOD}; }}\n")
            (root / "src/motion/comment.h").write_text(f"int g();  // as Method::{METHOD}\n")
            if len(list(naming(root))) != count:
                print(f"self-test: {count} files were not counted")
                failures += 1
    return failures


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--self-test", action="store_true")
    asked = parser.parse_args()
    if asked.self_test:
        return 1 if self_test() else 0
    found = list(naming(asked.root))
    print(f"{METHOD} is named in {len(found)} files: {', '.join(found)}")
    return 1 if not found or len(found) > MOST else 0


if __name__ == "__main__":
    sys.exit(main())
