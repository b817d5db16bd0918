"""The source of a model."""

from __future__ import annotations

from dataclasses import dataclass

from . import _core


@dataclass(frozen=True)
class Source:
    """The source of a model: a text with its name, a file, or the folder of a sweep; and the mode of its contacts in which it is read."""

    text: str | None
    name: str
    mode: tuple[str, ...] = ()
    folder: str = ""

    def __call__(self, given: dict[str, str], cases: list[str]) -> _core.Model:
        """Reads the model with these values of parameters and scenarios."""
        if self.folder:
            return _core.open_sweep(self.folder).model(given, cases, list(self.mode))
        if self.text is None:
            return _core.read_file(self.name, given, cases, list(self.mode))
        return _core.read_text(self.text, given, cases, list(self.mode), self.name)
