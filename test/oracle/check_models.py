#!/usr/bin/env python3
"""Compare the shipped models with the reference data, term by term and along a trajectory.

    check_models.py path/to/anholon                 double precision
    check_models.py path/to/anholon --digits 30     multiprecision
    check_models.py path/to/anholon --only disc     models whose path contains `disc`

Every model with a line `# oracle: NAME` is paired with data/NAME.json. At each stored state `anholon evaluate` must give
the stored generalized forces, energies, powers, reactions, accelerations and multipliers; `anholon simulate` must pass
through every stored sample. Prints one line per system; exit status 1 if anything is off. Needs Python 3.11, nothing else.
"""

import argparse
import json
import os
import re
import subprocess
import sys
import tomllib
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal, getcontext
from pathlib import Path

os.environ.setdefault("ANHOLON_CACHE", "")  # no compiled code is kept in the home folder

HERE = Path(__file__).resolve().parent
FORCES = ["Q", "QR", "Qomega", "minus_dVO", "minus_dVomega", "Gamma", "inertia_term", "N"]
ENERGIES = ["T_r", "S_r", "V_O", "V_omega", "h"]
POWERS = ["power_noncons", "power_constraint", "dh_dt"]
# Largest error allowed, in units of the scale of the quantity.
EVALUATE_TOLERANCE = Decimal("1e-13")
SIMULATE_TOLERANCE = Decimal("1e-12")
DIGITS_TOLERANCE = Decimal("1e-25")
STATE_OPTIONS = ["--q", "--qdot", "--qddot"]
UNSTABLE = {"s07_rattleback": Decimal("1e-9")}  # errors grow fast along this trajectory


class Worst:
    """The largest of many errors, each in units of its own scale, and its place."""

    def __init__(self):
        self.error = Decimal(0)
        self.where = ""
        self.count = 0

    def compare(self, value, reference, scale, where):
        reference = Decimal(reference)
        error = abs(Decimal(value) - reference) / max(scale, Decimal(1))
        self.count += 1
        if not error.is_finite() or error > self.error or not self.where:
            self.error, self.where = error, where

    def passes(self, tolerance):
        return self.count > 0 and self.error.is_finite() and self.error <= tolerance


class Failure(Exception):
    """The program gave no usable answer."""


def ask(program, arguments):
    """Runs the program. Returns its JSON with every number as an exact decimal."""
    done = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=600)
    if done.returncode != 0:
        message = (done.stderr.strip() or done.stdout.strip() or "no message").splitlines()
        raise Failure(f"{arguments[0]}: exit {done.returncode}: {message[0][:160]}")
    try:
        return json.loads(done.stdout, parse_float=Decimal, parse_int=Decimal, parse_constant=Decimal)
    except json.JSONDecodeError as error:
        raise Failure(f"{arguments[0]}: not JSON: {error}") from None


def primed(symbol, coordinates):
    """x_2 of the reference data -> (x, 2)."""
    name, _, order = symbol.rpartition("_")
    return (name, int(order)) if name in coordinates and order.isdigit() else (symbol, 0)


def jet_name(symbol, coordinates):
    name, order = primed(symbol, coordinates)
    return name + "'" * order


def body_names(model):
    """The names of all elements with a mass or an inertia, in the order of the file."""
    elements = [e for section in model if section in ("body", "particle") for e in model[section]]
    return [e["name"] for e in elements if "mass" in e or "inertia" in e]


def multiplier_names(model, known):
    """Keys of the multipliers in the order of the constraints; a vector constraint gives name.x, name.y, name.z."""
    names = []
    for constraint in model.get("constraint", []):
        name = constraint["name"]
        names += [k for k in (name, f"{name}.x", f"{name}.y", f"{name}.z") if k in known]
    return names


def multiplier(names, symbol):
    """lam2 -> key of the second multiplier; lam2_1 -> that of its rate."""
    number, _, order = symbol.removeprefix("lam").partition("_")
    index = int(number) - 1
    if index >= len(names):
        raise Failure(f"no multiplier for {symbol}; the program knows {names}")
    return names[index] + "'" * int(order or 0)


def compare_state(worst, answer, reference, model, coordinates, where):
    values = reference["values"]
    force_scale = max([Decimal(1)] + [abs(Decimal(x)) for key in FORCES for x in values[key]])
    speed = max(abs(Decimal(reference["state"][c + "_1"])) for c in coordinates)

    for key in FORCES:
        for coordinate, stored in zip(coordinates, values[key], strict=True):
            worst.compare(answer[key][coordinate], stored, force_scale, f"{key}.{coordinate} {where}")
    for key in ENERGIES:
        worst.compare(answer[key], values[key][0], abs(Decimal(values[key][0])), f"{key} {where}")
    for key in POWERS:
        worst.compare(answer[key], values[key][0], force_scale * max(speed, 1), f"{key} {where}")

    n = len(coordinates)
    upper = [(i, j) for i in range(n) for j in range(i, n)]
    mass_scale = max(abs(Decimal(x)) for x in values["M_upper"])
    for (i, j), stored in zip(upper, values["M_upper"], strict=True):
        worst.compare(answer["mass_matrix"][i][j], stored, mass_scale, f"mass_matrix[{i}][{j}] {where}")

    bodies = body_names(model)
    for key in values:
        if key.startswith("R_total_body"):
            name = bodies[int(key.removeprefix("R_total_body"))]
            for axis, stored in zip("xyz", values[key], strict=True):
                force = answer["reactions"][name]["force"]["xyz".index(axis)]
                worst.compare(force, stored, force_scale, f"reaction of {name}.{axis} {where}")

    names = multiplier_names(model, answer["lambda"])
    for symbol, stored in reference["solution"].items():
        if symbol.startswith("lam") and symbol not in coordinates:
            key = multiplier(names, symbol)
            value, key = answer["lambda"][key], f"lambda.{key}"
        else:
            key = jet_name(symbol, coordinates)
            value = answer["derivatives"][key]
        worst.compare(value, stored, abs(Decimal(stored)), f"{key} {where}")


def evaluate(program, path, model, data, digits, form):
    worst = Worst()
    coordinates = data["coords"]
    answer = ask(program, ["evaluate", str(path), "--json"])  # gives the names of the multipliers
    for index, reference in enumerate(data["states"]):
        state = reference["state"]
        arguments = ["evaluate", str(path), "--json", "--form", form, "--t", reference["t"]]
        for order, option in enumerate(STATE_OPTIONS):
            keys = {c: c + f"_{order}" * (order > 0) for c in coordinates}
            if all(key in state for key in keys.values()):
                arguments += [option, ",".join(f"{c}={state[key]}" for c, key in keys.items())]
        names = multiplier_names(model, answer["lambda"])
        values = {multiplier(names, s): state[s] for s in state if s.startswith("lam") and s not in coordinates}
        arguments += ["--lambda", ",".join(f"{k}={v}" for k, v in values.items())] if values else []
        arguments += ["--digits", str(digits)] if digits else []
        answer = ask(program, arguments)
        compare_state(worst, answer, reference, model, coordinates, f"at state {index}")
    return worst


def simulate(program, path, model, data, digits, form):
    worst = Worst()
    coordinates = data["coords"]
    trajectory = data["trajectory"]
    arguments = ["simulate", str(path), "--json", "--form", form, "--at", ",".join(trajectory["times"])]
    arguments += ["--digits", str(digits)] if digits else ["--tolerance", "1e-15"]
    answer = ask(program, arguments)
    if answer["outcome"] != "finished":
        raise Failure(f"simulate: {answer['outcome']}")
    columns = {name: i for i, name in enumerate(answer["columns"])}
    names = multiplier_names(model, [c.removeprefix("lambda.") for c in columns if c.startswith("lambda.")])
    samples = zip(trajectory["times"], trajectory["states"], trajectory["solution"], answer["rows"], strict=True)
    for time, state, solution, row in samples:
        worst.compare(row[columns["t"]], time, Decimal(1), f"t at {time}")
        for symbol, stored in (state | solution).items():
            if symbol.startswith("lam") and symbol not in coordinates:
                key = "lambda." + multiplier(names, symbol)
            else:
                key = jet_name(symbol, coordinates)
            worst.compare(row[columns[key]], stored, abs(Decimal(stored)), f"{key} at t = {time}")
    return worst


def paired_models(folder):
    for path in sorted(folder.rglob("*.toml")):
        found = re.search(r"^# oracle: (\S+)$", path.read_text(encoding="utf-8"), re.MULTILINE)
        if found:
            yield path, found[1]


def check(program, path, name, folder, digits, form):
    """One line of the table, and whether the system agrees."""
    label = f"{name:32} {path.stem:34}"
    evaluate_tolerance = DIGITS_TOLERANCE if digits else EVALUATE_TOLERANCE
    simulate_tolerance = DIGITS_TOLERANCE if digits else UNSTABLE.get(name, SIMULATE_TOLERANCE)
    line, passed = label, True
    try:
        data = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
        model = tomllib.loads(path.read_text(encoding="utf-8"))
        if model["coordinates"] != data["coords"]:
            raise Failure(f"coordinates {model['coordinates']}, not {data['coords']}")
    except (OSError, tomllib.TOMLDecodeError, Failure) as error:
        return f"{label} FAIL {error}", False
    for step, tolerance in ((evaluate, evaluate_tolerance), (simulate, simulate_tolerance)):
        try:
            worst = step(program, path, model, data, digits, form)
            ok = worst.passes(tolerance)
            line += f" {float(worst.error):8.1e} {worst.where:38.38}"
        except Failure as failure:
            if "does not apply" in str(failure):
                return f"{label} the form '{form}' does not apply", None
            ok = False
            line += f" {failure}"
        except (KeyError, IndexError, ValueError, TypeError, subprocess.TimeoutExpired) as error:
            ok = False
            line += f" {step.__name__}: {type(error).__name__}: {str(error)[:120]}"
        line += " ok  " if ok else " FAIL"
        passed = passed and ok
    return line, passed


def forms_with_motions(program):
    forms = json.loads(subprocess.run([program, "forms", "--json"], check=True, capture_output=True, text=True).stdout)
    return [form["name"] for form in forms if "vakonomic" not in form["name"]]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", help="the anholon program")
    parser.add_argument("--digits", type=int, default=0, help="multiprecision run with so many digits")
    parser.add_argument("--form", default="routh", help="form of the equations, or all")
    parser.add_argument("--only", default="", help="only models whose path contains this")
    parser.add_argument("--models", type=Path, default=HERE.parents[1] / "models")
    parser.add_argument("--data", type=Path, default=HERE / "data")
    parser.add_argument("--jobs", type=int, default=min(8, os.cpu_count() or 1))
    options = parser.parse_args()
    getcontext().prec = 80
    program = os.path.abspath(options.program)

    everything = list(paired_models(options.models))
    pairs = [(path, name) for path, name in everything if options.only in str(path.relative_to(options.models))]
    if not pairs:
        print("no model with an `# oracle:` line found", file=sys.stderr)
        return 1
    print(f"{'system':32} {'model':34} {'evaluate: worst error':47}      simulate: worst error")
    results = []
    with ThreadPoolExecutor(options.jobs) as pool:
        for form in forms_with_motions(program) if options.form == "all" else [options.form]:
            if options.form == "all":
                print(f"-- {form}", flush=True)
            jobs = [pool.submit(check, program, path, name, options.data, options.digits, form) for path, name in pairs]
            for job in jobs:
                line, result = job.result()
                results.append(result)
                print(line, flush=True)
    without = {file.stem for file in options.data.glob("s*.json")} - {name for _, name in everything}
    if without:
        print("no model for: " + ", ".join(sorted(without)))
    done = [result for result in results if result is not None]  # None: the form does not apply
    print(f"{sum(done)} of {len(done)} systems agree with the reference data")
    return 0 if done and all(done) else 1


if __name__ == "__main__":
    sys.exit(main())
