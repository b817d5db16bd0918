#!/usr/bin/env python3
"""The server of `anholon studio`: who may talk to it, what a text may do, and how it ends.

usage: server.py --program PROGRAM | --self-test
"""

import argparse
import http.client
import http.server
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import urllib.parse

MODEL = """title = "A mass on a spring"
coordinates = ["x"]
[parameters]
m = 1
k = 4
[[particle]]
name = "P"
mass = "m"
position = "x*ex"
[potential]
spring = "k*x^2/2"
[initial]
x = 1
"x'" = 0
[simulate]
to = 2
"""


class Studio:
    """A studio of a file, and requests to it."""

    def __init__(self, program, *arguments, cwd=None):
        self.process = subprocess.Popen([program, "studio", *arguments, "--no-browser", "--quiet"], stdout=subprocess.PIPE, text=True, cwd=cwd, env={**os.environ, "ANHOLON_CACHE": ""})
        self.address = self.process.stdout.readline().strip()
        assert self.address.startswith("http://127.0.0.1:"), self.address
        self.port = int(self.address.split(":")[2].split("/")[0])
        self.token = self.address.split("/")[3]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            self.process.wait(20)
        self.process.stdout.close()

    def ask(self, what, text=None, edition=1, page="test", timeout=90, case="", known=""):
        origin = f"http://127.0.0.1:{self.port}"
        headers = {"Origin": origin, "X-Anholon-Page": page, "X-Anholon-Edition": str(edition), "X-Anholon-Case": urllib.parse.quote(case), "X-Anholon-Known": known} if text is not None else {}
        status, body = request(self.port, f"/{self.token}/{what}", text, headers, timeout)
        return status, json.loads(body) if body.startswith("{") else body


def request(port, path, text=None, headers=(), timeout=90):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=timeout)
    try:
        connection.request("POST" if text is not None else "GET", path, text.encode() if text is not None else None, dict(headers))
        reply = connection.getresponse()
        return reply.status, reply.read().decode()
    finally:
        connection.close()


SOCKET = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA=="}


# Each function returns a list of faults.


def strangers(port, token):
    """Requests that must be refused before anything is computed or shown."""
    own = f"http://127.0.0.1:{port}"
    good = {"Origin": own, "X-Anholon-Page": "a", "X-Anholon-Edition": "1"}
    wrong = "0" * len(token)
    cases = {
        "no token": ("/", None, {}),
        "a wrong token": (f"/{wrong}/", None, {}),
        "the beginning of the token": (f"/{token[:-1]}/", None, {}),
        "a wrong token to compute": (f"/{wrong}/check", MODEL, good),
        "a foreign host": (f"/{token}/", None, {"Host": f"evil.example:{port}"}),
        "a foreign host with the name of ours": (f"/{token}/", None, {"Host": f"127.0.0.1:{port}.evil.example"}),
        "a name that was made to mean this machine": (f"/{token}/check", MODEL, {**good, "Host": f"rebound.example:{port}", "Origin": f"http://rebound.example:{port}"}),
        "a web socket without a token": ("/", None, {**SOCKET, "Origin": own}),
        "a web socket of a foreign page": (f"/{token}/", None, {**SOCKET, "Origin": "http://evil.example"}),
        "a foreign page that reads": (f"/{token}/model", None, {"Origin": "http://evil.example"}),
        "a foreign page": (f"/{token}/check", MODEL, {**good, "Origin": "http://evil.example"}),
        "another port of this machine": (f"/{token}/check", MODEL, {**good, "Origin": f"http://127.0.0.1:{port + 1}"}),
        "a page without an address": (f"/{token}/check", MODEL, {**good, "Origin": "null"}),
        "no origin": (f"/{token}/save", MODEL, {}),
        "a request across sites": (f"/{token}/check", MODEL, {**good, "Sec-Fetch-Site": "cross-site"}),
    }
    found = []
    for name, (path, text, headers) in cases.items():
        status, body = request(port, path, text, headers)
        if status != 403 or token in body:
            found.append(f"{name}: status {status}")
    return found


def paths(port, token):
    """Only the pages of the studio have an address."""
    found = []
    for path in ["../model", "../../etc/passwd", "/etc/passwd", "%2e%2e/%2e%2e/etc/passwd", "studio.js/../../x", "model.toml", "..%5c..%5cx", "model?x", "."]:
        status, body = request(port, f"/{token}/{path}")
        if status != 404 or "root:" in body:
            found.append(f"{path}: status {status}")
    status, body = request(port, f"/{token}")
    if status != 200 or f"url={token}/" not in body:
        found.append(f"the address without its last slash: status {status}")
    headers = {"Origin": f"http://127.0.0.1:{port}"}
    for path in ["save/../../stolen.toml", "save?file=stolen.toml", "save/%2e%2e%2fstolen.toml", "save-anyway/stolen.toml", "..%2fsave"]:
        status, _ = request(port, f"/{token}/{path}", MODEL, headers)
        if status != 404:
            found.append(f"saving to {path}: status {status}")
    return found


def sizes(port, token):
    """A body that is too long is refused, and so is one without an end."""
    found = []
    headers = {"Origin": f"http://127.0.0.1:{port}", "X-Anholon-Page": "a", "X-Anholon-Edition": "1"}
    try:
        status = request(port, f"/{token}/check", "#" * (3 << 20), headers)[0]
    except (BrokenPipeError, ConnectionResetError):
        status = 413
    if status != 413:
        found.append(f"3 MiB: status {status}")
    if (status := request(port, f"/{token}/check", "#" * (1 << 19), headers)[0]) != 200:
        found.append(f"half a MiB: status {status}")
    with socket.create_connection(("127.0.0.1", port), timeout=30) as s:
        s.sendall(f"POST /{token}/check HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nOrigin: http://127.0.0.1:{port}\r\nTransfer-Encoding: chunked\r\n\r\n".encode())
        sent, got = 0, b""
        try:
            while sent < 64 << 20:
                s.sendall(b"10000\r\n" + b"#" * 0x10000 + b"\r\n")
                sent += 0x10000
        except OSError:
            pass
        try:
            got = s.recv(64)
        except OSError:
            got = b" 413 "  # the connection was closed
        if b" 413 " not in got or sent >= 64 << 20:
            found.append(f"a body without an end: {sent} bytes were taken, {got!r}")
    with socket.create_connection(("127.0.0.1", port), timeout=30) as s:
        s.sendall(b"GET /" + b"x" * 100000 + b" HTTP/1.1\r\n\r\n")
        if b" 200 " in s.recv(64):
            found.append("a head of 100 kB")
    return found


def files(studio, folder):
    """A text reads no file that the model did not name when it was opened."""
    found = []
    secret = folder / "secret.csv"
    secret.write_text("1,7654321\n2,7654322\n3,7654323\n")
    texts = {
        "base": f'base = "{secret}"\n',
        "a relative base": 'base = "secret.csv"\n' + MODEL,
        "base in a case": MODEL + f'[case.a]\nbase = "{secret}"\n',
        "a table": MODEL + f'[[table]]\nname = "f"\nfile = "{secret}"\n[define]\ny = "f(x)"\n',
    }
    for name, text in texts.items():
        for what in ["check", "simulate"]:
            _, reply = studio.ask(what, text)
            shown = json.dumps(reply)
            if "76543" in shown or "reads only files" not in shown:
                found.append(f"{name}, {what}: {shown[:200]}")
    return found


def gates(port, token):
    return strangers(port, token) + paths(port, token) + sizes(port, token)


def works(studio):
    found = []
    _, checked = studio.ask("check", MODEL)
    if checked.get("diagnostics") != [] or {"name": "x", "what": "coordinate"} not in checked.get("names", []):
        found.append(f"check: {checked}")
    _, bad = studio.ask("check", MODEL.replace('"k*x^2/2"', '"k*y^2/2"'))
    lines = [d["line"] for d in bad.get("diagnostics", [])]
    if lines != [11]:
        found.append(f"the mistake in line 11 is reported at {lines}")
    _, motion = studio.ask("simulate", MODEL)
    if "columns" not in motion.get("data", ""):
        found.append(f"simulate: {str(motion)[:200]}")
    _, derived = studio.ask("derive", MODEL)
    if "<math" not in json.dumps(derived):
        found.append(f"derive: {str(derived)[:200]}")
    _, proof = studio.ask("prove", MODEL)
    if "confirmed" not in json.dumps(proof) and "proved" not in json.dumps(proof):
        found.append(f"prove: {str(proof)[:200]}")
    _, proof = studio.ask("prove", MODEL.replace("[simulate]\nto = 2\n", ""))
    if "maggi: proved equal" not in json.dumps(proof):
        found.append(f"the proof for a model without an end of its motion: {str(proof)[:200]}")
    return found


CASES = MODEL + '''[case.stiff]
parameters = {k = 400}
[case."far away / 100 %"]
initial = {x = 3}
'''
CONTACT = '''title = "Ball over a floor"
coordinates = ["z"]
parameters = {m = 1, g = 9.81}
gravity.field = "-g*ez"
particle = [{name = "ball", mass = "m", position = "z*ez"}]
contact = [{name = "floor", gap = "z", restitution = 0.5}]
initial = {z = 1}
simulate = {to = 1}
'''


def cases(studio):
    """A chosen case is applied to the motion; an unknown name gives a message."""
    found = []
    _, checked = studio.ask("check", CASES)
    if checked.get("cases") != ["stiff", "far away / 100 %"]:
        found.append(f"the cases: {checked}")
    first = {}
    for case in ["", "stiff", "far away / 100 %", ""]:
        _, motion = studio.ask("simulate", CASES, case=case)
        if "data" not in motion:
            found.append(f"case '{case}': {str(motion)[:200]}")
        elif first.setdefault(case, motion["data"]) != motion["data"]:
            found.append(f"case '{case}' gives two motions")
    if len(set(first.values())) != 3:
        found.append("a case does not change the motion")
    for case in ["stif", "../../etc/passwd", "a\r\nSet-Cookie: x", "x" * 8000, "%"]:
        status, reply = studio.ask("check", CASES, case=case)
        if status != 200 or "there is no case" not in json.dumps(reply) or "choose none" not in json.dumps(reply) or "--case" in json.dumps(reply):
            found.append(f"case {case[:20]!r}: {status} {str(reply)[:200]}")
    return found


def contacts(studio):
    """The mistakes of a model with contacts are messages; its motion is refused with the command that computes it."""
    found = []
    _, checked = studio.ask("check", CONTACT)
    if checked.get("diagnostics") != []:
        found.append(f"a floor: {checked}")
    _, bad = studio.ask("check", CONTACT.replace('gap = "z"', 'gap = "zz"'))
    if [d["line"] for d in bad.get("diagnostics", [])] != [6]:
        found.append(f"the mistake in line 6: {bad}")
    _, motion = studio.ask("simulate", CONTACT)
    if "no motions with contacts" not in json.dumps(motion) or "anholon simulate" not in json.dumps(motion):
        found.append(f"the motion with a contact: {str(motion)[:200]}")
    _, derived = studio.ask("derive", CONTACT)
    if "<math" in json.dumps(derived) or "equations of its own" not in json.dumps(derived):
        found.append(f"equations that leave out a contact: {str(derived)[:200]}")
    return found


def hostile(studio):
    """Texts that need too much: each has an answer within its time, and the studio works afterwards."""
    found = []
    texts = {
        "a motion without an end": ("simulate", MODEL.replace("to = 2", "to = 1e7"), "interrupted"),
        "a row each nanosecond": ("simulate", MODEL.replace("to = 2", "to = 1e9\nevery = 1e-9"), "error"),
        "a name of a megabyte": ("check", MODEL.replace('"P"', '"' + "P" * 900000 + '"'), ""),
        "brackets": ("check", MODEL.replace('"k*x^2/2"', '"' + "(" * 200000 + '"'), ""),
        "powers": ("simulate", MODEL.replace('"k*x^2/2"', '"((((((x+k)^99+m)^99+k)^99+m)^99+k)^99+m)^99"'), ""),
        "a chain of thousands": ("prove", MODEL.replace('coordinates = ["x"]', 'coordinates = ["x", "y[i]"]\n[index]\ni = "1..5000"'), ""),
    }
    for name, (what, text, word) in texts.items():
        began = time.monotonic()
        status, reply = studio.ask(what, text)
        if status != 200 or word not in json.dumps(reply) or time.monotonic() - began > 70:
            found.append(f"{name}: {status} after {time.monotonic() - began:.1f} s, {str(reply)[:200]}")
    return found + works(studio)


def editions(studio):
    """A newer text ends the computation of an older one; a text of another page does not."""
    slow = MODEL.replace("to = 2", "to = 1e7")
    replies = {}

    def first():
        replies["first"] = studio.ask("simulate", slow, edition=1, page="one")[1]

    thread = threading.Thread(target=first)
    thread.start()
    time.sleep(0.5)
    began = time.monotonic()
    _, second = studio.ask("simulate", MODEL, edition=2, page="one")
    waited = time.monotonic() - began
    thread.join()
    found = []
    if replies["first"] != {"replaced": True} or "data" not in second or waited > 5:
        found.append(f"the older text: {str(replies['first'])[:100]}, the newer after {waited:.1f} s: {str(second)[:100]}")
    if studio.ask("check", MODEL, edition=1, page="one")[1] != {"replaced": True}:
        found.append("an edition that is old already is computed")
    if "diagnostics" not in studio.ask("check", MODEL, edition=1, page="two")[1]:
        found.append("another page is given up")
    return found


def saving(program, folder):
    found = []
    model = folder / "save.toml"
    model.write_text(MODEL)
    beside = sorted(p.name for p in folder.iterdir())
    with Studio(program, str(model)) as s:
        first = s.ask("model")[1]
        status, one = s.ask("save", MODEL + "# one\n", known=first["hash"])
        if status != 200 or model.read_text() != MODEL + "# one\n":
            found.append("a text is not saved")
        reload = s.ask("model")[1]
        if reload["text"] != MODEL + "# one\n" or reload["hash"] != one["hash"]:
            found.append(f"a reload does not show the saved text: {reload['text'][-20:]!r}")
        for name, known in {"of a second tab": first["hash"], "that does not say what it knows": "", "that knows no text of the file": "0" * 64}.items():
            if s.ask("save", MODEL + "# two\n", known=known)[0] != 409 or model.read_text() != MODEL + "# one\n":
                found.append(f"a save {name} overwrites the save of the first")
        if s.ask("save", MODEL + "# one\n", known=first["hash"])[0] != 200:
            found.append("a text that the file holds already is refused")
        two = s.ask("save", MODEL + "# two\n", known=one["hash"])[1]
        model.write_text("# another program\n")
        if s.ask("save", MODEL, known=two["hash"])[0] != 409 or model.read_text() != "# another program\n":
            found.append("the change of another program is lost")
        if s.ask("model")[1]["text"] != "# another program\n":
            found.append("a reload does not show the text of another program")
        if s.ask("save-anyway", MODEL)[0] != 200 or model.read_text() != MODEL:
            found.append("save-anyway does not save")
        model.unlink()
        last = s.ask("model")[1]
        if last["text"] != MODEL or s.ask("save", MODEL, known=last["hash"])[0] != 200 or model.read_text() != MODEL:
            found.append("a file that was removed is not saved again")
    if sorted(p.name for p in folder.iterdir()) != beside:
        found.append("files are left beside the model")
    with Studio(program, "disc") as s:
        status, reply = s.ask("save", MODEL)
        if status != 403 or "comes with the program" not in json.dumps(reply):
            found.append(f"a shipped model: {status} {reply}")
    return found


def children(pid):
    return [int(p) for p in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def gone(pids, seconds=5):
    end = time.monotonic() + seconds
    while any(pathlib.Path(f"/proc/{p}").exists() and "Z" not in pathlib.Path(f"/proc/{p}/stat").read_text().split(") ")[1][:1] for p in pids):
        if time.monotonic() > end:
            return False
        time.sleep(0.05)
    return True


def endings(program, folder):
    found = []
    model = folder / "end.toml"
    model.write_text(MODEL)
    with Studio(program, str(model)) as s:
        workers = children(s.process.pid)
        busy = threading.Thread(target=lambda: ignore(lambda: s.ask("simulate", MODEL.replace("to = 2", "to = 1e7"))))
        busy.start()
        time.sleep(0.3)
        taken = subprocess.run([program, "studio", str(model), "--no-browser", "--port", str(s.port)], capture_output=True, text=True, timeout=30)
        if taken.returncode != 2 or f"port {s.port} is taken" not in taken.stderr:
            found.append(f"a port that is taken: {taken.returncode} {taken.stderr}")
        began = time.monotonic()
        s.process.send_signal(signal.SIGINT)
        code = s.process.wait(20)
        if code != 0 or time.monotonic() - began > 3 or len(workers) != 3 or not gone(workers):
            found.append(f"Ctrl-C: status {code} after {time.monotonic() - began:.1f} s, workers {workers}")
        busy.join()
    with Studio(program, str(model)) as s:
        workers = children(s.process.pid)
        s.process.kill()
        s.process.wait()
        if not gone(workers):
            found.append("a killed studio leaves its workers")
    return found


def ignore(f):
    try:
        f()
    except (OSError, http.client.HTTPException):
        pass


class Careless(http.server.BaseHTTPRequestHandler):
    """A server that answers every request of everybody."""

    def answer(self):
        self.send_response(200)
        self.end_headers()
        self.wfile.write(b"root: a file")

    do_GET = do_POST = answer

    def log_message(self, *_):
        pass


def self_test():
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Careless)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    port, token = server.server_address[1], "1" * 32
    counts = len(strangers(port, token)), len(paths(port, token)), len(sizes(port, token))
    server.shutdown()
    print(f"faults found in a careless server: {counts}")
    return 0 if counts[0] == 15 and counts[1] == 15 and counts[2] >= 1 else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program")
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        return self_test()
    program = str(pathlib.Path(options.program).resolve())
    if not pathlib.Path("viewer/dist/studio.js").exists():
        print("skipped: the viewer is not built, and so no studio")
        return 77
    found = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        model = folder / "model.toml"
        model.write_text(MODEL)
        with Studio(program, str(model)) as s:
            if request(s.port, f"/{s.token}/")[0] != 200:
                print("FAULT the page is not served")
                return 1
            for test in [works, cases, contacts, lambda x: gates(x.port, x.token), lambda x: files(x, folder), editions, hostile]:
                began = time.monotonic()
                found += test(s)
                print(f"{time.monotonic() - began:.1f} s")
        found += saving(program, folder) + endings(program, folder)
    for f in found:
        print(f"FAULT {f}")
    print(f"{len(found)} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
