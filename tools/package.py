#!/usr/bin/env python3
"""Makes the Debian package and the relocatable archive of the program, and tries both in an empty root.

    package.py FOLDER      FOLDER gets anholon_VERSION_amd64.deb, anholon-VERSION-linux-x86_64.tar.xz and SHA256SUMS

The libraries of build/libraries (static_libraries.py) are linked in. Only the C and C++ libraries, which every Debian 12 has, are not.
HDF5 and cairo (figures in PDF and PNG) are loaded when they are needed, if they are installed.
"""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import time

import static_libraries

ROOT = pathlib.Path(__file__).resolve().parents[1]
# The shared libraries that the program may need, and their packages in Debian 12
OUTSIDE = {
    "libc.so.6": "libc6 (>= 2.36)",
    "libm.so.6": "libc6 (>= 2.36)",
    "ld-linux-x86-64.so.2": "libc6 (>= 2.36)",
    "libstdc++.so.6": "libstdc++6 (>= 12)",
    "libgcc_s.so.1": "libgcc-s1 (>= 12)",
    "libz.so.1": "zlib1g",
    "libzstd.so.1": "libzstd1",
}


def run(*words, **options):
    return subprocess.run([str(w) for w in words], check=True, **options)


def version():
    """Returns the version of the project from CMakeLists.txt."""
    return re.search(r"project\(.*VERSION\s+([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)


def address():
    """Returns the e-mail address of the author of the last commit."""
    return run("git", "-C", ROOT, "log", "-1", "--format=%ae", capture_output=True, text=True).stdout.strip()


def needed(file):
    """Returns the shared libraries that a file needs."""
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", run("readelf", "-d", file, capture_output=True, text=True).stdout))


def compiled(prefix, build):
    """Builds the program in `build` and installs it under `prefix`, with its manual page, completions and licences."""
    libraries = ROOT / "build" / "libraries"
    static_libraries.main(libraries)
    run("cmake", "-S", ROOT, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", f"-DCMAKE_PREFIX_PATH={libraries}", "-DANHOLON_TESTS=OFF",
        "-DCMAKE_EXE_LINKER_FLAGS=-Wl,--gc-sections", stdout=subprocess.DEVNULL)  # fmt: skip
    run("cmake", "--build", build, "--target", "anholon", "--parallel", os.environ.get("ANHOLON_JOBS", str(os.cpu_count() or 2)))
    run("cmake", "--install", build, "--prefix", prefix, "--component", "program", "--strip", stdout=subprocess.DEVNULL)
    run(sys.executable, ROOT / "tools" / "command_line.py", prefix / "bin" / "anholon", prefix)
    shutil.copy(ROOT / "CITATION.cff", prefix / "share" / "doc" / "anholon")
    modules = [*prefix.glob("lib*/**/anholon-compiler.so")]
    if len(modules) != 1:
        raise SystemExit("the compiler module is missing; is LLVM 19 installed?")
    found = set().union(*(needed(f) for f in (prefix / "bin" / "anholon", *modules)))
    if found - set(OUTSIDE):
        raise SystemExit(f"shared libraries are needed that the package does not declare: {sorted(found - set(OUTSIDE))}")
    return sorted({OUTSIDE[name] for name in found})


def reset(entry):
    """Gives all files the same owner and time, so that archives of the same files have the same bytes."""
    entry.uid = entry.gid = 0
    entry.uname = entry.gname = "root"
    entry.mtime = int(os.environ.get("SOURCE_DATE_EPOCH", "0"))
    return entry


def archive(prefix, file):
    with tarfile.open(file, "w:xz", preset=6) as tar:
        tar.add(prefix, arcname=file.name.removesuffix("-linux-x86_64.tar.xz"), filter=reset)


def debian_package(prefix, depends, file, scratch):
    root = scratch / "deb"
    shutil.copytree(prefix, root / "usr", symlinks=True)
    (root / "DEBIAN").mkdir()
    size = sum(f.stat().st_size for f in root.rglob("*") if f.is_file()) // 1024
    (root / "DEBIAN" / "control").write_text(
        f"""Package: anholon
Version: {version()}
Architecture: amd64
Maintainer: The Anholon authors <{address()}>
Installed-Size: {size}
Depends: {", ".join(depends)}
Recommends: libhdf5-103-1, libcairo2
Suggests: chromium, ffmpeg
Section: science
Priority: optional
Description: equations of nonholonomic mechanical systems, their proof and motion
 Anholon derives the equations of motion of a mechanical system from a model
 file, proves that their classical forms agree, and integrates the motion.
""",
        encoding="utf-8",
    )
    run("dpkg-deb", "--root-owner-group", "-Zxz", "-b", root, file, stdout=subprocess.DEVNULL)


def try_archive(file, scratch):
    """Unpacks the archive in another folder and makes a motion and a page, without the environment of the build."""
    began = time.monotonic()
    with tarfile.open(file) as tar:
        tar.extractall(scratch / "moved here")
    program = next((scratch / "moved here").glob("*/bin/anholon"))
    clean = {"PATH": "/usr/bin:/bin", "HOME": str(scratch), "ANHOLON_CACHE": ""}
    run(program, "simulate", "disc", "--to", "10", "-o", scratch / "disc.csv", "--quiet", env=clean, cwd=scratch)
    run(program, "report", "disc", "--to", "10", "-o", scratch / "disc.html", "--quiet", env=clean, cwd=scratch)
    assert (scratch / "disc.csv").read_text(encoding="utf-8").startswith("t,") and (scratch / "disc.html").stat().st_size > 100_000
    return time.monotonic() - began


def try_in_root(deb, scratch):
    """Unpacks the package into a root with the declared libraries only, and runs the program in it."""
    root = scratch / "root"
    run("dpkg-deb", "-x", deb, root)
    for name in OUTSIDE:
        found = pathlib.Path(run("g++", f"-print-file-name={name}", capture_output=True, text=True).stdout.strip())
        if not found.is_absolute():
            found = next(f for f in map(pathlib.Path, (f"/lib64/{name}", f"/lib/x86_64-linux-gnu/{name}", f"/usr/lib/x86_64-linux-gnu/{name}")) if f.exists())
        place = root / ("lib64" if name.startswith("ld-") else "lib/x86_64-linux-gnu") / name
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(found.resolve(), place)
    for folder in ("tmp", "proc", "dev"):
        (root / folder).mkdir()
    script = f'mount -t proc proc "{root}/proc" && exec chroot "{root}" /usr/bin/anholon "$@"'
    environment = {"ANHOLON_CACHE": "", "PATH": os.environ["PATH"]}
    for words in (["simulate", "disc", "--to", "2000", "--at", "2000", "-o", "/tmp/disc.csv"], ["report", "disc", "--to", "1", "--quiet", "-o", "/tmp/disc.html"]):
        run("unshare", "-rmpf", "sh", "-c", script, "sh", *words, env=environment, stderr=subprocess.DEVNULL)
    # The program must find the shipped models without /proc, too.
    run("unshare", "-r", "chroot", root, "/usr/bin/anholon", "check", "disc", env=environment, stdout=subprocess.DEVNULL)
    assert (root / "tmp" / "disc.csv").stat().st_size > 50 and (root / "tmp" / "disc.html").stat().st_size > 100_000


def main(folder):
    folder = pathlib.Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    deb, packed = folder / f"anholon_{version()}_amd64.deb", folder / f"anholon-{version()}-linux-x86_64.tar.xz"
    with tempfile.TemporaryDirectory() as place:
        scratch = pathlib.Path(place)
        depends = compiled(scratch / "prefix", ROOT / "build" / "package")
        archive(scratch / "prefix", packed)
        debian_package(scratch / "prefix", depends, deb, scratch)
        seconds = try_archive(packed, scratch)
        try_in_root(deb, scratch)
    sums = "".join(f"{hashlib.sha256(f.read_bytes()).hexdigest()}  {f.name}\n" for f in (deb, packed))
    (folder / "SHA256SUMS").write_text(sums, encoding="utf-8")
    for file in (deb, packed):
        print(f"{file.name} {file.stat().st_size / 1e6:.1f} MB")
    print(f"from the archive to a motion and its page: {seconds:.1f} s")


if __name__ == "__main__":
    main(*sys.argv[1:])
