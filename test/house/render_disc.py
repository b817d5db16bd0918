#!/usr/bin/env python3
"""Records the disc: one picture, three moments, a film if ffmpeg is installed; the pictures are those requested and show a motion.

usage: render_disc.py PROGRAM

Exit status 77 (skipped) if Chromium is missing or the program has no viewer.
"""

import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MODEL = ROOT / "models/zoo/disc.toml"


def pixels(path):
    """Width, height and the unpacked (still filtered) bytes of a PNG."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", f"{path.name} is no PNG"
    at, size, packed, ended = 8, None, b"", False
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length : at + 12 + length])[0], f"{path.name} is damaged"
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
        elif kind == b"IDAT":
            packed += body
        ended = kind == b"IEND"
        at += 12 + length
    assert ended, f"{path.name} was cut off"
    return size, zlib.decompress(packed)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        temporary = out / "tmp"
        temporary.mkdir()
        environment = {**os.environ, "TMPDIR": str(temporary)}

        def render(*words, code=0):
            done = subprocess.run([program, "render", MODEL, "--to", "2", "--quiet", "--size", "160x90", *words], capture_output=True, text=True, env=environment, cwd=out)
            if "which is not installed" in done.stderr or "built without the viewer" in done.stderr:
                print("skipped: " + done.stderr.splitlines()[0])
                sys.exit(77)
            assert done.returncode == code, f"{words}: exit status {done.returncode}\n{done.stderr}"
            assert not list(temporary.glob("anholon-*")), "something temporary is left"
            return done

        render("-o", "disc.png", "--at", "1")
        size, light = pixels(out / "disc.png")
        assert size == (160, 90), size
        assert len(set(light)) > 20, "an empty picture"
        render("-o", "dark.png", "--at", "50%", "--dark")
        assert pixels(out / "dark.png")[1] != light, "--dark changes nothing"

        render("-o", "frames/", "--seconds", "0.3", "--fps", "10")
        names = sorted(p.name for p in (out / "frames").iterdir())
        assert names == ["frame-0001.png", "frame-0002.png", "frame-0003.png"], names
        frames = [pixels(out / "frames" / n) for n in names]
        assert all(s == (160, 90) for s, _ in frames)
        assert len({f for _, f in frames}) == 3, "pictures of different moments are the same"
        # A moment looks the same in a batch and alone.
        assert frames[1][1] == light

        assert "outside the motion" in render("-o", "late.png", "--at", "3", code=2).stderr
        if shutil.which("ffmpeg"):
            render("-o", "disc.gif", "--seconds", "0.3", "--fps", "10")
            assert (out / "disc.gif").read_bytes()[:6] == b"GIF89a"
            render("-o", "disc.mp4", "--seconds", "0.3", "--fps", "10")
            assert (out / "disc.mp4").read_bytes()[4:8] == b"ftyp"
        assert not list(out.glob("*.part")) and not list(out.glob("*.try"))
    print("ok")


if __name__ == "__main__":
    main()
