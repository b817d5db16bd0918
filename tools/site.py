#!/usr/bin/env python3
"""Builds the site of the documentation, build/site, from the Markdown pages of the tree.

usage: site.py --program PROGRAM [--only-pages]     runs every example, draws the gallery, builds the pages, checks them
       site.py --check                              navigation, figures and examples of the pages, without building
       site.py --self-test

Each folder of doc/ is a part of the site. Its README.md lists the pages of the part by links, in their order. The build copies the
pages, replaces links to files of the tree by links within the site, adds the gallery of shipped models and the page of messages
(made from test/golden/bad), and calls Sphinx. It fails where an example prints something else than its page, where Sphinx
warns, where a link of a built page leads nowhere, and where a page loads something from the network.
"""

import argparse
import concurrent.futures
import html
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.parse

import check_links
import golden
import readme

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARTS = {  # folder of doc/ -> caption in the navigation; README.md of a folder orders its pages
    "book": "The book",
    "recipes": "How do I …",
    "asked": "Asked and answered",
    "from": "Coming from",
    ".": "Reference",
    "theory": "Theory",
}
OTHERS = {  # pages outside of doc/ that belong to a part
    ".": ["NOTATION.md", "models/README.md", "python/notebooks/README.md"],
    "project": ["ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md", "bench/RESULTS.md", "test/golden/README.md", "viewer/README.md", "viewer/CONTRACT.md"],
}
RUN_BY_GOLDEN = ("book", "recipes", "asked", "from")  # folders whose transcripts golden.py runs
PAGES_RUN_BY_GOLDEN = ("doc/sweeps.md",)  # tools/readme.py runs the transcripts of README.md and of other pages of doc/
PYTHON_NOT_RUN = ("doc/results.md", "doc/sweeps.md")  # their Python needs files and clusters of the reader
LEAST_EXAMPLES = 300
RUN_ELSEWHERE = {  # commands that no transcript can run, and the tests that run them
    "render": "test/house/render_disc.py",  # needs a browser
    "studio": "test/studio/server.py",  # runs until Ctrl-C
    "completion": "tools/command_line.py",  # which also sources the script
    "sweep status": "test/sweeps/folders.py",  # needs a sweep that other processes compute
    "sweep collect": "test/sweeps/folders.py",
}
GALLERY = {"papers": "Papers", "asked": "Asked and answered", "contacts": "Contacts", "templates": "Templates", "zoo": "Systems of the literature"}  # folder of models/ -> caption


def say(text):
    print(text, flush=True)


# ---- the pages of the tree -------------------------------------------------------------------------------------------


def listed(index):
    """Returns the pages in the folder of `index` that it lists by links, in their order."""
    found = []
    for _, target in check_links.targets(index.read_text(encoding="utf-8")):
        file = urllib.parse.unquote(target.partition("#")[0])
        if not file.endswith(".md") or check_links.SCHEME.match(target):
            continue
        path = (index.parent / file).resolve()
        if path.parent == index.parent.resolve() and path.name != "README.md" and path not in found:
            found.append(path)
    return found


def part_pages(root, part):
    """Returns README.md of the part, then its pages in order."""
    index = root / "doc" / part / "README.md"
    return [index.resolve(), *listed(index)] if index.exists() else []


def title_of(text):
    found = re.search(r"^# +(.+)$", text, re.M)
    return found[1].strip() if found else None


def examples_of(text, name=""):
    """Returns the number of commands and Python blocks of a page that are executed."""
    _, steps = golden.parse(text.split("\n"))
    return len(steps) + (0 if name in PYTHON_NOT_RUN else len(re.findall(r"^```python$", text, re.M)))


def transcripts(root):
    """Returns the pages whose commands golden.py runs."""
    pages = [page for part in RUN_BY_GOLDEN for page in sorted((root / "doc" / part).glob("*.md"))]
    pages += [root / name for name in PAGES_RUN_BY_GOLDEN if (root / name).exists()]
    return [page for page in pages if "```console" in page.read_text(encoding="utf-8")]


def commands_without_example(root):
    """Returns a problem for each command of doc/commands.md that no transcript runs."""
    page = root / "doc/commands.md"
    if not page.exists():
        return []
    steps = []
    for path in [*sorted((root / "doc").rglob("*.md")), *sorted((root / "test/golden").glob("*/*.md")), root / "README.md"]:
        try:
            steps += [step.command for step in golden.parse(path.read_text(encoding="utf-8").split("\n"))[1]]
        except golden.CaseError:
            pass  # check() reports it
    names = re.findall(r"^###+ `anholon ([a-z ]+)`$", page.read_text(encoding="utf-8"), re.M)
    return [f"no example runs `anholon {name}`" for name in names if name not in RUN_ELSEWHERE and not any(re.search(rf"\banholon {name}\b", s) for s in steps)]


def check(root, least=LEAST_EXAMPLES):
    """Returns the problems and the number of executed examples."""
    problems, count = [], 0
    for folder in sorted({page.parent for page in (root / "doc").rglob("*.md")}):
        part = folder.relative_to(root / "doc").as_posix()
        if part not in PARTS:
            problems.append(f"doc/{part}: the navigation has no such part (PARTS in tools/site.py)")
            continue
        index = folder / "README.md"
        if not index.exists():
            problems.append(f"doc/{part} has no README.md that lists its pages")
            continue
        pages = listed(index)
        for page in sorted(folder.glob("*.md")):
            if page.name != "README.md" and page.resolve() not in pages:
                problems.append(f"{index.relative_to(root)} does not list {page.name}")
    pages = sorted((root / "doc").rglob("*.md")) + [root / "README.md"]
    run = {page.resolve() for page in [*transcripts(root), *(root / name for name in readme.PAGES)]}
    for page in pages:
        text, name = page.read_text(encoding="utf-8"), page.relative_to(root).as_posix()
        if title_of(text) is None:
            problems.append(f"{name} has no title")
        try:
            examples = examples_of(text, name)
        except golden.CaseError as error:
            problems.append(f"{name}: {error}")
            continue
        count += examples
        part = page.parent.relative_to(root / "doc").as_posix() if page.is_relative_to(root / "doc") else ""
        if part in ("book", "asked") and page.name != "README.md":
            if not examples:
                problems.append(f"{name} has no example that is executed")
        if part == "book" and page.name != "README.md":
            if not golden.FIGURE.search(text):
                problems.append(f"{name} has no figure")
            if "\n## Exercises\n" not in text:
                problems.append(f"{name} has no exercises")
        if part == "asked" and page.name != "README.md" and "https://github.com/" not in text:
            problems.append(f"{name} does not link the thread that it answers")
        for place, _ in golden.FIGURE.findall(text):
            if not (page.parent / place).exists():
                problems.append(f"{name}: there is no {place}")
        if "```console" in text and page.resolve() not in run:
            problems.append(f"{name}: no test runs its commands")
        if "```python" in text and part not in PYTHON_PARTS and name != "README.md":
            problems.append(f"{name}: no test runs its Python")
    shown = {(page.parent / place).resolve() for page in pages for place, _ in golden.FIGURE.findall(page.read_text(encoding="utf-8"))}
    for figure in sorted((root / "doc").rglob("figures/*")):
        if figure.resolve() not in shown:
            problems.append(f"{figure.relative_to(root)}: no page shows it")
    for case in sorted((root / "test/golden").glob("*/*.md")):
        count += examples_of(case.read_text(encoding="utf-8"))
    problems += commands_without_example(root)
    for folder in sorted({model.parent.name for model in (root / "models").glob("*/*.toml")} - GALLERY.keys()):
        problems.append(f"models/{folder}: the gallery has no such part (GALLERY in tools/site.py)")
    if count < least:
        problems.append(f"{count} examples are executed, {least} are wanted")
    return problems, count


PYTHON_PARTS = (".", *RUN_BY_GOLDEN)  # folders of doc/ whose Python blocks python/tests/test_documents.py runs


# ---- the copy that Sphinx reads --------------------------------------------------------------------------------------

# Formulas are matched first, as brackets before parentheses in them are no links.
CODE_OR_LINK = re.compile(check_links.CODE.pattern + "|" + check_links.FORMULA.pattern + "|" + r"(?P<picture>!?)\[(?P<text>(?:[^\[\]]|\[[^\]]*\])*)\]\(\s*<?(?P<target>[^()\s<>]*)>?\s*\)")


class Stage:
    def __init__(self, root, out):
        self.root, self.out, self.pages = root.resolve(), out, {}

    def add(self, path, text=None, name=None):
        """Adds a page of the tree, or a generated one with the contents `text`; `name` is its place in the copy."""
        place = name or path.relative_to(self.root).as_posix()
        self.pages[place] = (path, path.read_text(encoding="utf-8") if text is None else text)

    def place_of(self, path):
        """Returns the place of a file of the tree in the copy; None if it is no page of the site."""
        if path.is_dir():
            path = path / "README.md"
        for place, (source, _) in self.pages.items():
            if source == path:
                return place
        return None

    def link(self, page, found):
        if found["target"] is None:
            return found[0]
        target, text = found["target"], found["text"]
        if check_links.SCHEME.match(target) or target.startswith("#"):
            return found[0]
        source = self.pages[page][0]
        if source is None:  # links of a generated page are those of the copy
            return found[0]
        file, mark, anchor = target.partition("#")
        path = (source.parent / urllib.parse.unquote(file)).resolve()
        place = self.place_of(path)
        if place is None and path.is_file():
            place = f"files/{path.relative_to(self.root).as_posix()}"
            copy = self.out / place
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, copy)
        if place is None:
            return text
        relative = os.path.relpath(place, pathlib.PurePosixPath(page).parent)
        return f"{found['picture']}[{text}]({relative}{mark}{anchor})"

    def written(self, page):
        lines, fence, made = self.pages[page][1].split("\n"), None, []
        outside = []
        flush = lambda: (made.append(CODE_OR_LINK.sub(lambda m: self.link(page, m), "\n".join(outside))), outside.clear()) if outside else None
        for line in lines:
            mark = check_links.FENCE.match(line)
            if fence is None and mark:
                flush()
                fence = mark[1]
                info = line.strip()[len(fence):].split()
                if len(info) == 2 and not info[0].startswith("{"):
                    made.append(f'<p class="file-name">{html.escape(info[1])}</p>\n\n{fence}{info[0]}')
                else:
                    made.append(line)
            elif fence is not None:
                made.append(line)
                if mark and mark[1].startswith(fence) and not line.strip().strip(fence[0]):
                    fence = None
            else:
                outside.append(line)
        flush()
        return "\n".join(made)

    def write(self):
        for page in self.pages:
            copy = self.out / page
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(self.written(page), encoding="utf-8")


def toctree(caption, places, hidden=True):
    return "\n".join(["```{toctree}", f":caption: {caption}", ":maxdepth: 1", *([":hidden:"] if hidden else []), "", *places, "```", ""])


def messages_page(root):
    """Returns the page of messages: for each transcript of test/golden/bad, a mistake of a user, the message and its hint."""
    parts = ["# Messages\n", "Each section shows one mistake, the exact message of the program, and the hint that says what to do. [Outcomes](outcomes.md) "
             "explains how a computation can end without a complete result.\n"]  # fmt: skip
    cases = [(title_of(text) or path.stem, text) for path in sorted((root / "test/golden/bad").glob("*.md")) for text in [path.read_text(encoding="utf-8")]]
    for title, text in sorted(cases, key=lambda c: c[0].lower()):
        body = re.sub(r"^# +.+\n", "", text, count=1)
        parts.append(f"## {title}\n\n" + re.sub(r"^(#+) ", r"#\1 ", body, flags=re.M).strip() + "\n")
    return "\n".join(parts)


# ---- the gallery -----------------------------------------------------------------------------------------------------


def comment_of(text):
    """Returns the first paragraph of the comments of a model."""
    lines = []
    for line in text.splitlines():
        if line.startswith("#") and not line.startswith(("# oracle:", "#:")):
            if line == "#" and lines:
                break
            lines.append(line.lstrip("# "))
        elif lines:
            break
    return " ".join(lines)


def about(model, text):
    """Returns the description of a model: its first comment, else its row in models/README.md."""
    row = re.search(rf"^\| `{model.stem}` \| (.+) \|$", (ROOT / "models/README.md").read_text(encoding="utf-8"), re.M)
    return comment_of(text) or (row[1][0].upper() + row[1][1:] + "." if row else "")


def key(text, name):
    found = re.search(rf'^{name} *= *"((?:[^"\\]|\\.)*)"', text, re.M)
    return found[1] if found else ""


def draw(program, model, folder):
    """Makes the page of a model: description, figure of the motion, equations, file. Returns (title, sentence, page, figure or None)."""
    text, name, file = model.read_text(encoding="utf-8"), model.stem, page_name(model)
    title, figure = key(text, "title") or name, None
    run = lambda *words: subprocess.run([program, *map(str, words)], capture_output=True, text=True, cwd=ROOT, timeout=600, stdin=subprocess.DEVNULL, env=os.environ | {"ANHOLON_CACHE": ""})
    with tempfile.TemporaryDirectory() as scratch:
        rows = pathlib.Path(scratch) / "run.csv"
        # Curves are interpolated between rows. Contacts bend them, so models with contacts get many rows.
        end = re.search(r"^to *= *([\d.]+)", text, re.M) if model.parent.name == "contacts" else None
        done = run("simulate", model, "-o", rows, "--quiet", "--error-estimate", "never", *(["--every", f"{float(end[1]) / 400:.6g}"] if end else []))
        if done.returncode not in (0, 1) or not rows.exists():
            if not name.endswith("-symbolic") and model.parent.name != "templates":
                raise RuntimeError(f"{name}: {done.stderr.strip().splitlines()[:1]}")
        if rows.exists() and len(rows.read_text().splitlines()) > 2:
            done = run("plot", rows, "--size", "14cmx8cm", "--each" if len(key_list(text, "coordinates")) <= 3 else "--together", "-o", folder / f"{file}.svg")
            if done.returncode == 0:
                figure = f"{file}.svg"
    shown = f"{name}.toml" if model.parent.name == "templates" else name
    page = [f"# {title}\n", about(model, text), "", f"Source: {key(text, 'source')}." if key(text, "source") else "", ""]
    if figure:
        page += [f"![The coordinates of {title} against time]({figure})\n", f"The figure shows the coordinates against time; `anholon report {shown}` plays the motion.\n"]
    page += ["## The model\n", f"`anholon {'new' if model.parent.name == 'templates' else 'models'} {name}` prints this file.\n", "```toml", text.rstrip(), "```\n"]  # fmt: skip
    if model.parent.name == "contacts":
        page.append("Each mode of the contacts has equations of its own; [contacts](../doc/contact.md) shows motions of this kind.\n")
    else:
        done = run("derive", model, "--format", "mathml", "--quiet")
        if done.returncode != 0:
            raise RuntimeError(f"{name}: derive: {done.stderr.strip().splitlines()[:1]}")
        formulas = re.findall(r"<math.*?</math>", done.stdout, re.S)
        page += ["## Its equations\n", f"`anholon derive {shown}` prints them as text, LaTeX or MathML.\n",
                 '<div class="formula-scroll">', *(f"<p>{re.sub(chr(10) + '+', ' ', f)}</p>" for f in formulas), "</div>\n"]  # fmt: skip
    sentence = re.split(r"(?<=[a-z)])\. ", about(model, text))[0].rstrip(".")
    return title, sentence, "\n".join(page), figure


def page_name(model):
    """Returns the name of a model's page. Templates get a prefix, as they may have the name of a system of the literature."""
    return f"template-{model.stem}" if model.parent.name == "templates" else model.stem


def key_list(text, name):
    found = re.search(rf"^{name} *= *\[([^\]]*(?:\[[^\]]*\][^\]]*)*)\]", text, re.M)
    return re.findall(r'"([^"]+)"', found[1]) if found else []


def gallery(stage, program, jobs):
    folder = stage.out / "gallery"
    folder.mkdir(parents=True, exist_ok=True)
    models = {caption: [m for m in sorted((stage.root / "models" / kind).glob("*.toml"))] for kind, caption in GALLERY.items()}
    index, names = ["# Gallery\n", "Every shipped model, with its motion, its equations and its file. All of it is made by the program when the site is built.\n"], []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        made = {m: pool.submit(draw, program, m, folder) for list_ in models.values() for m in list_}
        for caption, list_ in models.items():
            cards = []
            for model in list_:
                title, sentence, page, figure = made[model].result()
                stage.pages[f"gallery/{page_name(model)}.md"] = (None, page)
                names.append(page_name(model))
                picture = f'<img src="{figure}" alt="" loading="lazy">' if figure else ""
                cards.append(f'<li>{picture}<a href="{page_name(model)}.html">{html.escape(title)}</a><br>{html.escape(sentence)}</li>')
            if cards:
                index += [f"## {caption}\n", '<ul class="cards">', *cards, "</ul>\n"]
    # The pictures of the cards are files in the folder of the pages.
    stage.pages["gallery/README.md"] = (None, "\n".join(index) + "\n" + toctree("Models", names))


# ---- the built pages -------------------------------------------------------------------------------------------------


RAW_TEX = re.compile(r"\\(?:[dt]?frac|d{1,3}ot|partial|sum|int|sqrt|big|left|right|text|mathrm|[a-zA-Z]*theta|[a-zA-Z]*phi|psi|Gamma|lambda|omega)(?![a-zA-Z])|\$[^$\n]*[\\^_=(][^$\n]*\$")
NO_TEXT = ("pre", "code", "script", "style", "title", "annotation")  # elements that may hold TeX


class Links(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.ids, self.links, self.loaded, self.without_text = set(), [], [], 0
        self.raw, self.inside = [], []

    def handle_endtag(self, tag):
        if tag in self.inside:
            while self.inside.pop() != tag:
                pass

    def handle_data(self, data):
        found = None if self.inside else RAW_TEX.search(data)
        if found:
            self.raw.append(found[0])

    def handle_starttag(self, tag, attributes):
        a = dict(attributes)
        if tag in NO_TEXT:
            self.inside.append(tag)
        if "id" in a:
            self.ids.add(a["id"])
        if tag == "a" and a.get("href"):
            self.links.append(a["href"])
        if tag in ("img", "script", "iframe", "source") and a.get("src"):
            self.loaded.append(a["src"])
        if tag == "link" and a.get("href") and "canonical" not in a.get("rel", ""):
            self.loaded.append(a["href"])
        if tag == "img" and "alt" not in a:
            self.without_text += 1


# Replacements in the built pages for screen readers and keyboards, which the theme neglects: (pattern, replacement).
FOR_READERS = [
    (re.compile(r'<p class="caption" role="heading">'), '<p class="caption" role="heading" aria-level="2">'),
    (re.compile(r'<aside class="sidebar-drawer">'), '<aside class="sidebar-drawer" aria-label="The site">'),
    (re.compile(r'<aside class="toc-drawer'), '<aside aria-label="This page" class="toc-drawer'),
    (re.compile(r"<pre>"), '<pre tabindex="0">'),  # a box that scrolls needs the focus of the keyboard
    (re.compile(r'<div class="(formula-scroll|formula|table-wrapper)(?=[" ])'), r'<div tabindex="0" class="\1'),
    (re.compile(r'<th class="head([^"]*)"><p></p></th>'), r'<td class="head\1"></td>'),
    (re.compile(r'(<article role="main" id="furo-main-content">)(?=((?!<h1).)*<div id="search-results">)', re.S), r"\1<h1>Search</h1>"),
]


def help_readers(site):
    """Makes the replacements of FOR_READERS in the built pages; returns the number of replacements by each."""
    counts = [0] * len(FOR_READERS)
    for path in sorted(site.rglob("*.html")):
        text = path.read_text(encoding="utf-8")
        for k, (what, by) in enumerate(FOR_READERS):
            text, n = what.subn(by, text)
            counts[k] += n
        path.write_text(text, encoding="utf-8")
    return counts


def remove_empty_folders(site):
    """Removes empty folders. Sphinx makes a folder of sources that stays empty here."""
    for folder in sorted((path for path in site.rglob("*") if path.is_dir()), reverse=True):
        if not any(folder.iterdir()):
            folder.rmdir()


def check_built(site):
    """Returns problems of the built pages: dead links and anchors, resources from the network, pictures without a text."""
    pages, problems = {}, []
    for path in sorted(site.rglob("*.html")):
        pages[path] = Links()
        pages[path].feed(path.read_text(encoding="utf-8"))
    for path, found in pages.items():
        shown = path.relative_to(site).as_posix()
        for target in found.loaded:
            if check_links.SCHEME.match(target) and not target.startswith("data:"):
                problems.append(f"{shown} loads {target} from the network")
            elif not target.startswith(("data:", "#")) and not (path.parent / urllib.parse.unquote(target.split("?")[0])).exists():
                problems.append(f"{shown} loads {target}, which is not there")
        if found.without_text:
            problems.append(f"{shown} has a picture without a text")
        problems += [f"{shown} shows TeX: {text}" for text in dict.fromkeys(found.raw)]
        for target in found.links:
            if check_links.SCHEME.match(target):
                continue
            file, _, anchor = target.partition("#")
            goal = (path.parent / urllib.parse.unquote(file.split("?")[0])).resolve() if file else path
            if not goal.exists():
                problems.append(f"{shown}: a link leads to {target}, which is not there")
            elif anchor and goal in pages and urllib.parse.unquote(anchor) not in pages[goal].ids:
                problems.append(f"{shown}: a link leads to {target}, where there is no such place")
    return problems


def run_examples(program, jobs):
    """Runs the transcripts of all pages. Returns the number of pages that failed."""
    pages = transcripts(ROOT) + [ROOT / name for name in readme.PAGES]
    def one(page):
        words = [sys.executable, "tools/readme.py" if page.relative_to(ROOT).as_posix() in readme.PAGES else "tools/golden.py", "--program", program, page]
        return page, subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for page, done in pool.map(one, pages):
            if done.returncode != 0:
                failed += 1
                print(done.stdout + done.stderr, end="")
    python = ROOT / "build/python-env/bin/python"
    module = ROOT / "build/release/python"
    if python.exists() and (module / "anholon").exists():
        done = subprocess.run([python, "-m", "pytest", "-q", "-c", ROOT / "python/pyproject.toml", "-p", "no:cacheprovider", ROOT / "python/tests/test_documents.py"],
                              capture_output=True, text=True, env=os.environ | {"PYTHONPATH": str(module), "ANHOLON_PROGRAM": str(program)})  # fmt: skip
        if done.returncode != 0:
            failed += 1
            print(done.stdout[-4000:])
    else:
        say("note: the Python package is not built (./dev python); Python examples are not run")
    return failed, len(pages)


def build(program, out, jobs, only_pages):
    start = time.monotonic()
    problems, count = check(ROOT)
    for problem in problems:
        print(problem)
    if problems:
        return 1
    say(f"{count} executed examples in the documents and transcripts")
    if not only_pages:
        failed, pages = run_examples(program, jobs)
        say(f"examples of {pages} pages run, {failed} failed, {time.monotonic() - start:.0f} s")
        if failed:
            return 1
    copy = ROOT / "build" / "site-pages"
    shutil.rmtree(copy, ignore_errors=True)
    copy.mkdir(parents=True)
    stage = Stage(ROOT, copy)
    tree = []
    for part, caption in PARTS.items():
        found = part_pages(ROOT, part) + [(ROOT / other).resolve() for other in OTHERS.get(part, ())]
        for page in found:
            stage.add(page)
        places = [page.relative_to(ROOT.resolve()).as_posix().removesuffix(".md") for page in found]
        if part == ".":
            stage.pages["doc/messages.md"] = (None, messages_page(ROOT))
            places.insert(places.index("doc/outcomes") + 1, "doc/messages")
            places += ["gallery/README"]
        tree.append(toctree(caption, places))
    for page in OTHERS["project"]:
        stage.add((ROOT / page).resolve())
    tree.append(toctree("The project", [page.removesuffix(".md") for page in OTHERS["project"]]))
    gallery(stage, program, jobs)
    say(f"gallery drawn, {time.monotonic() - start:.0f} s")
    stage.pages["index.md"] = ((ROOT / "README.md").resolve(), (ROOT / "README.md").read_text(encoding="utf-8") + "\n" + "\n".join(tree))
    stage.write()
    shutil.rmtree(out, ignore_errors=True)
    sphinx = ROOT / "build/docs-env/bin/sphinx-build"
    done = subprocess.run([sphinx, "-q", "-W", "--keep-going", "-j", str(jobs), "-b", "html", "-c", ROOT / "doc/site", "-d", ROOT / "build/site-cache", copy, out], cwd=ROOT)
    if done.returncode != 0:
        return 1
    for svg in (copy / "gallery").glob("*.svg"):
        shutil.copy(svg, out / "gallery")
    remove_empty_folders(out)
    unused = [what.pattern for (what, _), n in zip(FOR_READERS, help_readers(out)) if n == 0]
    problems = check_built(out) + [f"no page holds {pattern}: has the theme changed?" for pattern in unused]
    for problem in problems:
        print(problem)
    pages = sum(1 for _ in out.rglob("*.html"))
    say(f"site: {out / 'index.html'}, {pages} pages, {len(problems)} problems, {time.monotonic() - start:.0f} s")
    return 1 if problems else 0


# ---- the self-test ---------------------------------------------------------------------------------------------------

GOOD = {
    "README.md": "# A\n![disc](doc/book/figures/a.svg)\n",
    "doc/README.md": "# Documentation\n[b](b.md) [c](commands.md)\n",
    "doc/b.md": "# B\n```python\nx = 1\n```\n",
    "doc/book/README.md": "# Book\n1. [coin](1.md)\n",
    "doc/book/1.md": "# Coin\n![a](figures/a.svg)\n```console\n$ anholon plot x -o a.svg\n```\n\n## Exercises\n",
    "doc/book/figures/a.svg": "<svg/>",
    "doc/commands.md": "# Commands\n### `anholon check`\n",
    "doc/asked/README.md": "# Asked\n[q](q.md)\n",
    "doc/asked/q.md": "# Q\n<https://github.com/a/b/issues/1>\n```console\n$ anholon check x\n```\n",
}
MUTANTS = {
    "page not listed": ("doc/c.md", "# C\n"),
    "chapter not listed": ("doc/book/2.md", GOOD["doc/book/1.md"]),
    "part without an index": ("doc/recipes/r.md", "# R\n"),
    "unknown part": ("doc/others/r.md", "# R\n"),
    "no title": ("doc/b.md", "B\n```python\nx = 1\n```\n"),
    "chapter without a figure": ("doc/book/1.md", "# Coin\n```console\n$ anholon\n```\n## Exercises\n"),
    "chapter without an exercise": ("doc/book/1.md", GOOD["doc/book/1.md"].replace("Exercises", "End")),
    "chapter without an example": ("doc/book/1.md", "# Coin\n![a](figures/a.svg)\n\n## Exercises\n"),
    "figure that is not there": ("doc/b.md", "# B\n![x](figures/x.svg)\n```python\nx = 1\n```\n"),
    "figure that is not shown": ("doc/book/figures/b.svg", ""),
    "answer without its question": ("doc/asked/q.md", "# Q\n```console\n$ anholon check x\n```\n"),
    "command without an example": ("doc/commands.md", "# Commands\n### `anholon check`\n### `anholon fly`\n"),
    "too few examples": ("doc/b.md", "# B\n"),
    "models that the gallery does not show": ("models/others/a.toml", ""),
    "commands that nothing runs": ("doc/b.md", "# B\n```python\nx = 1\n```\n```console\n$ anholon models\n```\n"),
    "Python that nothing runs": ("doc/theory/README.md", "# T\n```python\nx = 1\n```\n"),
}
BUILT = '<html><head><link rel="stylesheet" href="a.css"></head><body id="top"><a href="b.html#here">b</a><img src="a.css" alt=""><a href="https://x.y">out</a><p>5 $, <code>$\\theta$</code></p></body></html>'
BUILT_MUTANTS = [("b.html#here", "c.html"), ("#here", "#there"), ('src="a.css"', 'src="https://x.y/a.js"'), ('href="a.css"', 'href="//x.y/a.css"'), (' alt=""', ""), ("5 $", r"$\Gamma_\psi$"), ("5 $", "$(y,x)$"), ("5 $", r"\frac ab")]


def self_test():
    failures = 0

    def lay(root, files):
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding="utf-8")

    for title, change in [("good", None), *MUTANTS.items()]:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            lay(root, GOOD | ({change[0]: change[1]} if change else {}))
            problems, count = check(root, least=3)
            if bool(problems) != (change is not None):
                print(f"{title}: {problems}")
                failures += 1
    for change in [None, *BUILT_MUTANTS]:
        with tempfile.TemporaryDirectory() as scratch:
            root = pathlib.Path(scratch)
            lay(root, {"a.html": BUILT.replace(*change) if change else BUILT, "b.html": '<p id="here"></p>', "a.css": ""})
            problems = check_built(root)
            if len(problems) != (change is not None):
                print(f"built page with {change}: {problems}")
                failures += 1
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch).resolve()
        lay(root, {"README.md": "# A\n[b](doc/b.md#x) `[c](d.md)` [folder](doc) [code](src/x.cpp) $[a](b)$ ![p](doc/p.svg)\n```toml a.toml\n[no](b.md)\n```\n", "doc/b.md": "# B", "src/x.cpp": "", "doc/p.svg": ""})
        stage = Stage(root, root / "out")
        stage.add(root / "README.md", name="index.md")
        stage.add(root / "doc/b.md")
        wanted = '# A\n[b](doc/b.md#x) `[c](d.md)` folder [code](files/src/x.cpp) $[a](b)$ ![p](files/doc/p.svg)\n<p class="file-name">a.toml</p>\n\n```toml\n[no](b.md)\n```\n'
        if stage.written("index.md") != wanted:
            print(stage.written("index.md"))
            failures += 1
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch)
        lay(root, {"static/a.css": ""})
        (root / "sources" / "doc").mkdir(parents=True)
        remove_empty_folders(root)
        if [path.name for path in root.iterdir()] != ["static"]:
            print("an empty folder stays")
            failures += 1
    python = ROOT / "build/docs-env/bin/python"
    if python.exists():  # the tools of the site are installed
        code = "from mathml import *; made = mathml(r'm\\sin\\dot\\theta', True); raise SystemExit(0 if formulas_refused() and made.count('mspace') == 2 and 'scriptlevel=\"+0\"' in made else 1)"
        if subprocess.run([python, "-c", code], cwd=ROOT / "doc/site").returncode != 0:
            print("a formula that cannot be translated is not refused")
            failures += 1
    print(f"{len(MUTANTS) + len(BUILT_MUTANTS)} mutants, {failures} mistakes")
    return 1 if failures else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build" / "site")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only-pages", action="store_true", help="do not run the examples")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--self-test", action="store_true")
    args = parser.parse_args()
    if args.self_test:
        return self_test()
    if args.check:
        problems, count = check(ROOT)
        for problem in problems:
            print(problem)
        print(f"{count} executed examples, {len(problems)} problems")
        return 1 if problems else 0
    if args.program is None or not args.program.exists():
        parser.error("--program must name the program")
    return build(args.program.resolve(), args.out, args.jobs, args.only_pages)


if __name__ == "__main__":
    sys.exit(main())
