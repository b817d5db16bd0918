#!/usr/bin/env python3
"""Hostile models: contradictory, degenerate, redundant, wrong, absurd. None may crash, hang or fill memory.

    run.py --program PROGRAM [--no-limits | --seconds S] [NAME...]
    run.py --self-test                                   each fault is noticed in a program that has it

Every model of this folder goes through `check`, `simulate`, `evaluate` and `derive`. Models that are too large to be stored (made
below) go through the first two. Each command has limits of processor time and memory. The limit of time distinguishes a hang from
work: the slowest command takes 1.6 s, and the load of other programs must not fail the test. With `--seconds 2` the test checks that
each command ends within two seconds on a quiet machine. The first line of a model gives the expected result:

    # expects: ok
    # expects: error "these words"                     bad input: exit status 2, positioned in the file
    # expects: singular "the constraint 'c1'"          an outcome of that name: exit status 1
    # expects: check ok; simulate blow_up/singular     if the commands differ; one of several

`check` and `simulate` must end as expected, the others in any of these ways. An error names file, line and column
(`# expects: file error …`: the file alone), an outcome has a name, and output requested as JSON is JSON.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading

os.environ.setdefault("ANHOLON_CACHE", "")  # no compiled code is kept in the home folder

FOLDER = pathlib.Path(__file__).resolve().parent
SECONDS = 10  # of processor time, for each command
MEMORY = 1 << 30  # bytes of address space
PATIENCE = 600  # seconds, after which a sleeping command is killed
COMMANDS = (
    ("check",),
    ("simulate", "--json"),
    ("evaluate", "--json"),
    ("derive",),
)
FEW = COMMANDS[:2]  # for models that take long to read
OUTCOMES = {
    "singular", "step_collapse", "blow_up", "negative_mass", "not_a_number", "no_convergence", "inconsistent",
    "interrupted", "too_large",
}  # fmt: skip


# ---- what is expected -------------------------------------------------------------------------------


class Expected:
    """`ok`, `error`, `file error` or outcomes, with the words of the message."""

    def __init__(self, text):
        match = re.fullmatch(r'\s*([a-z_/ ]+?)\s*(?:"(.*)")?\s*', text)
        if not match:
            raise SystemExit(f"not understood: expects: {text}")
        self.kind, self.words = match[1], match[2] or ""
        self.outcomes = self.kind.split("/")
        if self.kind not in ("ok", "error", "file error") and not set(self.outcomes) <= OUTCOMES:
            raise SystemExit(f"expects: there is no result '{self.kind}'")
        self.code = {"ok": 0, "error": 2, "file error": 2}.get(self.kind, 1)

    def met(self, code, errors):
        if code != self.code or self.words not in errors:
            return False
        return self.code != 1 or any(f"stopped ({o})" in errors for o in self.outcomes)


def expectations(line):
    """`# expects: check ok; simulate singular "words"` -> {"check": …, "simulate": …}"""
    if not line.startswith("# expects: "):
        raise SystemExit(f"the first line is not '# expects: …': {line}")
    result = {}
    for part in line[len("# expects: ") :].split(";"):
        command, _, rest = part.strip().partition(" ")
        if command in ("check", "simulate"):
            result[command] = Expected(rest)
        else:
            result["check"] = result["simulate"] = Expected(part)
    return result


# ---- models too large to be stored ------------------------------------------------------------------

PLANE = 'coordinates = ["x", "y"]\nparticle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]\n'
FORCE = 'force = [{on = "p", vector = "(%s)*ex"}]\n'
END = "[simulate]\nto = 1\n"


def line_of_points(n, more=""):
    names = ", ".join(f'"x{i}"' for i in range(n))
    points = "".join(f'  {{name = "p{i}", mass = 1, position = "x{i}*ex"}},\n' for i in range(n))
    return f"coordinates = [{names}]\nparticle = [\n{points}]\n{more}"


def constraints(equations):
    return "constraint = [\n" + "".join(f'  {{name = "c{i}", equation = "{e}"}},\n' for i, e in enumerate(equations)) + "]\n"


def made():
    """(name, expects, text or bytes) of the generated models."""
    yield "brackets", 'error "nested deeper"', PLANE + FORCE % ("(" * 100000 + "x" + ")" * 100000) + END
    yield "minus_signs", 'error "nested deeper"', PLANE + FORCE % ("-" * 100000 + "x") + END
    yield "primes", 'error "more than 400 signs"', PLANE + FORCE % ("x" + "'" * 100000) + END
    yield "powers", 'error "nested deeper"', PLANE + FORCE % "^".join(["2"] * 100000) + END
    yield "calls", 'error "nested deeper"', PLANE + FORCE % ("sin(" * 100000 + "x" + ")" * 100000) + END
    yield "arrays", "error", PLANE + 'title = ' + "[" * 100000 + "]" * 100000 + "\n"
    yield "tables", "error", PLANE + "title = " + "{a = " * 100000 + "1" + "}" * 100000 + "\n"
    yield "keys", 'error "parts"', PLANE + "a" + ".a" * 100000 + " = 1\n"
    yield "sum_of_a_million_characters", "ok", PLANE + FORCE % "+".join(["x"] * 500000) + END
    yield "sum_of_different_terms", "ok", PLANE + FORCE % " + ".join(f"sin({i}*x)" for i in range(10000)) + END
    yield "product_of_different_factors", "not_a_number", PLANE + FORCE % "*".join(f"(x + {i})" for i in range(1000)) + END
    yield "formula_too_long", 'error "bytes"', PLANE + FORCE % "+".join(["x"] * 600000) + END
    yield "digits_million", 'error "out of all proportion"', PLANE + FORCE % ("1" * 1000000) + END
    yield "digits_million_after_the_point", "error", PLANE + FORCE % ("0." + "1" * 1000000) + END
    yield "number_of_a_million_digits", "error", PLANE.replace("mass = 1", "mass = 0." + "1" * 1000000) + END
    yield "name_of_a_million_letters", 'error "unknown name"', PLANE + FORCE % ("a" * 1000000) + END
    yield "coordinate_of_a_million_letters", "ok", PLANE.replace('"x"', '"' + "a" * 1000000 + '"').replace("x*ex", "a" * 1000000 + "*ex") + END
    yield "title_of_a_megabyte", "ok", 'title = "' + "a" * 1000000 + '"\n' + PLANE + END
    yield "file_of_ten_megabytes", 'error "MiB"', PLANE + "# " + "a" * 10000000 + "\n" + END
    yield "comments", "ok", PLANE + END + "# nothing\n" * 100000
    yield "blank_lines", "ok", "\n" * 1000000 + PLANE + END
    yield "keys_unknown", 'error "unknown key"', PLANE + END + "".join(f"k{i} = {i}\n" for i in range(50000))
    yield "parameters_many", "ok", PLANE + END + "[parameters]\n" + "".join(f"a{i} = {i}\n" for i in range(20000))
    yield "parameters_in_a_chain", 'error "leads through more than"', PLANE + END + "[parameters]\na0 = 1\n" + "".join(f'a{i + 1} = "a{i} + 1"\n' for i in range(3000))
    yield "parameters_in_a_chain_backwards", 'error "leads through more than"', PLANE + END + "[parameters]\n" + "".join(
        f'a{i} = "a{i + 1} + 1"\n' for i in range(3000)
    ) + "a3000 = 1\n"
    yield "definitions_in_a_chain", "ok", PLANE + FORCE % "d2000" + END + '[define]\nd0 = "x"\n' + "".join(
        f'd{i + 1} = "sin(d{i})"\n' for i in range(2000)
    )
    yield "points_in_a_chain", "ok", PLANE + END + '[point]\nP0 = "x*ex"\n' + "".join(f'P{i + 1} = "P{i} + sin({i}*x)*ey"\n' for i in range(300))
    yield "errors_many", 'error "unknown name"', PLANE + END + "[parameters]\n" + "".join(f'a{i} = "b{i}"\n' for i in range(5000))
    yield "coordinates_5000", 'error "at most"', line_of_points(5000) + END
    yield "coordinates_100000", 'error "100000 coordinates"', "coordinates = [" + ", ".join(f'"x{i}"' for i in range(100000)) + "]\n" + END
    yield "coordinates_1000000", "error", "coordinates = [" + '"x",' * 1000000 + "]\n"
    yield "coordinates_300000_empty", 'error "coordinates"', "coordinates = [" + '"",' * 300000 + "]\n" + END
    yield "constraints_10000", 'error "at most"', PLANE + constraints(["x' = y'"] * 10000) + END
    yield "constraints_2000_of_1000", 'error "at most"', line_of_points(1001, constraints([f"x{i % 1000}' = x{i % 1000 + 1}'" for i in range(2000)])) + END
    yield "bodies_10000", "ok", 'coordinates = ["x"]\nparticle = [\n' + "".join(
        f'  {{name = "p{i}", mass = 1, position = "x*ex"}},\n' for i in range(3000)
    ) + "]\n" + END
    yield "forces_10000", "ok", PLANE + "force = [\n" + '  {on = "p", vector = "ex"},\n' * 10000 + "]\n" + END
    yield "not_text", "error", bytes(range(256)) * 1000
    yield "zeros", "error", b"\0" * 1000000
    yield "empty", 'error "no coordinates"', b""
    yield "byte_order_mark_alone", 'error "no coordinates"', b"\xef\xbb\xbf"
    yield "byte_order_mark", "ok", b"\xef\xbb\xbf" + (PLANE + END).encode()


# ---- running ------------------------------------------------------------------------------------------


def limit(seconds):
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    # The soft limit ends a hang; the time of a command is measured.
    resource.setrlimit(resource.RLIMIT_CPU, (seconds + 1, seconds + 2))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(program, command, path, seconds):
    """Exit status (negative: a signal), stdout, stderr, seconds of processor time; nothing is limited if `seconds` is None."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        limits = None if seconds is None else lambda: limit(seconds)
        process = subprocess.Popen([program, command[0], str(path), *command[1:], "--quiet"], stdout=out, stderr=err, preexec_fn=limits)
        patience = threading.Timer(PATIENCE, process.kill)
        patience.start()
        _, status, usage = os.wait4(process.pid, 0)
        patience.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0), err.seek(0)
        return process.returncode, out.read(), err.read().decode("utf-8", "replace"), usage.ru_utime + usage.ru_stime


def faults(name, path, expected, program, seconds, commands=COMMANDS):
    """The faults of a model, one line each."""
    positioned = re.compile(re.escape(str(path)) + r":\d+:\d+: error: .")
    whole = re.compile(r"(?:" + re.escape(str(path)) + r": )?error: .")
    for command in commands:
        code, out, errors, took = run(program, command, path, seconds)
        said = " | ".join(l for l in errors.splitlines() if re.search("error:|stopped|fault|terminate", l))[:300]

        def wrong(what):
            return f"{name}: {' '.join(command)}: {what}; exit {code}; {said}"

        if code not in (0, 1, 2) or "internal fault" in errors:
            yield wrong("out of processor time" if code == -signal.SIGXCPU else "no end" if code == -signal.SIGKILL else "a crash")
            continue
        if seconds is not None and took > seconds:
            yield wrong(f"took {took:.1f} s of processor time")
        want = expected.get(command[0])
        if want and not want.met(code, errors):
            yield wrong(f"expected {want.kind} '{want.words}'")
        file_error = any(e.kind == "file error" for e in expected.values())
        # An elimination that is not possible is no error of the file.
        of_the_file = command[0] in ("check", "simulate")
        if code == 2 and of_the_file and not (whole if file_error else positioned).search(errors):
            yield wrong("an error without a place")
        if code == 2 and not errors.strip():
            yield wrong("an error without a word")
        if code == 1 and not any(f"stopped ({o})" in errors for o in OUTCOMES):
            yield wrong("an outcome without a name")
        if "--json" in command and (code == 0 or out.strip()):
            try:
                json.loads(out)
            except ValueError as e:
                yield wrong(f"not JSON: {e}")


SICK = {
    "crash": "kill -SEGV $$",
    "fault": "echo 'x.cpp:1: internal fault: x' >&2; exit 3",
    "hang": "while :; do :; done",
    "memory": "/usr/bin/python3 -c 'b\"x\" * (2 << 30)' 2>/dev/null || kill -ABRT $$",
    "no place": "echo 'error: no' >&2; exit 2",
    "no name": "echo 'stopped: no' >&2; exit 1",
    "no JSON": "echo '{\"t\": nan,}'",
    "accepts all": "exit 0",
}
FAULTS = {
    "crash": "a crash", "fault": "a crash", "hang": "out of processor time", "memory": "a crash", "no place": "without a place",
    "no name": "without a name", "no JSON": "not JSON", "accepts all": "expected error",
}  # fmt: skip


def self_test():
    missed = []
    with tempfile.TemporaryDirectory() as scratch:
        model = pathlib.Path(scratch) / "model.toml"
        model.write_text("# expects: error")
        for sickness, script in SICK.items():
            program = pathlib.Path(scratch) / "program"
            program.write_text(f"#!/bin/bash\n{script}\n")
            program.chmod(0o755)
            found = list(faults("self-test", model, expectations("# expects: error"), str(program), 1, [("simulate", "--json")]))
            if FAULTS[sickness] not in " ".join(found):
                missed.append(f"{sickness}: {found}")
    for line in missed:
        print(f"not found: {line}")
    print(f"{len(SICK)} sick programs, {len(missed)} passed for healthy")
    return 1 if missed else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--no-limits", action="store_true", help="for programs under a sanitizer")
    parser.add_argument("--seconds", type=int, default=SECONDS, help="processor time that each command may take (%(default)s)")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    seconds = None if options.no_limits else options.seconds
    with tempfile.TemporaryDirectory() as scratch:
        cases = []
        for path in sorted(FOLDER.glob("*/*.toml")):
            with open(path, "rb") as file:
                line = file.readline().decode("utf-8", "replace").strip()
            cases.append((f"{path.parent.name}/{path.stem}", path, expectations(line)))
        for name, expects, text in made():
            path = pathlib.Path(scratch) / f"{name}.toml"
            path.write_bytes(text if isinstance(text, bytes) else text.encode())
            cases.append((f"made/{name}", path, expectations(f"# expects: {expects}")))
        for name, path in (("a_folder", scratch), ("not_there", scratch + "/no.toml"), ("nothing", "/dev/null"), ("without_end", "/dev/zero")):
            cases.append((f"path/{name}", pathlib.Path(path), expectations("# expects: file error")))
        if options.names:
            cases = [c for c in cases if any(n in c[0] for n in options.names)]
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            commands = [COMMANDS if c[1].parent.parent == FOLDER else FEW for c in cases]
            found = list(pool.map(lambda c, many: list(faults(*c, program, seconds, many)), cases, commands))
        # Two commands that share caches take longer than either alone, so a command that exceeds the limit runs again
        # by itself.
        for k, lines in enumerate(found):
            if any("processor time" in line for line in lines):
                found[k] = list(faults(*cases[k], program, seconds, commands[k]))
        wrong = [line for lines in found for line in lines]
    for line in wrong:
        print(line)
    print(f"{len(cases)} hostile models, {len(wrong)} faults")
    return 1 if wrong or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
