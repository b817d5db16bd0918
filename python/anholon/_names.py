"""Lists of names, as of coordinates, forms or outputs."""

from __future__ import annotations

from collections.abc import Iterable


def names_of(names: str | Iterable[object]) -> list[str]:
    """The names in a list; a text is one name, not the list of its characters."""
    if not isinstance(names, (str, Iterable)):
        raise TypeError(f"a name is a str, such as 'kane', or names are a list, not {names!r:.60}")
    return [names] if isinstance(names, str) else [str(name) for name in names]
