#!/usr/bin/env python3
"""Makes the manual page from the help of the program, so that they cannot differ, and installs it with the completions of shells.

    command_line.py PROGRAM PREFIX      writes PREFIX/share/man/man1/anholon.1.gz, and completions of bash, zsh and fish
    command_line.py PROGRAM --check     checks that both name every command and option, and completes words in bash
"""

import dataclasses
import gzip
import pathlib
import re
import subprocess
import sys
import tempfile

OPTION = re.compile(r"^  (-\S+)(?: (.*))?$")


@dataclasses.dataclass
class Option:
    flags: list[str]
    value: str  # the name of the value in the help; empty for a flag
    text: str


@dataclasses.dataclass
class Command:
    words: str  # "sweep collect"; empty for the program
    about: str
    arguments: list[tuple[str, str]]
    options: list[Option]
    inner: list["Command"]
    footer: str


def sections(text):
    """Returns the titled parts of a help text, and the footer."""
    parts, footer, title = {}, [], None
    for line in text.splitlines()[2:]:
        if re.fullmatch(r"(Positionals|Options|Subcommands):", line):
            title = line[:-1]
            parts[title] = []
        elif title and line.startswith("  "):
            parts[title].append(line)
        elif title and line:
            title = None
            footer.append(line)
        elif footer and not title:
            footer.append(line)
    # "Examples:" is followed by indented lines, which belong to the footer.
    return parts, "\n".join(footer).strip()


def entries(lines):
    """Returns pairs (left column, right column) of a part. A line that begins further right continues the right column."""
    found = []
    for line in lines:
        if line.startswith("    "):
            found[-1][1] += " " + line.strip()
        else:
            left, _, right = line.strip().partition("  ")
            found.append([left, right.strip()])
    return found


def command(program, words=""):
    """Reads the command with the name `words` from its help."""
    text = subprocess.run([program, *words.split(), "--help"], capture_output=True, text=True, check=True).stdout
    parts, footer = sections(text)
    options = []
    for left, right in entries(parts.get("Options", [])):
        names, _, value = left.partition(" ")
        options.append(Option(names.split(","), value, right))
    inner = [command(program, f"{words} {name}".strip()) for name, _ in entries(parts.get("Subcommands", []))]
    return Command(words, text.splitlines()[0], [(a, b) for a, b in entries(parts.get("Positionals", []))], options, inner, footer)


def all_of(c):
    """Returns a command and all its subcommands."""
    return [c] + [each for i in c.inner for each in all_of(i)]


# ---- the manual page ----


def roff(text):
    return "\n".join(re.sub(r"^([.'])", r"\\&\1", line) for line in text.replace("\\", "\\e").replace("-", "\\-").splitlines())


def manual(top, version):
    lines = [f'.TH ANHOLON 1 "" "anholon {version}" "User Commands"', ".SH NAME", "anholon \\- equations and motions of nonholonomic mechanical systems", ".SH SYNOPSIS"]
    lines += [".B anholon", ".I COMMAND", "[OPTIONS]", ".SH DESCRIPTION", roff(top.about), ".SH COMMANDS"]
    for c in all_of(top)[1:]:
        lines += [f".SS anholon {roff(c.words)}", roff(c.about)]
        for name, text in c.arguments:
            lines += [".TP", f"\\fI{roff(name)}\\fR", roff(text) or "\\&"]
        for o in c.options:
            lines += [".TP", f"\\fB{roff(', '.join(o.flags))}\\fR \\fI{roff(o.value)}\\fR", roff(o.text) or "\\&"]
        if c.footer:
            lines += [".PP", ".nf", roff(c.footer), ".fi"]
    lines += [".SH EXAMPLES", ".nf", roff(top.footer), ".fi"]
    return "\n".join(lines) + "\n"


# ---- completions ----


def script(program, shell):
    """Returns the output of `anholon completion`."""
    return subprocess.run([program, "completion", shell], capture_output=True, text=True, check=True).stdout


def check(program, top, page):
    """Asserts that page and completions have all commands and options of the help, and that bash completes words."""
    shells = {shell: script(program, shell) for shell in ("bash", "zsh", "fish")}
    plain = page.replace("\\-", "-")
    for c in all_of(top)[1:]:
        assert f".SS anholon {c.words}" in plain, c.words
        block = plain.split(f".SS anholon {c.words}\n")[1].split("\n.SS ")[0]
        help_text = subprocess.run([program, *c.words.split(), "--help"], capture_output=True, text=True, check=True).stdout
        flags = {f for line in help_text.splitlines() if (m := OPTION.match(line)) for f in m.group(1).split(",")}
        assert flags == {f for o in c.options for f in o.flags}, (c.words, flags)
        assert all(f in block for f in flags), c.words
        if " " not in c.words:  # zsh and fish complete only the options of the first command
            assert all(f"*{f}[" in shells["zsh"] and f" -l {f[2:]} " in shells["fish"] for f in flags if f.startswith("--")), c.words
        assert f'"{c.words}") words=' in shells["bash"], c.words
    with tempfile.TemporaryDirectory() as scratch:
        file = pathlib.Path(scratch) / "anholon"
        file.write_text(shells["bash"], encoding="utf-8")
        for words, expected in (("anholon si", "simulate"), ("anholon simulate --tol", "--tolerance"), ("anholon sweep coll", "collect"), ("anholon sweep collect --par", "--partial"), ("anholon check chaplygin-sl", "chaplygin-sleigh")):
            split = words.split()
            lines = f'source {file}\nanholon() {{ "{program}" "$@"; }}\nCOMP_WORDS=({words})\nCOMP_CWORD={len(split) - 1}\n_anholon\nprintf "%s\\n" "${{COMPREPLY[@]}}"\n'
            done = subprocess.run(["bash", "-c", lines], capture_output=True, text=True, check=False)
            assert expected in done.stdout.split(), f"{words}: {done.stdout}{done.stderr}"
            assert all(line.startswith(split[-1]) for line in done.stdout.split()), done.stdout
    print(f"{len(all_of(top)) - 1} commands, {sum(len(c.options) for c in all_of(top))} options")


def main(program, target):
    program = str(pathlib.Path(program).resolve())
    top = command(program)
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.split()[-1]
    page = manual(top, version)
    if target == "--check":
        check(program, top, page)
        return
    share = pathlib.Path(target) / "share"
    files = {"bash-completion/completions/anholon": script(program, "bash"), "zsh/vendor-completions/_anholon": script(program, "zsh"), "fish/vendor_completions.d/anholon.fish": script(program, "fish")}
    for name, text in files.items():
        (share / name).parent.mkdir(parents=True, exist_ok=True)
        (share / name).write_text(text, encoding="utf-8")
    (share / "man" / "man1").mkdir(parents=True, exist_ok=True)
    (share / "man" / "man1" / "anholon.1.gz").write_bytes(gzip.compress(page.encode(), mtime=0))


if __name__ == "__main__":
    main(*sys.argv[1:])
