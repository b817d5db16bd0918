#!/usr/bin/env python3
"""Runs the Python of doc/results.md on results of the program: h5py finds the documented data.

usage: read_with_h5py.py PROGRAM

Exit status 77 (skipped) if h5py or mpmath is not installed, or the program has no HDF5.
"""

import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    try:
        import h5py
    except ImportError:
        print("skipped: python3-h5py is not installed")
        return 77
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "doc" / "results.md").read_text(encoding="utf-8"), re.S)
    five, sweep, digits = blocks
    assert len(five.strip().splitlines()) <= 5, "more than five lines"

    with tempfile.TemporaryDirectory() as scratch:

        def simulate(*words):
            done = subprocess.run([program, "simulate", *words, "--quiet"], cwd=scratch, capture_output=True, text=True)
            if "no HDF5" in done.stderr:
                print("skipped: this build has no HDF5")
                sys.exit(77)
            assert done.returncode == 0, done.stderr

        folder = pathlib.Path(scratch)
        simulate("disc", "--to", "1", "--set", "m=2", "-o", "disc.h5")
        simulate("disc", "--to", "1", "--set", "m=2", "-o", "disc.csv")
        simulate("disc", "--to", "1", "--set", "m=2", "-o", "disc.json")
        names = {}
        exec(five.replace('"disc.h5"', repr(str(folder / "disc.h5"))), names)
        written = list(csv.reader((folder / "disc.csv").open()))
        for j, name in enumerate(written[0]):
            column = [float(row[j]) for row in written[1:]]
            assert list(names["rows"][name]) == column, name

        with h5py.File(folder / "disc.h5") as f:
            assert f.attrs["format"] == "anholon run" and f.attrs["format_version"] == 1
            assert f.attrs["command"] == "anholon simulate disc --to 1 --set m=2 -o disc.h5 --quiet"
            report = json.loads(f["report"].asstr()[()])
            whole = json.loads((folder / "disc.json").read_text())
            assert report == {k: v for k, v in whole.items() if k not in ("columns", "rows")}
            assert report["steps"] == len(f["steps"]) and f["steps"][-1] == 1 and all(f["steps"][1:] > f["steps"][:-1])
            assert f["model/texts"].asstr()[0] == (ROOT / "models" / "zoo" / "disc.toml").read_text(encoding="utf-8")
            assert list(f["settings/set"].asstr()) == ["m=2"] and list(f["settings/case"].asstr()) == []
            assert f["settings/form"].asstr()[0] == "routh"
            documented = (ROOT / "doc" / "results.md").read_text(encoding="utf-8")
            for name in f:
                assert f"`/{name}" in documented, f"/{name} is not documented"

        for name in ("cases.h5", "cases.csv"):
            subprocess.run(
                [program, "sweep", "disc", "--vary", "phi'=5,6,7", "--at", "0.5,1", "--reduce", "min(theta)", "--quiet", "-o", name],
                cwd=scratch,
                check=True,
            )
        names = {}
        exec(sweep.replace('"cases.h5"', repr(str(folder / "cases.h5"))), names)
        written = list(csv.reader((folder / "cases.csv").open()))
        assert len(written) == 7 and set(written[0]) == set(names["cases"])
        for j, name in enumerate(written[0]):
            words = name == "outcome"
            assert [row[j] if words else float(row[j]) for row in written[1:]] == list(names["cases"][name]), name

        simulate("disc", "--at", "0.50,1", "--digits", "30", "-o", "digits.h5")
        try:
            names = {}
            exec(digits.replace('"digits.h5"', repr(str(folder / "digits.h5"))), names)
            with h5py.File(folder / "digits.h5") as f:
                assert float(names["x"][0]) == f["rows"][0, 1] and names["x"][0] != f["rows"][0, 1]
        except ImportError:
            print("mpmath is not installed: digits are not read")
    return 0


if __name__ == "__main__":
    sys.exit(main())
