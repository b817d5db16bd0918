#!/usr/bin/env python3
"""Checks that a format of results is its own files and one row of the table in src/result/formats.cpp.

usage: formats_by_table.py [--root DIR] [--self-test]

The own files of NAME_format are src/result/NAME*. No other file of src/ may include their headers, use the row, or hold
an ending of the format as a text, since each such place would have to change for another format.
"""

import argparse
import pathlib
import re
import sys
import tempfile

TABLE = "src/result/formats.cpp"
# A mark of a format that another file needs, with the reason.
ALLOWED = {
    ("src/cli/equations/derive.cpp", '".json"'),  # of files that hold equations
    ("src/api/motion.cpp", '#include "result/json_run.h"'),  # Run::json() promises JSON
    # The parts of a sweep in a folder are Parquet files.
    ("src/ensemble/store/sweep_store.h", '#include "result/parquet/parquet.h"'),
    ("src/ensemble/store/sweep_store.cpp", '".parquet"'),
    ("src/ensemble/parts/fill.cpp", '#include "result/parquet/parquet_sweep.h"'),
    ("src/cli/motions/sweep_folder.cpp", '#include "result/parquet/parquet_sweep.h"'),
    # Tables of cases are no results and may be Parquet files of other programs.
    ("src/result/parquet/table_text.cpp", '#include "result/parquet/parquet.h"'),
}


def formats(root):
    return re.findall(r"&(\w+)_format\b", (root / TABLE).read_text(encoding="utf-8"))


def endings(own):
    for path in own:
        if found := re.search(r"\.endings = \{([^}]*)\}", path.read_text(encoding="utf-8")):
            return re.findall(r'"[^"]*"', found[1])
    return []


def check(root):
    sources = [p for p in sorted((root / "src").rglob("*")) if p.suffix in (".h", ".cpp", ".def")]
    for name in formats(root):
        rooms = (root / "src/result", root / "src/result" / name)
        own = [p for p in sources if p.parent in rooms and re.match(name + r"(_\w+)?\.", p.name)]
        headers = [f'#include "{p.relative_to(root / "src").as_posix()}"' for p in own if p.suffix in (".h", ".def")]
        if not endings(own):
            yield f"{name}_format: no file of src/result defines its endings"
        for path in sources:
            where = path.relative_to(root).as_posix()
            if path in own or where == TABLE:
                continue
            code = re.sub(r"//[^\n]*", "", path.read_text(encoding="utf-8"))
            marks = [*headers, f"{name}_format", *endings(own)]
            if held := [m for m in marks if m in code and (where, m) not in ALLOWED]:
                yield f"{where}: knows the format {name} by {', '.join(held)}: ask the row of the table"


GOOD = {
    TABLE: "extern const ResultFormat csv_format, hdf5_format;\n{&hdf5_format, &csv_format};\n",
    "src/result/csv.h": "class CsvRunWriter;\n",
    "src/result/csv.cpp": '#include "result/csv.h"\nconst ResultFormat csv_format = {.endings = {".csv"}};\n',
    "src/result/hdf5/hdf5_sink.h": "class Hdf5Sink;\n",
    "src/result/hdf5/hdf5_format.cpp": '#include "result/hdf5/hdf5_sink.h"\nconst ResultFormat hdf5_format = {.endings = {".h5", ".hdf5"}};\n',
    "src/cli/convert.cpp": '#include "result/format.h"\n// ".csv"\nconst char* kExample = "-o run.csv";\n',
}
MUTANTS = {
    "an ending": ("src/cli/simulate.cpp", 'bool b = path.ends_with(".hdf5");\n'),
    "a header": ("src/api/motion.cpp", '#include "result/csv.h"\n'),
    "a row": ("src/cli/sweep.cpp", "if (&format == &hdf5_format) return;\n"),
    "a row without a file": (TABLE, "{&hdf5_format, &csv_format, &sqlite_format};\n"),
}


def write(root, files):
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")


def self_test():
    failures = 0
    for title, more in [("", None), *MUTANTS.items()]:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            write(root, GOOD | ({more[0]: more[1]} if more else {}))
            problems = list(check(root))
            if bool(problems) != bool(more):
                print(f"mutant not refused: {title}" if more else f"a good tree was refused: {problems}")
                failures += 1
    print(f"{len(MUTANTS)} mutants, {failures} mistakes")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent.parent)
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        return self_test()
    problems = list(check(options.root))
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
