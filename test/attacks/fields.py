#!/usr/bin/env python3
"""Text that attacks, in every field of the language: no output takes it for anything but text.

    fields.py --program PROGRAM [--field NAME] [--long]
    fields.py --self-test                         outputs with such text are noticed

The fields are those of `anholon reference --schema`, which is made from the table of the language. Each gets, as its value and as a name if the
author chooses the name, sequences of the terminal, ends of comments, strings, elements and formulas of each format that is written, marks of
direction and line breaks. Accepted models go through all commands; outputs are read by a parser of their format, or searched for forbidden text.
"""

import argparse
import ast
import concurrent.futures
import html.parser
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unicodedata
import xml.dom.minidom

ATTACKS = {
    "terminal": "AT\x1b[31m\x1b]0;x\x07TACK\x9b31m\x85",
    "lines": "AT\nerror: TACK\r\nhint: x",
    "direction": "AT\u202eTACK\u2066\u200f\u2028\u200b",
    "markup": "</script><script>ATTACK</script><b onclick=ATTACK()>&amp;]]>\"'><img src=x onerror=ATTACK>",
    "program": "*/ ATTACK(); /* \"\"\" + ATTACK() + \"\"\" ''' \\\" \\\n#include \"ATTACK\"",
    "tex": "\\input{ATTACK} $ } { % # & _ ^ ~ \\end{document}",
    "table": "ATTACK,1,\"2\n3",
    "nothing": "AT\0TACK",
}

BASE = {
    "title": "base",
    "coordinates": ["x", "y", "theta"],
    "parameters": {"m": 1, "a": 2},
    "body": [{"name": "sled", "mass": "m", "inertia": 1, "center": "x*ex + y*ey", "angle": "theta"}],
    "force": [{"on": "sled", "vector": "-a*x*ex"}],
    "constraint": [{"name": "blade", "equation": "y'*cos(theta) = x'*sin(theta)"}],
    "initial": {"q": {"x": 0, "y": 0, "theta": 0.3}, "qdot": {"theta": 0.5}},
    "simulate": {"to": 0.5, "every": 0.1},
}


# ---- TOML -------------------------------------------------------------------------------------------------


def quoted(text):
    out = ""
    for c in text:
        if c in '"\\':
            out += "\\" + c
        elif ord(c) < 0x20 or 0x7F <= ord(c) < 0xA0 or unicodedata.category(c) in ("Cf", "Zl", "Zp"):
            out += f"\\u{ord(c):04x}"
        else:
            out += c
    return f'"{out}"'


def toml(value):
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{quoted(k)} = {toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    return quoted(value) if isinstance(value, str) else str(value)


def model_text(model):
    return "".join(f"{quoted(k)} = {toml(v)}\n" for k, v in model.items())


# ---- the fields -------------------------------------------------------------------------------------------


def fields(schema, path=()):
    """Paths to all values: names of keys, [] for an element of a list, * for a name of the author."""
    for choice in schema.get("anyOf", []):
        yield from fields(choice, path)
    if "items" in schema:
        yield from fields(schema["items"], (*path, "[]"))
    for key, inside in schema.get("properties", {}).items():
        yield from fields(inside, (*path, key))
    if isinstance(schema.get("additionalProperties"), dict):
        yield (*path, "*name")
        yield from fields(schema["additionalProperties"], (*path, "*"))
    if not schema.get("properties") and not isinstance(schema.get("additionalProperties"), dict) and "items" not in schema and path:
        yield path
    if path and schema.get("type") == "array":
        yield (*path, "[]") if path[-1] != "[]" else path


EXAMPLES = {"name": "n1", "mass": 1, "center": "x*ex", "position": "x*ex", "on": "sled", "equation": "x' = y'", "when": "x - 1", "rate": "1", "value": "x", "unit": "m"}


def with_attack(path, attack):
    """The base with the attack at this place; the keys beside it are those that such an element needs."""
    model = json.loads(json.dumps(BASE))
    place, last = model, None
    for k, step in enumerate(path[:-1]):
        key = 0 if step == "[]" else "free" if step == "*" else step
        empty = [] if path[k + 1] == "[]" else {}
        if isinstance(place, list):
            if not place:
                place.append(empty)
            elif not isinstance(place[0], type(empty)):
                place[0] = empty
            place = place[0]
        else:
            if not isinstance(place.get(key), type(empty)):
                place[key] = empty
            place = place[key]
        last = step
    if isinstance(place, list):
        place[:] = [attack]
    elif path[-1] == "*name":
        place[attack] = 1
    else:
        if last == "[]":
            needed = {"body": ["name", "mass", "center"], "particle": ["name", "mass", "position"], "force": ["on"], "constraint": ["name", "equation"], "event": ["when"], "output": ["name", "value"]}
            for key in needed.get(path[0], []) if len(path) == 3 else []:
                place.setdefault(key, EXAMPLES[key] if key != "name" else "second")
        elif last == "*":
            for key in {"state": ["rate"], "table": [], "parameters": ["value"], "output": ["value"]}.get(path[0], []):
                place.setdefault(key, EXAMPLES[key])
        place["free" if path[-1] == "*" else path[-1]] = attack
    return model


# ---- what outputs may hold --------------------------------------------------------------------------------


def steers(text, but=""):
    """A character that steers a terminal or the direction of writing, or None."""
    for c in text:
        if c not in "\n" + but and (unicodedata.category(c) in ("Cc", "Zl", "Zp") or (unicodedata.category(c) == "Cf" and c not in "\u200c\u200d\u2061\u2062\u2063\u2064")):
            return f"U+{ord(c):04X}"
    return None


def in_text(data):
    return steers(data.decode("utf-8"))


def in_said(data):
    """Messages: the attack begins no line of its own."""
    text = data.decode("utf-8")
    return steers(text) or ("a line of its own" if re.search(r"^(error: TACK|hint: x$|3$)", text, re.M) else None)


class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.wrong = None

    def handle_starttag(self, tag, attrs):
        if tag == "img" or any(n.startswith("on") and "ATTACK" in (v or "") for n, v in attrs):
            self.wrong = f"<{tag}>"

    def handle_data(self, data):
        if self.lasttag == "script" and data.startswith("ATTACK"):
            self.wrong = "a script"


def in_html(data):
    text = data.decode("utf-8")
    page = Page()
    page.feed(text)
    script = re.search(r'id="anholon-data">(.*?)</script>', text, re.S)
    if script:
        json.loads(script[1])
    return page.wrong or steers(re.sub(r"<script.*?</script>|<style.*?</style>", "", text, flags=re.S), but="\t")


def in_xml(data):
    document = xml.dom.minidom.parseString(data)
    names = {e.tagName for e in document.getElementsByTagName("*")}
    return "an element" if names & {"script", "b", "img"} else steers(data.decode("utf-8"))


def in_mathml(data):
    return in_xml(b"<all>" + re.sub(rb"&#x([0-9a-fA-F]+);", rb"", data) + b"</all>") if data.strip() else None


def in_json(data):
    json.loads(data)
    return in_text(data)


def in_python(data):
    tree = ast.parse(data.decode("utf-8"))
    calls = [n.func.id for n in ast.walk(tree) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)]
    return "a call" if "ATTACK" in calls else in_text(data)


def in_c(data):
    text = data.decode("utf-8")
    without = re.sub(r'/\*.*?\*/|"(?:\\.|[^"\\\n])*"', "", text, flags=re.S)
    if "ATTACK" in without or "TACK" in without:
        return "outside of comments and strings"
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler:
        r = subprocess.run([compiler, "-std=c99", "-fsyntax-only", "-x", "c", "-"], input=data, capture_output=True, check=False)
        if r.returncode != 0:
            return r.stderr.decode()[:200]
    return in_text(data)


def in_latex(data):
    text = re.sub(r"^ *%.*\n", "", data.decode("utf-8"), flags=re.M)
    depth = 0
    for i, c in enumerate(text):
        if c in "{}" and (i == 0 or text[i - 1] != "\\"):
            depth += 1 if c == "{" else -1
    wrong = re.search(r"\\input|\\end\{document\}|(?<!\\)[%#&]TACK|(?<!\\)% #", text)
    return f"{wrong[0]}" if wrong else "braces that do not fit" if depth else in_text(data)


def in_csv(data):
    text = data.decode("utf-8")
    widths = {len(re.findall(r'(?:"(?:[^"]|"")*"|[^,\n]*)(?:,|$)', l.rstrip("\n"))) for l in text.splitlines()}
    return "rows of other lengths" if len({len(l.split(",")) for l in text.splitlines()[1:]}) > 1 or not widths else in_text(data)


def nothing(data):
    return None


# command, the reader of its standard output, the reader of a file OUT
COMMANDS = (
    ("check MODEL", in_said, None),
    ("check MODEL --json", in_json, None),
    ("check MODEL --show mechanics", in_said, None),
    ("check MODEL --show program", in_said, None),
    ("derive MODEL", in_said, None),
    ("derive MODEL --format latex", in_latex, None),
    ("derive MODEL --format mathml", in_mathml, None),
    ("derive MODEL --json", in_json, None),
    ("derive MODEL --format c", in_c, None),
    ("derive MODEL --format python", in_python, None),
    ("evaluate MODEL", in_said, None),
    ("evaluate MODEL --json", in_json, None),
    ("simulate MODEL", in_csv, None),
    ("simulate MODEL --json", in_json, None),
    ("simulate MODEL -o OUT.h5 --save OUT.state", in_said, "OUT.h5"),
    ("simulate MODEL --continue OUT.state --to 0.7", in_csv, None),
    ("convert OUT.h5 --json", in_json, None),
    ("convert OUT.h5", in_csv, None),
    ("plot OUT.h5", in_text, None),
    ("plot OUT.h5 -o OUT.svg", in_said, "OUT.svg"),
    ("plot OUT.h5 -o OUT.tex", in_said, "OUT.tex"),
    ("plot OUT.h5 --labels latex -o OUT.svg", in_said, "OUT.svg"),
    ("sweep MODEL --vary a=1,2 --json", in_json, None),
    ("linearize MODEL", in_said, None),
    ("report MODEL -o OUT.html --no-proof", in_said, "OUT.html"),
    ("prove MODEL --forms routh,maggi -o OUT.json", in_said, "OUT.json"),
    ("verify OUT.json", in_said, None),
)
READERS = {".svg": in_xml, ".tex": in_latex, ".html": in_html, ".json": in_json, ".h5": nothing}


def run(program, line, model, out, folder):
    words = [w.replace("MODEL", str(model)).replace("OUT", str(out)) for w in line.split()]
    r = subprocess.run([program, *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120, cwd=folder, check=False)
    return r.returncode, r.stdout, r.stderr


def faults(program, model, folder):
    """The faults of all commands on this model."""
    path, out = folder / "model.toml", folder / "out"
    path.write_text(model_text(model), encoding="utf-8")
    accepted = False
    for k, (line, reader, file) in enumerate(COMMANDS):
        if k > 1 and not accepted:
            return
        code, printed, said = run(program, line, path, out, folder)
        if k == 0:
            accepted = code in (0, 1)
        if code not in (0, 1, 2):
            yield f"{line}: exit status {code}"
            continue
        found = []
        try:
            found.append(("messages", in_said(said)))
            if printed and code == 0:
                found.append(("output", reader(printed)))
            target = file and pathlib.Path(file.replace("OUT", str(out)))
            if file and code == 0 and target.exists():
                found.append((file, READERS[target.suffix](target.read_bytes())))
        except Exception as e:  # noqa: BLE001 whatever a parser throws
            found.append(("output", f"{type(e).__name__}: {e}"[:200]))
        for where, what in found:
            if what:
                yield f"{line}: {where}: {what}"


def self_test():
    missed = 0
    bad = [(in_text, b"a\x1b[31m"), (in_text, "a\u202e".encode()), (in_said, b"x\nerror: TACK"), (in_html, b"<p></script><script>ATTACK</script>"), (in_html, b"<b onclick='ATTACK()'>"), (in_xml, b"<svg>\x1b</svg>"),
           (in_xml, b"<svg><script/></svg>"), (in_json, b'{"a": "\x1b"}'), (in_python, b'"""a"""\nATTACK()'), (in_c, b"/* a */ ATTACK(); /* */"), (in_latex, b"\\input{ATTACK}"), (in_latex, b"{{}"), (in_csv, b"a\n1\n1,2\n")]  # fmt: skip
    good = [(in_text, "aé␛\n".encode()), (in_html, b"<p>&lt;script&gt;ATTACK</p>"), (in_json, b'{"a": "\\u001b"}'), (in_python, b'"""ATTACK()"""'), (in_c, b"/* ATTACK * / */ int x;"), (in_latex, b"\\textbackslash{}input\\{ATTACK\\}"), (in_csv, b'"a,b",c\n1,2\n')]
    for reader, data in bad:
        try:
            if not reader(data):
                print("not found:", reader.__name__, data)
                missed += 1
        except Exception:  # noqa: BLE001
            pass
    for reader, data in good:
        if reader(data):
            print("a false alarm:", reader.__name__, data, reader(data))
            missed += 1
    print(f"{missed} mistakes")
    return 1 if missed else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--field", help="only paths that hold this")
    parser.add_argument("--long", action="store_true", default=bool(os.environ.get("ANHOLON_LONG")))
    options = parser.parse_args()
    os.environ.setdefault("ANHOLON_CACHE", "")
    program = os.path.abspath(options.program)
    schema = json.loads(subprocess.run([program, "reference", "--schema"], stdout=subprocess.PIPE, check=True).stdout)
    paths = sorted(set(fields(schema)))
    if options.field:
        paths = [p for p in paths if options.field in ".".join(p)]
    wrong = 0
    with tempfile.TemporaryDirectory() as scratch:

        def work(job):
            k, (path, (name, attack)) = job
            folder = pathlib.Path(scratch) / str(k)
            folder.mkdir()
            try:
                return [f"{'.'.join(path)}, {name}: {f}" for f in faults(program, with_attack(path, attack), folder)]
            finally:
                shutil.rmtree(folder)

        # All attacks at once and, with --long, each alone.
        attacks = {"all": "".join(ATTACKS.values())} | (ATTACKS if options.long else {})
        jobs = list(enumerate((p, a) for p in paths for a in attacks.items()))
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            for found in pool.map(work, jobs):
                for f in found:
                    print(f.encode("ascii", "backslashreplace").decode(), flush=True)
                wrong += len(found)
    print(f"{len(paths)} fields, {len(jobs)} attacks, {wrong} faults")
    return 1 if wrong or not paths else 0


if __name__ == "__main__":
    sys.exit(main())
