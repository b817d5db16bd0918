"""Models from files and texts, and the models that come with the library."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence

from . import _core
from ._errors import ModelError
from ._numbers import Number, texts_of
from ._source import Source
from .model import made, Model


def load(path: str | os.PathLike[str] | _core.ShippedModel, *, case: str | Sequence[str] = (), set: Mapping[str, Number] | None = None) -> Model:
    """Reads a model file, or a shipped model by its name.

    Args:
        path: ``"disc"``, ``"my/robot.toml"``, or one of :func:`zoo`.
        case: scenarios [case.NAME] that are laid over the file.
        set: values of parameters instead of those of the file.

    Raises:
        ModelError: all mistakes of the file at once, each with its line, a caret and a hint.

    Example:
        >>> import anholon as an
        >>> an.load("disc").title
        'Disc rolling on a plane'
    """
    name = path.name if isinstance(path, _core.ShippedModel) else os.fspath(path)
    if "\n" in name or "=" in name and not os.path.exists(name):
        raise ModelError("load: this is the text of a model, not the path of a file\nhint: anholon.loads(text)")
    return _read(Source(None, os.path.abspath(name) if os.path.exists(name) else name), set, case)


def loads(text: str, *, case: str | Sequence[str] = (), set: Mapping[str, Number] | None = None, name: str = "model") -> Model:
    """Reads a model from a text. Error messages show `name` in the place of the file.

    Raises:
        ModelError: all mistakes of the text at once, or the text is the name of a file.
        TypeError: `text` is no text.

    Example:
        >>> import anholon as an
        >>> an.loads('''
        ... title = "Pendulum"
        ... coordinates = ["th"]
        ... particle = [{name = "bob", mass = 1, position = ["sin(th)", "-cos(th)", 0]}]
        ... gravity.field = "-9.81*ey"
        ... ''').coordinates[0].name
        'th'
    """
    if not isinstance(text, str):
        raise TypeError(f"loads takes the text of a model, a str, not a {type(text).__name__}")
    if text.strip() and not any(mark in text for mark in "\n=["):
        raise ModelError(f"loads: {text!r} is not the text of a model\nhint: anholon.load({text!r}) reads a file or a shipped model")
    return _read(Source(text, name), set, case)


def _read(again: Source, set: Mapping[str, Number] | None, case: str | Sequence[str]) -> Model:
    return made(again, texts_of(set), [case] if isinstance(case, str) else list(case))


def zoo() -> list[_core.ShippedModel]:
    """Lists the models that come with the library: name, path, title.

    Example:
        >>> import anholon as an
        >>> any(model.name == "disc" for model in an.zoo())
        True
    """
    return _core.shipped_models()
