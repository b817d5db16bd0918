#!/usr/bin/env python3
"""Forged and flipped certificates: `anholon verify` confirms none that says something false.

    certificates.py --program PROGRAM [--count 1000]
    certificates.py --self-test                         a verifier that confirms everything is noticed

Certificates of `anholon prove` get other numbers, nodes, functions, claims, witnesses, or other bytes. If all claims of a certificate are confirmed
nevertheless, this test computes them in doubles with a bound of their error: a claim of zero must not differ clearly from zero at any of some
random points, and a claim of a difference must not be zero at its witness.
"""

import argparse
import copy
import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
from fractions import Fraction

MODELS = (["luo-zhao-example-2", "--forms", "routh,maggi"], ["disc", "--forms", "routh,chaplygin"], ["luo-zhao-example-1", "--forms", "routh,nielsen,appell"], ["chaplygin-sleigh"], ["vertical-disc", "--forms", "routh,maggi,boltzmann-hamel"])
POINTS = 5
EPS = 2.0**-52
CLEARLY = 1000  # times the bound of the error


# ---- what a certificate says, in doubles -----------------------------------------------------------------


class NoValue(Exception):
    """An expression has no value at the point."""


def slope(name, x, y):
    """A bound of |f'| at x, where y = f(x)."""
    try:
        return {
            "sin": 1.0, "cos": 1.0, "tan": 1 + y * y, "exp": abs(y), "sinh": math.cosh(min(abs(x), 700)), "cosh": math.cosh(min(abs(x), 700)), "tanh": 1.0, "atan": 1.0, "asinh": 1.0,
        }[name]  # fmt: skip
    except KeyError:
        pass
    try:
        if name == "log":
            return 1 / abs(x)
        if name in ("asin", "acos"):
            return 1 / math.sqrt(1 - x * x)
        if name == "acosh":
            return 1 / math.sqrt(x * x - 1)
        if name == "atanh":
            return 1 / (1 - x * x)
    except (ZeroDivisionError, ValueError) as e:
        raise NoValue from e
    raise NoValue(name)


def function(name, x):
    try:
        return getattr(math, name)(x)
    except (ValueError, OverflowError, AttributeError) as e:
        raise NoValue(name) from e


def evaluate(nodes, point):
    """Pairs (value, bound of its error) of all nodes, None for a node without a value; `point` holds those of the symbols."""
    values = []
    for node in nodes:
        kind, rest = node[1], node[2:]
        try:
            if kind == "number":
                v = float(Fraction(rest[0]))
                pair = (v, abs(v) * EPS)
            elif kind == "pi":
                pair = (math.pi, math.pi * EPS)
            elif kind == "symbol":
                pair = point[rest[0]]
            elif kind == "sum":
                terms = [(float(Fraction(w)), *value(values, n)) for w, n in rest]
                pair = (math.fsum(w * v for w, v, _ in terms), sum(abs(w) * e + 4 * EPS * abs(w * v) for w, v, e in terms) + 1e-300)
            elif kind == "product":
                v, relative = 1.0, 0.0
                for n, power in rest:
                    x, e = value(values, n)
                    p = Fraction(power)
                    if x == 0 or e > abs(x) / 8 or (x < 0 and p.denominator != 1):
                        if x == 0 and e == 0 and p > 0:
                            v = 0.0
                            continue
                        raise NoValue
                    v *= x ** int(p) if p.denominator == 1 else x ** float(p)
                    relative += 2 * abs(float(p)) * e / abs(x) + 8 * EPS * (1 + abs(float(p)) * abs(math.log(abs(x))))
                pair = (v, abs(v) * relative + 1e-300)
            elif kind == "atan2":
                (y, ey), (x, ex) = value(values, rest[0]), value(values, rest[1])
                square = x * x + y * y
                if square == 0:
                    raise NoValue
                pair = (math.atan2(y, x), 2 * (abs(x) * ey + abs(y) * ex) / square + 8 * EPS)
            else:
                x, e = value(values, rest[0])
                v = function(kind, x)
                pair = (v, 2 * slope(kind, x, v) * e + 8 * EPS * (abs(v) + slope(kind, x, v) * abs(x)) + 1e-300)
            if not all(math.isfinite(p) for p in pair):
                raise NoValue
            values.append(pair)
        except (NoValue, OverflowError, ZeroDivisionError, ValueError):
            values.append(None)
    return values


def value(values, n):
    if values[n] is None:
        raise NoValue
    return values[n]


def difference(claim, values):
    v, e = value(values, claim["left"])
    for c, n in claim["right"]:
        (a, ea), (b, eb) = value(values, c), value(values, n)
        v -= a * b
        e += abs(a) * eb + abs(b) * ea + ea * eb + 4 * EPS * (abs(a * b) + abs(v))
    return v, e


def lies(certificate):
    """A false statement of one of the claims, or None."""
    r = random.Random(1)
    nodes, symbols = certificate["nodes"], certificate["symbols"]
    for _ in range(POINTS):
        values = evaluate(nodes, [(r.uniform(0.2, 1.7), 0.0) for _ in symbols])
        for k, claim in enumerate(certificate["claims"]):
            if claim["kind"] in ("agree", "kernel"):
                try:
                    v, e = difference(claim, values)
                except NoValue:
                    continue
                if abs(v) > CLEARLY * e:
                    return f"claim {k} ({claim['kind']} {claim['component']}): {v:.3g}, not zero"
    for k, claim in enumerate(certificate["claims"]):
        witness = claim.get("witness")
        if claim["kind"] in ("differ", "pivot") and witness:
            point = [(0.0, 0.0)] * len(symbols)
            for s, v in witness["values"]:
                point[s] = (float(Fraction(v)), abs(float(Fraction(v))) * EPS)
            for s, v, radius in witness["enclosed"]:
                point[s] = (float(Fraction(v)), abs(float(Fraction(v))) * EPS + float(Fraction(radius)))
            try:
                v, e = difference(claim, evaluate(nodes, point))
            except NoValue:
                continue
            if abs(v) <= e and e < 1e-9:
                return f"claim {k} ({claim['kind']} {claim['component']}): zero at its witness"
    return None


# ---- forging --------------------------------------------------------------------------------------------


def other_number(r, text):
    x = Fraction(text)
    return str(r.choice([x + 1, -x, x * 2, 1 / x if x else Fraction(1), x + Fraction(1, 10**6), Fraction(r.randrange(-5, 6)), Fraction(0)]))


def forge(r, original):
    c = copy.deepcopy(original)
    for _ in range(r.choice([1, 1, 1, 2, 4])):
        nodes, claims = c["nodes"], c["claims"]
        kind = r.randrange(12)
        claim = r.choice(claims)
        i = r.randrange(len(nodes))
        node = nodes[i]
        if kind == 0 and node[1] == "number":
            node[2] = other_number(r, node[2])
        elif kind == 1 and node[1] in ("sum", "product"):
            term = r.choice(node[2:])
            at = 0 if node[1] == "sum" else 1
            term[at] = other_number(r, term[at])
        elif kind == 2 and node[1] in ("sum", "product") and i > 0:
            term = r.choice(node[2:])
            term[1 if node[1] == "sum" else 0] = r.randrange(i)
        elif kind == 3 and node[1] in ("sin", "cos", "tan", "exp", "log"):
            node[1] = r.choice(["sin", "cos", "tan", "exp", "log", "sinh"])
        elif kind == 4 and node[1] == "symbol":
            node[2] = r.randrange(len(c["symbols"]))
        elif kind == 5:
            claim["left"] = r.randrange(len(nodes))
        elif kind == 6 and claim["right"]:
            r.choice(claim["right"])[r.randrange(2)] = r.randrange(len(nodes))
        elif kind == 7 and claim["right"]:
            claim["right"].remove(r.choice(claim["right"]))
        elif kind == 8:
            claim["kind"] = r.choice(["agree", "kernel", "differ", "pivot"])
            if claim["kind"] in ("differ", "pivot") and not claim.get("witness"):
                witnesses = [w["witness"] for w in claims if w.get("witness")]
                claim["witness"] = r.choice(witnesses) if witnesses else {"values": [[s, str(Fraction(r.randrange(1, 30), 7))] for s in range(len(c["symbols"]))], "enclosed": [], "equations": []}
            elif claim["kind"] in ("agree", "kernel"):
                claim.pop("witness", None)
        elif kind == 9 and claim.get("witness"):
            w = claim["witness"]
            entry = r.choice((w["values"] + w["enclosed"]) or [[0, "1"]])
            at = r.randrange(1, len(entry))
            entry[at] = other_number(r, entry[at])
        elif kind == 10:
            claim["right"].append([r.randrange(len(nodes)), r.randrange(len(nodes))])
        elif kind == 11 and len(node) > 3:
            node.remove(node[r.randrange(2, len(node))])
    return json.dumps(c).encode()


def flip(r, text):
    data = bytearray(text)
    for _ in range(r.choice([1, 1, 2, 5])):
        i = r.randrange(len(data))
        kind = r.randrange(4)
        if kind == 0:
            data[i] ^= 1 << r.randrange(8)
        elif kind == 1:
            del data[i : i + r.randrange(1, 8)]
        elif kind == 2:
            data[i] = ord(r.choice("0123456789-/[],\""))
        else:
            j = r.randrange(len(data))
            data[i], data[j] = data[j], data[i]
    return bytes(data)


# ---- running --------------------------------------------------------------------------------------------


def verify(program, data, folder):
    path = folder / "forged.json"
    path.write_bytes(data)
    r = subprocess.run([program, "verify", str(path), "--json"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=120, check=False)
    return r.returncode, r.stderr.decode("utf-8", "replace")


def judge(code, said, data):
    """The fault of this answer, or None."""
    if code not in (0, 1, 2):
        return f"exit status {code}: {said[:200]}"
    if code == 2 and not said.strip():
        return "refused without a word"
    if code != 0:
        return None
    try:
        lie = lies(json.loads(data))
    except (ValueError, KeyError, TypeError, IndexError) as e:
        return f"confirmed, though it cannot be read: {e}"
    return f"confirmed a lie: {lie}" if lie else None


def self_test():
    certificate = {
        "symbols": ["x"], "nodes": [[0, "number", "0"], [1, "symbol", 0], [2, "sin", 1], [3, "cos", 1], [4, "product", [2, "2"]], [5, "product", [3, "2"]], [6, "sum", ["1", 4], ["1", 5]], [7, "number", "1"]],
        "claims": [{"kind": "agree", "a": "f", "b": "g", "component": "x", "left": 6, "right": [[7, 7]]}],
    }  # fmt: skip
    wrong = 0
    if lies(certificate):
        print("a true certificate is called a lie:", lies(certificate))
        wrong += 1
    lying = copy.deepcopy(certificate)
    lying["nodes"][4][2][1] = "3"
    differ = copy.deepcopy(certificate)
    differ["claims"][0] |= {"kind": "differ", "witness": {"values": [[0, "1/3"]], "enclosed": [], "equations": []}}
    for c in (lying, differ):
        if not judge(0, "", json.dumps(c).encode()):
            print("a lie is not found:", c["claims"])
            wrong += 1
    if not judge(3, "internal fault", b"") or not judge(2, "", b"") or judge(1, "", b""):
        print("exit statuses are not judged")
        wrong += 1
    print(f"{wrong} mistakes")
    return 1 if wrong else 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--count", type=int, default=1000 if os.environ.get("ANHOLON_LONG") else 100)
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    wrong, codes, true_ones = 0, {}, 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        texts = []
        for k, model in enumerate(MODELS):
            path = folder / f"proof{k}.json"
            if subprocess.run([program, "prove", *model, "-o", str(path), "--json"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False).returncode in (0, 1) and path.exists():
                texts.append(path.read_bytes())
                lie = lies(json.loads(texts[-1]))
                if lie:
                    print(f"{model[0]}: what was proved is a lie: {lie}")
                    wrong += 1
        for k in range(options.count):
            r = random.Random(k)
            text = r.choice(texts)
            data = forge(r, json.loads(text)) if r.random() < 0.7 else flip(r, text)
            code, said = verify(program, data, folder)
            codes[code] = codes.get(code, 0) + 1
            what = judge(code, said, data)
            true_ones += code == 0
            if what:
                print(f"forgery {k}: {what}", flush=True)
                wrong += 1
    print(f"{options.count} forgeries of {len(texts)} certificates: {codes.get(2, 0)} refused, {codes.get(1, 0)} not confirmed, {true_ones} confirmed and true; {wrong} faults")
    return 1 if wrong or not texts else 0


if __name__ == "__main__":
    sys.exit(main())
