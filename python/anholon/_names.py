"""Names and lists of names, for example of coordinates, forms or outputs."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from typing import TypeVar

V = TypeVar("V")

# In the model language a Greek letter and its spelled name are the same name; so are the characters for a prime.
_SPELLED = str.maketrans(
    {
        **dict(zip("αβγδεζηθικλμνξοπρστυφχψω", "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho sigma tau upsilon phi chi psi omega".split(), strict=True)),
        **dict(zip("ϑϕϵϱµΓΔΘΛΞΠΣΦΨΩ", "theta phi epsilon rho mu Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega".split(), strict=True)),
        "′": "'",
        "’": "'",
    }
)


def spelled(name: str) -> str:
    """Returns the name with its Greek letters spelled: "theta'" for "θ'"."""
    return name if name.isascii() else name.translate(_SPELLED)


def known(name: str, names: Container[str]) -> str:
    """Returns the name in the spelling that `names` has, with or without Greek letters; the name itself if `names` lacks it."""
    if not isinstance(name, str) or name in names:
        return name
    return spelled(name) if spelled(name) in names else name


def by_spelled_names(values: Mapping[str, V], what: str) -> dict[str, V]:
    """Returns the values by spelled names.

    Raises:
        ModelError: two of the names have the same spelled name.
    """
    from ._errors import ModelError

    found: dict[str, V] = {}
    for name, value in values.items():
        own = spelled(name) if isinstance(name, str) else name
        if own in found:
            raise ModelError(f"{own!r} is given twice in {what}\nhint: one value for each name; a Greek letter and its spelled name are one name")
        found[own] = value
    return found


class UnknownName(KeyError):
    """There is no value of a name. The text says which names there are."""

    def __str__(self) -> str:
        return str(self.args[0])


class ByName(dict[str, V]):
    """Values by name. A name with Greek letters finds the value of its spelled name."""

    def __missing__(self, name: str) -> V:
        own = spelled(name) if isinstance(name, str) else name
        if own == name or not super().__contains__(own):
            raise UnknownName(f"there is no {name!r} here\nthe names are {', '.join(map(str, self)) or 'none'}{self._hint(name)}")
        return self[own]

    def _hint(self, name: object) -> str:
        """Returns the end of the message about an unknown name."""
        return ""

    def __contains__(self, name: object) -> bool:
        return super().__contains__(name) or (isinstance(name, str) and super().__contains__(spelled(name)))

    def get(self, name: str, default: object = None) -> object:  # type: ignore[override]
        """Returns the value of a name, or the default if there is no such name."""
        return self[name] if name in self else default


def names_of(names: str | Iterable[object]) -> list[str]:
    """Returns names as a list. A text is one name, not the list of its characters."""
    if not isinstance(names, (str, Iterable)):
        raise TypeError(f"a name is a str, such as 'kane', or names are a list, not {names!r:.60}")
    return [names] if isinstance(names, str) else [str(name) for name in names]
