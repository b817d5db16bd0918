"""What the checks of this folder share: their command line, and the small trees of files on which they are tried."""

import argparse
import contextlib
import pathlib
import tempfile


def run(doc, judge, self_test):
    """Judges a tree from the command line, or tries the check itself; returns the exit status.

    doc        the text of the module, whose first line is the help
    judge      root -> the problems, line by line, and a last line that sums up
    self_test  () -> a line for each case in which the check is mistaken
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
    """A folder, for as long as it is used, with these files: {name: text}."""
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch) / "root"
        root.mkdir()
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")
        yield root
