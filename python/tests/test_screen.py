"""The output in notebooks: formulas, tables, errors, progress bars, and the animation, in a browser without a network."""

import builtins
import html.parser
import json
import pathlib
import re
import subprocess
import sys
import types
from collections.abc import Callable
from typing import Any

import anholon as an
import pytest
from anholon import _progress, _widget

CHROMIUM = pathlib.Path("/usr/bin/chromium")


class Balanced(html.parser.HTMLParser):
    """Reads HTML and records elements that are not closed in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: set[str] = set()

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.seen.add(tag)
        if tag not in ("br", "hr", "meta", "link", "mspace"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open and self.open[-1] == tag, f"</{tag}> after {self.open[-3:]}"
        self.open.pop()


def elements(text: str) -> set[str]:
    reader = Balanced()
    reader.feed(text)
    reader.close()
    assert not reader.open
    return reader.seen


def test_everything_has_html(disc: an.Model) -> None:
    run = disc.simulate(to=1, every="0.1")
    shown: dict[str, Any] = {
        "model": disc,
        "equations": disc.equations("chaplygin"),
        "check": disc.check(),
        "proof": disc.prove("maggi"),
        "run": run,
        "report": run.report,
        "outcome": run.outcome,
        "figure": run.figure("theta"),
        "sweep": disc.sweep({"phi'": [5, 6]}, to="0.1"),
        "linear model": an.load("whipple").linearize(),
        "no run": disc.simulate(to=1, initial={"x'": 1, "phi'": 6, "psi": 0}),
    }
    seen = {name: elements(of._repr_html_()) for name, of in shown.items()}
    for name in ("equations", "check", "run", "sweep", "linear model"):
        assert "math" in seen[name], f"{name}: formulas are MathML"
    for name in ("model", "check", "proof", "run", "report", "sweep", "linear model"):
        assert "table" in seen[name]
    assert "svg" in seen["figure"] and "hint: " in shown["no run"]._repr_html_()
    assert "<script" not in "".join(of._repr_html_() for of in shown.values())


def test_latex() -> None:
    linear = an.load("whipple").linearize()
    text = linear._repr_latex_()
    assert text.count("\\begin") == text.count("\\end") and r"\dot{\phi}" in text
    equations = an.load("disc").equations()
    assert equations._repr_latex_() == equations.latex


def test_text_of_the_user_is_no_markup() -> None:
    text = '''title = "<script>alert(1)</script>"\ncoordinates = ["x"]\nparticle = [{name = "p", mass = 1, position = ["x", 0, 0]}]\n'''
    model = an.loads(text)
    for of in (model, model.check(), model.simulate(to="0.1"), model.sweep({"x": [0, 1]}, to="0.1")):
        assert "<script" not in of._repr_html_()


def test_mistakes_show_line_caret_and_hint() -> None:
    IPython = pytest.importorskip("IPython")
    shell = IPython.core.interactiveshell.InteractiveShell()
    shown: list[str] = []
    shell._showtraceback = lambda kind, value, lines: shown.extend(lines)
    shell.run_cell('import anholon as an\nan.loads("""\ncoordinates = ["x"]\nparameters = {k = "1 +"}\n""")')
    text = "\n".join(shown)
    assert "ModelError" in text and "^" in text and "parameters = {k" in text and ":3:" in text
    assert "model.py" not in text, "the package's own lines are not shown"
    shown.clear()
    shell.run_cell('an.load("disk")')
    assert "did you mean the shipped model 'disc'" in "\n".join(shown) and 'an.load("disk")' in "\n".join(shown)


# ---- progress ----


def test_a_bar_on_a_terminal(disc: an.Model, capsys: pytest.CaptureFixture[str]) -> None:
    told: list[int] = []

    def stop() -> bool:
        told.append(1)
        return len(told) > 30

    run = disc.simulate(to=1_000_000, at=[1_000_000], error_estimate=False, progress=True, stop=stop)
    assert run.outcome.kind == "interrupted"
    said = capsys.readouterr().err
    assert "of 1e+06" in said and "[...." in said
    assert said.rstrip(" ").endswith("\r") and said.split("\r")[-2].strip() == "", "the bar is taken away"
    disc.simulate(to=1, progress=False)
    disc.simulate(to=1)
    assert capsys.readouterr().err == "", "nobody sits before a program"


def test_a_bar_in_a_notebook(monkeypatch: pytest.MonkeyPatch) -> None:
    shown: list[str] = []

    class Handle:
        def update(self, what: str) -> None:
            shown.append(what)

    def display(what: str, display_id: bool) -> Handle:
        shown.append(what)
        return Handle()

    notebook = types.SimpleNamespace(display=display, HTML=lambda text: text)
    monkeypatch.setattr(_progress, "_notebook", lambda: notebook)
    monkeypatch.setattr(_progress, "_PAUSE", 0.0)
    with _progress.Shown(True, "a <b>", 10.0) as tell:
        assert tell is not None
        tell(2.5, 1)
        tell(5.0, 2)
    assert len(shown) == 3 and 'value="0.25' in shown[0] and "a &lt;b&gt;" in shown[0] and shown[-1] == ""
    shown.clear()
    with _progress.Shown(None, "quick", 10.0) as tell:
        assert tell is not None, "a notebook is interactive"
        tell(5.0, 1)
    assert shown == [], "what takes less than two seconds shows no bar"


# ---- pictures ----


def test_plots(disc: an.Model, monkeypatch: pytest.MonkeyPatch) -> None:
    run = disc.simulate(to=1, every="0.05", error_estimate=False)
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("agg")
    axes = run.plot("theta", "phi'", x="t")
    assert [line.get_label() for line in axes.lines] == [r"$\theta$", r"$\dot{\phi}$"]
    assert axes.lines[1].get_ydata().tolist() == run["phi'"].tolist() and axes.get_xlabel() == "$t$"
    axes.figure.canvas.draw()
    with pytest.raises(KeyError, match="thet"):
        run.plot("thet")
    real = builtins.__import__

    def without(name: str, *rest: Any) -> Any:
        if name.startswith("matplotlib"):
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    figure = run.plot("theta", "phi'", x="t")
    assert isinstance(figure, an.Figure) and figure.svg.startswith("<svg") and "</svg>" in figure.svg
    with pytest.raises(an.ModelError, match="thet"):
        run.figure("thet")


def test_animations(disc: an.Model, monkeypatch: pytest.MonkeyPatch) -> None:
    run = disc.simulate(to=1, every="0.05", error_estimate=False)
    pytest.importorskip("anywidget")
    widget = run.animate(plots=True)
    assert json.loads(widget.data)["cases"][0]["scene"]["items"] and widget.plots
    assert "application/vnd.jupyter.widget-view+json" in widget._repr_mimebundle_()[0]
    widget.time = 0.5
    monkeypatch.setattr(_widget, "available", lambda: False)
    assert isinstance(run.animate(), an.Page), "without anywidget the page plays in a frame"


# A page like a notebook of one cell. It renders the widget's module and reports what was drawn, blocked or logged as an error.
PAGE = """<!doctype html><html><head><meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline' blob:; style-src 'unsafe-inline';
 font-src data:; img-src data: blob:"><style>body {{ background: {background}; width: 60rem }}</style></head>
<body><div id="cell"></div><script type="application/json" id="module">{module}</script>
<script type="application/json" id="traits">{traits}</script><script>
const faults = [];
addEventListener('securitypolicyviolation', (e) => faults.push('refused: ' + e.blockedURI + ' ' + e.violatedDirective));
addEventListener('error', (e) => faults.push('error: ' + e.message));
addEventListener('unhandledrejection', (e) => faults.push('rejected: ' + e.reason));
const read = (id) => JSON.parse(document.getElementById(id).textContent);
const painted = (canvas) => {{
  if (!canvas || !canvas.width) return 0;
  const {{ data }} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const colours = new Set();
  for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 0) colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
  return colours.size;
}};
const pause = (ms) => new Promise((done) => setTimeout(done, ms));
(async () => {{
  const traits = read('traits'), listeners = {{}};
  const model = {{ get: (name) => traits[name], on: (e, f) => {{ listeners[e] = f; }}, off: (e) => {{ delete listeners[e]; }} }};
  const {{ default: widget }} = await import(URL.createObjectURL(new Blob([read('module')], {{ type: 'text/javascript' }})));
  const el = document.getElementById('cell');
  const clean = widget.render({{ model, el }});
  const root = el.firstElementChild.shadowRoot, canvas = () => root.querySelector('canvas.view');
  for (let k = 0; k < 200 && painted(canvas()) < 20; ++k) await pause(50);
  const first = canvas()?.toDataURL(), colours = painted(canvas());
  traits.time = traits.later;
  listeners['change:time']();
  const moved = canvas()?.toDataURL() !== first;
  const plots = root.querySelectorAll('.plots canvas').length;
  const sorry = root.querySelector('.sorry')?.textContent ?? '';
  const dark = el.firstElementChild.hasAttribute('data-dark');
  clean();
  const left = el.childElementCount + Object.keys(listeners).length;
  document.title = 'done';
  const said = document.createElement('output');
  said.textContent = JSON.stringify({{ colours, moved, plots, sorry, dark, left, faults }});
  document.body.replaceChildren(said);
}})().catch((e) => {{ document.body.textContent = 'failed: ' + e.stack; }});
</script></body></html>"""


@pytest.fixture(scope="module")
def in_browser(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., dict[str, Any]]:
    if not CHROMIUM.exists():
        pytest.skip(f"there is no {CHROMIUM}")
    folder = tmp_path_factory.mktemp("browser")

    def opened(data: str, background: str = "white", **traits: Any) -> dict[str, Any]:
        def quoted(of: Any) -> str:
            return json.dumps(of).replace("<", "\\u003c")

        page = folder / "page.html"
        page.write_text(PAGE.format(module=quoted(_widget.module()), traits=quoted({"data": data, **traits}), background=background), encoding="utf-8")
        words = [
            *(str(CHROMIUM), "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update"),
            *("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={folder / 'profile'}"),
            *("--virtual-time-budget=30000", "--dump-dom", page.as_uri()),
        ]
        done = subprocess.run(words, capture_output=True, text=True, timeout=240, check=False)
        found = re.search(r"<output>(.*?)</output>", done.stdout, re.S)
        assert found, done.stdout[-500:] + done.stderr[-1500:]
        said: dict[str, Any] = json.loads(html.unescape(found[1]))
        return said

    return opened


@pytest.mark.skipif(not (pathlib.Path(_widget.__file__).parent / "widget.js").is_file(), reason="the viewer is not built")
def test_the_module_draws_without_a_network(disc: an.Model, in_browser: Callable[..., dict[str, Any]]) -> None:
    run = disc.simulate(to=3, every="0.05", error_estimate=False)
    data = run._required().picture_data()
    said = in_browser(data, plots=True, later=2.0)
    assert said["faults"] == [] and said["sorry"] == ""
    assert said["colours"] >= 20 and said["moved"] and said["plots"] >= 1 and not said["dark"]
    assert said["left"] == 0, "a closed widget leaves nothing behind"
    assert in_browser(data, background="#111", plots=False, later=2.0)["dark"]


@pytest.mark.skipif(not (pathlib.Path(_widget.__file__).parent / "widget.js").is_file(), reason="the viewer is not built")
def test_damaged_data_say_so(in_browser: Callable[..., dict[str, Any]]) -> None:
    assert "cannot be shown" in in_browser('{"format": 2, "cases": []}', plots=False, later=0.0)["sorry"]


def test_the_package_imports_no_notebook() -> None:
    code = "import sys, anholon; print([m for m in ('IPython', 'anywidget', 'matplotlib', 'traitlets', 'sympy', 'pandas') if m in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"
