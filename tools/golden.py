#!/usr/bin/env python3
"""Runs transcripts: Markdown files that hold a model, commands and their exact output.

usage: golden.py --program PROGRAM [--bless] [CASE.md ...]     (default: all of test/golden)

A fenced block whose info has two words, as in ```toml disc.toml, is written to that file in a
scratch folder. In ```console blocks a line `$ command` is run there by bash (a command that ends
in \\ goes on in the next line), and what follows it is its exact output, stdout and stderr merged,
trailing blank lines aside; a last line `[exit 2]` is the exit code where it is not 0. `models` in the
scratch folder is the folder of shipped models, `anholon` the program under test.

In an expected line … stands for any text; a line that is only … stands for any number of lines. Lines that show
the progress of a long run are left out.

A picture `![…](figures/NAME.svg)` of the page is the file NAME.svg that one of its commands writes, byte by byte.
"""

import argparse
import difflib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
WILD = "…"
TIMEOUT = 600
EXIT = re.compile(r"\[exit \d+\]|\[still running after \d+ s\]")
FENCE = re.compile(r"^(`{3,})\s*(.*?)\s*$")
PROGRESS = re.compile(r"^\[#*\.*\] +\d+ %  .*$")  # progress of long runs; the machine decides whether a run is long
FIGURE = re.compile(r"!\[[^\]]*\]\(([^()\s]*figures/([\w.-]+))\)")


class CaseError(Exception):
    pass


class Step:
    """One command of a console block: lines[start:end] of the file hold its expected output."""

    def __init__(self, number, command, start):
        self.number, self.command, self.start, self.end = number, command, start, start


def parse(lines):
    """Returns the files to write, [(name, text)], and the steps, [Step]."""
    files, steps = [], []
    at = 0
    while at < len(lines):
        fence = FENCE.match(lines[at])
        at += 1
        if not fence:
            continue
        begin = at
        while at < len(lines) and lines[at].rstrip() != fence[1]:
            at += 1
        if at == len(lines):
            raise CaseError(f"line {begin}: the block is never closed")
        info = fence[2].split()
        if info == ["console"]:
            steps += parse_console(lines, begin, at)
        elif len(info) == 2:
            name = pathlib.PurePosixPath(info[1])
            if name.is_absolute() or ".." in name.parts or name.parts[0] in ("models", "build", "bin"):
                raise CaseError(f"line {begin}: '{name}' cannot be a file name in the scratch folder")
            files.append((str(name), "".join(line + "\n" for line in lines[begin:at])))
        at += 1
    return files, steps


def parse_console(lines, begin, end):
    steps = []
    at = begin
    while at < end:
        if lines[at].startswith("$ "):
            number, command = at + 1, lines[at][2:]
            while command.endswith("\\") and at + 1 < end:
                at += 1
                command = command[:-1] + lines[at].removeprefix("> ")
            at += 1
            steps.append(Step(number, command.strip(), at))
        elif not steps:
            raise CaseError(f"line {at + 1}: a console block begins with a line `$ command`")
        else:
            at += 1
        steps[-1].end = at
    return steps


def strip_end(lines):
    lines = list(lines)
    while lines and not lines[-1].strip():
        lines.pop()
    return lines


class Scratch:
    """A folder in which the commands of one case run, one after the other."""

    def __init__(self, program, files):
        self.temporary = tempfile.TemporaryDirectory(prefix="anholon-")
        self.folder = pathlib.Path(self.temporary.name).resolve()
        work = self.work = self.folder / "work"
        for name in ("bin", "home", "work/build"):
            (self.folder / name).mkdir(parents=True)
        program = pathlib.Path(program).resolve()
        (self.folder / "bin" / "anholon").symlink_to(program)
        (work / "build" / "anholon").symlink_to(program)
        if (ROOT / "models").is_dir():
            (work / "models").symlink_to(ROOT / "models")
        for name, text in files:
            (work / name).parent.mkdir(parents=True, exist_ok=True)
            (work / name).write_text(text, encoding="utf-8")
        keep = {k: v for k, v in os.environ.items() if not k.startswith(("LC_", "LANG", "XDG_"))}
        self.environment = keep | {
            "PATH": f"{self.folder / 'bin'}:{os.environ.get('PATH', '/usr/bin:/bin')}",
            "HOME": str(self.folder / "home"), "TMPDIR": str(self.folder / "home"),
            "LC_ALL": "C.UTF-8", "TERM": "dumb", "NO_COLOR": "1", "COLUMNS": "100",
            "ANHOLON_MODELS": "models", "ANHOLON_CACHE": "",
        }  # fmt: skip

    def run(self, command):
        """Runs a command. Returns the lines of its output, with a last line [exit N] if it failed."""
        try:
            done = subprocess.run(
                ["bash", "-o", "pipefail", "-c", command], cwd=self.work, env=self.environment,
                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=TIMEOUT,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return [f"[still running after {TIMEOUT} s]"]
        text = done.stdout.decode("utf-8", errors="backslashreplace")
        text = text.replace(str(self.work), "<scratch>").replace(str(ROOT), "<root>")
        # splitlines() would also split at form feeds and similar characters.
        lines = strip_end([line for line in text.split("\n") if not PROGRESS.match(line)])
        if done.returncode != 0:
            lines.append(f"[exit {done.returncode}]")
        return lines

    def outputs(self):
        """Returns the files that the commands wrote, by name."""
        found = {}
        for path in sorted(self.work.rglob("*")):
            if path.is_file() and not path.is_symlink():
                found[str(path.relative_to(self.work))] = path.read_bytes()
        return found

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()


def line_matches(pattern, line):
    if WILD not in pattern:
        return pattern == line
    return re.fullmatch(".*".join(re.escape(part) for part in pattern.split(WILD)), line) is not None


def align(expected, actual):
    """Returns for each actual line the index of the expected line that matches it, or None; and True if all lines match.

    The match is the longest common subsequence, in which an expected line … matches any number of lines, also none.
    """
    rows, columns = len(expected), len(actual)
    # Equal first lines are matched before, since the table has quadratic size and transcripts mostly agree.
    low = 0
    while low < min(rows, columns) and expected[low].strip() != WILD and line_matches(expected[low], actual[low]):
        low += 1
    best = [[0] * (columns + 1) for _ in range(rows + 1)]
    for i in range(rows - 1, low - 1, -1):
        many = expected[i].strip() == WILD
        for j in range(columns - 1, low - 1, -1):
            value = max(best[i + 1][j], best[i][j + 1])
            if many:
                # A match by … counts less than one by a written line, so that a … never takes a line that a written line matches.
                value = max(value, 1 + best[i][j + 1])
            elif line_matches(expected[i], actual[j]):
                value = max(value, 1000 + best[i + 1][j + 1])
            best[i][j] = value
    answer = list(range(low)) + [None] * (columns - low)
    i = j = low
    while i < rows and j < columns:
        if expected[i].strip() == WILD and best[i][j] == 1 + best[i][j + 1]:
            answer[j] = i
            j += 1
        elif expected[i].strip() != WILD and line_matches(expected[i], actual[j]) and best[i][j] == 1000 + best[i + 1][j + 1]:
            answer[j] = i
            i, j = i + 1, j + 1
        elif best[i][j] == best[i + 1][j]:
            i += 1
        else:
            j += 1
    needed = {k for k, line in enumerate(expected) if line.strip() != WILD}
    complete = None not in answer and needed <= set(answer)
    return answer, complete


def merge(expected, actual):
    """Returns True if the lines match, and the new expected lines: the actual ones with the wildcards that still match."""
    # Exit codes are compared separately, so that no … matches one.
    expected, expected_exit = split_exit(expected)
    actual, actual_exit = split_exit(actual)
    same, merged = merge_lines(expected, actual)
    return same and expected_exit == actual_exit, merged + actual_exit


def split_exit(lines):
    if lines and EXIT.fullmatch(lines[-1]):
        return lines[:-1], lines[-1:]
    return lines, []


def with_wildcards(patterns, line):
    """Returns the line with the wildcards of the first pattern that it resembles, placed where the surrounding text is the same."""
    for pattern in patterns:
        if difflib.SequenceMatcher(None, pattern, line).ratio() < 0.6:
            continue
        parts, kept = pattern.split(WILD), line
        for index, (before, after) in enumerate(zip(parts, parts[1:])):
            # Only words and signs around a wildcard are compared, as the numbers beside it may have changed, too.
            around = [re.escape(re.search(r"[^\d.]{0,4}$", before)[0]), re.escape(re.match(r"[^\d.]{0,4}", after)[0])]
            if index == len(parts) - 2 and len(after) <= 4:
                around[1] += "$"
            found = list(re.finditer(f"(?<={around[0]})\\S+?(?={around[1]})" if before else f"^\\S+?(?={around[1]})", kept))
            if len(found) != 1:
                break
            kept = kept[: found[0].start()] + WILD + kept[found[0].end() :]
        else:
            patterns.remove(pattern)
            return kept
    return line


def merge_lines(expected, actual):
    answer, complete = align(expected, actual)
    if complete:
        return True, list(expected)
    merged, previous = [], None
    unanswered = [e for k, e in enumerate(expected) if k not in answer and WILD in e and e.strip() != WILD]
    for index, line in zip(answer, actual):
        if index is None:
            merged.append(with_wildcards(unanswered, line))
        elif expected[index].strip() != WILD or index != previous:
            merged.append(expected[index])
        previous = index
    return False, merged


def check_figures(path, text, work, bless):
    """Returns True if each figure of the page is the one that its commands wrote; `bless` replaces the others."""
    good, shown = True, os.path.relpath(path, ROOT)
    for place, name in FIGURE.findall(text):
        drawn, kept = work / name, path.parent / place
        if not drawn.is_file():
            raise CaseError(f"no command of the page writes {name}, which it shows")
        if kept.is_file() and kept.read_bytes() == drawn.read_bytes():
            continue
        if bless:
            kept.parent.mkdir(parents=True, exist_ok=True)
            kept.write_bytes(drawn.read_bytes())
            print(f"{shown}: {place} drawn anew")
        else:
            print(f"{shown}: {place} is not what the commands of the page draw")
            good = False
    return good


def run_case(path, program, bless, run_step=None):
    """Returns True if all output is as expected. run_step(step, expected) may return 'skip' or 'code only'."""
    shown = os.path.relpath(path, ROOT)
    lines = path.read_text(encoding="utf-8").split("\n")
    files, steps = parse(lines)
    if not steps:
        raise CaseError("no `$ command` in a ```console block, so nothing is checked")
    good, edits = True, []
    with Scratch(program, files) as scratch:
        for step in steps:
            expected = strip_end(lines[step.start : step.end])
            mode = run_step(step, expected) if run_step else "exact"
            if mode == "skip":
                continue
            actual = scratch.run(step.command)
            if mode == "code only":
                actual = split_exit(actual)[1]
            same, merged = merge(expected, actual)
            if same:
                continue
            good = False
            edits.append((step, merged))
            print(f"{shown}:{step.number}: $ {step.command}")
            diff = difflib.unified_diff(expected, merged, "expected", "actual", lineterm="", n=3)
            print("\n".join(list(diff)))
        good = check_figures(path, "\n".join(lines), scratch.work, bless) and good
    if bless and edits:
        for step, merged in reversed(edits):
            if any(line.startswith(("$ ", "```")) for line in merged):
                raise CaseError(f"line {step.number}: the output has a line that begins with '$ ' or '```' and cannot be a transcript")
            lines[step.start : step.end] = merged
        path.write_text("\n".join(lines), encoding="utf-8")
        print(f"{shown}: rewritten")
        return True
    return good


def run_all(paths, program, bless, run_step=None):
    failed = 0
    for path in paths:
        try:
            if not run_case(path, program, bless, run_step):
                failed += 1
        except CaseError as error:
            print(f"{os.path.relpath(path, ROOT)}: {error}")
            failed += 1
    return failed


def all_cases():
    return sorted((ROOT / "test" / "golden").glob("good/*.md")) + sorted((ROOT / "test" / "golden").glob("bad/*.md"))


def self_test():
    """Checks that the runner accepts a correct transcript and refuses each mutant of it."""
    fake = '#!/bin/sh\necho "took $$ s"; echo "[##........]  21 %  t = 2"; cat "$1" >&2; [ -e "$1" ] || exit 2\n'
    case = "# title\n```toml a.toml\nx = 1\n```\n```console\n$ anholon a.toml\ntook … s\nx = 1\n\n$ anholon b 2>/dev/null \\\n    && true\n…\n[exit 2]\n```\n"
    mutants = {
        "wrong line": case.replace("\nx = 1\n\n", "\nx = 2\n\n"),
        "missing line": case.replace("\nx = 1\n\n", "\n\n"),
        "extra line": case.replace("\nx = 1\n\n", "\nx = 1\ny\n\n"),
        "wrong order": case.replace("took … s\nx = 1", "x = 1\ntook … s"),
        "wrong exit code": case.replace("[exit 2]", "[exit 1]"),
        "exit code forgotten": case.replace("[exit 2]\n", ""),
        "exit code invented": case.replace("\nx = 1\n\n", "\nx = 1\n[exit 1]\n\n"),
        "wrong line with a wildcard": case.replace("took … s", "Took … s"),
        "wildcard too narrow": case.replace("took … s", "took … ms"),
        "nothing run": case.replace("$ anholon a.toml", "").replace("console", "text"),
        "never closed": case.removesuffix("```\n"),
        "escape": case.replace("a.toml\nx", "../a.toml\nx"),
        "figure of another page": case + "![a](figures/b.svg)\n",
        "figure of old": case + "![a](figures/a.toml)\n",
    }
    failures = 0
    with tempfile.TemporaryDirectory() as scratch:
        program = pathlib.Path(scratch) / "program"
        program.write_text(fake)
        program.chmod(0o755)
        path = pathlib.Path(scratch) / "case.md"

        def verdict(text, bless=False):
            path.write_text(text, encoding="utf-8")
            stdout, sys.stdout = sys.stdout, open(os.devnull, "w")
            try:
                return run_all([path], program, bless) == 0
            finally:
                sys.stdout.close()
                sys.stdout = stdout

        (path.parent / "figures").mkdir()
        (path.parent / "figures" / "a.toml").write_text("x = 2\n")
        if not verdict(case):
            print("a good case was refused")
            failures += 1
        for title, text in mutants.items():
            if verdict(text):
                print(f"mutant not refused: {title}")
                failures += 1
        for title in ("wrong line", "missing line", "extra line", "wrong exit code", "wrong line with a wildcard"):
            verdict(mutants[title], bless=True)
            if path.read_text(encoding="utf-8").replace("\n\n$", "\n$") != case.replace("\n\n$", "\n$"):
                print(f"blessing did not restore: {title}\n{path.read_text(encoding='utf-8')}")
                failures += 1
        verdict(mutants["figure of old"], bless=True)
        if not verdict(mutants["figure of old"]):
            print("blessing did not draw the figure")
            failures += 1
    print(f"{len(mutants)} mutants, {failures} mistakes")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--bless", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    parser.add_argument("cases", nargs="*", type=pathlib.Path)
    args = parser.parse_args()
    if args.self_test:
        return self_test()
    if args.program is None or not args.program.exists():
        parser.error("--program must name the program under test")
    cases = [path.resolve() for path in args.cases] or all_cases()
    failed = run_all(cases, args.program, args.bless)
    print(f"{len(cases)} cases, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
