"""Fixtures of the tests of the Python package."""

import os
import pathlib
import subprocess
from collections.abc import Callable

import anholon as an
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program() -> Callable[..., str]:
    """Runs the command line and returns what it prints."""
    path = os.environ.get("ANHOLON_PROGRAM", str(ROOT / "build" / "anholon"))

    def run(*words: str) -> str:
        done = subprocess.run([path, *words], capture_output=True, text=True, check=False)
        return done.stdout

    return run


@pytest.fixture(scope="session")
def disc() -> an.Model:
    return an.load("disc")
