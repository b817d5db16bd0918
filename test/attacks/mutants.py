#!/usr/bin/env python3
"""Mutated models and command lines over all commands: none crashes, hangs, fills memory, reports a fault of its own or gives rows without numbers.

    mutants.py --program PROGRAM [--count 10000] [--first 0] [--jobs 2] [--keep FOLDER]
    mutants.py --self-test                              each fault is noticed in a program that has it

Mutant number k is the same on every machine: a shipped model (or one of test/hostile) in which lines, words, numbers, signs or bytes are
changed, exchanged, doubled or removed, and a command line made in the same way. Each has 5 seconds of processor time (proofs more) and 1 GiB. It fails if

    it ends by a signal, or with another exit status than 0, 1, 2
    it ends with 0 and a row holds a value that is no number
    it ends with 1 or 2 and without a message
    it sends a control character to the terminal
"""

import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECONDS, MEMORY, PATIENCE = 5, 1 << 30, 300
PROOFS = {"prove": 60, "report": 60}  # seconds where all forms are proved equal: that of a rolling ball in quaternions takes 6

WORDS = """sin cos tan exp log sqrt abs sign atan2 norm unit cross dot rotx roty rotz choose table select min max ex ey ez t pi e x y z theta phi psi x' y'' D(x,3)
0 1 -1 2 1/3 1e-30 1e30 1e308 1e-308 nan inf 0x1F 007 1_000 kg m s deg km/h "" "'" true false [[body]] [parameters] [define] [event] [state] coordinates
force torque constraint equation when set stop on from at mass inertia center position name title unit doc file base kind degree lambda power reaction vel omega
é θ \u202e \x1b[31m \x00 \u200b 中 😀""".split()
SIGNS = list("+-*/^'=<>()[]{},.\"#\\|&;:%!?@~`$ \t")


def corpus():
    files = sorted((ROOT / "models").rglob("*.toml")) + sorted((ROOT / "test" / "hostile").rglob("*.toml"))
    return [f for f in files if f.stat().st_size < 20000]


# ---- mutations ------------------------------------------------------------------------------------------


def number(r):
    return r.choice(["0", "-1", "1e-300", "1e300", "1e18", "-0.0", "3.14159", "1/7", "1e-16", "99999999999999999999", "0.1", "2", str(r.randrange(-100, 100)), f"{r.gauss(0, 10):.6g}"])


def mutate_text(r, text, others):
    """Makes one change."""
    lines = text.split("\n")
    kind = r.randrange(14)
    at = r.randrange(len(lines))
    if kind == 0:
        del lines[at]
    elif kind == 1:
        lines.insert(at, r.choice(lines))
    elif kind == 2:
        other = r.randrange(len(lines))
        lines[at], lines[other] = lines[other], lines[at]
    elif kind == 3:
        lines.insert(at, r.choice(r.choice(others).split("\n")))
    elif kind in (4, 5, 6, 7):  # a number or a word is exchanged for another
        pattern = r"[0-9][0-9.eE]*" if kind < 6 else r"[A-Za-z_]\w*'*"
        places = list(re.finditer(pattern, text))
        if places:
            m = r.choice(places)
            mine = r.choice([p[0] for p in places])
            new = number(r) if kind == 4 else mine if r.random() < 0.6 else r.choice(WORDS)
            return text[: m.start()] + new + text[m.end() :]
    elif kind in (8, 9):  # a sign is inserted, or removed
        i = r.randrange(len(text) + 1)
        return text[:i] + (r.choice(SIGNS) if kind == 8 else "") + text[i + (kind == 9) :]
    elif kind == 10:  # a part is repeated, or nested
        i = r.randrange(len(text) + 1)
        j = min(len(text), i + r.randrange(1, 200))
        return text[:j] + text[i:j] * r.choice([1, 2, 50]) + text[j:]
    elif kind == 11:  # the text is cut off
        return text[: r.randrange(len(text) + 1)]
    elif kind == 12:  # a formula becomes a part of another one
        places = list(re.finditer(r'"([^"\n]+)"', text))
        if len(places) > 1:
            m, f = r.choice(places), r.choice(places)
            return text[: m.start()] + r.choice(['"sin({})"', '"({})*{}"', '"sqrt({})"', '"1/({})"', '"({})^{}"', '"-({})"', '"abs({})"', '"log({})"']).replace("{}", f[1]) + text[m.end() :]
    else:
        i = r.randrange(len(text) + 1)
        return text[:i] + r.choice(WORDS) + text[i:]
    return "\n".join(lines)


def names_of(text):
    match = re.search(r"coordinates\s*=\s*\[([^\]]*)\]", text)
    return re.findall(r'"([^"]+)"', match[1]) if match else ["x"]


def command_line(r, text, model, folder, certificates, runs):
    """Words after the program; OUT stands for a file that the command writes."""
    names = names_of(text) + ["x", "nothing"]
    parameters = re.findall(r"^(\w+)\s*=", text, re.M) + ["m"]

    def value():
        return f"{r.choice(names)}={number(r)}"

    state = [["--q", value()], ["--qdot", value()], ["--t", number(r)], ["--set", f"{r.choice(parameters)}={number(r)}"], ["--qddot", value()], ["--lambda", value()]]
    form = [["--form", r.choice(["routh", "maggi", "chaplygin", "appell", "auto", "lagrange", "voronets", "nothing"])], ["--eliminate", r.choice(names)]]
    to = [["--to", r.choice(["0.3", "1", "0", "-1", "1e-9", "1e19", "x"])], ["--every", r.choice(["0.1", "1e-9", "0", "1e9"])], ["--at", r.choice(["0.1,0.2", "0", ",", "-1,1"])]]
    accuracy = [["--tolerance", r.choice(["1e-6", "1e-20", "0.5", "0", "-1"])], ["--digits", r.choice(["20", "1", "0", "60"])], ["--order", r.choice(["4", "30", "500", "3"])],
                ["--method", r.choice(["taylor", "rk", "bdf", "auto", "no"])], ["--integrator", r.choice(["cvode", "ida", "taylor", "no"])], ["--numbers", r.choice(["quad", "long-double", "double"])],
                ["--rigorous", r.choice(["1", "all", "0"])]]
    out = str(folder / f"out{r.choice(['.csv', '.h5', '.json', '.csv', '.txt', '/no/file.csv'])}")
    both = [["--json"], ["--quiet"]]
    table = {
        "check": state + form + both + [["--show", r.choice(["mechanics", "system", "structure", "program", "cost", "no"])]],
        "derive": state[3:4] + form + [["--format", r.choice(["text", "latex", "mathml", "json", "c", "python", "no"])], ["--expand", r.choice(["auto", "none", "full", "parts", "no"])], ["--steps"]] + both,
        "evaluate": state + form + both + accuracy[1:2] + accuracy[5:6],
        "simulate": state + form + both + to + accuracy + [["-o", out], ["--save", str(folder / "saved")], ["--error-estimate", r.choice(["always", "never", "short"])]],
        "sweep": state + form + both + to[:1] + accuracy[:1] + [["--vary", f"{r.choice(parameters + names)}={r.choice(['1:2:3', '0,1', '1:2:0', '1:2:1e9', '::', 'a'])}"], ["--vary", f"{r.choice(names)}~normal(0,{number(r)})"], ["-n", r.choice(["3", "0", "-1"])], ["-o", out]],
        "linearize": state + form + both + [["--about", r.choice(["state", "equilibrium"])], ["--vary", f"{r.choice(parameters)}={r.choice(['0..2:1', '1,2', '0..1e9:1e-9'])}"], ["--csv"]],
        "forms": both,
        "prove": both + [["--forms", r.choice(["routh,maggi", "routh", "no"])], ["-o", str(folder / "proof.json")], ["--digits", r.choice(["20", "100"])]],
        "report": state + form + to + accuracy[:1] + [["-o", str(folder / "page.html")], ["--no-proof"], ["--no-proof"]],
        "fmt": [["--check"], ["--stdout"], ["--stdout"]],
        "compare": state[3:4] + both,
        "verify": [["--points", r.choice(["1", "0", "6"])], ["--json"], ["--seed", number(r)]],
        "plot": [["--x", r.choice(names)], ["--from", number(r)], ["--log"], ["--each"], ["--size", r.choice(["40x10", "0x0", "8cmx5cm", "x"])], ["-o", str(folder / r.choice(["f.svg", "f.tex", "f.png", "f.no"]))], ["--json"], ["--title", r.choice(WORDS)], [r.choice(names)]],
        "convert": [[out]],
    }
    weights = {"check": 4, "derive": 4, "evaluate": 4, "simulate": 8, "sweep": 4, "linearize": 3, "prove": 1, "report": 2, "fmt": 2, "verify": 4, "plot": 4, "convert": 3, "compare": 1, "forms": 1}
    command = r.choices(list(weights), list(weights.values()))[0]
    argument = model
    if command == "verify":
        argument = mutated_file(r, r.choice(certificates), folder, "certificate.json")
    elif command in ("plot", "convert"):
        argument = mutated_file(r, r.choice(runs), folder, "run" + pathlib.Path(r.choice(runs)).suffix)
    words = [command, str(argument)]
    if command == "compare":
        words.append(mutated_file(r, r.choice(sorted((ROOT / "models").rglob("*.eq"))), folder, "equations.eq"))
    if command in ("simulate", "sweep", "report") and r.random() < 0.8:
        words += ["--to", r.choice(["0.1", "0.5"])]
    for option in r.sample(table[command], min(len(table[command]), r.randrange(4))):
        words += option
    if r.random() < 0.1:
        i = r.randrange(len(words))
        words[i : i + 1] = r.choice([[], [words[i], words[i]], [r.choice(WORDS)], ["--" + r.choice(WORDS)], [words[i][: len(words[i]) // 2]]])
    return [w.replace("\0", "") for w in words]


def mutated_file(r, path, folder, name):
    """Bytes of a file, flipped, cut or doubled."""
    data = bytearray(pathlib.Path(path).read_bytes())
    for _ in range(r.choice([0, 1, 1, 2, 10])):
        if not data:
            break
        i = r.randrange(len(data))
        kind = r.randrange(5)
        if kind == 0:
            data[i] ^= 1 << r.randrange(8)
        elif kind == 1:
            del data[i:]
        elif kind == 2:
            del data[i : i + r.randrange(1, 50)]
        elif kind == 3:
            data[i:i] = data[i : i + r.randrange(1, 50)]
        else:
            data[i : i + 1] = r.choice(WORDS).encode("utf-8", "surrogatepass")
    target = folder / name
    target.write_bytes(data)
    return str(target)


def mutant(k, models, folder, certificates, runs):
    """Mutant number k: writes its model and gives the words of its command line."""
    r = random.Random(k)
    texts = [m.read_text(encoding="utf-8", errors="replace") for m in (r.choice(models), r.choice(models))]
    text = texts[0]
    for _ in range(r.choice([0, 1, 1, 2, 3, 8])):
        if text:
            text = mutate_text(r, text, texts)
    model = folder / "model.toml"
    model.write_bytes(text.encode("utf-8", "surrogatepass"))
    return command_line(r, text, model, folder, certificates, runs)


# ---- running ------------------------------------------------------------------------------------------


def limit(seconds):
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (256 << 20, 256 << 20))


def run(program, words, folder, limits=True):
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        process = subprocess.Popen([program, *words], stdin=subprocess.DEVNULL, stdout=out, stderr=err, cwd=folder, preexec_fn=(lambda: limit(PROOFS.get(words[0] if words else "", SECONDS))) if limits else None)
        patience = threading.Timer(PATIENCE, process.kill)
        patience.start()
        code = process.wait()
        patience.cancel()
        out.seek(0), err.seek(0)
        return code, out.read(64 << 20), err.read(1 << 20)


def no_numbers(text):
    """The first row of CSV that is no row of numbers, or None; words are allowed in the column `outcome` of a case that did not finish."""
    lines = text.decode("utf-8", "replace").splitlines()
    if not lines:
        return None
    names = lines[0].split(",")
    words = names.index("outcome") if "outcome" in names else None
    width = None
    for line in lines[1:]:
        cells = line.split(",")
        width = width or len(cells)
        if len(cells) != width:
            return line
        if words is not None and cells[words] != "finished":
            return line
        for k, cell in enumerate(cells):
            if k == words:
                continue
            try:
                if not math.isfinite(float(cell)):
                    return line
            except ValueError:
                return line
    return None


def null_in(rows):
    return any(v is None or not (isinstance(v, str) or math.isfinite(v)) for row in rows for v in row)


def rows_at_fault(words, out, folder):
    """The fault of the rows of a run with exit status 0, or None."""
    if words[0] not in ("simulate", "sweep"):
        return None
    target = words[words.index("-o") + 1] if "-o" in words[:-1] else ""
    data = out
    if target:
        path = pathlib.Path(target)
        if path.suffix == ".h5" or not path.is_file():
            return None
        data = path.read_bytes()
    if "--show" in words:
        return None
    if target.endswith(".json") or (not target and data.lstrip().startswith(b"{")):
        try:
            rows = json.loads(data).get("rows", [])
        except ValueError as e:
            return f"no JSON: {e}"
        return "a row that is no numbers" if null_in(rows) else None
    line = no_numbers(data) if data else None
    return f"a row that is no numbers: {line[:120]}" if line else None


CONTROL = re.compile(rb"[\x00-\x08\x0b-\x1f\x7f]|\xc2[\x80-\x9f]")


def fault(program, words, folder, limits=True):
    for old in folder.glob("out*"):
        old.unlink()
    code, out, err = run(program, words, folder, limits)
    if code == -signal.SIGXCPU:
        return "out of processor time"
    if code < 0:
        return f"signal {signal.Signals(-code).name}"
    if code not in (0, 1, 2) or b"internal fault" in err:
        return f"exit status {code}"
    if code == 2 and not err.strip():
        return "no word about what is wrong"
    if CONTROL.search(err):
        return "a control character in the messages"
    if code == 0:
        return rows_at_fault(words, out, folder)
    return None


def prepared(program, folder):
    """Makes the certificates and runs that mutants begin with."""
    made = {"proof1.json": ["prove", "disc"], "proof2.json": ["prove", "luo-zhao-example-2", "--forms", "routh,maggi"]}
    runs = {"run.csv": ["simulate", "disc"], "run.json": ["simulate", "disc"], "run.h5": ["simulate", "disc"]}
    for name, words in made.items():
        subprocess.run([program, *words, "-o", str(folder / name)], stdout=subprocess.DEVNULL, check=True)
    for name, words in runs.items():
        subprocess.run([program, *words, "--to", "1", "--every", "0.1", "--quiet", "-o", str(folder / name)], check=False)
    return [folder / n for n in made], [folder / n for n in runs if (folder / n).exists()]


SICK = {
    "crash": ("kill -SEGV $$", "signal SIGSEGV"),
    "fault": ("exit 3", "exit status 3"),
    "hang": ("while :; do :; done", "out of processor time"),
    "silence": ("exit 2", "no word"),
    "no number": ("printf 't,x\\n0,1\\n1,nan\\n'", "no numbers"),
    "nothing between commas": ("printf 't,x\\n0,1\\n1,\\n'", "no numbers"),
    "escape": ("printf 'error: \\033[31m' >&2; exit 2", "control character"),
}


def self_test():
    missed = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for name, (script, expected) in SICK.items():
            program = folder / "program"
            program.write_text(f"#!/bin/bash\n{script}\n")
            program.chmod(0o755)
            found = fault(str(program), ["simulate", "x"], folder)
            if expected not in (found or ""):
                print(f"not found: {name}: {found}")
                missed += 1
        models = corpus()
        for k in range(50):  # mutant k is the same each time
            again = []
            for _ in range(2):
                again.append((mutant(k, models, folder, [models[0]], [models[0]]), (folder / "model.toml").read_bytes()))
            if again[0] != again[1]:
                print(f"mutant {k} is not the same twice")
                missed += 1
    print(f"{len(SICK)} sick programs, {missed} mistakes")
    return 1 if missed else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--count", type=int, default=10000 if os.environ.get("ANHOLON_LONG") else 100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=pathlib.Path, help="where mutants that fail are kept")
    parser.add_argument("--no-limits", action="store_true", help="for programs under a sanitizer")
    options = parser.parse_args()
    os.environ.setdefault("ANHOLON_CACHE", "")
    program = os.path.abspath(options.program)
    models = corpus()
    found, codes, lock = [], {}, threading.Lock()
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        certificates, runs = prepared(program, scratch)

        def work(job):
            for k in range(options.first + job, options.first + options.count, options.jobs):
                folder = scratch / f"job{job}"
                folder.mkdir(exist_ok=True)
                words = mutant(k, models, folder, certificates, runs)
                what = fault(program, words, folder, not options.no_limits)
                with lock:
                    codes[words[0] if words else ""] = codes.get(words[0] if words else "", 0) + 1
                if what:
                    with lock:
                        found.append(k)
                        print(f"mutant {k}: {what}: {' '.join(words)}".encode("ascii", "backslashreplace").decode().replace(str(folder), "."), flush=True)
                    if options.keep:
                        to = options.keep / str(k)
                        to.mkdir(parents=True, exist_ok=True)
                        for f in folder.iterdir():
                            if f.is_file():
                                (to / f.name).write_bytes(f.read_bytes())
                        (to / "words.json").write_text(json.dumps(words).replace(str(folder), str(to)))

        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            list(pool.map(work, range(options.jobs)))
    print(f"{options.count} mutants, {len(found)} faults; " + ", ".join(f"{n} {c}" for c, n in sorted(codes.items(), key=lambda x: -x[1]) if n > 20))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
