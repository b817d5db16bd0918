#!/usr/bin/env python3
"""Runs the same transcripts with the programs of two compilers; their output and files must agree bit by bit.

usage: same_bits.py PROGRAM OTHER

Cases: test/golden/good/*.md and test/determinism/*.md (the latter need no expected output), and the equations of every
shipped model. Lines that match a … of the case, such as timings, are not compared. A sweep into a folder needs --chunk,
because the size of its parts follows the measured time of a case otherwise. The exit code is 77 if OTHER is not built.
"""

import difflib
import os
import pathlib
import re
import subprocess
import sys

import golden


def transcript(path, program):
    lines = path.read_text(encoding="utf-8").split("\n")
    files, steps = golden.parse(lines)
    output = []
    with golden.Scratch(program, files) as scratch:
        for step in steps:
            expected = golden.strip_end(lines[step.start : step.end])
            actual = scratch.run(step.command)
            output.append(f"$ {step.command}")
            answer, _ = golden.align(expected, actual)
            for index, line in zip(answer, actual):
                wild = index is not None and golden.WILD in expected[index]
                output.append(expected[index] if wild else line)
        return output, scratch.outputs()


def sweeps_of_measured_parts(path):
    """Returns the commands of a case that make the folder of a sweep and leave the size of its parts to a measured time."""
    _, steps = golden.parse(path.read_text(encoding="utf-8").split("\n"))
    return [step.command for step in steps if re.search(r"\bsweep .*-o \S+/(\s|$)", step.command) and "--chunk" not in step.command]


def is_certificate(text):
    """True for a certificate. Its nodes are numbered in the order in which a compiler evaluates operands, which may differ."""
    text = text.decode("utf-8", "replace") if isinstance(text, bytes) else text or ""
    return '"anholon-certificate"' in text[:200]


def equations(model, program):
    return subprocess.run([program, "derive", str(model), "--quiet"], capture_output=True, text=True, check=False).stdout.split("\n")


def models_that_differ(program, other):
    """Returns the shipped models whose equations the two programs write differently, and prints the differences."""
    models = sorted((golden.ROOT / "models").rglob("*.toml"))
    found = []
    for model in models:
        one, two = equations(model, program), equations(model, other)
        if one != two:
            found.append(model)
            print("\n".join(difflib.unified_diff(one, two, f"{program} {model.name}", f"{other} {model.name}", lineterm="", n=0)))
    print(f"equations of {len(models)} models, {len(found)} differ")
    return found


def main(program, other):
    if not pathlib.Path(other).exists():
        print(f"{other} is not built; ./dev test builds it")
        return 77
    cases = sorted((golden.ROOT / "test").glob("golden/good/*.md"))
    cases += sorted((golden.ROOT / "test").glob("determinism/*.md"))
    failed = 0
    for path in cases:
        shown = os.path.relpath(path, golden.ROOT)
        if unsized := sweeps_of_measured_parts(path):
            failed += 1
            print("\n".join([f"{shown}: give --chunk to", *unsized]))
            continue
        (text, files), (text2, files2) = transcript(path, program), transcript(path, other)
        differences = list(difflib.unified_diff(text, text2, program, other, lineterm="", n=1))
        differences += [
            f"file {name} differs" for name in sorted(files.keys() | files2.keys()) if files.get(name) != files2.get(name) and not is_certificate(files.get(name))
        ]
        if differences:
            failed += 1
            print("\n".join([f"{shown}:", *differences]))
    print(f"{len(cases)} cases, {failed} differ")
    return 1 if models_that_differ(program, other) or failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
