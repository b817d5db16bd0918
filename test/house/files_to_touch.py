#!/usr/bin/env python3
"""Counts the files that one touches to add an option of motions, a method or an elementary function: those that name one
of each that is there.

usage: files_to_touch.py [PROGRAM] [--root DIR] [--self-test]

With a PROGRAM the option must also appear in places in which no file names it: in the help of each command that computes a
motion, in the schema of [simulate] and its effect, in the provenance of a result.
Result formats have a test of their own, formats_by_table.py; forms have new_form_test.cpp.
"""

import argparse
import dataclasses
import json
import pathlib
import re
import subprocess
import sys
import tempfile

OPTION = "most-steps"
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)


@dataclasses.dataclass
class Kind:
    what: str
    most: int
    named: str  # how a file names the example
    line: str  # a line that names it
    other: str  # a line that does not
    folders: tuple = ("src",)
    not_needed: str = "$^"  # files that name the example although a new one does not need it


KINDS = [
    # The member of the settings, the row, and its meaning for one motion. Limits of steppers have the same name.
    Kind("option of simulate", 3, r'"most-steps"|\*settings\.most_steps\b|\bmost_steps\(settings\)|&S::most_steps\b|optional<int> [\w, ]*\bmost_steps\b',
         "int n = *settings.most_steps;\n", "std::size_t n = settings.most_steps;  // as *settings.most_steps\n",
         # The library has a member for it; any other option is set by its name. Sweeps need not take one.
         not_needed=r"src/api/motion\.cpp|src/ensemble/request\.cpp"),
    # The method's own files are the work itself; `auto` chooses it only after measurements show when it is cheaper.
    Kind("method", 3, r'\bMethod::bdf\b|"bdf"|\bBdf\b|enum class Method [^}]*\bbdf\b', "bool b = m == Method::bdf;\n",
         "int g();  // as Method::bdf\n", not_needed=r"src/integrate/states/bdf\.(h|cpp)|src/motion/method_choice\.cpp"),
    # Names that users of other programs write for it are optional.
    Kind("elementary function", 4, r"(?<![A-Za-z_])(?:\w*_)?atanh\b", "Ball g(Ball x) { return arb_atanh(x); }\n",
         "// The inverse, atanh.\nint arcatanh;\n", ("include", "src", "viewer/src"), r"src/formula/habits\.cpp"),
]


def naming(kind, root):
    for folder in kind.folders:
        for path in sorted((root / folder).rglob("*")):
            name = path.relative_to(root).as_posix()
            if path.suffix not in (".h", ".cpp", ".def", ".ts") or re.fullmatch(kind.not_needed, name):
                continue
            if re.search(kind.named, COMMENT.sub("", path.read_text(encoding="utf-8"))):
                yield name


def check(root):
    for kind in KINDS:
        found = list(naming(kind, root))
        print(f"{kind.what}: {len(found)} files, at most {kind.most}: {', '.join(found)}")
        if not 0 < len(found) <= kind.most:
            yield kind.what


def missing(program):
    def run(*words, **more):
        return subprocess.run([program, *words], capture_output=True, **more)

    for command in ("simulate", "sweep", "report", "render"):
        if f"--{OPTION}" not in run(command, "--help", text=True).stdout:
            yield f"anholon {command} --help"
    key = OPTION.replace("-", "_")
    if key not in json.dumps(json.loads(run("reference", "--schema").stdout)["properties"]["simulate"]):
        yield "anholon reference --schema"
    with tempfile.TemporaryDirectory() as scratch:
        text = (pathlib.Path(__file__).resolve().parents[2] / "models/zoo/disc.toml").read_text(encoding="utf-8")
        text = re.sub(r"\n\[simulate\][^\[]*", "\n", text) + f"\n[simulate]\nto = 100\n{key} = 2\n"
        (pathlib.Path(scratch) / "x.toml").write_text(text, encoding="utf-8")
        for words in (["simulate"], ["sweep", "--vary", "m=1,2"]):
            if run(words[0], "x.toml", *words[1:], "--quiet", cwd=scratch).returncode != 1:
                yield f"{words[0]} with [simulate] {key} = 2 does not end early"
        done = run("simulate", "x.toml", "-o", "x.h5", "--quiet", cwd=scratch)
        if b"no HDF5" not in done.stderr and OPTION.encode() not in (pathlib.Path(scratch) / "x.h5").read_bytes():
            yield "the provenance of x.h5"


def self_test():
    failures = 0
    for kind in KINDS:
        for count in (kind.most, kind.most + 1):
            with tempfile.TemporaryDirectory() as scratch:
                root = pathlib.Path(scratch)
                (root / "src/a").mkdir(parents=True)
                for i in range(count):
                    (root / f"src/a/f{i}.cpp").write_text(kind.line)
                (root / "src/a/other.h").write_text(kind.other)
                if len(list(naming(kind, root))) != count:
                    print(f"{kind.what}: {count} files are not found: {list(naming(kind, root))}")
                    failures += 1
    print(f"{2 * len(KINDS)} trees, {failures} mistakes")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", nargs="?", type=lambda word: pathlib.Path(word).resolve())
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--self-test", action="store_true")
    asked = parser.parse_args()
    if asked.self_test:
        return self_test()
    too_many = list(check(asked.root))
    lacking = list(missing(asked.program)) if asked.program else []
    for place in lacking:
        print(f"--{OPTION} is missing: {place}")
    return 1 if too_many or lacking else 0


if __name__ == "__main__":
    sys.exit(main())
