#!/usr/bin/env python3
"""The studio and the page of a sweep: the motion of a case has the numbers of the printed command; mistakes are reported.

usage: sweeps.py --program PROGRAM | --self-test
"""

import argparse
import base64
import collections
import csv
import json
import math
import pathlib
import re
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

from server import CASES, CONTACT, MODEL, Studio, request

TABLE = "k,x'\n4,0.5\n9,-0.25\n16,1e-3\n"


def run(program, folder, *words):
    return subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, timeout=120)


def sweep(program, folder, *words):
    done = run(program, folder, "sweep", *words, "--quiet")
    assert done.returncode == 0, done.stderr


def numbers(text):
    data = base64.b64decode(text)
    return struct.unpack(f"<{len(data) // 8}d", data)


def shown(reply):
    """The columns of a motion as the page draws them: name -> [(t, value)]."""
    case = json.loads(reply["data"])["cases"][0]
    common = numbers(case["t"])
    return {c["name"]: list(zip(numbers(c["t"]) if c.get("t") else common, numbers(c["data"]))) for c in case["columns"]}, case["rows"]


def simulated(program, folder, command, rows):
    """The rows of the same command with `simulate`: name -> {t: value}."""
    words = shlex.split(command)
    assert words[:2] == ["anholon", "report"] and words[-2] == "-o", command
    end, start = float(eval(words[words.index("--to") + 1])), float(words[words.index("--t") + 1]) if "--t" in words else 0.0
    done = run(program, folder, "simulate", *words[2:-2], "--every", f"{repr(end - start)}/{rows - 1}", "-o", "case.csv", "--quiet")
    assert done.returncode == 0, done.stderr
    with open(folder / "case.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    return {name: {float(line["t"]): float(line[name]) for line in lines} for name in lines[0]}


def differs(reply, expected):
    """The first number of the page that the run does not have, or None if it has all.

    At an event the page has two rows of one time, its sides, which lie between the rows of the run.
    """
    columns, _ = shown(reply)
    compared = 0
    for name, points in columns.items():
        times = collections.Counter(t for t, _ in points)
        for t, value in points if name in expected else []:
            if times[t] == 2 and t not in expected[name]:
                continue
            compared += 1
            if expected[name].get(t) != value:
                return f"{name} at t = {t!r} is {value!r}, and {expected[name].get(t)!r} by the command"
    return None if compared > 500 else f"{compared} numbers were compared"


# Folders of different sweeps: words, the model of a file, and cases to look at.
ASKED = {
    "a grid of initial values": (["m.toml", "--vary", "x=1:2:5", "--vary", "x'=0:1:4", "--to", "2"], MODEL, [0, 7, 19]),
    "a parameter, a method, a tolerance": (["m.toml", "--vary", "k=1,2.5,4", "--to", "3/2", "--method", "rk", "--tolerance", "1e-7", "--set", "m=2"], MODEL, [1, 2]),
    "scenarios one after the other": (["c.toml", "--vary", "case=stiff,far away / 100 %", "--vary", "m=1,3", "--t", "0.5", "--to", "2"], CASES, [0, 3]),
    "a scenario with spaces in its name": (["c.toml", "--case", "far away / 100 %", "--case", "stiff", "--vary", "m=1,3"], CASES, [1]),
    "a table": (["m.toml", "--cases", "table.csv"], MODEL, [0, 2]),
    "times of rows": (["m.toml", "--vary", "m~uniform(1,2)", "-n", "7", "--seed", "3", "--at", "0.5,1.5"], MODEL, [4]),
    "further generations": (["m.toml", "--vary", "x=1:2:4", "--refine", "2", "--refine-by", "x:0.01"], MODEL, [9]),
    "an initial velocity for all, an order": (["m.toml", "--vary", "x=1:2:4", "--qdot", "x=-0.5", "--order", "12"], MODEL, [2]),
    "a contact": (["f.toml", "--vary", "z=0.5:1:4"], CONTACT, [3]),
}


# Each test returns a list of faults.


def motions(program, folder):
    """The motion of each case has the numbers of its command; another case has other numbers."""
    found = []
    for name, (words, text, cases) in ASKED.items():
        at = folder / name.replace("/", "")
        at.mkdir()
        (at / words[0]).write_text(text)
        (at / "table.csv").write_text(TABLE)
        sweep(program, at, *words, "-o", "falls/", "--chunk", "3")
        with Studio(program, "falls", cwd=at) as s:
            for case in cases:
                status, reply = s.ask("case", str(case), edition=case + 2)
                if status != 200 or reply.get("number") != case:
                    found.append(f"{name}: case {case}: {status} {str(reply)[:300]}")
                    continue
                expected = simulated(program, at, reply["command"], shown(reply)[1]) if "contact" not in name else contact_run(program, at, reply)
                if why := differs(reply, expected):
                    found.append(f"{name}: case {case}: {why}; {reply['command']}")
            _, other = s.ask("case", "0" if cases[-1] else "1", edition=999)
            if not differs(other, expected):
                found.append(f"{name}: another case has the same motion")
    return found


def contact_run(program, folder, reply):
    """A motion with impacts has further rows, so the interval is found from its rows."""
    points = shown(reply)[0]["z"]
    interval = min(b[0] - a[0] for a, b in zip(points[:4], points[1:5]))
    return simulated(program, folder, reply["command"], round(1 / interval) + 1)


def one_mode(program, folder):
    """The command of a motion in one mode is Python code, with the folder and the number of the case."""
    (folder / "f.toml").write_text(CONTACT)
    sweep(program, folder, "f.toml", "--mode", "floor=open", "--vary", "z=0.5:1:4", "-o", "it's one/", "--chunk", "3")
    with Studio(program, "it's one", cwd=folder) as s:
        _, reply = s.ask("case", "2", edition=3)
    words = shlex.split(reply.get("command", ""))
    wanted = 'import anholon; anholon.open_sweep("it\'s one").run(2).page("case-2.html")'
    return [] if words == ["python3", "-c", wanted] else [f"the command is {words or reply}"]


def mistakes(program, folder):
    """Requests with wrong numbers, requests of strangers, and folders in which something is missing or changed."""
    found = []

    def expect(what, reply, *words):
        text = json.dumps(reply, ensure_ascii=False)
        if "error" not in reply or not all(w in text for w in words):
            found.append(f"{what}: {text[:300]}")

    (folder / "m.toml").write_text(MODEL)
    sweep(program, folder, "m.toml", "--vary", "x=1:2:5", "--vary", "x'=0:1:4", "-o", "falls/", "--chunk", "5")
    sweep(program, folder, "m.toml", "--vary", "x=1:3:5", "--vary", "x'=0:1:4", "-o", "others/", "--chunk", "5")
    sweep(program, folder, "m.toml", "--vary", "x=1:2:5", "--vary", "m=1:2:2", "--columns", "x(0),outcome", "-o", "few/")
    falls = folder / "falls"
    edition = 1
    with Studio(program, "falls/", cwd=folder) as s:

        def ask(number):
            nonlocal edition
            edition += 1
            return s.ask("case", number, edition=edition)[1]

        expect("a case behind the last", ask("20"), "there is no case 20", "from 0 to 19")
        for text in ["x", "", "-1", "1.5", "1e3", " 1", "9" * 40, "../../etc/passwd"]:
            expect(f"the number '{text}'", ask(text), "is no number of a case")
        found += strangers(s)
        for what in ["save", "check", "simulate", "model", "language"]:
            if (status := s.ask(what, "1" if what in ("save", "check", "simulate") else None)[0]) != 404:
                found.append(f"a studio of a sweep answers {what} with {status}")
        part = falls / "part-000001.parquet"
        whole = part.read_bytes()
        part.unlink()
        expect("a part that is missing", ask("7"), "the part of case 7 is missing", "part-000001.parquet")
        if "data" not in ask("2"):
            found.append("a case of another part has no motion")
        _, growing = s.ask("sweep")
        if (growing.get("parts"), growing.get("all_parts"), growing.get("all")) != (3, 4, 15):
            found.append(f"a folder that grows: {str(growing)[:200]}")
        shutil.copy(folder / "others" / part.name, part)
        expect("a part of another sweep", ask("7"), "belongs to another sweep", part.name)
        expect("the map with it", s.ask("sweep")[1], "belongs to another sweep", part.name)
        part.write_bytes(whole[: len(whole) // 2])
        expect("half a part", ask("7"), part.name)
        part.write_bytes(whole)
        if "data" not in ask("7") or s.ask("sweep")[1].get("parts") != 4:
            found.append("a part that was put back is not read")
        text = (falls / "_sweep.json").read_text()
        (falls / "_sweep.json").write_text(text.replace('"program": "anholon ', '"program": "anholon 0.0.1 before '))
        told = s.ask("sweep")[1]
        if not told.get("program", "").startswith("anholon 0.0.1") or not told.get("other_program"):
            found.append(f"a folder of another version: {told.get('program')}, {told.get('other_program')}")
        (falls / "_sweep.json").write_text(text.replace('"to": "2"', '"to": "3"'))
        expect("another request", ask("7"), "_sweep.json was changed")
        (falls / "_sweep.json").write_text("{}")
        expect("a request that is none", ask("7"), "_sweep.json")
    with Studio(program, "few", cwd=folder) as s:
        if "--set m=" not in s.ask("case", "1")[1].get("command", ""):
            found.append("a folder with few columns does not tell what varies")
    return found


def held(program, folder):
    """A page with motions has those of its cases, in single precision; Ctrl-C leaves the earlier file."""
    found = []
    (folder / "m.toml").write_text(MODEL)
    sweep(program, folder, "m.toml", "--vary", "x=1:2:9", "--vary", "x'=0:1:5", "--vary", "k=4,5", "-o", "falls/")
    done = run(program, folder, "plot", "falls/", "-o", "falls.html", "--motions", "8")
    page = (folder / "falls.html").read_text()
    motions = json.loads(re.search(r'<script type="application/json" id="motions">(.*?)</script>', page, re.S)[1])
    if done.returncode != 0 or len(motions) != 8 or len({m["number"] for m in motions}) != 8:
        found.append(f"a page with 8 motions: {done.returncode}, {done.stderr}, {[m['number'] for m in motions]}")
    with Studio(program, "falls", cwd=folder) as s:
        for edition, motion in enumerate(motions, 2):
            _, reply = s.ask("case", str(motion["number"]), edition=edition)
            expected = simulated(program, folder, reply["command"], 300)
            case = motion["data"]["cases"][0]
            times = numbers(case["t"])
            for c in case["columns"]:
                values = singles(c["data"])
                if len(values) not in (0, 300) or (c["name"] in ("x", "x'") and len(values) != 300):
                    found.append(f"case {motion['number']}: {c['name']} has {len(values)} rows")
                for t, value in zip(times, values):
                    if struct.pack("<f", expected[c["name"]].get(t, math.nan)) != struct.pack("<f", value):
                        found.append(f"case {motion['number']}: {c['name']} at t = {t} is {value}, and {expected[c['name']].get(t)} by the command")
                        break
    return found + stopped(program, folder)


def singles(text):
    data = base64.b64decode(text.removeprefix("f:"))
    return struct.unpack(f"<{len(data) // 4}f", data)


def stopped(program, folder):
    (folder / "long.toml").write_text(MODEL.replace("to = 2", "to = 2e5"))
    sweep(program, folder, "long.toml", "--vary", "x=1:2:40", "--tolerance", "1e-3", "-o", "long/")
    page = folder / "long.html"
    page.write_text("before\n")
    process = subprocess.Popen([program, "plot", "long/", "-o", "long.html", "--motions", "40"], cwd=folder, stderr=subprocess.PIPE, text=True)
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=60)
    left = sorted(p.name for p in folder.iterdir() if p.name.startswith("long.html"))
    if process.returncode != 1 or "no page was written" not in told or page.read_text() != "before\n" or left != ["long.html"]:
        return [f"Ctrl-C: status {process.returncode}, {told}, {left}"]
    return []


def strangers(s):
    """A request without a token, or from another page, gets no motion."""
    own = {"Origin": f"http://127.0.0.1:{s.port}", "X-Anholon-Page": "a", "X-Anholon-Edition": "1"}
    cases = {
        "a foreign page": (s.token, {**own, "Origin": "http://evil.example"}),
        "no origin": (s.token, {"X-Anholon-Page": "a", "X-Anholon-Edition": "1"}),
        "a wrong token": ("0" * len(s.token), own),
        "a foreign host": (s.token, {**own, "Host": f"evil.example:{s.port}"}),
        "another port": (s.token, {**own, "Origin": f"http://127.0.0.1:{s.port + 1}"}),
    }
    found = [f"{name}: status {status}" for name, (token, headers) in cases.items() if (status := request(s.port, f"/{token}/case", "1", headers)[0]) != 403]
    for what in ["sweep", ""]:
        if (status := request(s.port, f"/{s.token}/{what}", None, {"Origin": "http://evil.example"})[0]) != 403:
            found.append(f"a foreign page that reads '{what}': status {status}")
    return found


def newer(program, folder):
    """A newer click ends the computation of an older one; a motion that stops early is shown up to its end."""
    found, replies = [], {}
    (folder / "long.toml").write_text(MODEL.replace("to = 2", "to = 1e6"))
    done = run(program, folder, "sweep", "long.toml", "--vary", "x=1,2", "--most-steps", "20", "--quiet", "-o", "short/")
    assert done.returncode == 1, done.stderr
    with Studio(program, "short", cwd=folder) as s:
        status, reply = s.ask("case", "0")
        if "step limit is reached" not in json.dumps(reply.get("sections", "")) or "data" not in reply:
            found.append(f"a motion that ends after 20 steps: {status} {str(reply)[:300]}")
    sweep(program, folder, "long.toml", "--vary", "x=1,2", "--tolerance", "1e-3", "-o", "long/")
    with Studio(program, "long", cwd=folder) as s:
        thread = threading.Thread(target=lambda: replies.update(first=s.ask("case", "0", edition=2, page="one")[1]))
        thread.start()
        time.sleep(0.5)
        replies["second"] = s.ask("case", "1", edition=3, page="one")[1]
        thread.join()
        if replies["first"] != {"replaced": True}:
            found.append(f"the older click: {str(replies['first'])[:200]}")
        if replies["second"].get("number") != 1 or "data" not in replies["second"]:
            found.append(f"the newer click: {str(replies['second'])[:300]}")
    return found


def self_test():
    """A page with a number that is not the command's is found."""

    def reply(value):
        times = [k / 1000 for k in range(600)]
        values = [value if k == 300 else float(k) for k in range(600)]
        packed = [base64.b64encode(struct.pack("<600d", *list_)).decode() for list_ in (times, values)]
        return {"data": json.dumps({"cases": [{"t": packed[0], "rows": 600, "columns": [{"name": "x", "data": packed[1]}]}]})}

    expected = {"x": {k / 1000: float(k) for k in range(600)}}
    wrong = [differs(reply(300.0), expected) is not None, differs(reply(300.0000000001), expected) is None, differs(reply(300.0), {}) is None]
    print(f"{sum(wrong)} of {len(wrong)} wrong")
    return 1 if any(wrong) else 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", type=lambda p: str(pathlib.Path(p).resolve()))
    parser.add_argument("--self-test", action="store_true")
    args = parser.parse_args()
    if args.self_test:
        return self_test()
    found = []
    if not pathlib.Path("viewer/dist/studio.js").exists():
        print("skipped: the viewer is not built, and so no studio")
        return 77
    for test in [motions, one_mode, mistakes, held, newer]:
        with tempfile.TemporaryDirectory() as folder:
            began = time.monotonic()
            found += test(args.program, pathlib.Path(folder))
            print(f"{test.__name__}: {time.monotonic() - began:.1f} s")
    for f in found:
        print(f"FAULT {f}")
    print(f"{len(found)} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
