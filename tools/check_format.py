#!/usr/bin/env python3
"""Checks that the C++ sources have the layout of .clang-format, by clang-format 19 (./dev fmt sets it).

usage: check_format.py [FILE...]     (default: all of src, include, test, bench and fuzz)
"""

import pathlib
import shutil
import subprocess
import sys


def main():
    program = shutil.which("clang-format-19")
    if program is None:
        print("clang-format-19 is not installed")
        return 77  # skipped
    root = pathlib.Path(__file__).resolve().parent.parent
    folders = ("src", "include", "test", "bench", "fuzz")
    files = [pathlib.Path(f) for f in sys.argv[1:]] or sorted(
        f for folder in folders for f in (root / folder).rglob("*") if f.suffix in (".h", ".cpp")
    )
    done = subprocess.run([program, "--dry-run", "-Werror", *map(str, files)], cwd=root, capture_output=True, text=True)
    print(done.stderr[:4000], end="")
    print(f"{len(files)} files")
    return 1 if done.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
