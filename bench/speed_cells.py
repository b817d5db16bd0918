"""Cells of the speed table: the time and error of a run by tolerance, their comparison at equal error, and their text."""

import math

LEVELS = ("1e-06", "1e-09", "1e-12", "1e-15")


def good(cells):
    """Returns the points of a work-precision curve, by falling tolerance."""
    points = [(float(level), c["us"], c["error"]) for level, c in cells.items() if "failed" not in c]
    return sorted(points, reverse=True)


def time_at(cells, error):
    """Returns the microseconds to reach an error: the least of the runs that reach it and of interpolations between neighbouring
    tolerances on logarithmic scales."""
    points = good(cells)
    times = [us for _, us, e in points if e <= error]
    for (_, us0, e0), (_, us1, e1) in zip(points, points[1:]):
        if e0 > error >= e1 > 0:
            part = math.log(e0 / error) / math.log(e0 / e1)
            times.append(math.exp((1 - part) * math.log(us0) + part * math.log(us1)))
    return min(times, default=None)


def least_error(cells):
    return min((e for _, _, e in good(cells)), default=math.inf)


def equal_error(system, peer, level):
    """Returns the time of the peer over that of Anholon at the error that the peer has at a tolerance; None if Anholon does not
    reach that error."""
    cell = system["cells"].get(peer, {}).get(level)
    if not cell or "failed" in cell:
        return None
    ours = time_at(system["cells"]["own"], cell["error"])
    return cell["us"] / ours if ours else None


def number(x):
    if x is None:
        return "–"
    return f"{x:.0f}" if x >= 1000 else f"{x:.3g}"


def ratio(x):
    return "–" if x is None else f"**{x:.2g}**" if x < 10 else f"**{x:.0f}**"


def cell_text(cell):
    if not cell:
        return "–"
    return "failed" if "failed" in cell else f"{number(cell['us'])} ({cell['error']:.0e})"


def table(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *("| " + " | ".join(map(str, r)) + " |" for r in rows)])


def per_step(cell):
    return number(cell["us"] / cell["steps"]) if cell and "failed" not in cell else "–"


def span(values):
    return " to ".join(dict.fromkeys(number(f(values)) for f in (min, max))) if values else "–"


def verdict(found):
    """Returns "met" or the goals that are missed. `found` maps names to a number and whether the number meets the goal."""
    missed = [f"{name} {number(x)}" for name, (x, well) in found.items() if not well]
    return "missed: " + ", ".join(missed) if missed else "met"
