#!/usr/bin/env python3
"""Checks that the program and CITATION.cff have the version of CMakeLists.txt.

usage: check_version.py PROGRAM
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]

wanted = re.search(r"project\(.*VERSION\s+([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)
found = {
    "CITATION.cff": re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.M).group(1),
    "anholon --version": subprocess.run([sys.argv[1], "--version"], capture_output=True, text=True, check=True).stdout.split()[-1],
}
wrong = {place: text for place, text in found.items() if text != wanted}
if wrong:
    sys.exit(f"CMakeLists.txt has version {wanted}, but {wrong}")
