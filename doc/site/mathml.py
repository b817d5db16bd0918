"""Formulas become MathML when the pages are built; readers need no script and no network."""

import re
from xml.etree import ElementTree

from latex2mathml.converter import convert

# Dots with accent="true", or stretched, touch the letter; the program writes derivatives like this as well.
DOTS = re.compile(r"<mo(?: [^>]*)?>(&#x0(?:02D9|00A8|20DB);)</mo></mover>")
FUNCTIONS = set("arccos arcsin arctan arctan2 cos cosh cot det exp ln log max min rank sin sinh tan tanh".split())
MATHML = "http://www.w3.org/1998/Math/MathML"
ROWS = ("math", "mrow", "mtd", "msqrt", "mstyle")  # elements with any number of children
SIDES = ("mi", "mn", "msub", "msup", "msubsup", "mover", "mfrac", "msqrt", "mrow", "mtext")
SIGNS = {"lvert": "|", "rvert": "|", "lceil": "⌈", "rceil": "⌉", "lfloor": "⌊", "rfloor": "⌋"}  # behind \\big and the like


class Unreadable(ValueError):
    pass


def tag_of(element):
    return element.tag.partition("}")[2]


def is_function(element):
    while tag_of(element) in ("msup", "msub", "msubsup") and len(element):
        element = element[0]
    return tag_of(element) == "mi" and (element.text or "") in FUNCTIONS


def is_operand(element):
    """Whether it is no sign, which has a space of its own."""
    return tag_of(element) in SIDES and not (tag_of(element) == "mi" and not (element.text or "").isalnum())


def arranged(made):
    """The formula with a space between a function and its neighbours, m sin θ, and columns of tables aligned by their cells:
    MathML Core, which browsers know, has neither."""
    ElementTree.register_namespace("", MATHML)
    root = ElementTree.fromstring(made)
    for parent in list(root.iter()):
        columns = parent.get("columnalign", "").split() if tag_of(parent) == "mtable" else []
        for line in parent if columns else []:
            for k, cell in enumerate(line):
                side = columns[min(k, len(columns) - 1)]
                cell.set("style", f"text-align:{side};text-align:-webkit-{side}")  # Chromium's word for blocks
        if tag_of(parent) not in ROWS:
            continue
        children = list(parent)
        for k in range(len(children) - 1, 0, -1):
            if is_operand(children[k - 1]) and is_operand(children[k]) and (is_function(children[k - 1]) or is_function(children[k])):
                parent.insert(k, ElementTree.Element(f"{{{MATHML}}}mspace", width="0.1667em"))
    return ElementTree.tostring(root, encoding="unicode")


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
    made = DOTS.sub(r'<mo stretchy="false" scriptlevel="+0">\1</mo></mover>', made)
    try:
        made = arranged(made)
    except ElementTree.ParseError as error:
        raise Unreadable(f"the formula {latex!r} becomes no MathML: {error}") from error
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
