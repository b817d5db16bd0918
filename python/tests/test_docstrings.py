"""Every public name has a docstring, which tells shapes and exceptions, and an example that is run."""

import ast
import inspect
import pathlib
import re
from collections.abc import Iterator
from typing import Any

import anholon as an
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGE = pathlib.Path(an.__file__).parent


def definitions() -> Iterator[tuple[str, ast.AST, str]]:
    """Yields (name, definition, class) of the public classes, functions and members that are written in Python."""
    parts = [node for path in sorted(PACKAGE.glob("*.py")) for node in ast.parse(path.read_text(encoding="utf-8")).body]
    classes = {node.name: node for node in parts if isinstance(node, ast.ClassDef)}

    def members(node: ast.ClassDef) -> Iterator[ast.FunctionDef]:
        """Yields the methods of the class, then those of the private classes of the package that it extends."""
        yield from (member for member in node.body if isinstance(member, ast.FunctionDef))
        for base in node.bases:
            if isinstance(base, ast.Name) and base.id in classes and base.id not in an.__all__:
                yield from members(classes[base.id])

    for node in parts:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name in an.__all__:
            yield node.name, node, ""
            if isinstance(node, ast.ClassDef):
                for member in members(node):
                    if not member.name.startswith("_") or member.name in ("__call__", "__getitem__"):
                        yield f"{node.name}.{member.name}", member, node.name


ALL = {name: (node, of) for name, node, of in definitions()}


def doc(node: Any) -> str:
    return ast.get_docstring(node) or ""


def examples() -> str:
    """Returns the code of all examples that are run: docstrings (python.examples), documents (test_documents), notebooks."""
    lines = [line for path in PACKAGE.glob("*.py") for line in re.findall(r"^\s*(?:>>>|\.\.\.) (.*)$", path.read_text(encoding="utf-8"), re.M)]
    for document in ("README.md", "doc/python.md"):
        lines += re.findall(r"^```python\n(.*?)^```", (ROOT / document).read_text(encoding="utf-8"), re.M | re.S)
    lines += [path.read_text(encoding="utf-8") for path in (ROOT / "python" / "notebooks").glob("*.py")]
    return "\n".join(lines)


def test_all_names_are_found() -> None:
    found = {name for name in ALL if "." not in name}
    assert found >= {name for name in an.__all__ if inspect.isclass(getattr(an, name)) and getattr(an, name).__module__.startswith("anholon.")}


@pytest.mark.parametrize("name", ALL)
def test_a_name_is_explained(name: str) -> None:
    node, _ = ALL[name]
    text = doc(node)
    assert text, f"{name} has no docstring"
    assert len(text.split()) >= 3 and text.splitlines()[0].rstrip().endswith((".", ":", ",")) or len(text.splitlines()) > 1, f"{name}: {text}"


@pytest.mark.parametrize("name", [name for name in ALL if "." not in name])
def test_a_name_has_an_example(name: str) -> None:
    node, _ = ALL[name]
    own = "Example:" in doc(node) and ">>>" in doc(node)
    assert own or re.search(rf"\ban\.{name}\b", examples()), f"{name} has no example"


@pytest.mark.parametrize("name", [name for name in ALL if "." in name])
def test_a_member_is_used_in_an_example(name: str) -> None:
    member = name.split(".")[1]
    pattern = {"__call__": r"\b(run|f|g)\(", "__getitem__": r"\b(run|sweep)\["}.get(member, rf"\.{member}\b")
    assert re.search(pattern, examples()), f"no example uses {name}"


def raised(node: Any) -> set[str]:
    """Returns the names of the exceptions that a body raises itself, without Interrupted."""
    names = set()
    for part in ast.walk(node):
        if isinstance(part, ast.Raise) and isinstance(part.exc, ast.Call) and isinstance(part.exc.func, ast.Name):
            names.add(part.exc.func.id)
    return names - {"Interrupted"}


@pytest.mark.parametrize("name", [name for name, (node, _) in ALL.items() if isinstance(node, ast.FunctionDef)])
def test_what_is_raised_and_the_shapes_are_told(name: str) -> None:
    node, of = ALL[name]
    assert isinstance(node, ast.FunctionDef)
    text = doc(node) + (doc(ALL[of][0]) if of else "")
    for error in raised(node):
        assert error in text, f"{name} raises {error}"
    returns = ast.unparse(node.returns) if node.returns else ""
    if re.fullmatch(r"(Complex)?Array|npt\.NDArray.*", returns):
        assert "shape" in text.lower() or "view" in text, f"{name}: no shape"


def test_members_of_the_parts_of_a_class_are_found() -> None:
    assert {f"Model.{name}" for name in vars(an.Model) if not name.startswith("_")} < ALL.keys()
    assert {"Model.title", "Model.prove", "Model.simulate", "Model.linearize"} < ALL.keys()


def test_the_test_finds_what_is_missing() -> None:
    broken = ast.parse("def f(x):\n    raise ValueError('x')").body[0]
    assert not doc(broken) and raised(broken) == {"ValueError"}
