#!/usr/bin/env python3
"""Signals at random moments, full disks, limits, missing folders, readers that leave, two processes on one file: what is written is whole, or not there.

    faults.py --program PROGRAM [--moments 60] [PART...]     parts: signals continue disk places pipes pairs cache
    faults.py --self-test                                    a file that is cut is noticed

After each fault a file under its name is the old one, or the whole new one. An unfinished file is called NAME.part; no other file lies beside it. Rows
in NAME.part are the first ones of an undisturbed run, and so are the rows under the name after a caught signal (Ctrl-C, TERM, HUP). The next run
writes the file as if nothing had happened; a saved run continues with the same bits. No process waits for ever, and every error has a message.
"""

import argparse
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SIGNALS = [signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGPIPE]
PATIENCE = 120  # seconds
OLD = b"an old file\n"
NOBODY = 65534

# Commands that write: name of the output, words. RUN stands for an existing run, MODEL for a model file.
WRITERS = {
    "simulate-csv": ("rows.csv", "simulate disc --to 400 --every 0.05 --error-estimate never -o OUT"),
    "simulate-h5": ("rows.h5", "simulate disc --to 400 --every 0.05 --error-estimate never -o OUT"),
    "simulate-json": ("rows.json", "simulate disc --to 200 --every 0.05 --error-estimate never -o OUT"),
    "sweep-csv": ("cases.csv", "sweep disc --vary phi'=5:7:400 --to 5 -o OUT"),
    "sweep-json": ("cases.json", "sweep disc --vary phi'=5:7:400 --to 5 -o OUT"),
    "report": ("page.html", "report disc --to 5 --no-proof -o OUT"),
    "simulate-report": ("page.html", "simulate disc --to 20 --report OUT --error-estimate never"),
    "prove": ("proof.json", "prove disc -o OUT"),
    "derive": ("disc.tex", "derive disc --format latex -o OUT"),
    "convert-h5": ("again.h5", "convert RUN OUT"),
    "convert-csv": ("again.csv", "convert RUN OUT"),
    "convert-json": ("again.json", "convert RUN OUT"),
    "plot-svg": ("fig.svg", "plot RUN theta phi -o OUT"),
    "plot-pdf": ("fig.pdf", "plot RUN theta phi -o OUT"),
    "plot-png": ("fig.png", "plot RUN theta phi -o OUT"),
    "plot-tex": ("fig.tex", "plot RUN theta phi -o OUT"),
    "new": ("mine.toml", "new pendulum -o OUT"),
    "fmt": ("disc.toml", "fmt OUT"),
}
NEW_ONLY = {"new"}  # refuses an existing file
IN_PLACE = {"fmt"}


class Wrong(Exception):
    pass


def must(truth, what):
    if not truth:
        raise Wrong(what)


class Bench:
    """A folder for one case, the program, and the files of undisturbed runs."""

    def __init__(self, program, folder):
        self.program, self.folder = program, pathlib.Path(folder)
        self.known, self.seconds = {}, {}
        self.run_file = self.folder / "run.csv"
        self.call(f"simulate disc --to 20 --every 0.01 --quiet -o {self.run_file}")
        text = (pathlib.Path(__file__).resolve().parents[2] / "models" / "zoo" / "disc.toml").read_text(encoding="utf-8")
        self.unformatted = text.replace(" = ", "   =  ").encode()

    def words(self, line, out):
        return [self.program, *(w.replace("OUT", str(out)).replace("RUN", str(self.run_file)) for w in line.split())]

    def start(self, words, **more):
        more.setdefault("stdout", subprocess.DEVNULL)
        more.setdefault("stderr", subprocess.PIPE)
        return subprocess.Popen(words, stdin=subprocess.DEVNULL, **more)

    def end(self, process):
        """Exit status and messages of a process."""
        try:
            said = process.communicate(timeout=PATIENCE)[1] or b""
        except subprocess.TimeoutExpired as e:
            process.kill()
            process.wait()
            raise Wrong("no end") from e
        return process.returncode, said.decode("utf-8", "replace")

    def call(self, line, out="", **more):
        return self.end(self.start(self.words(line, out), **more))

    def reference(self, name):
        """The bytes of an undisturbed run."""
        if name not in self.known:
            place = self.folder / "known"
            place.mkdir(exist_ok=True)
            target = place / WRITERS[name][0]
            self.begin(name, target, old=False)
            begun = time.monotonic()
            code, said = self.call(WRITERS[name][1], target)
            self.seconds[name] = time.monotonic() - begun
            must(code == 0, f"undisturbed: exit status {code}: {said}")
            self.known[name] = target.read_bytes()
            shutil.rmtree(place)
        return self.known[name]

    def begin(self, name, target, old):
        if name in IN_PLACE:
            target.write_bytes(self.unformatted)
        elif old and name not in NEW_ONLY:
            target.write_bytes(OLD)

    # The contents that a file may have.

    def before(self, name):
        return self.unformatted if name in IN_PLACE else OLD

    def rows(self, path):
        """The lines of a run in any format, as CSV."""
        if path.suffix == ".csv" or path.name.endswith(".csv.part"):
            return path.read_bytes()
        if path.suffix == ".json" and b'"rows": [\n    [0, ' in path.read_bytes()[:2000] and b'"case"' in path.read_bytes()[:2000]:
            return b"".join(json.dumps(row).encode() + b"\n" for row in json.loads(path.read_bytes())["rows"])  # of a sweep
        out = self.folder / "converted.csv"
        code, said = self.end(self.start([self.program, "convert", str(path), str(out)]))
        must(code == 0, f"{path.name} cannot be read: {said}")
        text = out.read_bytes()
        out.unlink()
        return text

    def same(self, name, path):
        """True if the file is that of an undisturbed run; times and places may differ."""
        data, known = path.read_bytes(), self.reference(name)
        if data == known:
            return True
        if name in ("prove", "new", "fmt", "derive", "plot-tex", "plot-svg", "convert-csv", "convert-json", "simulate-csv", "sweep-csv", "sweep-json"):
            return False
        if path.suffix in (".h5", ".json"):
            place = self.folder / ("known" + path.suffix)
            place.write_bytes(known)
            return self.rows(path) == self.rows(place)
        ends = {".html": b"</html>\n", ".pdf": b"%%EOF\n", ".png": b"IEND\xaeB`\x82"}
        return path.suffix in ends and data.endswith(ends[path.suffix]) and abs(len(data) - len(known)) < 2000

    def whole_lines(self, text):
        must(not text or text.endswith(b"\n"), "a row is cut")
        return text.split(b"\n")[:-1]

    def begins(self, name, path, code, cut_allowed):
        """Checks that the rows of the file are the first ones of an undisturbed run."""
        text = self.rows(path)
        place = self.folder / ("known" + path.suffixes[0])
        place.write_bytes(self.reference(name))
        known = self.rows(place)
        if cut_allowed:
            text = text[: text.rfind(b"\n") + 1]
        self.whole_lines(text)
        # The last row of a run that was asked to end shows the time that it reached.
        early = text[: text[:-1].rfind(b"\n") + 1]
        if not known.startswith(text) and not (code == 1 and known.startswith(early)):
            lines, all_lines = text.split(b"\n"), known.split(b"\n")
            at = next((k for k, (a, b) in enumerate(zip(lines, all_lines)) if a != b), len(lines))
            raise Wrong(f"row {at} of {len(lines)} is not that of an undisturbed run: {lines[at][:60]!r}")

    def judge(self, name, target, code, had_old):
        """Checks the folder after a fault."""
        allowed = {target.name, target.name + ".part"}
        others = {f.name for f in target.parent.iterdir()} - allowed
        must(not others, f"left beside it: {sorted(others)}")
        rows = name.split("-")[0] in ("simulate", "sweep") and name != "simulate-report"
        if target.exists():
            data = target.read_bytes()
            if data == self.before(name) and had_old:
                pass
            elif self.same_or_wrong(name, target):
                pass
            elif code == 1 and target.suffix == ".html":
                must(data.endswith(b"</html>\n"), "a page is cut")  # of the motion so far
            elif rows and (code in (0, 1) or target.suffix == ".h5"):
                self.begins(name, target, code, cut_allowed=False)
            else:
                raise Wrong(f"{target.name} is neither the old nor the new one ({len(data)} bytes of {len(self.reference(name))}, exit status {code})")
        else:
            must(not had_old, f"{target.name}: the old file is lost")
        part = target.parent / (target.name + ".part")
        if rows and part.exists() and part.name.endswith(".csv.part"):
            self.begins(name, part, code, cut_allowed=True)

    def same_or_wrong(self, name, target):
        try:
            return self.same(name, target)
        except Wrong:
            return False

    def again(self, name, target):
        """Checks that the next run is as if nothing had happened."""
        if name in NEW_ONLY:
            target.unlink(missing_ok=True)
        if name in IN_PLACE:
            target.write_bytes(self.unformatted)
        code, said = self.call(WRITERS[name][1], target)
        must(code == 0, f"the next run: exit status {code}: {said}")
        must(self.same(name, target), "the next run wrote something else")
        must([f.name for f in target.parent.iterdir()] == [target.name], "the next run left something")


def fresh(bench, name):
    place = bench.folder / "case"
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir()
    return place / WRITERS[name][0]


# ---- the parts: each yields (what was tried, function) -----------------------------------------------------


def signals(bench, moments, r):
    for name in WRITERS:
        bench.reference(name)
        for k in range(moments):
            s, after, old = SIGNALS[k % len(SIGNALS)], r.uniform(0, 1.05) * bench.seconds[name], r.random() < 0.5

            def case(name=name, s=s, after=after, old=old, last=k + 1 == moments):
                target = fresh(bench, name)
                bench.begin(name, target, old)
                process = bench.start(bench.words(WRITERS[name][1], target))
                time.sleep(after)
                process.send_signal(s)
                code, said = bench.end(process)
                must(code in (0, 1, 2, -s), f"exit status {code}: {said[-300:]}")
                bench.judge(name, target, code, name in IN_PLACE or (old and name not in NEW_ONLY))
                if last or s == signal.SIGKILL:
                    bench.again(name, target)

            yield f"{name}: {signal.Signals(s).name} after {after:.2f} s", case


def carry_on(bench, moments, r):
    """A saved run is continued with the same bits, however it ended."""
    for numbers in ("", " --numbers long-double"):
        line = f"simulate rolling-coin --to 3000 --every 1 --error-estimate never --tolerance 1e-15{numbers} -o OUT"
        state = {}

        def undisturbed(line=line, state=state):
            place = bench.folder / "known"
            place.mkdir(exist_ok=True)
            begun = time.monotonic()
            code, said = bench.call(line + f" --save {place}/state", place / "rows.csv")
            must(code == 0, said)
            state.update(rows=(place / "rows.csv").read_bytes().split(b"\n")[1:-1], seconds=time.monotonic() - begun)
            shutil.rmtree(place)

        yield f"continue{numbers}: undisturbed", undisturbed
        for k in range(moments // 2):
            s, share, form = SIGNALS[k % 4], r.random(), r.choice(["csv", "h5"])

            def case(line=line, state=state, s=s, share=share, form=form):
                place = bench.folder / "case"
                shutil.rmtree(place, ignore_errors=True)
                place.mkdir()
                rows, saved, rest = place / f"rows.{form}", place / "state", place / "rest.csv"
                process = bench.start(bench.words(line + f" --save {saved}", rows))
                time.sleep(share * state["seconds"])
                process.send_signal(s)
                code, said = bench.end(process)
                must(code in (0, 1, -s), f"exit status {code}: {said[-300:]}")
                if not saved.exists():
                    must(share * state["seconds"] < 3, "no saved run after 3 s")
                    return
                line_on = line.split(" --to")[0].split(" --tolerance")[0] + f" --to 3000 --every 1 --error-estimate never --continue {saved} -o OUT"
                code, said = bench.call(line_on, rest)
                if code == 2 and "has come to" in said:
                    return  # the run was complete
                must(code == 0, f"--continue: exit status {code}: {said[-300:]}")
                later = rest.read_bytes().split(b"\n")[1:-1]
                first = rows if rows.exists() else place / (rows.name + ".part")
                must(first.exists(), "the rows before the saved run are lost")
                before = bench.rows(first)
                before = before[: before.rfind(b"\n") + 1].split(b"\n")[1:-1]
                need = len(state["rows"]) - len(later)
                must(later == state["rows"][need:], "rows after the saved run have other bits")
                must(before[:need] == state["rows"][:need], f"rows before the saved run: {len(before)} of {need}, or other bits")
                if form == "h5":  # and it is continued in the same file
                    code, said = bench.call(line_on, rows)
                    must(code == 0, f"--continue into the same file: exit status {code}: {said[-300:]}")
                    must(bench.rows(rows).split(b"\n")[1:-1] == state["rows"], "the file that went on is not that of an undisturbed run")

            yield f"continue{numbers}: {signal.Signals(s).name} at {share:.0%}, {form}", case


def limited(size):
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    return limit


def tiny_disk(bench, size):
    """A file system of this size, or None if it cannot be made."""
    place = bench.folder / "disk"
    place.mkdir(exist_ok=True)
    done = os.geteuid() == 0 and subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", str(place)], stderr=subprocess.DEVNULL, check=False).returncode == 0
    return place if done else None


def disk(bench, moments, r):
    for name in WRITERS:
        size = len(bench.reference(name))
        for limit in sorted({0, 1, 1000, 5000, size // 2, max(0, size - 1)}):
            for old in (True, False):

                def case(name=name, limit=limit, old=old):
                    target = fresh(bench, name)
                    bench.begin(name, target, old)
                    code, said = bench.call(WRITERS[name][1], target, preexec_fn=limited(limit))
                    must(code in (0, 1, 2), f"exit status {code}: {said[-300:]}")
                    must(code != 2 or said.strip(), "not a word")
                    must(code != 0 or bench.same(name, target), "success, and not the whole file")
                    bench.judge(name, target, code, name in IN_PLACE or (old and name not in NEW_ONLY))

                yield f"{name}: files of at most {limit} bytes" + (", an old one is there" if old else ""), case

        def full(name=name, size=size):
            place = tiny_disk(bench, max(4096, size // 2 // 4096 * 4096))
            if place is None:
                return
            try:
                target = place / WRITERS[name][0]
                code, said = bench.call(WRITERS[name][1], target) if name not in IN_PLACE else (2, "x")
                must(code in (1, 2) or bench.same(name, target), f"a full disk: exit status {code}: {said[-300:]}")
                must(code == 0 or said.strip(), "not a word")
                if name not in IN_PLACE:
                    bench.judge(name, target, code, False)
            finally:
                subprocess.run(["umount", str(place)], check=False)

        yield f"{name}: a full disk", full


def places(bench, moments, r):
    for name in WRITERS:
        if name in IN_PLACE:
            continue
        for what in ("a missing folder", "a folder for a file", "a folder of that name", "/dev/full", "a folder that is read only", "a link", "a file that is read only"):

            def case(name=name, what=what):
                target = fresh(bench, name)
                more, expected = {}, 2
                if what == "a missing folder":
                    target = target.parent / "no" / target.name
                elif what == "a folder for a file":
                    (target.parent / "file").write_bytes(OLD)
                    target = target.parent / "file" / target.name
                elif what == "a folder of that name":
                    target.mkdir()
                elif what == "/dev/full":
                    if target.suffix not in (".csv", ".json", ".html", ".toml") or name in ("plot-tex", "convert-json", "convert-csv", "simulate-json", "sweep-json", "new"):
                        return  # the end of the name gives the format
                    target = pathlib.Path("/dev/full")
                elif what == "a link":
                    if name in NEW_ONLY:
                        return
                    real = target.parent / ("real" + target.suffix)
                    real.write_bytes(OLD)
                    target.symlink_to(real)
                    code, said = bench.call(WRITERS[name][1], target)
                    must(code == 0 and target.is_symlink() and bench.same(name, real), f"exit status {code}; the link became a file, or what it leads to was not written: {said[-200:]}")
                    return
                else:
                    if os.geteuid() != 0:
                        return
                    home = pathlib.Path(tempfile.mkdtemp(dir="/tmp"))
                    try:
                        os.chmod(home, 0o555 if "folder" in what else 0o777)
                        target = home / target.name
                        if "file" in what and name not in NEW_ONLY:
                            target.write_bytes(OLD)
                            os.chmod(target, 0o444)
                        elif "file" in what:
                            return
                        readable = subprocess.run([bench.program, "--version"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, preexec_fn=lambda: os.setuid(NOBODY), check=False)
                        if readable.returncode != 0 or not os.access(bench.run_file, os.R_OK):
                            return
                        os.chmod(bench.folder, 0o755), os.chmod(bench.run_file, 0o644)
                        code, said = bench.call(WRITERS[name][1], target, preexec_fn=lambda: os.setuid(NOBODY))
                        must(code == 2 and said.strip(), f"exit status {code}: {said[-200:]}")
                        must(not target.exists() or target.read_bytes() == OLD, "what may not be written was written")
                    finally:
                        shutil.rmtree(home)
                    return
                code, said = bench.call(WRITERS[name][1], target, **more)
                must(code == expected and "error" in said, f"exit status {code}: {said[-200:]}")

            yield f"{name}: {what}", case
    for line in ("check disc", "derive disc", "derive disc --format c", "evaluate disc --json", "simulate disc --to 1", "simulate disc --to 1 --json", "sweep disc --vary phi'=5,6 --to 1", "models",
                 "reference", "forms", "new pendulum", "plot RUN theta", "convert RUN", "linearize whipple --csv", "prove disc --forms routh,maggi"):  # fmt: skip

        def printed(line=line):
            with open("/dev/full", "wb") as nowhere:
                code, said = bench.call(line, stdout=nowhere)
            must(code == 2 and "cannot write" in said, f"exit status {code}: {said[-200:]}")

        yield f"{line} > /dev/full", printed


def pipes(bench, moments, r):
    for name, line in (("simulate-csv", "simulate disc --to 400 --every 0.01 --error-estimate never -o OUT"), ("sweep-csv", "sweep disc --vary phi'=5:7:4000 --to 5 -o OUT")):
        for read in (0, 100, 100000):

            def fifo(line=line, read=read):
                pipe = bench.folder / "case.csv"
                pipe.unlink(missing_ok=True)
                os.mkfifo(pipe)
                process = bench.start(bench.words(line, pipe))
                with open(pipe, "rb", buffering=0) as reader:
                    taken = 0
                    while taken < read:
                        taken += len(reader.read(read - taken)) or read
                begun = time.monotonic()
                code, said = bench.end(process)
                pipe.unlink()
                must(code == 2 and "cannot write" in said, f"exit status {code}: {said[-200:]}")
                must(time.monotonic() - begun < 20, "went on without a reader")

            yield f"{name}: the reader of a FIFO leaves after {read} bytes", fifo

        def stdout(line=line):
            process = bench.start(bench.words(line.replace(" -o OUT", ""), ""), stdout=subprocess.PIPE)
            process.stdout.read(100)
            process.stdout.close()
            process.stdout = None
            code, said = bench.end(process)
            must(code in (2, -signal.SIGPIPE), f"exit status {code}: {said[-200:]}")

        yield f"{name}: the reader of the standard output leaves", stdout

        def errors(line=line, name=name):
            target = fresh(bench, name)
            read, write = os.pipe()
            process = bench.start(bench.words(WRITERS[name][1], target), stderr=write)
            os.close(write), os.close(read)
            process.wait(timeout=PATIENCE)
            must(process.returncode == 0 and bench.same(name, target), f"exit status {process.returncode}: nobody reads the progress, and the rows are lost")

        yield f"{name}: the reader of stderr leaves", errors


def pairs(bench, moments, r):
    for name in WRITERS:
        if name in IN_PLACE:
            continue
        bench.reference(name)
        for k in range(max(2, moments // 20)):

            def case(name=name, apart=r.uniform(0, 0.5) * bench.seconds[name]):
                target = fresh(bench, name)
                first = bench.start(bench.words(WRITERS[name][1], target))
                time.sleep(apart)
                second = bench.start(bench.words(WRITERS[name][1], target))
                answers = [bench.end(first), bench.end(second)]
                must(any(code == 0 for code, _ in answers), f"neither came to its end: {answers}")
                for code, said in answers:
                    must(code == 0 or (code == 2 and ("another process" in said or "already" in said)), f"exit status {code}: {said[-200:]}")
                must(bench.same(name, target), "the file is not whole")
                must([f.name for f in target.parent.iterdir()] == [target.name], "something is left")

            yield f"{name}: two processes, round {k + 1}", case

    def saved():
        place = bench.folder / "case"
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir()
        line = f"simulate rolling-coin --to 1500 --every 1 --error-estimate never --tolerance 1e-15 --save {place}/state -o OUT"
        both = [bench.start(bench.words(line, place / f"{k}.csv")) for k in range(2)]
        answers = [bench.end(p) for p in both]
        must(all(code == 0 for code, _ in answers), f"{answers}")
        code, said = bench.call(f"simulate rolling-coin --to 1600 --every 1 --error-estimate never --continue {place}/state -o OUT", place / "rest.csv")
        must(code == 0, f"the saved run of two: {said[-300:]}")

    for k in range(3):
        yield f"two processes save to one file, round {k + 1}", saved


def cache(bench, moments, r):
    """Compiled code in the folder is made anew or is unchanged; rows have the same bytes."""
    line = "sweep disc --vary phi'=5:7:2000 --to 20 -o OUT"
    folder = bench.folder / "code"
    env = dict(os.environ, ANHOLON_CACHE=str(folder))
    known = {}

    def rows(**more):
        out = bench.folder / "cached.csv"
        code, said = bench.call(line, out, env=more.get("env", env))
        must(code == 0, f"exit status {code}: {said[-300:]}")
        return out.read_bytes()

    def first():
        shutil.rmtree(folder, ignore_errors=True)
        known["rows"] = rows(env=dict(os.environ, ANHOLON_CACHE=""))
        must(rows() == known["rows"], "code from the disk gives other rows")
        known["files"] = {f.name: f.read_bytes() for f in folder.iterdir()} if folder.exists() else {}

    yield "cache: filled", first

    def harm(kind):
        for name, data in known["files"].items():
            path = folder / name
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink(missing_ok=True)
            changed = bytearray(data)
            if kind == "bits":
                for _ in range(r.choice([1, 3, 100])):
                    changed[r.randrange(len(changed))] ^= 1 << r.randrange(8)
            elif kind == "cut":
                del changed[r.randrange(len(changed)) :]
            elif kind == "longer":
                changed += bytes(r.randrange(1, 100))
            elif kind == "nothing":
                changed.clear()
            elif kind == "link":
                (bench.folder / "elsewhere").write_bytes(data)
                path.symlink_to(bench.folder / "elsewhere")
                continue
            elif kind == "folder":
                path.mkdir()
                continue
            path.write_bytes(changed)
            if kind == "mode":
                path.chmod(0o666)
            elif kind == "owner" and os.geteuid() == 0:
                os.chown(path, NOBODY, NOBODY)

    for k in range(max(14, moments)):
        kind = ["bits", "bits", "cut", "longer", "nothing", "link", "mode", "owner", "folder"][k % 9]

        def case(kind=kind):
            if not known.get("files"):
                return  # this build does not compile
            harm(kind)
            must(rows() == known["rows"], "other rows")
            for name, data in known["files"].items():
                path = folder / name
                if kind in ("bits", "cut", "nothing") and path.exists():
                    must(path.read_bytes() == data, f"{name} is not made anew")

        yield f"cache: {kind} {k}", case

    def two():
        shutil.rmtree(folder, ignore_errors=True)
        outs = [bench.folder / f"cached{k}.csv" for k in range(2)]
        answers = [bench.end(p) for p in [bench.start(bench.words(line, out), env=env) for out in outs]]
        must(all(code == 0 for code, _ in answers), f"{answers}")
        for out in outs:
            must(out.read_bytes() == known["rows"], "other rows")
            out.unlink()

    for k in range(3):
        yield f"cache: two processes, round {k + 1}", two


PARTS = {"signals": signals, "continue": carry_on, "disk": disk, "places": places, "pipes": pipes, "pairs": pairs, "cache": cache}


def self_test():
    """Faulty programs: one writes a file in place and cuts it, one leaves out rows, one leaves a part beside the file."""
    mistakes = 0
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench.__new__(Bench)
        bench.program, bench.folder, bench.seconds = "/bin/false", pathlib.Path(scratch), {}
        bench.unformatted = b""
        bench.known = {"simulate-csv": b"t,x\n0,1\n1,2\n2,3\n3,4\n", "plot-svg": b"<svg></svg>\n"}
        target = fresh(bench, "simulate-csv")
        for text, code, good in ((b"t,x\n0,1\n", 1, True), (b"t,x\n0,1\n1,", 1, False), (b"t,x\n0,1\n2,3\n3,4\n", 1, False), (b"t,x\n0,1\n0.5,1\n", 1, True), (b"t,x\n0,1\n", -9, False), (OLD, -9, True), (b"t,x\n0,1\n1,2\n2,3\n3,4\n", 0, True)):
            target.write_bytes(text)
            try:
                bench.judge("simulate-csv", target, code, True)
                fine = True
            except Wrong:
                fine = False
            if fine != good:
                print(f"judged {'right' if fine else 'wrong'}: {text} with exit status {code}")
                mistakes += 1
        target.unlink()
        figure = fresh(bench, "plot-svg")
        figure.write_bytes(b"<svg>")
        for what in ("cut", "more"):
            try:
                bench.judge("plot-svg", figure, 0, False)
                print(f"not found: {what}")
                mistakes += 1
            except Wrong:
                pass
            figure.write_bytes(b"<svg></svg>\n")
            (figure.parent / "fig.svg.123~").write_bytes(b"")
    print(f"{mistakes} mistakes")
    return 1 if mistakes else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--moments", type=int, default=60)
    parser.add_argument("parts", nargs="*", choices=[*PARTS, []])
    options = parser.parse_args()
    os.environ.setdefault("ANHOLON_CACHE", "")
    wrong = 0
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(os.path.abspath(options.program), scratch)
        for part in options.parts or PARTS:
            r, count, before = random.Random(part), 0, wrong
            for what, case in PARTS[part](bench, options.moments, r):
                count += 1
                try:
                    case()
                except Wrong as e:
                    wrong += 1
                    print(f"{what}: {e}", flush=True)
            print(f"{part}: {count} cases, {wrong - before} faults", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
