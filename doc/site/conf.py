"""Settings of the site that `./dev docs` builds from the staged pages (tools/site.py)."""

import sys
from pathlib import Path

from pygments.lexer import RegexLexer, bygroups
from pygments.token import Generic, Name, Text

sys.path.insert(0, str(Path(__file__).parent))

project = "Anholon"
copyright = "the authors of Anholon"
html_title = "Anholon"
root_doc = "index"
extensions = ["myst_parser", "sphinx_copybutton", "mathml"]

myst_enable_extensions = ["dollarmath", "attrs_block"]
myst_heading_anchors = 5
myst_dmath_double_inline = True
myst_dmath_allow_digits = True  # without, a formula at the head of a cell that ends with a digit is none
myst_all_links_external = False
suppress_warnings = ["myst.header", "misc.highlighting_failure"]

smartquotes = False  # a prime is a derivative and -- begins an option

html_theme = "furo"
html_static_path = [str(Path(__file__).parent / "static")]
html_css_files = ["site.css"]
html_js_files = ["search.js", "print.js"]
html_math_renderer = "mathml"
html_copy_source = False
html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True}
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"

# A copied command has neither its prompt nor its output.
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True
copybutton_remove_prompts = True


class Transcript(RegexLexer):
    """Commands after a prompt, a line that ends in \\ going on in the next one, and what they print."""

    name = "Transcript"
    tokens = {
        "root": [
            (r"(\$ )((?:.*\\\n)*.*\n?)", bygroups(Generic.Prompt, Name.Function)),
            (r".*\n|.+", Text),
        ]
    }


def setup(app):
    app.add_lexer("console", Transcript)
