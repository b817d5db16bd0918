"""The common parts of the checks of this folder: their command line, and small trees of files for their self-tests."""

import argparse
import contextlib
import pathlib
import tempfile


def run(doc, judge, self_test):
    """Runs a check on a tree, or its self-test, from the command line; returns the exit status.

    doc        the docstring of the module, whose first line is the help
    judge      a function of the root that returns the problems, as lines, and a summary
    self_test  a function that yields a line for each case in which the check is mistaken
    """
    parser = argparse.ArgumentParser(description=doc.splitlines()[0])
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--self-test", action="store_true")
    args = parser.parse_args()
    if args.self_test:
        problems = list(self_test())
        summary = f"{len(problems)} mistakes"
    else:
        problems, summary = judge(args.root)
    for problem in problems:
        print(problem)
    print(summary)
    return 1 if problems else 0


@contextlib.contextmanager
def tree(files):
    """Makes a temporary folder with files {name: text}; it is removed after use."""
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch) / "root"
        root.mkdir()
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        yield root
