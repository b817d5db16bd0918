"""Fixtures of the tests of the Python package."""

import os
import pathlib
import signal
import subprocess
import threading
import time
from collections.abc import Callable

import anholon as an
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program() -> Callable[..., str]:
    """Returns a function that runs the program with options and returns its output."""
    path = os.environ.get("ANHOLON_PROGRAM", str(ROOT / "build" / "anholon"))

    def run(*words: str) -> str:
        done = subprocess.run([path, *words], capture_output=True, text=True, check=False)
        return done.stdout

    return run


@pytest.fixture(scope="session")
def disc() -> an.Model:
    return an.load("disc")


@pytest.fixture
def ctrl_c() -> Callable[..., Callable[[], float]]:
    """Returns a function that sends SIGINT to the main thread after some seconds.

    That function returns another one, which returns the processor time of the process since the signal, in seconds. Other work of
    the machine does not add to it.
    """

    def press_later(after: float) -> Callable[[], float]:
        pressed: list[float] = []

        def press() -> None:
            pressed.append(time.process_time())
            signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGINT)

        threading.Timer(after, press).start()
        return lambda: time.process_time() - pressed[0]

    return press_later
