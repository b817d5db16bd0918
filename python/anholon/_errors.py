"""Exceptions: for what a user wrote. What happens to a motion is told by an outcome."""

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
        diagnostics: all of them, in the order of the text; ``line`` and ``column`` count from 1.

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
        """IPython and Jupyter show this instead of a traceback: the user's own line that called, then the mistake."""
        return [*_calling_lines(self), f"\x1b[31mModelError\x1b[0m: {self.text}"]

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"


class ColumnError(KeyError):
    """There is no column of that name in a run; the text names the nearest ones.

    Attributes:
        name: what was asked for.
        columns: the names that there are.

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
    """What :meth:`Run.expect` and functions without a run raise where a motion or a computation cannot go on.

    Attributes:
        outcome: its kind, message and remedy.

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
    """Ctrl-C during a computation. What was computed until then is kept.

    Attributes:
        result: the :class:`Run`, :class:`Sweep` or :class:`SweepFolder` as far as it came.

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
    """The place in the user's code from which the library was called: the last frame outside of the package and of IPython."""
    place = None
    for frame, line in traceback.walk_tb(error.__traceback__):
        name = frame.f_globals.get("__name__", "")
        if name.partition(".")[0] not in ("anholon", "IPython", "ipykernel"):
            place = (frame.f_code.co_filename, line)
    if place is None:
        return []
    code = linecache.getline(*place).strip()
    return [f"line {place[1]}: \x1b[1m{code}\x1b[0m"] if code else []


# What the library says in the words of the command line, and how Python says it.
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
    """The exception for an error of the library; called by the binding."""
    if outcome is not None:
        return MotionError(text.rstrip("\n"), outcome)
    for words, here in _IN_PYTHON:
        text = re.sub(words, here, text)
    return ModelError(text.rstrip("\n"), diagnostics)
