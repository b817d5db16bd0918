"""Exceptions for mistakes of the user. An outcome, not an exception, tells what happens to a motion."""

from __future__ import annotations

import html
import linecache
import re
import traceback
from typing import TYPE_CHECKING, Any

from ._names import spelled

if TYPE_CHECKING:
    from ._core import Diagnostic, Outcome
    from .run import Run
    from .sweep import Sweep
    from .sweep_folder import SweepFolder


class ModelError(ValueError):
    """Mistakes in a model or in an argument, each with its place and a hint.

    Attributes:
        diagnostics: all mistakes, in the order of the text; ``line`` and ``column`` count from 1.

    Example:
        >>> import anholon as an
        >>> try:
        ...     an.load("disk")
        ... except an.ModelError as error:
        ...     print(error.diagnostics[0].hint)
        did you mean the shipped model 'disc'?
    """

    def __init__(self, text: str, diagnostics: list[Diagnostic] | None = None) -> None:
        super().__init__(text)
        self.text = text
        self.diagnostics: list[Diagnostic] = diagnostics or []

    def __reduce__(self) -> tuple[type[ModelError], tuple[str, list[Diagnostic]]]:
        return type(self), (self.text, self.diagnostics)

    def __str__(self) -> str:
        return self.text

    def _render_traceback_(self) -> list[str]:
        """Returns the lines that IPython and Jupyter show instead of a traceback: the user's line with the call, then the mistake."""
        return [*_calling_lines(self), f"\x1b[31mModelError\x1b[0m: {self.text}"]

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class ColumnError(KeyError):
    """A run has no column of a given name. The text names the nearest columns.

    Attributes:
        name: the name that was asked for.
        columns: the names of the columns of the run.

    Example:
        >>> import anholon as an
        >>> run = an.load("disc").simulate(to=1)
        >>> try:
        ...     run["thetadot"]
        ... except an.ColumnError as error:
        ...     print(str(error).splitlines()[0])
        there is no column 'thetadot'; did you mean "theta'" or "theta''"?
    """

    text: str

    def __init__(self, name: str, columns: list[str], outcome: Outcome) -> None:
        import difflib

        self.name, self.columns, self._outcome = name, columns, outcome
        if columns and not isinstance(name, str):
            there = f"the columns are {', '.join(columns)}"
            self.text = f"run[…] takes the name of one column, such as {columns[-1]!r}, not {name!r:.60}\n{there}\nhint: run[{columns[-1]!r}][1:3] has some rows, run.to_pandas() a table"
            super().__init__(self.text)
            return
        near = difflib.get_close_matches(re.sub(r"_?(dot|d)$", "'", spelled(str(name))), columns, 2)
        asked = "; did you mean " + " or ".join(repr(n) for n in near) + "?" if near else ""
        there = f"the columns are {', '.join(columns)}" if columns else f"the motion has not begun: {outcome!r}"
        self.text = f"there is no column {name!r}{asked}\n{there}"
        super().__init__(self.text)

    def __reduce__(self) -> tuple[type[ColumnError], tuple[str, list[str], Outcome]]:
        return type(self), (self.name, self.columns, self._outcome)

    def __str__(self) -> str:
        return self.text


class MotionError(RuntimeError):
    """A motion or a computation cannot go on. :meth:`Run.expect` and functions that return no run raise it.

    Attributes:
        outcome: the outcome of the motion or computation, with its kind, message and remedy.

    Example:
        >>> import anholon as an
        >>> try:
        ...     an.load("luo-zhao-example-2").simulate(to=1000).expect()
        ... except an.MotionError as error:
        ...     print(error.outcome.kind)
        negative_mass
    """

    def __init__(self, text: str, outcome: Outcome) -> None:
        super().__init__(text)
        self.outcome = outcome

    def __reduce__(self) -> tuple[type[MotionError], tuple[str, Outcome]]:
        return type(self), (str(self), self.outcome)


class Interrupted(KeyboardInterrupt):
    """The user pressed Ctrl-C during a computation. The results computed until then are kept.

    Attributes:
        result: the :class:`Run`, :class:`Sweep` or :class:`SweepFolder` with the results computed until then.

    Example:
        >>> import anholon as an, signal, threading
        >>> press = threading.Timer(0.3, signal.raise_signal, [signal.SIGINT])
        >>> try:
        ...     press.start()
        ...     an.load("disc").simulate(to=1_000_000, at=[1_000_000], error_estimate=False)
        ... except an.Interrupted as stopped:
        ...     print(stopped.result.outcome.kind)
        interrupted
    """

    def __init__(self, result: Run | Sweep | SweepFolder) -> None:
        from .sweep_folder import SweepFolder

        folder = isinstance(result, SweepFolder)
        super().__init__("interrupted; the complete parts are in the folder, and the same call goes on" if folder else "interrupted; what was computed is in .result")
        self.result: Any = result


def _calling_lines(error: BaseException) -> list[str]:
    """Returns the line of the user's code that called the library: that of the last frame outside of the package and of IPython."""
    place = None
    for frame, line in traceback.walk_tb(error.__traceback__):
        name = frame.f_globals.get("__name__", "")
        if name.partition(".")[0] not in ("anholon", "IPython", "ipykernel"):
            place = (frame.f_code.co_filename, line)
    if place is None:
        return []
    code = linecache.getline(*place).strip()
    return [f"line {place[1]}: \x1b[1m{code}\x1b[0m"] if code else []


# Patterns of messages in the words of the command line, and the same messages in the words of Python.
_IN_PYTHON = [
    (r"\berror: --(?:set|case): ", "error: "),
    (r"\berror: --set (\w+)=: ", r"error: \1: "),
    (r"\berror: --set (?=\w+=)", "error: "),
    (
        r'(?m)^hint: numbers need one: \[functions\] (\w+) = "…"$',
        r'hint: numbers need one: [functions] \1 = "…" in a file, function("\1", …) of a Builder, from_sympy(…, values={\1: …})',
    ),
    (r"(?m)^hint: leave out the dense output$", "hint: simulate(every=0.01), or at=[…], has rows at the times that are wanted"),
    (r"(?m)^hint: the mode (\S+?)=open, or slips, or sticks$", r'hint: model.in_mode("\1=open"), or slips, or sticks'),
    (r"(?m)^hint: the mode (\S+?)=0, or another number$", r'hint: model.in_mode("\1=0"), or another number'),
    (r'(?m)^(hint: parameters = .* in the state; then) set (\w+)$', r"\1 model.with_(\2=0.4), or Builder.parameter"),
    (r"(?m)^hint: leave out --digits and --numbers$", "hint: leave out digits and numbers"),
    (r"(?m)^hint: leave out --(save|rigorous|integrator)\b.*$", r"hint: leave out \1"),
]


def error_of(text: str, diagnostics: list[Diagnostic], outcome: Outcome | None) -> Exception:
    """Returns the exception for an error of the library. The binding calls it."""
    if outcome is not None:
        return MotionError(text.rstrip("\n"), outcome)
    for words, here in _IN_PYTHON:
        text = re.sub(words, here, text)
    return ModelError(text.rstrip("\n"), diagnostics)
