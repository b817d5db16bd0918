#!/usr/bin/env python3
"""Builds the libraries that wheels and packages carry, as position-independent archives, from Debian's pinned source packages.

    static_libraries.py FOLDER      FOLDER gets include/, lib/ and licences/; nothing is done if it is complete

Debian ships GMP, MPFR, FLINT, Arb and oneTBB as shared libraries only, or with archives that do not fit into a shared library, and its
FLINT needs NTL and gf2x, which Anholon does not use; here FLINT is built without them. Debian's own archives of SUNDIALS fit.
The .dsc files are pinned below by their SHA-256, and they hold the SHA-256 of the sources. They come from Debian's pool, or without
a network from the folder that the variable ANHOLON_SOURCES names.
"""

import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.request

MIRROR = "http://deb.debian.org/debian/pool/main"
# Each function has a section of its own, so that the linker can drop functions that nothing calls.
FLAGS = "-O2 -fPIC -fvisibility=hidden -ffunction-sections -fdata-sections -ffp-contract=off"
TUPLE = "x86_64-pc-linux-gnu"  # code for every x86-64, not for the machine that builds

PACKAGES = {  # name: (path in the pool, SHA-256 of the .dsc, licence)
    "gmp": ("g/gmp/gmp_6.2.1+dfsg1-1.1.dsc", "2831ed4f83bc3304c2403474b335652ab2dc507cd517de44414d9142171748f0", "LGPL-3.0-or-later or GPL-2.0-or-later"),
    "mpfr": ("m/mpfr4/mpfr4_4.2.0-1.dsc", "bfd38815d4d79f9ea3f14d94f61a075a0914ecbe4ef9666b7f6597340a60c250", "LGPL-3.0-or-later"),
    "flint": ("f/flint/flint_2.9.0-5.dsc", "7252dbc5d0eb0535ac8f076fc464e9f9bfd9e54a0adc1d76866883504f93aec7", "LGPL-2.1-or-later"),
    "arb": ("f/flint-arb/flint-arb_2.23.0-1.dsc", "d3f9d8396a76d2823dd2f2ede95655887a1def593ded933487b905ffcc518bdd", "LGPL-2.1-or-later"),
    "tbb": ("o/onetbb/onetbb_2021.8.0-2+deb12u1.dsc", "f01de0ed79cb49b48beb2cdb6e1b3c5f625ca65f07d7959bebfbbd89a2e941ad", "Apache-2.0"),
}
# Libraries that are not built here: archives of installed packages, or headers that are compiled in.
INSTALLED = {
    "sundials": ("libsundials-dev", "BSD-3-Clause", ["sundials_cvode", "sundials_ida"]),
    "cli11": ("libcli11-dev", "BSD-3-Clause", []),
    "tomlplusplus": ("libtomlplusplus-dev", "MIT", []),
    "nlohmann-json": ("nlohmann-json3-dev", "MIT", []),
    "llvm": ("llvm-19-dev", "Apache-2.0 with LLVM exceptions", []),  # linked into the compiler module
    "zstd": ("libzstd1", "BSD-3-Clause or GPL-2.0-only", []),  # shipped beside the compiler module, as LLVM needs it
}


def fetch(path, checksum, folder):
    """Gets a file of the pool into `folder` and checks its SHA-256. Returns its place."""
    place = folder / path.rsplit("/", 1)[-1]
    own = os.environ.get("ANHOLON_SOURCES")
    if not place.exists():
        if own:
            shutil.copyfile(pathlib.Path(own) / place.name, place)
        else:
            with urllib.request.urlopen(f"{MIRROR}/{path.replace('+', '%2b')}", timeout=120) as answer:
                place.write_bytes(answer.read())
    found = hashlib.sha256(place.read_bytes()).hexdigest()
    if found != checksum:
        place.unlink()
        raise SystemExit(f"{place.name}: SHA-256 is {found}, not {checksum}")
    return place


def unpack(name, folder):
    """Unpacks the source of a package, with Debian's patches."""
    path, checksum, _ = PACKAGES[name]
    dsc = fetch(path, checksum, folder)
    section = re.search(r"^Checksums-Sha256:\n((?: .*\n)+)", dsc.read_text(encoding="utf-8"), re.M).group(1)
    for line in section.splitlines():
        digest, _, file = line.split()
        if not file.endswith(".asc"):
            fetch(f"{path.rsplit('/', 1)[0]}/{file}", digest, folder)
    source = folder / name
    shutil.rmtree(source, ignore_errors=True)
    # --no-check, as signatures need a keyring, and the checksums above pin every byte.
    subprocess.run(["dpkg-source", "--no-check", "-x", dsc.name, name], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return source


def build(name, source, prefix, log):
    """Configures, compiles and installs one library into `prefix`."""
    jobs = os.environ.get("ANHOLON_JOBS") or str(os.cpu_count() or 2)

    def do(*words, where=source):
        subprocess.run([str(w) for w in words], cwd=where, check=True, stdout=log, stderr=log, stdin=subprocess.DEVNULL)

    flags = f"CFLAGS={FLAGS}"
    if name == "gmp":
        # configure needs the makefile of the manual, which Debian's source lacks.
        (source / "doc").mkdir(exist_ok=True)
        (source / "doc" / "Makefile.in").write_text("all install check:\n", encoding="utf-8")
        do("./configure", f"--build={TUPLE}", f"--host={TUPLE}", f"--prefix={prefix}", "--enable-cxx", "--disable-shared", "--with-pic", flags, f"CXXFLAGS={FLAGS}")
    elif name == "mpfr":
        do("./configure", f"--build={TUPLE}", f"--prefix={prefix}", f"--with-gmp={prefix}", "--disable-shared", "--with-pic", "--enable-thread-safe", flags)
    elif name == "flint":
        do("./configure", f"--build={TUPLE}", f"--prefix={prefix}", f"--with-gmp={prefix}", f"--with-mpfr={prefix}", "--disable-shared", flags)
    elif name == "arb":
        do("./configure", f"--build={TUPLE}", f"--prefix={prefix}", f"--with-gmp={prefix}", f"--with-mpfr={prefix}", f"--with-flint={prefix}", "--disable-shared", flags)
    elif name == "tbb":
        do("cmake", "-S", ".", "-B", "made", f"-DCMAKE_INSTALL_PREFIX={prefix}", "-DCMAKE_INSTALL_LIBDIR=lib", "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_SHARED_LIBS=OFF",
           "-DTBB_TEST=OFF", "-DTBBMALLOC_BUILD=OFF", "-DTBB_STRICT=OFF", f"-DCMAKE_CXX_FLAGS={FLAGS}")
        do("cmake", "--build", "made", "-j", jobs)
        do("cmake", "--install", "made")
        return
    if name not in ("flint", "arb"):
        do("make", "-j", jobs, "all")
        do("make", "install")
        return
    # The makefiles of FLINT and Arb rewrite the archive for each folder, which takes longer than compiling, so `ar` runs once below.
    do("make", "-j", jobs, "library", "AR=true")
    objects = source / "objects.txt"
    objects.write_text("\n".join(sorted(str(o.relative_to(source)) for o in (source / "build").rglob("*.o"))), encoding="utf-8")
    do("ar", "rcs", f"lib{name}.a", f"@{objects.name}")
    do("make", "install", "AR=true")


def copyright_of(name, source):
    """Returns the path of Debian's copyright file of a library: that of its source package, or of the installed package."""
    if source:
        return source / "debian" / "copyright"
    return pathlib.Path("/usr/share/doc") / INSTALLED[name][0] / "copyright"


def licence_table():
    """Returns a table of the libraries that are linked in, with their packages and licences."""
    text = "# Libraries that are linked in\n\nAnholon itself has the MIT licence. The file of each library holds its copyright in full.\n\n| library | Debian package | licence |\n|---|---|---|\n"
    for name, (path, _, licence) in PACKAGES.items():
        text += f"| {name} | source of {path.rsplit('/', 1)[-1].removesuffix('.dsc')} | {licence} |\n"
    for name, (package, licence, _) in INSTALLED.items():
        text += f"| {name} | {package} | {licence} |\n"
    text += "| three.js, uPlot, CodeMirror, STIX Two Math (viewer.txt) | npm, viewer/package.json | MIT; SIL OFL |\n"
    text += "| Boost.Beast (boost.txt), of the program alone | libboost-dev | BSL-1.0 |\n| nanobind (nanobind.txt), of the Python package alone | PyPI | BSD-3-Clause |\n"
    return text + "\nFLINT is built without NTL and gf2x. GMP, MPFR, FLINT and Arb can be exchanged: `tools/static_libraries.py` of the source builds them again.\n"


def main(folder):
    prefix = pathlib.Path(folder).resolve()
    wanted = hashlib.sha256(repr((PACKAGES, INSTALLED, FLAGS, TUPLE, str(prefix))).encode()).hexdigest()
    complete = prefix / "complete"
    (prefix / "licences").mkdir(parents=True, exist_ok=True)
    (prefix / "licences" / "README.md").write_text(licence_table(), encoding="utf-8")
    if complete.exists() and complete.read_text(encoding="utf-8") == wanted:
        return
    scratch = prefix / "source"
    for place in (scratch, prefix / "lib", prefix / "licences"):
        place.mkdir(parents=True, exist_ok=True)
    with open(prefix / "log.txt", "wb") as log:
        for name in PACKAGES:
            print(f"building {name}", file=sys.stderr, flush=True)
            source = unpack(name, scratch)
            try:
                build(name, source, prefix, log)
            except subprocess.CalledProcessError as error:
                raise SystemExit(f"{name} could not be built: {error}; see {prefix / 'log.txt'}") from error
            shutil.copyfile(copyright_of(name, source), prefix / "licences" / f"{name}.txt")
            shutil.rmtree(source)
    for name, (_, _, archives) in INSTALLED.items():
        for archive in archives:
            found = subprocess.run(["g++", f"-print-file-name=lib{archive}.a"], capture_output=True, text=True, check=True).stdout.strip()
            shutil.copyfile(found, prefix / "lib" / f"lib{archive}.a")
        shutil.copyfile(copyright_of(name, None), prefix / "licences" / f"{name}.txt")
    for unwanted in prefix.glob("lib/*.la"):
        unwanted.unlink()
    complete.write_text(wanted, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
