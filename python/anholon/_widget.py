"""The viewer of report pages as a widget of a notebook (anywidget): Jupyter, VS Code, Colab, marimo."""

from __future__ import annotations

import pathlib
from typing import Any

_made: dict[str, Any] = {}  # holds the class once anywidget is imported


def module() -> str:
    """Returns the text of the ES module. Raises FileNotFoundError if the package was built without the viewer."""
    path = pathlib.Path(__file__).parent / "widget.js"
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise FileNotFoundError(f"{path} is missing: the package was built without its viewer") from None


def available() -> bool:
    """True if anywidget can be imported and the package has the module."""
    import importlib.util

    return importlib.util.find_spec("anywidget") is not None and (pathlib.Path(__file__).parent / "widget.js").is_file()


def widget(data: str, *, plots: bool) -> Any:
    """Returns a widget that plays the motion of the data (viewer/CONTRACT.md). Needs anywidget."""
    if "Motion" not in _made:
        import anywidget
        import traitlets

        class Motion(anywidget.AnyWidget):
            """A motion that plays. ``time`` shows a time, ``playing`` starts and stops it."""

            _esm = module()
            data = traitlets.Unicode().tag(sync=True)
            plots = traitlets.Bool(False).tag(sync=True)
            time = traitlets.Float(0.0).tag(sync=True)
            playing = traitlets.Bool(False).tag(sync=True)

        _made["Motion"] = Motion
    return _made["Motion"](data=data, plots=plots)
