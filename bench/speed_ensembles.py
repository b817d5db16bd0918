"""Tables of the ensembles that bench/speed.py measured: neighbours in the lanes of one core, one thread and two."""

from speed_cells import LEVELS, cell_text, equal_error, number, per_step, ratio, table


def ensembles_of(result):
    return {title: s["batch"] for title, s in result["systems"].items() if "batch" in s}


def vector_peak(result):
    return result["peak"].get("avx512") or result["peak"].get("avx2")


def gigaflops(cell):
    """Returns the GF/s of the kernel alone. The plan counts a multiplication with an addition as one operation, the peak as two."""
    return 2 * cell["work"] * cell["by_kernel"] / cell["us"] / 1e3


def peak_parts(result, batch):
    peak = vector_peak(result)
    return [gigaflops(c) / peak for c in batch["cells"]["own"].values() if peak and "failed" not in c]


def ensembles(result):
    rows = []
    peak = vector_peak(result)
    for title, batch in ensembles_of(result).items():
        for level in LEVELS[:3]:
            own, heyoka = (batch["cells"][side].get(level) for side in ("own", "heyoka"))
            if not own and not heyoka:
                continue
            mine, theirs = (c["us_step"] if c and "failed" not in c else None for c in (own, heyoka))
            alone = result["systems"][title]["cells"]["own"].get(level)
            rate = gigaflops(own) if mine else None
            rows.append([
                title, level, number(mine), number(theirs), ratio(theirs / mine if mine and theirs else None),
                cell_text(own), cell_text(heyoka), ratio(equal_error(batch, "heyoka", level)),
                per_step(alone), number(rate), f"{100 * rate / peak:.0f} %" if rate and peak else "–",
            ])  # fmt: skip
    if not rows:
        return "not measured."
    return table(
        ["system", "tolerance", "us per trajectory and step: anholon", "heyoka", "heyoka / anholon, per step",
         "anholon, us per trajectory (error)", "heyoka", "equal error", "anholon alone, us per step", "GF/s", "of the vector peak"], rows,
    )  # fmt: skip


def lanes_checked(result):
    """Returns a text on the accuracy of the lanes: their distance from the same motions computed alone."""
    cells = [(t, level, c) for t, b in ensembles_of(result).items() for level, c in b["cells"]["own"].items()]
    good_ones = [c for _, _, c in cells if "failed" not in c]
    text = []
    if good_ones:
        text.append(f"Lanes end at most {max(c['apart'] for c in good_ones):.0e} from the same motions alone in their kernel.")
        tables = [f"{t} at {level}" for t, level, c in cells if "failed" not in c and not c["code"]]
        if tables:
            text.append(f"Without machine code: {', '.join(tables)}.")
        part = min(c["by_kernel"] / c["steps"] for c in good_ones)
        text.append(f"Steps by the kernel: {100 * min(1, part):.0f} % at least.")
    failed = [f"{t} at {level}: {c['failed']}" for t, level, c in cells if "failed" in c]
    return " ".join(text + ([f"Failed: {'; '.join(failed)}."] if failed else []))


def gain_by_threads(row):
    return row["1"]["wall"] / row["2"]["wall"]


def threads(result):
    rows = [
        [r["model"], r["cases"], number(r["1"]["wall"]), number(r["2"]["wall"]), ratio(gain_by_threads(r)),
         number(r["2"]["cores"] / r["1"]["cores"]), number(r["load"])] for r in result.get("threads", [])
    ]  # fmt: skip
    if not rows:
        return "not measured."
    head = ["model", "trajectories", "one thread, s", "two threads, s", "one / two", "time on the cores, two / one", "load before"]
    return table(head, rows)
