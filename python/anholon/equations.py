"""Equations of motion, proofs and certificates."""

from __future__ import annotations

import json
from typing import Any

from . import _core, _display


class Equations:
    """The equations of motion in a classical form. ``print`` shows text, a notebook shows typeset formulas.

    Example:
        >>> import anholon as an
        >>> equations = an.load("chaplygin-sleigh").equations("chaplygin")
        >>> equations.form
        'chaplygin'
    """

    def __init__(self, core: _core.Equations) -> None:
        self._core = core

    @property
    def form(self) -> str:
        """The name of the form."""
        return self._core.form

    @property
    def text(self) -> str:
        """The equations as plain text, which ``anholon derive`` prints."""
        return self._core.text

    @property
    def latex(self) -> str:
        """The equations in LaTeX, for papers."""
        return self._core.latex

    @property
    def mathml(self) -> str:
        """The equations in MathML, for browsers."""
        return self._core.mathml

    @property
    def json(self) -> Any:
        """The equations as trees of formulas, which ``anholon derive --format json`` prints."""
        return json.loads(self._core.json)

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<equations, form {self.form!r}; print() shows them>"

    def _repr_html_(self) -> str:
        return self._core.html

    def _repr_latex_(self) -> str:
        return self.latex


_SIGNS = {"proved": "✓", "refuted": "✗", "unknown": "?"}


class Proof:
    """The verdicts on forms, which tell if they are proved to agree with Routh's equations, with a certificate.

    Example:
        >>> import anholon as an
        >>> proof = an.load("chaplygin-sleigh").prove("maggi", "kane")
        >>> bool(proof), [form.verdict for form in proof.forms]
        (True, ['proved', 'proved'])
        >>> an.verify(proof).all_confirmed
        True
    """

    def __init__(self, core: _core.Proof) -> None:
        self._core = core

    @property
    def forms(self) -> list[_core.FormVerdict]:
        """One verdict for each form."""
        return self._core.forms

    @property
    def certificate(self) -> str:
        """A text that :func:`verify` and ``anholon verify`` check without the prover."""
        return self._core.certificate

    def save(self, path: str) -> None:
        """Writes the certificate to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.certificate)

    def __bool__(self) -> bool:
        """True if all forms are proved."""
        return self._core.all_proved

    def __repr__(self) -> str:
        return "\n".join(f"{_SIGNS[f.verdict]} {f!r}" for f in self.forms)

    def _repr_html_(self) -> str:
        return _display.proof(self, _SIGNS)


def verify(proof: Proof | str) -> _core.Verification:
    """Checks a certificate, or that of a proof. The checker and the prover share only the arithmetic of numbers.

    Raises:
        ModelError: the text is no certificate.
        TypeError: `proof` is neither a proof nor a text.

    Example:
        >>> import anholon as an
        >>> an.verify(an.load("chaplygin-sleigh").prove("kane").certificate).all_confirmed
        True
    """
    if not isinstance(proof, (Proof, str)):
        raise TypeError(f"verify takes a proof or the text of a certificate, not {'None' if proof is None else f'a {type(proof).__name__}'}")
    return _core.verify(proof.certificate if isinstance(proof, Proof) else proof)
