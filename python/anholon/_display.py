"""The objects as notebooks show them: tables and formulas in HTML with MathML, and LaTeX for printing."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from . import _core

if TYPE_CHECKING:
    from .analysis import LinearModel
    from .equations import Proof
    from .check import Check
    from .run import Run
    from .sweep import Sweep

_LEFT = " style='text-align:left'"
_MOST = 24  # the most rows and columns of a table


def math(mathml: str) -> str:
    """Returns MathML as an element that stands in text."""
    return f"<math>{mathml}</math>"


def symbol(name: str, model: _core.Model | None = None) -> str:
    """Returns the symbol of a name in HTML."""
    return math(_core.symbol(name, model)[1])


def number(value: float) -> str:
    """Returns a number with six digits as HTML."""
    text = f"{value:.6g}"
    mantissa, e, power = text.partition("e")
    return mantissa if not e else f"{mantissa}·10<sup>{int(power)}</sup>"


def rows(title: str, lines: Iterable[tuple[str, str]]) -> str:
    """Returns a table whose rows are a name and its contents, both HTML. The title is plain text."""
    body = "".join(f"<tr><th{_LEFT}>{name}</th><td{_LEFT}>{said}</td></tr>" for name, said in lines)
    return f"<table><caption>{html.escape(title)}</caption><tbody>{body}</tbody></table>"


def table(title: str, head: Sequence[str], body: Iterable[Sequence[str]]) -> str:
    """Returns a table with a head row. All cells are HTML, the title is plain text."""
    first = "".join(f"<th{_LEFT}>{cell}</th>" for cell in head)
    rest = "".join("<tr>" + "".join(f"<td{_LEFT}>{cell}</td>" for cell in line) + "</tr>" for line in body)
    return f"<table><caption>{html.escape(title)}</caption><thead><tr>{first}</tr></thead><tbody>{rest}</tbody></table>"


# ---- objects of the library ----


def outcome(of: _core.Outcome) -> str:
    """Shows how a computation ended, and what to do."""
    if of.ok:
        return "<p>finished</p>"
    return f"<p><strong>{html.escape(of.kind)}</strong>: {html.escape(of.message)}</p><p>hint: {html.escape(of.hint)}</p>"


def _report_lines(of: _core.Report) -> list[tuple[str, str]]:
    lines = []
    if of.trust:
        lines.append(("digits to trust", ", ".join(f"{html.escape(trust.kind)} {trust.digits}" for trust in of.trust)))
    elif of.no_trust:
        lines.append(("digits to trust", f"not estimated: {html.escape(of.no_trust)}"))
    lines.append(("residuals", f"Newton's law {number(of.newton)}, constraints {number(of.constraints)}, power {number(of.power)}"))
    lines += [("conserved", f"{html.escape(w.name)}, largest change {number(w.largest_change)}") for w in of.watched if w.conserved]
    lines += [("monitor", f"{html.escape(w.name)} from {number(w.least)} to {number(w.greatest)}") for w in of.watched if not w.conserved]
    lines += [("warning", html.escape(text)) for text in of.warnings]
    lines += [("note", html.escape(text)) for text in of.notes]
    return lines


def report(of: _core.Report) -> str:
    """Shows steps, residuals, digits to trust and conserved quantities."""
    steps = ("steps", f"{of.steps} of order {of.order} by {html.escape(of.method)}, {number(of.seconds)} s")
    return rows("report", [steps, *_report_lines(of)])


def _matrix(values: Any) -> str:
    lines = ["<mtr>" + "".join(f"<mtd><mn>{value:.5g}</mn></mtd>" for value in line) + "</mtr>" for line in values.tolist()]
    return f"<mrow><mo>[</mo><mtable>{''.join(lines)}</mtable><mo>]</mo></mrow>"


def _column(entries: Iterable[str]) -> str:
    lines = "".join(f"<mtr><mtd>{entry}</mtd></mtr>" for entry in entries)
    return f"<mrow><mo>[</mo><mtable>{lines}</mtable><mo>]</mo></mrow>"


def _eigenvalue(value: complex) -> str:
    return f"{value.real:.6g}" + (f" {'+' if value.imag > 0 else '−'} {abs(value.imag):.6g} i" if value.imag else "")


def linear_model(of: LinearModel) -> str:
    """Shows the matrices of z' = A z + B u, y = C z + D u and the eigenvalues."""
    head = f"linear model, {of.motion}" + (f": {of.why}" if of.why else "")
    eigenvalues = ", ".join(_eigenvalue(value) for value in of.eigenvalues[:_MOST]) or "none"
    lines = [("z", f"<math>{_column(_core.symbol(name)[1] for name in of.states[:_MOST])}</math>")]
    if of.inputs:
        lines.append(("u", ", ".join(symbol(name) for name in of.inputs)))
    if of.outputs:
        lines.append(("y", ", ".join(symbol(name) for name in of.outputs)))
    for name, matrix in (("A", of.A), ("B", of.B), ("C", of.C), ("D", of.D)):
        if matrix.size:
            written = f"<math>{_matrix(matrix)}</math>" if max(matrix.shape) <= _MOST else f"{matrix.shape[0]} × {matrix.shape[1]} numbers"
            lines.append((name, written))
    return rows(head, [*lines, ("eigenvalues, 1/s", eigenvalues)])


def _bmatrix(lines: Iterable[Iterable[str]]) -> str:
    return "\\begin{bmatrix}" + r" \\ ".join(" & ".join(line) for line in lines) + "\\end{bmatrix}"


def linear_model_latex(of: LinearModel) -> str:
    """Returns the equations of the linear model in LaTeX."""
    z = _bmatrix([_core.symbol(name)[0]] for name in of.states)

    def product(matrix: Any, of_names: str) -> str:
        return _bmatrix([f"{value:.5g}" for value in line] for line in matrix.tolist()) + of_names

    text = f"\\frac{{d}}{{dt}}{z} = {product(of.A, 'z')}"
    if of.inputs:
        text += " + " + product(of.B, _bmatrix([_core.symbol(name)[0]] for name in of.inputs))
    if of.outputs:
        text += r",\qquad y = " + product(of.C, "z")
        if of.inputs:
            text += " + " + product(of.D, "u")
    return f"$\\displaystyle {text}$"


# ---- objects of the package ----


def check(of: Check) -> str:
    """Shows the degrees of freedom, the kinds of the constraints and the initial state."""
    model = of.model._core
    constraints = [(html.escape(c.name), html.escape(c.kind) + (", redundant" if c.redundant else "")) for c in of.constraints]
    initial = [(symbol(v.name, model), number(v.value), v.origin) for v in of.initial]
    return (
        rows(of.model.title, [("degrees of freedom", str(of.degrees_of_freedom)), *constraints])
        + table("initial state", ["", "SI", "from"], initial)
        + "".join(f"<p>{html.escape(note)}</p>" for note in of.notes)
    )


def proof(of: Proof, signs: dict[str, str]) -> str:
    """Shows the verdict on each form, one line for each."""
    lines = [(html.escape(f.form), f"{signs[f.verdict]} {f.verdict}", html.escape(f.detail)) for f in of.forms]
    return table("against Routh's equations", ["form", "verdict", ""], lines)


def run(of: Run) -> str:
    """Shows how a motion ended, how far it can be trusted, its events and its columns."""
    if len(of) == 0:
        return outcome(of.outcome)
    report = of.report
    t = of.t
    lines = [("outcome", outcome(of.outcome))]
    lines.append(("rows", f"{len(of)} from t = {number(t[0])} to {number(t[-1])}; {report.steps} steps of order {report.order}, {number(report.seconds)} s"))
    lines += _report_lines(report)
    lines += [("event", html.escape(repr(event))) for event in of.events[:_MOST]]
    if len(of.events) > _MOST:
        lines.append(("event", f"… {len(of.events)} in all"))
    shown = [column for column in of.columns if column.kind in ("coordinates", "velocities", "states", "monitors")][:_MOST]
    columns = [(math(c.mathml), html.escape(c.unit), number(of[c.name][0]), number(of[c.name][-1])) for c in shown]
    return rows(of.model.title, lines) + table("", ["", "unit", "first", "last"], columns)


def sweep(of: Sweep, title: str, outcomes: Sequence[str]) -> str:
    """Shows how the motions ended, and the ranges of the values that vary."""
    import numpy as np

    kinds = {kind: outcomes.count(kind) for kind in dict.fromkeys(outcomes)}
    lines = [("cases", str(of.cases))] + [(html.escape(kind), str(count)) for kind, count in kinds.items()]
    varied = []
    for name, values in of.varied.items():
        if values.dtype == object:
            words = list(dict.fromkeys(values))
            varied.append((html.escape(name), html.escape(words[0]), html.escape(words[-1]), str(len(words))))
            continue
        known = values[np.isfinite(values)]
        varied.append((symbol(name), number(known.min()) if known.size else "", number(known.max()) if known.size else "", str(np.unique(known).size)))
    return rows(title, lines) + table("varied", ["", "least", "greatest", "values"], varied)
