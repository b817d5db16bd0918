#!/usr/bin/env python3
"""Checks that includes point downwards, that each outside library stays in its place, and that no two types share a name.

usage: check_layers.py [--root DIR] [--self-test]

ARCHITECTURE.md says what each folder owns; the table below holds its level.
"""

import re
import sys

from checking import run, tree

# Subfolders of a layer are layers themselves: "modelfile/text" is src/modelfile/text/.
LEVEL = {
    "base": 0, "base/platform": 0.1, "numeric/random": 0.9, "numeric": 1, "expr": 2, "expr/derivatives": 2.1, "print": 2.2, "formula": 2.5, "tape": 3, "model": 4,
    "modelfile/language": 5, "modelfile/text": 5.1, "modelfile/names": 5.2, "modelfile/mechanical": 5.3,
    "modelfile/motion": 5.4, "modelfile/check": 5.5, "modelfile": 5.6, "mechanics": 5.7,
    "formulation": 6, "formulation/forms/multipliers": 6.1, "formulation/forms/coordinates": 6.1,
    "formulation/forms/quasi_velocities": 6.1, "system": 7, "lowering": 7.5, "structure": 8, "proof/checker": 7.8, "proof": 8,
    "program": 9, "emit": 9, "setup": 9.2, "setup/start": 9.1, "setup/outputs": 9.22, "setup/words": 9.25, "kernel/plan": 9.4, "kernel": 9.5, "kernel/tiers": 9.6, "jit/x86": 9.9, "jit": 10,
    "integrate/series": 9.8, "integrate": 10, "integrate/lanes": 10.1, "integrate/states": 10.1, "result": 11, "result/hdf5": 11.1, "result/parquet": 11.1, "motion": 11.5, "dynamics": 11.7, "observe/rows": 11.9, "observe/floors": 11.9, "observe": 12, "linear": 12, "simulation": 12.2, "contact/law": 12.22, "contact/surface": 12.23, "contact/mode": 12.24, "contact": 12.25,
    "ensemble/lanes": 12.28, "ensemble": 12.3, "ensemble/cases": 12.35, "ensemble/reduce": 12.28, "ensemble/store": 12.3, "ensemble/parts": 12.4, "ensemble/refine": 12.4, "published": 12.5, "published/misprints": 12.55, "published/findings": 12.6, "plot": 13, "report/rows": 13.4, "report": 13.5, "report/page": 13.6, "api": 13.8, "api/pictures": 13.85, "studio": 13.9, "cli": 14, "cli/models": 14.1, "cli/equations": 14.2, "cli/motions": 14.2, "cli/pictures": 14.3, "python": 14,
}  # fmt: skip

MODELFILE = {name for name in LEVEL if name.startswith("modelfile")}
FORMS = {name for name in LEVEL if name.startswith("formulation/forms/")}

# Layers that may include fewer layers than all below them.
ONLY = {
    "result": {"base", "numeric"},
    "result/hdf5": {"base", "base/platform", "numeric", "result"},
    "result/parquet": {"base", "base/platform", "numeric", "result"},
    "ensemble/store": {"base", "result", "result/parquet"},
    "proof/checker": {"base", "numeric"},  # the checker must not depend on the simplifier
    "jit": {"kernel", "kernel/plan", "jit/x86"},  # it is a module of its own
    "jit/x86": {"kernel"},
    "plot": {"base", "base/platform", "numeric", "expr", "print", "formula", "result"},
}
NOT = {
    "modelfile/text": {"tape"},
    "mechanics": MODELFILE,
    "formulation": MODELFILE,
    "system": MODELFILE,
    "lowering": MODELFILE,
    "structure": MODELFILE | {"lowering"},
    "proof": MODELFILE | {"lowering"},
    "program": MODELFILE | {"lowering", "proof", "proof/checker"},
    "emit": MODELFILE | {"lowering", "proof", "proof/checker", "program"},
    "formula": {"print"},
    "kernel/plan": MODELFILE | {"proof", "proof/checker", "setup"},
    "kernel/tiers": MODELFILE | {"proof", "proof/checker", "setup"},
    "kernel": MODELFILE | {"proof", "proof/checker", "setup"},
    "integrate": MODELFILE | {"proof", "proof/checker", "setup"},
    "integrate/series": MODELFILE | {"proof", "proof/checker", "setup"},
    "integrate/lanes": MODELFILE | {"proof", "proof/checker", "setup"},
    "integrate/states": MODELFILE | {"proof", "proof/checker", "setup"},
    "report/rows": {"jit", "jit/x86", "integrate", "integrate/series", "integrate/states"},
    "report": {"jit", "jit/x86", "integrate", "integrate/series", "integrate/states"},
    "report/page": {"jit", "jit/x86", "integrate", "integrate/series", "integrate/states"},
} | {room: MODELFILE for room in FORMS}

# (pattern of headers, name of the library, layers that may include it, number of files in each layer that may)
OUTSIDE = [
    (r"(flint/|arb|acb|arf|arith|mag\.h|ca\.h|ca_|calcium|antic|nf\.h|nf_|fmp[qz]|qqbar)", "FLINT/Arb", {"expr", "formula", "numeric"}, None),
    (r"(gmp|gmpxx|mpfr|mpf2mpfr|mpc)\.h$", "GMP/MPFR", {"expr", "formula", "numeric"}, None),
    (r"toml\+\+/", "toml++", {"modelfile/text"}, 1),
    (r"CLI/", "CLI11", {"cli"}, 1),
    (r"(llvm|llvm-c)/", "LLVM", {"jit", "jit/x86"}, None),
    (r"sleef", "SLEEF", {"jit"}, None),
    (r"mpi\.h$", "MPI", {"ensemble/cases"}, 1),
    (r"(hdf5|H5\w*)(_hl)?\.h$", "HDF5", {"result/hdf5"}, 1),
    (r"cairo(-\w+)?\.h$", "cairo", {"plot"}, 1),
    (r"sqlite3\.h$", "SQLite", {"result"}, 1),
    (r"(sundials|cvode|cvodes|ida|idas|arkode|nvector|sunmatrix|sunlinsol|sunnonlinsol)/", "SUNDIALS", {"integrate/states"}, 1),
    (r"(tbb|oneapi)/", "oneTBB", {"ensemble/cases"}, 1),
    (r"pybind11/", "pybind11", {"python"}, None),
    (r"nlohmann/", "nlohmann-json", {"proof/checker", "simulation", "ensemble/store"}, 1),
    (r"boost/", "Boost.Beast and Asio", {"studio"}, 1),
    (r"(gtest|gmock|benchmark)/", "a test library", set(), None),
]  # fmt: skip

# Commands print by one file, which makes control characters visible that would act on a terminal.
SAYING = re.compile(r"\b(?:std::)?(printf|fprintf|vfprintf|puts|fputs|putchar|fputc|fwrite|cout|cerr|clog)\b")
SAYS = ("cli/say.cpp", "cli/say.h")

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
SOURCES = {".h", ".hpp", ".cpp", ".c", ".def", ".inc"}


# Comments, strings and characters, whose braces have no meaning.
NO_CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<![0-9A-Fa-f])\'(?:\\.|[^\'\\\n])\'', re.S)
TYPE = re.compile(r"(?:^|[;}>\s])(?:struct|class|union|enum(?:\s+class)?)\s+(?:\[\[\w+\]\]\s*)?(\w+)(?:\s+final)?\s*(?::[^:;][^;]*)?$")
NAMESPACE = re.compile(r"(?:^|[;}\s])(?:inline\s+)?namespace(?:\s+([\w:]+))?\s*$")


def types(text):
    """Yields the types that a text defines at the scope of a named namespace: (line, qualified name)."""
    text = NO_CODE.sub(lambda m: "\n" * m[0].count("\n"), text)
    text = re.sub(r"^\s*#(?:[^\n\\]|\\.|\\\n)*", "", text, flags=re.M)
    scopes = []  # the name of a namespace, "" for an unnamed one, None for any other brace
    begin = 0
    for brace in re.finditer(r"[{}]", text):
        if brace[0] == "}":
            if scopes:
                scopes.pop()
            begin = brace.end()
            continue
        before = text[max(begin, text.rfind(";", begin, brace.start()) + 1) : brace.start()]
        begin = brace.end()
        space, of = NAMESPACE.search(before), TYPE.search(before)
        if space:
            scopes.append(space[1] or "")
            continue
        if of and all(scopes):
            yield text.count("\n", 0, brace.start()) + 1, "::".join([*scopes, of[1]])
        scopes.append(None)


def same_names(sources):
    """Yields types that are defined twice. The program is linked from all files, so two types of one name would share functions."""
    places = {}
    for path, name in sources:
        for line, of in types(path.read_text(encoding="utf-8")):
            places.setdefault(of, []).append(f"{name}:{line}")
    for of, where in sorted(places.items()):
        if len(where) > 1:
            yield f"{where[1]}: the type {of} is at {where[0]}, too (ODR): another name, or an unnamed namespace"


def may_include(layer):
    below = {name for name, level in LEVEL.items() if level < LEVEL[layer]}
    return (ONLY.get(layer, below) - NOT.get(layer, set())) | {layer}


def layer_of(path):
    """Returns the layer of "a/b/file.h", its longest folder that is a layer; None if there is none."""
    folder = path.rpartition("/")[0]
    while folder and folder not in LEVEL:
        folder = folder.rpartition("/")[0]
    return folder or None


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match[1], match[2]


def check(root):
    problems = []
    users = {}
    src = root / "src"
    for path in sorted(p for p in src.rglob("*") if p.is_file() and p.suffix in SOURCES):
        inside = path.relative_to(src)
        layer = layer_of(inside.as_posix())
        if layer is None or layer != inside.parent.as_posix():
            problems.append(f"src/{inside}: '{inside.parent}' is not a layer of tools/check_layers.py")
            continue
        allowed = may_include(layer)
        for number, quote, header in includes(path):
            where = f"src/{inside}:{number}"
            if quote == '"':
                target = layer_of(header)
                if header.startswith("anholon/"):
                    pass
                elif target is None:
                    problems.append(f'{where}: "{header}" does not begin with a layer (write "layer/file.h")')
                elif target not in allowed:
                    way = "across" if LEVEL[target] == LEVEL[layer] else "upward" if LEVEL[target] > LEVEL[layer] else "where it may not look"
                    problems.append(f'{where}: {layer} includes "{header}": {way}')
            for pattern, name, layers, _ in OUTSIDE:
                if re.match(pattern, header) and not (quote == '"' and layer_of(header)):
                    users.setdefault((name, layer), set()).add(str(inside))
                    if layer not in layers:
                        place = " and ".join(f"{x}/" for x in sorted(layers)) or "test/"
                        problems.append(f"{where}: {name} belongs into {place} only")
        if layer.startswith("cli") and str(inside) not in SAYS and path.suffix in (".cpp", ".h"):
            text = NO_CODE.sub(lambda m: "\n" * m[0].count("\n"), path.read_text(encoding="utf-8"))
            for match in SAYING.finditer(text):
                problems.append(f"src/{inside}:{text.count(chr(10), 0, match.start()) + 1}: {match[1]}: the commands print by cli/say.h")
    for _, name, layers, limit in OUTSIDE:
        for layer in sorted(layers):
            files = sorted(users.get((name, layer), ()))
            if limit is not None and len(files) > limit:
                problems.append(f"{name} is included by {len(files)} files of {layer}/, {limit} is allowed: {', '.join(files)}")

    files = [(p, p.relative_to(root)) for p in sorted((root / "src").rglob("*")) if p.suffix in SOURCES]
    problems += same_names(files)

    public = root / "include"
    for path in sorted(p for p in public.rglob("*") if p.is_file() and p.suffix in SOURCES):
        for number, quote, header in includes(path):
            ours = quote == '"' and header.startswith("anholon/")
            standard = quote == "<" and re.fullmatch(r"[a-z_0-9]+", header)
            if not ours and not standard:
                problems.append(f"{path.relative_to(root)}:{number}: a public header includes {header}; standard library only")
    return problems


GOOD = {
    "src/base/text.h": "#include <string>\n",
    "src/expr/graph.cpp": '#include <flint/flint.h>\n#include "base/text.h"\n#include "expr/graph.h"\n',
    "src/expr/graph.h": '// #include "cli/main.h"\n',
    "src/modelfile/text/toml.cpp": '#include <toml++/toml.h>\n#include "modelfile/language/language.h"\n',
    "src/result/hdf5/hdf5.cpp": "#include <hdf5.h>\n",
    "src/plot/cairo_library.h": "#include <cairo.h>\n",
    "src/report/html.cpp": '#include "result/columns.h"\n#include "program/program.h"\n',
    "src/proof/checker/verify.cpp": '#include "numeric/ball.h"\n#include "proof/checker/certificate.h"\n',
    "src/proof/checker/certificate.cpp": '#include <nlohmann/json.hpp>\n#include "base/json.h"\n',
    "src/jit/emitter.cpp": '#include <llvm/IR/Module.h>\n#include "kernel/code.h"\n',
    "src/cli/main.cpp": '#include <CLI/CLI.hpp>\n#include "simulation/simulate.h"\n',
    "include/anholon/api.h": "#include <vector>\n",
    "src/cli/say.cpp": "void f() { std::fwrite(text, 1, 1, stdout); }\n",
    "src/cli/typed_words.cpp": 'const char* kText = "std::printf";  // not fputs\nint n = std::snprintf(buffer, 1, "x");\n',
    # These types have the same name in different scopes and are allowed.
    "src/kernel/plan.h": "namespace anholon {\nstruct Entry {\n  struct Place {};\n};\ntemplate <> struct Of<int> {};\n}\n",
    "src/simulation/plan.cpp": "namespace anholon {\nnamespace {\nstruct Entry {};\n}\nstruct Entry;\nstruct Own { struct Place {}; };\n}\nnamespace anholon::cli {\nclass Entry {};\n}\n",
}
MUTANTS = {
    "upward": ("src/expr/bad.cpp", '#include "model/model.h"\n'),
    "across": ("src/mechanics/bad.cpp", '#include "modelfile/read.h"\n'),
    "across, below": ("src/formulation/forms/multipliers/bad.cpp", '  #  include "modelfile/read.h"\n'),
    "HDF5 outside its room": ("src/result/bad.cpp", "#include <hdf5.h>\n"),
    "result sees numbers only": ("src/result/bad.cpp", '#include "model/model.h"\n'),
    "report does not integrate": ("src/report/bad.cpp", '#include "integrate/stepper.h"\n'),
    "the compiler sees kernels only": ("src/jit/bad.cpp", '#include "program/program.h"\n'),
    "the compiler has no functions of its own": ("src/jit/bad.cpp", '#include "expr/elementary.def"\n'),
    "kernels do without their compiler": ("src/kernel/bad.cpp", '#include "jit/emitter.h"\n'),
    "kernels do not integrate": ("src/kernel/bad.cpp", '#include "integrate/stepper.h"\n'),
    "program does not prove": ("src/program/bad.cpp", '#include "proof/checker/certificate.h"\n'),
    "verify trusts the simplifier": ("src/proof/checker/bad.cpp", '#include "expr/graph.h"\n'),
    "verify trusts the prover": ("src/proof/checker/zero.cpp", '#include "proof/prove.h"\n'),
    "the format trusts the simplifier": ("src/proof/checker/format.h", '#include "expr/expr.h"\n'),
    "nlohmann-json twice": ("src/proof/checker/again.cpp", "#include <nlohmann/json.hpp>\n"),
    "nlohmann-json elsewhere": ("src/cli/bad.cpp", "#include <nlohmann/json.hpp>\n"),
    "upward within a layer": ("src/modelfile/text/bad.cpp", '#include "modelfile/names/names.h"\n'),
    "a room that is no layer": ("src/expr/more/bad.h", "\n"),
    "unknown layer": ("src/util/bad.h", "\n"),
    "no layer in the path": ("src/expr/bad.cpp", '#include "graph.h"\n'),
    "FLINT too high": ("src/model/bad.h", "#include <flint/fmpq.h>\n"),
    "GMP too high": ("src/tape/bad.h", "#include <gmpxx.h>\n"),
    "MPFR too low": ("src/base/bad.h", "#include <mpfr.h>\n"),
    "toml++ twice": ("src/modelfile/text/again.cpp", "#include <toml++/toml.h>\n"),
    "toml++ elsewhere": ("src/cli/bad.cpp", "#include <toml++/toml.hpp>\n"),
    "CLI11 twice": ("src/cli/again.cpp", "#include <CLI/App.hpp>\n"),
    "SUNDIALS elsewhere": ("src/simulation/bad.cpp", "#include <cvode/cvode.h>\n"),
    "LLVM outside jit": ("src/simulation/bad.cpp", "#include <llvm/IR/Module.h>\n"),
    "HDF5 twice": ("src/result/hdf5/bad.cpp", "#include <hdf5.h>\n"),
    "HDF5 elsewhere": ("src/cli/bad.cpp", "#include <hdf5.h>\n"),
    "cairo elsewhere": ("src/cli/bad.cpp", "#include <cairo-pdf.h>\n"),
    "plot does not simulate": ("src/plot/bad.cpp", '#include "simulation/simulate.h"\n'),
    "test library in src": ("src/base/bad.cpp", "#include <gtest/gtest.h>\n"),
    "two types of one name": ("src/report/words.h", "namespace anholon {\n// {\nstruct Entry {\n  int k;\n};\n}\n"),
    "two classes of one name": ("src/simulation/bad.cpp", "namespace anholon {\nconst char* kText = \"}\";\nclass Own final : public Base {\n};\n}\n"),
    "an enumeration and a type": ("src/simulation/bad.cpp", "namespace anholon {\nenum class Own : int { a };\n}\n"),
    "a command prints by itself": ("src/cli/bad.cpp", "void f() { std::printf(title); }\n"),
    "public header": ("include/anholon/bad.h", '#include "expr/graph.h"\n'),
}


def self_test():
    with tree(GOOD) as root:
        for problem in check(root):
            yield f"a good tree was refused: {problem}"
    for title, (name, text) in MUTANTS.items():
        with tree(GOOD | {name: text}) as root:
            if not check(root):
                yield f"mutant not refused: {title}"


def judge(root):
    problems = check(root)
    return problems, f"{len(problems)} problems"


if __name__ == "__main__":
    sys.exit(run(__doc__, judge, self_test))
