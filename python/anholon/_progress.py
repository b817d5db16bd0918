"""Progress bars: text on a terminal, HTML in a notebook."""

from __future__ import annotations

import html
import sys
import time
from collections.abc import Callable
from typing import Any, Union

Progress = Union[bool, Callable[[float, int], object], None]
"""True shows a bar, False none. A function is called every 20 ms. None shows a bar after two seconds in an interactive session."""

_QUIET = 2.0  # s before a bar appears that was not asked for
_PAUSE = 0.1  # s between two updates of the bar
_WIDTH = 30  # characters


def interactive() -> bool:
    """True if the session is interactive: a prompt or a notebook."""
    return hasattr(sys, "ps1") or bool(sys.flags.interactive) or _notebook() is not None


def _notebook() -> Any:
    """Returns the module IPython.display in a notebook, else None. Does not import IPython outside of it."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is None or not hasattr(shell, "kernel"):
        return None
    import IPython.display

    return IPython.display


class Bar:
    """The progress bar of one computation. A call tells it how far the computation is; close() removes it."""

    def __init__(self, what: str, start: float, end: float | None, after: float, unit: str) -> None:
        self._what, self._start, self._end, self._unit = what, start, end, unit
        self._begun = time.monotonic()
        self._next = self._begun + after
        self._display = _notebook()
        self._handle: Any = None
        self._written = 0

    def __call__(self, done: float, count: int) -> None:
        now = time.monotonic()
        if now < self._next:
            return
        self._next = now + _PAUSE
        self._show(done, now - self._begun)

    def _part(self, done: float) -> float | None:
        if self._end is None or self._end == self._start:
            return None
        return min(1.0, max(0.0, (done - self._start) / (self._end - self._start)))

    def _show(self, done: float, seconds: float) -> None:
        part = self._part(done)
        left = f", {seconds * (1 - part) / part:.0f} s left" if part else ""
        said = f"{self._unit} {done:.4g}" + (f" of {self._end:g}" if self._end is not None else "") + f", {seconds:.0f} s{left}"
        if self._display is not None:
            value = "" if part is None else f' value="{part:.4f}"'
            text = f'<progress max="1"{value} style="width:20em"></progress> {html.escape(self._what)}: {html.escape(said)}'
            if self._handle is None:
                self._handle = self._display.display(self._display.HTML(text), display_id=True)
            else:
                self._handle.update(self._display.HTML(text))
            return
        full = round(_WIDTH * part) if part is not None else 0
        line = f"{self._what} [{'#' * full}{'.' * (_WIDTH - full)}] {said}"
        sys.stderr.write("\r" + line.ljust(self._written))
        sys.stderr.flush()
        self._written = len(line)

    def close(self) -> None:
        """Removes the bar."""
        if self._handle is not None:
            self._handle.update(self._display.HTML(""))
        if self._written:
            sys.stderr.write("\r" + " " * self._written + "\r")
            sys.stderr.flush()


class Shown:
    """Shows the progress of one computation as ``progress`` asks. The value of the ``with`` statement is the function to call, or None."""

    def __init__(self, progress: Progress, what: str, end: float | None, *, start: float = 0.0, unit: str = "t =") -> None:
        self._bar: Bar | None = None
        self._told: Callable[[float, int], object] | None = None
        if progress is True or (progress is None and interactive()):
            self._bar = Bar(what, start, end, 0.0 if progress else _QUIET, unit)
            self._told = self._bar
        elif callable(progress):
            self._told = progress

    def __enter__(self) -> Callable[[float, int], object] | None:
        return self._told

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
