#!/usr/bin/env python3
"""Installs a build into an empty folder, builds test/outside and the examples of doc/library.md against it, and runs them.

usage: check_outside.py BUILD_FOLDER [--compiler CXX]
"""

import argparse
import os
import pathlib
import re
import subprocess
import sys
import tempfile


# A program of doc/library.md and its output
EXAMPLE = re.compile(r"```cpp\n(.*?)```\n\n```text\n(.*?)```", re.S)


def run(*command, env=None):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, env=env)
    if done.returncode != 0:
        sys.exit(f"{' '.join(str(c) for c in command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--compiler", default="g++")
    options = parser.parse_args()
    project = pathlib.Path(__file__).resolve().parent.parent / "test" / "outside"
    with tempfile.TemporaryDirectory() as scratch:
        prefix, build = pathlib.Path(scratch) / "prefix", pathlib.Path(scratch) / "build"
        run("cmake", "--install", options.build, "--prefix", prefix)
        run("cmake", "-S", project, "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCMAKE_CXX_COMPILER={options.compiler}",
            "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")  # fmt: skip
        run("cmake", "--build", build)
        for k, (program, printed) in enumerate(EXAMPLE.findall((project.parent.parent / "doc" / "library.md").read_text(encoding="utf-8"))):
            source, example = pathlib.Path(scratch) / f"example{k}.cpp", pathlib.Path(scratch) / f"example{k}"
            source.write_text(program, encoding="utf-8")
            library = next(prefix.glob("lib/**/libanholon.so"))
            run(options.compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror", f"-I{prefix / 'include'}", source, library,
                f"-Wl,-rpath,{library.parent}", "-o", example)  # fmt: skip
            found = run(example, env=os.environ | {"ANHOLON_CACHE": ""})
            if found != printed:
                sys.exit(f"doc/library.md, program {k + 1} prints\n{found}")
        environment = {k: v for k, v in os.environ.items() if k != "ANHOLON_CACHE"} | {"ANHOLON_CACHE": ""}
        print(run(build / "outside", env=environment), end="")
        print(run(prefix / "bin" / "anholon", "models", env=environment).splitlines()[0])


if __name__ == "__main__":
    main()
