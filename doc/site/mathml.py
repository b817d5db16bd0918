"""Formulas become MathML when the pages are built; readers need no script and no network."""

import re

from latex2mathml.converter import convert

SIGNS = {"lvert": "|", "rvert": "|", "lceil": "⌈", "rceil": "⌉", "lfloor": "⌊", "rfloor": "⌋"}  # behind \\big and the like


class Unreadable(ValueError):
    pass


def mathml(latex, block):
    """The formula as MathML. Raises Unreadable if a command is not translated."""
    tag = re.search(r"\\tag\{([^}]*)\}", latex)
    text = re.sub(r"\\tag\{[^}]*\}", "", latex)
    text = re.sub(r"\\bmod\b", r"\\;\\mathrm{mod}\\;", text)
    for name, sign in SIGNS.items():
        text = re.sub(rf"\\{name}\b", sign, text)
    made = convert(text, display="block" if block else "inline")
    left = re.search(r"\\[A-Za-z]+", re.sub(r"<annotation.*?</annotation>", "", made))
    if left or "<merror" in made:
        raise Unreadable(f"the formula {latex!r} is not translated{': ' + left[0] if left else ''}")
    return made + (f'<span class="tag">({tag[1]})</span>' if tag else "")


def formulas_refused():
    """Whether a command that nobody knows is refused, in a test."""
    try:
        mathml(r"a \unheardof b", block=False)
    except Unreadable:
        return True
    return False


def inline(self, node):
    from docutils.nodes import SkipNode

    self.body.append(mathml(node.astext(), block=False))
    raise SkipNode


def block(self, node):
    from docutils.nodes import SkipNode

    self.body.append(f'<div class="formula">{mathml(node.astext(), block=True)}</div>')
    raise SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
