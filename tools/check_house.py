#!/usr/bin/env python3
"""Checks the shape of the code: no circle of files, no class or function that has grown too large, no crowded folder.

usage: check_house.py [--root DIR] [--self-test]

  circle      two files of src/ that include each other, by whatever way (a .h and its .cpp are one unit)
  class       a class with more than 20 data members
  function    a function of more than 80 lines; a body that only fills a table may be longer
  folder      a folder of src/ with more than 26 files

tools/house_debts.txt lists what is still larger: an entry may not grow, and one that is paid has to be taken out.
"""

import re
import sys

from checking import run, tree

MOST_MEMBERS, MOST_LINES, MOST_FILES = 20, 80, 26

INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])\'', re.S)
CLASS = re.compile(r"(?:^|[;}>\s])class\s+(?:\[\[\w+\]\]\s*|ANHOLON_API\s+)?(\w+)(?:\s+final)?\s*(?::[^:;{][^;{]*)?$")
NAMESPACE = re.compile(r"(?:^|[;}\s])(?:inline\s+)?namespace(?:\s+[\w:]+)?\s*$|extern\s*$")
TYPE = re.compile(r"(?:^|[;}>\s])(?:struct|class|union|enum(?:\s+class)?)\b[^;(){}]*$")
FUNCTION = re.compile(r"([~\w:<>, ]+?)\s*\([^;]*\)\s*(?:const|noexcept|override|final|mutable|->\s*[\w:<>&*, ]+|\s)*(?::[^;]*)?$", re.S)


INITIALIZER = re.compile(r"\)\s*:(?!:)(?:[^;]*,)?\s*[A-Za-z_]\w*\s*$")


def code_of(text):
    text = NO_CODE.sub(lambda m: '""' + "\n" * m[0].count("\n") if m[0][0] in "\"R'" else "\n" * m[0].count("\n"), text)
    return re.sub(r"^[ \t]*#(?:[^\n\\]|\\.|\\\n)*", lambda m: "\n" * m[0].count("\n"), text, flags=re.M)


def members(body):
    """Returns the data members that are declared directly in a class body."""
    flat, depth = [], 0
    for c in body:
        if c in "{(":
            depth += 1
        if depth == 0:
            flat.append(c)
        if c in "})":
            depth -= 1
            if depth == 0:
                flat.append(" @ " if c == ")" else " ")
    names = []
    for statement in "".join(flat).split(";"):
        statement = re.sub(r"\b(public|private|protected)\s*:", " ", statement).strip()
        if not statement or "@" in statement or re.match(r"(using|friend|template|static|typedef|enum|struct|class|explicit|virtual|mutable\s+static)\b", statement):
            continue
        while re.search(r"<[^<>]*>", statement):
            statement = re.sub(r"<[^<>]*>", "", statement)
        if not re.match(r"(?:mutable\s+|const\s+|constexpr\s+)*[\w:]+[\s&*]+\w", statement):
            continue
        names += [part for part in statement.split(",")]
    return names


def shapes(text):
    """Yields the classes and functions of a text: ("class", line, name, members) and ("function", line, name, lines)."""
    code = code_of(text)
    stack, begin = [], 0
    for brace in re.finditer(r"[{}]", code):
        at = brace.start()
        if brace[0] == "{":
            head = code[begin:at]
            outside = all(kind in ("namespace", "class") for kind, *_ in stack)
            kind, name = "other", ""
            # A member initializer in braces belongs to the head of its constructor.
            if outside and INITIALIZER.search(head):
                stack.append(("initializer", at, begin, ""))
                continue
            if NAMESPACE.search(head):
                kind = "namespace"
            elif outside and (found := CLASS.search(head)):
                kind, name = "class", found[1]
            elif outside and TYPE.search(head):
                kind = "class"
            elif outside and (found := FUNCTION.search(head.strip())):
                kind, name = "function", found[1].split()[-1] if found[1].split() else ""
            stack.append((kind, at, begin, name))
            begin = at + 1
        elif stack:
            kind, start, head, name = stack.pop()
            if kind == "initializer":
                begin = head
                continue
            begin = at + 1
            line = code.count("\n", 0, start) + 1
            if kind == "class" and name:
                yield "class", line, name, len(members(code[start + 1 : at]))
            if kind == "function":
                body = code[start + 1 : at].strip()
                table = re.match(r"(?:static\s+const\s+[^;{}()]*|return\s*)\{", body) and body.count(";") <= 3
                yield "function", line, name, 0 if table else code.count("\n", start, at) - 1


def units(root):
    graph = {}
    for path in sorted((root / "src").rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        name = path.relative_to(root / "src").as_posix()
        unit = name.rsplit(".", 1)[0]
        for header in INCLUDE.findall(path.read_text(encoding="utf-8")):
            to = header.rsplit(".", 1)[0]
            if to != unit:
                graph.setdefault(unit, set()).add(to)
        graph.setdefault(unit, set())
    return graph


def circles(graph):
    """Returns the strongly connected components with more than one unit."""
    index, low, stack, on, found, order = {}, {}, [], set(), [], [0]

    def visit(v):
        work = [(v, iter(sorted(graph.get(v, ()))))]
        index[v] = low[v] = order[0]
        order[0] += 1
        stack.append(v)
        on.add(v)
        while work:
            u, rest = work[-1]
            for w in rest:
                if w not in graph:
                    continue
                if w not in index:
                    index[w] = low[w] = order[0]
                    order[0] += 1
                    stack.append(w)
                    on.add(w)
                    work.append((w, iter(sorted(graph[w]))))
                    break
                if w in on:
                    low[u] = min(low[u], index[w])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[u])
                if low[u] == index[u]:
                    component = []
                    while True:
                        w = stack.pop()
                        on.discard(w)
                        component.append(w)
                        if w == u:
                            break
                    if len(component) > 1:
                        found.append(sorted(component))

    for v in sorted(graph):
        if v not in index:
            visit(v)
    return found


def check(root):
    for circle in circles(units(root)):
        yield "circle", "src", ", ".join(circle), len(circle)
    for path in sorted((root / "src").rglob("*")):
        where = path.relative_to(root).as_posix()
        if path.is_dir():
            count = sum(1 for f in path.iterdir() if f.is_file())
            if count > MOST_FILES:
                yield "folder", where, "files", count
        elif path.suffix in (".h", ".cpp"):
            for kind, line, name, size in shapes(path.read_text(encoding="utf-8")):
                if size > (MOST_MEMBERS if kind == "class" else MOST_LINES):
                    yield kind, f"{where}:{line}", name, size


GOOD = {
    "src/a/one.h": '#include "a/two.h"\nclass Few {\n  int a_ = 1, b_{2};\n  std::vector<std::pair<int, int>> c_;\n  void f() const { int x; }\n};\n',
    "src/a/two.h": "struct Record {\n" + "".join(f"  int m{i};\n" for i in range(40)) + "};\n",
    "src/a/table.cpp": "std::vector<Row> rows() {\n  return {\n" + '      {"a", 1},\n' * 100 + "  };\n}\n",
    "src/a/long.cpp": "void f(int a)\n    : x_(a), y_{1} {\n" + "  g();\n" * 80 + "}\n",
}
MUTANTS = {
    "circle": ("src/a/two.h", '#include "a/one.h"\n'),
    "circle by the .cpp": ("src/a/two.cpp", '#include "a/two.h"\n#include "a/one.h"\n'),
    "class": ("src/a/many.h", "class Many {\n  void f();\n" + "".join(f"  std::map<int, int> m{i}_;\n" for i in range(21)) + "};\n"),
    "class with lists": ("src/a/many.h", "class Many {\n  int a0_, " + ", ".join(f"m{i}_ = {i}" for i in range(20)) + ";\n};\n"),
    "function": ("src/a/long.cpp", "namespace x {\nint C::f(int a) const {\n" + "  g();\n" * 81 + "}\n}\n"),
    "constructor": ("src/a/long.cpp", "C::C(int a)\n    : x_(a), y_{1} {\n" + "  g();\n" * 81 + "}\n"),
    "member function": ("src/a/long.h", "class C {\n  void f() {\n" + "    g();\n" * 81 + "  }\n};\n"),
    "folder": (None, None),
}


def self_test():
    with tree(GOOD) as root:
        for problem in check(root):
            yield f"a good tree was refused: {problem}"
    for title, (name, text) in MUTANTS.items():
        more = {name: text} if name else {f"src/a/f{i}.h": "" for i in range(MOST_FILES)}
        with tree(GOOD | more) as root:
            if not any(kind == title.split()[0] or title in ("constructor", "member function") for kind, *_ in check(root)):
                yield f"mutant not refused: {title}"


def debts(root):
    """Reads the sizes that are allowed for the present: {(kind, place without its line, name): size}."""
    path = root / "tools" / "house_debts.txt"
    if not path.exists():
        return {}
    rows = [line.split("\t") for line in path.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    return {(kind, place, name): int(size) for kind, place, name, size in rows}


def unpaid(root):
    """Yields the problems that no debt covers, and the debts that are paid."""
    left = debts(root)
    for kind, where, name, size in check(root):
        key = (kind, where.rsplit(":", 1)[0], name)
        if size > left.pop(key, 0):
            yield f"{where}: {kind} {name}: {size}"
    for kind, place, name in left:
        yield f"{place}: {kind} {name} is no debt any more: take it out of tools/house_debts.txt"


def judge(root):
    problems = list(unpaid(root))
    return problems, f"{len(debts(root))} debts, {len(problems)} problems"


if __name__ == "__main__":
    sys.exit(run(__doc__, judge, self_test))
