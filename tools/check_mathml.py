#!/usr/bin/env python3
"""Checks that `derive --format mathml` writes well-formed presentation MathML for every shipped model, and for some of them all
forms with their steps and reactions.

usage: check_mathml.py --program PROGRAM
"""

import argparse
import pathlib
import subprocess
import sys
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent
SPACE = "{http://www.w3.org/1998/Math/MathML}"
WITH_EVERYTHING = ["zoo/chaplygin-sleigh", "zoo/second-order-linear", "zoo/variable-mass-pendulum", "papers/luo-zhao-example-2"]
# The number of children of each element; None for any number.
CHILDREN = {
    "math": 1, "mtable": None, "mtr": None, "mtd": None, "mrow": None, "msqrt": None, "mfrac": 2, "msup": 2, "msub": 2,
    "mover": 2, "mi": 0, "mn": 0, "mo": 0, "mtext": 0, "mspace": 0,
}  # fmt: skip


def problems(text):
    """Returns the errors of a MathML text as sentences."""
    try:
        root = xml.etree.ElementTree.fromstring(text)
    except xml.etree.ElementTree.ParseError as error:
        return [f"not well-formed: {error}"]
    found = []
    for table in root.iter(SPACE + "mtable"):
        columns = 3 if table in list(root) else 2  # a table of equations has 3 columns, one of the branches of a choice 2
        found += [f"a row of {len(row)} cells among {columns} columns" for row in table if len(row) != columns]
    for element in root.iter():
        name = element.tag.removeprefix(SPACE)
        if name not in CHILDREN or not element.tag.startswith(SPACE):
            found.append(f"<{element.tag}> is not expected")
        elif CHILDREN[name] is not None and len(element) != CHILDREN[name]:
            found.append(f"<{name}> has {len(element)} children")
        elif CHILDREN[name] == 0 and name != "mspace" and not element.text:
            found.append(f"<{name}> is empty")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    program = parser.parse_args().program
    if not problems("<math xmlns='http://www.w3.org/1998/Math/MathML'><mfrac><mn>1</mn></mfrac></math>"):
        print("the check accepts a fraction without denominator")
        return 1
    failed = 0
    # `derive` refuses models with contacts.
    models = [m for m in sorted((ROOT / "models").glob("*/*.toml")) if m.parent.name != "contacts"]
    cases = [(model, []) for model in models]
    cases += [(ROOT / "models" / f"{name}.toml", ["--form", "all", "--steps", "--reactions"]) for name in WITH_EVERYTHING]
    for model, options in cases:
        done = subprocess.run([program, "derive", model, "--format", "mathml", "--quiet", *options], stdout=subprocess.PIPE, timeout=120, check=False)
        formulas = [text + b"</math>" for text in done.stdout.split(b"</math>\n") if text]
        found = [problem for formula in formulas for problem in problems(formula)]
        found += [f"exit code {done.returncode}"] if done.returncode else [] if formulas else ["no formulas"]
        for problem in dict.fromkeys(found):
            print(f"{' '.join([str(model.relative_to(ROOT)), *options])}: {problem}")
        failed += bool(found)
    print(f"{len(cases)} cases, {failed} failed")
    return 1 if failed or not models else 0


if __name__ == "__main__":
    sys.exit(main())
