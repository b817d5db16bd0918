#!/usr/bin/env python3
"""Sweeps in folders: whatever happens to the processes, what is collected has the bytes of one quiet sweep.

    folders.py --program PROGRAM [--kills 40] [PART...]     parts: kill stop two shards disk model tables part judgement status plot watched refine page outside
    folders.py --self-test                                  a part with other numbers is noticed

Kills come at random moments. Only unfinished parts are lost, and a later process clears all files that are left.
"""

import argparse
import base64
import hashlib
import html
import json
import os
import pathlib
import random
import resource
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

SWEEP = ["sweep", "disc", "--vary", "phi'=1:7:40", "--vary", "theta=1.2,1.3,1.4,0", "--to", "5", "--quiet", "--threads", "1"]
CHUNK = ["--chunk", "8"]
PATIENCE = 300  # seconds


class Wrong(Exception):
    pass


def must(truth, what):
    if not truth:
        raise Wrong(what)


class Folders:
    def __init__(self, program, place, kills):
        self.program, self.place, self.kills = program, pathlib.Path(place), kills
        self.folder = self.place / "falls"
        quiet = self.place / "quiet.csv"
        self.run(*SWEEP, "--error-estimate", "never", "-o", str(quiet))
        self.expected = self.hash(quiet)

    def begin(self, *words, **options):
        return subprocess.Popen([self.program, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)

    def run(self, *words, status=None):
        process = self.begin(*words)
        out, error = process.communicate(timeout=PATIENCE)
        must(process.returncode in ((0, 1) if status is None else (status,)), f"{' '.join(words)}: {process.returncode}: {error}")
        return out, error

    def into(self, *words):
        return [*SWEEP, *CHUNK, "-o", str(self.folder) + "/", *words]

    @staticmethod
    def hash(path):
        return hashlib.sha256(pathlib.Path(path).read_bytes()).hexdigest()

    def check(self):
        """The folder holds the whole sweep and nothing else, with the right numbers."""
        names = sorted(os.listdir(self.folder))
        must(names == ["_judgement.json", "_sweep.json"] + [f"part-{k:06}.parquet" for k in range(20)], f"in the folder: {names}")
        collected = self.place / "all.csv"
        self.run("sweep", "collect", str(self.folder), "--quiet", "-o", str(collected), status=0)
        must(self.hash(collected) == self.expected, "what was collected has other bytes")
        shutil.rmtree(self.folder)

    def kill(self):
        """kill -9 at random moments; the same command continues."""
        for _ in range(self.kills):
            process = self.begin(*self.into())
            time.sleep(random.uniform(0, 0.25))
            process.kill()
            process.communicate()
            if (self.folder / "_sweep.json").exists():
                self.run("sweep", "status", str(self.folder))
        self.run(*self.into())
        self.check()

    def stop(self):
        """A process is stopped while another one computes its part: its late commit does no harm."""
        process = self.begin(*self.into("--shard", "1/1"))
        time.sleep(0.2)
        process.send_signal(signal.SIGSTOP)
        self.run(*self.into())
        process.send_signal(signal.SIGCONT)
        out, error = process.communicate(timeout=PATIENCE)
        must(process.returncode in (0, 1), f"the late process: {process.returncode}: {out}{error}")
        self.check()

    def two(self):
        """Two processes share one folder; each computes the parts that the other has not computed."""
        processes = [self.begin(*self.into()) for _ in range(2)]
        for process in processes:
            _, error = process.communicate(timeout=PATIENCE)
            must(process.returncode in (0, 1), error)
        self.check()

    def shards(self):
        """Three shares; one is killed and started anew."""
        processes = [self.begin(*self.into("--shard", f"{k}/3")) for k in (1, 2, 3)]
        time.sleep(0.2)
        processes[1].kill()
        for process in processes:
            process.communicate(timeout=PATIENCE)
        self.run(*self.into("--shard", "2/3"))
        self.check()
        _, error = self.run(*self.into("--shard", "4/3"), status=2)
        must("--shard takes a share" in error, error)

    def disk(self):
        """A full disk, made by a limit on the size of files; then there is room again."""
        limited = ["bash", "-c", 'ulimit -f 1; trap "" XFSZ; exec "$0" "$@"', self.program, *self.into()]
        done = subprocess.run(limited, capture_output=True, text=True, timeout=PATIENCE, check=False)
        must(done.returncode == 2 and "cannot write" in done.stderr, f"{done.returncode}: {done.stderr}")
        must(not [name for name in os.listdir(self.folder) if name.startswith("part-")], "a part that is not whole")
        self.run(*self.into())
        self.check()

    def model(self):
        """Other options, another model or a foreign folder are named, and nothing is overwritten."""
        self.run(*self.into())
        before = {p.name: self.hash(p) for p in self.folder.iterdir()}
        for words, word in [(["--tolerance", "1e-9"], "tolerance"), (["--set", "m=2"], "set"), (["--to", "6"], "to")]:
            _, error = self.run(*[w for w in self.into() if word != "to" or w not in ("--to", "5")], *words, status=2)
            must("holds another sweep" in error and word in error, error)
        _, error = self.run(*[w if w != "disc" else "rolling-coin" for w in self.into()], status=2)
        must({p.name: self.hash(p) for p in self.folder.iterdir()} == before, "the folder was changed")
        self.check()
        self.folder.mkdir()
        (self.folder / "thesis.tex").write_text("text")
        _, error = self.run(*self.into(), status=2)
        must("holds other files ('thesis.tex')" in error, error)
        shutil.rmtree(self.folder)
        _, error = self.run("sweep", "status", str(self.folder), status=2)
        must("is no folder of a sweep" in error, error)

    def tables(self):
        """The data file of a table belongs to the request, and the folder keeps it."""
        model, data = self.place / "cart.toml", self.place / "thrust.csv"
        model.write_text(
            'coordinates = ["x"]\nparameters.k = 1\nparticle = [{name = "p", mass = 1, position = "x*ex"}]\n'
            'table = [{name = "f", file = "thrust.csv"}]\nforce = [{on = "p", vector = "(f(t) - k*x)*ex"}]\ninitial.x = 1\n'
        )
        data.write_text("0,1\n3,2\n6,-1\n")
        words = ["sweep", str(model), "--vary", "k=1:3:4", "--to", "6", "--chunk", "1", "--quiet", "-o", f"{self.folder}/"]
        self.run(*words, status=0)
        part = self.folder / "part-000001.parquet"
        before = part.read_bytes()
        part.unlink()
        data.write_text("0,1\n3,-2\n6,-1\n")
        _, error = self.run(*words, status=2)
        must("holds another sweep: data file thrust.csv differs" in error and not part.exists(), error)
        data.write_text("0,1\n3,2\n6,-1\n")
        self.run(*words, status=0)
        must(part.read_bytes() == before, "the part has other bytes")
        data.unlink()
        model.unlink()
        page = self.place / "page.html"
        self.run("plot", str(self.folder), "x", "--motions", "2", "-o", str(page), status=0)
        motions = page.read_text().split('<script type="application/json" id="motions">')[1].split("</script>")[0]
        must(len(json.loads(motions)) == 2, "no motions")
        shutil.rmtree(self.folder)

    def part(self):
        """A part that was changed by hand is named; without it the command computes it again."""
        self.run(*self.into())
        part = self.folder / "part-000007.parquet"
        text = bytearray(part.read_bytes())
        text[40] ^= 1
        part.write_bytes(text)
        _, error = self.run("sweep", "collect", str(self.folder), "-o", str(self.place / "none.csv"), status=2)
        must("part-000007.parquet: the numbers of the file are not those that were written" in error, error)
        part.unlink()
        _, error = self.run("sweep", "collect", str(self.folder), "-o", str(self.place / "none.csv"), status=2)
        must("1 of 20 parts are missing" in error, error)
        self.run("sweep", "collect", str(self.folder), "--partial", "-o", str(self.place / "some.csv"), status=0)
        self.run(*self.into())
        self.check()

    def judgement(self):
        """A damaged judgement is named; without it the command judges again."""
        self.run(*self.into())
        judgement = self.folder / "_judgement.json"
        before = judgement.read_bytes()
        for wrong in ("garbage", "", "{}", "[]"):
            judgement.write_text(wrong)
            for words in (["sweep", "status", str(self.folder)], ["sweep", "status", str(self.folder), "--json"], self.into()):
                _, error = self.run(*words, status=2)
                must("_judgement.json is damaged" in error and "remove it" in error, error)
        judgement.unlink()
        self.run(*self.into())
        must(judgement.read_bytes() == before, "another judgement")
        self.check()

    def status(self):
        """The status of a folder, for any process that sees it."""
        self.run(*self.into("--shard", "1/2"))
        out, _ = self.run("sweep", "status", str(self.folder), "--json", status=1)
        told = json.loads(out)
        must(told["parts"] == 10 and told["all_parts"] == 20 and told["cases"] == 80, out)
        must(sum(told["outcomes"].values()) == 80 and set(told["outcomes"]) >= {"finished"} and "judgement" not in told, out)
        self.run(*self.into())
        self.run("sweep", "status", str(self.folder), status=0)
        # The judgement equals that of a sweep without a folder.
        told = json.loads(self.run("sweep", "status", str(self.folder), "--json", status=0)[0])["judgement"]
        alone = json.loads(self.run(*[w for w in SWEEP if w != "--quiet"], "--json")[0])
        must(told["error_estimate"] == alone["error_estimate"] and told["residuals"] == alone["residuals"], f"{told}\n{alone['residuals']}")
        must(told["residuals"]["checked"] and told["residuals"]["newton"]["worst"] < 1e-9, str(told))
        # The report of a collected file agrees as well, and so do the reasons why cases stopped.
        report, _ = self.run(*[w for w in SWEEP if w != "--quiet"], "--json")
        must(self.run("sweep", "collect", str(self.folder), "--json", status=0)[0] == report, "the JSON of collect differs")
        stopped = json.loads(report)["stopped"]
        must(len(stopped) > 0 and sum(s["cases"] for s in stopped) == 40 and stopped[0]["first"] == 3, str(stopped))
        must(json.loads(self.run("sweep", "status", str(self.folder), "--json", status=0)[0])["stopped"] == stopped, "status tells other reasons")
        line = f"stopped ({stopped[0]['outcome']}), 40 cases, first case 3: {stopped[0]['message']}\nhint: {stopped[0]['hint']}"
        for out in (self.run("sweep", "status", str(self.folder))[0], self.run("sweep", "collect", str(self.folder))[1], self.run(*self.into())[1]):
            must(line in out, out)
        self.check()


    def plot(self):
        """Pictures of a folder are the same for the same cases; mistakes are named."""
        self.run(*self.into())
        pictures = []
        for name in ("outcome", "theta"):
            for k in range(2):
                path = self.place / f"{name}{k}.svg"
                self.run("plot", str(self.folder), name, "-o", str(path), status=0)
                pictures.append(path.read_text())
        must(pictures[0] == pictures[1] and pictures[2] == pictures[3] != pictures[0], "the pictures differ")
        must("finished" in pictures[0] and pictures[0].count("<rect") >= 4, "no cells, or no legend")
        # The files of a sweep give the same picture except for units, which the model gives.
        for name in ("cases.csv", "cases.parquet"):
            self.run("sweep", "collect", str(self.folder), "--quiet", "-o", str(self.place / name), status=0)
            self.run("plot", str(self.place / name), "theta", "-o", str(self.place / "file.svg"), status=0)
            cells = [text[text.index("<rect") : text.rindex("<rect")] for text in (pictures[2], (self.place / "file.svg").read_text())]
            must(cells[0] == cells[1], f"{name} has other cells than the folder")
            self.run("plot", str(self.place / name), "--histogram", "outcome", "-o", str(self.place / "h.svg"), status=0)
            must("finished" in (self.place / "h.svg").read_text(), "the histogram names no outcome")
        for words, message in [
            (["lean", "-o", "x.svg"], "has no column 'lean'"),
            (["outcome"], "a sweep is drawn as .svg"),
            (["outcome", "--y", "mass", "-o", "x.svg"], "has no column 'mass'"),
            (["--histogram", "lean", "-o", "x.svg"], "has no column 'lean'"),
            (["theta", "--histogram", "x", "-o", "x.svg"], "a histogram shows one column"),
        ]:
            _, error = self.run("plot", str(self.folder), *words, status=2)
            must(message in error, error)
        self.check()

    def watched(self):
        """Another process watches until the sweep is complete."""
        self.run(*self.into("--shard", "1/2"))
        watcher = self.begin("sweep", "status", str(self.folder), "--watch")
        time.sleep(0.3)
        self.run(*self.into())
        out, error = watcher.communicate(timeout=PATIENCE)
        lines = out.splitlines()
        must(watcher.returncode == 0 and lines[0].startswith("10 of 20 parts, 80 of 160 cases"), out + error)
        must(any(line.startswith("20 of 20 parts, 160 of 160 cases") for line in lines), out)
        self.check()


    REFINED = ["sweep", "disc", "--vary", "phi'=1:7:13", "--vary", "theta=0.2:1.4:9", "--to", "3", "--quiet"]

    def refined(self, folder, *words, rule="theta:0.25"):
        return [*self.REFINED, "-o", str(folder) + "/", *words, *(["--refine-by", rule] if rule else [])]

    # Each of these begins a process, does one thing to it after some seconds, and returns whether the process was
    # still at work then.

    def kill_one(self, words, seconds):
        process = self.begin(*words)
        time.sleep(seconds)
        at_work = process.poll() is None
        process.kill()
        process.communicate()
        return at_work

    def stop_one(self, words, seconds):
        """Another process completes the folder in the meantime."""
        process = self.begin(*words)
        time.sleep(seconds)
        at_work = process.poll() is None
        process.send_signal(signal.SIGSTOP)
        self.run(*words, status=0)
        process.send_signal(signal.SIGCONT)
        _, error = process.communicate(timeout=PATIENCE)
        must(process.returncode == 0, f"the late process: {process.returncode}: {error}")
        return at_work

    def disk_one(self, words, seconds):
        """From then on the process can write no file of more than 1 kB."""
        process = subprocess.Popen(
            ["bash", "-c", 'trap "" XFSZ; exec "$0" "$@"', self.program, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        time.sleep(seconds)
        try:
            resource.prlimit(process.pid, resource.RLIMIT_FSIZE, (1024, 1024))
        except ProcessLookupError:
            pass  # it was faster
        _, error = process.communicate(timeout=PATIENCE)
        must(process.returncode == 0 or (process.returncode == 2 and "cannot write" in error), f"{process.returncode}: {error}")
        return process.returncode == 2

    def refine(self):
        """Generations at borders: the cases are the same after kills, with other parts, threads and shares, and as those of a single sweep."""
        quiet, all_of = self.place / "quiet", self.place / "refined.csv"
        self.run(*self.refined(quiet, "--refine", "3", "--chunk", "1000"), status=0)

        def collected(folder):
            self.run("sweep", "collect", str(folder), "--quiet", "-o", str(all_of), status=0)
            return self.hash(all_of)

        expected = collected(quiet)
        small = self.refined(self.folder, "--refine", "3", "--chunk", "5", "--threads", "1")
        begin = time.monotonic()
        self.run(*small, status=0)
        takes = time.monotonic() - begin
        shutil.rmtree(self.folder)
        happened = {"kill": 0, "stop": 0, "disk": 0}
        for _ in range(self.kills):
            how = random.choice(list(happened))
            happened[how] += getattr(self, f"{how}_one")(small, random.uniform(0, takes))
            if how == "stop":
                must(collected(self.folder) == expected, "after a late commit the cases are others")
                shutil.rmtree(self.folder)
        print(f"refine: {happened['kill']} kills, {happened['stop']} stops and {happened['disk']} full disks in a run of {takes:.1f} s")
        self.run(*small, status=0)
        must(collected(self.folder) == expected, "after kills, stops and full disks the cases are others")
        names = os.listdir(self.folder)
        must(not any(name.startswith(".tmp") for name in names) and sum(name.startswith("_gen") for name in names) == 3, f"{sorted(names)}")
        told = json.loads(self.run("sweep", "status", str(self.folder), "--json", status=0)[0])
        generations = told["generations"]
        must(len(generations) == 4 and generations[0]["cases"] == 117 and all(g["parts"] == g["all_parts"] > 0 for g in generations), str(told))
        must(sum(g["cases"] for g in generations) == told["cases"] and generations[1]["first_case"] == 117, str(told))
        shutil.rmtree(self.folder)

        # Each share computes as much as it can; the next round begins the next generation.
        for _ in range(4):
            for share in ("1/2", "2/2"):
                self.run(*self.refined(self.folder, "--refine", "3", "--chunk", "7", "--shard", share))
        must(collected(self.folder) == expected, "shares have other cases")

        # The last case has the result of its own numbers.
        header, *rows = all_of.read_text().splitlines()
        table, alone = self.place / "one.csv", self.place / "one-out.csv"
        table.write_text("phi',theta\n" + ",".join(rows[-1].split(",")[1:3]) + "\n")
        self.run("sweep", "disc", "--cases", str(table), "--to", "3", "--quiet", "--error-estimate", "never", "-o", str(alone), status=0)
        must(alone.read_text().splitlines()[1].split(",")[1:] == rows[-1].split(",")[1:], "a refined case has other numbers than alone")

        # Another rule, no grid, and a changed plan are refused.
        for generations in "4", "3", "1":
            _, error = self.run(*self.refined(self.folder, "--refine", generations, rule="theta:0.2"), status=2)
            must("refined by 'theta:0.25', not by 'theta:0.2'" in error, error)
        _, error = self.run(*self.refined(self.folder, "--refine", "2", rule=""), status=2)
        must("refined by 'theta:0.25', not by these alone" in error, error)
        for words, rule, message in [
            (["--vary", "m~normal(1,0.1)", "-n", "200"], "", "lies no grid"),
            (["--vary", "m=1,3,2"], "", "neither ascend nor descend"),
            (["--columns", "theta"], "", "without the column 'outcome'"),
            (["--columns", "theta"], "theta:1", None),
            ([], "outcome:1", "the column 'outcome' holds words"),
            (["--columns", "phi"], "theta:1", "keeps no column 'theta'"),
            ([], "thta:1", "did you mean 'theta'"),
            ([], "theta", "COLUMN:BOUND"),
            (["--refine", "31"], "", "--refine takes a number of generations"),
        ]:
            shutil.rmtree(self.place / "no", ignore_errors=True)
            generations = [] if "--refine" in words else ["--refine", "1"]
            _, error = self.run(*self.refined(self.place / "no", *generations, *words, rule=rule), status=2 if message else 0)
            must(message is None or message in error, error)
        plan = self.folder / "_generation-02.parquet"
        text = bytearray(plan.read_bytes())
        text[40] ^= 1
        plan.write_bytes(text)
        (self.folder / "part-000020.parquet").unlink()
        _, error = self.run(*self.refined(self.folder, "--refine", "3"), status=2)
        must("_generation-02.parquet" in error, error)
        shutil.rmtree(self.folder)


    def page(self):
        """The page of a refined folder holds the numbers of all cases; the command that a click shows computes the motion of its case."""
        spin = ["--set", "m=2", "--qdot", "psi=0.1"]
        self.run(*self.refined(self.folder, "--refine", "1", *spin), status=0)
        page, all_of = self.place / "page.html", self.place / "cases.csv"
        self.run("plot", str(self.folder), "theta", "-o", str(page), status=0)
        self.run("sweep", "collect", str(self.folder), "--quiet", "-o", str(all_of), status=0)
        text = page.read_text()
        must("http://" not in text and "https://" not in text, "the page refers to a network")
        data = json.loads(text.split('<script type="application/json" id="data">')[1].split("</script>")[0])
        header, *rows = [line.split(",") for line in all_of.read_text().splitlines()]
        for k, name in enumerate(header):
            column = data["columns"][k]
            values = struct.unpack(f"<{len(rows)}d", base64.b64decode(column["data"]))
            written = [column["words"][int(v)] for v in values] if column["words"] else list(values)
            must(column["name"] == name and written == [row[k] if column["words"] else float(row[k]) for row in rows], f"{name} differs")
        cells = struct.unpack(f"<{4 * len(rows)}d", base64.b64decode(data["cells"]))
        must(abs((cells[-3] - cells[-4]) * 2 - (cells[1] - cells[0])) < 1e-12, "the cells of the last generation are not half as wide")
        browser = shutil.which("chromium")
        if not browser:
            print("page: chromium is missing, so that no cell is clicked")
        else:
            click = """<script>setTimeout(() => { const c = document.querySelector("canvas"), r = c.getBoundingClientRect();
              c.dispatchEvent(new MouseEvent("click", {clientX: r.left + 150, clientY: r.top + 60})); }, 300)</script></body>"""
            page.write_text(text.replace("</body>", click))
            words = [browser, "--headless", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=3000", "--dump-dom", page.as_uri()]
            shown = subprocess.run(words, capture_output=True, text=True, timeout=PATIENCE, check=False).stdout
            must('<pre class="command">anholon report disc' in shown, f"no command: {shown[-500:]}")
            words = shlex.split(html.unescape(shown.split('<pre class="command">')[1].split("</pre>")[0]))
            number = int(words[-1].removeprefix("case-").removesuffix(".html"))
            motion = self.place / "motion.csv"
            self.run("simulate", *words[2:-2], "--at", "3", "-o", str(motion), status=0)
            alone = dict(zip(*[line.split(",") for line in motion.read_text().splitlines()]))
            row = dict(zip(header, rows[number]))
            must(all(abs(float(alone[name]) - float(row[name])) < 1e-6 for name in ("theta", "x", "psi'")), f"{alone}\n{row}")
            must(float(row["phi'(0)"]) < 4 and float(row["theta(0)"]) > 1, "another cell was clicked")
        shutil.rmtree(self.folder)


    def outside(self):
        """Mistakes made by other programs are named, and nothing is overwritten."""
        self.run(*self.into())
        part, request = self.folder / "part-000001.parquet", self.folder / "_sweep.json"
        whole, text = part.read_bytes(), request.read_text()
        for wrong, message in [(whole[:1000], "no whole Parquet file"), (b"", "no whole Parquet file")]:
            part.write_bytes(wrong)
            _, error = self.run("sweep", "status", str(self.folder), status=2)
            must("part-000001.parquet" in error and message in error, error)
        part.write_bytes((self.folder / "part-000000.parquet").read_bytes())
        for words in (["status"], ["collect", "-o", str(self.place / "none.csv")]):
            _, error = self.run("sweep", words[0], str(self.folder), *words[1:], status=2)
            must("part-000001.parquet belongs to another sweep" in error, error)
        part.write_bytes(whole)
        for wrong in ["", "{", "[]", text[:300], '{"format": "anholon sweep", "format_version": 1, "cases": -3, "chunk": 1}']:
            request.write_text(wrong)
            for words in (["sweep", "status", str(self.folder)], self.into(), ["plot", str(self.folder), "-o", "x.svg"]):
                _, error = self.run(*words, status=2)
                must("_sweep.json" in error and ("does not tell of a sweep" in error or "is damaged" in error), error)
            must(request.read_text() == wrong, "a damaged file was overwritten")
        request.unlink()
        _, error = self.run(*self.into(), status=2)
        must("its _sweep.json is missing" in error, error)
        # The folder of an earlier version has its request under another name, and another program made it.
        older = self.folder / "sweep.json"
        older.write_text(text.replace('"program": "anholon ', '"program": "anholon 0.0.1 before '))
        part.unlink()
        self.run("sweep", "status", str(self.folder), status=1)
        _, error = self.run(*self.into())
        must("was made by anholon 0.0.1 before" in error and part.read_bytes() == whole, error)
        _, error = self.run(*self.into())
        must("was made by" not in error, error)
        must(not request.exists(), "a second request")
        older.unlink()
        request.write_text(text)
        self.check()
        for share in ("3/2", "0/2", "1/0", "a/b", "1", "-1/2", "1/2/3", "99999999999999999999/2"):
            _, error = self.run(*self.into(f"--shard={share}"), status=2)
            must("--shard takes a share" in error, error)
        _, error = self.run("sweep", "disc", "--vary", "phi'=1:7:1000000", "--vary", "m=1:2:1000000", "--to", "1", "--chunk", "1", "-o", f"{self.folder}/", status=2)
        must("more than 10000000 parts" in error and not self.folder.exists(), error)
        table = self.place / "table.csv"
        for wrong, message in [
            ("phi',mm\n1,2\n", "did you mean 'm'"),
            ("phi',m\n1,2\n3\n", "the line has 1 cell"),
            ("m (kg)\n1\n", "a unit belongs to each number"),
            ("", "is empty"),
        ]:
            table.write_text(wrong)
            _, error = self.run("sweep", "disc", "--cases", str(table), "--to", "1", "-o", f"{self.folder}/", status=2)
            must(message in error and not self.folder.exists(), error)


PARTS = ["kill", "stop", "two", "shards", "disk", "model", "tables", "part", "judgement", "status", "plot", "watched", "refine", "page", "outside"]


def run_parts(arguments):
    with tempfile.TemporaryDirectory() as place:
        folders = Folders(os.path.abspath(arguments.program), place, arguments.kills)
        for name in arguments.parts or PARTS:
            try:
                getattr(folders, name)()
            except Wrong as wrong:
                print(f"{name}: {wrong}")
                return 1
            print(f"{name}: as expected")
    return 0


def self_test(arguments):
    """The comparison of bytes has to find a part with the numbers of another sweep."""
    with tempfile.TemporaryDirectory() as place:
        folders = Folders(os.path.abspath(arguments.program), place, 1)
        folders.expected = "0" * 64
        folders.run(*folders.into())
        try:
            folders.check()
        except Wrong:
            print("other bytes are found")
            return 0
    return 1


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--kills", type=int, default=40 if os.environ.get("ANHOLON_LONG") else 4)
    parser.add_argument("--self-test", action="store_true")
    parser.add_argument("parts", nargs="*")
    arguments = parser.parse_args()
    return self_test(arguments) if arguments.self_test else run_parts(arguments)


if __name__ == "__main__":
    sys.exit(main())
