#!/usr/bin/env python3
"""Checks the reference of the model language against the program.

usage: reference.py --program PROGRAM [--write] [--self-test]

* doc/language.md is what `anholon reference` prints, doc/anholon.schema.json what `anholon reference --schema` prints; --write
  writes them.
* Every example of the page is run. A ```toml block with a file name is written to that file; one without is a whole model if
  it has coordinates and a body or particle, else it is put over model.toml by `base`. `anholon check` must accept it, unless a
  ```text block follows: then it must fail with these messages, `error: …` by line. ```console blocks run as in golden.py.
* Every key of the page's tables occurs in an example.
* The schema accepts every shipped model, every template and every model of test/golden/good, and refuses some slips.
* `anholon fmt` changes none of their content (the program checks the item tree before it writes), and nothing the second
  time. Templates and examples of `anholon new` are in its layout, are checked and integrated.
"""

import argparse
import copy
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

import golden

ROOT = golden.ROOT
PAGE, SCHEMA = ROOT / "doc" / "language.md", ROOT / "doc" / "anholon.schema.json"


class Checker:
    def __init__(self, program):
        self.program, self.problems = program.resolve(), []

    def run(self, *words, folder=ROOT):
        done = subprocess.run([self.program, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=golden.TIMEOUT, stdin=subprocess.DEVNULL)
        return done.returncode, done.stdout, done.stderr

    def problem(self, text):
        self.problems.append(text)
        print(text)


# ---- the page --------------------------------------------------------------------------------------------------------


def blocks(text):
    """Returns the fenced blocks: [(line number, info, text, kind of the line after the block)]."""
    lines, found, at = text.split("\n"), [], 0
    while at < len(lines):
        if lines[at].startswith("```"):
            end = lines.index("```", at + 1)
            found.append((at + 1, lines[at][3:].split(), "".join(line + "\n" for line in lines[at + 1 : end]), lines[end + 1 :][:1]))
            at = end
        at += 1
    return found


def is_whole(text):
    return bool(re.search(r"^coordinates\b", text, re.M) and re.search(r"^(\[\[)?(body|particle)\b", text, re.M)) or bool(re.search(r"^base\b", text, re.M))


def check_examples(c, text, name="language.md"):
    found = blocks(text)
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for number, info, body, _ in found:
            if len(info) == 2:
                (folder / info[1]).write_text(body, encoding="utf-8")
        for k, (number, info, body, _) in enumerate(found):
            if info[:1] != ["toml"]:
                continue
            path = folder / (info[1] if len(info) == 2 else f"example-{number}.toml")
            if len(info) == 1:
                path.write_text(body if is_whole(body) else 'base = "model.toml"\n' + body, encoding="utf-8")
            after = found[k + 1] if k + 1 < len(found) else None
            bad = after and after[1] == ["text"]
            code, out, err = c.run("check", path, folder=folder)
            for case in sorted(set(re.findall(r"^\[+case\.(\w+)", body, re.M))):
                applied, _, why = c.run("check", path, "--case", case, folder=folder)
                code, err = (applied, err + why) if code == 0 else (code, err)
            if not bad and code != 0:
                c.problem(f"{name}:{number}: this example is not accepted\n{err}")
            if bad and code != 2:
                c.problem(f"{name}:{number}: this example ends with {code}, not with an error")
            if bad:
                messages = [line for line in err.split("\n") if "error: " in line]
                wanted = after[2].strip().split("\n")
                for want in wanted:
                    if not want.startswith("error: ") or len(want) < 15 or not any(want in m for m in messages):
                        c.problem(f"{name}:{after[0]}: the message is not {want!r}\n{err}")
    return c


def check_decisions(c, text):
    """Checks the values in the table of formulas whose meaning is decided, along a motion at rest."""
    table = text.split("### Decided")[1].split("\n###")[0]
    rows = re.findall(r"^\| `(.+?)` \| ([-\d.e]+) \|", table, re.M)
    model = next(body for _, info, body, _ in blocks(text) if info == ["toml", "model.toml"])
    with tempfile.TemporaryDirectory() as scratch:
        lines = "".join(f'v{k} = "{formula}"\n' for k, (formula, _) in enumerate(rows))
        pathlib.Path(scratch, "m.toml").write_text(model + "[initial]\nx = 3\n[monitor]\n" + lines, encoding="utf-8")
        code, out, err = c.run("simulate", "m.toml", "--at", "1", "--quiet", "--error-estimate", "never", folder=scratch)
    values = out.strip().split("\n")
    found = dict(zip(values[0].split(","), values[-1].split(","))) if code == 0 else {}
    if len(rows) < 10:
        c.problem("language.md: the table of decided formulas is not found")
    for k, (formula, value) in enumerate(rows):
        if code != 0 or float(found[f"v{k}"]) != float(value):
            c.problem(f"language.md: {formula} is {found.get(f'v{k}', err)}, not {value}")


def check_keys_used(c, text):
    """Checks that each key in a table of keys occurs in an example of its section or of another one."""
    examples = "\n".join(body for _, info, body, _ in blocks(text) if info[:1] == ["toml"])
    for table in re.findall(r"^\| key \| \| \|\n\|---\|---\|---\|\n((?:\|.*\n)+)", text, re.M):
        for key in re.findall(r"^\| `([^`]+)`", table, re.M):
            if not re.search(rf'(^|[\s{{.,"]){re.escape(key)}"? *[=.]', examples, re.M):
                c.problem(f"language.md: the key '{key}' occurs in no example")


# ---- the schema ------------------------------------------------------------------------------------------------------

TYPES = {"string": str, "number": (int, float), "integer": int, "boolean": bool, "array": list, "object": dict}
KNOWN = {"$schema", "title", "description", "type", "enum", "anyOf", "properties", "additionalProperties", "items", "maxProperties"}


def misfit(schema, value, path="model"):
    """Returns the first place at which the value does not fit; knows only the words of JSON Schema that the schema uses."""
    if schema is True:
        return None
    if schema is False:
        return f"{path}: not allowed"
    assert set(schema) <= KNOWN, f"a word of JSON Schema that is not checked: {set(schema) - KNOWN}"
    if "type" in schema:
        names = schema["type"] if isinstance(schema["type"], list) else [schema["type"]]
        if not any(isinstance(value, TYPES[n]) and (n == "boolean" or not isinstance(value, bool)) for n in names):
            return f"{path}: not {' or '.join(names)}"
    if "enum" in schema and value not in schema["enum"]:
        return f"{path}: none of {schema['enum']}"
    if "anyOf" in schema:
        results = [misfit(s, value, path) for s in schema["anyOf"]]
        if None not in results:
            return results[0]
    if isinstance(value, dict):
        if len(value) > schema.get("maxProperties", len(value)):
            return f"{path}: too many keys"
        for key, v in value.items():
            known = schema.get("properties", {})
            wrong = misfit(known[key] if key in known else schema.get("additionalProperties", True), v, f"{path}.{key}")
            if wrong:
                return wrong
    if isinstance(value, list) and "items" in schema:
        for k, v in enumerate(value):
            if wrong := misfit(schema["items"], v, f"{path}[{k}]"):
                return wrong
    return None


SLIPS = [
    'bodi = [{name = "b", center = "0"}]',
    '[[body]]\nname = "b"\ncentre = "0"',
    '[[body]]\nname = 3\ncenter = "0"',
    '[gravity]\nfield = "-g*ez"\ngradient = "true"',
    'table = [{name = "a", x = [0, 1], y = [0, 1], fit = "cubic"}]',
    '[[event]]\nwhen = "x"\ndirection = "left"',
    "[parameters]\nm = true",
    '[parameters]\nm = {valu = 1}',
    '[[force]]\non = {bodi = "b"}\nvector = "ex"',
    "[simulate]\nto = true",
]


def check_schema(c, models):
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    try:
        import jsonschema  # if it is installed, it checks the schema, too

        jsonschema.Draft7Validator.check_schema(schema)
        judge = jsonschema.Draft7Validator(schema)
    except ImportError:
        judge = None
    for name, text in models:
        value = tomllib.loads(text)
        if wrong := misfit(schema, value):
            c.problem(f"{name}: the schema refuses it: {wrong}")
        if judge:
            for error in judge.iter_errors(copy.deepcopy(value)):
                c.problem(f"{name}: jsonschema refuses it: {error.message}")
    for slip in SLIPS:
        if misfit(schema, tomllib.loads(slip)) is None:
            c.problem(f"the schema accepts a slip: {slip!r}")


# ---- the formatter and the templates -------------------------------------------------------------------------------------


def check_format(c, models):
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        names = []
        for k, (name, text) in enumerate(models):
            path = folder / f"{k}.toml"
            path.write_text(text, encoding="utf-8")
            names.append(path.name)
        code, _, err = c.run("fmt", *names, folder=folder)
        if code != 0:
            c.problem(f"fmt ends with {code}\n{err}")
        for (name, text), path in zip(models, names):
            after = (folder / path).read_text(encoding="utf-8")
            if tomllib.loads(after) != tomllib.loads(text):
                c.problem(f"{name}: fmt changes what it says")
            # Only spaces and commas may change, in comments as well.
            if re.sub(r"\s", "", after.replace(",", "")) != re.sub(r"\s", "", text.replace(",", "")):
                c.problem(f"{name}: fmt changes more than blanks and commas")
        code, out, err = c.run("fmt", "--check", *names, folder=folder)
        if code != 0:
            c.problem(f"fmt is not done after one time: {out}{err}")


def check_templates(c):
    folder = ROOT / "models" / "templates"
    paths = sorted(folder.glob("*.toml"))
    code, out, _ = c.run("new")
    listed = [line.split()[0] for line in out.split("\n") if line]
    if code != 0 or listed != [p.stem for p in paths] or not listed:
        c.problem(f"`anholon new` lists {listed}")
    code, out, _ = c.run("fmt", "--check", *paths)
    if code != 0:
        c.problem(f"not in the layout of `anholon fmt`:\n{out}")
    with tempfile.TemporaryDirectory() as scratch:
        for path in paths:
            code, _, err = c.run("new", path.stem, "-o", "mine.toml", folder=scratch)
            mine = pathlib.Path(scratch, "mine.toml")
            if code != 0 or mine.read_bytes() != path.read_bytes():
                c.problem(f"`anholon new {path.stem}`: {err}")
            if c.run("new", path.stem, "-o", "mine.toml", folder=scratch)[0] != 2:
                c.problem("`anholon new` writes over a file")
            if c.run("check", "mine.toml", folder=scratch)[0] != 0:
                c.problem(f"{path.stem}: check fails")
            code, _, err = c.run("simulate", "mine.toml", "--error-estimate", "never", "-o", "rows.csv", folder=scratch)
            if code != 0 or "residual report" not in err:
                c.problem(f"{path.stem}: simulate fails\n{err}")
            mine.unlink()


def self_test(c):
    """Checks that each of some mutants of the page is refused."""
    text = PAGE.read_text(encoding="utf-8")
    mutants = {
        "a good example with a slip": text.replace('equation = "dot(vel(P), B.y) = 0"', 'equation = "dot(vel(P), B.q) = 0"', 1),
        "a bad example that is good": text.replace('coordinate = ["x"]', 'monitor = {a = "x"}', 1),
        "another message": text.replace("did you mean 'coordinates'?", "did you mean 'coordinate'?", 1),
    }
    mistakes = 0
    for name, mutant in mutants.items():
        inner = Checker(c.program)
        inner.problem = inner.problems.append
        if mutant == text or not check_examples(inner, mutant).problems:
            print(f"mutant not refused: {name}")
            mistakes += 1
    inner = Checker(c.program)
    inner.problem = inner.problems.append
    check_decisions(inner, text.replace("| `-x^2` | -9 |", "| `-x^2` | 9 |", 1))
    if not inner.problems:
        print("mutant not refused: another value")
        mistakes += 1
    inner = Checker(c.program)
    inner.problem = inner.problems.append
    check_keys_used(inner, text.replace("| `by` |", "| `bye` |", 1))
    if not inner.problems:
        print("mutant not refused: a key without example")
        mistakes += 1
    print(f"{len(mutants) + 2} mutants, {mistakes} mistakes")
    return 1 if mistakes else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    args = parser.parse_args()
    c = Checker(args.program)
    if args.self_test:
        return self_test(c)
    for path, words in ((PAGE, ["reference"]), (SCHEMA, ["reference", "--schema"])):
        code, out, err = c.run(*words)
        if code != 0:
            c.problem(f"`anholon {' '.join(words)}` ends with {code}\n{err}")
        if args.write:
            path.write_text(out, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != out:
            c.problem(f"{os.path.relpath(path, ROOT)} is not what `anholon {' '.join(words)}` prints: tools/reference.py --program PROGRAM --write")
    text = PAGE.read_text(encoding="utf-8")
    check_examples(c, text)
    check_decisions(c, text)
    check_keys_used(c, text)
    models = [(str(p.relative_to(ROOT)), p.read_text(encoding="utf-8")) for p in sorted((ROOT / "models").rglob("*.toml"))]
    for page in [PAGE, ROOT / "README.md", *sorted((ROOT / "test" / "golden" / "good").glob("*.md"))]:
        for number, info, body, _ in blocks(page.read_text(encoding="utf-8")):
            if len(info) == 2 and info[1].endswith(".toml") and (page.parent.name == "good" or page == PAGE):
                models.append((f"{page.relative_to(ROOT)}:{number}", body))
    check_schema(c, models)
    check_format(c, models)
    check_templates(c)
    print(f"{len(models)} models, {len(blocks(text))} blocks, {len(c.problems)} problems")
    return 1 if c.problems else 0


if __name__ == "__main__":
    sys.exit(main())
