#!/usr/bin/env python3
"""Makes a folder of report pages: every shipped model with a picture, and an index of cards.

usage: gallery.py --program PROGRAM [--out FOLDER] [--jobs N] [--force] [NAME...]
       gallery.py --program PROGRAM --self-test

Pages are build/gallery/NAME.html. A page that is newer than the program and the models is left as it is.
Without Chromium there are no pictures. Exit status 1 where a page or picture could not be made.
"""

import argparse
import concurrent.futures
import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
SETS = (("papers", "From papers"), ("asked", "Asked and answered"), ("zoo", "Zoo"))
TIME_LIMIT = 900
# Models whose pages have no proof, as it takes minutes: anholon prove NAME.
NO_PROOF = set()
# The moment of a picture: MOMENT has it for some models, the others have the usual one.
USUAL_MOMENT = "60%"
MOMENT = {}
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")

STYLE = """
:root { --paper: #fdfdfb; --ink: #1c2126; --quiet: #5d6670; --line: #dcdfe3; --accent: #1f5fa8; --panel: #f4f5f3; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #14171b; --ink: #e4e7ea; --quiet: #98a2ad; --line: #323941; --accent: #7db4f2; --panel: #1c2127; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 0 clamp(1rem, 4vw, 3rem) 4rem; max-width: 84rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.5 system-ui, "Segoe UI", "Helvetica Neue", "Liberation Sans", sans-serif; }
h1 { font-size: clamp(1.5rem, 1.1rem + 2vw, 2.3rem); line-height: 1.2; margin: 2.2rem 0 .4rem; font-weight: 650; letter-spacing: -.01em; }
h2 { font-size: 1.35rem; margin: 2.6rem 0 1rem; padding-top: 1.2rem; border-top: 1px solid var(--line); font-weight: 620; }
.lead { max-width: 46rem; color: var(--quiet); margin: .4rem 0; }
.cards { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(17rem, 100%), 1fr)); gap: 1.2rem; list-style: none; margin: 0; padding: 0; }
.card { display: flex; flex-direction: column; height: 100%; border: 1px solid var(--line); border-radius: 10px; overflow: hidden;
  background: var(--panel); color: inherit; text-decoration: none; transition: border-color .15s, transform .15s; }
.card:hover { border-color: var(--accent); transform: translateY(-2px); }
.card:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
.card img, .card .none { display: block; width: 100%; aspect-ratio: 16 / 9; height: auto; border-bottom: 1px solid var(--line); }
.card .words { padding: .8rem 1rem 1rem; display: flex; flex-direction: column; gap: .35rem; flex: 1; }
.card h3 { font-size: 1.02rem; line-height: 1.3; margin: 0; font-weight: 620; overflow-wrap: anywhere; }
.card p { margin: 0; font-size: .9rem; overflow-wrap: anywhere; }
.card .counts { margin-top: auto; padding-top: .35rem; color: var(--quiet); font-size: .82rem; font-variant-numeric: tabular-nums; }
footer { margin-top: 3rem; color: var(--quiet); font-size: .85rem; }
@media (prefers-reduced-motion: reduce) { .card, .card:hover { transition: none; transform: none; } }
"""

PAPERS_STYLE = """
table { border-collapse: collapse; width: 100%; font-size: .92rem; }
th, td { text-align: left; vertical-align: top; padding: .5rem .6rem; border-bottom: 1px solid var(--line); overflow-wrap: anywhere; }
td p { margin: .35rem 0; color: var(--quiet); }
th, td:first-child { white-space: nowrap; font-variant-numeric: tabular-nums; }
code { font-size: .88em; }
details { color: var(--quiet); }
"""

speaking = threading.Lock()


def say(text):
    with speaking:
        print(text, flush=True)


def has_browser():
    own = os.environ.get("ANHOLON_CHROMIUM")
    return bool(shutil.which(own)) if own else any(shutil.which(b) for b in BROWSERS)


def first_paragraph(text):
    """Returns the comment at the head of a model file, which describes the model."""
    lines = []
    for line in text.splitlines():
        if line.startswith("# oracle"):
            continue
        if line.startswith("#"):
            words = line[1:].removeprefix(" ")
            if not words.strip() or words.startswith(" "):
                if lines:
                    break
            else:
                lines.append(words.strip())
        elif lines or line.startswith("coordinates"):
            break
    return " ".join(lines)


def first_sentence(text):
    # A full stop inside a name or a number, after an initial or after "eq" does not end a sentence.
    end = re.search(r"(?<![A-Z])(?<!\beq)(?<!\bcf)(?<!\be\.g)(?<!\bi\.e)\.(?=\s|$)|:(?=\s+[A-Z])", text)
    sentence = text[: end.start()] if end else text
    return sentence + "." if sentence else ""


class Page:
    def __init__(self, model, out):
        self.model, self.name = model, model.stem
        self.page, self.picture, self.facts = (out / f"{self.name}{end}" for end in (".html", ".png", ".json"))
        self.text = model.read_text(encoding="utf-8")
        self.problems = []
        self.early = False

    def sources(self):
        """Returns the files of the model and of its bases."""
        found, todo = [], [self.model]
        while todo:
            path = todo.pop()
            if path in found or not path.exists():
                continue
            found.append(path)
            for base in re.findall(r'^base\s*=\s*"([^"]+)"', path.read_text(encoding="utf-8"), re.M):
                todo.append(path.parent / base)
        return found

    def fresh(self, product, program):
        if not product.exists() or product.stat().st_size == 0:
            return False
        newest = max(p.stat().st_mtime for p in [program, *self.sources()])
        return product.stat().st_mtime >= newest

    def run(self, words, allowed=(0,)):
        try:
            done = subprocess.run([str(w) for w in words], capture_output=True, text=True, errors="replace", timeout=TIME_LIMIT, stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            self.problems.append(f"{words[1]}: not done after {TIME_LIMIT} s")
            return None
        if done.returncode not in allowed:
            said = (done.stderr.strip() or done.stdout.strip() or "nothing said").splitlines()
            self.problems.append(f"{words[1]}: exit status {done.returncode}: {said[0]}")
            return None
        return done

    def make(self, program, pictures, force):
        start, did = time.monotonic(), []
        if force or not self.fresh(self.page, program) or not self.fresh(self.facts, program):
            self.facts.unlink(missing_ok=True)
            words = [program, "report", self.model, "-o", self.page, "--quiet"] + (["--no-proof"] if self.name in NO_PROOF else [])
            done = self.run(words, allowed=(0, 1))
            checked = done and self.run([program, "check", self.model, "--json"])
            if done and not self.page.exists():
                self.problems.append("report: no page; " + (done.stderr.strip().splitlines() or ["nothing said"])[0])
            if done and checked and self.page.exists():
                told = json.loads(checked.stdout)
                facts = {"title": told.get("title") or self.name, "coordinates": len(told["coordinates"]), "constraints": len(told["constraints"]),
                         "order": max([c.get("order", 0) for c in told["constraints"]], default=0), "early": done.returncode == 1}
                self.facts.write_text(json.dumps(facts, indent=1) + "\n", encoding="utf-8")
            did.append("page")
        if pictures and not self.problems and (force or not self.fresh(self.picture, program)):
            self.picture.unlink(missing_ok=True)
            self.run([program, "render", self.model, "-o", self.picture, "--quiet", "--size", "480x270", "--at", MOMENT.get(self.name, USUAL_MOMENT)], allowed=(0, 1))
            if not self.problems and not self.picture.exists():
                self.problems.append("render: no picture")
            did.append("picture")
        return (" and ".join(did) or "as it was") + f", {time.monotonic() - start:.1f} s"

    def card(self):
        facts = json.loads(self.facts.read_text(encoding="utf-8"))
        count = lambda n, what: f"{n} {what}" + ("" if n == 1 else "s")
        counts = [count(facts["coordinates"], "coordinate"), count(facts["constraints"], "constraint")]
        if facts["order"] > 1:
            counts.append(f"of order {facts['order']}")
        if facts["early"]:
            counts.append("the motion ends early")
        if self.picture.exists():
            picture = f'<img src="{html.escape(self.picture.name)}" alt="" width="480" height="270" loading="lazy">'
        else:
            picture = '<span class="none"></span>'
        sentence = first_sentence(first_paragraph(self.text))
        return (f'<li><a class="card" href="{html.escape(self.page.name)}">{picture}<div class="words"><h3>{html.escape(facts["title"])}</h3>'
                + (f"<p>{html.escape(sentence)}</p>" if sentence else "") + f'<p class="counts">{html.escape(" · ".join(counts))}</p></div></a></li>')


def papers_page(claims, titles, version):
    """Returns the page of the tables of papers/: each statement, its formula, and the verdict when the page was made."""
    parts = ["<!doctype html>", '<html lang="en">', '<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">',
             '<meta name="color-scheme" content="light dark"><title>Anholon: the papers</title>', f"<style>{STYLE}{PAPERS_STYLE}</style></head>", "<body>",
             '<header><h1>The papers, equation by equation</h1><p class="lead">What is true is proved, and a changed version of it refuted; what is false is refuted, and its '
             'corrected version proved. <code>anholon papers --check</code> does it again.</p><p><a href="index.html">Gallery</a></p></header>', "<main>"]
    for key, title in titles.items():
        rows = []
        for c in (c for c in claims if c["paper"] == key):
            right = all(k.get("as_expected", True) for k in c["checks"])
            checks = "".join(f"<li><code>{html.escape(k['asks'])}</code> on {html.escape(k['model'])}: {html.escape(k.get('decided', 'not decided here'))}</li>" for k in c["checks"])
            said = {"Holds if": c["hypotheses"], "As read": c["difference"] and f"{c['difference']} ({c['class']})", "Corrected": c["corrected"]}
            words = "".join(f"<p>{what}: {html.escape(text)}</p>" for what, text in said.items() if text)
            rows.append(f"<tr><td>{html.escape(c['tag'])}</td><td>{html.escape(c['title'])}<p><code>{html.escape(c['formula'])}</code></p>{words}"
                        f"<details><summary>{len(c['checks'])} checks</summary><ul>{checks}</ul></details></td><td>{html.escape(c['verdict'] if right else 'not as the table says')}</td></tr>")
        parts += [f"<section><h2>[{html.escape(key)}] {html.escape(title)}</h2>", "<table><thead><tr><th>tag</th><th>statement</th><th>verdict</th></tr></thead><tbody>", *rows, "</tbody></table></section>"]
    return "\n".join(parts + ["</main>", f"<footer><p>Made by {html.escape(version)}.</p></footer>", "</body></html>", ""])


def make_papers(program, out, version):
    """Writes papers.html. Returns the failures."""
    words = [str(program), "papers", "--check", "--json", "--quiet"]
    done = subprocess.run(words, capture_output=True, text=True, timeout=TIME_LIMIT, stdin=subprocess.DEVNULL)
    if done.returncode not in (0, 1):
        return [("papers", (done.stderr.strip() or "nothing said").splitlines()[0])]
    told = json.loads(done.stdout)
    titles = {key: title for key, title in ((p["key"], p["english"]) for p in told["papers"])}
    (out / "papers.html").write_text(papers_page(told["claims"], titles, version), encoding="utf-8")
    return [] if done.returncode == 0 else [("papers", "a claim is not decided as its table says")]


def index(sets, version, papers=False):
    parts = ["<!doctype html>", '<html lang="en">', '<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">',
             '<meta name="color-scheme" content="light dark"><title>Anholon: gallery</title>', f"<style>{STYLE}</style></head>", "<body>", "<header><h1>Anholon: gallery</h1>",
             '<p class="lead">Every shipped model as a page of its own: its motion to play, its equations, the proof that all forms of them agree, '
             "and how far the numbers can be trusted.</p>" + ('<p><a href="papers.html">The papers, equation by equation</a></p>' if papers else "") + "</header>", "<main>"]
    for heading, pages in sets:
        cards = [p.card() for p in pages if p.page.exists() and p.facts.exists()]
        if cards:
            parts += [f"<section><h2>{html.escape(heading)}</h2>", '<ul class="cards">', *cards, "</ul></section>"]
    return "\n".join(parts + ["</main>", f"<footer><p>Made by {html.escape(version)}.</p></footer>", "</body></html>", ""])


def gallery(program, out, jobs, force, models, pictures, papers=False):
    """Makes the gallery. `models` are pairs (heading, files). Returns the failures."""
    out.mkdir(parents=True, exist_ok=True)
    sets = [(heading, [Page(m, out) for m in files]) for heading, files in models]
    pages = [p for _, list_ in sets for p in list_]
    done = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(p.make, program, pictures, force): p for p in pages}
        for future in concurrent.futures.as_completed(running):
            page, done = running[future], done + 1
            try:
                how = future.result()
            except Exception as e:  # a page that fails must not stop the others
                page.problems.append(f"{type(e).__name__}: {e}")
            say(f"[{done}/{len(pages)}] {page.name}: " + ("; ".join(page.problems) if page.problems else how))
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    failed = make_papers(program, out, version) if papers else []
    (out / "index.html").write_text(index(sets, version, papers), encoding="utf-8")
    return failed + [(p.name, why) for p in pages for why in p.problems]


def self_test(program):
    assert first_sentence("A disc of 1.5 kg rolls. It leans.") == "A disc of 1.5 kg rolls."
    assert first_sentence("The system of other.toml with a plane: more") == "The system of other.toml with a plane: more."
    assert first_sentence("It dies away. other.toml tells more.") == "It dies away."
    assert first_sentence("One thing, e.g. a ball: The end.") == "One thing, e.g. a ball."
    assert first_sentence("Walker, G. T. found it.") == "Walker, G. T. found it.", first_sentence("Walker, G. T. found it.")
    assert first_sentence("") == ""
    assert first_paragraph('title = "x"\n# oracle: a\n\n# One\n# two.\n#\n# three\ncoordinates = []\n') == "One two."
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        good, bad = ROOT / "models/zoo/disc.toml", out / "bad.toml"
        bad.write_text('title = "<b>"\ncoordinates = [\n', encoding="utf-8")
        failed = gallery(program, out / "g", 2, False, [("Both & more", [good, bad])], False)
        assert [name for name, _ in failed] == ["bad"], failed
        text = (out / "g/index.html").read_text(encoding="utf-8")
        assert 'href="disc.html"' in text and "5 coordinates" in text and "2 constraints" in text and "Both &amp; more" in text, text
        assert "bad.html" not in text and "://" not in text and "A thin disc rolls" in text, text
        claim = {"paper": "L", "tag": "2.7", "title": "a < b", "formula": "x", "hypotheses": "", "difference": "a dot", "class": "an error of the text", "corrected": "", "verdict": "true",
                 "checks": [{"asks": "x = y", "model": "m", "decided": "true", "as_expected": True}]}
        page = papers_page([claim, claim | {"tag": "2.8", "checks": [claim["checks"][0] | {"as_expected": False}]}], {"L": "Routh & others"}, "v")
        assert "a &lt; b" in page and "a dot (an error of the text)" in page and "Routh &amp; others" in page and page.count("not as the table says") == 1 and "://" not in page, page
        before = (out / "g/disc.html").stat().st_mtime_ns
        gallery(program, out / "g", 2, False, [("Both", [good])], False)
        assert (out / "g/disc.html").stat().st_mtime_ns == before, "made again for nothing"
        gallery(program, out / "g", 2, True, [("Both", [good])], False)
        assert (out / "g/disc.html").stat().st_mtime_ns > before
    print("ok")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build" / "gallery")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--force", action="store_true", help="make every page anew")
    parser.add_argument("--self-test", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME", help="only these models")
    args = parser.parse_args()
    program = args.program.resolve()
    if args.self_test:
        self_test(program)
        return 0
    models = [(heading, [m for m in sorted((ROOT / "models" / folder).glob("*.toml")) if not m.stem.endswith("-symbolic")]) for folder, heading in SETS]
    unknown = set(args.names) - {m.stem for _, files in models for m in files}
    if unknown:
        print(f"error: no shipped model is called {', '.join(sorted(unknown))}", file=sys.stderr)
        return 2
    if args.names:
        models = [(heading, [m for m in files if m.stem in args.names]) for heading, files in models]
    pictures = has_browser()
    if not pictures:
        say("no Chromium: the pages get no pictures (apt-get install chromium)")
    failed = gallery(program, args.out, args.jobs, args.force, models, pictures, papers=not args.names)
    say(f"gallery: {args.out / 'index.html'}")
    for name, why in failed:
        print(f"failed: {name}: {why}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
